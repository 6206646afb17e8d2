// Gauss points, uniform and adaptive meshes: orders against the closed form of the free helix, errors met.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "tendril/closed_form/helix.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/reproduce/methods_detail.hpp"

namespace tendril::reproduce::methods {
namespace {

using drawing::Curve;
using drawing::Panel;
using formulation::FreeRod;
using segmentation::Chain;
using segmentation::Mechanics;

constexpr int kPlaces = 1001;         // where solutions are compared
constexpr double kHalfAnOrder = 0.5;  // tells an order from its neighbours

/// Twisted clamped rod that sags under its weight, clear of the wall.
segmentation::Problem sagging_rod() {
  segmentation::Problem p;
  p.tube.axis =
      geometry::make_straight(1.0, Eigen::Vector3d::UnitX(), Eigen::Vector3d::Zero(), Eigen::Vector3d(0, 1, 0));
  p.tube.clearance = geometry::make_constant(0.9);
  p.rod = {1.0, 0.75, 400.0};
  p.load.force = {0.0, 0.0, -20.0};
  p.end.kind = segmentation::End::Kind::sleeve;
  p.end_position = 1.0;
  p.axial_value = -5.0;
  p.twist_value = 3.0;
  return p;
}

using Values = std::vector<std::array<double, 5>>;  // δ1, δ2, F1, F2, F3 at kPlaces

Values values_of(const Chain& c) {
  Values v(kPlaces);
  double u[FreeRod::inputs], s = 0;
  for (int i = 0; i < kPlaces; ++i) {
    c.sample(static_cast<double>(i) / (kPlaces - 1), u, &s);
    v[i] = {u[0], u[4], u[11], u[13], u[15]};
  }
  return v;
}

/// Largest difference over the largest value, of δ and of F.
std::array<double, 2> error_of(const Values& a, const Values& reference) {
  std::array<double, 2> worst{}, size{};
  for (int i = 0; i < kPlaces; ++i) {
    const auto &x = a[i], &y = reference[i];
    worst[0] = std::max(worst[0], std::hypot(x[0] - y[0], x[1] - y[1]));
    worst[1] = std::max(worst[1], std::hypot(x[2] - y[2], x[3] - y[3], x[4] - y[4]));
    size[0] = std::max(size[0], std::hypot(y[0], y[1]));
    size[1] = std::max(size[1], std::hypot(y[2], y[3], y[4]));
  }
  return {worst[0] / size[0], worst[1] / size[1]};
}

Chain on_mesh(const Chain& reference, int k, int pieces) {
  Chain c(reference.mechanics_ptr(), k);
  c.build({{0}, {}}, pieces, [&](double S, double* u, double* s) { reference.sample(S, u, s); });
  return c;
}

/// The free helix of (II.3.14), 2.3 turns in a straight tube: known exactly, with one wave length.
struct FreeHelix {
  closed_form::Helix helix{0.05, 0.2 * std::numbers::pi};
  double eta = 0.02, nu = 1.0 / 3;
  closed_form::SurfaceState state = closed_form::free_homoclinic_helix(helix, eta);
  double rate() const { return std::tan(helix.angle) / helix.radius; }  // dβ/dS

  segmentation::Problem problem() const {
    segmentation::Problem p;
    p.tube.axis =
        geometry::make_straight(1.0, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero(), Eigen::Vector3d(1, 0, 0));
    p.tube.clearance = geometry::make_constant(0.2);
    p.rod = {1.0, 1 / (1 + nu), 1 / (eta * eta)};
    p.end.kind = segmentation::End::Kind::sleeve;
    p.end_position = 1.0;
    for (const bool end : {false, true}) {
      segmentation::End& e = end ? p.end : p.start;
      const double b = end ? rate() : 0.0;
      e.eccentricity[0] = helix.radius * std::cos(b);
      e.eccentricity[1] = helix.radius * std::sin(b);
      e.slope[0] = -std::tan(helix.angle) * std::sin(b);
      e.slope[1] = std::tan(helix.angle) * std::cos(b);
    }
    p.axial_value = state.F_3;
    p.twist_value = state.M_3;
    return p;
  }

  void inputs(const segmentation::ScaledProblem& scaled, double S, double* u, double* s) const {
    const double w = rate(), b = w * S, c = std::cos(b), d = std::sin(b), r = helix.radius;
    const double one[] = {r * c, -r * w * d, -r * w * w * c, r * w * w * w * d};
    const double two[] = {r * d, r * w * c, -r * w * w * d, -r * w * w * w * c};
    std::copy(one, one + 4, u);
    std::copy(two, two + 4, u + 4);
    const auto k = FreeRod::kinematics<double>(formulation::lift<double>(scaled.section(S), 0.0, 0.0), u[0], u[1], u[2],
                                               u[4], u[5], u[6]);
    const double J1 = state.alpha * std::cos(helix.angle);
    u[9] = (1 + nu) * state.M_3 / J1 - k.c;
    u[8] = u[9] * S;
    u[10] = 0;
    const numerics::V3<double> N{c, d, 0.0}, g = numerics::cross(N, k.t);
    const double F1 = state.F_g * numerics::dot(g, k.k1), F2 = state.F_g * numerics::dot(g, k.k2), F3 = state.F_3;
    u[11] = F1;
    u[12] = -k.p * F3 + k.c * F2;  // (II.2.48-50) without load
    u[13] = F2;
    u[14] = -k.c * F1 - k.h * F3;
    u[15] = F3;
    u[16] = k.h * F2 + k.p * F1;
    *s = S / J1;
  }
};

Chain helix_on_mesh(const FreeHelix& helix, const std::shared_ptr<Mechanics>& mechanics, int k, int pieces) {
  Chain c(mechanics, k);
  c.build({{0}, {}}, pieces, [&](double S, double* u, double* s) { helix.inputs(mechanics->problem, S, u, s); });
  return c;
}

/// Slope of log error over log h on the three finest meshes whose error is not yet rounding.
double observed_order(const std::vector<double>& pieces, const std::vector<double>& error, double rounding) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = pieces.size(); i-- > 0 && n < 3;) {
    if (error[i] < rounding) continue;
    const double x = -std::log(pieces[i]), y = std::log(error[i]);
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace

void meshes(Outcome& out, const Progress& progress) {
  const FreeHelix helix;
  const auto tube = std::make_shared<Mechanics>(helix.problem());
  Values closed(kPlaces);
  for (int i = 0; i < kPlaces; ++i) {
    double u[FreeRod::inputs], s = 0;
    helix.inputs(tube->problem, static_cast<double>(i) / (kPlaces - 1), u, &s);
    closed[i] = {u[0], u[4], u[11], u[13], u[15]};
  }
  Data convergence{"convergence",
                   {"k", "pieces N", "error of delta [relative]", "error of F [relative]", "unknowns 6kN+11"},
                   std::vector<std::vector<double>>(5)};
  Panel shape = panel_of("eccentricity δ, order k + 3", "pieces N [-]", "relative error [-]"),
        force = panel_of("force F, order k + 1", "pieces N [-]", "relative error [-]");
  for (int k = 4; k <= 7; ++k) {
    std::vector<double> pieces, delta, F;
    for (const int n : {4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 48, 64}) {
      Chain c = helix_on_mesh(helix, tube, k, n);
      const auto solved = c.solve(at(0), tight_newton());
      if (!solved.converged) throw std::runtime_error("the helix was not solved on a mesh: " + solved.reason);
      const auto error = error_of(values_of(c), closed);
      pieces.push_back(n);
      delta.push_back(error[0]);
      F.push_back(error[1]);
      const double row[] = {double(k), double(n), error[0], error[1], 6.0 * k * n + 11};
      for (std::size_t i = 0; i < 5; ++i) convergence.value[i].push_back(row[i]);
    }
    const std::string name = "k = " + std::to_string(k);
    for (const bool of_force : {false, true}) {
      Curve c;
      c.x = pieces;
      c.y = of_force ? F : delta;
      c.label = name;
      c.mark = drawing::Mark::circle;
      (of_force ? force : shape).curves.push_back(c);
    }
    out.rows.push_back({name + ": order of F between nodes", observed_order(pieces, F, 1e-11), k + 1.0, kHalfAnOrder,
                        "theory: k + m, m = 1; finite h"});
    out.rows.push_back({name + ": order of δ between nodes", observed_order(pieces, delta, 1e-12), k + 3.0,
                        kHalfAnOrder, "theory: k + m, m = 3; finite h"});
    if (progress && !progress(0.3 + 0.1 * (k - 4), "convergence")) throw Interrupted{};
  }
  {
    Chain c = helix_on_mesh(helix, tube, 7, 3);
    if (!c.solve_adaptive(at(0), tight_newton(), 1e-11).converged) throw std::runtime_error("the helix was not solved");
    const auto error = error_of(values_of(c), closed);
    out.rows.push_back({"free helix at 1e-11: relative error of δ", error[0], 0.0, 1e-10, "closed form (II.3.14)"});
    out.rows.push_back({"free helix at 1e-11: relative error of F", error[1], 0.0, 1e-10, "closed form (II.3.9)"});
  }
  continuation::StudyOptions options;
  options.solve.tolerance = 1e-10;
  const segmentation::Problem problem = sagging_rod();
  const continuation::Result r = continuation::solve(problem, options);
  const auto mechanics = std::make_shared<Mechanics>(problem);
  Chain reference;
  if (r.status != continuation::Status::converged || !reference.restore(r.steps.at(0).state, mechanics) ||
      !reference.solve_adaptive(at(0), tight_newton(), 1e-13).converged)
    throw std::runtime_error("the sagging rod was not found");
  const Values exact = values_of(reference);
  out.data.push_back(convergence);

  Data adaptive{"adaptive",
                {"k", "asked", "pieces N", "error of delta [relative]", "error of F [relative]"},
                std::vector<std::vector<double>>(5)};
  Panel count = panel_of("adaptive knots", "error asked [-]", "pieces N [-]"),
        kept = panel_of("error met", "error asked [-]", "relative error [-]");
  double largest_share = 0;
  for (int k = 4; k <= 7; ++k) {
    Curve n, e;
    n.label = e.label = "k = " + std::to_string(k);
    n.mark = e.mark = drawing::Mark::circle;
    for (const double asked : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11}) {
      Chain c = on_mesh(reference, k, 3);
      if (!c.solve_adaptive(at(0), tight_newton(), asked).converged)
        throw std::runtime_error("an adaptive mesh was not solved");
      const auto error = error_of(values_of(c), exact);
      const double worst = std::max(error[0], error[1]);
      largest_share = std::max(largest_share, worst / asked);
      const double row[] = {double(k), asked, double(c.segment(0).pieces()), error[0], error[1]};
      for (std::size_t i = 0; i < 5; ++i) adaptive.value[i].push_back(row[i]);
      n.x.push_back(asked);
      n.y.push_back(c.segment(0).pieces());
      e.x.push_back(asked);
      e.y.push_back(worst);
    }
    count.curves.push_back(n);
    kept.curves.push_back(e);
    if (progress && !progress(0.7 + 0.05 * (k - 4), "adaptive knots")) throw Interrupted{};
  }
  Curve asked;
  asked.x = asked.y = {1e-11, 1e-4};
  asked.line = drawing::Line::dotted;
  asked.colour = 7;
  asked.label = "asked";
  kept.curves.push_back(asked);
  out.rows.push_back({"adaptive knots, k = 4..7, 1e-4 to 1e-11: largest error over error asked", largest_share, 0.0,
                      1.0, "finest mesh; at most 1"});
  out.data.push_back(adaptive);
  for (Panel* p : {&shape, &force, &count, &kept}) p->x_log = p->y_log = true;
  for (Panel* p : {&shape, &force}) p->y_range = {{1e-15, 1e-1}};
  Picture picture{
      "meshes",
      "Top: the free helix on uniform meshes with k Gauss points a piece, against its closed form. Bottom: a "
      "twisted, sagging rod on meshes that adapt to the error asked, against the finest mesh.",
      {}};
  picture.figure.panels = {shape, force, count, kept};
  out.pictures.push_back(picture);
}

}  // namespace tendril::reproduce::methods

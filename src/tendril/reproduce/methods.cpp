// Methods named in the thesis (IV.1) and its future work (V.3), each beside the default on the same states: nested
// procedures with sensitivities and with Broyden's update, residual line search, meshes by k and N, adaptive knots, and
// the solution as B-splines. L = B = 1.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "tendril/closed_form/helix.hpp"
#include "tendril/collocation/b_splines.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/reproduce/helical_conduit_detail.hpp"
#include "tendril/reproduce/systems.hpp"
#include "tendril/segmentation/nested.hpp"
#include "tendril/segmentation/pattern_checks.hpp"

namespace tendril::reproduce {
namespace {

using conduit::Conduit;
using drawing::Curve;
using drawing::Panel;
using formulation::FreeRod;
using segmentation::Chain;
using segmentation::Closure;
using segmentation::Mechanics;

constexpr double kTight = 1e-11;      // meshes of the solutions that are compared
constexpr double kAgreement = 1e-10;  // of two methods on such meshes
constexpr int kPlaces = 1001;         // where solutions are compared

Closure at(double p) { return {Closure::Kind::parameter, 0, p}; }

segmentation::NewtonOptions tight_newton() {
  segmentation::NewtonOptions o;
  o.tolerance = 1e-13;
  return o;
}

double rod_length(const Chain& c) {
  const auto& s = c.segment(c.segments() - 1);
  return s.state(s.pieces())[s.states() - 1];
}

/// A state of the helical conduit from nothing, at T = load |T0|.
Chain conduit_state(const Conduit& conduit, double clearance, double load) {
  const double T = load * conduit.unit;
  continuation::StudyOptions options;
  options.solve.tolerance = 1e-9;
  const continuation::Result r = continuation::solve(conduit.problem(clearance, T), options);
  Chain chain;
  if (r.status != continuation::Status::converged ||
      !chain.restore(r.steps.at(0).state, std::make_shared<Mechanics>(conduit.problem(clearance, T), T)))
    throw std::runtime_error("the state of the helical conduit was not found: " + r.message);
  return chain;
}

// ---- nested procedures, Broyden's update, line search ----

struct Count {
  std::string method;
  int newton = 0, factorisations = 0, propagations = 0, jacobians = 0;
};

void compare_solvers(Outcome& out, const Conduit& conduit, Data& table, const std::string& name, double clearance,
                     double before, double load) {
  const double target = load * conduit.unit;
  const Chain start = conduit_state(conduit, clearance, before);
  Chain whole = start, searched = start;
  const auto note = [&](double method, const Count& c) {
    const double row[] = {
        clearance,          before, load, method, double(c.newton), double(c.factorisations), double(c.propagations),
        double(c.jacobians)};
    for (std::size_t i = 0; i < table.value.size(); ++i) table.value[i].push_back(row[i]);
  };
  const auto s = whole.solve_adaptive(at(target), tight_newton(), kTight);
  if (!s.converged) throw std::runtime_error("the chain was not solved: " + s.reason);
  note(0, {"", s.iterations, s.factorisations, 0, 0});
  const auto same = [&](const std::string& what, const Chain& c) {
    out.rows.push_back({name + ", " + what + ": ℓ/L", rod_length(c), rod_length(whole), kAgreement * rod_length(whole),
                        "Newton over the chain"});
    double computed = 0, expected = 0;
    for (int k = 0; k + 1 < c.segments(); ++k) {
      computed += segmentation::reaction(c, k);
      expected += segmentation::reaction(whole, k);
    }
    // A reaction is a difference of forces that come from third derivatives.
    out.rows.push_back({name + ", " + what + ": concentrated reactions [B/L²]", computed, expected,
                        100 * kAgreement * std::abs(expected), "Newton over the chain"});
  };
  auto line_search = tight_newton();
  line_search.residual_line_search = true;
  const auto l = searched.solve_adaptive(at(target), line_search, kTight);
  if (!l.converged) throw std::runtime_error("the residual line search found no state: " + l.reason);
  note(1, {"", l.iterations, l.factorisations, 0, 0});
  same("residual line search (Algs. IV.2-3)", searched);
  for (const bool broyden : {false, true}) {
    segmentation::SequenceOptions options;
    options.newton = tight_newton();
    options.newton.tolerance = 1e-12;
    options.accuracy = kTight;
    options.broyden = broyden;
    Chain nested = start;
    const auto q = segmentation::solve_sequence(nested, target, options);
    if (!q.converged) throw std::runtime_error("SolveSequence found no state: " + q.reason);
    note(broyden ? 3 : 2, {"", q.iterations, q.factorisations, q.propagations, q.jacobians});
    same(broyden ? "SolveSequence with Broyden's update" : "SolveSequence (Algs. IV.4-5)", nested);
    char text[200];
    std::snprintf(text, sizeof text,
                  "%s, SolveSequence%s: %d propagations, %d Jacobians, %d factorisations; one Newton over the chain: "
                  "%d factorisations.",
                  name.c_str(), broyden ? " with Broyden's update" : "", q.propagations, q.jacobians, q.factorisations,
                  s.factorisations);
    out.notes.push_back(text);
  }
}

// ---- meshes ----

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

Panel panel_of(const std::string& title, const std::string& x, const std::string& y) {
  Panel p;
  p.title = title;
  p.x_label = x;
  p.y_label = y;
  return p;
}

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
    out.rows.push_back({name + ": order of F between nodes", observed_order(pieces, F, 1e-11), k + 1.0, 0.4,
                        "theory: k + m, m = 1; finite h"});
    out.rows.push_back({name + ": order of δ between nodes", observed_order(pieces, delta, 1e-12), k + 3.0, 0.4,
                        "theory: k + m, m = 3; finite h"});
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

// ---- B-splines ----

void splines(Outcome& out, const Conduit& conduit) {
  // A line contact at its sides: free, line, free.
  Chain chain = conduit_state(conduit, 1.0 / 40, -10);
  double misfit = 0, largest = 0;
  int dimension = 0, expected = 0;
  Data file{"b_splines",
            {"segment", "component", "order", "knot S [L]", "control point"},
            std::vector<std::vector<double>>(5)};
  Panel drawn = panel_of("δ_1 of the first free part with its control points", "S [L]", "δ_1 [L]");
  for (int j = 0; j < chain.segments(); ++j) {
    const auto& segment = chain.segment(j);
    const double a = chain.S(j), b = chain.S(j + 1);
    const auto list = collocation::b_splines(segment, a, b);
    const int k = segment.points_per_piece(), N = segment.pieces();
    expected += chain.is_line(j) ? 4 * k * N + 7 : 6 * k * N + 11;
    std::vector<double> u(segment.system().inputs), q(segment.system().quadratures);
    for (std::size_t c = 0; c < list.size(); ++c) {
      dimension += static_cast<int>(list[c].control.size());
      const auto [low, high] = list[c].bounds();
      const double size = std::max({std::abs(low), std::abs(high), 1e-300});
      for (int i = 0; i <= 400; ++i) {
        const double S = a + (b - a) * i / 400;
        segment.evaluate(S, a, b, u.data(), q.data());
        misfit = std::max(misfit, std::abs(list[c].value(S) - u[segment.system().first[c]]) / size);
      }
      for (std::size_t i = 0; i < list[c].knots.size(); ++i) {
        const double row[] = {double(j), double(c), double(list[c].order), list[c].knots[i],
                              i < list[c].control.size() ? list[c].control[i] : NAN};
        for (std::size_t f = 0; f < 5; ++f) file.value[f].push_back(row[f]);
      }
    }
    if (chain.is_line(j)) continue;
    const double high = collocation::squared_norm_bounds(segment, 0, 1, a, b, 1e-14).second;
    largest = std::max(largest, std::sqrt(high));
    if (j != 0) continue;
    Curve curve, control;
    curve.label = "solution";
    control.label = "control points";
    control.line = drawing::Line::dotted;
    control.mark = drawing::Mark::circle;
    control.mark_size = 5;
    const auto& spline = list[0];
    for (int i = 0; i <= 400; ++i) {
      curve.x.push_back(a + (b - a) * i / 400);
      curve.y.push_back(spline.value(curve.x.back()));
    }
    for (std::size_t i = 0; i < spline.control.size(); ++i) {
      double greville = 0;
      for (int m = 1; m < spline.order; ++m)
        greville += spline.knots[i + static_cast<std::size_t>(m)] / (spline.order - 1);
      control.x.push_back(greville);
      control.y.push_back(spline.control[i]);
    }
    drawn.curves = {curve, control};
  }
  out.rows.push_back(
      {"B-splines: largest difference from the solution, relative", misfit, 0.0, 1e-11, "exact conversion, rounding"});
  out.rows.push_back({"B-splines: control points of free | line | free", double(dimension), double(expected), 0.0,
                      "6kN+11 and 4kN+7 (IV.1.5-6)"});
  // The free parts touch the wall at the ends of the line only: their largest |δ| is the clearance itself.
  out.rows.push_back(
      {"B-splines: bound of |δ|/ε over the free parts", largest * 40, 1.0, 1e-8, "no penetration between nodes"});
  out.data.push_back(file);
  Picture picture{
      "b_splines",
      "The solution as a B-spline of order k + 3 with two continuous derivatives: rod in the helical conduit, "
      "ε/L = 1/40, T = -10 |T0|, from the clamp to the contact.",
      {}};
  picture.figure.columns = 1;
  picture.figure.panel_width = 640;
  picture.figure.panels = {drawn};
  out.pictures.push_back(picture);
}

Outcome compute(const Progress& progress) {
  Outcome out;
  const Conduit conduit;
  Data table{"solvers",
             {"epsilon [L]", "T/|T0| from", "T/|T0| to",
              "method (0 chain, 1 chain with residual line search, 2 SolveSequence, 3 with Broyden)",
              "Newton iterations", "factorisations", "propagations", "Jacobians"},
             std::vector<std::vector<double>>(8)};
  const auto go_on = [&](double fraction, const char* what) {
    if (progress && !progress(fraction, what)) throw Interrupted{};
  };
  go_on(0.0, "nested procedures");
  compare_solvers(out, conduit, table, "point contact", 1.0 / 20, -1.8, -2.2);
  go_on(0.1, "nested procedures");
  compare_solvers(out, conduit, table, "line contact", 1.0 / 40, -4.0, -5.0);
  out.data.push_back(table);
  go_on(0.2, "meshes");
  meshes(out, progress);
  go_on(0.92, "B-splines");
  splines(out, conduit);
  out.notes.push_back(
      "Jacobians are exact (dual numbers) everywhere. Finite differences, the thesis' way, serve the tests only: they "
      "check the "
      "linearisation of the equations, of the collocation pieces and of the chain.");
  go_on(1.0, "done");
  return out;
}

}  // namespace

System methods_system() {
  return {
      "methods",
      "Methods of the thesis and its outlook",
      "IV.1, V.3",
      "Nested procedures, Broyden's update, residual line search, Gauss points and adaptive knots, and the solution as "
      "B-splines, on the same states as the default.",
      compute,
      3.0};
}

}  // namespace tendril::reproduce

// The small inclination approximation (II.2.4): orders of its expressions and of its solutions in the clearance ε, its
// response in the helical conduit beside the exact one, and its use as a starting guess. L = B = 1.

#include "tendril/continuation/small_inclination.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>

#include "tendril/continuation/study.hpp"
#include "tendril/formulation/free_rod.hpp"
#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/reproduce/lagrangian_conduit.hpp"
#include "tendril/reproduce/systems.hpp"

namespace tendril::reproduce {
namespace {

using continuation::Step;
using drawing::Curve;
using drawing::Panel;
using formulation::FreeRod;
using formulation::Lifted;
using formulation::Material;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kTerms = 9;
const char* const kName[kTerms] = {"ω1", "ω2", "ω3", "F1", "F2", "M3", "J1", "F1 as printed (II.2.69)", "g1"};
using Errors = std::array<double, kTerms>;

/// Largest differences between the exact expressions and the approximation on one smooth field of eccentricity ε, with
/// axis curvature K = ε or 1 times a smooth function; stretch and turn of order one.
Errors expression_errors(double eps, bool curvature_small) {
  const Material m{0.0025, 1.0 / 3.0};
  const double size = curvature_small ? eps : 1.0;
  Errors most{};
  for (int i = 0; i <= 60; ++i) {
    const double x = i / 60.0;
    const auto wave = [x](double a, double w, double phase, int d) {  // d-th derivative of a cos(w x + phase)
      return a * std::pow(w, d) * std::cos(w * x + phase + 0.5 * M_PI * d);
    };
    Lifted<double> l{};
    for (int d = 0; d < 3; ++d) l.U[d] = {size * wave(1.1, 2.2, 0.3, d), size * wave(0.9, 1.7, -0.8, d), 0.0};
    double u[17] = {};
    for (int d = 0; d <= 3; ++d) {
      u[d] = eps * wave(0.8, 3.1, 0.4, d);
      u[4 + d] = eps * wave(0.6, 2.6, 1.3, d);
      if (d < 3) u[8 + d] = wave(1.2, 1.4, 0.2, d);
      if (d < 2) u[15 + d] = wave(30.0, 1.9, 0.7, d);
    }
    const double alpha = 1 + m.eta2 * u[15], alpha1 = m.eta2 * u[16];
    const auto k = FreeRod::kinematics<double>(l, u[0], u[1], u[2], u[4], u[5], u[6]);
    double r[6], s;
    FreeRod::residual<double>(m, l, u, r, &s);  // with F1 = F2 = 0: (II.2.51-52) give α F2 and -α F1
    const double J1 = alpha * k.J1bar;
    const formulation::SmallInclination<double> a(m, l, u, u + 4, u[9], alpha, alpha1);
    const double printed = a.F1 - 2.0 * (alpha1 * u[2] + alpha * u[3]) * -1.0;  // bracket with the sign of (II.2.69)
    const double error[kTerms] = {
        a.w1 + J1 * k.h,     a.w2 - J1 * k.p,        0.0 - J1 * k.c,
        a.F1 + r[1] / alpha, a.F2 - r[0] / alpha,    a.M3 - FreeRod::twisting_moment<double>(m, k, u[15], u[9]),
        alpha - J1,          printed + r[1] / alpha, u[1] - k.t[0]};
    for (int q = 0; q < kTerms; ++q) most[q] = std::max(most[q], std::abs(error[q]));
  }
  return most;
}

std::string number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

Curve curve(const std::vector<double>& x, const std::vector<double>& y, const std::string& label, int colour,
            drawing::Line line = drawing::Line::solid, drawing::Mark mark = drawing::Mark::none) {
  Curve c;
  c.x = x, c.y = y, c.label = label, c.colour = colour, c.line = line, c.mark = mark;
  return c;
}

collocation::BvpOptions fine() {
  collocation::BvpOptions o;
  o.tolerance = 1e-11;
  o.newton_tolerance = 1e-12;
  return o;
}

continuation::SmallInclinationRod approximate(const segmentation::Problem& p) {
  auto o = continuation::small_inclination(p, fine());
  if (!o.converged) throw std::runtime_error("small inclination: " + o.reason);
  return *o.rod;
}

Step exact(const segmentation::Problem& p) {
  continuation::StudyOptions o;
  o.solve.tolerance = 1e-11;
  o.fields = true;
  o.field_points = 101;
  const auto r = continuation::solve(p, o);
  if (r.status != continuation::Status::converged) throw std::runtime_error("exact state: " + r.message);
  return r.steps.at(0);
}

/// A rod between eccentric ends in an arc: everything lateral of the order ε, curvature ε or 1.
segmentation::Problem arc(double eps, bool curvature_small) {
  segmentation::Problem p;
  p.tube.axis = geometry::make_arc(1.0 / (1.5 * (curvature_small ? eps : 1.0)), 1.0);
  p.tube.clearance = geometry::make_constant(6 * eps);
  p.rod = {1.0, 0.75, 400.0};
  p.end.kind = segmentation::End::Kind::sleeve;
  p.end_position = 1.0;
  p.start.eccentricity[0] = eps;
  p.start.eccentricity[1] = -0.5 * eps;
  p.end.eccentricity[1] = eps;
  p.end.slope[0] = -0.7 * eps;
  p.axial_value = curvature_small ? -6.0 : -6.0 * eps;  // δ = O(ε) in an arc of curvature O(1) only near F3 = 0
  p.twist_value = 2.0;
  return p;
}

constexpr int kFields = 6;
const char* const kField[kFields] = {"δ", "F1, F2", "F3", "M1, M2", "φ", "rod length"};
using FieldErrors = std::array<double, kFields>;

FieldErrors solution_errors(double eps, bool curvature_small) {
  const auto p = arc(eps, curvature_small);
  const auto a = describe(approximate(p), 101).fields;
  const Step s = exact(p);
  const auto& e = s.fields;
  FieldErrors most{};
  for (std::size_t i = 0; i < e.S.size(); ++i) {
    const double d[kFields] = {std::hypot(a.delta1[i] - e.delta1[i], a.delta2[i] - e.delta2[i]),
                               std::hypot(a.F1[i] - e.F1[i], a.F2[i] - e.F2[i]),
                               a.F3[i] - e.F3[i],
                               std::hypot(a.M1[i] - e.M1[i], a.M2[i] - e.M2[i]),
                               a.phi[i] - e.phi[i],
                               a.s.back() - s.rod_length};
    for (int q = 0; q < kFields; ++q) most[q] = std::max(most[q], std::abs(d[q]));
  }
  return most;
}

/// Errors over ε, their orders as rows, a panel of the curves.
template <std::size_t N, class F>
Panel orders(const std::string& what, const std::vector<double>& eps, const F& errors, const char* const (&name)[N],
             const std::array<double, N>& expected, const std::string& source, double tolerance, Outcome& out) {
  std::vector<std::vector<double>> value(N);
  for (double e : eps) {
    const auto x = errors(e);
    for (std::size_t q = 0; q < N; ++q) value[q].push_back(x[q]);
  }
  Panel panel;
  panel.title = what;
  panel.x_label = "ε";
  panel.y_label = "largest error";
  panel.x_log = panel.y_log = true;
  Data data{what, {"epsilon"}, {eps}};
  std::replace_if(
      data.name.begin(), data.name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  for (std::size_t q = 0; q < N; ++q) {
    const std::size_t n = eps.size();
    const double order = std::log(value[q][n - 2] / value[q][n - 1]) / std::log(eps[n - 2] / eps[n - 1]);
    if (std::isfinite(expected[q]))
      out.rows.push_back({what + ": order of the error of " + name[q], order, expected[q], tolerance, source});
    panel.curves.push_back(curve(eps, value[q], name[q], static_cast<int>(q),
                                 q < 8 ? drawing::Line::solid : drawing::Line::dashed,
                                 q < 8 ? drawing::Mark::circle : drawing::Mark::square));
    data.columns.push_back(name[q]);
    data.value.push_back(value[q]);
  }
  out.data.push_back(std::move(data));
  return panel;
}

/// Fig. II.3.2(b) with the approximation: δ1 in the middle over the load, until the wall.
Panel response(const Progress& progress, Outcome& out) {
  Panel panel;
  panel.x_label = "T/|T_0|";
  panel.y_label = "δ_1 at ξ = 1/2 [L]";
  const double T0 = helical_conduit_force();
  std::vector<double> load, approximation, truth;
  Data data{"helical_conduit_middle", {"T/|T0|", "delta1 approximate [L]", "delta1 exact [L]"}, {}};
  for (int i = 0; i <= 40; ++i) {
    if (progress && !progress(0.6 + 0.3 * i / 40, "response in the helical conduit")) throw Interrupted{};
    const double T = (-1.6 + 1.7 * i / 40) * T0;
    const auto p = helical_conduit_case(0.12, T);  // a wall far away: both stay free
    load.push_back(T / T0);
    const auto a = approximate(p);
    approximation.push_back(a.at(0.5).inputs[0]);
    segmentation::Chain c = continuation::exact_start(a);
    const auto s = c.solve_adaptive({segmentation::Closure::Kind::parameter, 0, 0.0}, {}, 1e-10);
    double u[FreeRod::inputs], length;
    if (s.converged) c.sample(0.5, u, &length);
    truth.push_back(s.converged && std::abs(u[0]) < 0.1 ? u[0] : kNaN);
  }
  panel.curves.push_back(curve(load, truth, "exact", 0));
  panel.curves.push_back(curve(load, approximation, "small inclination", 1, drawing::Line::dashed));
  for (double wall : {1.0 / 40, 1.0 / 20})
    for (double side : {-1.0, 1.0})
      panel.curves.push_back(curve({load.front(), load.back()}, {side * wall, side * wall},
                                   side > 0 && wall < 0.03 ? "walls 1/40, 1/20" : "", 7, drawing::Line::dotted));
  panel.y_range = {-0.09, 0.06};
  data.value = {load, approximation, truth};
  out.data.push_back(std::move(data));
  return panel;
}

Outcome compute(const Progress& progress) {
  Outcome out;
  const auto step = [&](double fraction, const std::string& what) {
    if (progress && !progress(fraction, what)) throw Interrupted{};
  };
  step(0.0, "orders of the expressions");
  const std::vector<double> halves = {0.08, 0.04, 0.02, 0.01, 0.005, 0.0025, 0.00125, 0.000625};
  drawing::Figure order_figure;
  order_figure.title = "Errors of the small inclination approximation";
  order_figure.panels.push_back(orders<kTerms>(
      "Expressions, K = O(ε)", halves, [](double e) { return expression_errors(e, true); }, kName,
      {3, 3, 2, 3, 3, 2, 2, 1, 3}, "order of the neglected terms, (II.2.62-73)", 0.05, out));
  order_figure.panels.push_back(orders<kTerms>(
      "Expressions, K = O(1)", halves, [](double e) { return expression_errors(e, false); }, kName,
      {1, 1, 1, 1, 1, 1, 1, 1, 2}, "order of the neglected terms, (II.2.62-73)", 0.05, out));
  step(0.05, "orders of solutions, weakly curved axis");
  const std::vector<double> solved = {0.08, 0.04, 0.02, 0.01, 0.005, 0.0025};
  order_figure.panels.push_back(orders<kFields>(
      "Solutions, K = O(ε)", solved, [](double e) { return solution_errors(e, true); }, kField, {3, 3, 4, 3, 2, 2},
      "order of the expressions", 0.1, out));
  step(0.35, "orders of solutions, curved axis");
  order_figure.panels.push_back(orders<kFields>(
      "Solutions, K = O(1)", solved, [](double e) { return solution_errors(e, false); }, kField, {1, 1, 1, 1, 1, 1},
      "order of the expressions", 0.1, out));
  out.pictures.push_back(
      {"orders",
       "Largest errors over the clearance ε: of the expressions on a given field, and of solutions of "
       "a rod between eccentric ends in an arc of curvature 1.5 ε or 1.5.",
       order_figure});
  drawing::Figure response_figure;
  response_figure.columns = 1;
  response_figure.title = "Free rod in the helical conduit";
  response_figure.panel_width = 560;
  response_figure.panels.push_back(response(progress, out));
  out.pictures.push_back(
      {"response",
       "Fig. II.3.2(b): eccentricity in the middle of the rod in the helical conduit (K = 2.22): the approximation "
       "underestimates it, so contact comes late.",
       response_figure});
  step(0.92, "starting guess");
  const double T = -1.25 * helical_conduit_force();
  const auto p = helical_conduit_case(1.0 / 20, T);
  const auto a = approximate(p);
  segmentation::Chain c = continuation::exact_start(a);
  const auto from_it = c.solve_adaptive({segmentation::Closure::Kind::parameter, 0, 0.0}, {}, 1e-10);
  if (!from_it.converged) throw std::runtime_error("from the approximation: " + from_it.reason);
  double u[FreeRod::inputs], s;
  c.sample(0.5, u, &s);
  out.rows.push_back({"exact solution started from the approximation: δ1 at ξ = 1/2 [L]", u[0], -0.0394342078, 5e-11,
                      "general-purpose solver"});
  out.notes.push_back("At T = -1.25 |T0| in the helical conduit (ε = 1/20, K = 2.22) the approximation gives δ1 = " +
                      number("%.6f", a.at(0.5).inputs[0]) + " instead of -0.039434 in the middle, rod length " +
                      number("%.6f", a.at(1.0).s) + " instead of 1.070851. From it the exact equations converge in " +
                      std::to_string(from_it.iterations) + " Newton steps, refinement of the mesh included.");
  out.notes.push_back(
      "Domain: eccentricity and inclination O(ε), axis curvature K = O(ε) in units of 1/L; there the errors of δ, F1, "
      "F2, M1, M2 are O(ε³) and those of φ and the length O(ε²). With K = O(1) forces and moments are right to O(ε) "
      "only, "
      "and δ, itself O(ε), is wrong by a factor that does not tend to one.");
  step(1.0, "done");
  return out;
}

}  // namespace

System small_inclination_system() {
  return {"small_inclination",
          "Small inclination approximation",
          "II.2.4; errata of (II.2.60), (II.2.69)",
          "Measured orders of the approximation's expressions and solutions, its domain, and its use as a guess.",
          compute,
          0.4};
}

}  // namespace tendril::reproduce

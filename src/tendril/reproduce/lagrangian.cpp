// The Lagrangian formulation (II.1) beside the Eulerian one: free, point-contact and line-contact states of the helical
// conduit found by both from their own starts, compared section by section; Fig. II.3.3. L = B = 1.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "tendril/continuation/small_inclination.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/reproduce/lagrangian_conduit.hpp"
#include "tendril/reproduce/systems.hpp"

namespace tendril::reproduce {
namespace {

using continuation::Fields;
using continuation::LagrangianRod;
using continuation::Step;
using drawing::Curve;
using drawing::Panel;

constexpr double kAsked = 1e-11;  // of both solvers, between nodes
constexpr double kAgree = 1e-9;   // of the two formulations; moments are two derivatives of the eccentricity

struct State {
  double clearance, load;  // ε, T/|T0|
  Touch touch;
};
constexpr State kStates[] = {
    {1.0 / 20, -1.25, Touch::none}, {1.0 / 20, -0.5, Touch::none}, {1.0 / 40, -1.1, Touch::none},
    {1.0 / 20, -2.0, Touch::point}, {1.0 / 20, 1.0, Touch::point}, {1.0 / 40, -1.5, Touch::point},
    {1.0 / 40, 0.3, Touch::point},  {1.0 / 20, -5.0, Touch::line}, {1.0 / 20, -10.0, Touch::line},
    {1.0 / 20, 5.0, Touch::line},   {1.0 / 40, -5.0, Touch::line}, {1.0 / 40, -10.0, Touch::line},
    {1.0 / 40, 5.0, Touch::line},   {1.0 / 40, 10.0, Touch::line},
};

std::string words(const State& s) {
  char text[96];
  std::snprintf(text, sizeof text, "1/%ld, T = %g |T0|, %s", std::lround(1 / s.clearance), s.load,
                s.touch == Touch::none    ? "free"
                : s.touch == Touch::point ? "point contact"
                                          : "line contact");
  return text;
}

Step eulerian(segmentation::Problem problem, int points) {
  continuation::StudyOptions o;
  o.solve.tolerance = kAsked;
  o.fields = points > 0;
  o.field_points = points;
  const auto r = continuation::solve(problem, o);
  if (r.status != continuation::Status::converged) throw std::runtime_error("Eulerian state: " + r.message);
  return r.steps.at(0);
}

LagrangianRod lagrangian(double clearance, double T, Touch touch) {
  const LagrangianOutcome o = lagrangian_conduit(clearance, T, touch, kAsked);
  if (!o.converged) throw std::runtime_error("Lagrangian state: " + o.reason);
  return *o.rod;
}

/// Differences of the two at equal unstressed arc length: place (and closest place on the axis), force and moment over
/// their largest, angle of the directors.
struct Differences {
  std::vector<double> S, place, force, moment;
  double phi = 0.0, pressure = 0.0;
};
double largest(const std::vector<double>& v) { return *std::max_element(v.begin(), v.end()); }

Differences compare(const LagrangianRod& rod, const Fields& f) {
  Differences d;
  double F = 0.0, M = 0.0, p = 0.0;
  for (std::size_t i = 0; i < f.S.size(); ++i) {
    F = std::max(F, std::hypot(f.F1[i], f.F2[i], f.F3[i]));
    M = std::max(M, std::hypot(f.M1[i], f.M2[i], f.M3[i]));
    p = std::max(p, std::abs(f.pressure[i]));
  }
  for (std::size_t i = 0; i < f.S.size(); ++i) {
    bool beside = false;  // forces jump at a contact: its two sides are not told apart
    for (int j = 1; j < rod.segments(); ++j) beside = beside || std::abs(f.s[i] - rod.cut(j)) < 1e-7;
    if (beside) continue;
    const auto x = rod.at(f.s[i]);
    const auto v = continuation::seen_from_tube(rod.problem(), x, f.S[i]);
    d.S.push_back(f.S[i]);
    d.place.push_back(std::max(std::hypot(x.r[0] - f.x[i], x.r[1] - f.y[i], x.r[2] - f.z[i]), std::abs(v.S - f.S[i])));
    d.force.push_back(std::hypot(v.F[0] - f.F1[i], v.F[1] - f.F2[i], v.F[2] - f.F3[i]) / F);
    d.moment.push_back(std::hypot(v.M[0] - f.M1[i], v.M[1] - f.M2[i], v.M[2] - f.M3[i]) / M);
    d.phi = std::max(d.phi, std::abs(std::remainder(v.phi - f.phi[i], 2 * M_PI)));
    if (x.line) d.pressure = std::max(d.pressure, std::abs(-x.pressure - f.pressure[i]) / p);
  }
  return d;
}

/// Load where the pressure in the middle of the line contact vanishes, by the secant rule.
double lift_off(double clearance, double T0) {
  LagrangianRod rod = lagrangian(clearance, -20.0 * T0, Touch::line);
  collocation::BvpOptions o;
  o.tolerance = kAsked;
  const auto pressure = [&](double T) {
    const auto s = rod.solve_force(T, o);
    if (!s.converged) throw std::runtime_error("lift-off: " + s.reason);
    return rod.at(1, 0.5).pressure;
  };
  double a = -24.0 * T0, b = -24.5 * T0, fa = pressure(a), fb = pressure(b);
  for (int it = 0; it < 12 && std::abs(b - a) > 1e-10 * T0; ++it) {
    const double c = b - fb * (b - a) / (fb - fa);
    a = b, fa = fb;
    b = c, fb = pressure(c);
  }
  return b / T0;
}

/// Columns of Fig. II.3.3 over S: components in the directors.
struct Columns {
  std::vector<double> S;
  std::array<std::vector<double>, 8> value;  // δ1, δ2, F1..F3, M1..M3
  void add(double place, double d1, double d2, double phi, const std::array<double, 3>& F,
           const std::array<double, 3>& M) {
    const double c = std::cos(phi), s = std::sin(phi);
    S.push_back(place);
    const double row[8] = {
        d1, d2, c * F[0] + s * F[1], c * F[1] - s * F[0], F[2], c * M[0] + s * M[1], c * M[1] - s * M[0], M[2]};
    for (int i = 0; i < 8; ++i) value[i].push_back(row[i]);
  }
  void add(const Fields& f) {
    for (std::size_t i = 0; i < f.S.size(); ++i)
      add(f.S[i], f.delta1[i], f.delta2[i], f.phi[i], {f.F1[i], f.F2[i], f.F3[i]}, {f.M1[i], f.M2[i], f.M3[i]});
  }
};

Curve curve(const std::vector<double>& x, const std::vector<double>& y, const std::string& label, int colour,
            drawing::Line line = drawing::Line::solid, drawing::Mark mark = drawing::Mark::none) {
  Curve c;
  c.x = x, c.y = y, c.label = label, c.colour = colour, c.line = line, c.mark = mark;
  return c;
}

void figure_II33(const LagrangianRod& rod, const Fields& exact, double T, Outcome& out) {
  collocation::BvpOptions o;
  o.tolerance = 1e-10;
  const auto small = continuation::small_inclination(helical_conduit_case(1.0 / 20, T), o);
  if (!small.converged) throw std::runtime_error("small inclination: " + small.reason);
  Columns e, a, l;
  e.add(exact);
  a.add(describe(*small.rod, 201).fields);
  constexpr int circles = 21;
  for (int i = 0; i < circles; ++i) {
    const double S = i / (circles - 1.0);
    const auto v = continuation::seen_from_tube(rod.problem(), rod.at_place(S), S);
    l.add(S, v.delta1, v.delta2, v.phi, v.F, v.M);
  }
  static const char* const label[8] = {"δ_1 [L]",    "δ_2 [L]",   "F_1 [B/L²]", "F_2 [B/L²]",
                                       "F_3 [B/L²]", "M_1 [B/L]", "M_2 [B/L]",  "M_3 [B/L]"};
  drawing::Figure figure;
  figure.title = "Rod in a helical conduit at T = -1.25 |T_0| (Fig. II.3.3)";
  figure.panel_width = 400;
  figure.panel_height = 230;
  for (int i = 0; i < 8; ++i) {
    Panel p;
    p.x_label = "ξ = S/L";
    p.y_label = label[i];
    if (i == 7) p.y_range = {-1.1, -0.9};  // constant
    p.curves.push_back(curve(e.S, e.value[i], i == 0 ? "Eulerian, exact" : "", 0));
    p.curves.push_back(curve(a.S, a.value[i], i == 0 ? "small inclination" : "", 1, drawing::Line::dashed));
    p.curves.push_back(
        curve(l.S, l.value[i], i == 0 ? "Lagrangian" : "", 2, drawing::Line::none, drawing::Mark::circle));
    figure.panels.push_back(std::move(p));
  }
  out.pictures.push_back({"figure_II_3_3",
                          "Eccentricity, and force and moment in the directors, of the free rod at clearance 1/20, "
                          "M3 = -1: Eulerian (lines), Lagrangian (circles), small inclination approximation (dashes).",
                          figure});
  static const char* const formulation[3] = {"eulerian", "small_inclination", "lagrangian"};
  const Columns* const all[3] = {&e, &a, &l};
  for (int k = 0; k < 3; ++k) {
    Data d;
    d.name = std::string("figure_II_3_3_") + formulation[k];
    d.columns = {"S [L]",      "delta1 [L]", "delta2 [L]", "F1 [B/L^2]", "F2 [B/L^2]",
                 "F3 [B/L^2]", "M1 [B/L]",   "M2 [B/L]",   "M3 [B/L]"};
    d.value.push_back(all[k]->S);
    for (const auto& v : all[k]->value) d.value.push_back(v);
    out.data.push_back(std::move(d));
  }
}

void difference_picture(const std::vector<std::pair<State, Differences>>& shown, Outcome& out) {
  drawing::Figure figure;
  figure.title = "Eulerian minus Lagrangian";
  for (const auto& [state, d] : shown) {
    Panel p;
    p.title = "clearance " + words(state);
    p.x_label = "ξ = S/L";
    p.y_label = "difference";
    p.y_log = true;
    p.y_range = {1e-17, 1e-9};
    const auto floor = [](std::vector<double> v) {
      for (double& x : v) x = std::max(x, 1e-17);
      return v;
    };
    p.curves.push_back(curve(d.S, floor(d.place), "place [L]", 0));
    p.curves.push_back(curve(d.S, floor(d.force), "force, of the largest", 1));
    p.curves.push_back(curve(d.S, floor(d.moment), "moment, of the largest", 2));
    figure.panels.push_back(std::move(p));
  }
  out.pictures.push_back(
      {"differences", "Differences of the two formulations along the rod; both asked 1e-11.", figure});
}

Outcome compute(const Progress& progress) {
  Outcome out;
  const auto step = [&](double fraction, const std::string& what) {
    if (progress && !progress(fraction, what)) throw Interrupted{};
  };
  const double T0 = helical_conduit_force();
  const std::string twin = "Eulerian twin, both at 1e-11";
  {
    step(0.0, "rod on the axis");
    const LagrangianRod rod = lagrangian(1.0 / 20, -T0, Touch::none);
    double most = 0.0;
    for (int i = 0; i <= 100; ++i) {
      const auto v = continuation::seen_from_tube(rod.problem(), rod.at(rod.length() * i / 100), i / 100.0);
      most = std::max(most, std::hypot(v.delta1, v.delta2));
    }
    out.rows.push_back({"largest eccentricity at T0 = -7.0690330 B/L² [L]", most, 0.0, 1e-10, "closed form (II.3.19)"});
  }
  std::vector<std::pair<State, Differences>> shown;
  Data table{"states",
             {"clearance [L]", "T/|T0|", "contact (0 none, 1 point, 2 line)", "rod length [L]", "place difference [L]",
              "force difference", "moment difference", "phi difference [rad]", "pressure difference"},
             std::vector<std::vector<double>>(9)};
  const int n = static_cast<int>(std::size(kStates));
  for (int i = 0; i < n; ++i) {
    const State& s = kStates[i];
    step(0.05 + 0.8 * i / n, "clearance " + words(s));
    const Step e = eulerian(helical_conduit_case(s.clearance, s.load * T0), 201);
    const LagrangianRod rod = lagrangian(s.clearance, s.load * T0, s.touch);
    const Differences d = compare(rod, e.fields);
    const std::string of = words(s) + ": ";
    out.rows.push_back({of + "place, largest difference [L]", largest(d.place), 0.0, kAgree, twin});
    out.rows.push_back({of + "force, of the largest", largest(d.force), 0.0, kAgree, twin});
    out.rows.push_back({of + "moment, of the largest", largest(d.moment), 0.0, kAgree, twin});
    out.rows.push_back({of + "φ [rad]", d.phi, 0.0, kAgree, twin});
    out.rows.push_back({of + "rod length [L]", rod.length(), e.rod_length, kAgree, twin});
    if (s.touch == Touch::point)
      out.rows.push_back({of + "reaction [B/L²]", std::abs(rod.jump(1)), e.contacts.at(0).force, 1e-9, twin});
    if (s.touch == Touch::line) {
      out.rows.push_back(
          {of + "end reaction [B/L²]", std::abs(rod.jump(1)), *e.contacts.at(0).force_start, 1e-9, twin});
      out.rows.push_back({of + "begin of the contact s [L]", rod.cut(1), e.contacts.at(0).s_start, kAgree, twin});
      out.rows.push_back({of + "pressure, of the largest", d.pressure, 0.0, 1e-9, twin});
    }
    const double row[] = {s.clearance,
                          s.load,
                          static_cast<double>(s.touch),
                          rod.length(),
                          largest(d.place),
                          largest(d.force),
                          largest(d.moment),
                          d.phi,
                          d.pressure};
    for (int c = 0; c < 9; ++c) table.value[c].push_back(row[c]);
    if (i == 0) {
      const auto middle = continuation::seen_from_tube(rod.problem(), rod.at_place(0.5), 0.5);
      const auto quarter = continuation::seen_from_tube(rod.problem(), rod.at_place(0.25), 0.25);
      const std::string other = "general-purpose solver";
      out.rows.push_back({of + "δ1 at ξ = 1/2 [L]", middle.delta1, -0.0394342078, 5e-11, other});
      out.rows.push_back({of + "δ2 at ξ = 1/4 [L]", quarter.delta2, 0.0013138644, 5e-11, other});
      figure_II33(rod, e.fields, s.load * T0, out);
    }
    if (i == 0 || i == 3 || i == 8 || i == 13) shown.emplace_back(s, d);
  }
  difference_picture(shown, out);
  out.data.push_back(std::move(table));

  step(0.88, "fixed length");
  {
    LagrangianRod rod = lagrangian(1.0 / 20, -2.0 * T0, Touch::point);
    collocation::BvpOptions o;
    o.tolerance = kAsked;
    const auto s = rod.solve_length(1.12, o);
    if (!s.converged) throw std::runtime_error("fixed length: " + s.reason);
    segmentation::Problem p = helical_conduit_case(1.0 / 20, 0.0);
    p.axial = segmentation::AxialControl::rod_length;
    p.axial_value = 1.12;
    const Step e = eulerian(p, 0);
    out.rows.push_back(
        {"1/20, length held at 1.12 L: end force [B/L²]", rod.axial_value(), e.axial_force_end, 1e-8, twin});
  }
  step(0.92, "lift-off of the middle");
  const double lift = lift_off(1.0 / 20, T0);
  out.rows.push_back({"1/20, lift-off of the middle, T/|T0|", lift, -24.3653829, 5e-8, "general-purpose solver"});
  out.rows.push_back({"1/20, lift-off of the middle, T/|T0|", lift, -24.37, 5e-3, "thesis IV.2, printed"});
  out.notes.push_back(
      "Every Lagrangian state is reached from the rod on the axis, every Eulerian one from the solver's own cold "
      "start; "
      "of the several states a load may have, both are the one symmetric about the middle.");
  step(1.0, "done");
  return out;
}

}  // namespace

System lagrangian_system() {
  return {"lagrangian",
          "Lagrangian formulation",
          "II.1; Fig. II.3.3",
          "The world-frame Cosserat rod solved on its own, and its differences from the Eulerian formulation.",
          compute,
          1.7};
}

}  // namespace tendril::reproduce

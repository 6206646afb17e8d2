// Straight conduit (II.3.2): helices, free and along the wall, extensible, and the Eulerian solver on the same states;
// Fig. II.3.1 with its fold; the localized twisted rod; Euler's and Greenhill's loads as branch points of a path.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tendril/closed_form/columns.hpp"
#include "tendril/closed_form/helix.hpp"
#include "tendril/closed_form/localized_rod.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/reproduce/body.hpp"
#include "tendril/reproduce/straight_conduit_states.hpp"
#include "tendril/reproduce/systems.hpp"

namespace tendril::reproduce {
namespace {

using namespace straight_conduit;
using closed_form::Helix;
using drawing::Curve;
using drawing::Panel;
using segmentation::Scalar;
constexpr double pi = std::numbers::pi;
constexpr double exact = 1e-10;  // closed forms at a solver tolerance of 1e-11
constexpr double pitch = pi / 5;

Curve styled(std::string label, int colour, drawing::Line line = drawing::Line::solid,
             drawing::Mark mark = drawing::Mark::none) {
  Curve c;
  c.label = std::move(label);
  c.colour = colour;
  c.line = line;
  c.mark = mark;
  c.mark_size = 7;
  return c;
}

// ---- helices ----

/// m = M/√T of the free helix (II.3.15), and Γ = δ√T (II.3.14).
struct Loading {
  double m, Gamma;
};
Loading free_helix(double theta, double eta_over_delta) {
  const double c = std::cos(theta), s = std::sin(theta);
  const double alpha = 1.0 / (1.0 - eta_over_delta * eta_over_delta * s * s * c);
  return {(1.0 + c) * std::sqrt(alpha), s * std::sqrt(alpha)};
}

void helix_rows(std::vector<Row>& rows) {
  const double delta = 0.1;
  // printed in the corrected model: (η/δ)², δM, δ²T, m at θ = π/5
  const struct {
    double ratio2, moment, pull, m;
  } printed[]{{0.0, 1.06331351, 0.34549150, 1.80901699},
              {0.25, 1.14319682, 0.37144716, 1.87573933},
              {1.0, 1.47581686, 0.47952197, 2.13121967}};
  constexpr double digits = 5e-9;
  for (const auto& p : printed) {
    const double eta = delta * std::sqrt(p.ratio2);
    const std::string name = "free helix, θ = π/5, (η/δ)² = " + std::to_string(p.ratio2).substr(0, 4) + ": ";
    const SolvedHelix solved =
        solve_helix({delta, pitch}, closed_form::free_homoclinic_helix({delta, pitch}, eta), eta, false, false);
    const double M = solved.moment_along_axis, T = solved.force_along_axis;
    rows.push_back({name + "δM/B", delta * M, p.moment, digits, "(II.3.14), printed digits"});
    rows.push_back({name + "δ²T/B", delta * delta * T, p.pull, digits, "(II.3.14), printed digits"});
    rows.push_back({name + "m = M/√(BT)", M / std::sqrt(T), p.m, digits, "(II.3.15), printed digits"});
    rows.push_back(
        {name + "m = M/√(BT)", M / std::sqrt(T), free_helix(pitch, std::sqrt(p.ratio2)).m, 2 * exact, "(II.3.15)"});
    rows.push_back(
        {name + "largest difference of place and forces between nodes", solved.difference, 0.0, exact, "(II.3.5-11)"});
    rows.push_back({name + "unstressed length ℓ/L", solved.rod_length, solved.exact_length, exact, "1/(α cosθ)"});
  }
  // along the wall: outside or inside according to the pull
  for (const double ratio2 : {0.0, 0.25})
    for (const double Gamma : {0.45, 0.9}) {
      const double eta = delta * std::sqrt(ratio2), pull = Gamma * Gamma / (delta * delta);
      const auto state = closed_form::homoclinic_helix({delta, pitch}, pull, eta);
      const bool around = state.rho > 0.0;
      const std::string name = "helix " + std::string(around ? "around" : "inside") +
                               " the wall, Γ = " + std::to_string(Gamma).substr(0, 4) +
                               ", (η/δ)² = " + std::to_string(ratio2).substr(0, 4) + ": ";
      const SolvedHelix solved = solve_helix({delta, pitch}, state, eta, true, around);
      const double c = std::cos(pitch), s = std::sin(pitch), G2 = Gamma * Gamma;
      const double m = s * (1 + c) * (c + ratio2 * G2) / (Gamma * (c + ratio2 * s * s * s * s));
      const double pressure = m * m * (G2 - (1 + ratio2 * G2 * c) * s * s) / ((1 + c) * (1 + c) * (c + ratio2 * G2));
      rows.push_back(
          {name + "m", solved.moment_along_axis / std::sqrt(solved.force_along_axis), m, 10 * exact, "(II.3.17)"});
      rows.push_back({name + "ρδ/T", solved.pressure * delta / pull, pressure, 10 * exact, "(II.3.18)"});
      rows.push_back({name + "largest difference of angle and forces between nodes", solved.difference, 0.0, exact,
                      "(II.3.5-13)"});
    }
}

/// θ where (II.3.15) is stationary: the derivative of m² changes sign (bisection on it).
double fold_angle(double eta_over_delta) {
  const double r = eta_over_delta * eta_over_delta;
  const auto slope = [r](double theta) {
    const double c = std::cos(theta), s = std::sin(theta);
    return -2 * (1 - r * s * s * c) + (1 + c) * r * (2 * c * c - s * s);  // of the sign of dm²/dθ
  };
  double low = 0.0, high = pi / 2;  // rises at first where η/δ > 1/√2, falls in the end
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (slope(middle) > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double fold_loading(double theta) {
  return (1 + std::cos(theta)) /
         std::sqrt((1 + 3 * std::cos(2 * theta)) / (4 * std::cos(theta) + std::cos(2 * theta) - 1));
}

void fold_rows(std::vector<Row>& rows) {
  for (const double ratio : {0.75, 1.0, 1.25}) {
    const double theta = fold_angle(ratio);
    rows.push_back({"Fig. II.3.1, η/δ = " + std::to_string(ratio).substr(0, 4) + ": largest m of the free helix",
                    free_helix(theta, ratio).m, fold_loading(theta), 1e-12, "(II.3.16)"});
  }
}

Panel angle_panel(std::vector<Panel>& panels, Data& data) {
  Panel by_angle, by_radius;
  by_angle.title = "pitch angle of the free helix";
  by_angle.x_label = by_radius.x_label = "m = M/√(BT) [-]";
  by_angle.y_label = "θ/π [-]";
  by_radius.title = "its radius";
  by_radius.y_label = "Γ = δ √(T/B) [-]";
  by_angle.x_range = by_radius.x_range = {{0.8, 3.2}};
  by_angle.y_range = {{0.0, 0.5}};
  by_radius.y_range = {{0.0, 2.0}};
  const double ratios[]{0.0, 0.5, 0.75, 1.0, 1.25};
  const char* labels[]{"η/δ = 0", "1/2", "3/4", "1", "5/4"};
  Curve circles = styled("θ = π/5", 6, drawing::Line::none, drawing::Mark::circle), circles2 = circles;
  circles2.label.clear();
  for (int k = 0; k < 5; ++k) {
    Curve a = styled(labels[k], k), b = styled("", k);
    for (int i = 0; i <= 200; ++i) {
      const double theta = 0.5 * pi * i / 200;
      const double s = std::sin(theta);
      if (1.0 - ratios[k] * ratios[k] * s * s * std::cos(theta) <= 1e-3) continue;
      const Loading l = free_helix(theta, ratios[k]);
      a.x.push_back(l.m);
      a.y.push_back(theta / pi);
      b.x.push_back(l.m);
      b.y.push_back(l.Gamma);
      data.value[0].push_back(ratios[k]);
      data.value[1].push_back(theta);
      data.value[2].push_back(l.m);
      data.value[3].push_back(l.Gamma);
    }
    by_angle.curves.push_back(a);
    by_radius.curves.push_back(b);
    const Loading l = free_helix(pitch, ratios[k]);
    circles.x.push_back(l.m);
    circles.y.push_back(pitch / pi);
    circles2.x.push_back(l.m);
    circles2.y.push_back(l.Gamma);
  }
  Curve fold = styled("folds (II.3.16)", 6, drawing::Line::dashed), fold2 = styled("", 6, drawing::Line::dashed);
  for (int i = 0; i <= 120; ++i) {
    const double theta = (0.5 * std::acos(-1.0 / 3.0) - 1e-4) * i / 120, c = std::cos(theta), s = std::sin(theta);
    const double r = 2.0 / (c * c * c + 3 * c * c + c - 1.0);  // dm/dθ = 0 in (II.3.15)
    if (1.0 - r * s * s * c <= 0.0) break;
    fold.x.push_back(fold_loading(theta));
    fold.y.push_back(theta / pi);
    fold2.x.push_back(fold_loading(theta));
    fold2.y.push_back(s / std::sqrt(1.0 - r * s * s * c));
  }
  by_angle.curves.push_back(fold);
  by_angle.curves.push_back(circles);
  by_radius.curves.push_back(fold2);
  by_radius.curves.push_back(circles2);
  panels.push_back(by_angle);
  return by_radius;
}

// ---- localized rod ----

void localized_rows(std::vector<Row>& rows, std::vector<Panel>& panels, Data& data) {
  // between places of the closed form: the same boundary value problem exactly
  const closed_form::LocalizedRod rod = localized(1.8, 10.0);
  const SolvedLocalized inside = solve_localized(rod, true);
  rows.push_back({"localized rod, m = 1.8, ends on the closed form: largest difference of place [1/√T]",
                  inside.difference * std::sqrt(rod.pull), 0.0, 1e-8, "sin(θ/2) = a sech(a √T s)"});
  rows.push_back({"localized rod, m = 1.8, ends on the closed form: d3·D3 in the middle", inside.cosine_in_the_middle,
                  std::cos(rod.steepest()), 1e-8, "cos θ = 1 - 2 a²"});
  // clamped on the axis, longer and longer
  const double domains[]{8.0, 10.0, 12.0};
  double fault[3];
  for (int i = 0; i < 3; ++i) {
    const closed_form::LocalizedRod long_rod = localized(1.8, domains[i]);
    const SolvedLocalized s = solve_localized(long_rod, false);
    fault[i] = std::abs(s.shortening / long_rod.shortening() - 1.0);
    rows.push_back(
        {"localized rod clamped on the axis at a √T Z = " + std::to_string(int(domains[i])) + ": shortening √T/4a",
         s.shortening * std::sqrt(long_rod.pull) / 4.0 / (long_rod.decay() / std::sqrt(long_rod.pull)), 1.0,
         200.0 * std::exp(-domains[i]), "4 a/√T; the clamps count like exp(-a √T Z)"});
  }
  rows.push_back({"localized rod: decay of that difference over a √T Z = 8 to 12", std::log(fault[0] / fault[2]) / 4.0,
                  1.0, 0.3, "order exp(-a √T Z)"});
  Panel shape;
  shape.title = "localized rod, m = 1.8";
  shape.x_label = "along the axis, z √T [-]";
  shape.y_label = "eccentricity δ √T [-]";
  Curve d1 = styled("δ_1, solved", 0), d2 = styled("δ_2, solved", 1),
        form = styled("closed form", 6, drawing::Line::none, drawing::Mark::circle);
  form.mark_size = 4;
  const double root = std::sqrt(rod.pull);
  for (std::size_t i = 0; i < inside.S.size(); ++i) {
    const double z = (inside.S[i] - 0.5) * root;
    d1.x.push_back(z);
    d1.y.push_back(inside.delta1[i] * root);
    d2.x.push_back(z);
    d2.y.push_back(inside.delta2[i] * root);
    if (i % 8 == 0)
      for (const double y : {inside.exact1[i], inside.exact2[i]}) {
        form.x.push_back(z);
        form.y.push_back(y * root);
      }
    const double row[]{z, inside.delta1[i] * root, inside.delta2[i] * root, inside.exact1[i] * root,
                       inside.exact2[i] * root};
    for (int q = 0; q < 5; ++q) data.value[q].push_back(row[q]);
  }
  shape.curves = {d1, d2, form};
  panels.push_back(shape);
}

// ---- branch points ----

segmentation::Problem on_the_axis(double EA) {
  segmentation::Problem p;
  p.tube.axis = geometry::make_straight(1.0);
  p.tube.clearance = geometry::make_constant(0.05);
  p.rod = {1.0, 0.75, {}};
  if (EA > 0.0) p.rod.axial_stiffness = EA;
  p.end.kind = segmentation::End::Kind::sleeve;
  p.end_position = 1.0;
  return p;
}

std::vector<double> branch_points(const std::function<segmentation::Problem(double)>& family, double from, double to) {
  continuation::StudyOptions options;
  options.solve.branch = segmentation::BranchRule::symmetric;
  const auto r = continuation::follow(family, {from, {to}, true}, options);
  std::vector<double> found;
  for (const auto& e : r.events)
    if (e.kind == "branch_point") found.push_back(e.parameter);
  found.resize(std::max<std::size_t>(found.size(), 3), std::nan(""));
  return found;
}

Panel branch_rows(std::vector<Row>& rows, Data& data) {
  constexpr double asked = 1e-8;
  for (const double EA : {0.0, 400.0}) {
    const auto loads = branch_points(
        [EA](double P) {
          auto p = on_the_axis(EA);
          p.axial_value = Scalar(-P, -1.0);
          return p;
        },
        10, EA > 0 ? 125 : 170);
    for (int n = 1; n <= 3; ++n) {
      const double P = loads[n - 1], stretch = EA > 0 ? 1 - P / EA : 1;
      rows.push_back({"Euler's load " + std::to_string(n) + (EA > 0 ? ", EA = 400: P/α [B/L²]" : ": P [B/L²]"),
                      P / stretch, closed_form::euler_load_clamped(n, 1, 1), 100 * asked,
                      "4 z² with sin z = 0 or tan z = z"});
    }
  }
  Panel p;
  p.title = "twisted rod, clamped: where it buckles";
  p.x_label = "thrust P L²/(4π² B) [-]";
  p.y_label = "torque M L/B [-]";
  Curve first = styled("first branch point", 0, drawing::Line::none, drawing::Mark::circle),
        second = styled("second", 1, drawing::Line::none, drawing::Mark::square),
        form = styled("Greenhill, clamped", 7);
  for (const double EA : {0.0, 400.0})
    for (const double P : {-100.0, -50.0, -20.0, 0.0, 10.0, 20.0, 30.0, 35.0}) {
      if (EA > 0 && std::abs(P) > 40.0) continue;
      const auto torques = branch_points(
          [=](double M) {
            auto p = on_the_axis(EA);
            p.axial_value = -P;
            p.twist_value = Scalar(M, 1.0);
            return p;
          },
          0.5, 25);
      const double stretch = EA > 0 ? 1 - P / EA : 1;
      rows.push_back({"Greenhill's torque at P = " + std::to_string(int(P)) + " B/L²" +
                          (EA > 0 ? ", EA = 400: M L/(α B)" : ": M L/B"),
                      torques[0] / stretch, closed_form::greenhill_torque_clamped(P / stretch, 1, 1), 10 * asked,
                      "transcendental condition of the clamped rod"});
      const double row[]{EA, P, torques[0], torques[1]};
      for (int q = 0; q < 4; ++q) data.value[q].push_back(row[q]);
      if (EA > 0) continue;
      first.x.push_back(P / (4 * pi * pi));
      first.y.push_back(torques[0]);
      if (std::isfinite(torques[1])) {
        second.x.push_back(P / (4 * pi * pi));
        second.y.push_back(torques[1]);
      }
    }
  for (int i = 0; i <= 150; ++i) {
    const double P = std::min(-100.0 + (4 * pi * pi + 100.0) * i / 150, 4 * pi * pi * (1 - 1e-12));
    form.x.push_back(P / (4 * pi * pi));
    form.y.push_back(closed_form::greenhill_torque_clamped(P, 1, 1));
  }
  p.curves = {form, first, second};
  return p;
}

Outcome compute(const Progress& progress) {
  const auto report = [&](double fraction, const char* what) {
    if (progress && !progress(fraction, what)) throw Interrupted{};
  };
  Outcome out;
  Data helices{"fig_II_3_1",
               {"eta/delta", "theta [rad]", "m = M/sqrt(BT)", "Gamma = delta sqrt(T/B)"},
               std::vector<std::vector<double>>(4)};
  Data shape{"localized_rod",
             {"z sqrt(T)", "delta1 sqrt(T), solved", "delta2 sqrt(T), solved", "delta1 sqrt(T), closed form",
              "delta2 sqrt(T), closed form"},
             std::vector<std::vector<double>>(5)};
  Data loads{"greenhill",
             {"EA [B/L^2] (0: inextensible)", "thrust P [B/L^2]", "first branch point M [B/L]", "second"},
             std::vector<std::vector<double>>(4)};
  report(0.0, "helices");
  helix_rows(out.rows);
  fold_rows(out.rows);
  std::vector<Panel> figure, others;
  figure.push_back(angle_panel(figure, helices));
  report(0.3, "localized rod");
  localized_rows(out.rows, others, shape);
  report(0.5, "branch points");
  others.push_back(branch_rows(out.rows, loads));
  Picture fig{"fig_II_3_1",
              "Fig. II.3.1: the free extensible helix under pull and torque. Dashed: folds (II.3.16), where the torque "
              "that a helix of given δ/η can carry is largest. Circles: θ = π/5.",
              {}};
  fig.figure.title = "Free helix";
  fig.figure.panels = figure;
  Picture second{
      "straight_conduit",
      "Left: the localized rod of the Eulerian solver (lines) and the homoclinic closed form (circles). Right: "
      "branch points of the straight rod found along paths of growing torque, and Greenhill's condition.",
      {}};
  second.figure.title = "Twisted rod: localized state and buckling loads";
  second.figure.panels = others;
  out.pictures = {fig, second};
  out.data = {helices, shape, loads};
  out.notes = {
      "Branch points of the straight rod are double (the rod buckles in every plane), so the determinant keeps its "
      "sign; "
      "they are detected by counting unstable directions and located where the response to a fixed load has its pole.",
      "Under tension the torque meant is the twisting moment, which the clamped rod carries along its axis."};
  report(1.0, "done");
  return out;
}

}  // namespace

System straight_conduit_system() {
  return {"straight_conduit", "Straight conduit: helices, localized rod, buckling loads", "II.3.2; Fig. II.3.1",
          "Helices free and along the wall, extensible, with the fold of Fig. II.3.1; the localized rod; Euler's and "
          "Greenhill's loads found by the path follower.",
          compute};
}

}  // namespace tendril::reproduce

// Pictures of rods and strings on surfaces.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "tendril/closed_form/strings.hpp"
#include "tendril/formulation/surface_rod_problem.hpp"
#include "tendril/reproduce/surface_rods_detail.hpp"

namespace tendril::reproduce::on_surfaces {

namespace {

using namespace formulation;
constexpr double pi = std::numbers::pi;

template <class Section>
std::vector<std::array<double, 3>> places(const std::vector<Section>& sections) {
  std::vector<std::array<double, 3>> r;
  for (const auto& x : sections) r.push_back(x.r);
  return r;
}

drawing::Curve styled(int colour, double width, const std::string& label = "") {
  drawing::Curve c;
  c.colour = colour;
  c.width = width;
  c.label = label;
  return c;
}

std::string text(const char* format, double a) {
  char line[80];
  std::snprintf(line, sizeof line, format, a);
  return line;
}

}  // namespace

const std::vector<Example>& examples() {
  static const std::vector<Example> all = {{"sphere",
                                            geometry::sphere(1.0),
                                            -1.0,
                                            {-pi / 2, pi / 2, 0.0, 2 * pi},
                                            {0.5, 0.35},
                                            6,
                                            12,
                                            {0.6, -0.5, 1.2, 0.3, 0.5, 2.0, -0.7, 0.0},
                                            4.5},
                                           {"cylinder",
                                            geometry::cylinder(0.6),
                                            -1.0,
                                            {-1.2, 1.4, 0.0, 2 * pi},
                                            {0.5, 0.35},
                                            7,
                                            12,
                                            {-0.3, -0.8, 0.9, 0.4, 0.5, 1.5, -1.2, 0.0},
                                            3.2},
                                           {"torus",
                                            geometry::torus(1.0, 0.35),
                                            1.0,
                                            {0.0, 2 * pi, 0.0, 2 * pi},
                                            {-0.35, 0.6},
                                            24,
                                            10,
                                            {-0.4, 0.3, 0.5, 0.2, 0.3, 2.5, -0.7, 0.0},
                                            2.6},
                                           {"ellipsoid",
                                            geometry::ellipsoid(1.2, 0.9, 0.7),
                                            -1.0,
                                            {-pi / 2, pi / 2, 0.0, 2 * pi},
                                            {0.8, 0.45},
                                            6,
                                            12,
                                            {0.2, -0.3, 0.9, 0.8, 0.2, 1.5, -0.7, 0.0},
                                            3.6},
                                           {"graph",
                                            geometry::graph([](const auto& x, const auto& y) {
                                              return 0.3 * (sin(2.0 * x) * cos(2.0 * y)) + 0.1 * (x * y);
                                            }),
                                            1.0,
                                            {-1.6, 1.6, -1.6, 1.6},
                                            {-1.1, 0.7},
                                            12,
                                            12,
                                            {-1.2, -0.9, 0.5, 0.3, 0.2, 3.0, -0.7, 0.0},
                                            3.0}};
  return all;
}

SurfaceRod model_of(const Example& example) { return {example.surface, 0.01, 1.0 / 3.0, {0.0, 0.0, -1.5}, {}}; }

geometry::SurfacePtr hill() {
  return geometry::graph([](const auto& x, const auto& y) { return 0.8 * exp(-2.0 * (x * x + y * y)); });
}
BodyRange hill_range() { return {-1.5, 1.5, -1.5, 1.5}; }

Picture rods(Outcome& out) {
  Picture picture{"rods",
                  "A heavy, twisted, extensible rod (σ = 1.5 B/L³ downwards, M_3 = −0.7 or −1.2 B/L, η = 1/10) on five "
                  "surfaces, coloured by the pressure on it along the outward (upward) normal: where it is positive a "
                  "body inside carries the rod, where it is negative a wall outside is needed.",
                  {}};
  picture.figure.title = "Rods bound to surfaces";
  picture.figure.columns = 3;
  picture.figure.panel_width = 330.0;
  picture.figure.panel_height = 280.0;
  drawing::Panel along;
  along.title = "Pressure along the rods";
  along.x_label = "s/ℓ [-]";
  along.y_label = "outward pressure [B/L³]";
  Data table{"rods",
             {"surface", "s [L]", "x [L]", "y [L]", "z [L]", "kappa_g [1/L]", "kappa_n [1/L]", "tau_g [1/L]",
              "F_g [B/L^2]", "F_n [B/L^2]", "F_3 [B/L^2]", "M_3 [B/L]", "rho [B/L^3]"},
             std::vector<std::vector<double>>(13)};
  int number = 0;
  for (const Example& x : examples()) {
    ++number;
    const SurfaceRod rod = model_of(x);
    const auto curve = integrate_surface_rod(rod, x.start, evenly(0.0, x.length, 300));
    if (!curve.summary.completed)
      out.notes.push_back("The rod on the " + x.name + " ends early: " + curve.summary.reason);
    const int pieces = 24;
    const auto balanced = integrate_surface_rod(rod, x.start, balance_places(x.length, pieces));
    Imbalance left{HUGE_VAL, HUGE_VAL};
    if (balanced.summary.completed) left = world_imbalance(rod, balanced.section, pieces);
    out.rows.push_back({"rod on the " + x.name + ": forces in the world frame, imbalance", left.force, 0.0, exact,
                        "(II.1.12) by quadrature of weight and pressure"});
    out.rows.push_back({"rod on the " + x.name + ": moments in the world frame, imbalance", left.moment, 0.0, exact,
                        "(II.1.13) by quadrature of weight and pressure"});
    drawing::Panel panel;
    panel.title = x.name;
    const BodyView body(x.surface, x.range, x.view);
    body.draw_body(panel, x.u_lines, x.v_lines);
    drawing::Curve style = styled(0, 3.2);
    drawing::Curve pressure = styled(number - 1, 1.6, x.name);
    for (const auto& s : curve.section) {
      style.value.push_back(x.outward * s.rho);
      pressure.x.push_back(s.s / x.length);
      pressure.y.push_back(x.outward * s.rho);
      const double line[] = {double(number), s.s,   s.r[0], s.r[1], s.r[2], s.kappa_g, s.kappa_n,
                             s.tau_g,        s.F_g, s.F_n,  s.F_3,  s.M_3,  s.rho};
      for (int c = 0; c < 13; ++c) table.value[c].push_back(line[c]);
    }
    body.draw_curve(panel, places(curve.section), style);
    panel.value_label = "outward pressure [B/L³]";
    picture.figure.panels.push_back(std::move(panel));
    along.curves.push_back(std::move(pressure));
  }
  picture.figure.panels.push_back(std::move(along));
  out.data.push_back(std::move(table));
  return picture;
}

Picture rod_to_string(Outcome& out) {
  Picture picture{"rod_to_string",
                  "A rod fed through a sleeve over a hill, clamped in the direction of the chord at both ends, the end "
                  "force F_3 = T prescribed: with growing tension it approaches the geodesic (dashed) but for boundary "
                  "layers of length 1/√T at the clamps.",
                  {}};
  picture.figure.columns = 2;
  picture.figure.panel_width = 430.0;
  picture.figure.panel_height = 340.0;
  const std::array<double, 2> from{-1.0, -0.3}, to{1.0, 0.4};
  const auto geodesic = solve_geodesic(hill(), from, to, {-0.4, 2.5});
  const auto string = integrate_string({hill(), 0.0, {}}, geodesic.start, evenly(0.0, geodesic.length, 200));
  const SurfaceRod rod{hill(), 0.0, 1.0 / 3.0, {}, {}};
  const double chord = std::atan2(to[1] - from[1], to[0] - from[0]);
  // θ is measured from the u-line in the tangent plane, not in the map
  const auto direction = [&](const std::array<double, 2>& at) {
    const auto p = hill()->patch(at[0], at[1]);
    const auto zero = geometry::surface_direction<double>(geometry::lift(p, at[0], at[1]), 0.0);
    const auto t = std::cos(chord) * p(1, 0) + std::sin(chord) * p(0, 1);
    return std::atan2(geometry::dot(t, zero.g), geometry::dot(t, zero.t));
  };
  const double left = direction(from), right = direction(to);
  auto problem = surface_rod_problem(rod, collocation::make_conditions<2 * surface_rod_end>(
                                              surface_rod_end, [=](const auto* e, const auto& p, auto* r) {
                                                const auto* f = e + surface_rod_end;
                                                r[0] = e[iu] - from[0];
                                                r[1] = e[iv] - from[1];
                                                r[2] = e[itheta] - left;
                                                r[3] = f[iu] - to[0];
                                                r[4] = f[iv] - to[1];
                                                r[5] = f[itheta] - right;
                                                r[6] = f[iF_3] - p;  // sleeve: the force is given, the length free
                                                r[7] = 1.0 * f[iM_3];
                                                r[8] = 1.0 * e[ipsi];
                                              }));
  std::vector<SurfaceRodState<double>> guess;
  for (std::size_t i = 0; i < string.section.size(); i += 20) {
    const auto& y = string.section[i].state;
    guess.push_back({y[0], y[1], y[2], 0.0, 0.0, 30.0, 0.0, 0.0});
  }
  guess_from(problem, rod, guess, geodesic.length, 20);
  drawing::Panel body_panel, plot;
  const BodyView body(hill(), hill_range(), {-1.2, 1.05});
  body.draw_body(body_panel, 14, 14);
  drawing::Curve dashed = styled(6, 1.6, "geodesic");
  dashed.line = drawing::Line::dashed;
  plot.title = "Pressure over tension";
  plot.x_label = "share of the length s/ℓ [-]";
  plot.y_label = "ρ/T [1/L]";
  body_panel.title = "Rod over a hill";
  collocation::BvpOptions options;
  options.tolerance = 1e-11;
  Data table{"rod_to_string",
             {"T [B/L^2]", "length [L]", "length over the geodesic's [L]"},
             std::vector<std::vector<double>>(3)};
  std::vector<std::pair<double, std::vector<SurfaceRodSection>>> solved;
  // from a moderate pull down to a push, then up again
  for (const double T : {30.0, 10.0, 0.0, -4.0, 30.0, 100.0, 1000.0, 10000.0, 40000.0}) {
    const auto summary = problem.solve(collocation::Closure::at(T), options);
    if (!summary.converged) {
      out.notes.push_back(text("Rod over a hill at T = %g: ", T) + summary.reason);
      break;
    }
    if (T == 30.0 && solved.size() > 1) continue;
    solved.emplace_back(T, sections_of(problem, rod, 300));
    table.value[0].push_back(T);
    table.value[1].push_back(length_of(problem));
    table.value[2].push_back(length_of(problem) - geodesic.length);
  }
  std::sort(solved.begin(), solved.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  int colour = 0;
  double first_excess = 0.0;
  for (const auto& [T, sections] : solved) {
    if (T >= 10000.0) {
      // in the middle, far from the clamps, the rod is a string: ρ = -κ_n F_3 up to terms of order B/(T L²)
      const auto& middle = sections[sections.size() / 2];
      const double excess = middle.rho / (-middle.kappa_n * middle.F_3) - 1.0;
      if (T == 10000.0) {
        first_excess = excess;
        continue;
      }
      out.rows.push_back({"rod over a hill: its excess of ρ/(−κ_n F_3) over 1 in the middle, T = 10⁴ over T = 4·10⁴",
                          first_excess / excess, 4.0, 0.1, "string limit (III.1.54), error of order B/(T L²)"});
      continue;
    }
    drawing::Curve ratio = styled(colour, 1.4, T < 0.0 ? text("T = −%g B/L²", -T) : text("T = %g B/L²", T));
    for (const auto& x : sections) {
      ratio.x.push_back(x.s / sections.back().s);
      ratio.y.push_back(x.rho / T);
    }
    body.draw_curve(body_panel, places(sections), styled(colour++, 2.0, ratio.label));
    if (T >= 10.0) plot.curves.push_back(std::move(ratio));
  }
  drawing::Curve limit = dashed;
  for (const auto& x : string.section) {
    limit.x.push_back(x.s / geodesic.length);
    limit.y.push_back(x.rho);
  }
  limit.label = "string";
  plot.curves.push_back(limit);
  body.draw_curve(body_panel, places(string.section), dashed);
  picture.figure.panels.push_back(std::move(body_panel));
  picture.figure.panels.push_back(std::move(plot));
  out.data.push_back(std::move(table));
  return picture;
}

Picture strings(Outcome& out) {
  Picture picture{
      "strings",
      "Strings on surfaces: geodesics of a spheroid (Clairaut), a torus and a hill with two of them between "
      "the same points; heavy strings on a sphere and a vertical cylinder, and the latter unrolled, with the "
      "catenary as marks.",
      {}};
  drawing::Figure& figure = picture.figure;
  figure.title = "Strings: geodesics and catenaries";
  figure.columns = 3;
  figure.panel_width = 300.0;
  figure.panel_height = 280.0;
  const BodyRange whole{-pi / 2, pi / 2, 0.0, 2 * pi};
  {
    drawing::Panel panel;
    panel.title = "spheroid, five oscillations";
    const auto surface = geometry::ellipsoid(1.0, 1.0, 1.5);
    const double length = closed_form::spheroid_geodesic(1.0, 1.5, 0.8).length;
    const auto curve =
        integrate_string({surface, 0.0, {}}, {0.0, 0.0, pi / 2 - 0.8, 1.0}, evenly(0.0, 5 * length, 900));
    const BodyView body(surface, whole, {0.5, 0.3});
    body.draw_body(panel, 8, 12);
    body.draw_curve(panel, places(curve.section), styled(0, 1.8));
    figure.panels.push_back(std::move(panel));
  }
  {
    drawing::Panel panel;
    panel.title = "torus, crossing the hole";
    const auto surface = geometry::torus(1.0, 0.35);
    // Clairaut's constant (R + r) cos θ below R - r: the geodesic winds around the section
    const auto curve = integrate_string({surface, 0.0, {}}, {0.0, 0.0, 1.15, 1.0}, evenly(0.0, 16.0, 900));
    const BodyView body(surface, {0.0, 2 * pi, 0.0, 2 * pi}, {0.5, 0.8});
    body.draw_body(panel, 24, 10);
    body.draw_curve(panel, places(curve.section), styled(0, 1.8));
    figure.panels.push_back(std::move(panel));
  }
  {
    drawing::Panel panel;
    panel.title = "hill, two geodesics";
    const std::array<double, 2> from{-1.0, -0.3}, to{1.0, 0.4};
    const BodyView body(hill(), hill_range(), {-1.2, 0.85});
    body.draw_body(panel, 14, 14);
    int colour = 0;
    double length[2] = {0.0, 0.0};
    for (const double guess : {-0.4, 0.9}) {
      const auto found = solve_geodesic(hill(), from, to, {guess, 2.5});
      if (!found.converged) {
        out.notes.push_back("Geodesic over the hill: " + found.reason);
        continue;
      }
      length[colour] = found.length;
      const auto curve = integrate_string({hill(), 0.0, {}}, found.start, evenly(0.0, found.length, 200));
      body.draw_curve(panel, places(curve.section), styled(colour++, 2.0, text("length %.4f", found.length)));
    }
    out.notes.push_back("Between (-1, -0.3) and (1, 0.4) the hill has a geodesic on either side, of lengths" +
                        text(" %.9f", length[0]) + text(" and %.9f; each is found from its own guess.", length[1]));
    figure.panels.push_back(std::move(panel));
  }
  {
    drawing::Panel panel;
    panel.title = "sphere, heavy string";
    const BodyView body(geometry::sphere(1.0), whole, {0.4, 0.25});
    body.draw_body(panel, 6, 12);
    int colour = 0;
    for (const double lowest : {-0.6, 0.2}) {
      const closed_form::SphericalCatenary arch(2.0, lowest, 0.5);
      const auto curve = integrate_string({geometry::sphere(1.0), 0.0, {0.0, 0.0, -2.0}},
                                          {std::asin(lowest), 0.0, pi / 2, 0.5}, evenly(0.0, 4 * arch.length(), 400));
      body.draw_curve(panel, places(curve.section),
                      styled(colour++, 2.0, lowest < 0.0 ? "lowest at z = −0.6" : "lowest at z = 0.2"));
    }
    figure.panels.push_back(std::move(panel));
  }
  drawing::Panel round, flat;
  round.title = "cylinder, heavy string";
  flat.title = "the same unrolled";
  flat.x_label = "arc [L]";
  flat.y_label = "height [L]";
  flat.x_range = {{-1.7, 1.7}};
  const double radius = 0.6, half = 1.5;
  const BodyView body(geometry::cylinder(radius), {-0.3, 1.7, 0.0, 2 * pi}, {0.0, 0.3});
  body.draw_body(round, 5, 12);
  int colour = 0;
  for (const double H : {0.3, 0.8, 2.0}) {
    const SurfaceString string{geometry::cylinder(radius), 0.05, {0.0, 0.0, -1.3}};
    const closed_form::Catenary exact_shape{H, 1.3, 0.05};
    const auto first = integrate_string(string, {0.0, 0.0, pi / 2, H}, evenly(0.0, half, 100));
    std::vector<std::array<double, 3>> r;
    drawing::Curve line = styled(colour, 1.8, text("H = %g F_0", H)), marks = styled(colour, 0.0);
    marks.line = drawing::Line::none;
    marks.mark = drawing::Mark::circle;
    for (int side : {-1, 1}) {
      for (int i = 0; i <= 100; ++i) {
        const auto& x = first.section[side < 0 ? 100 - i : i];
        r.push_back({x.r[0], side * x.r[1], x.r[2]});
        line.x.push_back(side * radius * x.state[1]);
        line.y.push_back(x.state[0]);
      }
    }
    for (double s : evenly(-half, half, 12)) {
      marks.x.push_back(exact_shape.x(s));
      marks.y.push_back(exact_shape.z(s));
    }
    body.draw_curve(round, r, styled(colour, 2.0));
    flat.curves.push_back(std::move(line));
    flat.curves.push_back(std::move(marks));
    ++colour;
  }
  figure.panels.push_back(std::move(round));
  figure.panels.push_back(std::move(flat));
  return picture;
}

}  // namespace tendril::reproduce::on_surfaces

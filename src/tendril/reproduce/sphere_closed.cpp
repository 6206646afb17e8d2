// Closed elasticae on the sphere: the gallery of Fig. III.1.4 and the map of Fig. III.1.3c.
#include <algorithm>

#include "tendril/drawing/contour.hpp"
#include "tendril/numerics/gauss.hpp"
#include "tendril/reproduce/body_view.hpp"
#include "tendril/reproduce/sphere_detail.hpp"

namespace tendril::reproduce::on_sphere {

namespace {

using closed_form::SphereElastica;
namespace bound = formulation;

/// A closed elastica, or one of the circles the parameter space does not hold inside.
struct Member {
  char label;
  bool wavelike;
  double kappa_sigma;
  int turns, periods;  // q = turns/periods; periods 0: a circle of this κ_σ (0) or the equator (κ_m = 0)
  bool from_south = false;
};

// The thesis prints no parameters but what its text says of the sets (a,b,c,d), (e,f), (i,g,h), (n,k,l), (r,o,p), (m)
// and (q); these members have those properties.
const std::vector<Member>& members() {
  static const std::vector<Member> all = {
      {'a', false, 0.30, 5, 4, true}, {'b', false, 0.90, 5, 4, true}, {'c', false, 1.60, 5, 4, true},
      {'d', false, 2.60, 1, 4},       {'e', false, 1.40, 4, 3, true}, {'f', false, 2.30, 1, 3, true},
      {'g', false, 2.20, 1, 2},       {'h', false, 3.00, 1, 2},       {'i', false, 1.00, 3, 2},
      {'j', true, 1.70, 3, 1},        {'k', true, 2.40, -1, 2},       {'l', true, 4.50, -1, 2},
      {'m', false, 0.00, 0, 0},       {'n', true, 1.20, 3, 2},        {'o', true, 2.40, 0, 1},
      {'p', true, 4.50, 0, 1},        {'q', true, 1.00, 0, 0},        {'r', true, 1.40, 2, 1},
      {'s', true, 1.60, 6, 5},        {'t', true, 5.50, 1, 3}};
  return all;
}

std::string fraction(const Member& m) {
  const std::string turns = (m.turns < 0 ? "−" : "") + std::to_string(std::abs(m.turns));
  return m.periods == 1 ? turns : turns + "/" + std::to_string(m.periods);
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// The curve in space over some periods, ϑ by Gauss quadrature between the points.
std::vector<std::array<double, 3>> path(const SphereElastica& rod, int periods, int points) {
  const auto& table = numerics::gauss_table(7);
  std::vector<std::array<double, 3>> r;
  const double h = rod.period() * periods / points;
  double longitude = 0.0;
  for (int i = 0; i <= points; ++i) {
    const double z = rod.height(i * h), rho = std::sqrt(1.0 - z * z);
    r.push_back({rho * std::cos(longitude), rho * std::sin(longitude), z});
    for (int j = 0; j < 7; ++j) longitude += h * table.b[j] * rod.longitude_rate((i + table.c[j]) * h);
  }
  return r;
}

}  // namespace

Picture gallery(Outcome& out, const Progress& progress) {
  Picture picture{
      "closed_elasticae",
      "Twenty closed elasticae on the sphere, as Fig. III.1.4: wavelike (blue) and orbit-like (red); hidden "
      "parts are faint. (a), (b), (c), (e), (f) are seen from below the south pole, all others from the side.",
      {}};
  drawing::Figure& figure = picture.figure;
  figure.title = "Closed elasticae on the sphere";
  figure.columns = 5;
  figure.panel_width = 180.0;
  figure.panel_height = 180.0;
  const BodyRange whole{-pi / 2, pi / 2, 0.0, 2.0 * pi};
  const BodyView side(geometry::sphere(1.0), whole, {0.4, 0.25}), south(geometry::sphere(1.0), whole, {0.0, -pi / 2});
  Data table{"gallery",
             {"letter (1 = a)", "wavelike", "kappa_sigma [1/R^2]", "kappa_m [1/R]", "sigma [B/R^2]", "q", "periods",
              "length [R]", "closure gap [R]"},
             std::vector<std::vector<double>>(9)};
  double worst = 0.0, height = 0.0;
  int ambiguous = 0;
  for (const Member& m : members()) {
    const int number = m.label - 'a';
    if (progress && !progress(0.3 + 0.4 * number / 20.0, "closed elasticae")) throw Interrupted{};
    drawing::Panel panel;
    panel.title = std::string("(") + m.label + ")  ";
    std::vector<std::array<double, 3>> r;
    double kappa_max = 0.0, q = gap, length = 2.0 * pi, miss = 0.0;
    if (m.periods == 0) {  // a circle around the pole, or the equator
      kappa_max = m.wavelike ? 0.0 : 1.5;
      const double z = kappa_max / std::hypot(1.0, kappa_max);
      length = 2.0 * pi * std::sqrt(1.0 - z * z);
      for (int i = 0; i <= 240; ++i)
        r.push_back({std::sqrt(1 - z * z) * std::cos(i * pi / 120), std::sqrt(1 - z * z) * std::sin(i * pi / 120), z});
      panel.title += m.wavelike ? "equator" : "circle κ_g = 1.5";
    } else {
      q = static_cast<double>(m.turns) / m.periods;
      const auto found = closed_form::elasticae_of_progression(q, m.kappa_sigma, m.wavelike);
      if (found.empty()) {
        out.notes.push_back(std::string("No closed curve found for (") + m.label + ").");
        worst = HUGE_VAL;
        continue;
      }
      if (found.size() > 1) ++ambiguous;
      kappa_max = found.front();
      const double sigma = kappa_max * kappa_max - m.kappa_sigma;
      const SphereElastica rod(sigma, kappa_max);
      length = m.periods * rod.period();
      r = path(rod, m.periods, 400 * m.periods);
      const bound::SurfaceRod model{geometry::sphere(1.0), 0.0, 0.0, {}, {}};
      std::vector<double> s;
      for (int i = 0; i <= 20 * m.periods; ++i) s.push_back(length * i / (20 * m.periods));
      const auto curve = bound::integrate_surface_rod(model, crest(rod, kappa_max, sigma, 0.0), s);
      miss = curve.summary.completed ? std::max(distance(curve.section.front().r, curve.section.back().r),
                                                distance(curve.section.front().t, curve.section.back().t))
                                     : HUGE_VAL;
      for (const auto& x : curve.section) height = std::max(height, std::abs(x.r[2] - rod.height(x.s)));
      panel.title += "q = " + fraction(m);
    }
    worst = std::max(worst, miss);
    const double line[] = {number + 1.0,
                           m.wavelike ? 1.0 : 0.0,
                           m.kappa_sigma,
                           kappa_max,
                           kappa_max * kappa_max - m.kappa_sigma,
                           q,
                           double(m.periods),
                           length,
                           miss};
    for (int i = 0; i < 9; ++i) table.value[i].push_back(line[i]);
    const BodyView& view = m.from_south ? south : side;
    if (m.from_south || m.label == 'm')
      for (auto& p : r) p[2] = -p[2];  // the mirror image, around the south pole
    view.draw_body(panel, 6, 12);
    drawing::Curve style;
    style.colour = m.wavelike ? 0 : 1;
    style.width = 2.0;
    view.draw_curve(panel, r, style);
    figure.panels.push_back(std::move(panel));
  }
  out.rows.push_back({"eighteen closed elasticae: largest gap in place and direction", worst, 0.0, exact,
                      "closure found for q (III.1.68-69), traced by the general solver"});
  out.rows.push_back({"their height ζ along the way, largest difference", height, 0.0, exact,
                      "(III.1.66) against the general solver"});
  out.notes.push_back("Of the eighteen pairs (q, κ_σ) of the gallery " + std::to_string(ambiguous) +
                      " had more than one root κ_m of the closure condition (400 places scanned up to 1e-13 of the "
                      "frontier); the least is drawn.");
  out.data.push_back(std::move(table));
  return picture;
}

Picture wavelength() {
  Picture picture{
      "wavelength",
      "Wavelength Λ of a wavelike and angular progression Δϑ of an orbit-like elastica (Fig. III.1.3a, b): "
      "longitude gained between two crests of κ_g (dots), at κ_σ = 4.5, κ_m² = 4.5 and κ_σ = 3.5, κ_m² = 7.6.",
      {}};
  picture.figure.panel_width = 300.0;
  picture.figure.panel_height = 300.0;
  struct Case {
    double kappa_sigma, square;
    const char *title, *name;
  };
  for (const Case c : {Case{4.5, 4.5, "wavelike", "Λ"}, Case{3.5, 7.6, "orbit-like", "Δϑ"}}) {
    const SphereElastica rod(c.square - c.kappa_sigma, std::sqrt(c.square));
    const double gain = rod.longitude_per_period();
    const drawing::View view{0.5 * gain, 0.45};  // the first period in front
    const BodyView body(geometry::sphere(1.0), {-pi / 2, pi / 2, 0.0, 2.0 * pi}, view);
    drawing::Panel panel;
    panel.title = c.title;
    body.draw_body(panel, 6, 12);
    drawing::Curve line, crests, span;
    line.colour = rod.wavelike() ? 0 : 1;
    line.width = 2.0;
    const int periods = 2, points = 200;
    const auto r = path(rod, periods, periods * points);
    body.draw_curve(panel, r, line);
    // the parallel of the crests, and on it the longitude gained in one period
    const double z = rod.height(0.0), rho = std::sqrt(1.0 - z * z);
    std::vector<std::array<double, 3>> arc;
    for (int i = 0; i <= 100; ++i) arc.push_back({rho * std::cos(gain * i / 100), rho * std::sin(gain * i / 100), z});
    span.colour = 2;
    span.width = 3.0;
    body.draw_curve(panel, arc, span);
    crests.line = drawing::Line::none;
    crests.mark = drawing::Mark::circle;
    crests.colour = 6;
    for (int n = 0; n <= periods; ++n) {
      const auto p = drawing::project(view, r[n * points]);
      if (p[2] < 0.0) continue;  // behind
      crests.x.push_back(p[0]);
      crests.y.push_back(p[1]);
    }
    panel.curves.push_back(crests);
    const auto middle = drawing::project(view, arc[50]);
    panel.words.push_back(
        {middle[0], middle[1],
         c.name + std::string(gain < 0.0 ? " = −" : " = ") + text("%.3f·2π", std::abs(gain) / (2.0 * pi))});
    picture.figure.panels.push_back(std::move(panel));
  }
  return picture;
}

Picture map(Outcome& out) {
  Picture picture{"map",
                  "Turns of longitude per period, Λ/2π of the wavelike and Δϑ/2π of the orbit-like elasticae "
                  "(Fig. III.1.3c): the curve closes where the value is rational. Black: the frontier of the families "
                  "κ_m² = 2κ_σ; dashed: passage through the poles, κ_σ = 2. Circles: members of the gallery.",
                  {}};
  picture.figure.columns = 1;
  picture.figure.panel_width = 760.0;
  picture.figure.panel_height = 560.0;
  drawing::Panel panel;
  panel.title = "Closed elasticae on the sphere: turns per period";
  panel.x_label = "reduced tension κ_σ = κ_m^2 − σ [1/R²]";
  panel.y_label = "largest curvature squared κ_m^2 [1/R²]";
  constexpr double most_x = 6.0, most_y = 14.0;
  panel.x_range = {{0.0, most_x}};
  panel.y_range = {{0.0, most_y}};
  Data lines{"map", {"q", "kappa_sigma [1/R^2]", "kappa_m^2 [1/R^2]"}, std::vector<std::vector<double>>(3)};
  struct Level {
    double q;
    const char* name;  // empty: too close to the frontier, members of the gallery tell
    double word;       // κ_σ where the line is named
  };
  struct Region {
    bool wavelike, before;  // κ_σ < 2
    std::vector<Level> levels;
  };
  const std::vector<Region> regions = {
      {true, true, {{1.2, "6/5", 1.9}, {4.0 / 3, "4/3", 1.85}, {1.5, "3/2", 1.75}, {2, "2", 1.0}, {3, "3", 1.45}}},
      {true,
       false,
       {{-0.75, "−3/4", 2.6},
        {-2.0 / 3, "−2/3", 3.7},
        {-0.5, "−1/2", 5.4},
        {-1.0 / 3, "−1/3", 5.4},
        {0, "0", 5.4},
        {1.0 / 3, "1/3", 4.6}}},
      {false,
       true,
       {{1.125, "9/8", 0.6}, {1.2, "6/5", 0.5}, {1.25, "5/4", 0.6}, {4.0 / 3, "4/3", 0.35}, {1.5, "", 0.0}}},
      {false, false, {{0.125, "1/8", 4.0}, {0.2, "1/5", 3.5}, {0.25, "1/4", 4.4}, {1.0 / 3, "", 0.0}, {0.5, "", 0.0}}}};
  for (const Region& region : regions) {
    // a grid of κ_σ and of the share τ of the way to the frontier, finer towards it
    std::vector<double> x, tau;
    for (int i = 0; i <= 90; ++i)
      x.push_back(region.before ? 0.02 + 1.978 * i / 90 : 2.002 + (most_x - 2.002) * i / 90);
    for (int j = 0; j <= 70; ++j) tau.push_back(0.0005 + 0.999 * j / 70);
    const auto square = [&](double kappa_sigma, double t) {
      const double part = std::pow(1.0 - t, 3.0), frontier = 2.0 * kappa_sigma;
      return region.wavelike ? frontier * (1.0 - part) : frontier + (1.6 * most_y - frontier) * part;
    };
    const auto value = [&](double kappa_sigma, double t) { return progression(kappa_sigma, square(kappa_sigma, t)); };
    std::vector<double> grid;
    for (double t : tau)
      for (double k : x) grid.push_back(value(k, t));
    for (const Level& level : region.levels) {
      for (const auto& found : drawing::level_lines(x, tau, grid, level.q, value)) {
        drawing::Curve curve;
        curve.colour = region.wavelike ? 0 : 1;
        if (region.before && level.q == 1.5) curve.label = region.wavelike ? "Λ/2π, wavelike" : "Δϑ/2π, orbit-like";
        std::size_t best = 0;
        double score = HUGE_VAL;
        for (std::size_t i = 0; i < found.x.size(); ++i) {
          const double y = square(found.x[i], found.y[i]);
          curve.x.push_back(found.x[i]);
          curve.y.push_back(y);
          lines.value[0].push_back(level.q);
          lines.value[1].push_back(found.x[i]);
          lines.value[2].push_back(y);
          const double d = std::abs(found.x[i] - level.word);
          if (d < score) score = d, best = i;
        }
        if (*level.name) panel.words.push_back({curve.x[best], curve.y[best], level.name});
        panel.curves.push_back(std::move(curve));
      }
    }
  }
  drawing::Curve frontier, poles, dots;
  frontier.x = {0.0, most_x};
  frontier.y = {0.0, 2.0 * most_x};
  frontier.colour = 6;
  frontier.width = 2.0;
  frontier.label = "κ_m^2 = 2 κ_σ";
  poles.x = {2.0, 2.0};
  poles.y = {0.0, most_y};
  poles.colour = 6;
  poles.line = drawing::Line::dashed;
  poles.label = "through the poles";
  dots.line = drawing::Line::none;
  dots.mark = drawing::Mark::circle;
  dots.colour = 6;
  dots.label = "gallery";
  for (const Member& m : members()) {
    if (m.periods == 0) continue;
    const auto found = closed_form::elasticae_of_progression(double(m.turns) / m.periods, m.kappa_sigma, m.wavelike);
    if (found.empty()) continue;
    dots.x.push_back(m.kappa_sigma);
    dots.y.push_back(found.front() * found.front());
    panel.words.push_back({dots.x.back(), dots.y.back(), std::string("(") + m.label + ")"});
  }
  panel.curves.push_back(frontier);
  panel.curves.push_back(poles);
  panel.curves.push_back(dots);
  picture.figure.panels.push_back(std::move(panel));
  out.data.push_back(std::move(lines));
  return picture;
}

}  // namespace tendril::reproduce::on_sphere

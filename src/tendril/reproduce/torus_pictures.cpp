#include "tendril/reproduce/torus_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tendril::reproduce::torus {
namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

BodyView torus_view(double epsilon) { return {geometry::torus(1.0, epsilon), {0.0, 2.0 * pi, -pi, pi}, {0.0, 0.95}}; }

drawing::Panel body(const std::string& title, const BodyView& view, const std::vector<Point>& rod) {
  drawing::Panel panel;
  panel.title = title;
  view.draw_body(panel, 12, 1);
  drawing::Curve style;
  style.width = 2.4;
  style.colour = 7;
  std::vector<std::array<double, 3>> places;
  for (const Point& p : rod) {
    places.push_back(p.r);
    style.value.push_back(std::abs(p.rho) > 1e-8 ? p.rho : 0.0);
  }
  if (std::all_of(style.value.begin(), style.value.end(), [](double v) { return v == 0.0; }))
    style.value.clear();
  else
    panel.value_label = "ρ [B/R³]";
  view.draw_curve(panel, places, style, 0.3);
  return panel;
}

drawing::Curve offset(const std::string& label, int colour, const std::vector<Point>& winding) {
  drawing::Curve c;
  c.label = label;
  c.colour = colour;
  const double xi = winding.back().xi, beta = winding.back().beta;
  for (const Point& p : winding) {
    c.x.push_back(p.xi / xi);
    c.y.push_back(p.beta - beta * p.xi / xi);
  }
  return c;
}

drawing::Curve pressure(const std::string& label, int colour, const std::vector<Point>& winding, double unit) {
  drawing::Curve c;
  c.label = label;
  c.colour = colour;
  for (const Point& p : winding) {
    c.x.push_back(p.xi / winding.back().xi);
    c.y.push_back(p.rho / unit);
  }
  return c;
}

}  // namespace tendril::reproduce::torus

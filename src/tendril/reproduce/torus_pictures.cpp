#include "tendril/reproduce/torus_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tendril::reproduce::torus {
namespace {

constexpr double pi = std::numbers::pi, nan = std::numeric_limits<double>::quiet_NaN();
constexpr drawing::View view{0.0, 0.95};

V3<double> towards_viewer() {
  return {std::cos(view.elevation) * std::cos(view.azimuth), std::cos(view.elevation) * std::sin(view.azimuth),
          std::sin(view.elevation)};
}

/// The line from a point of the surface towards the viewer meets the solid torus again.
bool hidden(double epsilon, const V3<double>& r, const V3<double>& N) {
  const V3<double> v = towards_viewer();
  if (numerics::dot(N, v) < -1e-6) return true;
  constexpr double step = 0.01;
  for (double t = 5.0 * step; t < 3.0; t += step) {
    const double x = r[0] + t * v[0], y = r[1] + t * v[1], z = r[2] + t * v[2];
    if (std::abs(z) > epsilon && z * v[2] > 0.0) return false;
    const double d = std::hypot(x, y) - 1.0;
    if (d * d + z * z < 0.999 * epsilon * epsilon) return true;
  }
  return false;
}

void add(drawing::Curve& c, const V3<double>& r) {
  const auto q = drawing::project(view, r);
  c.x.push_back(q[0]);
  c.y.push_back(q[1]);
}

void interrupt(drawing::Curve& c) {
  c.x.push_back(nan);
  c.y.push_back(nan);
}

/// Where the surface turns away from the viewer: N·v = 0, that is tanβ = (v·e_r)/v_z with N = cosβ e_r - sinβ e_z.
drawing::Curve outline(double epsilon) {
  drawing::Curve c;
  c.colour = 7;
  c.width = 0.9;
  c.opacity = 0.8;
  const V3<double> v = towards_viewer();
  for (int side = 0; side < 2; ++side) {
    constexpr int n = 360;
    for (int i = 0; i <= n; ++i) {
      const double xi = 2.0 * pi * i / n, cx = std::cos(xi), sx = std::sin(xi);
      const double b = std::atan2(v[0] * cx + v[1] * sx, v[2]) + side * pi, radius = 1.0 + epsilon * std::cos(b);
      const V3<double> r{radius * cx, radius * sx, -epsilon * std::sin(b)};
      if (hidden(epsilon, r, {std::cos(b) * cx, std::cos(b) * sx, -std::sin(b)}))
        interrupt(c);
      else
        add(c, r);
    }
    interrupt(c);
  }
  return c;
}

}  // namespace

drawing::Panel body(const std::string& title, double epsilon, const std::vector<Point>& rod) {
  drawing::Panel panel;
  panel.title = title;
  panel.axes = false;
  panel.equal_scale = true;
  panel.curves.push_back(outline(epsilon));
  double most = 0.0;
  for (const Point& p : rod) most = std::max(most, std::abs(p.rho));
  const bool coloured = most > 1e-8;
  drawing::Curve seen, behind;
  seen.width = 2.6;
  behind.width = 1.6;
  behind.opacity = 0.3;
  seen.colour = behind.colour = 7;
  bool was_hidden = false;
  for (std::size_t i = 0; i < rod.size(); ++i) {
    const Point& p = rod[i];
    const bool now = hidden(epsilon, p.r, p.N);
    const auto append = [&](drawing::Curve& c) {
      add(c, p.r);
      if (coloured) c.value.push_back(p.rho);
    };
    append(now ? behind : seen);
    if (i > 0 && now != was_hidden) {  // the two parts share the vertex where they meet
      drawing::Curve& ended = was_hidden ? behind : seen;
      append(ended);
      interrupt(ended);
      if (coloured) ended.value.push_back(nan);
    }
    was_hidden = now;
  }
  panel.curves.push_back(behind);
  panel.curves.push_back(seen);
  if (coloured) panel.value_label = "ρ [B/R³]";
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

#include "tendril/drawing/polyline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tendril::drawing {
namespace {

bool finite(const Point& p) { return std::isfinite(p[0]) && std::isfinite(p[1]); }

// Fractions of the segment a-b that lie in the box (Liang and Barsky); empty when first > second.
std::pair<double, double> inside(const Point& a, const Point& b, const Box& box) {
  const double low[2] = {box.left, box.top}, high[2] = {box.right, box.bottom};
  double enter = 0.0, leave = 1.0;
  for (int i = 0; i < 2; ++i) {
    const double d = b[static_cast<std::size_t>(i)] - a[static_cast<std::size_t>(i)];
    const double start = a[static_cast<std::size_t>(i)];
    if (d == 0.0) {
      if (start < low[i] || start > high[i]) return {1.0, 0.0};
      continue;
    }
    const double t0 = (low[i] - start) / d, t1 = (high[i] - start) / d;
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  return {enter, leave};
}

double distance_squared(const Point& p, const Point& a, const Point& b) {
  const double dx = b[0] - a[0], dy = b[1] - a[1], length = dx * dx + dy * dy;
  const double t = length > 0 ? std::min(1.0, std::max(0.0, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length)) : 0.0;
  const double ex = p[0] - a[0] - t * dx, ey = p[1] - a[1] - t * dy;
  return ex * ex + ey * ey;
}

}  // namespace

std::vector<Piece> clip(const std::vector<Point>& line, const Box& box) {
  std::vector<Piece> pieces;
  bool open = false;  // the last piece ends at the current point
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Point &a = line[i], &b = line[i + 1];
    const auto [enter, leave] = finite(a) && finite(b) ? inside(a, b, box) : std::pair<double, double>{1.0, 0.0};
    if (enter > leave) {
      open = false;
      continue;
    }
    const auto at = [&](double t) {
      return t == 0.0 ? a : t == 1.0 ? b : Point{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
    };
    if (!open || enter > 0.0) pieces.push_back({{at(enter)}, i});
    pieces.back().points.push_back(at(leave));
    open = leave == 1.0;
  }
  return pieces;
}

std::vector<Point> clip_polygon(std::vector<Point> polygon, const Box& box) {
  std::erase_if(polygon, [](const Point& p) { return !finite(p); });
  const double bound[4] = {box.left, box.top, box.right, box.bottom};
  for (int side = 0; side < 4; ++side) {
    const std::size_t axis = static_cast<std::size_t>(side % 2);
    const double sign = side < 2 ? 1.0 : -1.0;
    std::vector<Point> cut;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double da = sign * (a[axis] - bound[side]), db = sign * (b[axis] - bound[side]);
      if (da >= 0) cut.push_back(a);
      if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
        const double t = da / (da - db);
        Point p{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
        p[axis] = bound[side];
        cut.push_back(p);
      }
    }
    polygon = std::move(cut);
  }
  return polygon;
}

std::vector<Point> simplify(const std::vector<Point>& line, double tolerance) {
  if (line.size() < 3) return line;
  std::vector<bool> kept(line.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open = {{0, line.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    double worst = tolerance * tolerance;
    std::size_t at = 0;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double d = distance_squared(line[i], line[first], line[last]);
      if (d > worst) {
        worst = d;
        at = i;
      }
    }
    if (at == 0) continue;
    kept[at] = true;
    open.push_back({first, at});
    open.push_back({at, last});
  }
  std::vector<Point> thin;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (kept[i]) thin.push_back(line[i]);
  }
  return thin;
}

}  // namespace tendril::drawing

#pragma once
// Lines on paper: cut at the frame, thinned to what the eye can tell.

#include <array>
#include <cstddef>
#include <vector>

namespace tendril::drawing {

using Point = std::array<double, 2>;  // [px]

struct Box {
  double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
  bool holds(const Point& p) const { return p[0] >= left && p[0] <= right && p[1] >= top && p[1] <= bottom; }
  bool meets(const Box& b) const { return left < b.right && b.left < right && top < b.bottom && b.top < bottom; }
};

/// A piece of a line inside the box; `first` is the index of the given line's segment it begins on.
struct Piece {
  std::vector<Point> points;
  std::size_t first = 0;
};

/// The parts of the line inside the box. Points that are not finite break it.
std::vector<Piece> clip(const std::vector<Point>& line, const Box& box);

/// The closed polygon's part inside the box (Sutherland and Hodgman); points that are not finite are left out.
std::vector<Point> clip_polygon(std::vector<Point> polygon, const Box& box);

/// Fewer points, nowhere farther than `tolerance` from the line (Douglas and Peucker).
std::vector<Point> simplify(const std::vector<Point>& line, double tolerance);

}  // namespace tendril::drawing

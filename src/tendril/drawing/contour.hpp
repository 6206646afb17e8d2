#pragma once
// Level lines of a function given at the nodes of a rectangular grid (marching squares), its crossings of the grid's
// edges sharpened by root finding when the function itself can be called.

#include <functional>
#include <vector>

namespace tendril::drawing {

struct LevelLine {
  std::vector<double> x, y;
};

/// value[j * x.size() + i] at (x[i], y[j]); cells with a NaN corner are left out. `exact`, if given, is the function: a
/// crossing is then exact along its edge.
std::vector<LevelLine> level_lines(const std::vector<double>& x, const std::vector<double>& y,
                                   const std::vector<double>& value, double level,
                                   const std::function<double(double, double)>& exact = {});

}  // namespace tendril::drawing

#pragma once
// Axes of pictures: linear and logarithmic scales with ticks at round numbers, the palette (Okabe and Ito, distinct to
// colour-blind readers and on white) and a diverging colour scale.

#include <string>
#include <vector>

namespace tendril::drawing {

struct Scale {
  double from = 0.0, to = 1.0;
  bool logarithmic = false;
  /// Fraction of the axis, 0 at `from`, 1 at `to`; NaN where a logarithm does not exist.
  double operator()(double value) const;
};

struct Tick {
  double value = 0.0;
  std::string label;  // empty: a minor tick
};

/// About `wanted` labelled ticks inside the scale, at 1, 2 or 5 times a power of ten.
std::vector<Tick> ticks(const Scale& scale, int wanted);

/// Scale that shows all of `values` with a margin; noise on a constant is not blown up. [0, 1] for no values.
Scale scale_of(const std::vector<double>& values, bool logarithmic);

std::string palette(int index);
/// t in [-1, 1]: blue below zero, grey at zero, red above.
std::string diverging_colour(double t);

}  // namespace tendril::drawing

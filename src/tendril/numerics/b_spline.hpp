#pragma once
// Polynomials in Bernstein form and splines in B-form (de Boor, A Practical Guide to Splines; Farin). Piecewise
// polynomials of any smoothness convert to B-splines exactly, by blossoms; control points bound values from both sides
// (convex hull), the closer the finer the polynomial is cut.

#include <utility>
#include <vector>

namespace tendril::numerics {

/// Coefficients on [0,1]: sum c_i C(n,i) x^i (1-x)^(n-i), n = size - 1.
using Bernstein = std::vector<double>;

double value(const Bernstein& c, double x);
/// Integral from 0 of `length` times c, plus `constant`: one degree more.
Bernstein integrated(const Bernstein& c, double length, double constant);
Bernstein product(const Bernstein& a, const Bernstein& b);
Bernstein sum(const Bernstein& a, const Bernstein& b);
/// The parts on [0,x] and [x,1], each on [0,1] again.
std::pair<Bernstein, Bernstein> split(const Bernstein& c, double x);
/// The polynomial of degree size - 1 through (x_i, y_i).
Bernstein interpolant(const std::vector<double>& x, const std::vector<double>& y);
/// Lowest and highest value on [0,1], each to within `accuracy` on the safe side.
std::pair<double, double> bounds(const Bernstein& c, double accuracy);

struct BSpline {
  int order = 1;                // degree + 1
  std::vector<double> knots;    // ascending, control.size() + order of them
  std::vector<double> control;  // control points

  double value(double x, int derivative = 0) const;
  /// Smallest and largest control point: bounds of all values.
  std::pair<double, double> bounds() const;
};

/// The spline of this order with `continuity` continuous derivatives at the interior breaks (0: itself continuous),
/// whose piece i on [breaks[i], breaks[i+1]] is given in Bernstein form of degree order - 1.
BSpline b_spline(int order, int continuity, const std::vector<double>& breaks, const std::vector<Bernstein>& pieces);

}  // namespace tendril::numerics

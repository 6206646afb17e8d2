#include "tendril/numerics/b_spline.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <cmath>

namespace tendril::numerics {
namespace {

double binomial(int n, int k) {
  double b = 1.0;
  for (int i = 1; i <= k; ++i) b = b * (n - k + i) / i;
  return b;
}

/// Polar form of the polynomial on [a, b] at the given arguments, one for every degree.
double blossom(Bernstein c, double a, double b, const double* arguments) {
  for (std::size_t r = 1; r < c.size(); ++r) {
    const double t = (arguments[r - 1] - a) / (b - a);
    for (std::size_t i = 0; i + r < c.size(); ++i) c[i] = (1 - t) * c[i] + t * c[i + 1];
  }
  return c[0];
}

/// Raises `best` to the largest value of c: a part whose coefficients all lie below it cannot hold the maximum.
void raise(const Bernstein& c, double accuracy, int depth, double& best) {
  best = std::max({best, c.front(), c.back()});
  if (*std::max_element(c.begin(), c.end()) <= best + accuracy) return;
  if (depth == 0) return;
  const auto [left, right] = split(c, 0.5);
  raise(left, accuracy, depth - 1, best);
  raise(right, accuracy, depth - 1, best);
}

}  // namespace

double value(const Bernstein& c, double x) {
  const std::vector<double> arguments(c.size(), x);
  return blossom(c, 0.0, 1.0, arguments.data());
}

Bernstein integrated(const Bernstein& c, double length, double constant) {
  Bernstein out{constant};
  for (const double d : c) out.push_back(out.back() + length * d / static_cast<double>(c.size()));
  return out;
}

Bernstein product(const Bernstein& a, const Bernstein& b) {
  const int n = static_cast<int>(a.size()) - 1, m = static_cast<int>(b.size()) - 1;
  Bernstein out(a.size() + b.size() - 1, 0.0);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= m; ++j) out[i + j] += binomial(n, i) * binomial(m, j) / binomial(n + m, i + j) * a[i] * b[j];
  return out;
}

Bernstein sum(const Bernstein& a, const Bernstein& b) {
  assert(a.size() == b.size());
  Bernstein out = a;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] += b[i];
  return out;
}

std::pair<Bernstein, Bernstein> split(const Bernstein& c, double x) {
  Bernstein left, right(c.size()), row = c;
  for (std::size_t r = c.size(); r > 0; --r) {
    left.push_back(row[0]);
    right[r - 1] = row[r - 1];
    for (std::size_t i = 0; i + 1 < r; ++i) row[i] = (1 - x) * row[i] + x * row[i + 1];
  }
  return {left, right};
}

Bernstein interpolant(const std::vector<double>& x, const std::vector<double>& y) {
  const int n = static_cast<int>(x.size());
  Eigen::MatrixXd basis(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) basis(i, j) = binomial(n - 1, j) * std::pow(x[i], j) * std::pow(1 - x[i], n - 1 - j);
  const Eigen::VectorXd c = basis.fullPivLu().solve(Eigen::Map<const Eigen::VectorXd>(y.data(), n));
  return {c.data(), c.data() + n};
}

std::pair<double, double> bounds(const Bernstein& c, double accuracy) {
  constexpr int kDepth = 40;
  Bernstein negative = c;
  for (double& v : negative) v = -v;
  double high = -HUGE_VAL, low = -HUGE_VAL;
  raise(c, accuracy, kDepth, high);
  raise(negative, accuracy, kDepth, low);
  return {-low - accuracy, high + accuracy};
}

double BSpline::value(double x, int derivative) const {
  assert(knots.size() == control.size() + order);
  if (derivative >= order) return 0.0;
  const int n = static_cast<int>(control.size());
  const auto above = std::upper_bound(knots.begin() + order - 1, knots.begin() + n, x);
  const int span = static_cast<int>(above - knots.begin()) - 1;  // knots[span] <= x < knots[span + 1]
  std::vector<double> c(control.begin() + span - order + 1, control.begin() + span + 1);
  int k = order;
  for (int d = 0; d < derivative; ++d, --k)  // differences are the control points of the derivative
    for (int i = 0; i + 1 < k; ++i) {
      const int j = span - k + 2 + i;
      c[i] = (k - 1) * (c[i + 1] - c[i]) / (knots[j + k - 1] - knots[j]);
    }
  for (int r = 1; r < k; ++r)  // de Boor
    for (int i = 0; i + r < k; ++i) {
      const int j = span - k + 1 + r + i;
      const double t = (x - knots[j]) / (knots[j + k - r] - knots[j]);
      c[i] = (1 - t) * c[i] + t * c[i + 1];
    }
  return c[0];
}

std::pair<double, double> BSpline::bounds() const {
  const auto [low, high] = std::minmax_element(control.begin(), control.end());
  return {*low, *high};
}

BSpline b_spline(int order, int continuity, const std::vector<double>& breaks, const std::vector<Bernstein>& pieces) {
  assert(breaks.size() == pieces.size() + 1 && continuity < order);
  BSpline s;
  s.order = order;
  s.knots.assign(order, breaks.front());
  for (std::size_t i = 1; i + 1 < breaks.size(); ++i) s.knots.insert(s.knots.end(), order - 1 - continuity, breaks[i]);
  s.knots.insert(s.knots.end(), order, breaks.back());
  const int n = static_cast<int>(s.knots.size()) - order;
  for (int j = 0; j < n; ++j) {
    // The blossom of any piece under the B-spline gives its control point; the one around the middle the least
    // rounding.
    const double* arguments = &s.knots[j + 1];
    double middle = 0.0;
    for (int i = 0; i < order - 1; ++i) middle += arguments[i] / std::max(1, order - 1);
    const auto piece_at = [&](double x) {
      return static_cast<std::size_t>(std::upper_bound(breaks.begin() + 1, breaks.end() - 1, x) - breaks.begin()) - 1;
    };
    const std::size_t first = piece_at(s.knots[j]),
                      last =
                          std::max(first, piece_at(s.knots[j + order]) - (s.knots[j + order] < breaks.back() ? 1 : 0));
    const std::size_t i = std::clamp(piece_at(middle), first, last);
    assert(static_cast<int>(pieces[i].size()) == order);
    s.control.push_back(blossom(pieces[i], breaks[i], breaks[i + 1], arguments));
  }
  return s;
}

}  // namespace tendril::numerics

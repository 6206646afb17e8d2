#include "tendril/geometry/quintic_spline.hpp"

#include <algorithm>

namespace tendril::geometry {

namespace {

constexpr int kMaxOrder = 6;
using Values = std::array<double, kMaxOrder>;

// Nonzero B-splines of orders 1..order on [knots[span], knots[span+1]): all[k-1][j] is B-spline span-k+1+j of order k.
std::array<Values, kMaxOrder> basis(const std::vector<double>& knots, std::size_t span, double x, int order) {
  std::array<Values, kMaxOrder> all{};
  all[0][0] = 1.0;
  for (int k = 2; k <= order; ++k) {
    for (int j = 0; j < k - 1; ++j) {
      // B-spline m = span-k+2+j of order k-1 lives on [knots[m], knots[m+k-1]].
      const std::size_t m = span + 2 + j - k;
      const double left = knots[m], right = knots[m + k - 1];
      const double term = all[k - 2][j] / (right - left);
      all[k - 1][j] += (right - x) * term;
      all[k - 1][j + 1] += (x - left) * term;
    }
  }
  return all;
}

std::size_t span_of(const std::vector<double>& knots, double x, int order) {
  const auto first = knots.begin() + (order - 1), last = knots.end() - order;
  const auto it = std::upper_bound(first, last, x);
  return static_cast<std::size_t>(it - knots.begin()) - 1;
}

// Banded elimination without pivoting; row i holds columns i - kHalf .. i + kHalf.
constexpr int kHalf = 6;
using Row = std::array<double, 2 * kHalf + 1>;

template <int Dim>
void solve_banded(std::vector<Row>& A, std::vector<std::array<double, Dim>>& b) {
  const std::ptrdiff_t n = static_cast<std::ptrdiff_t>(A.size());
  for (std::ptrdiff_t p = 0; p < n; ++p) {
    for (std::ptrdiff_t i = p + 1; i <= std::min(n - 1, p + kHalf); ++i) {
      const double factor = A[i][p - i + kHalf] / A[p][kHalf];
      if (factor == 0.0) continue;
      for (std::ptrdiff_t j = p; j <= std::min(n - 1, p + kHalf); ++j)
        A[i][j - i + kHalf] -= factor * A[p][j - p + kHalf];
      for (int c = 0; c < Dim; ++c) b[i][c] -= factor * b[p][c];
    }
  }
  for (std::ptrdiff_t i = n - 1; i >= 0; --i) {
    for (std::ptrdiff_t j = i + 1; j <= std::min(n - 1, i + kHalf); ++j) {
      for (int c = 0; c < Dim; ++c) b[i][c] -= A[i][j - i + kHalf] * b[j][c];
    }
    for (int c = 0; c < Dim; ++c) b[i][c] /= A[i][kHalf];
  }
}

template <int Dim>
PiecewiseQuintic<Dim> solve_spline(const std::vector<double>& interior, const std::vector<double>& sites,
                                   const std::vector<std::array<double, Dim>>& values, int order) {
  std::vector<double> knots(order, sites.front());
  knots.insert(knots.end(), interior.begin(), interior.end());
  knots.insert(knots.end(), order, sites.back());

  const std::size_t n = sites.size();
  std::vector<Row> A(n, Row{});
  std::vector<std::array<double, Dim>> coefficients = values;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t span = span_of(knots, sites[i], order);
    const Values B = basis(knots, span, sites[i], order)[order - 1];
    for (int j = 0; j < order; ++j) {
      const std::ptrdiff_t band =
          static_cast<std::ptrdiff_t>(span + 1 + j - order) - static_cast<std::ptrdiff_t>(i) + kHalf;
      if (band >= 0 && band < 2 * kHalf + 1) A[i][band] = B[j];
    }
  }
  solve_banded<Dim>(A, coefficients);

  // B-spline coefficients -> Taylor coefficients at the left end of each piece: differences of the coefficients give
  // those of the derivatives, one order lower each.
  PiecewiseQuintic<Dim> spline;
  spline.breaks.push_back(sites.front());
  spline.breaks.insert(spline.breaks.end(), interior.begin(), interior.end());
  spline.breaks.push_back(sites.back());
  spline.pieces.resize(interior.size() + 1);
  for (std::size_t p = 0; p < spline.pieces.size(); ++p) {
    const std::size_t span = p + order - 1;
    const auto B = basis(knots, span, knots[span], order);
    auto& piece = spline.pieces[p];
    piece = {};
    for (int c = 0; c < Dim; ++c) {
      Values local{};
      for (int j = 0; j < order; ++j) local[j] = coefficients[span + 1 + j - order][c];
      double factorial = 1.0;
      for (int d = 0; d < order; ++d) {
        const int k = order - d;  // order of the d-th derivative
        double sum = 0.0;
        for (int j = 0; j < k; ++j) sum += local[j] * B[k - 1][j];
        piece[d][c] = sum / factorial;
        factorial *= d + 1;
        for (int j = 0; j + 1 < k; ++j) {
          const std::size_t m = span + 2 + j - k;
          local[j] = (k - 1) * (local[j + 1] - local[j]) / (knots[m + k - 1] - knots[m]);
        }
      }
    }
  }
  return spline;
}

}  // namespace

template <int Dim>
std::size_t PiecewiseQuintic<Dim>::piece_of(double t) const {
  return static_cast<std::size_t>(std::upper_bound(breaks.begin() + 1, breaks.end() - 1, t) - breaks.begin()) - 1;
}

template <int Dim>
typename PiecewiseQuintic<Dim>::Piece PiecewiseQuintic<Dim>::derivatives(double t) const {
  const std::size_t p = piece_of(t);
  return piece_derivatives<Dim>(pieces[p], t - breaks[p]);
}

template <int Dim>
PiecewiseQuintic<Dim> interpolate_quintic(const std::vector<double>& nodes,
                                          const std::vector<std::array<double, Dim>>& values) {
  const int order = static_cast<int>(std::min<std::size_t>(kMaxOrder, nodes.size()));
  std::vector<double> interior;
  if (nodes.size() > kMaxOrder) interior.assign(nodes.begin() + 3, nodes.end() - 3);  // not-a-knot
  return solve_spline<Dim>(interior, nodes, values, order);
}

template <int Dim>
PiecewiseQuintic<Dim> interpolate_quintic(const std::vector<double>& interior_knots, const std::vector<double>& sites,
                                          const std::vector<std::array<double, Dim>>& values) {
  return solve_spline<Dim>(interior_knots, sites, values, kMaxOrder);
}

template struct PiecewiseQuintic<1>;
template struct PiecewiseQuintic<3>;
template PiecewiseQuintic<1> interpolate_quintic<1>(const std::vector<double>&,
                                                    const std::vector<std::array<double, 1>>&);
template PiecewiseQuintic<3> interpolate_quintic<3>(const std::vector<double>&,
                                                    const std::vector<std::array<double, 3>>&);
template PiecewiseQuintic<1> interpolate_quintic<1>(const std::vector<double>&, const std::vector<double>&,
                                                    const std::vector<std::array<double, 1>>&);
template PiecewiseQuintic<3> interpolate_quintic<3>(const std::vector<double>&, const std::vector<double>&,
                                                    const std::vector<std::array<double, 3>>&);

}  // namespace tendril::geometry

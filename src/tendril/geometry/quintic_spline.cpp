#include "tendril/geometry/quintic_spline.hpp"

#include <algorithm>
#include <cmath>

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

std::vector<double> open_knots(const std::vector<double>& interior, double from, double to, int order) {
  std::vector<double> knots(order, from);
  knots.insert(knots.end(), interior.begin(), interior.end());
  knots.insert(knots.end(), order, to);
  return knots;
}

// Knots at the nodes, without the two next to each end (not-a-knot).
std::vector<double> not_a_knot(const std::vector<double>& nodes) {
  if (nodes.size() <= kMaxOrder) return {};
  return {nodes.begin() + 3, nodes.end() - 3};
}

// Row i: B-splines at site i, around the diagonal.
std::vector<Row> collocation_matrix(const std::vector<double>& knots, const std::vector<double>& sites, int order) {
  std::vector<Row> A(sites.size(), Row{});
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const std::size_t span = span_of(knots, sites[i], order);
    const Values B = basis(knots, span, sites[i], order)[order - 1];
    for (int j = 0; j < order; ++j) {
      const auto band = static_cast<std::ptrdiff_t>(span + 1 + j - order) - static_cast<std::ptrdiff_t>(i) + kHalf;
      if (band >= 0 && band < 2 * kHalf + 1) A[i][band] = B[j];
    }
  }
  return A;
}

// B-spline coefficients -> Taylor coefficients at the left end of each piece: differences of the coefficients give
// those of the derivatives, one order lower each.
template <int Dim>
PiecewiseQuintic<Dim> taylor_pieces(const std::vector<double>& knots, int order,
                                    const std::vector<std::array<double, Dim>>& coefficients) {
  PiecewiseQuintic<Dim> spline;
  spline.breaks.assign(knots.begin() + (order - 1), knots.end() - (order - 1));
  spline.pieces.resize(spline.breaks.size() - 1);
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

template <int Dim>
PiecewiseQuintic<Dim> solve_spline(const std::vector<double>& interior, const std::vector<double>& sites,
                                   const std::vector<std::array<double, Dim>>& values, int order) {
  const std::vector<double> knots = open_knots(interior, sites.front(), sites.back(), order);
  std::vector<Row> A = collocation_matrix(knots, sites, order);
  std::vector<std::array<double, Dim>> coefficients = values;
  solve_banded<Dim>(A, coefficients);
  return taylor_pieces<Dim>(knots, order, coefficients);
}

// Third-derivative coefficient j as a combination of coefficients j..j+3, times the root of its B-spline's integral.
std::array<double, 4> third_difference(const std::vector<double>& knots, int order, std::size_t j) {
  std::array<std::array<double, 4>, 4> c{};
  for (int i = 0; i < 4; ++i) c[i][i] = 1.0;
  for (int d = 1; d <= 3; ++d) {
    for (int i = 0; i + d < 4; ++i) {
      const double gap = knots[j + i + order] - knots[j + i + d];
      for (int m = 0; m < 4; ++m) c[i][m] = (order - d) * (c[i + 1][m] - c[i][m]) / gap;
    }
  }
  const double weight = std::sqrt((knots[j + order] - knots[j + 3]) / (order - 3));
  for (double& value : c[0]) value *= weight;
  return c[0];
}

// Smoothing splines of given data on given interior knots: the normal equations BᵀB + λ DᵀD of the coefficients, with B
// the B-splines at the nodes and D their third differences.
template <int Dim>
class Smoother {
 public:
  using Data = std::vector<std::array<double, Dim>>;

  Smoother(const std::vector<double>& nodes, const Data& values, const std::vector<double>& interior)
      : order_(static_cast<int>(std::min<std::size_t>(kMaxOrder, nodes.size()))),
        knots_(open_knots(interior, nodes.front(), nodes.back(), order_)),
        values_(values) {
    const std::size_t n = knots_.size() - static_cast<std::size_t>(order_);
    fit_.assign(n, Row{});
    rough_.assign(n, Row{});
    for (const double node : nodes) {
      const std::size_t span = span_of(knots_, node, order_);
      first_.push_back(span + 1 - static_cast<std::size_t>(order_));
      B_.push_back(basis(knots_, span, node, order_)[order_ - 1]);
      for (int p = 0; p < order_; ++p) {
        for (int q = 0; q < order_; ++q) fit_[first_.back() + p][q - p + kHalf] += B_.back()[p] * B_.back()[q];
      }
    }
    for (std::size_t j = 0; j + 3 < n; ++j) {
      D_.push_back(third_difference(knots_, order_, j));
      for (int p = 0; p < 4; ++p) {
        for (int q = 0; q < 4; ++q) rough_[j + p][q - p + kHalf] += D_[j][p] * D_[j][q];
      }
    }
  }

  PiecewiseQuintic<Dim> spline(double lambda) const {
    constexpr int kRefinements = 3;
    std::vector<Row> A = fit_;
    for (std::size_t i = 0; i < A.size(); ++i) {
      for (int p = 0; p <= 2 * kHalf; ++p) A[i][p] += lambda * rough_[i][p];
    }
    Data x(A.size(), std::array<double, Dim>{});
    for (int round = 0; round <= kRefinements; ++round) {
      std::vector<Row> factors = A;
      Data step = residual(x, lambda);
      solve_banded<Dim>(factors, step);
      for (std::size_t i = 0; i < x.size(); ++i) {
        for (int c = 0; c < Dim; ++c) x[i][c] += step[i][c];
      }
    }
    return taylor_pieces<Dim>(knots_, order_, x);
  }

 private:
  // From the factors B and D, whose products with a smooth spline are small, not from the matrix, in which λ DᵀD has
  // rounded the rest away.
  Data residual(const Data& x, double lambda) const {
    Data r(x.size(), std::array<double, Dim>{});
    for (std::size_t i = 0; i < values_.size(); ++i) {
      for (int c = 0; c < Dim; ++c) {
        double misfit = values_[i][c];
        for (int p = 0; p < order_; ++p) misfit -= B_[i][p] * x[first_[i] + p][c];
        for (int p = 0; p < order_; ++p) r[first_[i] + p][c] += B_[i][p] * misfit;
      }
    }
    for (std::size_t j = 0; j < D_.size(); ++j) {
      for (int c = 0; c < Dim; ++c) {
        double third = 0.0;
        for (int p = 0; p < 4; ++p) third += D_[j][p] * x[j + p][c];
        for (int p = 0; p < 4; ++p) r[j + p][c] -= lambda * D_[j][p] * third;
      }
    }
    return r;
  }

  int order_;
  std::vector<double> knots_;
  const Data& values_;
  std::vector<std::size_t> first_;  // coefficient of the first B-spline at each node
  std::vector<Values> B_;
  std::vector<std::array<double, 4>> D_;
  std::vector<Row> fit_, rough_;
};

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
  return solve_spline<Dim>(not_a_knot(nodes), nodes, values, order);
}

template <int Dim>
PiecewiseQuintic<Dim> interpolate_quintic(const std::vector<double>& interior_knots, const std::vector<double>& sites,
                                          const std::vector<std::array<double, Dim>>& values) {
  return solve_spline<Dim>(interior_knots, sites, values, kMaxOrder);
}

template <int Dim>
PiecewiseQuintic<Dim> smooth_quintic(const std::vector<double>& nodes,
                                     const std::vector<std::array<double, Dim>>& values, double tolerance) {
  const std::size_t n = nodes.size();
  if (n < 4) return interpolate_quintic<Dim>(nodes, values);
  const auto deviation = [&](const PiecewiseQuintic<Dim>& spline) {
    double largest = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const auto value = spline.derivatives(nodes[i])[0];
      double square = 0.0;
      for (int c = 0; c < Dim; ++c) square += (value[c] - values[i][c]) * (value[c] - values[i][c]);
      largest = std::max(largest, square);
    }
    return std::sqrt(largest);
  };
  // Largest λ = spacing^5 10^e whose spline stays within the tolerance: the deviation grows with λ. Beyond the highest
  // the spline is the parabola of least squares and the matrix only rounding.
  const double spacing = (nodes.back() - nodes.front()) / static_cast<double>(n - 1);
  const auto weight = [&](double exponent) { return std::pow(spacing, 5) * std::pow(10.0, exponent); };
  double low = -8.0, high = std::clamp(6.0 * std::log10(static_cast<double>(n)) - 3.0, -4.0, 13.0);
  PiecewiseQuintic<Dim> best;
  const std::vector<double> all = not_a_knot(nodes);
  const Smoother<Dim> fine(nodes, values, all);
  for (int step = 0; step < 14; ++step) {
    const double exponent = step == 0 ? high : 0.5 * (low + high);
    PiecewiseQuintic<Dim> spline = fine.spline(weight(exponent));
    if (deviation(spline) <= tolerance) {
      best = std::move(spline);
      low = exponent;
      if (step == 0) break;
    } else if (step > 0) {
      high = exponent;
    }
  }
  if (best.pieces.empty()) return interpolate_quintic<Dim>(nodes, values);

  // Waves shorter than 2π 10^(e/6) spacings are damped, so about six knots for that length say all there is to say;
  // each knot is a mesh point of every solve.
  for (auto every = static_cast<std::size_t>(std::pow(10.0, low / 6.0)); every >= 2; every /= 2) {
    std::vector<double> some;
    for (std::size_t i = every / 2; i < all.size(); i += every) some.push_back(all[i]);
    const Smoother<Dim> coarse(nodes, values, some);
    for (const double less : {0.0, 0.05, 0.15, 0.3}) {
      PiecewiseQuintic<Dim> spline = coarse.spline(weight(low - less));
      if (deviation(spline) <= tolerance) return spline;
    }
  }
  return best;
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
template PiecewiseQuintic<1> smooth_quintic<1>(const std::vector<double>&, const std::vector<std::array<double, 1>>&,
                                               double);
template PiecewiseQuintic<3> smooth_quintic<3>(const std::vector<double>&, const std::vector<std::array<double, 3>>&,
                                               double);

}  // namespace tendril::geometry

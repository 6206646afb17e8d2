#include "tendril/geometry/spline_axis.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "tendril/geometry/error.hpp"

namespace tendril::geometry {

namespace {

constexpr int kTerms = 12;  // power series to degree 11
using Series = std::array<double, kTerms>;
using Coefficients = PiecewiseQuintic<3>::Piece;

Series multiply(const Series& a, const Series& b) {
  Series c{};
  for (int i = 0; i < kTerms; ++i) {
    for (int j = 0; i + j < kTerms; ++j) c[i + j] += a[i] * b[j];
  }
  return c;
}

Series divide(const Series& a, const Series& b) {
  Series c{};
  for (int i = 0; i < kTerms; ++i) {
    double sum = a[i];
    for (int j = 0; j < i; ++j) sum -= c[j] * b[i - j];
    c[i] = sum / b[0];
  }
  return c;
}

Series square_root(const Series& a) {
  Series c{};
  c[0] = std::sqrt(a[0]);
  for (int i = 1; i < kTerms; ++i) {
    double sum = a[i];
    for (int j = 1; j < i; ++j) sum -= c[j] * c[i - j];
    c[i] = sum / (2.0 * c[0]);
  }
  return c;
}

// x(σ) from σ(x) = Σ_{k>=1} s_k x^k: Lagrange, [σ^k] x = (1/k) [x^{k-1}] (x/σ)^k.
Series reversion(const Series& s) {
  Series shifted{}, one{}, inverse{};
  for (int i = 0; i + 1 < kTerms; ++i) shifted[i] = s[i + 1];
  one[0] = 1.0;
  const Series u = divide(one, shifted);
  Series power = one;
  for (int k = 1; k < kTerms; ++k) {
    power = multiply(power, u);
    inverse[k] = power[k - 1] / k;
  }
  return inverse;
}

double evaluate(const Series& a, double x) {
  double sum = 0.0;
  for (int i = kTerms; i-- > 0;) sum = sum * x + a[i];
  return sum;
}

Vec3 vec(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

constexpr double kSlowest = 0.05;  // speed |R'| relative to its mean on the piece
constexpr int kTwistTerms = 7;     // ψ = Σ_{j=0}^{6} twist[j] x^{3+j}

struct Cell {
  double S_mid;
  std::array<double, kTerms - 1> x;       // x = Σ x[j] σ^{j+1}, σ = S - S_mid
  std::array<double, kTwistTerms> twist;  // ψ(x)
  Coefficients R;                         // Taylor coefficients at the middle
  Vec3 D1;                                // Bishop frame at the middle

  double parameter(double sigma) const {
    double sum = 0.0;
    for (int j = kTerms - 1; j-- > 0;) sum = sum * sigma + x[j];
    return sum * sigma;
  }
  double angle(double at_x) const {
    double sum = 0.0;
    for (int j = kTwistTerms; j-- > 0;) sum = sum * at_x + twist[j];
    return sum * at_x * at_x * at_x;
  }
};

class SplineAxis final : public Axis {
 public:
  std::vector<double> starts;  // S at the left end of each cell, ascending
  std::vector<Cell> cells;
  std::vector<std::uint32_t> bucket;  // cell that holds S = i length / buckets
  std::vector<double> knot_places;
  double total = 0.0;

  double length() const override { return total; }
  const std::vector<double>& knots() const override { return knot_places; }

  void index() {
    bucket.resize(cells.size() + 1);
    std::uint32_t cell = 0;
    for (std::size_t i = 0; i < bucket.size(); ++i) {
      const double S = total * static_cast<double>(i) / static_cast<double>(cells.size());
      while (cell + 1 < cells.size() && starts[cell + 1] <= S) ++cell;
      bucket[i] = cell;
    }
  }

  std::size_t cell_of(double S) const {
    const double n = static_cast<double>(cells.size());
    const double place = std::max(0.0, std::min(n - 1.0, S / total * n));
    const auto i = static_cast<std::size_t>(place);
    auto first = starts.begin() + bucket[i];
    auto last = starts.begin() + bucket[i + 1] + 1;
    if (first != starts.begin() && S < *first) --first;  // rounding of the quotient
    if (last != starts.end() && S >= *last) ++last;
    const auto it = std::upper_bound(first, last, S);
    return it == starts.begin() ? 0 : static_cast<std::size_t>(it - starts.begin()) - 1;
  }

  AxisPoint at(double S) const override {
    const Cell& cell = cells[cell_of(S)];
    const double x = cell.parameter(S - cell.S_mid);
    const Coefficients d = piece_derivatives<3>(cell.R, x);
    const Vec3 p1 = vec(d[1]), p2 = vec(d[2]), p3 = vec(d[3]), p4 = vec(d[4]), p5 = vec(d[5]);

    AxisPoint point;
    point.position = vec(d[0]);

    // x', x'', x''', x'''' with respect to S, from x'^-2 = R_x.R_x.
    const double x1 = 1.0 / p1.norm();
    const double A = p1.dot(p2), A1 = p2.dot(p2) + p1.dot(p3), A2 = 3.0 * p2.dot(p3) + p1.dot(p4);
    const double x1_2 = x1 * x1, x1_3 = x1_2 * x1, x1_4 = x1_2 * x1_2;
    const double x2 = -x1_4 * A;
    const double x3 = -4.0 * x1_3 * x2 * A - x1_4 * x1 * A1;
    const double x4 = -(12.0 * x1_2 * x2 * x2 + 4.0 * x1_3 * x3) * A - 9.0 * x1_4 * x2 * A1 - x1_3 * x1_3 * A2;

    // Frame: minimal rotation from the middle, then the angle ψ about D3.
    const Vec3 t = x1 * p1;
    const Vec3 t_mid = vec(cell.R[1]).normalized();
    const Vec3 sum = (t + t_mid) / (1.0 + t.dot(t_mid));
    const Vec3 k1 = cell.D1 - t.dot(cell.D1) * sum;
    const Vec3 k2 = t.cross(k1);
    const double psi = cell.angle(x), c = std::cos(psi), s = std::sin(psi);
    const Vec3 D1 = c * k1 + s * k2, D2 = c * k2 - s * k1;
    point.frame << D1, D2, t;

    // Parts of R'', R''', R'''', R''''' across D3 (Faà di Bruno; terms along p1 drop out).
    const auto across = [&](const Vec3& a) { return Eigen::Vector2d(a.dot(D1), a.dot(D2)); };
    const Eigen::Vector2d q2 = across(p2), q3 = across(p3), q4 = across(p4), q5 = across(p5);
    const Eigen::Vector2d R2 = x1_2 * q2;
    const Eigen::Vector2d R3 = x1_3 * q3 + 3.0 * x1 * x2 * q2;
    const Eigen::Vector2d R4 = x1_4 * q4 + 6.0 * x1_2 * x2 * q3 + (4.0 * x1 * x3 + 3.0 * x2 * x2) * q2;
    const Eigen::Vector2d R5 = x1_4 * x1 * q5 + 10.0 * x1_3 * x2 * q4 + (10.0 * x1_2 * x3 + 15.0 * x1 * x2 * x2) * q3 +
                               (5.0 * x1 * x4 + 10.0 * x2 * x3) * q2;
    // W = (R''.D1, R''.D2) = (U2, -U1) and, with D_j' = -(R''.D_j) D3 and K = |W|²,
    // W' = R'''_⊥, W'' = R''''_⊥ + K W, W''' = R'''''_⊥ + 5/2 K' W + K W'.
    const double K = R2.squaredNorm(), K1 = 2.0 * R2.dot(R3);
    const Eigen::Vector2d W2 = R4 + K * R2, W3 = R5 + 2.5 * K1 * R2 + K * R3;
    point.U = {Vec3(-R2[1], R2[0], 0.0), Vec3(-R3[1], R3[0], 0.0), Vec3(-W2[1], W2[0], 0.0), Vec3(-W3[1], W3[0], 0.0)};
    return point;
  }
};

// Series of one trial cell of half width h about its middle, in x.
struct Expansion {
  Series sigma;    // arc length from the middle
  Series x;        // x(σ)
  Series twist;    // ψ(x)
  bool converged;  // both series end below rounding
};

Expansion expand(const Coefficients& R, double h) {
  Series q{}, tangent{}, triple{};
  const Vec3 t = vec(R[1]).normalized();
  std::array<Vec3, 5> d{};  // R_x = Σ d[j] x^j
  for (int j = 0; j < 5; ++j) d[j] = (j + 1.0) * vec(R[j + 1]);
  for (int i = 0; i < 5; ++i) {
    tangent[i] = d[i].dot(t);
    for (int j = 0; j < 5; ++j) {
      q[i + j] += d[i].dot(d[j]);
      if (j > 0) triple[i + j - 1] += j * d[i].cross(d[j]).dot(t);  // t.(R_x x R_xx)
    }
  }
  const Series v = square_root(q);
  Series denominator = multiply(v, tangent);
  for (int i = 0; i < kTerms; ++i) denominator[i] += q[i];
  const Series rate = divide(triple, denominator);  // ψ_x = (g1 g2' - g1' g2)/(1 + g3)

  Expansion e{};
  for (int i = 0; i + 1 < kTerms; ++i) {
    e.sigma[i + 1] = v[i] / (i + 1);
    e.twist[i + 1] = rate[i] / (i + 1);
  }
  e.x = reversion(e.sigma);

  constexpr double kTail = 2e-15;  // last kept terms, relative to the cell (x) or in rad (ψ)
  const double half_length = v[0] * h;
  double tail_x = 0.0, tail_twist = 0.0;
  for (int k : {kTerms - 2, kTerms - 1}) {
    tail_x = std::max(tail_x, std::abs(e.x[k]) * std::pow(half_length, k) / h);
    tail_x = std::max(tail_x, std::abs(e.sigma[k]) * std::pow(h, k) / half_length);
  }
  for (int k : {kTwistTerms + 1, kTwistTerms + 2})
    tail_twist = std::max(tail_twist, std::abs(e.twist[k]) * std::pow(h, k));
  e.converged = tail_x <= kTail && tail_twist <= kTail;
  return e;
}

Coefficients recentred(const Coefficients& piece, double x) {
  Coefficients d = piece_derivatives<3>(piece, x);
  double factorial = 1.0;
  for (int j = 1; j < 6; ++j) {
    factorial *= j;
    for (double& value : d[j]) value /= factorial;
  }
  return d;
}

// Neumaier's compensated sum: arc length keeps its digits over 10^6 cells.
struct Sum {
  double value = 0.0, rest = 0.0;
  void add(double x) {
    const double next = value + x;
    rest += std::abs(value) >= std::abs(x) ? (value - next) + x : (x - next) + value;
    value = next;
  }
  double total() const { return value + rest; }
};

GeometryError stops(double S, double ratio) {
  return GeometryError({"axis", S, ratio, kSlowest,
                        "the smooth curve through the points stops or turns back at S = " + number_text(S) +
                            " (speed " + number_text(ratio) + " of its mean, at least " + number_text(kSlowest) +
                            " is needed)",
                        "remove stray or doubled points there, or allow smoothing"});
}

GeometryError kinks(double S, double radius, double smallest) {
  return GeometryError({"axis", S, radius, smallest,
                        "the smooth curve through the points has a kink at S = " + number_text(S) +
                            " (radius of curvature about " + number_text(radius) + ", less than a thousandth of the " +
                            "distance of the points there)",
                        "remove stray or doubled points there, or allow smoothing"});
}

}  // namespace

AxisPtr make_spline_axis(const PiecewiseQuintic<3>& curve, const Normal& normal) {
  constexpr int kDeepest = 10;  // halvings of a piece: cells down to 1/1024 of it
  auto axis = std::make_shared<SplineAxis>();
  axis->cells.reserve(curve.pieces.size());
  axis->starts.reserve(curve.pieces.size());
  Sum S;
  Vec3 D1 = Vec3::Zero(), t_left = Vec3::Zero();  // Bishop frame at the left end of the coming cell

  struct Span {
    double from, to;
    int depth;
  };
  std::vector<Span> todo;
  for (std::size_t p = 0; p < curve.pieces.size(); ++p) {
    if (p > 0) axis->knot_places.push_back(S.total());
    const double width = curve.breaks[p + 1] - curve.breaks[p];
    const Coefficients& piece = curve.pieces[p];
    const double mean_speed = (vec(piece_derivatives<3>(piece, width)[0]) - vec(piece[0])).norm() / width;
    todo.push_back({0.0, width, 0});
    while (!todo.empty()) {
      const Span span = todo.back();
      todo.pop_back();
      const double middle = 0.5 * (span.from + span.to), h = 0.5 * (span.to - span.from);
      Cell cell{};
      cell.R = recentred(piece, middle);
      const double speed = vec(cell.R[1]).norm();
      if (!(speed > kSlowest * mean_speed)) throw stops(S.total(), speed / mean_speed);
      const Expansion e = expand(cell.R, h);
      const Vec3 t_mid = vec(cell.R[1]) / speed;
      const Vec3 t_from = vec(piece_derivatives<3>(piece, span.from)[1]).normalized();
      const Vec3 t_to = vec(piece_derivatives<3>(piece, span.to)[1]).normalized();
      if (!e.converged || t_from.dot(t_mid) < 0.7 || t_to.dot(t_mid) < 0.7) {
        if (span.depth == kDeepest) {
          const Vec3 d2 = 2.0 * vec(cell.R[2]);
          throw kinks(S.total(), speed * speed / (d2 - d2.dot(t_mid) * t_mid).norm(), speed * width / 1024.0);
        }
        todo.push_back({middle, span.to, span.depth + 1});
        todo.push_back({span.from, middle, span.depth + 1});
        continue;
      }
      std::copy(e.x.begin() + 1, e.x.end(), cell.x.begin());
      std::copy_n(e.twist.begin() + 3, kTwistTerms, cell.twist.begin());

      if (axis->cells.empty()) {
        const Vec3 d1 = vec(piece[1]), d2 = 2.0 * vec(piece[2]);
        const Vec3 curvature = (d2 - d2.dot(t_from) * t_from) / d1.squaredNorm();
        const double whole = curve.breaks.back() - curve.breaks.front();
        D1 = starting_frame(t_from, normal, curvature, 1e-9 / (whole * d1.norm())).col(0);
        t_left = t_from;
      }
      // Back from the left end to the middle: undo ψ, then the minimal rotation t_left -> t_mid.
      const double psi = cell.angle(-h);
      const Vec3 k1 = std::cos(psi) * D1 - std::sin(psi) * t_left.cross(D1);
      Vec3 d1 = k1 - t_mid.dot(k1) * (t_left + t_mid) / (1.0 + t_left.dot(t_mid));
      cell.D1 = (d1 - d1.dot(t_mid) * t_mid).normalized();

      axis->starts.push_back(S.total());
      S.add(-evaluate(e.sigma, -h));
      cell.S_mid = S.total();
      S.add(evaluate(e.sigma, h));
      const Vec3 right = cell.D1 - t_to.dot(cell.D1) * (t_to + t_mid) / (1.0 + t_to.dot(t_mid));
      const double psi_right = cell.angle(h);
      D1 = std::cos(psi_right) * right + std::sin(psi_right) * t_to.cross(right);
      t_left = t_to;
      axis->cells.push_back(cell);
    }
  }
  axis->total = S.total();
  axis->index();
  return axis;
}

std::vector<double> arc_lengths(const PiecewiseQuintic<3>& curve, const std::vector<double>& t) {
  // Gauss-Legendre, eight points: only used to choose parameters, not for the axis itself.
  constexpr std::array<double, 4> node{0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
  constexpr std::array<double, 4> weight{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                         0.1012285362903763};
  std::vector<double> S(t.size(), 0.0);
  Sum sum;
  double from = curve.breaks.front();
  std::size_t p = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    while (from < t[i]) {
      while (p + 1 < curve.pieces.size() && curve.breaks[p + 1] <= from) ++p;
      const double to = p + 1 < curve.pieces.size() ? std::min(t[i], curve.breaks[p + 1]) : t[i];
      const double middle = 0.5 * (from + to) - curve.breaks[p], h = 0.5 * (to - from);
      double part = 0.0;
      for (int g = 0; g < 4; ++g) {
        part += weight[g] * (vec(piece_derivatives<3>(curve.pieces[p], middle - h * node[g])[1]).norm() +
                             vec(piece_derivatives<3>(curve.pieces[p], middle + h * node[g])[1]).norm());
      }
      sum.add(h * part);
      from = to;
    }
    S[i] = sum.total();
  }
  return S;
}

}  // namespace tendril::geometry

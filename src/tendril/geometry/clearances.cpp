#include "tendril/geometry/clearances.hpp"

#include <algorithm>
#include <cmath>

#include "tendril/geometry/error.hpp"
#include "tendril/geometry/quintic_spline.hpp"

namespace tendril::geometry {

namespace {

class ConstantClearance final : public Clearance {
 public:
  explicit ConstantClearance(double q) : q_(q) {}
  std::array<double, 5> at(double) const override { return {q_, 0.0, 0.0, 0.0, 0.0}; }
  const std::vector<double>& knots() const override { return knots_; }

 private:
  double q_;
  std::vector<double> knots_;
};

class TableClearance final : public Clearance {
 public:
  explicit TableClearance(PiecewiseQuintic<1> spline) : spline_(std::move(spline)) {
    knots_.assign(spline_.breaks.begin() + 1, spline_.breaks.end() - 1);
  }
  std::array<double, 5> at(double S) const override {
    const auto d = spline_.derivatives(S);
    return {d[0][0], d[1][0], d[2][0], d[3][0], d[4][0]};
  }
  const std::vector<double>& knots() const override { return knots_; }

 private:
  PiecewiseQuintic<1> spline_;
  std::vector<double> knots_;
};

// Degree 7 between nodes, slopes limited as below, second and third derivatives 0 at the nodes: C3 and monotone between
// nodes. With u from 0 to 1 and δ the chord's slope, q' = u³(1-u)³ (140 δ - 70 m0 - 70 m1) + m0 (1-u)³(1+3u+6u²)
// + m1 u³(1+3(1-u)+6(1-u)²) keeps the sign of δ if m0 and m1 have it and are no steeper than δ.
class MonotoneClearance final : public Clearance {
 public:
  MonotoneClearance(const std::vector<double>& S, const std::vector<double>& q) : nodes_(S) {
    const std::size_t n = S.size();
    std::vector<double> chord(n - 1), m(n);
    for (std::size_t i = 0; i + 1 < n; ++i) chord[i] = (q[i + 1] - q[i]) / (S[i + 1] - S[i]);
    m.front() = chord.front();
    m.back() = chord.back();
    for (std::size_t i = 1; i + 1 < n; ++i) {
      const double a = chord[i - 1], b = chord[i];
      m[i] = a * b > 0.0 ? std::copysign(std::min(std::abs(a), std::abs(b)), a) : 0.0;
    }
    for (std::size_t i = 0; i + 1 < n; ++i) {
      // q = q0 + h m0 u + u⁴ (a + b u + c u² + d u³); D and d are the value and slope left over at u = 1.
      const double h = S[i + 1] - S[i], D = q[i + 1] - q[i] - h * m[i], d = h * (m[i + 1] - m[i]);
      pieces_.push_back({q[i], m[i], 35 * D - 15 * d, -84 * D + 39 * d, 70 * D - 34 * d, -20 * D + 10 * d});
    }
    knots_.assign(S.begin() + 1, S.end() - 1);
  }
  std::array<double, 5> at(double S) const override {
    const auto end = nodes_.end() - 1;
    const auto i = static_cast<std::size_t>(std::upper_bound(nodes_.begin() + 1, end, S) - nodes_.begin()) - 1;
    const double h = nodes_[i + 1] - nodes_[i], x = S - nodes_[i], u = x / h;
    const auto& [q0, m0, a, b, c, d] = pieces_[i];
    const double u2 = u * u, u3 = u2 * u, h2 = h * h;
    return {q0 + m0 * x + u2 * u2 * (a + u * (b + u * (c + u * d))),
            m0 + u3 * (4 * a + u * (5 * b + u * (6 * c + u * 7 * d))) / h,
            u2 * (12 * a + u * (20 * b + u * (30 * c + u * 42 * d))) / h2,
            u * (24 * a + u * (60 * b + u * (120 * c + u * 210 * d))) / (h2 * h),
            (24 * a + u * (120 * b + u * (360 * c + u * 840 * d))) / (h2 * h2)};
  }
  const std::vector<double>& knots() const override { return knots_; }

 private:
  std::vector<double> nodes_, knots_;
  std::vector<std::array<double, 6>> pieces_;
};

// Whether the curve leaves the range of the two neighbouring nodes by more than a quarter of the largest step nearby
// (a parabola sampled at three nodes leaves it by an eighth).
bool swings(const PiecewiseQuintic<1>& spline, const std::vector<double>& S, const std::vector<double>& q) {
  constexpr double kShare = 0.25;
  constexpr int kSamples = 8;
  for (std::size_t i = 0; i + 1 < S.size(); ++i) {
    double step = std::abs(q[i + 1] - q[i]);
    if (i > 0) step = std::max(step, std::abs(q[i] - q[i - 1]));
    if (i + 2 < S.size()) step = std::max(step, std::abs(q[i + 2] - q[i + 1]));
    const double low = std::min(q[i], q[i + 1]), high = std::max(q[i], q[i + 1]);
    const double slack = kShare * step + 1e-12 * high;
    for (int k = 1; k < kSamples; ++k) {
      const double value = spline.derivatives(S[i] + (S[i + 1] - S[i]) * k / kSamples)[0][0];
      if (value < low - slack || value > high + slack) return true;
    }
  }
  return false;
}

class AnalyticClearance final : public Clearance {
 public:
  AnalyticClearance(std::function<std::array<double, 5>(double)> law, std::vector<double> knots)
      : law_(std::move(law)), knots_(std::move(knots)) {}
  std::array<double, 5> at(double S) const override { return law_(S); }
  const std::vector<double>& knots() const override { return knots_; }

 private:
  std::function<std::array<double, 5>(double)> law_;
  std::vector<double> knots_;
};

class ScaledClearance final : public Clearance {
 public:
  ScaledClearance(ClearancePtr base, double factor) : base_(std::move(base)), factor_(factor) {}
  std::array<double, 5> at(double S) const override {
    auto q = base_->at(S);
    for (double& value : q) value *= factor_;
    return q;
  }
  const std::vector<double>& knots() const override { return base_->knots(); }

 private:
  ClearancePtr base_;
  double factor_;
};

// Lowers `best` to the smallest value of a quintic in Bernstein form: a part whose coefficients all lie above the best
// value so far cannot hold the minimum (convex hull), the others are halved.
void lower(std::array<double, 6> b, int depth, double resolution, double& best) {
  best = std::min({best, b[0], b[5]});
  if (*std::min_element(b.begin(), b.end()) >= best - resolution || depth == 0) return;
  std::array<double, 6> left{};
  for (int k = 0; k < 6; ++k) {  // de Casteljau at the middle; b becomes the right half
    left[k] = b[0];
    for (int j = 0; j < 5 - k; ++j) b[j] = 0.5 * (b[j] + b[j + 1]);
  }
  lower(left, depth - 1, resolution, best);
  lower(b, depth - 1, resolution, best);
}

double piece_minimum(const PiecewiseQuintic<1>::Piece& piece, double width) {
  constexpr double kBinomial[6][6] = {{1, 0, 0, 0, 0, 0}, {1, 1, 0, 0, 0, 0}, {1, 2, 1, 0, 0, 0},
                                      {1, 3, 3, 1, 0, 0}, {1, 4, 6, 4, 1, 0}, {1, 5, 10, 10, 5, 1}};
  std::array<double, 6> a{}, b{};
  double power = 1.0;
  for (int j = 0; j < 6; ++j, power *= width) a[j] = piece[j][0] * power;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) b[i] += kBinomial[i][j] / kBinomial[5][j] * a[j];
  }
  double best = b[0];
  lower(b, 30, 1e-12 * std::abs(b[0]), best);
  return best;
}

bool stays_positive(const PiecewiseQuintic<1>& spline) {
  for (std::size_t p = 0; p < spline.pieces.size(); ++p) {
    if (!(piece_minimum(spline.pieces[p], spline.breaks[p + 1] - spline.breaks[p]) > 0.0)) return false;
  }
  return true;
}

void check_table(const std::vector<double>& S, const std::vector<double>& q, double length) {
  std::vector<Issue> issues;
  require_positive(issues, "length", length);
  if (S.size() != q.size() || S.empty()) {
    issues.push_back(
        {"clearance", 0.0, static_cast<double>(q.size()), static_cast<double>(S.size()),
         "the table has " + std::to_string(S.size()) + " places and " + std::to_string(q.size()) + " values",
         "one value for each place, at least one"});
  }
  throw_if_any(issues);
  for (std::size_t i = 0; i < S.size(); ++i) {
    const std::string entry = "clearance[" + std::to_string(i) + "]";
    if (!std::isfinite(S[i])) {
      issues.push_back({entry, 0.0, S[i], 0.0, "its place S is not a finite number", ""});
    } else if (i > 0 && !(S[i] > S[i - 1])) {
      issues.push_back(
          {entry, S[i], S[i], S[i - 1],
           "its place S = " + number_text(S[i]) + " is not beyond the one before, " + number_text(S[i - 1]),
           "places must ascend; model a step by a short taper"});
    }
    if (!(std::isfinite(q[i]) && q[i] > 0.0)) {
      issues.push_back({entry, S[i], q[i], 0.0,
                        "is " + number_text(q[i]) + " at S = " + number_text(S[i]) + ", must be greater than 0", ""});
    }
  }
  throw_if_any(issues);
  if (S.size() == 1) return;
  const double slack = 1e-6 * length;
  if (S.front() > slack) {
    issues.push_back({"clearance", 0.0, S.front(), slack,
                      "the table starts at S = " + number_text(S.front()) + ", the axis at 0", "cover the whole axis"});
  }
  if (S.back() < length - slack) {
    issues.push_back({"clearance", length, S.back(), length,
                      "the table ends at S = " + number_text(S.back()) + ", the axis at " + number_text(length),
                      "cover the whole axis"});
  }
  throw_if_any(std::move(issues));
}

}  // namespace

ClearancePtr make_constant(double clearance) {
  std::vector<Issue> issues;
  require_positive(issues, "clearance", clearance);
  throw_if_any(std::move(issues));
  return std::make_shared<ConstantClearance>(clearance);
}

ClearancePtr make_table(const std::vector<double>& S, const std::vector<double>& clearance, double length) {
  check_table(S, clearance, length);
  if (S.size() == 1) return make_constant(clearance[0]);
  std::vector<std::array<double, 1>> values(clearance.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i][0] = clearance[i];
  PiecewiseQuintic<1> spline = interpolate_quintic<1>(S, values);

  if (!stays_positive(spline) || swings(spline, S, clearance)) return std::make_shared<MonotoneClearance>(S, clearance);
  return std::make_shared<TableClearance>(std::move(spline));
}

FittedClearance make_smooth_table(const std::vector<double>& S, const std::vector<double>& clearance, double length,
                                  double tolerance) {
  FittedClearance fitted{nullptr, 0.0, 0.0};
  if (tolerance > 0.0 && S.size() > 3) {
    check_table(S, clearance, length);
    std::vector<std::array<double, 1>> values(clearance.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i][0] = clearance[i];
    PiecewiseQuintic<1> spline = smooth_quintic<1>(S, values, tolerance);
    if (stays_positive(spline)) fitted.clearance = std::make_shared<TableClearance>(std::move(spline));
  }
  if (!fitted.clearance) fitted.clearance = make_table(S, clearance, length);
  for (std::size_t i = 0; i < S.size(); ++i) {
    const double deviation = std::abs(fitted.clearance->at(S[i])[0] - clearance[i]);
    if (deviation > fitted.largest_deviation) fitted.largest_deviation = deviation, fitted.deviation_S = S[i];
  }
  return fitted;
}

ClearancePtr make_analytic(std::function<std::array<double, 5>(double)> law, std::vector<double> knots) {
  if (!law) throw GeometryError({"clearance", 0.0, 0.0, 0.0, "the law is empty", "give a callable"});
  std::sort(knots.begin(), knots.end());
  return std::make_shared<AnalyticClearance>(std::move(law), std::move(knots));
}

ClearancePtr scaled(ClearancePtr clearance, double factor) {
  std::vector<Issue> issues;
  require_positive(issues, "clearance.scale", factor);
  throw_if_any(std::move(issues));
  return std::make_shared<ScaledClearance>(std::move(clearance), factor);
}

}  // namespace tendril::geometry

#include "tendril/geometry/clearances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

struct Minimum {
  double x;  // as a fraction of the piece
  double value;
};

// Smallest value of a quintic in Bernstein form on [x0, x1] of its piece: a part whose coefficients all lie above the
// best value so far cannot hold the minimum (convex hull), the others are halved.
void lower(std::array<double, 6> b, double x0, double x1, double resolution, Minimum& best) {
  if (b[0] < best.value) best = {x0, b[0]};
  if (b[5] < best.value) best = {x1, b[5]};
  if (*std::min_element(b.begin(), b.end()) >= best.value - resolution || x1 - x0 < 1e-9) return;
  std::array<double, 6> left{};
  for (int k = 0; k < 6; ++k) {  // de Casteljau at the middle; b becomes the right half
    left[k] = b[0];
    for (int j = 0; j < 5 - k; ++j) b[j] = 0.5 * (b[j] + b[j + 1]);
  }
  const double middle = 0.5 * (x0 + x1);
  lower(left, x0, middle, resolution, best);
  lower(b, middle, x1, resolution, best);
}

Minimum piece_minimum(const PiecewiseQuintic<1>::Piece& piece, double width) {
  std::array<double, 6> a{}, b{};
  constexpr double kBinomial[6][6] = {{1, 0, 0, 0, 0, 0}, {1, 1, 0, 0, 0, 0}, {1, 2, 1, 0, 0, 0},
                                      {1, 3, 3, 1, 0, 0}, {1, 4, 6, 4, 1, 0}, {1, 5, 10, 10, 5, 1}};
  double power = 1.0;
  for (int j = 0; j < 6; ++j, power *= width) a[j] = piece[j][0] * power;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) b[i] += kBinomial[i][j] / kBinomial[5][j] * a[j];
  }
  Minimum best{0.0, b[0]};
  lower(b, 0.0, 1.0, 1e-12 * std::abs(b[0]), best);
  return best;
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

  std::vector<Issue> issues;
  for (std::size_t p = 0; p < spline.pieces.size(); ++p) {
    const double width = spline.breaks[p + 1] - spline.breaks[p];
    const Minimum least = piece_minimum(spline.pieces[p], width);
    if (least.value > 0.0) continue;
    const double place = spline.breaks[p] + least.x * width;
    issues.push_back({"clearance", place, least.value, 0.0,
                      "the smooth curve through the table falls to " + number_text(least.value) +
                          " at S = " + number_text(place) + ", between its nodes",
                      "add nodes where the clearance changes fast"});
  }
  throw_if_any(std::move(issues));
  return std::make_shared<TableClearance>(std::move(spline));
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

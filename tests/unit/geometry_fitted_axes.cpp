// Axes through points and from surveys: convergence to known curves, exactness at the data, true arc length, refusals.

#include <gtest/gtest.h>

#include <numbers>

#include "geometry_checks.hpp"
#include "tendril/geometry/axis_transforms.hpp"
#include "tendril/geometry/error.hpp"
#include "tendril/geometry/fitted_axes.hpp"

namespace {

using namespace tendril::geometry;
using geometry_checks::defects;

constexpr double kPi = std::numbers::pi;

std::vector<Vec3> sampled(const AxisPtr& axis, int hops) {
  std::vector<Vec3> points;
  for (int i = 0; i <= hops; ++i) points.push_back(axis->at(axis->length() * i / hops).position);
  return points;
}

// Largest position, curvature and frame error against the curve the points were taken from.
std::array<double, 3> errors(const Axis& fitted, const Axis& exact) {
  std::array<double, 3> worst{};
  for (int i = 0; i <= 500; ++i) {
    const double S = exact.length() * i / 500;
    const auto a = fitted.at(S), b = exact.at(S);
    worst[0] = std::max(worst[0], (a.position - b.position).norm());
    worst[1] = std::max(worst[1], (a.U[0] - b.U[0]).norm());
    worst[2] = std::max(worst[2], (a.frame - b.frame).norm());
  }
  return worst;
}

TEST(GeometryPoints, ConvergeToTheHelixWithTheOrderOfTheSpline) {
  const auto helix = make_helix(0.225, 0.785, 2.0);
  const Vec3 normal = helix->at(0.0).frame.col(0);
  const auto coarse = errors(*make_points(sampled(helix, 40), 0.0, normal).axis, *helix);
  const auto fine = errors(*make_points(sampled(helix, 80), 0.0, normal).axis, *helix);
  // Degree five: positions of order 6, curvatures of order 4; half an order is left for the pre-asymptotic range.
  EXPECT_GT(std::log2(coarse[0] / fine[0]), 5.5);
  EXPECT_GT(std::log2(coarse[1] / fine[1]), 3.5);
  EXPECT_GT(std::log2(coarse[2] / fine[2]), 4.5);
  EXPECT_LT(fine[0], 1e-8);
}

TEST(GeometryPoints, AreInterpolatedExactlyAndRunByArcLength) {
  // Uneven hops (factor 30) on a space curve that is not given by its arc length.
  std::vector<Vec3> points;
  double t = 0.0;
  for (int i = 0; i < 60; ++i) {
    points.emplace_back(std::sin(t), 0.5 * std::cos(2 * t), t + 0.2 * std::sin(3 * t));
    t += i % 7 == 3 ? 0.005 : 0.06 + 0.05 * std::sin(i);
  }
  const auto fitted = make_points(points);
  EXPECT_LT(fitted.largest_deviation, 1e-14);  // rounding of coordinates of size 3
  double polygon = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) polygon += (points[i] - points[i - 1]).norm();
  EXPECT_GT(fitted.axis->length(), polygon);
  EXPECT_LT((fitted.axis->at(0.0).position - points.front()).norm(), 1e-14);
  EXPECT_LT((fitted.axis->at(fitted.axis->length()).position - points.back()).norm(), 1e-14);

  const auto worst = defects(*fitted.axis, 1e-4, 400);
  // Differences at h = 1e-4: eps/h = 1e-12 for R and D; U''' is 1e4 times larger than U.
  EXPECT_LT(worst.tangent, 1e-10);
  EXPECT_LT(worst.frame, 1e-9);
  EXPECT_LT(worst.derivatives, 1e-7);
  EXPECT_LT(worst.orthonormal, 1e-14);
}

TEST(GeometryPoints, BishopFrameEqualsFineIntegration) {
  // D1' = -(R''.D1) D3 integrated from the axis' own tangent by many small minimal rotations of two reflections each
  // (double reflection, fourth order), Richardson-extrapolated.
  const auto axis = make_points(sampled(make_helix(0.3, 1.0, 2.0), 30)).axis;
  const auto transported = [&](int steps) {
    Vec3 D1 = axis->at(0.0).frame.col(0);
    for (int i = 0; i < steps; ++i) {
      const auto a = axis->at(axis->length() * i / steps), b = axis->at(axis->length() * (i + 1) / steps);
      const Vec3 v = b.position - a.position;
      const Vec3 D1_left = D1 - 2.0 / v.squaredNorm() * v.dot(D1) * v;
      const Vec3 t_left = a.frame.col(2) - 2.0 / v.squaredNorm() * v.dot(a.frame.col(2)) * v;
      const Vec3 w = b.frame.col(2) - t_left;
      D1 = D1_left - 2.0 / w.squaredNorm() * w.dot(D1_left) * w;
    }
    return D1;
  };
  const Vec3 coarse = transported(2000), fine = transported(4000);
  const Vec3 expected = fine + (fine - coarse) / 15.0;
  const Vec3 D1 = axis->at(axis->length()).frame.col(0);
  EXPECT_GT((D1 - axis->at(0.0).frame.col(0)).norm(), 0.1);  // it does turn
  EXPECT_LT((D1 - expected).norm(), 2e-11);                  // rounding of 4000 rotations through short chords
}

TEST(GeometryPoints, JumpOnlyAtKnotsAndOnlyInTheThirdDerivative) {
  const auto axis = make_points(sampled(make_helix(0.3, 1.0, 2.0), 20)).axis;
  ASSERT_EQ(axis->knots().size(), 15u);  // 19 interior points, not-a-knot at two on either side
  double largest_jump = 0.0;
  for (double knot : axis->knots()) {
    const auto left = axis->at(std::nextafter(knot, 0.0)), right = axis->at(knot);
    EXPECT_LT((left.position - right.position).norm(), 1e-14);
    EXPECT_LT((left.frame - right.frame).norm(), 1e-13);
    for (int j = 0; j < 3; ++j) EXPECT_LT((left.U[j] - right.U[j]).norm(), 1e-11 * std::pow(20.0, j));
    largest_jump = std::max(largest_jump, (left.U[3] - right.U[3]).norm());
  }
  EXPECT_GT(largest_jump, 1e-3);
}

TEST(GeometryPoints, AreDefinedSlightlyBeyondTheEnds) {
  const auto axis = make_points(sampled(make_helix(0.3, 1.0, 2.0), 20)).axis;
  const double beyond = 1e-6 * axis->length();
  for (double end : {0.0, axis->length()}) {
    const double step = end == 0.0 ? -beyond : beyond;
    const auto at = axis->at(end), out = axis->at(end + step);
    EXPECT_LT((out.position - at.position - step * at.frame.col(2)).norm(), 2.0 * beyond * beyond / 0.3);
    EXPECT_LT((out.U[2] - at.U[2] - step * at.U[3]).norm(), 1e-6 * at.U[3].norm());
  }
}

TEST(GeometryPoints, StraightAndFewPointsAreThePolynomial) {
  const auto line = make_points({{0, 0, 0}, {0, 0, 1}, {0, 0, 2.5}, {0, 0, 3}, {0, 0, 7}});
  EXPECT_NEAR(line.axis->length(), 7.0, 1e-14);
  EXPECT_LT((line.axis->at(4.2).position - Vec3(0, 0, 4.2)).norm(), 1e-13);
  EXPECT_LT(line.axis->at(4.2).U[0].norm(), 1e-13);
  EXPECT_LT((line.axis->at(4.2).frame - Mat3::Identity()).norm(), 1e-13);
  EXPECT_LT(make_points({{0, 0, 0}, {0, 0.1, 1}, {0, 0, 2}, {0.1, 0, 3}}).largest_deviation, 1e-14);
}

TEST(GeometryPoints, SmoothingUsesItsToleranceAndTakesTheNoiseOut) {
  const auto helix = make_helix(1.0, 1.2, 6.0);
  auto points = sampled(helix, 200);
  const double noise = 1e-3;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = static_cast<double>(i);
    points[i] += noise * Vec3(std::sin(12.9898 * x), std::sin(78.233 * x), std::sin(37.719 * x)) / std::sqrt(3.0);
  }
  const auto rough = make_points(points), smooth = make_points(points, 1.2 * noise);
  EXPECT_LE(smooth.largest_deviation, 1.2 * noise);
  EXPECT_GT(smooth.largest_deviation, 0.5 * noise);
  double rough_bend = 0.0, smooth_bend = 0.0;
  for (int i = 20; i <= 180; ++i) {
    rough_bend = std::max(rough_bend, rough.axis->at(rough.axis->length() * i / 200).U[0].norm());
    smooth_bend = std::max(smooth_bend, smooth.axis->at(smooth.axis->length() * i / 200).U[0].norm());
  }
  const double exact = std::pow(std::sin(1.2), 2);
  EXPECT_GT(rough_bend, 2.0 * exact);
  EXPECT_NEAR(smooth_bend, exact, 0.1 * exact);  // noise/arc² of the smoothing length (about 0.2) stays below a tenth
}

TEST(GeometryPoints, ASmoothedCurveHasKnotsForItsWavesNotForItsPoints) {
  const auto helix = make_helix(1.0, 1.2, 6.0);
  auto points = sampled(helix, 1000);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] += 0.0015 * Vec3(std::sin(12.9898 * i), std::cos(78.233 * i), 0);
  const auto smooth = make_points(points, 0.003);
  EXPECT_EQ(make_points(points).axis->knots().size(), points.size() - 6);
  EXPECT_LT(smooth.axis->knots().size(), 100u);  // a turn and a third
  EXPECT_LE(smooth.largest_deviation, 0.003);
  ASSERT_EQ(smooth.S.size(), points.size());
  EXPECT_EQ(smooth.S.front(), 0.0);
  EXPECT_NEAR(smooth.S.back(), smooth.axis->length(), 1e-12 * smooth.axis->length());
  for (std::size_t i = 0; i < points.size(); i += 7)
    EXPECT_LE((smooth.axis->at(smooth.S[i]).position - points[i]).norm(), smooth.largest_deviation * (1 + 1e-9));
}

TEST(GeometryPoints, RefuseWhatIsNoCurve) {
  const auto issue = [](const std::vector<Vec3>& points) {
    try {
      make_points(points);
    } catch (const GeometryError& error) {
      return error.issues.front();
    }
    return Issue{"accepted", 0, 0, 0, "", ""};
  };
  EXPECT_EQ(issue({{0, 0, 0}, {0, 0, 1}, {0, 0, 2}}).value, 3.0);
  const auto repeated = issue({{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}});
  EXPECT_EQ(repeated.field, "points[2]");
  EXPECT_EQ(repeated.S, 1.0);
  const auto kink = issue({{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0.1, 0, 1}, {0.2, 0, 0}});
  EXPECT_EQ(kink.field, "points[2]");
  EXPECT_EQ(kink.S, 2.0);
  EXPECT_GT(kink.value, 170.0);
  EXPECT_EQ(issue({{0, 0, 0}, {0, 0, 1}, {0, std::nan(""), 2}, {0, 0, 3}}).field, "points[2]");
  EXPECT_THROW(make_points({{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}}, -1.0), GeometryError);
}

TEST(GeometrySurvey, StraightAndSingleArcAreExact) {
  const auto line = make_survey({100, 150, 400}, {30, 30, 30}, {90, 90, 90}, 1e-3);
  EXPECT_NEAR(line.axis->length(), 300.0, 1e-12);
  EXPECT_LT((line.axis->at(300).position - Vec3(0, 150, 150 * std::sqrt(3.0))).norm(), 1e-11);
  EXPECT_LT(line.axis->at(120).U[0].norm(), 1e-14);

  // Build-up in the vertical plane towards north, 90 degrees over 900 m in stations 100 m apart: one circle.
  std::vector<double> md, inc, azi;
  for (int i = 0; i <= 9; ++i) {
    md.push_back(1000 + 100 * i);
    inc.push_back(10 * i);
    azi.push_back(360);
  }
  const auto arc = make_survey(md, inc, azi, 1e-3);
  const double radius = 1800 / kPi;
  for (double S : {0.0, 123.0, 500.0, 900.0}) {
    const Vec3 expected(radius * (1 - std::cos(S / radius)), 0, radius * std::sin(S / radius));
    EXPECT_LT((arc.axis->at(S).position - expected).norm(), 1e-7);  // quintic on pieces of 0.1 rad, radius 573
    EXPECT_NEAR(arc.axis->at(S).U[0].norm(), 1 / radius, 1e-8);
  }
  EXPECT_NEAR(arc.axis->length(), 900.0, 1e-11);
}

TEST(GeometrySurvey, StaysWithinTheAllowedDeviationAndOnTheMinimumCurvatureStations) {
  const std::vector<double> md{0, 300, 330, 360, 400, 430, 700}, inc{0, 0, 4, 10, 16, 18, 18},
      azi{0, 0, 350, 358, 6, 15, 15};
  // Minimum curvature by its own formula, ratio factor RF = 2/θ tan(θ/2).
  std::vector<Vec3> stations{Vec3::Zero()};
  const auto tangent = [&](std::size_t i) {
    const double a = inc[i] * kPi / 180, b = azi[i] * kPi / 180;
    return Vec3(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
  };
  double tightest = 0.0;
  for (std::size_t i = 1; i < md.size(); ++i) {
    const double angle = std::acos(std::min(1.0, tangent(i - 1).dot(tangent(i))));
    const double factor = angle > 0 ? 2 / angle * std::tan(angle / 2) : 1.0;
    stations.push_back(stations.back() + 0.5 * (md[i] - md[i - 1]) * factor * (tangent(i - 1) + tangent(i)));
    tightest = std::max(tightest, angle / (md[i] - md[i - 1]));
  }
  for (double allowed : {1e-2, 1e-3, 1e-4}) {
    const auto fitted = make_survey(md, inc, azi, allowed);
    EXPECT_LE(fitted.largest_deviation, allowed);
    EXPECT_NEAR(fitted.axis->length(), 700.0, 1e-11);
    EXPECT_LT(fitted.largest_place_shift, allowed);
    for (std::size_t i = 0; i < md.size(); ++i) {
      const auto p = fitted.axis->at(md[i]);
      EXPECT_LT((p.position - stations[i]).norm(), 1.001 * allowed);
      EXPECT_LT((p.frame.col(2) - tangent(i)).norm(), 0.01);
    }
    double bend = 0.0;
    for (int i = 0; i <= 7000; ++i) bend = std::max(bend, fitted.axis->at(0.1 * i).U[0].norm());
    EXPECT_LT(bend, 1.2 * tightest);  // the blends swing a little; a wrong wrap at north would give 40 times more
    const auto worst = defects(*fitted.axis, 0.05, 300);
    EXPECT_LT(worst.tangent, 1e-9);  // eps * 700 / 0.05
    EXPECT_LT(worst.frame, 1e-10);
    EXPECT_LT(worst.derivatives, 1e-5);  // U''' from R'''''
  }
}

TEST(GeometrySurvey, AzimuthsOfOneDirectionGiveTheSameHole) {
  const std::vector<double> md{0, 100, 200, 300}, inc{5, 10, 12, 15};
  const auto a = make_survey(md, inc, {359, 1, 2, 358}, 1e-3), b = make_survey(md, inc, {-1, 361 - 360, 2, -2}, 1e-3);
  for (double S : {50.0, 150.0, 300.0}) EXPECT_LT((a.axis->at(S).position - b.axis->at(S).position).norm(), 1e-10);
}

TEST(GeometrySurvey, RefusalsNameStationAndDepth) {
  try {
    make_survey({0, 30, 20, 90}, {0, 1, 200, 3}, {0, 0, 0, 1000}, 1e-3);
    FAIL();
  } catch (const GeometryError& error) {
    ASSERT_EQ(error.issues.size(), 3u);
    EXPECT_EQ(error.issues[0].field, "md[2]");
    EXPECT_EQ(error.issues[0].bound, 30.0);
    EXPECT_EQ(error.issues[1].field, "inclination[2]");
    EXPECT_EQ(error.issues[2].field, "azimuth[3]");
    EXPECT_EQ(error.issues[2].S, 90.0);
  }
  EXPECT_THROW(make_survey({0, 30}, {0, 100}, {0, 0}, 1e-3), GeometryError);  // turns by 100 degrees
  EXPECT_THROW(make_survey({0}, {0}, {0}, 1e-3), GeometryError);
  EXPECT_THROW(make_survey({0, 30}, {0, 1}, {0, 0}, 0.0), GeometryError);
}

}  // namespace

// Clearance laws and the tube check: values and derivatives, safety between nodes, refusals with place and value.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/geometry/error.hpp"
#include "tendril/geometry/fitted_axes.hpp"
#include "tendril/geometry/tube_check.hpp"

namespace {

using namespace tendril::geometry;

std::vector<double> even(int n, double length) {
  std::vector<double> S;
  for (int i = 0; i <= n; ++i) S.push_back(length * i / n);
  return S;
}

// Derivatives j -> j+1 by central differences away from knots.
void expect_consistent(const Clearance& law, double S, double h) {
  const auto q = law.at(S), up = law.at(S + h), down = law.at(S - h);
  for (int j = 0; j < 4; ++j) {
    EXPECT_NEAR((up[j] - down[j]) / (2 * h), q[j + 1], 1e-5 * (1.0 + std::abs(q[j + 1]))) << "derivative " << j;
  }
}

TEST(GeometryClearance, SmoothTablesKeepWhatIsSmooth) {
  // a constant and a line need no bending: they come back to rounding, whatever is allowed
  const std::vector<double> S = even(400, 2.0);
  for (const double slope : {0.0, 0.3}) {
    std::vector<double> q;
    for (const double at : S) q.push_back(1.0 + slope * at);
    const FittedClearance law = make_smooth_table(S, q, 2.0, 0.2);
    EXPECT_LT(law.largest_deviation, 1e-10);
    EXPECT_NEAR(law.clearance->at(0.777)[0], 1.0 + slope * 0.777, 1e-10);
    EXPECT_NEAR(law.clearance->at(0.777)[1], slope, 1e-8);
  }
  // jitter goes, within the tolerance; three derivatives are continuous at the knots
  std::vector<double> q;
  for (std::size_t i = 0; i < S.size(); ++i)
    q.push_back(1.0 + 0.2 * std::sin(3 * S[i]) + 0.01 * std::sin(78.233 * static_cast<double>(i)));
  const FittedClearance law = make_smooth_table(S, q, 2.0, 0.02);
  EXPECT_LE(law.largest_deviation, 0.02);
  for (const double at : {0.3, 0.9, 1.7}) EXPECT_NEAR(law.clearance->at(at)[1], 0.6 * std::cos(3 * at), 0.1);
  for (const double knot : law.clearance->knots()) {
    const auto before = law.clearance->at(knot - 1e-12), after = law.clearance->at(knot + 1e-12);
    for (int j = 0; j < 4; ++j) EXPECT_NEAR(before[j], after[j], 1e-6 * (1 + std::abs(after[j]))) << j;
  }
  EXPECT_LT(make_smooth_table(S, q, 2.0, 0.0).largest_deviation, 1e-12);
}

TEST(GeometryClearance, ConstantAndScaled) {
  const auto q = scaled(make_constant(0.05), 1.5);
  EXPECT_NEAR(q->at(0.3)[0], 0.075, 1e-16);
  EXPECT_EQ(q->at(0.3)[1], 0.0);
  EXPECT_TRUE(q->knots().empty());
  EXPECT_THROW(make_constant(-0.1), GeometryError);
  EXPECT_THROW(scaled(make_constant(0.1), 0.0), GeometryError);
}

TEST(GeometryClearance, TableConvergesWithItsDerivatives) {
  std::array<double, 2> worst{};
  for (int level = 0; level < 2; ++level) {
    const auto S = even(20 << level, 1.0);
    std::vector<double> q;
    for (double s : S) q.push_back(1.0 + 0.3 * std::sin(5 * s));
    const auto law = make_table(S, q, 1.0);
    for (std::size_t i = 0; i < S.size(); ++i) EXPECT_NEAR(law->at(S[i])[0], q[i], 1e-14);
    for (double s = 0.2; s < 0.8; s += 0.0123) {
      worst[level] = std::max(worst[level], std::abs(law->at(s)[2] + 7.5 * std::sin(5 * s)));
    }
    for (double knot : law->knots()) {
      for (int j = 0; j < 4; ++j) {
        EXPECT_NEAR(law->at(std::nextafter(knot, 0.0))[j], law->at(knot)[j], 1e-9 * std::pow(20.0, j));
      }
    }
    expect_consistent(*law, 0.511, 1e-4);
  }
  EXPECT_GT(std::log2(worst[0] / worst[1]), 3.5);  // second derivatives of a quintic: order 4
}

TEST(GeometryClearance, StepTablesStayBetweenTheirNodes) {
  const std::vector<double> S{0, 1500, 1510, 3000}, q{0.05, 0.05, 0.001, 0.001};
  const auto law = make_table(S, q, 3000);
  for (double s = 0; s <= 3000; s += 0.5) {
    EXPECT_GE(law->at(s)[0], 0.001 - 1e-15);
    EXPECT_LE(law->at(s)[0], 0.05 + 1e-15);
  }
  EXPECT_NEAR(law->at(1505)[0], 0.0255, 1e-15);
  for (double knot : law->knots()) {
    for (int j = 0; j < 4; ++j) EXPECT_NEAR(law->at(std::nextafter(knot, 0.0))[j], law->at(knot)[j], 1e-14);
  }
  expect_consistent(*law, 1503.0, 1e-3);
  // Sloped nodes as well: a taper between two taper rates.
  const auto taper = make_table({0, 1, 1.1, 10}, {1, 2, 3, 3.5}, 10);
  double last = 0.0;
  for (double s = 0; s <= 10; s += 0.01) {
    EXPECT_GT(taper->at(s)[0], last);
    last = taper->at(s)[0];
  }
  expect_consistent(*taper, 1.04, 1e-5);
  // Two nodes: a straight taper.
  EXPECT_NEAR(make_table({0, 4}, {1, 3}, 4)->at(1)[0], 1.5, 1e-15);
}

TEST(GeometryClearance, TableRefusals) {
  const auto issues = [](const std::vector<double>& S, const std::vector<double>& q, double length) {
    try {
      make_table(S, q, length);
    } catch (const GeometryError& error) {
      return error.issues;
    }
    return std::vector<Issue>{};
  };
  const auto shortfall = issues({0.1, 0.5, 0.9}, {1, 1, 1}, 1.0);
  ASSERT_EQ(shortfall.size(), 2u);
  EXPECT_EQ(shortfall[0].value, 0.1);
  EXPECT_EQ(shortfall[1].value, 0.9);
  EXPECT_EQ(shortfall[1].bound, 1.0);
  const auto wrong = issues({0, 0.5, 0.5, 1}, {1, -1, 1, std::nan("")}, 1.0);
  ASSERT_EQ(wrong.size(), 3u);
  EXPECT_EQ(wrong[0].S, 0.5);
  EXPECT_EQ(wrong[0].value, -1.0);
  EXPECT_EQ(wrong[1].bound, 0.5);
  EXPECT_EQ(issues({0, 1}, {1}, 1.0).size(), 1u);
  EXPECT_TRUE(issues({0, 1 - 9e-7}, {1, 1}, 1.0).empty());  // covered to 1e-6 of the length
}

TEST(GeometryTube, QualityTableOfKnownTubes) {
  const double r = 0.3, pitch = 0.7, K = std::pow(std::sin(pitch), 2) / r;
  const auto table = check_tube({make_helix(r, pitch, 2.0), make_constant(0.05)});
  EXPECT_NEAR(table.total_bend, 2.0 * K, 1e-12);
  EXPECT_NEAR(table.curvature_clearance_max, 0.05 * K, 1e-14);
  EXPECT_EQ(table.clearance_min, 0.05);

  // A bulge Q = 0.1 + 0.05 exp(-100 (S - 1.234)²) on an arc: everything is largest at its middle.
  const auto bulge = make_analytic([](double S) {
    const double x = S - 1.234;
    return std::array<double, 5>{0.1 + 0.05 * std::exp(-100 * x * x), 0, 0, 0, 0};
  });
  const auto arc = check_tube({make_arc(2.0, 3.0), bulge});
  EXPECT_NEAR(arc.curvature_clearance_max_S, 1.234, 1e-6);  // root of rounding of the quadratic top
  EXPECT_NEAR(arc.curvature_clearance_max, 0.075, 1e-14);
  EXPECT_NEAR(arc.clearance_max, 0.15, 1e-14);
}

TEST(GeometryTube, RefusesCrossingSectionsAndClosedBores) {
  const auto law = [](double at, double depth) {
    return make_analytic([=](double S) {
      return std::array<double, 5>{0.5 + depth * std::exp(-50 * (S - at) * (S - at)), 0, 0, 0, 0};
    });
  };
  try {
    check_tube({make_arc(1.0, 3.0), law(2.0, 0.6)});
    FAIL();
  } catch (const GeometryError& error) {
    ASSERT_EQ(error.issues.size(), 1u);
    EXPECT_NEAR(error.S, 2.0, 1e-6);
    EXPECT_NEAR(error.value, 1.1, 1e-12);
    EXPECT_EQ(error.bound, 1.0);
  }
  try {
    check_tube({make_arc(1.0, 3.0), law(0.7, -0.6)});
    FAIL();
  } catch (const GeometryError& error) {
    EXPECT_EQ(error.what_field, "clearance");
    EXPECT_NEAR(error.S, 0.7, 1e-6);
    EXPECT_NEAR(error.value, -0.1, 1e-12);
  }
  EXPECT_THROW(check_tube({make_arc(1.0, 3.0), make_constant(1.0)}), GeometryError);  // exactly 1 is too much
  EXPECT_NO_THROW(check_tube({make_arc(1.0, 3.0), make_constant(0.999)}));

  // A corner of 60 degrees, finely sampled: smooth between its points, but tighter than the tube is wide.
  std::vector<Vec3> points;
  for (int i = -40; i <= 40; ++i) points.push_back(0.02 * i * (i < 0 ? Vec3(0, 0, 1) : Vec3(std::sqrt(0.75), 0, 0.5)));
  try {
    check_tube({make_points(points).axis, make_constant(0.1)});
    FAIL();
  } catch (const GeometryError& error) {
    EXPECT_EQ(error.what_field, "clearance x curvature");
    EXPECT_NEAR(error.S, 0.8, 0.06);
  }
  EXPECT_THROW(check_tube({nullptr, make_constant(1.0)}), GeometryError);
}

}  // namespace

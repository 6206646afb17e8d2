// A collocation solution as B-splines: the same function, as many control points as the space has dimensions, bounds
// that hold between nodes.
#include <gtest/gtest.h>

#include <cmath>

#include "collocation_model.hpp"
#include "tendril/collocation/b_splines.hpp"

namespace {

using namespace collocation_model;

constexpr double from = 0.0, to = 1.0;

class CollocationBSplines : public ::testing::TestWithParam<int> {};

TEST_P(CollocationBSplines, AreTheSolution) {
  const int k = GetParam();
  const Mixed m(7.0);
  const Segment s = solved_mixed(m, k, 6, from, to);
  const auto splines = tendril::collocation::b_splines(s, from, to);
  ASSERT_EQ(static_cast<int>(splines.size()), s.system().components());
  double u[6], q[1];
  for (int c = 0; c < s.system().components(); ++c) {
    const int order = s.system().order[c];
    EXPECT_EQ(splines[c].order, k + order);
    EXPECT_EQ(static_cast<int>(splines[c].control.size()), k * s.pieces() + order);
    for (int i = 0; i <= 500; ++i) {
      const double S = from + (to - from) * i / 500;
      s.evaluate(S, from, to, u, q);
      for (int j = 0; j < order; ++j) {
        const double scale = std::pow(m.omega, j);  // of the j-th derivative
        EXPECT_NEAR(splines[c].value(S, j), u[s.system().first[c] + j], 1e-11 * scale) << "component " << c;
      }
    }
  }
}

TEST_P(CollocationBSplines, BoundTheNormBetweenNodes) {
  const Mixed m(7.0);
  const Segment s = solved_mixed(m, GetParam(), 6, from, to);
  const auto [low, high] = tendril::collocation::squared_norm_bounds(s, 0, 0, from, to, 1e-10);
  double least = HUGE_VAL, most = 0, u[6], q[1];
  for (int i = 0; i <= 20000; ++i) {
    s.evaluate(from + (to - from) * i / 20000, from, to, u, q);
    least = std::min(least, 2 * u[0] * u[0]);
    most = std::max(most, 2 * u[0] * u[0]);
  }
  EXPECT_LE(low, least);
  EXPECT_GE(high, most);
  EXPECT_NEAR(high, most,
              1e-6);  // a maximum missed by half a step of 1/20000: (ω/40000)² of it, and the accuracy asked
}

INSTANTIATE_TEST_SUITE_P(Points, CollocationBSplines, ::testing::Values(4, 5, 6, 7));

}  // namespace

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tendril/numerics/line_search.hpp"

namespace {

using namespace tendril;

TEST(Backtracking, MinimisesTheQuadraticThenTheCubicModel) {
  const double f0 = 2.0, slope = -2.0 * f0;
  auto m = [&](double x) { return f0 + slope * x + 5.0 * x * x + 8.0 * x * x * x; };
  numerics::Backtracking search(f0);
  ASSERT_FALSE(search.sufficient(1.0, m(1.0)));
  const double first = search.next(1.0, m(1.0));  // quadratic with the rise 13 at 1: 4/26
  EXPECT_NEAR(first, 4.0 / 26.0, 1e-14);
  const double least = (-10.0 + std::sqrt(100.0 + 4.0 * 24.0 * 4.0)) / 48.0;  // of the cubic itself, 0.25
  EXPECT_NEAR(search.next(first, m(first)), std::min(least, 0.5 * first), 1e-14);
  numerics::Backtracking other(f0);
  EXPECT_EQ(other.next(0.8, std::numeric_limits<double>::infinity()), 0.4);
  const double quadratic = other.next(0.4, m(0.4) + 3.0);
  EXPECT_GE(quadratic, 0.04);
  EXPECT_LE(quadratic, 0.2);
  EXPECT_FALSE(other.sufficient(0.5, f0));
  EXPECT_TRUE(other.sufficient(0.5, 0.99 * f0));
}

}  // namespace

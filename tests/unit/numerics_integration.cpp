// Extrapolated integration and the small Newton iteration behind shooting: known solutions, derivatives through dual
// numbers, honest failures.
#include <gtest/gtest.h>

#include <cmath>

#include "tendril/numerics/dual_newton.hpp"
#include "tendril/numerics/extrapolation.hpp"

namespace tendril::numerics {
namespace {

using State = std::array<double, 4>;

bool kepler(double, const State& y, State& dy) {
  const double r = std::hypot(y[0], y[1]), cube = r * r * r;
  dy = {y[2], y[3], -y[0] / cube, -y[1] / cube};
  return true;
}

TEST(Extrapolation, EccentricOrbitComesBack) {
  const double e = 0.6;
  const State start{1.0 - e, 0.0, 0.0, std::sqrt((1.0 + e) / (1.0 - e))};
  for (const double tolerance : {1e-7, 1e-13}) {
    State y = start;
    IntegrationOptions options;
    options.tolerance = tolerance;
    const auto sum = integrate(kepler, 0.0, 2.0 * 3.14159265358979323846, y, options);
    ASSERT_TRUE(sum.completed) << sum.reason;
    // an error of energy becomes one of phase, 3π times larger, twice that in place and 6 times in velocity at
    // pericentre; some tens of steps add up
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(y[i], start[i], 2000.0 * tolerance);
    EXPECT_LT(sum.steps, 200);
  }
}

TEST(Extrapolation, BackwardsGivesTheStart) {
  State y{1.0, 0.0, 0.0, 1.1};
  ASSERT_TRUE(integrate(kepler, 0.0, 3.0, y).completed);
  ASSERT_TRUE(integrate(kepler, 3.0, 0.0, y).completed);
  EXPECT_NEAR(y[0], 1.0, 1e-11);
  EXPECT_NEAR(y[3], 1.1, 1e-11);
}

TEST(Extrapolation, CarriesDerivatives) {
  // y' = -c y: dy/dc = -x e^(-c x), dy/dy0 = e^(-c x)
  using D = Dual<2>;
  const D c = D::seed(0.7, 0);
  std::array<D, 1> y{D::seed(2.0, 1)};
  ASSERT_TRUE(integrate(
                  [&](double, const std::array<D, 1>& at, std::array<D, 1>& dy) {
                    dy[0] = -(c * at[0]);
                    return true;
                  },
                  0.0, 1.5, y)
                  .completed);
  const double decay = std::exp(-1.05);
  EXPECT_NEAR(y[0].v, 2.0 * decay, 1e-12);
  EXPECT_NEAR(y[0].d[0], -3.0 * decay, 1e-11);
  EXPECT_NEAR(y[0].d[1], decay, 1e-12);
}

TEST(Extrapolation, ABlowUpIsAStatus) {
  std::array<double, 1> y{1.0};  // y' = y²: y = 1/(1 - x)
  const auto sum = integrate(
      [](double, const std::array<double, 1>& at, std::array<double, 1>& dy) {
        dy[0] = at[0] * at[0];
        return at[0] < 1e12;
      },
      0.0, 2.0, y);
  EXPECT_FALSE(sum.completed);
  EXPECT_NEAR(sum.reached, 1.0, 1e-6);
  EXPECT_STRNE(sum.reason, "");
}

TEST(DualNewton, FindsARootAndSaysWhenThereIsNone) {
  std::array<double, 2> x{2.0, 0.3};
  const auto circle = [](const std::array<Dual<2>, 2>& at, std::array<Dual<2>, 2>& r) {
    r[0] = at[0] * at[0] + at[1] * at[1] - 4.0;
    r[1] = at[0] - at[1];
    return true;
  };
  ASSERT_TRUE((solve_dual_newton<2>(circle, x).converged));
  EXPECT_NEAR(x[0], std::sqrt(2.0), 1e-14);
  std::array<double, 1> z{0.4};
  const auto none = [](const std::array<Dual<1>, 1>& at, std::array<Dual<1>, 1>& r) {
    r[0] = at[0] * at[0] + 1.0;
    return true;
  };
  const auto failed = solve_dual_newton<1>(none, z);
  EXPECT_FALSE(failed.converged);
  EXPECT_STRNE(failed.reason, "");
}

}  // namespace
}  // namespace tendril::numerics

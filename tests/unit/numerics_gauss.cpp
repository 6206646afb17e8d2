// Gauss tables: the points against Boost's, exactness to degree 2k - 1 and not beyond, repeated integrals of the
// Lagrange polynomials against Cauchy's formula by independent quadrature, and of the Legendre polynomial.
#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/special_functions/legendre.hpp>
#include <cmath>

#include "tendril/numerics/gauss.hpp"

namespace {

using tendril::numerics::gauss_table;
using tendril::numerics::GaussTable;
using tendril::numerics::max_order;

constexpr double rounding = 1e-14;   // of the oracle: products of up to 6 factors, 15-point sums
constexpr double monomials = 1e-12;  // of `basis`: monomial coefficients of alternating sign up to 2e3 (k = 7)

double lagrange(const GaussTable& g, int l, double x) {
  double f = 1.0;
  for (int j = 0; j < g.k; ++j)
    if (j != l) f *= (x - g.c[j]) / (g.c[l] - g.c[j]);
  return f;
}

/// p-fold integral from 0 to x: ∫ (x-t)^(p-1)/(p-1)! f dt, by Boost's 15-point rule (exact to degree 29).
template <class F>
double repeated_integral(F f, int p, double x) {
  if (p == 0) return f(x);
  const double factorial = p == 1 ? 1.0 : p == 2 ? 1.0 : 2.0;
  return boost::math::quadrature::gauss<double, 15>::integrate(
      [&](double t) { return std::pow(x - t, p - 1) / factorial * f(t); }, 0.0, x);
}

class NumericsGauss : public ::testing::TestWithParam<int> {
 protected:
  const GaussTable& g = gauss_table(GetParam());
};

TEST_P(NumericsGauss, PointsAreZerosOfLegendreAndWeightsAreTheirs) {
  ASSERT_EQ(g.k, GetParam());
  const auto zeros = boost::math::legendre_p_zeros<double>(g.k);  // the ones >= 0, ascending
  double sum = 0.0;
  for (int i = 0; i < g.k; ++i) {
    const double t = zeros[i < g.k / 2 ? zeros.size() - 1 - i : i - g.k / 2];
    EXPECT_NEAR(g.c[i], 0.5 * (1 + (i < g.k / 2 ? -t : t)), 2e-16);
    const double d = boost::math::legendre_p_prime(g.k, t);
    EXPECT_NEAR(g.b[i], 1 / ((1 - t * t) * d * d), 1e-15);
    EXPECT_NEAR(g.c[i] + g.c[g.k - 1 - i], 1.0, 2e-16);  // symmetric about 1/2
    sum += g.b[i];
  }
  EXPECT_NEAR(sum, 1.0, 1e-15);
}

TEST_P(NumericsGauss, IntegratesDegreeTwoKMinusOneExactlyAndTwoKNot) {
  const auto defect = [&](int degree) {
    double q = 0.0;
    for (int i = 0; i < g.k; ++i) q += g.b[i] * std::pow(g.c[i], degree);
    return q - 1.0 / (degree + 1);
  };
  for (int degree = 0; degree <= 2 * g.k - 1; ++degree) EXPECT_NEAR(defect(degree), 0.0, 1e-15) << degree;
  // error of the rule for x^(2k): (k!)^4 / ((2k+1) ((2k)!)²)
  const double e = std::pow(std::tgamma(g.k + 1), 4) / ((2 * g.k + 1) * std::pow(std::tgamma(2 * g.k + 1), 2));
  EXPECT_NEAR(defect(2 * g.k) / -e, 1.0, 1e-5);
}

TEST_P(NumericsGauss, RepeatedIntegralsOfLagrangePolynomialsAnywhere) {
  for (int p = 0; p <= max_order; ++p)
    for (const double x : {0.0, 0.1, 1.0 / 3, 0.5, 0.87, 1.0}) {
      double out[tendril::numerics::max_points];
      g.basis(p, x, out);
      for (int l = 0; l < g.k; ++l)
        EXPECT_NEAR(out[l], repeated_integral([&](double t) { return lagrange(g, l, t); }, p, x), monomials)
            << "p " << p << " l " << l << " x " << x;
    }
}

TEST_P(NumericsGauss, TablesAreTheIntegralsAtThePointsAndAtOne) {
  for (int p = 0; p <= max_order; ++p)
    for (int l = 0; l < g.k; ++l) {
      const auto polynomial = [&](double t) { return lagrange(g, l, t); };
      for (int q = 0; q < g.k; ++q)
        EXPECT_NEAR(g.integral[p][q][l], repeated_integral(polynomial, p, g.c[q]), rounding);
      // extrapolation to 1 multiplies the rounding of the factors
      EXPECT_NEAR(g.at_one[p][l], repeated_integral(polynomial, p, 1.0), (p == 0 ? 10 : 1) * rounding);
    }
  for (int l = 0; l < g.k; ++l) EXPECT_NEAR(g.at_one[1][l], g.b[l], rounding);  // the weights are the integrals
}

TEST_P(NumericsGauss, LargestRepeatedIntegralOfTheLegendrePolynomial) {
  for (int p = 0; p <= max_order; ++p) {
    double most = 0.0;
    for (int i = 0; i <= 1000; ++i)
      most = std::max(most, std::abs(repeated_integral(
                                [&](double t) { return boost::math::legendre_p(g.k, 2 * t - 1); }, p, i / 1000.0)));
    EXPECT_NEAR(g.legendre_integral[p] / most, 1.0, 1e-4) << "p " << p;  // both sampled: second order in 1/400
  }
  EXPECT_NEAR(g.legendre_integral[0], 1.0, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Points, NumericsGauss, ::testing::Values(4, 5, 6, 7));

}  // namespace

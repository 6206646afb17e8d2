// Elliptic integrals and functions against Boost.Math, which takes the modulus k where ours take the parameter k².
#include <gtest/gtest.h>

#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <boost/math/special_functions/ellint_3.hpp>
#include <boost/math/special_functions/jacobi_elliptic.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "tendril/closed_form/elliptic.hpp"

namespace tendril::closed_form {
namespace {

// Both sides are good to a few units in the last place; near m = 1 the passage k = √m costs a factor 1/(1 - m).
constexpr double rounding = 2e-15;

double allowed(double value, double m) { return rounding * std::abs(value) * (1.0 + 1.0 / (1.0 - m)); }

const double parameters[] = {0.0, 1e-12, 1e-3, 0.1, 0.25, 0.5, 0.75, 0.9, 0.99, 0.9999, 1.0 - 1e-8};

TEST(ClosedFormElliptic, CompleteIntegralsAgreeWithBoost) {
  for (const double m : parameters) {
    const double k = std::sqrt(m);
    EXPECT_NEAR(complete_k(m), boost::math::ellint_1(k), allowed(complete_k(m), m)) << "m = " << m;
    EXPECT_NEAR(complete_e(m), boost::math::ellint_2(k), allowed(complete_e(m), m)) << "m = " << m;
    for (const double n : {-1e6, -37.0, -2.0, -0.3, -1e-9, 0.0, 0.2, 0.7, 0.95}) {
      const double expected = boost::math::ellint_3(k, n);
      EXPECT_NEAR(complete_pi(n, m), expected, 4.0 * allowed(expected, m)) << "m = " << m << ", n = " << n;
    }
  }
}

TEST(ClosedFormElliptic, LastArgumentIsTheParameter) {
  // K(m = 1/2) = Γ(1/4)²/(4√π); read as a modulus, 1/2 would give 1.6857.
  const double gamma = std::tgamma(0.25);
  EXPECT_NEAR(complete_k(0.5), gamma * gamma / (4.0 * std::sqrt(std::acos(-1.0))), 1e-14);
  constexpr double printed_digits = 1e-12;
  EXPECT_NEAR(complete_pi(-2.0, 0.25), 0.954798819628, printed_digits);
}

TEST(ClosedFormElliptic, LegendresRelationTiesKToE) {
  for (const double m : {0.01, 0.3, 0.5, 0.8, 0.999}) {
    const double K = complete_k(m), E = complete_e(m), K1 = complete_k(1.0 - m), E1 = complete_e(1.0 - m);
    EXPECT_NEAR(E * K1 + E1 * K - K * K1, std::acos(0.0), 1e-14) << "m = " << m;
  }
}

TEST(ClosedFormElliptic, JacobisFunctionsAgreeWithBoost) {
  for (const double m : {0.0, 1e-6, 0.2, 0.5, 0.9, 0.999, 1.0}) {
    const double k = std::sqrt(m);
    for (double u = -7.3; u < 8.0; u += 0.37) {
      double cn = 0, dn = 0;
      const double sn = boost::math::jacobi_elliptic(k, u, &cn, &dn);
      const Jacobi j = jacobi(u, m);
      // The argument's own rounding, |u| ε, and that of k, which moves the period by up to ε/(1 - m).
      const double tolerance = 1e-14 + (m < 1.0 ? 1e-15 / (1.0 - m) : 0.0);
      EXPECT_NEAR(j.sn, sn, tolerance) << "u = " << u << ", m = " << m;
      EXPECT_NEAR(j.cn, cn, tolerance) << "u = " << u << ", m = " << m;
      EXPECT_NEAR(j.dn, dn, tolerance) << "u = " << u << ", m = " << m;
    }
  }
}

TEST(ClosedFormElliptic, OutsideTheDomainThrows) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double m : {-0.1, 1.0, 1.5, nan}) EXPECT_THROW(complete_k(m), std::domain_error) << m;
  for (const double m : {-0.1, 1.1, nan}) {
    EXPECT_THROW(complete_e(m), std::domain_error) << m;
    EXPECT_THROW(jacobi(0.3, m), std::domain_error) << m;
  }
  EXPECT_THROW(complete_pi(1.0, 0.5), std::domain_error);
  EXPECT_THROW(complete_pi(nan, 0.5), std::domain_error);
  EXPECT_THROW(jacobi(nan, 0.5), std::domain_error);
}

}  // namespace
}  // namespace tendril::closed_form

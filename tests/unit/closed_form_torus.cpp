// Parallels and Villarceau circles of a torus: equilibrium in the world frame.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "closed_form_world.hpp"
#include "tendril/closed_form/torus.hpp"

namespace tendril::closed_form {
namespace {

using Eigen::Vector3d;
constexpr double pi = std::numbers::pi;

/// Point of the torus at azimuth ξ and polar angle β, D1 = e_r, D2 = -e_z, and the outward normal there.
std::pair<Vector3d, Vector3d> torus_point(double epsilon, double xi, double beta) {
  const Vector3d radial(std::cos(xi), std::sin(xi), 0.0);
  const Vector3d normal = std::cos(beta) * radial - std::sin(beta) * Vector3d::UnitZ();
  return {radial + epsilon * normal, normal};
}

TEST(ClosedFormTorus, ParallelsAreInEquilibrium) {
  const double epsilon = 0.3, eta = 0.1, M_3 = 1.7;
  for (const double beta : {0.0, 0.8, pi / 2, pi, -2.0}) {
    const bool geodesic = beta == 0.0 || beta == pi;
    for (const double F_3 : {0.0, 4.0, -2.0}) {
      if (!geodesic && F_3 != 0.0) continue;
      const SurfaceState state = torus_parallel(epsilon, beta, F_3, M_3, eta);
      const auto section = [&](double s) {
        const double xi = s * state.alpha / (1.0 + epsilon * std::cos(beta));
        const auto [position, normal] = torus_point(epsilon, xi, beta);
        return test::Section{position, Vector3d(-std::sin(xi), std::cos(xi), 0.0), normal, state};
      };
      EXPECT_LT(test::fault(section, 0.4), test::difference_tolerance) << "beta " << beta << ", F3 " << F_3;
      EXPECT_EQ(state.rho == 0.0, F_3 == 0.0);
    }
  }
  EXPECT_THROW(torus_parallel(epsilon, 0.8, 1.0, M_3, eta), std::domain_error) << "no geodesic: tension needs support";
}

TEST(ClosedFormTorus, VillarceauCirclesAreFreeRings) {
  for (const double epsilon : {0.2, 0.7})
    for (const Hand hand : {Hand::right, Hand::left})
      for (const double M_3 : {0.0, -2.3}) {
        // Arc length to azimuth: ds/dξ = 1/J̄1 = √(1 - ε²)/(1 - ε cosξ), inverted in closed form (Kepler's anomalies).
        const auto azimuth = [epsilon](double s) {
          return 2.0 * std::atan(std::sqrt((1.0 - epsilon) / (1.0 + epsilon)) * std::tan(0.5 * s));
        };
        const auto place = [&](double s) {
          const double xi = azimuth(s);
          return torus_point(epsilon, xi, villarceau(epsilon, hand, xi, M_3).beta);
        };
        const auto section = [&](double s) {
          const double xi = azimuth(s);
          const VillarceauPoint v = villarceau(epsilon, hand, xi, M_3);
          const auto [position, normal] = torus_point(epsilon, xi, v.beta);
          // r' = C3 e_ξ + ε β' e_β, from the claimed β'.
          const Vector3d hoop(-std::sin(xi), std::cos(xi), 0.0), radial(std::cos(xi), std::sin(xi), 0.0);
          const Vector3d around = -std::sin(v.beta) * radial - std::cos(v.beta) * Vector3d::UnitZ();
          const double C3 = 1.0 + epsilon * std::cos(v.beta);
          return test::Section{position, v.J_bar_1 * (C3 * hoop + epsilon * v.beta_prime * around), normal, v.state};
        };
        for (const double s : {-2.1, 0.3, 1.4}) {
          EXPECT_LT(test::fault(section, s), test::difference_tolerance) << "epsilon " << epsilon << " at " << s;
          // A circle of radius 1 whose plane passes through the torus' centre, displaced by ε.
          const Vector3d centre = 0.5 * (place(1e-9).first + place(pi - 1e-9).first);
          EXPECT_NEAR((place(s).first - centre).norm(), 1.0, 1e-8);
          EXPECT_NEAR(centre.norm(), epsilon, 1e-8);
        }
      }
}

TEST(ClosedFormTorus, VillarceauAngleIsContinuousAroundTheTorus) {
  const double h = 1e-6;
  for (const double xi : {-3 * pi, -pi, pi, 3 * pi}) {
    const VillarceauPoint before = villarceau(0.4, Hand::left, xi - h, 0.0),
                          after = villarceau(0.4, Hand::left, xi + h, 0.0);
    EXPECT_NEAR(after.beta - before.beta, 2 * h * before.beta_prime, 1e-11) << "at " << xi;
  }
}

TEST(ClosedFormTorus, MeridiansAreInEquilibriumAcrossTheAxis) {
  const double epsilon = 0.3, eta = 0.1, M_3 = 1.7;
  for (const double F_3 : {0.0, 4.0, -2.0}) {
    const SurfaceState state = torus_meridian(epsilon, F_3, M_3, eta);
    const auto section = [&](double s) {
      const double beta = s * state.alpha / epsilon;
      const auto [position, normal] = torus_point(epsilon, 0.0, beta);
      return test::Section{position, Vector3d(-std::sin(beta), 0.0, -std::cos(beta)), normal, state};
    };
    EXPECT_LT(test::fault(section, 0.4), test::difference_tolerance) << "F3 " << F_3;
    EXPECT_NEAR(section(0.4).tangent.dot(Vector3d::UnitY()), 0.0, 1e-15) << "d3·D3 = 0";
  }
}

TEST(ClosedFormTorus, GeodesicsCloseAfterTheTurnAskedFor) {
  // The integrals again by shooting: β' = slope(β) with classical Runge-Kutta, from the outer to the inner equator.
  for (const double epsilon : {0.2, 0.6})
    for (const double turn : {0.4, 1.3, 2 * pi, 12.0}) {
      const TorusGeodesic g = torus_geodesic(epsilon, turn);
      const int steps = 20000;
      const double h = 0.5 * turn / steps;
      double beta = 0.0, length = 0.0;
      const auto speed = [&](double b) {
        const double C3 = 1.0 + epsilon * std::cos(b);
        return std::hypot(C3, epsilon * g.slope(b));
      };
      for (int i = 0; i < steps; ++i) {
        const double k1 = g.slope(beta), k2 = g.slope(beta + 0.5 * h * k1), k3 = g.slope(beta + 0.5 * h * k2),
                     k4 = g.slope(beta + h * k3);
        length += h / 6.0 * (speed(beta) + 4.0 * speed(beta + 0.25 * h * (k1 + k2)) + speed(beta + h * k3));
        beta += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
      }
      // The distance from the inner equator grows as e^{√(1/(ε(1-ε))) s}: what is lost by shooting onto it.
      EXPECT_NEAR(beta, pi, 1e-8) << "epsilon " << epsilon << ", turn " << turn;
      EXPECT_NEAR(2.0 * length, g.length, 1e-7) << "epsilon " << epsilon << ", turn " << turn;
    }
  EXPECT_THROW(torus_geodesic(0.2, 0.0), std::domain_error);
}

TEST(ClosedFormTorus, GeodesicsHaveNoGeodesicCurvature) {
  const TorusGeodesic g = torus_geodesic(0.2, 2.0);
  // d3·e_θ C3 is constant and the acceleration has no part in the surface across the curve: seen from the shape alone.
  const auto place = [&](double beta, double xi) { return torus_point(0.2, xi, beta).first; };
  for (const double beta0 : {0.3, 2.0, 3.0}) {
    const double h = 1e-4;
    std::array<Vector3d, 3> r;
    for (int i = -1; i <= 1; ++i) {
      const double b = beta0 + h * i;
      const double xi = i * h / 6.0 * (1.0 / g.slope(beta0) + 4.0 / g.slope(0.5 * (beta0 + b)) + 1.0 / g.slope(b));
      r[i + 1] = place(b, xi);
    }
    const Vector3d d = (r[2] - r[0]) / (2 * h), dd = (r[2] - 2.0 * r[1] + r[0]) / (h * h);
    const Vector3d N = torus_point(0.2, 0.0, beta0).second, t = d.normalized();
    EXPECT_NEAR(dd.dot(N.cross(t)) / d.squaredNorm(), 0.0, 1e-5) << "at " << beta0;  // differences: h² + 1e-16/h²
    EXPECT_NEAR(dd.dot(N) / d.squaredNorm(), g.kappa_n(beta0), 1e-5) << "at " << beta0;
  }
}

}  // namespace
}  // namespace tendril::closed_form

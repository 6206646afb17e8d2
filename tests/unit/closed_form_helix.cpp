// Helices on, inside and around a straight cylinder, and the rod on the axis of a helical conduit.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "closed_form_world.hpp"
#include "tendril/closed_form/helical_conduit.hpp"
#include "tendril/closed_form/helix.hpp"

namespace tendril::closed_form {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double printed_8 = 0.6e-8;  // half a unit of the eighth decimal, and a little
constexpr double printed_10 = 0.6e-10;
constexpr double rounding = 1e-13;  // a dozen operations on numbers up to 100

test::Section section(const Helix& h, const SurfaceState& state, double s) {
  const double xi = s * state.alpha * std::cos(h.angle), beta = xi * std::tan(h.angle) / h.radius;
  const Eigen::Vector3d radial(std::cos(beta), std::sin(beta), 0.0), hoop(-std::sin(beta), std::cos(beta), 0.0);
  return {h.radius * radial + Eigen::Vector3d(0, 0, xi),
          std::sin(h.angle) * hoop + Eigen::Vector3d(0, 0, std::cos(h.angle)), radial, state};
}

TEST(ClosedFormHelix, AnyTensionAndTwistIsInEquilibriumOnTheCylinder) {
  for (const double angle : {0.2, pi / 5, 1.1, -0.7})
    for (const double F_3 : {-3.0, 0.0, 8.0})
      for (const double M_3 : {-2.0, 0.0, 5.0})
        for (const double eta : {0.0, 0.05, 0.3}) {
          const Helix helix{0.8, angle};
          const SurfaceState state = helix_on_cylinder(helix, F_3, M_3, eta);
          EXPECT_LT(test::fault([&](double s) { return section(helix, state, s); }, 0.37), test::difference_tolerance)
              << "angle " << angle << ", F3 " << F_3 << ", M3 " << M_3 << ", eta " << eta;
        }
}

TEST(ClosedFormHelix, FreeHelixNeedsNoWall) {
  for (const double angle : {0.3, 0.9, -0.5})
    for (const double M_3 : {-4.0, 1.0, 3.0})
      for (const double eta : {0.0, 0.1}) {
        const Helix helix{0.4, angle};
        const SurfaceState state = helix_on_cylinder(helix, free_helix_tension(helix, M_3, eta), M_3, eta);
        EXPECT_NEAR(state.rho, 0.0, rounding);
      }
}

TEST(ClosedFormHelix, AxialResultantsAreTheForceAndMomentInTheWorld) {
  const Helix helix{0.7, 0.6};
  const SurfaceState state = helix_on_cylinder(helix, 2.5, -1.5, 0.2);
  const AxialResultants axial = axial_resultants(helix, state);
  const test::Section c = section(helix, state, 0.21);
  EXPECT_NEAR(axial.force, c.force().z(), rounding);
  EXPECT_NEAR(axial.moment, c.moment().z(), rounding);
}

TEST(ClosedFormHelix, TwistVectorIsThatOfTheIntermediateFrame) {
  // k1, k2: the axis frame turned by the least rotation that takes D3 to d3; their rate per reference length is the
  // twist.
  for (const double angle : {0.5, -0.9}) {
    const Helix helix{0.6, angle};
    const double alpha = 1.1, rate = alpha * std::cos(angle);  // dξ/ds
    const auto tangent = [&](double xi) {
      const double beta = xi * std::tan(angle) / helix.radius;
      return Eigen::Vector3d(-std::sin(angle) * std::sin(beta), std::sin(angle) * std::cos(beta), std::cos(angle));
    };
    const auto k1 = [&](double xi) {
      const Eigen::Vector3d g = tangent(xi);
      return Eigen::Vector3d(1 - g.x() * g.x() / (1 + g.z()), -g.x() * g.y() / (1 + g.z()), -g.x());
    };
    const double xi = 0.83;
    const Eigen::Vector3d a = k1(xi), c = tangent(xi), b = c.cross(a);
    const Eigen::Vector3d dc = rate * test::derivative(tangent, xi), da = rate * test::derivative(k1, xi);
    const TwistVector w = helix_twist(helix, alpha, xi);
    EXPECT_NEAR(w.omega_1, -dc.dot(b), test::difference_tolerance);
    EXPECT_NEAR(w.omega_2, dc.dot(a), test::difference_tolerance);
    EXPECT_NEAR(w.omega_3, da.dot(b), test::difference_tolerance);
  }
}

TEST(ClosedFormHelix, HomoclinicFamilyHasTheTabulatedLoads) {
  struct Row {
    double squared_ratio, delta_M, delta2_T, m;  // (η/δ)², δM, δ²T, m = M/√T
  };
  const Row rows[] = {{0.0, 1.06331351, 0.34549150, 1.80901699},
                      {0.25, 1.14319682, 0.37144716, 1.87573933},
                      {1.0, 1.47581686, 0.47952197, 2.13121967}};
  const Helix helix{0.3, pi / 5};
  for (const Row& row : rows) {
    const SurfaceState state = free_homoclinic_helix(helix, std::sqrt(row.squared_ratio) * helix.radius);
    const AxialResultants axial = axial_resultants(helix, state);
    EXPECT_NEAR(helix.radius * state.M_3, row.delta_M, printed_8);
    EXPECT_NEAR(helix.radius * helix.radius * axial.force, row.delta2_T, printed_8);
    EXPECT_NEAR(state.M_3 / std::sqrt(axial.force), row.m, printed_8);
    EXPECT_NEAR(axial.moment, state.M_3, rounding) << "the family is defined by this equality";
    EXPECT_NEAR(state.rho, 0.0, rounding);
  }
}

TEST(ClosedFormHelix, HomoclinicFamilyCarriesTheGivenPull) {
  for (const double eta : {0.0, 0.1, 0.4})
    for (const double pull : {0.5, 3.0, 10.0}) {
      const Helix helix{0.5, 0.7};
      const SurfaceState state = homoclinic_helix(helix, pull, eta);
      const AxialResultants axial = axial_resultants(helix, state);
      EXPECT_NEAR(axial.force, pull, rounding);
      EXPECT_NEAR(axial.moment, state.M_3, rounding);
      // More pull than the free helix has: the wall must hold the rod outwards, from inside.
      const double free_pull = axial_resultants(helix, free_homoclinic_helix(helix, eta)).force;
      EXPECT_EQ(state.rho > 0.0, pull > free_pull);
    }
}

TEST(ClosedFormHelix, AxisTensionOfTheHelicalConduit) {
  const HelicalConduit conduit{pi / 4, 1.0 / (pi * std::sqrt(2.0))};
  EXPECT_NEAR(conduit.curvature(), 2.2214415, 0.6e-7);
  EXPECT_NEAR(conduit.torsion(), 2.2214415, 0.6e-7);
  EXPECT_NEAR(axis_tension(conduit, -1.0, 0.05), -7.0690329710, printed_10);
  EXPECT_NEAR(axis_tension(conduit, +1.0, 0.05), -2.6802939305, printed_10);
}

TEST(ClosedFormHelix, OutsideTheDomainThrows) {
  EXPECT_THROW(helix_on_cylinder({-0.1, 0.5}, 0, 0, 0), std::domain_error);
  EXPECT_THROW(helix_on_cylinder({0.1, 1.6}, 0, 0, 0), std::domain_error);
  EXPECT_THROW(helix_on_cylinder({0.1, 0.5}, -101.0, 0, 0.1), std::domain_error) << "stretch would vanish";
  EXPECT_THROW(free_homoclinic_helix({0.1, 0.9}, 0.3), std::domain_error) << "no free helix so thick";
}

}  // namespace
}  // namespace tendril::closed_form

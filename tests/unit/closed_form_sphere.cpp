// The rod on a sphere: equilibrium in the world frame, and the longitude per period against the integrated path.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "closed_form_world.hpp"
#include "tendril/closed_form/sphere.hpp"

namespace tendril::closed_form {
namespace {

struct Case {
  double sigma, kappa_max, longitude;  // longitude per period
};
const Case wavelike[] = {
    {0.5, 1.7, -0.4676295431}, {-1.3, 0.9, -3.4163806611}, {0.3, 2.5, -1.3529506680}, {-3.0, 1.2, -3.2711595151}};
const Case orbitlike[] = {
    {2.0, 1.8, 8.0902861942}, {1.0, 1.2, 9.1275693616}, {6.0, 3.0, 0.6548962780}, {4.0, 2.2, 7.0524629525}};

constexpr double printed_10 = 0.6e-10;

struct Place {
  Eigen::Vector3d position, tangent;
};

/// Path on the unit sphere with the given geodesic curvature: r' = t, t' = κ_g N x t - N, N = r (classical
/// Runge-Kutta).
Place walk(const SphereElastica& rod, double from, double to, Place p, int steps) {
  const double h = (to - from) / steps;
  const auto rate = [&](double chi, const Place& q) {
    return Place{q.tangent, rod.kappa_g(chi) * q.position.cross(q.tangent) - q.position};
  };
  const auto moved = [](const Place& q, const Place& d, double w) {
    return Place{q.position + w * d.position, q.tangent + w * d.tangent};
  };
  for (int i = 0; i < steps; ++i) {
    const double chi = from + i * h;
    const Place a = rate(chi, p), b = rate(chi + h / 2, moved(p, a, h / 2)), c = rate(chi + h / 2, moved(p, b, h / 2)),
                d = rate(chi + h, moved(p, c, h));
    p.position += h / 6 * (a.position + 2 * b.position + 2 * c.position + d.position);
    p.tangent += h / 6 * (a.tangent + 2 * b.tangent + 2 * c.tangent + d.tangent);
  }
  return p;
}

const Place origin{Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()};

void expect_sound(const Case& c, bool wave) {
  const SphereElastica rod(c.sigma, c.kappa_max);
  ASSERT_EQ(rod.wavelike(), wave);
  EXPECT_NEAR(rod.longitude_per_period(), c.longitude, printed_10);
  EXPECT_NEAR(rod.kappa_g(rod.period()), c.kappa_max, 1e-12 * c.kappa_max);
  EXPECT_NEAR(rod.kappa_g(rod.period() / 2), wave ? -c.kappa_max : std::sqrt(2 * c.sigma - c.kappa_max * c.kappa_max),
              1e-12 * c.kappa_max);

  for (const double M_3 : {0.0, -1.7, 2.4})
    for (const double chi : {0.31, 1.9}) {
      const auto section = [&](double s) {
        const Place p = walk(rod, chi - 0.1, s, walk(rod, 0.0, chi - 0.1, origin, 500), 200);
        return test::Section{p.position, p.tangent, p.position, rod.state(s, M_3)};
      };
      EXPECT_LT(test::fault(section, chi), test::difference_tolerance) << "sigma " << c.sigma << ", M3 " << M_3;
    }

  // Without twist the moment about the centre, M + r x F, is the axis of the first integral; its size is I.
  const test::Section first{origin.position, origin.tangent, origin.position, rod.state(0.0, 0.0)};
  const Eigen::Vector3d integral = first.moment() + first.position.cross(first.force());
  EXPECT_NEAR(integral.norm(), rod.integral(), 1e-13 * rod.integral());
  // Longitude around that axis along one period, from the path itself.
  const Eigen::Vector3d axis = integral.normalized();
  Place p = origin;
  double longitude = 0.0;
  const int pieces = 400;
  for (int i = 0; i < pieces; ++i) {
    const Place q = walk(rod, i * rod.period() / pieces, (i + 1) * rod.period() / pieces, p, 4);
    const Eigen::Vector3d a = p.position - p.position.dot(axis) * axis, b = q.position - q.position.dot(axis) * axis;
    longitude += std::atan2(axis.dot(a.cross(b)), a.dot(b));
    p = q;
  }
  // Runge-Kutta with 1600 steps a period: (period/1600)^4 ~ 1e-10 times constants.
  constexpr double integration = 1e-7;
  EXPECT_NEAR(std::abs(longitude), std::abs(rod.longitude_per_period()), integration) << "sigma " << c.sigma;
  EXPECT_NEAR(p.position.dot(axis), origin.position.dot(axis), integration) << "the latitude repeats";
}

TEST(ClosedFormSphere, WavelikeFamily) {
  for (const Case& c : wavelike) expect_sound(c, true);
}

TEST(ClosedFormSphere, OrbitlikeFamily) {
  for (const Case& c : orbitlike) expect_sound(c, false);
}

TEST(ClosedFormSphere, LongitudeIsTheIntegralOfItsRate) {
  for (const Case& c : {wavelike[0], wavelike[2], orbitlike[0], orbitlike[3]}) {
    const SphereElastica rod(c.sigma, c.kappa_max);
    double sum = 0.0;  // trapezoids converge geometrically on a periodic integrand
    const int n = 400;
    for (int i = 0; i < n; ++i) sum += rod.longitude_rate(i * rod.period() / n);
    EXPECT_NEAR(sum * rod.period() / n, rod.longitude_per_period(), 1e-10);
  }
}

TEST(ClosedFormSphere, CircleOfConstantCurvature) {
  const SphereElastica rod(1.44, 1.2);
  for (const double chi : {0.0, 0.7, 2.9}) {
    EXPECT_NEAR(rod.kappa_g(chi), 1.2, 1e-15);
    EXPECT_NEAR(rod.state(chi, 3.0).rho, 0.0, 1e-15) << "a free ring bends with one curvature and no tension";
  }
}

TEST(ClosedFormSphere, OutsideTheDomainThrows) {
  EXPECT_THROW(SphereElastica(4.0, 1.5), std::domain_error) << "kappa_max would be the least curvature";
  EXPECT_THROW(SphereElastica(2.0, 2.0), std::domain_error) << "one loop of infinite length";
  EXPECT_THROW(SphereElastica(1.0, 0.0), std::domain_error);
  EXPECT_THROW(SphereElastica(std::nan(""), 1.0), std::domain_error);
}

TEST(SphereElastica, KeepsItsDigitsBesideThePole) {
  // On both sides of κ_σ = 2, as close as 1e-6: the jump is 4π or 2π plus a term linear in the distance.
  const auto longitude = [](double kappa_sigma, double square) {
    return SphereElastica(square - kappa_sigma, std::sqrt(square)).longitude_per_period();
  };
  for (const double distance : {1e-4, 1e-6}) {
    EXPECT_NEAR(longitude(2 - distance, 1.5) - longitude(2 + distance, 1.5), 4 * std::numbers::pi, 10 * distance);
    EXPECT_NEAR(longitude(2 - distance, 6.0) - longitude(2 + distance, 6.0), 2 * std::numbers::pi, 10 * distance);
  }
}

TEST(SphereElastica, ClosedCurvesHaveTheirProgression) {
  for (const bool wave : {true, false}) {
    for (const double kappa_sigma : {0.4, 1.7, 2.2, 5.0}) {
      for (const double q : {-0.5, 0.0, 1.0 / 3, 4.0 / 3, 2.5}) {
        for (const double kappa : elasticae_of_progression(q, kappa_sigma, wave)) {
          const SphereElastica rod(kappa * kappa - kappa_sigma, kappa);
          EXPECT_EQ(rod.wavelike(), wave);
          // near the frontier the longitude grows like the logarithm of the distance: κ_m's last digit shows
          const double distance = std::abs(kappa * kappa / (2 * kappa_sigma) - 1);
          EXPECT_NEAR(rod.longitude_per_period(), 2 * std::numbers::pi * q, 1e-12 + 1e-14 / distance);
        }
      }
    }
  }
  // an orbit around the pole (κ_σ < 2) gains more than a turn, one beside it (κ_σ > 2) never loses longitude
  EXPECT_TRUE(elasticae_of_progression(0.5, 1.0, false).empty());
  EXPECT_TRUE(elasticae_of_progression(-0.2, 3.0, false).empty());
  EXPECT_EQ(elasticae_of_progression(0.5, 3.0, false).size(), 1u);
  EXPECT_THROW(elasticae_of_progression(0.5, 2.0, false), std::domain_error);
}

TEST(SphereRod, BecomesTheElasticaWhenItsStretchVanishes) {
  // difference of order η²: a fourth when η is halved
  const double sigma = 2.0, kappa = 1.8;
  const SphereElastica limit(sigma, kappa);
  const auto off = [&](double eta) {
    const SphereRod rod(sigma, eta, std::sqrt(SphereRod::integral_squared(sigma, eta, kappa, 0.0)));
    EXPECT_NEAR(rod.kappa_max(), kappa, 1e-9);
    return rod.period() - limit.period();
  };
  EXPECT_NEAR(off(0.02) / off(0.01), 4.0, 0.05);
  EXPECT_NEAR(SphereRod::separatrix(sigma, 1e-5), 2 * sigma, 1e-8);
}

TEST(SphereRod, RefusesWhatIsNoRod) {
  EXPECT_THROW(SphereRod(-900.0, 0.05, 10.0), std::domain_error);  // σ η² <= -2
  EXPECT_THROW(SphereRod(10.0, 0.05, 1.0), std::domain_error);     // less than the circle's
  EXPECT_THROW(SphereRod(-10.0, 0.05, 2.0), std::domain_error);    // less than the geodesic's
}

}  // namespace
}  // namespace tendril::closed_form

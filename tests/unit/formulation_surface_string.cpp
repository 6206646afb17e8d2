// Strings on surfaces: great circles, helices, Clairaut's geodesics, catenaries, each against its closed form; the
// same found between two points by shooting.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tendril/closed_form/strings.hpp"
#include "tendril/formulation/surface_string.hpp"
#include "tendril/geometry/error.hpp"

namespace tendril::formulation {
namespace {

constexpr double closed = 1e-10;  // closed form against integration at 1e-13 a step
constexpr double pi = std::numbers::pi;

std::vector<double> evenly(double length, int parts) {
  std::vector<double> s;
  for (int i = 0; i <= parts; ++i) s.push_back(length * i / parts);
  return s;
}

TEST(SurfaceString, GreatCircleAndItsPressure) {
  // (III.1.53-55): κ_g = 0, constant tension 1, ρ = -(1 + η̄²) κ_n
  const SurfaceString string{geometry::sphere(1.0), 0.1, {}};
  const auto curve = integrate_string(string, {0.0, 0.0, 0.7, 1.0}, evenly(2.5, 10));
  ASSERT_TRUE(curve.summary.completed) << curve.summary.reason;
  for (const auto& x : curve.section) {
    const double arc = 1.1 * x.s, c = std::cos(arc), s = std::sin(arc);  // θ from the meridian, which goes north
    EXPECT_NEAR(x.r[0], c, closed);
    EXPECT_NEAR(x.r[1], s * std::sin(0.7), closed);
    EXPECT_NEAR(x.r[2], s * std::cos(0.7), closed);
    EXPECT_NEAR(x.rho, -1.1, closed);
  }
}

TEST(SurfaceString, ClairautOnTheSpheroid) {
  const double a = 1.0, b = 1.5, latitude = 0.8;
  const auto exact = closed_form::spheroid_geodesic(a, b, latitude);
  // crosses the equator with cos(angle to the parallel) = cos U
  const SurfaceString string{geometry::ellipsoid(a, a, b), 0.0, {}};
  const auto curve =
      integrate_string(string, {0.0, 0.0, pi / 2 - latitude, 1.0}, {0.0, exact.length / 4, exact.length});
  ASSERT_TRUE(curve.summary.completed) << curve.summary.reason;
  EXPECT_NEAR(curve.section[1].state[0], latitude, closed);
  EXPECT_NEAR(curve.section[2].state[0], 0.0, closed);
  EXPECT_NEAR(curve.section[2].state[1], exact.longitude, closed);
  // on a sphere every geodesic closes
  EXPECT_NEAR(closed_form::spheroid_geodesic(1.0, 1.0, 0.3).longitude, 2.0 * pi, closed);
}

TEST(SurfaceString, CatenaryOfThePlaneAndOfTheVerticalCylinder) {
  for (const double eta_squared : {0.0, 0.05}) {
    const closed_form::Catenary exact{0.8, 1.3, eta_squared};
    const double radius = 0.6;
    const SurfaceString plane{geometry::vertical_plane(), eta_squared, {0.0, 0.0, -1.3}};
    const SurfaceString cylinder{geometry::cylinder(radius), eta_squared, {0.0, 0.0, -1.3}};
    const auto p = integrate_string(plane, {0.0, 0.0, 0.0, 0.8}, evenly(1.5, 5));
    const auto q = integrate_string(cylinder, {0.0, 0.0, pi / 2, 0.8}, evenly(1.5, 5));  // u is the height there
    ASSERT_TRUE(p.summary.completed && q.summary.completed);
    for (std::size_t i = 0; i < p.section.size(); ++i) {
      const double s = p.section[i].s;
      EXPECT_NEAR(p.section[i].state[0], exact.x(s), closed);
      EXPECT_NEAR(p.section[i].state[1], exact.z(s), closed);
      EXPECT_NEAR(p.section[i].F_3, exact.tension(s), closed);
      EXPECT_NEAR(p.section[i].rho, 0.0, closed);
      EXPECT_NEAR(q.section[i].state[1] * radius, exact.x(s), closed);
      EXPECT_NEAR(q.section[i].state[0], exact.z(s), closed);
    }
  }
}

TEST(SurfaceString, HeavyStringOnTheSphere) {
  for (const double lowest : {-0.6, 0.2}) {
    const closed_form::SphericalCatenary exact(2.0, lowest, 0.5);
    const SurfaceString string{geometry::sphere(1.0), 0.0, {0.0, 0.0, -2.0}};
    const auto curve =
        integrate_string(string, {std::asin(lowest), 0.0, pi / 2, 0.5}, {0.0, exact.length(), 2.0 * exact.length()});
    ASSERT_TRUE(curve.summary.completed) << curve.summary.reason;
    EXPECT_NEAR(std::sin(curve.section[1].state[0]), exact.highest(), closed);
    EXPECT_NEAR(curve.section[1].state[1], exact.longitude(), closed);
    EXPECT_NEAR(std::sin(curve.section[2].state[0]), lowest, closed);
    EXPECT_NEAR(curve.section[2].state[1], 2.0 * exact.longitude(), closed);
  }
}

TEST(SurfaceString, CarriesTensionOnly) {
  EXPECT_THROW(integrate_string({geometry::sphere(1.0), 0.0, {}}, {0.0, 0.0, 0.7, 0.0}, {0.0, 1.0}),
               geometry::GeometryError);
  // rolled down a cylinder until its tension is spent: a status
  const auto curve =
      integrate_string({geometry::cylinder(0.5), 0.0, {0.0, 0.0, -2.0}}, {0.0, 0.0, pi, 1.0}, {0.0, 0.4, 0.6});
  EXPECT_FALSE(curve.summary.completed);
  EXPECT_EQ(curve.section.size(), 2u);
  EXPECT_NEAR(curve.section.back().F_3, 0.2, closed);
}

TEST(SurfaceString, BetweenTwoPoints) {
  // the helix of a cylinder, going once around on the way
  const auto helix = solve_geodesic(geometry::cylinder(0.5), {0.0, 0.0}, {1.0, 2.5 * pi}, {1.2, 4.0});
  ASSERT_TRUE(helix.converged) << helix.reason;
  EXPECT_NEAR(helix.length, std::hypot(1.0, 1.25 * pi), closed);
  // a great circle: cos(length) = r1·r2
  const auto arc = solve_geodesic(geometry::sphere(1.0), {-0.4, 0.0}, {0.6, 1.5}, {1.0, 1.5});
  ASSERT_TRUE(arc.converged) << arc.reason;
  EXPECT_NEAR(std::cos(arc.length), std::sin(-0.4) * std::sin(0.6) + std::cos(0.4) * std::cos(0.6) * std::cos(1.5),
              closed);
  // the elastic catenary hung between the places it passes at s = -0.5 and 1
  const closed_form::Catenary exact{0.8, 1.3, 0.05};
  const SurfaceString string{geometry::vertical_plane(), 0.05, {0.0, 0.0, -1.3}};
  const auto hung =
      solve_string(string, 1.5, {exact.x(-0.5), exact.z(-0.5)}, {exact.x(1.0), exact.z(1.0)}, {-0.5, 1.0});
  ASSERT_TRUE(hung.converged) << hung.reason;
  EXPECT_NEAR(hung.start[2], -std::atan2(0.65, 0.8), closed);
  EXPECT_NEAR(hung.start[3], exact.tension(-0.5), closed);
  // around a hill: the geodesic on its left, found again from its other end, and a shorter one on its right
  const auto hill = geometry::graph([](const auto& x, const auto& y) { return exp(-2.0 * (x * x + y * y)); });
  const auto there = solve_geodesic(hill, {-1.0, -0.3}, {1.0, 0.4}, {-0.4, 2.5});
  ASSERT_TRUE(there.converged) << there.reason;
  const auto end = integrate_string({hill}, there.start, {0.0, there.length}).section.back().state;
  const auto back = solve_geodesic(hill, {1.0, 0.4}, {-1.0, -0.3}, {end[2] + pi + 0.02, 2.5});
  ASSERT_TRUE(back.converged) << back.reason;
  EXPECT_NEAR(there.length, back.length, closed);
  const auto other = solve_geodesic(hill, {1.0, 0.4}, {-1.0, -0.3}, {pi + 0.1, 2.5});
  ASSERT_TRUE(other.converged) << other.reason;
  EXPECT_GT(std::abs(other.length - there.length), 0.05);
}

}  // namespace
}  // namespace tendril::formulation

// Rods bound to parametric surfaces: closed forms (cylinder, sphere, torus), first integrals, balance in the world
// frame, invariance under another parametrisation, clamped ends found again.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tendril/closed_form/helix.hpp"
#include "tendril/closed_form/sphere.hpp"
#include "tendril/formulation/line_contact.hpp"
#include "tendril/formulation/surface_rod.hpp"
#include "tendril/formulation/surface_rod_problem.hpp"
#include "tendril/geometry/error.hpp"

namespace tendril::formulation {
namespace {

using geometry::Triple;

constexpr double closed = 1e-10;  // closed form against integration at 1e-13 a step

std::vector<double> evenly(double length, int parts) {
  std::vector<double> s;
  for (int i = 0; i <= parts; ++i) s.push_back(length * i / parts);
  return s;
}

geometry::SurfacePtr wavy() {
  return geometry::graph([](const auto& x, const auto& y) { return 0.3 * (sin(x) * cos(2.0 * y)) + 0.1 * (x * y); });
}

TEST(SurfaceRod, HelixOnTheCylinder) {
  for (const double eta : {0.0, 0.2}) {
    const double radius = 0.6, angle = 0.7, F_3 = 1.3, M_3 = -0.8;
    const auto exact = closed_form::helix_on_cylinder({radius, angle}, F_3, M_3, eta);  // N outward
    const SurfaceRod rod{geometry::cylinder(radius), eta * eta, 1.0 / 3.0, {}, {}};     // N inward: see notation
    const SurfaceRodState<double> start{0.1, 0.2, angle, 0.0, -exact.F_g, F_3, M_3, 0.4};
    const auto curve = integrate_surface_rod(rod, start, evenly(3.0, 6));
    ASSERT_TRUE(curve.summary.completed) << curve.summary.reason;
    for (const auto& x : curve.section) {
      EXPECT_NEAR(x.kappa_g, 0.0, closed);
      EXPECT_NEAR(x.kappa_n, -exact.kappa_n, closed);
      EXPECT_NEAR(x.tau_g, exact.tau_g, closed);
      EXPECT_NEAR(x.F_g, -exact.F_g, closed);
      EXPECT_NEAR(x.F_n, 0.0, closed);
      EXPECT_NEAR(x.rho, -exact.rho, closed);
      EXPECT_NEAR(x.state[iu], 0.1 + exact.alpha * x.s * std::cos(angle), closed);
      EXPECT_NEAR(x.state[iv], 0.2 + exact.alpha * x.s * std::sin(angle) / radius, closed);
      EXPECT_NEAR(x.state[ipsi], 0.4 + x.s * (4.0 / 3.0 * M_3 - exact.alpha * exact.tau_g), closed);
    }
  }
}

TEST(SurfaceRod, ElasticaOnTheSphere) {
  struct Case {
    double sigma, kappa_max;
  };
  for (const Case c : {Case{0.5, 1.7}, Case{-1.3, 0.9}, Case{2.0, 1.8}, Case{6.0, 3.0}}) {
    const double M_3 = 1.4;
    const closed_form::SphereElastica exact(c.sigma, c.kappa_max);  // N outward
    const SurfaceRod rod{geometry::sphere(1.0), 0.0, 0.0, {}, {}};  // N inward
    const auto at = [&](double s) { return exact.state(s, M_3); };
    const auto first = at(0.3);
    const SurfaceRodState<double> start{0.2, 0.1, 0.5, -first.kappa_g, -first.F_g, first.F_3, M_3, 0.0};
    const auto curve = integrate_surface_rod(rod, start, evenly(2.0, 8));
    ASSERT_TRUE(curve.summary.completed) << curve.summary.reason;
    for (const auto& x : curve.section) {
      const auto e = at(0.3 + x.s);
      EXPECT_NEAR(x.kappa_g, -e.kappa_g, closed);
      EXPECT_NEAR(x.F_g, -e.F_g, closed);
      EXPECT_NEAR(x.F_n, -e.F_n, closed);
      EXPECT_NEAR(x.F_3, e.F_3, closed);
      EXPECT_NEAR(x.rho, -e.rho, closed);
    }
  }
}

TEST(SurfaceRod, VillarceauCircleOfTheTorusIsAFreeRing) {
  const double minor = 0.4, M_3 = 0.9;
  const SurfaceRod rod{geometry::torus(1.0, minor), 0.0, 0.0, {}, {}};  // N outward
  // at the outer equator t makes sinθ = minor with the parallel, κ_g = 0, κ_n = -1 and F_g = -κ_n M_3 (F = M_3 κ b)
  const SurfaceRodState<double> start{0.0, 0.0, std::asin(minor), 0.0, M_3, 0.0, M_3, 0.0};
  // the initial value problem loses seven digits on a whole turn: a third of it is exact enough
  const auto curve = integrate_surface_rod(rod, start, evenly(2.0 / 3.0 * std::numbers::pi, 6));
  ASSERT_TRUE(curve.summary.completed) << curve.summary.reason;
  for (const auto& x : curve.section) {
    EXPECT_NEAR(x.rho, 0.0, closed);
    EXPECT_NEAR(x.F_3, 0.0, closed);
    EXPECT_NEAR(x.kappa_g * x.kappa_g + x.kappa_n * x.kappa_n, 1.0, closed);
  }
}

TEST(SurfaceRod, WorldBalanceAndEnergyEverywhere) {
  // Weight, body couple, torque, stretch, on every kind of surface.
  struct Case {
    geometry::SurfacePtr surface;
    double u, v;
  };
  for (const Case& c : {Case{geometry::sphere(1.2), 0.2, 0.1}, Case{geometry::cylinder(0.8), 0.2, 0.1},
                        Case{geometry::torus(1.0, 0.35), 0.2, 0.1}, Case{geometry::ellipsoid(1.0, 0.8, 0.7), 0.2, 0.1},
                        Case{wavy(), 0.2, 0.1}}) {
    for (const double eta_squared : {0.0, 0.01}) {
      for (const double couple : {0.0, 0.3}) {
        const SurfaceRod rod{c.surface, eta_squared, 0.3, {0.3, -0.2, -1.5}, {0.0, couple, -0.5 * couple}};
        const SurfaceRodState<double> y{c.u, c.v, 0.6, 0.4, 0.5, 1.1, -0.7, 0.0};
        const int pieces = 12;
        const auto curve = integrate_surface_rod(rod, y, balance_places(1.5, pieces));
        ASSERT_TRUE(curve.summary.completed) << curve.summary.reason;
        const auto left = world_imbalance(rod, curve.section, pieces);
        EXPECT_LT(left.force, closed);
        EXPECT_LT(left.moment, closed);
        if (couple == 0.0) {
          EXPECT_NEAR(surface_rod_energy(rod, curve.section.back()), surface_rod_energy(rod, curve.section.front()),
                      closed);
        }
      }
    }
  }
}

TEST(SurfaceRod, AnotherParametrisationGivesTheSameRod) {
  // The torus with skewed, stretched parameters: u = a + 0.4 b², v = b - 0.3 sin a.
  const auto plain = geometry::torus(1.0, 0.35);
  const auto skewed = geometry::surface_from([](const auto& a, const auto& b) {
    using T = std::decay_t<decltype(a)>;
    const T u = a + 0.4 * (b * b), v = b - 0.3 * sin(a), rho = 1.0 + 0.35 * cos(v);
    return Triple<T>{{rho * cos(u), rho * sin(u), 0.35 * sin(v)}};
  });
  const double a = 0.3, b = 0.5, u = a + 0.4 * b * b, v = b - 0.3 * std::sin(a), theta = 0.9;
  const SurfaceRod one{plain, 0.02, 0.3, {0.1, 0.2, -1.0}, {}}, two{skewed, 0.02, 0.3, {0.1, 0.2, -1.0}, {}};
  // the same direction in the other parameters
  const auto d = geometry::surface_direction<double>(geometry::lift(plain->patch(u, v), u, v), theta);
  const auto at_zero = geometry::surface_direction<double>(geometry::lift(skewed->patch(a, b), a, b), 0.0);
  const double other = std::atan2(dot(d.t, at_zero.g), dot(d.t, at_zero.t));
  const SurfaceRodState<double> y{u, v, theta, 0.4, 0.5, 1.1, -0.7, 0.0}, z{a, b, other, 0.4, 0.5, 1.1, -0.7, 0.0};
  const auto p = integrate_surface_rod(one, y, evenly(0.8, 4)), q = integrate_surface_rod(two, z, evenly(0.8, 4));
  ASSERT_TRUE(p.summary.completed && q.summary.completed);
  for (std::size_t i = 0; i < p.section.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(p.section[i].r[k], q.section[i].r[k], closed);
      EXPECT_NEAR(p.section[i].F[k], q.section[i].F[k], closed);
      EXPECT_NEAR(p.section[i].M[k], q.section[i].M[k], closed);
    }
    EXPECT_NEAR(p.section[i].rho, q.section[i].rho, closed);
  }
}

TEST(SurfaceRod, AxialMomentOnSurfacesOfRevolution) {
  // Normals meet the axis and the weight is parallel to it: (M + r x F)·e_z is constant.
  for (const auto& surface :
       {geometry::torus(1.0, 0.35), geometry::ellipsoid(1.0, 1.0, 0.6), geometry::cylinder(0.5)}) {
    const SurfaceRod rod{surface, 0.01, 0.3, {0.0, 0.0, -2.0}, {}};
    const auto curve = integrate_surface_rod(rod, {0.2, 0.3, 0.8, 0.4, 0.5, 1.1, -0.7, 0.0}, evenly(2.0, 4));
    ASSERT_TRUE(curve.summary.completed) << curve.summary.reason;
    const auto axial = [](const SurfaceRodSection& x) { return x.M[2] + x.r[0] * x.F[1] - x.r[1] * x.F[0]; };
    for (const auto& x : curve.section) EXPECT_NEAR(axial(x), axial(curve.section.front()), closed);
  }
}

TEST(SurfaceRod, ClampedEndsAreFoundAgain) {
  for (const auto& surface : {geometry::ellipsoid(1.0, 0.8, 0.7), wavy(), geometry::torus(1.0, 0.35)}) {
    const SurfaceRod rod{surface, 0.01, 0.3, {0.0, 0.0, -2.0}, {0.2, 0.1, -0.3}};
    const SurfaceRodState<double> y{0.2, 0.3, 0.8, 0.4, 0.5, 1.1, -0.7, 0.0};
    const auto curve = integrate_surface_rod(rod, y, evenly(1.5, 1));
    ASSERT_TRUE(curve.summary.completed) << curve.summary.reason;
    const auto& end = curve.section.back().state;
    ClampedSurfaceRod problem{rod, 1.5, {y[iu], y[iv], y[itheta]}, {end[iu], end[iv], end[itheta]}, end[iM_3]};
    const auto found = solve_clamped(problem, {0.3, 0.3, 1.4});
    ASSERT_TRUE(found.converged) << found.reason;
    for (const int i : {ikappa_g, iF_g, iF_3, iM_3}) EXPECT_NEAR(found.start[i], y[i], closed);
    EXPECT_GT(std::abs(end[iM_3] - y[iM_3]), 1e-3);  // the body couple has turned it
  }
}

TEST(SurfaceRod, CollocationAndShootingAgree) {
  const SurfaceRod rod{wavy(), 0.01, 0.3, {0.0, 0.0, -2.0}, {}};
  ClampedSurfaceRod problem{rod, 1.6, {-0.6, -0.5, 0.3}, {0.6, 0.4, 0.9}, -0.7};
  auto collocated = surface_rod_problem(rod, clamped_conditions(problem));
  guess_from(collocated, rod, {{-0.6, -0.5, 0.3, 0, 0, 0, -0.7, 0}, {0.6, 0.4, 0.9, 0, 0, 0, -0.7, 0}}, 1.6, 8);
  collocation::BvpOptions options;
  options.tolerance = 1e-11;
  const auto summary = collocated.solve(collocation::Closure::at(0.0), options);
  ASSERT_TRUE(summary.converged) << summary.reason;
  const auto y = state_at(collocated, 0.0);
  const auto shot = solve_clamped(problem, {y[ikappa_g] + 0.1, y[iF_g] + 0.1, y[iF_3] - 0.1});
  ASSERT_TRUE(shot.converged) << shot.reason;
  for (const int i : {ikappa_g, iF_g, iF_3}) EXPECT_NEAR(shot.start[i], y[i], 1e-9);  // |F| of some 20
}

TEST(SurfaceRod, WholeVillarceauCircleBetweenClamps) {
  const double minor = 0.4, M_3 = 0.9, turn = 2.0 * std::numbers::pi;
  const SurfaceRod rod{geometry::torus(1.0, minor), 0.0, 0.0, {}, {}};
  // tan(v/2) = sqrt((1+minor)/(1-minor)) tan(ξ/2) with u the longitude: both grow by a turn
  const double tilt = std::asin(minor);
  auto ring = surface_rod_problem(rod, clamped_conditions({rod, turn, {0.0, 0.0, tilt}, {turn, turn, tilt}, M_3}));
  guess_from(ring, rod, {{0, 0, tilt, 0, M_3, 0, M_3, 0}, {turn, turn, tilt, 0, M_3, 0, M_3, 0}}, turn, 16);
  collocation::BvpOptions options;
  options.tolerance = 1e-11;
  const auto summary = ring.solve(collocation::Closure::at(0.0), options);
  ASSERT_TRUE(summary.converged) << summary.reason;
  for (const auto& x : sections_of(ring, rod, 24)) {
    EXPECT_NEAR(x.rho, 0.0, 1e-9);  // third derivatives of the collocated solution
    EXPECT_NEAR(x.F_3, 0.0, closed);
    EXPECT_NEAR(std::hypot(x.kappa_g, x.kappa_n), 1.0, closed);
  }
}

TEST(SurfaceRod, TheEulerianLineContactHoldsOnItsSolutions) {
  // The torus as a ringed surface: D1 = e_r, D2 = -e_z, D3 = e_θ, U = (0, -1, 0), β = -v, S = u; N outward in both. The
  // inputs of the line-contact equations are taken along a solved rod, higher derivatives in S by 7-point differences.
  const double minor = 0.35, at = 0.5, h = 0.01;
  const SurfaceRod rod{geometry::torus(1.0, minor), 0.02, 0.3, {0.0, 0.0, -1.5}, {0.0, 0.0, 0.4}};
  const SurfaceRodState<double> start{-0.4, 0.3, 0.5, 0.2, 0.3, 2.5, -0.7, 0.1};
  const auto slope = [&rod](const SurfaceRodState<double>& y) {
    SurfaceRodState<double> dy;
    double F_n;
    surface_rod_slope(rod, y, dy, F_n);
    return dy;
  };
  // over S = u: dy/dS = (dy/ds)/(du/ds)
  const auto over_u = [&](double, const SurfaceRodState<double>& y, SurfaceRodState<double>& dy) {
    dy = slope(y);
    const double rate = dy[iu];
    for (double& d : dy) d /= rate;
    return rate > 0.0;
  };
  std::array<SurfaceRodState<double>, 7> y;
  std::array<double, 7> beta_1, psi_1;
  for (int k = 0; k < 7; ++k) {
    y[k] = start;
    ASSERT_TRUE(numerics::integrate(over_u, 0.0, at + (k - 3) * h, y[k]).completed);
    SurfaceRodState<double> rate;
    over_u(0.0, y[k], rate);
    beta_1[k] = -rate[iv];
    psi_1[k] = rate[ipsi];
  }
  const auto first = [&](const std::array<double, 7>& f) {
    return (45.0 * (f[4] - f[2]) - 9.0 * (f[5] - f[1]) + (f[6] - f[0])) / (60.0 * h);
  };
  const auto second = [&](const std::array<double, 7>& f) {
    return (-490.0 * f[3] + 270.0 * (f[4] + f[2]) - 27.0 * (f[5] + f[1]) + 2.0 * (f[6] + f[0])) / (180.0 * h * h);
  };
  SurfaceRodState<double> rate;
  over_u(0.0, y[3], rate);
  const double inputs[LineContact::inputs] = {-y[3][iv],  beta_1[3],  first(beta_1), second(beta_1),
                                              y[3][ipsi], psi_1[3],   first(psi_1),  y[3][iF_g],
                                              rate[iF_g], y[3][iF_3], rate[iF_3]};
  Section section;
  section.U[0] = {0.0, -1.0, 0.0};
  section.Q[0] = minor;
  section.sigma = {0.0, 1.5, 0.0};  // -1.5 e_z = 1.5 D2
  section.mu = {0.0, -0.4, 0.0};
  double residual[LineContact::components], arc, F_n;
  LineContact::residual<double>({0.02, 0.3}, lift(section, 0.0, 0.0), lift_clearance(section, 0.0, 0.0), inputs,
                                residual, &arc, &F_n);
  const auto x = surface_rod_section(rod, 0.0, y[3]);
  constexpr double differences = 5e-9;  // of the stencils: 64 times less for half the step
  for (const double r : residual) EXPECT_NEAR(r, 0.0, differences);
  EXPECT_NEAR(F_n, x.F_n, differences);
  EXPECT_GT(std::abs(x.F_n), 0.1);
}

TEST(SurfaceRod, RefusesWhatMakesNoSense) {
  using geometry::GeometryError;
  EXPECT_THROW(geometry::sphere(-1.0), GeometryError);
  EXPECT_THROW(geometry::torus(1.0, 1.2), GeometryError);
  const SurfaceRod rod{geometry::sphere(1.0), 0.0, 0.0, {}, {}};
  const SurfaceRodState<double> y{0.1, 0.0, 0.3, 0.0, 0.0, 1.0, 0.0, 0.0};
  EXPECT_THROW(integrate_surface_rod(rod, y, {}), GeometryError);
  EXPECT_THROW(integrate_surface_rod(rod, y, {0.0, 1.0, 0.5}), GeometryError);
  EXPECT_THROW(integrate_surface_rod({geometry::sphere(1.0), -0.1, 0.0, {}, {}}, y, {0.0, 1.0}), GeometryError);
  auto bad = y;
  bad[iF_3] = std::nan("");
  try {
    integrate_surface_rod(rod, bad, {0.0, 1.0});
    FAIL();
  } catch (const GeometryError& e) {
    EXPECT_EQ(e.what_field, "F_3");
  }
  // a cone's tip, where its parameters fail
  const auto cone = geometry::surface_from([](const auto& u, const auto& v) {
    using T = std::decay_t<decltype(u)>;
    return Triple<T>{{u * cos(v), u * sin(v), u}};
  });
  EXPECT_THROW(integrate_surface_rod({cone, 0.0, 0.0, {}, {}}, {0.0, 0.0, 0.3, 0.0, 0.0, 1.0, 0.0, 0.0}, {0.0, 1.0}),
               GeometryError);
}

TEST(SurfaceRod, ACrushedRodIsAStatus) {
  const SurfaceRod rod{geometry::cylinder(0.5), 0.01, 0.0, {}, {}};
  const auto curve = integrate_surface_rod(rod, {0.0, 0.0, 0.3, 0.0, 0.0, -150.0, 0.0, 0.0}, {0.0, 1.0});
  EXPECT_FALSE(curve.summary.completed);
  EXPECT_STRNE(curve.summary.reason, "");
}

}  // namespace
}  // namespace tendril::formulation

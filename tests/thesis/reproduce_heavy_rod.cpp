// The system `heavy_rod`: its table, the shape of the response curve, and states against the integrated rod.

#include <Eigen/Geometry>

#include "support/outcome.hpp"
#include "tendril/reproduce/heavy_rod_states.hpp"

namespace tendril::test {
namespace {

using namespace reproduce::heavy;

TEST(Reproduce, HeavyRod) { expect_sound(system_named("heavy_rod")); }

/// Classical Runge-Kutta along the rod from the clamp, in 4000 steps: an integration that shares nothing with the
/// collocation. Its error is the fourth power of the step, 1e-12 or so, times the growth of the rod's own instability.
TEST(HeavyRod, IsTheIntegratedRod) {
  constexpr double weight = 5.0, integrated = 1e-9;
  auto rod = rod_problem(weight, Vary::torque);
  collocation::BvpOptions options;
  options.tolerance = 1e-11;
  for (const double torque : {0.0, 3.0, 6.0, 8.0}) {
    ASSERT_TRUE(rod.solve(collocation::Closure::at(torque), options).converged);
    const double l = length_of(rod);
    Section s = section_at(rod, 0.0);
    const auto rate = [&](const Section& c) {
      return Section{l * c.t, l * c.M.cross(c.t), -l * c.t.cross(c.F), l * weight * Vec::UnitZ()};
    };
    const auto moved = [](const Section& c, double h, const Section& d) {
      return Section{c.r + h * d.r, c.t + h * d.t, c.M + h * d.M, c.F + h * d.F};
    };
    constexpr int steps = 4000;
    for (int i = 0; i < steps; ++i) {
      const double h = 1.0 / steps;
      const Section a = rate(s), b = rate(moved(s, h / 2, a)), c = rate(moved(s, h / 2, b)), d = rate(moved(s, h, c));
      s = moved(moved(moved(moved(s, h / 6, a), h / 3, b), h / 3, c), h / 6, d);
    }
    SCOPED_TRACE(torque);
    EXPECT_NEAR(s.r.x(), 1, integrated);
    EXPECT_NEAR(std::hypot(s.r.y(), s.r.z()), 0, integrated);
    EXPECT_NEAR(s.t.x(), 1, integrated);
    EXPECT_NEAR(s.F.dot(s.t), 0, 10 * integrated);
    EXPECT_NEAR(s.M.dot(s.t), torque, 10 * integrated);
  }
}

/// The slope of the end force over the length against two neighbouring lengths.
TEST(HeavyRod, StiffnessOfFeedingIsTheSlope) {
  constexpr double weight = 5.0, torque = 6.0;
  auto rod = rod_problem(weight, Vary::torque);
  collocation::BvpOptions options;
  ASSERT_TRUE(rod.solve(collocation::Closure::at(torque), options).converged);
  const double slope = stiffness_of_feeding(rod, weight);
  auto pulled = rod_problem(weight, Vary::end_force, torque);
  pulled.initialise([&](int, double x, double* u, double* r) { rod.evaluate(0, x, u, r); }, rod.pieces());
  constexpr double h =
      0.01;  // of F3; central differences: relative error of the order of (h/38)², 38 the thrust that buckles
  double length[2];
  for (const int side : {0, 1}) {
    ASSERT_TRUE(pulled.solve(collocation::Closure::at(side == 0 ? -h : h), options).converged);
    length[side] = length_of(pulled);
  }
  EXPECT_NEAR(2 * h / (length[1] - length[0]) / slope, 1, 1e-4);
}

}  // namespace
}  // namespace tendril::test

// The small inclination solver: point contacts, the limit of its domain, and what it is for: starting the exact solver.
#include <gtest/gtest.h>

#include <cmath>

#include "tendril/continuation/small_inclination.hpp"
#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/reproduce/lagrangian_conduit.hpp"

namespace tendril::continuation {
namespace {

collocation::BvpOptions options() {
  collocation::BvpOptions o;
  o.tolerance = 1e-11;
  return o;
}

double T0() { return reproduce::helical_conduit_force(); }

TEST(SmallInclination, ReproducesTheRodOnTheAxis) {
  // δ = 0 solves the approximate equations, too: (II.3.19) has no δ
  const auto o = small_inclination(reproduce::helical_conduit_case(1.0 / 20, -T0()), options());
  ASSERT_TRUE(o.converged) << o.reason;
  for (double S : {0.1, 0.37, 0.5, 0.9}) {
    const auto c = o.rod->at(S);
    EXPECT_NEAR(std::hypot(c.inputs[0], c.inputs[4]), 0.0, 1e-11) << S;
    EXPECT_NEAR(c.inputs[15], -T0(), 1e-9);
  }
}

TEST(SmallInclination, FindsAPointContactThatPushes) {
  const auto o = small_inclination(reproduce::helical_conduit_case(1.0 / 20, -2.0 * T0()), options());
  ASSERT_TRUE(o.converged) << o.reason;
  ASSERT_EQ(o.rod->segments(), 2);
  EXPECT_NEAR(o.rod->place(1), 0.5, 1e-9);  // symmetric
  EXPECT_GT(o.rod->reaction(1), 0.0);
  const auto c = o.rod->at(1, 0.0);
  EXPECT_NEAR(std::hypot(c.inputs[0], c.inputs[4]), 1.0 / 20, 1e-12);
  const Step s = describe(*o.rod, 0);
  ASSERT_EQ(s.contacts.size(), 1u);
  EXPECT_NEAR(s.contacts[0].force_vector.norm(), o.rod->reaction(1), 1e-12);
}

TEST(SmallInclination, RefusesALineContact) {
  const auto o = small_inclination(reproduce::helical_conduit_case(1.0 / 40, -2.5 * T0()), options());
  EXPECT_FALSE(o.converged);
  EXPECT_TRUE(o.outside_domain);
  EXPECT_NE(o.reason.find("line contact"), std::string::npos) << o.reason;
}

TEST(SmallInclination, StartsTheExactSolver) {
  for (double load : {-1.2, -0.5}) {
    const auto o = small_inclination(reproduce::helical_conduit_case(1.0 / 20, load * T0()), options());
    ASSERT_TRUE(o.converged) << o.reason;
    segmentation::Chain c = exact_start(*o.rod);
    const auto s = c.solve_adaptive({segmentation::Closure::Kind::parameter, 0, 0.0}, {}, 1e-10);
    ASSERT_TRUE(s.converged) << s.reason;
    // the world-frame solver's state
    const auto twin = reproduce::lagrangian_conduit(1.0 / 20, load * T0(), reproduce::Touch::none, 1e-10);
    ASSERT_TRUE(twin.converged) << twin.reason;
    double u[17], length;
    c.sample(1.0, u, &length);
    EXPECT_NEAR(length, twin.rod->length(), 1e-9);
  }
}

TEST(SmallInclination, TakesEveryKindOfEnd) {
  // pinned, push, held length, twist: each solved state satisfies what was asked, and they are the same state
  segmentation::Problem p;
  p.tube.axis = geometry::make_arc(4.0, 1.0);
  p.tube.clearance = geometry::make_constant(0.1);
  p.rod = {1.0, 0.8, 300.0};
  p.end.kind = segmentation::End::Kind::pinned;
  p.end_position = 1.0;
  p.start.eccentricity[0] = 0.01;
  p.end.eccentricity[1] = -0.02;
  p.axial_value = -4.0;
  p.twist_value = 0.6;
  const auto a = small_inclination(p, options());
  ASSERT_TRUE(a.converged) << a.reason;
  const auto end = a.rod->at(1.0);
  EXPECT_NEAR(end.M1, 0.0, 1e-10);
  EXPECT_NEAR(end.M2, 0.0, 1e-10);
  EXPECT_NEAR(end.M3, 0.6, 1e-10);
  EXPECT_NEAR(end.inputs[15], -4.0, 1e-10);
  const Step s = describe(*a.rod, 0);
  for (int kind = 0; kind < 2; ++kind) {
    segmentation::Problem q = p;
    q.axial = kind == 0 ? segmentation::AxialControl::push : segmentation::AxialControl::rod_length;
    q.axial_value = kind == 0 ? s.push : s.rod_length;
    q.twist = segmentation::TwistControl::twist;
    q.twist_value = end.inputs[8];
    const auto b = small_inclination(q, options());
    ASSERT_TRUE(b.converged) << b.reason;
    EXPECT_NEAR(b.rod->at(1.0).inputs[15], -4.0, 1e-8);
    EXPECT_NEAR(b.rod->at(1.0).M3, 0.6, 1e-8);
    EXPECT_NEAR(b.rod->at(0.5).inputs[0], a.rod->at(0.5).inputs[0], 1e-9);
  }
}

}  // namespace
}  // namespace tendril::continuation

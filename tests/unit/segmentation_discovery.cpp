// Discovery from nothing: the helical conduit of model section 7, the straight round tube of design section 5, lying
// and winding rods. States are finite-element states: lengths and places to a few digits.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/segmentation/discovery.hpp"

namespace {

using namespace tendril;
using segmentation::AxialControl;
using segmentation::discover;
using segmentation::DiscoveryProblem;
constexpr double pi = std::numbers::pi;
constexpr double T0 = 7.0690329710;

DiscoveryProblem helical_conduit(double clearance, double load) {
  DiscoveryProblem p;
  p.tube = {geometry::make_helix(1.0 / (pi * std::sqrt(2.0)), pi / 4.0, 1.0), geometry::make_constant(clearance)};
  p.data.eta2 = 1.0 / 400.0;
  p.data.nu = 1.0 / 3.0;
  p.twist_value = -1.0;
  p.axial_value = load * T0;
  return p;
}

struct Row {
  double clearance, load, S1, end_force, length;
};

TEST(Discovery, HelicalConduitFromNothing) {
  // model section 7, continuous phase
  const Row rows[] = {{0.05, -5, 0.386028, 15.01659, 1.1979060},  {0.05, -10, 0.308279, 27.16998, 1.3355420},
                      {0.025, -5, 0.348736, 11.47938, 1.1502132}, {0.025, -10, 0.278517, 20.31662, 1.2784074},
                      {0.025, 5, 0.383236, 12.88791, 0.8717895},  {0.025, 10, 0.345356, 19.29295, 0.7993206}};
  for (const auto& row : rows) {
    for (const bool march : {false, true}) {
      segmentation::DiscoveryOptions o;
      o.march_length = march;
      const auto r = discover(helical_conduit(row.clearance, row.load), o);
      ASSERT_TRUE(r.converged) << r.message << row.load;
      EXPECT_EQ(r.negative, 0);
      EXPECT_LT(r.force_slope, 0.0);
      EXPECT_NEAR(r.axial_force_end, row.load * T0, 1e-4);
      EXPECT_NEAR(r.state.length, row.length, 1e-4);  // elements of 1/48 with cubic shape
      ASSERT_EQ(r.contacts.size(), 1u);
      EXPECT_TRUE(r.contacts[0].line);
      EXPECT_NEAR(r.contacts[0].start, row.S1, 3e-3);  // a seventh of an element
      EXPECT_NEAR(r.contacts[0].end, 1.0 - row.S1, 3e-3);
      EXPECT_NEAR(r.contacts[0].force_start, row.end_force,
                  0.12 * row.end_force);  // the mesh smears the concentrated end
      EXPECT_NEAR(r.s.back(), r.state.length, 1e-12);
    }
  }
}

TEST(Discovery, HelicalConduitFreeAndPoint) {
  const auto free = discover(helical_conduit(0.05, -1.25), {});
  ASSERT_TRUE(free.converged);
  EXPECT_TRUE(free.contacts.empty());
  EXPECT_NEAR(free.state.length, 1.0708511544, 2e-6);
  const auto point = discover(helical_conduit(0.05, -2.0), {});
  ASSERT_TRUE(point.converged);
  ASSERT_EQ(point.contacts.size(), 1u);
  EXPECT_FALSE(point.contacts[0].line);
  EXPECT_NEAR(point.contacts[0].start, 0.5, 1e-4);
  const auto transition = discover(helical_conduit(0.05, -2.640046467), {});
  ASSERT_TRUE(transition.converged);
  EXPECT_NEAR(transition.state.length, 1.127716284, 1e-4);
  double force = 0.0;
  for (const auto& c : transition.contacts) force += c.force;
  EXPECT_NEAR(force, 13.16761489, 0.01);
}

TEST(Discovery, NearlyStraightConduitRefines) {
  // The energy's order shows in the length: doubling the elements divides its error by eight or more (contacts on no
  // node).
  auto p = helical_conduit(0.05, -1.25);
  double last = 0.0;
  for (const int n : {8, 16, 32}) {
    segmentation::DiscoveryOptions o;
    o.elements = n;
    const double error = std::abs(discover(p, o).state.length - 1.0708511544);
    if (last > 0.0) EXPECT_LT(error, last / 8.0);
    last = error;
  }
}

DiscoveryProblem straight_tube(double clearance, AxialControl axial, double value) {
  DiscoveryProblem p;
  p.tube = {geometry::make_straight(2.0), geometry::make_constant(2.0 * clearance)};  // scaled: length 1
  p.axial = axial;
  p.axial_value = value;
  return p;
}

TEST(Discovery, StraightTubeByPush) {
  struct Case {
    double load;
    std::size_t contacts;
  };
  for (const auto& [load, contacts] : {Case{0.9, 0}, {1.5, 1}, {1.9, 1}, {2.5, 2}, {2.8, 2}, {3.05, 3}}) {
    const auto r = discover(straight_tube(0.025, AxialControl::push, load * 4.0 * pi * pi), {});
    ASSERT_TRUE(r.converged) << load << r.message;
    EXPECT_EQ(r.contacts.size(), contacts) << load;
    EXPECT_NEAR(r.H_end, -load * 4.0 * pi * pi, 1e-6);
    EXPECT_EQ(r.negative, 0);
  }
}

TEST(Discovery, StraightTubeByLength) {
  // Slightly longer than the tube: buckled and free, then one point contact at the middle.
  const double h = 0.025, first = std::pow(pi * h, 2) / 4.0;  // small slope: δ = h sin²(πS), excess = π²h²/4
  const auto free = discover(straight_tube(h, AxialControl::rod_length, 1.0 + 0.5 * first), {});
  ASSERT_TRUE(free.converged);
  EXPECT_TRUE(free.contacts.empty());
  EXPECT_NEAR(free.H_end, -4.0 * pi * pi, 0.2);  // finite rotations: a few times excess * 4π²
  EXPECT_GT(free.force_slope, 0.0);              // the force falls along the free branch: held length only
  const auto touching = discover(straight_tube(h, AxialControl::rod_length, 1.0 + 1.02 * first), {});
  ASSERT_TRUE(touching.converged);
  ASSERT_EQ(touching.contacts.size(), 1u);
  EXPECT_FALSE(touching.contacts[0].line);
  EXPECT_NEAR(touching.contacts[0].start, 0.5, 1e-3);
  EXPECT_LT(touching.force_slope, 0.0);
  EXPECT_NEAR(touching.state.length, 1.0 + 1.02 * first, 1e-7);
  // On the wall the force rises again: the same state is found by its force.
  auto p = straight_tube(h, AxialControl::axial_force, touching.axial_force_end);
  const auto again = discover(p, {});
  ASSERT_TRUE(again.converged);
  EXPECT_NEAR(again.state.length, touching.state.length, 1e-6);
}

TEST(Discovery, HeavyRodLies) {
  const double w = 500.0, Q = 0.01;
  auto p = straight_tube(Q, AxialControl::axial_force, -20.0);
  p.data.body_force = {-w, 0.0, 0.0};
  const auto r = discover(p, {});
  ASSERT_TRUE(r.converged);
  ASSERT_EQ(r.contacts.size(), 1u);
  const auto& c = r.contacts[0];
  EXPECT_TRUE(c.line);
  EXPECT_NEAR(std::abs(c.angle_start), pi, 1e-3);
  // Beam on a floor at small thrust: the sum of contact and clamp forces is the weight; the middle carries w per
  // length.
  double middle = 0.0, width = 0.0;
  for (std::size_t i = 0; i < r.wall_S.size(); ++i) {
    if (std::abs(r.wall_S[i] - 0.5) > 0.05) continue;
    middle += r.wall_weight[i] * r.wall_pressure[i];
    width += r.wall_weight[i];
  }
  EXPECT_NEAR(middle / width, w, 0.02 * w);
}

TEST(Discovery, LongWellIsQuickEnoughToSettle) {
  auto p = straight_tube(1.5e-4, AxialControl::axial_force, -1e4);
  p.data.body_force = {-3e3, 0.0, 0.0};
  const auto r = discover(p, {});
  ASSERT_TRUE(r.converged) << r.message;
  EXPECT_NEAR(r.axial_force_end, -1e4, 0.1);
  EXPECT_EQ(r.negative, 0);
  EXPECT_LT(r.iterations, 400);
}

// Outside a straight cylinder, tied to its wall at both ends with one turn and taut: a helix lies on the wall, with
// ρ = ακ(F3 - τ(M3 - ατ)) (model section 7).
TEST(Discovery, WindsOutside) {
  const double Q = 0.05, rate = 2.0 * pi, theta = std::atan(Q * rate), F = 200.0;
  DiscoveryProblem p;
  p.tube = {geometry::make_straight(1.0), geometry::make_constant(Q), geometry::Side::outside};
  p.turns = 1;
  p.start.eccentricity = p.end.eccentricity = {Q, 0.0};
  p.start.slope = p.end.slope = {0.0, Q * rate};
  p.axial_value = F;
  const auto r = discover(p, {});
  ASSERT_TRUE(r.converged) << r.message;
  EXPECT_NEAR(r.state.length, 1.0 / std::cos(theta), 1e-5);
  ASSERT_EQ(r.contacts.size(), 1u);
  EXPECT_TRUE(r.contacts[0].line);
  EXPECT_EQ(r.contacts[0].start, 0.0);
  EXPECT_EQ(r.contacts[0].end, 1.0);
  const double kappa = std::pow(std::sin(theta), 2) / Q, tau = std::sin(theta) * std::cos(theta) / Q;
  const double rho = kappa * (F + tau * tau);
  double middle = 0.0, width = 0.0;
  for (std::size_t i = 0; i < r.wall_S.size(); ++i) {
    if (std::abs(r.wall_S[i] - 0.5) > 0.2) continue;
    middle += r.wall_weight[i] * r.wall_pressure[i];
    width += r.wall_weight[i];
  }
  EXPECT_NEAR(middle / width, rho / std::cos(theta), 0.02 * rho);  // per S
}

// A held twist: the torque that comes out reproduces it.
TEST(Discovery, HeldTwist) {
  auto p = helical_conduit(0.05, -5.0);
  const auto free = discover(p, {});
  p.twist = segmentation::TwistControl::twist;
  p.twist_value = free.phi.back();
  const auto held = discover(p, {});
  ASSERT_TRUE(held.converged);
  EXPECT_NEAR(held.state.torque, -1.0, 1e-4);  // contact multipliers settle to that
  EXPECT_NEAR(held.phi.back(), free.phi.back(), 1e-6);
  EXPECT_NEAR(held.state.length, free.state.length, 1e-4);
}

}  // namespace

// Bifurcations of the straight rod on the axis of its tube, found by the path follower: the rod buckles in two planes
// at once, so every branch point is double and the determinant keeps its sign.

#include <gtest/gtest.h>

#include "support/problems.hpp"
#include "tendril/closed_form/columns.hpp"
#include "tendril/continuation/study.hpp"

namespace tendril::test {
namespace {

using continuation::Result;
using segmentation::AxialControl;
using segmentation::BranchRule;

constexpr double asked = 1e-8;

Problem straight_tube(double axial_stiffness) {
  Problem p;
  p.tube.axis = geometry::make_straight(1.0);
  p.tube.clearance = geometry::make_constant(0.05);
  p.rod = {1.0, 0.75, {}};
  if (axial_stiffness > 0) p.rod.axial_stiffness = axial_stiffness;
  p.end.kind = End::Kind::sleeve;
  p.end_position = 1.0;
  return p;
}

std::vector<double> branch_points(const std::function<Problem(double)>& family, double from, double to,
                                  BranchRule rule = BranchRule::symmetric) {
  continuation::StudyOptions options;
  options.solve.branch = rule;
  const Result r = continuation::follow(family, {from, {to}, true}, options);
  EXPECT_EQ(r.status, continuation::Status::converged) << r.message;
  std::vector<double> found;
  for (const auto& e : r.events)
    if (e.kind == "branch_point") found.push_back(e.parameter);
  return found;
}

/// Thrust P at which the rod of unstressed length 1/α in the held span buckles: P/α = Euler's load, α = 1 - P/EA.
TEST(BranchPoints, EulersLoads) {
  for (const double EA : {0.0, 400.0}) {
    const auto loads = branch_points(
        [EA](double P) {
          Problem p = straight_tube(EA);
          p.axial_value = Scalar(-P, -1.0);
          return p;
        },
        10, 110);
    ASSERT_EQ(loads.size(), 2u) << EA;
    for (int n = 1; n <= 2; ++n) {
      const double P = loads[n - 1], stretch = EA > 0 ? 1 - P / EA : 1;
      EXPECT_NEAR(P / stretch / closed_form::euler_load_clamped(n, 1, 1), 1, asked);
    }
  }
}

/// The torque, under thrust and under tension, of rods with and without stretch: M/α and P/α enter where M and P do.
TEST(BranchPoints, GreenhillsTorque) {
  for (const double EA : {0.0, 400.0})
    for (const double P : {-100.0, -20.0, 0.0, 20.0, 35.0}) {
      const auto torques = branch_points(
          [=](double M) {
            Problem p = straight_tube(EA);
            p.axial_value = -P;
            p.twist_value = Scalar(M, 1.0);
            return p;
          },
          0.5, 26);
      ASSERT_FALSE(torques.empty()) << P;
      const double stretch = EA > 0 ? 1 - P / EA : 1;
      EXPECT_NEAR(torques[0] / stretch / closed_form::greenhill_torque_clamped(P / stretch, 1, 1), 1, asked)
          << "EA " << EA << ", P " << P;
    }
}

/// Asked for a stable state, the path leaves the straight rod there, and says that the length jumps: the bent branch is
/// subcritical.
TEST(BranchPoints, TheStablePathLeavesAtEulersLoad) {
  const double euler = 4 * pi * pi;
  continuation::StudyOptions options;
  const Result r = continuation::follow(
      [=](double x) {
        Problem p = straight_tube(0.0);
        p.axial = AxialControl::push;
        p.axial_value = Scalar(euler * x, euler);
        return p;
      },
      {0.5, {1.5}, true}, options);
  ASSERT_EQ(r.events.size(), 2u);
  EXPECT_EQ(r.events[0].kind, "branch_point");
  EXPECT_NEAR(r.events[0].parameter, 1, asked);
  EXPECT_EQ(r.events[1].kind, "jump");
  ASSERT_EQ(r.steps.size(), 1u);
  EXPECT_EQ(r.steps[0].stability, "stable");
  EXPECT_EQ(r.steps[0].contacts.size(), 1u);
}

}  // namespace
}  // namespace tendril::test

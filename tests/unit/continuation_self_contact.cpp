// Where a rod meets itself: coils wound closer than the rod is thick, and what must not be mistaken for that.

#include <gtest/gtest.h>

#include "support/problems.hpp"
#include "tendril/continuation/self_contact.hpp"
#include "tendril/continuation/study.hpp"

namespace tendril::test {
namespace {

using continuation::Status;

/// A rod in a coiled tube: three turns of radius 0.05, 0.03 apart.
Problem coil(double diameter) {
  constexpr double radius = 0.05, pitch = 0.03;
  Problem p;
  p.tube.axis = geometry::make_helix(radius, std::atan(2 * pi * radius / pitch), 1.0);
  p.tube.clearance = geometry::make_constant(0.004);
  p.rod.torsional_stiffness = 0.75;
  p.rod_diameter = diameter;
  p.end.kind = End::Kind::sleeve;
  p.end_position = 1.0;
  return p;
}

TEST(SelfContact, CoilsCloserThanTheRodIsThick) {
  const auto open = continuation::solve(coil(0.01), {});
  ASSERT_EQ(open.status, Status::converged) << open.message;
  EXPECT_EQ(open.steps[0].message, "") << "coils are 0.03 apart, less twice the clearance";
  const auto touching = continuation::solve(coil(0.04), {});
  ASSERT_EQ(touching.status, Status::converged) << touching.message;
  EXPECT_NE(touching.steps[0].message.find("the rod meets itself"), std::string::npos) << touching.steps[0].message;
}

/// The axis itself goes round and meets itself: a rod in a tube that crosses another part of it.
TEST(SelfContact, ARodThatCrossesItself) {
  const double R = 1 / (2.6 * pi);  // 1.3 turns of a circle
  Problem p;
  p.tube.axis = geometry::make_arc(R, 1.0);
  p.tube.clearance = geometry::make_constant(0.002);
  p.rod.torsional_stiffness = 0.75;
  p.end.kind = End::Kind::sleeve;
  p.end_position = 1.0;
  p.axial_value = 10.0;
  continuation::StudyOptions options;
  options.solve.branch = segmentation::BranchRule::symmetric;
  const auto r = continuation::solve(p, options);
  ASSERT_EQ(r.status, Status::converged) << r.message;
  EXPECT_NE(r.steps[0].message.find("the rod crosses itself"), std::string::npos) << r.steps[0].message;
  p.tube.axis = geometry::make_arc(2 * R, 1.0);
  const auto clear = continuation::solve(p, options);
  ASSERT_EQ(clear.status, Status::converged) << clear.message;
  EXPECT_EQ(clear.steps[0].message, "");
}

}  // namespace
}  // namespace tendril::test

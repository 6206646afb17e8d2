// Where a rod meets itself: coils wound closer than the rod is thick, and what must not be mistaken for that.

#include <gtest/gtest.h>

#include "support/problems.hpp"
#include "tendril/continuation/self_contact.hpp"
#include "tendril/continuation/study.hpp"

namespace tendril::test {
namespace {

using continuation::Status;

/// A rod wound around a straight tube under tension, `turns` turns over unit length.
Problem coil(int turns, double diameter) {
  Problem p;
  p.tube.axis = geometry::make_straight(1.0, Vector3d::UnitZ());
  p.tube.clearance = geometry::make_constant(0.05);
  p.tube.side = geometry::Side::outside;
  p.rod.torsional_stiffness = 0.75;
  p.rod_diameter = diameter;
  p.turns = turns;
  p.start.kind = p.end.kind = End::Kind::pinned;
  p.start.eccentricity[0] = p.end.eccentricity[0] = 0.06;
  p.end_position = 1.0;
  p.axial_value = 400.0;
  return p;
}

TEST(SelfContact, CoilsCloserThanTheRodIsThick) {
  continuation::StudyOptions options;
  const auto open = continuation::solve(coil(8, 0.02), options);
  ASSERT_EQ(open.status, Status::converged) << open.message;
  EXPECT_EQ(open.steps[0].message, "") << "pitch 0.125, six diameters";
  // Neighbouring coils of a helix are less than the pitch, 0.125, apart.
  const auto touching = continuation::solve(coil(8, 0.13), options);
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

// All states of one load: what is known of the rod in a straight tube must be among them.

#include <gtest/gtest.h>

#include "support/problems.hpp"
#include "tendril/continuation/states.hpp"

namespace tendril::test {
namespace {

using continuation::Status;

/// The straight tube at 2.53 Euler loads: the straight state, the planar ones and two spatial ones, of which a rod
/// without torque has mirror images.
TEST(States, StraightTubeHasSeveral) {
  Problem p;
  p.tube.axis = geometry::make_straight(1.0, Vector3d::UnitZ());
  p.tube.clearance = geometry::make_constant(0.025);
  p.rod.torsional_stiffness = 0.75;
  p.end.kind = End::Kind::sleeve;
  p.end_position = 1.0;
  p.axial_value = -100.0;
  p.twist_value = 1.0;
  const auto found = continuation::find_states(p, {});
  ASSERT_GE(found.states.size(), 4u);
  int axis = 0, stable = 0;
  for (const auto& s : found.states) {
    EXPECT_EQ(s.step.status, Status::converged) << s.step.message;
    EXPECT_NEAR(s.step.axial_force_end, -100.0, 1e-6);
    axis += s.on_axis;
    stable += s.step.stability == "stable";
    if (s.on_axis) {
      // straight and twisted: ½M3²/C L
      EXPECT_NEAR(s.energy, 0.5 / 0.75, 1e-9);
      EXPECT_EQ(s.step.stability, "unstable") << "above Euler's load";
    }
  }
  EXPECT_EQ(axis, 1);
  EXPECT_GE(stable, 1);
  EXPECT_EQ(found.states.front().step.stability, "stable") << "stable ones come first";
}

/// The energy of a rod that varies is that of its sections: of the straight, twisted state ½M3² ∫ds/C.
TEST(States, EnergyIsThatOfTheSections) {
  Problem p;
  p.tube.axis = geometry::make_straight(1.0, Vector3d::UnitZ());
  p.tube.clearance = geometry::make_constant(0.025);
  p.rod.torsional_stiffness = 0.75;
  rod::SectionEntry e;
  e.from = 0.6;
  e.to = 5.0;
  e.rod[0] = e.rod[1] = p.rod;
  for (auto& r : e.rod) r.torsional_stiffness = 1.5;
  p.law = rod::section_law(p.rod, 0.0, std::vector<rod::SectionEntry>{e}, false);
  p.end.kind = End::Kind::sleeve;
  p.end_position = 1.0;
  p.axial_value = -20.0;
  p.twist_value = 1.0;
  const auto found = continuation::find_states(p, {});
  ASSERT_GE(found.states.size(), 1u);
  for (const auto& s : found.states)
    if (s.on_axis) EXPECT_NEAR(s.energy, 0.5 * (0.6 / 0.75 + 0.4 / 1.5), 1e-9);
}

}  // namespace
}  // namespace tendril::test

// Fields along the rod: both sides of every junction, so that what jumps there can be seen, and no segment without
// rows.

#include <gtest/gtest.h>

#include <cmath>

#include "tendril/continuation/study.hpp"
#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"

namespace tendril {
namespace {

using continuation::Step;

// The helical conduit of the README: one point contact at -14, one line at -50.
Step conduit(double axial_force, int points) {
  segmentation::Problem p;
  p.tube = {geometry::make_helix(0.225079079, 0.785398163, 1.0), geometry::make_constant(0.05)};
  p.rod = {1.0, 0.75, 400.0};
  p.end.kind = segmentation::End::Kind::sleeve;
  p.end_position = 1.0;
  p.axial_value = axial_force;
  p.twist_value = -1.0;
  continuation::StudyOptions options;
  options.fields = true;
  options.field_points = points;
  return continuation::solve(p, options).steps.at(0);
}

// Last row left of S and first row right of it.
std::pair<std::size_t, std::size_t> beside(const Step& step, double S) {
  const auto& column = step.fields.S;
  const std::size_t right = std::lower_bound(column.begin(), column.end(), S) - column.begin();
  return {right - 1, right};
}

double force_jump(const Step& step, double S) {
  const auto& f = step.fields;
  const auto [l, r] = beside(step, S);
  return std::hypot(f.F1[r] - f.F1[l], f.F2[r] - f.F2[l], f.F3[r] - f.F3[l]);
}

TEST(Fields, ForceJumpsByTheReaction) {
  constexpr double kRelative = 1e-6;  // the solver's 1e-8, and the slope of F over 1e-9 of a segment
  const Step point = conduit(-14.0, 401);
  ASSERT_EQ(point.contacts.size(), 1u);
  EXPECT_NEAR(force_jump(point, point.contacts[0].start), point.contacts[0].force, kRelative * point.contacts[0].force);

  const Step line = conduit(-50.0, 401);
  ASSERT_EQ(line.contacts.size(), 1u);
  const auto& c = line.contacts[0];
  EXPECT_NEAR(force_jump(line, c.start), *c.force_start, kRelative * c.force);
  EXPECT_NEAR(force_jump(line, c.end), *c.force_end, kRelative * c.force);
  // the pressure jumps as well: 0 outside the contact
  const auto [l, r] = beside(line, c.start);
  EXPECT_EQ(line.fields.pressure[l], 0.0);
  EXPECT_GT(line.fields.pressure[r], 0.0);
  EXPECT_LT(line.fields.S[r] - line.fields.S[l], 1e-8);
}

TEST(Fields, EverySegmentHasRows) {
  const Step step = conduit(-50.0, 9);  // steps of 1/8: the contact is not much longer
  ASSERT_EQ(step.segments.size(), 3u);
  for (const auto& segment : step.segments) {
    const long rows = std::count_if(step.fields.S.begin(), step.fields.S.end(),
                                    [&](double S) { return segment.start <= S && S <= segment.end; });
    EXPECT_GE(rows, 8);
  }
}

TEST(Fields, AFreeRodHasTheRowsAskedFor) {
  const Step step = conduit(-8.0, 5);
  EXPECT_EQ(step.fields.S, (std::vector<double>{0.0, 0.25, 0.5, 0.75, 1.0}));
}

}  // namespace
}  // namespace tendril

// The test that a step along a path has stayed on its branch, and what follows where a stable branch ends.

#include <gtest/gtest.h>

#include "support/problems.hpp"
#include "tendril/continuation/path_follower.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/segmentation/cold_start.hpp"

namespace tendril::test {
namespace {

using continuation::Arrival;
using continuation::Branching;
using continuation::judge_arrival;
using continuation::Result;
using continuation::Status;

TEST(PathStep, SameBranchNearThePredictedStateOnly) {
  EXPECT_EQ(judge_arrival({0.01, 0.999, true}), Branching::same);
  EXPECT_EQ(judge_arrival({0.8, 0.999, true}), Branching::elsewhere);  // Newton went to another solution
  EXPECT_EQ(judge_arrival({0.01, 0.2, true}), Branching::elsewhere);   // a corner the step has cut
}

TEST(PathStep, ATurnedSignIsABranchPointOrALeap) {
  EXPECT_EQ(judge_arrival({0.01, 0.999, false}), Branching::crossed);
  // the step tells too little to decide: it is cut
  EXPECT_EQ(judge_arrival({0.2, 0.999, false}), Branching::elsewhere);
  EXPECT_EQ(judge_arrival({0.01, 0.8, false}), Branching::elsewhere);
}

/// A nearly straight tube: the rod bows with the bend, and snaps to the wall just below Euler's load.
segmentation::Problem bow(double force) {
  segmentation::Problem p;
  p.tube.axis = geometry::make_arc(500.0, 1.0);
  p.tube.clearance = geometry::make_constant(0.04);
  p.rod = {1.0, 0.75, {}};
  p.end.kind = segmentation::End::Kind::sleeve;
  p.end_position = 1.0;
  p.axial_value = Scalar(force, 1.0);
  return p;
}

Result follow(std::vector<double> values, segmentation::BranchRule branch = segmentation::BranchRule::stable) {
  continuation::StudyOptions options;
  options.solve.branch = branch;
  return continuation::follow(bow, {-5.0, std::move(values), true}, options);
}

TEST(PathLimit, TheRodSnapsWhereverTheValuesLie) {
  // the values next to the fold, between fold and contact, and far beyond each misled a follower that only solves
  for (const std::vector<double>& values : std::vector<std::vector<double>>{
           {-60}, {-39, -60}, {-39.0811, -39.0812, -60}, {-39.05, -39.07, -60}, {-45}, {-75}}) {
    const Result r = follow(values);
    ASSERT_EQ(r.status, Status::converged) << r.message;
    ASSERT_EQ(r.events.size(), 2u);
    EXPECT_EQ(r.events[0].kind, "fold");
    EXPECT_EQ(r.events[1].kind, "jump");
    EXPECT_NEAR(r.events[0].parameter, -39.0811571183, 1e-8);  // regression; below Euler's 4π² = 39.478
    EXPECT_EQ(r.events[1].parameter, r.events[0].parameter);
    for (const auto& s : r.steps) {
      EXPECT_EQ(s.stability, "stable") << *s.parameter;
      EXPECT_EQ(s.contacts.size(), *s.parameter < r.events[0].parameter ? 1u : 0u) << *s.parameter;
    }
  }
}

TEST(PathLimit, TheContactIsLostWhereThatOfTheUnstableBranchBegins) {
  // on the way back the rod leaves the wall at the load at which the unstable branch between fold and contact meets it
  const Result back = follow({-60, -5}), unstable = follow({-41}, segmentation::BranchRule::nearest);
  ASSERT_EQ(back.status, Status::converged) << back.message;
  ASSERT_EQ(back.events.size(), 4u);
  EXPECT_EQ(back.events[2].kind, "contact_leaves");
  EXPECT_EQ(back.events[3].kind, "jump");
  EXPECT_EQ(back.events[3].parameter, back.events[2].parameter);
  EXPECT_TRUE(back.steps[1].contacts.empty());
  ASSERT_EQ(unstable.status, Status::converged) << unstable.message;
  ASSERT_EQ(unstable.events.size(), 2u);
  EXPECT_EQ(unstable.events[0].kind, "fold");
  EXPECT_EQ(unstable.events[1].kind, "contact_appears");
  EXPECT_NEAR(back.events[2].parameter / unstable.events[1].parameter, 1, 1e-9);
}

TEST(PathLimit, OutOfTimeIsNoInterruption) {
  const auto mechanics = std::make_shared<segmentation::Mechanics>(bow(-5.0), -5.0);
  const segmentation::ColdStart start = segmentation::cold_start(mechanics, {}, {});
  ASSERT_TRUE(start.converged) << start.reason;
  continuation::FollowOptions options;
  options.max_seconds = 1e-9;
  continuation::PathFollower follower(start.chain, options);
  const continuation::FollowSummary s = follower.to(-60);
  EXPECT_FALSE(s.reached);
  EXPECT_FALSE(s.interrupted);  // that is a person's doing
  EXPECT_EQ(s.kind, "time");
  EXPECT_EQ(follower.chain().parameter(), -5.0);
}

}  // namespace
}  // namespace tendril::test

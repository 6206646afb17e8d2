// A search from nothing gives up when it is told to: by a flag, or by its time, inside a solve too.

#include <gtest/gtest.h>

#include <atomic>

#include "support/problems.hpp"
#include "tendril/continuation/study.hpp"

namespace tendril::test {
namespace {

using continuation::Result;
using continuation::Status;

/// Forty Euler loads and weight in a narrow tube: tens of contacts, seconds of work.
Problem laborious() {
  Problem p;
  p.tube.axis = geometry::make_helix(0.2, 0.9, 1.0);
  p.tube.clearance = geometry::make_constant(0.0005);
  p.rod = {1.0, 0.75, {}};
  p.load.force = {300.0, 200.0, -100.0};
  p.end.kind = End::Kind::sleeve;
  p.end_position = 1.0;
  p.axial_value = -40 * 4 * pi * pi;
  return p;
}

TEST(Stop, AFlagEndsAColdStart) {
  const std::atomic<bool> stop{true};
  continuation::StudyOptions options;
  options.stop = &stop;
  const Result r = continuation::solve(laborious(), options);
  EXPECT_EQ(r.status, Status::not_converged);
  EXPECT_TRUE(r.interrupted);
  EXPECT_NE(r.message.find("interrupted"), std::string::npos) << r.message;
}

TEST(Stop, TimeEndsAColdStart) {
  continuation::StudyOptions options;
  options.solve.max_seconds = 1e-3;
  const Result r = continuation::solve(laborious(), options);
  EXPECT_EQ(r.status, Status::not_converged);
  EXPECT_FALSE(r.interrupted);
  EXPECT_NE(r.message.find("time limit"), std::string::npos) << r.message;
}

}  // namespace
}  // namespace tendril::test

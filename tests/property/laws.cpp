// Laws that no frame, unit or order of reading may break: a random problem and its twins (moved, mirrored, reversed, in
// other units, in a twisted frame) have the same answer, each found from nothing.

#include "support/laws.hpp"

#include <gtest/gtest.h>

namespace tendril::test {
namespace {

using continuation::Status;

// Solved to 1e-9 between nodes; the reported figures are values at mesh points, where the method superconverges.
constexpr double asked = 1e-9;
constexpr double length_tolerance = 1e-9;
constexpr double figure_tolerance = 1e-8;  // places by L, forces by the largest force
constexpr double angle_tolerance = 1e-6;  // the error of a place times the rate of β, up to 2π over 1 % of the length

class Laws : public testing::TestWithParam<int> {};

TEST_P(Laws, TwinsAgree) {
  const RandomProblem given = random_problem(GetParam());
  continuation::StudyOptions options;
  options.solve.tolerance = asked;
  const auto first = continuation::solve(given.problem, options);
  ASSERT_EQ(first.status, Status::converged) << given.words << "\n" << first.message;
  Dice dice(1000003ull * GetParam());
  std::vector<Twin> twins{moved(given.problem, dice), mirrored(given.problem, dice), reversed(given.problem, dice),
                          in_other_units(given.problem, dice)};
  if (given.problem.tube.side == geometry::Side::inside) twins.push_back(in_twisted_frame(given.problem, dice));
  for (const Twin& twin : twins) {
    SCOPED_TRACE(given.words + ", " + twin.law);
    const auto second = continuation::solve(twin.problem, options);
    ASSERT_EQ(second.status, Status::converged) << second.message;
    const LawFault fault = compare(twin, given.problem, first.steps[0], second.steps[0]);
    ASSERT_TRUE(fault.same_contacts) << first.steps[0].contacts.size() << " and " << second.steps[0].contacts.size();
    EXPECT_LT(fault.length, length_tolerance);
    EXPECT_LT(fault.place, figure_tolerance);
    EXPECT_LT(fault.angle, angle_tolerance);
    EXPECT_LT(fault.force, figure_tolerance);
    EXPECT_LT(fault.end_force, figure_tolerance);
    EXPECT_EQ(first.steps[0].stability, second.steps[0].stability);
  }
}

// Seeds whose problem and twins are all found from nothing today; the others are counted in cold_starts_slow.
INSTANTIATE_TEST_SUITE_P(Seeds, Laws,
                         testing::Values(1, 2, 3, 4, 5, 6, 8, 9, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 26,
                                         27, 28, 29, 30, 31, 32, 33, 34, 35, 36, 38, 39, 40, 41, 42, 43, 44, 45));

}  // namespace
}  // namespace tendril::test

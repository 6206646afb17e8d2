// How many everyday problems are solved from nothing: a few hundred random rods inside random tubes. Each must converge
// with its certificate, and the independent integration must agree. (Outside, a rod without an outer wall may have no
// state near the tube at all; those seeds are left to laws.cpp.)

#include <gtest/gtest.h>

#include "support/cosserat.hpp"
#include "support/problems.hpp"
#include "tendril/continuation/study.hpp"

namespace tendril::test {
namespace {

TEST(ColdStarts, InsideProblemsAreSolved) {
  constexpr double derived = 1e-7;  // ten times the 1e-8 asked, for forces and moments
  int tried = 0, stable = 0;
  for (int seed = 1; seed <= 400; ++seed) {
    const RandomProblem given = random_problem(seed);
    if (given.problem.tube.side == geometry::Side::outside) continue;
    SCOPED_TRACE(given.words);
    const auto r = continuation::solve(given.problem, {});
    ++tried;
    EXPECT_EQ(r.status, continuation::Status::converged) << r.message;
    if (r.status != continuation::Status::converged) continue;
    const auto& s = r.steps[0];
    stable += s.stability == "stable";
    EXPECT_LE(s.certificate.balance, 1e-8);
    EXPECT_GE(s.certificate.gap_min, -derived);
    EXPECT_GE(s.certificate.reaction_min, -derived);
    const SolvedRod rod(given.problem, s);
    EXPECT_LT(free_segments_against_integration(rod, given.problem.tube.length()).largest(), derived);
    EXPECT_LT(line_contacts_against_balance(rod).largest(), derived);
  }
  EXPECT_GT(tried, 300);
  EXPECT_EQ(stable, tried) << "the default branch rule asks for stable states";
}

}  // namespace
}  // namespace tendril::test

// The first problems of the campaign (`make campaign` draws a thousand): each is certified, stable and confirmed by the
// judge's own equations, or its end has a reason.

#include <gtest/gtest.h>

#include "support/campaign_judge.hpp"

namespace tendril::test {
namespace {

TEST(Campaign, FirstFortyProblems) {
  using Kind = CampaignOutcome::Kind;
  int counted = 0, solved = 0;
  for (std::uint64_t seed = 1; counted < 40; ++seed) {
    const CampaignOutcome o = run_campaign_problem(seed, CampaignRules::held);
    if (o.kind == Kind::dropped) continue;
    SCOPED_TRACE(o.words);
    ++counted;
    solved += o.kind == Kind::solved;
    EXPECT_NE(o.kind, Kind::wrong) << o.reason;
    if (o.kind != Kind::solved) {
      EXPECT_FALSE(o.reason.empty());
    }
  }
  EXPECT_GE(solved, 39) << "of " << counted << ", one of which needs no stable state";
}

TEST(Campaign, NothingIsWrongWithRodsThatVaryOrAnyEnd) {
  using Kind = CampaignOutcome::Kind;
  constexpr double seconds = 3.0;  // what is not found soon ends with that reason
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const CampaignOutcome o = run_campaign_problem(seed, CampaignRules::all, seconds);
    SCOPED_TRACE(o.words);
    EXPECT_NE(o.kind, Kind::wrong) << o.reason;
    if (o.kind != Kind::solved) {
      EXPECT_FALSE(o.reason.empty());
    }
  }
}

TEST(Campaign, SeedsMeanTheSameProblem) {
  const CampaignProblem a = campaign_problem(7), b = campaign_problem(7);
  EXPECT_EQ(a.words, b.words);
  EXPECT_NE(a.words, campaign_problem(8).words);
  // The rules, on many draws.
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const CampaignProblem c = campaign_problem(seed);
    const auto quality = geometry::check_tube(c.problem.tube);
    const double L = c.problem.tube.length();
    EXPECT_LE(quality.curvature_clearance_max, 0.5) << c.words;
    EXPECT_LE(quality.total_bend, 6 * pi * 1.001) << c.words;
    EXPECT_GE(quality.clearance_min, 0.0015 * L) << c.words;  // a table may swing a little between its nodes
    EXPECT_LE(quality.clearance_max, 0.055 * L) << c.words;
  }
}

}  // namespace
}  // namespace tendril::test

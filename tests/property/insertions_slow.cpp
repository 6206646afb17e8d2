// The first three tubes of `make insertions`, in coarser steps: no step is lost, and the last state is the one found
// from nothing or another certified one.

#include <gtest/gtest.h>

#include "support/insertions.hpp"

namespace tendril::test {
namespace {

TEST(Insertions, FirstThreeTubes) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const InsertionOutcome o = run_insertion(seed, 60);
    SCOPED_TRACE(o.words);
    EXPECT_EQ(o.lost, 0) << o.reason;
    EXPECT_TRUE(o.end == InsertionOutcome::End::equal || o.end == InsertionOutcome::End::other_branch) << o.reason;
  }
}

TEST(Insertions, SeedsMeanTheSameTube) {
  EXPECT_EQ(insertion_draw(5).words, insertion_draw(5).words);
  EXPECT_NE(insertion_draw(5).words, insertion_draw(6).words);
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const InsertionDraw d = insertion_draw(seed);
    EXPECT_LE(geometry::check_tube(d.problem.tube).curvature_clearance_max, 0.5) << d.words;
  }
}

}  // namespace
}  // namespace tendril::test

// The same as load_paths.cpp where a path takes seconds: an S-bend, and the compression side of the conduit through all
// its changes of pattern.

#include <gtest/gtest.h>

#include "support/load_paths.hpp"

namespace tendril::test {
namespace {

TEST(LoadPathsSlow, SBend) { expect_independent(example("s_bend", -60, "end.axial_force"), {}); }
TEST(LoadPathsSlow, HelixOuter20) { expect_independent(example("helix_outer_20", -207), {}); }
TEST(LoadPathsSlow, HelixOuter20Mirrored) { expect_mirrored(example("helix_outer_20", -207)); }

TEST(LoadPathsSlow, BeyondTheFoldThereIsNoStableState) {
  for (const double target : {-210.0, -240.0}) {
    const continuation::Result r = follow(example("helix_outer_20", target), {target});
    EXPECT_EQ(r.status, continuation::Status::not_converged);
    ASSERT_EQ(r.events.size(), 12u);
    EXPECT_EQ(r.events.back().kind, "fold");
    EXPECT_NEAR(r.events.back().parameter / conduit::T0, 29.4315, 1e-4);  // regression
    EXPECT_NE(r.message.find("the load cannot be raised beyond the fold at parameter -208.05240"), std::string::npos)
        << r.message;
  }
}

}  // namespace
}  // namespace tendril::test

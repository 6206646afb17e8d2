// The system `helical_conduit`: its whole table, and what its pictures must show.

#include <algorithm>

#include "support/outcome.hpp"

namespace tendril::test {
namespace {

TEST(Reproduce, HelicalConduit) {
  const reproduce::Outcome outcome = expect_sound(system_named("helical_conduit"));
  // Figs. II.3.2, II.3.3, IV.2.1 to IV.2.4
  EXPECT_EQ(outcome.pictures.size(), 6u);
  const auto response = std::find_if(outcome.data.begin(), outcome.data.end(),
                                     [](const reproduce::Data& d) { return d.name == "response_40"; });
  ASSERT_NE(response, outcome.data.end());
  const auto &load = response->value[0], &length = response->value[1];
  EXPECT_NEAR(load.front(), -35, 1e-9);
  EXPECT_NEAR(load.back(), 35, 1e-9);
  // Compression feeds rod in, all the way.
  EXPECT_TRUE(std::is_sorted(load.begin(), load.end()));
  EXPECT_TRUE(std::is_sorted(length.rbegin(), length.rend()));
}

TEST(Reproduce, NamesAreWordsForTheCommandLine) {
  std::set<std::string> seen;
  for (const reproduce::System& s : reproduce::systems()) {
    EXPECT_TRUE(seen.insert(s.name).second) << s.name;
    EXPECT_EQ(s.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string::npos) << s.name;
    EXPECT_FALSE(s.title.empty() || s.section.empty() || s.summary.empty()) << s.name;
    EXPECT_NE(s.compute, nullptr) << s.name;
    EXPECT_GT(s.cost, 0) << s.name;
  }
}

}  // namespace
}  // namespace tendril::test

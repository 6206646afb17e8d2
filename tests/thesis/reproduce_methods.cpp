// The system `methods`: its table, and that the methods do what they are for.

#include "support/outcome.hpp"

namespace tendril::test {
namespace {

TEST(Reproduce, Methods) {
  const reproduce::Outcome outcome = expect_sound(system_named("methods"));
  // Broyden's update saves Jacobians: one, where sensitivities take one at every step.
  const auto solvers = std::find_if(outcome.data.begin(), outcome.data.end(),
                                    [](const reproduce::Data& d) { return d.name == "solvers"; });
  ASSERT_NE(solvers, outcome.data.end());
  const auto &method = solvers->value[3], &jacobians = solvers->value[7], &factorisations = solvers->value[5];
  for (std::size_t i = 0; i < method.size(); ++i) {
    if (method[i] == 3) {
      EXPECT_LT(jacobians[i], jacobians[i - 1]);
    } else if (method[i] == 2) {
      EXPECT_GT(factorisations[i], factorisations[i - 2]) << "one Newton over the chain is the cheaper way";
    }
  }
}

}  // namespace
}  // namespace tendril::test

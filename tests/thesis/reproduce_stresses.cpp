// The system `stresses`: its table.

#include "support/outcome.hpp"

namespace tendril::test {
namespace {

TEST(Reproduce, Stresses) { expect_sound(system_named("stresses")); }

}  // namespace
}  // namespace tendril::test

// The compression side at clearance 1/20 beyond the lift-off: a cascade of further changes of pattern, and its end.

#include <gtest/gtest.h>

#include "support/problems.hpp"
#include "tendril/continuation/study.hpp"

namespace tendril::test {
namespace {

using continuation::Event;
using continuation::Result;

Result follow(const std::vector<double>& loads) {
  continuation::Path path;
  path.start = conduit::T0;
  for (const double load : loads) path.values.push_back(load * std::abs(conduit::T0));
  return continuation::follow([](double T) { return conduit::problem(1.0 / 20, T); }, path, {});
}

// No independent figure is known for these loads. What is asserted: the order of the changes, that every pair of twins
// changes together (the conduit is symmetric about its middle), and that other listed values give the same loads.
TEST(Compression, TheCascadeDoesNotDependOnTheListedValues) {
  constexpr double tolerance = 1e-7;  // relative; where a line opens p varies as the square of its length
  const Result one = follow({-27, -28}), two = follow({-25, -27.3, -27.55, -28});
  ASSERT_EQ(one.status, continuation::Status::converged) << one.message;
  ASSERT_EQ(two.status, continuation::Status::converged) << two.message;
  const std::vector<std::string> kinds{"contact_appears", "point_to_line",   "line_splits",  "line_splits",
                                       "line_splits",     "contact_appears", "point_to_line"};
  ASSERT_EQ(one.events.size(), kinds.size());
  ASSERT_EQ(two.events.size(), kinds.size());
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    EXPECT_EQ(one.events[i].kind, kinds[i]);
    EXPECT_EQ(two.events[i].kind, kinds[i]);
    EXPECT_NEAR(one.events[i].parameter / two.events[i].parameter, 1, tolerance) << kinds[i];
  }
  EXPECT_NEAR(one.events[3].S + one.events[4].S, 1.0, 1e-6);
  EXPECT_EQ(one.events[3].parameter, one.events[4].parameter);
  EXPECT_EQ(one.steps.back().contacts.size(), 5u);
  for (const auto& s : one.steps) {
    EXPECT_LE(s.certificate.invariant_spread, 1e-8);
    EXPECT_LE(s.certificate.balance, 1e-8);
    EXPECT_GE(s.certificate.gap_min, -1e-7);
    EXPECT_GE(s.certificate.reaction_min, -1e-7);
    EXPECT_EQ(s.stability, "stable");
  }
}

}  // namespace
}  // namespace tendril::test

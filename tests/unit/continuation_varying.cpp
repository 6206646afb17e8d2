// Rods that vary, from the case file: the buckling load of a stepped column, and the law of reversal.

#include <gtest/gtest.h>

#include <cmath>

#include "tendril/io/case.hpp"
#include "tendril/io/diagnostics.hpp"

namespace {

using namespace tendril;

continuation::Step solve(const std::string& text) {
  const io::Case c = io::parse_case(text, "test.toml", io::Format::toml);
  continuation::StudyOptions options;
  options.solve = io::solve_options(c);
  const auto r = io::run(c, options);
  EXPECT_EQ(r.status, continuation::Status::converged) << r.message;
  return r.steps.back();
}

// Pinned at both ends, EI = 1 over a and B beyond: tan(k1 a)/k1 + tan(k2 b)/k2 = 0, k² = P/EI. The straight column is
// stable below that load and not above; the discrete rod of the second variation errs by less than 1e-4 of the load.
TEST(VaryingColumn, SteppedColumnBucklesAtItsEulerLoad) {
  const double a = 0.6, b = 0.4, B = 5.0;
  const auto f = [&](double P) {
    const double k1 = std::sqrt(P), k2 = std::sqrt(P / B);
    return std::sin(k1 * a) * std::cos(k2 * b) / k1 + std::cos(k1 * a) * std::sin(k2 * b) / k2;
  };
  double low = 9.0, high = 49.0;  // between the Euler loads of the two uniform columns
  for (int i = 0; i < 60; ++i) (f(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
  const auto stability = [&](double P) {
    return solve(R"(schema = 1
[rod]
bending_stiffness = 1.0
torsional_stiffness = 0.75
[[rod.section]]
from = 0.6
to = 5.0
bending_stiffness = 5.0
[tube]
clearance = 0.05
[tube.axis]
kind = "straight"
length = 1.0
[start]
kind = "pinned"
[end]
kind = "pinned"
torque = 0.0
axial_force = )" +
                 io::shortest(-P) + "\n[solve]\nbranch = \"symmetric\"\n")
        .stability;
  };
  EXPECT_EQ(stability((1.0 - 1e-4) * low), "stable");
  EXPECT_EQ(stability((1.0 + 1e-4) * low), "unstable");
}

// The problem run from its other end is the same problem: taper, step, weight, a collar, a point load and a contact.
TEST(VaryingRod, MayBeRunFromItsOtherEnd) {
  const auto text = [](bool reversed) {
    const std::string from = reversed ? "end" : "start";
    return R"(schema = 1
[rod]
bending_stiffness = 1.0
torsional_stiffness = 0.75
axial_stiffness = 4000.0
weight_per_length = 3.0
[[rod.section]]
measured_from = ")" +
           from + R"("
from = 0.2
to = 0.5
bending_stiffness = [1.0, 2.0]
[[rod.section]]
measured_from = ")" +
           from + R"("
from = 0.5
to = 0.9
bending_stiffness = 2.0
[[rod.collar]]
measured_from = ")" +
           from + R"("
at = 0.7
height = 0.01
[tube]
clearance = 0.03
[tube.axis]
kind = "arc"
radius = 1.0
length = 1.5
reverse = )" +
           (reversed ? "true" : "false") +
           R"(
[load]
gravity = [0.0, 0.6, 0.8]
[[load.point]]
measured_from = ")" +
           from + R"("
at = 1.1
force = [0.5, 1.0, 0.0]
[start]
kind = "sleeve"
)" + (reversed ? "axial_force = -20.0\ntorque = 0.3\n" : "") +
           "[end]\nkind = \"sleeve\"\n" + (reversed ? "" : "axial_force = -20.0\ntorque = 0.3\n");
  };
  const auto a = solve(text(false)), b = solve(text(true));
  EXPECT_NEAR(b.rod_length, a.rod_length, 1e-9);
  EXPECT_NEAR(b.axial_force_end, a.axial_force_start, 1e-7);
  EXPECT_EQ(a.stability, "stable");
  EXPECT_EQ(b.stability, "stable");
  ASSERT_EQ(b.contacts.size(), a.contacts.size());
  ASSERT_GE(a.contacts.size(), 1u);
  for (std::size_t i = 0; i < a.contacts.size(); ++i) {
    const auto &x = a.contacts[i], &y = b.contacts[a.contacts.size() - 1 - i];
    EXPECT_EQ(x.collar, y.collar);
    EXPECT_EQ(x.line, y.line);
    EXPECT_NEAR(1.5 - y.end, x.start, 1e-8);
    EXPECT_NEAR(x.force, y.force, 1e-7 * std::max(1.0, x.force));
    EXPECT_LT((x.force_vector - y.force_vector).norm(), 1e-6);
  }
}

}  // namespace

// The rod between two parallel walls: every landmark found by the path follower, against the closed forms of the
// elastica. At the transition from point to line the equations are singular, and all along the line its ends are double
// roots; beyond, the flat part buckles. Fixed span (the rod grows, or the push does) and fixed length (the span
// shrinks).

#include <gtest/gtest.h>

#include <string>

#include "support/problems.hpp"
#include "tendril/closed_form/columns.hpp"
#include "tendril/continuation/study.hpp"

namespace tendril::test {
namespace {

using closed_form::PlanarState;
using continuation::Event;
using continuation::Result;
using segmentation::AxialControl;
using segmentation::BranchRule;
using segmentation::TwistControl;

enum class Held { push, span, length };

Problem between_walls(double clearance, Held held, double p) {
  Problem q;
  q.tube.axis = geometry::make_straight(1.0);
  q.tube.clearance = geometry::make_constant(clearance);
  q.rod = {1.0, 0.75, {}};
  q.end.kind = End::Kind::sleeve;
  q.end_position = held == Held::length ? Scalar(p, 1.0) : Scalar(1.0);
  q.axial = held == Held::push ? AxialControl::push : AxialControl::rod_length;
  q.axial_value = held == Held::length ? Scalar(1.0) : Scalar(p, 1.0);
  return q;
}

Result followed(double clearance, Held held, double from, double to, double tolerance = 1e-9) {
  continuation::StudyOptions options;
  options.solve.branch = BranchRule::planar;
  options.solve.tolerance = tolerance;
  return continuation::follow([=](double p) { return between_walls(clearance, held, p); }, {from, {to}, true}, options);
}

const Event* event(const Result& r, const std::string& kind) {
  const Event* found = nullptr;
  for (const Event& e : r.events)
    if (e.kind == kind) {
      EXPECT_EQ(found, nullptr) << "two events of kind " << kind;
      found = &e;
    }
  EXPECT_NE(found, nullptr) << "no event of kind " << kind;
  return found;
}

constexpr double asked = 1e-8;  // ten times the solver's 1e-9

void expect(const Event* e, const PlanarState& s, double parameter, double middle) {
  ASSERT_NE(e, nullptr);
  EXPECT_NEAR(e->parameter / parameter, 1, asked);
  EXPECT_NEAR(e->rod_length / s.rod_length, 1, asked);
  EXPECT_NEAR(-e->axial_force_end / s.thrust, 1, asked);
  EXPECT_NEAR(e->S, middle, 1e-7);  // where the gap is flat; its value is what is located
}

TEST(PlanarElastica, NeedsAPlaneOfSymmetry) {
  Problem twisted = between_walls(0.05, Held::span, 1.01);
  twisted.twist_value = 1.0;  // torque turns the rod out of every plane
  continuation::StudyOptions options;
  options.solve.branch = BranchRule::planar;
  const Result r = continuation::solve(twisted, options);
  EXPECT_EQ(r.status, continuation::Status::outside_validity);
  EXPECT_NE(r.message.find("plane of symmetry"), std::string::npos) << r.message;
}

TEST(PlanarElastica, FixedSpanByTheRodsLength) {
  for (const double h : {0.05, 0.2}) {
    SCOPED_TRACE(h);
    const Result r = followed(h, Held::span, 1 + 1.2 * h * h, 1 + 5.5 * h * h);
    const auto a = closed_form::first_contact_at_span(h, 1, 1), b = closed_form::point_to_line_at_span(h, 1, 1),
               c = closed_form::flat_part_buckles_at_span(h, 1, 1);
    expect(event(r, "contact_appears"), a, a.rod_length, 0.5);
    expect(event(r, "point_to_line"), b, b.rod_length, 0.5);
    expect(event(r, "line_splits"), c, c.rod_length, 0.5);
  }
}

TEST(PlanarElastica, FixedSpanByThePush) {
  const double h = 0.05;
  const Result r = followed(h, Held::push, 60, 360);
  const auto b = closed_form::point_to_line_at_span(h, 1, 1), c = closed_form::flat_part_buckles_at_span(h, 1, 1);
  expect(event(r, "point_to_line"), b, b.thrust, 0.5);
  expect(event(r, "line_splits"), c, c.thrust, 0.5);
}

/// The slope at which a closed form reaches the clearance, by bisection.
template <class F>
PlanarState at_clearance(F&& state, double clearance, double steepest) {
  double low = 1e-9, high = steepest;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (state(middle, 1.0, 1.0).clearance < clearance ? low : high) = middle;
  }
  return state(low, 1.0, 1.0);
}

TEST(PlanarElastica, FixedLengthByTheSpan) {
  for (const double h : {0.02, 0.1}) {
    SCOPED_TRACE(h);
    const auto a = at_clearance(closed_form::first_contact, h, 2.2),
               b = at_clearance(closed_form::point_to_line, h, 1.1),
               c = at_clearance(closed_form::flat_part_buckles, h, 1.1);
    const Result r = followed(h, Held::length, 1 - 1.5 * h * h, 1 - 7 * h * h);
    expect(event(r, "contact_appears"), a, a.span, 0.5 * a.span);
    expect(event(r, "point_to_line"), b, b.span, 0.5 * b.span);
    expect(event(r, "line_splits"), c, c.span, 0.5 * c.span);
  }
}

/// Along the line phase: the flat part, the thrust and the reaction of the arcs of length l, 16 K² cos a B/l² and
/// 32 K² sin a B/l² in all.
TEST(PlanarElastica, TheLineBetweenItsEvents) {
  const double h = 0.05;
  continuation::StudyOptions options;
  options.solve.branch = BranchRule::planar;
  options.solve.tolerance = 1e-9;
  options.fields = true;
  const Result r = continuation::follow([=](double p) { return between_walls(h, Held::push, p); },
                                        {60.0, {200.0, 300.0}, true}, options);
  ASSERT_EQ(r.steps.size(), 2u);
  for (const auto& s : r.steps) {
    ASSERT_EQ(s.contacts.size(), 1u);
    const auto& c = s.contacts[0];
    EXPECT_TRUE(c.line);
    EXPECT_NEAR(c.start + c.end, 1, asked);
    // the arc of chord (d, h) whose inflections lie at its ends: tan a = h/d, and its length from c = 2E/K - 1
    const double d = c.start, tilt = std::atan2(h, d);
    const auto whole = closed_form::point_to_line(tilt, 2.0, 1.0);  // two such arcs of length 1, scaled to this chord
    const double length = d / (0.5 * whole.span);
    EXPECT_NEAR(s.push / (whole.thrust / (length * length)), 1, asked);
    EXPECT_NEAR(c.force / (whole.reaction / (length * length)), 1, asked);
    EXPECT_NEAR(s.rod_length, 2 * length + (c.end - c.start), asked);
    EXPECT_NEAR(c.force_distributed, 0, 1e-8);
    for (const double y : s.fields.delta2) EXPECT_EQ(y, 0) << "planar, exactly";
    EXPECT_EQ(s.stability, "unstable");  // in a round tube
  }
}

TEST(PlanarElastica, APlanarCaseHasTheBranchPointsOfThePlane) {
  // the straight rod between walls: Euler's loads, each a simple root; one branch point each, not one for each plane
  const Result r = followed(0.05, Held::push, 20, 170);
  std::vector<double> loads;
  for (const auto& e : r.events) {
    EXPECT_EQ(e.kind, "branch_point");
    loads.push_back(e.parameter);
  }
  ASSERT_EQ(loads.size(), 3u);
  for (int n = 1; n <= 3; ++n) EXPECT_NEAR(loads[n - 1] / closed_form::euler_load_clamped(n, 1, 1), 1, asked);
}

}  // namespace
}  // namespace tendril::test

// Rods in motion: insertion and withdrawal of a rod with a free tip, the inlet turned, snapshots, snap-through. Against
// states found from nothing, against the way back, and against the fold of the path where a rod must jump.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "support/problems.hpp"
#include "tendril/continuation/insertion.hpp"

namespace tendril::test {
namespace {

using continuation::Insertion;
using continuation::Result;
using continuation::Session;
using continuation::Status;
using continuation::Step;
using segmentation::AxialControl;

Problem bend(double length) {
  Problem p;
  p.tube.axis = geometry::make_arc(0.3, 1.5);
  p.tube.clearance = geometry::make_constant(0.02);
  p.rod = {1.0, 0.75, {}};
  p.end.kind = End::Kind::free;
  p.axial = AxialControl::rod_length;
  p.axial_value = length;
  return p;
}

continuation::StudyOptions options() { return {}; }

void same_state(const Step& a, const Step& b) {
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  for (std::size_t i = 0; i < a.contacts.size(); ++i) {
    EXPECT_EQ(a.contacts[i].line, b.contacts[i].line);
    // places of contacts are as sharp as the root of the tolerance where curvatures are equal on both sides
    EXPECT_NEAR(a.contacts[i].start, b.contacts[i].start, 1e-6);
    EXPECT_NEAR(a.contacts[i].force, b.contacts[i].force, 1e-5 * a.contacts[i].force);
  }
  EXPECT_NEAR(a.push, b.push, 1e-6 * std::abs(a.push));
}

TEST(Insertion, ArrivesWhereAColdStartDoesAndComesBackTheSameWay) {
  Insertion way;
  way.values = {0.5, 0.9, 1.3, 0.9, 0.5};
  way.step = 0.02;
  const Result r = continuation::insert(bend(0.2), way, options());
  ASSERT_EQ(r.status, Status::converged) << r.message;
  ASSERT_EQ(r.steps.size(), 5u);
  for (const Step& s : r.steps) EXPECT_EQ(s.stability, "stable");
  for (int i = 0; i < 3; ++i) {
    SCOPED_TRACE(i);
    same_state(r.steps[i], continuation::solve(bend(way.values[i]), options()).steps.at(0));
  }
  same_state(r.steps[0], r.steps[4]);
  same_state(r.steps[1], r.steps[3]);
  // on the way in a contact appears and becomes a line; on the way back the reverse, at the same lengths
  ASSERT_EQ(r.events.size(), 4u);
  const char* kinds[] = {"contact_appears", "point_to_line", "line_to_point", "contact_leaves"};
  for (int i = 0; i < 4; ++i) EXPECT_EQ(r.events[i].kind, kinds[i]);
  EXPECT_NEAR(r.events[0].parameter, r.events[3].parameter, 1e-3);  // interpolated within steps of 0.02
  EXPECT_NEAR(r.events[1].parameter, r.events[2].parameter, 0.02);
}

/// The same bend for a wire whose last 0.4, counted from the tip, taper to a fiftieth of its stiffness.
Problem tapered_bend(double length) {
  Problem p = bend(length);
  rod::SectionEntry taper;
  taper.from = -0.4;
  taper.to = 0.0;
  taper.rod[0] = p.rod;
  taper.rod[1] = {0.02, 0.015, {}};
  taper.between = rod::SectionEntry::Between::linear;
  p.law = rod::section_law(p.rod, 0.0, {taper}, true);
  return p;
}

// Less rod than taper is in at first: the rest of it follows. The taper stays with the tip, and the way back is the
// same.
TEST(Insertion, OfATaperedWireIsTheColdStartsAndTheWayBack) {
  Insertion way;
  way.values = {0.5, 0.9, 0.5};
  way.step = 0.02;
  const Result r = continuation::insert(tapered_bend(0.3), way, options());
  ASSERT_EQ(r.status, Status::converged) << r.message;
  for (const Step& s : r.steps) EXPECT_EQ(s.stability, "stable");
  for (int i = 0; i < 2; ++i) {
    SCOPED_TRACE(i);
    same_state(r.steps[i], continuation::solve(tapered_bend(way.values[i]), options()).steps.at(0));
  }
  same_state(r.steps[0], r.steps[2]);
  for (const auto& e : r.events) EXPECT_NE(e.kind, "jump");
}

TEST(Session, ComesBackToASnapshot) {
  Session s(bend(0.4), options());
  ASSERT_TRUE(s.ready()) << s.reason();
  const auto there = s.snapshot();
  const Step before = s.state();
  ASSERT_TRUE(s.advance(0.3).reached);
  EXPECT_DOUBLE_EQ(s.fed(), 0.7);
  ASSERT_TRUE(s.restore(there));
  EXPECT_DOUBLE_EQ(s.fed(), 0.4);
  EXPECT_TRUE(s.events().empty());
  same_state(before, s.state());
  ASSERT_TRUE(s.advance(0.3).reached);
  same_state(s.state(), continuation::solve(bend(0.7), options()).steps.at(0));
}

/// A rod of equal bending stiffnesses that was straight turns about its own tangent without resistance.
TEST(Session, TurnsARoundStraightRodWithoutChangingIt) {
  Session s(bend(0.9), options());
  ASSERT_TRUE(s.ready()) << s.reason();
  const Step before = s.state(11);
  ASSERT_TRUE(s.rotate(0.7).reached);
  const Step after = s.state(11);
  same_state(before, after);
  EXPECT_NEAR(after.fields.phi.front() - before.fields.phi.front(), 0.7, 1e-9);
  EXPECT_NEAR(after.fields.phi.back() - before.fields.phi.back(), 0.7, 1e-7);
  EXPECT_NEAR(after.torque_start, 0.0, 1e-9);
  ASSERT_TRUE(s.advance(0.05).reached);
  EXPECT_DOUBLE_EQ(s.rotation(), 0.7);
}

TEST(Session, StopsWhereItIsWhenAsked) {
  Session s(bend(0.4), options());
  ASSERT_TRUE(s.ready()) << s.reason();
  std::atomic<bool> stop{true};
  s.set_stop(&stop);
  const auto motion = s.advance(0.3);
  EXPECT_FALSE(motion.reached);
  EXPECT_EQ(motion.reason, "interrupted");
  EXPECT_DOUBLE_EQ(s.fed(), 0.4);
  EXPECT_EQ(s.state().status, Status::converged);
  stop = false;
  EXPECT_TRUE(s.advance(0.3).reached);
  s.set_stop(nullptr);
  EXPECT_TRUE(s.advance(0.1).reached);
  EXPECT_DOUBLE_EQ(s.fed(), 0.8);
}

// Ninety thousand steps do not fit into a second; what was reached is kept.
TEST(Insertion, EndsAtItsTimeLimit) {
  Insertion way;
  way.to = 1.3;
  way.step = 1e-5;
  auto o = options();
  o.solve.max_seconds = 1.0;
  const Result r = continuation::insert(bend(0.4), way, o);
  EXPECT_EQ(r.status, Status::not_converged);
  EXPECT_NE(r.message.find("time limit of 1 s"), std::string::npos) << r.message;
  if (r.trace.empty()) return;  // not even the start, on a slow machine
  EXPECT_TRUE(r.interrupted);
  EXPECT_LT(r.steps.back().rod_length, 1.3);
  EXPECT_LE(r.steps.back().certificate.error, 1e-8);
}

TEST(Session, SaysWhereTheAxisEnds) {
  Session s(bend(1.3), options());
  ASSERT_TRUE(s.ready()) << s.reason();
  const auto motion = s.advance(0.5);
  EXPECT_FALSE(motion.reached);
  EXPECT_FALSE(motion.reason.empty());
  EXPECT_LE(s.state().segments.back().end, 1.5 + 1e-9);
  EXPECT_EQ(s.state().status, Status::converged);  // of the last state reached
}

/// The far end in a sleeve moves along the tube at a given axial force.
TEST(Session, MovesASleeveAlongTheTube) {
  Problem p;
  p.tube.axis = geometry::make_arc(0.6, 1.2);
  p.tube.clearance = geometry::make_constant(0.02);
  p.rod = {1.0, 0.75, 400.0};
  p.end.kind = End::Kind::sleeve;
  p.end_position = 0.6;
  p.axial_value = 2.0;
  Session s(p, options());
  ASSERT_TRUE(s.ready()) << s.reason();
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(s.advance(0.02).reached);
  p.end_position = 1.0;
  EXPECT_NEAR(s.fed(), 1.0, 1e-12);
  same_state(s.state(), continuation::solve(p, options()).steps.at(0));
}

/// Euler's column with a free end buckles at π²/4, whatever its tip does along the tube.
TEST(Stability, OfAColumnWithAFreeTip) {
  const auto column = [](double load) {
    Problem p;
    p.tube.axis = geometry::make_straight(1.0);
    p.tube.clearance = geometry::make_constant(0.1);
    p.rod = {1.0, 0.75, 2e4};
    p.end.kind = End::Kind::free;
    p.end.tip.force = {0.0, 0.0, -load};
    continuation::StudyOptions o;
    o.solve.branch = segmentation::BranchRule::symmetric;
    return continuation::solve(p, o).steps.at(0);
  };
  const double euler = pi * pi / 4;  // of the compressible rod: 0.9999 of it at this stiffness
  EXPECT_EQ(column(0.999 * euler).stability, "stable");
  EXPECT_EQ(column(1.001 * euler).stability, "unstable");
}

}  // namespace
}  // namespace tendril::test

// Ends that nothing holds across: a free tip with its load, a tip that rests on the wall, a guided end. Against the
// Cosserat equations integrated from the clamped end (support/cosserat.hpp), beams of small slope, and the work done at
// the inlet.

#include <gtest/gtest.h>

#include <cmath>

#include "support/cosserat.hpp"
#include "support/problems.hpp"
#include "tendril/continuation/study.hpp"

namespace tendril::test {
namespace {

using continuation::Result;
using continuation::Status;
using continuation::Step;
using segmentation::AxialControl;

Problem bend(double position) {
  Problem p;
  p.tube.axis = geometry::make_arc(0.8, 1.2);
  p.tube.clearance = geometry::make_constant(0.06);
  p.rod = {1.0, 0.75, 400.0};
  p.end.kind = End::Kind::free;
  p.end_position = Scalar(position, 1.0);
  return p;
}

Step solved(const Problem& p, bool fields = false) {
  continuation::StudyOptions options;
  options.fields = fields;
  options.field_points = 4001;
  const Result r = continuation::solve(p, options);
  EXPECT_EQ(r.status, Status::converged) << r.message;
  return r.steps.at(0);
}

/// The tip as the Cosserat equations find it from the state at the clamp.
Section from_clamp(const Problem& p, const Step& step) {
  const SolvedRod rod(p, step);
  return rod.rod().continued(rod.at(0.0), step.rod_length);
}

TEST(FreeTip, BearsItsDeadLoad) {
  Problem p = bend(0.25);
  p.load.force = {0.3, 0.1, -0.2};
  p.end.tip.force = {0.05, 0.2, -0.3};
  p.end.tip.couple = {0.02, -0.01, 0.05};
  const Step s = solved(p);
  ASSERT_TRUE(s.contacts.empty());
  const Section tip = from_clamp(p, s);
  // the solver's tolerance, and the distance from the clamp that its errors grow over
  EXPECT_LT((tip.F - p.end.tip.force).norm(), 1e-8);
  EXPECT_LT((tip.M - p.end.tip.couple).norm(), 1e-8);
  EXPECT_LT((tip.r - SolvedRod(p, s).at(0.25).r).norm(), 1e-9);
  EXPECT_EQ(s.stability, "unknown");  // a dead couple has no energy
}

TEST(FreeTip, BearsALoadThatFollowsItsDirectors) {
  Problem p = bend(0.25);
  p.end.tip.force = {0.05, 0.2, -0.3};
  p.end.tip.couple = {0.02, -0.01, 0.05};
  p.end.tip.follower = true;
  const Step s = solved(p);
  ASSERT_TRUE(s.contacts.empty());
  const Section tip = from_clamp(p, s);
  EXPECT_LT((tip.d.transpose() * tip.F - p.end.tip.force).norm(), 1e-8);
  EXPECT_LT((tip.d.transpose() * tip.M - p.end.tip.couple).norm(), 1e-8);
  EXPECT_NEAR(s.axial_force_end, -0.3, 1e-9);
}

TEST(FreeTip, LengthAndPlaceGiveTheSameState) {
  for (const double place : {0.3, 0.9}) {
    const Step by_place = solved(bend(place));
    Problem p = bend(place);
    p.axial = AxialControl::rod_length;
    p.axial_value = by_place.rod_length;
    const Step by_length = solved(p);
    EXPECT_NEAR(by_length.segments.back().end, place, 1e-8);
    ASSERT_EQ(by_length.contacts.size(), by_place.contacts.size());
    for (std::size_t i = 0; i < by_place.contacts.size(); ++i)
      EXPECT_NEAR(by_length.contacts[i].force, by_place.contacts[i].force, 1e-6 * by_place.contacts[i].force);
  }
}

/// A clamped rod that leaves the axis of a straight tube at a slope θ meets the wall at ℓ = Q/θ, rests on it with R =
/// 3(θℓ - Q)/ℓ³ and comes to lie along it at ℓ = 3Q/θ, all to second order in θ.
TEST(RestingTip, FollowsTheBeamOfSmallSlope) {
  constexpr double slope = 0.01, Q = 0.001;
  const auto family = [](double position) {
    Problem p;
    p.tube.axis = geometry::make_straight(1.0);
    p.tube.clearance = geometry::make_constant(Q);
    p.rod = {1.0, 0.75, {}};
    p.start.slope[0] = slope;
    p.end.kind = End::Kind::free;
    p.end_position = Scalar(position, 1.0);
    return p;
  };
  continuation::StudyOptions options;
  const Result r = continuation::follow(family, {0.05, {0.2, 0.5}, true}, options);
  ASSERT_EQ(r.status, Status::converged) << r.message;
  ASSERT_EQ(r.events.size(), 3u);
  constexpr double second_order = 3 * slope * slope;
  EXPECT_EQ(r.events[0].kind, "tip_touches");
  EXPECT_NEAR(r.events[0].parameter, Q / slope, second_order);
  EXPECT_EQ(r.events[1].kind, "tip_leaves");
  EXPECT_EQ(r.events[2].kind, "contact_appears");
  EXPECT_NEAR(r.events[1].parameter, 3 * Q / slope, second_order);
  const Step& resting = r.steps[0];
  ASSERT_EQ(resting.contacts.size(), 1u);
  EXPECT_EQ(resting.contacts[0].end, 0.2);
  const double R = 3 * (slope * 0.2 - Q) / (0.2 * 0.2 * 0.2);
  EXPECT_NEAR(resting.contacts[0].force, R, R * 10 * slope * slope);
  // beyond, the rest of the rod lies along the wall and carries nothing
  ASSERT_EQ(r.steps[1].contacts.size(), 1u);
  EXPECT_NEAR(r.steps[1].contacts[0].end, 3 * Q / slope, second_order);
  EXPECT_NEAR(r.steps[1].axial_force_end, 0.0, 1e-9);
}

/// Frictionless walls do no work: what rod fed in stores is the work of the push at the inlet, dE/dℓ = -H. That checks
/// the condition along the wall, which a wrong normal would break.
TEST(RestingTip, StoresTheWorkOfThePushAtTheInlet) {
  const auto energy = [](const Step& s) {
    double E = 0.0;
    const auto& f = s.fields;
    for (std::size_t i = 0; i + 1 < f.s.size(); ++i)
      E += 0.25 * (f.s[i + 1] - f.s[i]) * (f.kappa[i] * f.kappa[i] + f.kappa[i + 1] * f.kappa[i + 1]);
    return E;
  };
  const auto at = [](double place) {
    Problem p = bend(place);
    p.rod.axial_stiffness.reset();
    p.tube.clearance = geometry::make_table({0.0, 0.4, 0.8, 1.2}, {0.06, 0.05, 0.075, 0.06}, 1.2);
    return solved(p, true);
  };
  constexpr double step = 1e-3;
  const Step before = at(0.7 - step), here = at(0.7), after = at(0.7 + step);
  ASSERT_EQ(here.contacts.size(), 1u);
  ASSERT_NEAR(here.contacts[0].end, 0.7, 1e-9);
  const auto& f = here.fields;
  const double H = f.F3[0] + 0.5 * (f.M1[0] * f.M1[0] + f.M2[0] * f.M2[0]);
  const double slope = (energy(after) - energy(before)) / (after.rod_length - before.rod_length);
  EXPECT_GT(-H, 0.1);
  EXPECT_NEAR(slope, -H, 1e-5 * std::abs(H));  // squared step and trapezoids, both near 1e-6
}

/// A guided end carries no shear: at small slope the rod is an arc of constant curvature that ends θℓ/2 off the axis.
TEST(GuidedEnd, TakesThePlaceThatCostsNoForce) {
  constexpr double slope = 0.01;
  Problem p;
  p.tube.axis = geometry::make_straight(1.0);
  p.tube.clearance = geometry::make_constant(0.1);
  p.rod = {1.0, 0.75, {}};
  p.start.slope[0] = slope;
  p.end.kind = End::Kind::guided;
  const Step s = solved(p, true);
  EXPECT_NEAR(s.fields.delta1.back(), slope / 2, slope * slope);
  EXPECT_NEAR(s.fields.kappa.front(), s.fields.kappa.back(), 1e-9);
  EXPECT_NEAR(s.fields.F1.back(), 0.0, 1e-10);
  EXPECT_EQ(s.stability, "stable");
}

/// Against the wall it rests there; the wall's force is the shear that pushes it back.
TEST(GuidedEnd, RestsOnTheWall) {
  constexpr double slope = 0.01, Q = 0.004;  // between θ/3 and θ/2: only the end touches
  Problem p;
  p.tube.axis = geometry::make_straight(1.0);
  p.tube.clearance = geometry::make_constant(Q);
  p.rod = {1.0, 0.75, {}};
  p.start.slope[0] = slope;
  p.end.kind = End::Kind::guided;
  const Step s = solved(p);
  ASSERT_EQ(s.contacts.size(), 1u);
  EXPECT_EQ(s.contacts[0].end, 1.0);
  EXPECT_NEAR(s.contacts[0].force, 12 * (slope / 2 - Q), 12 * slope * slope);
}

/// A heavy rod lies on the wall of a tube that narrows or widens; the guide at the end asks for the axis' direction,
/// the wall for its own: the rod leaves the wall before the guide.
TEST(GuidedEnd, HasTheGuidesDirectionNotTheWalls) {
  struct Draw {
    double narrowing, weight, axial, radius;
  };
  for (const Draw& d : {Draw{0.1, 200.0, 0.0, 0.0}, Draw{-0.3, 1000.0, -50.0, 0.0}, Draw{-0.3, 200.0, 0.0, 0.3}}) {
    Problem p;
    p.tube.axis = d.radius > 0.0 ? geometry::make_arc(d.radius, 1.0) : geometry::make_straight(1.0);
    p.tube.clearance =
        geometry::make_table({0.0, 0.5, 1.0}, {0.01, 0.01 * (1 - 0.5 * d.narrowing), 0.01 * (1 - d.narrowing)}, 1.0);
    p.rod = {1.0, 0.75, {}};
    p.load.force = {d.weight, 0.0, 0.0};
    p.axial_value = d.axial;
    p.end.kind = End::Kind::guided;
    continuation::StudyOptions options;
    options.fields = true;
    options.field_points = 20001;
    const auto r = continuation::solve(p, options);
    ASSERT_EQ(r.status, continuation::Status::converged) << r.message;
    const auto& f = r.steps[0].fields;
    const std::size_t n = f.delta1.size();
    const auto slope = [&](const std::vector<double>& x) {  // one-sided, of second order
      return (3 * x[n - 1] - 4 * x[n - 2] + x[n - 3]) / (f.S[n - 1] - f.S[n - 3]);
    };
    // the wall's is 0.001 or 0.003; samples lie 5e-5 apart
    EXPECT_NEAR(std::hypot(slope(f.delta1), slope(f.delta2)), 0.0, 1e-5);
  }
}

}  // namespace
}  // namespace tendril::test

// A straight rod pushed along a straight round tube, clamped on the axis at one end and in a sleeve at the other: where
// the straight state, the planar states and a line contact in place of a point are all wrong answers. Loads in units of
// 4π²B/L², the Euler load. Inextensible, no weight.

#include <gtest/gtest.h>

#include "support/cosserat.hpp"
#include "support/problems.hpp"
#include "tendril/continuation/study.hpp"

namespace tendril::test {
namespace {

using continuation::Result;
using continuation::Status;
using continuation::Step;
using segmentation::AxialControl;
using segmentation::BranchRule;

const double euler = 4 * pi * pi;

Problem tube(double clearance, AxialControl control, double load) {
  Problem p;
  p.tube.axis = geometry::make_straight(1.0);
  p.tube.clearance = geometry::make_constant(clearance);
  p.rod = {1.0, 0.75, {}};
  p.end.kind = End::Kind::sleeve;
  p.end_position = 1.0;
  p.axial = control;
  p.axial_value = control == AxialControl::push          ? Scalar(euler * load, euler)
                  : control == AxialControl::axial_force ? Scalar(-euler * load, -euler)
                                                         : Scalar(load, 1.0);
  return p;
}

Result pushed(double clearance, std::vector<double> loads, BranchRule branch = BranchRule::stable) {
  continuation::StudyOptions options;
  options.solve.branch = branch;
  options.fields = true;
  const double first = loads.front();
  const auto family = [clearance](double x) { return tube(clearance, AxialControl::push, x); };
  return continuation::follow(family, {first, std::move(loads), true}, options);
}

double turn_between(const continuation::Contact& a, const continuation::Contact& b) {
  return std::remainder(b.angle_start - a.angle_start, 2 * pi);
}

// Ten times the solver's 1e-8: figures of states symmetric about the middle.
constexpr double symmetry_tolerance = 1e-7;

TEST(StraightTube, BelowEulerItStaysStraight) {
  const Result r = continuation::solve(tube(0.025, AxialControl::push, 0.99), {});
  ASSERT_EQ(r.status, Status::converged) << r.message;
  EXPECT_TRUE(r.steps[0].contacts.empty());
  EXPECT_NEAR(r.steps[0].rod_length, 1, 1e-12);
  EXPECT_EQ(r.steps[0].stability, "stable");
}

TEST(StraightTube, SixTimesEulerIsNotReturnedStraight) {
  for (const AxialControl control : {AxialControl::axial_force, AxialControl::push}) {
    const Result r = continuation::solve(tube(0.025, control, 6), {});
    ASSERT_EQ(r.status, Status::converged) << r.message;
    const Step& s = r.steps[0];
    EXPECT_EQ(s.stability, "stable") << s.branch;
    // a helix on the wall with pitch p stores (2πQ/p)²/2 of length; at six Euler loads well over one per cent
    EXPECT_GT(s.rod_length, 1.01);
    EXPECT_GE(s.contacts.size(), 3u);
    EXPECT_LT(s.certificate.balance, 1e-8);
    EXPECT_LT(s.certificate.invariant_spread, 1e-7);
    EXPECT_GE(s.certificate.gap_min, -1e-7);
    // nothing turns the rod about the tube's axis at the free sleeve but its own torque, and that is zero
    EXPECT_NEAR(s.torque_start, 0, 1e-7 * euler);
  }
}

TEST(StraightTube, AskedForSymmetryItIsStraightAndSaysUnstable) {
  continuation::StudyOptions options;
  options.solve.branch = BranchRule::symmetric;
  const Result r = continuation::solve(tube(0.025, AxialControl::push, 6), options);
  ASSERT_EQ(r.status, Status::converged) << r.message;
  EXPECT_NEAR(r.steps[0].rod_length, 1, 1e-12);
  EXPECT_EQ(r.steps[0].stability, "unstable");
}

/// Half a beam-column of length 1/2 under the thrust k², clamped, pushed aside by h with no slope in the middle:
/// w = A (1 - cos kx) + B (kx - sin kx), R = 2 k³ |B|.
double beam_column_reaction(double h, double k) { return 2 * k * k * k * h / std::abs(k / 2 - 2 * std::tan(k / 4)); }

TEST(StraightTube, OnePlanarPointAtOneAndAHalf) {
  constexpr double h = 0.002;
  // the exact state differs from small-slope theory by a few times the squared slope, (πh)² = 4e-5
  constexpr double small_slope = 4e-4;
  const Result r = continuation::solve(tube(h, AxialControl::push, 1.5), {});
  ASSERT_EQ(r.status, Status::converged) << r.message;
  const Step& s = r.steps[0];
  ASSERT_EQ(s.contacts.size(), 1u);
  EXPECT_FALSE(s.contacts[0].line);
  EXPECT_NEAR(s.contacts[0].start, 0.5, symmetry_tolerance);
  EXPECT_NEAR(s.contacts[0].force / beam_column_reaction(h, 2 * pi * std::sqrt(1.5)), 1, small_slope);
  EXPECT_EQ(s.stability, "stable");
  // the push is the thrust behind the sleeve: -H, and here the rod leaves the sleeve with M ≠ 0
  EXPECT_NEAR(s.push / euler, 1.5, 1e-8);
  EXPECT_LT(s.axial_force_end, -1.5 * euler);
}

TEST(StraightTube, ThePlanarPointLosesStabilityOutOfPlane) {
  constexpr double h = 0.001;  // moves the load by about 150 h² = 1.5e-4 from its limit 2.0457485
  const Result r = pushed(h, {1.5, 2.0455, 2.0460}, BranchRule::planar);
  ASSERT_EQ(r.status, Status::converged) << r.message;
  ASSERT_EQ(r.steps.size(), 3u);
  const Step &before = r.steps[r.steps.size() - 2], &after = r.steps.back();
  EXPECT_EQ(before.stability, "stable");
  EXPECT_EQ(after.stability, "unstable");
  for (const Step* s : {&before, &after}) {
    ASSERT_EQ(s->contacts.size(), 1u);
    for (const double y : s->fields.delta2) EXPECT_NEAR(y, 0, 1e-12);
    EXPECT_NEAR(s->contacts[0].force / beam_column_reaction(h, std::sqrt(s->push)), 1, 1e-4);
  }
}

TEST(StraightTube, SpatialStatesBeyond) {
  constexpr double h = 0.005;
  for (const auto& [load, contacts] : {std::pair{2.2, 2u}, {2.5, 2u}, {3.05, 3u}}) {
    SCOPED_TRACE(load);
    const Problem p = tube(h, AxialControl::push, load);
    const Result r = continuation::solve(p, {});
    ASSERT_EQ(r.status, Status::converged) << r.message;
    const Step& s = r.steps[0];
    EXPECT_EQ(s.stability, "stable") << s.branch;
    ASSERT_EQ(s.contacts.size(), contacts);
    for (const auto& c : s.contacts) EXPECT_FALSE(c.line) << "a line contact would pull there";
    // symmetric about the middle, out of the plane
    const auto &a = s.contacts.front(), &b = s.contacts.back();
    EXPECT_NEAR(a.start + b.start, 1, symmetry_tolerance);
    EXPECT_NEAR(a.force / b.force, 1, symmetry_tolerance);
    EXPECT_GT(std::abs(turn_between(a, b)), 0.5);
    if (contacts == 3) {
      EXPECT_NEAR(s.contacts[1].start, 0.5, symmetry_tolerance);
      EXPECT_NEAR(2 * turn_between(a, s.contacts[1]), turn_between(a, b), 1e-6);
    }
    EXPECT_LT(s.certificate.balance, 1e-10);
    EXPECT_LT(free_segments_against_integration(SolvedRod(p, s), 1.0).largest(), 1e-7);
  }
}

/// The second point appears where small-slope theory puts it, 2.9803448, up to c h²: two clearances and extrapolation.
TEST(StraightTube, ThirdPointAppears) {
  double loads[2];
  const double clearances[]{0.001, 0.002};
  for (int i : {0, 1}) {
    const Result r = pushed(clearances[i], {2.5, 3.05});
    ASSERT_EQ(r.status, Status::converged) << r.message;
    std::vector<const continuation::Event*> appears;
    for (const auto& e : r.events)
      if (e.kind == "contact_appears") appears.push_back(&e);
    ASSERT_EQ(appears.size(), 1u);
    EXPECT_NEAR(appears[0]->S, 0.5, 1e-6);
    loads[i] = appears[0]->parameter;
  }
  constexpr double printed = 5e-8 + 1e-6;  // seven decimals; the h⁴ term is about (4.6e-4)² of it
  EXPECT_NEAR(loads[0] + (loads[0] - loads[1]) / 3, 2.9803448, printed);
}

/// Planar one-point state at held length, from a shooting of the half rod with the world-frame rod (support/cosserat):
/// three unknowns (two forces, one moment at the clamp), three conditions in the middle.
TEST(StraightTube, HeldLengthIsTheElastica) {
  constexpr double h = 0.05, length = 1.0063;
  const Result r = continuation::solve(tube(h, AxialControl::rod_length, length), {});
  ASSERT_EQ(r.status, Status::converged) << r.message;
  const Step& s = r.steps[0];
  ASSERT_EQ(s.contacts.size(), 1u);
  EXPECT_EQ(s.stability, "stable");

  const CosseratRod rod({1.0, 0.75, {}}, Vector3d::Zero());
  const auto middle = [&](const Vector3d& x) {
    Section start;
    start.r.setZero();
    start.d.setIdentity();  // d3 along z, d1 along x
    start.F = Vector3d(x[1], 0, x[0]);
    start.M = Vector3d(0, x[2], 0);
    const Section m = rod.continued(start, length / 2);
    return Vector3d(m.r.z() - 0.5, m.r.x() - h, m.d.col(2).x());
  };
  const double k = 2 * pi * std::sqrt(1.6);
  Vector3d x(-k * k, -beam_column_reaction(h, k) / 2, h * k * k / 2);
  Vector3d fault = middle(x);
  for (int i = 0; i < 30 && fault.norm() > 1e-13; ++i) {
    Matrix3d J;
    for (int c = 0; c < 3; ++c) {
      const double step = 1e-5 * std::max(1.0, std::abs(x[c]));
      J.col(c) = (middle(x + step * Vector3d::Unit(c)) - middle(x - step * Vector3d::Unit(c))) / (2 * step);
    }
    Vector3d dx = J.fullPivLu().solve(-fault);
    for (int cut = 0; cut < 20 && middle(x + dx).norm() > fault.norm(); ++cut) dx /= 2;
    x += dx;
    fault = middle(x);
  }
  ASSERT_LT(fault.norm(), 1e-12);
  constexpr double asked = 1e-7;  // ten times the tolerance 1e-8
  EXPECT_NEAR(s.axial_force_start / x[0], 1, asked);
  EXPECT_NEAR(s.contacts[0].force / (2 * std::abs(x[1])), 1, 10 * asked);  // a tenth of the thrust
}

}  // namespace
}  // namespace tendril::test

// The Lagrangian formulation as the Eulerian one's twin: free, point-contact and line-contact states of the helical
// conduit, both clearances, each solver from its own start. World-frame place, directors, force and moment compared at
// the same unstressed arc length.

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "support/cosserat.hpp"
#include "support/problems.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/reproduce/lagrangian_conduit.hpp"

namespace tendril::test {
namespace {

using continuation::LagrangianRod;
using continuation::LagrangianSection;
using reproduce::Touch;

// Both asked 1e-11 between nodes; the bar is 1e-8. Moments are second derivatives of the eccentricity, one order of
// the mesh less accurate than what the Eulerian estimate is about, hence 1e-10 of the largest moment.
constexpr double asked = 1e-11, place_tolerance = 1e-11, load_tolerance = 1e-10;

continuation::Step eulerian(const Problem& p) {
  continuation::StudyOptions o;
  o.solve.tolerance = asked;
  const auto r = continuation::solve(p, o);
  EXPECT_EQ(r.status, continuation::Status::converged) << r.message;
  return r.steps.at(0);
}

Vector3d vec(const numerics::V3<double>& a) { return {a[0], a[1], a[2]}; }

void compare(double clearance, double load, Touch touch) {
  SCOPED_TRACE("clearance " + std::to_string(clearance) + ", T/|T0| " + std::to_string(load));
  const double T = load * std::abs(conduit::T0);
  const Problem p = conduit::problem(clearance, T);
  const auto step = eulerian(p);
  ASSERT_EQ(step.contacts.size(), touch == Touch::none ? 0u : 1u);
  if (touch != Touch::none) {
    ASSERT_EQ(step.contacts[0].line, touch == Touch::line);
  }
  const SolvedRod twin(p, step);
  const auto found = reproduce::lagrangian_conduit(clearance, T, touch, asked);
  ASSERT_TRUE(found.converged) << found.reason;
  const LagrangianRod& rod = *found.rod;
  EXPECT_NEAR(rod.length(), step.rod_length, place_tolerance);
  Difference worst;
  double F = 0, M = 0;
  std::vector<std::pair<Section, LagrangianSection>> pairs;
  for (int i = 0; i <= 200; ++i) {
    const double S = (i + 0.3) / 200.9;  // never on a contact
    const Section a = twin.at(S);
    pairs.emplace_back(a, rod.at(a.s));
    F = std::max(F, a.F.norm());
    M = std::max(M, a.M.norm());
  }
  for (const auto& [a, b] : pairs) {
    Section c;
    c.r = vec(b.r);
    c.d.col(0) = vec(b.d1);
    c.d.col(2) = vec(b.d3);
    c.d.col(1) = c.d.col(2).cross(c.d.col(0));
    c.F = vec(b.F);
    c.M = vec(b.M);
    worst.take(a, c, 1.0, F, M);
    if (b.line) {
      const double pressure = -twin.pressure(twin.segment_at(a.S), a.S);  // compressive > 0; inside, N is into the wall
      EXPECT_NEAR(b.pressure / pressure, 1, 1e-8) << a.S;                 // a third derivative more
    }
  }
  EXPECT_LT(worst.place, place_tolerance);
  EXPECT_LT(worst.directors, load_tolerance);
  EXPECT_LT(worst.force, load_tolerance);
  EXPECT_LT(worst.moment, load_tolerance);
  if (touch == Touch::point) {
    EXPECT_NEAR(std::abs(rod.jump(1)), step.contacts[0].force, load_tolerance * F);
  }
  if (touch == Touch::line) {
    const auto& c = step.contacts[0];
    EXPECT_NEAR(rod.cut(1), c.s_start, 1e-9);
    EXPECT_NEAR(rod.cut(2), c.s_end, 1e-9);
    EXPECT_NEAR(std::abs(rod.jump(1)), *c.force_start, load_tolerance * F);
  }
}

TEST(Lagrangian, FreeStatesOfTheConduit) {
  compare(1.0 / 20, -1.25, Touch::none);
  compare(1.0 / 20, -0.5, Touch::none);
  compare(1.0 / 40, -1.1, Touch::none);
}

TEST(Lagrangian, PointContactsOfTheConduit) {
  compare(1.0 / 20, -2.0, Touch::point);
  compare(1.0 / 20, 1.0, Touch::point);
  compare(1.0 / 40, -1.5, Touch::point);
  compare(1.0 / 40, 0.3, Touch::point);
}

TEST(Lagrangian, LineContactsOfTheConduit) {
  compare(1.0 / 20, -5.0, Touch::line);
  compare(1.0 / 20, -10.0, Touch::line);
  compare(1.0 / 20, 5.0, Touch::line);
  compare(1.0 / 40, -5.0, Touch::line);
  compare(1.0 / 40, 10.0, Touch::line);
}

TEST(Lagrangian, FixedLengthFindsTheEndForce) {
  const auto found = reproduce::lagrangian_conduit(1.0 / 20, -2.0 * std::abs(conduit::T0), Touch::point, asked);
  ASSERT_TRUE(found.converged) << found.reason;
  LagrangianRod rod = *found.rod;
  collocation::BvpOptions o;
  o.tolerance = asked;
  const auto s = rod.solve_length(1.12, o);
  ASSERT_TRUE(s.converged) << s.reason;
  EXPECT_NEAR(rod.length(), 1.12, 1e-12);
  Problem p = conduit::problem(1.0 / 20, 0.0);
  p.axial = segmentation::AxialControl::rod_length;
  p.axial_value = 1.12;
  const auto step = eulerian(p);
  EXPECT_NEAR(rod.axial_value(), step.axial_force_end, 1e-8);  // the force is steep in the length: 7/0.02
}

TEST(Lagrangian, QuaternionStaysOfUnitLength) {
  // nothing asks for it: Gauss collocation conserves quadratic invariants at the mesh points
  const auto found = reproduce::lagrangian_conduit(1.0 / 20, -10.0 * std::abs(conduit::T0), Touch::line, asked);
  ASSERT_TRUE(found.converged) << found.reason;
  LagrangianRod rod = *found.rod;
  for (int j = 0; j < rod.segments(); ++j) {
    const auto& s = rod.bvp().segment(j);
    const int first = j == 1 ? 2 : 3;
    for (int i = 0; i <= s.pieces(); ++i) {
      double square = 0;
      for (int q = 0; q < 4; ++q) square += s.state(i)[first + q] * s.state(i)[first + q];
      EXPECT_NEAR(square, 1.0, 1e-11);  // Newton's tolerance
    }
  }
}

}  // namespace
}  // namespace tendril::test

// Solved states against an independent integration of the world-frame Cosserat rod (support/cosserat.hpp): free
// segments integrated from their start, line contacts balanced under the wall's pressure, point contacts as jumps along
// the surface's normal.

#include "support/cosserat.hpp"

#include <gtest/gtest.h>

#include "support/problems.hpp"
#include "tendril/continuation/study.hpp"

namespace tendril::test {
namespace {

using continuation::Status;
using continuation::Step;

// Asked 1e-10 between nodes. Second derivatives (the moment) are one order of the mesh less accurate than the values
// the estimate is about, and the integration multiplies them by up to exp(sqrt(F3/B) s), about 30 here.
constexpr double asked = 1e-10;
constexpr double integration_tolerance = 1e-8, balance_tolerance = 1e-8;
constexpr double on_wall_tolerance = 1e-13;  // β, not δ, is the unknown there: rounding

void expect_cosserat(const Problem& p, std::size_t points, std::size_t lines) {
  continuation::StudyOptions options;
  options.solve.tolerance = asked;
  const auto r = continuation::solve(p, options);
  ASSERT_EQ(r.status, Status::converged) << r.message;
  const Step& step = r.steps[0];
  std::size_t found_lines = 0;
  for (const auto& c : step.contacts) found_lines += c.line;
  EXPECT_EQ(step.contacts.size() - found_lines, points);
  EXPECT_EQ(found_lines, lines);
  const SolvedRod rod(p, step);
  const Difference d = free_segments_against_integration(rod, p.tube.length());
  EXPECT_LT(d.place, integration_tolerance);
  EXPECT_LT(d.directors, integration_tolerance);
  EXPECT_LT(d.force, integration_tolerance);
  EXPECT_LT(d.moment, integration_tolerance);
  const LineFault line = line_contacts_against_balance(rod);
  EXPECT_LT(line.force, balance_tolerance);
  EXPECT_LT(line.moment, balance_tolerance);
  EXPECT_LT(line.off_wall, on_wall_tolerance);

  // across every junction: place, directors and moment go on; the force jumps by the reported one, along the normal
  const double L = p.tube.length(), beside = 1e-12 * L;
  std::size_t contact = 0;
  for (int j = 0; j + 1 < rod.segments(); ++j) {
    const Section a = rod.at(rod.place(j + 1) - beside), b = rod.at(rod.place(j + 1) + beside);
    SCOPED_TRACE("junction at S = " + std::to_string(rod.place(j + 1)));
    const double F = std::max(a.F.norm(), b.F.norm()), M = std::max(a.M.norm(), b.M.norm());
    EXPECT_LT((a.r - b.r).norm(), integration_tolerance * L);
    EXPECT_LT((a.d - b.d).norm(), integration_tolerance);
    EXPECT_LT((a.M - b.M).norm(), integration_tolerance * M);
    const Vector3d wall = -(b.F - a.F);  // on the rod
    EXPECT_LT((wall - wall.dot(a.normal) * a.normal).norm(), integration_tolerance * F);
    EXPECT_GT(-rod.sign() * wall.dot(a.normal), 0);  // it pushes
    EXPECT_NEAR(a.eccentricity / a.clearance, 1, integration_tolerance);
    while (contact < step.contacts.size() && step.contacts[contact].end < rod.place(j + 1) - beside) ++contact;
    ASSERT_LT(contact, step.contacts.size());
    const auto& c = step.contacts[contact];
    const double reported = !c.line                                         ? c.force
                            : std::abs(c.start - rod.place(j + 1)) < beside ? *c.force_start
                                                                            : *c.force_end;
    EXPECT_NEAR(wall.norm() / reported, 1, 1e-7);  // the difference of two large forces
    if (!c.line) {
      EXPECT_LT((wall - c.force_vector).norm(), 1e-7 * reported);
    }
  }
}

double unit() { return std::abs(conduit::T0); }

TEST(Cosserat, ConduitFree) { expect_cosserat(conduit::problem(1.0 / 20, -1.25 * unit()), 0, 0); }
TEST(Cosserat, ConduitPoint) { expect_cosserat(conduit::problem(1.0 / 20, -2 * unit()), 1, 0); }
TEST(Cosserat, ConduitLineOutside) { expect_cosserat(conduit::problem(1.0 / 20, -10 * unit()), 0, 1); }
TEST(Cosserat, ConduitLineInside) { expect_cosserat(conduit::problem(1.0 / 40, 10 * unit()), 0, 1); }

/// The step sideways by 0.3 of examples/s_bend.toml as points of x = 0.3 (10 t³ - 15 t⁴ + 6 t⁵).
Problem s_bend() {
  std::vector<Vector3d> points;
  for (int i = 0; i <= 16; ++i) {
    const double t = i / 16.0;
    points.emplace_back(0.3 * t * t * t * (10 + t * (-15 + 6 * t)), 0, t);
  }
  Problem p;
  p.tube.axis = geometry::make_points(points).axis;
  p.tube.clearance = geometry::make_constant(0.02);
  p.rod = {1.0, 0.75, {}};
  p.end.kind = End::Kind::sleeve;
  p.end_position = p.tube.length();
  p.axial_value = -5.0;
  p.twist_value = 1.0;
  p.load.force = Vector3d(0, -20, 0);
  return p;
}
TEST(Cosserat, HeavySBend) { expect_cosserat(s_bend(), 0, 1); }

/// A ringed surface: the clearance changes along the axis, so that the wall's normal leans.
TEST(Cosserat, LineOnAConeLikeWall) {
  Problem p = conduit::problem(1.0 / 40, -5 * unit());
  p.tube.clearance = geometry::make_analytic([](double S) {
    const double w = 3, a = 0.004;
    return std::array<double, 5>{0.025 + a * std::sin(w * S), a * w * std::cos(w * S), -a * w * w * std::sin(w * S),
                                 -a * w * w * w * std::cos(w * S), a * w * w * w * w * std::sin(w * S)};
  });
  expect_cosserat(p, 0, 1);
}

/// Once around a bent tube, pressed on it by tension.
TEST(Cosserat, OutsideWinding) {
  Problem p;
  p.tube.axis = geometry::make_arc(1.0, 1.0);
  p.tube.clearance = geometry::make_constant(0.05);
  p.tube.side = geometry::Side::outside;
  p.rod = {1.0, 0.75, {}};
  p.end.kind = End::Kind::sleeve;
  p.end_position = 1.0;
  for (End* e : {&p.start, &p.end}) {
    e->eccentricity[0] = 0.06;
    e->slope[1] = 2 * pi * 0.06;
  }
  p.axial_value = 40.0;
  p.turns = 1;
  expect_cosserat(p, 0, 1);
}

/// Random problems at the default tolerance.
class CosseratRandom : public testing::TestWithParam<int> {};
TEST_P(CosseratRandom, Agrees) {
  const RandomProblem given = random_problem(GetParam());
  const auto r = continuation::solve(given.problem, {});
  ASSERT_EQ(r.status, Status::converged) << given.words << "\n" << r.message;
  const SolvedRod rod(given.problem, r.steps[0]);
  constexpr double default_tolerance = 1e-7;  // ten times the 1e-8 asked, for moments (second derivatives)
  EXPECT_LT(free_segments_against_integration(rod, given.problem.tube.length()).largest(), default_tolerance)
      << given.words;
  EXPECT_LT(line_contacts_against_balance(rod).largest(), default_tolerance) << given.words;
}
INSTANTIATE_TEST_SUITE_P(Seeds, CosseratRandom,
                         testing::Values(1, 2, 3, 4, 5, 7, 9, 10, 11, 12, 15, 16, 22, 23, 28, 30, 31, 33, 36, 38, 41,
                                         45));

}  // namespace
}  // namespace tendril::test

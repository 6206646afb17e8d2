// The system torus: every row of its table, and what the table does not show: twisted, extensible knots, their mirror
// images, the energy twin from a start of its own, and the refusal of meridians.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tendril/geometry/error.hpp"
#include "tendril/reproduce/systems.hpp"
#include "tendril/reproduce/torus_energy.hpp"
#include "tendril/reproduce/torus_gallery.hpp"

namespace tendril::reproduce {
namespace {

using namespace torus;
constexpr double pi = std::numbers::pi;

TEST(ReproduceTorus, EveryRowHolds) {
  const Outcome outcome = torus_system().compute({});
  EXPECT_GE(outcome.rows.size(), 70u);
  for (const Row& row : outcome.rows)
    EXPECT_LE(std::abs(row.computed - row.expected), row.tolerance) << row.quantity << ": " << row.computed;
  for (const Data& data : outcome.data) {
    EXPECT_EQ(data.columns.size(), data.value.size()) << data.name;
    for (const auto& column : data.value) EXPECT_EQ(column.size(), data.value.front().size()) << data.name;
  }
  EXPECT_NE(outcome.notes.front().find("d3·D3 = 0"), std::string::npos) << "why meridians are refused";
}

TEST(ReproduceTorus, StopsWhenAsked) {
  EXPECT_THROW(torus_system().compute([](double done, const std::string&) { return done == 0.0; }), Interrupted);
}

TEST(ReproduceTorus, RefusesCurvesWithoutARevolution) {
  const Family family{{0.2, {}, 0.0}, 1, Family::Vary::turn, 0.0};
  for (const double turn : {0.0, -1.0}) {
    try {
      make_problem(family, turn, 8, villarceau_sampler(family.rod));
      FAIL() << "accepted " << turn << " revolutions";
    } catch (const geometry::GeometryError& e) {
      EXPECT_EQ(e.what_field, "revolutions");
      EXPECT_EQ(e.value, turn);
      EXPECT_NE(std::string(e.what()).find("d3·D3 = 0"), std::string::npos);
    }
  }
}

/// From the Villarceau circle of a rod, F3 = 0, to one winding in `turn` revolutions.
BoundaryValueProblem knot(const Rod& rod, Family& family, double turn) {
  family = {rod, 1, Family::Vary::turn, 0.0};
  BoundaryValueProblem problem = villarceau_circle(rod);
  continuation::BranchOptions options;
  options.direction = turn < 1.0 ? -1 : 1;
  (turn < 1.0 ? options.p_min : options.p_max) = turn;
  options.solve.tolerance = 1e-6;
  const auto branch = continuation::follow(problem, options);
  EXPECT_FALSE(branch.failed) << branch.ended;
  collocation::BvpOptions fine;
  fine.tolerance = accuracy;
  EXPECT_TRUE(problem.solve(collocation::Closure::at(turn), fine).converged);
  return problem;
}

const Rod twisted{0.3, {0.01, 0.3}, 1.3};  // η = 1/10

TEST(ReproduceTorus, TwistedExtensibleKnotsBalanceInSpace) {
  for (const double turn : {0.4, 1.3}) {
    Family family;
    const auto problem = knot(twisted, family, turn);
    const Faults f = faults(family, problem);
    // solved to 1e-11 of states up to 10
    for (const double fault : {f.phase, f.drag, f.M3, f.H, f.axial_moment, f.closure, f.force, f.moment})
      EXPECT_LT(fault, 1e-9) << turn;
    double stretch = 0.0, bend = 0.0;
    for (const Point& p : points(family, problem, 100)) {
      EXPECT_NEAR(p.M3, 1.3, 1e-9);
      stretch = std::max(stretch, std::abs(p.alpha - 1.0));
      bend = std::max(bend, std::abs(p.Fn));
    }
    EXPECT_GT(stretch, 1e-3) << "the test must see the stretch";
    EXPECT_GT(bend, 0.1) << "and the twist";
  }
}

TEST(ReproduceTorus, MirrorImagesOfTwistedKnotsAreKnotsOfOppositeTwist) {
  Family family;
  const auto right = knot(twisted, family, 0.4);
  Family other = family;
  other.windings = -1;
  other.rod.M3 = -twisted.M3;
  // β, ψ and F_g change their sign; started off the state by a little
  auto left = make_problem(other, 0.4, right.pieces(), [&](int, double x, double* u, double* s) {
    right.evaluate(0, x, u, s);
    for (int i = 0; i < 9; ++i) u[i] = -u[i];
    const double w = 2.0 * pi;
    u[0] += 0.02 * std::sin(w * x);
    u[1] += 0.02 * w * std::cos(w * x);
    u[2] -= 0.02 * w * w * std::sin(w * x);
  });
  collocation::BvpOptions fine;
  fine.tolerance = accuracy;
  ASSERT_TRUE(left.solve(collocation::Closure::at(0.4), fine).converged);
  for (const double x : {0.0, 0.2, 0.55, 0.9}) {
    const Point a = point_at(family, right, x), b = point_at(other, left, x);
    EXPECT_NEAR(a.beta, -b.beta, 1e-10);
    EXPECT_NEAR(a.kg, -b.kg, 1e-9);
    EXPECT_NEAR(a.tg, -b.tg, 1e-9);
    EXPECT_NEAR(a.Fg, -b.Fg, 1e-9);
    EXPECT_NEAR(a.Fn, b.Fn, 1e-9);
    EXPECT_NEAR(a.F3, b.F3, 1e-9);
    EXPECT_NEAR(a.rho, b.rho, 1e-8);
  }
}

TEST(ReproduceTorus, EnergyAloneFindsTheKnotFromTheUniformWinding) {
  std::vector<double> uniform;
  for (int i = 0; i < 200; ++i) uniform.push_back(pi * (i + 0.5) / 200);
  for (const double turn : {1.0 / 6, 0.4, 2.0 / 3}) {
    const EnergyTwin twin = energy_twin(0.2, turn, 0.0, uniform, 32);
    ASSERT_TRUE(twin.converged);
    Family family;
    const auto problem = knot({0.2, {}, 0.0}, family, turn);
    EXPECT_NEAR(point_at(family, problem, 0.0).slope, twin.slope, 1e-10) << turn;
    EXPECT_NEAR(point_at(family, problem, 0.0).H, twin.H, 1e-10) << turn;
    EXPECT_LT(twin.rest, 1e-12) << "terms enough";
  }
}

TEST(ReproduceTorus, ForceParameterInvertsTheCubic) {
  for (const double p : {-2.6, -1e-9, 0.0, 0.3, 21.5}) EXPECT_NEAR(force_parameter(p + p * p * p), p, 1e-14 * 25);
}

}  // namespace
}  // namespace tendril::reproduce

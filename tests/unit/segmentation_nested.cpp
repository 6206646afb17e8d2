// SolveElmProb, PropagateSolution and SolveSequence against the one Newton over the chain, on the helical conduit of
// the thesis (radius 1/(π√2), pitch angle π/4, M3 = -1, clamped on the axis) with a point or a line contact.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/geometry/fitted_axes.hpp"
#include "tendril/segmentation/contact_pattern_switcher.hpp"
#include "tendril/segmentation/nested.hpp"
#include "tendril/segmentation/pattern_checks.hpp"

namespace {

using namespace tendril;
using namespace tendril::segmentation;

constexpr double T0 = 7.069032970971682;  // force at which the rod lies on the axis
constexpr double mesh_tolerance = 1e-11, agreement = 1e-10;

Problem conduit(double clearance) {
  Problem p;
  p.tube.axis = geometry::make_helix(1.0 / (std::numbers::pi * std::numbers::sqrt2), std::numbers::pi / 4.0, 1.0);
  p.tube.clearance = geometry::make_constant(clearance);
  p.rod.bending_stiffness = 1.0;
  p.rod.axial_stiffness = 400.0;
  p.rod.torsional_stiffness = 0.75;
  p.end.kind = End::Kind::sleeve;
  p.axial_value = {-T0, 1.0};
  p.twist_value = {-1.0, 0.0};
  p.end_position = {1.0, 0.0};
  return p;
}

NewtonOptions tight() {
  NewtonOptions o;
  o.tolerance = 1e-12;
  return o;
}

SequenceOptions tight_sequence() {
  SequenceOptions o;
  o.newton = tight();
  o.accuracy = mesh_tolerance;
  return o;
}

Closure at(double factor) { return {Closure::Kind::parameter, 0, -factor * T0}; }

void step(Chain& c, double factor, double accuracy = 1e-8) {
  const auto s = c.solve_adaptive(at(factor), tight(), accuracy);
  ASSERT_TRUE(s.converged) << factor << ": " << s.reason;
}

/// Compression side, at T = -load T0: point contact before the transition, line contact after it.
Chain state(double clearance, bool line, double load) {
  Chain c(std::make_shared<Mechanics>(conduit(clearance), -T0), 7);
  c.set_parameter(-T0);
  c.build({{0}, {}}, 8, [](double S, double* u, double* s) {
    std::fill(u, u + 17, 0.0);
    u[15] = -T0;
    s[0] = S;
  });
  const bool wide = clearance > 0.04;
  const double touches = wide ? 1.2905 : 1.1788;  // first contact: model values 1.290510413, 1.178887788
  for (double f : {1.0, 1.1, wide ? 1.2 : 1.15, touches}) step(c, f);
  c = c.recut({{0, 0}, {0.5}});
  step(c, touches + 0.01);
  step(c, 1.5);
  if (line) {
    step(c, 2.0);
    if (wide) step(c, 2.6);
    c = c.recut({{0, 1, 0}, {0.495, 0.505}});
    const auto s = c.solve_adaptive({Closure::Kind::span, 1, 0.01}, tight(), 1e-8);
    EXPECT_TRUE(s.converged) << s.reason;
    step(c, 3.0);
    if (load > 3.5) step(c, 4.0);
  }
  step(c, load);
  return c;
}

double length(const Chain& c) {
  const auto& s = c.segment(c.segments() - 1);
  return s.state(s.pieces())[s.states() - 1];
}

/// Relative agreement of places, reactions and length.
void expect_same(const Chain& a, const Chain& b, double tolerance) {
  ASSERT_EQ(a.segments(), b.segments());
  EXPECT_NEAR(length(a), length(b), tolerance * length(b));
  for (int k = 0; k + 1 < a.segments(); ++k) {
    EXPECT_NEAR(a.S(k + 1), b.S(k + 1), tolerance) << "junction " << k;
    EXPECT_NEAR(reaction(a, k), reaction(b, k), tolerance * std::abs(reaction(b, k))) << "junction " << k;
  }
}

struct Case {
  const char* name;
  double clearance;
  bool line;
  double before, load;
};
std::ostream& operator<<(std::ostream& o, const Case& c) { return o << c.name; }

class Nested : public testing::TestWithParam<Case> {
 protected:
  Chain before() const { return state(GetParam().clearance, GetParam().line, GetParam().before); }
  /// The chain's own answer at the load.
  Chain reference(Chain c) const {
    step(c, GetParam().load, mesh_tolerance);
    return c;
  }
};

TEST_P(Nested, SequenceAgreesWithChain) {
  Chain c = before();
  const Chain whole = reference(c);
  const auto s = solve_sequence(c, -GetParam().load * T0, tight_sequence());
  ASSERT_TRUE(s.converged) << s.reason;
  EXPECT_EQ(c.parameter(), whole.parameter());
  EXPECT_LE(c.error(), 2.0 * mesh_tolerance);  // scales of one segment against those of the chain
  expect_same(c, whole, agreement);
  RecordProperty("outer", s.iterations);
  RecordProperty("propagations", s.propagations);
  RecordProperty("factorisations", s.factorisations);
}

TEST_P(Nested, AdoptedSolutionIsTheChainsOwn) {
  Chain c = before();
  ASSERT_TRUE(solve_sequence(c, -GetParam().load * T0, tight_sequence()).converged);
  std::vector<double> x, y, d;
  c.gather(x);
  const auto s = c.solve(at(GetParam().load), tight());
  ASSERT_TRUE(s.converged) << s.reason;
  EXPECT_LE(s.factorisations, 1);
  c.gather(y);
  c.scales(d);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], y[i], agreement * d[i]) << "unknown " << i;
}

TEST_P(Nested, BroydenAgreesWithSensitivities) {
  Chain a = before(), b = a;
  SequenceOptions o = tight_sequence();
  const auto newton = solve_sequence(a, -GetParam().load * T0, o);
  o.broyden = true;
  const auto broyden = solve_sequence(b, -GetParam().load * T0, o);
  ASSERT_TRUE(newton.converged) << newton.reason;
  ASSERT_TRUE(broyden.converged) << broyden.reason;
  EXPECT_LT(broyden.jacobians, newton.jacobians);
  expect_same(b, a, agreement);
}

TEST_P(Nested, ResidualLineSearchGivesTheSameState) {
  Chain a = before(), b = a, c = a;
  SequenceOptions o = tight_sequence();
  ASSERT_TRUE(solve_sequence(a, -GetParam().load * T0, o).converged);
  o.newton.residual_line_search = true;
  const auto nested = solve_sequence(b, -GetParam().load * T0, o);
  ASSERT_TRUE(nested.converged) << nested.reason;
  expect_same(b, a, agreement);
  const auto whole = c.solve_adaptive(at(GetParam().load), o.newton, mesh_tolerance);
  ASSERT_TRUE(whole.converged) << whole.reason;
  expect_same(c, a, agreement);
}

TEST_P(Nested, ElementaryProblemAloneAgreesWithChain) {
  const Chain start = before(), whole = reference(start);
  ElementaryOptions o;
  o.newton = tight();
  o.accuracy = mesh_tolerance;
  const ScaledProblem& P = whole.mechanics().problem;
  for (int j = 0; j < whole.segments(); ++j) {
    const auto data = boundary_data(P, whole.segment(j), whole.S(j), whole.S(j + 1));
    for (bool search : {false, true}) {
      o.newton.residual_line_search = search;
      const auto e = solve_elm_prob(P, data, start.segment(j), o);  // from the state at another load
      ASSERT_TRUE(e.converged) << e.reason;
      const collocation::Segment &mine = e.segment, &its = whole.segment(j);
      for (int q = 0; q + 1 < mine.states(); ++q) {
        const double size = std::max(1.0, std::abs(its.state(0)[q]));
        EXPECT_NEAR(mine.state(0)[q], its.state(0)[q], agreement * size) << "segment " << j << " left " << q;
        const double size_b = std::max(1.0, std::abs(its.state(its.pieces())[q]));
        EXPECT_NEAR(mine.state(mine.pieces())[q], its.state(its.pieces())[q], agreement * size_b)
            << "segment " << j << " right " << q;
      }
      const double s0 = its.state(0)[its.states() - 1], s1 = its.state(its.pieces())[its.states() - 1];
      EXPECT_NEAR(mine.state(mine.pieces())[mine.states() - 1], s1 - s0, agreement);
    }
  }
}

// Central differences of step h: error h² f'''/6 plus rounding 1e-12/h, and f''' up to some 1e3 here.
constexpr double difference_step = 3e-5, difference_tolerance = 1e-5;

TEST_P(Nested, SensitivitiesOfTheElementaryProblem) {
  const Chain whole = reference(before());
  const ScaledProblem& P = whole.mechanics().problem;
  ElementaryOptions o;
  o.newton = tight();
  o.accuracy = 1e-8;  // the mesh stays as it is while the data move
  for (int j = 0; j < whole.segments(); ++j) {
    const auto data = boundary_data(P, whole.segment(j), whole.S(j), whole.S(j + 1));
    const auto e = solve_elm_prob(P, data, whole.segment(j), o);
    ASSERT_TRUE(e.converged) << e.reason;
    ASSERT_EQ(e.left_rate.cols(), data.count());
    const int ns = e.segment.states();
    for (int i = 0; i < data.count(); ++i) {
      const double h = difference_step * (whole.S(j + 1) - whole.S(j));
      BoundaryData up = data, down = data;
      up.at(i) += h;
      down.at(i) -= h;
      const auto a = solve_elm_prob(P, down, e.segment, o), b = solve_elm_prob(P, up, e.segment, o);
      ASSERT_TRUE(a.converged && b.converged);
      for (bool left : {true, false}) {
        const auto& rate = left ? e.left_rate : e.right_rate;
        const double largest = std::max(1.0, rate.col(i).lpNorm<Eigen::Infinity>());
        for (int q = 0; q < ns; ++q) {
          const double d =
              (b.segment.state(left ? 0 : b.segment.pieces())[q] - a.segment.state(left ? 0 : a.segment.pieces())[q]) /
              (2.0 * h);
          EXPECT_NEAR(rate(q, i), d, difference_tolerance * largest)
              << "segment " << j << " datum " << i << (left ? " left " : " right ") << "state " << q;
        }
      }
    }
  }
}

TEST_P(Nested, JacobianOfTheSequence) {
  const Chain whole = reference(before());
  const ScaledProblem& P = whole.mechanics().problem;
  std::vector<collocation::Segment> guess;
  for (int j = 0; j < whole.segments(); ++j) guess.push_back(whole.segment(j));
  SequenceOptions o = tight_sequence();
  o.accuracy = 1e-8;
  const Eigen::VectorXd y = junction_unknowns(whole);
  const Propagation X = propagate_solution(P, y, guess, o, true);
  ASSERT_TRUE(X.converged) << X.reason;
  // the chain's state satisfies the junctions; forces are some 1e2
  EXPECT_LT(X.residual.lpNorm<Eigen::Infinity>(), 1e-8);
  for (int i = 0; i < y.size(); ++i) {
    Eigen::VectorXd up = y, down = y;
    const double h = 1e-6;  // the jumps curve strongly with the place of a junction
    up[i] += h;
    down[i] -= h;
    const auto a = propagate_solution(P, down, guess, o, false), b = propagate_solution(P, up, guess, o, false);
    ASSERT_TRUE(a.converged && b.converged);
    const Eigen::VectorXd d = (b.residual - a.residual) / (2.0 * h);
    const double largest = X.jacobian.col(i).lpNorm<Eigen::Infinity>();
    EXPECT_GT(largest, 0.1);
    for (int q = 0; q < y.size(); ++q)
      EXPECT_NEAR(X.jacobian(q, i), d[q], difference_tolerance * largest) << "jump " << q << " unknown " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(HelicalConduit, Nested,
                         testing::Values(Case{"point_wide", 0.05, false, 1.7, 2.0},
                                         Case{"point_narrow", 0.025, false, 1.5, 1.8},
                                         Case{"line_wide", 0.05, true, 4.5, 5.0},
                                         Case{"line_narrow", 0.025, true, 4.5, 5.0}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(SolveSequence, FindsTheLineContactOfTheModel) {
  // independent boundary value solution, six or seven digits: S1 = 0.386028, R = 15.01659, length 1.1979060
  Chain c = state(0.05, true, 4.5);
  ASSERT_TRUE(solve_sequence(c, -5.0 * T0, tight_sequence()).converged);
  EXPECT_NEAR(c.S(1), 0.386028, 1e-6);
  EXPECT_NEAR(c.S(2), 1.0 - 0.386028, 1e-6);
  EXPECT_NEAR(reaction(c, 0), 15.01659, 1e-5);
  EXPECT_NEAR(length(c), 1.1979060, 1e-7);
}

TEST(SolveSequence, AgreesWithChainUnderWeightInAVaryingTube) {
  // clearance and eccentric, tilted, rolled ends with Q' ≠ 0 and a body force: every term of the boundary data is alive
  const double mean = 0.05;
  Problem p = conduit(mean);
  p.tube.clearance = geometry::make_analytic([=](double S) {
    const double w = 2.0 * std::numbers::pi, a = 0.1 * mean;
    return std::array{mean + a * std::sin(w * S), a * w * std::cos(w * S), -a * w * w * std::sin(w * S),
                      -a * w * w * w * std::cos(w * S), a * w * w * w * w * std::sin(w * S)};
  });
  p.load.force = {1.0, -2.0, 3.0};
  p.start.eccentricity[0] = 0.004;
  p.start.slope[1] = 0.02;
  p.start.roll = 0.3;
  p.end.eccentricity[1] = -0.006;
  p.end.slope[0] = -0.03;
  for (const bool line : {false, true}) {
    Chain c = state(mean, line, line ? 4.5 : 1.7);
    c.rebind(std::make_shared<Mechanics>(p, -T0));
    Chain whole = c;
    const double load = line ? 5.0 : 2.0;
    step(whole, load, mesh_tolerance);
    const auto s = solve_sequence(c, -load * T0, tight_sequence());
    ASSERT_TRUE(s.converged) << s.reason;
    expect_same(c, whole, agreement);
    EXPECT_GT(std::abs(c.S(1) + c.S(c.segments() - 1) - 1.0), 1e-3) << "the state was meant to be unsymmetric";
  }
}

TEST(SolveSequence, LineContactFromTheEndOfTheRod) {
  // A heavy rod lies on the bottom of a straight tube and is lifted to the axis at its far end. Small deflections: the
  // free length is (72 B h / w)^(1/4) = 0.4356 and the force at the lift-off w/3 of it.
  const double h = 0.05, weight = 100.0;
  Problem p;
  p.tube.axis =
      geometry::make_straight(1.0, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX());
  p.tube.clearance = geometry::make_constant(h);
  p.rod.torsional_stiffness = 0.75;
  p.load.force = {weight, 0.0, 0.0};
  p.start.eccentricity[0] = h;
  p.end.kind = End::Kind::sleeve;
  p.end_position = {1.0, 0.0};
  p.axial_value = {0.0, 1.0};
  const double free = std::pow(72.0 * h / weight, 0.25);
  Chain c(std::make_shared<Mechanics>(p, 0.0), 7);
  c.set_parameter(0.0);
  c.build({{1, 0}, {1.0 - free}}, 8, [&](double S, double* u, double* s) {
    std::fill(u, u + 17, 0.0);
    const double x = std::max(0.0, S - (1.0 - free)), V = weight * free / 3.0;
    u[0] = h - V * x * x * x / 6.0 + weight * x * x * x * x / 24.0;
    u[1] = -V * x * x / 2.0 + weight * x * x * x / 6.0;
    u[2] = -V * x + weight * x * x / 2.0;
    s[0] = S;
  });
  Chain whole = c;
  const auto w = whole.solve_adaptive({Closure::Kind::parameter, 0, 0.0}, tight(), mesh_tolerance);
  ASSERT_TRUE(w.converged) << w.reason;
  const auto s = solve_sequence(c, 0.0, tight_sequence());
  ASSERT_TRUE(s.converged) << s.reason;
  expect_same(c, whole, agreement);
  // slopes up to 0.15: the linear theory is right to a few parts in a hundred
  EXPECT_NEAR(1.0 - c.S(1), free, 0.03 * free);
  EXPECT_NEAR(reaction(c, 0), weight * free / 3.0, 0.03 * weight * free / 3.0);
}

TEST(SolveSequence, AgreesWithChainInASampledTube) {
  // the spline through 40 points of the helix has a knot at each: meshes must follow the knots while junctions move
  Problem p = conduit(0.05);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 40; ++i) points.push_back(p.tube.axis->at(i / 39.0).position);
  p.tube.axis = geometry::make_points(points, 0.0, Eigen::Vector3d(p.tube.axis->at(0.0).frame.col(0))).axis;
  p.end_position = {};
  Chain c = state(0.05, true, 4.9);
  c.rebind(std::make_shared<Mechanics>(p, -T0));
  Chain whole = c;
  step(whole, 5.0, mesh_tolerance);
  const auto s = solve_sequence(c, -5.0 * T0, tight_sequence());
  ASSERT_TRUE(s.converged) << s.reason;
  expect_same(c, whole, agreement);
}

TEST(SolveSequence, RefusesOtherSupportsAndLeavesTheChainAlone) {
  const Chain solved = state(0.05, false, 1.5);
  auto refused = [&](auto&& change, const char* word) {
    Problem p = conduit(0.05);
    change(p);
    Chain c = solved;
    c.rebind(std::make_shared<Mechanics>(p, -T0));
    std::vector<double> before, after;
    c.gather_all(before);
    const auto s = solve_sequence(c, -1.6 * T0, {});
    c.gather_all(after);
    EXPECT_FALSE(s.converged);
    EXPECT_NE(s.reason.find(word), std::string::npos) << s.reason;
    EXPECT_EQ(before, after);
  };
  refused([](Problem& p) { p.start.kind = End::Kind::pinned; }, "clamped");
  refused([](Problem& p) { p.axial = AxialControl::push; }, "axial force");
  refused([](Problem& p) { p.axial_at = Which::start; }, "axial force");
  refused([](Problem& p) { p.twist = TwistControl::twist; }, "torque");
}

TEST(SwitchContactPattern, NestedFindsTheSameLineContact) {
  // a point contact taken past the transition at 2.64 T0: check III turns it into a line
  Chain a = state(0.05, false, 2.6);
  step(a, 3.0);
  Chain b = a;
  SwitcherOptions o;
  o.newton = tight();
  o.accuracy = mesh_tolerance;
  const auto whole = switch_contact_pattern(a, at(3.0), o);
  o.nested = true;
  const auto nested = switch_contact_pattern(b, at(3.0), o);
  ASSERT_TRUE(whole.converged) << whole.reason;
  ASSERT_TRUE(nested.converged) << nested.reason;
  EXPECT_EQ(whole.nested_solves, 0);
  EXPECT_GE(nested.nested_solves, 2);
  EXPECT_EQ(nested.nested_fallbacks, 0);
  EXPECT_EQ(b.pattern().line, (std::vector<char>{0, 1, 0}));
  expect_same(b, a, agreement);
}

TEST(SolveElmProb, NamesDataThatDoNotFit) {
  const Chain c = state(0.05, false, 1.5);
  const ScaledProblem& P = c.mechanics().problem;
  auto data = boundary_data(P, c.segment(0), c.S(0), c.S(1));
  auto short_data = data;
  short_data.left.pop_back();
  EXPECT_NE(solve_elm_prob(P, short_data, c.segment(0), {}).reason.find("boundary data"), std::string::npos);
  data.S_b = data.S_a;
  EXPECT_NE(solve_elm_prob(P, data, c.segment(0), {}).reason.find("length"), std::string::npos);
}

}  // namespace

// Solved chains of the helical conduit: jump conditions at contacts (model section 5), how the gap opens, how a point's
// reaction splits when it becomes a line, first integrals over the whole pattern, the checks on known states, and the
// exactness of the chain's linearisation.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <functional>

#include "segmentation_helical.hpp"
#include "tendril/formulation/convert.hpp"
#include "tendril/segmentation/pattern_checks.hpp"

namespace {

using namespace helical;
using namespace tendril::segmentation;
using Eigen::Vector3d;
using formulation::FreeRod;
using formulation::Section;

constexpr double eta2 = 1.0 / 400;

/// A state of a free segment in the world frame.
struct World {
  Vector3d t, curvature, N;  // d3, d(d3)/ds̄, outward normal of the wall below
  double alpha, J1bar, Fn;
};

World world(const Chain& c, int segment, double S) {
  const auto& P = c.mechanics().problem;
  const Section s = P.section(S);
  double u[17];
  c.segment(segment).evaluate(S, c.S(segment), c.S(segment + 1), u, nullptr);
  const auto k = FreeRod::kinematics<double>(formulation::lift(s, 0.0, 0.0), u[0], u[1], u[2], u[4], u[5], u[6]);
  const double r = std::hypot(u[0], u[4]);
  const auto n = formulation::touch_basis<double>(k, u[0] / r, u[4] / r, s.Q[1]);
  const auto out = [&](const formulation::V3<double>& v) {
    Vector3d w = Vector3d::Zero();
    for (int d = 0; d < 3; ++d) w += v[d] * Vector3d(s.D[d][0], s.D[d][1], s.D[d][2]);
    return w;
  };
  return {
      out(k.t), k.J1bar * out(k.t1),        n.n1 * out(k.k1) + n.n2 * out(k.k2), FreeRod::stretch(P.material, u[15]),
      k.J1bar,  u[11] * n.n1 + u[13] * n.n2};
}

/// One-sided derivative at S along `direction` (±1), fifth order.
template <class F>
auto one_sided(F&& f, double S, int direction, double h = 2e-3) {
  using V = std::decay_t<decltype(f(S))>;
  const double d = direction * h;
  return V((-137.0 * f(S) + 300.0 * f(S + d) - 300.0 * f(S + 2 * d) + 200.0 * f(S + 3 * d) - 75.0 * f(S + 4 * d) +
            12.0 * f(S + 5 * d)) /
           (60.0 * d));
}

void expect_jumps_at_point(const Chain& c) {
  const double S = c.S(1);
  const World left = world(c, 0, S), right = world(c, 1, S);
  const double R = right.Fn - left.Fn, J1 = left.alpha * left.J1bar;
  ASSERT_GT(R, 1.0);
  EXPECT_NEAR(R, reaction(c, 0), 1e-10 * R);  // inside: R̂ = R
  EXPECT_LT((left.t - right.t).norm(), 1e-12);
  EXPECT_LT((left.curvature - right.curvature).norm(), 1e-10);
  const Vector3d g = left.N.cross(left.t);
  const double kn = left.curvature.dot(left.N), kg = left.curvature.dot(g);
  const auto jump = [&](auto&& of) {
    using V = std::decay_t<decltype(of(left))>;
    const V after = one_sided([&](double x) { return of(world(c, 1, x)); }, S, +1);
    const V before = one_sided([&](double x) { return of(world(c, 0, x)); }, S, -1);
    return V(J1 * (after - before));
  };
  const Vector3d curvature = jump([](const World& w) { return w.curvature; });
  const double stretch = jump([](const World& w) { return w.alpha; });
  // N and g turn continuously, so the jumps of κ_n' and κ_g' are those of the vector
  const double accuracy = 1e-5 * R;  // fifth-order one-sided differences, h = 2e-3, lengths of variation 0.1
  EXPECT_NEAR(curvature.dot(left.N), -(1 + eta2 * kn * kn) * R, accuracy);
  EXPECT_NEAR(curvature.dot(g), -kg * kn * eta2 * R, accuracy);
  EXPECT_NEAR(stretch, left.alpha * kn * eta2 * R, accuracy * eta2 * 10);
  EXPECT_GT(std::abs(kn), 1.0);
}

TEST(SegmentationContacts, JumpsAtAPointContact) { expect_jumps_at_point(point_chain(-2.0)); }

/// The same problem with nothing symmetric: tapered, eccentric ends, weight, and every scalar following p.
Problem oblique() {
  Problem P = problem();
  P.tube.clearance = geometry::make_analytic([](double S) {
    const double a = 0.2 * clearance, w = 3.0, s = std::sin(w * S), c = std::cos(w * S);
    return std::array<double, 5>{clearance + a * (s - 1), a * w * c, -a * w * w * s, -a * w * w * w * c,
                                 a * w * w * w * w * s};
  });
  P.axial_value = {-2.0 * std::abs(T0), -4.0};
  P.twist_value = {-1.0, 3.0};
  P.end.eccentricity[0] = {0.0, 0.1};
  P.end.eccentricity[1] = {0.0, -0.15};
  P.start.slope[1] = {0.0, 0.2};
  P.start.roll = {0.0, 0.5};
  P.clearance_scale = {1.0, -0.5};
  P.load.force = {0.0, 0.0, -10.0};
  P.body_force_scale = {0.0, 5.0};
  P.end_position = {1.0, -0.05};
  return P;
}

Chain oblique_chain(Chain c, double p) {
  c.rebind(std::make_shared<Mechanics>(oblique(), 0.0));
  c.set_parameter(0.0);
  for (double q : {0.0, 0.5 * p, p})
    if (!c.solve_adaptive({Closure::Kind::parameter, 0, q}, {}, tolerance).converged)
      throw std::runtime_error("the oblique problem was not solved");
  return c;
}

TEST(SegmentationContacts, JumpsAtAPointContactWithoutSymmetryUnderWeight) {
  const Chain c = oblique_chain(point_chain(-2.0), 0.1);
  const World w = world(c, 0, c.S(1));
  ASSERT_GT(std::abs(w.curvature.dot(w.N.cross(w.t))), 0.02);  // κ_g
  ASSERT_GT(std::abs(c.S(1) - 0.5), 1e-3);
  expect_jumps_at_point(c);
}

/// d(unknowns)/dp from the linearised chain against solved neighbours.
void expect_exact_tangent(Chain c, double p, const std::function<bool(Chain&)>& again) {
  ASSERT_TRUE(again(c));
  std::vector<double> t, low, high, scale;
  ASSERT_TRUE(c.tangent({Closure::Kind::parameter, 0, p}, t));
  c.scales(scale);
  const double h = 2e-4;
  NewtonOptions tight;
  tight.tolerance = 1e-12;
  for (int side = 0; side < 2; ++side) {
    Chain d = c;  // on the same mesh
    ASSERT_TRUE(d.solve({Closure::Kind::parameter, 0, p + (side ? h : -h)}, tight).converged);
    d.gather(side ? high : low);
  }
  c.set_parameter(p);
  ASSERT_EQ(t.size(), low.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < t.size(); ++i) largest = std::max(largest, std::abs(t[i]) / scale[i]);
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double difference = (high[i] - low[i]) / (2 * h);  // second order; solves to 1e-12/h
    EXPECT_NEAR(difference / scale[i], t[i] / scale[i], 1e-5 * std::abs(t[i]) / scale[i] + 1e-6 * largest) << i;
  }
}

TEST(SegmentationContacts, LinearisationIsExact) {
  const auto again = [](double p) {
    return [p](Chain& c) { return c.solve({Closure::Kind::parameter, 0, p}, {}).converged; };
  };
  expect_exact_tangent(oblique_chain(point_chain(-2.0), 0.1), 0.1, again(0.1));
  Problem P = oblique();
  Chain line = line_chain(-5.0);
  P.axial_value = {-5.0 * std::abs(T0), -4.0};
  line.rebind(std::make_shared<Mechanics>(P, 0.0));
  line.set_parameter(0.0);
  for (double p : {0.0, 0.02, 0.04})
    ASSERT_TRUE(line.solve_adaptive({Closure::Kind::parameter, 0, p}, {}, tolerance).converged) << p;
  expect_exact_tangent(line, 0.04, again(0.04));
}

TEST(SegmentationContacts, GapOpensQuadraticallyNextToAPoint) {
  const Chain c = point_chain(-2.0);
  const World w = world(c, 0, c.S(1));
  const double excess = curvature_excess(c, 0);
  ASSERT_LT(excess, -1e-2);
  // h'' = (κ_n of the surface - κ·N)/J̄1² = -⟨κ⟩/(Q J̄1²)
  const double coefficient = -excess / (2 * clearance * clearance * w.J1bar * w.J1bar);
  for (int side : {-1, +1}) {
    const auto gap = [&](double d) { return relative_gap(c, side < 0 ? 0 : 1, c.S(1) + side * d); };
    EXPECT_NEAR(std::log2(gap(2e-3) / gap(1e-3)), 2.0, 0.05) << side;  // the next power: R d/6 of the curvature jump
    // Richardson removes the cubic term
    EXPECT_NEAR((2 * gap(5e-4) / 25e-8 - gap(1e-3) / 1e-6) / coefficient, 1.0, 1e-3) << side;
  }
}

TEST(SegmentationContacts, GapOpensCubicallyNextToALine) {
  const Chain c = line_chain(-5.0);
  for (int junction : {0, 1}) {
    const int segment = 2 * junction, side = junction == 0 ? -1 : +1;
    const double S = c.S(junction + 1), R = reaction(c, junction);
    const World w = world(c, segment, S);
    const double kn = w.curvature.dot(w.N), J1 = w.alpha * w.J1bar;
    const auto gap = [&](double d) { return relative_gap(c, segment, S + side * d); };
    EXPECT_NEAR(std::log2(gap(8e-3) / gap(4e-3)), 3.0, 0.05) << junction;
    // (1 + η² κ_n²) R̂ |s - s_c|³/6 per unit reference length, h'' = (κ_n of the surface - κ·N)/J̄1²
    const double coefficient = (1 + eta2 * kn * kn) * R / (6 * clearance * J1 * w.J1bar * w.J1bar);
    EXPECT_NEAR((2 * gap(4e-3) / 64e-9 - gap(8e-3) / 512e-9) / coefficient, 1.0, 2e-3) << junction;
  }
}

TEST(SegmentationContacts, TransitionsOfTheHelicalConduit) {
  // model section 7, outer side, clearance 1/20; own boundary value solutions to all digits given
  const Chain touching = free_chain(-1.290510413);
  EXPECT_NEAR(relative_gap(touching, 0, 0.5), 0.0, 1e-8);
  const Chain flat = point_chain(-2.640046467);
  EXPECT_NEAR(curvature_excess(flat, 0), 0.0, 1e-8);
  EXPECT_NEAR(reaction(flat, 0), 13.16761489, 1e-7);
  const Chain line = line_chain(-5.0);
  EXPECT_NEAR(line.S(1), 0.386028, 1e-6);
  EXPECT_NEAR(line.S(2), 1 - 0.386028, 1e-6);
  EXPECT_NEAR(reaction(line, 0), 15.01659, 1e-5);
  EXPECT_NEAR(reaction(line, 1), 15.01659, 1e-5);
  EXPECT_NEAR(pressure(line, 1, 0.5), 35.5468, 1e-4);
}

TEST(SegmentationContacts, ReactionOfAPointSplitsEvenlyIntoTheEndsOfALine) {
  double ends[2], p[2];
  for (int i = 0; i < 2; ++i) {
    const Chain c = line_chain_of_span(i ? 0.005 : 0.01);
    EXPECT_NEAR(reaction(c, 0), reaction(c, 1), 1e-6);
    ends[i] = reaction(c, 0);
    p[i] = c.parameter() / std::abs(T0);
  }
  // to a line of no length, linearly: second-order rest (span 0.01)² of relative size 1
  EXPECT_NEAR(2 * ends[1] - ends[0], 13.16761489 / 2, 5e-3);
  EXPECT_NEAR(2 * p[1] - p[0], -2.640046467, 2e-3);
}

TEST(SegmentationContacts, FirstIntegralsAreOneNumberOverTheWholePattern) {
  for (const Chain& c : {free_chain(-1.2), point_chain(-2.0), line_chain(-5.0)}) {
    const auto& P = c.mechanics().problem;
    double low = HUGE_VAL, high = -HUGE_VAL, twist_low = HUGE_VAL, twist_high = -HUGE_VAL;
    for (int i = 0; i <= 97; ++i) {
      const double S = i / 97.0;
      double u[17], s;
      c.sample(S, u, &s);
      const auto k =
          FreeRod::kinematics<double>(formulation::lift(P.section(S), 0.0, 0.0), u[0], u[1], u[2], u[4], u[5], u[6]);
      const double alpha = 1 + eta2 * u[15];
      const double H =
          0.5 * alpha * alpha * k.J1bar * k.J1bar * numerics::dot(k.t1, k.t1) + u[15] + 0.5 * eta2 * u[15] * u[15];
      const double M3 = FreeRod::twisting_moment<double>(P.material, k, u[15], u[9]);
      low = std::min(low, H), high = std::max(high, H);
      twist_low = std::min(twist_low, M3), twist_high = std::max(twist_high, M3);
    }
    EXPECT_LT((high - low) / std::abs(low), 1e-7) << c.segments();  // solved to 1e-9 of each component's scale
    EXPECT_NEAR(twist_low, -1.0, 1e-8);
    EXPECT_NEAR(twist_high, -1.0, 1e-8);
  }
}

std::vector<Margin> of_kind(const Chain& c, CheckKind kind) {
  std::vector<Margin> out;
  for (const Margin& m : margins(c))
    if (m.kind == kind) out.push_back(m);
  return out;
}

TEST(SegmentationContacts, MarginsOfAFreeRodAreItsSmallestGaps) {
  for (const auto& [f, admissible] : {std::pair{-1.2, true}, std::pair{-1.35, false}}) {
    const Chain c = free_chain(f);
    for (const Margin& m : margins(c)) EXPECT_EQ(m.kind, CheckKind::gap);
    const auto gaps = of_kind(c, CheckKind::gap);
    const auto worst = std::min_element(gaps.begin(), gaps.end(), [](auto& a, auto& b) { return a.value < b.value; });
    ASSERT_NE(worst, gaps.end());
    EXPECT_NEAR(worst->S, 0.5, 1e-6);
    EXPECT_EQ(worst->value > 0, admissible);
    for (int i = 0; i <= 400; ++i) EXPECT_GE(relative_gap(c, 0, i / 400.0), worst->value - 1e-12);
  }
}

TEST(SegmentationContacts, MarginsOfAPointContactChangeSignAtItsTransitions) {
  const auto check = [](double f, bool pushes, bool flat_enough) {
    const Chain c = point_chain(f);
    const auto spans = of_kind(c, CheckKind::span), R = of_kind(c, CheckKind::reaction),
               k = of_kind(c, CheckKind::curvature);
    ASSERT_EQ(spans.size(), 2u);
    ASSERT_EQ(R.size(), 1u);
    ASSERT_EQ(k.size(), 1u);
    EXPECT_NEAR(spans[0].value, 0.5, 1e-8);
    EXPECT_NEAR(R[0].S, 0.5, 1e-8);
    EXPECT_EQ(R[0].value > 0, pushes) << f;
    EXPECT_EQ(k[0].value > 0, flat_enough) << f;
    EXPECT_TRUE(of_kind(c, CheckKind::pressure).empty());
  };
  check(-1.28, false, true);  // before the first contact at -1.2905 the wall would have to pull
  check(-1.30, true, true);
  check(-2.63, true, true);
  check(-2.65, true, false);  // past -2.6400 the rod would bulge through the wall on both sides
}

TEST(SegmentationContacts, MarginsOfALineContactChangeSignWhereItsMiddleLifts) {
  for (const auto& [f, loaded] : {std::pair{-24.3, true}, std::pair{-24.4, false}}) {  // lift-off at -24.3653829
    const Chain c = line_chain(f);
    const auto R = of_kind(c, CheckKind::reaction), p = of_kind(c, CheckKind::pressure);
    EXPECT_EQ(of_kind(c, CheckKind::span).size(), 3u);
    EXPECT_TRUE(of_kind(c, CheckKind::curvature).empty());
    ASSERT_EQ(R.size(), 2u);
    EXPECT_GT(R[0].value, 0.0);
    const auto worst = std::min_element(p.begin(), p.end(), [](auto& a, auto& b) { return a.value < b.value; });
    ASSERT_NE(worst, p.end());
    EXPECT_NEAR(worst->S, 0.5, 1e-4);
    EXPECT_EQ(worst->value > 0, loaded) << worst->raw;
  }
}

TEST(SegmentationContacts, SpaceHasTheThesisDimensions) {
  for (int k : {4, 7}) {
    const Chain c = line_chain(-3.0, k);
    for (int j = 0; j < 3; ++j) {
      const auto& s = c.segment(j).part(0);                                             // a uniform rod has one
      const std::size_t N = s.pieces(), dimension = s.local().size() + s.states() - 1;  // the arc length is one more
      EXPECT_EQ(dimension, c.is_line(j) ? 4 * k * N + 7 : 6 * k * N + 11);
    }
  }
}

TEST(SegmentationContacts, StoredStatesComeBackAndRecutsKeepTheState) {
  const Chain c = line_chain(-3.0);
  std::vector<double> text;
  c.store(text);
  Chain d;
  ASSERT_TRUE(d.restore(text, std::make_shared<Mechanics>(problem(), T0)));
  EXPECT_EQ(d.pattern(), c.pattern());
  EXPECT_EQ(d.parameter(), c.parameter());
  // a recut is a starting iterate on the same state: one or two steps away
  Chain e = c.recut(c.pattern());
  const auto found = e.solve_adaptive({Closure::Kind::parameter, 0, c.parameter()}, {}, tolerance);
  ASSERT_TRUE(found.converged);
  EXPECT_LE(found.factorisations, 4);
  double u[17], v[17], w[17], s, t, r;
  for (int i = 0; i <= 40; ++i) {
    c.sample(i / 40.0, u, &s);
    d.sample(i / 40.0, v, &t);
    e.sample(i / 40.0, w, &r);
    for (int q : {0, 1, 2, 4, 5, 6, 8, 9, 11, 13, 15}) {
      EXPECT_NEAR(u[q], v[q], 1e-13 * (1 + std::abs(u[q])));
      EXPECT_NEAR(u[q], w[q], 1e-6 * (1 + std::abs(u[q])));  // another mesh
    }
    EXPECT_NEAR(s, t, 1e-14);
  }
  text.resize(text.size() / 2);
  EXPECT_FALSE(d.restore(text, std::make_shared<Mechanics>(problem(), T0)));
}

}  // namespace

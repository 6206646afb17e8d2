// The scaled problem and the two formulations as collocation systems: units, the parameter, and the exact Jacobians
// (inputs, S and p) against differences on a tube where everything varies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tendril/formulation/near_wall.hpp"
#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/axis_transforms.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/segmentation/scaled_problem.hpp"

namespace {

using namespace tendril;
using segmentation::Mechanics;
using segmentation::Problem;

Problem general(double L = 1.0, double B = 1.0) {
  Problem P;
  const auto gamma = [L](double S) {
    const double x = S / L;
    return std::array<double, 5>{std::sin(x), std::cos(x) / L, -std::sin(x) / (L * L), -std::cos(x) / (L * L * L),
                                 std::sin(x) / std::pow(L, 4)};
  };
  P.tube.axis = geometry::with_frame_twist(geometry::make_helix(0.4 * L, 0.7, L), gamma);
  P.tube.clearance = geometry::make_analytic([L](double S) {
    const double w = 2.0 / L, a = 0.08 * L, b = 0.03 * L, s = std::sin(w * S), c = std::cos(w * S);
    return std::array<double, 5>{a + b * s, b * w * c, -b * w * w * s, -b * w * w * w * c, b * w * w * w * w * s};
  });
  P.clearance_scale = {1.0, 0.7};
  P.rod.bending_stiffness = B;
  P.rod.torsional_stiffness = 0.75 * B;
  P.rod.axial_stiffness = 100 * B / (L * L);
  P.load.force = Eigen::Vector3d(3, -2, 5) * B / (L * L * L);
  P.load.couple = Eigen::Vector3d(-1, 0.5, 2) * B / (L * L);
  P.body_force_scale = {1.0, 0.4};
  P.body_couple_scale = {1.0, -0.6};
  return P;
}

const std::vector<double> free_state = {0.04, 0.3, -1.0, 5.0,  -0.05, 0.2, 2.0,  -7.0, 0.3,
                                        1.5,  -4., 3.0,  10.0, -2.0,  8.0, -6.0, 12.0};
const std::vector<double> line_state = {0.7, 1.2, -3.0, 9.0, 0.2, 1.7, -2.0, 4.0, -5.0, -6.0, 11.0};

void expect_exact_jacobian(const collocation::System& system, Mechanics& mechanics, const std::vector<double>& u) {
  const double S = 0.43;
  const int n = system.equations(), width = system.inputs + 2;
  std::vector<double> r(n), value(n), jac(n * width), low(n), high(n), low2(n), high2(n);
  system.jacobian(S, u.data(), value.data(), jac.data());
  system.residual(S, u.data(), r.data());
  for (int e = 0; e < n; ++e) EXPECT_NEAR(value[e], r[e], 1e-12 * (1 + std::abs(r[e])));
  for (int q = 0; q < width; ++q) {
    const double h = 1e-3;
    const auto at = [&](double d, std::vector<double>& out) {
      auto v = u;
      if (q < system.inputs) v[q] += d;
      mechanics.problem.p = q == width - 1 ? d : 0.0;
      system.residual(q == width - 2 ? S + d : S, v.data(), out.data());
      mechanics.problem.p = 0.0;
    };
    at(h, high);
    at(-h, low);
    at(2 * h, high2);
    at(-2 * h, low2);
    for (int e = 0; e < n; ++e) {
      const double slope = (8 * (high[e] - low[e]) - (high2[e] - low2[e])) / (12 * h);
      // fourth order: h^4/30 times a fifth derivative up to 1e5; rounding eps 1e3/h
      EXPECT_NEAR(jac[e * width + q], slope, 2e-7 * (1 + std::abs(slope))) << "equation " << e << " column " << q;
    }
  }
}

TEST(SegmentationSystems, ExactJacobianOfTheContactFreeEquations) {
  Mechanics m(general());
  EXPECT_EQ(m.free.order, (std::vector<int>{3, 3, 2, 1, 1, 1}));
  EXPECT_EQ(m.free.inputs, 17);
  expect_exact_jacobian(m.free, m, free_state);
}

TEST(SegmentationSystems, ExactJacobianOfTheLineContactEquations) {
  Mechanics m(general());
  EXPECT_EQ(m.line.order, (std::vector<int>{3, 2, 1, 1}));
  EXPECT_EQ(m.line.inputs, 11);
  expect_exact_jacobian(m.line, m, line_state);
}

TEST(SegmentationSystems, WallCoordinatesAreTheContactFreeStateInOtherWords) {
  Mechanics m(general());
  EXPECT_EQ(m.near_wall.order, m.free.order);
  const double S = 0.43;
  std::vector<double> u = free_state, v;
  const auto section = m.problem.section(S);
  formulation::free_to_wall(section, 7.0, u.data());
  EXPECT_NEAR(u[0], std::atan2(free_state[4], free_state[0]) + 2 * M_PI, 1e-14) << "the turn nearest the one asked for";
  EXPECT_NEAR(u[4], std::hypot(free_state[0], free_state[4]) - section.Q[0], 1e-16);
  v = u;
  m.near_wall.present(S, v.data());
  for (int j = 0; j < m.free.inputs; ++j)  // δ''' is made of terms up to 1e3
    EXPECT_NEAR(v[j], free_state[j], 1e-12 * (1 + std::abs(free_state[j]))) << j;
  std::vector<double> a(m.free.equations()), b(a);
  m.near_wall.residual(S, u.data(), a.data());
  m.free.residual(S, v.data(), b.data());
  EXPECT_EQ(a, b);
  expect_exact_jacobian(m.near_wall, m,
                        {0.7, 1.2, -3.0, 9.0, -0.01, 0.05, 0.3, -2.0, 0.3, 1.5, -4., 3.0, 10.0, -2.0, 8.0, -6.0, 12.0});
}

/// Several places side by side give what each gives alone; one of them outside the validity harms no other.
void expect_places_side_by_side(const collocation::System& system, Mechanics& mechanics, const std::vector<double>& u,
                                int force) {
  using numerics::Pack;
  const int n = system.equations(), width = system.inputs + 2, count = 5, bad = 2;
  const double S[Pack::lanes] = {0.1, 0.23, 0.4, 0.77, 0.9};
  const int components = system.components();
  std::vector<Pack> x(system.inputs), r(n), value(n), jac(n * width), defect(n), top(components * components);
  std::vector<std::vector<double>> state(count, u);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < system.inputs; ++j) state[i][j] *= 1.0 + 0.03 * i;
  state[bad][force] = -101.0;  // α < 0
  for (int j = 0; j < system.inputs; ++j)
    for (int i = 0; i < Pack::lanes; ++i) x[j].set(i, state[std::min(i, count - 1)][j]);
  for (const double p : {0.0, 0.3, 0.0}) {  // the sections remembered must follow the parameter
    mechanics.problem.p = p;
    system.residuals(S, count, x.data(), r.data());
    system.jacobians(S, count, x.data(), value.data(), jac.data());
    system.highest(S, count, x.data(), defect.data(), top.data());
    std::vector<double> one(n), slopes(n * width);
    for (int i = 0; i < count; ++i) {
      if (i == bad) {
        EXPECT_TRUE(std::isnan(r[0][i]) && std::isnan(value[0][i]));
        continue;
      }
      system.jacobian(S[i], state[i].data(), one.data(), slopes.data());
      const double rounding = 1e-12;  // the same operations, fused or not
      for (int e = 0; e < n; ++e) {
        EXPECT_NEAR(r[e][i], one[e], rounding * (1e2 + std::abs(one[e])));
        EXPECT_NEAR(value[e][i], one[e], rounding * (1e2 + std::abs(one[e])));
      }
      for (int e = 0; e < components; ++e) {
        EXPECT_NEAR(defect[e][i], one[e], rounding * (1e2 + std::abs(one[e])));
        for (int c = 0; c < components; ++c) {
          const double slope = slopes[e * width + system.first[c] + system.order[c]];
          EXPECT_NEAR(top[e * components + c][i], slope, rounding * (1e2 + std::abs(slope))) << e << ' ' << c;
        }
      }
      for (int q = 0; q < n * width; ++q)
        EXPECT_NEAR(jac[q][i], slopes[q], rounding * (1e2 + std::abs(slopes[q]))) << "lane " << i << " entry " << q;
    }
  }
}

TEST(SegmentationSystems, PlacesSideBySideAreThePlacesAlone) {
  Mechanics m(general());
  expect_places_side_by_side(m.free, m, free_state, 15);
  expect_places_side_by_side(m.line, m, line_state, 9);
}

TEST(SegmentationSystems, UnitsDropOutOfTheScaledEquations) {
  Mechanics a(general()), b(general(7.0, 40.0));
  EXPECT_NEAR(b.problem.force_unit(), 40.0 / 49, 1e-14);
  EXPECT_NEAR(b.problem.moment_unit(), 40.0 / 7, 1e-14);
  std::vector<double> r(7), s(7);
  a.free.residual(0.3, free_state.data(), r.data());
  b.free.residual(0.3, free_state.data(), s.data());
  for (int e = 0; e < 7; ++e) EXPECT_NEAR(r[e], s[e], 1e-11 * (1 + std::abs(r[e])));
  a.line.residual(0.3, line_state.data(), r.data());
  b.line.residual(0.3, line_state.data(), s.data());
  for (int e = 0; e < 5; ++e) EXPECT_NEAR(r[e], s[e], 1e-11 * (1 + std::abs(r[e])));
}

TEST(SegmentationSystems, SectionFollowsTheParameter) {
  Mechanics m(general(), 2.0);  // the scalars hold at p = 2
  m.problem.p = 2.0;
  const auto before = m.problem.section(0.4);
  m.problem.p = 2.5;
  const auto after = m.problem.section(0.4);
  for (int j = 0; j < 4; ++j) EXPECT_NEAR(after.Q[j], before.Q[j] + 0.5 * before.Q_rate[j], 1e-13);
  EXPECT_NEAR(after.Q[0] / before.Q[0], 1.35, 1e-13);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(after.sigma[i], before.sigma[i] + 0.5 * before.sigma_rate[i], 1e-13);
    EXPECT_NEAR(after.mu[i], 0.7 * before.mu[i], 1e-13);
  }
  EXPECT_FALSE(m.problem.axisymmetric);
  EXPECT_FALSE(m.problem.weightless);
}

TEST(SegmentationSystems, OutsideItsValidityTheFormulationRefuses) {
  Mechanics m(general());
  auto u = free_state;
  u[15] = -101.0;  // α = 1 + F3/100 < 0
  std::vector<double> r(7), jac(7 * 19);
  m.free.residual(0.3, u.data(), r.data());
  EXPECT_TRUE(std::isnan(r[0]));
  m.free.jacobian(0.3, u.data(), r.data(), jac.data());
  EXPECT_TRUE(std::isnan(r[0]));
  auto v = line_state;
  v[9] = -101.0;
  m.line.residual(0.3, v.data(), r.data());
  EXPECT_TRUE(std::isnan(r[0]));
}

}  // namespace

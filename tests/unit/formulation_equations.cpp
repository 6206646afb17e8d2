// The contact-free and the line-contact equations. The rod on the axis of a helical conduit solves the first; and the
// two are the same mechanics in different unknowns: a line-contact state, rewritten as a free one with the wall's force
// as body force, solves the free equations wherever U1, U2, U3, Q', weight and couple all differ from 0.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <functional>

#include "formulation_tube.hpp"
#include "tendril/closed_form/helical_conduit.hpp"
#include "tendril/formulation/convert.hpp"
#include "tendril/formulation/energy_density.hpp"

namespace {

using namespace tendril;
using formulation::FreeRod;
using formulation::LineContact;
using formulation::Material;
using formulation::Section;
using formulation_tube::GeneralTube;
using formulation_tube::slope;

constexpr double rounding = 1e-11;   // terms up to 1e2
constexpr double difference = 2e-7;  // differences of forces and couples up to 1e2, h = 5e-3 sixth order

/// The rod on the axis of a helical conduit in a Bishop frame: everything in closed form.
struct OnAxis {
  closed_form::HelicalConduit conduit{0.7, 0.25};
  Material m{1.0 / 400, 1.0 / 3};
  double M3;

  double F3() const { return closed_form::axis_tension(conduit, M3, std::sqrt(m.eta2)); }
  Section section(double S) const {
    const double K = conduit.curvature(), t = conduit.torsion(), P = -t * S + 0.3;
    Section s;
    s.S = S;
    s.U[0] = {K * std::sin(P), K * std::cos(P), 0};  // Φ' = -τ
    s.U[1] = {-t * K * std::cos(P), t * K * std::sin(P), 0};
    s.U[2] = {-t * t * s.U[0][0], -t * t * s.U[0][1], 0};
    s.U[3] = {-t * t * s.U[1][0], -t * t * s.U[1][1], 0};
    s.Q[0] = 0.05;
    return s;
  }
  std::array<double, 17> inputs(const Section& s) const {
    const double a = 1 + m.eta2 * F3();
    std::array<double, 17> u{};
    u[9] = (1 + m.nu) * M3 / a;               // M3 = α φ'/(1+ν)
    u[11] = -a * s.U[1][1] + s.U[0][0] * M3;  // (II.2.52) with ω = α U, ω3 = 0
    u[12] = -a * s.U[2][1] + s.U[1][0] * M3;
    u[13] = a * s.U[1][0] + s.U[0][1] * M3;  // (II.2.51)
    u[14] = a * s.U[2][0] + s.U[1][1] * M3;
    u[15] = F3();
    return u;
  }
};

TEST(FormulationFreeRod, RodOnTheAxisOfAHelicalConduit) {
  for (const double M3 : {-1.0, 0.0, 2.3}) {
    const OnAxis rod{.M3 = M3};
    for (const double S : {0.0, 0.35, 0.8}) {
      const Section s = rod.section(S);
      auto u = rod.inputs(s);
      std::array<double, 7> r{};
      FreeRod::residual<double>(rod.m, formulation::lift(s, 0.0, 0.0), u.data(), r.data(), r.data() + 6);
      for (int e = 0; e < 6; ++e) EXPECT_NEAR(r[e], 0.0, rounding) << "equation " << e << " M3 " << M3;
      EXPECT_NEAR(r[6], 1 / (1 + rod.m.eta2 * rod.F3()), rounding);
      u[15] += 1e-3;  // any other tension bends the rod off its axis
      FreeRod::residual<double>(rod.m, formulation::lift(s, 0.0, 0.0), u.data(), r.data(), r.data() + 6);
      EXPECT_GT(std::hypot(r[3], r[4]), 1e-4);
    }
  }
}

TEST(FormulationFreeRod, BasisIsOrthonormalAndTurnsLeastFromTheFrame) {
  const Section s = GeneralTube{}.at(0.7);
  const auto k = FreeRod::kinematics<double>(formulation::lift(s, 0.0, 0.0), 0.05, 0.4, -1.0, -0.08, -0.3, 2.0);
  using numerics::dot;
  EXPECT_NEAR(dot(k.k1, k.k1), 1, rounding);
  EXPECT_NEAR(dot(k.k2, k.k2), 1, rounding);
  EXPECT_NEAR(dot(k.t, k.t), 1, rounding);
  EXPECT_NEAR(dot(k.k1, k.k2), 0, rounding);
  EXPECT_NEAR(dot(k.k1, k.t), 0, rounding);
  const auto third = numerics::cross(k.k1, k.k2);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(third[i], k.t[i], rounding);
  // smallest rotation: its axis D3 x d3 keeps its components
  EXPECT_NEAR(-k.t[1] * k.k1[0] + k.t[0] * k.k2[0], -k.t[1], rounding);
  EXPECT_NEAR(-k.t[1] * k.k1[1] + k.t[0] * k.k2[1], k.t[0], rounding);
  EXPECT_NEAR(dot(k.t1, k.t), 0, rounding);
}

/// Line-contact inputs at S that satisfy the equations of the section: the four highest derivatives enter linearly.
std::array<double, 11> equilibrium_inputs(const Material& m, const Section& s, std::array<double, 11> u) {
  constexpr int top[4] = {3, 6, 8, 10};
  const auto l = formulation::lift(s, 0.0, 0.0);
  const auto Q = formulation::lift_clearance(s, 0.0, 0.0);
  for (int t : top) u[t] = 0.0;
  Eigen::Vector4d r0, r;
  Eigen::Matrix4d J;
  double quad;
  LineContact::residual<double>(m, l, Q, u.data(), r0.data(), &quad);
  for (int c = 0; c < 4; ++c) {
    auto v = u;
    v[top[c]] = 1.0;
    LineContact::residual<double>(m, l, Q, v.data(), r.data(), &quad);
    J.col(c) = r - r0;
  }
  const Eigen::Vector4d x = -J.partialPivLu().solve(r0);
  for (int c = 0; c < 4; ++c) u[top[c]] = x[c];
  return u;
}

struct Both {
  Material m;
  GeneralTube tube;
};

class FormulationEquivalence : public ::testing::TestWithParam<Both> {};

TEST_P(FormulationEquivalence, LineContactIsAFreeRodUnderTheForceOfTheWall) {
  const auto& [m, tube] = GetParam();
  // β β' β'' - ψ ψ' - F_g - F3 -
  const std::array<double, 11> start = {0.4, 1.3, -2.0, 0, 0.3, 2.1, 0, 3.0, 0, -5.0, 0};
  for (const double S0 : {0.3, 1.1}) {
    const auto u = equilibrium_inputs(m, tube.at(S0), start);
    // the state nearby to first order in the highest derivatives: enough for first derivatives at S0
    const auto line_at = [&](double S) {
      const double h = S - S0;
      std::array<double, 11> v = u;
      v[0] = u[0] + h * (u[1] + h / 2 * (u[2] + h / 3 * u[3]));
      v[1] = u[1] + h * (u[2] + h / 2 * u[3]);
      v[2] = u[2] + h * u[3];
      v[4] = u[4] + h * (u[5] + h / 2 * u[6]);
      v[5] = u[5] + h * u[6];
      v[7] = u[7] + h * u[8];
      v[9] = u[9] + h * u[10];
      return v;
    };
    const auto free_at = [&](double S) {
      std::array<double, 17> f{};
      formulation::line_to_free(m, tube.at(S), line_at(S).data(), f.data());
      return f;
    };
    auto f = free_at(S0);
    f[10] = slope([&](double S) { return free_at(S)[9]; }, S0);
    f[12] = slope([&](double S) { return free_at(S)[11]; }, S0);
    f[14] = slope([&](double S) { return free_at(S)[13]; }, S0);
    // δ' is the slope of δ, δ'' of δ', δ''' of δ''
    for (int d : {0, 1, 2, 4, 5, 6})
      EXPECT_NEAR(f[d + 1], slope([&](double S) { return free_at(S)[d]; }, S0), difference) << d;
    EXPECT_NEAR(f[9], slope([&](double S) { return free_at(S)[8]; }, S0), difference);  // φ' of φ: ψ' and N turn alike
    EXPECT_NEAR(f[16], u[10], rounding);
    Section s = tube.at(S0);
    const auto wall = LineContact::wall(m, s, u.data());
    auto l = formulation::lift(s, 0.0, 0.0);
    for (int i = 0; i < 3; ++i) l.sigma[i] += wall.rho * wall.curve.N[i];
    std::array<double, 7> r{};
    FreeRod::residual<double>(m, l, f.data(), r.data(), r.data() + 6);
    for (int e = 0; e < 6; ++e) EXPECT_NEAR(r[e], 0.0, difference) << "equation " << e << " at " << S0;
    double quad;
    std::array<double, 4> res{};
    double Fn;
    LineContact::residual<double>(m, formulation::lift(s, 0.0, 0.0), formulation::lift_clearance(s, 0.0, 0.0), u.data(),
                                  res.data(), &quad, &Fn);
    for (double x : res) EXPECT_NEAR(x, 0.0, rounding);
    EXPECT_NEAR(quad, r[6], rounding);
    EXPECT_NEAR(Fn, wall.Fn, rounding);
    const auto k = FreeRod::kinematics<double>(formulation::lift(s, 0.0, 0.0), f[0], f[1], f[2], f[4], f[5], f[6]);
    EXPECT_NEAR(FreeRod::twisting_moment<double>(m, k, f[15], f[9]), wall.M3, rounding);
  }
}

TEST_P(FormulationEquivalence, ConversionThereAndBack) {
  const auto& [m, tube] = GetParam();
  for (const double turns : {0.0, 3.0, -2.0}) {
    const Section s = tube.at(0.6);
    const auto u = equilibrium_inputs(m, s, {2.9 + 2 * M_PI * turns, -1.7, 3.0, 0, 0.5, -1.4, 0, -2.0, 0, 4.0, 0});
    std::array<double, 17> f{};
    std::array<double, 11> v{};
    formulation::line_to_free(m, s, u.data(), f.data());
    EXPECT_NEAR(std::hypot(f[0], f[4]), s.Q[0], rounding);
    EXPECT_NEAR((f[0] * f[1] + f[4] * f[5]) / s.Q[0], s.Q[1], rounding);
    formulation::free_to_line(m, s, f.data(), u[0] + 0.8 * (turns > 0 ? 1 : -1), v.data());
    for (int q : {0, 1, 2, 4, 5, 7, 9}) EXPECT_NEAR(v[q], u[q], rounding) << "input " << q << " turns " << turns;
  }
}

INSTANTIATE_TEST_SUITE_P(Tubes, FormulationEquivalence,
                         ::testing::Values(Both{{0.0, 0.0}, {0.0, 0.0, 0.0}},            // cylinder, inextensible
                                           Both{{0.01, 1.0 / 3}, {1.0, 0.0, 0.0}},       // Bishop pipe
                                           Both{{0.01, 1.0 / 3}, {0.0, 0.0, 1.0}},       // straight, tapered
                                           Both{{0.01, 1.0 / 3}, {1.0, 1.0, 1.0}},       // frame with twist of its own
                                           Both{{0.01, 1.0 / 3}, {1.0, 1.0, 1.0, 8.0}},  // weight
                                           Both{{0.0, 0.5}, {1.0, 1.0, 1.0, 8.0, 2.0}},  // and couple
                                           Both{{0.01, 1.0 / 3}, {1.0, 1.0, 1.0, 8.0, 2.0}}));

/// Euler-Lagrange residual of the reduced energy density along a state given in closed form.
Eigen::Vector2d variation(const std::function<formulation::DensityDerivatives(double)>& density, double S) {
  const double h = 0.01;
  Eigen::Vector2d r;
  for (int c = 0; c < 2; ++c) {
    const auto g = [&](double x, int d) { return density(x).gradient[3 * c + d]; };
    const double second = (2 * (g(S + 3 * h, 2) + g(S - 3 * h, 2)) - 27 * (g(S + 2 * h, 2) + g(S - 2 * h, 2)) +
                           270 * (g(S + h, 2) + g(S - h, 2)) - 490 * g(S, 2)) /
                          (180 * h * h);
    r[c] = g(S, 0) - slope([&](double x) { return g(x, 1); }, S, h) + second;
  }
  return r;
}

TEST(FormulationEnergyDensity, IsStationaryForTheRodOnTheAxisOfAHelicalConduit) {
  for (const double M3 : {-1.0, 2.3}) {
    const OnAxis rod{.M3 = M3};
    const double a = 1 + rod.m.eta2 * rod.F3(), K = rod.conduit.curvature();
    const double H = 0.5 * a * a * K * K + rod.F3() + 0.5 * rod.m.eta2 * rod.F3() * rod.F3();
    const auto density = [&](double lambda, double torque) {
      return [=, &rod](double S) {
        const Section s = rod.section(S);
        const auto d = formulation::density_section({s.U[0][0], s.U[0][1], 0}, {s.U[1][0], s.U[1][1], 0}, {0, 0}, 0);
        return formulation::density_derivatives(d, formulation::Vector6::Zero(), lambda, torque, rod.m.eta2);
      };
    };
    EXPECT_LT(variation(density(H, M3), 0.4).norm(), 1e-8);        // sixth-order differences, h = 0.01
    EXPECT_GT(variation(density(H + 0.1, M3), 0.4).norm(), 1e-3);  // and for no other load
    EXPECT_GT(variation(density(H, M3 + 0.1), 0.4).norm(), 1e-3);
    EXPECT_NEAR(density(H, M3)(0.4).s1, 1 / a, rounding);  // the stretch that goes with it
  }
}

TEST(FormulationEnergyDensity, IsStationaryForTheFreeHelix) {
  // δ = r (cos aS, sin aS) in a straight tube, a = tanθ/r; the closed form's tension and moment
  const double r = 0.3, theta = 0.5, a = std::tan(theta) / r, eta2 = 0.01, M3 = 2.2;
  const double kappa = std::sin(theta) * std::sin(theta) / r, tau = std::sin(theta) * std::cos(theta) / r;
  const double F3 = tau * (M3 - tau) / (1 + eta2 * tau * tau), alpha = 1 + eta2 * F3;
  const double H = 0.5 * alpha * alpha * kappa * kappa + F3 + 0.5 * eta2 * F3 * F3;
  const auto state = [&](double S) {
    const double c = r * std::cos(a * S), s = r * std::sin(a * S);
    return formulation::Vector6(c, -a * s, -a * a * c, s, a * c, -a * a * s);
  };
  const auto section = formulation::density_section(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), {0, 0}, 0);
  const auto density = [&](double lambda) {
    return [=](double S) { return formulation::density_derivatives(section, state(S), lambda, M3, eta2); };
  };
  EXPECT_LT(variation(density(H), 0.7).norm(), 1e-7);
  EXPECT_GT(variation(density(H + 0.1), 0.7).norm(), 1e-3);
  EXPECT_NEAR(density(H)(0.7).s1, 1 / (alpha * std::cos(theta)), rounding);
}

}  // namespace

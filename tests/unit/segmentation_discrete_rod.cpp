// The reduced energy density against its definition, its derivatives against differences, and the discrete rod at
// closed forms.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/segmentation/discrete_equilibrium.hpp"
#include "tendril/segmentation/discrete_rod.hpp"

namespace {

using namespace tendril;
using formulation::Matrix6;
using formulation::Vector6;
using segmentation::Vector4;

struct Sample {
  formulation::DensitySection section;
  Vector6 x;
  Eigen::Vector3d U, dU;
  double lambda, torque, eta2;
};

std::vector<Sample> samples() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Sample> out;
  for (int i = 0; i < 20; ++i) {
    Sample s;
    for (int k = 0; k < 3; ++k) {
      s.U[k] = 2.0 * unit(random);
      s.dU[k] = 5.0 * unit(random);
    }
    s.section = formulation::density_section(s.U, s.dU, {30.0 * unit(random), 30.0 * unit(random)}, 4.0 * unit(random));
    for (int k = 0; k < 6; ++k) s.x[k] = (k % 3 == 0 ? 0.05 : k % 3 == 1 ? 0.4 : 3.0) * unit(random);
    s.lambda = 40.0 * unit(random);
    s.torque = 3.0 * unit(random);
    s.eta2 = i % 4 == 0 ? 0.0 : 2.5e-3;
    out.push_back(s);
  }
  return out;
}

// Density by its definition, from d3 and its derivative, at a given s'.
double full_density(const Sample& s, double s1) {
  const Eigen::Vector3d a(s.x[0], s.x[3], 0.0), a1(s.x[1], s.x[4], 0.0), a2(s.x[2], s.x[5], 0.0);
  const Eigen::Vector3d v = Eigen::Vector3d::UnitZ() + a1 + s.U.cross(a);
  const Eigen::Vector3d dv = a2 + s.dU.cross(a) + s.U.cross(a1);
  const double n = v.norm();
  const Eigen::Vector3d g = v / n, dg = dv / n - v * (v.dot(dv) / (n * n * n)), t1 = dg + s.U.cross(g);
  const double c = s.U.dot(g) - (g[0] * dg[1] - dg[0] * g[1]) / (1.0 + g[2]);  // (II.2.48)/J1
  const double y = s.section.force_potential + s.section.force.dot(Eigen::Vector2d(a[0], a[1]));
  const double strain = n / s1 - 1.0;
  return 0.5 * t1.squaredNorm() / s1 + s.torque * c + (s.eta2 > 0.0 ? 0.5 * s1 * strain * strain / s.eta2 : 0.0) +
         s1 * (s.lambda - y);
}

TEST(EnergyDensity, IsTheLeastOverTheStretch) {
  constexpr double rounding = 1e-12;  // of terms of size 100
  for (const auto& s : samples()) {
    const auto d = formulation::density_derivatives(s.section, s.x, s.lambda, s.torque, s.eta2);
    EXPECT_NEAR(d.energy, full_density(s, d.s1), rounding * 1e3);
    if (s.eta2 == 0.0) continue;
    const double step = 1e-4;
    EXPECT_GT(full_density(s, d.s1 + step), d.energy);
    EXPECT_GT(full_density(s, d.s1 - step), d.energy);
    // Stationary: the slope is the difference's own third-order remainder.
    EXPECT_NEAR((full_density(s, d.s1 + step) - full_density(s, d.s1 - step)) / (2.0 * step), 0.0, 2e-4);
  }
}

TEST(EnergyDensity, DerivativesMatchDifferences) {
  constexpr double relative = 2e-7;  // central differences of step 1e-5 with values of size 100
  for (const auto& s : samples()) {
    const auto d = formulation::density_derivatives(s.section, s.x, s.lambda, s.torque, s.eta2);
    const auto value = formulation::density_invariants(s.section, s.x);
    const auto reduced = formulation::reduced_density(value, s.lambda, s.eta2);
    EXPECT_NEAR(reduced.energy + s.torque * value.c, d.energy, 1e-11 * (1.0 + std::abs(d.energy)));
    EXPECT_NEAR(reduced.s1, d.s1, 1e-12);
    EXPECT_NEAR(reduced.s1_rate, d.s1_rate, 1e-12);
    const double h = 1e-5, scale = 1.0 + d.hessian.cwiseAbs().maxCoeff();
    for (int k = 0; k < 6; ++k) {
      Vector6 up = s.x, down = s.x;
      up[k] += h;
      down[k] -= h;
      const auto p = formulation::density_derivatives(s.section, up, s.lambda, s.torque, s.eta2);
      const auto m = formulation::density_derivatives(s.section, down, s.lambda, s.torque, s.eta2);
      EXPECT_NEAR((p.energy - m.energy) / (2 * h), d.gradient[k], relative * scale);
      EXPECT_NEAR((p.s1 - m.s1) / (2 * h), d.s1_gradient[k], relative * scale);
      EXPECT_NEAR((p.c - m.c) / (2 * h), d.c_gradient[k], relative * scale);
      for (int j = 0; j < 6; ++j)
        EXPECT_NEAR((p.gradient[j] - m.gradient[j]) / (2 * h), d.hessian(j, k), relative * scale) << j << k;
    }
  }
}

TEST(BlockTridiagonal, FactorsAndCounts) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const int n = 6;
  segmentation::BlockTridiagonal A;
  A.resize(n);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(4 * n, 4 * n);
  for (int i = 0; i < n; ++i) {
    segmentation::Matrix4 b, l;
    for (int k = 0; k < 16; ++k) {
      b(k) = normal(random);
      l(k) = normal(random);
    }
    A.diagonal[i] = b + b.transpose();
    if (i > 0) A.left[i] = l;
    dense.block(4 * i, 4 * i, 4, 4) = A.diagonal[i];
    if (i > 0) {
      dense.block(4 * i, 4 * i - 4, 4, 4) = l;
      dense.block(4 * i - 4, 4 * i, 4, 4) = l.transpose();
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eig(dense);
  EXPECT_EQ(A.factor(), (eig.eigenvalues().array() < 0.0).count());
  std::vector<Vector4> x(n), y;
  for (auto& v : x) v = Vector4::Random();
  A.multiply(x, y);
  A.solve(y);
  for (int i = 0; i < n; ++i) EXPECT_LT((x[i] - y[i]).norm(), 1e-10);  // condition below 1e4, rounding
}

// A free helical arc carried by its ends is an equilibrium: λ = H and M3 of model section 7. The residual of the
// interpolated state falls with the order of the elements.
TEST(DiscreteRod, HelixArcIsStationary) {
  const double delta = 0.3, theta = 0.5, eta2 = 0.01, m3 = -0.7, length = 1.0;
  const double kappa = std::pow(std::sin(theta), 2) / delta, tau = std::sin(theta) * std::cos(theta) / delta;
  // Free helix: F3 = τ(M3 - ατ), α = 1 + η²F3.
  const double F3 = tau * (m3 - tau) / (1.0 + eta2 * tau * tau), alpha = 1.0 + eta2 * F3;
  const double lambda = 0.5 * std::pow(alpha * kappa, 2) + F3 + 0.5 * eta2 * F3 * F3;
  const geometry::Tube tube{geometry::make_straight(length), geometry::make_constant(1.0)};
  double previous = 0.0;
  for (const int n : {20, 40}) {
    segmentation::DiscreteRodData data;
    data.eta2 = eta2;
    segmentation::DiscreteEquilibrium eq({tube, data, segmentation::discrete_rod_nodes(1.0, 1.0 / n, {})});
    const double k = std::tan(theta) / delta;
    for (std::size_t i = 0; i < eq.u.size(); ++i) {
      const double b = k * eq.rod().nodes()[i];
      eq.u[i] = delta * Vector4(std::cos(b), -k * std::sin(b), std::sin(b), k * std::cos(b));
    }
    eq.fixed.front() = eq.fixed.back() = Vector4::Ones();
    eq.lambda = lambda;
    eq.torque = m3;
    const auto exact = eq.u;
    const auto report = eq.minimise(1e-12, 20, 0.1);
    EXPECT_TRUE(report.converged);
    double error = 0.0;
    for (std::size_t i = 0; i < eq.u.size(); ++i) error = std::max(error, (eq.u[i] - exact[i]).cwiseAbs().maxCoeff());
    EXPECT_LT(error, 2e-6);
    if (previous > 0.0) EXPECT_LT(error, previous / 10.0);  // fourth order: 16
    previous = error;
    EXPECT_NEAR(eq.end_bending_energy(true), 0.5 * std::pow(alpha * kappa, 2), 2e-5);
    EXPECT_NEAR(eq.end_bending_energy(false), 0.5 * std::pow(alpha * kappa, 2), 2e-5);
    EXPECT_NEAR(eq.totals(eq.u).length, length / std::cos(theta) / alpha, 1e-6);
  }
}

}  // namespace

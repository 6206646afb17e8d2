#pragma once
// Damped Newton iteration for a handful of unknowns whose residual is a generic function of dual numbers: the exact
// Jacobian comes with the residual. Used for shooting.

#include <Eigen/LU>
#include <array>
#include <cmath>

#include "tendril/numerics/dual.hpp"

namespace tendril::numerics {

struct DualNewtonOptions {
  double tolerance = 1e-12;  // |step| <= tolerance (1 + |x|), every unknown, full step
  int max_iterations = 60;
  double least_damping = 1e-4;
};

struct DualNewtonSummary {
  bool converged = false;
  const char* reason = "";  // when not converged
  int iterations = 0;
  double step = 0.0;      // scaled size of the last step
  double residual = 0.0;  // largest component at the end
};

/// Finds x with f(x) = 0; `f(const std::array<Dual<K>, K>& x, std::array<Dual<K>, K>& r)` returns false where
/// undefined.
template <int K, class F>
DualNewtonSummary solve_dual_newton(const F& f, std::array<double, K>& x, const DualNewtonOptions& options = {}) {
  using D = Dual<K>;
  DualNewtonSummary sum;
  std::array<D, K> r;
  const auto evaluate = [&](const std::array<double, K>& at, double& merit) {
    std::array<D, K> seeded;
    for (int i = 0; i < K; ++i) seeded[i] = D::seed(at[i], i);
    if (!f(seeded, r)) return false;
    merit = 0.0;
    for (const D& component : r) merit += component.v * component.v;
    return std::isfinite(merit);
  };
  double merit = 0.0;
  if (!evaluate(x, merit)) {
    sum.reason = "the residual is not defined at the starting guess";
    return sum;
  }
  while (sum.iterations < options.max_iterations) {
    ++sum.iterations;
    Eigen::Matrix<double, K, K> jacobian;
    Eigen::Matrix<double, K, 1> right;
    for (int i = 0; i < K; ++i) {
      right[i] = -r[i].v;
      for (int j = 0; j < K; ++j) jacobian(i, j) = r[i].d[j];
    }
    const Eigen::Matrix<double, K, 1> step = jacobian.fullPivLu().solve(right);
    sum.step = 0.0;
    for (int i = 0; i < K; ++i) sum.step = std::fmax(sum.step, std::abs(step[i]) / (1.0 + std::abs(x[i])));
    if (!step.allFinite()) {
      sum.reason = "the linearised problem is singular";
      return sum;
    }
    const bool small = sum.step <= options.tolerance;
    double damping = 1.0;
    for (;; damping *= 0.5) {
      if (damping < options.least_damping) {
        sum.reason = "the damped Newton iteration found no acceptable step";
        return sum;
      }
      std::array<double, K> trial = x;
      for (int i = 0; i < K; ++i) trial[i] += damping * step[i];
      double next = 0.0;
      if (evaluate(trial, next) && (small || next <= (1.0 - 1e-4 * damping) * merit || next < 1e-26)) {
        x = trial;
        merit = next;
        break;
      }
    }
    if (small) {
      sum.converged = true;
      sum.residual = 0.0;
      for (const D& component : r) sum.residual = std::fmax(sum.residual, std::abs(component.v));
      return sum;
    }
  }
  sum.reason = "too many iterations";
  return sum;
}

}  // namespace tendril::numerics

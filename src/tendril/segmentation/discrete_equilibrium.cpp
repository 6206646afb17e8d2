#include "tendril/segmentation/discrete_equilibrium.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace tendril::segmentation {

using formulation::Matrix6;
using formulation::Vector6;

namespace {

double dot(const std::vector<Vector4>& a, const std::vector<Vector4>& b) {
  double s = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) s += a[i].dot(b[i]);
  return s;
}

void axpy(double c, const std::vector<Vector4>& x, std::vector<Vector4>& y) {
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += c * x[i];
}

double largest_eccentricity(const std::vector<Vector4>& x) {
  double m = 0.0;
  for (const auto& v : x) m = std::max({m, std::abs(v[0]), std::abs(v[2])});
  return m;
}

}  // namespace

DiscreteEquilibrium::DiscreteEquilibrium(DiscreteRod rod) : rod_(std::move(rod)) {
  const std::size_t n = rod_.node_count();
  fixed.assign(n, Vector4::Zero());
  u.assign(n, Vector4::Zero());
  wall_multiplier.assign(rod_.points().size(), 0.0);
  wall_share.assign(rod_.points().size(), 1.0);
  cache_.resize(rod_.points().size());
  for (const auto& x : rod_.data().loads) {
    const auto& S = rod_.nodes();
    const auto near =
        std::min_element(S.begin(), S.end(), [&](double a, double b) { return std::abs(a - x.S) < std::abs(b - x.S); });
    node_loads.emplace_back(near - S.begin(), x.load);
  }
  mass_ = rod_.mass();
  K_.resize(n);
  shifted_.resize(n);
  gradient_.resize(n);
  free_gradient_.resize(n);
  apart_.resize(n);
  pull_.resize(n);
  for (int k = 0; k < 2; ++k) {
    border_[k].resize(n);
    solved_[k].resize(n);
  }
}

DiscreteEquilibrium::Totals DiscreteEquilibrium::totals(const std::vector<Vector4>& at) {
  Totals t;
  t.torque = torque;
  const auto& points = rod_.points();
  const double eta2 = rod_.data().eta2, sign = rod_.sign();
  double wall = 0.0, lambda_top = 1e300;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector6 x = rod_.at(points[i], at);
    auto& q = cache_[i].q;
    q = formulation::density_invariants(points[i].section, x);
    // d3 nearly normal to the axis: the description ends before that.
    if (q.g3 < 0.05) return t;
    t.writhe += points[i].weight * q.c;
    lambda_top = std::min(lambda_top, q.y);
    const double k = stiffness(i), p = wall_multiplier[i] + k * sign * (std::hypot(x[0], x[3]) - points[i].clearance);
    if (k > 0.0) {
      const double old = wall_multiplier[i], now = std::max(0.0, p);
      wall += points[i].weight * (now * now - old * old) / (2.0 * k);
    }
  }
  if (tip_wall) {
    const double p = tip_reaction_at(at.back()), old = tip_multiplier;
    wall += (p * p - old * old) / (2.0 * tip_stiffness);
  }
  wall -= tip_load.dot(at.back());
  for (const auto& [node, load] : node_loads) wall -= load.dot(at[node]);
  // The stretch stays positive only above this λ: 1 + 2η²(λ - σ·r) > 0.
  const double lowest = eta2 > 0.0 ? lambda_top - 0.499 / eta2 : -1e300;
  double L = lambda;
  if (!length_held && L <= lowest) return t;
  double energy = 0.0;
  for (int it = 0; it < 50; ++it) {
    L = std::max(L, lowest);
    energy = t.length = t.length_rate = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto r = formulation::reduced_density(cache_[i].q, L, eta2);
      energy += points[i].weight * r.energy;
      t.length += points[i].weight * r.s1;
      t.length_rate += points[i].weight * r.s1_rate;
    }
    if (!length_held) break;
    const double residual = t.length - length_target - length_compliance * (L - length_multiplier);
    const double step = residual / (length_compliance - t.length_rate);
    energy -= L * length_target + 0.5 * length_compliance * (L - length_multiplier) * (L - length_multiplier);
    if (std::abs(step) <= 1e-13 * (1.0 + std::abs(L))) break;
    // Inextensible: linear in λ, one step is exact.
    L += step;
  }
  t.lambda = L;
  if (twist_held) {
    const double k = (1.0 + rod_.data().nu) * twist_share * twist_length;
    t.torque = (twist_target + t.writhe) / k;
    energy += 0.5 * t.torque * t.torque * k;
  } else {
    energy += torque * t.writhe;
  }
  if (anchor_stiffness > 0.0) {
    for (std::size_t i = 0; i < at.size(); ++i) apart_[i] = at[i] - anchor[i];
    mass_.multiply(apart_, pull_);
    energy += 0.5 * anchor_stiffness * dot(apart_, pull_);
  }
  t.merit = energy + wall;
  t.valid = std::isfinite(t.merit);
  return t;
}

void DiscreteEquilibrium::assemble() {
  K_.set_zero();
  for (auto& g : gradient_) g.setZero();
  for (auto& b : border_)
    for (auto& g : b) g.setZero();
  border_diagonal_.setZero();
  const auto& points = rod_.points();
  const double sign = rod_.sign();
  double rate = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& q = points[i];
    const Vector6 x = rod_.at(q, u);
    auto d = formulation::density_derivatives(q.section, x, lambda, torque, rod_.data().eta2);
    const double radius = std::hypot(x[0], x[3]);
    const double k = stiffness(i), p = wall_multiplier[i] + k * sign * (radius - q.clearance);
    if (p > 0.0) {
      const double e1 = x[0] / radius, e2 = x[3] / radius, tangential = sign * p / radius;
      d.gradient[0] += sign * p * e1;
      d.gradient[3] += sign * p * e2;
      d.hessian(0, 0) += k * e1 * e1 + tangential * e2 * e2;
      d.hessian(3, 3) += k * e2 * e2 + tangential * e1 * e1;
      d.hessian(0, 3) += (k - tangential) * e1 * e2;
      d.hessian(3, 0) += (k - tangential) * e1 * e2;
    }
    DiscreteRod::scatter(q, d.gradient, q.weight, gradient_);
    DiscreteRod::scatter(q, d.hessian, q.weight, K_);
    DiscreteRod::scatter(q, d.s1_gradient, q.weight, border_[0]);
    if (twist_held) DiscreteRod::scatter(q, d.c_gradient, q.weight, border_[1]);
    rate += q.weight * d.s1_rate;
  }
  if (tip_wall && tip_reaction() > 0.0) {
    const Vector4& v = u.back();
    const double radius = std::hypot(v[0], v[2]), e1 = v[0] / radius, e2 = v[2] / radius, p = tip_reaction();
    const double k = tip_stiffness, tangential = sign * p / radius;
    gradient_.back() += sign * p * Vector4(e1, 0, e2, 0);
    Matrix4& K = K_.diagonal.back();
    K(0, 0) += k * e1 * e1 + tangential * e2 * e2;
    K(2, 2) += k * e2 * e2 + tangential * e1 * e1;
    K(0, 2) += (k - tangential) * e1 * e2;
    K(2, 0) += (k - tangential) * e1 * e2;
  }
  gradient_.back() -= tip_load;
  for (const auto& [node, load] : node_loads) gradient_[node] -= load;
  if (anchor_stiffness > 0.0) {
    for (std::size_t i = 0; i < u.size(); ++i) apart_[i] = u[i] - anchor[i];
    mass_.multiply(apart_, pull_);
    axpy(anchor_stiffness, pull_, gradient_);
    for (std::size_t i = 0; i < u.size(); ++i) {
      K_.diagonal[i] += anchor_stiffness * mass_.diagonal[i];
      if (i > 0) K_.left[i] += anchor_stiffness * mass_.left[i];
    }
  }
  border_diagonal_[0] = length_compliance - rate;
  border_diagonal_[1] = (1.0 + rod_.data().nu) * twist_share * twist_length;
  free_gradient_ = gradient_;
  hold(gradient_);
  hold(border_[0]);
  hold(border_[1]);
}

void DiscreteEquilibrium::hold(std::vector<Vector4>& x) const {
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = x[i].cwiseProduct(Vector4::Ones() - fixed[i]);
}

int DiscreteEquilibrium::factor(double shift) {
  const std::size_t n = K_.diagonal.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector4 f = Vector4::Ones() - fixed[i];
    shifted_.diagonal[i] = f.asDiagonal() * (K_.diagonal[i] + shift * mass_.diagonal[i]) * f.asDiagonal();
    shifted_.diagonal[i].diagonal() += fixed[i];
    if (i > 0) {
      const Vector4 g = Vector4::Ones() - fixed[i - 1];
      shifted_.left[i] = f.asDiagonal() * (K_.left[i] + shift * mass_.left[i]) * g.asDiagonal();
    }
  }
  int negative = shifted_.factor();
  // Borders: K + Σ b bᵀ/d is what must be definite; its negative count follows from the bordered matrix (Haynsworth).
  schur_ = -Eigen::Matrix2d::Identity();
  const bool on[2] = {length_held, twist_held};
  for (int k = 0; k < 2; ++k) {
    if (!on[k]) continue;
    solved_[k] = border_[k];
    shifted_.solve(solved_[k]);
  }
  for (int k = 0; k < 2; ++k) {
    if (!on[k]) continue;
    schur_(k, k) = -border_diagonal_[k] - dot(border_[k], solved_[k]);
    if (k == 1 && on[0]) schur_(0, 1) = schur_(1, 0) = -dot(border_[0], solved_[1]);
  }
  negative += static_cast<int>((symmetric_eigenvalues<2>(schur_).array() < 0.0).count()) - 2;
  return negative;
}

// Solves [K B; Bᵀ -D] [x; y] = [x; rhs] in place with the factors at hand.
void DiscreteEquilibrium::border_solve(std::vector<Vector4>& x, const Eigen::Vector2d& rhs, Eigen::Vector2d& y) {
  shifted_.solve(x);
  const bool on[2] = {length_held, twist_held};
  Eigen::Vector2d r = Eigen::Vector2d::Zero();
  for (int k = 0; k < 2; ++k)
    if (on[k]) r[k] = rhs[k] - dot(border_[k], x);
  y = Eigen::Vector2d::Zero();
  if (on[0] || on[1]) y = schur_.inverse() * r;
  for (int k = 0; k < 2; ++k)
    if (on[k]) axpy(-y[k], solved_[k], x);
}

DiscreteEquilibrium::Report DiscreteEquilibrium::minimise(double tolerance, int max_iterations, double step_cap) {
  Report report;
  Totals now = totals(u);
  if (!now.valid) return report;
  lambda = now.lambda;
  torque = now.torque;
  // Growth rates of buckling under λ are at most λ²/4 in the L² metric: the natural size of the shift.
  const double natural = 10.0 + 0.25 * lambda * lambda;
  double shift = 0.0;
  std::vector<Vector4> step, trial(u.size());
  for (; report.iterations < max_iterations; ++report.iterations) {
    if (stop.asked()) return report;
    assemble();
    for (int tries = 0; tries < 40; ++tries) {
      ++report.factorisations;
      if (factor(shift) == 0) break;
      shift = std::max(4.0 * shift, 0.02 * natural);
    }
    step = gradient_;
    for (auto& s : step) s = -s;
    Eigen::Vector2d change;
    border_solve(step, Eigen::Vector2d::Zero(), change);
    const double slope = dot(gradient_, step), size = largest_eccentricity(step);
    double t = size > step_cap ? step_cap / size : 1.0;
    if (!std::isfinite(size)) return report;
    const double old_lambda = lambda;
    bool accepted = false;
    const double noise = 1e-13 * (1.0 + std::abs(now.merit) + std::abs(lambda));
    for (int tries = 0; tries < 12; ++tries, t *= 0.4) {
      for (std::size_t i = 0; i < u.size(); ++i) trial[i] = u[i] + t * step[i];
      lambda = old_lambda + (length_held ? t * change[0] : 0.0);
      const Totals next = totals(trial);
      if (next.valid && next.merit <= now.merit + 1e-4 * t * slope + noise) {
        accepted = true;
        u.swap(trial);
        now = next;
        lambda = next.lambda;
        torque = next.torque;
        break;
      }
    }
    if (!accepted) {
      lambda = old_lambda;
      if (shift > 1e8 * natural) return report;
      shift = std::max(8.0 * shift, 0.1 * natural);
      continue;
    }
    if (t == 1.0 && size <= tolerance && shift <= 1e-3 * natural) {
      report.converged = true;
      ++report.iterations;
      return report;
    }
    if (t == 1.0)
      shift = shift > 1e-3 * natural ? 0.15 * shift : 0.0;
    else if (t < 0.3)
      shift = std::max(3.0 * shift, 0.01 * natural);
  }
  return report;
}

double DiscreteEquilibrium::tip_reaction_at(const Vector4& v) const {
  const double penetration = rod_.sign() * (std::hypot(v[0], v[2]) - rod_.clearance_at(rod_.nodes().back()));
  return std::max(0.0, tip_multiplier + tip_stiffness * penetration);
}

double DiscreteEquilibrium::tip_reaction() const { return tip_wall ? tip_reaction_at(u.back()) : 0.0; }

void DiscreteEquilibrium::update_wall_multipliers() {
  tip_multiplier = tip_reaction();
  for (std::size_t i = 0; i < wall_multiplier.size(); ++i) wall_multiplier[i] = wall_pressure(i);
}

double DiscreteEquilibrium::wall_penetration(std::size_t i) const {
  const Vector6 x = rod_.at(rod_.points()[i], u);
  return rod_.sign() * (std::hypot(x[0], x[3]) - rod_.points()[i].clearance);
}

double DiscreteEquilibrium::wall_pressure(std::size_t i) const {
  return std::max(0.0, wall_multiplier[i] + stiffness(i) * wall_penetration(i));
}

int DiscreteEquilibrium::negative_eigenvalues(double shift) {
  assemble();
  return factor(shift);
}

std::optional<std::vector<Vector4>> DiscreteEquilibrium::unstable_direction(double shift) {
  assemble();
  if (factor(shift) == 0) return std::nullopt;
  // Smallest shift that makes the form definite, then inverse iteration there.
  double low = shift, high = std::max(2.0 * shift, 1.0);
  while (factor(high) > 0 && high < 1e16) high *= 4.0;
  for (int i = 0; i < 12; ++i) {
    const double mid = 0.5 * (low + high);
    (factor(mid) > 0 ? low : high) = mid;
  }
  factor(high);
  std::vector<Vector4> v(u.size()), Mv;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double x = static_cast<double>(i) / static_cast<double>(v.size());
    v[i] = Vector4(std::sin(7.1 * x) + 0.3, 0.0, 0.4 * std::cos(9.7 * x) + 0.2, 0.0);
  }
  hold(v);
  for (int i = 0; i < 8; ++i) {
    mass_.multiply(v, Mv);
    hold(Mv);
    Eigen::Vector2d y;
    border_solve(Mv, Eigen::Vector2d::Zero(), y);
    const double size = largest_eccentricity(Mv);
    for (std::size_t k = 0; k < v.size(); ++k) v[k] = Mv[k] / size;
  }
  return v;
}

double DiscreteEquilibrium::lambda_slope(std::vector<Vector4>& du) {
  assemble();
  // Without the compliance in series; the border is there whatever the control.
  const bool held = length_held;
  const double compliance = length_compliance;
  length_held = true;
  border_diagonal_[0] -= compliance;
  factor(0.0);
  du.assign(u.size(), Vector4::Zero());
  Eigen::Vector2d y;
  border_solve(du, Eigen::Vector2d(1.0, 0.0), y);
  border_diagonal_[0] += compliance;
  length_held = held;
  return y[0];
}

Eigen::Vector2d DiscreteEquilibrium::end_couple(bool at_end) {
  assemble();
  const Vector4& g = at_end ? free_gradient_.back() : free_gradient_.front();
  const Vector4& f = at_end ? fixed.back() : fixed.front();
  const double sign = at_end ? 1.0 : -1.0;
  return sign * Eigen::Vector2d(f[1] * g[1], f[3] * g[3]);
}

double DiscreteEquilibrium::end_bending_energy(bool at_end) {
  const Eigen::Vector2d couple = end_couple(at_end);
  if (couple.isZero(0.0)) return 0.0;
  const auto section = rod_.section_at(at_end ? rod_.nodes().back() : rod_.nodes().front());
  const Vector4& v = at_end ? u.back() : u.front();
  Vector6 x;
  x << v[0], v[1], 0.0, v[2], v[3], 0.0;
  Eigen::Vector3d r1 = section.V1 * x;
  r1[2] += 1.0;
  // The twist's share of the couple: M3 ∂c/∂δ'' = -M3 (-v2, v1)/(|r1|(|r1| + v3)).
  const double n = r1.norm(), k = torque / (n * (n + r1[2]));
  const Eigen::Vector2d m = couple - k * Eigen::Vector2d(r1[1], -r1[0]);
  const double m3 = -(m[0] * r1[0] + m[1] * r1[1]) / r1[2];
  return 0.5 * (m.squaredNorm() + m3 * m3) * n * n;  // κ = |∂e/∂r2| |r1|
}

}  // namespace tendril::segmentation

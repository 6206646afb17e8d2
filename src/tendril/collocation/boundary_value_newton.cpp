// Newton's method for a boundary value problem (affine-invariant damping with simplified steps, Deuflhard), adaptive
// meshes, and what path following needs of the linearised problem.
#include <algorithm>
#include <cmath>

#include "tendril/collocation/boundary_value_problem.hpp"

namespace tendril::collocation {

namespace {

double largest(const std::vector<double>& y) {
  double most = 0.0;
  for (double v : y) {
    if (!std::isfinite(v)) return HUGE_VAL;
    most = std::max(most, std::abs(v));
  }
  return most;
}

int largest_entry(const std::vector<double>& normal, const std::vector<double>& scale) {
  int k = 0;
  for (std::size_t i = 0; i < normal.size(); ++i)
    if (std::abs(normal[i]) * scale[i] > std::abs(normal[k]) * scale[k]) k = static_cast<int>(i);
  return k;
}

}  // namespace

BvpSummary BoundaryValueProblem::newton(const Closure& closure, const BvpOptions& options) {
  BvpSummary sum;
  update_scale();
  int held = -1;
  if (closure.kind == Closure::Kind::parameter) held = column_of_p();
  if (closure.kind == Closure::Kind::plane) held = largest_entry(closure.normal, scale_);
  std::vector<double> x0, x1, dx, dw, bar, dwbar;
  // x1 = x0 + damping (dx, dw), in the problem's units
  auto move = [&](const std::vector<double>& d, const std::vector<double>& w, double damping) {
    x1 = x0;
    const int n = unknowns();
    for (int i = 0; i < n; ++i) x1[i] += damping * scale_[i] * d[i];
    for (std::size_t i = 0; i < w.size(); ++i) x1[n + i] += damping * w[i];
    scatter_all(x1);
  };
  auto changes = [&](const std::vector<double>& d, std::vector<double>& w) {
    std::vector<double> unscaled(d);
    for (std::size_t i = 0; i < d.size(); ++i) unscaled[i] *= scale_[i];
    local_changes(unscaled, w);
  };
  double damping = 1.0;
  while (sum.iterations < options.max_iterations) {
    ++sum.iterations;
    ++sum.factorisations;
    if (!assemble(closure, held)) {
      sum.reason = "the linearised problem is singular or not finite";
      return sum;
    }
    correction(closure, dx);
    const double norm = largest(dx);
    sum.correction = norm;
    if (!std::isfinite(norm)) {
      sum.reason = "the Newton correction is not finite";
      return sum;
    }
    changes(dx, dw);
    gather_all(x0);
    for (;;) {
      move(dx, dw, damping);
      double bar_norm = HUGE_VAL;
      if (residual(closure)) {
        correction(closure, bar);
        bar_norm = largest(bar);
      }
      const bool full = damping > 0.99;
      if (full && bar_norm <= options.newton_tolerance) {
        changes(bar, dwbar);
        gather_all(x0);
        move(bar, dwbar, 1.0);
        sum.correction = bar_norm;
        sum.converged = true;
        return sum;
      }
      if (full && norm < 1e-8 && bar_norm > 0.5 * norm && bar_norm < 1e3 * options.newton_tolerance) {
        sum.correction = bar_norm;  // rounding level
        sum.converged = true;
        return sum;
      }
      double bend = 0.0;  // best damping: λ² ½|Δ| / |bar - (1 - λ)Δ|
      if (std::isfinite(bar_norm))
        for (std::size_t i = 0; i < bar.size(); ++i) bend = std::max(bend, std::abs(bar[i] - (1.0 - damping) * dx[i]));
      const double best = bend > 0.0 ? 0.5 * damping * damping * norm / bend : 0.0;
      if (bar_norm < (1.0 - 0.25 * damping) * norm || (full && norm < 1e-9 && bar_norm < 2.0 * norm)) {
        // simplified steps with the same factors while they contract well
        double previous = norm;
        while (full && bar_norm < 0.1 * previous) {
          changes(bar, dwbar);
          gather_all(x0);
          move(bar, dwbar, 1.0);
          ++sum.iterations;
          previous = bar_norm;
          if (!residual(closure)) {
            scatter_all(x0);
            break;
          }
          correction(closure, bar);
          bar_norm = largest(bar);
          if (bar_norm <= options.newton_tolerance) {
            sum.correction = bar_norm;
            sum.converged = true;
            return sum;
          }
        }
        damping = full ? 1.0 : std::min(1.0, std::max(best, 0.5 * damping));
        break;
      }
      damping = std::clamp(best, 0.1 * damping, 0.5 * damping);
      if (damping < options.min_damping) {
        scatter_all(x0);
        sum.reason = "the damped Newton iteration found no acceptable step";
        return sum;
      }
    }
  }
  sum.reason = "no convergence within the allowed number of iterations";
  return sum;
}

double BoundaryValueProblem::error_ratios(double tolerance, std::vector<std::vector<double>>& ratio) {
  bind();
  update_scale();
  ratio.assign(segments(), {});
  double most = 0.0;
  std::vector<double> e;
  for (int j = 0; j < segments(); ++j) {
    const auto& s = segment_[j];
    const auto& system = s.system();
    s.estimate_error(0.0, 1.0, e);
    ratio[j].assign(s.pieces(), 0.0);
    for (int i = 0; i < s.pieces(); ++i) {
      for (int c = 0; c < system.components(); ++c)
        for (int d = 0; d < system.order[c]; ++d)
          ratio[j][i] = std::max(ratio[j][i], e[static_cast<std::size_t>(i) * system.inputs + system.first[c] + d] /
                                                  (scale_[column_of_state(j, 0, s.state_index(c, d))] * tolerance));
      if (!std::isfinite(ratio[j][i])) ratio[j][i] = 1e6;
      most = std::max(most, ratio[j][i]);
    }
  }
  return most;
}

double BoundaryValueProblem::estimate_error() {
  std::vector<std::vector<double>> ratio;
  return error_ratios(1.0, ratio);
}

void BoundaryValueProblem::adapt(double tolerance) {
  std::vector<std::vector<double>> ratio;
  error_ratios(tolerance, ratio);
  for (int j = 0; j < segments(); ++j) segment_[j].adapt(0.0, 1.0, knots_[j], ratio[j], 4.0);
  number();
}

BvpSummary BoundaryValueProblem::solve(const Closure& closure, const BvpOptions& options) {
  BvpSummary total;
  if (!solved_ && closure.kind == Closure::Kind::parameter) p_ = closure.value;
  for (int mesh = 0; mesh < options.max_meshes; ++mesh) {
    // a plane belongs to one mesh: on the others the parameter found is held
    const bool first = mesh == 0 || closure.kind != Closure::Kind::plane;
    const BvpSummary s = newton(first ? closure : Closure::at(p_), options);
    total.iterations += s.iterations;
    total.factorisations += s.factorisations;
    total.converged = s.converged;
    total.reason = s.reason;
    total.correction = s.correction;
    if (!s.converged) return total;
    solved_ = true;
    total.error = estimate_error();
    if (!options.adapt || total.error <= options.tolerance) return total;
    adapt(options.tolerance);
    if (pieces() > options.max_pieces) break;
  }
  total.converged = false;
  total.reason = "the mesh could not be refined to the tolerance";
  return total;
}

BoundaryValueProblem BoundaryValueProblem::on_mesh_of(const BoundaryValueProblem& other) const {
  BoundaryValueProblem copy = *this;
  bind();
  for (int j = 0; j < segments(); ++j) {
    std::vector<double> points;
    const auto& s = other.segment_[j];
    for (int i = 1; i < s.pieces(); ++i) points.push_back(s.place(i, 0.0, 1.0));
    copy.segment_[j].initialise_on(0.0, 1.0, points,
                                   [&](double x, double* u, double* q) { segment_[j].evaluate(x, 0.0, 1.0, u, q); });
  }
  copy.number();
  return copy;
}

bool BoundaryValueProblem::tangent(int held, std::vector<double>& t) {
  if (!assemble(Closure::at(p_), held)) return false;
  t = plane_;
  for (int i = 0; i < unknowns(); ++i) t[i] *= scale_[i] / scale_[held];
  return std::isfinite(largest(t));
}

void BoundaryValueProblem::advance(const std::vector<double>& t, double step) {
  // local unknowns move along the tangent only: the residual part of their correction is taken out
  std::vector<double> dx(t), none(t.size(), 0.0), dw, rest, x;
  for (double& v : dx) v *= step;
  local_changes(dx, dw);
  local_changes(none, rest);
  gather_all(x);
  for (std::size_t i = 0; i < dx.size(); ++i) x[i] += dx[i];
  for (std::size_t i = 0; i < dw.size(); ++i) x[dx.size() + i] += dw[i] - rest[i];
  scatter_all(x);
}

bool BoundaryValueProblem::response(const std::vector<double>& normal, std::vector<double>& y) {
  update_scale();
  Closure plane = Closure::on_plane(normal, 0.0);
  std::vector<double> x;
  gather(x);
  for (int i = 0; i < unknowns(); ++i) plane.value += normal[i] * x[i];
  if (!assemble(plane, largest_entry(normal, scale_))) return false;
  for (std::size_t i = 0; i < rhs_.size(); ++i) rhs_[i] = std::sin(1.0 + static_cast<double>(i * i));  // no symmetry
  rhs_[closure_row_] = 0.0;
  correction(plane, y);
  for (int i = 0; i < unknowns(); ++i) y[i] *= scale_[i];
  return std::isfinite(largest(y));
}

}  // namespace tendril::collocation

#include "tendril/segmentation/elementary_problem.hpp"

#include <algorithm>
#include <cmath>

#include "tendril/numerics/frontal.hpp"
#include "tendril/numerics/line_search.hpp"
#include "tendril/segmentation/end_state.hpp"

namespace tendril::segmentation {
namespace {

using formulation::FreeRod;
using formulation::LineContact;
using numerics::Dual;

// places of the boundary data in the end states
constexpr int free_left[5] = {6, 0, 1, 3, 4}, free_right[6] = {10, -1, 0, 1, 3, 4};
constexpr int line_left[3] = {3, 0, 1}, line_right[4] = {6, -1, 0, 1};  // -1: M3, a function of the state

using EndDual = Dual<13>;  // 12 states (8 of a line contact) and S

EndDual twisting_moment(const ScaledProblem& P, bool line, const double* z, double S) {
  EndDual x[12];
  for (int i = 0; i < (line ? 8 : 12); ++i) x[i] = EndDual::seed(z[i], i);
  const EndDual dS = EndDual::seed(0.0, 12), dp(0.0);
  const auto sec = P.section(S);
  return Transmitted<EndDual>(P.material, line, formulation::lift<EndDual>(sec, dS, dp),
                              formulation::lift_clearance<EndDual>(sec, dS, dp), x)
      .M3;
}

/// Newton on one segment: unknowns are the states of all mesh points, scaled by their typical size.
class ElementaryNewton {
 public:
  ElementaryNewton(const ScaledProblem& problem, const BoundaryData& data, collocation::Segment& segment)
      : P_(problem), data_(data), s_(segment), line_(is_line(segment)) {}

  bool solve(const NewtonOptions& options, ElementarySolution& out);
  bool sensitivities(ElementarySolution& out);
  /// Largest error over tolerance; `ratio` piece by piece.
  double error_ratio(double tolerance, std::vector<double>& ratio);

 private:
  const ScaledProblem& P_;
  const BoundaryData& data_;
  collocation::Segment& s_;
  bool line_;
  numerics::FrontalLU lu_;
  std::vector<double> typical_;  // of one state
  std::vector<double> rhs_, weight_, by_a_, by_b_;
  double merit_ = 0.0;

  int unknowns() const { return (s_.pieces() + 1) * s_.states(); }
  void typical();
  bool assemble();
  bool residual();
  void end_rows(bool left, double* r, double* values, double* by_b) const;
  void move(const std::vector<double>& z0, const std::vector<double>& w0, const std::vector<double>& dz,
            const std::vector<double>& dw, double damping);
  void local_changes(const std::vector<double>& dz, std::vector<double>& dw) const;
  void simplified(std::vector<double>& x);
};

void ElementaryNewton::typical() {
  const double d0 = P_.clearance_max;
  if (line_)
    typical_ = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
  else
    typical_ = {d0, d0, 10.0 * d0, d0, d0, 10.0 * d0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
  for (int i = 0; i <= s_.pieces(); ++i)
    for (int q = 0; q + 1 < s_.states(); ++q) {
      if (q == (line_ ? 0 : 6) || (line_ && q == 3)) continue;  // angles: a radian
      typical_[q] = std::max(typical_[q], std::abs(s_.state(i)[q]));
    }
  // components of one vector share one scale
  auto share = [&](std::initializer_list<int> group) {
    double most = 0.0;
    for (int q : group) most = std::max(most, typical_[q]);
    for (int q : group) typical_[q] = most;
  };
  if (line_) {
    share({5, 6});
  } else {
    share({0, 3});
    share({1, 4});
    share({2, 5});
    share({8, 9, 10});
  }
}

/// Rows of one end over its state (unscaled); the derivative with respect to S_b goes to by_b.
void ElementaryNewton::end_rows(bool left, double* r, double* values, double* by_b) const {
  const int ns = s_.states();
  const double* z = s_.state(left ? 0 : s_.pieces());
  const auto& data = left ? data_.left : data_.right;
  const int* place = left ? (line_ ? line_left : free_left) : (line_ ? line_right : free_right);
  const int n = static_cast<int>(data.size());
  for (int i = 0; i < n; ++i) {
    by_b[i] = 0.0;
    if (place[i] >= 0) {
      r[i] = z[place[i]] - data[i];
      values[i * ns + place[i]] = 1.0;
      continue;
    }
    const EndDual M3 = twisting_moment(P_, line_, z, data_.S_b);
    r[i] = M3.v - data[i];
    for (int q = 0; q + 1 < ns; ++q) values[i * ns + q] = M3.d[q];
    by_b[i] = M3.d[12];
  }
  if (left) {  // s starts from 0
    r[n] = z[ns - 1];
    values[n * ns + ns - 1] = 1.0;
    by_b[n] = 0.0;
  }
}

bool ElementaryNewton::assemble() {
  typical();
  const int ns = s_.states(), pieces = s_.pieces();
  std::vector<std::vector<int>> blocks(pieces + 2);
  for (int q = 0; q < ns; ++q) blocks.front().push_back(q);
  for (int i = 0; i < pieces; ++i)
    for (int q = 0; q < 2 * ns; ++q) blocks[i + 1].push_back(i * ns + q);
  for (int q = 0; q < ns; ++q) blocks.back().push_back(pieces * ns + q);
  lu_.analyse(unknowns(), blocks);
  lu_.begin();
  rhs_.clear();
  weight_.clear();
  by_a_.clear();
  by_b_.clear();
  bool ok = true;
  auto add = [&](int rows, int width, std::vector<double>& values, const double* r, const double* a, const double* b) {
    for (int i = 0; i < rows; ++i) {
      double most = 0.0;
      for (int q = 0; q < width; ++q) most = std::max(most, std::abs(values[i * width + q] *= typical_[q % ns]));
      ok = ok && std::isfinite(most) && std::isfinite(r[i]);
      weight_.push_back(most > 0.0 ? 1.0 / most : 1.0);
      rhs_.push_back(-r[i]);
      by_a_.push_back(a ? a[i] : 0.0);
      by_b_.push_back(b ? b[i] : 0.0);
    }
    lu_.add_block(rows, values.data());
  };
  double r[12], b[12], a[12];
  std::vector<double> values(12 * 12, 0.0);
  end_rows(true, r, values.data(), b);
  add(BoundaryData::left_count(line_) + 1, ns, values, r, nullptr, b);
  collocation::Condensed c;
  for (int i = 0; i < pieces && ok; ++i) {
    if (!(s_.place(i + 1, data_.S_a, data_.S_b) > s_.place(i, data_.S_a, data_.S_b))) return false;
    if (!s_.condense(i, data_.S_a, data_.S_b, c)) return false;
    values.assign(static_cast<std::size_t>(2) * ns * ns, 0.0);
    for (int row = 0; row < ns; ++row) {
      const double* from = &c.rows[static_cast<std::size_t>(row) * (ns + 3)];
      std::copy_n(from, ns, &values[static_cast<std::size_t>(row) * 2 * ns]);
      values[static_cast<std::size_t>(row) * 2 * ns + ns + row] = 1.0;
      a[row] = from[ns];
      b[row] = from[ns + 1];
    }
    add(ns, 2 * ns, values, c.residual.data(), a, b);
  }
  if (!ok) return false;
  values.assign(12 * 12, 0.0);
  end_rows(false, r, values.data(), b);
  add(BoundaryData::right_count(line_), ns, values, r, nullptr, b);
  return ok && lu_.finish();
}

bool ElementaryNewton::residual() {
  double r[12], values[12 * 12] = {}, by_b[12], square = 0.0;
  std::vector<double>& rhs = rhs_;
  rhs.clear();
  auto take = [&](int n) {
    for (int i = 0; i < n; ++i) rhs.push_back(-r[i]);
  };
  end_rows(true, r, values, by_b);
  take(BoundaryData::left_count(line_) + 1);
  for (int i = 0; i < s_.pieces(); ++i) {
    if (!s_.residual(i, data_.S_a, data_.S_b, std::span<double>(r, s_.states()), &square)) return false;
    take(s_.states());
  }
  end_rows(false, r, values, by_b);
  take(BoundaryData::right_count(line_));
  for (std::size_t i = 0; i < rhs.size(); ++i) square += weight_[i] * weight_[i] * rhs[i] * rhs[i];
  merit_ = 0.5 * square;
  return std::isfinite(merit_);
}

void ElementaryNewton::local_changes(const std::vector<double>& dz, std::vector<double>& dw) const {
  dw.resize(s_.local().size());
  const std::size_t local = s_.local().size() / s_.pieces();
  for (int i = 0; i < s_.pieces(); ++i)
    s_.local_correction(i, &dz[static_cast<std::size_t>(i) * s_.states()], 0.0, 0.0, 0.0, &dw[i * local]);
}

void ElementaryNewton::move(const std::vector<double>& z0, const std::vector<double>& w0, const std::vector<double>& dz,
                            const std::vector<double>& dw, double damping) {
  for (std::size_t i = 0; i < z0.size(); ++i) s_.states_data()[i] = z0[i] + damping * dz[i];
  for (std::size_t i = 0; i < w0.size(); ++i) s_.local()[i] = w0[i] + damping * dw[i];
}

/// Correction of the present residual with the last factors, in units of the typical sizes.
void ElementaryNewton::simplified(std::vector<double>& x) {
  x.assign(unknowns(), 0.0);
  lu_.solve(rhs_, x);
}

bool ElementaryNewton::solve(const NewtonOptions& options, ElementarySolution& out) {
  auto norm_of = [](const std::vector<double>& y) {
    double most = 0.0;
    for (double v : y) most = std::max(most, std::abs(v));
    return std::isfinite(most) ? most : HUGE_VAL;
  };
  auto unscale = [&](std::vector<double>& y) {
    for (std::size_t i = 0; i < y.size(); ++i) y[i] *= typical_[i % s_.states()];
  };
  std::vector<double> dz, scaled, dw, bar, z0, w0;
  double damping = 1.0;
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    if (options.stop.asked()) {
      out.reason = options.stop.reason();
      return false;
    }
    ++out.iterations;
    ++out.factorisations;
    if (!assemble()) {
      out.reason = "the linearised elementary problem is singular or left the validity of the formulation";
      return false;
    }
    simplified(scaled);
    const double norm = norm_of(scaled);
    if (!std::isfinite(norm)) {
      out.reason = "the Newton correction of an elementary problem is not finite";
      return false;
    }
    dz = scaled;
    unscale(dz);
    local_changes(dz, dw);
    z0 = s_.states_data();
    w0 = s_.local();
    if (options.residual_line_search) {
      damping = 1.0;
      if (!residual()) merit_ = HUGE_VAL;
    }
    numerics::Backtracking search(merit_);
    for (;;) {
      move(z0, w0, dz, dw, damping);
      double bar_norm = HUGE_VAL;
      merit_ = HUGE_VAL;
      if (residual()) {
        simplified(bar);
        bar_norm = norm_of(bar);
      }
      const double contraction = bar_norm / std::max(norm, 1e-300);
      const bool floor = damping > 0.99 && norm < 1e-9 && contraction > 0.5 && bar_norm < 1e3 * options.tolerance;
      if (damping > 0.99 && (bar_norm <= options.tolerance || floor)) {
        unscale(bar);
        local_changes(bar, dw);
        z0 = s_.states_data();
        w0 = s_.local();
        move(z0, w0, bar, dw, 1.0);
        return true;
      }
      // affine-invariant estimate of the best damping (Deuflhard): λ² ½|Δ| / |bar - (1 - λ)Δ|
      double bend = 0.0;
      if (std::isfinite(bar_norm))
        for (std::size_t i = 0; i < bar.size(); ++i)
          bend = std::max(bend, std::abs(bar[i] - (1.0 - damping) * scaled[i]));
      const double best = bend > 0.0 ? 0.5 * damping * damping * norm / bend : 0.0;
      const bool descends =
          options.residual_line_search ? search.sufficient(damping, merit_) : contraction < 1.0 - 0.25 * damping;
      if (descends || (damping > 0.99 && norm < 1e-9 && contraction < 2.0)) {
        damping = damping > 0.99 ? 1.0 : std::min(1.0, std::max(best, 0.5 * damping));
        break;
      }
      damping =
          options.residual_line_search ? search.next(damping, merit_) : std::clamp(best, 0.1 * damping, 0.5 * damping);
      if (damping < options.min_damping) {
        move(z0, w0, dz, dw, 0.0);
        out.reason = "the damped Newton iteration found no acceptable step in an elementary problem";
        return false;
      }
    }
  }
  out.reason = "an elementary problem did not converge within the allowed number of iterations";
  return false;
}

bool ElementaryNewton::sensitivities(ElementarySolution& out) {
  ++out.factorisations;
  if (!assemble()) return false;
  const int ns = s_.states(), nl = BoundaryData::left_count(line_), nr = BoundaryData::right_count(line_);
  const int rows = static_cast<int>(rhs_.size()), last = unknowns() - ns;
  out.left_rate.resize(ns, nl + nr + 2);
  out.right_rate.resize(ns, nl + nr + 2);
  std::vector<double> b(rows), x(unknowns());
  for (int i = 0; i < nl + nr + 2; ++i) {
    if (i < nl + nr) {  // the datum enters its own row with -1
      std::fill(b.begin(), b.end(), 0.0);
      b[i < nl ? i : rows - nr + (i - nl)] = 1.0;
    } else {
      const auto& by = i == nl + nr ? by_a_ : by_b_;
      for (int q = 0; q < rows; ++q) b[q] = -by[q];
    }
    lu_.solve(b, x);
    for (int q = 0; q < ns; ++q) {
      out.left_rate(q, i) = x[q] * typical_[q];
      out.right_rate(q, i) = x[last + q] * typical_[q];
    }
  }
  return out.left_rate.allFinite() && out.right_rate.allFinite();
}

double ElementaryNewton::error_ratio(double tolerance, std::vector<double>& ratio) {
  typical();
  std::vector<double> e;
  s_.estimate_error(data_.S_a, data_.S_b, e);
  const auto& system = s_.system();
  ratio.assign(s_.pieces(), 0.0);
  for (int i = 0; i < s_.pieces(); ++i) {
    for (int c = 0; c < system.components(); ++c)
      for (int j = 0; j < system.order[c]; ++j)
        ratio[i] = std::max(ratio[i], e[static_cast<std::size_t>(i) * system.inputs + system.first[c] + j] /
                                          (typical_[s_.state_index(c, j)] * tolerance));
    if (!std::isfinite(ratio[i])) ratio[i] = 1e6;
  }
  return *std::max_element(ratio.begin(), ratio.end());
}

}  // namespace

double& BoundaryData::at(int i) {
  const int nl = static_cast<int>(left.size()), nr = static_cast<int>(right.size());
  if (i < nl) return left[i];
  if (i < nl + nr) return right[i - nl];
  return i == nl + nr ? S_a : S_b;
}

bool is_line(const collocation::Segment& segment) { return segment.system().components() == LineContact::components; }

BoundaryData boundary_data(const ScaledProblem& P, const collocation::Segment& segment, double S_a, double S_b) {
  const bool line = is_line(segment);
  BoundaryData d;
  d.S_a = S_a;
  d.S_b = S_b;
  const double *zl = segment.state(0), *zr = segment.state(segment.pieces());
  for (int i = 0; i < BoundaryData::left_count(line); ++i) d.left.push_back(zl[line ? line_left[i] : free_left[i]]);
  for (int i = 0; i < BoundaryData::right_count(line); ++i) {
    const int place = line ? line_right[i] : free_right[i];
    d.right.push_back(place >= 0 ? zr[place] : twisting_moment(P, line, zr, S_b).v);
  }
  return d;
}

ElementarySolution solve_elm_prob(const ScaledProblem& P, const BoundaryData& data, const collocation::Segment& guess,
                                  const ElementaryOptions& options) {
  constexpr int most_meshes = 8;
  constexpr double knot_distance = 1e-7;  // of a mesh point from a knot of the data, as in the chain
  ElementarySolution out;
  out.segment = guess;
  const bool line = is_line(guess);
  if (static_cast<int>(data.left.size()) != BoundaryData::left_count(line) ||
      static_cast<int>(data.right.size()) != BoundaryData::right_count(line)) {
    out.reason = "the boundary data do not belong to this kind of elementary problem";
    return out;
  }
  if (!(data.S_b > data.S_a)) {
    out.reason = "the elementary problem has no length";
    return out;
  }
  ElementaryNewton newton(P, data, out.segment);
  std::vector<double> ratio;
  for (int mesh = 0; mesh < most_meshes; ++mesh) {
    if (!newton.solve(options.newton, out)) return out;
    const double worst = newton.error_ratio(options.accuracy, ratio);
    out.error = worst * options.accuracy;
    const bool aligned = out.segment.aligned(data.S_a, data.S_b, P.knots, knot_distance);
    if (worst <= 1.0 && (aligned || mesh >= 3)) {
      if (options.sensitivities && !newton.sensitivities(out)) {
        out.reason = "the linearised elementary problem is singular";
        return out;
      }
      out.converged = true;
      return out;
    }
    out.segment.adapt(data.S_a, data.S_b, P.knots, ratio, 4.0);
  }
  out.reason = "the mesh of an elementary problem could not be refined to the tolerance";
  return out;
}

}  // namespace tendril::segmentation

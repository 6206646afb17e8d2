#include "tendril/segmentation/chain.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "tendril/formulation/convert.hpp"
#include "tendril/numerics/kernels.hpp"
#include "tendril/numerics/line_search.hpp"

namespace tendril::segmentation {

using formulation::FreeRod;
using formulation::LineContact;

namespace {

/// A phase condition is needed where an axisymmetric problem has a state off the axis.
constexpr double phase_threshold = 1e-3;  // of the clearance
/// A kink of the third derivative this close to a mesh point (of L) is harmless; farther, the mesh is laid anew.
constexpr double knot_distance = 1e-7;

/// The highest derivatives from the equations, which are linear in them, all lower ones given.
void complete(const collocation::System& system, double S, double* u) {
  double r[12], jac[12 * 34], top[12 * 13];
  int pivots[12];
  const int n = system.components(), cols = system.inputs + 2;
  system.jacobian(S, u, r, jac);
  for (int e = 0; e < n; ++e) {
    if (!std::isfinite(r[e])) return;
    for (int c = 0; c < n; ++c) top[e * (n + 1) + c] = jac[e * cols + system.first[c] + system.order[c]];
    top[e * (n + 1) + n] = r[e];
  }
  if (!numerics::factor_and_solve(top, n, n + 1, n + 1, pivots)) return;
  for (int c = 0; c < n; ++c) u[system.first[c] + system.order[c]] -= top[c * (n + 1) + n];
}

}  // namespace

Pattern Chain::pattern() const {
  Pattern q;
  q.line = line_;
  q.S.assign(S_.begin() + 1, S_.end() - 1);
  return q;
}

void Chain::build(const Pattern& pattern, int pieces_total, const Sampler& sampler) {
  mechanics_->problem.p = p_;
  const ScaledProblem& P = mechanics_->problem;
  std::vector<double> points(P.knots);
  const double end = P.now(P.end_position);
  for (int i = 1; i < pieces_total; ++i) points.push_back(end * i / pieces_total);
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  // knots stay, the even points give way to them
  std::vector<double> kept;
  for (double s : points) {
    const bool knot = std::binary_search(P.knots.begin(), P.knots.end(), s);
    const double room = 0.3 * end / pieces_total;
    if (knot) {
      while (!kept.empty() && s - kept.back() < room &&
             !std::binary_search(P.knots.begin(), P.knots.end(), kept.back()))
        kept.pop_back();
      kept.push_back(s);
    } else if (kept.empty() || s - kept.back() > room) {
      kept.push_back(s);
    }
  }
  build(pattern, kept, sampler);
}

void Chain::build(const Pattern& pattern, const std::vector<double>& points, const Sampler& sampler,
                  const LineSampler& on_wall) {
  const ScaledProblem& P = mechanics_->problem;
  mechanics_->problem.p = p_;
  line_ = pattern.line;
  S_.assign(1, 0.0);
  S_.insert(S_.end(), pattern.S.begin(), pattern.S.end());
  S_.push_back(P.now(P.end_position));
  const int n = static_cast<int>(line_.size());
  segment_.clear();
  held_.clear();
  double beta = 0.0;
  bool have_beta = false;
  for (int j = 0; j < n; ++j) {
    const bool line = line_[j];
    segment_.emplace_back(line ? static_cast<const collocation::System*>(&mechanics_->line) : &mechanics_->free, k_);
    const double a = S_[j], b = S_[j + 1];
    // points too close to the ends of the segment are dropped; too few, and even ones are used
    std::vector<double> inside;
    for (double s : points)
      if (s > a + 0.02 * (b - a) && s < b - 0.02 * (b - a)) inside.push_back(s);
    for (int i = 1; inside.size() < 2 && i < 3; ++i) {
      const double s = a + (b - a) * i / 3.0;
      if (inside.empty() || std::abs(inside[0] - s) > 0.15 * (b - a)) inside.push_back(s);
    }
    std::sort(inside.begin(), inside.end());
    segment_.back().initialise_on(a, b, inside, [&](double S, double* u, double* q) {
      if (!line) {
        sampler(S, u, q);
      } else if (on_wall && on_wall(S, u, q)) {
        beta = u[0];  // the turn counted so far
        have_beta = true;
        return;
      } else {
        double f[FreeRod::inputs];
        sampler(S, f, q);
        if (!have_beta) {
          beta = std::atan2(f[4], f[0]);
          have_beta = true;
        }
        formulation::free_to_line(P.material, P.section(S), f, beta, u);
        beta = u[0];
      }
      complete(segment_.back().system(), S, u);
    });
    have_beta = false;
  }
  multiplier_ = 0.0;
  choose_phase();
  number();
}

void Chain::hold(int junction, double S) {
  if (held_.empty()) held_.assign(segments(), std::nan(""));
  held_[junction] = S;
}

void Chain::release(int junction) {
  if (!held_.empty()) held_[junction] = std::nan("");
}

bool Chain::any_held() const {
  return std::any_of(held_.begin(), held_.end(), [](double s) { return std::isfinite(s); });
}

Chain Chain::recut(const Pattern& pattern) const {
  return recut(pattern, [this](double S, double* u, double* s) { sample(S, u, s); });
}

Chain Chain::recut(const Pattern& pattern, const Sampler& sampler) const {
  Chain c(mechanics_, k_);
  c.p_ = p_;
  c.p_scale_ = p_scale_;
  std::vector<double> points;
  for (int j = 0; j < segments(); ++j)
    for (int i = 1; i < segment_[j].pieces(); ++i) points.push_back(segment_[j].place(i, S_[j], S_[j + 1]));
  c.build(pattern, points, sampler, [this](double S, double* line, double* s) {
    const int j = segment_at(S);
    if (!line_[j]) return false;
    segment_[j].evaluate(S, S_[j], S_[j + 1], line, s);
    return true;
  });
  return c;
}

void Chain::adopt(const Pattern& pattern, std::vector<collocation::Segment> segments) {
  mechanics_->problem.p = p_;
  line_ = pattern.line;
  S_.assign(1, 0.0);
  S_.insert(S_.end(), pattern.S.begin(), pattern.S.end());
  S_.push_back(mechanics_->problem.now(mechanics_->problem.end_position));
  held_.clear();
  segment_ = std::move(segments);
  choose_phase();
  number();
  estimate_error();
}

int Chain::segment_at(double S) const {
  int j = 0;
  while (j + 1 < segments() && S_[j + 1] <= S) ++j;
  return j;
}

void Chain::sample(double S, double* u, double* s) const {
  const int j = segment_at(S);
  if (!line_[j]) {
    segment_[j].evaluate(S, S_[j], S_[j + 1], u, s);
    return;
  }
  double line[LineContact::inputs];
  segment_[j].evaluate(S, S_[j], S_[j + 1], line, s);
  formulation::line_to_free(mechanics_->problem.material, mechanics_->problem.section(S), line, u);
}

bool Chain::needs_phase() const {
  if (!mechanics_->problem.axisymmetric) return false;
  const auto& s = segment_.front();
  double most = 0.0;
  for (int i = 0; i <= s.pieces(); ++i) most = std::max(most, std::hypot(s.state(i)[0], s.state(i)[3]));
  return !line_.front() && most > phase_threshold * mechanics_->problem.clearance_max;
}

void Chain::choose_phase() {
  phase_ = needs_phase();
  if (!phase_) return;
  // the first contact, or the largest eccentricity, is turned to β = 0
  auto& s = segment_.front();
  phase_segment_ = 0;
  phase_piece_ = s.pieces() - 1;
  if (segments() == 1) {
    double most = -1.0;
    for (int i = 1; i < s.pieces(); ++i) {
      const double e = std::hypot(s.state(i)[0], s.state(i)[3]);
      if (e > most) {
        most = e;
        phase_piece_ = i - 1;
      }
    }
  }
  const double* z = s.state(phase_piece_ + 1);
  const double r = std::hypot(z[0], z[3]), c = z[0] / r, sn = z[3] / r;
  auto turn = [&](double& x, double& y) {
    const double a = c * x + sn * y, b = -sn * x + c * y;
    x = a;
    y = b;
  };
  const double angle = std::atan2(sn, c);
  for (int j = 0; j < segments(); ++j) {
    auto& seg = segment_[j];
    const int n = seg.system().components(), k = seg.points_per_piece();
    for (int i = 0; i <= seg.pieces(); ++i) {
      double* q = seg.state(i);
      if (line_[j]) {
        q[0] -= angle;
      } else {
        for (int d = 0; d < 3; ++d) turn(q[d], q[3 + d]);
        turn(q[8], q[9]);
      }
    }
    if (!line_[j])
      for (int g = 0; g < seg.pieces() * k; ++g) {
        double* w = &seg.local()[static_cast<std::size_t>(g) * n];
        turn(w[0], w[1]);
        turn(w[3], w[4]);
      }
  }
}

void Chain::number() {
  first_column_.clear();
  int column = 0;
  for (const auto& s : segment_) {
    first_column_.push_back(column);
    column += (s.pieces() + 1) * s.states();
  }
  state_columns_ = column;
  const int p = column_of_p(), multiplier = p + 1;
  blocks_.clear();
  auto states = [&](std::vector<int>& cols, int j, int i) {
    for (int q = 0; q < segment_[j].states(); ++q) cols.push_back(column_of_state(j, i, q));
  };
  std::vector<int> cols;
  states(cols, 0, 0);
  cols.push_back(column_of_S(0));
  cols.push_back(p);
  blocks_.push_back(cols);
  for (int j = 0; j < segments(); ++j) {
    for (int i = 0; i < segment_[j].pieces(); ++i) {
      cols.clear();
      states(cols, j, i);
      cols.push_back(column_of_S(j));
      cols.push_back(column_of_S(j + 1));
      cols.push_back(p);
      states(cols, j, i + 1);
      if (phase_ && j == phase_segment_ && i == phase_piece_) cols.push_back(multiplier);
      blocks_.push_back(cols);
    }
    if (j + 1 < segments()) {
      cols.clear();
      states(cols, j, segment_[j].pieces());
      states(cols, j + 1, 0);
      cols.push_back(column_of_S(j + 1));
      cols.push_back(p);
      blocks_.push_back(cols);
    }
  }
  cols.clear();
  states(cols, segments() - 1, segment_.back().pieces());
  cols.push_back(column_of_S(segments()));
  cols.push_back(p);
  blocks_.push_back(cols);
  blocks_.emplace_back();  // the closure's, known when a system is solved
}

int Chain::unknowns() const { return column_of_p() + 1 + (phase_ ? 1 : 0); }

void Chain::gather(std::vector<double>& x) const {
  x.resize(unknowns());
  for (int j = 0; j < segments(); ++j)
    std::copy(segment_[j].states_data().begin(), segment_[j].states_data().end(), x.begin() + first_column_[j]);
  std::copy(S_.begin(), S_.end(), x.begin() + state_columns_);
  x[column_of_p()] = p_;
  if (phase_) x.back() = multiplier_;
}

void Chain::scatter(const std::vector<double>& x) {
  for (int j = 0; j < segments(); ++j)
    std::copy_n(x.begin() + first_column_[j], segment_[j].states_data().size(), segment_[j].states_data().begin());
  std::copy_n(x.begin() + state_columns_, S_.size(), S_.begin());
  p_ = x[column_of_p()];
  if (phase_) multiplier_ = x.back();
  mechanics_->problem.p = p_;
}

void Chain::gather_all(std::vector<double>& x) const {
  gather(x);
  for (const auto& s : segment_) x.insert(x.end(), s.local().begin(), s.local().end());
}

void Chain::scatter_all(const std::vector<double>& x) {
  scatter({x.begin(), x.begin() + unknowns()});
  std::size_t at = unknowns();
  for (auto& s : segment_)
    for (double& w : s.local()) w = x[at++];
}

void Chain::advance(const std::vector<double>& t, double step) {
  std::vector<double> dx(t), dw;
  for (double& v : dx) v *= step;
  local_changes(dx, dw);
  std::vector<double> x;
  gather(x);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += dx[i];
  scatter(x);
  std::size_t at = 0;
  for (auto& s : segment_)
    for (double& w : s.local()) w += dw[at++];
}

void Chain::rebind(std::shared_ptr<Mechanics> mechanics) {
  mechanics_ = std::move(mechanics);
  for (int j = 0; j < segments(); ++j)
    segment_[j].rebind(line_[j] ? static_cast<const collocation::System*>(&mechanics_->line) : &mechanics_->free);
  mechanics_->problem.p = p_;
}

void Chain::typical() {
  StateScale t{mechanics_->problem.clearance_max, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0};
  t.d1 = t.d0;
  t.d2 = 10.0 * t.d0;
  for (int j = 0; j < segments(); ++j) {
    const auto& s = segment_[j];
    for (int i = 0; i <= s.pieces(); ++i) {
      const double* z = s.state(i);
      if (line_[j]) {
        t.b1 = std::max(t.b1, std::abs(z[1]));
        t.b2 = std::max(t.b2, std::abs(z[2]));
        t.turn1 = std::max(t.turn1, std::abs(z[4]));
        for (int q = 5; q < 7; ++q) t.F = std::max(t.F, std::abs(z[q]));
      } else {
        t.d1 = std::max({t.d1, std::abs(z[1]), std::abs(z[4])});
        t.d2 = std::max({t.d2, std::abs(z[2]), std::abs(z[5])});
        t.turn1 = std::max(t.turn1, std::abs(z[7]));
        for (int q = 8; q < 11; ++q) t.F = std::max(t.F, std::abs(z[q]));
      }
    }
  }
  typical_ = t;
}

void Chain::scales(std::vector<double>& d) const {
  d.assign(unknowns(), 1.0);
  const StateScale& t = typical_;
  const double free[12] = {t.d0, t.d1, t.d2, t.d0, t.d1, t.d2, 1.0, t.turn1, t.F, t.F, t.F, 1.0};
  const double line[8] = {1.0, t.b1, t.b2, 1.0, t.turn1, t.F, t.F, 1.0};
  for (int j = 0; j < segments(); ++j) {
    const auto& s = segment_[j];
    for (int i = 0; i <= s.pieces(); ++i)
      std::copy_n(line_[j] ? line : free, s.states(), d.begin() + column_of_state(j, i, 0));
  }
  d[column_of_p()] = p_scale_;
  if (phase_) d.back() = t.F;
}

void Chain::add_rows(int block, int rows, double* values) {
  const auto& cols = blocks_[block];
  const int width = static_cast<int>(cols.size());
  for (int r = 0; r < rows; ++r) {
    double most = 0.0;
    for (int c = 0; c < width; ++c) most = std::max(most, std::abs(values[r * width + c] *= scale_[cols[c]]));
    row_weight_.push_back(most > 0.0 ? 1.0 / most : 1.0);
  }
  lu_.add_block(rows, values);
}

bool Chain::assemble(const Closure& closure) {
  mechanics_->problem.p = p_;
  typical();
  scales(scale_);
  // the closure's columns complete the structure
  std::vector<int> cols;
  switch (closure.kind) {
    case Closure::Kind::parameter:
      cols = {column_of_p()};
      break;
    case Closure::Kind::unknown:
      cols = {closure.index};
      break;
    case Closure::Kind::span:
      cols = {column_of_S(closure.index), column_of_S(closure.index + 1)};
      break;
  }
  if (blocks_.back() != cols) {
    blocks_.back() = cols;
    lu_.analyse(unknowns(), blocks_);
  }
  lu_.begin();
  rhs_.clear();
  row_weight_.clear();
  int block = 0;
  bool ok = true;
  double r[64];
  auto add = [&](auto&& rows_of) {
    values_.assign(static_cast<std::size_t>(32) * blocks_[block].size(), 0.0);
    const int n = rows_of(r, values_.data());
    for (int i = 0; i < n; ++i) {
      ok = ok && std::isfinite(r[i]);
      rhs_.push_back(-r[i]);
    }
    add_rows(block++, n, values_.data());
  };
  add([&](double* q, double* v) { return left_rows(q, v); });
  collocation::Condensed condensed;
  for (int j = 0; j < segments() && ok; ++j) {
    auto& s = segment_[j];
    const int ns = s.states();
    for (int i = 0; i < s.pieces() && ok; ++i) {
      if (!s.condense(i, S_[j], S_[j + 1], condensed)) {
        ok = false;
        break;
      }
      add([&](double* q, double* v) {
        const bool phase = phase_ && j == phase_segment_ && i == phase_piece_;
        const int width = 2 * ns + 3 + (phase ? 1 : 0);
        for (int row = 0; row < ns; ++row) {
          std::copy_n(&condensed.rows[static_cast<std::size_t>(row) * (ns + 3)], ns + 3, v + row * width);
          v[row * width + ns + 3 + row] = 1.0;
          q[row] = condensed.residual[row];
        }
        if (!phase) return ns;
        q[9] += multiplier_;  // a tangential point force: must come out 0
        v[9 * width + width - 1] = 1.0;
        q[ns] = s.state(i + 1)[3];  // δ2 = 0
        v[ns * width + ns + 3 + 3] = 1.0;
        return ns + 1;
      });
    }
    if (j + 1 < segments() && ok) add([&](double* q, double* v) { return junction_rows(j, q, v); });
  }
  if (ok) {
    add([&](double* q, double* v) { return right_rows(q, v); });
    add([&](double* q, double* v) { return closure_row(closure, q, v); });
    ok = lu_.finish();
  }
  return ok;
}

bool Chain::residual(const Closure& closure, std::vector<double>& rhs) {
  mechanics_->problem.p = p_;
  rhs.clear();
  bool ok = true;
  double r[64], square = 0.0;
  values_.assign(32 * 64, 0.0);
  auto take = [&](int n) {
    for (int i = 0; i < n; ++i) {
      ok = ok && std::isfinite(r[i]);
      rhs.push_back(-r[i]);
    }
  };
  take(left_rows(r, values_.data()));
  for (int j = 0; j < segments(); ++j) {
    auto& s = segment_[j];
    for (int i = 0; i < s.pieces(); ++i) {
      int n = s.states();
      if (!s.residual(i, S_[j], S_[j + 1], std::span<double>(r, n), &square)) return false;
      if (phase_ && j == phase_segment_ && i == phase_piece_) {
        r[9] += multiplier_;
        r[n++] = s.state(i + 1)[3];
      }
      take(n);
    }
    if (j + 1 < segments()) {
      std::fill(values_.begin(), values_.end(), 0.0);
      take(junction_rows(j, r, values_.data()));
    }
  }
  std::fill(values_.begin(), values_.end(), 0.0);
  take(right_rows(r, values_.data()));
  std::fill(values_.begin(), values_.end(), 0.0);
  take(closure_row(closure, r, values_.data()));
  for (std::size_t i = 0; i < rhs.size(); ++i) square += row_weight_[i] * row_weight_[i] * rhs[i] * rhs[i];
  merit_ = 0.5 * square;
  return ok;
}

void Chain::local_changes(const std::vector<double>& dx, std::vector<double>& dw) {
  std::size_t n = 0;
  for (const auto& s : segment_) n += s.local().size();
  dw.resize(n);
  std::size_t at = 0;
  for (int j = 0; j < segments(); ++j) {
    const auto& s = segment_[j];
    const std::size_t local = s.local().size() / s.pieces();
    for (int i = 0; i < s.pieces(); ++i, at += local)
      s.local_correction(i, &dx[column_of_state(j, i, 0)], dx[column_of_S(j)], dx[column_of_S(j + 1)],
                         dx[column_of_p()], &dw[at]);
  }
}

void Chain::apply(const std::vector<double>& x0, const std::vector<double>& w0, const std::vector<double>& dx,
                  double damping) {
  std::vector<double> x(x0);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += damping * dx[i];
  scatter(x);
  std::size_t at = 0;
  for (auto& s : segment_)
    for (double& w : s.local()) w = w0[at++];
}

NewtonSummary Chain::solve(const Closure& closure, const NewtonOptions& options) {
  NewtonSummary sum;
  if (phase_ != needs_phase()) {
    choose_phase();
    number();
  }
  std::vector<double> x0, w0, dx, dw, bar, dwbar, wt;
  auto scaled_norm = [&](const std::vector<double>& y) {
    double most = 0.0;
    for (double v : y) most = std::max(most, std::abs(v));
    return std::isfinite(most) ? most : HUGE_VAL;
  };
  auto unscale = [&](std::vector<double>& y) {
    for (std::size_t i = 0; i < y.size(); ++i) y[i] *= scale_[i];
  };
  auto gather_local = [&](std::vector<double>& w) {
    w.clear();
    for (const auto& s : segment_) w.insert(w.end(), s.local().begin(), s.local().end());
  };
  // widths of the pieces may not collapse within one step
  auto width_limit = [&](const std::vector<double>& d) {
    double limit = 1.0;
    for (int j = 0; j < segments(); ++j) {
      const auto& s = segment_[j];
      const double a = S_[j], b = S_[j + 1], da = d[column_of_S(j)], db = d[column_of_S(j + 1)];
      for (int i = 0; i < s.pieces(); ++i) {
        const double h = s.place(i + 1, a, b) - s.place(i, a, b);
        const double h1 = s.place(i + 1, a + da, b + db) - s.place(i, a + da, b + db);
        if (h1 < 0.3 * h) limit = std::min(limit, 0.7 * h / (h - h1));
      }
    }
    return limit;
  };
  double damping = 1.0, last_norm = 0.0;
  for (sum.iterations = 0; sum.iterations < options.max_iterations;) {
    ++sum.iterations;
    ++sum.factorisations;
    if (!assemble(closure)) {
      sum.reason = "the linearised chain is singular or left the validity of the formulation";
      return sum;
    }
    dx.assign(unknowns(), 0.0);
    lu_.solve(rhs_, dx);
    double norm = scaled_norm(dx);
    if (!std::isfinite(norm)) {
      sum.reason = "the Newton correction is not finite";
      return sum;
    }
    unscale(dx);
    local_changes(dx, dw);
    gather(x0);
    gather_local(w0);
    const double limit = width_limit(dx);
    damping = std::min({1.0, limit, damping});
    if (damping < options.min_damping) {
      sum.correction = norm;
      sum.reason = "the damped Newton iteration found no acceptable step";
      return sum;
    }
    if (options.residual_line_search && !residual(closure, rhs_)) merit_ = HUGE_VAL;
    numerics::Backtracking search(merit_);
    bool accepted = false;
    while (!accepted) {
      wt = w0;
      for (std::size_t i = 0; i < wt.size(); ++i) wt[i] += damping * dw[i];
      apply(x0, wt, dx, damping);
      double bar_norm = HUGE_VAL;
      merit_ = HUGE_VAL;
      if (residual(closure, rhs_)) {
        bar.assign(unknowns(), 0.0);
        lu_.solve(rhs_, bar);
        bar_norm = scaled_norm(bar);
      }
      const double contraction = bar_norm / std::max(norm, 1e-300);
      // affine-invariant estimate of the best damping (Deuflhard): λ² ½|Δ| / |bar - (1 - λ)Δ|, scaled norms
      double bend = 0.0;
      if (std::isfinite(bar_norm))
        for (std::size_t i = 0; i < bar.size(); ++i)
          bend = std::max(bend, std::abs(bar[i] - (1.0 - damping) * dx[i] / scale_[i]));
      const double best = bend > 0.0 ? 0.5 * damping * damping * norm / bend : 0.0;
      if (bar_norm <= options.tolerance && damping > 0.99) {
        // the simplified correction is already below the tolerance: take it and stop
        unscale(bar);
        local_changes(bar, dwbar);
        gather(x0);
        for (std::size_t i = 0; i < wt.size(); ++i) wt[i] += dwbar[i];
        apply(x0, wt, bar, 1.0);
        sum.converged = true;
        sum.correction = bar_norm;
        return sum;
      }
      const bool descends =
          options.residual_line_search ? search.sufficient(damping, merit_) : contraction < 1.0 - 0.25 * damping;
      if (descends || (norm < 1e-9 && contraction < 2.0 && damping > 0.99)) {
        accepted = true;
        last_norm = norm;
        if (damping > 0.99 && norm < 1e-9 && contraction > 0.5) {
          // rounding level: no further progress is possible
          sum.converged = bar_norm < 1e3 * options.tolerance;
          sum.correction = bar_norm;
          if (!sum.converged) sum.reason = "corrections stagnate at rounding level";
          if (sum.converged) return sum;
        }
        // chained simplified steps while they contract well
        double previous = norm;
        while (!options.residual_line_search && damping > 0.99 && bar_norm < 0.1 * previous) {
          unscale(bar);
          if (width_limit(bar) < 1.0) break;
          local_changes(bar, dwbar);
          gather(x0);
          gather_local(w0);
          wt = w0;
          for (std::size_t i = 0; i < wt.size(); ++i) wt[i] += dwbar[i];
          apply(x0, wt, bar, 1.0);
          ++sum.iterations;
          previous = bar_norm;
          if (!residual(closure, rhs_)) {
            apply(x0, w0, bar, 0.0);
            break;
          }
          bar.assign(unknowns(), 0.0);
          lu_.solve(rhs_, bar);
          bar_norm = scaled_norm(bar);
          if (bar_norm <= options.tolerance) {
            sum.converged = true;
            sum.correction = bar_norm;
            return sum;
          }
          if (bar_norm > previous) break;
        }
        damping = damping > 0.99 || options.residual_line_search ? 1.0 : std::min(1.0, std::max(best, 0.5 * damping));
        break;
      }
      damping =
          options.residual_line_search ? search.next(damping, merit_) : std::clamp(best, 0.1 * damping, 0.5 * damping);
      if (damping < options.min_damping) {
        apply(x0, w0, dx, 0.0);
        sum.correction = norm;
        sum.reason = "the damped Newton iteration found no acceptable step";
        return sum;
      }
    }
  }
  sum.correction = last_norm;
  sum.reason = "no convergence within the allowed number of iterations";
  return sum;
}

double Chain::error_ratio(int j, std::vector<double>& ratio, double tolerance) const {
  const auto& s = segment_[j];
  std::vector<double> e;
  s.estimate_error(S_[j], S_[j + 1], e);
  const StateScale& t = typical_;
  const double free[17] = {t.d0, t.d1, t.d2, 0, t.d0, t.d1, t.d2, 0, 1.0, t.turn1, 0, t.F, 0, t.F, 0, t.F, 0};
  const double line[11] = {1.0, t.b1, t.b2, 0, 1.0, t.turn1, 0, t.F, 0, t.F, 0};
  const int n = s.system().inputs;
  ratio.assign(s.pieces(), 0.0);
  double most = 0.0;
  for (int i = 0; i < s.pieces(); ++i) {
    for (int q = 0; q < n; ++q) {
      const double scale = line_[j] ? line[q] : free[q];
      if (scale > 0.0) ratio[i] = std::max(ratio[i], e[static_cast<std::size_t>(i) * n + q] / (scale * tolerance));
    }
    if (!std::isfinite(ratio[i])) ratio[i] = 1e6;
    most = std::max(most, ratio[i]);
  }
  return most;
}

double Chain::estimate_error() {
  typical();
  std::vector<double> ratio;
  error_ = 0.0;
  for (int j = 0; j < segments(); ++j) error_ = std::max(error_, error_ratio(j, ratio, 1.0));
  return error_;
}

NewtonSummary Chain::solve_adaptive(const Closure& closure, const NewtonOptions& options, double tolerance) {
  NewtonSummary total;
  for (int round = 0; round < 8; ++round) {
    const bool may_hold = round > 0 && segments() > 1 && !any_held();
    const Chain before = may_hold ? *this : Chain();
    NewtonSummary s = solve(closure, options);
    total.iterations += s.iterations;
    total.factorisations += s.factorisations;
    if (!s.converged && may_hold) {
      // a short segment amplifies the change of mesh: settle with the junctions held, then let them go
      *this = before;
      for (int j = 0; j + 1 < segments(); ++j) hold(j, S_[j + 1]);
      NewtonSummary h = solve({Closure::Kind::parameter, 0, p_}, options);
      for (int j = 0; j + 1 < segments(); ++j) release(j);
      total.iterations += h.iterations;
      total.factorisations += h.factorisations;
      if (h.converged) {
        s = solve(closure, options);
        total.iterations += s.iterations;
        total.factorisations += s.factorisations;
      }
    }
    total.converged = s.converged;
    total.correction = s.correction;
    total.reason = s.reason;
    if (!s.converged) return total;
    typical();
    std::vector<std::vector<double>> ratio(segments());
    double most = 0.0;
    for (int j = 0; j < segments(); ++j) most = std::max(most, error_ratio(j, ratio[j], tolerance));
    error_ = most * tolerance;
    bool aligned = true;
    for (int j = 0; j < segments(); ++j)
      aligned = aligned && segment_[j].aligned(S_[j], S_[j + 1], mechanics_->problem.knots, knot_distance);
    if (most <= 1.0 && (aligned || round >= 3)) return total;
    for (int j = 0; j < segments(); ++j) segment_[j].adapt(S_[j], S_[j + 1], mechanics_->problem.knots, ratio[j], 4.0);
    number();
    if (phase_) choose_phase(), number();
  }
  total.converged = false;
  total.reason = "the mesh could not be refined to the tolerance";
  return total;
}

bool Chain::tangent(const Closure& closure, std::vector<double>& t) {
  if (!assemble(closure)) return false;
  std::vector<double> b(rhs_.size(), 0.0);
  b.back() = 1.0;  // the closure row comes last
  t.assign(unknowns(), 0.0);
  lu_.solve(b, t);
  for (std::size_t i = 0; i < t.size(); ++i) t[i] *= scale_[i];
  return true;
}

bool Chain::response(const Closure& closure, std::vector<double>& y) {
  if (!assemble(closure)) return false;
  const std::vector<double> load(rhs_.size(), 1.0);
  y.assign(unknowns(), 0.0);
  lu_.solve(load, y);
  return true;
}

void Chain::store(std::vector<double>& out) const {
  out = {1.0, static_cast<double>(k_), p_, p_scale_, static_cast<double>(segments())};
  for (int j = 0; j < segments(); ++j) out.push_back(line_[j]);
  out.insert(out.end(), S_.begin(), S_.end());
  for (int j = 0; j < segments(); ++j) {
    const auto& s = segment_[j];
    out.push_back(s.pieces());
    for (int i = 0; i <= s.pieces(); ++i) out.push_back(s.place(i, S_[j], S_[j + 1]));
    out.insert(out.end(), s.states_data().begin(), s.states_data().end());
    out.insert(out.end(), s.local().begin(), s.local().end());
  }
}

bool Chain::restore(const std::vector<double>& in, std::shared_ptr<Mechanics> mechanics) {
  std::size_t at = 0;
  bool ok = true;
  auto next = [&]() { return at < in.size() ? in[at++] : (ok = false, 0.0); };
  if (next() != 1.0) return false;
  mechanics_ = std::move(mechanics);
  k_ = static_cast<int>(next());
  p_ = next();
  p_scale_ = next();
  const double n = next();
  if (!ok || k_ < 4 || k_ > 7 || !(n >= 1.0 && n < 1e6)) return false;
  line_.clear();
  S_.clear();
  segment_.clear();
  for (int j = 0; j < n; ++j) line_.push_back(next() != 0.0);
  for (int j = 0; j <= n; ++j) S_.push_back(next());
  mechanics_->problem.p = p_;
  for (int j = 0; j < n && ok; ++j) {
    segment_.emplace_back(line_[j] ? static_cast<const collocation::System*>(&mechanics_->line) : &mechanics_->free,
                          k_);
    const double pieces = next();
    if (!(pieces >= 1.0 && pieces < 1e6) || !(S_[j + 1] > S_[j])) return false;
    std::vector<double> s;
    for (int i = 0; i <= pieces; ++i) s.push_back(next());
    if (!ok) return false;
    auto& seg = segment_.back();
    seg.initialise_on(S_[j], S_[j + 1], std::span(s).subspan(1, s.size() - 2), [](double, double* u, double* q) {
      std::fill_n(u, FreeRod::inputs, 0.0);
      q[0] = 0.0;
    });
    for (double& z : seg.states_data()) z = next();
    for (double& w : seg.local()) w = next();
  }
  if (!ok) return false;
  multiplier_ = 0.0;
  choose_phase();
  number();
  return true;
}

}  // namespace tendril::segmentation

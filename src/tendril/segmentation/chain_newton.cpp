// Newton's method over the whole chain: affine-invariant damping with simplified steps, or the residual line search;
// and the refinement of the meshes to the tolerance.
#include <algorithm>
#include <cmath>

#include "tendril/numerics/line_search.hpp"
#include "tendril/segmentation/chain.hpp"

namespace tendril::segmentation {

namespace {

/// A kink of the third derivative this close to a mesh point (of L) is harmless; farther, the mesh is laid anew.
constexpr double knot_distance = 1e-7;
/// Steps on old factors go on while each is at most this fraction of the one before.
constexpr double simplified_contraction = 0.1;
/// A stretch that has lost all but this of its length, and is to lose more without the corrections becoming smaller, is
/// not there.
constexpr double vanished = 1e-2;
/// A correction that no longer contracts is rounding when it is this close to the estimate for it. The estimate takes
/// one rounding a row: its sums have some ten terms, and the largest correction is the worst of thousands.
constexpr double rounding_margin = 10.0;

}  // namespace

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
  // widths of the pieces may not collapse within one step
  auto width_limit = [&](const std::vector<double>& d) {
    double limit = 1.0;
    each_part([&](int j, int q, const collocation::Segment& s, double a, double b) {
      const double da = d[column_of_left(j, q)], db = d[column_of_right(j, q)];
      for (int i = 0; i < s.pieces(); ++i) {
        const double h = s.place(i + 1, a, b) - s.place(i, a, b);
        const double h1 = s.place(i + 1, a + da, b + db) - s.place(i, a + da, b + db);
        if (h1 < 0.3 * h) limit = std::min(limit, 0.7 * h / (h - h1));
      }
    });
    return limit;
  };
  // Without contraction: has the iteration come to rest at the rounding of its residuals? It is part of the error then.
  // At most 1e-7 by default: with a tenth of that a contact about to merge is no longer followed to its event, without
  // any bound an event beside a singular state is located to 2e-8.
  rounding_ = 0.0;
  const double rounding_most = std::max(1e-9, 1e4 * options.tolerance);
  const auto at_rest = [&](double norm) {
    if (!(norm < rounding_most && norm <= rounding_margin * rounding_level())) return false;
    rounding_ = norm;
    return true;
  };
  const std::vector<double> places = S_;
  const auto shrinks_away = [&](const std::vector<double>& d) {
    for (int j = 1; j + 1 < segments(); ++j) {
      const double now = S_[j + 1] - S_[j], then = now + d[column_of_S(j + 1)] - d[column_of_S(j)];
      if (now < vanished * (places[j + 1] - places[j]) && then < 0.3 * now) return true;
    }
    return false;
  };
  double damping = 1.0, last_norm = 0.0;
  if (options.keep_factors && factored_ && blocks_.back() == closure_columns(closure)) {
    // The last factors still contract nearby: steps that cost a residual each. Without success, all is as before.
    std::vector<double> start;
    gather_all(start);
    double previous = HUGE_VAL;
    while (residual(closure, rhs_)) {
      ++sum.iterations;
      bar.assign(unknowns(), 0.0);
      lu_.solve(rhs_, bar);
      const double norm = scaled_norm(bar);
      if (!(norm < simplified_contraction * previous) || !std::isfinite(norm)) break;
      unscale(bar);
      if (width_limit(bar) < 1.0) break;
      local_changes(bar, dwbar);
      gather(x0);
      gather_local(wt);
      for (std::size_t i = 0; i < wt.size(); ++i) wt[i] += dwbar[i];
      apply(x0, wt, bar, 1.0);
      previous = norm;
      if (norm <= options.tolerance) {
        sum.converged = true;
        sum.correction = norm;
        return sum;
      }
    }
    scatter_all(start);
  }
  const int kept = sum.iterations;
  for (; sum.iterations < kept + options.max_iterations;) {
    if (options.stop.asked()) {
      sum.correction = last_norm;
      sum.reason = options.stop.reason();
      return sum;
    }
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
    if (limit < 1.0 && norm > 0.5 * last_norm && shrinks_away(dx)) {
      sum.correction = norm;
      sum.reason = "a segment shrinks away";
      return sum;
    }
    damping = std::min({1.0, limit, damping});
    if (damping < options.min_damping) {
      sum.correction = norm;
      sum.converged = at_rest(norm);
      if (!sum.converged) sum.reason = "the damped Newton iteration found no acceptable step";
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
      if (damping > 0.99 && contraction > 0.3 && std::isfinite(bar_norm) && at_rest(norm)) {
        sum.converged = true;
        sum.correction = norm;
        return sum;
      }
      const bool descends =
          options.residual_line_search ? search.sufficient(damping, merit_) : contraction < 1.0 - 0.25 * damping;
      if (descends) {
        accepted = true;
        last_norm = norm;
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
        if (at_rest(norm)) {
          sum.converged = true;
          return sum;
        }
        sum.reason = "the damped Newton iteration found no acceptable step";
        return sum;
      }
    }
  }
  sum.correction = last_norm;
  sum.reason = "no convergence within the allowed number of iterations";
  return sum;
}

bool Chain::cuts_hold() const {
  bool hold = true;
  const auto& pieces = mechanics_->problem.law.pieces;
  each_part([&](int j, int q, const collocation::Segment& s, double, double) {
    constexpr double slack = 1e-9;
    const auto& law = pieces[segment_[j].law(q)];
    const int last = s.states() - 1;
    hold = hold && s.state(0)[last] > law.from - slack && s.state(s.pieces())[last] < law.to + slack;
  });
  return hold;
}

bool Chain::marks_kept() const {
  const ScaledProblem& P = mechanics_->problem;
  if (!P.marked()) return true;
  const double S0 = S_.front(), Sn = S_.back(), s0 = segment_.front().state(0)[segment_.front().states() - 1],
               sn = segment_.back().state(segment_.back().pieces())[segment_.back().states() - 1];
  int wanted = 0, kept = 0;
  for (const auto& l : P.point_loads) wanted += l.on_rod ? l.at > s0 && l.at < sn : l.at > S0 && l.at < Sn;
  for (const auto& c : P.collars) wanted += c.s > s0 && c.s < sn;
  for (const CutSegment& s : segment_)
    for (int q = 0; q + 1 < s.parts(); ++q) kept += (s.cut(q).load >= 0) + (s.cut(q).collar >= 0);
  return wanted == kept;
}

bool Chain::cross_cut(const Chain& before, const Closure& closure, const NewtonOptions& options, NewtonSummary& sum) {
  constexpr double narrow = 0.1, overshoot = 0.02;  // of the segments beside the junction
  for (int k = 1; k < segments(); ++k)
    for (const int side : {-1, 1}) {
      const CutSegment& s = segment_[side < 0 ? k - 1 : k];
      if (s.parts() < 2) continue;
      const double cut = s.cut(side < 0 ? s.parts() - 2 : 0).S;
      const double beside = side < 0 ? S_[k] - S_[k - 1] : S_[k + 1] - S_[k];
      if (std::abs(cut - S_[k]) > narrow * beside) continue;
      Pattern q = before.pattern();
      q.S[k - 1] = cut + side * overshoot * beside;
      Chain other = before.recut(q);
      sum = other.solve(closure, options);
      if (!sum.converged) continue;
      *this = std::move(other);
      return true;
    }
  return false;
}

double Chain::error_ratio(int j, int part, std::vector<double>& ratio, double tolerance) const {
  const auto& s = segment_[j].part(part);
  std::vector<double> e;
  s.estimate_error(segment_[j].left(part, S_[j]), segment_[j].right(part, S_[j + 1]), e);
  const StateScale& t = typical_;
  const double free[19] = {t.d0, t.d1, t.d2, 0, t.d0, t.d1, t.d2, 0, 1.0, t.turn1, 0, t.F, 0, t.F, 0, t.F, 0, 1.0, 0};
  const double near[17] = {1.0, t.b1, t.b2, 0, t.d0, t.d1, t.d2, 0, 1.0, t.turn1, 0, t.F, 0, t.F, 0, t.F, 0};
  const double line[13] = {1.0, t.b1, t.b2, 0, 1.0, t.turn1, 0, t.F, 0, t.F, 0, 1.0, 0};
  const int n = s.system().inputs;
  ratio.assign(s.pieces(), 0.0);
  double most = 0.0;
  for (int i = 0; i < s.pieces(); ++i) {
    for (int q = 0; q < n; ++q) {
      const double scale = line_[j] ? line[q] : near_wall(j) ? near[q] : free[q];
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
  error_ = rounding_;
  each_part([&](int j, int q, const collocation::Segment&, double, double) {
    error_ = std::max(error_, error_ratio(j, q, ratio, 1.0));
  });
  return error_;
}

void Chain::relay(double tolerance, const Chain* like) {
  typical();
  std::vector<double> ratio;
  each_part([&](int j, int q, const collocation::Segment&, double a, double b) {
    (like ? *like : *this).error_ratio(j, q, ratio, tolerance);
    segment_[j].part(q).adapt(a, b, mechanics_->problem.knots, ratio, 4.0);
  });
  for (auto& s : segment_) s.count();
  number();
  if (phase_) choose_phase(), number();
}

NewtonSummary Chain::solve_adaptive(const Closure& closure, const NewtonOptions& options, double tolerance) {
  NewtonSummary total;
  for (int round = 0; round < 8; ++round) {
    const bool may_hold = round > 0 && segments() > 1 && !any_held();
    const bool varies = mechanics_->problem.varies();
    const Chain before = may_hold || varies ? *this : Chain();
    NewtonSummary s = solve(closure, options);
    total.iterations += s.iterations;
    total.factorisations += s.factorisations;
    if (!s.converged && options.stop.asked()) {
      total.reason = s.reason;
      return total;
    }
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
    const bool may_recut = varies && closure.kind != Closure::Kind::unknown;  // a column means another unknown then
    if (!s.converged && may_recut && cross_cut(before, closure, options, s)) {
      total.iterations += s.iterations;
      total.factorisations += s.factorisations;
    }
    total.converged = s.converged;
    total.correction = s.correction;
    total.reason = s.reason;
    if (!s.converged) return total;
    if (varies && !(cuts_hold() && marks_kept())) {
      if (round >= 5 || !may_recut) {
        total.converged = false;
        total.reason = mechanics_->problem.marked()
                           ? "a contact comes to lie under a point load, or beside a collar or a break of the section"
                           : "a contact does not settle on either side of a break of the rod's section";
        return total;
      }
      *this = recut(pattern());
      continue;
    }
    typical();
    std::vector<std::vector<double>> ratio;  // of every part
    double most = 0.0;
    bool aligned = true;
    const auto& knots = mechanics_->problem.knots;
    each_part([&](int j, int q, const collocation::Segment& s, double a, double b) {
      ratio.emplace_back();
      most = std::max(most, error_ratio(j, q, ratio.back(), tolerance));
      aligned = aligned && s.aligned(a, b, knots, knot_distance);
    });
    error_ = most * tolerance;
    if (most <= 1.0 && (aligned || round >= 3)) return total;
    std::size_t at = 0;
    each_part([&](int j, int q, const collocation::Segment&, double a, double b) {
      segment_[j].part(q).adapt(a, b, knots, ratio[at++], 4.0);
    });
    for (auto& s : segment_) s.count();
    choose_coordinates();
    number();
    if (phase_) choose_phase(), number();
  }
  total.converged = false;
  total.reason = "the mesh could not be refined to the tolerance";
  return total;
}

}  // namespace tendril::segmentation

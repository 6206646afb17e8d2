#include "tendril/continuation/path_follower.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "tendril/continuation/path_detail.hpp"
#include "tendril/continuation/report_state.hpp"
#include "tendril/segmentation/certificate.hpp"
#include "tendril/segmentation/flat_lines.hpp"
#include "tendril/segmentation/tip.hpp"

namespace tendril::continuation {

using segmentation::Chain;
using segmentation::CheckKind;
using segmentation::Closure;
using segmentation::Margin;
using segmentation::Pattern;

namespace {

double now_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

bool on_axis(const Chain& c) { return c.segments() == 1 && !c.is_line(0) && !c.turns_freely(); }

constexpr int max_folds = 6;  // per stretch
// a branch that has come back this far (of the parameter's size) after a limit point does not lead to the target
constexpr double largest_retreat = 0.25;

}  // namespace

PathFollower::PathFollower(Chain chain, FollowOptions options,
                           std::function<std::shared_ptr<segmentation::Mechanics>(double)> rebuild)
    : chain_(std::move(chain)), options_(std::move(options)), rebuild_(std::move(rebuild)) {
  clock_start_ = now_seconds();
  trace.push_back(trace_point(chain_));
}

void PathFollower::note(const segmentation::NewtonSummary& s) {
  total_.newton_iterations += s.iterations;
  total_.factorisations += s.factorisations;
}

bool PathFollower::correct(Chain& c, const Closure& closure, bool adaptive) {
  if (rebuild_) c.rebind(rebuild_(closure.value));
  if (segmentation::has_flat_line(c) && !c.any_held()) return correct_beside(c, closure, adaptive);
  auto newton = options_.switcher.newton;
  newton.keep_factors = adaptive;  // ordinary steps begin on the last factors; events are closed in on with fresh ones
  const auto s = adaptive ? c.solve_adaptive(closure, newton, options_.switcher.accuracy) : c.solve(closure, newton);
  note(s);
  if (!s.converged) total_.reason = s.reason;
  return s.converged;
}

void PathFollower::record(const std::string& kind, double S, const Chain& c) {
  const TracePoint t = trace_point(c);
  Event e;
  e.parameter = t.parameter;
  e.kind = kind;
  e.S = S;
  e.rod_length = t.rod_length;
  e.axial_force_end = t.axial_force_end;
  for (int k = 0; k + 1 < c.segments(); ++k) e.contact_force += std::abs(segmentation::reaction(c, k));
  for (int j = 0; j < c.segments(); ++j)
    if (c.is_line(j)) e.contact_force += segmentation::line_force(c, j).magnitude;
  if (c.tip_rests()) e.contact_force += std::abs(segmentation::tip_state(c).reaction);
  events.push_back(e);
}

FollowSummary PathFollower::to(double target) {
  total_ = {};
  auto finish = [&](bool reached, const std::string& reason, const std::string& kind) {
    total_.reached = reached;
    total_.reason = reached ? "" : reason;
    total_.kind = kind;
    return total_;
  };
  const double p_start = chain_.parameter();
  const double range = std::abs(target - p_start);
  if (range == 0.0) return finish(true, "", "");
  const double p_scale = std::max({std::abs(target), std::abs(p_start), range});
  p_unit_ = std::min(p_scale, 4.0 * range);  // a rod's length changes by a trifle while its shape changes entirely
  direction_ = target > p_start ? 1 : -1;
  const int goal = direction_;
  previous_.clear();
  int events_without_progress = 0, folds = 0, crawling = 0;
  double p_farthest = p_start;
  double last_event_p = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> x1, tangent, scale;
  for (int step = 0; step < options_.max_steps; ++step) {
    if (options_.stop && options_.stop->load()) {
      total_.interrupted = true;
      return finish(false, "interrupted", "failure");
    }
    if (options_.max_seconds > 0.0 && now_seconds() - clock_start_ > options_.max_seconds) {
      total_.interrupted = true;
      return finish(false, "the time limit was reached", "failure");
    }
    chain_.set_parameter_scale(p_unit_);
    chain_.gather_all(x1);
    // direction of the path: secant if there is one on this mesh, else the tangent
    Closure closure{Closure::Kind::parameter, 0, chain_.parameter()};
    std::vector<double> d;
    bool have_tangent = false;
    const int n = chain_.unknowns();
    if (!previous_.empty() && previous_.size() == x1.size()) {
      d.resize(x1.size());
      for (std::size_t i = 0; i < d.size(); ++i) d[i] = x1[i] - previous_[i];
    } else if (segmentation::has_flat_line(chain_)) {  // no tangent there: a secant to a solved neighbour
      Chain ahead;
      double nudge = direction_ * std::min(1e-3 * p_unit_, 0.05 * range);
      for (int attempt = 0;; ++attempt, nudge *= 0.2) {
        ahead = chain_;
        if (correct(ahead, {Closure::Kind::parameter, 0, chain_.parameter() + nudge}, false)) break;
        if (attempt == 4) return finish(false, "the path cannot be continued: no neighbouring state", "failure");
      }
      ahead.gather_all(d);
      for (std::size_t i = 0; i < d.size(); ++i) d[i] -= x1[i];
    } else {
      previous_.clear();
      have_tangent = chain_.tangent(closure, tangent);
      if (!have_tangent) return finish(false, "the path cannot be continued: singular state", "failure");
      last_sign_ = chain_.determinant_sign();
      chain_.scales(scale);
      d = tangent;
      for (double& v : d) v *= direction_;
    }
    chain_.scales(scale);
    // the unknown that changes fastest, p preferred (p is natural and needs no switching); places S_k and p count fully
    const int ip = chain_.column_of_p();
    int hold = ip;
    double fastest = 0.0;
    for (int i = 0; i < n; ++i) fastest = std::max(fastest, std::abs(d[i]) / scale[i]);
    const bool flat = segmentation::has_flat_line(chain_);
    if (options_.arclength && !flat && std::abs(d[ip]) / scale[ip] < 0.1 * fastest)
      for (int i = 0; i < n; ++i)
        if (std::abs(d[i]) / scale[i] == fastest) {
          hold = i;
          break;
        }
    const double rate = fastest;
    // length of the step in units of d
    double length = std::min(options_.max_step, step_) / std::max(rate, 1e-300);
    bool landing = false;
    const double dp = d[ip] * length;
    const double to_go = target - chain_.parameter();
    if (dp * to_go > 0.0 && std::abs(dp) >= std::abs(to_go) - 1e-12 * p_scale) {
      length = (target - chain_.parameter()) / d[ip];
      landing = true;
      hold = ip;
    }
    if (hold == ip)
      closure.kind = Closure::Kind::parameter;
    else {
      closure.kind = Closure::Kind::unknown;
      closure.index = hold;
    }
    Chain next = chain_;
    bool ok = false, collapsed = false;
    long before = total_.newton_iterations;
    for (int attempt = 0; attempt < 14 && !ok; ++attempt) {
      next.scatter_all(x1);
      if (have_tangent) {
        next.advance(tangent, direction_ * length);
      } else {
        std::vector<double> x(x1);
        for (std::size_t i = 0; i < x.size(); ++i) x[i] += length * d[i];
        next.scatter_all(x);
      }
      closure.value = landing ? target : (hold == ip ? next.parameter() : x1[hold] + length * d[hold]);
      before = total_.newton_iterations;
      ok = correct(next, closure, false);
      if (ok) {  // a step that turned back or jumped elsewhere is not a step along this path
        std::vector<double> y;
        next.gather(y);
        double change = 0.0;
        for (int i = 0; i < n; ++i) change = std::max(change, std::abs(y[i] - x1[i]) / scale[i]);
        if (change > 4.0 * length * rate + 1e-6) ok = false;
      }
      if (!ok) {
        length *= 0.35;
        landing = false;
      }
      // a stretch about to vanish makes the equations singular: take it out where that is the next event
      if (!ok && (attempt == 3 || attempt == 9)) {
        chain_.scatter_all(x1);
        collapsed = collapse_shortest();
        if (collapsed) break;
      }
    }
    if (!ok && collapsed) {
      previous_.clear();
      step_ = 0.01;
      trace.push_back(trace_point(chain_));
      continue;
    }
    if (!ok) {
      return finish(false, total_.reason.empty() ? "no step along the path converges" : total_.reason, "failure");
    }
    // a step in another unknown may pass the target: land on it instead
    if (!landing && (next.parameter() - target) * goal > 0.0 && (target - chain_.parameter()) * goal > 0.0) {
      std::vector<double> y;
      next.gather_all(y);
      const double f = (target - x1[ip]) / (y[ip] - x1[ip]);
      for (std::size_t i = 0; i < y.size(); ++i) y[i] = x1[i] + f * (y[i] - x1[i]);
      Chain landed = next;
      landed.scatter_all(y);
      if (correct(landed, {Closure::Kind::parameter, 0, target}, false)) {
        next = landed;
        landing = true;
        closure = {Closure::Kind::parameter, 0, target};
      }
    }
    const long iterations = total_.newton_iterations - before;
    step_ = std::clamp(length * rate *
                           (flat              ? 1.6
                            : iterations <= 5 ? 1.8
                            : iterations <= 8 ? 1.2
                                              : 0.6),
                       1e-7, options_.max_step);
    // unilateral conditions on the new state
    std::vector<double> x2;
    next.gather_all(x2);
    auto bad = segmentation::violations(next, segmentation::margins(next), options_.switcher.tolerance);
    if (!bad.empty()) {
      chain_.scatter_all(x1);
      const auto here = segmentation::margins(chain_);
      auto first_of = [&](const std::vector<Margin>& list, const std::vector<Margin>& reference) {
        const Margin* first = nullptr;
        double when = HUGE_VAL;
        for (const Margin& m : list) {
          const Margin* r = same_condition(reference, m);
          const double t = r && r->value > 0.0 ? r->value / (r->value - m.value) : 0.5;
          if (t < when) {
            when = t;
            first = &m;
          }
        }
        return first;
      };
      Margin event = *first_of(bad, here);
      Chain at = next;
      std::vector<double> upper = x2;
      bool located = false;
      for (int round = 0; round < 6; ++round) {
        Margin m = event;
        Chain candidate = next;
        if (!locate(x1, upper, candidate, m, closure)) break;
        const auto also =
            segmentation::violations(candidate, segmentation::margins(candidate), options_.switcher.tolerance);
        const Margin* earlier = nullptr;
        for (const Margin& v : also)
          if (!(v.kind == m.kind && v.index == m.index && std::abs(v.S - m.S) < 1e-3)) {
            earlier = &v;
            break;
          }
        at = candidate;
        event = m;
        located = true;
        if (!earlier) break;
        candidate.gather_all(upper);
        event = *earlier;
      }
      if (!located) {
        step_ *= 0.3;
        if (step_ < 1e-6) return finish(false, "a change of the contact pattern could not be located", "failure");
        previous_.clear();
        continue;
      }
      // guard against changing back and forth at one place
      const double p_event = at.parameter();
      events_without_progress = std::abs(p_event - last_event_p) < 1e-9 * p_scale ? events_without_progress + 1 : 0;
      last_event_p = p_event;
      if (events_without_progress > 6)
        return finish(false, "the contact pattern alternates without progress", "failure");
      const double dp_here = x2[ip] - x1[ip];
      direction_ = dp_here > 0.0 ? 1 : dp_here < 0.0 ? -1 : direction_;
      // conditions that vanish at the same load (symmetry) change together; from the far end, so that indices stay
      // valid
      std::vector<Margin> together{event};
      if (event.kind == CheckKind::span) {
        for (int j = 1; j + 1 < at.segments(); ++j) {
          const double span = at.S(j + 1) - at.S(j);
          if (j != event.index && std::abs(span - event.raw) < 1e-3 * event.raw)
            together.push_back({CheckKind::span, j, 0.5 * (at.S(j) + at.S(j + 1)), span, span, 0.0});
        }
      } else
        for (const Margin& x : segmentation::margins(at))
          if (x.kind == event.kind && std::abs(x.value) < 1e-7 &&
              !(x.index == event.index && std::abs(x.S - event.S) < 1e-6) &&
              std::none_of(together.begin(), together.end(),
                           [&](const Margin& y) { return y.index == x.index && std::abs(y.S - x.S) < 1e-6; }))
            together.push_back(x);
      std::sort(together.begin(), together.end(),
                [](const Margin& a, const Margin& b) { return a.index != b.index ? a.index > b.index : a.S > b.S; });
      if (!change_pattern(at, together)) {
        chain_ = at;
        return finish(false,
                      total_.reason.empty() ? "the changed contact pattern has no solution nearby" : total_.reason,
                      "failure");
      }
      previous_.clear();
      step_ = std::min(step_, 0.02);
      trace.push_back(trace_point(chain_));
      // a seeded stretch of finite length may lie beyond the target: come back to it on the new branch
      if ((at.parameter() - target) * (chain_.parameter() - target) < 0.0)
        direction_ = target > chain_.parameter() ? 1 : -1;
      continue;
    }
    // fold: the parameter turns back
    const double dp_now = x2[ip] - x1[ip];
    if (!previous_.empty() && options_.arclength) {
      const double dp_old = x1[ip] - previous_[ip];
      if (dp_old * dp_now < 0.0) {
        record("fold", 0.0, locate_fold(previous_, x2, next));
        if (++folds > max_folds) return finish(false, "the path turns back and forth", "failure");
      }
    }
    if (dp_now != 0.0) direction_ = dp_now > 0.0 ? 1 : -1;
    // branch point: the determinant at fixed parameter changes sign although the parameter does not turn back
    int sign = 0;
    if (options_.arclength && !flat &&
        (closure.kind == Closure::Kind::parameter ||
         next.tangent({Closure::Kind::parameter, 0, next.parameter()}, tangent)))
      sign = next.determinant_sign();
    const bool turned = !previous_.empty() && (x1[ip] - previous_[ip]) * dp_now < 0.0;
    bool crossed = !turned && sign * last_sign_ < 0;
    last_sign_ = sign;
    // on the axis of an axisymmetric problem the rod buckles in two planes at once
    const auto& problem = chain_.mechanics().problem;
    const bool twofold = problem.axisymmetric && !problem.planar && options_.arclength;
    if (twofold && last_count_ < 0 && on_axis(chain_)) last_count_ = unstable_directions(chain_);
    const int count = twofold && on_axis(next) ? unstable_directions(next) : -1;
    if (!turned && count >= 0 && last_count_ >= 0 && count != last_count_) crossed = true;
    last_count_ = count;
    const auto branching = crossed ? locate_branch_point(x1, x2, next) : std::nullopt;
    if (branching) {
      record("branch_point", 0.0, *branching);
      bool left = false;
      if (options_.stable && !options_.stable(next))
        for (const double amplitude : {0.02, -0.02, 0.005, -0.005}) {
          const auto other = branch_off(*branching, amplitude);
          // one that turns back is unstable under its load, if by too little to be counted
          if (!other || (other->parameter() - branching->parameter()) * direction_ <= 0.0) continue;
          if (!options_.stable(*other)) continue;
          if (!segmentation::violations(*other, segmentation::margins(*other), options_.switcher.tolerance).empty())
            continue;
          chain_ = *other;
          left = true;
          break;
        }
      if (left) {
        previous_.clear();
        last_count_ = -1;
        step_ = 0.01;
        trace.push_back(trace_point(chain_));
        continue;
      }
      if (options_.leave_branch) {
        if (auto stable = options_.leave_branch(next)) {
          const double before_length = trace_point(next).rod_length, after_length = trace_point(*stable).rod_length;
          if (std::abs(after_length - before_length) > 1e-3 * before_length) record("jump", 0.0, *branching);
          chain_ = *stable;
          previous_.clear();
          step_ = 0.01;
          trace.push_back(trace_point(chain_));
          if (landing) return finish(true, "", "");
          continue;
        }
      }
    }
    previous_ = x1;
    chain_ = next;
    crawling = length * rate < 2e-3 ? crawling + 1 : 0;
    if (crawling >= 12 && collapse_shortest()) {
      crawling = 0;
      previous_.clear();
      step_ = 0.01;
      trace.push_back(trace_point(chain_));
      continue;
    }
    trace.push_back(trace_point(chain_));
    if (landing) {
      const double e = chain_.estimate_error();
      if (e > options_.switcher.accuracy) {
        if (!correct(chain_, {Closure::Kind::parameter, 0, target}, true))
          return finish(false, total_.reason, "failure");
        previous_.clear();
      }
      return finish(true, "", "");
    }
    // keep the mesh fit for the tolerance
    const double e = chain_.estimate_error();
    if (e > options_.switcher.accuracy || (segmentation::has_flat_line(chain_) && doubt_ > 1e-7)) {
      Closure keep{Closure::Kind::parameter, 0, chain_.parameter()};
      if (!correct(chain_, keep, true)) return finish(false, total_.reason, "failure");
      previous_.clear();
    }
    const double farthest =
        (goal > 0 ? std::max(p_farthest, chain_.parameter()) : std::min(p_farthest, chain_.parameter()));
    p_farthest = farthest;
    if ((farthest - chain_.parameter()) * goal > largest_retreat * p_scale)
      return finish(false, "the branch turns back at a limit point at parameter " + std::to_string(farthest),
                    "failure");
  }
  return finish(false, "the path did not reach its target within the allowed number of steps", "failure");
}

}  // namespace tendril::continuation

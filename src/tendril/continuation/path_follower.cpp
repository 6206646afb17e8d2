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

constexpr int max_folds = 6;  // per stretch
// a branch that has come back this far (of the parameter's size) after a limit point does not lead to the target
constexpr double largest_retreat = 0.25;

}  // namespace

PathFollower::PathFollower(Chain chain, FollowOptions options,
                           std::function<std::shared_ptr<segmentation::Mechanics>(double)> rebuild)
    : chain_(std::move(chain)), options_(std::move(options)), rebuild_(std::move(rebuild)) {
  clock_start_ = std::isnan(options_.begun) ? now_seconds() : options_.begun;
  trace.push_back(trace_point(chain_));
}

void PathFollower::note(const segmentation::NewtonSummary& s) {
  total_.newton_iterations += s.iterations;
  total_.factorisations += s.factorisations;
}

bool PathFollower::correct(Chain& c, const Closure& closure, bool adaptive, bool keep_factors) {
  if (rebuild_) c.rebind(rebuild_(closure.value));
  if (segmentation::has_flat_line(c) && !c.any_held()) return correct_beside(c, closure, adaptive);
  auto newton = options_.switcher.newton;
  newton.keep_factors = adaptive || keep_factors;  // events are closed in on with fresh ones
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

FollowSummary PathFollower::ended(const std::string& reason, const std::string& kind) {
  total_.reached = false;
  total_.reason = reason;
  total_.kind = kind;
  const numerics::Stop& stop = options_.switcher.newton.stop;
  if (kind != "failure" || !stop.asked()) return total_;
  // whatever failed did so because it was stopped
  total_.reason = stop.reason();
  total_.interrupted = stop.interrupted();
  if (!total_.interrupted) total_.kind = "time";
  return total_;
}

FollowSummary PathFollower::to(double target) {
  total_ = {};
  const double p_start = chain_.parameter();
  const double range = std::abs(target - p_start);
  total_.reached = range == 0.0;
  if (total_.reached) return total_;
  const double p_scale = std::max({std::abs(target), std::abs(p_start), range});
  p_unit_ = std::min(p_scale, 4.0 * range);  // a rod's length changes by a trifle while its shape changes entirely
  const int goal = target > p_start ? 1 : -1;
  direction_ = goal;
  start_anew(step_);
  folds_ = events_here_ = 0;
  int crawling = 0;
  double farthest = p_start;
  for (int count = 0; count < options_.max_steps; ++count) {
    if (options_.stop && options_.stop->load()) {
      total_.interrupted = true;
      return ended("interrupted", "failure");
    }
    if (options_.max_seconds > 0.0 && now_seconds() - clock_start_ > options_.max_seconds)
      return ended("the time limit of " + figure(options_.max_seconds) + " s was reached", "time");
    Step step;
    total_.reason.clear();
    FollowSummary out;
    bool taken = take_step(target, step);
    Vanishing vanishing = Vanishing::none;
    for (int round = 0; round < 3 && !taken && vanishing == Vanishing::none; ++round) {
      const std::string why = total_.reason.empty() ? "no step along the path converges" : total_.reason;
      vanishing = at_vanishing(target, out);  // that of a short stretch makes the equations singular
      total_.reason = why;
      if (vanishing == Vanishing::none && round < 2) taken = take_step(target, step);
    }
    if (vanishing == Vanishing::landed) return arrive(target);
    if (vanishing == Vanishing::finished) return out;
    if (vanishing == Vanishing::changed) continue;
    if (!taken) return ended(total_.reason, "failure");
    const int ip = step.next.column_of_p();
    // the nearest of what lies within the step: a limit point, a branch point, a condition violated
    const bool turned = heading_.rate * step.heading.rate < 0.0 && options_.arclength;
    if (turned) {
      Chain fold = locate_fold(step.x1, step.x2, step.next);
      if (segmentation::violations(fold, segmentation::margins(fold), options_.switcher.tolerance).empty()) {
        if ((fold.parameter() - target) * (step.x1[ip] - target) < 0.0) {  // the target lies before the fold
          Step part = step;
          part.next = fold;
          fold.gather_all(part.x2);
          if (part.x2.size() == part.x1.size() && land_between(target, part)) {
            chain_ = part.next;
            trace.push_back(trace_point(chain_));
            return arrive(target);
          }
        }
        const Next next = at_fold(step, fold, target, out);
        if (next == Next::finished) return out;
        if (next == Next::elsewhere) continue;
        if (++folds_ > max_folds) return ended("the path turns back and forth", "failure");
      } else {
        step.next = fold;
        fold.gather_all(step.x2);
        step.landing = false;
        std::vector<double> forward(step.x2);
        for (std::size_t i = 0; i < forward.size(); ++i) forward[i] -= step.x1[i];
        step.crossed = false;
      }
    }
    if (step.crossed) {
      if (const auto branching = locate_branch_point(step.x1, step.x2, step.next)) {
        if (segmentation::violations(*branching, segmentation::margins(*branching), options_.switcher.tolerance)
                .empty()) {
          record("branch_point", 0.0, *branching);
          if (at_branch_point(*branching, step, target)) continue;
        }
      } else if (step.length > 1e-4 && last_count_ < 0) {  // the sign turned without a branch point: a leap
        step_ = 0.3 * step.length;
        continue;
      }
    }
    auto bad = segmentation::violations(step.next, segmentation::margins(step.next), options_.switcher.tolerance);
    if (std::any_of(bad.begin(), bad.end(), [](const Margin& m) { return m.kind == CheckKind::span; })) {
      vanishing = at_vanishing(target, out);
      if (vanishing == Vanishing::landed) return arrive(target);
      if (vanishing == Vanishing::finished) return out;
      if (vanishing == Vanishing::changed) continue;
      // short, but there
      if (step.landing) std::erase_if(bad, [](const Margin& m) { return m.kind == CheckKind::span; });
    }
    if (!bad.empty()) {
      if (at_violation(target, step, std::move(bad), out) == Next::finished) return out;
      continue;
    }
    const double dp = step.x2[ip] - step.x1[ip];
    if (step.heading.rate != 0.0)
      direction_ = step.heading.rate > 0.0 ? 1 : -1;
    else if (dp != 0.0)
      direction_ = dp > 0.0 ? 1 : -1;
    previous_ = std::move(step.x1);
    chain_ = std::move(step.next);
    heading_ = std::move(step.heading);
    trace.push_back(trace_point(chain_));
    if (step.landing) return arrive(target);
    crawling = step.length < 2e-3 ? crawling + 1 : 0;
    if (crawling >= 12) {
      crawling = 0;
      vanishing = at_vanishing(target, out);
      if (vanishing == Vanishing::landed) return arrive(target);
      if (vanishing == Vanishing::finished) return out;
      if (vanishing == Vanishing::changed) continue;
    }
    // keep the mesh fit for the tolerance
    const double e = chain_.estimate_error();
    if (e > options_.switcher.accuracy || (segmentation::has_flat_line(chain_) && doubt_ > 1e-7)) {
      if (!correct(chain_, {Closure::Kind::parameter, 0, chain_.parameter()}, true))
        return ended(total_.reason, "failure");
      start_anew(step_);
    }
    farthest = goal > 0 ? std::max(farthest, chain_.parameter()) : std::min(farthest, chain_.parameter());
    if ((farthest - chain_.parameter()) * goal > largest_retreat * p_scale)
      return ended("the branch turns back at parameter " + figure(farthest) + " and does not lead to the target",
                   "limit");
  }
  return ended("the path did not reach its target within the allowed number of steps", "failure");
}

PathFollower::Vanishing PathFollower::at_vanishing(double target, FollowSummary& out) {
  const Chain before = chain_;
  bool beyond = false;
  const Change change = collapse_shortest(target, beyond);
  if (change.done)
    return after_event(before, change, target, out) == Next::finished ? Vanishing::finished : Vanishing::changed;
  chain_ = before;
  return beyond && land_along_span(target) ? Vanishing::landed : Vanishing::none;
}

FollowSummary PathFollower::arrive(double target) {
  if (chain_.estimate_error() > options_.switcher.accuracy) {
    if (!correct(chain_, {Closure::Kind::parameter, 0, target}, true)) return ended(total_.reason, "failure");
    start_anew(step_);
  }
  total_.reached = true;
  total_.reason.clear();
  total_.kind.clear();
  return total_;
}

void PathFollower::settle(double target, double p_left) {
  start_anew(0.02);
  last_count_ = -1;
  trace.push_back(trace_point(chain_));
  // a state found a little farther on may lie beyond the target: it is come back to
  if ((p_left - target) * (chain_.parameter() - target) < 0.0) direction_ = target > chain_.parameter() ? 1 : -1;
}

PathFollower::Next PathFollower::at_violation(double target, Step& step, std::vector<Margin> bad, FollowSummary& out) {
  const int ip = chain_.column_of_p();
  chain_.scatter_all(step.x1);
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
  Chain at = step.next;
  std::vector<double> upper = step.x2;
  bool located = false, singular = false;
  for (int round = 0; round < 6; ++round) {
    Margin m = event;
    Chain candidate = step.next;
    if (!locate(step.x1, upper, candidate, m, step.closure)) break;
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
    singular = interpolated_;
    if (!earlier) break;
    candidate.gather_all(upper);
    event = *earlier;
  }
  if (!located) {
    start_anew(0.3 * std::min(step_, step.length));
    if (step_ >= 1e-6) return Next::go_on;
    out = ended("a change of the contact pattern could not be located", "failure");
    return Next::finished;
  }
  Chain sharp = at;
  if (!singular) sharpen(sharp, event);
  // guard against changing back and forth at one place
  const double p_event = sharp.parameter();
  events_here_ = std::abs(p_event - last_event_p_) < 1e-9 * std::max(p_unit_, std::abs(p_event)) ? events_here_ + 1 : 0;
  last_event_p_ = p_event;
  if (events_here_ > 6) {
    out = ended("the contact pattern alternates without progress", "failure");
    return Next::finished;
  }
  const double dp = step.x2[ip] - step.x1[ip];
  direction_ = dp > 0.0 ? 1 : dp < 0.0 ? -1 : direction_;
  // conditions that vanish at the same load (symmetry) change together; from the far end, so that indices stay valid
  std::vector<Margin> together{event};
  if (event.kind == CheckKind::span) {
    for (int j = 1; j + 1 < at.segments(); ++j) {
      const double span = at.S(j + 1) - at.S(j);
      if (j != event.index && std::abs(span - event.raw) < 1e-3 * event.raw)
        together.push_back({CheckKind::span, j, 0.5 * (at.S(j) + at.S(j + 1)), span, span, 0.0});
    }
  } else
    for (const Margin& x : segmentation::margins(sharp))
      if (x.kind == event.kind && std::abs(x.value) < 1e-7 &&
          !(x.index == event.index && std::abs(x.S - event.S) < 1e-6) &&
          std::none_of(together.begin(), together.end(),
                       [&](const Margin& y) { return y.index == x.index && std::abs(y.S - x.S) < 1e-6; }))
        together.push_back(x);
  std::sort(together.begin(), together.end(),
            [](const Margin& a, const Margin& b) { return a.index != b.index ? a.index > b.index : a.S > b.S; });
  const Chain before = chain_;
  total_.reason.clear();
  const Change change = change_pattern(at, sharp, together);
  if (!change.done) {
    chain_ = at;
    out =
        ended(total_.reason.empty() ? "the changed contact pattern has no solution nearby" : total_.reason, "failure");
    return Next::finished;
  }
  return after_event(before, change, target, out);
}

PathFollower::Next PathFollower::after_event(const Chain& before, const Change& change, double target,
                                             FollowSummary& out) {
  if (change.onward != 0 && change.onward != direction_) {
    // the load would have to go back
    const Next next = at_limit(before, change.event, "the change of contact", target, out);
    if (next != Next::go_on) return next;
    direction_ = change.onward;
  }
  settle(target, change.event.parameter());
  return Next::go_on;
}

}  // namespace tendril::continuation

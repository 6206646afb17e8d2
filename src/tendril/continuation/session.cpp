#include "tendril/continuation/session.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tendril/continuation/path_detail.hpp"
#include "tendril/continuation/report_state.hpp"
#include "tendril/continuation/study_detail.hpp"
#include "tendril/segmentation/cold_start.hpp"
#include "tendril/segmentation/collars.hpp"
#include "tendril/segmentation/pattern_edit.hpp"
#include "tendril/segmentation/tip.hpp"

namespace tendril::continuation {

using segmentation::AxialControl;
using segmentation::Chain;
using segmentation::CheckKind;
using segmentation::Closure;
using segmentation::Margin;
using segmentation::Mechanics;
using segmentation::Pattern;
using segmentation::Problem;
using segmentation::Scalar;

namespace {

constexpr int finest = 6;  // halvings of a step before the rod is taken to jump
/// A state farther than this (of the clearance) from where the trend leads is sought with a smaller step.
constexpr double far_from_trend = 0.25;
/// Mesh points are brought back to the axis' own until they lie this close (of L).
constexpr double knot_distance = 1e-8;
/// Changes of a guessed pattern before it is given up.
constexpr int most_guessed = 12;
/// A free stretch before the tip that is shorter (of L) has all but gone: what is left without it is tried first.
constexpr double gone = 5e-4;
/// Meshes are laid to this share of the tolerance.
constexpr double mesh_share = 0.3;

/// Where the rod lies: to be compared with another state.
class Course {
 public:
  explicit Course(const Chain& chain) : end_(chain.S(chain.segments())) {
    double u[formulation::state_inputs];
    for (int i = 0; i <= places; ++i) {
      chain.sample(end_ * i / places, u, nullptr);
      at_[i] = {u[0], u[4]};
    }
  }
  /// Largest distance at equal S, of the clearance.
  double distance(const Chain& chain) const {
    const double end = chain.S(chain.segments());
    double most = 0.0, u[formulation::state_inputs];
    for (int i = 0; i <= places && end_ * i / places <= end; ++i) {
      chain.sample(end_ * i / places, u, nullptr);
      most = std::max(most, std::hypot(u[0] - at_[i][0], u[4] - at_[i][1]));
    }
    return most / chain.mechanics().problem.clearance_max;
  }

 private:
  static constexpr int places = 64;
  double end_;
  std::array<std::array<double, 2>, places + 1> at_;
};

/// Patterns to be tried where the rod cannot go on with its own: that one from a start of its own, and what a free
/// stretch before the tip that shrinks away leaves. There the states of both sides are one only in the limit.
std::vector<Pattern> patterns_nearby(const Chain& c) {
  const Pattern q = c.pattern();
  std::vector<Pattern> out{q};
  if (!segmentation::open_across(c.mechanics().problem) || q.line.back()) return out;
  Pattern other = q;
  other.tip = !q.tip;
  const double span = c.S(c.segments()) - c.S(c.segments() - 1);
  out.insert(span < gone ? out.begin() : out.end(), other);
  if (q.line.size() > 1 && !q.line[q.line.size() - 2]) {  // the last point goes into the tip
    other = segmentation::remove_point(q, static_cast<int>(q.S.size()) - 1);
    other.tip = true;
    out.push_back(other);
  }
  return out;
}

}  // namespace

std::shared_ptr<Mechanics> Session::mechanics(int moving) const {
  Problem p = problem_;
  const Scalar fed(value_[0], moving == 0 ? 1.0 : 0.0);
  (feed_ == Feed::length ? p.axial_value : p.end_position) = fed;
  auto& inlet = p.twist_at == segmentation::Which::start ? p.twist_value : p.start.roll;
  inlet = Scalar(value_[1], moving == 1 ? 1.0 : 0.0);
  return std::make_shared<Mechanics>(p, value_[moving]);
}

Session::Session(const Problem& problem, const StudyOptions& options)
    : problem_(problem), options_(options), switcher_(switcher_options(options.solve)) {
  switcher_.newton.stop = {options.stop, options.solve.max_seconds, numerics::Stop::Clock::now()};
  for (Scalar* s : {&problem_.axial_value, &problem_.end_position, &problem_.twist_value, &problem_.start.roll})
    s->rate = 0.0;
  auto first = std::make_shared<Mechanics>(problem_, 0.0);
  const auto accept = [](const Chain& c) { return judge_stability(c).word != "unstable"; };
  const auto start = segmentation::cold_start(first, options_.solve, switcher_, accept);
  if (!start.converged) {
    reason_ = "no state found at the start: " + start.reason;
    return;
  }
  chain_ = start.chain;
  how_ = start.branch;
  const double L = first->problem.L;
  const bool free = first->problem.tip_free();
  feed_ = free || problem_.axial == AxialControl::rod_length ? Feed::length : Feed::position;
  if (free && problem_.axial != AxialControl::rod_length) {  // from here on the length is what is given
    const TracePoint t = trace_point(chain_);
    problem_.axial = AxialControl::rod_length;
    problem_.axial_value = t.rod_length * L;
  }
  value_[0] = feed_ == Feed::length ? problem_.axial_value.value
                                    : (problem_.end_position.value > 0.0 ? problem_.end_position.value : L);
  value_[1] = problem_.twist_at == segmentation::Which::start ? problem_.twist_value.value : problem_.start.roll.value;
  chain_.rebind(mechanics(0));
  chain_.set_parameter(value_[0]);
  chain_.set_parameter_scale(std::max(std::abs(value_[0]), 1e-3 * L));
  if (!chain_.solve({Closure::Kind::parameter, 0, value_[0]}, switcher_.newton).converged)
    reason_ = "the state at the start is singular under its length";
}

void Session::set_stop(const std::atomic<bool>* stop) {
  options_.stop = stop;
  switcher_.newton.stop.flag = stop;
}

Session::Motion Session::advance(double distance) { return move(0, distance); }
Session::Motion Session::rotate(double angle) { return move(1, angle); }

Session::Motion Session::move(int which, double distance) {
  Motion motion;
  if (!ready()) {
    motion.reason = reason_;
    return motion;
  }
  if (!std::isfinite(distance)) {
    motion.reason = "the distance is not a finite number";
    return motion;
  }
  if (which != moving_) {
    moving_ = which;
    trend_.clear();
    chain_.rebind(mechanics(which));
    chain_.set_parameter(value_[which]);
    chain_.set_parameter_scale(which == 0 ? std::max(std::abs(value_[0]), 1e-3 * chain_.mechanics().problem.L) : 1.0);
  }
  if (which == 1 && problem_.twist_at == segmentation::Which::start &&
      problem_.twist == segmentation::TwistControl::torque) {
    motion.reason = "the torque at the start is given: its angle cannot be";
    return motion;
  }
  const double target = value_[which] + distance;
  const numerics::Stop& stop = switcher_.newton.stop;
  int halvings = 0;
  while (value_[which] != target) {
    if (stop.asked()) {
      motion.reason = stop.reason();
      return motion;
    }
    const double left = target - value_[which], most = std::abs(distance) * std::ldexp(1.0, -halvings);
    const double next = std::abs(left) <= most * (1.0 + 1e-9) ? target : value_[which] + std::copysign(most, left);
    const Outcome outcome = step(next, motion);
    ++motion.substeps;
    if (outcome != Outcome::done && stop.asked()) continue;
    if (outcome == Outcome::done) {
      if (halvings > 0) --halvings;
      continue;
    }
    if (halvings < finest) {
      ++halvings;
      trend_.clear();
      continue;
    }
    if (outcome == Outcome::axis_ends) return motion;
    if (!jump(target, distance, motion)) {
      if (stop.asked()) continue;
      if (motion.reason.empty()) motion.reason = "no further state was found";
      return motion;
    }
    halvings = 0;
  }
  motion.reached = true;
  return motion;
}

Chain Session::expected(double target, Motion& motion) {
  const double from = value_[moving_];
  Chain next = chain_;
  if (!trend_.lead(next, from, target)) {
    std::vector<double> t;
    ++motion.factorisations;
    if (next.tangent({Closure::Kind::parameter, 0, target}, t)) next.advance(t, target - from);
  }
  // The axis' mesh points are where its pieces meet: the mesh is laid anew between them, its errors as they are now.
  next.relay(mesh_share * switcher_.accuracy, &chain_);
  return next;
}

Session::Outcome Session::step(double target, Motion& motion) {
  const double from = value_[moving_];
  const Closure closure{Closure::Kind::parameter, 0, target};
  Chain next = expected(target, motion);
  const Course course(next);
  segmentation::NewtonOptions newton = switcher_.newton;
  newton.keep_factors = true;
  newton.max_iterations = 12;
  // as the junctions settle the mesh is brought back to its points, on the same factors
  std::vector<double> laid = next.places();
  segmentation::NewtonSummary s;
  for (int round = 0; round < 4; ++round) {
    s = next.solve(closure, newton);
    motion.newton_iterations += s.iterations;
    motion.factorisations += s.factorisations;
    double moved = 0.0;
    for (std::size_t i = 0; i < laid.size(); ++i) moved = std::max(moved, std::abs(next.places()[i] - laid[i]));
    if (!s.converged || moved < knot_distance) break;
    next.stay(laid);
    laid = next.places();
  }
  if (s.converged && next.estimate_error() > switcher_.accuracy) {  // the mesh no longer fits
    s = next.solve_adaptive(closure, newton, mesh_share * switcher_.accuracy);
    motion.newton_iterations += s.iterations;
    motion.factorisations += s.factorisations;
  }
  bool passed = s.converged;
  if (!passed) motion.reason = s.reason;
  for (const Pattern& q : passed ? std::vector<Pattern>() : patterns_nearby(chain_)) {
    next = chain_.recut(q);
    segmentation::SwitcherOptions guess = switcher_;
    guess.guess = true;
    guess.max_patterns = most_guessed;
    const auto w = segmentation::switch_contact_pattern(next, closure, guess);
    motion.newton_iterations += w.newton_iterations;
    motion.factorisations += w.factorisations;
    passed = w.converged && course.distance(next) < far_from_trend && judge_stability(next).word != "unstable";
    if (passed) break;
  }
  if (!passed) return Outcome::failed;
  const auto violated = segmentation::violations(next, segmentation::margins(next), switcher_.tolerance);
  const bool changed = !violated.empty();
  if (changed) {
    const auto w = segmentation::switch_contact_pattern(next, closure, switcher_);
    motion.newton_iterations += w.newton_iterations;
    motion.factorisations += w.factorisations;
    if (!w.converged) {
      motion.reason = w.reason;
      return Outcome::failed;
    }
  }
  if (next.S(next.segments()) > 1.0 + 1e-9) {
    motion.reason = "the tip reaches the end of the axis";
    return Outcome::axis_ends;
  }
  if (course.distance(next) > far_from_trend) {
    motion.reason = "the state would leave where it was";
    return Outcome::too_far;
  }
  if (judge_stability(next).word == "unstable") {
    motion.reason = "the state loses its stability";
    return Outcome::failed;
  }
  if (changed || !s.converged) note_changes(chain_, next, violated, from, target);
  accept(std::move(next), target);
  motion.reason.clear();
  return Outcome::done;
}

void Session::accept(Chain next, double value) {
  trend_.push(std::move(chain_), value_[moving_], next);
  chain_ = std::move(next);
  value_[moving_] = value;
  moved_ = true;
}

std::optional<Chain> Session::downhill(double value, bool from_here, Motion& motion) const {
  Session there;
  there.problem_ = problem_;
  there.feed_ = feed_;
  there.value_[0] = value_[0];
  there.value_[1] = value_[1];
  there.value_[moving_] = value;
  const auto stable = [](const Chain& c) { return judge_stability(c).word != "unstable"; };
  segmentation::DiscreteState here;
  if (from_here) here = segmentation::discrete_state(chain_);
  auto found = segmentation::cold_start(there.mechanics(moving_), options_.solve, switcher_, stable,
                                        from_here ? &here : nullptr);
  motion.newton_iterations += found.effort.newton_iterations;
  motion.factorisations += found.effort.factorisations;
  if (!found.converged || !stable(found.chain)) {
    motion.reason = "no state follows on, and downhill from there: " +
                    (found.converged ? std::string("no stable one") : found.reason);
    return std::nullopt;
  }
  found.chain.set_parameter_scale(chain_.parameter_scale());
  return found.chain;
}

bool Session::walk(Chain& chain, double from, double to, Motion& motion) const {
  double step = to - from;
  for (int tries = 0; tries < 80 && from != to; ++tries) {
    const double next = std::abs(to - from) <= std::abs(step) * (1.0 + 1e-9) ? to : from + step;
    Chain c = chain;
    const auto s = segmentation::switch_contact_pattern(c, {Closure::Kind::parameter, 0, next}, switcher_);
    motion.newton_iterations += s.newton_iterations;
    motion.factorisations += s.factorisations;
    if (s.converged && judge_stability(c).word != "unstable") {
      chain = std::move(c);
      from = next;
      continue;
    }
    step *= 0.4;
    if (std::abs(step) < 1e-3 * std::abs(to - from)) return false;
  }
  return from == to;
}

bool Session::jump(double target, double unit, Motion& motion) {
  const double from = value_[moving_];
  // A state may be hard to find where it is about to be lost itself: then it is sought farther on and brought back.
  for (const double farther : {0.0, 1.0, 3.0, 8.0, 20.0})
    for (const bool from_here : {true, false}) {
      if (moving_ == 1 && farther > 0.0) continue;
      if (switcher_.newton.stop.asked()) return false;
      const double value = target + farther * unit;
      auto next = downhill(value, from_here, motion);
      if (!next || !walk(*next, value, target, motion)) continue;
      if (Course(chain_).distance(*next) > far_from_trend) {
        note("jump", from, 0.0);
        motion.jumped = true;
        char text[64];
        std::snprintf(text, sizeof text, "downhill in energy after a jump at %.9g", from);
        how_ = text;
      }
      note_changes(chain_, *next, {}, from, target);
      accept(std::move(*next), target);
      motion.reason.clear();
      return true;
    }
  return false;
}

Step Session::state(int points) const {
  StudyOptions o = options_;
  o.fields = points > 0;
  if (points > 0) o.field_points = points;
  Chain c = chain_;
  return judged_step(c, o, switcher_, how_ + (moved_ ? ", then moved" : ""), value_[0]);
}

TracePoint Session::trace() const {
  const auto& P = chain_.mechanics().problem;
  TracePoint t = trace_point(chain_);
  t.parameter = value_[0];
  t.rod_length *= P.L;
  t.axial_force_end *= P.force_unit();
  t.torque_end *= P.moment_unit();
  return t;
}

Session::Snapshot Session::snapshot() const {
  Snapshot s;
  chain_.store(s.state);
  s.value[0] = value_[0];
  s.value[1] = value_[1];
  s.how = how_;
  s.events = events_.size();
  return s;
}

bool Session::restore(const Snapshot& s) {
  Chain c;
  const double keep[2] = {value_[0], value_[1]};
  value_[0] = s.value[0];
  value_[1] = s.value[1];
  moving_ = 0;
  if (!c.restore(s.state, mechanics(0))) {
    value_[0] = keep[0];
    value_[1] = keep[1];
    return false;
  }
  c.set_parameter(value_[0]);
  c.set_parameter_scale(std::max(std::abs(value_[0]), 1e-3 * c.mechanics().problem.L));
  chain_ = std::move(c);
  trend_.clear();
  how_ = s.how;
  if (s.events < events_.size()) events_.resize(s.events);
  return true;
}

}  // namespace tendril::continuation

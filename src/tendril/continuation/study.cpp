#include "tendril/continuation/study.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>

#include "tendril/continuation/formulations.hpp"
#include "tendril/continuation/path_detail.hpp"
#include "tendril/continuation/path_follower.hpp"
#include "tendril/continuation/report_state.hpp"
#include "tendril/continuation/self_contact.hpp"
#include "tendril/continuation/study_detail.hpp"
#include "tendril/segmentation/cold_start.hpp"

namespace tendril::continuation {

using segmentation::Chain;
using segmentation::Mechanics;
using segmentation::Problem;

namespace {

double clock_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Mesh points that a tube may bring: a million unknowns, some two gigabytes.
constexpr std::size_t most_knots = 10000;

/// Failures of the path follower that are passed by a stable state just beyond, per listed value.
constexpr int most_recoveries = 4;

std::string time_limit(double seconds) { return "the time limit of " + figure(seconds) + " s was reached"; }

struct Solver {
  const StudyOptions& options;
  segmentation::SwitcherOptions switcher;
  double begun = clock_seconds();
  explicit Solver(const StudyOptions& o) : options(o), switcher(switcher_options(o.solve)) {
    switcher.newton.stop = {o.stop, o.solve.max_seconds, numerics::Stop::Clock::now()};
  }
  Solver(const Solver&) = delete;

  bool stopped() const { return switcher.newton.stop.asked(); }

  /// From nothing; a stable state if the rule asks for one and there is one to be found.
  segmentation::ColdStart cold(const std::shared_ptr<Mechanics>& mechanics) const {
    std::function<bool(const Chain&)> accept;
    if (options.solve.branch == segmentation::BranchRule::stable)
      accept = [](const Chain& c) { return judge_stability(c).word != "unstable"; };
    return segmentation::cold_start(mechanics, options.solve, switcher, accept);
  }

  /// First state: restored, or from nothing.
  segmentation::ColdStart first(const std::shared_ptr<Mechanics>& mechanics) const {
    if (options.initial) {
      segmentation::ColdStart c;
      Chain chain;
      if (chain.restore(*options.initial, mechanics)) {
        const double p = mechanics->problem.p0;
        chain.set_parameter(p);
        mechanics->problem.p = p;
        c.effort =
            segmentation::switch_contact_pattern(chain, {segmentation::Closure::Kind::parameter, 0, p}, switcher);
        if (c.effort.converged) {
          c.converged = true;
          c.chain = chain;
          c.branch = "continued from the stored state";
          return c;
        }
      }
    }
    return cold(mechanics);
  }

  /// The state as a step, judged and certified.
  Step step(Chain& chain, const std::string& how, std::optional<double> parameter) const {
    return judged_step(chain, options, switcher, how, parameter);
  }
};

/// Where a state stands against the limits of the formulation.
std::string validity_limit(Chain& chain) {
  const auto c = segmentation::certify(chain);
  if (c.smallest_inclination < 0.1) return "d3·D3 falls to " + std::to_string(c.smallest_inclination);
  if (c.smallest_stretch < 0.15) return "the stretch falls to " + std::to_string(c.smallest_stretch);
  return "";
}

void finish_status(Result& r) {
  r.status = Status::converged;
  for (const Step& s : r.steps)
    if (s.status != Status::converged && r.status == Status::converged) {
      r.status = s.status;
      if (r.message.empty()) r.message = s.message;
    }
  if (r.steps.empty()) r.status = Status::not_converged;
}

}  // namespace

Result follow(const std::function<Problem(double)>& given, const Path& path, const StudyOptions& options) {
  Solver solver(options);
  const bool planar = options.solve.branch == segmentation::BranchRule::planar;
  const std::function<Problem(double)> family = [&given, planar](double p) {
    Problem problem = given(p);
    problem.planar = problem.planar || planar;
    return problem;
  };
  Result result;
  auto mechanics = std::make_shared<Mechanics>(family(path.start), path.start);
  const double L = mechanics->problem.L, F = mechanics->problem.force_unit(), M = mechanics->problem.moment_unit();
  const bool single = path.values.empty();
  if (planar && !mechanics->problem.planar) {
    Step s;
    s.status = Status::outside_validity;
    s.message =
        "branch = \"planar\" needs a plane of symmetry, that of D1 and D3: the axis (without torsion), the ends' "
        "eccentricity and slope and the body force must lie in it, torque and twist be zero";
    result.steps.push_back(s);
    finish_status(result);
    return result;
  }
  if (mechanics->problem.knots.size() > most_knots) {
    Step s;
    s.message = "the tube brings " + std::to_string(mechanics->problem.knots.size()) +
                " points, and each is a mesh point of the rod: at most " + std::to_string(most_knots) +
                " can be solved; thin the points of the axis or of the clearance";
    result.steps.push_back(s);
    finish_status(result);
    return result;
  }
  if (options.solve.formulation == segmentation::Formulation::small_inclination) {
    const std::vector<double> values = single ? std::vector<double>{path.start} : path.values;
    for (const double& value : values) {
      const double begun = clock_seconds();
      Step s =
          small_inclination_step(family(value), options.solve.tolerance, options.fields ? options.field_points : 0);
      if (!single) s.parameter = value;
      judge_approximation(s, options.solve.tolerance);
      s.effort.wall_seconds = clock_seconds() - begun;
      result.steps.push_back(std::move(s));
      if (&value == &values.back() || !solver.stopped()) continue;
      if (options.stop && options.stop->load()) {
        result.interrupted = true;
      } else {
        Step rest;
        rest.parameter = *(&value + 1);
        rest.message = time_limit(options.solve.max_seconds);
        result.steps.push_back(std::move(rest));
      }
      break;
    }
    finish_status(result);
    return result;
  }
  auto say = [&](double fraction, const std::string& what) {
    if (options.progress) options.progress(fraction, what);
  };
  say(0.0, "finding the contact pattern");
  segmentation::ColdStart start = solver.first(mechanics);
  const auto& effort0 = start.effort;
  if (!start.converged) {
    Step s;
    s.status = start.outside_validity ? Status::outside_validity : Status::not_converged;
    s.parameter = single ? std::nullopt : std::optional<double>(path.start);
    s.message =
        (start.outside_validity ? "outside the validity of the formulation: " : "no state found at the start: ") +
        start.reason;
    s.effort = {effort0.newton_iterations, effort0.factorisations, effort0.patterns_tried,
                clock_seconds() - solver.begun};
    result.steps.push_back(s);
    result.message = s.message;
    result.status = s.status;
    result.interrupted = solver.switcher.newton.stop.interrupted();
    return result;
  }
  Effort pending{effort0.newton_iterations, effort0.factorisations, effort0.patterns_tried, 0.0};
  double step_began = solver.begun;
  auto push = [&](Step s) {
    s.effort = pending;
    s.effort.wall_seconds = clock_seconds() - step_began;
    step_began = clock_seconds();
    pending = {};
    result.steps.push_back(std::move(s));
  };
  if (single) {
    push(solver.step(start.chain, start.branch, std::nullopt));
    finish_status(result);
    return result;
  }

  FollowOptions follow_options;
  follow_options.switcher = solver.switcher;
  follow_options.arclength = path.smooth;
  follow_options.stop = options.stop;
  follow_options.max_seconds = options.solve.max_seconds;
  follow_options.begun = solver.begun;
  follow_options.max_step = options.max_step;
  if (options.solve.branch == segmentation::BranchRule::stable) {
    follow_options.stable = [](const Chain& c) { return judge_stability(c).word == "stable"; };
    // the stable state nearest beyond: the discrete search may still find the branch left when too near
    follow_options.snap = [&](const Chain& at, int direction) -> std::optional<Chain> {
      const double unit = std::max({std::abs(at.parameter()), std::abs(path.start), 1e-300});
      for (const double beyond : {1e-6, 1e-4, 1e-3, 1e-2}) {
        if (solver.stopped()) break;
        const double p = at.parameter() + direction * beyond * unit;
        segmentation::ColdStart other = solver.cold(std::make_shared<Mechanics>(family(p), p));
        if (other.converged && judge_stability(other.chain).word == "stable") return other.chain;
      }
      return std::nullopt;
    };
  }
  std::function<std::shared_ptr<Mechanics>(double)> rebuild;
  if (!path.smooth) rebuild = [&family](double p) { return std::make_shared<Mechanics>(family(p), p); };
  PathFollower follower(start.chain, follow_options, rebuild);
  std::string how = start.branch;
  auto collect = [&]() {
    for (Event e : follower.events) {
      e.S *= L;
      e.rod_length *= L;
      e.axial_force_end *= F;
      e.contact_force *= F;
      result.events.push_back(e);
    }
    follower.events.clear();
    for (TracePoint t : follower.trace) {
      t.rod_length *= L;
      t.axial_force_end *= F;
      t.torque_end *= M;
      result.trace.push_back(t);
    }
    follower.trace.clear();
  };
  const auto jump = [&](const Chain& from) {
    Chain at = from;
    const Step left = describe(at, 0);
    Event e;
    e.parameter = from.parameter();
    e.kind = "jump";
    e.rod_length = left.rod_length;
    e.axial_force_end = left.axial_force_end;
    result.events.push_back(e);
  };
  for (std::size_t i = 0; i < path.values.size(); ++i) {
    const double value = path.values[i];
    say(static_cast<double>(i) / path.values.size(), "following the path");
    FollowSummary f;
    const auto go_on = [&] {
      f = follower.to(value);
      pending.newton_iterations += f.newton_iterations;
      pending.factorisations += f.factorisations;
      pending.patterns_tried += f.patterns;
      collect();
    };
    go_on();
    // where the follower fails, a stable state is sought just beyond, wherever the listed value lies
    for (int recovery = 0; recovery < most_recoveries && f.kind == "failure" && !f.interrupted && follow_options.snap;
         ++recovery) {
      Chain last = follower.chain();
      if (!validity_limit(last).empty()) break;
      const auto beyond = follow_options.snap(last, value > last.parameter() ? 1 : -1);
      if (!beyond || (beyond->parameter() - value) * (last.parameter() - value) < 0.0) break;
      if (far_apart(last, *beyond)) {
        jump(last);
        how = "least energy after a jump from parameter " + figure(last.parameter()) + " (" + f.reason + ")";
      }
      follower = PathFollower(*beyond, follow_options, rebuild);
      go_on();
    }
    if (f.kind == "time") {
      Chain last = follower.chain();
      Step s = solver.step(last, how, last.parameter());
      s.status = Status::not_converged;
      s.message =
          "the path ends: " + f.reason + ", at parameter " + figure(last.parameter()) + "; last good state given";
      push(s);
      finish_status(result);
      return result;
    }
    if (!f.reached && !f.interrupted) {
      // the branch ends here: pass to a stable state at the wanted load if there is one
      Chain last = follower.chain();
      const std::string limit = validity_limit(last);
      const double p_last = last.parameter();
      segmentation::ColdStart again;
      if (limit.empty() && f.kind != "limit") again = solver.cold(std::make_shared<Mechanics>(family(value), value));
      if (again.converged) {
        jump(last);
        how = again.branch + " after a jump from parameter " + figure(p_last) + " (" + f.reason + ")";
        follower = PathFollower(again.chain, follow_options, rebuild);
      } else {
        Step s = solver.step(last, how, p_last);
        s.status = limit.empty() ? Status::not_converged : Status::outside_validity;
        s.message = (limit.empty() ? "the path ends: " + f.reason : "the formulation ends: " + limit) +
                    "; last good state given, at parameter " + figure(p_last);
        if (!limit.empty()) {
          Event e;
          e.parameter = p_last;
          e.kind = "end_of_validity";
          e.rod_length = s.rod_length;
          e.axial_force_end = s.axial_force_end;
          result.events.push_back(e);
        }
        push(s);
        finish_status(result);
        return result;
      }
    } else if (f.interrupted) {
      Chain last = follower.chain();
      Step s = solver.step(last, how, last.parameter());
      s.status = Status::not_converged;
      s.message = f.reason + "; last good state given";
      push(s);
      result.interrupted = true;
      finish_status(result);
      return result;
    }
    Step s = solver.step(follower.chain(), how, value);
    if (s.stability == "unstable" && options.solve.branch == segmentation::BranchRule::stable) {
      auto there = std::make_shared<Mechanics>(family(value), value);
      segmentation::ColdStart other = solver.cold(there);
      if (other.converged) {
        Step t = solver.step(other.chain, other.branch, value);
        if (t.stability == "stable") {
          jump(follower.chain());
          t.branch = "left an unstable state (rod length " + std::to_string(s.rod_length) + "): " + t.branch;
          s = t;
          how = other.branch;
          follower = PathFollower(other.chain, follow_options, rebuild);
        }
      }
    }
    push(s);
    if (how.find("then followed") == std::string::npos) how += ", then followed along the path";
    if (options.stop && options.stop->load()) {
      result.interrupted = i + 1 < path.values.size();
      break;
    }
  }
  say(1.0, "done");
  finish_status(result);
  return result;
}

Result solve(const Problem& problem, const StudyOptions& options) {
  return follow([&](double) { return problem; }, Path{0.0, {}, true}, options);
}

}  // namespace tendril::continuation

// One step along a path: direction, predictor, corrector, and the test that the solved state lies on the same branch.
#include <algorithm>
#include <cmath>

#include "tendril/continuation/path_follower.hpp"
#include "tendril/continuation/report_state.hpp"
#include "tendril/segmentation/flat_lines.hpp"

namespace tendril::continuation {

using segmentation::Chain;
using segmentation::Closure;

namespace {

// The parameter is held while it changes at least this fraction as fast as the fastest unknown: it is natural and the
// factors of one step serve the next.
constexpr double parameter_preferred = 0.1;
// Of the step: from the predicted to the solved state.
constexpr double largest_deviation = 0.4, wanted_deviation = 0.1;
constexpr double smallest_cosine = 0.7;
// The headings at both ends of a step may differ by about as much.
constexpr double largest_turn = 1.0;
constexpr double shortest_step = 1e-8;
constexpr int attempts = 4;

double dot(const std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& scale) {
  double sum = 0.0;
  for (std::size_t i = 0; i < scale.size(); ++i) sum += a[i] * b[i] / (scale[i] * scale[i]);
  return sum;
}

double largest(const std::vector<double>& d, const std::vector<double>& scale) {
  double most = 0.0;
  for (std::size_t i = 0; i < scale.size(); ++i) most = std::max(most, std::abs(d[i]) / scale[i]);
  return most;
}

void subtract(std::vector<double>& a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
}

bool on_axis(const Chain& c) { return c.segments() == 1 && !c.is_line(0) && !c.turns_freely(); }

}  // namespace

Branching judge_arrival(const Arrival& a) {
  if (a.deviation > largest_deviation || a.cosine < smallest_cosine) return Branching::elsewhere;
  if (a.sign_kept) return Branching::same;
  // the sign turns at a branch point, but also from one branch to its neighbour: only a step that is told well is
  // trusted
  return a.deviation < 0.25 * largest_deviation && a.cosine > 0.9 ? Branching::crossed : Branching::elsewhere;
}

bool PathFollower::find_heading(Chain& c, int hold, const std::vector<double>& forward, Heading& out) {
  out = {};
  const int ip = c.column_of_p();
  out.hold = ip;
  if (segmentation::has_flat_line(c)) return out.valid = true;  // singular: no tangent
  const int n = c.unknowns();
  std::vector<double> t, x, scale;
  c.scales(scale);
  const auto along = [&](int held) {
    const double value = held == ip ? c.parameter() : 0.0;
    Closure closure{held == ip ? Closure::Kind::parameter : Closure::Kind::unknown, held, value};
    if (held != ip) {
      c.gather(x);
      closure.value = x[held];
    }
    return c.tangent(closure, t) && std::all_of(t.begin(), t.end(), [](double v) { return std::isfinite(v); });
  };
  if (!along(hold)) {
    if (forward.empty()) return false;
    int most = 0;
    for (int i = 0; i < n; ++i)
      if (i != ip && std::abs(forward[i]) / scale[i] > std::abs(forward[most]) / scale[most]) most = i;
    if (!along(hold == ip ? most : ip)) return false;
  }
  const double size = largest(t, scale);
  double unit = 1.0 / size;
  if (forward.empty() ? t[ip] * direction_ < 0.0 : dot(t, forward, scale) < 0.0) unit = -unit;
  out.sign = unit > 0.0 ? c.determinant_sign() : -c.determinant_sign();
  out.rate = t[ip] * unit / scale[ip];
  if (options_.arclength && std::abs(out.rate) < parameter_preferred)
    out.hold = static_cast<int>(std::max_element(t.begin(), t.end(),
                                                 [&](const double& a, const double& b) {
                                                   return std::abs(a) / scale[&a - t.data()] <
                                                          std::abs(b) / scale[&b - t.data()];
                                                 }) -
                                t.begin());
  c.gather_all(x);
  c.advance(t, unit);
  c.gather_all(out.t);
  c.scatter_all(x);
  subtract(out.t, x);
  return out.valid = true;
}

void PathFollower::start_anew(double step) {
  previous_.clear();
  heading_ = {};
  step_ = step;
}

bool PathFollower::land_between(double target, Step& s) {
  const int ip = s.next.column_of_p();
  const auto at = [&](double f) {
    std::vector<double> x(s.x1);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += f * (s.x2[i] - s.x1[i]);
    return x;
  };
  Chain landed = s.next;
  landed.scatter_all(at((target - s.x1[ip]) / (s.x2[ip] - s.x1[ip])));
  Closure closure{Closure::Kind::parameter, 0, target};
  if (!correct(landed, closure, false)) {
    if (s.closure.kind == Closure::Kind::parameter) return false;
    // beside a fold: approached in the unknown held
    closure = s.closure;
    const double from = s.x1[closure.index], to = s.x2[closure.index];
    double lo = 0.0, hi = 1.0, f_lo = s.x1[ip] - target, f_hi = s.x2[ip] - target;
    for (int it = 0;; ++it) {
      const double f = std::clamp(lo + (hi - lo) * f_lo / (f_lo - f_hi), lo + 0.01 * (hi - lo), hi - 0.01 * (hi - lo));
      landed.scatter_all(at(f));
      closure.value = from + f * (to - from);
      if (!correct(landed, closure, false)) return false;
      const double off = landed.parameter() - target;
      if (std::abs(off) < 1e-13 * std::max(p_unit_, std::abs(target)) || hi - lo < 1e-14) break;
      if (it == 60) return false;
      (off * f_lo > 0.0 ? lo : hi) = f;
      (off * f_lo > 0.0 ? f_lo : f_hi) = off;
    }
    landed.set_parameter(target);
  }
  s.next = landed;
  s.next.gather_all(s.x2);
  s.closure = closure;
  s.landing = true;
  std::vector<double> forward(s.x2);
  subtract(forward, s.x1);
  return find_heading(s.next, s.heading.hold, forward, s.heading);
}

bool PathFollower::take_step(double target, Step& s) {
  chain_.set_parameter_scale(p_unit_);
  std::vector<double> scale;
  const int n = chain_.unknowns(), ip = chain_.column_of_p();
  chain_.gather_all(s.x1);
  if (previous_.size() != s.x1.size()) previous_.clear();
  if (!heading_.valid || (!heading_.t.empty() && heading_.t.size() != s.x1.size()))
    if (!find_heading(chain_, ip, {}, heading_)) {
      total_.reason = "the path cannot be continued: singular state";
      return false;
    }
  chain_.scales(scale);
  scale.resize(n);
  // direction d, largest scaled change 1, and the bend b of the predictor x + h d + h² b
  std::vector<double> d = heading_.t, b;
  const bool flat = d.empty();
  if (!previous_.empty() && (flat || rebuild_)) {
    d = s.x1;
    subtract(d, previous_);
  } else if (flat) {  // a secant to a solved neighbour
    const double range = std::abs(target - chain_.parameter());
    double nudge = direction_ * std::min(1e-3 * p_unit_, 0.05 * range);
    for (int attempt = 0;; ++attempt, nudge *= 0.2) {
      Chain ahead = chain_;
      if (correct(ahead, {Closure::Kind::parameter, 0, chain_.parameter() + nudge}, false)) {
        ahead.gather_all(d);
        break;
      }
      if (attempt == 4) {
        total_.reason = "the path cannot be continued: no neighbouring state";
        return false;
      }
    }
    subtract(d, s.x1);
  } else if (!previous_.empty()) {
    std::vector<double> back(s.x1);
    subtract(back, previous_);
    const double length = dot(d, back, scale) / dot(d, d, scale);
    if (length > 0.0) {
      b.resize(d.size());
      for (std::size_t i = 0; i < b.size(); ++i) b[i] = (length * d[i] - back[i]) / (length * length);
    }
  }
  if (const double size = largest(d, scale); flat || rebuild_)
    for (double& v : d) v /= size;
  s.length = std::clamp(step_, shortest_step, options_.max_step);
  if (!b.empty()) {
    s.length = std::min(s.length, std::max(largest_turn / std::max(largest(b, scale), 1e-300), 1e-3 * step_));
  }
  const auto predicted_p = [&](double h) { return h * d[ip] + (b.empty() ? 0.0 : h * h * b[ip]); };
  const int hold = flat ? ip : heading_.hold;
  const double to_go = target - s.x1[ip];
  s.landing = s.crossed = false;
  if (predicted_p(s.length) * to_go > 0.0 && std::abs(predicted_p(s.length)) >= std::abs(to_go) * (1.0 - 1e-12)) {
    double low = 0.0, high = s.length;
    for (int it = 0; it < 60; ++it) {
      const double mid = 0.5 * (low + high);
      (std::abs(predicted_p(mid)) < std::abs(to_go) ? low : high) = mid;
    }
    s.length = high;
    s.landing = true;
  }
  std::vector<double> guess(s.x1), moved;
  s.next = chain_;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    const double h = s.length;
    for (std::size_t i = 0; i < guess.size(); ++i) guess[i] = s.x1[i] + h * d[i] + (b.empty() ? 0.0 : h * h * b[i]);
    if (attempt > 0) s.next = chain_;
    s.next.scatter_all(guess);
    if (s.landing || hold == ip)
      s.closure = {Closure::Kind::parameter, 0, s.landing ? target : guess[ip]};
    else
      s.closure = {Closure::Kind::unknown, hold, guess[hold]};
    bool ok = correct(s.next, s.closure, false, true);
    double deviation = 0.0;
    if (ok) {
      s.next.gather_all(s.x2);
      moved = s.x2;
      subtract(moved, guess);
      // what rounding leaves of a tiny step is no departure
      deviation = std::max(0.0, largest(moved, scale) - 1e-8) / h;
      ok = flat || rebuild_ ? deviation < 3.0 : deviation < largest_deviation;
      if (!ok) total_.reason = "the branch is lost at every length of the step";
    }
    if (ok) {
      moved = s.x2;
      subtract(moved, s.x1);
      const int held = s.closure.kind == Closure::Kind::parameter ? ip : hold;
      ok = find_heading(s.next, held, moved, s.heading);
    }
    if (ok && !flat && !rebuild_ && !s.heading.t.empty()) {
      Arrival a;
      a.deviation = deviation;
      a.cosine = dot(heading_.t, s.heading.t, scale) /
                 std::sqrt(dot(heading_.t, heading_.t, scale) * dot(s.heading.t, s.heading.t, scale));
      a.sign_kept = heading_.sign * s.heading.sign >= 0;
      const Branching verdict = judge_arrival(a);
      ok = verdict != Branching::elsewhere;
      if (!ok) total_.reason = "the branch is lost at every length of the step";
      s.crossed = verdict == Branching::crossed;
    }
    if (!ok) {
      s.landing = false;
      step_ = s.length *= 0.35;
      if (s.length < shortest_step) return false;
      continue;
    }
    // a step in another unknown may pass the target
    if (!s.landing && (s.x2[ip] - target) * to_go > 0.0 && !land_between(target, s)) {
      step_ = s.length *= 0.35;
      continue;
    }
    const double next = flat || rebuild_ ? 1.6 : std::cbrt(wanted_deviation / std::max(deviation, 1e-4));
    const double longer = std::clamp(s.length * std::clamp(next, 0.5, 3.0), shortest_step, options_.max_step);
    step_ = s.landing && attempt == 0 ? std::max(step_, longer) : longer;  // a target may be near
    // on the axis of an axisymmetric problem the rod buckles in two planes at once
    const auto& problem = chain_.mechanics().problem;
    if (problem.axisymmetric && !problem.planar && options_.arclength) {
      if (last_count_ < 0 && on_axis(chain_)) last_count_ = unstable_directions(chain_);
      const int count = on_axis(s.next) ? unstable_directions(s.next) : -1;
      if (count >= 0 && last_count_ >= 0 && count != last_count_) s.crossed = true;
      last_count_ = count;
    }
    return true;
  }
  return false;
}

}  // namespace tendril::continuation

// Limit points and branch points of a path, located between two of its states, and the way on from them: along a branch
// that crosses, by a jump to another stable state, or not at all.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tendril/continuation/path_detail.hpp"
#include "tendril/continuation/path_follower.hpp"
#include "tendril/formulation/free_rod.hpp"

namespace tendril::continuation {

using segmentation::Chain;
using segmentation::Closure;

bool far_apart(const Chain& a, const Chain& b) {
  const TracePoint at = trace_point(a), to = trace_point(b);
  if (at.contacts != to.contacts || std::abs(at.rod_length - to.rod_length) > 1e-3 * at.rod_length) return true;
  double u[formulation::state_inputs], v[formulation::state_inputs], most = 0.0;
  constexpr int places = 32;
  for (int i = 1; i < places; ++i) {
    const double S = a.S(a.segments()) * i / places;
    a.sample(S, u, nullptr);
    b.sample(std::min(S, b.S(b.segments())), v, nullptr);
    // the rod may lie turned about the axis
    most = std::max(most, a.turns_freely() ? std::abs(std::hypot(u[0], u[4]) - std::hypot(v[0], v[4]))
                                           : std::hypot(u[0] - v[0], u[4] - v[4]));
  }
  return most > 0.1 * a.mechanics().problem.clearance_max;
}

PathFollower::Next PathFollower::at_fold(const Step& step, const Chain& fold, double target, FollowSummary& out) {
  const std::size_t before = events.size();
  record("fold", 0.0, fold);
  const Next next = at_limit(chain_, fold, "the fold", target, out);
  if (next == Next::elsewhere && events.size() == before + 1) {
    // not a jump: the branch ends on another that goes on, where that one becomes stable
    if (const auto crossing = crossing_near(fold)) {
      events.resize(before);
      record("branch_point", 0.0, *crossing);
    }
  }
  if (next == Next::finished) {
    // the last good state: next to the fold, wherever the step began
    constexpr double beside = 1e-6;
    const double there = fold.parameter() - direction_ * beside * std::abs(fold.parameter());
    Step part = step;
    part.next = fold;
    fold.gather_all(part.x2);
    if ((there - chain_.parameter()) * direction_ > 0.0 && land_between(there, part)) chain_ = part.next;
  }
  return next;
}

std::optional<Chain> PathFollower::crossing_near(const Chain& fold) {
  // chain_, just beyond the fold, lies on the branch that goes on; followed back it becomes unstable where they cross
  Chain back = chain_;
  std::vector<double> here, there;
  Heading ahead, behind;
  if (!find_heading(back, back.column_of_p(), {}, ahead)) return std::nullopt;
  back.gather_all(here);
  const double distance = chain_.parameter() - fold.parameter();
  for (const double more : {1.0, 4.0, 16.0, 64.0}) {
    const double p = fold.parameter() - more * distance;
    if (!correct(back, {Closure::Kind::parameter, 0, p}, false) || !find_heading(back, back.column_of_p(), {}, behind))
      return std::nullopt;
    if (behind.sign * ahead.sign >= 0) continue;
    back.gather_all(there);
    return locate_branch_point(there, here, back);
  }
  return std::nullopt;
}

PathFollower::Next PathFollower::at_limit(const Chain& before, const Chain& at, const std::string& what, double target,
                                          FollowSummary& out) {
  if (!options_.stable || !options_.snap || !options_.stable(before)) return Next::go_on;
  if (auto other = options_.snap(at, direction_)) {
    if (far_apart(at, *other)) record("jump", 0.0, at);
    chain_ = std::move(*other);
    settle(target, at.parameter());
    return Next::elsewhere;
  }
  out = ended("the load cannot be raised beyond " + what + " at parameter " + figure(at.parameter()) +
                  ": no stable state was found there",
              "limit");
  return Next::finished;
}

bool PathFollower::at_branch_point(const Chain& at, const Step& step, double target) {
  if (!options_.stable || options_.stable(step.next)) return false;
  bool turned_back = false;
  for (const double amplitude : {0.001, -0.001, 0.005, -0.005, 0.02, -0.02}) {
    auto other = branch_off(at, amplitude);
    if (!other) continue;
    // one that turns back is unstable under its load, if by too little to be counted; farther on it may come again
    const bool back = (other->parameter() - at.parameter()) * direction_ <= 0.0;
    turned_back = turned_back || back;
    if (back || !options_.stable(*other)) continue;
    if (!segmentation::violations(*other, segmentation::margins(*other), options_.switcher.tolerance).empty()) continue;
    if (turned_back) record("jump", 0.0, at);
    chain_ = std::move(*other);
    settle(target, at.parameter());
    return true;
  }
  if (!options_.snap) return false;
  auto stable = options_.snap(at, direction_);
  if (!stable) return false;
  if (far_apart(at, *stable)) record("jump", 0.0, at);
  chain_ = std::move(*stable);
  settle(target, at.parameter());
  return true;
}

std::optional<Chain> PathFollower::locate_branch_point(const std::vector<double>& from, const std::vector<double>& to,
                                                       const Chain& on) {
  // The response y to a fixed load grows without bound; g = 1/(c·y) passes through zero smoothly, with c the difference
  // of the responses at both ends, in which the kernel counts most. At the root itself the equations are singular, so
  // it is interpolated from solved places beside it.
  struct Place {
    double p, g;
    std::vector<double> x;
  };
  Chain c = on;
  const int ip = c.column_of_p();
  std::vector<double> y, direction;
  std::vector<Place> known;
  int load_case = 0;
  auto along = [&](const std::vector<double>& v) {
    double dot = 0.0;
    for (std::size_t i = 0; i < v.size(); ++i) dot += direction[i] * v[i];
    return dot;
  };
  auto solve_at = [&](double p, const std::vector<double>& guess) {
    c.scatter_all(guess);
    const Closure closure{Closure::Kind::parameter, 0, p};
    if (!correct(c, closure, false) || !c.response(closure, y, load_case)) return;
    Place place{p, 1.0 / along(y), {}};
    c.gather_all(place.x);
    known.push_back(std::move(place));
  };
  // Both ends, for the load whose response changes sign in between: one that the kernel resists. None: no branch point.
  auto bracket = [&](const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> at_a, at_b;
    Chain ca = c, cb = c;
    ca.scatter_all(a);
    cb.scatter_all(b);
    const Closure here_a{Closure::Kind::parameter, 0, a[ip]}, here_b{Closure::Kind::parameter, 0, b[ip]};
    if (!correct(ca, here_a, false) || !correct(cb, here_b, false)) return false;
    for (load_case = 0; load_case < 8; ++load_case) {
      if (!ca.response(here_a, at_a, load_case) || !cb.response(here_b, at_b, load_case)) return false;
      direction = at_b;
      double norm = 0.0;
      for (std::size_t i = 0; i < at_a.size(); ++i) norm += std::pow(direction[i] -= at_a[i], 2);
      for (double& v : direction) v /= norm;
      const double ga = along(at_a), gb = along(at_b);
      if (ga * gb >= 0.0) continue;
      known = {{b[ip], 1.0 / gb, {}}, {a[ip], 1.0 / ga, {}}};
      cb.gather_all(known[0].x);
      ca.gather_all(known[1].x);
      return true;
    }
    return false;
  };
  auto between = [&](const std::vector<double>& a, const std::vector<double>& b, double p) {
    std::vector<double> x(a.size());
    const double f = (p - a[ip]) / (b[ip] - a[ip]);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = a[i] + f * (b[i] - a[i]);
    return x;
  };
  auto root_between = [&](double lo, double hi) {  // of the polynomial through the known places
    std::vector<double> d;
    for (const auto& k : known) d.push_back(k.g);
    for (std::size_t j = 1; j < d.size(); ++j)
      for (std::size_t i = d.size() - 1; i >= j; --i) d[i] = (d[i] - d[i - 1]) / (known[i].p - known[i - j].p);
    auto value = [&](double p) {
      double v = d.back();
      for (std::size_t i = d.size() - 1; i-- > 0;) v = v * (p - known[i].p) + d[i];
      return v;
    };
    const double at_lo = value(lo);
    for (int it = 0; it < 70; ++it) {
      const double mid = 0.5 * (lo + hi);
      (value(mid) * at_lo > 0.0 ? lo : hi) = mid;
    }
    return 0.5 * (lo + hi);
  };
  std::vector<double> a = from, b = to, best;
  bool found = bracket(a, b);
  // a count of eigenvalues on a mesh of its own may be late or early by a little
  for (const double beyond : {3e-6, 3e-5}) {
    if (found) break;
    const double more = beyond * std::max(std::abs(from[ip]), std::abs(to[ip])) * (to[ip] > from[ip] ? 1.0 : -1.0);
    b = between(from, to, to[ip] + more);
    a = between(from, to, from[ip] - more);
    found = bracket(a, b);
  }
  if (!found) return std::nullopt;
  b = known[0].x;
  a = known[1].x;
  for (int pass = 0; pass < 3; ++pass) {
    double root = root_between(a[ip], b[ip]);
    const double width = b[ip] - a[ip];
    for (double spread : {0.3, 0.12, 0.05}) {
      for (double side : {-1.0, 1.0}) {
        const double f = (root - a[ip]) / width + side * spread;
        if (f > 0.0 && f < 1.0) solve_at(a[ip] + f * width, between(a, b, a[ip] + f * width));
      }
      root = root_between(a[ip], b[ip]);
    }
    // go on between the nearest solved places on both sides
    for (const Place& k : known) {
      const double f = (k.p - a[ip]) / (b[ip] - a[ip]), at = (root - a[ip]) / (b[ip] - a[ip]);
      if (f > 0.0 && f < at) a = k.x;
    }
    for (const Place& k : known) {
      const double f = (k.p - a[ip]) / (b[ip] - a[ip]), at = (root - a[ip]) / (b[ip] - a[ip]);
      if (f < 1.0 && f > at) b = k.x;
    }
    best = between(a, b, root);
    if (std::abs(b[ip] - a[ip]) < 1e-5 * std::max(1.0, std::abs(root))) break;
    std::erase_if(known, [&](const Place& k) { return std::abs(k.p - root) > 3.0 * std::abs(b[ip] - a[ip]); });
    if (known.size() < 2) break;
  }
  c.scatter_all(best);
  return c;
}

std::optional<Chain> PathFollower::branch_off(const Chain& at, double amplitude) {
  Chain c = at;
  std::vector<double> y, scale;
  const Closure here{Closure::Kind::parameter, 0, at.parameter()};
  if (!c.response(here, y)) return std::nullopt;  // all kernel, this near
  c.scales(scale);
  int most = 0;
  for (int i = 0; i < c.column_of_S(0); ++i)
    if (std::abs(y[i]) > std::abs(y[most])) most = i;
  if (!(std::abs(y[most]) > 0.0)) return std::nullopt;
  const double factor = amplitude / y[most];
  for (std::size_t i = 0; i < y.size(); ++i) y[i] *= factor * scale[i];
  y[c.column_of_p()] = 0.0;
  c.advance(y, 1.0);
  std::vector<double> x;
  c.gather(x);
  if (!correct(c, {Closure::Kind::unknown, most, x[most]}, false)) return std::nullopt;
  return c;
}

Chain PathFollower::locate_fold(const std::vector<double>& a, const std::vector<double>& b, const Chain& on) {
  // hold the unknown that changes most from a to b and find where dp along it vanishes
  Chain c = on;
  std::vector<double> scale, t, x(a.size());
  c.scales(scale);
  int held = 0;
  for (int i = 0; i < c.unknowns(); ++i)
    if (i != c.column_of_p() && std::abs(b[i] - a[i]) / scale[i] > std::abs(b[held] - a[held]) / scale[held]) held = i;
  auto slope = [&](double f) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = a[i] + f * (b[i] - a[i]);
    c.scatter_all(x);
    const Closure closure{Closure::Kind::unknown, held, a[held] + f * (b[held] - a[held])};
    if (!correct(c, closure, false) || !c.tangent(closure, t)) return std::numeric_limits<double>::quiet_NaN();
    return t[c.column_of_p()];
  };
  double f0 = 0.0, f1 = 1.0, g0 = slope(f0), g1 = slope(f1);
  for (int it = 0; it < 40 && g0 * g1 < 0.0 && f1 - f0 > 1e-10; ++it) {
    double f = f0 + (f1 - f0) * g0 / (g0 - g1);
    f = std::clamp(f, f0 + 0.01 * (f1 - f0), f1 - 0.01 * (f1 - f0));
    const double g = slope(f);
    if (!std::isfinite(g)) break;
    // p is stationary here, so a slope this small moves it by far less than any tolerance
    if (std::abs(g) < 1e-7 * (std::abs(g0) + std::abs(g1))) return c;
    (g * g0 > 0.0 ? f0 : f1) = f;
    (g * g0 > 0.0 ? g0 : g1) = g;
  }
  return c;
}

}  // namespace tendril::continuation

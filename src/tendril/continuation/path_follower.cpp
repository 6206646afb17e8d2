#include "tendril/continuation/path_follower.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "tendril/segmentation/pattern_edit.hpp"
#include "tendril/segmentation/seeding.hpp"

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

TracePoint trace_point(const Chain& c) {
  double u[formulation::FreeRod::inputs], s;
  const double end = c.S(c.segments());
  c.sample(end, u, &s);
  TracePoint t;
  t.parameter = c.parameter();
  t.rod_length = s;
  t.axial_force_end = u[15];
  const auto& P = c.mechanics().problem;
  const auto sec = P.section(end);
  const auto k = formulation::FreeRod::kinematics<double>(formulation::lift<double>(sec, 0.0, 0.0), u[0], u[1], u[2],
                                                          u[4], u[5], u[6]);
  t.torque_end = formulation::FreeRod::twisting_moment<double>(P.material, k, u[15], u[9]);
  const Pattern q = c.pattern();
  t.contacts = segmentation::point_contacts(q) + segmentation::line_contacts(q);
  return t;
}

constexpr int max_folds = 6;  // per stretch
// a branch that has come back this far (of the parameter's size) after a limit point does not lead to the target
constexpr double largest_retreat = 0.25;

/// The margin of the same condition in another state of the same pattern.
const Margin* same_condition(const std::vector<Margin>& all, const Margin& m) {
  const Margin* best = nullptr;
  for (const Margin& x : all) {
    if (x.kind != m.kind || x.index != m.index) continue;
    if (!best || std::abs(x.S - m.S) < std::abs(best->S - m.S)) best = &x;
  }
  return best;
}

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
  const auto s = adaptive ? c.solve_adaptive(closure, options_.switcher.newton, options_.switcher.accuracy)
                          : c.solve(closure, options_.switcher.newton);
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
  events.push_back(e);
}

bool PathFollower::locate(const std::vector<double>& a, const std::vector<double>& b, Chain& at, Margin& m,
                          const Closure& closure) {
  const double va = a[closure.kind == Closure::Kind::parameter ? at.column_of_p() : closure.index];
  const double vb = b[closure.kind == Closure::Kind::parameter ? at.column_of_p() : closure.index];
  const auto& tol = options_.switcher.tolerance;
  auto value_of = [&](const Chain& c, Margin& found) {
    const auto all = segmentation::margins(c);
    const Margin* x = same_condition(all, m);
    if (!x) return std::numeric_limits<double>::quiet_NaN();  // no interior minimum: not violated
    found = *x;
    return x->value - (m.kind == CheckKind::span ? segmentation::span_floor(c, m.index, tol) : 0.0);
  };
  std::vector<double> lo = a, hi = b, x(a.size());
  double flo = 0.0, fhi = 0.0, tlo = 0.0, thi = 1.0;
  Margin found = m;
  Chain c = at;
  c.scatter_all(a);
  if (rebuild_) c.rebind(rebuild_(va));
  flo = value_of(c, found);
  c.scatter_all(b);
  if (rebuild_) c.rebind(rebuild_(vb));
  fhi = value_of(c, found);
  if (std::isnan(fhi)) return false;
  int side = 0;
  for (int it = 0; it < 60; ++it) {
    double t = 0.5 * (tlo + thi);
    if (!std::isnan(flo) && flo > 0.0 && fhi < 0.0) {
      t = tlo + (thi - tlo) * flo / (flo - fhi);
      const double guard = 1e-3 * (thi - tlo);
      t = std::clamp(t, tlo + guard, thi - guard);
    }
    const double f = (t - tlo) / (thi - tlo);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = lo[i] + f * (hi[i] - lo[i]);
    c.scatter_all(x);
    Closure here = closure;
    here.value = va + t * (vb - va);
    if (!correct(c, here, false)) return false;
    const double v = value_of(c, found);
    c.gather_all(x);
    if (!std::isnan(v) && std::abs(v) < options_.event_tolerance) {
      m = found;
      at = c;
      return true;
    }
    if (std::isnan(v) || v > 0.0) {
      lo = x;
      tlo = t;
      flo = v;
      if (side == 1) fhi *= 0.5;  // Illinois: keep the bracket shrinking from both sides
      side = 1;
    } else {
      hi = x;
      thi = t;
      fhi = v;
      if (side == -1 && !std::isnan(flo)) flo *= 0.5;
      side = -1;
    }
    if (thi - tlo < 1e-12) {
      m = found;
      at = c;
      return true;
    }
  }
  m = found;
  at = c;
  return true;
}

bool PathFollower::change_pattern(Chain& at, const std::vector<Margin>& together) {
  const Margin& m = together.front();
  const Pattern q = at.pattern();
  const double p = at.parameter();
  const Closure here{Closure::Kind::parameter, 0, p};
  const auto& tol = options_.switcher.tolerance;
  ++total_.patterns;
  // Solve a changed pattern whose new segment has the given small length, the load free; direction from the load.
  Closure seeded_closure;
  auto seed = [&](Chain& c, int segment, double span) {
    c.set_parameter_scale(std::max(1e-3, std::abs(p)));
    const Closure closure{Closure::Kind::span, segment, span};
    // New junctions are first held while the mesh adapts; then this one's are let go with the load, its symmetric
    // twins' last, lest they collapse.
    const auto fresh = segmentation::new_junctions(q, c.pattern());
    Chain held = c;
    for (int k : fresh) held.hold(k, held.S(k + 1));
    if (correct(held, {Closure::Kind::parameter, 0, c.parameter()}, true)) c = held;
    for (int k : fresh) c.release(k);
    bool others = false;
    for (int k : fresh)
      if (k != segment - 1 && k != segment) {
        c.hold(k, c.S(k + 1));
        others = true;
      }
    if (others) {
      if (!correct(c, closure, false)) return false;
      for (int k : fresh) c.release(k);
    }
    if (!correct(c, closure, true)) return false;
    seeded_closure = closure;
    return true;
  };
  // which way the load goes as the new stretch grows
  auto growth = [&](Chain& c) {
    std::vector<double> t;
    if (c.tangent(seeded_closure, t) && t[c.column_of_p()] != 0.0) return t[c.column_of_p()] > 0.0 ? 1 : -1;
    return c.parameter() >= p ? 1 : -1;
  };
  auto seeded = [&](const Pattern& r, int segment, double span, Chain& out) {
    out = at.recut(r);
    return seed(out, segment, span);
  };
  auto worst = [&](const Chain& c) {
    double w = 0.0;
    for (const Margin& v : segmentation::violations(c, segmentation::margins(c), tol)) w = std::max(w, -v.value);
    return w;
  };
  // A little beyond the event the old pattern violates its condition over a finite stretch: switch there, at fixed
  // load.
  auto beyond = [&]() {
    for (double f : {3e-4, 1e-3, 3e-3, 1e-2}) {
      const double there = p + direction_ * f * std::max(1.0, std::abs(p));
      Chain c = at;
      const Closure fixed{Closure::Kind::parameter, 0, there};
      if (!correct(c, fixed, false)) continue;
      const auto s = segmentation::switch_contact_pattern(c, fixed, options_.switcher);
      total_.newton_iterations += s.newton_iterations;
      total_.factorisations += s.factorisations;
      total_.patterns += s.patterns_tried;
      const Pattern r = c.pattern();
      if (!s.converged || r == q || r.line.size() <= q.line.size()) continue;
      // what was there before has stayed where it was
      const bool near = std::all_of(q.S.begin(), q.S.end(), [&](double S) {
        return std::any_of(r.S.begin(), r.S.end(), [&](double x) { return std::abs(x - S) < 0.05; });
      });
      if (!near) continue;
      const bool more_lines = segmentation::line_contacts(r) > segmentation::line_contacts(q);
      for (const Margin& x : together)
        record(m.kind == CheckKind::pressure ? "line_splits"
               : m.kind == CheckKind::gap    ? "contact_appears"
               : more_lines                  ? "point_to_line"
                                             : "point_splits",
               x.S, at);
      chain_ = c;
      return true;
    }
    return false;
  };
  auto neighbour_span = [&](double left, double right) { return std::min(left, right); };

  switch (m.kind) {
    case CheckKind::gap: {
      Pattern r = q;
      for (const Margin& x : together) r = segmentation::insert_point(r, x.index, x.S);
      Chain c = at.recut(r);
      const auto summary = segmentation::solve_with_fresh_junctions(
          c, segmentation::new_junctions(q, r), here, options_.switcher.newton, options_.switcher.accuracy);
      note(summary);
      if (!summary.converged) return beyond();
      for (const Margin& x : together) record("contact_appears", x.S, at);
      chain_ = c;
      return true;
    }
    case CheckKind::reaction: {
      Pattern r = q;
      for (const Margin& x : together) {
        if (q.line[x.index] || q.line[x.index + 1]) {
          total_.reason = "the reaction at the end of a line contact vanishes";
          return false;
        }
        r = segmentation::remove_point(r, x.index);
      }
      Chain c = at.recut(r);
      if (!correct(c, here, true)) return false;
      for (const Margin& x : together) record("contact_leaves", x.S, at);
      chain_ = c;
      return true;
    }
    case CheckKind::curvature: {
      for (double f : {0.02, 0.05, 0.01})
        for (const bool line : {true, false}) {
          Pattern r = q;
          double span = 0.0;
          for (const Margin& x : together) {
            span = f * neighbour_span(at.S(x.index + 1) - at.S(x.index), at.S(x.index + 2) - at.S(x.index + 1));
            r = line ? segmentation::point_to_line(r, x.index, span) : segmentation::point_to_two(r, x.index, span);
          }
          Chain c;
          if (!seeded(r, together.back().index + 1, span, c) || worst(c) > 0.0) continue;
          for (const Margin& x : together) record(line ? "point_to_line" : "point_splits", x.S, at);
          direction_ = growth(c);
          chain_ = c;
          return true;
        }
      if (beyond()) return true;
      total_.reason = "neither a line nor two points are admissible where a point contact exceeds the curvature limit";
      return false;
    }
    case CheckKind::pressure: {
      for (double f : {0.05, 0.08, 0.03, 0.12, 0.2, 0.06, 0.04}) {
        // the load at which the beam fits the wall over this span: p̂_min = -½ p̂'' l²/5 in the old pattern
        const double span = f * (at.S(m.index + 1) - at.S(m.index));
        const double second = 720.0 * segmentation::opening_at(at, m.index, m.S, span).k;
        const double wanted = -0.5 * second * 0.25 * span * span / 5.0;
        auto lowest_at = [&](Chain& c, double value) {
          if (!correct(c, {Closure::Kind::parameter, 0, value}, false)) return std::numeric_limits<double>::quiet_NaN();
          const auto all = segmentation::margins(c);
          const Margin* v = same_condition(all, m);
          return v ? v->raw : std::numeric_limits<double>::quiet_NaN();
        };
        Chain base = at;
        const double nudge = direction_ * 1e-4 * std::max(1.0, std::abs(p)), low = lowest_at(base, p + nudge);
        if (!std::isfinite(low) || low >= 0.0) continue;
        if (!std::isfinite(lowest_at(base, p + nudge * wanted / low))) continue;
        std::vector<segmentation::Opening> openings;
        for (const Margin& x : together)
          openings.push_back(segmentation::opening_at(base, x.index, x.S, f * (at.S(x.index + 1) - at.S(x.index))));
        int free = 0;
        Chain c = segmentation::open_lines(base, openings, free);
        if (!seed(c, free, openings.back().span) || worst(c) > 0.0) continue;
        for (const Margin& x : together) record("line_splits", x.S, at);
        direction_ = growth(c);
        chain_ = c;
        return true;
      }
      if (beyond()) return true;
      total_.reason = "no admissible way to open a line contact where its pressure vanishes";
      return false;
    }
    case CheckKind::span:
      return collapse(at, together);
  }
  return false;
}

Chain PathFollower::locate_branch_point(const std::vector<double>& a, const std::vector<double>& b, const Chain& on) {
  // The response y to a fixed load grows without bound; 1/(c·y) passes through zero smoothly, with c the response at b.
  Chain c = on;
  const int ip = c.column_of_p();
  std::vector<double> x(a.size()), y, direction;
  auto inverse = [&](double f, const std::vector<double>& guess) {
    c.scatter_all(guess);
    const Closure closure{Closure::Kind::parameter, 0, a[ip] + f * (b[ip] - a[ip])};
    if (!correct(c, closure, false) || !c.response(closure, y)) return std::numeric_limits<double>::quiet_NaN();
    if (direction.empty()) {
      double norm = 0.0;
      for (double v : y) norm += v * v;
      direction = y;
      for (double& v : direction) v /= norm;
    }
    double dot = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) dot += direction[i] * y[i];
    return 1.0 / dot;
  };
  // Solved places and the value there; at the root itself the equations are singular, so it is interpolated from a
  // few places beside it (the value is smooth in f).
  std::vector<std::pair<double, double>> known;
  auto solve_at = [&](double f) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = a[i] + f * (b[i] - a[i]);
    const double g = inverse(f, x);
    if (std::isfinite(g)) known.emplace_back(f, g);
    return std::isfinite(g);
  };
  auto interpolated = [&](double f) {  // Newton's divided differences through the places nearest in the list
    std::vector<double> d;
    for (const auto& k : known) d.push_back(k.second);
    for (std::size_t j = 1; j < d.size(); ++j)
      for (std::size_t i = d.size() - 1; i >= j; --i) d[i] = (d[i] - d[i - 1]) / (known[i].first - known[i - j].first);
    double v = d.back();
    for (std::size_t i = d.size() - 1; i-- > 0;) v = v * (f - known[i].first) + d[i];
    return v;
  };
  auto root_of = [&]() {
    double lo = 0.0, hi = 1.0;
    const double at_lo = interpolated(lo);
    for (int it = 0; it < 60; ++it) {
      const double mid = 0.5 * (lo + hi);
      (interpolated(mid) * at_lo > 0.0 ? lo : hi) = mid;
    }
    return 0.5 * (lo + hi);
  };
  double root = 0.5;
  if (solve_at(1.0) && solve_at(0.0) && known[0].second * known[1].second < 0.0) {
    root = root_of();
    double spread = 0.3;
    for (int round = 0; round < 4; ++round, spread *= 0.4) {
      for (double side : {-1.0, 1.0}) {
        const double f = std::clamp(root + side * spread, 0.02 + 0.01 * round, 0.98 - 0.01 * round);
        if (std::none_of(known.begin(), known.end(), [&](const auto& k) { return std::abs(k.first - f) < 1e-3; }))
          solve_at(f);
      }
      root = root_of();
    }
  }
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = a[i] + root * (b[i] - a[i]);
  c.scatter_all(x);
  if (correct(c, {Closure::Kind::parameter, 0, a[ip] + root * (b[ip] - a[ip])}, false)) return c;
  c.scatter_all(x);
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

bool PathFollower::collapse(const Chain& at, const std::vector<Margin>& together) {
  const Pattern q = at.pattern();
  const double p = at.parameter();
  Pattern r = q;
  for (const Margin& m : together) {
    if (m.index == 0 || m.index + 1 == at.segments()) {
      total_.reason = "a contact reaches an end of the rod";
      return false;
    }
    r = segmentation::remove_segment(r, m.index);
  }
  const int j = together.back().index;  // the first along the rod: its index is the same in both patterns
  const bool line = q.line[j], joined_line = !line && q.line[j - 1] && q.line[j + 1];
  Chain c = at.recut(r);
  if (!correct(c, {Closure::Kind::parameter, 0, p}, true)) return false;
  // the exact event, seen from the other side: a point at its curvature limit, or a joined line at zero pressure
  Margin limit;
  limit.kind = joined_line ? CheckKind::pressure : CheckKind::curvature;
  limit.index = j - 1;
  limit.S = 0.5 * (at.S(j) + at.S(j + 1));
  Chain event = c;
  auto limit_at = [&](double value) {
    if (!correct(event, {Closure::Kind::parameter, 0, value}, false)) return std::numeric_limits<double>::quiet_NaN();
    const auto all = segmentation::margins(event);
    const Margin* v = same_condition(all, limit);
    return v ? v->value : std::numeric_limits<double>::quiet_NaN();
  };
  const double size = std::max(1.0, std::abs(p));
  double p0 = p, p1 = p + 1e-4 * (direction_ ? direction_ : 1) * size, f0 = limit_at(p0), f1 = limit_at(p1);
  for (int it = 0;
       it < 20 && std::isfinite(f0) && std::isfinite(f1) && f1 != f0 && std::abs(f1) > options_.event_tolerance; ++it) {
    const double p2 = p1 - f1 * (p1 - p0) / (f1 - f0);
    if (!(std::abs(p2 - p) < 0.05 * size)) break;
    p0 = p1;
    f0 = f1;
    p1 = p2;
    f1 = limit_at(p1);
  }
  if (!(std::abs(f1) <= 1e-8)) return false;
  // a stretch that has only just opened is not about to close
  if (!events.empty() && std::abs(p1 - events.back().parameter) < 1e-6 * size) return false;
  if (!segmentation::violations(event, segmentation::margins(event), options_.switcher.tolerance).empty()) return false;
  ++total_.patterns;
  for (const Margin& m : together) record(line ? "line_to_point" : "contacts_merge", m.S, event);
  chain_ = event;
  return true;
}

bool PathFollower::collapse_shortest() {
  const int n = chain_.segments();
  std::vector<Margin> candidates;
  for (int j = 1; j + 1 < n; ++j) {
    const double span = chain_.S(j + 1) - chain_.S(j);
    const double beside = std::min(chain_.S(j) - chain_.S(j - 1), chain_.S(j + 2) - chain_.S(j + 1));
    if (span < 0.3 * beside)
      candidates.push_back({CheckKind::span, j, 0.5 * (chain_.S(j) + chain_.S(j + 1)), span, span, 0.0});
  }
  std::sort(candidates.begin(), candidates.end(), [](const Margin& a, const Margin& b) { return a.raw < b.raw; });
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    std::vector<Margin> together;
    for (const Margin& m : candidates)
      if (std::abs(m.raw - candidates[i].raw) < 1e-3 * candidates[i].raw) together.push_back(m);
    std::sort(together.begin(), together.end(), [](const Margin& a, const Margin& b) { return a.index > b.index; });
    const Chain keep = chain_;
    if (collapse(keep, together)) {
      if (chain_.parameter() != keep.parameter()) direction_ = chain_.parameter() > keep.parameter() ? 1 : -1;
      return true;
    }
    chain_ = keep;
  }
  return false;
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
    chain_.set_parameter_scale(p_scale);
    chain_.gather_all(x1);
    // direction of the path: secant if there is one on this mesh, else the tangent
    Closure closure{Closure::Kind::parameter, 0, chain_.parameter()};
    std::vector<double> d;
    bool have_tangent = false;
    const int n = chain_.unknowns();
    if (!previous_.empty() && previous_.size() == x1.size()) {
      d.resize(x1.size());
      for (std::size_t i = 0; i < d.size(); ++i) d[i] = x1[i] - previous_[i];
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
    if (options_.arclength && std::abs(d[ip]) / scale[ip] < 0.1 * fastest)
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
    step_ = std::clamp(length * rate * (iterations <= 5 ? 1.8 : iterations <= 8 ? 1.2 : 0.6), 1e-7, options_.max_step);
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
    if (options_.arclength && (closure.kind == Closure::Kind::parameter ||
                               next.tangent({Closure::Kind::parameter, 0, next.parameter()}, tangent)))
      sign = next.determinant_sign();
    const bool turned = !previous_.empty() && (x1[ip] - previous_[ip]) * dp_now < 0.0;
    const bool crossed = !turned && sign * last_sign_ < 0;
    last_sign_ = sign;
    if (crossed) {
      const Chain branching = locate_branch_point(x1, x2, next);
      record("branch_point", 0.0, branching);
      if (options_.leave_branch) {
        if (auto stable = options_.leave_branch(next)) {
          const double before_length = trace_point(next).rod_length, after_length = trace_point(*stable).rod_length;
          if (std::abs(after_length - before_length) > 1e-3 * before_length) record("jump", 0.0, branching);
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
    if (e > options_.switcher.accuracy) {
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

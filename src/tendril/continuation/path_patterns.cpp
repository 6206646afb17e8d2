// Changes of the contact pattern at a located event: seeded with a small length and the load free, or taken out.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tendril/continuation/path_detail.hpp"
#include "tendril/continuation/path_follower.hpp"
#include "tendril/segmentation/collars.hpp"
#include "tendril/segmentation/flat_lines.hpp"
#include "tendril/segmentation/pattern_edit.hpp"
#include "tendril/segmentation/seeding.hpp"
#include "tendril/segmentation/tip.hpp"

namespace tendril::continuation {

using segmentation::Chain;
using segmentation::CheckKind;
using segmentation::Closure;
using segmentation::Margin;
using segmentation::Pattern;

PathFollower::Change PathFollower::change_pattern(Chain& at, const Chain& sharp, const std::vector<Margin>& together) {
  const Margin& m = together.front();
  const Change none{false, 0, sharp};
  const Pattern q = at.pattern();
  const double p = at.parameter();
  const Closure here{Closure::Kind::parameter, 0, p};
  const auto& tol = options_.switcher.tolerance;
  ++total_.patterns;
  std::vector<double> unused;
  const double size = natural_size(at, unused);
  // Solve a changed pattern whose new segment has the given small length, the load free; direction from the load.
  Closure seeded_closure;
  auto seed = [&](Chain& c, int segment, double span) {
    c.set_parameter_scale(size);
    const Closure closure{Closure::Kind::span, segment, span};
    // New junctions are first held while the mesh adapts; then all are let go with the load, or, where that fails, the
    // symmetric twins' last, lest they collapse.
    const auto fresh = segmentation::new_junctions(q, c.pattern());
    Chain held = c;
    for (int k : fresh) held.hold(k, held.S(k + 1));
    if (correct(held, {Closure::Kind::parameter, 0, c.parameter()}, true)) c = held;
    for (int k : fresh) c.release(k);
    Chain together_free = c;
    if (correct(together_free, closure, true)) {
      c = together_free;
      seeded_closure = closure;
      return true;
    }
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
    if (!segmentation::has_flat_line(c) && c.tangent(seeded_closure, t) && t[c.column_of_p()] != 0.0)
      return t[c.column_of_p()] > 0.0 ? 1 : -1;
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
      const double there = p + direction_ * f * size;
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
               x.S, sharp);
      chain_ = c;
      return Change{true, direction_, sharp};
    }
    return none;
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
      for (const Margin& x : together) record("contact_appears", x.S, sharp);
      // on a branch that is pushed back by the wall the load turns here: go on where the new contact presses
      const auto fresh = segmentation::new_junctions(q, r);
      const int onward = fresh.empty()
                             ? direction_
                             : rising(c, [&](const Chain& x) { return segmentation::reaction(x, fresh.front()); });
      chain_ = c;
      return {true, onward, sharp};
    }
    case CheckKind::reaction: {
      Pattern r = q;
      for (const Margin& x : together) {
        if (q.line[x.index] || q.line[x.index + 1]) {
          total_.reason = "the reaction at the end of a line contact vanishes";
          return none;
        }
        r = segmentation::remove_point(r, x.index);
      }
      Chain c = at.recut(r);
      if (!correct(c, here, true)) return none;
      for (const Margin& x : together) record("contact_leaves", x.S, sharp);
      const int onward =
          rising(c, [&](const Chain& x) { return segmentation::relative_gap(x, x.segment_at(m.S), m.S); });
      chain_ = c;
      return {true, onward, sharp};
    }
    case CheckKind::curvature: {
      // Along a flat wall two points over a straight span are a line that carries nothing: a line is sought first.
      for (const bool line : {true, false})
        for (double f : {0.02, 0.05, 0.01}) {
          Pattern r = q;
          double span = 0.0;
          for (const Margin& x : together) {
            span = f * neighbour_span(at.S(x.index + 1) - at.S(x.index), at.S(x.index + 2) - at.S(x.index + 1));
            r = line ? segmentation::point_to_line(r, x.index, span) : segmentation::point_to_two(r, x.index, span);
          }
          Chain c;
          if (!seeded(r, together.back().index + 1, span, c) || worst(c) > 0.0) continue;
          for (const Margin& x : together) record(line ? "point_to_line" : "point_splits", x.S, sharp);
          chain_ = c;
          return {true, growth(c), sharp};
        }
      if (const Change there = beyond(); there.done) return there;
      total_.reason = "neither a line nor two points are admissible where a point contact exceeds the curvature limit";
      return none;
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
        const double nudge = direction_ * 1e-4 * size, low = lowest_at(base, p + nudge);
        if (!std::isfinite(low) || low >= 0.0) continue;
        if (!std::isfinite(lowest_at(base, p + nudge * wanted / low))) continue;
        std::vector<segmentation::Opening> openings;
        for (const Margin& x : together)
          openings.push_back(segmentation::opening_at(base, x.index, x.S, f * (at.S(x.index + 1) - at.S(x.index))));
        int free = 0;
        Chain c = segmentation::open_lines(base, openings, free);
        if (!seed(c, free, openings.back().span) || worst(c) > 0.0) continue;
        for (const Margin& x : together) record("line_splits", x.S, sharp);
        chain_ = c;
        return {true, growth(c), sharp};
      }
      if (const Change there = beyond(); there.done) return there;
      total_.reason = "no admissible way to open a line contact where its pressure vanishes";
      return none;
    }
    case CheckKind::buckling:
      for (const Margin& x : together) record("line_splits", x.S, sharp);
      total_.reason = "the stretch along the wall buckles away from it";
      return none;
    case CheckKind::tip_gap:
    case CheckKind::tip_reaction: {
      if (q.line.back()) {
        total_.reason = "the reaction at the tip end of a line contact vanishes";
        return none;
      }
      Pattern r = q;
      r.tip = m.kind == CheckKind::tip_gap;
      Chain c = at.recut(r);
      if (!correct(c, here, true)) return none;
      record(r.tip ? "tip_touches" : "tip_leaves", m.S, sharp);
      // a branch may turn where the wall meets the tip: go on where the tip presses, or is off the wall
      const int onward = rising(c, [&](const Chain& x) {
        const auto tip = segmentation::tip_state(x);
        return r.tip ? tip.reaction : tip.gap;
      });
      chain_ = c;
      return {true, onward, sharp};
    }
    case CheckKind::collar_gap:
    case CheckKind::collar_reaction: {
      std::vector<int> which;
      for (const Margin& x : together) which.push_back(x.index);
      const std::size_t count = at.mechanics().problem.collars.size();
      Chain c = at.recut(segmentation::collar_patterns(q, which, count).front());
      if (!correct(c, here, true)) return none;
      const bool touches = m.kind == CheckKind::collar_gap;
      for (const Margin& x : together) record(touches ? "contact_appears" : "contact_leaves", x.S, sharp);
      const int onward = rising(c, [&](const Chain& x) {
        for (const auto& v : segmentation::margins(x))
          if (v.index == m.index && (v.kind == (touches ? CheckKind::collar_reaction : CheckKind::collar_gap)))
            return v.value;
        return 0.0;
      });
      chain_ = c;
      return {true, onward, sharp};
    }
    case CheckKind::tip_approach: {
      const int n = at.segments();
      for (double f : {0.02, 0.05, 0.01, 0.1}) {
        const double span = f * (at.S(n) - at.S(n - 1));
        Pattern r = q;
        r.tip = false;
        r.line.push_back(0);
        r.S.push_back(at.S(n) - span);
        Chain c;
        if (!seeded(r, n, span, c) || worst(c) > 0.0) continue;
        record("tip_leaves", m.S, sharp);
        record("contact_appears", m.S, sharp);
        chain_ = c;
        return {true, growth(c), sharp};
      }
      total_.reason = "no admissible way to lift the tip where the rod comes to lie along the wall";
      return none;
    }
    case CheckKind::tip_couple:
      total_.reason = "a line contact that reaches the tip leaves the wall there";
      return none;
    case CheckKind::span:
      return collapse(at, together);
  }
  return none;
}

double PathFollower::natural_size(const Chain& at, std::vector<double>& t) {
  const double own = std::max(1e-3, std::abs(at.parameter()));
  t.clear();
  if (segmentation::has_flat_line(at)) return std::min(own, p_unit_);
  Chain c = at;
  if (!c.tangent({Closure::Kind::parameter, 0, at.parameter()}, t)) {
    t.clear();
    return std::min(own, p_unit_);
  }
  std::vector<double> scale;
  c.scales(scale);
  double fastest = 0.0;
  for (int i = 0; i < c.column_of_p(); ++i) fastest = std::max(fastest, std::abs(t[i]) / scale[i]);
  return std::isfinite(fastest) && fastest > 0.0 ? std::min(own, 1.0 / fastest) : std::min(own, p_unit_);
}

int PathFollower::rising(const Chain& at, const std::function<double(const Chain&)>& value) {
  std::vector<double> t;
  const double size = natural_size(at, t);
  if (t.empty() || rebuild_) return 0;
  Chain probe = at;
  probe.advance(t, direction_ * 1e-5 * size);
  return value(probe) < value(at) ? -direction_ : direction_;
}

PathFollower::Change PathFollower::collapse(const Chain& at, const std::vector<Margin>& together) {
  const Change none{false, 0, at};
  const Pattern q = at.pattern();
  const double p = at.parameter();
  Pattern r = q;
  bool to_tip = false;
  for (const Margin& m : together) {
    const bool last = m.index + 1 == at.segments();
    to_tip = last && !q.line[m.index] && !q.line[m.index - 1] && at.mechanics().problem.tip_free();
    if (m.index == 0 || (last && !to_tip)) {
      total_.reason = "a contact reaches an end of the rod";
      return none;
    }
    r = segmentation::without_segment(at, r, m.index);
  }
  const int j = together.back().index;  // the first along the rod: its index is the same in both patterns
  const bool line = q.line[j], joined_line = !line && !to_tip && q.line[j - 1] && q.line[j + 1];
  Chain c = at.recut(r);
  if (!correct(c, {Closure::Kind::parameter, 0, p}, true)) return none;
  // the exact event, seen from the other side: a point at its curvature limit, or a joined line at zero pressure
  Margin limit;
  limit.kind = to_tip ? CheckKind::tip_approach : joined_line ? CheckKind::pressure : CheckKind::curvature;
  limit.index = j - 1;
  limit.S = 0.5 * (at.S(j) + at.S(j + 1));
  Chain event = c;
  auto limit_at = [&](double value) {
    if (!correct(event, {Closure::Kind::parameter, 0, value}, false)) return std::numeric_limits<double>::quiet_NaN();
    const auto all = segmentation::margins(event);
    const Margin* v = same_condition(all, limit);
    return v ? v->value : std::numeric_limits<double>::quiet_NaN();
  };
  std::vector<double> unused;
  const double size = natural_size(c, unused);
  double p0 = p, p1 = p + 1e-4 * (direction_ ? direction_ : 1) * size, f0 = limit_at(p0), f1 = limit_at(p1);
  for (int it = 0;
       it < 20 && std::isfinite(f0) && std::isfinite(f1) && f1 != f0 && std::abs(f1) > options_.event_tolerance; ++it) {
    const double p2 = p1 - f1 * (p1 - p0) / (f1 - f0);
    if (!(std::abs(p2 - p) < 0.2 * size)) break;
    p0 = p1;
    f0 = f1;
    p1 = p2;
    f1 = limit_at(p1);
  }
  if (!(std::abs(f1) <= 1e-8)) return none;
  sharpen(event, limit);
  // a stretch that has only just opened is not about to close: its event lies behind
  if ((event.parameter() - p) * direction_ < -1e-9 * size) return none;
  if (!segmentation::violations(event, segmentation::margins(event), options_.switcher.tolerance).empty()) return none;
  ++total_.patterns;
  const auto all = segmentation::margins(event);
  for (std::size_t i = 0; i < together.size(); ++i) {
    Margin x = limit;
    x.index = together[i].index - 1 - static_cast<int>(together.size() - 1 - i) * (joined_line ? 2 : 1);
    x.S = together[i].S;
    const Margin* found = same_condition(all, x);
    record(to_tip ? "tip_touches" : line ? "line_to_point" : "contacts_merge", found ? found->S : x.S, event);
  }
  const int onward = rising(event, [&](const Chain& x) {
    const auto margins = segmentation::margins(x);
    const Margin* v = same_condition(margins, limit);
    return v ? v->value : std::numeric_limits<double>::infinity();  // no minimum left: further off
  });
  chain_ = event;
  return {true, onward, event};
}

std::vector<Margin> PathFollower::short_spans() const {
  std::vector<Margin> out;
  for (int j = 1; j + 1 < chain_.segments(); ++j) {
    const double span = chain_.S(j + 1) - chain_.S(j);
    const double beside = std::min(chain_.S(j) - chain_.S(j - 1), chain_.S(j + 2) - chain_.S(j + 1));
    if (span < 0.3 * beside)
      out.push_back({CheckKind::span, j, 0.5 * (chain_.S(j) + chain_.S(j + 1)), span, span, 0.0});
  }
  std::sort(out.begin(), out.end(), [](const Margin& a, const Margin& b) { return a.raw < b.raw; });
  return out;
}

bool PathFollower::land_along_span(double target) {
  // near its vanishing a short stretch decides everything: its length is the natural unknown, the load a smooth
  // function of it (growing with its square where a line opens), also where steps of the load find nothing
  constexpr double largest_change = 0.3, smallest_change = 0.02;  // of the length
  constexpr int most_steps = 60;
  for (const Margin& m : short_spans()) {
    Chain c = chain_;
    std::vector<double> t;
    double last_rate = 0.0, limit = largest_change;
    for (int it = 0; it < most_steps && limit > smallest_change; ++it) {
      const double span = c.S(m.index + 1) - c.S(m.index), off = target - c.parameter();
      Closure closure{Closure::Kind::span, m.index, span};
      if (!c.tangent(closure, t)) break;
      const double rate = t[c.column_of_p()];
      if (rate == 0.0 || rate * last_rate < 0.0) break;  // the load turns: another branch begins
      last_rate = rate;
      const double change = std::clamp(off / rate, -limit * span, limit * span);
      Chain next = c;
      next.advance(t, change);
      if (std::abs(off) <= std::abs(rate * limit * span)) {
        Chain landed = next;
        landed.set_parameter(target);
        if (correct(landed, {Closure::Kind::parameter, 0, target}, false)) {
          const double there = landed.S(m.index + 1) - landed.S(m.index);
          auto bad = segmentation::violations(landed, segmentation::margins(landed), options_.switcher.tolerance);
          std::erase_if(bad, [](const Margin& b) { return b.kind == CheckKind::span; });
          if (bad.empty() && there > 0.0 && std::abs(there - span - change) < 0.5 * limit * span) {
            chain_ = landed;
            start_anew(step_);
            trace.push_back(trace_point(chain_));
            return true;
          }
        }
      }
      closure.value = span + change;
      if (correct(next, closure, false))
        c = std::move(next);
      else
        limit *= 0.5;
    }
  }
  return false;
}

PathFollower::Change PathFollower::collapse_shortest(double target, bool& beyond) {
  beyond = false;
  const std::vector<Margin> candidates = short_spans();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    std::vector<Margin> together;
    for (const Margin& m : candidates)
      if (std::abs(m.raw - candidates[i].raw) < 1e-3 * candidates[i].raw) together.push_back(m);
    std::sort(together.begin(), together.end(), [](const Margin& a, const Margin& b) { return a.index > b.index; });
    const Chain keep = chain_;
    const std::size_t before = events.size();
    Change change = collapse(keep, together);
    const double p = keep.parameter();
    if (change.done && (change.event.parameter() - target) * (p - target) > 0.0) return change;
    beyond = beyond || change.done;
    events.resize(before);  // nothing, or only beyond the target
    chain_ = keep;
  }
  return {};
}

}  // namespace tendril::continuation

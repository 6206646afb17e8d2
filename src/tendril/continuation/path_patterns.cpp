// Changes of the contact pattern at a located event: seeded with a small length and the load free, or taken out.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tendril/continuation/path_detail.hpp"
#include "tendril/continuation/path_follower.hpp"
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
    c.set_parameter_scale(std::min(std::max(1e-3, std::abs(p)), p_unit_));
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
      const double there = p + direction_ * f * std::min(std::max(1.0, std::abs(p)), p_unit_);
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
      // on a branch that is pushed back by the wall the load turns here: go on where the new contact presses
      std::vector<double> t;
      const auto fresh = segmentation::new_junctions(q, r);
      if (!fresh.empty() && c.tangent(here, t)) {
        Chain probe = c;
        probe.advance(t, direction_ * 1e-5 * p_unit_);
        if (segmentation::reaction(probe, fresh.front()) < segmentation::reaction(c, fresh.front()))
          direction_ = -direction_;
      }
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
        const double nudge = direction_ * 1e-4 * std::min(std::max(1.0, std::abs(p)), p_unit_),
                     low = lowest_at(base, p + nudge);
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
    case CheckKind::buckling:
      for (const Margin& x : together) record("line_splits", x.S, at);
      total_.reason = "the stretch along the wall buckles away from it";
      return false;
    case CheckKind::tip_gap:
    case CheckKind::tip_reaction: {
      if (q.line.back()) {
        total_.reason = "the reaction at the tip end of a line contact vanishes";
        return false;
      }
      Pattern r = q;
      r.tip = m.kind == CheckKind::tip_gap;
      Chain c = at.recut(r);
      if (!correct(c, here, true)) return false;
      record(r.tip ? "tip_touches" : "tip_leaves", m.S, at);
      // a branch may turn where the wall meets the tip: go on where the tip presses
      std::vector<double> t;
      if (r.tip && c.tangent(here, t)) {
        Chain probe = c;
        probe.advance(t, direction_ * 1e-5 * p_unit_);
        if (segmentation::tip_state(probe).reaction < segmentation::tip_state(c).reaction) direction_ = -direction_;
      }
      chain_ = c;
      return true;
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
        record("tip_leaves", m.S, at);
        record("contact_appears", m.S, at);
        direction_ = growth(c);
        chain_ = c;
        return true;
      }
      total_.reason = "no admissible way to lift the tip where the rod comes to lie along the wall";
      return false;
    }
    case CheckKind::tip_couple:
      total_.reason = "a line contact that reaches the tip leaves the wall there";
      return false;
    case CheckKind::span:
      return collapse(at, together);
  }
  return false;
}

bool PathFollower::collapse(const Chain& at, const std::vector<Margin>& together) {
  const Pattern q = at.pattern();
  const double p = at.parameter();
  Pattern r = q;
  bool to_tip = false;
  for (const Margin& m : together) {
    const bool last = m.index + 1 == at.segments();
    to_tip = last && !q.line[m.index] && !q.line[m.index - 1] && at.mechanics().problem.tip_free();
    if (m.index == 0 || (last && !to_tip)) {
      total_.reason = "a contact reaches an end of the rod";
      return false;
    }
    r = segmentation::without_segment(at, r, m.index);
  }
  const int j = together.back().index;  // the first along the rod: its index is the same in both patterns
  const bool line = q.line[j], joined_line = !line && !to_tip && q.line[j - 1] && q.line[j + 1];
  Chain c = at.recut(r);
  if (!correct(c, {Closure::Kind::parameter, 0, p}, true)) return false;
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
  const double size = std::min(std::max(1.0, std::abs(p)), p_unit_);
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
  for (const Margin& m : together)
    record(to_tip ? "tip_touches" : line ? "line_to_point" : "contacts_merge", m.S, event);
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

}  // namespace tendril::continuation

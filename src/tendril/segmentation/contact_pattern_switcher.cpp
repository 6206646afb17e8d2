#include "tendril/segmentation/contact_pattern_switcher.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tendril/segmentation/collars.hpp"
#include "tendril/segmentation/nested.hpp"
#include "tendril/segmentation/pattern_edit.hpp"
#include "tendril/segmentation/pattern_windows.hpp"
#include "tendril/segmentation/seeding.hpp"
#include "tendril/segmentation/tip.hpp"

namespace tendril::segmentation {

double span_floor(const Chain& chain, int j, const ContactTolerances& t) {
  double ref = std::numeric_limits<double>::infinity();
  if (j > 0) ref = std::min(ref, chain.S(j) - chain.S(j - 1));
  if (j + 1 < chain.segments()) ref = std::min(ref, chain.S(j + 2) - chain.S(j + 1));
  return std::isfinite(ref) ? t.span * ref : 0.0;
}

std::vector<Margin> violations(const Chain& chain, const std::vector<Margin>& all, const ContactTolerances& t) {
  std::vector<Margin> bad;
  for (Margin m : all) {
    double tolerance = 0.0;
    switch (m.kind) {
      case CheckKind::span:
        m.value -= span_floor(chain, m.index, t);
        break;
      case CheckKind::reaction:
        tolerance = t.reaction;
        break;
      case CheckKind::curvature:
        tolerance = t.curvature;
        break;
      case CheckKind::gap:
        tolerance = t.gap;
        break;
      case CheckKind::pressure:
        if (m.pull >= -t.pressure) continue;
        break;
      case CheckKind::buckling:
        break;
      case CheckKind::tip_gap:
        tolerance = t.gap;
        break;
      case CheckKind::tip_reaction:
        tolerance = t.reaction;
        break;
      case CheckKind::tip_approach:
      case CheckKind::tip_couple:
        tolerance = t.curvature;
        break;
      case CheckKind::collar_gap:
        tolerance = t.gap;
        break;
      case CheckKind::collar_reaction:
        tolerance = t.reaction;
        break;
    }
    if (m.value < -tolerance) bad.push_back(m);
  }
  // Penetration beside a point contact that exceeds the curvature limit is the same violation seen twice.
  std::erase_if(bad, [&](const Margin& g) {
    return g.kind == CheckKind::gap && std::any_of(bad.begin(), bad.end(), [&](const Margin& c) {
             return c.kind == CheckKind::curvature && (c.index == g.index || c.index + 1 == g.index);
           });
  });
  std::stable_sort(bad.begin(), bad.end(), [](const Margin& a, const Margin& b) {
    return a.kind != b.kind ? a.kind < b.kind : a.value < b.value;
  });
  return bad;
}

namespace {

struct Visited {
  std::vector<Pattern> patterns;
  double apart = 2e-3;  // places closer than this are the same
  bool seen(const Pattern& q) const {
    return std::any_of(patterns.begin(), patterns.end(), [&](const Pattern& v) {
      if (v.line != q.line || v.tip != q.tip || v.collar != q.collar) return false;
      for (std::size_t i = 0; i < q.S.size(); ++i)
        if (std::abs(v.S[i] - q.S[i]) > apart) return false;
      return true;
    });
  }
};

/// Stretch around junction k over which the free state beside a point contact passes the wall.
double penetrated_span(const Chain& chain, int k) {
  const double S = chain.S(k + 1);
  const double left = S - chain.S(k), right = chain.S(k + 2) - S;
  double a = 0.0, b = 0.0;
  for (int i = 1; i <= 200; ++i) {
    const double f = 0.5 * i / 200.0;
    if (relative_gap(chain, k, S - f * left) < 0.0) a = f * left;
    if (relative_gap(chain, k + 1, S + f * right) < 0.0) b = f * right;
  }
  return a + b;
}

/// The segment between contacts that lost most of its length; none below a third.
int shrunk_segment(const Chain& before, const Chain& after) {
  double least = 2.0 / 3.0;
  int found = -1;
  for (int j = 1; j + 1 < before.segments(); ++j) {
    const double ratio = (after.S(j + 1) - after.S(j)) / (before.S(j + 1) - before.S(j));
    if (ratio < least) {
      least = ratio;
      found = j;
    }
  }
  return found;
}

/// As solve_with_fresh_junctions, by SolveSequence where it applies.
NewtonSummary solve_nested(Chain& chain, const std::vector<int>& fresh, const Closure& closure,
                           const SwitcherOptions& options, SwitcherSummary& sum) {
  NewtonSummary total = settle_fresh_junctions(chain, fresh, options.newton);
  NewtonSummary s;
  if (closure.kind == Closure::Kind::parameter && !chain.mechanics().problem.varies()) {
    SequenceOptions o;
    o.newton = options.newton;
    o.accuracy = options.accuracy;
    const SequenceSummary q = solve_sequence(chain, closure.value, o);
    s = {q.converged, q.elementary_iterations, q.factorisations, q.correction, q.reason};
  }
  total.iterations += s.iterations;
  total.factorisations += s.factorisations;
  ++(s.converged ? sum.nested_solves : sum.nested_fallbacks);
  if (!s.converged) {
    s = chain.solve_adaptive(closure, options.newton, options.accuracy);
    total.iterations += s.iterations;
    total.factorisations += s.factorisations;
  }
  total.converged = s.converged;
  total.correction = s.correction;
  total.reason = s.reason;
  return total;
}

}  // namespace

SwitcherSummary switch_contact_pattern(Chain& chain, const Closure& closure, const SwitcherOptions& options) {
  if (options.windows && !options.nested && closure.kind == Closure::Kind::parameter &&
      chain.segments() >= long_chain) {
    Chain whole = chain;
    whole.set_parameter(closure.value);
    const SwitcherSummary w = switch_in_windows(whole, options, false);
    chain = std::move(whole);
    return w;
  }
  SwitcherSummary sum;
  Visited visited;
  visited.apart *= chain.S(chain.segments()) - chain.S(0);
  NewtonOptions newton = options.newton;
  auto run = [&](Chain& c, const Pattern* before = nullptr) {
    if (options.newton.stop.asked()) {
      sum.reason = options.newton.stop.reason();
      return false;
    }
    const auto fresh = before ? new_junctions(*before, c.pattern()) : std::vector<int>{};
    const NewtonSummary s = options.nested ? solve_nested(c, fresh, closure, options, sum)
                                           : solve_with_fresh_junctions(c, fresh, closure, newton, options.accuracy);
    sum.newton_iterations += s.iterations;
    sum.factorisations += s.factorisations;
    ++sum.patterns_tried;
    if (!s.converged) sum.reason = s.reason;
    if (options.observer) options.observer(c, s);
    return s.converged;
  };
  // Badness of a candidate between two places: how far it is from admissible, to choose between line and two points.
  const auto violated = [&](const Chain& c) {
    auto bad = violations(c, margins(c), options.tolerance);
    std::erase_if(bad, [&](const Margin& m) { return m.S < options.from || m.S > options.to; });
    return bad;
  };
  auto badness = [&](const Chain& c, double from, double to) {
    double worst = 0.0;
    for (const Margin& m : violated(c))
      if (m.S >= from && m.S <= to) worst = std::max(worst, -m.value);
    return worst;
  };
  Chain given = options.guess ? chain : Chain();
  for (int left = options.guess ? 6 : 0; !run(chain); --left) {
    if (left == 0) return sum;
    int gone = shrunk_segment(given, chain);
    // far from the solution the residuals are at times the better guide
    if (!newton.residual_line_search) {
      chain = given;
      newton.residual_line_search = true;
      const bool found = run(chain);
      newton.residual_line_search = false;
      if (found) break;
      if (gone < 0) gone = shrunk_segment(given, chain);
    }
    // a stretch the iteration shrinks away is not there; where there is none, the junctions are held first
    if (gone < 0) {
      chain = given;
      const Pattern none{{0}, {}};
      if (run(chain, &none)) break;
      gone = shrunk_segment(given, chain);
      if (gone < 0) return sum;
    }
    given = given.recut(without_segment(given, given.pattern(), gone));
    chain = given;
  }
  while (sum.patterns_tried < options.max_patterns) {
    const auto bad = violated(chain);
    if (bad.empty()) {
      sum.converged = true;
      sum.reason.clear();
      return sum;
    }
    visited.patterns.push_back(chain.pattern());
    const Pattern q = chain.pattern();
    bool moved = false;
    auto take = [&](Chain c) {
      if (visited.seen(c.pattern()) || !run(c, &q) || visited.seen(c.pattern())) return false;
      chain = std::move(c);
      return true;
    };
    // Neighbouring points that all exceed the curvature limit are a line between them, where that is admissible; an end
    // held on the wall counts as such a neighbour.
    const auto on_wall = [&](int j, double S, End::Kind kind) {
      return (kind == End::Kind::clamped || kind == End::Kind::sleeve) && std::abs(relative_gap(chain, j, S)) < 1e-9;
    };
    const ScaledProblem& P = chain.mechanics().problem;
    auto take_lines = [&](const std::vector<Margin>& points) {  // by descending index
      Pattern all = q;
      double from = HUGE_VAL, to = -HUGE_VAL;
      for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const int k = points[i + 1].index;
        if (points[i].index != k + 1 || q.line[k + 1]) continue;
        from = std::min(from, chain.S(k));
        to = std::max(to, chain.S(k + 3));
        all.line[k + 1] = 1;
      }
      const int last = chain.segments() - 1;
      if (points.back().index == 0 && !q.line[0] && on_wall(0, chain.S(0), P.start.kind)) {
        all.line[0] = 1;
        from = chain.S(0);
        to = std::max(to, chain.S(2));
      }
      if (points.front().index == last - 1 && !q.line[last] && on_wall(last, chain.S(last + 1), P.end.kind)) {
        all.line[last] = 1;
        from = std::min(from, chain.S(last - 1));
        to = chain.S(last + 1);
      }
      for (std::size_t k = all.S.size(); k-- > 0;)
        if (all.line[k] && all.line[k + 1]) all = remove_point(all, static_cast<int>(k));
      if (all == q) return false;
      Chain c = chain.recut(all);
      if (visited.seen(all) || !run(c, &q) || visited.seen(c.pattern()) || badness(c, from, to) > 0.0) return false;
      chain = std::move(c);
      return true;
    };
    // The first violated kind is treated, all its places together; one at a time where that fails (IV.1.4).
    for (std::size_t first = 0; first < bad.size() && !moved;) {
      std::size_t last = first;
      while (last < bad.size() && bad[last].kind == bad[first].kind) ++last;
      std::vector<Margin> same(bad.begin() + first, bad.begin() + last);
      std::sort(same.begin(), same.end(),
                [](const Margin& a, const Margin& b) { return a.index != b.index ? a.index > b.index : a.S > b.S; });
      switch (bad[first].kind) {
        case CheckKind::span:
          moved = take(chain.recut(without_segment(chain, q, bad[first].index)));
          break;
        case CheckKind::tip_gap:
        case CheckKind::tip_reaction:
        case CheckKind::tip_approach:
        case CheckKind::tip_couple:
          for (const Pattern& r : tip_patterns(chain, bad[first].kind)) {
            moved = take(chain.recut(r));
            if (moved) break;
          }
          break;
        case CheckKind::collar_gap:
        case CheckKind::collar_reaction: {
          std::vector<int> which;
          for (const Margin& m : same) which.push_back(m.index);
          for (const Pattern& r : collar_patterns(q, which, P.collars.size())) {
            moved = take(chain.recut(r));
            if (moved) break;
          }
          break;
        }
        case CheckKind::reaction: {
          Pattern all = q;
          for (const Margin& m : same)
            if (!q.line[m.index] && !q.line[m.index + 1]) all = remove_point(all, m.index);
          moved = all != q && take(chain.recut(all));
          for (std::size_t i = first; i < last && !moved; ++i) {
            const int k = bad[i].index;
            if (!q.line[k] && !q.line[k + 1]) {
              moved = take(chain.recut(remove_point(q, k)));
            } else {  // the end of a line pulls: the line gives way to a point
              const int line = q.line[k] ? k : k + 1;
              if (line > 0 && line + 1 < static_cast<int>(q.line.size()))
                moved = take(chain.recut(remove_segment(q, line)));
            }
          }
          break;
        }
        case CheckKind::curvature:
          moved = take_lines(same);
          for (std::size_t i = first; i < last && !moved; ++i) {
            const Margin& m = bad[i];
            const double span =
                std::max(penetrated_span(chain, m.index), 4.0 * span_floor(chain, m.index, options.tolerance));
            const double room =
                0.5 * std::min(chain.S(m.index + 1) - chain.S(m.index), chain.S(m.index + 2) - chain.S(m.index + 1));
            const double from = chain.S(m.index), to = chain.S(m.index + 2);
            for (double f : {0.5, 0.2, 0.9}) {
              Chain line = chain.recut(point_to_line(q, m.index, std::min(f * span, room)));
              Chain two = chain.recut(point_to_two(q, m.index, std::min(1.2 * f * span, room)));
              const double bad_line = !visited.seen(line.pattern()) && run(line, &q) && !visited.seen(line.pattern())
                                          ? badness(line, from, to)
                                          : HUGE_VAL;
              const double bad_two =
                  bad_line > 0.0 && !visited.seen(two.pattern()) && run(two, &q) && !visited.seen(two.pattern())
                      ? badness(two, from, to)
                      : HUGE_VAL;
              if (bad_line == HUGE_VAL && bad_two == HUGE_VAL) continue;
              chain = bad_line <= bad_two ? line : two;
              moved = true;
              break;
            }
          }
          break;
        case CheckKind::gap: {
          Pattern all = q;
          for (const Margin& m : same) all = insert_point(all, m.index, m.S);
          moved = take(chain.recut(all));
          for (std::size_t i = first; i < last && !moved && same.size() > 1; ++i)
            moved = take(chain.recut(insert_point(q, bad[i].index, bad[i].S)));
          break;
        }
        case CheckKind::pressure: {
          auto openings = tensile_stretches(chain, options.tolerance.pressure);
          std::erase_if(openings, [&](const Opening& o) {  // a line that pulls everywhere is treated below
            return o.span > 0.9 * (chain.S(o.segment + 1) - chain.S(o.segment)) || o.S < options.from ||
                   o.S > options.to;
          });
          int free = 0;
          if (!openings.empty()) moved = take(open_lines(chain, openings, free));
          for (std::size_t i = 0; i < openings.size() && !moved && openings.size() > 1; ++i)
            moved = take(open_lines(chain, {openings[i]}, free));
          [[fallthrough]];
        }
        case CheckKind::buckling:
          for (std::size_t i = first; i < last && !moved; ++i) {
            const int j = bad[i].index;
            if (j == 0 || j + 1 == chain.segments()) continue;
            moved = take(chain.recut(remove_segment(q, j)));
            if (moved) break;
            Pattern two = q;  // two points where the line was
            two.line[j] = 0;
            moved = take(chain.recut(two));
          }
          break;
      }
      first = last;
    }
    if (!moved) {
      if (sum.reason.empty()) sum.reason = "every change of the contact pattern leads back to one already tried";
      return sum;
    }
  }
  sum.reason = "the contact pattern did not settle within the allowed number of changes";
  return sum;
}

}  // namespace tendril::segmentation

#include "tendril/segmentation/contact_pattern_switcher.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tendril/segmentation/pattern_edit.hpp"

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
      case CheckKind::reaction: tolerance = t.reaction; break;
      case CheckKind::curvature: tolerance = t.curvature; break;
      case CheckKind::gap: tolerance = t.gap; break;
      case CheckKind::pressure: tolerance = t.pressure; break;
    }
    if (m.value < -tolerance) bad.push_back(m);
  }
  // Penetration beside a point contact that exceeds the curvature limit is the same violation seen twice.
  std::erase_if(bad, [&](const Margin& g) {
    return g.kind == CheckKind::gap && std::any_of(bad.begin(), bad.end(), [&](const Margin& c) {
             return c.kind == CheckKind::curvature && (c.index == g.index || c.index + 1 == g.index);
           });
  });
  std::stable_sort(bad.begin(), bad.end(),
                   [](const Margin& a, const Margin& b) { return a.kind != b.kind ? a.kind < b.kind : a.value < b.value; });
  return bad;
}

namespace {

struct Visited {
  std::vector<Pattern> patterns;
  bool seen(const Pattern& q) const {
    return std::any_of(patterns.begin(), patterns.end(), [&](const Pattern& v) {
      if (v.line != q.line) return false;
      for (std::size_t i = 0; i < q.S.size(); ++i)
        if (std::abs(v.S[i] - q.S[i]) > 2e-3) return false;
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

}  // namespace

SwitcherSummary switch_contact_pattern(Chain& chain, const Closure& closure, const SwitcherOptions& options) {
  SwitcherSummary sum;
  Visited visited;
  auto run = [&](Chain& c) {
    const NewtonSummary s = c.solve_adaptive(closure, options.newton, options.accuracy);
    sum.newton_iterations += s.iterations;
    sum.factorisations += s.factorisations;
    ++sum.patterns_tried;
    if (!s.converged) sum.reason = s.reason;
    return s.converged;
  };
  // Badness of a candidate: how far it is from admissible, to choose between line and two points.
  auto badness = [&](const Chain& c) {
    double worst = 0.0;
    for (const Margin& m : violations(c, margins(c), options.tolerance)) worst = std::max(worst, -m.value);
    return worst;
  };
  if (!run(chain)) return sum;
  while (sum.patterns_tried < options.max_patterns) {
    const auto bad = violations(chain, margins(chain), options.tolerance);
    if (bad.empty()) {
      sum.converged = true;
      sum.reason.clear();
      return sum;
    }
    visited.patterns.push_back(chain.pattern());
    const Pattern q = chain.pattern();
    // Candidates in the order they should be tried; every violated condition offers its own.
    bool moved = false;
    for (const Margin& m : bad) {
      std::vector<Pattern> candidates;
      switch (m.kind) {
        case CheckKind::span:
          candidates.push_back(remove_segment(q, m.index));
          break;
        case CheckKind::reaction: {
          const int k = m.index;
          if (!q.line[k] && !q.line[k + 1]) {
            candidates.push_back(remove_point(q, k));
          } else {  // the end of a line pulls: the line gives way to a point
            const int line = q.line[k] ? k : k + 1;
            if (line > 0 && line + 1 < static_cast<int>(q.line.size())) candidates.push_back(remove_segment(q, line));
          }
          break;
        }
        case CheckKind::curvature: {
          const double span = std::max(penetrated_span(chain, m.index), 4.0 * span_floor(chain, m.index, options.tolerance));
          const double room = 0.5 * std::min(chain.S(m.index + 1) - chain.S(m.index), chain.S(m.index + 2) - chain.S(m.index + 1));
          for (double f : {0.5, 0.2, 0.9}) {
            candidates.push_back(point_to_line(q, m.index, std::min(f * span, room)));
            candidates.push_back(point_to_two(q, m.index, std::min(1.2 * f * span, room)));
          }
          break;
        }
        case CheckKind::gap: {
          candidates.push_back(insert_point(q, m.index, m.S));
          break;
        }
        case CheckKind::pressure: {
          const double a = chain.S(m.index), b = chain.S(m.index + 1);
          for (double f : {0.3, 0.1, 0.6}) candidates.push_back(split_line(q, m.index, m.S, f * (b - a), a, b));
          if (m.index > 0 && m.index + 1 < chain.segments()) {
            candidates.push_back(remove_segment(q, m.index));
            // two points where the line was
            Pattern two = q;
            two.line[m.index] = 0;
            candidates.push_back(two);
          }
          break;
        }
      }
      Chain best;
      double best_badness = std::numeric_limits<double>::infinity();
      for (const Pattern& cand : candidates) {
        if (visited.seen(cand)) continue;
        Chain c = chain.recut(cand);
        if (!run(c) || visited.seen(c.pattern())) continue;
        const double b = badness(c);
        if (b < best_badness) {
          best_badness = b;
          best = c;
        }
        if (b == 0.0 || candidates.size() == 1 || (m.kind != CheckKind::curvature && m.kind != CheckKind::pressure)) break;
        if (m.kind == CheckKind::curvature && &cand - candidates.data() >= 1) break;  // one line and one pair compared
      }
      if (best_badness < std::numeric_limits<double>::infinity()) {
        chain = best;
        moved = true;
        break;
      }
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

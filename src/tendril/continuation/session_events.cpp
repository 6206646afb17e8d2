// What a moving rod's log says: contacts before and after a motion are paired by place, and what has no partner has
// come, gone, split or merged. When is read off the condition that was violated, between the two states.

#include <algorithm>
#include <cmath>

#include "tendril/continuation/path_detail.hpp"
#include "tendril/continuation/report_state.hpp"
#include "tendril/continuation/session.hpp"
#include "tendril/continuation/study_detail.hpp"
#include "tendril/segmentation/collars.hpp"
#include "tendril/segmentation/tip.hpp"

namespace tendril::continuation {

using segmentation::Chain;
using segmentation::CheckKind;
using segmentation::Margin;
using segmentation::Pattern;

namespace {

std::vector<double> places_of(const Chain& c, bool lines) {
  std::vector<double> S;
  for (int j = 0; j < c.segments(); ++j) {
    if (lines && c.is_line(j)) S.push_back(0.5 * (c.S(j) + c.S(j + 1)));
    if (!lines && j + 1 < c.segments() && !c.is_line(j) && !c.is_line(j + 1)) S.push_back(c.S(j + 1));
  }
  return S;
}

}  // namespace

void Session::note(const std::string& kind, double value, double S) {
  const auto& P = chain_.mechanics().problem;
  const TracePoint t = trace_point(chain_);
  Event e;
  e.parameter = value;
  e.kind = kind;
  e.S = S * P.L;
  e.rod_length = feed_ == Feed::length && moving_ == 0 ? value : t.rod_length * P.L;
  e.axial_force_end = t.axial_force_end * P.force_unit();
  events_.push_back(e);
}

void Session::note_changes(const Chain& before, const Chain& after, const std::vector<Margin>& violated, double from,
                           double to) {
  const Pattern a = before.pattern(), b = after.pattern();
  if (a.line == b.line && a.tip == b.tip && a.collar == b.collar) return;
  // when: where the first violated margin passed zero between the two states
  const auto margins_before = segmentation::margins(before);
  const auto when = [&](CheckKind kind, double S) {
    double at = to, nearest = HUGE_VAL;
    for (const Margin& v : violated) {
      if (v.kind != kind || std::abs(v.S - S) > nearest) continue;
      nearest = std::abs(v.S - S);
      const Margin* was = same_condition(margins_before, v);
      const double f = was && was->value > 0.0 ? was->value / (was->value - v.value) : 0.5;
      at = from + f * (to - from);
    }
    return at;
  };
  std::vector<double> points_a = places_of(before, false), points_b = places_of(after, false);
  std::vector<double> lines_a = places_of(before, true), lines_b = places_of(after, true);
  // what stayed: nearest pairs
  const auto pair_off = [](std::vector<double>& x, std::vector<double>& y, double reach) {
    while (!x.empty() && !y.empty()) {
      std::size_t bi = 0, bj = 0;
      double best = HUGE_VAL;
      for (std::size_t i = 0; i < x.size(); ++i)
        for (std::size_t j = 0; j < y.size(); ++j)
          if (std::abs(x[i] - y[j]) < best) {
            best = std::abs(x[i] - y[j]);
            bi = i;
            bj = j;
          }
      if (best > reach) return;
      x.erase(x.begin() + static_cast<std::ptrdiff_t>(bi));
      y.erase(y.begin() + static_cast<std::ptrdiff_t>(bj));
    }
  };
  const double end = after.S(after.segments());
  pair_off(points_a, points_b, 0.05 * end);
  pair_off(lines_a, lines_b, 0.2 * end);
  if (a.tip && !b.tip)
    note("tip_leaves", std::min(when(CheckKind::tip_reaction, end), when(CheckKind::tip_approach, end)), end);
  if (!a.tip && b.tip) note("tip_touches", when(CheckKind::tip_gap, end), end);
  for (const auto& c : segmentation::collar_states(after)) {
    const bool touched = before.touches(c.collar);
    if (c.touches && !touched) note("contact_appears", when(CheckKind::collar_gap, c.S), c.S);
    if (!c.touches && touched) note("contact_leaves", when(CheckKind::collar_reaction, c.S), c.S);
  }
  const auto near = [&](std::vector<double>& x, double S) {
    for (std::size_t i = 0; i < x.size(); ++i)
      if (std::abs(x[i] - S) < 0.05 * end) {
        x.erase(x.begin() + static_cast<std::ptrdiff_t>(i));
        return true;
      }
    return false;
  };
  for (const double S : lines_b)
    note(near(points_a, S) ? "point_to_line" : "line_splits", when(CheckKind::curvature, S), S);
  for (const double S : lines_a)
    note(near(points_b, S) ? "line_to_point" : "contacts_merge", when(CheckKind::span, S), S);
  for (const double S : points_b) {
    const bool split = std::any_of(violated.begin(), violated.end(), [&](const Margin& v) {
      return v.kind == CheckKind::curvature && std::abs(v.S - S) < 0.05 * end;
    });
    note(split ? "point_splits" : "contact_appears", when(split ? CheckKind::curvature : CheckKind::gap, S), S);
  }
  for (const double S : points_a) {
    const bool merged = std::any_of(violated.begin(), violated.end(), [&](const Margin& v) {
      return v.kind == CheckKind::span && std::abs(v.S - S) < 0.05 * end;
    });
    note(merged ? "contacts_merge" : "contact_leaves", when(merged ? CheckKind::span : CheckKind::reaction, S), S);
  }
}

}  // namespace tendril::continuation

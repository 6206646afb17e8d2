// Pictures of the heavy rod.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "tendril/reproduce/heavy_rod_states.hpp"

namespace tendril::reproduce::heavy {

using collocation::BoundaryValueProblem;
using continuation::BranchEvent;
using drawing::Curve;
using drawing::Panel;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Curve part_of(const std::vector<Place>& list, const std::function<bool(const Place&, const Place&)>& drawn) {
  Curve c;
  for (std::size_t i = 0; i + 1 < list.size(); ++i) {
    if (!drawn(list[i], list[i + 1])) continue;
    if (c.x.empty() || c.x.back() != list[i].torque || c.y.back() != list[i].length) {
      c.x.push_back(kNaN);
      c.y.push_back(kNaN);
      c.x.push_back(list[i].torque);
      c.y.push_back(list[i].length);
    }
    c.x.push_back(list[i + 1].torque);
    c.y.push_back(list[i + 1].length);
  }
  return c;
}

}  // namespace

Panel response_panel(const std::string& title, const std::vector<Place>& list,
                     const std::vector<const BranchEvent*>& folds, const std::vector<const BranchEvent*>& states,
                     const std::vector<std::string>& names, bool whole, double longest) {
  Panel panel;
  panel.title = title;
  panel.x_label = "end torque M_3(L) [B/L]";
  panel.y_label = "length of the rod ℓ/L [-]";
  panel.y_log = whole;
  // Between two states of which one is a fold, the other decides.
  const auto stable = [](const Place& a, const Place& b) { return (a.sign != 0 ? a : b).stiffness < 0; };
  Curve zone;
  zone.filled = true;
  zone.colour = 7;
  zone.opacity = 0.15;
  zone.label = whole ? "more than one equilibrium" : "";
  const double low = whole ? 0.9 : 0.99, high = whole ? 1.2 * longest : 1.26;
  zone.x = {folds[1]->p, folds[0]->p, folds[0]->p, folds[1]->p};
  zone.y = {low, low, high, high};
  Curve good = part_of(list, stable), bad = part_of(list, [&](const Place&a, const Place&b) { return !stable(a, b); });
  good.colour = 0;
  bad.colour = 1;
  bad.line = drawing::Line::dashed;
  good.width = bad.width = 2.0;
  if (whole) {
    good.label = "stable at F_3 = 0";
    bad.label = "unstable at F_3 = 0, stable at held length";
  }
  panel.curves = {zone, good, bad};
  if (whole) {
    Curve beyond = part_of(list, [](const Place& a, const Place& b) { return a.advance < 0 && b.advance < 0; });
    beyond.colour = 4;
    beyond.width = 6;
    beyond.opacity = 0.5;
    beyond.label = "turns back: d_3·D_3 < 0";
    panel.curves.insert(panel.curves.begin() + 1, beyond);
  }
  Curve mark;
  mark.line = drawing::Line::none;
  mark.mark = drawing::Mark::square;
  mark.colour = 6;
  mark.label = whole ? "fold" : "";
  for (const BranchEvent* e : folds) {
    mark.x.push_back(e->p);
    mark.y.push_back(e->values[0]);
  }
  panel.curves.push_back(mark);
  mark.mark = drawing::Mark::circle;
  mark.label = "";
  mark.x.clear();
  mark.y.clear();
  for (std::size_t i = 0; i < states.size(); ++i) {
    mark.x.push_back(states[i]->p);
    mark.y.push_back(states[i]->values[0]);
    panel.words.push_back({mark.x.back(), mark.y.back(), "(" + names[i] + ")"});
  }
  panel.curves.push_back(mark);
  panel.x_range = whole ? std::array<double, 2>{-0.3, 9.0} : std::array<double, 2>{5.5, 8.4};
  panel.y_range = {{low, high}};
  return panel;
}

Panel body(const std::string& title, const BoundaryValueProblem& rod, double amplified) {
  const drawing::View view{-1.05, 0.38};
  Panel panel;
  panel.title = title;
  panel.axes = false;
  panel.equal_scale = true;
  Curve line, floor, wall, frame;
  line.colour = 0;
  line.width = 2.6;
  floor.colour = wall.colour = 7;
  floor.line = wall.line = drawing::Line::dashed;
  frame.colour = 7;
  frame.width = 0.8;
  frame.opacity = 0.6;
  const auto add = [&](Curve& c, double x, double y, double z) {
    const auto p = drawing::project(view, {x, y, z});
    c.x.push_back(p[0]);
    c.y.push_back(p[1]);
  };
  double deepest = 0, widest = 0;
  for (int i = 0; i <= 400; ++i) {
    const Vec r = section_at(rod, i / 400.0).r;
    deepest = std::min(deepest, amplified * r.z());
    widest = std::max(widest, amplified * std::abs(r.y()));
  }
  const double back = widest + 0.12, down = deepest - 0.12;
  for (int i = 0; i <= 400; ++i) {
    const Vec r = section_at(rod, i / 400.0).r;
    const double y = amplified * r.y(), z = amplified * r.z();
    add(line, r.x(), y, z);
    add(floor, r.x(), y, down);
    add(wall, r.x(), back, z);
  }
  for (const auto& [x, y, z] : {std::array{0.0, -back, down},
                                {1.0, -back, down},
                                {1.0, back, down},
                                {0.0, back, down},
                                {0.0, -back, down},
                                {kNaN, 0.0, 0.0},
                                {0.0, back, down},
                                {0.0, back, 0.12},
                                {1.0, back, 0.12},
                                {1.0, back, down}})
    add(frame, x, y, z);
  panel.curves = {frame, floor, wall, line};
  Curve ends;
  ends.line = drawing::Line::none;
  ends.mark = drawing::Mark::square;
  ends.mark_size = 8;
  ends.colour = 6;
  add(ends, 0, 0, 0);
  add(ends, 1, 0, 0);
  panel.curves.push_back(ends);
  return panel;
}

}  // namespace tendril::reproduce::heavy

// Events along a path, located by solving the equations together with the event's condition.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "tendril/continuation/path_detail.hpp"
#include "tendril/continuation/path_follower.hpp"
#include "tendril/segmentation/flat_lines.hpp"
#include "tendril/segmentation/pattern_edit.hpp"

namespace tendril::continuation {

using segmentation::Chain;
using segmentation::CheckKind;
using segmentation::Closure;
using segmentation::Margin;
using segmentation::Pattern;

namespace {

// of the path's: an event's load is wanted to more digits than its state
constexpr double event_accuracy = 0.02;

}  // namespace

std::string figure(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

TracePoint trace_point(const Chain& c) {
  double u[formulation::state_inputs], s, start;
  const double end = c.S(c.segments());
  c.sample(c.S(0), u, &start);
  c.sample(end, u, &s);
  TracePoint t;
  t.parameter = c.parameter();
  t.rod_length = s - start;
  t.axial_force_end = u[15];
  const auto& P = c.mechanics().problem;
  const auto sec = P.section(end);
  const auto k = formulation::FreeRod::kinematics<double>(formulation::lift<double>(sec, 0.0, 0.0), u[0], u[1], u[2],
                                                          u[4], u[5], u[6]);
  t.torque_end = formulation::FreeRod::twisting_moment<double>(P.material_at(u), k, u[15], u[9]);
  const Pattern q = c.pattern();
  t.contacts = segmentation::point_contacts(q) + segmentation::line_contacts(q) + (q.tip ? 1 : 0);
  return t;
}

const Margin* same_condition(const std::vector<Margin>& all, const Margin& m) {
  const Margin* best = nullptr;
  for (const Margin& x : all) {
    if (x.kind != m.kind || x.index != m.index) continue;
    if (!best || std::abs(x.S - m.S) < std::abs(best->S - m.S)) best = &x;
  }
  return best;
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
  interpolated_ = false;
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
  const auto met = [&](double t) {
    // in a plane the equations are singular where a point becomes a line, and a trial that meets it is a poor one
    if (c.mechanics().problem.planar && m.kind == CheckKind::curvature &&
        (interpolated_ = locate_beside(a, b, t, at, m, closure)))
      return true;
    m = found;
    at = c;
    return true;
  };
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
    if (!correct(c, here, false)) return interpolated_ = locate_beside(a, b, t, at, m, closure);
    const double v = value_of(c, found);
    c.gather_all(x);
    if (!std::isnan(v) && std::abs(v) < options_.event_tolerance) {
      return met(t);
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
      return met(t);
    }
  }
  return met(0.5 * (tlo + thi));
}

void PathFollower::sharpen(Chain& at, Margin& m) {
  if (rebuild_ || m.kind == CheckKind::span || m.kind == CheckKind::buckling || segmentation::has_flat_line(at)) return;
  Chain c = at;
  Margin found = m;
  const double p = at.parameter(), size = std::max(p_unit_, std::abs(p));
  const auto s = c.solve_adaptive({Closure::Kind::parameter, 0, p}, options_.switcher.newton,
                                  event_accuracy * options_.switcher.accuracy);
  note(s);
  if (!s.converged) return;
  const auto value = [&](const Chain& x) {
    const auto all = segmentation::margins(x);
    const Margin* y = same_condition(all, m);
    if (!y) return std::numeric_limits<double>::quiet_NaN();
    found = *y;
    return y->value;
  };
  std::vector<double> t;
  const double f = value(c);
  if (!c.tangent({Closure::Kind::parameter, 0, p}, t)) return;
  Chain probe = c;
  const double nudge = 1e-6 * size;
  probe.advance(t, nudge);
  double slope = (value(probe) - f) / nudge, p0 = p, f0 = f;
  for (int it = 0; it < 8 && std::isfinite(slope) && slope != 0.0; ++it) {
    const double p1 = p0 - f0 / slope;
    if (!(std::abs(p1 - p) < 1e-4 * size)) return;
    c.advance(t, p1 - p0);
    if (!correct(c, {Closure::Kind::parameter, 0, p1}, false, true)) return;
    const double f1 = value(c);
    if (std::abs(f1) < 0.1 * options_.event_tolerance || std::abs(p1 - p0) < 1e-14 * size) {
      at = c;
      m = found;
      return;
    }
    slope = (f1 - f0) / (p1 - p0);
    p0 = p1;
    f0 = f1;
  }
}

}  // namespace tendril::continuation

// Events along a path, located by solving the equations together with the event's condition.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tendril/continuation/path_detail.hpp"
#include "tendril/continuation/path_follower.hpp"
#include "tendril/segmentation/pattern_edit.hpp"

namespace tendril::continuation {

using segmentation::Chain;
using segmentation::CheckKind;
using segmentation::Closure;
using segmentation::Margin;
using segmentation::Pattern;

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
    if (!correct(c, here, false)) return locate_beside(a, b, t, at, m, closure);
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

#include "tendril/segmentation/windows.hpp"

#include <algorithm>
#include <cmath>

#include "tendril/formulation/free_rod.hpp"
#include "tendril/segmentation/collars.hpp"

namespace tendril::segmentation {

using formulation::FreeRod;

namespace {

/// The place `lengths` decay lengths from S, away from junctions; or the end of the rod.
double away(const Chain& c, double S, double lengths) {
  const double start = c.S(0), end = c.S(c.segments()), sense = lengths < 0.0 ? -1.0 : 1.0;
  constexpr double step = 0.5;
  double length = decay_length(c, S);
  for (double gone = 0.0; gone < std::abs(lengths); gone += step) {
    S += sense * step * length;
    if (S <= start || S >= end) return sense < 0.0 ? start : end;
    length = decay_length(c, S);
  }
  if (S - start < 4.0 * length && sense < 0.0) return start;
  if (end - S < 4.0 * length && sense > 0.0) return end;
  const int j = c.segment_at(S);
  const double a = c.S(j), b = c.S(j + 1), clear = std::min(0.5 * (b - a), 2.0 * length);
  return std::clamp(S, a + clear, b - clear);
}

}  // namespace

double decay_length(const Chain& c, double S) {
  const ScaledProblem& P = c.mechanics().problem;
  double u[formulation::state_inputs];
  c.sample(S, u, nullptr);
  const auto sec = P.section(S);
  const double load = std::hypot(sec.sigma[0], sec.sigma[1]) + std::abs(u[15]) * std::hypot(sec.U[0][0], sec.U[0][1]);
  const double length =
      std::min(1.0 / std::sqrt(std::max(std::abs(u[15]), 1e-12)), std::pow(sec.Q[0] / std::max(load, 1e-12), 0.25));
  return std::max(length, 1e-4 * (c.S(c.segments()) - c.S(0)));
}

std::vector<Window> tile(const Chain& whole, double core, double margin) {
  std::vector<Window> windows;
  const double end = whole.S(whole.segments());
  for (double from = whole.S(0); from < end;) {
    Window w{from, away(whole, from, core), 0.0, 0.0};
    if (!(w.to > from)) w.to = end;
    if (away(whole, w.to, 0.5 * core) >= end) w.to = end;
    w.first = std::min(from, away(whole, from, -margin));
    w.last = std::max(w.to, away(whole, w.to, margin));
    windows.push_back(w);
    from = w.to;
  }
  return windows;
}

std::vector<Window> around(const Chain& whole, std::vector<double> places, double core, double margin) {
  std::sort(places.begin(), places.end());
  std::vector<Window> windows;
  for (const double S : places) {
    Window w{std::min(S, away(whole, S, -core)), std::max(S, away(whole, S, core)), 0.0, 0.0};
    w.first = std::min(w.from, away(whole, w.from, -margin));
    w.last = std::max(w.to, away(whole, w.to, margin));
    if (!windows.empty() && w.from <= windows.back().to) {
      windows.back().to = std::max(windows.back().to, w.to);
      windows.back().last = std::max(windows.back().last, w.last);
    } else {
      windows.push_back(w);
    }
  }
  return windows;
}

Chain cut(const Chain& whole, double first, double last) {
  const ScaledProblem& P = whole.mechanics().problem;
  const int n = whole.segments();
  ScaledProblem part = P;
  const bool from_start = first <= whole.S(0), to_end = last >= whole.S(n);
  part.p0 = P.p;
  double u[formulation::state_inputs], s;
  const auto hold = [&](ScaledProblem::ScaledEnd& e) {
    e.kind = End::Kind::clamped;
    for (int c = 0; c < 2; ++c) {
      e.eccentricity[c] = {u[4 * c], 0.0};
      e.slope[c] = {u[4 * c + 1], 0.0};
    }
    e.roll = {u[8], 0.0};
  };
  const auto torque = [&](double S) {
    const auto k = FreeRod::kinematics<double>(formulation::lift<double>(P.section(S), 0.0, 0.0), u[0], u[1], u[2],
                                               u[4], u[5], u[6]);
    return FreeRod::twisting_moment<double>(P.material_at(u), k, u[15], u[9]);
  };
  const auto still = [&](Scalar& x) { x = {P.now(x), 0.0}; };
  for (ScaledProblem::ScaledEnd* e : {&part.start, &part.end}) {
    for (int c = 0; c < 2; ++c) {
      still(e->eccentricity[c]);
      still(e->slope[c]);
    }
    still(e->roll);
  }
  for (Scalar* x : {&part.axial, &part.twist, &part.end_position}) still(*x);
  still(part.source.clearance_scale);
  still(part.source.body_force_scale);
  still(part.source.body_couple_scale);
  still(part.source.point_load_scale);
  // The axial and the torsional condition reach the window from the side of the end they belong to.
  const bool axial_left = P.source.axial != AxialControl::rod_length && P.source.axial_at == Which::start;
  const bool twist_left = P.source.twist_at == Which::start;
  const auto transmit = [&](bool left, double S) {
    whole.sample(S, u, &s);
    hold(left ? part.start : part.end);
    if (axial_left == left) {
      part.source.axial = AxialControl::axial_force;
      part.source.axial_at = left ? Which::start : Which::end;
      part.axial = {u[15], 0.0};
    }
    if (twist_left == left) {
      part.source.twist = TwistControl::torque;
      part.source.twist_at = left ? Which::start : Which::end;
      part.twist = {torque(S), 0.0};
    }
    if (left) part.start_s = s;
  };
  if (from_start) {
    part.start_position = whole.S(0);
    if (P.law.from_end) whole.sample(whole.S(0), u, &part.start_s);
  } else {
    part.start_position = first;
    transmit(true, first);
  }
  if (!to_end) {
    part.end_position = {last, 0.0};
    transmit(false, last);
  } else if (part.source.axial == AxialControl::rod_length) {
    whole.sample(whole.S(n), u, &s);
    part.source.axial = AxialControl::axial_force;
    part.source.axial_at = Which::end;
    part.axial = {part.tip_free() ? 0.0 : u[15], 0.0};
    if (part.tip_free()) part.end_position = {whole.S(n), 0.0};
  }
  // A prescribed twist is one between the ends of the whole.
  if (part.source.twist == TwistControl::twist && !(from_start && to_end)) {
    const double S = twist_left ? whole.S(0) : whole.S(n);
    whole.sample(S, u, &s);
    part.source.twist = TwistControl::torque;
    part.twist = {torque(S), 0.0};
  }
  if (!to_end) part.law.from_end = false;  // s is still counted from there, and known at the window's start
  if (!from_start || !to_end) part.axisymmetric = false;
  const double a = part.start_position, b = part.end_position.value;
  std::erase_if(part.knots, [&](double k) { return k <= a || k >= b; });

  const int left = whole.segment_at(a), right = b >= whole.S(n) ? n - 1 : whole.segment_at(b);
  Pattern q;
  q.tip = to_end && whole.tip_rests();
  q.collar = whole.pattern().collar;
  std::vector<double> points;
  for (int j = left; j <= right; ++j) {
    q.line.push_back(whole.is_line(j));
    if (j > left) q.S.push_back(whole.S(j));
    const auto& seg = whole.segment(j);
    for (int i = 1; i < seg.pieces(); ++i) {
      const double x = seg.place(i, whole.S(j), whole.S(j + 1));
      if (x > a && x < b) points.push_back(x);
    }
  }
  Chain c(std::make_shared<Mechanics>(part), whole.k());
  c.set_parameter(P.p);
  c.build(
      q, points, [&](double S, double* v, double* w) { whole.sample(S, v, w); },
      [&](double S, double* line, double* w) {
        const int j = whole.segment_at(S);
        if (!whole.is_line(j)) return false;
        whole.segment(j).evaluate(S, whole.S(j), whole.S(j + 1), line, w);
        return true;
      });
  return c;
}

Chain splice(const Chain& whole, const std::vector<Window>& windows, const std::vector<Chain>& parts) {
  struct Piece {
    const Chain* chain;
    double a, b;
  };
  std::vector<Piece> pieces;
  double at = whole.S(0);
  const double end = whole.S(whole.segments());
  for (std::size_t i = 0; i < windows.size(); ++i) {
    if (windows[i].from > at) pieces.push_back({&whole, at, windows[i].from});
    pieces.push_back({&parts[i], windows[i].from, windows[i].to});
    at = windows[i].to;
  }
  if (at < end) pieces.push_back({&whole, at, end});

  Pattern q;
  std::vector<double> points;
  for (const Piece& p : pieces) {
    const Chain& c = *p.chain;
    const double seam = p.a;
    bool begun = false;
    for (int j = 0; j < c.segments(); ++j) {
      const double a = std::max(c.S(j), p.a), b = std::min(c.S(j + 1), p.b);
      if (!(b > a)) continue;
      if (!q.line.empty() && (begun || static_cast<bool>(q.line.back()) != c.is_line(j))) {
        q.S.push_back(begun ? c.S(j) : seam);
        q.line.push_back(c.is_line(j));
      } else if (q.line.empty()) {
        q.line.push_back(c.is_line(j));
      }
      begun = true;
      const auto& seg = c.segment(j);
      for (int i = 0; i <= seg.pieces(); ++i) {
        const double x = seg.place(i, c.S(j), c.S(j + 1));
        if (x > p.a && x < p.b && (points.empty() || x > points.back())) points.push_back(x);
      }
    }
  }
  const auto piece_at = [&](double S) {
    auto it = std::upper_bound(pieces.begin(), pieces.end(), S, [](double x, const Piece& p) { return x < p.a; });
    return it == pieces.begin() ? pieces.front() : *(it - 1);
  };
  q.tip = pieces.back().chain->tip_rests();
  q.collar = whole.pattern().collar;
  q.collar.resize(whole.mechanics().problem.collars.size(), 0);
  for (const Piece& p : pieces)
    for (const CollarState& c : collar_states(*p.chain))
      if (c.S >= p.a && c.S < p.b) q.collar[c.collar] = c.touches;
  Chain out(whole.mechanics_ptr(), whole.k());
  out.set_tip_place(end);
  out.set_parameter(whole.parameter());
  out.set_parameter_scale(whole.parameter_scale());
  out.build(
      q, points, [&](double S, double* u, double* s) { piece_at(S).chain->sample(S, u, s); },
      [&](double S, double* line, double* s) {
        const Chain& c = *piece_at(S).chain;
        const int j = c.segment_at(S);
        if (!c.is_line(j)) return false;
        c.segment(j).evaluate(S, c.S(j), c.S(j + 1), line, s);
        return true;
      });
  return out;
}

}  // namespace tendril::segmentation

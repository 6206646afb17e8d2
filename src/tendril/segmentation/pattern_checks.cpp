#include "tendril/segmentation/pattern_checks.hpp"

#include <algorithm>
#include <cmath>

#include "tendril/formulation/convert.hpp"
#include "tendril/segmentation/collars.hpp"
#include "tendril/segmentation/flat_lines.hpp"
#include "tendril/segmentation/tip.hpp"

namespace tendril::segmentation {

using formulation::FreeRod;
using formulation::LineContact;
using formulation::Section;

namespace {

struct Touch {
  double Fn, kappa_excess;
};

/// Normal force (and curvature excess) of a free state that touches the wall at S.
Touch touch(const ScaledProblem& P, const Section& s, const double* u) {
  const auto l = formulation::lift<double>(s, 0.0, 0.0);
  const auto k = FreeRod::kinematics<double>(l, u[0], u[1], u[2], u[4], u[5], u[6]);
  const double r = std::hypot(u[0], u[4]), cb = u[0] / r, sb = u[4] / r;
  const auto n = formulation::touch_basis<double>(k, cb, sb, s.Q[1]);
  Touch t;
  t.Fn = u[11] * n.n1 + u[13] * n.n2;
  const double kappa_n = k.p * n.n1 + k.h * n.n2;  // (d(d3)/dS)·N; per unit deformed length times J1bar
  const double bp = (u[0] * u[5] - u[4] * u[1]) / (r * r);
  const auto c =
      LineContact::curve<double>(l, formulation::lift_clearance<double>(s, 0.0, 0.0), std::atan2(sb, cb), bp, 0.0);
  t.kappa_excess = P.sign * s.Q[0] * (kappa_n * k.J1bar - c.kn);  // (III.3.10), N outward
  return t;
}

/// gap, its first and second derivative along S, relative to the clearance scale (inside: Q - |δ|).
std::array<double, 3> gap_jet(const ScaledProblem& P, const Section& s, const double* u) {
  const double r = std::hypot(u[0], u[4]);
  const double q = s.Q[0];
  if (r < 1e-12 * q) return {P.sign, 0.0, 0.0};
  const double r1 = (u[0] * u[1] + u[4] * u[5]) / r;
  const double r2 = (u[1] * u[1] + u[5] * u[5] + u[0] * u[2] + u[4] * u[6] - r1 * r1) / r;
  return {P.sign * (q - r) / q, P.sign * (s.Q[1] - r1) / q, P.sign * (s.Q[2] - r2) / q};
}

constexpr int samples_per_piece = 6;

void free_minima(const Chain& chain, int j, std::vector<Margin>& out) {
  const ScaledProblem& P = chain.mechanics().problem;
  const auto& seg = chain.segment(j);
  const double a = chain.S(j), b = chain.S(j + 1);
  double u[formulation::state_inputs];
  auto gap = [&](double S) {
    seg.evaluate(S, a, b, u, nullptr);
    return gap_jet(P, P.section(S), u);
  };
  std::vector<double> S, g, slope;
  for (int i = 0; i < seg.pieces(); ++i)
    for (int q = 0; q < samples_per_piece; ++q) {
      const double x = seg.place(i, a, b) * (1.0 - q / double(samples_per_piece)) +
                       seg.place(i + 1, a, b) * (q / double(samples_per_piece));
      const auto v = gap(x);
      S.push_back(x);
      g.push_back(v[0]);
      slope.push_back(v[1]);
    }
  // an end held on the wall: gap and slope vanish there, and the rod may enter the wall at once
  const auto beside_end = [&](double end, double h) {
    if (std::abs(gap(end)[0]) > 1e-9) return;
    std::vector<double> x, y, z;
    for (int k = 1; k <= 20; ++k) {
      const auto v = gap(end + h * std::ldexp(1.0, -k));
      x.push_back(end + h * std::ldexp(1.0, -k));
      y.push_back(v[0]);
      z.push_back(v[1]);
    }
    if (h > 0.0) {
      std::reverse(x.begin(), x.end());
      std::reverse(y.begin(), y.end());
      std::reverse(z.begin(), z.end());
    }
    const auto place = h > 0.0 ? 1 : std::ssize(S);
    S.insert(S.begin() + place, x.begin(), x.end());
    g.insert(g.begin() + place, y.begin(), y.end());
    slope.insert(slope.begin() + place, z.begin(), z.end());
  };
  if (j == 0 && S.size() > 1) beside_end(a, S[1] - a);
  if (j + 1 == chain.segments()) beside_end(b, S.back() - b);
  const auto last = gap(b);
  S.push_back(b);
  g.push_back(last[0]);
  slope.push_back(last[1]);
  for (std::size_t i = 0; i + 1 < S.size(); ++i) {
    // a minimum lies where the slope goes from - to +; next to a contact (g = slope = 0) there is none to report
    if (!(slope[i] < 0.0 && slope[i + 1] >= 0.0)) continue;
    if (i + 2 == S.size() && j + 1 < chain.segments()) continue;  // the contact at b itself
    double low = S[i], high = S[i + 1], x = 0.5 * (low + high);
    std::array<double, 3> v{};
    for (int it = 0; it < 60; ++it) {
      v = gap(x);
      (v[1] < 0.0 ? low : high) = x;
      double next = v[2] > 0.0 ? x - v[1] / v[2] : 0.5 * (low + high);
      if (!(next > low && next < high)) next = 0.5 * (low + high);
      if (std::abs(next - x) < 1e-13) break;
      x = next;
    }
    v = gap(x);
    // rounding next to a contact, where gap and slope both vanish, is no minimum
    const double from_contact = std::min(j > 0 ? x - a : HUGE_VAL, j + 1 < chain.segments() ? b - x : HUGE_VAL);
    if (std::abs(v[0]) < 1e-9 && from_contact < 1e-3 * (b - a)) continue;
    out.push_back({CheckKind::gap, j, x, v[0], v[0], 0.0});
  }
}

struct LineSamples {
  std::vector<double> S, p;
  double force = 0.0;  // ∫|p| dS, for scale
};

LineSamples sample_line(const Chain& chain, int j) {
  LineSamples out;
  const auto& seg = chain.segment(j);
  const double a = chain.S(j), b = chain.S(j + 1);
  for (int i = 0; i < seg.pieces(); ++i) {
    const double left = seg.place(i, a, b), h = seg.place(i + 1, a, b) - left;
    for (int q = 0; q < samples_per_piece; ++q) {
      out.S.push_back(left + h * (q + 0.5) / samples_per_piece);
      out.p.push_back(pressure(chain, j, out.S.back()));
      out.force += std::abs(out.p.back()) * h / samples_per_piece;
    }
  }
  return out;
}

/// Tensile force of the stretch around a negative minimum: two thirds of its depth times its width.
double tensile_pull(const Chain& chain, int j, double S, double low) {
  const double a = chain.S(j), b = chain.S(j + 1);
  auto reach = [&](double direction) {
    double step = 1e-7 * (b - a), x = S;
    for (int it = 0; it < 60; ++it, step *= 1.5) {
      x += direction * step;
      if (x <= a || x >= b) return std::abs(std::clamp(x, a, b) - S);
      if (pressure(chain, j, x) > 0.0) break;
    }
    return std::abs(x - S);
  };
  return 2.0 / 3.0 * low * (reach(-1.0) + reach(1.0));
}

void line_minima(const Chain& chain, int j, const LineSamples& samples, double scale, std::vector<Margin>& out) {
  const auto &S = samples.S, &p = samples.p;
  const double a = chain.S(j), b = chain.S(j + 1);
  const int n = static_cast<int>(S.size());
  for (int i = 0; i < n; ++i) {
    const bool low_left = i == 0 || p[i] <= p[i - 1], low_right = i == n - 1 || p[i] < p[i + 1];
    if (!low_left || !low_right) continue;
    double x = S[i], v = p[i];
    if (i > 0 && i < n - 1) {  // golden section; the minimum value converges twice as fast as its place
      double lo = S[i - 1], hi = S[i + 1];
      const double g = 0.6180339887498949;
      double x1 = hi - g * (hi - lo), x2 = lo + g * (hi - lo);
      double f1 = pressure(chain, j, x1), f2 = pressure(chain, j, x2);
      for (int it = 0; it < 36; ++it) {
        if (f1 < f2) {
          hi = x2, x2 = x1, f2 = f1, x1 = hi - g * (hi - lo), f1 = pressure(chain, j, x1);
        } else {
          lo = x1, x1 = x2, f1 = f2, x2 = lo + g * (hi - lo), f2 = pressure(chain, j, x2);
        }
      }
      // where the pressure jumps (a knot of the tube) the lower side counts
      for (const double y : {0.5 * (lo + hi), lo, hi})
        if (const double f = pressure(chain, j, y); f < v) {
          x = y;
          v = f;
        }
    } else {
      x = i == 0 ? a : b;
      v = pressure(chain, j, i == 0 ? a + 1e-9 * (b - a) : b - 1e-9 * (b - a));
    }
    out.push_back({CheckKind::pressure, j, x, v / scale, v, v < 0.0 ? tensile_pull(chain, j, x, v) / scale : 0.0});
  }
}

}  // namespace

double reaction(const Chain& chain, int junction) {
  const ScaledProblem& P = chain.mechanics().problem;
  const double S = chain.S(junction + 1);
  const Section sec = P.section(S);
  double Fn[2];
  for (int side = 0; side < 2; ++side) {
    const int j = junction + side;
    const auto& seg = chain.segment(j);
    double u[formulation::state_inputs];
    const int piece = side == 0 ? seg.pieces() - 1 : 0;
    seg.evaluate_local(piece, side == 0 ? 1.0 : 0.0, chain.S(j), chain.S(j + 1), u, nullptr);
    Fn[side] = chain.is_line(j) ? P.wall(sec, u).Fn : touch(P, sec, u).Fn;
  }
  return P.sign * (Fn[1] - Fn[0]);
}

double curvature_excess(const Chain& chain, int junction) {
  const ScaledProblem& P = chain.mechanics().problem;
  const auto& seg = chain.segment(junction);
  double u[formulation::state_inputs];
  seg.evaluate_local(seg.pieces() - 1, 1.0, chain.S(junction), chain.S(junction + 1), u, nullptr);
  return touch(P, P.section(chain.S(junction + 1)), u).kappa_excess;
}

double relative_gap(const Chain& chain, int segment, double S) {
  double u[formulation::state_inputs];
  chain.segment(segment).evaluate(S, chain.S(segment), chain.S(segment + 1), u, nullptr);
  return gap_jet(chain.mechanics().problem, chain.mechanics().problem.section(S), u)[0];
}

double pressure(const Chain& chain, int segment, double S) {
  const ScaledProblem& P = chain.mechanics().problem;
  double u[formulation::state_inputs];
  chain.segment(segment).evaluate(S, chain.S(segment), chain.S(segment + 1), u, nullptr);
  return -P.sign * P.wall(P.section(S), u).rho;
}

CutJump cut_jump(const Chain& chain, int segment, int cut) {
  const ScaledProblem& P = chain.mechanics().problem;
  const CutSegment& s = chain.segment(segment);
  CutJump out;
  out.S = s.cut(cut).S;
  const Section sec = P.section(out.S);
  double Fn[2], Mg[2], B[2], F3 = 0.0;
  for (int side = 0; side < 2; ++side) {
    const auto& part = s.part(cut + side);
    const double a = s.left(cut + side, chain.S(segment)), b = s.right(cut + side, chain.S(segment + 1));
    double u[formulation::state_inputs];
    part.evaluate_local(side == 0 ? part.pieces() - 1 : 0, side == 0 ? 1.0 : 0.0, a, b, u, nullptr);
    const auto& law = P.law.pieces[s.law(cut + side)];
    const auto w = formulation::VaryingLine::wall(law, P.curved, sec, u);
    Fn[side] = w.wall.Fn;
    Mg[side] = w.Mg;
    B[side] = law.at<double>(u[11]).B;
    F3 = std::max(F3, std::abs(u[9]));
  }
  if (s.cut(cut).load >= 0) {  // what is left of the load: the wall bears it along N, no couple about g
    double u[formulation::state_inputs];
    s.evaluate(out.S, chain.S(segment), chain.S(segment + 1), u, nullptr);
    const auto curve = P.wall(sec, u).curve;
    const auto& load = P.point_loads[s.cut(cut).load];
    const double scale = P.now(P.source.point_load_scale);
    Fn[1] += numerics::dot(in_frame(sec, scale * load.force), curve.N);
    Mg[1] += numerics::dot(in_frame(sec, scale * load.couple), curve.gv);
  }
  out.reaction = P.sign * (Fn[1] - Fn[0]);
  out.couple = Mg[1] - Mg[0];
  const double room = 0.5 * (chain.S(segment + 1) - chain.S(segment));
  out.span = std::min(room, std::sqrt(5.0 * std::abs(B[1] - B[0]) / std::max(F3, 1e-12)));  // (V.18)
  return out;
}

std::vector<Margin> margins(const Chain& chain) {
  std::vector<Margin> out;
  const int n = chain.segments();
  double most = 1.0;  // forces are compared with the largest contact force, and B/L² where there is none
  std::vector<double> R(n, 0.0);
  std::vector<LineSamples> lines(n);
  std::vector<std::pair<int, CutJump>> cuts;
  for (int j = 0; j + 1 < n; ++j) most = std::max(most, std::abs(R[j] = reaction(chain, j)));
  for (int j = 0; j < n; ++j)
    if (chain.is_line(j)) {
      lines[j] = sample_line(chain, j);
      most = std::max(most, lines[j].force);
      for (int q = 0; q + 1 < chain.segment(j).parts(); ++q) {
        cuts.push_back({j, cut_jump(chain, j, q)});
        most = std::max(most, std::abs(cuts.back().second.reaction));
      }
    }
  const auto collars = collar_states(chain);
  for (const CollarState& c : collars) most = std::max(most, std::abs(c.reaction));
  const bool open = open_across(chain.mechanics().problem);
  const TipState tip = open ? tip_state(chain) : TipState();
  most = std::max(most, std::abs(tip.reaction));
  for (int j = 0; j < n; ++j)
    if (n > 1)
      out.push_back({CheckKind::span, j, chain.S(j), chain.S(j + 1) - chain.S(j), chain.S(j + 1) - chain.S(j), 0.0});
  for (int j = 0; j + 1 < n; ++j) {
    out.push_back({CheckKind::reaction, j, chain.S(j + 1), R[j] / most, R[j], 0.0});
    if (!chain.is_line(j) && !chain.is_line(j + 1)) {
      const double k = curvature_excess(chain, j);
      const double scale = std::max(1.0, chain.mechanics().problem.clearance_max * 10.0);
      out.push_back({CheckKind::curvature, j, chain.S(j + 1), -k / scale, -k, 0.0});
    }
  }
  for (const auto& [j, c] : cuts) {
    out.push_back({CheckKind::pressure, j, c.S, c.reaction / most, c.reaction, std::min(c.reaction, 0.0) / most});
    constexpr double borne = 1e-9;  // [B/L], what rounding leaves of the moment
    if (std::abs(c.couple) < borne) continue;
    const double pull = -std::abs(c.couple) / std::max(c.span, 1e-6);
    out.push_back({CheckKind::pressure, j, c.S, pull / most, pull, pull / most});
  }
  for (int j = 0; j < n; ++j) {
    if (chain.is_line(j) && carries_nothing(chain, j)) {
      const double b = buckling_margin(chain, j);
      out.push_back({CheckKind::buckling, j, 0.5 * (chain.S(j) + chain.S(j + 1)), b, b, 0.0});
    }
    if (chain.is_line(j))
      line_minima(chain, j, lines[j], most, out);
    else
      free_minima(chain, j, out);
  }
  for (const CollarState& c : collars) {
    if (c.touches)
      out.push_back({CheckKind::collar_reaction, c.collar, c.S, c.reaction / most, c.reaction, 0.0});
    else
      out.push_back({CheckKind::collar_gap, c.collar, c.S, c.gap, c.gap, 0.0});
  }
  if (open) {
    const double S = chain.S(n);
    const bool line = chain.is_line(n - 1), free = chain.mechanics().problem.tip_free();
    if (!line && !chain.tip_rests()) out.push_back({CheckKind::tip_gap, n - 1, S, tip.gap, tip.gap, 0.0});
    if (line || chain.tip_rests())
      out.push_back({CheckKind::tip_reaction, n - 1, S, tip.reaction / most, tip.reaction, 0.0});
    if (!line && free && chain.tip_rests())
      out.push_back({CheckKind::tip_approach, n - 1, S, tip.approach, tip.approach, 0.0});
    if (line && free) out.push_back({CheckKind::tip_couple, n - 1, S, -std::abs(tip.couple), tip.couple, 0.0});
  }
  return out;
}

}  // namespace tendril::segmentation

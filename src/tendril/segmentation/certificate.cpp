#include "tendril/segmentation/certificate.hpp"

#include <algorithm>
#include <cmath>

#include "tendril/formulation/convert.hpp"
#include "tendril/numerics/gauss.hpp"
#include "tendril/segmentation/collars.hpp"
#include "tendril/segmentation/tip.hpp"

namespace tendril::segmentation {

using formulation::FreeRod;
using formulation::LineContact;
using formulation::Section;
using numerics::V3;

namespace {

using A3 = std::array<double, 3>;

A3 world(const Section& s, const V3<double>& c) {
  A3 w{};
  for (int i = 0; i < 3; ++i) w[i] = c[0] * s.D[0][i] + c[1] * s.D[1][i] + c[2] * s.D[2][i];
  return w;
}

A3 times(const A3& a, const A3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double norm(const A3& a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

/// World position, internal force and moment of a free-form state.
struct Resultants {
  A3 r, F, M;
  double alpha, inclination, H, M3;
};

Resultants resultants(const ScaledProblem& P, const Section& s, const double* u) {
  const auto k =
      FreeRod::kinematics<double>(formulation::lift<double>(s, 0.0, 0.0), u[0], u[1], u[2], u[4], u[5], u[6]);
  Resultants q;
  q.alpha = FreeRod::stretch(P.material_at(u), u[15]);
  const auto [M1, M2, M3] = P.moments(k, u);
  q.M3 = M3;
  V3<double> F{}, M{};
  for (int i = 0; i < 3; ++i) {
    F[i] = u[11] * k.k1[i] + u[13] * k.k2[i] + u[15] * k.t[i];
    M[i] = M1 * k.k1[i] + M2 * k.k2[i] + M3 * k.t[i];
  }
  q.F = world(s, F);
  q.M = world(s, M);
  q.r = world(s, {u[0], u[4], 0.0});
  for (int i = 0; i < 3; ++i) q.r[i] += s.R[i];
  q.inclination = k.t[2];
  q.H = 0.5 * (M1 * M1 + M2 * M2) + u[15] + 0.5 * P.material.eta2 * u[15] * u[15];  // of uniform rods
  return q;
}

void add_force(WallForce& w, const A3& r, const A3& f) {
  const A3 m = times(r, f);
  for (int i = 0; i < 3; ++i) {
    w.force[i] += f[i];
    w.moment[i] += m[i];
  }
}

}  // namespace

WallForce line_force(const Chain& chain, int j) {
  WallForce out;
  const ScaledProblem& P = chain.mechanics().problem;
  const auto& seg = chain.segment(j);
  const auto& g = numerics::gauss_table(7);
  double u[formulation::state_inputs], f[formulation::state_inputs];
  for (int i = 0; i < seg.pieces(); ++i) {
    const double a = seg.place(i, chain.S(j), chain.S(j + 1)), h = seg.place(i + 1, chain.S(j), chain.S(j + 1)) - a;
    for (int q = 0; q < g.k; ++q) {
      seg.evaluate_local(i, g.c[q], chain.S(j), chain.S(j + 1), u, nullptr);
      const Section s = P.section(a + h * g.c[q]);
      const auto w = P.wall(s, u);
      const double ds = h * g.b[q] / ((1.0 + P.material_at(u, true).eta2 * u[9]) * w.curve.J1bar);  // dS / J1
      A3 force = world(s, w.curve.N);
      for (double& x : force) x *= w.rho * ds;
      P.line_to_free(s, u, f);
      A3 r = world(s, {f[0], f[4], 0.0});
      for (int c = 0; c < 3; ++c) r[c] += s.R[c];
      add_force(out, r, force);
      out.magnitude += -P.sign * w.rho * ds;
    }
  }
  for (int q = 0; q + 1 < seg.parts(); ++q) {  // at kinks of the stiffness
    const CutJump c = cut_jump(chain, j, q);
    const Section s = P.section(c.S);
    seg.evaluate(c.S, chain.S(j), chain.S(j + 1), u, nullptr);
    A3 force = world(s, P.wall(s, u).curve.N);
    for (double& x : force) x *= -P.sign * c.reaction;
    P.line_to_free(s, u, f);
    A3 r = world(s, {f[0], f[4], 0.0});
    for (int i = 0; i < 3; ++i) r[i] += s.R[i];
    add_force(out, r, force);
    out.magnitude += c.reaction;
  }
  return out;
}

WallForce junction_force(const Chain& chain, int k) {
  WallForce out;
  const ScaledProblem& P = chain.mechanics().problem;
  const double R = reaction(chain, k), S = chain.S(k + 1);
  const Section s = P.section(S);
  // the force on the rod is -⟦F_n⟧ N = -ς R̂ N
  const int j = chain.is_line(k) ? k + 1 : k;  // a free side
  const auto& seg = chain.segment(j);
  double u[formulation::state_inputs];
  seg.evaluate_local(j == k ? seg.pieces() - 1 : 0, j == k ? 1.0 : 0.0, chain.S(j), chain.S(j + 1), u, nullptr);
  const double rad = std::hypot(u[0], u[4]), c3 = 1.0 - u[0] * s.U[0][1] + u[4] * s.U[0][0], w = std::hypot(c3, s.Q[1]);
  A3 force = world(s, {c3 * u[0] / rad / w, c3 * u[4] / rad / w, -s.Q[1] / w});
  for (double& x : force) x *= -P.sign * R;
  A3 r = world(s, {u[0], u[4], 0.0});
  for (int c = 0; c < 3; ++c) r[c] += s.R[c];
  add_force(out, r, force);
  out.magnitude = R;
  return out;
}

ChainCertificate certify(Chain& chain) {
  ChainCertificate c;
  const ScaledProblem& P = chain.mechanics().problem;
  c.error = chain.estimate_error();
  c.phase_multiplier = chain.phase_multiplier();
  const int n = chain.segments();

  c.continuity = guide_fault(chain);

  // ---- unilateral conditions ----
  c.gap_min = 1.0;
  double reaction_min = 1.0;
  bool any_reaction = false;
  for (const Margin& m : margins(chain)) {
    if (m.kind == CheckKind::gap || m.kind == CheckKind::tip_gap || m.kind == CheckKind::collar_gap)
      c.gap_min = std::min(c.gap_min, m.value);
    if (m.kind == CheckKind::tip_couple) c.continuity = std::max(c.continuity, std::abs(m.raw));
    if (m.kind == CheckKind::reaction || m.kind == CheckKind::pressure || m.kind == CheckKind::tip_reaction ||
        m.kind == CheckKind::collar_reaction) {
      reaction_min = std::min(reaction_min, m.kind == CheckKind::pressure && m.value < 0.0 ? m.pull : m.value);
      any_reaction = true;
    }
    if (m.kind == CheckKind::curvature)
      c.curvature_max =
          any_reaction ? std::max(c.curvature_max == 0 ? -1e300 : c.curvature_max, -m.value) : c.curvature_max;
  }
  if (n > 1 || chain.tip_rests()) c.gap_min = std::min(c.gap_min, 0.0);
  c.reaction_min = any_reaction ? reaction_min : 0.0;

  // ---- equations between the nodes, first integrals, whole-rod balance ----
  double F_max = 1.0, M_max = 1.0, H_low = HUGE_VAL, H_high = -HUGE_VAL, T_low = HUGE_VAL, T_high = -HUGE_VAL;
  A3 load{}, load_moment{};
  const auto& g = numerics::gauss_table(7);
  double u[formulation::state_inputs] = {}, f[formulation::state_inputs], out[8];
  std::vector<std::array<double, 2>> residuals;  // moment-like, force-like, per unit S
  for (int j = 0; j < n; ++j) {
    const auto& seg = chain.segment(j);
    const double a = chain.S(j), b = chain.S(j + 1);
    const bool line = chain.is_line(j);
    for (int i = 0; i < seg.pieces(); ++i) {
      // of a uniform rod the plain form, in which a state is evaluated whatever its unknowns are
      const collocation::System& system = P.varies() ? seg.system_of(i) : *chain.mechanics().system(line, 0);
      const double s0 = seg.place(i, a, b), h = seg.place(i + 1, a, b) - s0;
      for (int q = 0; q < 12; ++q) {
        const double x = (q + 0.5) / 12.0, S = s0 + x * h;
        seg.evaluate_local(i, x, a, b, u, nullptr);
        const Section sec = P.section(S);
        system.residual(S, u, out);
        if (line) {
          residuals.push_back(
              {h * std::max(std::abs(out[0]), std::abs(out[1])), h * std::max(std::abs(out[2]), std::abs(out[3]))});
          P.line_to_free(sec, u, f);
        } else {
          residuals.push_back({h * std::max({std::abs(out[0]), std::abs(out[1]), std::abs(out[2])}),
                               h * std::max({std::abs(out[3]), std::abs(out[4]), std::abs(out[5])})});
          std::copy_n(u, formulation::state_inputs, f);
        }
        const Resultants r = resultants(P, sec, f);
        F_max = std::max(F_max, norm(r.F));
        M_max = std::max(M_max, norm(r.M));
        H_low = std::min(H_low, r.H);
        H_high = std::max(H_high, r.H);
        T_low = std::min(T_low, r.M3);
        T_high = std::max(T_high, r.M3);
        c.strain_max = std::max(c.strain_max, std::abs(r.alpha - 1.0));
        c.smallest_inclination = std::min(c.smallest_inclination, r.inclination);
        c.smallest_stretch = std::min(c.smallest_stretch, r.alpha);
      }
      for (int q = 0; q < g.k; ++q) {  // weight and couple of the piece
        seg.evaluate_local(i, g.c[q], a, b, u, nullptr);
        const Section sec = P.section(s0 + h * g.c[q]);
        if (line)
          P.line_to_free(sec, u, f);
        else
          std::copy_n(u, formulation::state_inputs, f);
        A3 r = world(sec, {f[0], f[4], 0.0});
        for (int w = 0; w < 3; ++w) r[w] += sec.R[w];
        const auto k =
            FreeRod::kinematics<double>(formulation::lift<double>(sec, 0.0, 0.0), f[0], f[1], f[2], f[4], f[5], f[6]);
        const double ds = h * g.b[q] * (1.0 / (FreeRod::stretch(P.material_at(f), f[15]) * k.J1bar));
        const A3 sigma = world(sec, P.body_force_at(sec, f)), mu = world(sec, sec.mu), arm = times(r, sigma);
        for (int w = 0; w < 3; ++w) {
          load[w] += sigma[w] * ds;
          load_moment[w] += (arm[w] + mu[w]) * ds;
        }
      }
    }
  }
  for (const auto& r : residuals) c.equilibrium = std::max({c.equilibrium, r[0] / M_max, r[1] / F_max});
  if (P.weightless && !P.varies()) {
    c.invariant_spread = (H_high - H_low) / std::max({1.0, std::abs(H_low), std::abs(H_high)});
    c.invariant_spread =
        std::max(c.invariant_spread, (T_high - T_low) / std::max({1.0, std::abs(T_low), std::abs(T_high)}));
  }

  // ---- continuity at the junctions, from the two sides' free forms ----
  for (int k = 0; k + 1 < n; ++k) {
    Resultants side[2];
    A3 N{};
    const Section sec = P.section(chain.S(k + 1));
    for (int w = 0; w < 2; ++w) {
      const int j = k + w;
      const auto& seg = chain.segment(j);
      seg.evaluate_local(w == 0 ? seg.pieces() - 1 : 0, w == 0 ? 1.0 : 0.0, chain.S(j), chain.S(j + 1), u, nullptr);
      if (chain.is_line(j))
        P.line_to_free(sec, u, f);
      else
        std::copy_n(u, formulation::state_inputs, f);
      side[w] = resultants(P, sec, f);
      const double rad = std::hypot(f[0], f[4]), c3 = 1.0 - f[0] * sec.U[0][1] + f[4] * sec.U[0][0],
                   v = std::hypot(c3, sec.Q[1]);
      N = world(sec, {c3 * f[0] / rad / v, c3 * f[4] / rad / v, -sec.Q[1] / v});
    }
    double jump_n = 0.0;
    for (int i = 0; i < 3; ++i) jump_n += (side[1].F[i] - side[0].F[i]) * N[i];
    for (int i = 0; i < 3; ++i) {
      c.continuity = std::max(c.continuity, std::abs(side[1].r[i] - side[0].r[i]) / P.clearance_max);
      c.continuity = std::max(c.continuity, std::abs(side[1].F[i] - side[0].F[i] - jump_n * N[i]) / F_max);
      c.continuity = std::max(c.continuity, std::abs(side[1].M[i] - side[0].M[i]) / M_max);
    }
  }

  const auto collars = collar_states(chain);
  const auto loads = load_states(chain);
  for (int j = 0; j < n; ++j)
    for (int q = 0; q + 1 < chain.segment(j).parts(); ++q) {
      const CutSegment& cut = chain.segment(j);
      const Section sec = P.section(cut.cut(q).S);
      Resultants side[2];
      A3 N{};  // along which the wall lets F jump
      for (int w = 0; w < 2; ++w) {
        state_at_cut(chain, j, q, w, f);
        side[w] = resultants(P, sec, f);
      }
      if (chain.is_line(j)) {
        cut.evaluate(cut.cut(q).S, chain.S(j), chain.S(j + 1), u, nullptr);
        N = world(sec, P.wall(sec, u).curve.N);
      }
      for (const CollarState& x : collars)
        if (x.segment == j && x.cut == q && x.touches) {
          N = x.N;
          c.continuity = std::max(c.continuity, std::abs(x.gap));
        }
      for (const LoadState& x : loads)
        if (x.segment == j && x.cut == q)
          for (int i = 0; i < 3; ++i) {
            side[1].F[i] += x.force[i];
            side[1].M[i] += x.couple[i];
          }
      double jump_n = 0.0;
      for (int i = 0; i < 3; ++i) jump_n += (side[1].F[i] - side[0].F[i]) * N[i];
      for (int i = 0; i < 3; ++i) {
        c.continuity = std::max({c.continuity, std::abs(side[1].r[i] - side[0].r[i]) / P.clearance_max,
                                 std::abs(side[1].F[i] - side[0].F[i] - jump_n * N[i]) / F_max,
                                 std::abs(side[1].M[i] - side[0].M[i]) / M_max});
      }
    }

  // ---- balance of the whole rod: F(end) - F(start) + loads + wall forces = 0, moments about the origin likewise ----
  Resultants ends[2];
  for (int w = 0; w < 2; ++w) {
    const int j = w == 0 ? 0 : n - 1;
    const auto& seg = chain.segment(j);
    const double S = w == 0 ? chain.S(0) : chain.S(n);
    seg.evaluate_local(w == 0 ? 0 : seg.pieces() - 1, w == 0 ? 0.0 : 1.0, chain.S(j), chain.S(j + 1), u, nullptr);
    const Section sec = P.section(S);
    if (chain.is_line(j))
      P.line_to_free(sec, u, f);
    else
      std::copy_n(u, formulation::state_inputs, f);
    ends[w] = resultants(P, sec, f);
  }
  WallForce tip_wall;
  if (P.tip_free()) {  // what the tip is loaded with, not what the rod feels there
    const TipForces tip = tip_forces(chain);
    ends[1].F = tip.load;
    ends[1].M = tip.couple;
    add_force(tip_wall, tip.place, tip.wall);
    tip_wall.magnitude = norm(tip.wall);
  }
  A3 force = load, moment = load_moment;
  double contact_sum = 0.0, arm_max = 1.0;
  auto wall = [&](const WallForce& w) {
    for (int i = 0; i < 3; ++i) {
      force[i] += w.force[i];
      moment[i] += w.moment[i];
    }
    contact_sum += std::abs(w.magnitude);
  };
  for (int j = 0; j < n; ++j)
    if (chain.is_line(j)) wall(line_force(chain, j));
  for (int k = 0; k + 1 < n; ++k) wall(junction_force(chain, k));
  wall(tip_wall);
  for (const CollarState& x : collars) {
    if (!x.touches) continue;
    WallForce w;
    A3 push = x.N;
    for (double& v : push) v *= -P.sign * x.reaction;
    add_force(w, x.place, push);
    w.magnitude = x.reaction;
    wall(w);
  }
  double point_load = 0.0;
  for (const LoadState& x : loads) {
    WallForce w;
    add_force(w, x.place, x.force);
    for (int i = 0; i < 3; ++i) {
      force[i] += w.force[i];
      moment[i] += w.moment[i] + x.couple[i];
    }
    point_load += norm(x.force);
  }
  const A3 m0 = times(ends[0].r, ends[0].F), m1 = times(ends[1].r, ends[1].F);
  A3 reference{};
  for (int i = 0; i < 3; ++i) {
    force[i] += ends[1].F[i] - ends[0].F[i];
    moment[i] += ends[1].M[i] + m1[i] - ends[0].M[i] - m0[i];
    reference[i] = ends[1].r[i] - ends[0].r[i];
  }
  arm_max = std::max({arm_max, norm(ends[0].r), norm(ends[1].r)});
  const double F_scale = std::max(F_max, contact_sum + norm(load) + point_load);
  c.balance = std::max(norm(force) / F_scale, norm(moment) / std::max(M_max, F_scale * arm_max));
  return c;
}

}  // namespace tendril::segmentation

#include "tendril/segmentation/tip.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "tendril/segmentation/in_plane.hpp"
#include "tendril/segmentation/pattern_edit.hpp"

namespace tendril::segmentation {

using formulation::FreeRod;
using formulation::LineContact;
using formulation::Section;
using formulation::V3;
using numerics::dot;
using numerics::Dual;

namespace {

using T = Dual<14>;  // 11 states (7 of a line contact), S, p, s of a varying rod

struct Rows {
  int width, *n;
  const int* place;
  double *r, *values;
  void operator()(const T& f) const {
    r[*n] = f.v;
    for (int i = 0; i < 14; ++i)
      if (place[i] >= 0) values[*n * width + place[i]] += f.d[i];
    ++*n;
  }
};

template <class X>
V3<X> combined(const X& a, const V3<X>& u, const X& b, const V3<X>& v, const X& c, const V3<X>& w) {
  return {a * u[0] + b * v[0] + c * w[0], a * u[1] + b * v[1] + c * w[1], a * u[2] + b * v[2] + c * w[2]};
}

}  // namespace

bool open_across(const ScaledProblem& P) { return P.tip_free() || P.end.kind == End::Kind::guided; }

double guide_fault(const Chain& chain) {
  if (chain.mechanics().problem.end.kind != End::Kind::guided) return 0.0;
  double u[formulation::state_inputs];
  chain.sample(chain.S(chain.segments()), u, nullptr);
  return std::hypot(u[1], u[5]);
}

namespace {

/// `m`: the rod's material, or what it is at the tip of a rod that varies.
template <class M>
int tip_rows(const ScaledProblem& P, const M& m, bool line, bool rests, const double* z, double S, double* r,
             double* values) {
  constexpr bool varies = !std::is_same_v<M, formulation::Material>;
  const int ns = line ? 8 : 12, width = ns + 2, dense = line ? 7 : 11;
  int place[14], n = 0;
  T x[12];
  for (int i = 0; i < 14; ++i) place[i] = -1;
  for (int i = 0; i < dense; ++i) {
    x[i] = T::seed(z[i], i);
    place[i] = i;
  }
  const T dS = T::seed(0.0, 11), dp = T::seed(0.0, 12);
  place[11] = ns;
  place[12] = ns + 1;
  if (varies) place[13] = ns - 1;
  const Section sec = P.section(S);
  const auto l = formulation::lift<T>(sec, dS, dp);
  const auto Q = formulation::lift_clearance<T>(sec, dS, dp);
  auto now = [&](const Scalar& s) { return T(P.now(s)) + s.rate * dp; };
  const Rows row{width, &n, place, r, values};
  const bool guided = P.end.kind == End::Kind::guided;
  const T axial = !guided && P.source.axial == AxialControl::axial_force ? now(P.axial) : T(0.0);
  const T torque = P.source.twist == TwistControl::torque ? now(P.twist) : T(0.0);
  T M3, phi, M3_load;
  int out_of_plane[3] = {1, 2, 4};
  if (line) {
    const auto c = LineContact::curve<T>(l, Q, x[0], x[1], x[2]);
    M3 = LineContact::twisting_moment<T>(m, c, x[6], x[4]);
    const WallPlace<T> w(l, Q, x[0], x[1]);
    phi = x[3] - w.turn;
    // ψ: d1 = cosψ g + sinψ N, d2 = -sinψ g + cosψ N
    const T cp = cos(x[3]), sp = sin(x[3]);
    const TipLoadInD<T> load(P, sec, dS, combined<T>(cp, c.gv, sp, c.N, T(0.0), c.t),
                             combined<T>(-sp, c.gv, cp, c.N, T(0.0), c.t), c.t);
    const T alpha = 1.0 + m.eta2 * x[6];
    row(x[5] - dot(load.force, c.gv));
    T MN = alpha * c.kg;
    if constexpr (varies) MN = m.B * (MN - (m.k1 * sp + m.k2 * cp));
    row(MN - dot(load.couple, c.N));
    M3_load = dot(load.couple, c.t);
    row(M3 - torque - M3_load);
    row(x[6] - axial - dot(load.force, c.t));
    out_of_plane[0] = 0;
    out_of_plane[1] = 1;
    out_of_plane[2] = 2;
  } else {
    const FreeEnd<T> f(m, l, x);
    M3 = f.M3;
    phi = x[6];
    const T cp = cos(phi), sp = sin(phi);
    const TipLoadInD<T> load(P, sec, dS, combined<T>(cp, f.k.k1, sp, f.k.k2, T(0.0), f.k.t),
                             combined<T>(-sp, f.k.k1, cp, f.k.k2, T(0.0), f.k.t), f.k.t);
    const V3<T> F = combined<T>(x[8], f.k.k1, x[9], f.k.k2, x[10] - axial, f.k.t);
    V3<T> G = F;
    if (!guided)
      for (int i = 0; i < 3; ++i) G[i] = F[i] - load.force[i];
    T radius(0.0), e1(0.0), e2(0.0);
    if (rests) {
      radius = sqrt(x[0] * x[0] + x[3] * x[3]);
      e1 = x[0] / radius;
      e2 = x[3] / radius;
      row(radius - Q[0]);
      row(e1 * G[1] - e2 * G[0]);
    } else {
      row(dot(G, f.k.k1));
      row(dot(G, f.k.k2));
    }
    if (guided) {
      row(x[1]);
      row(x[4]);
      return n;
    }
    std::array<T, 2> bending{f.w1, f.w2};
    if constexpr (varies) bending = bending_moments<T>(m, f, phi);
    row(bending[0] - dot(load.couple, f.k.k1));
    row(bending[1] - dot(load.couple, f.k.k2));
    row(M3 - torque - dot(load.couple, f.k.t));
    if (rests)
      row(Q[1] * (e1 * G[0] + e2 * G[1]) + f.k.r1[2] * G[2]);
    else
      row(dot(G, f.k.t));
  }
  // along the axis: the place of the tip, or the length of the rod
  const bool length = P.source.axial == AxialControl::rod_length, from_end = P.law.from_end;
  const int column = length ? ns - 1 : ns;
  const Scalar value = length && from_end ? Scalar{} : length ? P.axial : P.end_position;
  r[n] = (length ? z[column] : S) - P.now(value);
  values[n * width + column] = 1.0;
  values[n * width + ns + 1] = -value.rate;
  ++n;
  if (from_end && !length) {  // s is counted from here; where the length is given, it stands at the other end
    r[n] = z[ns - 1];
    values[n * width + ns - 1] = 1.0;
    ++n;
  }
  if (P.planar) keep_end_in_plane(line, false, out_of_plane, z, r, values, width);
  return n;
}

}  // namespace

int free_tip_rows(const ScaledProblem& P, bool line, bool rests, int law, const double* z, double S, double* r,
                  double* values) {
  if (!P.varies()) return tip_rows(P, P.material, line, rests, z, S, r, values);
  const formulation::LocalMaterial<T> m(P.law.pieces[law], P.curved, T::seed(z[line ? 7 : 11], 13));
  return tip_rows(P, m, line, rests, z, S, r, values);
}

TipForces tip_forces(const Chain& chain) {
  TipForces out;
  const ScaledProblem& P = chain.mechanics().problem;
  const int n = chain.segments();
  double u[formulation::state_inputs];
  chain.sample(chain.S(n), u, nullptr);
  const Section sec = P.section(chain.S(n));
  const auto k =
      FreeRod::kinematics<double>(formulation::lift<double>(sec, 0.0, 0.0), u[0], u[1], u[2], u[4], u[5], u[6]);
  const double cp = std::cos(u[8]), sp = std::sin(u[8]), zero = 0.0;
  const TipLoadInD<double> load(P, sec, 0.0, combined(cp, k.k1, sp, k.k2, zero, k.t),
                                combined(-sp, k.k1, cp, k.k2, zero, k.t), k.t);
  const double axial = P.source.axial == AxialControl::axial_force ? P.now(P.axial) : 0.0;
  const double torque = P.source.twist == TwistControl::torque ? P.now(P.twist) : 0.0;
  const TipState tip = tip_state(chain);
  const double r = std::max(std::hypot(u[0], u[4]), 1e-300), w = std::hypot(k.r1[2], sec.Q[1]);
  const V3<double> N{k.r1[2] * u[0] / r / w, k.r1[2] * u[4] / r / w, -sec.Q[1] / w};
  for (int i = 0; i < 3; ++i) {
    out.place[i] = sec.R[i] + u[0] * sec.D[0][i] + u[4] * sec.D[1][i];
    for (int d = 0; d < 3; ++d) {
      out.load[i] += (load.force[d] + axial * k.t[d]) * sec.D[d][i];
      out.couple[i] += (load.couple[d] + torque * k.t[d]) * sec.D[d][i];
      out.wall[i] -= P.sign * tip.reaction * N[d] * sec.D[d][i];
    }
  }
  return out;
}

Pattern without_segment(const Chain& chain, const Pattern& q, int j) {
  Pattern r = remove_segment(q, j);
  const int n = static_cast<int>(q.line.size());
  if (j == n - 1 && n > 1 && open_across(chain.mechanics().problem)) r.tip = !q.line[j] && !r.line.back();
  return r;
}

std::vector<Pattern> tip_patterns(const Chain& chain, CheckKind violated) {
  std::vector<Pattern> out;
  Pattern q = chain.pattern();
  const int n = chain.segments();
  const double end = chain.S(n), span = end - chain.S(n - 1);
  auto overhang = [&](double length, bool tip) {  // a contact, and a free stretch behind it
    Pattern r = q;
    r.line.push_back(0);
    r.S.push_back(end - length);
    r.tip = tip;
    out.push_back(r);
  };
  switch (violated) {
    case CheckKind::tip_gap:
      q.tip = true;
      out.push_back(q);
      break;
    case CheckKind::tip_reaction:
      if (q.line.back()) {
        for (double f : {0.05, 0.2, 0.01}) overhang(f * span, false);
      } else {
        q.tip = false;
        out.push_back(q);
      }
      break;
    case CheckKind::tip_approach: {
      // the rod is beyond the wall from where it crosses it to the tip
      double a = 0.0;
      for (int i = 1; i <= 200; ++i)
        if (relative_gap(chain, n - 1, end - i / 200.0 * span) < 0.0) a = i / 200.0 * span;
      for (double f : {0.5, 0.2, 0.9}) overhang(f * std::max(a, 0.01 * span), false);
      break;
    }
    case CheckKind::tip_couple:
      for (const bool tip : {true, false})
        for (double f : {0.05, 0.2, 0.01}) overhang(f * span, tip);
      break;
    default:
      break;
  }
  return out;
}

TipState tip_state(const Chain& chain) {
  TipState out;
  const ScaledProblem& P = chain.mechanics().problem;
  const int j = chain.segments() - 1;
  const double S = chain.S(j + 1);
  const Section sec = P.section(S);
  const auto l = formulation::lift<double>(sec, 0.0, 0.0);
  const auto& seg = chain.segment(j);
  const bool guided = P.end.kind == End::Kind::guided;
  const double axial = !guided && P.source.axial == AxialControl::axial_force ? P.now(P.axial) : 0.0;
  if (chain.is_line(j)) {
    double u[formulation::state_inputs];
    seg.evaluate_local(seg.pieces() - 1, 1.0, chain.S(j), S, u, nullptr);
    const auto w = P.wall(sec, u);
    const auto& c = w.curve;
    const double cp = std::cos(u[4]), sp = std::sin(u[4]), zero = 0.0;
    const TipLoadInD<double> load(P, sec, 0.0, combined(cp, c.gv, sp, c.N, zero, c.t),
                                  combined(-sp, c.gv, cp, c.N, zero, c.t), c.t);
    out.reaction = -P.sign * (w.Fn - dot(load.force, c.N));
    const auto m = P.material_at(u, true);
    const double natural = m.natural[0] * cp - m.natural[1] * sp;  // along g
    out.couple = m.bending * (-(1.0 + m.eta2 * u[9]) * c.kn - natural) - dot(load.couple, c.gv);
    out.push = u[9];
    return out;
  }
  double u[formulation::state_inputs];
  seg.evaluate_local(seg.pieces() - 1, 1.0, chain.S(j), S, u, nullptr);
  const auto k = FreeRod::kinematics<double>(l, u[0], u[1], u[2], u[4], u[5], u[6]);
  const double cp = std::cos(u[8]), sp = std::sin(u[8]), zero = 0.0;
  const TipLoadInD<double> load(P, sec, 0.0, combined(cp, k.k1, sp, k.k2, zero, k.t),
                                combined(-sp, k.k1, cp, k.k2, zero, k.t), k.t);
  V3<double> G = combined(u[11], k.k1, u[13], k.k2, u[15] - axial, k.t);
  out.push = u[15];
  for (int i = 0; i < 3 && !guided; ++i) G[i] -= load.force[i];
  const double r = std::hypot(u[0], u[4]), q = sec.Q[0];
  out.gap = P.sign * (q - r) / q;
  if (r > 1e-9 * q) {
    out.approach = -P.sign * (sec.Q[1] - (u[0] * u[1] + u[4] * u[5]) / r) / q;
    if (chain.tip_rests()) {
      const double w = std::hypot(k.r1[2], sec.Q[1]);
      const V3<double> N{k.r1[2] * u[0] / r / w, k.r1[2] * u[4] / r / w, -sec.Q[1] / w};
      out.reaction = -P.sign * (guided ? (G[0] * u[0] + G[1] * u[4]) / r * w / k.r1[2] : dot(G, N));
    }
  }
  return out;
}

}  // namespace tendril::segmentation

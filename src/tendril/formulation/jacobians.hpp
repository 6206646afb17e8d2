#pragma once
// Exact Jacobians of the two elementary formulations over R = double or several sections side by side: forward duals
// for what depends on the shape only, the balance equations differentiated by hand on top (their derivatives are tested
// against duals). Row-major, equations x (inputs + 2): d/d(inputs), d/dS, d/dp.

#include "tendril/formulation/free_rod.hpp"
#include "tendril/formulation/line_contact.hpp"
#include "tendril/numerics/dual.hpp"

namespace tendril::formulation {

template <class R>
void free_rod_jacobian(const Material& m, const Fields<R>& s, bool loads_move, const R* u, R* out, R* jac) {
  // The shape depends on δ1, δ2 and the place: eight inputs and S.
  constexpr int shape_inputs = 8, seeds = shape_inputs + 1, width = FreeRod::inputs + 2;
  using T = numerics::Dual<seeds, R>;
  T v[shape_inputs];
  for (int j = 0; j < shape_inputs; ++j) v[j] = T::seed(u[j], j);
  const FreeRod::Shape<T> q = FreeRod::shape<T>(lift<T>(s, T::seed(R(0.0), shape_inputs), T(0.0)), v);
  const FreeRod::Shape<R> value{q.J.v,  q.Jp.v, q.p.v,  q.h.v,  q.pp.v, q.hp.v, q.c.v,
                                q.cp.v, q.s1.v, q.s2.v, q.s3.v, q.m1.v, q.m2.v, q.m3.v};
  FreeRod::balance<R>(m, value, u, out, out + FreeRod::components);

  const R &phip = u[9], &phipp = u[10], &F1 = u[11], &F1p = u[12], &F2 = u[13], &F2p = u[14], &F3 = u[15], &F3p = u[16];
  const R alpha = FreeRod::stretch(m, F3), alphap = m.eta2 * F3p;
  const R &J = q.J.v, &Jp = q.Jp.v, &p = q.p.v, &h = q.h.v, &pp = q.pp.v, &hp = q.hp.v, &c = q.c.v, &cp = q.cp.v;
  const R A = alpha * J, Ap = alphap * J + alpha * Jp;  // J1, J1'
  const R w1 = -(A * h), w2 = A * p, w3 = A * c;
  const R w1p = -(Ap * h + A * hp), w2p = Ap * p + A * pp;
  const R fc = 1.0 / (1.0 + m.nu), twist = c + phip, rate = cp + phipp;
  const R M3 = fc * (A * twist), M3p = fc * (Ap * twist + A * rate);

  // derivatives with respect to J1, J1' and the shape at fixed J1, then to the inputs that are not of the shape
  struct Row {
    R A{0.0}, Ap{0.0}, p{0.0}, h{0.0}, pp{0.0}, hp{0.0}, c{0.0}, cp{0.0}, alpha{0.0};
    R phip{0.0}, phipp{0.0}, F[3]{0.0, 0.0, 0.0}, Fp{0.0};  // Fp: of the force's own derivative
  };
  Row d[FreeRod::components];
  d[0].A = w1p - A * hp + p * M3 + w2 * fc * twist - c * w2 - w3 * p;  // (II.2.51)
  d[0].Ap = -(A * h);
  d[0].h = -(A * Ap);
  d[0].hp = -(A * A);
  d[0].p = A * (M3 - w3);
  d[0].c = A * w2 * (fc - 1.0);
  d[0].phip = w2 * fc * A;
  d[0].alpha = -F2;
  d[0].F[1] = -alpha;
  d[1].A = w2p + A * pp + c * w1 - w3 * h + h * M3 - w1 * fc * twist;  // (II.2.52)
  d[1].Ap = A * p;
  d[1].p = A * Ap;
  d[1].pp = A * A;
  d[1].h = A * (M3 - w3);
  d[1].c = A * w1 * (1.0 - fc);
  d[1].phip = -(w1 * fc * A);
  d[1].alpha = F1;
  d[1].F[0] = alpha;
  d[2].A = M3p + A * fc * rate;  // (II.2.53)
  d[2].Ap = A * fc * twist;
  d[2].c = d[2].phip = A * fc * Ap;
  d[2].cp = d[2].phipp = A * fc * A;
  d[3].A = F1p + p * F3 - c * F2;  // (II.2.48)
  d[3].p = A * F3;
  d[3].c = -(A * F2);
  d[3].F[2] = w2;
  d[3].F[1] = -w3;
  d[3].Fp = A;
  d[4].A = F2p + c * F1 + h * F3;  // (II.2.49)
  d[4].h = A * F3;
  d[4].c = A * F1;
  d[4].F[0] = w3;
  d[4].F[2] = -w1;
  d[4].Fp = A;
  d[5].A = F3p - h * F2 - p * F1;  // (II.2.50)
  d[5].h = -(A * F2);
  d[5].p = -(A * F1);
  d[5].F[1] = w1;
  d[5].F[0] = -w2;
  d[5].Fp = A;

  const T* loads[FreeRod::components] = {&q.m1, &q.m2, &q.m3, &q.s1, &q.s2, &q.s3};
  R load_rate[FreeRod::components];
  for (R& x : load_rate) x = R(0.0);
  if (loads_move) {
    const Lifted<R> l = lift<R>(s, R(0.0), R(0.0));
    const auto k = FreeRod::kinematics<R>(l, u[0], u[1], u[2], u[4], u[5], u[6]);
    const V3<R>* basis[3] = {&k.k1, &k.k2, &k.t};
    for (int j = 0; j < 3; ++j) {
      load_rate[j] = numerics::dot(s.mu_rate, *basis[j]);
      load_rate[3 + j] = numerics::dot(s.sigma_rate, *basis[j]);
    }
  }
  for (int e = 0; e < FreeRod::components; ++e) {
    R* row = jac + e * width;
    const Row& x = d[e];
    const R to_J = alpha * x.A + alphap * x.Ap, to_Jp = alpha * x.Ap;
    for (int j = 0; j < seeds; ++j) {
      R sum = to_J * q.J.d[j] + to_Jp * q.Jp.d[j] + x.c * q.c.d[j] + loads[e]->d[j];
      if (e != 2) sum += x.p * q.p.d[j] + x.h * q.h.d[j];
      if (e == 0) sum += x.hp * q.hp.d[j];
      if (e == 1) sum += x.pp * q.pp.d[j];
      if (e == 2) sum += x.cp * q.cp.d[j];
      row[j < shape_inputs ? j : FreeRod::inputs] = sum;
    }
    row[8] = R(0.0);  // φ itself enters no equation
    row[9] = x.phip;
    row[10] = x.phipp;
    row[11] = x.F[0];
    row[13] = x.F[1];
    // F3 and F3' also through the stretch: α = 1 + η² F3, J1 = α J, J1' = α' J + α J'
    row[15] = x.F[2] + m.eta2 * (x.alpha + J * x.A + Jp * x.Ap);
    row[12] = row[14] = R(0.0);
    row[16] = m.eta2 * (J * x.Ap);
    if (e >= 3) row[2 * e + 6] += x.Fp;
    row[FreeRod::inputs + 1] = load_rate[e];
  }
  R* row = jac + FreeRod::components * width;  // ds/dS = 1/J1
  const R slope = -1.0 / (A * A);
  for (int j = 0; j < width; ++j) row[j] = R(0.0);
  for (int j = 0; j < seeds; ++j) row[j < shape_inputs ? j : FreeRod::inputs] = slope * alpha * q.J.d[j];
  row[15] = slope * m.eta2 * J;
}

/// Equations and their derivatives with respect to δ1''', δ2''', φ'', F1', F2', F3' alone: out[7], top[6 x 6].
template <class R>
void free_rod_highest(const Material& m, const Fields<R>& s, const R* u, R* out, R* top) {
  constexpr int n = FreeRod::components;
  using T = numerics::Dual<2, R>;
  T v[8];
  for (int j = 0; j < 8; ++j) v[j] = T(u[j]);
  v[3] = T::seed(u[3], 0);
  v[7] = T::seed(u[7], 1);
  const FreeRod::Shape<T> q = FreeRod::shape<T>(lift<T>(s, T(0.0), T(0.0)), v);
  const FreeRod::Shape<R> value{q.J.v,  q.Jp.v, q.p.v,  q.h.v,  q.pp.v, q.hp.v, q.c.v,
                                q.cp.v, q.s1.v, q.s2.v, q.s3.v, q.m1.v, q.m2.v, q.m3.v};
  FreeRod::balance<R>(m, value, u, out, out + n);
  const R A = FreeRod::stretch(m, u[15]) * q.J.v, fc = 1.0 / (1.0 + m.nu);
  const R slope = m.eta2 * (q.J.v * A);  // of J1 J1' with F3'
  for (int i = 0; i < n * n; ++i) top[i] = R(0.0);
  for (int j = 0; j < 2; ++j) {  // δ''' enters p', h' and (ω3/J1)' alone
    top[j] = -(A * A * q.hp.d[j]);
    top[n + j] = A * A * q.pp.d[j];
    top[2 * n + j] = fc * A * A * q.cp.d[j];
  }
  top[5] = -(slope * q.h.v);
  top[n + 5] = slope * q.p.v;
  top[2 * n + 2] = fc * A * A;
  top[2 * n + 5] = slope * fc * (q.c.v + u[9]);
  for (int e = 3; e < n; ++e) top[e * n + e] = A;
}

template <class R>
void line_contact_jacobian(const Material& m, const Fields<R>& s, const R* u, R* out, R* jac) {
  // The curve depends on β to β''', the place and p; ψ itself enters no equation.
  constexpr int curve_inputs = 4, curve_seeds = curve_inputs + 2;
  constexpr int seeds = LineContact::inputs - 1 + 2, skip = LineContact::first[LineContact::phi];
  using N = numerics::Dual<curve_seeds, R>;
  using T = numerics::Dual<seeds, R>;
  N v[curve_inputs];
  for (int j = 0; j < curve_inputs; ++j) v[j] = N::seed(u[j], j);
  const N dS = N::seed(R(0.0), curve_inputs), dp = N::seed(R(0.0), curve_inputs + 1);
  const auto narrow = LineContact::shape<N>(lift<N>(s, dS, dp), lift_clearance<N>(s, dS, dp), v);
  auto widen = [](const N& n) {
    T t(n.v);
    for (int j = 0; j < curve_inputs; ++j) t.d[j] = n.d[j];
    t.d[seeds - 2] = n.d[curve_inputs];
    t.d[seeds - 1] = n.d[curve_inputs + 1];
    return t;
  };
  const LineContact::Shape<T> shape{widen(narrow.J),  widen(narrow.Jp),  widen(narrow.kn), widen(narrow.knp),
                                    widen(narrow.kg), widen(narrow.kgp), widen(narrow.tg), widen(narrow.tgp),
                                    widen(narrow.sg), widen(narrow.s3),  widen(narrow.mg), widen(narrow.mn),
                                    widen(narrow.m3)};
  T x[LineContact::inputs], r[LineContact::components + 1];
  int q = 0;
  for (int j = 0; j < LineContact::inputs; ++j) x[j] = j == skip ? T(u[j]) : T::seed(u[j], q++);
  LineContact::balance<T>(m, shape, x, r, r + LineContact::components);
  for (int e = 0; e <= LineContact::components; ++e) {
    out[e] = r[e].v;
    R* row = jac + e * (LineContact::inputs + 2);
    q = 0;
    for (int j = 0; j < LineContact::inputs; ++j) row[j] = j == skip ? R(0.0) : r[e].d[q++];
    row[LineContact::inputs] = r[e].d[q];
    row[LineContact::inputs + 1] = r[e].d[q + 1];
  }
}

}  // namespace tendril::formulation

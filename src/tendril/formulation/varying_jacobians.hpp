#pragma once
// Exact Jacobians of the formulations of a varying rod over R = double or several sections side by side: narrow forward
// duals for what depends on the shape and the place only, wide ones for the balance equations on top. Row-major,
// equations x (inputs + 2): d/d(inputs), d/dS, d/dp.

#include "tendril/formulation/varying_rod.hpp"

namespace tendril::formulation {

/// A dual over `narrow` inputs, S and p as one over all inputs; place[i] is where input i goes.
template <int Wide, int Narrow, class R>
numerics::Dual<Wide, R> widen(const numerics::Dual<Narrow, R>& n, const int* place) {
  numerics::Dual<Wide, R> t(n.v);
  for (int i = 0; i < Narrow - 2; ++i) t.d[place[i]] = n.d[i];
  t.d[Wide - 2] = n.d[Narrow - 2];
  t.d[Wide - 1] = n.d[Narrow - 1];
  return t;
}

template <int N, class R>
void store_jacobian(const numerics::Dual<N, R>* r, int count, R* out, R* jac) {
  for (int e = 0; e < count; ++e) {
    out[e] = r[e].v;
    for (int j = 0; j < N; ++j) jac[e * N + j] = r[e].d[j];
  }
}

template <class R>
void varying_free_jacobian(const rod::SectionPiece& law, bool curved, const Fields<R>& s, const R* u, R* out, R* jac) {
  constexpr int shape_inputs = 8, wide = VaryingFree::inputs + 2;
  constexpr int place[shape_inputs] = {0, 1, 2, 3, 4, 5, 6, 7};
  using N = numerics::Dual<shape_inputs + 2, R>;
  using T = numerics::Dual<wide, R>;
  N v[shape_inputs];
  for (int j = 0; j < shape_inputs; ++j) v[j] = N::seed(u[j], j);
  const N dS = N::seed(R(0.0), shape_inputs), dp = N::seed(R(0.0), shape_inputs + 1);
  const Lifted<N> l = lift<N>(s, dS, dp);
  const FreeRod::Shape<N> n = FreeRod::shape<N>(l, v);
  const VaryingFree::Heavy<N> g = VaryingFree::heavy<N>(l, lift_gravity<N>(s, dS, dp), v);
  const auto w = [&](const N& x) { return widen<wide>(x, place); };
  const FreeRod::Shape<T> q{w(n.J),  w(n.Jp), w(n.p),  w(n.h),  w(n.pp), w(n.hp), w(n.c),
                            w(n.cp), w(n.s1), w(n.s2), w(n.s3), w(n.m1), w(n.m2), w(n.m3)};
  const VaryingFree::Heavy<T> h{w(g.g1), w(g.g2), w(g.g3)};
  T x[VaryingFree::inputs], r[VaryingFree::components];
  for (int j = 0; j < VaryingFree::inputs; ++j) x[j] = T::seed(u[j], j);
  VaryingFree::balance<T>(law, curved, q, h, x, r);
  store_jacobian<wide, R>(r, VaryingFree::components, out, jac);
}

template <class R>
void varying_line_jacobian(const rod::SectionPiece& law, bool curved, const Fields<R>& s, const R* u, R* out, R* jac) {
  constexpr int curve_inputs = 4, wide = VaryingLine::inputs + 2;
  constexpr int place[curve_inputs] = {0, 1, 2, 3};
  using N = numerics::Dual<curve_inputs + 2, R>;
  using T = numerics::Dual<wide, R>;
  N v[curve_inputs];
  for (int j = 0; j < curve_inputs; ++j) v[j] = N::seed(u[j], j);
  const N dS = N::seed(R(0.0), curve_inputs), dp = N::seed(R(0.0), curve_inputs + 1);
  VaryingLine::Heavy<N> g;
  const LineContact::Shape<N> n =
      varying_line_shape<N>(lift<N>(s, dS, dp), lift_gravity<N>(s, dS, dp), lift_clearance<N>(s, dS, dp), v, g);
  const auto w = [&](const N& x) { return widen<wide>(x, place); };
  const LineContact::Shape<T> q{w(n.J),   w(n.Jp), w(n.kn), w(n.knp), w(n.kg), w(n.kgp), w(n.tg),
                                w(n.tgp), w(n.sg), w(n.s3), w(n.mg),  w(n.mn), w(n.m3)};
  const VaryingLine::Heavy<T> h{w(g.gg), w(g.g3)};
  T x[VaryingLine::inputs], r[VaryingLine::components];
  for (int j = 0; j < VaryingLine::inputs; ++j) x[j] = T::seed(u[j], j);
  VaryingLine::balance<T>(law, curved, q, h, x, r);
  store_jacobian<wide, R>(r, VaryingLine::components, out, jac);
}

template <class T, class R>
void varying_free_residual(const rod::SectionPiece& law, bool curved, const Fields<R>& s, const T* u, T* out) {
  const Lifted<T> l = lift<T>(s, T(0.0), T(0.0));
  VaryingFree::balance<T>(law, curved, FreeRod::shape<T>(l, u),
                          VaryingFree::heavy<T>(l, lift_gravity<T>(s, T(0.0), T(0.0)), u), u, out);
}

template <class T, class R>
void varying_line_residual(const rod::SectionPiece& law, bool curved, const Fields<R>& s, const T* u, T* out) {
  VaryingLine::Heavy<T> g;
  const auto q = varying_line_shape<T>(lift<T>(s, T(0.0), T(0.0)), lift_gravity<T>(s, T(0.0), T(0.0)),
                                       lift_clearance<T>(s, T(0.0), T(0.0)), u, g);
  VaryingLine::balance<T>(law, curved, q, g, u, out);
}

}  // namespace tendril::formulation

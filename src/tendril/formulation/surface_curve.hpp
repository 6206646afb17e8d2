#pragma once
// A curve β(S) on the normal ringed surface, N outward: curvatures κ_n, κ_g, torsion τ_g and the Jacobian (III.2.9-16
// and A.4.11 with the corrected signs of docs/decisions/0004). Any scalar type: evaluated on jets it also yields the
// total derivatives along the curve.

#include <array>
#include <cmath>

#include "tendril/numerics/vec3.hpp"

namespace tendril::formulation {

using numerics::V3;

template <class T>
struct SurfaceCurve {
  T J1bar, kn, kg, tg;  // dS/ds̄, normal and geodesic curvature, geodesic torsion
  V3<T> t, gv, N;       // tangent d3, N x d3, outward normal; components in D
};

/// U, Up: frame curvatures and derivative; Q, Qp, Qpp: clearance; b, bp, bpp: polar angle β and derivatives.
template <class T>
SurfaceCurve<T> surface_curve(const V3<T>& U, const V3<T>& Up, const T& Q, const T& Qp, const T& Qpp, const T& b,
                              const T& bp, const T& bpp) {
  using numerics::cross;
  using numerics::dot;
  using numerics::operator+;
  using numerics::operator-;
  using numerics::operator*;
  using std::cos;
  using std::sin;
  using std::sqrt;
  SurfaceCurve<T> c;
  const T cb = cos(b), sb = sin(b);
  const V3<T> e{cb, sb, T(0.0)}, e1{-sb, cb, T(0.0)};
  const T C3 = 1.0 + Q * (U[0] * sb - U[1] * cb);
  const V3<T> Ue = cross(U, e);
  const V3<T> Ss = {Qp * cb - Q * U[2] * sb, Qp * sb + Q * U[2] * cb, C3};
  const V3<T> Sb = Q * e1;
  // S_ss = component derivative of S_s plus U x S_s
  V3<T> Sss = Qpp * e + (2.0 * Qp) * Ue + Q * (cross(Up, e) + cross(U, Ue));
  Sss = Sss + V3<T>{U[1], -U[0], T(0.0)};  // D3' = U2 D1 - U1 D2
  const V3<T> Ssb = Qp * e1 + Q * cross(U, e1);
  const T w = sqrt(C3 * C3 + Qp * Qp), wi = 1.0 / w;
  c.N = {C3 * e[0] * wi, C3 * e[1] * wi, -(Qp * wi)};  // outward
  const V3<T> r1 = Ss + bp * Sb;
  const T J = 1.0 / sqrt(dot(r1, r1));
  c.J1bar = J;
  c.t = J * r1;
  c.gv = cross(c.N, c.t);
  const V3<T> r2 = Sss + (2.0 * bp) * Ssb - (bp * bp * Q) * e + bpp * Sb;
  const T J2 = J * J;
  c.kn = J2 * dot(r2, c.N);
  c.kg = J2 * dot(r2, c.gv);
  // τ_g = II(t, g), with g = x S_s + y S_b (S_b = Q e1 and S_s's part along D3 and e span the tangent plane)
  const T II_e = dot(Sss, c.N), II_f = dot(Ssb, c.N), II_g = -(Q * C3 * wi);
  const T E = dot(Ss, Ss), F = dot(Ss, Sb), G = Q * Q;
  const T gs = dot(c.gv, Ss), gb = dot(c.gv, Sb), det = 1.0 / (E * G - F * F);
  const T x = (G * gs - F * gb) * det, y = (E * gb - F * gs) * det;
  c.tg = J * (II_e * x + II_f * (bp * x + y) + II_g * bp * y);
  return c;
}

}  // namespace tendril::formulation

#pragma once
// Normal ringed surface of radius Q(S) around the reference curve, S(S,β) = R + Q (cosβ D1 + sinβ D2), and curves β(S)
// on it: forms and curvatures in components of (D1, D2, D3), for any scalar type with + - * / sqrt sin cos. General:
// Q' != 0 and U3 != 0. The normal N points outward, away from the axis. Primes are d/dS. Source: appendix A.4 with the
// corrected A.4.11, and (III.2.14), (III.2.16) with their signs for N outward (III.2.14 and III.2.16 change sign).
// Regular where Q² (C3² + Q'²) > 0; the map to the axis is one-to-one where C3 > 0.

#include <cmath>

#include "tendril/geometry/tube.hpp"
#include "tendril/geometry/vec3.hpp"

namespace tendril::geometry {

/// What the surface needs to know of one section; derivatives that are not needed may be left 0 (see below).
template <class T>
struct RingSection {
  Triple<T> U, dU, ddU;  // in components of D; ddU enters the third derivatives only
  T Q, dQ, ddQ, dddQ;    // dddQ enters the third derivatives only
};

/// Section of a tube at S.
inline RingSection<double> ring_section(const AxisPoint& point, const std::array<double, 5>& Q) {
  const auto triple = [](const Vec3& v) { return Triple<double>{{v[0], v[1], v[2]}}; };
  return {triple(point.U[0]), triple(point.U[1]), triple(point.U[2]), Q[0], Q[1], Q[2], Q[3]};
}

/// Surface at (S, β): tangents, second and third derivatives, normal, fundamental forms.
template <class T>
struct RingedSurface {
  Triple<T> S1, Sb;         // S_ξ, S_β
  Triple<T> S11, S1b, Sbb;  // second derivatives
  Triple<T> S111, S11b, S1bb, Sbbb;
  Triple<T> N;  // outward unit normal
  T C3;         // 1 + Q (U1 sinβ - U2 cosβ)
  T E, F, G;    // first form (A.4.10)
  T e, f, g;    // second form for N outward (A.4.11 corrected)

  RingedSurface(const RingSection<T>& r, const T& beta) {
    using std::cos;
    using std::sin;
    using std::sqrt;
    const T c = cos(beta), s = sin(beta), zero = T(0.0) * beta, one = zero + T(1.0);
    const Triple<T> er{{c, s, zero}}, eb{{-s, c, zero}}, D3{{zero, zero, one}};
    const Triple<T> Ue = cross(r.U, er), dUe = cross(r.dU, er), ddUe = cross(r.ddU, er);
    const Triple<T> Ub = cross(r.U, eb), dUb = cross(r.dU, eb);
    const T two = T(2.0);

    // ∂ξ a = a_ξ (components) + U x a.
    S1 = D3 + r.dQ * er + r.Q * Ue;
    Sb = r.Q * eb;
    const Triple<T> dS1 = r.ddQ * er + r.dQ * Ue + r.Q * dUe;
    S11 = dS1 + cross(r.U, S1);
    S1b = r.dQ * eb + r.Q * Ub;
    Sbb = -(r.Q * er);
    const Triple<T> ddS1 = r.dddQ * er + r.ddQ * Ue + two * r.dQ * dUe + r.Q * ddUe;
    S111 = ddS1 + cross(r.dU, S1) + cross(r.U, dS1) + cross(r.U, S11);
    S11b = r.ddQ * eb + r.dQ * Ub + r.Q * dUb + cross(r.U, S1b);
    S1bb = -(r.dQ * er + r.Q * Ue);
    Sbbb = -(r.Q * eb);

    C3 = one + r.Q * (r.U[0] * s - r.U[1] * c);
    const T w = sqrt(C3 * C3 + r.dQ * r.dQ);
    N = (one / w) * (C3 * er - r.dQ * D3);  // (A.4.6)
    E = C3 * C3 + r.Q * r.Q * r.U[2] * r.U[2] + r.dQ * r.dQ;
    F = r.Q * r.Q * r.U[2];
    G = r.Q * r.Q;
    e = (C3 * (S11[0] * c + S11[1] * s) - r.dQ * S11[2]) / w;
    f = -(r.Q * ((r.U[0] * c + r.U[1] * s) * r.dQ + C3 * r.U[2])) / w;
    g = -(r.Q * C3) / w;
  }
};

/// Direction β' on the surface: everything that needs no β''.
template <class T>
struct DirectionOnTube {
  T dbeta;
  T Jbar1;       // dξ/ds̄ = 1/|r'|
  Triple<T> dr;  // r'
  Triple<T> t;   // unit tangent
  Triple<T> gv;  // N x t
  Triple<T> a;   // r'' without its β'' part
  T kappa_n;     // normal curvature (III.2.15)
  T tau_g;       // geodesic torsion, -(III.2.16)
  T x, y;        // gv = x S_ξ + y S_β

  DirectionOnTube(const RingedSurface<T>& surface, const T& beta1) : dbeta(beta1) {
    using std::sqrt;
    const T one = T(1.0), two = T(2.0);
    const auto& m = surface;
    dr = m.S1 + dbeta * m.Sb;
    Jbar1 = one / sqrt(dot(dr, dr));
    t = Jbar1 * dr;
    gv = cross(m.N, t);
    a = m.S11 + two * dbeta * m.S1b + dbeta * dbeta * m.Sbb;
    kappa_n = Jbar1 * Jbar1 * (m.e + two * m.f * dbeta + m.g * dbeta * dbeta);
    // gv·S_ξ = J̄1 √(EG - F²) β' and gv·S_β = -J̄1 √(EG - F²) (S_ξ x S_β points inward), solved with the first form.
    const T root = sqrt(m.E * m.G - m.F * m.F);
    x = Jbar1 * (m.F + m.G * dbeta) / root;
    y = -(Jbar1 * (m.E + m.F * dbeta)) / root;
    tau_g = Jbar1 * (m.e * x + m.f * (dbeta * x + y) + m.g * dbeta * y);
  }
};

/// Curve β(S) on the surface: β', β''. Also κ_n', which does not depend on β'''.
template <class T>
struct CurveOnTube : DirectionOnTube<T> {
  Triple<T> ddr;  // r''
  T kappa_g;      // geodesic curvature, -(III.2.14)
  T dkappa_n;     // κ_n' (needs U'' and Q''')

  CurveOnTube(const RingedSurface<T>& m, const T& beta1, const T& beta2) : DirectionOnTube<T>(m, beta1) {
    const T J2 = this->Jbar1 * this->Jbar1, b = beta1, two = T(2.0), three = T(3.0);
    ddr = this->a + beta2 * m.Sb;
    kappa_g = J2 * dot(ddr, this->gv);
    // r''' without its β''' part; N' by Weingarten.
    const Triple<T> dddr =
        m.S111 + three * b * m.S11b + three * b * b * m.S1bb + b * b * b * m.Sbbb + three * beta2 * (m.S1b + b * m.Sbb);
    const Triple<T> dN = -((T(1.0) / this->Jbar1) * (this->kappa_n * this->t + this->tau_g * this->gv));
    dkappa_n = J2 * (dot(dddr, m.N) + dot(ddr, dN)) - two * this->kappa_n * J2 * dot(this->dr, ddr);
  }
};

/// β'' of the curve with this direction and geodesic curvature (inverse of CurveOnTube::kappa_g).
template <class T>
T second_angle_derivative(const RingedSurface<T>& surface, const DirectionOnTube<T>& direction, const T& kappa_g) {
  const T J2 = direction.Jbar1 * direction.Jbar1;
  return (kappa_g / J2 - dot(direction.a, direction.gv)) / dot(surface.Sb, direction.gv);
}

}  // namespace tendril::geometry

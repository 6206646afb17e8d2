#pragma once
// Contact-free elementary problem, Eulerian form (II.2.36-53): the rod as eccentricity δ1, δ2 over the arc length S of
// the reference curve, directors turned by φ in the intermediate basis k1, k2, k3 = d3, internal force F1, F2, F3 in
// that basis. Orders 3,3,2,1,1,1. Scaled by L and B; the prime is d/dS. Valid while d3·D3 > 0 and C3 > 0.

#include <array>
#include <cmath>

#include "tendril/formulation/section.hpp"

namespace tendril::formulation {

struct FreeRod {
  static constexpr int components = 6;
  static constexpr std::array<int, 6> order{3, 3, 2, 1, 1, 1};  // δ1 δ2 φ F1 F2 F3
  static constexpr int quadratures = 1;                         // s
  static constexpr int inputs = 17;                             // derivatives 0..order of every component
  // place of each component's value in the inputs
  static constexpr std::array<int, 6> first{0, 4, 8, 11, 13, 15};
  static constexpr int phi = 2;  // component whose value (not slope) never enters the equations

  /// Kinematics that need δ to δ'' only.
  template <class T>
  struct Kinematics {
    V3<T> t, t1, k1, k2;  // d3, d(d3)/dS (full derivative), basis; components in D
    T J1bar;              // dS/ds̄ = 1/|r'|
    T p, h;               // t1·k1, t1·k2
    T c;                  // ω3/J1
    T r1r2;               // r'·r''
    V3<T> r1, r2, gp;     // r', r'' (full), component derivative of d3
  };

  template <class T>
  static Kinematics<T> kinematics(const Lifted<T>& s, const T& d1, const T& d1p, const T& d1pp, const T& d2,
                                  const T& d2p, const T& d2pp) {
    using numerics::cross;
    using numerics::dot;
    using numerics::operator+;
    using numerics::operator-;
    using numerics::operator*;
    using std::sqrt;
    Kinematics<T> k;
    const V3<T>&U = s.U[0], &U1 = s.U[1];
    const V3<T> a{d1, d2, T(0.0)}, a1{d1p, d2p, T(0.0)}, a2{d1pp, d2pp, T(0.0)};
    k.r1 = a1 + cross(U, a);  // (II.2.3)
    k.r1[2] = k.r1[2] + 1.0;
    k.r2 = a2 + cross(U1, a) + cross(U, a1) + cross(U, k.r1);
    k.J1bar = 1.0 / sqrt(dot(k.r1, k.r1));  // (II.2.4)
    k.r1r2 = dot(k.r1, k.r2);
    const T J3 = k.J1bar * k.J1bar * k.J1bar;
    k.t = k.J1bar * k.r1;
    k.t1 = k.J1bar * k.r2 - (J3 * k.r1r2) * k.r1;
    // k1, k2: D1, D2 turned by the smallest rotation that takes D3 to d3 (II.2.12)
    const T q = 1.0 / (1.0 + k.t[2]);
    const T g12 = -(k.t[0] * k.t[1] * q);
    k.k1 = {1.0 - k.t[0] * k.t[0] * q, g12, -k.t[0]};
    k.k2 = {g12, 1.0 - k.t[1] * k.t[1] * q, -k.t[1]};
    k.p = dot(k.t1, k.k1);
    k.h = dot(k.t1, k.k2);
    k.gp = k.t1 - cross(U, k.t);
    k.c = dot(U, k.t) - (k.t[0] * k.gp[1] - k.gp[0] * k.t[1]) * q;  // (II.2.47) over J1
    return k;
  }

  /// Stretch (II.2.33)
  template <class M, class T>
  static T stretch(const M& m, const T& F3) {
    return 1.0 + m.eta2 * F3;
  }

  /// Twisting moment (II.2.37): M3 = (ω3 + J1 φ')/(1+ν)
  template <class T, class M>
  static T twisting_moment(const M& m, const Kinematics<T>& k, const T& F3, const T& phip) {
    return stretch(m, F3) * k.J1bar * (k.c + phip) / (1.0 + m.nu);
  }

  /// What the balance equations need of the shape (δ to δ''') and of the loads: no internal force, no φ.
  template <class T>
  struct Shape {
    T J, Jp;                   // dS/ds̄ and its derivative
    T p, h, pp, hp;            // components of d(d3)/dS along k1, k2, and their derivatives
    T c, cp;                   // ω3/J1 and its derivative
    T s1, s2, s3, m1, m2, m3;  // body force and couple in the k basis
  };

  template <class T>
  static Shape<T> shape(const Lifted<T>& s, const T* u) {
    using numerics::cross;
    using numerics::dot;
    using numerics::operator+;
    using numerics::operator-;
    using numerics::operator*;
    const Kinematics<T> k = kinematics(s, u[0], u[1], u[2], u[4], u[5], u[6]);
    const V3<T>&U = s.U[0], &U1 = s.U[1], &U2 = s.U[2];
    // third derivative of r
    const V3<T> a{u[0], u[4], T(0.0)}, a1{u[1], u[5], T(0.0)}, a2{u[2], u[6], T(0.0)}, a3{u[3], u[7], T(0.0)};
    const V3<T> r1p = a2 + cross(U1, a) + cross(U, a1);  // component derivatives
    const V3<T> r1pp = a3 + cross(U2, a) + T(2.0) * cross(U1, a1) + cross(U, a2);
    const V3<T> r3 = r1pp + cross(U1, k.r1) + cross(U, r1p) + cross(U, k.r2);
    Shape<T> q;
    const T J = k.J1bar, J2 = J * J, J3 = J2 * J;
    q.J = J;
    q.Jp = -(J3 * k.r1r2);
    const T Jpp = 3.0 * (J3 * J2 * k.r1r2 * k.r1r2) - J3 * (dot(k.r2, k.r2) + dot(r3, k.r1));
    const V3<T> t2 = J * r3 + (2.0 * q.Jp) * k.r2 + Jpp * k.r1;
    q.p = k.p;
    q.h = k.h;
    q.c = k.c;
    q.pp = dot(t2, k.k1) + k.c * k.h;  // the k basis turns with (ω1, ω2, ω3)/J1
    q.hp = dot(t2, k.k2) - k.c * k.p;
    const V3<T> gpp = t2 - cross(U1, k.t) - cross(U, k.gp) - cross(U, k.t1);
    const T f = 1.0 / (1.0 + k.t[2]);
    q.cp = dot(U1, k.t) + dot(U, k.gp) - (k.t[0] * gpp[1] - gpp[0] * k.t[1]) * f +
           (k.t[0] * k.gp[1] - k.gp[0] * k.t[1]) * (f * f * k.gp[2]);
    q.s1 = dot(s.sigma, k.k1), q.s2 = dot(s.sigma, k.k2), q.s3 = dot(s.sigma, k.t);
    q.m1 = dot(s.mu, k.k1), q.m2 = dot(s.mu, k.k2), q.m3 = dot(s.mu, k.t);
    return q;
  }

  /// Residuals of (II.2.48-53) for a shape and the inputs u (of which φ', φ'' and the forces are read), and ds/dS.
  template <class T>
  static void balance(const Material& m, const Shape<T>& q, const T* u, T* res, T* quad) {
    const T &F1 = u[11], &F1p = u[12], &F2 = u[13], &F2p = u[14], &F3 = u[15], &F3p = u[16];
    const T alpha = stretch(m, F3), alphap = m.eta2 * F3p;
    const T J1 = alpha * q.J, J1p = alphap * q.J + alpha * q.Jp;
    // twist vector of the k basis (II.2.45-47) and its derivatives
    const T w1 = -(J1 * q.h), w2 = J1 * q.p, w3 = J1 * q.c;
    const T w1p = -(J1p * q.h + J1 * q.hp), w2p = J1p * q.p + J1 * q.pp;
    const double fc = 1.0 / (1.0 + m.nu);
    const T twist = q.c + u[9];
    const T M3 = fc * (J1 * twist);
    const T M3p = fc * (J1p * twist + J1 * (q.cp + u[10]));
    res[0] = J1 * w1p + w2 * M3 - w3 * w2 - alpha * F2 + q.m1;  // (II.2.51)
    res[1] = J1 * w2p + w3 * w1 - w1 * M3 + alpha * F1 + q.m2;  // (II.2.52)
    res[2] = J1 * M3p + q.m3;                                   // (II.2.53)
    res[3] = J1 * F1p + w2 * F3 - w3 * F2 + q.s1;               // (II.2.48)
    res[4] = J1 * F2p + w3 * F1 - w1 * F3 + q.s2;               // (II.2.49)
    res[5] = J1 * F3p + w1 * F2 - w2 * F1 + q.s3;               // (II.2.50)
    quad[0] = 1.0 / J1;                                         // ds/dS
  }

  /// Residuals of (II.2.48-53), and ds/dS.
  template <class T>
  static void residual(const Material& m, const Lifted<T>& s, const T* u, T* res, T* quad) {
    balance(m, shape(s, u), u, res, quad);
  }
};

}  // namespace tendril::formulation

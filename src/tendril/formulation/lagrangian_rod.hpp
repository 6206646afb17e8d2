#pragma once
// Lagrangian formulation (II.1): special Cosserat rod in the world frame over its own arc length, as systems on x in
// [0,1] with s = s_a + l x, l unknown. Position r, attitude as a unit quaternion q (no singular attitude; Gauss
// collocation conserves quadratic invariants, so |q| = 1 needs no condition), force F and moment M in world components:
//   r' = α d3, α = 1 + η² F·d3,  q' = ½ (0, Ω) q, Ω = M + ν (M·d3) d3,  F' = -f - p,  M' = -α d3 x F - m
// (II.1.2-3, 12-15), the prime being d/ds. Line contact: the rod is a curve on the wall X(S, β); d3·N = 0 and its
// derivative M·(d3 x N) = α κ_n are invariants of the equations, conditions at one end; the next derivative gives
// F·N, so the wall's pressure never enters. N outward. Scaled by L and B. Shares nothing with the Eulerian forms.

#include <array>
#include <functional>
#include <vector>

#include "tendril/formulation/lagrangian_wall.hpp"
#include "tendril/formulation/section.hpp"

namespace tendril::formulation {

template <class T>
using Quaternion = std::array<T, 4>;  // w, x, y, z

/// Directors of a unit quaternion.
template <class T>
V3<T> director1(const Quaternion<T>& q) {
  return {1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]), 2.0 * (q[1] * q[2] + q[0] * q[3]),
          2.0 * (q[1] * q[3] - q[0] * q[2])};
}
template <class T>
V3<T> director3(const Quaternion<T>& q) {
  return {2.0 * (q[1] * q[3] + q[0] * q[2]), 2.0 * (q[2] * q[3] - q[0] * q[1]),
          1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2])};
}

/// What is the same along the whole rod.
struct LagrangianRodData {
  Material material;
  std::function<TubeJet(double S)> tube;
  V3<double> force{}, couple{};  // f, m: per unit reference length, world
};

/// Rates of attitude and moment, free or not.
template <class T>
struct CosseratRates {
  V3<T> Omega, dd3, dM;
  Quaternion<T> dq;
  CosseratRates(const LagrangianRodData& rod, const T& alpha, const Quaternion<T>& q, const V3<T>& d3, const V3<T>& F,
                const V3<T>& M) {
    using numerics::cross;
    using numerics::dot;
    using numerics::operator+;
    using numerics::operator*;
    Omega = M + (rod.material.nu * dot(M, d3)) * d3;  // (II.1.15)
    const V3<T> v{q[1], q[2], q[3]};
    const V3<T> dv = T(0.5) * (q[0] * Omega + cross(Omega, v));  // (II.1.2)
    dq = {-(0.5 * dot(Omega, v)), dv[0], dv[1], dv[2]};
    dd3 = cross(Omega, d3);
    dM = T(-1.0) * (alpha * cross(d3, F));  // (II.1.13)
    for (int i = 0; i < 3; ++i) dM[i] = dM[i] - rod.couple[i];
  }
};

/// Contact-free: r 0-2, q 3-6, F 7-9, M 10-12, l 13.
struct LagrangianFree {
  static constexpr int components = 14;
  const LagrangianRodData* rod = nullptr;
  std::vector<int> order = std::vector<int>(components, 1);
  int quadratures = 0;

  template <class T>
  void operator()(const T&, const T* u, const T&, T* out) const {
    using numerics::dot;
    const Quaternion<T> q{u[6], u[8], u[10], u[12]};
    const V3<T> F{u[14], u[16], u[18]}, M{u[20], u[22], u[24]}, d3 = director3(q);
    const T& l = u[26];
    const T alpha = 1.0 + rod->material.eta2 * dot(F, d3);  // (II.1.14)
    const CosseratRates<T> c(*rod, alpha, q, d3, F, M);
    for (int i = 0; i < 3; ++i) {
      out[i] = u[2 * i + 1] - l * (alpha * d3[i]);     // (II.1.3)
      out[7 + i] = u[15 + 2 * i] + l * rod->force[i];  // (II.1.12)
      out[10 + i] = u[21 + 2 * i] - l * c.dM[i];       // (II.1.13)
    }
    for (int i = 0; i < 4; ++i) out[3 + i] = u[7 + 2 * i] - l * c.dq[i];
    out[13] = u[27];
  }
};

/// State of a line contact and everything that follows from it.
template <class T>
struct LagrangianContact {
  T alpha, kn, Fn, dS, dbeta, dFt, dFg;
  V3<T> d3, N, g, F, dN;  // g = N x d3
  CosseratRates<T> cosserat;

  LagrangianContact(const LagrangianRodData& rod, const TubeJet& tube, const T& S, const T& beta,
                    const Quaternion<T>& q, const V3<T>& M, const T& Ft, const T& Fg)
      : LagrangianContact(rod, WallPoint<T>(tube, S, beta), tube, S, beta, q, M, Ft, Fg) {}

 private:
  LagrangianContact(const LagrangianRodData& rod, const WallPoint<T>& wall, const TubeJet& tube, const T& S,
                    const T& beta, const Quaternion<T>& q, const V3<T>& M, const T& Ft, const T& Fg)
      : alpha(1.0 + rod.material.eta2 * Ft),
        d3(director3(q)),
        N(wall.N),
        cosserat(rod, alpha, q, d3, V3<T>{T(0.0), T(0.0), T(0.0)}, M) {
    using numerics::cross;
    using numerics::dot;
    using numerics::operator+;
    using numerics::operator-;
    using numerics::operator*;
    using J = numerics::Jet<T>;
    const auto rate = wall.rates(d3);
    dS = alpha * rate[0];
    dbeta = alpha * rate[1];
    // along the rod: N' and κ_n'
    const V3<T>& dd3 = cosserat.dd3;
    const WallPoint<J> moving(tube, J(S, dS), J(beta, dbeta));
    const J curvature = moving.normal_curvature(moving.rates({J(d3[0], dd3[0]), J(d3[1], dd3[1]), J(d3[2], dd3[2])}));
    kn = curvature.v;
    dN = {moving.N[0].d, moving.N[1].d, moving.N[2].d};
    g = cross(N, d3);
    const V3<T> dg = cross(dN, d3) + cross(N, dd3), across = cross(d3, N);
    const V3<T> f{T(rod.force[0]), T(rod.force[1]), T(rod.force[2])};
    const V3<T> m{T(rod.couple[0]), T(rod.couple[1]), T(rod.couple[2])};
    // (M·(d3 x N) - α κ_n)' = 0 with M' = -α d3 x F - m and α' = η² (F·d3' - f·d3), for F·N
    const double eta2 = rod.material.eta2;
    const T pull = Fg * dot(g, dd3) - dot(f, d3);
    Fn = (dot(M, cross(dd3, N) + cross(d3, dN)) - dot(m, across) - alpha * curvature.d - eta2 * (kn * pull)) /
         (alpha + eta2 * (kn * dot(N, dd3)));
    F = Ft * d3 + Fg * g + Fn * N;
    dFt = pull + Fn * dot(N, dd3);  // the pressure along N drops out of F·d3 and F·g
    dFg = dot(F, dg) - dot(f, g);
    cosserat.dM = T(-1.0) * (alpha * cross(d3, F)) - m;
  }
};

/// Line contact: S 0, β 1, q 2-5, M 6-8, F·d3 9, F·g 10, l 11.
struct LagrangianLine {
  static constexpr int components = 12;
  const LagrangianRodData* rod = nullptr;
  std::vector<int> order = std::vector<int>(components, 1);
  int quadratures = 0;

  template <class T>
  void operator()(const T&, const T* u, const T&, T* out) const {
    const Quaternion<T> q{u[4], u[6], u[8], u[10]};
    const V3<T> M{u[12], u[14], u[16]};
    const T& l = u[22];
    const LagrangianContact<T> c(*rod, rod->tube(numerics::value(u[0])), u[0], u[2], q, M, u[18], u[20]);
    out[0] = u[1] - l * c.dS;
    out[1] = u[3] - l * c.dbeta;
    for (int i = 0; i < 4; ++i) out[2 + i] = u[5 + 2 * i] - l * c.cosserat.dq[i];
    for (int i = 0; i < 3; ++i) out[6 + i] = u[13 + 2 * i] - l * c.cosserat.dM[i];
    out[9] = u[19] - l * c.dFt;
    out[10] = u[21] - l * c.dFg;
    out[11] = u[23];
  }
};

/// Pressure of the wall on the rod along N, per unit reference length: ρ = -f·N - (F·N)' + F·N'. `u` as above.
double lagrangian_pressure(const LagrangianRodData& rod, const double* u);

}  // namespace tendril::formulation

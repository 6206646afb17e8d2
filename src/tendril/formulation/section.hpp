#pragma once
// What the governing equations need of one section S of the tube: frame curvatures, clearance and loads, all scaled by
// L and B (lengths L, forces B/L^2, moments B/L). `lift` carries them to a derivative scalar: dS is a scalar of value 0
// whose derivative says how S moves with the unknowns, dp likewise for the path parameter.

#include <array>

#include "tendril/numerics/vec3.hpp"

namespace tendril::formulation {

using numerics::V3;

struct Material {
  double eta2 = 0.0;               // η² = B/(A L²); 0: inextensible
  double nu = 0.0;                 // 1 + ν = B/C
  double bending = 1.0;            // of a varying rod: B at a section over the scale's
  double natural[2] = {0.0, 0.0};  // and its curvature without stress about d1 and d2
};

/// What varies along the axis, over R = double or several sections side by side (numerics/pack.hpp).
template <class R>
struct Fields {
  std::array<V3<R>, 4> U{};         // U..U''' in D
  std::array<R, 5> Q{}, Q_rate{};   // Q..Q'''' ; d/dp of Q..Q'''
  V3<R> sigma{}, mu{};              // body force and couple, components in D
  V3<R> sigma_rate{}, mu_rate{};    // d/dp
  V3<R> sigma_slope{}, mu_slope{};  // of loads that change along the axis: d/dS of the world's vector, in D
  V3<R> gravity{}, gravity_rate{};  // of varying rods: force per unit of the section's weight, components in D; d/dp
};

struct Section : Fields<double> {
  double S = 0.0;
  V3<double> R{}, D[3]{};  // position and frame vectors, world
};

template <class T>
struct Lifted {
  std::array<V3<T>, 3> U;  // U, U', U''
  V3<T> sigma, mu;
};

/// d/dS of the components of a load: a world-fixed vector's turn against the frame, x' = -U x x.
template <class R>
V3<R> load_slope(const V3<R>& load, const V3<R>& slope, const V3<R>& U) {
  V3<R> d = numerics::cross(load, U);
  for (int i = 0; i < 3; ++i) d[i] = d[i] + slope[i];
  return d;
}

template <class T, class R>
Lifted<T> lift(const Fields<R>& s, const T& dS, const T& dp) {
  Lifted<T> l;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) l.U[j][i] = s.U[j][i] + s.U[j + 1][i] * dS;
  const V3<R> ds = load_slope(s.sigma, s.sigma_slope, s.U[0]), dm = load_slope(s.mu, s.mu_slope, s.U[0]);
  for (int i = 0; i < 3; ++i) {
    l.sigma[i] = s.sigma[i] + ds[i] * dS + s.sigma_rate[i] * dp;
    l.mu[i] = s.mu[i] + dm[i] * dS + s.mu_rate[i] * dp;
  }
  return l;
}

/// Direction of the weight of a varying rod, with derivatives.
template <class T, class R>
V3<T> lift_gravity(const Fields<R>& s, const T& dS, const T& dp) {
  const V3<R> dg = numerics::cross(s.gravity, s.U[0]);
  V3<T> g;
  for (int i = 0; i < 3; ++i) g[i] = s.gravity[i] + dg[i] * dS + s.gravity_rate[i] * dp;
  return g;
}

/// Q, Q', Q'', Q''' at the section, with derivatives.
template <class T, class R>
std::array<T, 4> lift_clearance(const Fields<R>& s, const T& dS, const T& dp) {
  std::array<T, 4> q;
  for (int j = 0; j < 4; ++j) q[j] = s.Q[j] + s.Q[j + 1] * dS + s.Q_rate[j] * dp;
  return q;
}

}  // namespace tendril::formulation

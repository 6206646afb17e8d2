#pragma once
// A direction t in a parametric surface, given by its angle θ from the u-line (any parametrisation, skew ones too), and
// the invariants that belong to it: Darboux frame {t, g = N x t, N}, normal curvature, geodesic torsion, rates of u, v
// and θ along the curve. And, as a second way, the thesis' formulas for a curve u(s), v(s) (III.1.13-19).

#include "tendril/geometry/parametric_surface.hpp"

namespace tendril::geometry {

template <class T>
struct SurfaceDirection {
  Triple<T> t, g, N;
  T u_rate, v_rate;    // du, dv per arc length [1/length each]
  T geodesic_turning;  // dθ per arc length of the geodesic: dθ/ds̄ = κ_g + geodesic_turning
  T kappa_n, tau_g;
  T kappa_n_along;  // dκ_n/ds̄ of the geodesic; of a curve: + 2 κ_g τ_g
};

template <class T>
SurfaceDirection<T> surface_direction(const Patch<T, 3>& S, const T& theta) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const Triple<T>&Su = S(1, 0), &Sv = S(0, 1);
  SurfaceDirection<T> d;
  const Triple<T> n = cross(Su, Sv);
  const T w = sqrt(dot(n, n)), root_E = sqrt(dot(Su, Su));  // w² = EG - F²
  d.N = (1.0 / w) * n;                                      // (III.1.6)
  const Triple<T> a1 = (1.0 / root_E) * Su, a2 = cross(d.N, a1);
  const T skew = dot(a1, Sv), height = w / root_E;  // S_v = skew a1 + height a2
  const T c = cos(theta), s = sin(theta);
  d.t = c * a1 + s * a2;
  d.g = c * a2 - s * a1;
  d.v_rate = s / height;
  d.u_rate = (c - skew * d.v_rate) / root_E;
  const T y = c / height, x = (-s - skew * y) / root_E;  // g = x S_u + y S_v
  d.geodesic_turning = -(dot(d.u_rate * S(2, 0) + d.v_rate * S(1, 1), a2) / root_E);
  // second derivative of the curve without its part along S_u, S_v
  const T uu = d.u_rate * d.u_rate, uv = d.u_rate * d.v_rate, vv = d.v_rate * d.v_rate;
  const Triple<T> bend = uu * S(2, 0) + (2.0 * uv) * S(1, 1) + vv * S(0, 2);
  d.kappa_n = dot(bend, d.N);  // (III.1.18) at unit speed
  d.tau_g = dot((d.u_rate * x) * S(2, 0) + (d.u_rate * y + d.v_rate * x) * S(1, 1) + (d.v_rate * y) * S(0, 2), d.N);
  // along the geodesic: u'', v'' make the tangential part of r'' vanish (III.1.56-57)
  const T v2 = -(dot(bend, a2) / height), u2 = -((dot(bend, a1) + skew * v2) / root_E);
  const Triple<T> third = (uu * d.u_rate) * S(3, 0) + (3.0 * (uu * d.v_rate)) * S(2, 1) +
                          (3.0 * (vv * d.u_rate)) * S(1, 2) + (vv * d.v_rate) * S(0, 3);
  const Triple<T> mixed =
      (d.u_rate * u2) * S(2, 0) + (d.u_rate * v2 + d.v_rate * u2) * S(1, 1) + (d.v_rate * v2) * S(0, 2);
  d.kappa_n_along = dot(third, d.N) + 3.0 * dot(mixed, d.N);
  return d;
}

/// Invariants of the curve u(s), v(s) with the derivatives u1, v1, u2, v2 in any parameter, by the fundamental forms
/// and Christoffel symbols as printed in (III.1.3), (III.1.13-19).
struct CurveInvariants {
  double kappa_g, kappa_n, tau_g;
};
CurveInvariants curve_invariants(const Patch<double, 4>& S, double u1, double v1, double u2, double v2);

}  // namespace tendril::geometry

#pragma once
// The tube in the world frame, as the Lagrangian formulation needs it: derivatives of the axis, of two normals and of
// the clearance at one place S, and the wall X(S, β) = R + Q (cosβ D1 + sinβ D2) around it on any scalar whose S has
// that place as its value (Taylor's sums then carry every derivative exactly). Scaled by L; primes are d/dS.

#include <array>
#include <cmath>

#include "tendril/numerics/dual.hpp"
#include "tendril/numerics/vec3.hpp"

namespace tendril::formulation {

using numerics::V3;

struct TubeJet {
  double S = 0.0;
  std::array<V3<double>, 6> R{};         // R .. R^(5)
  std::array<V3<double>, 5> D1{}, D2{};  // D1 .. D1''''
  std::array<double, 5> Q{};             // Q .. Q''''
};

/// Derivative of order `from` at S + dS, from all derivatives at S.
template <class T, std::size_t N>
T taylor(const std::array<double, N>& c, const T& dS, std::size_t from) {
  T sum(c[N - 1]);
  for (std::size_t k = N - 1; k-- > from;) sum = c[k] + sum * dS * (1.0 / static_cast<double>(k + 1 - from));
  return sum;
}
template <class T, std::size_t N>
V3<T> taylor(const std::array<V3<double>, N>& c, const T& dS, std::size_t from) {
  V3<T> out;
  for (int i = 0; i < 3; ++i) {
    std::array<double, N> ci;
    for (std::size_t k = 0; k < N; ++k) ci[k] = c[k][i];
    out[i] = taylor<T>(ci, dS, from);
  }
  return out;
}

/// Wall at (S, β): place, tangents, second derivatives, outward unit normal.
template <class T>
struct WallPoint {
  V3<T> X, XS, Xb, XSS, XSb, Xbb, N;

  WallPoint(const TubeJet& t, const T& S, const T& beta) {
    using numerics::cross;
    using numerics::dot;
    using numerics::operator+;
    using numerics::operator-;
    using numerics::operator*;
    using std::cos;
    using std::sin;
    using std::sqrt;
    const T dS = S - t.S, c = cos(beta), s = sin(beta);
    V3<T> e[3], b[3];  // radial direction and the one around, with derivatives in S
    T Q[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const V3<T> D1 = taylor<T>(t.D1, dS, k), D2 = taylor<T>(t.D2, dS, k);
      e[k] = c * D1 + s * D2;
      b[k] = c * D2 - s * D1;
      Q[k] = taylor<T>(t.Q, dS, k);
    }
    X = taylor<T>(t.R, dS, 0) + Q[0] * e[0];
    XS = taylor<T>(t.R, dS, 1) + Q[1] * e[0] + Q[0] * e[1];
    XSS = taylor<T>(t.R, dS, 2) + Q[2] * e[0] + (2.0 * Q[1]) * e[1] + Q[0] * e[2];
    Xb = Q[0] * b[0];
    XSb = Q[1] * b[0] + Q[0] * b[1];
    Xbb = T(-1.0) * (Q[0] * e[0]);
    const V3<T> n = cross(Xb, XS);  // outward for a right-handed frame
    N = (1.0 / sqrt(dot(n, n))) * n;
  }

  /// Rates (dS, dβ) of a curve with unit tangent t, per stretched arc length (III.1.5).
  std::array<T, 2> rates(const V3<T>& t) const {
    using numerics::dot;
    const T E = dot(XS, XS), F = dot(XS, Xb), G = dot(Xb, Xb), a = dot(t, XS), b = dot(t, Xb);
    const T inverse = 1.0 / (E * G - F * F);
    return {(G * a - F * b) * inverse, (E * b - F * a) * inverse};
  }
  /// Normal curvature of that curve: second fundamental form (III.1.17).
  T normal_curvature(const std::array<T, 2>& rate) const {
    using numerics::dot;
    return rate[0] * rate[0] * dot(XSS, N) + 2.0 * (rate[0] * rate[1] * dot(XSb, N)) + rate[1] * rate[1] * dot(Xbb, N);
  }
};

/// Place on the axis closest to r (near `guess`), with exact first derivatives; not finite when there is none.
template <class Tube, class T>
T closest_place(const Tube& tube, const V3<T>& r, double guess) {
  using numerics::dot;
  using numerics::value;
  using numerics::operator-;
  const V3<double> r0{value(r[0]), value(r[1]), value(r[2])};
  double S = guess;
  for (int it = 0; it < 60; ++it) {
    const TubeJet t = tube(S);
    const V3<double> d = r0 - t.R[0];
    const double step = dot(d, t.R[1]) / (1.0 - dot(d, t.R[2]));
    S += std::abs(step) > 0.1 ? std::copysign(0.1, step) : step;
    if (std::abs(step) < 1e-15) break;
  }
  const TubeJet t = tube(S);
  const V3<T> R0{T(t.R[0][0]), T(t.R[0][1]), T(t.R[0][2])}, R1{T(t.R[1][0]), T(t.R[1][1]), T(t.R[1][2])};
  const V3<T> d = r - R0;
  return S + dot(d, R1) / (1.0 - dot(r0 - t.R[0], t.R[2]));
}

}  // namespace tendril::formulation

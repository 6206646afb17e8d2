#pragma once
// Energy per unit arc length of the tube's axis of a rod described by its eccentricity δ(S) (Eulerian, chapter II.2),
// scaled by the axis length and the bending stiffness. Unstressed length s(S) and twist φ(S) enter only through s' and
// φ' when the body force is uniform and no body couple acts, so both are minimised out pointwise: λ is the multiplier
// of the rod's length, λ = ½ω² + F3 + ½η²F3² + σ·r (constant along the rod, across frictionless contacts too), M3 the
// one of the total twist. With a = |r1|², t² = |dd3/dS|², m = λ - σ·r (η = 0: inextensible, s' = |r1|):
//   min over s' of  ½t²/s' + s'(|r1|/s' - 1)²/(2η²) + s' m  =  [t² + 2m(a + η²t²)] / (G + √a),  G² = (a + η²t²)(1 +
//   2η²m)
// and the twist adds M3 c, c = ω3/J1 of the Bishop-transported frame. Its λ-derivative is s'.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace tendril::formulation {

/// Truncated Taylor number to second order in N variables: value, gradient, Hessian.
template <int N>
struct Jet2 {
  double v = 0.0;
  Eigen::Matrix<double, N, 1> g = Eigen::Matrix<double, N, 1>::Zero();
  Eigen::Matrix<double, N, N> h = Eigen::Matrix<double, N, N>::Zero();

  static Jet2 variable(double value, int index) {
    Jet2 x;
    x.v = value;
    x.g[index] = 1.0;
    return x;
  }
  static Jet2 chain(const Jet2& x, double f, double df, double ddf) {
    return {f, df * x.g, df * x.h + (ddf * x.g) * x.g.transpose()};
  }
};
template <int N>
Jet2<N> operator+(const Jet2<N>& a, const Jet2<N>& b) {
  return {a.v + b.v, a.g + b.g, a.h + b.h};
}
template <int N>
Jet2<N> operator-(const Jet2<N>& a, const Jet2<N>& b) {
  return {a.v - b.v, a.g - b.g, a.h - b.h};
}
template <int N>
Jet2<N> operator*(double c, const Jet2<N>& a) {
  return {c * a.v, c * a.g, c * a.h};
}
template <int N>
Jet2<N> operator+(double c, const Jet2<N>& a) {
  return {c + a.v, a.g, a.h};
}
template <int N>
Jet2<N> operator*(const Jet2<N>& a, const Jet2<N>& b) {
  const Eigen::Matrix<double, N, N> cross = a.g * b.g.transpose();
  return {a.v * b.v, a.v * b.g + b.v * a.g, a.v * b.h + b.v * a.h + cross + cross.transpose()};
}
template <int N>
Jet2<N> inverse(const Jet2<N>& a) {
  const double i = 1.0 / a.v;
  return Jet2<N>::chain(a, i, -i * i, 2.0 * i * i * i);
}
template <int N>
Jet2<N> sqrt(const Jet2<N>& a) {
  const double r = std::sqrt(a.v);
  return Jet2<N>::chain(a, r, 0.5 / r, -0.25 / (r * a.v));
}

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix36 = Eigen::Matrix<double, 3, 6>;

/// One section of the tube and the linear maps from x = (δ1, δ1', δ1'', δ2, δ2', δ2'') to r1 = r' and r2 = r''
/// (components in D).
struct DensitySection {
  Matrix36 V1, V2, Vp;           // r1 = e3 + V1 x, r2 = c2 + V2 x, component derivative of r1 = Vp x
  Eigen::Vector3d c2, U;         // c2 = U x e3
  Eigen::Vector2d force;         // body force along D1, D2           [B/L^3]
  double force_potential = 0.0;  // σ·R                               [B/L^2]
  // of a rod that varies, at the section that lies here: B over the scale's, and η² over the rod's
  double bending = 1.0, softness = 1.0;
};

inline DensitySection density_section(const Eigen::Vector3d& U, const Eigen::Vector3d& dU, const Eigen::Vector2d& force,
                                      double force_potential) {
  DensitySection d;
  d.U = U;
  d.c2 = Eigen::Vector3d(U[1], -U[0], 0.0);
  d.force = force;
  d.force_potential = force_potential;
  Eigen::Matrix3d Ux, dUx;
  Ux << 0, -U[2], U[1], U[2], 0, -U[0], -U[1], U[0], 0;
  dUx << 0, -dU[2], dU[1], dU[2], 0, -dU[0], -dU[1], dU[0], 0;
  d.V1.setZero();
  d.Vp.setZero();
  for (int j = 0; j < 2; ++j) {
    d.V1.col(3 * j) = Ux.col(j);
    d.V1(j, 3 * j + 1) = 1.0;
    d.Vp.col(3 * j) = dUx.col(j);
    d.Vp.col(3 * j + 1) = Ux.col(j);
    d.Vp(j, 3 * j + 2) = 1.0;
  }
  d.V2 = d.Vp + Ux * d.V1;
  return d;
}

/// What the density needs of the rod's place at a section.
struct DensityInvariants {
  double a = 1.0, t2 = 0.0, c = 0.0, y = 0.0;  // |r1|², |dd3/dS|², ω3/J1, σ·r
  double g3 = 1.0;                             // d3·D3, > 0 as long as the Eulerian map holds
  double softness = 1.0;                       // of the section; t2 has its bending stiffness in it
};

inline DensityInvariants density_invariants(const DensitySection& d, const Vector6& x) {
  Eigen::Vector3d r1 = d.V1 * x, r2 = d.c2 + d.V2 * x;
  const Eigen::Vector3d dv = d.Vp * x;
  r1[2] += 1.0;
  DensityInvariants q;
  q.a = r1.squaredNorm();
  const double b = r1.dot(r2), n = std::sqrt(q.a);
  q.t2 = d.bending * std::max(0.0, (r2.squaredNorm() - b * b / q.a) / q.a);
  q.softness = d.softness;
  q.g3 = r1[2] / n;
  q.c = d.U.dot(r1) / n - (r1[0] * dv[1] - dv[0] * r1[1]) / (n * (n + r1[2]));
  q.y = d.force_potential + d.force[0] * x[0] + d.force[1] * x[3];
  return q;
}

/// Reduced density without the twist, and its first two λ-derivatives: energy, s', ds'/dλ.
struct ReducedDensity {
  double energy = 0.0, s1 = 0.0, s1_rate = 0.0;
};

inline ReducedDensity reduced_density(const DensityInvariants& q, double lambda, double eta2) {
  eta2 *= q.softness;
  const double m = lambda - q.y, A = q.a + eta2 * q.t2, B = 1.0 + 2.0 * eta2 * m;
  const double G = std::sqrt(A * B);
  const double s1 = std::sqrt(A / B);
  return {(q.t2 + 2.0 * m * A) / (G + std::sqrt(q.a)), s1, -eta2 * s1 / B};
}

/// Value and derivatives with respect to x at given λ and M3.
struct DensityDerivatives {
  double energy = 0.0;  // reduced density, M3 c included
  double s1 = 0.0, s1_rate = 0.0, c = 0.0;
  Vector6 gradient;  // of energy
  Vector6 s1_gradient, c_gradient;
  Matrix6 hessian;  // of energy
};

inline DensityDerivatives density_derivatives(const DensitySection& d, const Vector6& x, double lambda, double torque,
                                              double eta2) {
  eta2 *= d.softness;
  Eigen::Vector3d r1 = d.V1 * x;
  r1[2] += 1.0;
  const Eigen::Vector3d r2 = d.c2 + d.V2 * x, dv = d.Vp * x;
  using J = Jet2<4>;
  // bending and stretching through (a, b, d, m)
  const Vector6 ga = 2.0 * d.V1.transpose() * r1, gd = 2.0 * d.V2.transpose() * r2;
  const Vector6 gb = d.V1.transpose() * r2 + d.V2.transpose() * r1;
  const double y = d.force_potential + d.force[0] * x[0] + d.force[1] * x[3];
  const J a = J::variable(r1.squaredNorm(), 0), b = J::variable(r1.dot(r2), 1), dd = J::variable(r2.squaredNorm(), 2),
          m = J::variable(lambda - y, 3);
  const J ia = inverse(a);
  const J t2 = d.bending * ((dd - b * b * ia) * ia);
  const J A = a + eta2 * t2;
  const J e = (t2 + 2.0 * (m * A)) * inverse(sqrt(A * (1.0 + (2.0 * eta2) * m)) + sqrt(a));
  Eigen::Matrix<double, 6, 4> Jx;
  Jx.col(0) = ga;
  Jx.col(1) = gb;
  Jx.col(2) = gd;
  Jx.col(3).setZero();
  Jx(0, 3) = -d.force[0];
  Jx(3, 3) = -d.force[1];
  const Matrix36 P = e.g[0] * d.V1 + e.g[1] * d.V2, R = e.g[2] * d.V2;
  Matrix6 curved =
      d.V1.transpose() * P + d.V2.transpose() * R;  // half of the constant Hessians of a, b, d, symmetrised below
  DensityDerivatives out;
  out.energy = e.v;
  out.s1 = e.g[3];
  out.s1_rate = e.h(3, 3);
  out.gradient = Jx * e.g;
  out.s1_gradient = Jx * e.h.col(3);
  const Eigen::Matrix<double, 6, 4> Jh = Jx * e.h;
  out.hessian = Jh * Jx.transpose() + curved + curved.transpose();
  // writhe density through (a, v3, u, w): c = u/√a - w/(√a(√a + v3))
  const J n = sqrt(a), v3 = J::variable(r1[2], 1), u = J::variable(d.U.dot(r1), 2),
          w = J::variable(r1[0] * dv[1] - dv[0] * r1[1], 3);
  const J c = (u - w * inverse(n + v3)) * inverse(n);
  Jx.col(1) = d.V1.row(2).transpose();
  Jx.col(2) = d.V1.transpose() * d.U;
  Jx.col(3) = r1[0] * d.Vp.row(1).transpose() + dv[1] * d.V1.row(0).transpose() - dv[0] * d.V1.row(1).transpose() -
              r1[1] * d.Vp.row(0).transpose();
  out.c = c.v;
  out.c_gradient = Jx * c.g;
  if (torque != 0.0) {
    out.energy += torque * c.v;
    out.gradient += torque * out.c_gradient;
    const Eigen::Matrix<double, 6, 4> Jc = Jx * c.h;
    curved = c.g[0] * (d.V1.transpose() * d.V1) +
             c.g[3] * (d.V1.row(0).transpose() * d.Vp.row(1) - d.V1.row(1).transpose() * d.Vp.row(0));
    out.hessian += torque * (Jc * Jx.transpose() + curved + curved.transpose());
  }
  return out;
}

}  // namespace tendril::formulation

#pragma once
// Continuous-contact elementary problem, Eulerian form (III.2.30-36): the rod lies on the ringed surface along β(S),
// directors turned by ψ in the Darboux basis (g = N x d3, N outward, d3), internal force F_g, F_n, F3. F_n follows
// explicitly from the moment equation, so the unknowns are β, ψ, F_g, F3 with orders 3,2,1,1; the pressure is evaluated
// afterwards. Scaled by L and B; the prime is d/dS.

#include <array>

#include "tendril/formulation/section.hpp"
#include "tendril/formulation/surface_curve.hpp"
#include "tendril/numerics/dual.hpp"

namespace tendril::formulation {

struct LineContact {
  static constexpr int components = 4;
  static constexpr std::array<int, 4> order{3, 2, 1, 1};  // β ψ F_g F3
  static constexpr int quadratures = 1;                   // s
  static constexpr int inputs = 11;
  static constexpr std::array<int, 4> first{0, 4, 7, 9};
  static constexpr int phi = 1;

  template <class T>
  using Curve = SurfaceCurve<T>;

  /// Curve without derivatives along it: needs β to β''.
  template <class T>
  static Curve<T> curve(const Lifted<T>& s, const std::array<T, 4>& Q, const T& b, const T& bp, const T& bpp) {
    return surface_curve<T>(s.U[0], s.U[1], Q[0], Q[1], Q[2], b, bp, bpp);
  }

  /// Curve with its total derivative along S: needs β to β'''.
  template <class T>
  static Curve<numerics::Jet<T>> curve_jet(const std::array<V3<T>, 3>& U, const std::array<T, 4>& Q, const T& b,
                                           const T& bp, const T& bpp, const T& bppp) {
    using J = numerics::Jet<T>;
    const V3<J> Uj{J{U[0][0], U[1][0]}, J{U[0][1], U[1][1]}, J{U[0][2], U[1][2]}};
    const V3<J> Upj{J{U[1][0], U[2][0]}, J{U[1][1], U[2][1]}, J{U[1][2], U[2][2]}};
    return surface_curve<J>(Uj, Upj, J{Q[0], Q[1]}, J{Q[1], Q[2]}, J{Q[2], Q[3]}, J{b, bp}, J{bp, bpp}, J{bpp, bppp});
  }

  template <class T, class M>
  static T twisting_moment(const M& m, const Curve<T>& c, const T& F3, const T& psip) {
    const T alpha = 1.0 + m.eta2 * F3;
    return alpha * (c.tg + c.J1bar * psip) / (1.0 + m.nu);
  }

  /// Normal force from the moment equation about g with the stretch rate eliminated (III.2.33).
  template <class T>
  static T normal_force(const Material& m, const T& alpha, const T& J1, const T& kn, const T& knp, const T& kg,
                        const T& tg, const T& M3, const T& Fg, const T& s3, const T& mg) {
    return (mg / alpha - J1 * knp - m.eta2 * kn * (kg * Fg - s3 / alpha) - kg * (alpha * tg - M3)) /
           (1.0 + m.eta2 * kn * kn);
  }

  /// What the balance equations need of the curve (β to β''') and of the loads: no internal force, no ψ.
  template <class T>
  struct Shape {
    T J, Jp;                      // dS/ds̄ and its derivative
    T kn, knp, kg, kgp, tg, tgp;  // curvatures, torsion and their derivatives
    T sg, s3, mg, mn, m3;         // body force and couple along g, N, d3
  };

  template <class T>
  static Shape<T> shape(const Lifted<T>& s, const std::array<T, 4>& Q, const T* u) {
    return shape_of<T>(curve_jet<T>(s.U, Q, u[0], u[1], u[2], u[3]), s);
  }

  template <class T>
  static Shape<T> shape_of(const Curve<numerics::Jet<T>>& c, const Lifted<T>& s) {
    using numerics::dot;
    const V3<T> gv{c.gv[0].v, c.gv[1].v, c.gv[2].v}, N{c.N[0].v, c.N[1].v, c.N[2].v}, t{c.t[0].v, c.t[1].v, c.t[2].v};
    return {c.J1bar.v, c.J1bar.d,        c.kn.v,          c.kn.d,        c.kg.v,       c.kg.d,      c.tg.v,
            c.tg.d,    dot(s.sigma, gv), dot(s.sigma, t), dot(s.mu, gv), dot(s.mu, N), dot(s.mu, t)};
  }

  template <class T>
  static void balance(const Material& m, const Shape<T>& q, const T* u, T* res, T* quad, T* normal = nullptr) {
    const T &Fg = u[7], &Fgp = u[8], &F3 = u[9], &F3p = u[10];
    const T alpha = 1.0 + m.eta2 * F3, alphap = m.eta2 * F3p;
    const T J1 = alpha * q.J, J1p = alphap * q.J + alpha * q.Jp;
    const double fc = 1.0 / (1.0 + m.nu);
    const T M3 = fc * (alpha * q.tg + J1 * u[5]);
    const T M3p = fc * (alphap * q.tg + alpha * q.tgp + J1p * u[5] + J1 * u[6]);
    const T Fn = normal_force(m, alpha, J1, q.kn, q.knp, q.kg, q.tg, M3, Fg, q.s3, q.mg);
    res[0] =
        J1 * (alphap * q.kg + alpha * q.kgp) - alpha * q.kn * (alpha * q.tg - M3) + alpha * Fg + q.mn;  // (III.2.34)
    res[1] = J1 * M3p + q.m3;                                                                           // (III.2.35)
    res[2] = J1 * Fgp + alpha * (q.kg * F3 - q.tg * Fn) + q.sg;                                         // (III.2.30)
    res[3] = J1 * F3p - alpha * (q.kg * Fg + q.kn * Fn) + q.s3;                                         // (III.2.32)
    quad[0] = 1.0 / J1;
    if (normal) *normal = Fn;
  }

  template <class T>
  static void residual(const Material& m, const Lifted<T>& s, const std::array<T, 4>& Q, const T* u, T* res, T* quad,
                       T* normal = nullptr) {
    balance(m, shape(s, Q, u), u, res, quad, normal);
  }

  /// Values at a section for reporting: normal force and the N-component ρ of the wall's force per unit reference
  /// length.
  struct Wall {
    double Fn, rho, M3;
    SurfaceCurve<double> curve;
  };
  static Wall wall(const Material& m, const Section& s, const double* u);

  /// The curve of the inputs u on the wall with the derivative of everything along S, and its values alone.
  using WallJet =
      decltype(curve_jet<numerics::Jet<double>>(std::array<V3<numerics::Jet<double>>, 3>{}, {}, {}, {}, {}, {}));
  static WallJet wall_jet(const Section& s, const double* u);
  static SurfaceCurve<double> values(const WallJet& c);
};

}  // namespace tendril::formulation

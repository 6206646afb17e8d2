#pragma once
// The two elementary problems for a rod that varies along its own length (docs/theory/varying_rods.md, numbers V.n):
// the unstressed arc length s is a component of order 1, the section's properties are functions of it. Free: orders
// 3,3,2,1,1,1,1; line contact: 3,2,1,1,1. Layouts are those of the uniform rod with s, s' appended, so that a state
// (the derivatives below the highest) has the same layout: there s comes last as well.

#include "tendril/formulation/free_rod.hpp"
#include "tendril/formulation/line_contact.hpp"
#include "tendril/rod/section_law.hpp"

namespace tendril::formulation {

/// Room for the inputs of any formulation, then the piece of the section law as a number: what a state evaluated on a
/// varying rod carries along.
inline constexpr int state_inputs = 20;

/// Components of the natural curvature in a basis in which d1 = cos a e1 + sin a e2, and their derivatives along s;
/// `turn` is da/ds (V.4).
template <class T>
struct NaturalCurvature {
  T n1, n2, n1s, n2s;
  NaturalCurvature(const rod::Properties<T>& p, bool curved, const T& angle, const T& turn) {
    if (!curved) {
      n1 = n2 = n1s = n2s = T(0.0);
      return;
    }
    using std::cos;
    using std::sin;
    const T c = cos(angle), s = sin(angle);
    n1 = p.k1 * c - p.k2 * s;
    n2 = p.k1 * s + p.k2 * c;
    n1s = p.k1s * c - p.k2s * s - n2 * turn;
    n2s = p.k1s * s + p.k2s * c + n1 * turn;
  }
};

struct VaryingFree {
  static constexpr int components = 7;
  static constexpr std::array<int, 7> order{3, 3, 2, 1, 1, 1, 1};  // δ1 δ2 φ F1 F2 F3 s
  static constexpr int inputs = 19;
  static constexpr std::array<int, 7> first{0, 4, 8, 11, 13, 15, 17};
  static constexpr int piece = 19;  // where a state carries its piece of the law

  /// Weight per unit weight density, components in k.
  template <class T>
  struct Heavy {
    T g1, g2, g3;
  };

  template <class T>
  static void balance(const rod::SectionPiece& law, bool curved, const FreeRod::Shape<T>& q, const Heavy<T>& g,
                      const T* u, T* res) {
    const T &phip = u[9], &phipp = u[10], &F1 = u[11], &F2 = u[13], &F3 = u[15], &F3p = u[16];
    const rod::Properties<T> p = law.at<T>(u[17]);
    const T alpha = 1.0 + p.e * F3;
    const T J1 = alpha * q.J;
    const T alphas = p.es * F3 + p.e * (J1 * F3p);  // dα/ds (V.6)
    const T J1s = alphas * q.J + alpha * J1 * q.Jp;
    const T w1 = -(J1 * q.h), w2 = J1 * q.p, w3 = J1 * q.c;  // (II.2.45-47)
    const T w1s = -(J1s * q.h + J1 * J1 * q.hp), w2s = J1s * q.p + J1 * J1 * q.pp;
    const NaturalCurvature<T> n(p, curved, u[8], J1 * phip);
    const T M1 = p.B * (w1 - n.n1), M2 = p.B * (w2 - n.n2);  // (V.3)
    const T M1s = p.Bs * (w1 - n.n1) + p.B * (w1s - n.n1s), M2s = p.Bs * (w2 - n.n2) + p.B * (w2s - n.n2s);
    const T twist = q.c + phip;
    const T M3 = p.C * (J1 * twist);
    const T M3s = p.Cs * (J1 * twist) + p.C * (J1s * twist + J1 * J1 * (q.cp + phipp));
    res[0] = M1s + w2 * M3 - w3 * M2 - alpha * F2 + q.m1;  // (V.7)
    res[1] = M2s + w3 * M1 - w1 * M3 + alpha * F1 + q.m2;
    res[2] = M3s + w1 * M2 - w2 * M1 + q.m3;
    res[3] = J1 * u[12] + w2 * F3 - w3 * F2 + q.s1 + p.weight * g.g1;  // (V.8)
    res[4] = J1 * u[14] + w3 * F1 - w1 * F3 + q.s2 + p.weight * g.g2;
    res[5] = J1 * F3p + w1 * F2 - w2 * F1 + q.s3 + p.weight * g.g3;
    res[6] = u[18] - 1.0 / J1;  // (V.1)
  }

  template <class T>
  static Heavy<T> heavy(const Lifted<T>& l, const V3<T>& gravity, const T* u) {
    const auto k = FreeRod::kinematics(l, u[0], u[1], u[2], u[4], u[5], u[6]);
    return {numerics::dot(gravity, k.k1), numerics::dot(gravity, k.k2), numerics::dot(gravity, k.t)};
  }
};

struct VaryingLine {
  static constexpr int components = 5;
  static constexpr std::array<int, 5> order{3, 2, 1, 1, 1};  // β ψ F_g F3 s
  static constexpr int inputs = 13;
  static constexpr std::array<int, 5> first{0, 4, 7, 9, 11};
  static constexpr int piece = 13;

  template <class T>
  struct Heavy {
    T gg, g3;
  };

  /// Moments, normal force and what the balance needs of them (V.12-14).
  template <class T>
  struct Resultants {
    T alpha, J1, Mg, MN, M3, twist, ng, nN, ngs, nNs, Fn;
    rod::Properties<T> p;
    Resultants(const rod::SectionPiece& law, bool curved, const T& J, const T& kn, const T& knp, const T& kg,
               const T& tg, const T& s3, const T& mg, const T& psi, const T& psip, const T& Fg, const T& F3, const T& s)
        : p(law.at<T>(s)) {
      alpha = 1.0 + p.e * F3;
      J1 = alpha * J;
      const NaturalCurvature<T> n(p, curved, psi, J1 * psip);
      ng = n.n1, nN = n.n2, ngs = n.n1s, nNs = n.n2s;
      twist = alpha * tg + J1 * psip;
      Mg = p.B * (-(alpha * kn) - ng);
      MN = p.B * (alpha * kg - nN);
      M3 = p.C * twist;
      // the moment equation about g with dα/ds eliminated by the axial balance (V.13)
      Fn = (p.Bs * (-(alpha * kn) - ng) -
            p.B * (kn * (p.es * F3 + p.e * (alpha * kg * Fg - s3)) + alpha * J1 * knp + ngs) + alpha * kg * M3 -
            alpha * tg * MN + mg) /
           (alpha * (1.0 + p.B * p.e * kn * kn));
    }
  };

  template <class T>
  static void balance(const rod::SectionPiece& law, bool curved, const LineContact::Shape<T>& q, const Heavy<T>& g,
                      const T* u, T* res) {
    const T &Fg = u[7], &F3 = u[9], &F3p = u[10];
    const T weight = law.at<T>(u[11]).weight;
    const T s3 = q.s3 + weight * g.g3;
    const Resultants<T> r(law, curved, q.J, q.kn, q.knp, q.kg, q.tg, s3, q.mg, u[4], u[5], Fg, F3, u[11]);
    const T alphas = r.p.es * F3 + r.p.e * (r.J1 * F3p);
    const T J1s = alphas * q.J + r.alpha * r.J1 * q.Jp;
    const T MNs = r.p.Bs * (r.alpha * q.kg - r.nN) + r.p.B * (alphas * q.kg + r.alpha * r.J1 * q.kgp - r.nNs);
    const T M3s = r.p.Cs * r.twist + r.p.C * (alphas * q.tg + r.alpha * r.J1 * q.tgp + J1s * u[5] + r.J1 * r.J1 * u[6]);
    res[0] = MNs + r.alpha * (q.tg * r.Mg + q.kn * r.M3) + r.alpha * Fg + q.mn;  // (V.12b)
    res[1] = M3s - r.alpha * (q.kn * r.MN + q.kg * r.Mg) + q.m3;                 // (V.12c)
    res[2] = r.J1 * u[8] + r.alpha * (q.kg * F3 - q.tg * r.Fn) + q.sg + weight * g.gg;
    res[3] = r.J1 * F3p - r.alpha * (q.kg * Fg + q.kn * r.Fn) + s3;
    res[4] = u[12] - 1.0 / r.J1;
  }

  /// Normal force, pressure and moments at a section; `gravity` in D.
  struct Wall {
    LineContact::Wall wall;
    double Mg, MN;
  };
  static Wall wall(const rod::SectionPiece& law, bool curved, const Section& s, const double* u);
};

/// The curve of a line contact with the weight's components along g and d3.
template <class T>
LineContact::Shape<T> varying_line_shape(const Lifted<T>& l, const V3<T>& gravity, const std::array<T, 4>& Q,
                                         const T* u, VaryingLine::Heavy<T>& g) {
  const auto c = LineContact::curve_jet<T>(l.U, Q, u[0], u[1], u[2], u[3]);
  const V3<T> gv{c.gv[0].v, c.gv[1].v, c.gv[2].v}, t{c.t[0].v, c.t[1].v, c.t[2].v};
  g = {numerics::dot(gravity, gv), numerics::dot(gravity, t)};
  return LineContact::shape_of<T>(c, l);
}

/// The properties at one end of a segment as a material there: what end and junction conditions need.
template <class T>
struct LocalMaterial {
  T eta2, nu, B, k1, k2;
  bool curved;
  LocalMaterial(const rod::SectionPiece& law, bool curved_rod, const T& s) : curved(curved_rod) {
    const rod::Properties<T> p = law.at<T>(s);
    eta2 = p.e;
    nu = 1.0 / p.C - 1.0;
    B = p.B;
    k1 = p.k1;
    k2 = p.k2;
  }
};

}  // namespace tendril::formulation

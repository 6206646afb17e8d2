#pragma once
// What junction and end conditions need of the state at one end of an elementary problem, on any scalar. State layouts:
// free δ1 δ1' δ1'' δ2 δ2' δ2'' φ φ' F1 F2 F3 s (12); line contact β β' β'' ψ ψ' F_g F3 s (8). N outward throughout.

#include <cmath>

#include "tendril/formulation/convert.hpp"
#include "tendril/segmentation/scaled_problem.hpp"

namespace tendril::segmentation {

/// Free end state on any scalar, from the 11 states that enter (s does not).
template <class T>
struct FreeEnd {
  formulation::FreeRod::Kinematics<T> k;
  T alpha, w1, w2, M3;
  template <class M>
  FreeEnd(const M& m, const formulation::Lifted<T>& l, const T* z)
      : k(formulation::FreeRod::kinematics<T>(l, z[0], z[1], z[2], z[3], z[4], z[5])),
        alpha(formulation::FreeRod::stretch(m, z[10])) {
    const T J1 = alpha * k.J1bar;
    w1 = -(J1 * k.h);  // (II.2.45)
    w2 = J1 * k.p;     // (II.2.46)
    M3 = formulation::FreeRod::twisting_moment<T>(m, k, z[10], z[7]);
  }
};

/// Bending moments M1, M2 of a varying rod's free end, components in k (V.3).
template <class T>
std::array<T, 2> bending_moments(const formulation::LocalMaterial<T>& m, const FreeEnd<T>& f, const T& phi) {
  if (!m.curved) return {m.B * f.w1, m.B * f.w2};
  using std::cos;
  using std::sin;
  const T c = cos(phi), s = sin(phi);
  return {m.B * (f.w1 - (m.k1 * c - m.k2 * s)), m.B * (f.w2 - (m.k1 * s + m.k2 * c))};
}

/// a - b brought into (-π, π] by whole turns.
template <class T>
T wrapped(const T& a) {
  return a - 2.0 * M_PI * std::round(numerics::value(a) / (2.0 * M_PI));
}

/// Place and slope of a section that touches the wall at β with rate β' (IV.1.10-11).
template <class T>
struct WallPlace {
  T d1, d1p, d2, d2p;  // δ1, δ1', δ2, δ2'
  T turn;              // ψ - φ, continuous in β (IV.1.12-13)
  WallPlace(const formulation::Lifted<T>& l, const std::array<T, 4>& Q, const T& beta, const T& slope) {
    using std::cos;
    using std::sin;
    const T cb = cos(beta), sb = sin(beta);
    d1 = Q[0] * cb;
    d2 = Q[0] * sb;
    d1p = Q[1] * cb - slope * d2;
    d2p = Q[1] * sb + slope * d1;
    const auto k = formulation::FreeRod::kinematics<T>(l, d1, d1p, T(0.0), d2, d2p, T(0.0));
    const auto n = formulation::touch_basis<T>(k, cb, sb, Q[1]);
    turn = formulation::darboux_angle<T>(n, beta);
  }
};

/// F3 and M3 at an end: what is transmitted along the sequence.
template <class T>
struct Transmitted {
  T F3, M3;
  Transmitted(const formulation::Material& m, bool line, const formulation::Lifted<T>& l, const std::array<T, 4>& Q,
              const T* z) {
    using formulation::LineContact;
    if (line) {
      F3 = z[6];
      M3 = LineContact::twisting_moment<T>(m, LineContact::curve<T>(l, Q, z[0], z[1], z[2]), F3, z[4]);
    } else {
      F3 = z[10];
      M3 = FreeEnd<T>(m, l, z).M3;
    }
  }
};

/// The quantities of (IV.1.17) at an end on the wall: curvatures, transverse force in the wall, director angle φ.
template <class T>
struct JunctionSide {
  T kg, kn, Fg, phi;
  JunctionSide(const formulation::Material& m, bool line, const formulation::Lifted<T>& l, const std::array<T, 4>& Q,
               const T* z) {
    using std::sqrt;
    if (line) {
      const auto c = formulation::LineContact::curve<T>(l, Q, z[0], z[1], z[2]);
      kg = c.kg;
      kn = c.kn;
      Fg = z[5];
      phi = z[3] - WallPlace<T>(l, Q, z[0], z[1]).turn;
    } else {
      const FreeEnd<T> f(m, l, z);
      const T r = sqrt(z[0] * z[0] + z[3] * z[3]);
      const auto n = formulation::touch_basis<T>(f.k, z[0] / r, z[3] / r, Q[1]);
      kn = (f.w2 * n.n1 - f.w1 * n.n2) / f.alpha;
      kg = (f.w1 * n.n1 + f.w2 * n.n2) / f.alpha;
      Fg = z[8] * n.n2 - z[9] * n.n1;
      phi = z[6];
    }
  }
};

}  // namespace tendril::segmentation

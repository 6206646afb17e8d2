#pragma once
// Small inclination approximation of the contact-free Eulerian form (II.2.4): δ and δ' of the order of the clearance ε,
// axis curvature K = O(ε) (the thesis asks εK = O(ε²)). To first order k1 = D1 - δ1' D3, k2 = D2 - δ2' D3,
// k3 = D3 + δ1' D1 + δ2' D2, J1 = α, and
//   ω1 = α (U1 - δ2''), ω2 = α (U2 + δ1''), ω3 = 0, M3 = α φ'/(1+ν)        (II.2.66-68), (II.2.73),
// with which the balance equations (II.2.48-53) are kept; eliminated, (II.2.51-52) are (II.2.69-70) with the signs of
// docs/decisions/0004. With K = O(ε) the errors of these expressions are O(ε³) in ω1, ω2, F1, F2, M1, M2 and O(ε²) in
// ω3, M3, J1; with K = O(1) they are O(ε). Twist-free frame (U3 = 0). Scaled by L and B.

#include <cmath>
#include <functional>
#include <vector>

#include "tendril/formulation/section.hpp"

namespace tendril::formulation {

/// Strains and shear of the approximation from δ (to δ'''), φ', φ'', α, α' at one section.
template <class T>
struct SmallInclination {
  T w1, w2, M3;  // ω1 = M1, ω2 = M2 in the k basis
  T F1, F2;      // (II.2.69-70), corrected; without body couple

  SmallInclination(const Material& m, const Lifted<T>& l, const T* d1, const T* d2, const T& turn1, const T& alpha,
                   const T& alpha1) {
    const V3<T>&U = l.U[0], &U1 = l.U[1];
    w1 = alpha * (U[0] - d2[2]);                  // (II.2.66)
    w2 = alpha * (U[1] + d1[2]);                  // (II.2.67)
    M3 = (1.0 / (1.0 + m.nu)) * (alpha * turn1);  // (II.2.73)
    w1p = alpha1 * (U[0] - d2[2]) + alpha * (U1[0] - d2[3]);
    w2p = alpha1 * (U[1] + d1[2]) + alpha * (U1[1] + d1[3]);
    const T rate = turn1 * (1.0 / (1.0 + m.nu));
    F1 = w1 * rate - w2p;
    F2 = w1p + w2 * rate;
  }
  T w1p, w2p;
};

/// The system on x in [0,1], S = S_a + x (S_b - S_a): δ1, δ2 (order 3), φ (2), F1, F2, F3, and the constants S_a, S_b;
/// quadrature s. Inputs are derivatives with respect to x.
struct SmallInclinationSystem {
  static constexpr int inputs = 21, states = 14;
  Material material;
  std::function<Section(double S)> section;
  std::vector<int> order{3, 3, 2, 1, 1, 1, 1, 1};
  int quadratures = 1;

  template <class T>
  void operator()(const T& x, const T* u, const T&, T* out) const {
    using numerics::dot;
    const T h = u[19] - u[17], S = u[17] + h * x, f = 1.0 / h;
    const double place = numerics::value(S);
    const Lifted<T> l = lift<T>(section(place), S - place, T(0.0));
    const T f2 = f * f, f3 = f2 * f;
    const T d1[4] = {u[0], f * u[1], f2 * u[2], f3 * u[3]}, d2[4] = {u[4], f * u[5], f2 * u[6], f3 * u[7]};
    const T turn1 = f * u[9], turn2 = f2 * u[10];
    const T &F1 = u[11], &F2 = u[13], &F3 = u[15];
    const T alpha = 1.0 + material.eta2 * F3, alpha1 = material.eta2 * (f * u[16]);
    const SmallInclination<T> e(material, l, d1, d2, turn1, alpha, alpha1);
    const V3<T>&s = l.sigma, &m = l.mu;
    const T s1 = s[0] - d1[1] * s[2], s2 = s[1] - d2[1] * s[2], s3 = s[2] + d1[1] * s[0] + d2[1] * s[1];
    const T m1 = m[0] - d1[1] * m[2], m2 = m[1] - d2[1] * m[2], m3 = m[2] + d1[1] * m[0] + d2[1] * m[1];
    const double fc = 1.0 / (1.0 + material.nu);
    out[0] = alpha * e.w1p + e.w2 * e.M3 - alpha * F2 + m1;         // (II.2.51) with ω3 = 0
    out[1] = alpha * e.w2p - e.w1 * e.M3 + alpha * F1 + m2;         // (II.2.52)
    out[2] = fc * (alpha * (alpha1 * turn1 + alpha * turn2)) + m3;  // (II.2.53)
    out[3] = alpha * (f * u[12]) + e.w2 * F3 + s1;                  // (II.2.48)
    out[4] = alpha * (f * u[14]) - e.w1 * F3 + s2;                  // (II.2.49)
    out[5] = alpha * (f * u[16]) + e.w1 * F2 - e.w2 * F1 + s3;      // (II.2.50)
    out[6] = u[18];
    out[7] = u[20];
    out[8] = h / alpha;  // ds/dx
  }
};

}  // namespace tendril::formulation

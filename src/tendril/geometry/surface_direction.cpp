#include "tendril/geometry/surface_direction.hpp"

#include <cmath>

namespace tendril::geometry {

CurveInvariants curve_invariants(const Patch<double, 4>& S, double u1, double v1, double u2, double v2) {
  const auto &Su = S(1, 0), &Sv = S(0, 1), &Suu = S(2, 0), &Suv = S(1, 1), &Svv = S(0, 2);
  const double E = dot(Su, Su), F = dot(Su, Sv), G = dot(Sv, Sv);  // (III.1.3)
  const double Eu = 2 * dot(Suu, Su), Ev = 2 * dot(Suv, Su);
  const double Fu = dot(Suu, Sv) + dot(Su, Suv), Fv = dot(Suv, Sv) + dot(Su, Svv);
  const double Gu = 2 * dot(Suv, Sv), Gv = 2 * dot(Svv, Sv);
  const double D = E * G - F * F;
  const double g111 = (G * Eu - 2 * F * Fu + F * Ev) / (2 * D),
               g112 = (2 * E * Fu - E * Ev - F * Eu) / (2 * D);                         // (III.1.14)
  const double g121 = (G * Ev - F * Gu) / (2 * D), g122 = (E * Gu - F * Ev) / (2 * D);  // (III.1.15)
  const double g221 = (2 * G * Fv - G * Gu - F * Gv) / (2 * D),
               g222 = (E * Gv - 2 * F * Fv + F * Gu) / (2 * D);  // (III.1.16)
  const double I = E * u1 * u1 + 2 * F * u1 * v1 + G * v1 * v1;
  const Triple<double> N = (1.0 / std::sqrt(D)) * cross(Su, Sv);
  const double e = dot(Suu, N), f = dot(Suv, N), g = dot(Svv, N);  // (III.1.17)
  CurveInvariants c;
  c.kappa_g =
      std::sqrt(D / (I * I * I)) * (g112 * u1 * u1 * u1 - g221 * v1 * v1 * v1 + (2 * g122 - g111) * u1 * u1 * v1 -
                                    (2 * g121 - g222) * u1 * v1 * v1 + u1 * v2 - u2 * v1);  // (III.1.13)
  c.kappa_n = (e * u1 * u1 + 2 * f * u1 * v1 + g * v1 * v1) / I;                            // (III.1.18)
  c.tau_g = ((f * E - e * F) * u1 * u1 + (g * F - f * G) * v1 * v1 + (g * E - e * G) * u1 * v1) / (I * std::sqrt(D));
  return c;  // (III.1.19)
}

}  // namespace tendril::geometry

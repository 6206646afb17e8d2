#pragma once
// The same state seen by the two formulations: a line-contact state as eccentricity in the free form, and a free state
// that touches the wall as angle on the ringed surface (section 5 of docs/notation.md; (IV.1.10-14) corrected).

#include <cmath>

#include "tendril/formulation/free_rod.hpp"
#include "tendril/formulation/line_contact.hpp"

namespace tendril::formulation {

/// Normal N, components along k1, k2 and the Darboux angle atan2(n1, n2), where the curve touches the wall.
/// k: kinematics; cb, sb: direction of the eccentricity; Qp: Q'.
template <class T>
struct TouchBasis {
  T n1, n2;
};

template <class T>
TouchBasis<T> touch_basis(const FreeRod::Kinematics<T>& k, const T& cb, const T& sb, const T& Qp) {
  using std::sqrt;
  const T w = 1.0 / sqrt(k.r1[2] * k.r1[2] + Qp * Qp);
  const V3<T> N{k.r1[2] * cb * w, k.r1[2] * sb * w, -(Qp * w)};  // (A.4.6), outward
  // tangency makes N normal to d3 up to the tangency residual; normalise in the k1, k2 plane
  T n1 = numerics::dot(N, k.k1), n2 = numerics::dot(N, k.k2);
  const T l = 1.0 / sqrt(n1 * n1 + n2 * n2);
  return {n1 * l, n2 * l};
}

/// Angle atan2(n1, n2) between the directors' two references, ψ = φ + angle, on the branch nearest π/2 - β: with β real
/// and continuous along a line contact, φ keeps its full turns across it.
template <class T>
T darboux_angle(const TouchBasis<T>& n, const T& beta) {
  using std::atan2;
  const T a = atan2(n.n1, n.n2);
  return a + 2.0 * M_PI * std::round((0.5 * M_PI - numerics::value(beta) - numerics::value(a)) / (2.0 * M_PI));
}

/// Free inputs (17) of a line-contact state given by its inputs (11).
void line_to_free(const Material& m, const Section& s, const double* line, double* free);
/// The same with the wall's reaction known.
void line_to_free(const Material& m, const Section& s, const LineContact::Wall& wall, const double* line, double* free);
/// Line-contact inputs (11) of a free state near the wall; β is chosen within π of `near`.
void free_to_line(const Material& m, const Section& s, const double* free, double near, double* line);

}  // namespace tendril::formulation

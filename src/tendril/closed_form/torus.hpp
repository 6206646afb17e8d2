#pragma once
// Closed equilibria on a torus of major radius 1 and minor radius ε < 1 (III.2.53-61), in the right-handed frame D1 =
// e_r, D2 = -e_z, D3 = e_θ, so U = (0, -1, 0). N outward; weightless, frictionless. Scaled: major radius = B = 1.

#include "tendril/closed_form/surface_state.hpp"

namespace tendril::closed_form {

/// The parallel β = const. On the two geodesic parallels (β = 0, π) any tension is possible; on the others F_3 must be
/// 0.
SurfaceState torus_parallel(double epsilon, double beta, double F_3, double M_3, double eta);

/// A meridian ξ = const: a geodesic, any tension. Its tangent has d3·D3 = 0, so the Eulerian form cannot hold it.
SurfaceState torus_meridian(double epsilon, double F_3, double M_3, double eta);

/// Sign of β' and of τ_g along a Villarceau circle.
enum class Hand { right = +1, left = -1 };

struct VillarceauPoint {
  double beta = 0.0;        // polar angle                        [rad]
  double beta_prime = 0.0;  // dβ/dξ, ξ the angle around the torus  [-]
  double J_bar_1 = 0.0;     // dξ/ds̄                              [1/L]
  SurfaceState state;
};
/// A Villarceau circle at the azimuth ξ: a free ring of radius 1 that touches the torus all along, F_3 = 0 and ρ = 0
/// for any twisting moment. ξ = 0 lies on the outer equator β = 0.
VillarceauPoint villarceau(double epsilon, Hand hand, double xi, double M_3);

/// A geodesic that winds around the tube: C3 cosϑ = c is constant (Clairaut), 0 < c < 1 - ε, so that it passes the
/// inner equator, the slower the closer c is to 1 - ε.
struct TorusGeodesic {
  double epsilon = 0.0;
  double margin = 0.0;  // 1 - ε - c, kept by itself: it gets as small as e^{-turn √((1-ε)/ε)}
  double turn = 0.0;    // azimuth gained in one winding            [rad]
  double length = 0.0;  // of one winding                           [L]

  double clairaut() const { return 1.0 - epsilon - margin; }
  double slope(double beta) const;    // dβ/dξ
  double kappa_n(double beta) const;  // normal curvature; the wall's force is ρ = -α κ_n F_3
};
/// The one that gains the azimuth `turn` in each winding; closed after 2π n / turn windings and n revolutions.
TorusGeodesic torus_geodesic(double epsilon, double turn);

}  // namespace tendril::closed_form

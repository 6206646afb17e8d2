#pragma once
// Closed equilibria on a torus of major radius 1 and minor radius ε < 1 (III.2.53-61), in the right-handed frame D1 =
// e_r, D2 = -e_z, D3 = e_θ, so U = (0, -1, 0). N outward; weightless, frictionless. Scaled: major radius = B = 1.

#include "tendril/closed_form/surface_state.hpp"

namespace tendril::closed_form {

/// The parallel β = const. On the two geodesic parallels (β = 0, π) any tension is possible; on the others F_3 must be
/// 0.
SurfaceState torus_parallel(double epsilon, double beta, double F_3, double M_3, double eta);

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

}  // namespace tendril::closed_form

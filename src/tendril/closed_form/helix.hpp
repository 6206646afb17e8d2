#pragma once
// A rod bent into a circular helix on, inside or around a straight cylinder, weightless and frictionless: exact for any
// constant tension and twisting moment (II.3.8-15). The cylinder's axis is D3; the angle θ to it is positive
// for a right-handed helix. Scaled as everywhere: L = B = 1, slenderness η² = B/(A L²), zero when inextensible.

#include "tendril/closed_form/surface_state.hpp"

namespace tendril::closed_form {

/// δ > 0: distance of the centreline from the axis; -π/2 < θ < π/2.
struct Helix {
  double radius = 0.0;  // δ  [L]
  double angle = 0.0;   // θ  [rad]

  double curvature() const;  // sin²θ/δ
  double torsion() const;    // sinθ cosθ/δ
};

/// The rod on the cylinder under tension F_3 and twisting moment M_3. ρ <= 0 needs a wall outside it, ρ >= 0 one
/// inside.
SurfaceState helix_on_cylinder(const Helix& helix, double F_3, double M_3, double eta);

/// Tension for which the helix needs no wall, F_3 = τ (M_3 - α τ) with α = 1 + η² F_3.
double free_helix_tension(const Helix& helix, double M_3, double eta);

/// Components of the internal force and moment of a section along the cylinder's axis.
struct AxialResultants {
  double force = 0.0;   // F·D3                                     [B/L²]
  double moment = 0.0;  // M·D3  [B/L]
};
AxialResultants axial_resultants(const Helix& helix, const SurfaceState& state);

/// Twist vector of the intermediate frame k1, k2, k3 per reference length at ξ (β = ξ tanθ/δ).
struct TwistVector {
  double omega_1, omega_2, omega_3;  // [1/L]
};
TwistVector helix_twist(const Helix& helix, double alpha, double xi);

/// The family homoclinic to the straight rod, M_3 = M·D3 (II.3.10, II.3.12): the twisting moment follows from the
/// shape, the pull T = F·D3 is free.
SurfaceState homoclinic_helix(const Helix& helix, double pull, double eta);
/// The member of that family that needs no wall (II.3.14).
SurfaceState free_homoclinic_helix(const Helix& helix, double eta);

}  // namespace tendril::closed_form

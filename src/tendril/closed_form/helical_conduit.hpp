#pragma once
// A rod along the axis of a helical conduit, clear of its wall, weightless: the only tension for which the axis itself
// is an equilibrium (II.3.19). Scaled: L = B = 1.

namespace tendril::closed_form {

/// Axis on a cylinder of radius Σ, at the angle Θ to the cylinder's axis; Θ > 0 right-handed.
struct HelicalConduit {
  double pitch_angle = 0.0;   // Θ  [rad]
  double helix_radius = 0.0;  // Σ  [L]

  double curvature() const;  // sin²Θ/Σ
  double torsion() const;    // sinΘ cosΘ/Σ
};

/// T_0 = τ (M_3 - τ)/(1 + η² τ²): F_3 of the rod that follows the axis under the twisting moment M_3.
double axis_tension(const HelicalConduit& conduit, double M_3, double eta);

}  // namespace tendril::closed_form

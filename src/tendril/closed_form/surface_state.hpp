#pragma once
// State of a rod in continuous contact at one section, in the terms of the line-contact equations (III.2.30-35) with N
// the OUTWARD normal of the tube. Scaled: lengths by L, forces by B/L², moments by B/L.

namespace tendril::closed_form {

struct SurfaceState {
  double alpha = 1.0;    // stretch                                       [-]
  double kappa_g = 0.0;  // geodesic curvature of the deformed centreline  [1/L]
  double kappa_n = 0.0;  // normal curvature                               [1/L]
  double tau_g = 0.0;    // geodesic torsion                               [1/L]
  double F_g = 0.0;      // force along N x d3                             [B/L²]
  double F_n = 0.0;      // force along N                                  [B/L²]
  double F_3 = 0.0;      // force along d3, tension positive               [B/L²]
  double M_3 = 0.0;      // twisting moment                                [B/L]
  double rho = 0.0;      // N-component of the contact force on the rod per reference length; inside <= 0  [B/L³]
};

}  // namespace tendril::closed_form

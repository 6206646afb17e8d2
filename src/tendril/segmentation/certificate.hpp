#pragma once
// What "converged" rests on: residuals of the equations between the nodes, gap, reactions, curvature limits, continuity
// at the junctions, force and moment balance of the whole rod, first integrals. Everything is evaluated from the solved
// state anew; nothing is taken from the solver. All figures are relative (docs/notation.md, "Certificate").

#include "tendril/segmentation/pattern_checks.hpp"

namespace tendril::segmentation {

struct ChainCertificate {
  double equilibrium = 0, gap_min = 0, reaction_min = 0, curvature_max = 0, continuity = 0;
  double balance = 0, invariant_spread = 0, error = 0, strain_max = 0, phase_multiplier = 0;
  double smallest_inclination = 1;  // min d3·D3
  double smallest_stretch = 1;      // min α
};

/// World resultants (scaled) of the wall's forces on the rod over segment j (line) and at junction j.
struct WallForce {
  std::array<double, 3> force{}, moment{};  // moment about the world origin
  double magnitude = 0.0;                   // ∫ p ds
};
WallForce line_force(const Chain& chain, int segment);
WallForce junction_force(const Chain& chain, int junction);

ChainCertificate certify(Chain& chain);

}  // namespace tendril::segmentation

#pragma once
// The unilateral conditions on a solved chain, checks I-V of IV.1.4 with the signs of docs/notation.md: lengths of the
// segments, reactions at points and line ends, curvature at point contacts, gap along free segments, pressure along
// lines. Each is a margin that must not be negative; between nodes the extrema are located, not sampled.

#include <vector>

#include "tendril/segmentation/chain.hpp"

namespace tendril::segmentation {

enum class CheckKind {
  span,
  reaction,
  curvature,
  gap,
  pressure,
  buckling,  // of a line that carries nothing; I to V as in IV.1.4
  // of a tip (tip.hpp)
  tip_gap,       // of one that is free
  tip_reaction,  // of one that rests on the wall
  tip_approach,  // the rod comes to it from inside
  tip_couple,    // a line up to the tip would need a couple there
  // of collars (collars.hpp)
  collar_gap,      // of one that does not touch
  collar_reaction  // of one that does
};

struct Margin {
  CheckKind kind;
  int index = 0;   // segment (span, gap, pressure, buckling, tip), junction (reaction, curvature) or collar
  double S = 0.0;  // where
  double value = 0.0;  // span by L, reaction by the largest contact force, ⟨κ⟩, gap by Q, pressure by that force over L
  double raw = 0.0;   // span by L, force by B/L², ⟨κ⟩, gap by Q, pressure by B/L³
  double pull = 0.0;  // pressure only: tensile force of the stretch around the minimum over the largest contact force
};

/// Reaction R̂ = ς⟦F_n⟧ at junction j (between segments j and j+1).
double reaction(const Chain& chain, int junction);
/// ⟨κ⟩ = ς Q (κ·N - κ_n of the surface) at a point contact, from the free state on its left.
double curvature_excess(const Chain& chain, int junction);
/// Relative gap ς(Q - |δ|)/Q of a free state at S.
double relative_gap(const Chain& chain, int segment, double S);
/// Compressive pressure p̂ = -ςρ per unit reference length of a line segment at S.
double pressure(const Chain& chain, int segment, double S);

/// What a line contact does not carry across a cut of the section law, where the wall's curvature goes on: the
/// concentrated reaction R̂ = ς⟦F_n⟧ [B/L²] at a kink of the stiffness, the couple ⟦M·g⟧ [B/L] at a step, which no wall
/// bears: there the rod must lift off, over about `span`.
struct CutJump {
  double S = 0.0, reaction = 0.0, couple = 0.0, span = 0.0;
};
CutJump cut_jump(const Chain& chain, int segment, int cut);

/// All margins of the chain. Interior minima of the gap are reported only where the gap has a local minimum away from
/// the contacts; the neighbourhood of a contact is covered by the reaction and curvature checks.
std::vector<Margin> margins(const Chain& chain);

}  // namespace tendril::segmentation

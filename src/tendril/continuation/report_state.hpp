#pragma once
// From a solved chain to the result's plain data in the case's units.

#include "tendril/continuation/result.hpp"
#include "tendril/segmentation/certificate.hpp"

namespace tendril::continuation {

/// Lengths, forces, contacts, segments and certificate of a solved chain; fields with `points` rows when points > 0.
Step describe(segmentation::Chain& chain, int points);

struct StabilityVerdict {
  std::string word;  // "stable" | "unstable" | "unknown"
  std::string why;   // in words, for the branch description
};
/// Second variation on the admissible set under the case's own control (docs/decisions/0007).
StabilityVerdict judge_stability(const segmentation::Chain& chain);

/// Directions in which the second variation is negative, under the case's own control as far as it has an energy (a
/// held axial force counts at held length). A state on the axis of an axisymmetric problem buckles in two planes at
/// once, so that the determinant keeps its sign: this count does not.
int unstable_directions(const segmentation::Chain& chain);

}  // namespace tendril::continuation

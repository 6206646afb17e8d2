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

}  // namespace tendril::continuation

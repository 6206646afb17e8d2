#pragma once
// A rod of given length whose tip is free, from nothing: where its tip comes to lie is sought with the place held, in
// which case the axial force is given and the least energy exists; the sharp state at that place is then moved to the
// length.

#include "tendril/segmentation/contact_pattern_switcher.hpp"
#include "tendril/segmentation/discovery.hpp"

namespace tendril::segmentation {

/// Sets the place of the tip, problem.end_position, so that the least-energy state has the length asked for, nearly.
void place_tip(const ScaledProblem& P, DiscoveryOptions options, DiscoveryProblem& problem);

/// `chain`, a guess, on mechanics whose rod length is given: solved with its tip held where it is, then at its length.
SwitcherSummary solve_by_place(Chain& chain, const SwitcherOptions& options);

}  // namespace tendril::segmentation

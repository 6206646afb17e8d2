#pragma once
// Starting states for contact patterns in which something new has a small but finite length.

#include <vector>

#include "tendril/segmentation/chain.hpp"

namespace tendril::segmentation {

/// Shear forces F1, F2 of a free state from the moment equations (II.2.51-52), all else given (17 free inputs).
void balance_shear(const ScaledProblem& problem, double S, double* u);

struct Opening {
  int segment = 0;     // line segment that opens
  double S = 0.0;      // where its pressure has its minimum
  double span = 0.0;   // length of the new free stretch
};

/// Lines opened where their pressure vanishes. Over a short span 2l the rod leaves the wall by k (l² - x²)³ with 720 k =
/// p̂'': the beam that is clamped to the wall with equal curvature at both ends and loaded by the missing pressure.
/// Openings by descending segment; `free_segment` receives the index of the last one's free stretch.
Chain open_lines(const Chain& at, const std::vector<Opening>& openings, int& free_segment);

}  // namespace tendril::segmentation

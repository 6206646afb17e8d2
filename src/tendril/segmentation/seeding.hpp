#pragma once
// Starting states for contact patterns in which something new has a small but finite length.

#include <vector>

#include "tendril/segmentation/chain.hpp"

namespace tendril::segmentation {

/// Shear forces F1, F2 of a free state from the moment equations (II.2.51-52), all else given (17 free inputs).
void balance_shear(const ScaledProblem& problem, double S, double* u);

struct Opening {
  int segment = 0;    // line segment that opens
  double S = 0.0;     // where its pressure has its minimum
  double span = 0.0;  // length 2l of the new free stretch
  double k = 0.0;     // the rod leaves the wall by k (l² - x²)³
};

/// Opening of given span around S where the pressure just vanishes: 720 k = p̂''.
Opening opening_at(const Chain& chain, int segment, double S, double span);
/// One opening for every stretch of line contact that pulls with more than `tolerance` of the largest contact force, by
/// descending place; a stretch of half-length a opens over
/// l = √5 a, the length at which the beam fits the wall with equal curvature at both ends.
std::vector<Opening> tensile_stretches(const Chain& chain, double tolerance);

/// Lines opened over the given stretches. Where a stretch reaches an end of its line, a point contact stays behind.
/// `free_segment` receives the index of the last opening's free stretch.
Chain open_lines(const Chain& at, const std::vector<Opening>& openings, int& free_segment);

/// Junctions of `after` that `before` does not have (nothing of `before` within `distance`).
std::vector<int> new_junctions(const Pattern& before, const Pattern& after, double distance = 1e-12);

/// First stage of the next: solve with the `fresh` junctions held where they are, at the present parameter, and release
/// them. The chain keeps its guess when that fails.
NewtonSummary settle_fresh_junctions(Chain& chain, const std::vector<int>& fresh, const NewtonOptions& options);

/// Solve a chain whose `fresh` junctions are guesses: first with them held in place, then released. Without the first
/// stage Newton tends to collapse a short new stretch to nothing, which solves every equation too.
NewtonSummary solve_with_fresh_junctions(Chain& chain, const std::vector<int>& fresh, const Closure& closure,
                                         const NewtonOptions& options, double tolerance);

}  // namespace tendril::segmentation

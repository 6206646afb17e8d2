#pragma once
// Collars and point loads of a solved chain (docs/theory/collars.md). A collar sits at a cut of a free segment, stands
// out from the rod and touches the wall at a point without tangency: |δ| = Q - ς h, and there F jumps along the wall's
// normal only. Unilateral like any contact: a collar that does not touch keeps its gap, the reaction of one that does
// pushes, R̂ = ς(⟦F⟧ + P)·N >= 0.

#include <array>
#include <vector>

#include "tendril/segmentation/chain.hpp"

namespace tendril::segmentation {

struct CollarState {
  int collar = 0, segment = 0, cut = 0;
  double S = 0.0, s = 0.0, angle = 0.0;
  bool touches = false;
  double gap = 0.0;                    // ς(Q_c - |δ|)/Q_c
  double reaction = 0.0;               // R̂ of one that touches [B/L²]
  std::array<double, 3> place{}, N{};  // world; N: outward normal of the wall at its angle
};
/// In order of S; collars beyond the ends of the rod are not there.
std::vector<CollarState> collar_states(const Chain& chain);

/// A point load where it acts.
struct LoadState {
  int load = 0, segment = 0, cut = 0;
  double S = 0.0, s = 0.0;
  std::array<double, 3> place{}, force{}, couple{};  // world, scaled
};
std::vector<LoadState> load_states(const Chain& chain);

/// The free form of the state on one side of a cut (0: before, 1: behind), and its place.
void state_at_cut(const Chain& chain, int segment, int cut, int side, double* u);

/// Patterns to try where collars violate a condition: all of them changed, then one at a time.
std::vector<Pattern> collar_patterns(const Pattern& pattern, const std::vector<int>& collars, std::size_t count);

}  // namespace tendril::segmentation

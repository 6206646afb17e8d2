#pragma once
// ContactPatternSwitcher (Algorithm IV.6): from a chain with some contact pattern to one whose solution satisfies all
// unilateral conditions at the same load. Checks I-V in the thesis' order with the additions of docs/decisions: a point
// that exceeds the curvature limit becomes a line or two points, whichever is admissible; visited patterns are
// remembered, so the search cannot cycle.

#include <functional>
#include <string>
#include <vector>

#include "tendril/segmentation/pattern_checks.hpp"

namespace tendril::segmentation {

/// Admissibility tolerances; every one enters as `margin.value >= -tolerance`.
struct ContactTolerances {
  double span = 1e-4;       // segment length over that of its shorter neighbour; below: merge
  double reaction = 1e-8;   // of the largest reaction
  double curvature = 1e-7;  // ⟨κ⟩: must exceed the discretisation error or point and line alternate
  double gap = 1e-8;        // of the clearance
  double pressure = 1e-8;   // tensile force of a stretch of line contact, of the largest contact force
};

struct SwitcherOptions {
  ContactTolerances tolerance;
  NewtonOptions newton;
  double accuracy = 1e-8;  // mesh tolerance
  int max_patterns = 60;
  double from = -1e300, to = 1e300;  // violated conditions count between these places
  bool guess = false;                // the chain is a guess: where its solve fails, with all junctions held first
  bool windows = true;               // long chains are switched window by window (pattern_windows.hpp)
  bool nested = false;  // SolveSequence for every pattern; the chain's Newton where that fails or does not apply
  std::function<void(const Chain&, const NewtonSummary&)> observer;  // called after every pattern tried
};

struct SwitcherSummary {
  bool converged = false;
  int patterns_tried = 0;
  int nested_solves = 0, nested_fallbacks = 0;  // patterns solved by SolveSequence, and those it left to the chain
  long newton_iterations = 0, factorisations = 0;
  std::string reason;
};

/// Segment length below which segment j counts as vanished.
double span_floor(const Chain& chain, int j, const ContactTolerances& t);
/// The violated margins, in the order I..V, worst first within a kind.
std::vector<Margin> violations(const Chain& chain, const std::vector<Margin>& margins, const ContactTolerances& t);

SwitcherSummary switch_contact_pattern(Chain& chain, const Closure& closure, const SwitcherOptions& options);

}  // namespace tendril::segmentation

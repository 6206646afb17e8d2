#pragma once
// A state from nothing: the smoothed wall's least-energy state (discovery) names the contact pattern, the sharp chain
// solves it, the switcher makes every unilateral condition hold. Symmetric states on request, without discovery.

#include <functional>
#include <string>
#include <vector>

#include "tendril/segmentation/contact_pattern_switcher.hpp"
#include "tendril/segmentation/discrete_start.hpp"

namespace tendril::segmentation {

struct ColdStart {
  bool converged = false;
  Chain chain;
  std::string branch;             // how the state was reached
  std::string reason;             // why not
  bool outside_validity = false;  // not converged: every search ended where the formulation does
  Reach reach;                    // there
  SwitcherSummary effort;
};

/// `accept` (optional) judges a solved state, for instance its stability; the search goes on while it says no, and the
/// first state solved is returned if none is accepted. `from` (optional): a shape to start the searches at.
ColdStart cold_start(const std::shared_ptr<Mechanics>& mechanics, const SolveOptions& solve,
                     const SwitcherOptions& options, const std::function<bool(const Chain&)>& accept = {},
                     const DiscreteState* from = nullptr);
/// A state as the discrete rod's, for `from` above: the least energy is then sought downhill from there.
DiscreteState discrete_state(const Chain& chain);

}  // namespace tendril::segmentation

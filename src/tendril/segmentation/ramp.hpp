#pragma once
// The last resort of a cold start: an easier problem of the same pattern of ends, solved from nothing, and led to the
// one that is asked for; where the state cannot be followed, downhill to the next.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tendril/segmentation/contact_pattern_switcher.hpp"

namespace tendril::segmentation {

/// A way from an easier problem (0) to the given one (1).
struct Ramp {
  std::string from;  // what it starts at, for messages
  std::function<Problem(double t)> at;
};

/// The ways there are: an even section of a rod that varies; fewer loads; a wider tube.
std::vector<Ramp> ramps(const ScaledProblem& problem);

/// Follows a state along a ramp. `chain` is the state at 0 and becomes the one at 1, on `mechanics`; `downhill` finds a
/// state of a problem near a given one where that is lost.
SwitcherSummary follow_ramp(const Ramp& ramp, Chain& chain, const std::shared_ptr<Mechanics>& mechanics,
                            const SwitcherOptions& options,
                            const std::function<bool(const std::shared_ptr<Mechanics>&, Chain&)>& downhill);

}  // namespace tendril::segmentation

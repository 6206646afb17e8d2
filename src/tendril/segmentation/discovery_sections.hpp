#pragma once
// Discovery of rods that vary along their length. The discrete energy knows its sections by S; which section lies where
// depends on the state. Both are settled by turns: the sections are laid out as the last state carries them, with what
// its multiplier λ gains along them, until they no longer move.

#include "tendril/rod/section_law.hpp"
#include "tendril/segmentation/discovery.hpp"

namespace tendril::segmentation {

/// Sections of `law` laid out as a state found has them; how far they moved [L].
double lay_sections(const rod::SectionLaw& law, const DiscoveryResult& found, DiscoveryProblem& problem);

/// As discover(), with the sections where the state found has them. `problem` keeps them for searches that go on.
DiscoveryResult discover_sections(const rod::SectionLaw& law, DiscoveryProblem& problem,
                                  const DiscoveryOptions& options);

}  // namespace tendril::segmentation

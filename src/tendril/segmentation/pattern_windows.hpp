#pragma once
// The contact pattern of a long rod, window by window (windows.hpp): every window is switched on its own until its
// unilateral conditions hold, the whole is put together and solved, and what is still violated is repaired in windows
// around it. Many contacts change in one round, and a failing check is a matter of its neighbourhood.

#include "tendril/segmentation/contact_pattern_switcher.hpp"

namespace tendril::segmentation {

/// Elementary problems from which on a chain is long.
inline constexpr int long_chain = 24;

/// `guess`: the chain is not a solution of its pattern but a first guess, so that all windows are solved before the
/// whole.
SwitcherSummary switch_in_windows(Chain& chain, const SwitcherOptions& options, bool guess);

}  // namespace tendril::segmentation

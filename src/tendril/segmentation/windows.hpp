#pragma once
// Windows of a long rod. A disturbance is forgotten within some bending lengths, so a part of the chain between two
// places, its ends held at the whole chain's state there (δ, δ', and the axial force and torque that come from the
// controlled ends), is a problem of its own whose inner pattern is that of the whole rod: patterns are sought window by
// window, and the cost of a change of pattern does not depend on the length of the rod.

#include <vector>

#include "tendril/segmentation/chain.hpp"

namespace tendril::segmentation {

/// A part of the rod that is decided (from, to), and the larger one it is solved in (first, last).
struct Window {
  double from = 0.0, to = 0.0;
  double first = 0.0, last = 0.0;
};

/// Decay length of a disturbance at S: of a rod under axial force, or lying on the wall under its load.
double decay_length(const Chain& chain, double S);

/// Windows that tile the rod. `core` decay lengths are decided, `margin` more solved on each side.
std::vector<Window> tile(const Chain& whole, double core, double margin);
/// Windows that decide `core` decay lengths on each side of the given places; joined where they overlap.
std::vector<Window> around(const Chain& whole, std::vector<double> places, double core, double margin);

/// The part [first, last] of the whole as a chain of its own, on its own mechanics.
Chain cut(const Chain& whole, double first, double last);
/// The whole with the parts [from, to] replaced by those of the windows' chains. Windows ascend and do not overlap.
Chain splice(const Chain& whole, const std::vector<Window>& windows, const std::vector<Chain>& parts);

}  // namespace tendril::segmentation

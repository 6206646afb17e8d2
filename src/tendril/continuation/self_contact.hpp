#pragma once
// Where a rod meets itself. The model knows the wall only: parts of the rod that lie far apart along it pass through
// one another unseen. Chords of the centreline are compared, those nearer along the rod than 2 diameters left out.

#include <string>

#include "tendril/segmentation/chain.hpp"

namespace tendril::continuation {

struct SelfApproach {
  double distance = 0.0;             // of the two parts of the centreline  [length]
  double first = 0.0, second = 0.0;  // S [length], first < second
  bool found = false;
};

/// The nearest two parts that touch or cross: closer than `diameter`, or, 0: not known, than 1e-6 of the axis' length.
/// `chords`: of equal length in S; their sag bounds the error, (length)²K/8.
SelfApproach self_approach(const segmentation::Chain& chain, double diameter, int chords = 1200);

/// The warning in words; empty where the rod keeps clear of itself.
std::string self_contact_warning(const segmentation::Chain& chain, double diameter);

}  // namespace tendril::continuation

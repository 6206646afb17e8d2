#pragma once
// From a problem to its discrete rod (discovery.hpp), and from a discrete state to the chain that the sharp solvers
// start with: the loaded stretches as its pattern, the fields as its guess.

#include "tendril/segmentation/chain.hpp"
#include "tendril/segmentation/discovery.hpp"

namespace tendril::segmentation {

/// The discrete problem of the smoothed wall for these mechanics.
DiscoveryProblem discovery_problem(const ScaledProblem& problem);

/// A chain of about `pieces` pieces with k Gauss points each, to be solved.
Chain sharp_start(const std::shared_ptr<Mechanics>& mechanics, const DiscoveryResult& found, int k, int pieces);

}  // namespace tendril::segmentation

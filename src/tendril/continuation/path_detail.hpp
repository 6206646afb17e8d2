#pragma once
// What the parts of the path follower share: a state as a point of the trace, and one condition seen in two states.

#include <vector>

#include "tendril/continuation/result.hpp"
#include "tendril/segmentation/pattern_checks.hpp"

namespace tendril::continuation {

/// Parameter, rod length, end force and torque, number of contacts; scaled as the chain.
TracePoint trace_point(const segmentation::Chain& chain);
/// The margin in `all` of the condition that m belongs to (same kind and index, nearest place); none: nullptr.
const segmentation::Margin* same_condition(const std::vector<segmentation::Margin>& all, const segmentation::Margin& m);

}  // namespace tendril::continuation

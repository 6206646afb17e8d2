#pragma once
// What the parts of the path follower share: a state as a point of the trace, and one condition seen in two states.

#include <string>
#include <vector>

#include "tendril/continuation/result.hpp"
#include "tendril/segmentation/pattern_checks.hpp"

namespace tendril::continuation {

/// Parameter, rod length, end force and torque, number of contacts; scaled as the chain.
TracePoint trace_point(const segmentation::Chain& chain);
/// The margin in `all` of the condition that m belongs to (same kind and index, nearest place); none: nullptr.
const segmentation::Margin* same_condition(const std::vector<segmentation::Margin>& all, const segmentation::Margin& m);

/// Two states at nearly the same parameter that no small motion joins.
bool far_apart(const segmentation::Chain& a, const segmentation::Chain& b);
/// A number as messages give it.
std::string figure(double value);

}  // namespace tendril::continuation

#pragma once
// Sizes of the stack arrays of segment*.cpp.

namespace tendril::collocation {

constexpr int most_inputs = 64, most_equations = 32;

}  // namespace tendril::collocation

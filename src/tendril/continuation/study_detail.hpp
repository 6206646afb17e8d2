#pragma once
// What solves, paths and motions share: the switcher's options for a tolerance, and a state as a certified step.

#include <optional>
#include <string>

#include "tendril/continuation/study.hpp"
#include "tendril/segmentation/contact_pattern_switcher.hpp"

namespace tendril::continuation {

segmentation::SwitcherOptions switcher_options(const segmentation::SolveOptions& solve);

/// The state as a step of a result: judged for stability, certified, its mesh refined where first integrals ask for it.
Step judged_step(segmentation::Chain& chain, const StudyOptions& options, const segmentation::SwitcherOptions& switcher,
                 const std::string& how, std::optional<double> parameter);

/// "Converged" is a state of the exact equations. An approximate one earns the word where it satisfies them; elsewhere
/// it lies outside the range in which it could be taken for one, and says by how much.
void judge_approximation(Step& s, double tolerance);

}  // namespace tendril::continuation

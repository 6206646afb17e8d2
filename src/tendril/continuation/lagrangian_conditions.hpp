#pragma once
// End and junction conditions of the Lagrangian solver, on any scalar.

#include "tendril/continuation/lagrangian.hpp"

namespace tendril::continuation {

/// The conditions of a pattern as one block over all ends; p is the axial value. `places` guess S of the junctions.
collocation::Conditions lagrangian_conditions(std::shared_ptr<const LagrangianProblem> problem,
                                              const LagrangianPattern& pattern, const std::vector<double>& places);

}  // namespace tendril::continuation

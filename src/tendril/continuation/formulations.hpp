#pragma once
// `solve.formulation`: a state found by the Eulerian solver solved again in the Lagrangian form, on the same contact
// pattern, and reported with the differences of the two; or the small inclination approximation reported with its
// differences from the exact state that it leads to.

#include "tendril/collocation/boundary_value_problem.hpp"
#include "tendril/continuation/lagrangian.hpp"
#include "tendril/continuation/result.hpp"
#include "tendril/segmentation/chain.hpp"

namespace tendril::continuation {

/// One section of an Eulerian state in the world frame, scaled.
LagrangianSection world_section(const segmentation::Chain& chain, double S);

struct LagrangianTwin {
  std::optional<LagrangianRod> rod;  // none: `reason`
  std::string reason;
  Comparison difference;  // from the chain
};
LagrangianTwin lagrangian_twin(const segmentation::Chain& chain, double tolerance);

/// The twin's numbers in place of the Eulerian ones in a described step; not converged when the two differ by more than
/// `tolerance` allows, or when there is no twin.
void report_lagrangian(const segmentation::Chain& chain, double tolerance, int field_points, Step& step);

/// A state of the small inclination approximation as a step.
Step small_inclination_step(const segmentation::Problem& problem, double tolerance, int field_points);

}  // namespace tendril::continuation

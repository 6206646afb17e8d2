#pragma once
// The rod in the helical conduit of the thesis (L = B = 1, Θ = π/4, Σ = 1/(π√2), η = 1/20, ν = 1/3, M3 = -1) by the
// Lagrangian formulation alone: from the rod on the axis to free, point-contact and line-contact states.

#include <optional>
#include <string>

#include "tendril/continuation/lagrangian.hpp"
#include "tendril/segmentation/problem.hpp"

namespace tendril::reproduce {

/// The case for the Eulerian solver; T = F3 at the end.
segmentation::Problem helical_conduit_case(double clearance, double T);
/// |T0|: the end force that keeps the rod on the axis (II.3.19).
double helical_conduit_force();

enum class Touch { none, point, line };

struct LagrangianOutcome {
  bool converged = false;
  std::string reason;
  std::optional<continuation::LagrangianRod> rod;  // when converged
};
/// State with this contact in the middle at T, found without the Eulerian solver. Contact inside (tension side) or
/// outside of the helix follows from T.
LagrangianOutcome lagrangian_conduit(double clearance, double T, Touch touch, double tolerance);

}  // namespace tendril::reproduce

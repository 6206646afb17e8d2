#pragma once
// Two-point problems of surface-bound rods by collocation: the equations of surface_rod.hpp over x = s/ℓ, the length ℓ
// one more component (constant). Conditions are the caller's, on the states at both ends; the path parameter p enters
// them and, where asked, scales body force and couple. Where shooting loses all digits (long or taut rods) this does
// not.

#include "tendril/collocation/boundary_value_problem.hpp"
#include "tendril/formulation/surface_rod.hpp"

namespace tendril::formulation {

/// A state at an end: u, v, θ, κ_g, F_g, F_3, M_3, ψ, ℓ; both ends together: left | right.
constexpr int ilength = surface_rod_states, surface_rod_end = surface_rod_states + 1;

/// Conditions: nine, from `collocation::make_conditions<2 * surface_rod_end>`.
collocation::BoundaryValueProblem surface_rod_problem(const SurfaceRod& rod, collocation::Conditions conditions,
                                                      bool load_scaled_by_parameter = false);

/// Clamped ends (u, v, θ), fixed length, ψ = 0 at the left, M_3 at the right end.
collocation::Conditions clamped_conditions(const ClampedSurfaceRod& problem);

/// First guess from sections of any curve, evenly spaced in x from 0 to 1.
void guess_from(collocation::BoundaryValueProblem& problem, const SurfaceRod& rod,
                const std::vector<SurfaceRodState<double>>& states, double length, int pieces);

/// State and length at x in [0, 1].
SurfaceRodState<double> state_at(const collocation::BoundaryValueProblem& problem, double x);
double length_of(const collocation::BoundaryValueProblem& problem);
/// Sections at `count` + 1 even places.
std::vector<SurfaceRodSection> sections_of(const collocation::BoundaryValueProblem& problem, const SurfaceRod& rod,
                                           int count);

}  // namespace tendril::formulation

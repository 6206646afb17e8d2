#pragma once
// Parts of the system `heavy_rod`: a clamped rod of unknown length through a frictionless sleeve, under its weight, in
// the world frame along its own arc length, so that it may turn back on the axis; and the same problem in Eulerian
// form. L = B = 1, inextensible, axis along x, weight along -z.
//   r' = ℓ t,  t' = ℓ M x t,  M' = -ℓ t x F,  F' = ℓ w e_z,  ' = d/dx, x = s/ℓ    (II.1.12-14) with M = t x t' + M3 t
// Unknown t, M, F, ℓ, and r as quadratures; |t| = 1 and M·t = M3 are first integrals.

#include <array>
#include <string>
#include <vector>

#include "tendril/continuation/branch.hpp"
#include "tendril/drawing/figure.hpp"
#include "tendril/segmentation/chain.hpp"

namespace tendril::reproduce::heavy {

using Vec = Eigen::Vector3d;

/// What varies: the torque at F3(end) = 0, or F3(end) at a held torque.
enum class Vary { torque, end_force };

/// The rod at M3 = 0: the planar state of small sag. `torque` is used when the end force varies.
collocation::BoundaryValueProblem rod_problem(double weight, Vary vary, double torque = 0.0);

struct Section {
  Vec r, t, M, F;
};
Section section_at(const collocation::BoundaryValueProblem& rod, double x);
double length_of(const collocation::BoundaryValueProblem& rod);
/// Least t·e_x = d3·D3 along the rod: the Eulerian map ends where it is 0.
double least_advance(const collocation::BoundaryValueProblem& rod);
double largest_deflection(const collocation::BoundaryValueProblem& rod);
/// dF3/dℓ along the equilibria at held torque: less than 0 where a held end force is stable (docs/decisions/0007).
double stiffness_of_feeding(const collocation::BoundaryValueProblem& rod, double weight);

/// The Eulerian problem in a tube too wide to touch, F3(end) = 0. p is the torque.
segmentation::Problem eulerian_problem(double weight, double torque);
/// The same state solved by the Eulerian formulation, from the values of this one as first guess.
segmentation::Chain eulerian_state(const collocation::BoundaryValueProblem& rod, double weight, double tolerance);

/// One state of the response curve.
struct Place {
  double arclength = 0, torque = 0, length = 0, advance = 0, deflection = 0, stiffness = 0;
  int sign = 0;  // of the determinant at held length, relative to the first; 0: at an event
};

/// The curve between torque and length, stable and unstable parts apart, with its folds and the named states. `whole`:
/// all of it on a logarithmic axis up to `longest`, else the neighbourhood of the first fold.
drawing::Panel response_panel(const std::string& title, const std::vector<Place>& list,
                              const std::vector<const continuation::BranchEvent*>& folds,
                              const std::vector<const continuation::BranchEvent*>& states,
                              const std::vector<std::string>& names, bool whole, double longest);
/// The rod in space with its projections on a horizontal and a vertical plane.
drawing::Panel body(const std::string& title, const collocation::BoundaryValueProblem& rod, double amplified);

}  // namespace tendril::reproduce::heavy

// Contact-free equations in wall coordinates: those of the contact-free form, their inputs and columns converted.
#include <algorithm>

#include "tendril/formulation/near_wall.hpp"
#include "tendril/segmentation/scaled_problem.hpp"

namespace tendril::segmentation {

using formulation::FreeRod;

NearWallSystem::NearWallSystem(const ScaledProblem* problem) : problem_(problem), free_(problem) {
  order = free_.order;
  first = free_.first;
  quadratures = free_.quadratures;
  inputs = free_.inputs;
}

void NearWallSystem::residual(double S, const double* u, double* out) const {
  double v[FreeRod::inputs];
  std::copy_n(u, FreeRod::inputs, v);
  present(S, v);
  free_.residual(S, v, out);
}

void NearWallSystem::jacobian(double S, const double* u, double* out, double* jac) const {
  double v[FreeRod::inputs];
  std::copy_n(u, FreeRod::inputs, v);
  present(S, v);
  free_.jacobian(S, v, out, jac);
  formulation::wall_columns(problem_->section(S), u, equations(), jac);
}

void NearWallSystem::present(double S, double* u) const { formulation::wall_to_free(problem_->section(S), u); }

}  // namespace tendril::segmentation

#pragma once
// The two formulations of a varying rod as collocation systems, one for every piece of the section law: between breaks
// the law is a polynomial, and a segment of the chain is cut where the rod passes a break.

#include "tendril/collocation/system.hpp"
#include "tendril/formulation/varying_rod.hpp"
#include "tendril/numerics/pack.hpp"

namespace tendril::segmentation {

struct ScaledProblem;

/// `Form`: formulation::VaryingFree (components δ1 δ2 φ F1 F2 F3 s) or VaryingLine (β ψ F_g F3 s).
template <class Form>
class VaryingSystem final : public collocation::System {
 public:
  VaryingSystem(const ScaledProblem* problem, int piece);
  void residual(double S, const double* u, double* out) const override;
  void jacobian(double S, const double* u, double* out, double* jac) const override;
  void residuals(const double* S, int count, const numerics::Pack* u, numerics::Pack* out) const override;
  void jacobians(const double* S, int count, const numerics::Pack* u, numerics::Pack* out,
                 numerics::Pack* jac) const override;

 private:
  const ScaledProblem* problem_;
  int piece_;
};

using VaryingFreeSystem = VaryingSystem<formulation::VaryingFree>;
using VaryingLineSystem = VaryingSystem<formulation::VaryingLine>;

}  // namespace tendril::segmentation

#pragma once
// A mixed-order system of ordinary differential equations G(S, u, u', ..., u^(m)) = 0 with quadratures q' = f(S, u,
// ...): what the collocation core needs to know of a formulation. `inputs` are the derivatives 0..m_c of every
// component, laid out component by component. One path parameter p may enter.

#include <vector>

#include "tendril/numerics/pack.hpp"

namespace tendril::collocation {

class System {
 public:
  virtual ~System() = default;
  std::vector<int> order;  // m_c of each component
  std::vector<int> first;  // place of component c's value in the inputs
  int quadratures = 0;
  int inputs = 0;  // sum of (m_c + 1)

  int components() const { return static_cast<int>(order.size()); }
  int equations() const { return components() + quadratures; }

  /// G and the quadrature integrands: out[equations()].
  virtual void residual(double S, const double* u, double* out) const = 0;
  /// The same with exact derivatives: jac is row-major, equations() x (inputs + 2); the last two columns are d/dS,
  /// d/dp.
  virtual void jacobian(double S, const double* u, double* out, double* jac) const = 0;

  /// Inputs as others read them, in place, where the equations are written in other unknowns.
  virtual void present(double S, double* u) const;

  /// Both at up to eight places side by side, lane i at S[i], i < count: u[inputs], out[equations()],
  /// jac[equations() x (inputs + 2)]. What other lanes hold is of no interest, on either side.
  virtual void residuals(const double* S, int count, const numerics::Pack* u, numerics::Pack* out) const;
  virtual void jacobians(const double* S, int count, const numerics::Pack* u, numerics::Pack* out,
                         numerics::Pack* jac) const;
  /// The equations and their derivatives with respect to the highest derivatives alone, side by side:
  /// out[equations()], top[components() x components()]. The error estimate needs no more.
  virtual void highest(const double* S, int count, const numerics::Pack* u, numerics::Pack* out,
                       numerics::Pack* top) const;
};

}  // namespace tendril::collocation

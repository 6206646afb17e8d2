#pragma once
// A mixed-order system of ordinary differential equations G(S, u, u', ..., u^(m)) = 0 with quadratures q' = f(S, u,
// ...): what the collocation core needs to know of a formulation. `inputs` are the derivatives 0..m_c of every
// component, laid out component by component. One path parameter p may enter.

#include <vector>

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
};

}  // namespace tendril::collocation

#include "tendril/collocation/system.hpp"

namespace tendril::collocation {

void System::present(double, double*) const {}

// One place after the other, for systems that do not know better.

void System::residuals(const double* S, int count, const numerics::Pack* u, numerics::Pack* out) const {
  std::vector<double> x(inputs), r(equations());
  for (int lane = 0; lane < count; ++lane) {
    for (int j = 0; j < inputs; ++j) x[j] = u[j][lane];
    residual(S[lane], x.data(), r.data());
    for (int e = 0; e < equations(); ++e) out[e].set(lane, r[e]);
  }
}

void System::jacobians(const double* S, int count, const numerics::Pack* u, numerics::Pack* out,
                       numerics::Pack* jac) const {
  std::vector<double> x(inputs), r(equations()), a(static_cast<std::size_t>(equations()) * (inputs + 2));
  for (int lane = 0; lane < count; ++lane) {
    for (int j = 0; j < inputs; ++j) x[j] = u[j][lane];
    jacobian(S[lane], x.data(), r.data(), a.data());
    for (int e = 0; e < equations(); ++e) out[e].set(lane, r[e]);
    for (std::size_t j = 0; j < a.size(); ++j) jac[j].set(lane, a[j]);
  }
}

void System::highest(const double* S, int count, const numerics::Pack* u, numerics::Pack* out,
                     numerics::Pack* top) const {
  const int n = components(), columns = inputs + 2;
  std::vector<numerics::Pack> jac(static_cast<std::size_t>(equations()) * columns);
  jacobians(S, count, u, out, jac.data());
  for (int e = 0; e < n; ++e)
    for (int c = 0; c < n; ++c) top[e * n + c] = jac[e * columns + first[c] + order[c]];
}

}  // namespace tendril::collocation

#pragma once
// Systems and end conditions written once as generic functions: values on double, exact Jacobians by dual numbers.

#include <cassert>
#include <functional>
#include <vector>

#include "tendril/collocation/system.hpp"
#include "tendril/numerics/dual.hpp"

namespace tendril::collocation {

/// A system that the problem's parameter enters.
class ParametricSystem : public System {
 public:
  double p = 0.0;
};

/// The system of a functor `F` with members `std::vector<int> order`, `int quadratures` and
/// `template <class T> void operator()(const T& x, const T* u, const T& p, T* out) const`: equations, then integrands.
/// Inputs: sum of (order + 1). Exact Jacobian by dual numbers.
template <class F, int Inputs>
class DualSystem final : public ParametricSystem {
 public:
  explicit DualSystem(F functor) : f(std::move(functor)) {
    order = f.order;
    quadratures = f.quadratures;
    for (int m : order) {
      first.push_back(inputs);
      inputs += m + 1;
    }
    assert(inputs == Inputs);
  }
  F f;

  void residual(double x, const double* u, double* out) const override { f(x, u, p, out); }
  void jacobian(double x, const double* u, double* out, double* jac) const override {
    using T = numerics::Dual<Inputs + 2>;
    T v[Inputs];
    for (int i = 0; i < Inputs; ++i) v[i] = T::seed(u[i], i);
    std::vector<T> r(equations());
    f(T::seed(x, Inputs), static_cast<const T*>(v), T::seed(p, Inputs + 1), r.data());
    for (int e = 0; e < equations(); ++e) {
      out[e] = r[e].v;
      for (int i = 0; i < Inputs + 2; ++i) jac[e * (Inputs + 2) + i] = r[e].d[i];
    }
  }
};

/// Conditions on the states at the ends of all segments, left0 | right0 | left1 | ...; a state is the derivatives
/// 0..m_c - 1 of every component, then the quadratures.
struct Conditions {
  int count = 0;
  /// r[count]; jac, unless null, row-major count x (ends + 1): the last column is d/dp.
  std::function<void(const double* ends, double p, double* r, double* jac)> evaluate;
};

/// Conditions from a generic lambda (const auto* ends, const auto& p, auto* r).
template <int Ends, class F>
Conditions make_conditions(int count, F f) {
  return {count, [count, f](const double* ends, double p, double* r, double* jac) {
            if (!jac) {
              f(ends, p, r);
              return;
            }
            using T = numerics::Dual<Ends + 1>;
            std::vector<T> e(Ends), out(count);
            for (int i = 0; i < Ends; ++i) e[i] = T::seed(ends[i], i);
            f(static_cast<const T*>(e.data()), T::seed(p, Ends), out.data());
            for (int i = 0; i < count; ++i) {
              r[i] = out[i].v;
              for (int j = 0; j <= Ends; ++j) jac[i * (Ends + 1) + j] = out[i].d[j];
            }
          }};
}

}  // namespace tendril::collocation

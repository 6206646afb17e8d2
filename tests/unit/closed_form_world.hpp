#pragma once
// Local equilibrium of a rod on a surface, evaluated in the world frame from nothing but its shape, the outward normal
// and the claimed state: independent of the component equations the closed forms were derived from.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <functional>

#include "tendril/closed_form/surface_state.hpp"

namespace tendril::closed_form::test {

using Eigen::Vector3d;

/// One section of the deformed rod: position, unit tangent, outward normal of the surface, claimed state.
struct Section {
  Vector3d position, tangent, normal;
  SurfaceState state;

  Vector3d g() const { return normal.cross(tangent); }
  Vector3d force() const { return state.F_g * g() + state.F_n * normal + state.F_3 * tangent; }
  /// M = d3 x dd3/ds + M_3 d3 with dd3/ds = α (κ_g g + κ_n N).
  Vector3d moment() const { return state.alpha * (state.kappa_g * normal - state.kappa_n * g()) + state.M_3 * tangent; }
};

/// d/dx by sixth-order central differences.
template <class F>
auto derivative(F&& f, double x, double h = 5e-3) {
  using V = std::decay_t<decltype(f(x))>;
  const V near = f(x + h) - f(x - h), middle = f(x + 2 * h) - f(x - 2 * h), far = f(x + 3 * h) - f(x - 3 * h);
  return V((45.0 * near - 9.0 * middle + far) / (60.0 * h));
}

/// Sixth-order differences of fields of size 1..10 at h = 5e-3: truncation h^6 ~ 2e-14 times a seventh derivative up
/// to 1e4, rounding 1e-15/h ~ 1e-12.
constexpr double difference_tolerance = 1e-8;

/// Largest component of the faults: kinematics (t, κ_g, κ_n, τ_g against the shape) and equilibrium (II.1.12-13), at
/// the reference arc length s. `section` maps s to the section.
inline double fault(const std::function<Section(double)>& section, double s) {
  const Section c = section(s);
  const SurfaceState& q = c.state;
  const Vector3d dr = derivative([&](double x) { return section(x).position; }, s);
  const Vector3d dt = derivative([&](double x) { return section(x).tangent; }, s);
  const Vector3d dn = derivative([&](double x) { return section(x).normal; }, s);
  const Vector3d dF = derivative([&](double x) { return section(x).force(); }, s);
  const Vector3d dM = derivative([&](double x) { return section(x).moment(); }, s);
  return std::max({
      (dr - q.alpha * c.tangent).lpNorm<Eigen::Infinity>(),
      (dt - q.alpha * (q.kappa_g * c.g() + q.kappa_n * c.normal)).lpNorm<Eigen::Infinity>(),
      (dn - q.alpha * (-q.kappa_n * c.tangent - q.tau_g * c.g())).lpNorm<Eigen::Infinity>(),
      (dF + q.rho * c.normal).lpNorm<Eigen::Infinity>(),
      (dM + q.alpha * c.tangent.cross(c.force())).lpNorm<Eigen::Infinity>(),
  });
}

}  // namespace tendril::closed_form::test

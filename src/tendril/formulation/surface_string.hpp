#pragma once
// Strings (rods without bending stiffness) on a parametric surface (III.1.50-57): the tension alone carries the load.
// Forces scaled by a reference tension F0, η̄² = F0/A, body force σ̄ = L f/F0 per reference length. Without body force
// the string is a geodesic under constant tension (III.1.53-55); a heavy string is the catenary of the surface. Both
// between two points by shooting.

#include <array>
#include <string>
#include <vector>

#include "tendril/geometry/surface_direction.hpp"
#include "tendril/numerics/extrapolation.hpp"

namespace tendril::formulation {

struct SurfaceString {
  geometry::SurfacePtr surface;
  double eta_squared = 0.0;            // F0/A; 0: inextensible
  std::array<double, 3> body_force{};  // σ̄, world frame, per reference length
};

/// u, v, θ (from the u-line), F_3.
template <class T>
using StringState = std::array<T, 4>;

template <class T>
bool string_slope(const SurfaceString& string, const StringState<T>& y, StringState<T>& dy, T& kappa_g) {
  const auto patch = geometry::lift(string.surface->patch(numerics::value(y[0]), numerics::value(y[1])), y[0], y[1]);
  const auto d = geometry::surface_direction<T>(patch, y[2]);
  const auto along = [&string](const geometry::Triple<T>& a) {
    return a[0] * string.body_force[0] + a[1] * string.body_force[1] + a[2] * string.body_force[2];
  };
  const T alpha = 1.0 + string.eta_squared * y[3];
  if (!(numerics::value(alpha) > 0.0) || !(numerics::value(y[3]) > 0.0)) return false;  // slack
  kappa_g = -(along(d.g) / (alpha * y[3]));                                             // (III.1.50)
  dy[0] = alpha * d.u_rate;
  dy[1] = alpha * d.v_rate;
  dy[2] = alpha * (kappa_g + d.geodesic_turning);  // (III.1.56-57) when κ_g = 0
  dy[3] = -along(d.t);                             // (III.1.52)
  return true;
}

struct StringSection {
  double s = 0.0;
  StringState<double> state{};
  std::array<double, 3> r{}, t{}, N{};
  double alpha = 1.0, kappa_g = 0.0, kappa_n = 0.0, F_3 = 0.0;
  double rho = 0.0;  // (III.1.51): N-component of the force on the string per reference length
};

struct StringCurve {
  std::vector<StringSection> section;
  numerics::IntegrationSummary summary;
};
/// From the state at s.front() through the increasing places s. Refuses (geometry::GeometryError) a start without
/// tension.
StringCurve integrate_string(const SurfaceString& string, const StringState<double>& start,
                             const std::vector<double>& s, const numerics::IntegrationOptions& options = {});

struct StringSolution {
  bool converged = false;
  std::string reason;
  int iterations = 0;
  StringState<double> start{};
  double length = 0.0;  // reference length between the points
};
/// The string of given reference length between two points (u, v), from a guess of θ and F_3 at the first.
StringSolution solve_string(const SurfaceString& string, double length, const std::array<double, 2>& from,
                            const std::array<double, 2>& to, const std::array<double, 2>& guess);
/// The geodesic between two points, from a guess of θ at the first and of the length.
StringSolution solve_geodesic(const geometry::SurfacePtr& surface, const std::array<double, 2>& from,
                              const std::array<double, 2>& to, const std::array<double, 2>& guess);

}  // namespace tendril::formulation

#include "tendril/closed_form/torus.hpp"

#include <cmath>
#include <numbers>

#include "tendril/closed_form/domain.hpp"

namespace tendril::closed_form {
namespace {

void check(double epsilon) {
  require(epsilon > 0.0 && epsilon < 1.0, "minor radius epsilon", epsilon, "between 0 and 1");
}

}  // namespace

SurfaceState torus_parallel(double epsilon, double beta, double F_3, double M_3, double eta) {
  check(epsilon);
  require(eta >= 0.0 && std::isfinite(eta), "slenderness eta", eta, "zero or positive");
  const double C3 = 1.0 + epsilon * std::cos(beta);
  // sin of a multiple of π as a double: within rounding of zero is a geodesic.
  const bool geodesic = std::abs(std::sin(beta)) < 1e-14 * (1.0 + std::abs(beta));
  require(geodesic || F_3 == 0.0, "tension on a parallel that is no geodesic", F_3, "0");
  SurfaceState s;
  s.alpha = 1.0 + eta * eta * F_3;
  require(s.alpha > 0.0, "stretch alpha", s.alpha, "positive");
  s.kappa_g = geodesic ? 0.0 : -std::sin(beta) / C3;
  s.kappa_n = -std::cos(beta) / C3;
  s.F_3 = F_3;
  s.M_3 = M_3;
  s.F_n = s.kappa_g * M_3;
  s.F_g = -s.kappa_n * M_3;
  s.rho = geodesic ? -s.alpha * s.kappa_n * F_3 : 0.0;
  return s;
}

VillarceauPoint villarceau(double epsilon, Hand hand, double xi, double M_3) {
  check(epsilon);
  const double sign = hand == Hand::right ? 1.0 : -1.0;
  const double root = std::sqrt((1.0 - epsilon) * (1.0 + epsilon));
  VillarceauPoint p;
  // tan(β/2) = ±√((1+ε)/(1-ε)) tan(ξ/2), continued through ξ = π, 3π, ...
  const double turns = std::round(xi / (2.0 * std::numbers::pi)), half = 0.5 * xi - std::numbers::pi * turns;
  p.beta = sign * 2.0 *
           (std::atan2(std::sqrt(1.0 + epsilon) * std::sin(half), std::sqrt(1.0 - epsilon) * std::cos(half)) +
            std::numbers::pi * turns);
  p.beta_prime = sign * (1.0 + epsilon * std::cos(p.beta)) / root;
  p.J_bar_1 = (1.0 - epsilon * std::cos(xi)) / root;
  p.state.kappa_g = -sign * std::sin(xi);
  p.state.kappa_n = -std::cos(xi);
  p.state.tau_g = sign * p.J_bar_1;
  p.state.M_3 = M_3;
  // A ring of curvature 1 in its plane carries F = M_3 κ b with b = κ_g N - κ_n g its binormal.
  p.state.F_g = -p.state.kappa_n * M_3;
  p.state.F_n = p.state.kappa_g * M_3;
  return p;
}

}  // namespace tendril::closed_form

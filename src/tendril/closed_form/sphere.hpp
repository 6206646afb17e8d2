#pragma once
// The inextensible rod on a sphere of radius 1 (III.1.58-69, appendix A.3), N outward: the geodesic curvature obeys
// 2 κ_g'' + κ_g (κ_g² - σ) = 0. Two families, by the largest geodesic curvature κ_m > 0: wavelike (κ_m² > 2σ, Jacobi
// cn, κ_g changes sign) and orbitlike (σ <= κ_m² < 2σ, Jacobi dn, it does not). Weightless, frictionless. Scaled:
// radius = B = 1.

#include "tendril/closed_form/surface_state.hpp"

namespace tendril::closed_form {

class SphereElastica {
 public:
  /// σ: tension constant, F_3 = (σ - κ_g²)/2; κ_m: largest geodesic curvature, κ_m² >= σ and not 2σ.
  SphereElastica(double sigma, double kappa_max);

  bool wavelike() const { return wavelike_; }
  /// Arc length after which κ_g repeats: 8 k K(k²)/κ_m or 4 K(1/k²)/κ_m.
  double period() const;
  /// κ_g and dκ_g/dχ at the arc length χ, measured from a place where κ_g = κ_m.
  double kappa_g(double chi) const;
  double kappa_g_prime(double chi) const;
  /// The whole state at χ for the constant twisting moment M_3.
  SurfaceState state(double chi, double M_3) const;
  /// Longitude gained around the axis of the first integral in one period: Λ of (III.1.68) or Δϑ of (III.1.69), with
  /// the factors 4 and 2 missing there.
  double longitude_per_period() const;
  /// Magnitude of that first integral, I² = κ_m² + (κ_σ - 2)²/4.
  double integral() const { return integral_; }
  /// Latitude and rate of longitude (III.1.66): ζ = κ_g/I (sine of the latitude), dϑ/dχ.
  double longitude_rate(double chi) const;

 private:
  double sigma_, kappa_max_, k_squared_, integral_;
  bool wavelike_;
};

}  // namespace tendril::closed_form

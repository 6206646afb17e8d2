#pragma once
// The inextensible rod on a sphere of radius 1 (III.1.58-69, appendix A.3), N outward: the geodesic curvature obeys
// 2 κ_g'' + κ_g (κ_g² - σ) = 0. Two families, by the largest geodesic curvature κ_m > 0: wavelike (κ_m² > 2σ, Jacobi
// cn, κ_g changes sign) and orbitlike (σ <= κ_m² < 2σ, Jacobi dn, it does not). Weightless, frictionless. Scaled:
// radius = B = 1.

#include <vector>

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
  double height(double chi) const { return kappa_g(chi) / integral_; }

 private:
  double sigma_, kappa_max_, k_squared_, integral_;
  double half_gap_;  // (κ_σ - 2)/2: 0 on paths through the pole
  bool wavelike_;
};

/// Largest curvatures κ_m of the elasticae with κ_σ = κ_m² - σ that gain q turns of longitude per period, increasing:
/// roots of the closure condition, each to rounding. Empty where the family has no such member.
std::vector<double> elasticae_of_progression(double q, double kappa_sigma, bool wavelike);

/// The extensible rod on the sphere of radius 1 (III.1.70-74). Its first integrals make the extreme stretches 1 -+ d,
/// hence the extrema of κ_g, explicit: I² = α_0² - η⁻² + η⁻² (1 + η⁻²) d².
class SphereRod {
 public:
  /// σ η² > -2; I at least that of the circle or geodesic of this σ.
  SphereRod(double sigma, double eta, double integral);
  /// α_0 of (III.1.73).
  static double alpha_0(double sigma, double eta);
  /// I² of (III.1.72) where the geodesic curvature is κ_g and its slope κ_g'.
  static double integral_squared(double sigma, double eta, double kappa_g, double slope);
  /// κ_m² on the separatrix (III.1.74), corrected: η² in the denominator.
  static double separatrix(double sigma, double eta);

  bool wavelike() const { return wavelike_; }
  double kappa_max() const { return kappa_max_; }
  double kappa_min() const { return wavelike_ ? -kappa_max_ : kappa_min_; }
  double stretch(double kappa_g) const;
  /// |dκ_g/dχ|; 0 outside [κ_min, κ_max].
  double slope(double kappa_g) const;
  /// Pressure along the inward normal (III.1.71) where κ_g has this value and the slope ±slope(κ_g).
  double inward_pressure(double kappa_g, double slope, double M_3) const;
  /// Reference arc length after which κ_g repeats.
  double period() const;

 private:
  double sigma_, inverse_, alpha_0_, amplitude_, kappa_max_, kappa_min_ = 0.0;  // inverse_ = η⁻²
  bool wavelike_ = true;
};

}  // namespace tendril::closed_form

#include "tendril/closed_form/sphere.hpp"

#include <cmath>

#include "tendril/closed_form/domain.hpp"
#include "tendril/closed_form/elliptic.hpp"

namespace tendril::closed_form {

SphereElastica::SphereElastica(double sigma, double kappa_max) : sigma_(sigma), kappa_max_(kappa_max) {
  require(std::isfinite(sigma), "tension constant sigma", sigma, "finite");
  require(kappa_max > 0.0 && std::isfinite(kappa_max), "largest geodesic curvature", kappa_max, "positive");
  const double square = kappa_max * kappa_max;
  require(square >= sigma, "square of the largest geodesic curvature", square, "at least sigma");
  require(square != 2.0 * sigma, "square of the largest geodesic curvature", square,
          "different from 2 sigma (one loop of infinite length)");
  wavelike_ = square > 2.0 * sigma;
  const double kappa_sigma = square - sigma;  // κ_σ
  // κ_m² = σ is the circle of constant κ_g: the parameter 1/k² of the orbitlike family is 0 there.
  k_squared_ = kappa_sigma > 0.0 ? square / (2.0 * kappa_sigma) : HUGE_VAL;
  integral_ = std::hypot(kappa_max, 0.5 * (kappa_sigma - 2.0));
}

double SphereElastica::period() const {
  if (wavelike_) return 8.0 * std::sqrt(k_squared_) * complete_k(k_squared_) / kappa_max_;
  return 4.0 * complete_k(1.0 / k_squared_) / kappa_max_;
}

double SphereElastica::kappa_g(double chi) const {
  if (wavelike_) return kappa_max_ * jacobi(0.5 * kappa_max_ * chi / std::sqrt(k_squared_), k_squared_).cn;
  return kappa_max_ * jacobi(0.5 * kappa_max_ * chi, 1.0 / k_squared_).dn;
}

double SphereElastica::kappa_g_prime(double chi) const {
  if (wavelike_) {
    const double k = std::sqrt(k_squared_);
    const Jacobi j = jacobi(0.5 * kappa_max_ * chi / k, k_squared_);
    return -0.5 * kappa_max_ * kappa_max_ / k * j.sn * j.dn;
  }
  const double m = 1.0 / k_squared_;
  const Jacobi j = jacobi(0.5 * kappa_max_ * chi, m);
  return -0.5 * kappa_max_ * kappa_max_ * m * j.sn * j.cn;
}

SurfaceState SphereElastica::state(double chi, double M_3) const {
  const double curvature = kappa_g(chi), slope = kappa_g_prime(chi);
  SurfaceState s;
  s.kappa_g = curvature;
  s.kappa_n = -1.0;
  s.M_3 = M_3;
  s.F_g = M_3 - slope;                             // (III.2.34)
  s.F_n = curvature * M_3;                         // (III.2.33)
  s.F_3 = 0.5 * (sigma_ - curvature * curvature);  // (III.1.59)
  s.rho = s.F_3 - slope * M_3;                     // (III.2.31)
  return s;
}

double SphereElastica::longitude_rate(double chi) const {
  const double curvature = kappa_g(chi), zeta = curvature / integral_;
  return (2.0 + sigma_ - curvature * curvature) / (2.0 * integral_ * (1.0 - zeta * zeta));  // (III.1.66)
}

double SphereElastica::longitude_per_period() const {
  const double square = kappa_max_ * kappa_max_, I2 = integral_ * integral_;
  // On κ_σ = 2 the rod passes through the pole and the longitude jumps.
  require(square < I2, "kappa_max^2 - sigma on a path through the pole", square - sigma_, "different from 2");
  const double n = square / (square - I2);  // negative
  const double weight = (2.0 + sigma_ - I2) / (square - I2);
  if (wavelike_) {  // (III.1.68), corrected: docs/decisions/0004
    return 4.0 * std::sqrt(k_squared_) * integral_ / kappa_max_ *
           (complete_k(k_squared_) - weight * complete_pi(n, k_squared_));
  }
  const double m = 1.0 / k_squared_;  // (III.1.69), corrected: docs/decisions/0004
  return 2.0 * integral_ / kappa_max_ * (complete_k(m) - weight * complete_pi(n * m, m));
}

}  // namespace tendril::closed_form

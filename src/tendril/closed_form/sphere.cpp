#include "tendril/closed_form/sphere.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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
  half_gap_ = 0.5 * (kappa_sigma - 2.0);
  integral_ = std::hypot(kappa_max, half_gap_);
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
  // (III.1.66) with I² - κ_m² = h², 2 + σ - κ_m² = -2 h: nothing cancels close to the pole
  const double curvature = kappa_g(chi), fall = (kappa_max_ - curvature) * (kappa_max_ + curvature);
  return 0.5 * integral_ * (fall - 2.0 * half_gap_) / (fall + half_gap_ * half_gap_);
}

double SphereElastica::longitude_per_period() const {
  // On κ_σ = 2 the rod passes through the pole and the longitude jumps.
  require(half_gap_ != 0.0, "kappa_max^2 - sigma", 2.0, "different from 2 (a path through the pole)");
  const double n = -kappa_max_ * kappa_max_ / (half_gap_ * half_gap_);
  const double weight = 1.0 + 2.0 / half_gap_;  // (2 + σ - I²)/(κ_m² - I²)
  if (wavelike_) {                              // (III.1.68), corrected: docs/decisions/0004
    return 4.0 * std::sqrt(k_squared_) * integral_ / kappa_max_ *
           (complete_k(k_squared_) - weight * complete_pi(n, k_squared_));
  }
  const double m = 1.0 / k_squared_;  // (III.1.69), corrected: docs/decisions/0004
  return 2.0 * integral_ / kappa_max_ * (complete_k(m) - weight * complete_pi(n * m, m));
}

std::vector<double> elasticae_of_progression(double q, double kappa_sigma, bool wavelike) {
  require(std::isfinite(q), "turns per period", q, "finite");
  require(kappa_sigma > 0.0 && kappa_sigma != 2.0 && std::isfinite(kappa_sigma), "kappa_max^2 - sigma", kappa_sigma,
          "positive and different from 2");
  // κ_m² / (2 κ_σ) is 1 - e^-y or 1 + e^-y: the separatrix, where the longitude grows without bound, is at y = ∞
  const auto curvature = [&](double y) {
    return std::sqrt(2.0 * kappa_sigma * (wavelike ? -std::expm1(-y) : 1.0 + std::exp(-y)));
  };
  const auto miss = [&](double y) {
    const double kappa = curvature(y);
    return SphereElastica(kappa * kappa - kappa_sigma, kappa).longitude_per_period() / (2.0 * std::numbers::pi) - q;
  };
  constexpr int parts = 400;
  const double first = wavelike ? 1e-8 : -14.0, last = 30.0;
  std::vector<double> found;
  double a = first, fa = miss(a);
  for (int i = 1; i <= parts; ++i) {
    // wavelike: y -> 0 is the equator, approached geometrically
    const double t = static_cast<double>(i) / parts, b = wavelike ? last * t * t : first + (last - first) * t;
    const double fb = miss(b);
    if ((fa > 0.0) != (fb > 0.0)) {
      double low = a, high = b;
      for (int n = 0; n < 200; ++n) {
        const double middle = 0.5 * (low + high);
        if (middle <= std::min(low, high) || middle >= std::max(low, high)) break;
        ((miss(middle) > 0.0) == (fa > 0.0) ? low : high) = middle;
      }
      found.push_back(curvature(0.5 * (low + high)));
    }
    a = b;
    fa = fb;
  }
  std::sort(found.begin(), found.end());
  return found;
}

double SphereRod::alpha_0(double sigma, double eta) {
  return std::sqrt(1.0 + 1.0 / (eta * eta)) * (0.5 * sigma * eta * eta + 1.0);
}

double SphereRod::integral_squared(double sigma, double eta, double kappa_g, double slope) {
  const double inverse = 1.0 / (eta * eta), square = kappa_g * kappa_g;
  const double alpha = alpha_0(sigma, eta) / std::sqrt(1.0 + inverse + square);  // (III.1.41)
  const double rate = slope * (1.0 + inverse) / (1.0 + inverse + square);        // (α κ_g)'/α
  const double moment = alpha + inverse * (alpha - 1.0);                         // α κ_n + F_3
  return rate * rate + moment * moment + alpha * alpha * square;                 // (III.1.72)
}

double SphereRod::separatrix(double sigma, double eta) {
  const double inverse = 1.0 / (eta * eta), gap = sigma - 2.0 * inverse;
  return 8.0 * sigma * inverse * (1.0 + inverse) / (gap * gap);  // (III.1.74), corrected: docs/decisions/0004
}

SphereRod::SphereRod(double sigma, double eta, double integral) : sigma_(sigma), inverse_(1.0 / (eta * eta)) {
  require(eta > 0.0 && std::isfinite(eta), "slenderness eta", eta, "positive");
  require(sigma * eta * eta > -2.0, "tension constant sigma", sigma, "greater than -2/eta^2");
  alpha_0_ = alpha_0(sigma, eta);
  const double square = (integral * integral - alpha_0_ * alpha_0_ + inverse_) / (inverse_ * (1.0 + inverse_));
  require(square >= 0.0, "total moment about the centre", integral, "at least that of the circle of this sigma");
  amplitude_ = std::sqrt(square);
  require(amplitude_ < 1.0, "total moment about the centre", integral, "small enough to leave the rod its length");
  const auto curvature_squared = [&](double alpha) {
    return alpha_0_ * alpha_0_ / (alpha * alpha) - 1.0 - inverse_;  // (III.1.41)
  };
  const double most = curvature_squared(1.0 - amplitude_), least = curvature_squared(1.0 + amplitude_);
  require(most >= 0.0, "total moment about the centre", integral, "at least that of the geodesic of this sigma");
  kappa_max_ = std::sqrt(most);
  wavelike_ = least < 0.0;
  if (!wavelike_) kappa_min_ = std::sqrt(least);
}

double SphereRod::stretch(double kappa_g) const { return alpha_0_ / std::sqrt(1.0 + inverse_ + kappa_g * kappa_g); }

double SphereRod::slope(double kappa_g) const {
  const double alpha = stretch(kappa_g), gap = amplitude_ * amplitude_ - (alpha - 1.0) * (alpha - 1.0);
  return alpha_0_ * alpha_0_ / (alpha * alpha) * std::sqrt(inverse_ / (1.0 + inverse_) * std::max(gap, 0.0));
}

double SphereRod::inward_pressure(double kappa_g, double slope, double M_3) const {
  const double x = 1.0 + inverse_ + kappa_g * kappa_g, alpha = stretch(kappa_g), square = slope * slope;
  const double pull = inverse_ * (alpha - 1.0) * alpha;
  // κ_g'' from (III.1.70), with (α κ_g)'/α = κ_g' (1 + η⁻²)/x; then (α'/α)' from α'/α = -κ_g κ_g'/x
  const double second = pull * kappa_g * x / (1.0 + inverse_) + 2.0 * kappa_g * square / x;
  const double stretching = -(square + kappa_g * second) / x + 2.0 * kappa_g * kappa_g * square / (x * x);
  return -pull - slope * M_3 + stretching;  // (III.1.71)
}

double SphereRod::period() const {
  // The trapezoidal rule over a whole period of an analytic function converges geometrically.
  const auto trapezoid = [&](int parts) {
    double sum = 0.0;
    for (int i = 0; i < parts; ++i) {
      const double angle = 2.0 * std::numbers::pi * (i + 0.5) / parts;
      if (wavelike_) {
        // κ = κ_m cos φ: κ'² = (κ_m² - κ²) g², the factor taken out of α - (1 - d)
        const double kappa = kappa_max_ * std::cos(angle), x = 1.0 + inverse_ + kappa * kappa;
        const double x_m = 1.0 + inverse_ + kappa_max_ * kappa_max_, alpha = alpha_0_ / std::sqrt(x);
        const double factor = alpha_0_ / (std::sqrt(x) * std::sqrt(x_m) * (std::sqrt(x) + std::sqrt(x_m)));
        sum += alpha * alpha / (alpha_0_ * alpha_0_) *
               std::sqrt((1.0 + inverse_) / (inverse_ * factor * (1.0 + amplitude_ - alpha)));
      } else {
        // α = 1 + d cos φ: φ' = sqrt((α_0² - (1 + η⁻²) α²) / (1 + η²))
        const double alpha = 1.0 + amplitude_ * std::cos(angle);
        sum += std::sqrt((1.0 + 1.0 / inverse_) / (alpha_0_ * alpha_0_ - (1.0 + inverse_) * alpha * alpha));
      }
    }
    return sum * 2.0 * std::numbers::pi / parts;
  };
  double last = trapezoid(16);
  for (int parts = 32; parts <= 1 << 20; parts *= 2) {
    const double next = trapezoid(parts);
    const bool same = std::abs(next - last) <= 1e-14 * next;
    last = next;
    if (same) break;
  }
  return last;
}

}  // namespace tendril::closed_form

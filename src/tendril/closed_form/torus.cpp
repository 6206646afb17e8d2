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

SurfaceState torus_meridian(double epsilon, double F_3, double M_3, double eta) {
  check(epsilon);
  require(eta >= 0.0 && std::isfinite(eta), "slenderness eta", eta, "zero or positive");
  SurfaceState s;
  s.alpha = 1.0 + eta * eta * F_3;
  require(s.alpha > 0.0, "stretch alpha", s.alpha, "positive");
  s.kappa_n = -1.0 / epsilon;
  s.F_3 = F_3;
  s.M_3 = M_3;
  s.F_g = -s.kappa_n * M_3;
  s.rho = -s.alpha * s.kappa_n * F_3;
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

double TorusGeodesic::slope(double beta) const {
  const double C3 = 1.0 + epsilon * std::cos(beta), c = clairaut(), half = std::cos(0.5 * beta);
  // C3 - c = ε (1 + cosβ) + margin, without cancellation near the inner equator.
  return C3 * std::sqrt((2.0 * epsilon * half * half + margin) * (C3 + c)) / (epsilon * c);
}

double TorusGeodesic::kappa_n(double beta) const {
  const double C3 = 1.0 + epsilon * std::cos(beta), cos_pitch = clairaut() / C3, c2 = cos_pitch * cos_pitch;
  return -std::cos(beta) * c2 / C3 - (1.0 - c2) / epsilon;  // (III.2.54)
}

TorusGeodesic torus_geodesic(double epsilon, double turn) {
  check(epsilon);
  require(turn > 0.0 && std::isfinite(turn), "azimuth per winding", turn, "positive");
  TorusGeodesic g;
  g.epsilon = epsilon;
  // dξ = ε c dβ/(C3 √(C3² - c²)) and ds = C3² dξ/c around one winding. With tan((π - β)/2) = a sinh w and
  // a² = margin/(2ε + margin) the integrand is smooth and decays as e^{-|w|}: the trapezoidal rule converges as
  // e^{-π²/step}.
  const auto integrate = [&](double margin) {
    g.margin = margin;
    g.turn = g.length = 0.0;
    const double c = g.clairaut(), a = std::sqrt(margin / (2.0 * epsilon + margin)), step = 0.1;
    const int last = static_cast<int>((std::asinh(1.0 / a) + 45.0) / step);
    for (int i = -last; i <= last; ++i) {
      const double as = a * std::sinh(step * i), q = 1.0 + as * as;  // cos(π - β) = (1 - as²)/q
      const double C3 = 1.0 - epsilon * (1.0 - as * as) / q;
      const double d_xi = 2.0 * epsilon * c * step / (C3 * std::sqrt((C3 + c) * (2.0 * epsilon + margin) * q));
      g.turn += d_xi;
      g.length += C3 * C3 / c * d_xi;
    }
  };
  // The turn falls from ∞ to 0 as the margin grows from 0 to 1 - ε: bisection in its logit.
  double low = -690.0, high = 60.0;
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    integrate((1.0 - epsilon) / (1.0 + std::exp(-middle)));
    (g.turn > turn ? low : high) = middle;
  }
  require(std::abs(g.turn - turn) < 1e-8 * turn, "azimuth per winding", turn, "within the range of double numbers");
  return g;
}

}  // namespace tendril::closed_form

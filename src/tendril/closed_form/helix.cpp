#include "tendril/closed_form/helix.hpp"

#include <cmath>
#include <numbers>

#include "tendril/closed_form/domain.hpp"

namespace tendril::closed_form {
namespace {

void check(const Helix& h, double eta) {
  require(h.radius > 0.0 && std::isfinite(h.radius), "helix radius", h.radius, "positive");
  require(std::abs(h.angle) < std::numbers::pi / 2, "helix angle", h.angle, "between -pi/2 and pi/2");
  require(eta >= 0.0 && std::isfinite(eta), "slenderness eta", eta, "zero or positive");
}

}  // namespace

double Helix::curvature() const { return std::sin(angle) * std::sin(angle) / radius; }
double Helix::torsion() const { return std::sin(angle) * std::cos(angle) / radius; }

SurfaceState helix_on_cylinder(const Helix& helix, double F_3, double M_3, double eta) {
  check(helix, eta);
  const double kappa = helix.curvature(), tau = helix.torsion();
  SurfaceState s;
  s.alpha = 1.0 + eta * eta * F_3;
  require(s.alpha > 0.0, "stretch alpha", s.alpha, "positive");
  s.kappa_n = -kappa;
  s.tau_g = tau;
  s.F_g = kappa * (M_3 - s.alpha * tau);  // (III.2.34) with κ_g = 0; minus (II.3.9), see docs/decisions/0004
  s.F_3 = F_3;
  s.M_3 = M_3;
  s.rho = s.alpha * kappa * (F_3 - tau * (M_3 - s.alpha * tau));  // (II.3.13)
  return s;
}

double free_helix_tension(const Helix& helix, double M_3, double eta) {
  check(helix, eta);
  const double tau = helix.torsion();
  return tau * (M_3 - tau) / (1.0 + eta * eta * tau * tau);  // ρ = 0 in (II.3.13), linear in F_3
}

AxialResultants axial_resultants(const Helix& helix, const SurfaceState& s) {
  const double sine = std::sin(helix.angle), cosine = std::cos(helix.angle);
  // d3 = sinθ e_β + cosθ D3, g = N x d3 = -cosθ e_β + sinθ D3; moment M = -α κ_n g + α κ_g N + M_3 d3.
  return {s.F_3 * cosine + s.F_g * sine, -s.alpha * s.kappa_n * sine + s.M_3 * cosine};
}

TwistVector helix_twist(const Helix& helix, double alpha, double xi) {
  const double kappa = helix.curvature(), x = xi * std::tan(helix.angle) / helix.radius;
  return {
      alpha * kappa * std::sin(x), -alpha * kappa * std::cos(x),
      -alpha * std::sin(helix.angle) * (1.0 - std::cos(helix.angle)) / helix.radius};  // corrected: docs/decisions/0004
}

SurfaceState homoclinic_helix(const Helix& helix, double pull, double eta) {
  check(helix, eta);
  const double sine = std::sin(helix.angle), cosine = std::cos(helix.angle), delta = helix.radius;
  const double sine4 = sine * sine * sine * sine;
  // α from F·D3 = F_3 cosθ + F_g sinθ = T, multiplied by η² so that the inextensible rod is no special case.
  const double alpha = (eta * eta * pull + cosine) / (cosine + eta * eta * sine4 / (delta * delta));  // (II.3.10)
  require(alpha > 0.0, "stretch alpha", alpha, "positive");
  const double M_3 = alpha * sine * (1.0 + cosine) / delta;
  const double F_3 = (pull - alpha * sine4 / (delta * delta)) / cosine;
  return helix_on_cylinder(helix, F_3, M_3, eta);
}

SurfaceState free_homoclinic_helix(const Helix& helix, double eta) {
  check(helix, eta);
  const double sine = std::sin(helix.angle), cosine = std::cos(helix.angle), delta = helix.radius;
  const double inverse = 1.0 - eta * eta / (delta * delta) * sine * sine * cosine;
  require(inverse > 0.0, "1 - (eta/delta)^2 sin^2(theta) cos(theta)", inverse, "positive");
  const double alpha = 1.0 / inverse;                                          // (II.3.14)
  return homoclinic_helix(helix, alpha * sine * sine / (delta * delta), eta);  // δ² T = α sin²θ
}

}  // namespace tendril::closed_form

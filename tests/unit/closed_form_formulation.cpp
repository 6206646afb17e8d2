// The closed forms put into the governing equations of the formulation room: every residual vanishes and the wall's
// force is the one claimed. Helix, Villarceau circle and sphere together exercise β' ≠ 0, U ≠ 0 and Q' ≠ 0.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "closed_form_world.hpp"
#include "tendril/closed_form/helix.hpp"
#include "tendril/closed_form/sphere.hpp"
#include "tendril/closed_form/torus.hpp"
#include "tendril/formulation/free_rod.hpp"
#include "tendril/formulation/line_contact.hpp"

namespace tendril::closed_form {
namespace {

using formulation::FreeRod;
using formulation::LineContact;
using formulation::Material;
using formulation::Section;

constexpr double nu = 1.0 / 3.0;
constexpr double rounding = 1e-11;  // sums of terms up to 1e3

Section section(double S, const Eigen::Vector3d& U, const std::array<double, 5>& Q) {
  Section s;
  s.S = S;
  s.U[0] = {U.x(), U.y(), U.z()};
  s.Q = Q;
  return s;
}

/// Largest residual of (III.2.30-35) and of the wall's force against the claimed state.
void expect_line_contact(const Material& m, const Section& s, const std::array<double, 11>& u,
                         const SurfaceState& state, double tolerance = rounding) {
  std::array<double, 4> residual{};
  double dsdS = 0.0;
  LineContact::residual<double>(m, formulation::lift(s, 0.0, 0.0), formulation::lift_clearance(s, 0.0, 0.0), u.data(),
                                residual.data(), &dsdS);
  for (const double r : residual) EXPECT_NEAR(r, 0.0, tolerance);
  const LineContact::Wall wall = LineContact::wall(m, s, u.data());
  EXPECT_NEAR(wall.curve.kg, state.kappa_g, tolerance);
  EXPECT_NEAR(wall.curve.kn, state.kappa_n, tolerance);
  EXPECT_NEAR(wall.curve.tg, state.tau_g, tolerance);
  EXPECT_NEAR(wall.M3, state.M_3, tolerance);
  EXPECT_NEAR(wall.Fn, state.F_n, tolerance);
  EXPECT_NEAR(wall.rho, state.rho, tolerance);
  EXPECT_NEAR(dsdS * state.alpha * wall.curve.J1bar, 1.0, tolerance);
}

TEST(ClosedFormFormulation, HelixSolvesTheLineContactEquations) {
  for (const double angle : {0.5, -0.9})
    for (const double F_3 : {-2.0, 6.0})
      for (const double M_3 : {-1.5, 3.0}) {
        const Helix helix{0.35, angle};
        const double eta = 0.15;
        const SurfaceState q = helix_on_cylinder(helix, F_3, M_3, eta);
        const double J1 = q.alpha * std::cos(angle), psi_prime = ((1 + nu) * M_3 - q.alpha * q.tau_g) / J1;
        expect_line_contact({eta * eta, nu}, section(0.4, {0, 0, 0}, {helix.radius}),
                            {0.7, std::tan(angle) / helix.radius, 0, 0, 0.2, psi_prime, 0, q.F_g, 0, F_3, 0}, q);
      }
}

TEST(ClosedFormFormulation, VillarceauCircleSolvesTheLineContactEquations) {
  const double epsilon = 0.4, M_3 = 1.8, root = std::sqrt(1 - epsilon * epsilon);
  for (const Hand hand : {Hand::right, Hand::left})
    for (const double xi : {0.3, 2.0, -1.1}) {
      const VillarceauPoint v = villarceau(epsilon, hand, xi, M_3);
      const double sign = hand == Hand::right ? 1.0 : -1.0, b1 = v.beta_prime;
      // β' = ±(1 + ε cosβ)/√(1 - ε²) differentiated
      const double b2 = -sign * epsilon * std::sin(v.beta) * b1 / root;
      const double b3 = -sign * epsilon * (std::cos(v.beta) * b1 * b1 + std::sin(v.beta) * b2) / root;
      // ψ' = ((1 + ν) M3 - τ_g)/J̄1 with τ_g = ±J̄1
      const double J = v.J_bar_1, J_prime = epsilon * std::sin(xi) / root;
      expect_line_contact({0.0, nu}, section(xi, {0, -1, 0}, {epsilon}),
                          {v.beta, b1, b2, b3, 0.0, (1 + nu) * M_3 / J - sign, -(1 + nu) * M_3 * J_prime / (J * J),
                           v.state.F_g, -std::sin(xi) * M_3, 0, 0},
                          v.state);
    }
}

TEST(ClosedFormFormulation, ElasticaOnTheSphereSolvesTheLineContactEquations) {
  // The unit sphere as a ringed surface: U = 0, Q = √(1 - S²). Through any point in any direction (S, β, β') passes a
  // rod with the claimed κ_g and dκ_g/dχ; β'' and β''' follow, since κ_g is linear in β'' and its rate in β'''.
  const double S = 0.3, Q = std::sqrt(1 - S * S), beta = 0.4, beta_prime = 0.7, M_3 = -1.3;
  const std::array<double, 5> clearance = {Q, -S / Q, -1 / std::pow(Q, 3), -3 * S / std::pow(Q, 5),
                                           -3 * (1 + 4 * S * S) / std::pow(Q, 7)};
  const Section s = section(S, {0, 0, 0}, clearance);
  const auto U = formulation::lift(s, 0.0, 0.0).U;
  const auto Qs = formulation::lift_clearance(s, 0.0, 0.0);
  for (const auto& [sigma, kappa_max] : {std::pair{0.5, 1.7}, std::pair{2.0, 1.8}})
    for (const double chi : {0.2, 1.3}) {
      const SphereElastica rod(sigma, kappa_max);
      const SurfaceState q = rod.state(chi, M_3);
      const auto curve = [&](double b2, double b3) {
        return LineContact::curve_jet<double>(U, Qs, beta, beta_prime, b2, b3);
      };
      const double kg0 = curve(0, 0).kg.v, b2 = (q.kappa_g - kg0) / (curve(1, 0).kg.v - kg0);
      const double J = curve(b2, 0).J1bar.v, J_prime = curve(b2, 0).J1bar.d, slope = rod.kappa_g_prime(chi);
      const double rate0 = curve(b2, 0).kg.d, b3 = (slope / J - rate0) / (curve(b2, 1).kg.d - rate0);
      // F_g = M3 - κ_g', κ_g'' = κ_g (σ - κ_g²)/2; F_3' = -κ_g κ_g'; d/dS = d/dχ /J̄1. τ_g = 0 on a sphere.
      const double second = 0.5 * q.kappa_g * (sigma - q.kappa_g * q.kappa_g);
      expect_line_contact({0.0, nu}, s,
                          {beta, beta_prime, b2, b3, 0.0, (1 + nu) * M_3 / J, -(1 + nu) * M_3 * J_prime / (J * J),
                           q.F_g, -second / J, q.F_3, -q.kappa_g * slope / J},
                          q);
    }
}

TEST(ClosedFormFormulation, FreeHelixSolvesTheContactFreeEquations) {
  const double eta = 0.1, M_3 = 2.2, S = 0.6;
  for (const double angle : {0.5, -0.4}) {
    const Helix helix{0.3, angle};
    const SurfaceState q = helix_on_cylinder(helix, free_helix_tension(helix, M_3, eta), M_3, eta);
    const double rate = std::tan(angle) / helix.radius, J1 = q.alpha * std::cos(angle);
    const auto force = [&](double at) {  // F in k1, k2
      const double b = rate * at;
      const Eigen::Vector3d hoop(-std::sin(b), std::cos(b), 0), axis = Eigen::Vector3d::UnitZ();
      const Eigen::Vector3d t = std::sin(angle) * hoop + std::cos(angle) * axis,
                            g = -std::cos(angle) * hoop + std::sin(angle) * axis;
      const Eigen::Vector3d F = q.F_g * g + q.F_3 * t;
      const double w = 1 + t.z();
      return Eigen::Vector2d(F.dot(Eigen::Vector3d(1 - t.x() * t.x() / w, -t.x() * t.y() / w, -t.x())),
                             F.dot(Eigen::Vector3d(-t.x() * t.y() / w, 1 - t.y() * t.y() / w, -t.y())));
    };
    const Eigen::Vector2d F = force(S), F_prime = test::derivative(force, S);
    const double phi_prime = ((1 + nu) * M_3 - helix_twist(helix, q.alpha, S).omega_3) / J1;
    const double c = helix.radius * std::cos(rate * S), d = helix.radius * std::sin(rate * S);
    const double r2 = rate * rate, r3 = r2 * rate;
    const std::array<double, 17> u = {c,           -rate * d, -r2 * c,     r3 * d,    d,   rate * c,
                                      -r2 * d,     -r3 * c,   0.0,         phi_prime, 0.0, F.x(),
                                      F_prime.x(), F.y(),     F_prime.y(), q.F_3,     0.0};
    std::array<double, 6> residual{};
    double dsdS = 0.0;
    const Section s = section(S, {0, 0, 0}, {0.5});
    FreeRod::residual<double>({eta * eta, nu}, formulation::lift(s, 0.0, 0.0), u.data(), residual.data(), &dsdS);
    for (const double r : residual) EXPECT_NEAR(r, 0.0, test::difference_tolerance) << "angle " << angle;
    EXPECT_NEAR(dsdS * J1, 1.0, rounding);
  }
}

}  // namespace
}  // namespace tendril::closed_form

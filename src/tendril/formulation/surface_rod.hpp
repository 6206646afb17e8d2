#pragma once
// Rods and strings bound to any regular parametric surface, over their own reference arc length s (III.1). Scaled as
// everywhere (lengths by L, forces by B/L², moments by B/L; a string: forces by a reference tension F0). N is that of
// (III.1.6), ρ the component along N of the force on the rod per reference length; no friction. Departs from the
// thesis' unknowns (u, v, ψ): with the direction θ measured from the u-line, skew parametrisations included, the
// equations are explicit and of first order, and body force, body couple and extensibility stay in. The normal shear
// F_n follows from the state; the pressure needs its derivative, taken by dual numbers.

#include <array>
#include <string>
#include <vector>

#include "tendril/geometry/surface_direction.hpp"
#include "tendril/numerics/extrapolation.hpp"

namespace tendril::formulation {

struct SurfaceRod {
  geometry::SurfacePtr surface;
  double eta_squared = 0.0;             // B/(A L²); 0: inextensible
  double nu = 0.0;                      // B/C - 1
  std::array<double, 3> body_force{};   // σ, world frame, per reference length [B/L³]
  std::array<double, 3> body_couple{};  // μ, world frame [B/L²]
};

/// u, v, θ, κ_g, F_g, F_3, M_3, ψ.
enum SurfaceRodIndex { iu, iv, itheta, ikappa_g, iF_g, iF_3, iM_3, ipsi, surface_rod_states };
template <class T>
using SurfaceRodState = std::array<T, surface_rod_states>;

template <class T>
T dot3(const geometry::Triple<T>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// dy/ds; F_n on the way; body force and couple times `load`. False where the rod is compressed to nothing (α <= 0) or
/// the surface is singular.
template <class T>
bool surface_rod_slope(const SurfaceRod& rod, const SurfaceRodState<T>& y, SurfaceRodState<T>& dy, T& F_n,
                       const T& load = T(1.0)) {
  const auto patch = geometry::lift(rod.surface->patch(numerics::value(y[iu]), numerics::value(y[iv])), y[iu], y[iv]);
  const auto d = geometry::surface_direction<T>(patch, y[itheta]);
  const double eta2 = rod.eta_squared;
  const T &kg = y[ikappa_g], &F_g = y[iF_g], &F_3 = y[iF_3], &M_3 = y[iM_3];
  const T &kn = d.kappa_n, &tg = d.tau_g;
  const T alpha = 1.0 + eta2 * F_3;
  if (!(numerics::value(alpha) > 0.0)) return false;
  const T s_g = load * dot3(d.g, rod.body_force), s_3 = load * dot3(d.t, rod.body_force);
  const T m_g = load * dot3(d.g, rod.body_couple), m_n = load * dot3(d.N, rod.body_couple);
  const T m_3 = load * dot3(d.t, rod.body_couple);
  const T kn_slope = alpha * (d.kappa_n_along + 2.0 * (kg * tg));
  const T twist = alpha * tg - M_3;
  // (III.1.31) with α' of (III.1.30) put in: explicit in F_n
  F_n = -(kn_slope + eta2 * (kn * (kg * F_g - s_3 / alpha)) + kg * twist - m_g / alpha) / (1.0 + eta2 * (kn * kn));
  const T pull = kg * F_g + kn * F_n;
  dy[iF_3] = alpha * pull - s_3;  // (III.1.30)
  dy[iu] = alpha * d.u_rate;      // (III.1.5)
  dy[iv] = alpha * d.v_rate;
  dy[itheta] = alpha * (kg + d.geodesic_turning);                          // (III.1.20), skew parametrisation
  dy[ikappa_g] = kn * twist - F_g - (eta2 * kg * dy[iF_3] + m_n) / alpha;  // (III.1.32)
  dy[iF_g] = alpha * (tg * F_n - kg * F_3) - s_g;                          // (III.1.28)
  dy[iM_3] = -m_3;                                                         // (III.1.33)
  dy[ipsi] = (1.0 + rod.nu) * M_3 - alpha * tg;                            // (III.1.35)
  return true;
}

/// The whole section: world frame and Darboux components.
struct SurfaceRodSection {
  double s = 0.0;
  SurfaceRodState<double> state{};
  std::array<double, 3> r{}, t{}, g{}, N{};
  double alpha = 1.0, kappa_g = 0.0, kappa_n = 0.0, tau_g = 0.0;
  double F_g = 0.0, F_n = 0.0, F_3 = 0.0, M_3 = 0.0;
  double rho = 0.0;                // (III.1.29)
  std::array<double, 3> F{}, M{};  // world frame (III.1.26-27)
};
SurfaceRodSection surface_rod_section(const SurfaceRod& rod, double s, const SurfaceRodState<double>& y);

struct SurfaceRodCurve {
  std::vector<SurfaceRodSection> section;  // at the places asked for
  numerics::IntegrationSummary summary;    // not completed: the sections end where the integration did
};
/// Refuses (geometry::GeometryError) a start that is not finite, a surface that is singular there, places that do not
/// increase, η² < 0 or ν <= -1.
void check_surface_rod(const SurfaceRod& rod, const SurfaceRodState<double>& start, const std::vector<double>& s);

/// Initial value problem: the sections at the increasing places s, from the state at s.front().
SurfaceRodCurve integrate_surface_rod(const SurfaceRod& rod, const SurfaceRodState<double>& start,
                                      const std::vector<double>& s, const numerics::IntegrationOptions& options = {});

/// Largest imbalance of the world-frame laws over the curve, by quadrature of loads and pressure between its sections
/// (an independent look at the equations): force in [B/L²], moment about the origin in [B/L]. The sections must be the
/// Gauss-Lobatto-like set made by `balance_places`.
struct Imbalance {
  double force = 0.0, moment = 0.0;
};
/// Places for the quadrature: both ends and seven Gauss points on each of `pieces` equal pieces.
std::vector<double> balance_places(double length, int pieces);
Imbalance world_imbalance(const SurfaceRod& rod, const std::vector<SurfaceRodSection>& sections, int pieces);

/// Energy-like first integral: ½|M_perp|² + F_3 + ½ η² F_3² + σ·r, constant for μ = 0.
double surface_rod_energy(const SurfaceRod& rod, const SurfaceRodSection& x);

/// Clamped at both ends (place and direction), fixed length, M_3 at the right end given: shooting with the exact
/// Jacobian from `guess` of κ_g, F_g, F_3 at s = 0.
struct ClampedSurfaceRod {
  SurfaceRod rod;
  double length = 1.0;
  std::array<double, 3> left{}, right{};  // u, v, θ
  double M_3 = 0.0;
};
struct SurfaceRodSolution {
  bool converged = false;
  std::string reason;  // when not converged
  int iterations = 0;
  SurfaceRodState<double> start{};
};
SurfaceRodSolution solve_clamped(const ClampedSurfaceRod& problem, const std::array<double, 3>& guess,
                                 const numerics::IntegrationOptions& options = {});

}  // namespace tendril::formulation

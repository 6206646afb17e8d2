#pragma once
// The parts of the system `sphere`: what its sources share.

#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <string>

#include "tendril/closed_form/sphere.hpp"
#include "tendril/formulation/surface_rod.hpp"
#include "tendril/reproduce/system.hpp"

namespace tendril::reproduce::on_sphere {

constexpr double pi = std::numbers::pi;
constexpr double exact = 1e-10;         // asked of the solver
constexpr double slender = 1.0 / 20.0;  // η of Fig. III.1.5
constexpr double gap = std::numeric_limits<double>::quiet_NaN();

inline std::string text(const char* format, double a = 0.0, double b = 0.0, double c = 0.0) {
  char line[120];
  std::snprintf(line, sizeof line, format, a, b, c);
  return line;
}

/// Turns of longitude per period.
inline double progression(double kappa_sigma, double square) {
  return closed_form::SphereElastica(square - kappa_sigma, std::sqrt(square)).longitude_per_period() / (2.0 * pi);
}

/// Start of the general solver where κ_g is largest: on the parallel, N inward, no torque.
inline formulation::SurfaceRodState<double> crest(const closed_form::SphereElastica& rod, double kappa_max,
                                                  double sigma, double M_3) {
  const double east = rod.longitude_rate(0.0) > 0.0 ? 1.0 : -1.0;
  return {std::asin(rod.height(0.0)),
          0.0,
          east * pi / 2,
          -kappa_max,
          -M_3,
          0.5 * (sigma - kappa_max * kappa_max),
          M_3,
          0.0};
}

/// Twenty closed elasticae; their closure under the general solver becomes rows.
Picture gallery(Outcome& out, const Progress& progress);
/// What wavelength and angular progression are.
Picture wavelength();
/// Contours of the turns per period over the parameter space.
Picture map(Outcome& out);
Picture phase_portrait();
Picture extrema(Outcome& out);

}  // namespace tendril::reproduce::on_sphere

#include "tendril/rod/section_stress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace tendril::rod {

double CircularSection::area() const {
  return std::numbers::pi / 4 * (outer_diameter * outer_diameter - inner_diameter * inner_diameter);
}

double CircularSection::second_moment() const {
  return std::numbers::pi / 64 * (std::pow(outer_diameter, 4) - std::pow(inner_diameter, 4));
}

double Stress::von_mises() const { return std::sqrt(s33 * s33 + 3 * (s31 * s31 + s32 * s32)); }

Stress stress_at(const CircularSection& section, const Resultants& r, double a1, double a2) {
  const double I = section.second_moment();
  return {-a2 * r.M3 / (2 * I), a1 * r.M3 / (2 * I), r.F3 / section.area() + (a2 * r.M1 - a1 * r.M2) / I};  // (A.1.6)
}

SectionStress section_stress(const CircularSection& section, const Elasticity& material, const Resultants& r) {
  const double I = section.second_moment(), radius = section.radius();
  SectionStress s;
  s.axial = r.F3 / section.area();
  s.bending = radius * std::hypot(r.M1, r.M2) / I;
  s.torsion = radius * r.M3 / (2 * I);
  // Bending and torsion grow with the distance from the centre, and bending adds to the axial stress on one side.
  const double normal = std::abs(s.axial) + s.bending;
  s.von_mises = std::sqrt(normal * normal + 3 * s.torsion * s.torsion);
  const double e = normal / material.young_modulus, half_shear = s.torsion / (2 * material.shear_modulus());
  const double nu = material.poisson_ratio;
  // Principal strains of (e, -nu e) with that shear, beside the third one, -nu e.
  const double middle = (1 - nu) / 2 * e, away = std::hypot((1 + nu) / 2 * e, half_shear);
  s.strain = std::max(middle + away, away - middle);
  return s;
}

std::string small_strain_warning(double strain) {
  if (!(strain > kSmallStrain)) return "";
  char text[160];
  std::snprintf(
      text, sizeof text,
      "the largest strain in the section is %.3g %%, above %.3g %%: linear elasticity at small strain is doubtful",
      100 * strain, 100 * kSmallStrain);
  return text;
}

}  // namespace tendril::rod

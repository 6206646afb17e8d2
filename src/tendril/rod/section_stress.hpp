#pragma once
// Stresses in a circular section, solid or tubular, from the internal force and moment (Kirchhoff, Clebsch, Love: A.1
// of the thesis, after Dill 1992): sigma_33 = E(alpha - 1 + a_2 u_1 - a_1 u_2), sigma_31 = -G a_2 u_3, sigma_32 = G a_1
// u_3 (A.1.6), F_3 = EA(alpha - 1), M_i = EI u_i, M_3 = GJ u_3. Linear elasticity at small strain: the theory's error
// is of the order of the largest strain, which is reported and warned about above 2 %.

#include <string>
#include <vector>

namespace tendril::rod {

struct CircularSection {
  double outer_diameter = 0.0, inner_diameter = 0.0;  // inner 0: solid  [length]

  double radius() const { return outer_diameter / 2; }
  double area() const;           // [length^2]
  double second_moment() const;  // I; the polar one is 2 I  [length^4]
};

struct Elasticity {
  double young_modulus = 0.0;  // E  [force/length^2]
  double poisson_ratio = 0.0;  // ν
  double shear_modulus() const { return young_modulus / (2 * (1 + poisson_ratio)); }
};

/// Force and moment on the section in the basis of its directors.
struct Resultants {
  double F3 = 0.0, M1 = 0.0, M2 = 0.0, M3 = 0.0;
};

/// Stress at a point of the section [force/length^2].
struct Stress {
  double s31 = 0.0, s32 = 0.0, s33 = 0.0;
  double von_mises() const;
};
Stress stress_at(const CircularSection& section, const Resultants& resultants, double a1, double a2);

/// What a section carries at most; all at the outer surface.
struct SectionStress {
  double axial = 0.0;      // F3/area, tension positive
  double bending = 0.0;    // largest of bending alone, >= 0
  double torsion = 0.0;    // shear at the surface, sign of M3
  double von_mises = 0.0;  // largest over the section
  double strain = 0.0;     // largest principal strain in magnitude, where the von Mises stress is largest
};
SectionStress section_stress(const CircularSection& section, const Elasticity& material, const Resultants& resultants);

/// Strain above which the small-strain assumption is called into question.
constexpr double kSmallStrain = 0.02;
/// Empty, or a warning in words.
std::string small_strain_warning(double strain);

}  // namespace tendril::rod

// Stresses in the section (A.1): a steel wire, solid or drawn as a tube, pushed through the thesis' helical conduit at
// the scale of a guidewire. Units mm, N, MPa.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "tendril/continuation/study.hpp"
#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/numerics/dual.hpp"
#include "tendril/reproduce/systems.hpp"
#include "tendril/rod/section_stress.hpp"

namespace tendril::reproduce {
namespace {

using continuation::Fields;
using drawing::Curve;
using drawing::Panel;
using rod::CircularSection;
using rod::Elasticity;
using rod::Resultants;
using rod::SectionStress;

constexpr double kPi = std::numbers::pi, kLength = 100.0, kClearance = 2.5;  // [mm]
constexpr Elasticity kSteel{200e3, 0.3};
constexpr double kPitch = kPi / 4, kRounding = 1e-12;
constexpr double kAsked = 1e-9;

struct Wire {
  const char* name;
  CircularSection section;
  double bending_stiffness() const { return kSteel.young_modulus * section.second_moment(); }
  double torsional_stiffness() const { return 2 * kSteel.shear_modulus() * section.second_moment(); }
  double axial_stiffness() const { return kSteel.young_modulus * section.area(); }
};
constexpr Wire kWires[] = {{"solid wire, 0.5 mm", {0.5, 0.0}}, {"tube, 0.5 x 0.35 mm", {0.5, 0.35}}};

/// The conduit's curvature and torsion are equal at 45°.
const double kCurvature = kPi * std::sin(kPitch) / kLength;

/// Torque -B/L; force at which the wire follows the axis, T0 (II.3.19), times `load`.
segmentation::Problem problem(const Wire& wire, double load) {
  const double B = wire.bending_stiffness(), M3 = -B / kLength, eta2 = B / wire.axial_stiffness();  // [mm²]
  const double T0 = kCurvature * (M3 - B * kCurvature) / (1 + eta2 * kCurvature * kCurvature);
  segmentation::Problem p;
  p.tube.axis = geometry::make_helix(std::sin(kPitch) * std::sin(kPitch) / kCurvature, kPitch, kLength);
  p.tube.clearance = geometry::make_constant(kClearance);
  p.rod = {B, wire.torsional_stiffness(), wire.axial_stiffness()};
  p.end.kind = segmentation::End::Kind::sleeve;
  p.end_position = kLength;
  p.axial_value = load * T0;
  p.twist_value = M3;
  return p;
}

Fields solved(const Wire& wire, double load, const std::function<bool()>& go_on) {
  if (!go_on()) throw Interrupted{};
  continuation::StudyOptions options;
  options.solve.tolerance = kAsked;
  options.fields = true;
  options.field_points = 801;
  const continuation::Result r = continuation::solve(problem(wire, load), options);
  if (r.status != continuation::Status::converged) throw std::runtime_error("the wire was not solved: " + r.message);
  return r.steps.at(0).fields;
}

Resultants resultants(const Fields& f, std::size_t i) { return {f.F3[i], f.M1[i], f.M2[i], f.M3[i]}; }

/// Integrals of the stresses over the section (A.1.7), by Simpson's rule along the radius, which is exact for cubics.
Resultants integrated(const CircularSection& section, const Resultants& r) {
  Resultants sum;
  constexpr int kAround = 12;
  const double inner = section.inner_diameter / 2, outer = section.radius();
  for (int i = 0; i < kAround; ++i)
    for (int k = 0; k < 3; ++k) {
      const double rho = inner + (outer - inner) * k / 2, angle = 2 * kPi * i / kAround;
      const double a1 = rho * std::cos(angle), a2 = rho * std::sin(angle);
      const double weight = (k == 1 ? 4 : 1) * (outer - inner) / 6 * rho * 2 * kPi / kAround;
      const rod::Stress s = rod::stress_at(section, r, a1, a2);
      sum.F3 += weight * s.s33;
      sum.M1 += weight * a2 * s.s33;
      sum.M2 -= weight * a1 * s.s33;
      sum.M3 += weight * (a1 * s.s32 - a2 * s.s31);
    }
  return sum;
}

/// Lateral strains by (A.1.3-4), first terms with the corrected sign, against Hooke's law: their largest difference.
double lateral_misfit(const CircularSection& section, const Resultants& r) {
  using D = numerics::Dual<2>;
  const double EI = kSteel.young_modulus * section.second_moment(), nu = kSteel.poisson_ratio;
  const double stretch = 1 + r.F3 / (kSteel.young_modulus * section.area()), u1 = r.M1 / EI, u2 = r.M2 / EI;
  double worst = 0;
  for (int i = 0; i < 24; ++i) {
    const double rho = section.radius() * (1 + i % 3) / 3, angle = 2 * kPi * i / 24;
    const D a1 = D::seed(rho * std::cos(angle), 0), a2 = D::seed(rho * std::sin(angle), 1);
    const D b1 = (1 - stretch) * nu * a1 - nu * u1 * (a1 * a2) + 0.5 * nu * u2 * (a1 * a1 - a2 * a2);
    const D b2 = (1 - stretch) * nu * a2 + nu * u2 * (a1 * a2) + 0.5 * nu * u1 * (a1 * a1 - a2 * a2);
    const double contraction = -nu * rod::stress_at(section, r, a1.v, a2.v).s33 / kSteel.young_modulus;
    worst = std::max(
        {worst, std::abs(b1.d[0] - contraction), std::abs(b2.d[1] - contraction), std::abs(b1.d[1] + b2.d[0])});
  }
  return worst;
}

double searched(const CircularSection& section, const Resultants& r) {
  double most = 0;
  for (int i = 0; i <= 20; ++i)
    for (int j = 0; j < 3600; ++j) {
      const double inner = section.inner_diameter / 2, rho = inner + (section.radius() - inner) * i / 20;
      most = std::max(most,
                      rod::stress_at(section, r, rho * std::cos(2 * kPi * j / 3600), rho * std::sin(2 * kPi * j / 3600))
                          .von_mises());
    }
  return most;
}

void rows_of(Outcome& out, const Wire& wire, const Fields& on_axis, const Fields& pushed, std::size_t worst) {
  const std::string where = std::string(wire.name) + ": ";
  const CircularSection& section = wire.section;
  // On the axis everything is known: curvature and torsion of the axis, M3 = -B/L, F3 = T0.
  const Resultants r = resultants(on_axis, 400);
  const SectionStress s = rod::section_stress(section, kSteel, r);
  const double E = kSteel.young_modulus, B = wire.bending_stiffness(), eta2 = B / wire.axial_stiffness();
  const double force = kCurvature * (-B / kLength - B * kCurvature) / (1 + eta2 * kCurvature * kCurvature);
  const double stretch = 1 + force / wire.axial_stiffness();
  const auto row = [&](const std::string& what, double computed, double expected, double tolerance,
                       const char* source) {
    out.rows.push_back({where + what, computed, expected, tolerance, source});
  };
  row("on the axis, axial stress [MPa]", s.axial, force / section.area(), 1e-6, "T0/area, (II.3.19)");
  row("on the axis, bending stress [MPa]", s.bending, E * section.radius() * stretch * kCurvature, 1e-6, "E r α K");
  row("on the axis, torsional stress [MPa]", s.torsion, -B / kLength * section.radius() / (2 * section.second_moment()),
      1e-6, "M3 r/J");
  const double normal = std::abs(force) / section.area() + E * section.radius() * stretch * kCurvature;
  row("on the axis, largest von Mises stress [MPa]", s.von_mises, std::hypot(normal, std::sqrt(3.0) * s.torsion), 1e-6,
      "closed form");
  const Resultants w = resultants(pushed, worst), back = integrated(section, w);
  row("F3 from the integrated stresses [N]", back.F3, w.F3, kRounding * std::abs(w.F3), "(A.1.7)");
  row("M1 from the integrated stresses [N mm]", back.M1, w.M1, kRounding * B * kCurvature, "(A.1.7)");
  row("M2 from the integrated stresses [N mm]", back.M2, w.M2, kRounding * B * kCurvature, "(A.1.7)");
  row("M3 from the integrated stresses [N mm]", back.M3, w.M3, kRounding * B * kCurvature, "(A.1.7)");
  row("lateral strain against -ν σ33/E", lateral_misfit(section, w), 0.0, 1e-15, "(A.1.3-4), sign corrected");
  // A search every 0.1° misses the place by at most 0.05°: relative (9e-4)²/2.
  const double most = rod::section_stress(section, kSteel, w).von_mises;
  row("pushed, largest von Mises stress [MPa]", most, searched(section, w), 4e-7 * most, "search over the section");
}

/// Normal stress over the section, as rings.
Panel map_of(const std::string& title, const CircularSection& section, const Resultants& r) {
  Panel panel;
  panel.title = title;
  panel.x_label = "a_1 [mm]";
  panel.y_label = "a_2 [mm]";
  panel.equal_scale = true;
  panel.value_label = "σ_{33} [MPa]";
  constexpr int kRings = 24;
  const double inner = section.inner_diameter / 2;
  for (int k = 0; k < kRings; ++k) {
    const double rho = inner + (section.radius() - inner) * (k + 0.5) / kRings;
    Curve ring;
    ring.width = 130 * (section.radius() - inner) / section.radius() / kRings + 0.6;
    for (int i = 0; i <= 180; ++i) {
      const double angle = 2 * kPi * i / 180;
      ring.x.push_back(rho * std::cos(angle));
      ring.y.push_back(rho * std::sin(angle));
      ring.value.push_back(rod::stress_at(section, r, ring.x.back(), ring.y.back()).s33);
    }
    panel.curves.push_back(ring);
  }
  panel.x_range = panel.y_range = {{-1.15 * section.radius(), 1.15 * section.radius()}};
  return panel;
}

Outcome compute(const Progress& progress) {
  Outcome out;
  Picture along{"stresses",
                "Stresses along the rod pushed with 10 |T0| through the helical conduit: axial, bending and "
                "torsional stress at the surface, and the largest von Mises stress in each section.",
                {}};
  Picture sections{"sections",
                   "Normal stress in the most stressed section, axes along k1 and k2. The neutral axis is off the "
                   "centre because the "
                   "rod is pushed.",
                   {}};
  for (int i = 0; i < 2; ++i) {
    const Wire& wire = kWires[i];
    const auto go_on = [&, part = 0]() mutable {
      return progress ? progress((2 * i + part++) / 4.0, wire.name) : true;
    };
    const std::function<bool()> step = go_on;
    const Fields on_axis = solved(wire, 1.0, step), pushed = solved(wire, 10.0, step);
    Data data{i == 0 ? "stresses_solid" : "stresses_tube",
              {"S [mm]", "axial [MPa]", "bending [MPa]", "torsion [MPa]", "von Mises [MPa]", "strain [-]"},
              std::vector<std::vector<double>>(6)};
    std::size_t worst = 0;
    double largest = 0, strain = 0;
    for (std::size_t k = 0; k < pushed.S.size(); ++k) {
      const SectionStress s = rod::section_stress(wire.section, kSteel, resultants(pushed, k));
      const double row[] = {pushed.S[k], s.axial, s.bending, s.torsion, s.von_mises, s.strain};
      for (std::size_t c = 0; c < 6; ++c) data.value[c].push_back(row[c]);
      if (s.von_mises > largest) {
        largest = s.von_mises;
        worst = k;
      }
      strain = std::max(strain, s.strain);
    }
    rows_of(out, wire, on_axis, pushed, worst);
    Panel panel;
    panel.title = wire.name;
    panel.x_label = "S [mm]";
    panel.y_label = "stress [MPa]";
    const char* names[] = {"", "axial", "bending", "torsion", "von Mises"};
    for (std::size_t c = 1; c < 5; ++c) {
      Curve curve;
      curve.x = data.value[0];
      curve.y = data.value[c];
      curve.label = names[c];
      if (c == 4) {
        curve.width = 2.2;
        curve.colour = 6;
      }
      panel.curves.push_back(curve);
    }
    along.figure.panels.push_back(panel);
    char text[200];
    std::snprintf(text, sizeof text, "%s, S = %.1f mm", wire.name, pushed.S[worst]);
    sections.figure.panels.push_back(map_of(text, wire.section, resultants(pushed, worst)));
    out.data.push_back(data);
    std::snprintf(text, sizeof text, "%s: largest von Mises stress %.1f MPa at S = %.2f mm, largest strain %.3f %%",
                  wire.name, largest, pushed.S[worst], 100 * strain);
    const std::string warning = rod::small_strain_warning(strain);
    out.notes.push_back(std::string(text) +
                        (warning.empty() ? ", within the small-strain assumption." : "; " + warning + "."));
  }
  sections.figure.panel_height = 340;
  out.pictures = {along, sections};
  // The thesis' own numbers: η = 1/20 is a solid rod of diameter 4 η L, whose surface strain on the axis is 2 η K L.
  const double thesis = 2 * (1.0 / 20) * kPi * std::sin(kPitch);
  out.rows.push_back({"η = 1/20 of the thesis, solid rod on the axis: surface strain of bending r K", thesis,
                      CircularSection{4.0 / 20, 0}.radius() * kPi * std::sin(kPitch), kRounding, "η² = I/(area L²)"});
  char text[300];
  std::snprintf(
      text, sizeof text,
      "The thesis' slenderness η = 1/20 is that of a solid rod of diameter L/5: on the axis of its helical conduit "
      "it is bent to a surface strain of %.0f %%. Its example is one of the equations, not of a real rod.",
      100 * thesis);
  out.notes.push_back(text);
  if (progress) progress(1.0, "done");
  return out;
}

}  // namespace

System stresses_system() {
  return {"stresses",
          "Stresses in the section",
          "A.1",
          "Axial, bending and torsional stress and the largest von Mises stress along a wire, solid or tubular, pushed "
          "through a helical conduit; the largest strain watched.",
          compute,
          0.1};
}

}  // namespace tendril::reproduce

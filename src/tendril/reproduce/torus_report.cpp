#include "tendril/reproduce/torus_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tendril::reproduce::torus {

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", value);
  return buffer;
}

std::string text(const std::vector<double>& values) {
  std::string out;
  for (double v : values) out += (out.empty() ? "" : ", ") + text(v);
  return out;
}

/// β of a solved winding where the energy twin starts from.
EnergyTwin twin_of(const Family& family, const BoundaryValueProblem& winding) {
  constexpr int places = 800;
  std::vector<double> beta;
  for (int i = 0; i < places; ++i) beta.push_back(point_at(family, winding, (i + 0.5) / (2 * places)).beta);
  const double p = winding.parameter(), turn = family.turn(p), force = family.force(p);
  // sharper bends need more terms: where the rod leaves the inner equator, and in long knots
  const int terms = 24 + static_cast<int>(16.0 * turn) + (std::abs(force) > 1.0 ? 24 : 0);
  return energy_twin(family.rod.epsilon, turn, force, beta, terms);
}

void include(Faults& all, const Faults& one, double size) {
  const auto larger = [size](double& a, double b) { a = std::max(a, b / size); };
  larger(all.phase, one.phase);
  larger(all.drag, one.drag);
  larger(all.M3, one.M3);
  larger(all.H, one.H);
  larger(all.axial_moment, one.axial_moment);
  larger(all.closure, one.closure);
  larger(all.force, one.force);
  larger(all.moment, one.moment);
}

void fault_rows(const std::string& which, const Faults& f, std::vector<Row>& rows) {
  const auto add = [&](const char* what, double value, const char* source) {
    rows.push_back({which + ": " + what, value, 0.0, exact, source});
  };
  add("largest phase multiplier λ", f.phase, "0: the rod may be turned about the axis");
  add("largest multiplier μ of H", f.drag, "0: no drag");
  add("largest |M3|", f.M3, "constant, 0 asked for");
  add("spread of H", f.H, "conserved");
  add("spread of (M + r × F)·e_z", f.axial_moment, "conserved: the normals meet the axis");
  add("jump of F, M, ρ where the ends meet", f.closure, "continuous");
  add("F + ∫ρN ds in space", f.force, "(II.1.12), Lagrangian");
  add("M + ∫d3 × F ds in space", f.moment, "(II.1.13), Lagrangian");
}

Picture bodies(const std::string& name, const std::string& title, const std::string& caption,
               std::vector<drawing::Panel> panels, int columns) {
  Picture p;
  p.name = name;
  p.caption = caption;
  p.figure.title = title;
  p.figure.columns = columns;
  p.figure.panel_width = 300.0;
  p.figure.panel_height = 250.0;
  p.figure.panels = std::move(panels);
  return p;
}

drawing::Panel along_a_winding(const std::string& y_label) {
  drawing::Panel panel;
  panel.x_label = "azimuth over that of one winding [-]";
  panel.y_label = y_label;
  return panel;
}

}  // namespace tendril::reproduce::torus

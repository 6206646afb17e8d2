#pragma once
// The parts of the system `surface_rods`: what its sources share.

#include <cstdio>
#include <string>
#include <vector>

#include "tendril/formulation/surface_rod.hpp"
#include "tendril/formulation/surface_string.hpp"
#include "tendril/reproduce/body_view.hpp"
#include "tendril/reproduce/system.hpp"

namespace tendril::reproduce::on_surfaces {

constexpr double exact = 1e-10;  // asked of the solver

/// A surface with what is drawn of it and a rod on it.
struct Example {
  std::string name;
  geometry::SurfacePtr surface;
  double outward;  // N times this points out of the body (up, for a graph)
  BodyRange range;
  drawing::View view;
  int u_lines, v_lines;
  formulation::SurfaceRodState<double> start;
  double length;
};
/// Sphere, cylinder, torus, ellipsoid and graph, each with a heavy, twisted, extensible rod.
const std::vector<Example>& examples();
formulation::SurfaceRod model_of(const Example& example);

/// z = 0.8 exp(-2 (x² + y²)).
geometry::SurfacePtr hill();
BodyRange hill_range();

std::vector<double> evenly(double from, double to, int parts);

/// Rows against closed forms and between the two solvers.
void add_rod_rows(Outcome& out);
void add_string_rows(Outcome& out);
/// Rods on five surfaces, coloured by the pressure; their balance in the world frame becomes rows.
Picture rods(Outcome& out);
/// A rod over a hill between clamps, from slack to taut: towards the geodesic.
Picture rod_to_string(Outcome& out);
Picture strings(Outcome& out);

}  // namespace tendril::reproduce::on_surfaces

#pragma once
// Rows, numbers and pictures that the parts of the system torus share. Private to it.

#include <string>
#include <vector>

#include "tendril/reproduce/system.hpp"
#include "tendril/reproduce/torus_energy.hpp"
#include "tendril/reproduce/torus_gallery.hpp"
#include "tendril/reproduce/torus_pictures.hpp"

namespace tendril::reproduce::torus {

constexpr double exact = 1e-10;  // asked of states solved to `accuracy`
inline constexpr const char* twin_source = "stationary energy (Fourier series), no equation of equilibrium";

std::string text(double value);                       // four digits
std::string text(const std::vector<double>& values);  // separated by commas

/// The energy twin of a solved winding, started from its β.
EnergyTwin twin_of(const Family& family, const BoundaryValueProblem& winding);

/// The larger of both, entry by entry, the new ones over `size`.
void include(Faults& all, const Faults& one, double size);
void fault_rows(const std::string& which, const Faults& faults, std::vector<Row>& rows);

Picture bodies(const std::string& name, const std::string& title, const std::string& caption,
               std::vector<drawing::Panel> panels, int columns);
drawing::Panel along_a_winding(const std::string& y_label);

/// Rows, data and pictures of the knots at F3(0) = 0 (Figs. III.2.2, III.2.4).
void report_knots(const Gallery& gallery, Outcome& out);
/// Knots (1,5) and (2,1) under axial force, with the geodesics as limits (Fig. III.2.3), and the families.
void report_loads(const Gallery& gallery, Outcome& out);

}  // namespace tendril::reproduce::torus

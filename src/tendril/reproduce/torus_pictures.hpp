#pragma once
// Pictures of rods on a torus: projected bodies with the pressure in colour and hidden parts faded, and fields along
// the azimuth. Private to the system torus.

#include <string>
#include <vector>

#include "tendril/drawing/figure.hpp"
#include "tendril/reproduce/body_view.hpp"
#include "tendril/reproduce/torus_knot.hpp"

namespace tendril::reproduce::torus {

BodyView torus_view(double epsilon);
/// The torus and the rod on it, coloured by ρ (not at all where ρ vanishes everywhere).
drawing::Panel body(const std::string& title, const BodyView& view, const std::vector<Point>& rod);

/// Offset from the uniform winding, β - ξ/turn, along the azimuth in shares of the whole.
drawing::Curve offset(const std::string& label, int colour, const std::vector<Point>& winding);
/// ρ over `unit`.
drawing::Curve pressure(const std::string& label, int colour, const std::vector<Point>& winding, double unit = 1.0);

}  // namespace tendril::reproduce::torus

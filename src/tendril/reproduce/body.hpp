#pragma once
// Bodies in space as curves on paper: the tube's shade and outline, the rod with its contacts, the forces on it.

#include <functional>

#include "tendril/continuation/result.hpp"
#include "tendril/drawing/figure.hpp"
#include "tendril/geometry/tube.hpp"

namespace tendril::reproduce {

/// A panel without axes, one unit as long in both directions, for a body seen from `view`.
drawing::Panel body_panel(const std::string& title);

/// The tube's wall between S = 0 and `length`: what it covers, its outline, both end circles and its axis.
void add_tube(drawing::Panel& panel, const drawing::View& view, const geometry::Tube& tube, double length);

/// The rod's centreline in black, where it is in contact (gap below `touching`) in vermillion.
void add_rod(drawing::Panel& panel, const drawing::View& view, const continuation::Fields& fields, double touching);

/// An arrow from `tail` along `vector`.
void add_arrow(drawing::Panel& panel, const drawing::View& view, const Eigen::Vector3d& tail,
               const Eigen::Vector3d& vector, const std::string& label = "");

}  // namespace tendril::reproduce

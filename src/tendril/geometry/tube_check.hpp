#pragma once
// Whether a tube can be handled at all: clearance positive everywhere, and clearance times curvature below 1, so that
// neighbouring sections do not meet (C3 > 0 for every β) and the Eulerian map is one-to-one. Overlap of distant parts
// of the tube is not looked for. Sampled between knots and refined at the extremes.

#include <vector>

#include "tendril/geometry/error.hpp"
#include "tendril/geometry/tube.hpp"

namespace tendril::geometry {

struct TubeQuality {
  double length;         // [length]
  double total_bend;     // ∫|R''| dS [rad]
  double curvature_max;  // [1/length]
  double curvature_max_S;
  double curvature_clearance_max;  // largest Q |R''| [-]
  double curvature_clearance_max_S;
  double clearance_min, clearance_min_S;
  double clearance_max, clearance_max_S;
};

/// The table of the tube, and every place that makes it unusable.
TubeQuality measure_tube(const Tube& tube, std::vector<Issue>& issues);

/// The table of a usable tube; throws GeometryError with every place that makes it unusable.
TubeQuality check_tube(const Tube& tube);

}  // namespace tendril::geometry

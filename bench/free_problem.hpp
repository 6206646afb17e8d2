#pragma once
// The twisted clamped rod that sags under its weight, clear of the wall: the free problem that benchmarks and the
// comparison with SciPy share. L = B = 1.

#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/segmentation/problem.hpp"

namespace tendril::bench {

inline segmentation::Problem free_problem(double weight = 20.0) {
  segmentation::Problem p;
  p.tube.axis =
      geometry::make_straight(1.0, Eigen::Vector3d::UnitX(), Eigen::Vector3d::Zero(), Eigen::Vector3d(0, 1, 0));
  p.tube.clearance = geometry::make_constant(0.9);
  p.rod = {1.0, 0.75, 400.0};
  p.load.force = {0.0, 0.0, -weight};
  p.end.kind = segmentation::End::Kind::sleeve;
  p.end_position = 1.0;
  p.axial_value = -5.0;
  p.twist_value = 3.0;
  return p;
}

}  // namespace tendril::bench

#pragma once
// Parts of the system `methods`.

#include <string>

#include "tendril/reproduce/system.hpp"
#include "tendril/segmentation/chain.hpp"

namespace tendril::reproduce::methods {

inline segmentation::Closure at(double p) { return {segmentation::Closure::Kind::parameter, 0, p}; }

inline segmentation::NewtonOptions tight_newton() {
  segmentation::NewtonOptions o;
  o.tolerance = 1e-13;
  return o;
}

inline drawing::Panel panel_of(const std::string& title, const std::string& x, const std::string& y) {
  drawing::Panel p;
  p.title = title;
  p.x_label = x;
  p.y_label = y;
  return p;
}

/// Orders of convergence on uniform meshes, and adaptive knots, for k = 4..7.
void meshes(Outcome& out, const Progress& progress);

}  // namespace tendril::reproduce::methods

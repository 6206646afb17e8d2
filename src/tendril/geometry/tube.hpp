#pragma once
// The tube as the rod's centreline sees it: the normal ringed surface of radius Q(S) around the reference curve.
// Q is the clearance (bore radius minus rod radius inside, sum of the radii outside). Side +1: the rod is inside.

#include <array>
#include <memory>
#include <vector>

#include "tendril/geometry/axis.hpp"

namespace tendril::geometry {

/// Clearance law Q(S) > 0 with four derivatives.
class Clearance {
 public:
  virtual ~Clearance() = default;
  /// Q, Q', Q'', Q''', Q'''' at S  [length^(1-j)]
  virtual std::array<double, 5> at(double S) const = 0;
  /// Interior places where a derivative of Q up to the fourth jumps (ascending).
  virtual const std::vector<double>& knots() const = 0;
};

enum class Side { inside = +1, outside = -1 };

/// Reference curve, clearance and side: everything the mechanics needs to know of the geometry. Value type.
struct Tube {
  std::shared_ptr<const Axis> axis;
  std::shared_ptr<const Clearance> clearance;
  Side side = Side::inside;

  double sign() const { return side == Side::inside ? 1.0 : -1.0; }  // ς of the equations
  double length() const { return axis->length(); }
};

}  // namespace tendril::geometry

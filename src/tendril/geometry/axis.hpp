#pragma once
// The reference curve of a tube: a regular curve R(S) in arc length with a right-handed adapted frame
// (D1, D2, D3 = R'), D_j' = U x D_j (II.2.1). Every frame here is twist free (Bishop, U3 = 0) unless wrapped
// by a frame with its own twist. All quantities are in the case's units; the prime is d/dS.

#include <Eigen/Core>
#include <array>
#include <vector>

namespace tendril::geometry {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// One section of the reference curve.
struct AxisPoint {
  Vec3 position;          // R(S), world                                     [length]
  Mat3 frame;             // columns D1, D2, D3, world                       [-]
  std::array<Vec3, 4> U;  // U, U', U'', U''' , components in D; D_j' = U x D_j   [1/length^(j+1)]
};

/// A reference curve. Implementations are immutable, so evaluation is re-entrant.
class Axis {
 public:
  virtual ~Axis() = default;
  /// Arc length of the whole curve [length]; the curve is defined for 0 <= S <= length().
  virtual double length() const = 0;
  /// Section at S. At a knot the derivatives that jump are those of the right-hand piece.
  virtual AxisPoint at(double S) const = 0;
  /// Interior places (ascending, without 0 and length()) where a derivative of U up to U''' jumps: mesh points of every
  /// solve.
  virtual const std::vector<double>& knots() const = 0;
};

}  // namespace tendril::geometry

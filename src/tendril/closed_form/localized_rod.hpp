#pragma once
// The localized twisted rod: inextensible, weightless, infinitely long, pulled by T along D3 and twisted by M, straight
// far away on both sides. With m = M/√(BT) < 2 and a² = 1 - m²/4 the angle θ to the axis obeys sin(θ/2) = a sech(a √T
// s), and the azimuth of the tangent is ψ = M s/2 + atan(2 a tanh(a √T s)/m) (Coyne 1990; derived anew from F and M + r
// x F being constant). The distance from the axis follows from the moment, r x F = M D3 - M(s). Scaled by B = 1 and a
// length of the caller's choice.

#include <array>

namespace tendril::closed_form {

struct LocalizedRod {
  double pull = 1.0;    // T > 0                          [B/L²]
  double torque = 1.0;  // M, |M| < 2 √T                   [B/L]

  struct Place {
    std::array<double, 3> r, t, t1;  // position (third: along the axis, 0 in the middle), tangent, dt/ds
  };
  Place at(double s) const;
  double decay() const;       // a √T: the rod straightens like exp(-a √T |s|)            [1/L]
  double shortening() const;  // length of the rod minus its distance along the axis: 4 a/√T  [L]
  double steepest() const;    // largest θ, in the middle                                [rad]
  double furthest() const;    // largest distance from the axis, in the middle             [L]
};

}  // namespace tendril::closed_form

#pragma once
// A twistless rod pushed along a straight round tube, clamped on the axis at both ends, in the limit of small clearance
// h: the deflection w = x + iy obeys the linear beam-column B w'''' + P w'' = 0 between its contacts, all of it
// proportional to h, and only the wall is nonlinear. States symmetric under half a turn about a line across the tube's
// middle. Scaled by B = 1 and the tube's length 1; deflections, reactions and slack by h, h and h². Derived here,
// solved by Newton's method with exact derivatives.

namespace tendril::closed_form {

struct SmallClearanceState {
  bool found = false;
  double push = 0.0;    // P                                           [B/L²]
  double place = 0.5;   // of the first contact                        [L]
  double turn = 0.0;    // angle about the axis between the outer contacts  [rad]
  double outer = 0.0;   // reaction of one of the outer contacts, or of the only one   [h B/L⁴ L]
  double middle = 0.0;  // of the one in the middle, three contacts
  double slack = 0.0;   // (rod length - 1)/h²
};

/// One point, in the plane of the rod; slack 2.467 at first contact (P = 4π²).
SmallClearanceState planar_point(double push);
/// The planar point gives way sideways at the antisymmetric Euler load, 80.76 = 2.0457485 * 4π². There the spatial
/// one-point states have one load and any slack from that of the planar state to this, where the point splits in two.
SmallClearanceState spatial_point_splits();
SmallClearanceState two_points(double push);
/// The load at which the middle of the two-point state reaches the wall: 2.9803448 * 4π².
SmallClearanceState third_point_appears();
SmallClearanceState three_points(double push);

}  // namespace tendril::closed_form

#pragma once
// Buckling loads of a straight rod (Euler, Greenhill) and the planar elastica between two walls, ends clamped on the
// axis and free to approach: first touch, point contact turning into line contact, buckling of the flat part.
// Inextensible, weightless, frictionless; B is the bending stiffness, units those of the caller. In the closed forms a
// is the largest slope against the line of thrust of an arc, K and E the complete elliptic integrals of parameter m =
// sin²(a/2), and c = 2 E/K - 1 the ratio of chord to arc. These planar states exist in a round tube too, but need not
// be stable there.

namespace tendril::closed_form {

/// n-th buckling thrust of a rod of length L clamped at both ends: 4π²B/L² (n = 1), 80.76 B/L² (n = 2), ...
double euler_load_clamped(int n, double length, double bending_stiffness);

/// Torque at which a twisted rod under the thrust P (tension negative) buckles: Greenhill's problem,
/// hinged: (M/2B)² + P/B = (π/L)²; clamped: first root of its transcendental condition, M L/B = 8.9868 for P = 0.
double greenhill_torque_hinged(double thrust, double length, double bending_stiffness);
double greenhill_torque_clamped(double thrust, double length, double bending_stiffness);

/// One of the three landmarks of the rod between two walls.
struct PlanarState {
  double slope = 0.0;        // a                                            [rad]
  double clearance = 0.0;    // h: distance of the centreline's wall from the axis  [length]
  double rod_length = 0.0;   // whole rod                                    [length]
  double span = 0.0;         // distance of the clamps                       [length]
  double arc_length = 0.0;   // of one free arc: half the rod before the flat part exists  [length]
  double flat_length = 0.0;  // of the part along the wall                   [length]
  double thrust = 0.0;       // compressive force along the axis             [force]
  double reaction = 0.0;     // of the wall, all together                    [force]
};

/// The rod of length L, bent until its largest slope is a, reaches h = L sin(a/2)/K: F = 16 K² B/L², no reaction yet.
PlanarState first_contact(double slope, double rod_length, double bending_stiffness);
/// The contact point has lost its curvature: h = (L/2) c sin a, F = 64 K² cos a B/L², R = 128 K² sin a B/L².
PlanarState point_to_line(double slope, double rod_length, double bending_stiffness);
/// The flat part buckles: 16 K² cos a B/l² = 4π² B/c_f², h = l c sin a, L = 2 l + c_f. R: the two end forces together.
PlanarState flat_part_buckles(double slope, double rod_length, double bending_stiffness);

/// The same at a given clearance h and span D; the slope follows from h/D (the last: h/D < 0.315).
PlanarState first_contact_at_span(double clearance, double span, double bending_stiffness);
PlanarState point_to_line_at_span(double clearance, double span, double bending_stiffness);
PlanarState flat_part_buckles_at_span(double clearance, double span, double bending_stiffness);

}  // namespace tendril::closed_form

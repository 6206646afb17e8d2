#pragma once
// Strings on surfaces (III.1.50-57) that are known exactly: geodesics of a prolate spheroid (Clairaut), the elastic
// catenary of a vertical plane, which a vertical cylinder carries unrolled, and the heavy string on a sphere by its two
// first integrals. Scaled by a reference tension F0 and a length L.

namespace tendril::closed_form {

/// One oscillation of a geodesic about the equator: ρ cos(angle to the parallel) = const (Clairaut).
struct Oscillation {
  double length = 0.0;     // of the curve
  double longitude = 0.0;  // gained
};
/// Spheroid of equatorial radius a and polar radius b >= a; `latitude` is the largest reduced latitude, in (0, π/2).
Oscillation spheroid_geodesic(double a, double b, double latitude);

/// Hanging string at the reference arc length s from its lowest point: horizontal tension H, weight w per reference
/// length, compliance η̄² = F0/A.
struct Catenary {
  double horizontal_tension = 1.0, weight = 1.0, eta_squared = 0.0;
  double x(double s) const;        // horizontal distance from the lowest point
  double z(double s) const;        // height above it
  double tension(double s) const;  // F_3
};

/// Inextensible string of weight w on the sphere of radius 1, from its lowest point, height z0 and tension F0 there, to
/// the next turning point: F_3 - w z and F_3 ρ² dϑ/ds are constant, so s and ϑ are quadratures over the height.
class SphericalCatenary {
 public:
  SphericalCatenary(double weight, double lowest, double tension);
  double highest() const { return highest_; }
  double length() const { return length_; }
  double longitude() const { return longitude_; }

 private:
  double highest_, length_, longitude_;
};

}  // namespace tendril::closed_form

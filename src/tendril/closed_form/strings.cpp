#include "tendril/closed_form/strings.hpp"

#include <cmath>
#include <numbers>

#include "tendril/closed_form/domain.hpp"
#include "tendril/closed_form/elliptic.hpp"

namespace tendril::closed_form {

Oscillation spheroid_geodesic(double a, double b, double latitude) {
  require(a > 0.0 && std::isfinite(a), "equatorial radius", a, "positive");
  require(b >= a && std::isfinite(b), "polar radius", b, "at least the equatorial radius");
  require(latitude > 0.0 && latitude < 0.5 * std::numbers::pi, "largest reduced latitude", latitude, "in (0, pi/2)");
  // sin u = sin U sin χ turns length and longitude into complete integrals with m/n = 1 - a²/b², n = sin²U
  const double n = std::sin(latitude) * std::sin(latitude), part = 1.0 - (a / b) * (a / b), m = n * part;
  return {4.0 * b * complete_e(m),
          4.0 * std::cos(latitude) * (b / a) * (part * complete_k(m) + (1.0 - part) * complete_pi(n, m))};
}

double Catenary::x(double s) const {
  return eta_squared * horizontal_tension * s +
         horizontal_tension / weight * std::asinh(weight * s / horizontal_tension);
}
double Catenary::z(double s) const {
  return 0.5 * eta_squared * weight * s * s + (tension(s) - horizontal_tension) / weight;
}
double Catenary::tension(double s) const { return std::hypot(horizontal_tension, weight * s); }

SphericalCatenary::SphericalCatenary(double weight, double lowest, double tension) {
  require(weight > 0.0 && std::isfinite(weight), "weight", weight, "positive");
  require(lowest > -1.0 && lowest < 1.0, "lowest height", lowest, "in (-1, 1)");
  require(tension > 0.0 && std::isfinite(tension), "tension at the lowest point", tension, "positive");
  const double moment = tension * std::sqrt(1.0 - lowest * lowest);  // F_3 ρ² dϑ/ds
  const auto pull = [&](double z) { return tension + weight * (z - lowest); };
  // (1 - z²) F_3² - moment² = (z - lowest) cubic(z): dz/ds = 0 at both turning points
  const auto cubic = [&](double z) {
    const double mean = 2.0 * tension + weight * (z - lowest);  // (F_3² - F_0²)/(w (z - z0))
    return (1.0 - z * z) * weight * mean - tension * tension * (z + lowest);
  };
  require(cubic(lowest) > 0.0, "tension at the lowest point", tension, "small enough for the string to rise from it");
  double below = lowest, above = 1.0;  // cubic(1) < 0
  for (int i = 0; i < 200 && below < above; ++i) {
    const double middle = 0.5 * (below + above);
    if (middle == below || middle == above) break;
    (cubic(middle) > 0.0 ? below : above) = middle;
  }
  highest_ = below;
  // z = mean - amplitude cos χ; the trapezoidal rule of an even periodic function converges geometrically
  const double mean = 0.5 * (lowest + highest_), amplitude = 0.5 * (highest_ - lowest);
  const auto trapezoid = [&](int parts, double& length, double& longitude) {
    length = longitude = 0.0;
    for (int i = 0; i < parts; ++i) {
      const double z = mean - amplitude * std::cos((i + 0.5) * std::numbers::pi / parts);
      // cubic(z) = (highest - z) quotient, by divided differences of the cubic at its root
      const double quotient = weight * (2.0 * tension - weight * lowest) * (z + highest_) +
                              weight * weight * (z * z + z * highest_ + highest_ * highest_ - 1.0) + tension * tension;
      const double ds = pull(z) / std::sqrt(quotient) * std::numbers::pi / parts;
      length += ds;
      longitude += moment / (pull(z) * (1.0 - z * z)) * ds;
    }
  };
  double length = 0.0, longitude = 0.0;
  trapezoid(16, length_, longitude_);
  for (int parts = 32; parts <= 1 << 16; parts *= 2) {
    trapezoid(parts, length, longitude);
    const bool same =
        std::abs(length - length_) <= 1e-15 * length && std::abs(longitude - longitude_) <= 1e-15 * longitude;
    length_ = length;
    longitude_ = longitude;
    if (same) break;
  }
}

}  // namespace tendril::closed_form

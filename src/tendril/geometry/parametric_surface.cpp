#include "tendril/geometry/parametric_surface.hpp"

#include <cmath>

namespace tendril::geometry {

SurfacePtr sphere(double radius) { return ellipsoid(radius, radius, radius); }

SurfacePtr cylinder(double radius) {
  return surface_from([radius](const auto& u, const auto& v) {
    using T = std::decay_t<decltype(u)>;
    return Triple<T>{{radius * cos(v), radius * sin(v), u}};
  });
}

SurfacePtr torus(double major, double minor) {
  return surface_from([major, minor](const auto& u, const auto& v) {
    using T = std::decay_t<decltype(u)>;
    const T rho = major + minor * cos(v);
    return Triple<T>{{rho * cos(u), rho * sin(u), minor * sin(v)}};
  });
}

SurfacePtr ellipsoid(double a, double b, double c) {
  return surface_from([a, b, c](const auto& u, const auto& v) {
    using T = std::decay_t<decltype(u)>;
    return Triple<T>{{a * (cos(u) * cos(v)), b * (cos(u) * sin(v)), c * sin(u)}};
  });
}

SurfacePtr vertical_plane() {
  return surface_from([](const auto& u, const auto& v) {
    using T = std::decay_t<decltype(u)>;
    return Triple<T>{{u, T(0.0), v}};
  });
}

}  // namespace tendril::geometry

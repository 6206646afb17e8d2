#include "tendril/geometry/parametric_surface.hpp"

#include <cmath>
#include <initializer_list>

#include "tendril/geometry/error.hpp"

namespace tendril::geometry {

namespace {

struct Named {
  const char* name;
  double value;
};
void check_lengths(std::initializer_list<Named> lengths) {
  std::vector<Issue> issues;
  for (const Named& x : lengths) require_positive(issues, x.name, x.value);
  throw_if_any(std::move(issues));
}

}  // namespace

SurfacePtr sphere(double radius) {
  check_lengths({{"radius", radius}});
  return ellipsoid(radius, radius, radius);
}

SurfacePtr cylinder(double radius) {
  check_lengths({{"radius", radius}});
  return surface_from([radius](const auto& u, const auto& v) {
    using T = std::decay_t<decltype(u)>;
    return Triple<T>{{radius * cos(v), radius * sin(v), u}};
  });
}

SurfacePtr torus(double major, double minor) {
  check_lengths({{"major radius", major}, {"minor radius", minor}});
  if (!(minor < major))
    throw GeometryError({"minor radius", 0.0, minor, major,
                         "is " + number_text(minor) + ", must be smaller than the major radius " + number_text(major),
                         "the tube would meet itself"});
  return surface_from([major, minor](const auto& u, const auto& v) {
    using T = std::decay_t<decltype(u)>;
    const T rho = major + minor * cos(v);
    return Triple<T>{{rho * cos(u), rho * sin(u), minor * sin(v)}};
  });
}

SurfacePtr ellipsoid(double a, double b, double c) {
  check_lengths({{"semi-axis a", a}, {"semi-axis b", b}, {"semi-axis c", c}});
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

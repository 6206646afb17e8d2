// Parametric surfaces: automatic derivatives against closed forms and against a surface given by its own derivatives;
// invariants of a direction against the printed fundamental-form formulas and against the surfaces' known curvatures.
#include <gtest/gtest.h>

#include <cmath>

#include "tendril/geometry/surface_direction.hpp"

namespace tendril::geometry {
namespace {

constexpr double rounding = 1e-13;

/// A skew graph (F != 0): z = 0.3 sin x cos 2y + 0.1 x y.
SurfacePtr wavy() {
  return graph([](const auto& x, const auto& y) { return 0.3 * (sin(x) * cos(2.0 * y)) + 0.1 * (x * y); });
}

SurfacePtr cone_by_derivatives() {  // radius 0.4 u, by hand
  return surface_from_derivatives([](const auto& u, const auto& v) {
    using T = std::decay_t<decltype(u)>;
    const T c = 0.4 * cos(v), s = 0.4 * sin(v), zero(0.0);
    return SecondOrder<T>{{Triple<T>{{u * c, u * s, u}}, Triple<T>{{c, s, T(1.0)}}, Triple<T>{{-(u * s), u * c, zero}},
                           Triple<T>{{zero, zero, zero}}, Triple<T>{{-s, c, zero}},
                           Triple<T>{{-(u * c), -(u * s), zero}}}};
  });
}

TEST(ParametricSurface, DerivativesByHandAndAutomaticallyAgree) {
  const auto automatic = surface_from([](const auto& u, const auto& v) {
    using T = std::decay_t<decltype(u)>;
    return Triple<T>{{0.4 * (u * cos(v)), 0.4 * (u * sin(v)), u}};
  });
  const auto a = automatic->patch(1.3, 0.7), b = cone_by_derivatives()->patch(1.3, 0.7);
  for (std::size_t n = 0; n < a.partial.size(); ++n)
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(a.partial[n][k], b.partial[n][k], rounding) << n << ' ' << k;
}

TEST(ParametricSurface, FunctionsAndTheirFourthDerivatives) {
  const auto p = surface_from([](const auto& u, const auto& v) {
                   using T = std::decay_t<decltype(u)>;
                   return Triple<T>{{exp(u * v), sqrt(u) / v, sin(u) * cos(v)}};
                 })->patch(1.2, 0.7);
  const double u = 1.2, v = 0.7, e = std::exp(u * v);
  EXPECT_NEAR(p(2, 2)[0], e * (2.0 + 4.0 * u * v + u * u * v * v), 1e-12);
  EXPECT_NEAR(p(3, 1)[1], -0.375 * std::pow(u, -2.5) / (v * v), 1e-12);
  EXPECT_NEAR(p(1, 3)[2], std::cos(u) * std::sin(v), rounding);
  EXPECT_NEAR(p(0, 4)[2], std::sin(u) * std::cos(v), rounding);
}

TEST(ParametricSurface, KnownCurvatures) {
  const auto at = [](const SurfacePtr& s, double u, double v, double theta) {
    return surface_direction<double>(lift(s->patch(u, v), u, v), theta);
  };
  const double theta = 0.8, c2 = std::cos(theta) * std::cos(theta), s2 = std::sin(theta) * std::sin(theta);
  const double sc = std::sin(theta) * std::cos(theta);
  auto d = at(sphere(2.0), 0.4, 1.1, theta);  // N inward
  EXPECT_NEAR(d.kappa_n, 0.5, rounding);
  EXPECT_NEAR(d.tau_g, 0.0, rounding);
  EXPECT_NEAR(d.kappa_n_along, 0.0, rounding);
  d = at(cylinder(0.5), 0.4, 1.1, theta);  // (III.1.21-22): 0 along u, 2 along v, N inward
  EXPECT_NEAR(d.kappa_n, 2.0 * s2, rounding);
  EXPECT_NEAR(d.tau_g, 2.0 * sc, rounding);
  EXPECT_NEAR(d.geodesic_turning, 0.0, rounding);
  const double v = 0.9, rho = 1.0 + 0.3 * std::cos(v);
  d = at(torus(1.0, 0.3), 0.2, v, theta);  // N outward
  const double k1 = -std::cos(v) / rho, k2 = -1.0 / 0.3;
  EXPECT_NEAR(d.kappa_n, k1 * c2 + k2 * s2, rounding);
  EXPECT_NEAR(d.tau_g, (k2 - k1) * sc, rounding);
}

TEST(ParametricSurface, DirectionAgreesWithThePrintedFormulas) {
  // A curve of given κ_g through a point of every kind of surface: u', v' from the direction, u'', v'' from its slope
  // by dual numbers, then (III.1.13-19).
  const double kappa_g = 0.7;
  for (const auto& s : {wavy(), torus(1.0, 0.3), ellipsoid(1.0, 0.8, 0.6), cone_by_derivatives(), cylinder(0.7)}) {
    const double u = 0.6, v = 0.3, theta = 2.1;
    const auto patch = s->patch(u, v);
    const auto d = surface_direction<double>(lift(patch, u, v), theta);
    using D = numerics::Dual<1>;
    const D du = D::seed(u, 0, d.u_rate), dv = D::seed(v, 0, d.v_rate);
    const auto along = surface_direction<D>(lift(patch, du, dv), D::seed(theta, 0, kappa_g + d.geodesic_turning));
    const auto c = curve_invariants(patch, d.u_rate, d.v_rate, along.u_rate.d[0], along.v_rate.d[0]);
    EXPECT_NEAR(c.kappa_g, kappa_g, 1e-12);
    EXPECT_NEAR(c.kappa_n, d.kappa_n, 1e-12);
    EXPECT_NEAR(c.tau_g, d.tau_g, 1e-12);
    // κ_n' = geodesic part + 2 κ_g τ_g, and the Darboux equations (III.1.10-12)
    EXPECT_NEAR(along.kappa_n.d[0], d.kappa_n_along + 2.0 * kappa_g * d.tau_g, 1e-12);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(along.t[k].d[0], kappa_g * d.g[k] + d.kappa_n * d.N[k], 1e-12);
      EXPECT_NEAR(along.g[k].d[0], -kappa_g * d.t[k] + d.tau_g * d.N[k], 1e-12);
      EXPECT_NEAR(along.N[k].d[0], -d.kappa_n * d.t[k] - d.tau_g * d.g[k], 1e-12);
    }
    // any parameter: u(3 s), with acceleration along the curve
    const auto faster = curve_invariants(patch, 3.0 * d.u_rate, 3.0 * d.v_rate, 9.0 * along.u_rate.d[0] + d.u_rate,
                                         9.0 * along.v_rate.d[0] + d.v_rate);
    EXPECT_NEAR(faster.kappa_g, kappa_g, 1e-12);
  }
}

}  // namespace
}  // namespace tendril::geometry

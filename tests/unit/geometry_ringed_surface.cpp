// Forms and curvatures of normal ringed surfaces: against world-frame differences on a general tube (Q' and U3 not 0),
// and closed forms on cylinder, sphere and torus (model section 7).

#include <gtest/gtest.h>

#include <numbers>

#include "geometry_checks.hpp"
#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/axis_transforms.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/geometry/ringed_surface.hpp"

namespace {

using namespace tendril::geometry;
using geometry_checks::slope;

constexpr double kRounding = 1e-13;   // some hundred operations
constexpr double kDifference = 2e-8;  // second differences of order six at h = 5e-3: eps/h² = 1e-11, (3h)^6 = 1e-11

Vec3 eigen(const Triple<double>& a) { return {a[0], a[1], a[2]}; }

struct General {
  AxisPtr axis = with_frame_twist(make_helix(0.8, 0.9, 3.0), [](double S) {
    return std::array<double, 5>{std::sin(S), std::cos(S), -std::sin(S), -std::cos(S), std::sin(S)};
  });
  static std::array<double, 5> Q(double S) {
    const double a = 0.2, b = 0.1, w = 1.5;
    return {a + b * std::sin(w * S), b * w * std::cos(w * S), -b * w * w * std::sin(w * S),
            -b * w * w * w * std::cos(w * S), b * w * w * w * w * std::sin(w * S)};
  }
  static double beta(double S) { return 0.4 + 2 * S + 0.3 * S * S - 0.1 * S * S * S; }
  static double beta1(double S) { return 2 + 0.6 * S - 0.3 * S * S; }
  static double beta2(double S) { return 0.6 - 0.6 * S; }

  Vec3 surface(double S, double b) const {
    const auto p = axis->at(S);
    return p.position + Q(S)[0] * (std::cos(b) * p.frame.col(0) + std::sin(b) * p.frame.col(1));
  }
  Vec3 normal(double S, double b, double h) const {  // outward: S_β x S_ξ
    const Vec3 along = slope([&](double s) { return surface(s, b); }, S, h);
    const Vec3 round = slope([&](double x) { return surface(S, x); }, b, h);
    return round.cross(along).normalized();
  }
  RingedSurface<double> at(double S) const { return {ring_section(axis->at(S), Q(S)), beta(S)}; }
};

TEST(GeometryRingedSurface, FormsAgreeWithDifferencesOnAGeneralTube) {
  const General tube;
  const double h = 5e-3;
  for (double S : {0.4, 1.3, 2.4}) {
    const double b = General::beta(S);
    const auto m = tube.at(S);
    const auto D = tube.axis->at(S).frame;
    const auto along = [&](double s, double x) { return slope([&](double u) { return tube.surface(u, x); }, s, h); };
    const auto round = [&](double s, double x) { return slope([&](double u) { return tube.surface(s, u); }, x, h); };
    const Vec3 S1 = along(S, b), Sb = round(S, b), N = tube.normal(S, b, h);
    EXPECT_LT((D * eigen(m.S1) - S1).norm(), kDifference);
    EXPECT_LT((D * eigen(m.Sb) - Sb).norm(), kDifference);
    EXPECT_LT((D * eigen(m.N) - N).norm(), kDifference);
    const Vec3 away = tube.surface(S, b) - tube.axis->at(S).position;
    EXPECT_GT(N.dot(away), 0.0);
    const Vec3 S11 = slope([&](double s) { return along(s, b); }, S, h);
    const Vec3 S1b = slope([&](double s) { return round(s, b); }, S, h);
    const Vec3 S111 = slope(
        [&](double s) {
          return Vec3(tube.axis->at(s).frame *
                      eigen(RingedSurface<double>(ring_section(tube.axis->at(s), General::Q(s)), b).S11));
        },
        S, h);
    EXPECT_LT((D * eigen(m.S11) - S11).norm(), kDifference);
    EXPECT_LT((D * eigen(m.S1b) - S1b).norm(), kDifference);
    EXPECT_LT((D * eigen(m.S111) - S111).norm(), kDifference);
    EXPECT_NEAR(m.E, S1.dot(S1), kDifference);
    EXPECT_NEAR(m.F, S1.dot(Sb), kDifference);
    EXPECT_NEAR(m.G, Sb.dot(Sb), kDifference);
    EXPECT_NEAR(m.e, S11.dot(N), kDifference);
    EXPECT_NEAR(m.f, S1b.dot(N), kDifference);
    EXPECT_NEAR(m.g, eigen(m.Sbb).dot(eigen(m.N)), kRounding);
  }
}

TEST(GeometryRingedSurface, CurveInvariantsAgreeWithDifferencesOnAGeneralTube) {
  const General tube;
  const double h = 5e-3;
  for (double S : {0.4, 1.3, 2.4}) {
    const CurveOnTube<double> curve(tube.at(S), General::beta1(S), General::beta2(S));
    const auto D = tube.axis->at(S).frame;
    const auto r = [&](double s) { return tube.surface(s, General::beta(s)); };
    const Vec3 dr = slope(r, S, h), ddr = slope([&](double s) { return slope(r, s, h); }, S, h);
    const double J = 1.0 / dr.norm();
    const Vec3 t = J * dr, N = tube.normal(S, General::beta(S), h), gv = N.cross(t);
    const Vec3 curvature = J * J * (ddr - ddr.dot(t) * t);
    const Vec3 dN = slope([&](double s) { return tube.normal(s, General::beta(s), h); }, S, h);
    EXPECT_NEAR(curve.Jbar1, J, kDifference);
    EXPECT_LT((D * eigen(curve.t) - t).norm(), kDifference);
    EXPECT_LT((D * eigen(curve.gv) - gv).norm(), kDifference);
    EXPECT_NEAR(curve.kappa_n, curvature.dot(N), kDifference);
    EXPECT_NEAR(curve.kappa_g, curvature.dot(gv), kDifference);
    EXPECT_NEAR(curve.tau_g, -J * dN.dot(gv), kDifference);
    using Number = Eigen::Matrix<double, 1, 1>;
    const Number dkappa_n = slope(
        [&](double s) { return Number(CurveOnTube<double>(tube.at(s), General::beta1(s), General::beta2(s)).kappa_n); },
        S, h);
    EXPECT_NEAR(curve.dkappa_n, dkappa_n[0], kDifference);
    const auto m = tube.at(S);
    EXPECT_LT((eigen(curve.gv) - curve.x * eigen(m.S1) - curve.y * eigen(m.Sb)).norm(), kRounding);
    EXPECT_NEAR(second_angle_derivative<double>(m, curve, curve.kappa_g), General::beta2(S), kRounding);
  }
}

RingSection<double> straight_section(double Q, double dQ = 0, double ddQ = 0, double dddQ = 0) {
  const Triple<double> zero{{0, 0, 0}};
  return {zero, zero, zero, Q, dQ, ddQ, dddQ};
}

TEST(GeometryRingedSurface, HelixOnACylinder) {
  const double Q = 0.4, theta = 0.6;
  const CurveOnTube<double> curve(RingedSurface<double>(straight_section(Q), 1.1), std::tan(theta) / Q, 0.0);
  EXPECT_NEAR(curve.kappa_n, -std::pow(std::sin(theta), 2) / Q, kRounding);
  EXPECT_NEAR(curve.tau_g, std::sin(theta) * std::cos(theta) / Q, kRounding);
  EXPECT_NEAR(curve.kappa_g, 0.0, kRounding);
  EXPECT_NEAR(curve.Jbar1, std::cos(theta), kRounding);
  EXPECT_NEAR(curve.dkappa_n, 0.0, kRounding);
}

TEST(GeometryRingedSurface, SphereIsRingedByItsParallels) {
  for (double S : {-0.6, 0.1, 0.7}) {
    const double Q = std::sqrt(1 - S * S), dQ = -S / Q, ddQ = -1 / (Q * Q * Q), dddQ = -3 * S / std::pow(Q, 5);
    const RingedSurface<double> sphere(straight_section(Q, dQ, ddQ, dddQ), 0.9);
    EXPECT_NEAR(sphere.N[2], S, kRounding);
    for (double b1 : {-2.0, 0.0, 0.7}) {
      const CurveOnTube<double> curve(sphere, b1, 0.3);
      EXPECT_NEAR(curve.kappa_n, -1.0, kRounding);
      EXPECT_NEAR(curve.tau_g, 0.0, kRounding);
      EXPECT_NEAR(curve.dkappa_n, 0.0, 10 * kRounding);
    }
  }
}

TEST(GeometryRingedSurface, VillarceauCirclesAndParallelsOfTheTorus) {
  const auto torus = make_torus(1.0, Vec3(1, 0, 0));  // D1 = e_r
  const double eps = 0.35, root = std::sqrt(1 - eps * eps);
  const std::array<double, 5> Q{eps, 0, 0, 0, 0};
  for (double xi : {0.4, 1.9, -1.2}) {
    for (double hand : {1.0, -1.0}) {
      const double beta = hand * 2 * std::atan(std::sqrt((1 + eps) / (1 - eps)) * std::tan(xi / 2));
      const double b1 = hand * (1 + eps * std::cos(beta)) / root, b2 = -hand * eps * std::sin(beta) * b1 / root;
      const CurveOnTube<double> curve(RingedSurface<double>(ring_section(torus->at(xi), Q), beta), b1, b2);
      EXPECT_NEAR(curve.kappa_g, -hand * std::sin(xi), kRounding);
      EXPECT_NEAR(curve.kappa_n, -std::cos(xi), kRounding);
      EXPECT_NEAR(curve.tau_g, hand * (1 - eps * std::cos(xi)) / root, kRounding);
      EXPECT_NEAR(curve.Jbar1, (1 - eps * std::cos(xi)) / root, kRounding);
      EXPECT_NEAR(curve.dkappa_n, std::sin(xi), kRounding);
    }
  }
  const CurveOnTube<double> parallel(RingedSurface<double>(ring_section(torus->at(0.3), Q), 0.8), 0.0, 0.0);
  EXPECT_NEAR(parallel.kappa_g, -std::sin(0.8) / (1 + eps * std::cos(0.8)), kRounding);
  EXPECT_NEAR(parallel.kappa_n, -std::cos(0.8) / (1 + eps * std::cos(0.8)), kRounding);
}

TEST(GeometryRingedSurface, InvariantsDoNotDependOnTheFrame) {
  // The same curve described in frames turned by γ(S): β -> β - γ.
  const auto bishop = make_helix(0.8, 0.9, 3.0);
  const General turned;  // γ = sin S
  for (double S : {0.3, 2.0}) {
    const double b = General::beta(S) + std::sin(S), b1 = General::beta1(S) + std::cos(S),
                 b2 = General::beta2(S) - std::sin(S);
    const CurveOnTube<double> one(turned.at(S), General::beta1(S), General::beta2(S));
    const CurveOnTube<double> two(RingedSurface<double>(ring_section(bishop->at(S), General::Q(S)), b), b1, b2);
    EXPECT_NEAR(one.kappa_n, two.kappa_n, kRounding);
    EXPECT_NEAR(one.kappa_g, two.kappa_g, kRounding);
    EXPECT_NEAR(one.tau_g, two.tau_g, kRounding);
    EXPECT_NEAR(one.dkappa_n, two.dkappa_n, 10 * kRounding);
  }
}

// Smallest dual number, to prove that other scalar types pass through.
struct Dual {
  double v, d;
  explicit Dual(double value = 0.0, double slope = 0.0) : v(value), d(slope) {}
  friend Dual operator+(Dual a, Dual b) { return Dual(a.v + b.v, a.d + b.d); }
  friend Dual operator-(Dual a, Dual b) { return Dual(a.v - b.v, a.d - b.d); }
  friend Dual operator-(Dual a) { return Dual(-a.v, -a.d); }
  friend Dual operator*(Dual a, Dual b) { return Dual(a.v * b.v, a.v * b.d + a.d * b.v); }
  friend Dual operator/(Dual a, Dual b) { return Dual(a.v / b.v, (a.d * b.v - a.v * b.d) / (b.v * b.v)); }
  friend Dual sqrt(Dual a) { return Dual(std::sqrt(a.v), a.d / (2 * std::sqrt(a.v))); }
  friend Dual sin(Dual a) { return Dual(std::sin(a.v), std::cos(a.v) * a.d); }
  friend Dual cos(Dual a) { return Dual(std::cos(a.v), -std::sin(a.v) * a.d); }
};

TEST(GeometryRingedSurface, DualNumbersAlongTheCurveGiveTheDerivativeOfTheNormalCurvature) {
  const General tube;
  const double S = 1.1;
  const auto p = tube.axis->at(S);
  const auto Q = General::Q(S);
  const auto with_slope = [](const Vec3& a, const Vec3& da) {
    return Triple<Dual>{{Dual(a[0], da[0]), Dual(a[1], da[1]), Dual(a[2], da[2])}};
  };
  const RingSection<Dual> section{with_slope(p.U[0], p.U[1]),
                                  with_slope(p.U[1], p.U[2]),
                                  with_slope(p.U[2], p.U[3]),
                                  Dual(Q[0], Q[1]),
                                  Dual(Q[1], Q[2]),
                                  Dual(Q[2], Q[3]),
                                  Dual(Q[3], Q[4])};
  const double b1 = General::beta1(S), b2 = General::beta2(S), b3 = -0.6;
  const CurveOnTube<Dual> dual(RingedSurface<Dual>(section, Dual(General::beta(S), b1)), Dual(b1, b2), Dual(b2, b3));
  const CurveOnTube<double> curve(tube.at(S), b1, b2);
  EXPECT_NEAR(dual.kappa_n.v, curve.kappa_n, kRounding);
  EXPECT_NEAR(dual.kappa_n.d, curve.dkappa_n, kRounding);
}

}  // namespace

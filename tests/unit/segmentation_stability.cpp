// Stability on the contact pattern: Euler's and Greenhill's loads, and the one-point state of a straight round tube.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/segmentation/stability.hpp"

namespace {

using namespace tendril;
using formulation::Vector6;
using segmentation::StabilityProblem;
constexpr double pi = std::numbers::pi;

StabilityProblem straight(double clearance) {
  StabilityProblem p;
  p.tube = {geometry::make_straight(3.0), geometry::make_constant(3.0 * clearance)};  // scaled length 1
  p.eccentricity = [](double) -> Vector6 { return Vector6::Zero(); };
  return p;
}

double critical(const std::function<bool(double)>& stable, double low, double high) {
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Cubic elements: eigenvalues are high by (kh)^4/720.
constexpr double discretisation = 2e-6;

TEST(Stability, EulerClampedClamped) {
  for (const double eta2 : {0.0, 1e-4}) {
    auto p = straight(0.05);
    p.data.eta2 = eta2;
    const auto load = critical(
        [&](double P) {
          p.lambda = -P + 0.5 * eta2 * P * P;
          return segmentation::stability(p).negative_held_length == 0;
        },
        20.0, 60.0);
    // Compressed by α = 1 - η²P, curvature per unstressed length: α w'''' + P w'' = 0 over the held span.
    EXPECT_NEAR(load / (1.0 - eta2 * load) / (4.0 * pi * pi), 1.0, discretisation);
    p.lambda = -1.01 * load + 0.5 * eta2 * std::pow(1.01 * load, 2);
    EXPECT_EQ(segmentation::stability(p).negative_held_length, 2);  // any direction
  }
}

TEST(Stability, EulerPinned) {
  auto p = straight(0.05);
  p.start.pinned = p.end.pinned = true;
  const auto load =
      critical([&](double P) { return p.lambda = -P, segmentation::stability(p).negative_dead_push == 0; }, 5, 20);
  EXPECT_NEAR(load / (pi * pi), 1.0, discretisation);
}

// Greenhill's problem with clamped ends and a held torque, no thrust: tan(M/2) = M/2.
TEST(Stability, TorqueClampedClamped) {
  auto p = straight(0.05);
  const auto torque =
      critical([&](double M) { return p.torque = M, segmentation::stability(p).negative_held_length == 0; }, 5, 12);
  EXPECT_NEAR(torque / 8.98681891, 1.0, discretisation * 10.0);  // the third derivative enters: the constant is larger
}

// Planar one-point state of small clearance: between the clamp and the wall w = A(1 - cos kS) + B(kS - sin kS), w(1/2)
// = h, w'(1/2) = 0, in a tilted plane so that nothing rests on D1.
StabilityProblem one_point(double load, double h) {
  auto p = straight(h);
  const double k = std::sqrt(load), c = std::cos(0.5 * k), s = std::sin(0.5 * k);
  // [1-c, k/2-s; s, 1-c] [A; B] = [h; 0]
  const double det = (1 - c) * (1 - c) - s * (0.5 * k - s), A = h * (1 - c) / det, B = -h * s / det;
  p.lambda = -load + 0.5 * std::pow(k * k * A, 2);  // H at the clamp: F3 = -load there
  p.eccentricity = [=](double S) -> Vector6 {
    const double x = S < 0.5 ? S : 1.0 - S, sign = S < 0.5 ? 1.0 : -1.0, C = std::cos(k * x), Z = std::sin(k * x);
    const double w = A * (1 - C) + B * (k * x - Z), w1 = sign * k * (A * Z + B * (1 - C)), w2 = k * k * (A * C + B * Z);
    Vector6 v;
    v << 0.8 * w, 0.8 * w1, 0.8 * w2, 0.6 * w, 0.6 * w1, 0.6 * w2;
    return v;
  };
  p.points = {{0.5, 2.0 * std::abs(k * k * k * (-A * s + B * c))}};
  p.rotation_free = true;
  return p;
}

// Out of plane it holds up to 2.0457485 * 4π²: clamped, a node at the contact.
TEST(Stability, OnePointStateLeavesItsPlane) {
  const double h = 1e-4;
  const auto load =
      critical([&](double P) { return segmentation::stability(one_point(P, h)).negative_held_length == 0; },
               1.2 * 4 * pi * pi, 3 * 4 * pi * pi);
  EXPECT_NEAR(load / (4.0 * pi * pi), 2.0457485, 1e-5);  // clearance squared, elements
  // With the rotation left in, its own eigenvalue is zero up to the clearance squared and the count is the same.
  auto p = one_point(1.7 * 4 * pi * pi, h);
  p.rotation_free = false;
  const auto r = segmentation::stability(p);
  EXPECT_EQ(r.negative_held_length, 0);
  EXPECT_NEAR(r.lowest, 0.0, 1e-3);  // of eigenvalues of size 5000
}

// Above that load one mode leaves the plane; within it the contact slides along the wall, R̂ (v_n')²/g'' outweighs the
// thrust and the planar state stays a minimum until the curvature limit at 4 * 4π².
TEST(Stability, SlidingContactHoldsInThePlane) {
  for (const double load : {2.2, 3.0, 3.9})
    EXPECT_EQ(segmentation::stability(one_point(load * 4 * pi * pi, 1e-4)).negative_held_length, 1);
}

// A heavy rod on the bottom of a horizontal tube, pinned: P = min over n of (nπ)² + w/(Q(nπ)²) (Dawson and Paslay).
TEST(Stability, LyingRodSnakes) {
  const double w = 4000.0, Q = 0.01;
  auto p = straight(Q);
  p.data.body_force = {-w, 0.0, 0.0};
  p.start.pinned = p.end.pinned = true;
  p.eccentricity = [=](double) -> Vector6 { return (Vector6() << -Q, 0, 0, 0, 0, 0).finished(); };
  p.lines = {{0.0, 1.0, 0.0, 0.0, [=](double) { return w; }}};
  double exact = 1e300;
  for (int n = 1; n < 20; ++n) exact = std::min(exact, n * n * pi * pi + w / (Q * n * n * pi * pi));
  const auto load = critical(
      [&](double P) {
        p.lambda = -P + w * Q;  // F3 + σ·r
        return segmentation::stability(p).negative_dead_push == 0;
      },
      0.3 * exact, 2.0 * exact);
  EXPECT_NEAR(load / exact, 1.0, 50.0 * discretisation);  // eight half waves: (kh)^4 is larger
}

}  // namespace

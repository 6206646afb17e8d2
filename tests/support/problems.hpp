#pragma once
// Problems that several tests solve: the helical conduit of the thesis (chapter V; L = B = 1), and a stream of random
// problems of everyday size, each from its own seed.

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/geometry/fitted_axes.hpp"
#include "tendril/geometry/tube_check.hpp"
#include "tendril/segmentation/problem.hpp"

namespace tendril::test {

using Eigen::Vector3d;
using segmentation::End;
using segmentation::Problem;
using segmentation::Scalar;
constexpr double pi = std::numbers::pi;

namespace conduit {

constexpr double pitch = pi / 4, eta = 1.0 / 20, torque = -1.0;
inline const double radius = 1 / (pi * std::numbers::sqrt2);
inline const double torsion = std::sin(pitch) * std::cos(pitch) / radius;
/// The end force at which the rod follows the axis without the wall: F3 = τ(M3 - τ)/(1 + η²τ²).
inline const double T0 = torsion * (torque - torsion) / (1 + eta * eta * torsion * torsion);

/// Clamped on the axis, a sleeve on the axis at the far end, F3(1) = T. D1 is the Frenet normal in the middle.
inline Problem problem(double clearance, double T) {
  const double half = 0.5 * torsion;
  const Vector3d normal(-1, 0, 0), binormal(0, -std::cos(pitch), std::sin(pitch));
  Problem p;
  p.tube.axis = geometry::make_helix(radius, pitch, 1.0, std::cos(half) * normal + std::sin(half) * binormal);
  p.tube.clearance = geometry::make_constant(clearance);
  p.rod = {1.0, 0.75, 1 / (eta * eta)};
  p.end.kind = End::Kind::sleeve;
  p.end_position = 1.0;
  p.axial_value = Scalar(T, 1.0);
  p.twist_value = torque;
  return p;
}

}  // namespace conduit

/// Uniform numbers that are the same with every standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed * 0x9E3779B97F4A7C15ull + 1) {}
  double between(double a, double b) { return a + (b - a) * (static_cast<double>(engine_() >> 11) * 0x1.0p-53); }
  bool chance(double p) { return between(0, 1) < p; }
  Vector3d direction() {
    const double z = between(-1, 1), a = between(-pi, pi), r = std::sqrt(1 - z * z);
    return {r * std::cos(a), r * std::sin(a), z};
  }

 private:
  std::mt19937_64 engine_;
};

/// A curve of about unit length whose heading wanders: angles are sums of three harmonics.
inline std::vector<Vector3d> wandering_points(Dice& dice, double bend) {
  std::array<double, 3> a{}, b{}, pa{}, pb{};
  for (int k = 0; k < 3; ++k) {
    a[k] = dice.between(-bend, bend) / (k + 1);
    b[k] = dice.between(-bend, bend) / (k + 1);
    pa[k] = dice.between(0, 2 * pi);
    pb[k] = dice.between(0, 2 * pi);
  }
  constexpr int points = 17, fine = 40;
  std::vector<Vector3d> out{Vector3d::Zero()};
  Vector3d r = Vector3d::Zero();
  for (int i = 0; i < (points - 1) * fine; ++i) {
    const double t = (i + 0.5) / ((points - 1) * fine);
    double x = 0, y = 0;
    for (int k = 0; k < 3; ++k) {
      x += a[k] * std::sin(pi * (k + 1) * t + pa[k]);
      y += b[k] * std::sin(pi * (k + 1) * t + pb[k]);
    }
    r += Vector3d(std::sin(x), std::cos(x) * std::sin(y), std::cos(x) * std::cos(y)) / ((points - 1) * fine);
    if ((i + 1) % fine == 0) out.push_back(r);
  }
  return out;
}

struct RandomProblem {
  Problem problem;
  std::string words;  // what it is, for messages
};

/// Seeded problem with unit bending stiffness and an axis of about unit length: helix, arc or spline, clearance 0.01 to
/// 0.05, end force -60..60, torque -3..3, weight up to 200 (or none), extensible or not, one in five outside. Ends on
/// the axis (outside: a little off the wall), without slope.
inline RandomProblem random_problem(std::uint64_t seed) {
  Dice dice(seed);
  std::ostringstream words;
  words.precision(6);
  for (;;) {
    Problem p;
    words.str("");
    words << "seed " << seed << ": ";
    const double kind = dice.between(0, 3);
    if (kind < 1) {
      const double bend = dice.between(0.6, 6), angle = dice.between(0.2, 1.3) * (dice.chance(0.5) ? 1 : -1);
      const double curvature = bend, r = std::pow(std::sin(angle), 2) / curvature;
      p.tube.axis = geometry::make_helix(r, angle, 1.0);
      words << "helix r=" << r << " angle=" << angle;
    } else if (kind < 2) {
      const double r = dice.between(0.25, 2);
      p.tube.axis = geometry::make_arc(r, 1.0);
      words << "arc r=" << r;
    } else {
      p.tube.axis = geometry::make_points(wandering_points(dice, dice.between(0.3, 1.2))).axis;
      words << "spline bend";
    }
    const double Q = dice.between(0.01, 0.05);
    p.tube.clearance = geometry::make_constant(Q);
    p.tube.side = dice.chance(0.2) ? geometry::Side::outside : geometry::Side::inside;
    const bool outside = p.tube.side == geometry::Side::outside;
    const double T = outside ? dice.between(0, 60) : dice.between(-60, 60), M = dice.between(-3, 3);
    p.rod.torsional_stiffness = dice.between(0.6, 1.0);
    if (dice.chance(0.5)) p.rod.axial_stiffness = dice.between(500, 20000);
    const double weight = dice.chance(0.5) ? dice.between(0, 200) : 0.0;
    p.load.force = weight * dice.direction();
    p.end.kind = End::Kind::sleeve;
    p.end_position = p.tube.length();
    p.axial_value = T;
    p.twist_value = M;
    if (outside) {
      const double angle = dice.between(-pi, pi);
      for (End* e : {&p.start, &p.end}) {
        e->eccentricity[0] = 1.2 * Q * std::cos(angle);
        e->eccentricity[1] = 1.2 * Q * std::sin(angle);
      }
    }
    const auto quality = geometry::check_tube(p.tube);
    if (quality.curvature_clearance_max > 0.3) continue;
    words << ", bend " << quality.total_bend << ", Q " << Q << ", " << (outside ? "outside" : "inside") << ", T " << T
          << ", M3 " << M << ", weight " << weight
          << (p.rod.axial_stiffness ? ", EA " + std::to_string(*p.rod.axial_stiffness) : ", inextensible");
    return {p, words.str()};
  }
}

}  // namespace tendril::test

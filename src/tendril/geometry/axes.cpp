#include "tendril/geometry/axes.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tendril/geometry/error.hpp"

namespace tendril::geometry {

namespace {

// Curve of constant curvature κ and torsion τ from the Frenet triad (n0, b0, t0) at R0: the triad turns at the rate of
// the Darboux vector τ t + κ b, fixed in space.
class ConstantCurvatureAxis final : public Axis {
 public:
  ConstantCurvatureAxis(const Vec3& R0, const Mat3& frenet, double kappa, double tau, double length, double phi0)
      : R0_(R0),
        frenet_(frenet),
        kappa_(kappa),
        tau_(tau),
        rate_(std::hypot(kappa, tau)),
        length_(length),
        phi0_(phi0) {}

  double length() const override { return length_; }
  const std::vector<double>& knots() const override { return knots_; }

  AxisPoint at(double S) const override {
    // Rotation by χ = rate S about the Darboux vector, in components along (n0, b0, t0); the divided forms
    // (1 - cos χ)/rate² and (S - sin χ/rate)/rate² stay finite on the straight line.
    const double chi = rate_ * S;
    const double sine = rate_ > 0.0 ? std::sin(chi) / rate_ : S;
    const double half = rate_ > 0.0 ? std::sin(0.5 * chi) / (0.5 * rate_) : S;
    const double versine = 0.5 * half * half;
    const double rest = chi * chi < 1e-8 ? S * S * S / 6.0 : (S - sine) / (rate_ * rate_);
    const double k = kappa_, w = tau_;
    const Vec3 position(k * versine, k * w * rest, S - k * k * rest);
    const Vec3 t(k * sine, k * w * versine, 1.0 - k * k * versine);
    const Vec3 n(1.0 - rate_ * rate_ * versine, w * sine, -k * sine);

    const double phi = phi0_ - tau_ * S;  // Bishop: D1 = cosΦ n + sinΦ b, Φ' = -τ
    const double c = std::cos(phi), s = std::sin(phi);
    const Vec3 b = t.cross(n);
    AxisPoint point;
    point.position = R0_ + frenet_ * position;
    point.frame.col(0) = frenet_ * (c * n + s * b);
    point.frame.col(1) = frenet_ * (c * b - s * n);
    point.frame.col(2) = frenet_ * t;
    const double k1 = k * w, k2 = k1 * w, k3 = k2 * w;
    point.U = {Vec3(k * s, k * c, 0.0), Vec3(-k1 * c, k1 * s, 0.0), Vec3(-k2 * s, -k2 * c, 0.0),
               Vec3(k3 * c, -k3 * s, 0.0)};
    return point;
  }

 private:
  Vec3 R0_;
  Mat3 frenet_;  // columns n0, b0, t0
  double kappa_, tau_, rate_, length_, phi0_;
  std::vector<double> knots_;
};

// Frame (n, b, t) with n the default normal; Φ(0) from the wished one.
AxisPtr constant_curvature(const Vec3& R0, const Vec3& n, const Vec3& t, double kappa, double tau, double length,
                           const Normal& normal) {
  Mat3 frenet;
  frenet << n, t.cross(n), t;
  const Mat3 D = starting_frame(t, normal ? normal : Normal(n), n, 0.0);
  const double phi0 = normal ? std::atan2(D.col(0).dot(frenet.col(1)), D.col(0).dot(n)) : 0.0;
  return std::make_shared<ConstantCurvatureAxis>(R0, frenet, kappa, tau, length, phi0);
}

void require_finite_vector(std::vector<Issue>& issues, const std::string& field, const Vec3& v) {
  if (v.allFinite()) return;
  issues.push_back({field, 0.0, v.sum(), 0.0, "has a component that is not a finite number", ""});
}

}  // namespace

Mat3 starting_frame(const Vec3& D3, const Normal& normal, const Vec3& curvature_vector, double straight_below) {
  constexpr double kAlong = 1e-6;  // sine below which a direction counts as along D3
  Vec3 wished = curvature_vector;
  if (normal) {
    if (!normal->allFinite() || normal->norm() == 0.0) {
      throw GeometryError({"normal", 0.0, normal->norm(), 0.0, "must be three finite numbers, not all 0", ""});
    }
    wished = normal->normalized();
    const double sine = wished.cross(D3).norm();
    if (sine < kAlong) {
      throw GeometryError({"normal", 0.0, sine, kAlong,
                           "is along the tangent at S = 0 (sine of the angle " + number_text(sine) + ", at least " +
                               number_text(kAlong) + " is needed)",
                           "give a direction across the tube"});
    }
  } else if (curvature_vector.norm() <= straight_below) {
    for (int axis = 0; axis < 3; ++axis) {
      wished = Vec3::Unit(axis);
      if (wished.cross(D3).norm() > kAlong) break;
    }
  }
  Mat3 D;
  D.col(0) = (wished - wished.dot(D3) * D3).normalized();
  D.col(0) = (D.col(0) - D.col(0).dot(D3) * D3).normalized();  // twice is enough for rounding
  D.col(1) = D3.cross(D.col(0));
  D.col(2) = D3;
  return D;
}

AxisPtr make_straight(double length, const Vec3& direction, const Vec3& origin, const Normal& normal) {
  std::vector<Issue> issues;
  require_positive(issues, "length", length);
  require_finite_vector(issues, "direction", direction);
  require_finite_vector(issues, "origin", origin);
  if (direction.allFinite() && direction.norm() == 0.0) {
    issues.push_back({"direction", 0.0, 0.0, 0.0, "is the zero vector", "give any vector along the tube"});
  }
  throw_if_any(std::move(issues));
  const Vec3 t = direction.normalized();
  const Mat3 D = starting_frame(t, normal, Vec3::Zero(), 0.0);
  return constant_curvature(origin, D.col(0), t, 0.0, 0.0, length, {});
}

AxisPtr make_arc(double radius, double length, const Normal& normal) {
  std::vector<Issue> issues;
  require_positive(issues, "radius", radius);
  require_positive(issues, "length", length);
  throw_if_any(std::move(issues));
  return constant_curvature(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitZ(), 1.0 / radius, 0.0, length, normal);
}

AxisPtr make_helix(double radius, double pitch_angle, double length, const Normal& normal) {
  constexpr double kSteepest = std::numbers::pi / 2;
  std::vector<Issue> issues;
  require_positive(issues, "radius", radius);
  require_positive(issues, "length", length);
  require_finite(issues, "pitch_angle", pitch_angle);
  if (std::abs(pitch_angle) > kSteepest) {
    issues.push_back({"pitch_angle", 0.0, pitch_angle, kSteepest,
                      "is " + number_text(pitch_angle) + " rad, must lie between -pi/2 and pi/2",
                      "angles in degrees need a unit"});
  }
  throw_if_any(std::move(issues));
  const double s = std::sin(pitch_angle), c = std::cos(pitch_angle);
  return constant_curvature(radius * Vec3::UnitX(), -Vec3::UnitX(), Vec3(0.0, s, c), s * s / radius, s * c / radius,
                            length, normal);
}

AxisPtr make_torus(double major_radius, const Normal& normal) {
  std::vector<Issue> issues;
  require_positive(issues, "major_radius", major_radius);
  throw_if_any(std::move(issues));
  return constant_curvature(major_radius * Vec3::UnitX(), -Vec3::UnitX(), Vec3::UnitY(), 1.0 / major_radius, 0.0,
                            2.0 * std::numbers::pi * major_radius, normal);
}

}  // namespace tendril::geometry

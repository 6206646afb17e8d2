#include "tendril/geometry/axis_transforms.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>

#include "tendril/geometry/error.hpp"

namespace tendril::geometry {

namespace {

using SectionMap = std::function<AxisPoint(const Axis&, double)>;

class MappedAxis final : public Axis {
 public:
  MappedAxis(AxisPtr base, double length, std::vector<double> knots, SectionMap map)
      : base_(std::move(base)), length_(length), knots_(std::move(knots)), map_(std::move(map)) {}
  double length() const override { return length_; }
  AxisPoint at(double S) const override { return map_(*base_, S); }
  const std::vector<double>& knots() const override { return knots_; }

 private:
  AxisPtr base_;
  double length_;
  std::vector<double> knots_;
  SectionMap map_;
};

AxisPtr mapped(AxisPtr base, SectionMap map) {
  const double length = base->length();
  std::vector<double> knots = base->knots();
  return std::make_shared<MappedAxis>(std::move(base), length, std::move(knots), std::move(map));
}

}  // namespace

AxisPtr with_normal(AxisPtr axis, const Normal& normal) {
  const AxisPoint start = axis->at(0.0);
  const Vec3 curvature =
      start.U[0][1] * start.frame.col(0) - start.U[0][0] * start.frame.col(1);  // R'' = U2 D1 - U1 D2
  const Vec3 D1 = starting_frame(start.frame.col(2), normal, curvature, 1e-9 / axis->length()).col(0);
  const double angle = std::atan2(D1.dot(start.frame.col(1)), D1.dot(start.frame.col(0)));
  return with_frame_twist(std::move(axis), [angle](double) {
    return std::array<double, 5>{angle, 0.0, 0.0, 0.0, 0.0};
  });
}

AxisPtr rotate_translate(AxisPtr axis, const Mat3& rotation, const Vec3& shift) {
  const double defect = (rotation.transpose() * rotation - Mat3::Identity()).norm();
  if (!(defect < 1e-12) || rotation.determinant() < 0.0 || !shift.allFinite()) {
    throw GeometryError({"rotation", 0.0, defect, 1e-12, "is not a rotation matrix (or the shift is not finite)",
                         "use mirror for reflections"});
  }
  return mapped(std::move(axis), [rotation, shift](const Axis& base, double S) {
    AxisPoint point = base.at(S);
    point.position = rotation * point.position + shift;
    point.frame = rotation * point.frame;
    return point;
  });
}

AxisPtr scaled(AxisPtr axis, double factor) {
  std::vector<Issue> issues;
  require_positive(issues, "scale", factor);
  throw_if_any(std::move(issues));
  std::vector<double> knots = axis->knots();
  for (double& knot : knots) knot *= factor;
  const double length = factor * axis->length();
  return std::make_shared<MappedAxis>(std::move(axis), length, std::move(knots), [factor](const Axis& base, double S) {
    AxisPoint point = base.at(S / factor);
    point.position *= factor;
    double power = 1.0;
    for (Vec3& U : point.U) U /= (power *= factor);
    return point;
  });
}

AxisPtr mirror(AxisPtr axis, const Vec3& plane_normal) {
  if (!plane_normal.allFinite() || plane_normal.norm() == 0.0) {
    throw GeometryError({"plane_normal", 0.0, plane_normal.norm(), 0.0, "must be finite and not the zero vector", ""});
  }
  const Vec3 n = plane_normal.normalized();
  const Mat3 M = Mat3::Identity() - 2.0 * n * n.transpose();
  return mapped(std::move(axis), [M](const Axis& base, double S) {
    AxisPoint point = base.at(S);
    point.position = M * point.position;
    point.frame = M * point.frame;
    point.frame.col(1) *= -1.0;
    for (Vec3& U : point.U) U = Vec3(-U[0], U[1], -U[2]);
    return point;
  });
}

AxisPtr reverse(AxisPtr axis) {
  const double length = axis->length();
  std::vector<double> knots = axis->knots();
  std::reverse(knots.begin(), knots.end());
  for (double& knot : knots) knot = length - knot;
  return std::make_shared<MappedAxis>(std::move(axis), length, std::move(knots), [length](const Axis& base, double S) {
    AxisPoint point = base.at(length - S);
    point.frame.col(1) *= -1.0;
    point.frame.col(2) *= -1.0;
    double sign = 1.0;  // d/dS changes sign with the direction
    for (Vec3& U : point.U) {
      U = sign * Vec3(-U[0], U[1], U[2]);
      sign = -sign;
    }
    return point;
  });
}

AxisPtr subrange(AxisPtr axis, double S0, double S1) {
  const double whole = axis->length(), slack = 1e-9 * whole;
  if (!(S0 >= -slack && S0 < S1 && S1 <= whole + slack)) {
    throw GeometryError({"subrange", S0, S1, whole,
                         "from " + number_text(S0) + " to " + number_text(S1) + " is not a part of the axis, 0 to " +
                             number_text(whole),
                         "ascending places on the axis"});
  }
  std::vector<double> knots;
  for (double knot : axis->knots()) {
    if (knot > S0 + slack && knot < S1 - slack) knots.push_back(knot - S0);
  }
  return std::make_shared<MappedAxis>(std::move(axis), S1 - S0, std::move(knots),
                                      [S0](const Axis& base, double S) { return base.at(S0 + S); });
}

AxisPtr with_frame_twist(AxisPtr axis, FrameAngle gamma) {
  return mapped(std::move(axis), [gamma = std::move(gamma)](const Axis& base, double S) {
    AxisPoint point = base.at(S);
    const auto g = gamma(S);
    const double c = std::cos(g[0]), s = std::sin(g[0]);
    const Vec3 D1 = point.frame.col(0), D2 = point.frame.col(1);
    point.frame.col(0) = c * D1 + s * D2;
    point.frame.col(1) = c * D2 - s * D1;
    // W = U1 + i U2 -> W e^{-iγ}, derivatives by Leibniz' rule; U3 -> U3 + γ'.
    using Complex = std::complex<double>;
    const Complex i(0.0, 1.0), E0(c, -s);
    const Complex E1 = -i * g[1] * E0, E2 = (-i * g[2] - g[1] * g[1]) * E0;
    const Complex E3 = (-i * g[3] - 3.0 * g[1] * g[2] + i * g[1] * g[1] * g[1]) * E0;
    std::array<Complex, 4> W;
    for (int j = 0; j < 4; ++j) W[j] = Complex(point.U[j][0], point.U[j][1]);
    const std::array<Complex, 4> turned{W[0] * E0, W[1] * E0 + W[0] * E1, W[2] * E0 + 2.0 * W[1] * E1 + W[0] * E2,
                                        W[3] * E0 + 3.0 * W[2] * E1 + 3.0 * W[1] * E2 + W[0] * E3};
    for (int j = 0; j < 4; ++j) point.U[j] = Vec3(turned[j].real(), turned[j].imag(), point.U[j][2] + g[j + 1]);
    return point;
  });
}

}  // namespace tendril::geometry

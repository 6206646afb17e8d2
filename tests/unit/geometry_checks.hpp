#pragma once
// Defects of an axis by differences of order six: sections are tested against nothing but R(S) and the frames.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "tendril/geometry/axis.hpp"

namespace geometry_checks {

using tendril::geometry::Axis;
using tendril::geometry::Vec3;

/// Central difference of order six of f at S.
template <class Function>
auto slope(const Function& f, double S, double h) {
  const auto first = (f(S + h) - f(S - h)).eval();
  const auto second = (f(S + 2 * h) - f(S - 2 * h)).eval();
  const auto third = (f(S + 3 * h) - f(S - 3 * h)).eval();
  return ((45.0 * first - 9.0 * second + third) / (60.0 * h)).eval();
}

/// Worst defects of the definitions, each relative to the size of what it should vanish against.
struct Defects {
  double tangent = 0.0;      // R' - D3
  double frame = 0.0;        // D_j' - U x D_j
  double derivatives = 0.0;  // U^(j)' - U^(j+1), relative to the largest U^(j+1) met
  double orthonormal = 0.0;  // DᵀD - 1, det D - 1
};

inline Defects defects(const Axis& axis, double h, int samples = 60) {
  Defects worst;
  std::array<double, 3> error{}, size{};
  for (int i = 0; i < samples; ++i) {
    double S = 4 * h + (axis.length() - 8 * h) * (i + 0.37) / samples;
    const auto& knots = axis.knots();
    const bool near_knot = std::any_of(knots.begin(), knots.end(), [&](double k) { return std::abs(k - S) < 3.1 * h; });
    if (near_knot) continue;
    const auto p = axis.at(S);
    worst.tangent =
        std::max(worst.tangent, (slope([&](double s) { return axis.at(s).position; }, S, h) - p.frame.col(2)).norm());
    const Vec3 U = p.frame * p.U[0];
    for (int j = 0; j < 3; ++j) {
      const Vec3 dD = slope([&](double s) { return Vec3(axis.at(s).frame.col(j)); }, S, h);
      worst.frame = std::max(worst.frame, (dD - U.cross(p.frame.col(j))).norm());
      const Vec3 dU = slope([&](double s) { return axis.at(s).U[j]; }, S, h);
      error[j] = std::max(error[j], (dU - p.U[j + 1]).norm());
      size[j] = std::max(size[j], p.U[j + 1].norm());
    }
    worst.orthonormal =
        std::max(worst.orthonormal, (p.frame.transpose() * p.frame - tendril::geometry::Mat3::Identity()).norm());
    worst.orthonormal = std::max(worst.orthonormal, std::abs(p.frame.determinant() - 1.0));
  }
  for (int j = 0; j < 3; ++j) worst.derivatives = std::max(worst.derivatives, error[j] / std::max(size[j], 1e-300));
  return worst;
}

}  // namespace geometry_checks

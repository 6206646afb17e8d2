#pragma once
// A tube with nothing special about it, as sections for the governing equations: U1, U2, U3, Q and the loads all vary
// along S. The frame is integrated by the exact exponential of small steps, so that loads fixed in the world can be
// given.

#include <Eigen/Geometry>
#include <cmath>

#include "tendril/formulation/section.hpp"

namespace formulation_tube {

using tendril::formulation::Section;
using tendril::formulation::V3;

struct GeneralTube {
  double amplitude = 1.0;  // of U
  double twist = 1.0;      // of U3
  double taper = 1.0;      // of Q'
  double weight = 0.0, couple = 0.0;

  /// f, f', f'', f''' of c0 + c1 sin(w S + a)
  static std::array<double, 5> wave(double S, double c0, double c1, double w, double a) {
    const double s = std::sin(w * S + a), c = std::cos(w * S + a);
    return {c0 + c1 * s, c1 * w * c, -c1 * w * w * s, -c1 * w * w * w * c, c1 * w * w * w * w * s};
  }
  std::array<V3<double>, 4> U(double S) const {
    const auto u1 = wave(S, 0.4 * amplitude, 0.7 * amplitude, 1.3, 0.2);
    const auto u2 = wave(S, -0.2 * amplitude, 0.9 * amplitude, 0.9, 1.1);
    const auto u3 = wave(S, 0.5 * twist, 0.6 * twist, 1.7, -0.4);
    std::array<V3<double>, 4> U;
    for (int j = 0; j < 4; ++j) U[j] = {u1[j], u2[j], u3[j]};
    return U;
  }
  /// Frame at S from the frame at 0: D' = D [U]x, by Richardson-extrapolated exponentials.
  Eigen::Matrix3d frame(double S) const {
    const auto march = [&](int n) {
      Eigen::Matrix3d D = Eigen::Matrix3d::Identity();
      const double h = S / n, g = std::sqrt(3.0) / 6;
      for (int i = 0; i < n; ++i) {  // fourth-order Magnus
        const auto a = U((i + 0.5 - g) * h)[0], b = U((i + 0.5 + g) * h)[0];
        const Eigen::Vector3d A(a[0], a[1], a[2]), B(b[0], b[1], b[2]);
        const Eigen::Vector3d w = 0.5 * h * (A + B) + std::sqrt(3.0) / 12 * h * h * A.cross(B);
        D = D * Eigen::AngleAxisd(w.norm(), w.normalized()).toRotationMatrix();
      }
      return D;
    };
    return S == 0.0 ? Eigen::Matrix3d::Identity() : Eigen::Matrix3d((16.0 * march(256) - march(128)) / 15.0);
  }
  Section at(double S) const {
    Section s;
    s.S = S;
    s.U = U(S);
    s.Q = wave(S, 0.15, 0.05 * taper, 2.1, 0.3);
    if (weight != 0.0 || couple != 0.0) {
      const Eigen::Matrix3d D = frame(S);
      const Eigen::Vector3d f = D.transpose() * (weight * Eigen::Vector3d(0.3, -0.8, 0.5));
      const Eigen::Vector3d m = D.transpose() * (couple * Eigen::Vector3d(-0.6, 0.2, 0.7));
      for (int i = 0; i < 3; ++i) {
        s.sigma[i] = f[i];
        s.mu[i] = m[i];
      }
    }
    return s;
  }
};

/// d/dx by sixth-order central differences.
template <class F>
double slope(F&& f, double x, double h = 5e-3) {
  return (45.0 * (f(x + h) - f(x - h)) - 9.0 * (f(x + 2 * h) - f(x - 2 * h)) + (f(x + 3 * h) - f(x - 3 * h))) /
         (60.0 * h);
}

}  // namespace formulation_tube

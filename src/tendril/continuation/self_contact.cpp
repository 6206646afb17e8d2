#include "tendril/continuation/self_contact.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace tendril::continuation {

using Eigen::Vector3d;

namespace {

/// Distance of two chords a + x u and b + y v, x, y in [0, 1].
double apart(const Vector3d& a, const Vector3d& u, const Vector3d& b, const Vector3d& v) {
  const Vector3d w = a - b;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double det = uu * vv - uv * uv;
  double x = det > 1e-12 * uu * vv ? std::clamp((uv * vw - vv * uw) / det, 0.0, 1.0) : 0.0;
  const double y = std::clamp((uv * x + vw) / vv, 0.0, 1.0);
  x = std::clamp((uv * y - uw) / uu, 0.0, 1.0);
  return (w + x * u - y * v).norm();
}

}  // namespace

SelfApproach self_approach(const segmentation::Chain& chain, double diameter, int chords) {
  const auto& P = chain.mechanics().problem;
  const double reach = diameter > 0.0 ? diameter / P.L : 1e-6;
  const double from = chain.S(0), to = chain.S(chain.segments());
  std::vector<Vector3d> r;
  std::vector<double> along{0.0};
  double u[formulation::state_inputs];
  for (int i = 0; i <= chords; ++i) {
    const double S = from + (to - from) * i / chords;
    chain.sample(S, u, nullptr);
    const auto s = P.section(S);
    Vector3d x;
    for (int k = 0; k < 3; ++k) x[k] = s.R[k] + u[0] * s.D[0][k] + u[4] * s.D[1][k];
    if (i > 0) along.push_back(along.back() + (x - r.back()).norm());
    r.push_back(x);
  }
  double longest = 0.0;
  for (int i = 0; i < chords; ++i) longest = std::max(longest, along[i + 1] - along[i]);
  SelfApproach out;
  double nearest = reach;
  for (int i = 0; i < chords; ++i)
    for (int j = i + 2; j < chords;) {
      // what lies far away stays far for as many chords as it takes to come back
      const double distance = (r[i] - r[j]).norm() - 2.0 * longest;
      if (distance > nearest) {
        j += std::max(1, static_cast<int>((distance - nearest) / longest));
        continue;
      }
      if (along[j] - along[i + 1] > 2.0 * reach) {
        const double d = apart(r[i], r[i + 1] - r[i], r[j], r[j + 1] - r[j]);
        if (d < nearest) {
          nearest = d;
          out.distance = d * P.L;
          out.first = (from + (to - from) * (i + 0.5) / chords) * P.L;
          out.second = (from + (to - from) * (j + 0.5) / chords) * P.L;
          out.found = true;
        }
      }
      ++j;
    }
  return out;
}

std::string self_contact_warning(const segmentation::Chain& chain, double diameter) {
  const SelfApproach a = self_approach(chain, diameter);
  if (!a.found) return "";
  char text[240];
  if (diameter > 0.0)
    std::snprintf(text, sizeof text,
                  "warning: the rod meets itself at S = %.6g and S = %.6g: %.4g apart, its diameter is %.4g; forces "
                  "between parts of the rod are not part of the model",
                  a.first, a.second, a.distance, diameter);
  else
    std::snprintf(text, sizeof text,
                  "warning: the rod crosses itself at S = %.6g and S = %.6g; forces between parts of the rod are not "
                  "part of the model",
                  a.first, a.second);
  return text;
}

}  // namespace tendril::continuation

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tendril/geometry/error.hpp"
#include "tendril/geometry/fitted_axes.hpp"
#include "tendril/geometry/spline_axis.hpp"

namespace tendril::geometry {

namespace {

std::string entry(std::size_t i) { return "points[" + std::to_string(i) + "]"; }

void check_points(const std::vector<Vec3>& points, double smoothing) {
  constexpr std::size_t kFewest = 4;
  constexpr double kRepeated = 1e-10;  // hop that counts as none, relative to the length of the polygon
  constexpr std::size_t kMostIssues = 20;
  std::vector<Issue> issues;
  if (points.size() < kFewest) {
    issues.push_back({"points", 0.0, static_cast<double>(points.size()), static_cast<double>(kFewest),
                      "there are " + std::to_string(points.size()) + ", at least 4 are needed", ""});
  }
  if (!(std::isfinite(smoothing) && smoothing >= 0.0)) {
    issues.push_back({"smoothing", 0.0, smoothing, 0.0, "is " + number_text(smoothing) + ", must be 0 or more", ""});
  }
  for (std::size_t i = 0; i < points.size() && issues.size() < kMostIssues; ++i) {
    if (!points[i].allFinite()) issues.push_back({entry(i), 0.0, points[i].sum(), 0.0, "is not finite", ""});
  }
  throw_if_any(issues);

  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  double S = 0.0;
  for (std::size_t i = 1; i < points.size() && issues.size() < kMostIssues; ++i) {
    const Vec3 hop = points[i] - points[i - 1];
    if (!(hop.norm() > kRepeated * length)) {
      issues.push_back(
          {entry(i), S, hop.norm(), kRepeated * length,
           "repeats the point before it (distance " + number_text(hop.norm()) + " at S = " + number_text(S) + ")",
           "remove one of the two"});
      continue;
    }
    S += hop.norm();
    if (i + 1 == points.size()) break;
    const Vec3 next = points[i + 1] - points[i];
    if (hop.dot(next) < 0.0) {
      const double degrees = std::atan2(hop.cross(next).norm(), hop.dot(next)) * 57.29577951308232;
      issues.push_back({entry(i), S, degrees, 90.0,
                        "the line through the points turns by " + number_text(degrees) +
                            " degrees there (S = " + number_text(S) + "), at most 90 are allowed",
                        "remove the stray point, or sample the bend more finely"});
    }
  }
  throw_if_any(std::move(issues));
}

}  // namespace

FittedAxis make_points(const std::vector<Vec3>& points, double smoothing, const Normal& normal) {
  check_points(points, smoothing);
  std::vector<std::array<double, 3>> values(points.size());
  std::vector<double> t(points.size(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    values[i] = {points[i][0], points[i][1], points[i][2]};
    if (i > 0) t[i] = t[i - 1] + (points[i] - points[i - 1]).norm();
  }

  // Chord length first, then the arc length of the spline itself: two rounds bring |R'| close to 1.
  constexpr int kRounds = 2;
  PiecewiseQuintic<3> curve = interpolate_quintic<3>(t, values);
  for (int round = 0; round < kRounds; ++round) {
    t = arc_lengths(curve, t);
    curve = interpolate_quintic<3>(t, values);
  }
  FittedAxis fitted{nullptr, 0.0, 0.0, 0.0};
  if (smoothing > 0.0) curve = smooth_quintic<3>(t, values, smoothing);
  fitted.axis = make_spline_axis(curve, normal);

  fitted.S = arc_lengths(curve, t);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto d = curve.derivatives(t[i])[0];
    const double deviation = (Vec3(d[0], d[1], d[2]) - points[i]).norm();
    if (deviation > fitted.largest_deviation) {
      fitted.largest_deviation = deviation;
      fitted.deviation_S = fitted.S[i];
    }
  }
  return fitted;
}

}  // namespace tendril::geometry

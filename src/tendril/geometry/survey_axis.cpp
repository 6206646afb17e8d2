#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tendril/geometry/error.hpp"
#include "tendril/geometry/fitted_axes.hpp"
#include "tendril/geometry/spline_axis.hpp"

namespace tendril::geometry {

namespace {

std::string station(const char* field, std::size_t i) { return std::string(field) + "[" + std::to_string(i) + "]"; }

void check_survey(const std::vector<double>& md, const std::vector<double>& inclination,
                  const std::vector<double>& azimuth, double allowed) {
  std::vector<Issue> issues;
  require_positive(issues, "allowed_deviation", allowed);
  if (md.size() < 2 || inclination.size() != md.size() || azimuth.size() != md.size()) {
    issues.push_back({"survey", 0.0, static_cast<double>(md.size()), 2.0,
                      "has " + std::to_string(md.size()) + " depths, " + std::to_string(inclination.size()) +
                          " inclinations and " + std::to_string(azimuth.size()) + " azimuths",
                      "equally many of each, at least 2"});
  }
  throw_if_any(issues);
  for (std::size_t i = 0; i < md.size(); ++i) {
    const double S = std::isfinite(md[i] - md[0]) ? md[i] - md[0] : 0.0;
    const auto issue = [&](const char* field, double value, double bound, const std::string& problem,
                           const char* hint) {
      issues.push_back({station(field, i), S, value, bound, problem, hint});
    };
    if (!std::isfinite(md[i])) {
      issue("md", md[i], 0.0, "is not a finite number", "");
    } else if (i > 0 && !(md[i] > md[i - 1])) {
      issue("md", md[i], md[i - 1],
            "is " + number_text(md[i]) + ", not deeper than the station before, " + number_text(md[i - 1]),
            "depths must ascend; remove the repeated station");
    }
    if (!(inclination[i] >= 0.0 && inclination[i] <= 180.0)) {
      issue("inclination", inclination[i], 180.0,
            "is " + number_text(inclination[i]) + " degrees, must lie between 0 and 180", "");
    }
    if (!(std::abs(azimuth[i]) <= 360.0)) {
      issue("azimuth", azimuth[i], 360.0, "is " + number_text(azimuth[i]) + " degrees, must lie between -360 and 360",
            "");
    }
  }
  throw_if_any(std::move(issues));
}

// The minimum-curvature hole: circular arcs between stations, tangent to both directions.
struct MinimumCurvature {
  std::vector<double> S;       // md - md[0]
  std::vector<Vec3> tangent;   // at the stations
  std::vector<Vec3> across;    // unit, in the plane of the arc that starts there; zero if it is straight
  std::vector<double> dogleg;  // angle of that arc [rad]
  std::vector<Vec3> position;

  // Position at s within arc i.
  Vec3 in_arc(std::size_t i, double s) const {
    const double length = S[i + 1] - S[i], kappa = dogleg[i] / length, phi = kappa * s;
    const double half = phi > 0.0 ? std::sin(0.5 * phi) / (0.5 * phi) : 1.0;
    const double along = phi > 0.0 ? std::sin(phi) / phi : 1.0;
    return position[i] + s * (along * tangent[i] + 0.5 * phi * half * half * across[i]);
  }
  Vec3 at(double place) const {
    auto i = static_cast<std::size_t>(std::upper_bound(S.begin() + 1, S.end() - 1, place) - S.begin()) - 1;
    return in_arc(i, place - S[i]);
  }
  // Jump of the curvature vector at interior station i.
  double curvature_jump(std::size_t i) const {
    const double before = S[i] - S[i - 1], after = S[i + 1] - S[i];
    const Vec3 arriving = std::cos(dogleg[i - 1]) * across[i - 1] - std::sin(dogleg[i - 1]) * tangent[i - 1];
    return (dogleg[i] / after * across[i] - dogleg[i - 1] / before * arriving).norm();
  }
};

MinimumCurvature minimum_curvature(const std::vector<double>& md, const std::vector<double>& inclination,
                                   const std::vector<double>& azimuth) {
  constexpr double kLargestDogleg = 0.5 * std::numbers::pi;  // between two stations
  constexpr double kRadians = std::numbers::pi / 180.0;
  const std::size_t n = md.size();
  MinimumCurvature hole;
  std::vector<Issue> issues;
  for (std::size_t i = 0; i < n; ++i) {
    const double inc = inclination[i] * kRadians, azi = azimuth[i] * kRadians;
    hole.S.push_back(md[i] - md[0]);
    hole.tangent.emplace_back(std::sin(inc) * std::cos(azi), std::sin(inc) * std::sin(azi), std::cos(inc));
  }
  hole.position.push_back(Vec3::Zero());
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const Vec3 &a = hole.tangent[i], &b = hole.tangent[i + 1];
    const Vec3 rest = b - a.dot(b) * a;
    const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
    if (angle > kLargestDogleg) {
      issues.push_back({station("survey", i + 1), hole.S[i + 1], angle / kRadians, 90.0,
                        "the hole turns by " + number_text(angle / kRadians) + " degrees between md " +
                            number_text(md[i]) + " and " + number_text(md[i + 1]) + ", at most 90 are allowed",
                        "check inclination and azimuth of both stations"});
    }
    constexpr double kStraight = 1e-12;  // rad; below this the plane of the arc is rounding
    hole.dogleg.push_back(angle > kStraight ? angle : 0.0);
    hole.across.push_back(angle > kStraight ? Vec3(rest.normalized()) : Vec3(Vec3::Zero()));
    hole.position.push_back(hole.in_arc(i, hole.S[i + 1] - hole.S[i]));
  }
  throw_if_any(std::move(issues));
  return hole;
}

// Interior knots: around a station with a jump Δκ the four knots ±h, ±h/3 of the smoothest ramp of a C2 piecewise cubic
// curvature (an integrated quadratic B-spline); one knot where the jump does not matter; between stations as many as
// keep a piece below 0.1 rad, where a quintic is an arc to rounding.
std::vector<double> blend_knots(const MinimumCurvature& hole, double half_width, double allowed) {
  constexpr double kLargestTurn = 0.1;
  constexpr double kShare = 0.3;  // of the shorter neighbouring interval
  std::vector<double> knots;
  const std::size_t n = hole.S.size();
  double free_from = 0.0;
  for (std::size_t i = 1; i < n; ++i) {
    const double before = hole.S[i] - hole.S[i - 1];
    double h = 0.0;
    if (i + 1 < n) {
      const double jump = hole.curvature_jump(i);
      const double widest = kShare * std::min(before, hole.S[i + 1] - hole.S[i]);
      h = std::min(half_width, widest);
      if (jump * widest * widest < 1e-3 * allowed) h = 0.0;
    }
    const double free_to = hole.S[i] - h;
    const double turn = hole.dogleg[i - 1] * (free_to - free_from) / before;
    const int pieces = std::max(1, static_cast<int>(std::ceil(turn / kLargestTurn)));
    for (int p = 1; p < pieces; ++p) knots.push_back(free_from + (free_to - free_from) * p / pieces);
    if (i + 1 == n) break;
    if (h > 0.0) {
      for (double place : {-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0}) knots.push_back(hole.S[i] + place * h);
    } else {
      knots.push_back(hole.S[i]);
    }
    free_from = hole.S[i] + h;
  }
  return knots;
}

// Spline with these knots through the hole at the Greville sites.
PiecewiseQuintic<3> blended(const MinimumCurvature& hole, const std::vector<double>& knots) {
  const double end = hole.S.back();
  std::vector<double> padded(6, 0.0);
  padded.insert(padded.end(), knots.begin(), knots.end());
  padded.insert(padded.end(), 6, end);
  std::vector<double> sites;
  std::vector<std::array<double, 3>> values;
  for (std::size_t i = 0; i + 6 < padded.size(); ++i) {
    double site = 0.0;
    for (std::size_t j = 1; j <= 5; ++j) site += padded[i + j] / 5.0;
    if (i == 0) site = 0.0;
    if (i + 7 == padded.size()) site = end;
    sites.push_back(site);
    const Vec3 R = hole.at(site);
    values.push_back({R[0], R[1], R[2]});
  }
  return interpolate_quintic<3>(knots, sites, values);
}

void scale(PiecewiseQuintic<3>& curve, double factor) {
  for (auto& piece : curve.pieces) {
    for (auto& row : piece) {
      for (double& value : row) value *= factor;
    }
  }
}

}  // namespace

FittedAxis make_survey(const std::vector<double>& md, const std::vector<double>& inclination_deg,
                       const std::vector<double>& azimuth_deg, double allowed_deviation, const Normal& normal) {
  constexpr int kHalvings = 20;
  constexpr int kSamples = 8;  // per piece, where the deviation is measured
  check_survey(md, inclination_deg, azimuth_deg, allowed_deviation);
  const MinimumCurvature hole = minimum_curvature(md, inclination_deg, azimuth_deg);
  const double span = hole.S.back();

  double half_width = span;
  FittedAxis fitted{nullptr, 0.0, 0.0, 0.0};
  for (int halving = 0; halving < kHalvings; ++halving) {
    PiecewiseQuintic<3> curve = blended(hole, blend_knots(hole, half_width, allowed_deviation));
    std::vector<double> places;
    for (std::size_t p = 0; p < curve.pieces.size(); ++p) {
      const double width = curve.breaks[p + 1] - curve.breaks[p];
      for (int k = 0; k < kSamples; ++k) places.push_back(curve.breaks[p] + width * k / kSamples);
    }
    places.push_back(span);
    const std::vector<double> S = arc_lengths(curve, places);
    const double factor = span / S.back();
    scale(curve, factor);

    // Deviation at equal S: the spline's place is S factor, the hole's is the same depth.
    fitted.largest_deviation = fitted.deviation_S = fitted.largest_place_shift = 0.0;
    double widest = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto d = curve.derivatives(places[i])[0];
      const double deviation = (Vec3(d[0], d[1], d[2]) - hole.at(std::min(S[i] * factor, span))).norm();
      if (deviation > fitted.largest_deviation) {
        fitted.largest_deviation = deviation;
        fitted.deviation_S = S[i] * factor;
      }
      fitted.largest_place_shift = std::max(fitted.largest_place_shift, std::abs(S[i] * factor - places[i]));
    }
    for (std::size_t i = 1; i < hole.S.size(); ++i) widest = std::max(widest, hole.S[i] - hole.S[i - 1]);
    if (fitted.largest_deviation <= allowed_deviation) {
      fitted.axis = make_spline_axis(curve, normal);
      return fitted;
    }
    half_width = 0.5 * std::min(half_width, 0.3 * widest);
  }
  throw GeometryError({"allowed_deviation", fitted.deviation_S, fitted.largest_deviation, allowed_deviation,
                       "a smooth curve stays only within " + number_text(fitted.largest_deviation) +
                           " of the surveyed hole at S = " + number_text(fitted.deviation_S) + ", allowed are " +
                           number_text(allowed_deviation),
                       "allow more, or check the stations there"});
}

}  // namespace tendril::geometry

#pragma once
// Reference curves from data: points on a centreline, and directional surveys of wells. Both become a C4 quintic spline
// run by its own arc length (spline_axis.hpp), so that U, U', U'' are continuous and U''' is piecewise smooth.

#include <array>
#include <vector>

#include "tendril/geometry/axes.hpp"

namespace tendril::geometry {

/// An axis and how far it lies from the data it was made of.
struct FittedAxis {
  AxisPtr axis;
  double largest_deviation;    // from the points, or from the minimum-curvature curve at equal S  [length]
  double deviation_S;          // where it is                                                       [length]
  double largest_place_shift;  // survey: largest difference of S and md - md[0] on the same point; points: 0   [length]
  std::vector<double> S = {};  // points: place of each on the axis, where it meets or lies beside it [length]
};

/// Through the points (at least four), exactly; with smoothing > 0 the smoothest spline (least integral of the squared
/// third derivative) that stays within `smoothing` of every point. Refuses numbers that are not finite, repeated
/// points, and hops that turn by more than a right angle, each with its place.
FittedAxis make_points(const std::vector<Vec3>& points, double smoothing = 0.0, const Normal& normal = {});

/// Minimum-curvature hole through the stations: measured depth [length], inclination from vertical and azimuth from
/// north [degrees, as surveys are written]; world x north, y east, z down, the first station at the origin. Circular
/// arcs meet with a jump of curvature at each station; there the spline blends them over a length halved until the
/// largest deviation is at most `allowed_deviation`. The curve is finally scaled (by about 1 + 1e-8) so that its length
/// is md.back() - md[0] exactly; interior stations keep S = md - md[0] to `largest_place_shift`.
FittedAxis make_survey(const std::vector<double>& md, const std::vector<double>& inclination_deg,
                       const std::vector<double>& azimuth_deg, double allowed_deviation, const Normal& normal = {});

}  // namespace tendril::geometry

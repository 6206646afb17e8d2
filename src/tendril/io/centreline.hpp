#pragma once
// A centreline or survey as a case uses it: one path of the file, cleaned, in the case's units; and the smooth curve
// that is laid through or near its points. Internal to io and the program.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tendril/geometry/clearances.hpp"
#include "tendril/geometry/fitted_axes.hpp"
#include "tendril/io/cleaning.hpp"
#include "tendril/io/diagnostics.hpp"
#include "tendril/io/polyline_path.hpp"

namespace tendril::io {

/// Lengths in case units.
struct Centreline {
  std::vector<geometry::Vec3> points;  // kind points            [length]
  std::vector<double> radius;          // its radius column, or empty  [length]
  std::vector<double> md, inc, azi;    // kind survey            [length, deg, deg]
  std::vector<int> rows;               // line of the file of each point or station; empty: not known
  std::string name;                    // of the file; empty: points of the case itself
  std::string format;                  // "VTK PolyData", ...
  std::string unit;                    // of the lengths as written; empty: not said
  CleaningReport cleaning;
};

/// How a file is to be read.
struct CentrelineRequest {
  bool si = false;           // convert to m; else lengths keep their numbers
  bool need_unit = true;     // in SI: refuse a format without units; tables of text are in m then
  std::string unit;          // of the lengths, where the file does not say
  std::string radius_array;  // name of the radius; empty: those that are known
  PathChoice path;           // in file units
};

/// Points of a file; an issue is at a place of the file, or, through `complain`, at a key of the case.
using Complain = std::function<Issue&(const std::string& key, const std::string& message)>;
Centreline read_points(const std::shared_ptr<const Source>& source, const CentrelineRequest& request, Issues& issues,
                       const Complain& complain, std::vector<std::string>& notes);

/// Stations of a file.
Centreline read_survey(const std::shared_ptr<const Source>& source, const CentrelineRequest& request, Issues& issues,
                       const Complain& complain, std::vector<std::string>& notes);

/// The text of a file with its name; throws FileError.
std::shared_ptr<const Source> read_source(const std::string& path, const std::string& name);

/// A smooth curve for points, and what was needed for it.
struct CentrelineFit {
  geometry::FittedAxis axis;
  double smoothing = 0.0;  // tolerance it was made with; 0: it passes through every point
  bool automatic = false;  // the tolerance was chosen here
  std::vector<double> S;   // place of each point on it; with a radius only
};

/// Share of the median radius that smoothing may move a point by where the case does not say.
constexpr double kSmoothingShare = 0.15;
double automatic_smoothing(const Centreline& line);

/// The curve for the points. `smoothing`: tolerance, 0 exact, nothing: exact where the tube of radius + `offset` is
/// then usable (its sections do not cross), else automatic_smoothing. Throws GeometryError.
CentrelineFit fit_centreline(const Centreline& line, std::optional<double> smoothing, const geometry::Normal& normal,
                             double offset);

/// Tolerance for the radius beside one for the points: no more than 5 % of the smallest radius.
double radius_tolerance(const Centreline& line, double smoothing);

/// Clearance radius + offset along `from` <= S <= from + length of the fit's axis, or of the same part run backwards.
geometry::FittedClearance fit_radius(const Centreline& line, const CentrelineFit& fit, double offset, double tolerance,
                                     double from, double length, bool reversed);

}  // namespace tendril::io

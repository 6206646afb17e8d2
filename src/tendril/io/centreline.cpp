#include "tendril/io/centreline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tendril/geometry/tube_check.hpp"
#include "tendril/io/units.hpp"

namespace tendril::io {
namespace {

using geometry::GeometryError;
using geometry::Vec3;

constexpr double kFarthest = 1e15;  // a coordinate beyond it is no place, and its square would not be a number

// Units as the trade writes them, to the names of units.hpp.
std::string common_unit(const std::string& unit) {
  const std::string plain = plain_name(unit);
  if (unit == "m" || unit == "mm" || unit == "in") return unit;
  if (plain == "m" || plain == "metre" || plain == "meter" || plain == "metres" || plain == "meters") return "m";
  if (plain == "mm" || plain == "cm" || plain == "um" || plain == "km" || plain == "in") return plain;
  if (plain == "ft" || plain == "f" || plain == "feet" || plain == "foot") return "ft";
  if (plain == "deg" || plain == "dega" || plain == "degree" || plain == "degrees") return "deg";
  if (plain == "rad" || plain == "radian" || plain == "radians") return "rad";
  return unit;
}

std::optional<double> size_of(const std::string& unit, Dimension dimension, const Place& place, Issues& issues) {
  try {
    return parse_unit(common_unit(unit), dimension);
  } catch (const UnitError& error) {
    Issue& issue = issues.add(place, "", "the unit of the file: " + std::string(error.what()));
    issue.hint = error.hint;
    return std::nullopt;
  }
}

// Size of the file's unit of length in case units.
double length_scale(const std::string& in_file, bool has_units, const CentrelineRequest& request, const Place& place,
                    const std::string& name, const std::string& what, Issues& issues, const Complain& complain,
                    std::vector<std::string>& notes) {
  std::string unit = in_file;
  if (!request.unit.empty()) {
    if (unit.empty()) {
      unit = request.unit;
    } else if (common_unit(unit) != common_unit(request.unit)) {
      Issue& issue = complain("tube.axis.file_unit", "`tube.axis.file_unit` contradicts the file");
      issue.value = request.unit;
      issue.bound = unit + ", as " + name + " says";
      return 1.0;
    }
  }
  if (!request.si) {
    if (!unit.empty())
      notes.push_back(name + ": " + what + " are taken as written, in " + unit + " (units = \"dimensionless\")");
    return 1.0;
  }
  if (unit.empty() && !has_units && request.need_unit) {
    Issue& issue = complain("tube.axis.file", "files of this format do not say their unit of length");
    issue.hint = "add file_unit = \"mm\" (VMTK, 3D Slicer) or file_unit = \"cm\" (many SimVascular models)";
    return 1.0;
  }
  if (unit.empty()) {
    notes.push_back(name + ": " + what + " have no unit, taken as m");
    return 1.0;
  }
  const double size = size_of(unit, Dimension::length, place, issues).value_or(1.0);
  if (size != 1.0) notes.push_back(name + ": " + what + " converted from " + unit + " to m");
  return size;
}

std::string more(long count) { return count > 1 ? " (and " + std::to_string(count - 1) + " more)" : std::string(); }

// Numbers that cannot be a place or a radius.
void check_numbers(const PolylineFile& file, Issues& issues) {
  long wild = 0, thin = 0;
  std::size_t first_wild = 0, first_thin = 0;
  for (std::size_t i = 0; i < file.points.size(); ++i) {
    if (!(file.points[i].cwiseAbs().maxCoeff() < kFarthest) || !file.points[i].allFinite()) {
      if (wild++ == 0) first_wild = i;
    }
    if (!file.radius.empty() && !(file.radius[i] > 0 && file.radius[i] < kFarthest)) {
      if (thin++ == 0) first_thin = i;
    }
  }
  if (wild > 0) {
    const Vec3& p = file.points[first_wild];
    Issue& issue = issues.add(file.place_of(first_wild), "",
                              "this is not a finite number" + file.index_text(first_wild) + more(wild));
    issue.value = shortest(p[0]) + ", " + shortest(p[1]) + ", " + shortest(p[2]);
    issue.bound = "coordinates within " + shortest(kFarthest);
  }
  if (thin > 0) {
    Issue& issue = issues.add(file.rows.empty() ? file.radius_place : file.place_of(first_thin), "",
                              "the radius must be > 0" + file.index_text(first_thin) + more(thin));
    issue.value = shortest(file.radius[first_thin]);
    issue.bound = "> 0";
  }
}

CentrelineFit fitted(const Centreline& line, double smoothing, const geometry::Normal& normal) {
  CentrelineFit fit;
  fit.axis = geometry::make_points(line.points, smoothing, normal);
  fit.smoothing = smoothing;
  return fit;
}

bool usable(const Centreline& line, const CentrelineFit& fit, double offset) {
  const double length = fit.axis.axis->length();
  const geometry::FittedClearance radius = fit_radius(line, fit, offset, 0.0, 0.0, length, false);
  std::vector<geometry::Issue> issues;
  geometry::measure_tube({fit.axis.axis, radius.clearance, geometry::Side::inside}, issues);
  return issues.empty();
}

}  // namespace

std::shared_ptr<const Source> read_source(const std::string& path, const std::string& name) {
  return std::make_shared<Source>(Source{name, read_text_file(path, kMaxFileBytes), false});
}

Centreline read_points(const std::shared_ptr<const Source>& source, const CentrelineRequest& request, Issues& issues,
                       const Complain& complain, std::vector<std::string>& notes) {
  Centreline out;
  out.name = source->name;
  const FileFormat format = format_of(source->name, source->text);
  out.format = format_name(format);
  const PolylineFile file = read_polylines(source, request.radius_array, issues);
  if (!issues.empty()) return out;
  if (file.points.empty() || file.lines.empty()) {
    issues.add(file.place, "", "the file has no points");
    return out;
  }
  check_numbers(file, issues);
  const bool has_units = format == FileFormat::csv || format == FileFormat::slicer_markups;
  const double scale =
      length_scale(file.unit, has_units, request, file.place, out.name, "lengths", issues, complain, notes);
  out.unit = file.unit.empty() ? request.unit : file.unit;
  double radius_scale = scale;
  if (common_unit(file.radius_unit) != common_unit(file.unit)) {
    if (request.si) {
      radius_scale = size_of(file.radius_unit, Dimension::length, file.place, issues).value_or(1.0);
      notes.push_back(out.name + ": the radius is converted from " + file.radius_unit);
    } else {
      Issue& issue = issues.add(file.place, "", "radius and coordinates have different units");
      issue.value = file.radius_unit + " and " + file.unit;
      issue.hint = "set units = \"si\" to have them converted";
    }
  }
  if (!issues.empty()) return out;
  bool complained = false;
  const std::vector<std::size_t> path =
      choose_path(file, request.path, [&](const std::string& key, const std::string& message) -> Issue& {
        complained = true;
        return complain(key, message);
      });
  if (complained) return out;
  if (path.size() < 2) {
    Issue& issue =
        issues.add(path.empty() ? file.place : file.place_of(path.front()), "", "a curve needs at least two points");
    issue.value = std::to_string(path.size());
    return out;
  }
  for (const std::string& note : file.notes) notes.push_back(out.name + ": " + note);
  for (const std::size_t i : path) {
    out.points.push_back(file.points[i]);
    if (!file.radius.empty()) out.radius.push_back(file.radius[i] * (radius_scale / scale));
    if (!file.rows.empty()) out.rows.push_back(file.rows[i]);
  }
  out.cleaning = clean_points(out.points, out.radius, out.rows, out.unit);
  for (const std::string& note : out.cleaning.notes) notes.push_back(out.name + ": " + note);
  if (out.points.size() < 2) {
    issues.add(file.place_of(path.front()), "", "all points of the curve are the same").bound = "at least two";
    return out;
  }
  for (Vec3& p : out.points) p *= scale;
  for (double& r : out.radius) r *= scale;
  out.cleaning.step_min *= scale, out.cleaning.step_max *= scale, out.cleaning.step_max_place *= scale;
  return out;
}

Centreline read_survey(const std::shared_ptr<const Source>& source, const CentrelineRequest& request, Issues& issues,
                       const Complain& complain, std::vector<std::string>& notes) {
  Centreline out;
  out.name = source->name;
  out.format = format_name(format_of(source->name, source->text));
  const SurveyFile file = read_stations(source, issues);
  if (!issues.empty() || file.md.empty()) return out;
  const Place units_place{source, file.units_row, 1, 1};
  const double md_scale =
      length_scale(file.md_unit, true, request, units_place, out.name, "depths", issues, complain, notes);
  out.unit = file.md_unit.empty() ? request.unit : file.md_unit;
  const auto degrees = [&](const std::string& unit) {
    const double size =
        unit.empty() ? std::numbers::pi / 180 : size_of(unit, Dimension::angle, units_place, issues).value_or(1.0);
    return size == std::numbers::pi / 180 ? 1.0 : size * 180 / std::numbers::pi;
  };
  const double inc_scale = degrees(file.inc_unit), azi_scale = degrees(file.azi_unit);
  if (!issues.empty()) return out;
  for (const std::string& note : file.notes) notes.push_back(out.name + ": " + note);
  constexpr double kDegreeRounding = 1e-9;  // of a conversion from rad
  constexpr std::size_t kMostIssues = 20;   // a wrong column repeats itself on every line
  for (std::size_t i = 0; i < file.md.size() && issues.size() < kMostIssues; ++i) {
    const double inc = file.inc[i] * inc_scale, azi = file.azi[i] * azi_scale;
    const bool again = i > 0 && file.md[i] == file.md[i - 1] && file.inc[i] == file.inc[i - 1] &&
                       file.azi[i] == file.azi[i - 1];  // cleaned away below
    if (!(std::abs(file.md[i]) < kFarthest && std::isfinite(inc) && std::isfinite(azi))) {
      issues.add(file.place_of(i), "", "this is not a finite number");
      continue;
    }
    if (i > 0 && file.md[i] <= file.md[i - 1] && !again) {
      Issue& issue = issues.add(file.place_of(i), "", "measured depth must increase from station to station");
      issue.value = shortest(file.md[i]) + " after " + shortest(file.md[i - 1]);
      issue.bound = "> " + shortest(file.md[i - 1]);
    }
    if (inc < 0 || inc > 180 + kDegreeRounding) {
      Issue& issue = issues.add(file.place_of(i), "", "inclination is out of bounds");
      issue.value = shortest(inc) + " deg";
      issue.bound = ">= 0 and <= 180 deg, from vertical";
    }
    if (azi < 0 || azi > 360 + kDegreeRounding) {
      Issue& issue = issues.add(file.place_of(i), "", "azimuth is out of bounds");
      issue.value = shortest(azi) + " deg";
      issue.bound = ">= 0 and <= 360 deg, clockwise from north";
    }
    out.md.push_back(file.md[i] * md_scale);
    out.inc.push_back(inc);
    out.azi.push_back(azi);
    out.rows.push_back(file.rows[i]);
  }
  if (!issues.empty()) return out;
  out.cleaning = clean_stations(out.md, out.inc, out.azi, out.rows, request.si ? "m" : out.unit);
  for (const std::string& note : out.cleaning.notes) notes.push_back(out.name + ": " + note);
  if (out.md.size() < 2) issues.add(file.place_of(0), "", "a survey needs at least two stations");
  return out;
}

double automatic_smoothing(const Centreline& line) {
  std::vector<double> radius = line.radius;
  const auto middle = radius.begin() + static_cast<std::ptrdiff_t>(radius.size() / 2);
  std::nth_element(radius.begin(), middle, radius.end());
  return kSmoothingShare * *middle;
}

CentrelineFit fit_centreline(const Centreline& line, std::optional<double> smoothing, const geometry::Normal& normal,
                             double offset) {
  if (smoothing) return fitted(line, *smoothing, normal);
  if (line.radius.empty()) return fitted(line, 0.0, normal);
  std::optional<CentrelineFit> exact;
  try {
    exact = fitted(line, 0.0, normal);
    if (usable(line, *exact, offset)) return *exact;
  } catch (const GeometryError&) {  // a kink or a turning point, which smoothing may remove
  }
  CentrelineFit fit = fitted(line, automatic_smoothing(line), normal);
  fit.automatic = true;
  return fit;
}

double radius_tolerance(const Centreline& line, double smoothing) {
  constexpr double kShare = 0.05;
  return std::min(smoothing, kShare * *std::min_element(line.radius.begin(), line.radius.end()));
}

geometry::FittedClearance fit_radius(const Centreline& line, const CentrelineFit& fit, double offset, double tolerance,
                                     double from, double length, bool reversed) {
  std::vector<double> S, value;
  const double smallest_hop = 1e-9 * length;
  for (std::size_t i = 0; i < fit.axis.S.size(); ++i) {
    const double at = fit.axis.S[i] - from;
    if (!S.empty() && at <= S.back() + smallest_hop) continue;
    S.push_back(at);
    value.push_back(line.radius[i] + offset);
  }
  if (reversed) {
    for (double& at : S) at = length - at;
    std::reverse(S.begin(), S.end());
    std::reverse(value.begin(), value.end());
  }
  return geometry::make_smooth_table(S, value, length, tolerance);
}

}  // namespace tendril::io

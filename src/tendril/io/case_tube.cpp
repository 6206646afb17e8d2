// [tube] and [tube.axis] to a geometry::Tube. What geometry refuses is reported at the key that caused it.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/axis_transforms.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/geometry/error.hpp"
#include "tendril/geometry/fitted_axes.hpp"
#include "tendril/geometry/tube_check.hpp"
#include "tendril/io/assemble.hpp"
#include "tendril/io/centreline.hpp"

namespace tendril::io {
namespace {

using geometry::AxisPtr;
using geometry::ClearancePtr;
using geometry::Vec3;

constexpr double kSurveyDeviation = 0.01;  // of the smallest clearance: well below what a contact position can feel

Vec3 vector(const Case& c, const std::string& key, const Vec3& fallback) {
  return {c.component(key, 0, fallback[0]), c.component(key, 1, fallback[1]), c.component(key, 2, fallback[2])};
}

// "points[17]" of a file also by its line there.
std::string line_of(const Check& check, const std::string& field) {
  const std::size_t bracket = field.find('[');
  if (!check.c.centreline || bracket == std::string::npos || field.compare(0, 9, "clearance") == 0) return "";
  const auto index = static_cast<std::size_t>(std::strtoul(field.c_str() + bracket + 1, nullptr, 10));
  if (index >= check.c.centreline->rows.size()) return "";
  return " (" + check.c.centreline->name + ":" + std::to_string(check.c.centreline->rows[index]) + ")";
}

void report(const Check& check, const std::string& key, const geometry::GeometryError& error,
            const std::string& advice = {}) {
  for (const geometry::Issue& found : error.issues) {
    Issue& issue = check.add(key, found.field + line_of(check, found.field) + ": " + found.problem);
    issue.hint = found.hint + (advice.empty() ? "" : (found.hint.empty() ? "" : "; ") + advice);
  }
}

// Keys of [tube.axis] that this kind does not take, and those it cannot do without.
bool axis_keys(const Check& check, const std::string& kind) {
  const std::size_t before = check.issues.size();
  for (const Key* key : children("tube.axis")) {
    if (key->kinds.empty() || !check.given(key->path)) continue;
    if (std::find(key->kinds.begin(), key->kinds.end(), kind) != key->kinds.end()) continue;
    Issue& issue = check.add(key->path, "`" + key->path + "` does not belong to kind = \"" + kind + "\"");
    for (const std::string& owner : key->kinds) issue.bound += (issue.bound.empty() ? "kind " : ", ") + owner;
  }
  const auto need = [&](const char* name) {
    const std::string key = std::string("tube.axis.") + name;
    if (check.given(key)) return;
    Issue& issue = check.add("tube.axis", "missing key `" + key + "` for kind = \"" + kind + "\"");
    issue.hint = find_key(key)->doc;
  };
  if (kind == "straight" || kind == "arc" || kind == "helix") need("length");
  if (kind == "arc")
    check.exactly_one("tube.axis", {"tube.axis.radius", "tube.axis.curvature"}, "how much the arc bends");
  if (kind == "helix") need("radius"), need("pitch_angle");
  if (kind == "torus") need("major_radius");
  if (kind == "points") check.exactly_one("tube.axis", {"tube.axis.points", "tube.axis.file"}, "where the points are");
  if (kind == "survey") need("file");
  return check.issues.size() == before && !check.issues.has("tube.axis");
}

double smallest(const std::vector<double>& numbers) {
  if (numbers.size() == 1) return numbers[0];
  double value = HUGE_VAL;
  for (std::size_t i = 1; i < numbers.size(); i += 2) value = std::min(value, numbers[i]);
  return value;
}

// Clearance as the case gives it: one number or S, value pairs.
std::optional<std::vector<double>> clearance_numbers(const Check& check, bool radius_in_file) {
  const Case& c = check.c;
  const bool outside = c.word("tube.side", "inside") == "outside";
  std::string key;
  if (!check.given("tube.clearance") && !check.given("tube.radius") && radius_in_file) {
    key = "file";
  } else {
    key =
        check.exactly_one("tube", {"tube.clearance", "tube.radius"}, "a points file may bring a radius column instead");
  }
  if (key == "tube.clearance") {
    if (!c.has(key)) return std::nullopt;
    return c.numbers.at(key);
  }
  const std::optional<double> rod = rod_radius(c);
  if (key.empty() || check.issues.has("tube.rod_radius")) return std::nullopt;
  if (!rod) {
    check.add(key == "file" ? "tube" : key, "the radius of the tube needs the radius of the rod").hint =
        "give `tube.rod_radius`, `rod.diameter` or `rod.outer_diameter`, or give `tube.clearance`";
    return std::nullopt;
  }
  std::vector<double> numbers;
  if (key == "file") {
    numbers.resize(2 * c.centreline->radius.size());  // their S is known when the curve is
    for (std::size_t i = 0; i < c.centreline->radius.size(); ++i) numbers[2 * i + 1] = c.centreline->radius[i];
  } else if (c.has(key)) {
    numbers = c.numbers.at(key);
  } else {
    return std::nullopt;
  }
  for (std::size_t i = numbers.size() == 1 ? 0 : 1; i < numbers.size(); i += 2) numbers[i] += outside ? *rod : -*rod;
  if (const double least = smallest(numbers); !(least > 0)) {
    Issue& issue = check.add(key == "file" ? "tube.axis.file" : key, "the rod does not fit into the tube");
    if (key == "file") {
      const auto& radius = c.centreline->radius;
      const auto at = static_cast<std::size_t>(std::min_element(radius.begin(), radius.end()) - radius.begin());
      if (at < c.centreline->rows.size()) issue.hint = "narrowest at line " + std::to_string(c.centreline->rows[at]);
    }
    issue.value = "clearance " + shortest(least) + " with a rod of radius " + shortest(*rod);
    issue.bound = "> 0";
    return std::nullopt;
  }
  return numbers;
}

AxisPtr make_whole_axis(const Case& c, const std::string& kind, const geometry::Normal& normal) {
  const double length = c.number("tube.axis.length");
  if (kind == "straight") {
    return geometry::make_straight(length, vector(c, "tube.axis.direction", Vec3::UnitZ()),
                                   vector(c, "tube.axis.origin", Vec3::Zero()), normal);
  }
  if (kind == "arc") {
    const double radius =
        c.has("tube.axis.curvature") ? 1 / c.number("tube.axis.curvature") : c.number("tube.axis.radius");
    return geometry::make_arc(radius, length, normal);
  }
  if (kind == "helix")
    return geometry::make_helix(c.number("tube.axis.radius"), c.number("tube.axis.pitch_angle"), length, normal);
  if (kind == "torus") return geometry::make_torus(c.number("tube.axis.major_radius"), normal);
  return nullptr;
}

std::string length_text(const Case& c, double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return std::string(text) + (c.si ? " m" : "");
}

// Through or near the points of the case; tells what smoothing did.
CentrelineFit points_axis(const Check& check, bool own_clearance, const geometry::Normal& normal) {
  const Case& c = check.c;
  const Centreline& line = *c.centreline;
  std::optional<double> smoothing;
  if (c.has("tube.axis.smoothing")) smoothing = c.number("tube.axis.smoothing");
  const bool wanted = c.word("tube.axis.smoothing") == "auto";
  if (wanted) smoothing = automatic_smoothing(line);
  const double rod = rod_radius(c).value_or(0.0);
  const double offset = c.word("tube.side", "inside") == "outside" ? rod : -rod;
  CentrelineFit fit;
  if (smoothing || line.radius.empty() || own_clearance) {  // whether the tube is usable then depends on more
    fit = fit_centreline(line, smoothing.value_or(0.0), normal, offset);
  } else {
    fit = fit_centreline(line, {}, normal, offset);
  }
  if (check.curve) {
    check.curve->smoothing = fit.smoothing;
    check.curve->automatic = fit.automatic || wanted;
    check.curve->deviation = fit.axis.largest_deviation;
    check.curve->deviation_S = fit.axis.deviation_S;
  }
  if (check.notes && fit.smoothing > 0) {
    const std::string name = line.name.empty() ? "" : line.name + ": ";
    check.notes->push_back(
        name +
        (fit.automatic ? "an exact curve through the points folds the tube, so they are smoothed within "
                       : "points smoothed within ") +
        length_text(c, fit.smoothing) + (fit.automatic || wanted ? " (15 % of the median radius)" : "") +
        "; largest deviation " + length_text(c, fit.axis.largest_deviation) +
        " at S = " + length_text(c, fit.axis.deviation_S));
  }
  return fit;
}

AxisPtr survey_axis(const Check& check, double deviation, const geometry::Normal& normal) {
  const Centreline& line = *check.c.centreline;
  const geometry::FittedAxis fit = geometry::make_survey(line.md, line.inc, line.azi, deviation, normal);
  if (check.curve) {
    check.curve->smoothing = deviation;
    check.curve->deviation = fit.largest_deviation;
    check.curve->deviation_S = fit.deviation_S;
  }
  return fit.axis;
}

// The part of the axis between `from` and `to`, by S of the whole curve.
std::optional<std::pair<double, double>> part_of(const Check& check, const std::string& kind, double length) {
  const double origin = kind == "survey" && check.c.centreline ? check.c.centreline->md.front() : 0.0;
  const double from = check.c.number("tube.axis.from", origin), to = check.c.number("tube.axis.to", origin + length);
  if (check.issues.has("tube.axis.from") || check.issues.has("tube.axis.to")) return std::nullopt;
  const double rounding = 1e-12 * (std::abs(origin) + length);
  const std::string bound = ">= " + shortest(origin) + " and <= " + shortest(origin + length);
  for (const auto& [key, value] : {std::pair{"tube.axis.from", from}, std::pair{"tube.axis.to", to}}) {
    if (value >= origin - rounding && value <= origin + length + rounding) continue;
    Issue& issue = check.add(key, "`" + std::string(key) + "` lies outside the curve");
    issue.value = shortest(value);
    issue.bound = bound;
    return std::nullopt;
  }
  if (!(to > from)) {
    Issue& issue = check.add("tube.axis.to", "`tube.axis.to` must be beyond `tube.axis.from`");
    issue.value = shortest(to);
    issue.bound = "> " + shortest(from);
    return std::nullopt;
  }
  return std::pair{std::max(from - origin, 0.0), std::min(to - origin, length)};
}

// Clearance from the radius column, smoothed with the points.
ClearancePtr radius_clearance(const Check& check, const CentrelineFit& fit, double offset, double from, double length,
                              bool reversed) {
  const Case& c = check.c;
  const Centreline& line = *c.centreline;
  const double tolerance = c.number("tube.axis.radius_smoothing", radius_tolerance(line, fit.smoothing));
  const geometry::FittedClearance fitted = fit_radius(line, fit, offset, tolerance, from, length, reversed);
  if (check.curve) {
    check.curve->radius_smoothing = tolerance;
    check.curve->radius_deviation = fitted.largest_deviation;
    check.curve->radius_deviation_S = fitted.deviation_S;
  }
  if (check.notes && tolerance > 0) {
    check.notes->push_back(line.name + ": radius smoothed within " + length_text(c, tolerance) +
                           "; largest deviation " + length_text(c, fitted.largest_deviation) +
                           " at S = " + length_text(c, fitted.deviation_S));
  }
  return fitted.clearance;
}

// What may help where sections of the tube cross.
std::string advice(const Check& check, const std::string& kind) {
  if (kind != "points" || !check.c.centreline || check.c.has("tube.axis.smoothing")) return "";
  if (check.curve && check.curve->automatic)
    return "the points are smoothed already, within " + length_text(check.c, check.curve->smoothing) +
           " (15 % of the median radius)";
  if (check.c.centreline->radius.empty()) return "`tube.axis.smoothing` gives points that jitter a smooth curve";
  return "smoothing = \"auto\" allows 15 % of the median radius";
}

}  // namespace

void check_scaled_tube(const Check& check, const geometry::Tube& tube, double factor) {
  try {
    geometry::check_tube({tube.axis, geometry::scaled(tube.clearance, factor), tube.side});
  } catch (const geometry::GeometryError& error) {
    report(check, "tube.clearance", error);
  }
}

std::optional<geometry::Tube> assemble_tube(const Check& check) {
  const Case& c = check.c;
  const std::string kind = c.word("tube.axis.kind");
  const bool keys_good = !kind.empty() && axis_keys(check, kind);
  const bool radius_in_file = c.centreline && !c.centreline->radius.empty();
  const bool file_failed = check.given("tube.axis.file") && !c.centreline;
  std::optional<std::vector<double>> numbers;
  if (!file_failed || check.given("tube.clearance") || check.given("tube.radius"))
    numbers = clearance_numbers(check, radius_in_file);
  if (!keys_good) return std::nullopt;

  geometry::Tube tube;
  tube.side = c.word("tube.side", "inside") == "outside" ? geometry::Side::outside : geometry::Side::inside;
  double from = 0.0;
  const bool reversed = c.word("tube.axis.reverse") == "true";
  std::optional<CentrelineFit> fit;
  const bool own_clearance = check.given("tube.clearance") || check.given("tube.radius");
  if ((kind == "points" || kind == "survey") && !c.centreline) return std::nullopt;
  try {
    const double deviation = c.number("tube.axis.deviation", numbers ? kSurveyDeviation * smallest(*numbers) : 0.0);
    if (kind == "survey" && !(deviation > 0)) return std::nullopt;  // the clearance is missing, which has been reported
    geometry::Normal normal;
    if (c.has("tube.axis.normal")) normal = vector(c, "tube.axis.normal", Vec3::Zero());
    if (kind == "points") {
      if (c.word("tube.axis.smoothing") == "auto" && !radius_in_file) {
        check.add("tube.axis.smoothing", "smoothing = \"auto\" is a share of the radius, and the file has none").hint =
            "give a tolerance, e.g. one tenth of the radius of the tube";
        return std::nullopt;
      }
      fit = points_axis(check, own_clearance, normal);
      tube.axis = fit->axis.axis;
    } else if (kind == "survey") {
      tube.axis = survey_axis(check, deviation, normal);
    } else {
      tube.axis = make_whole_axis(c, kind, normal);
    }
    if (!tube.axis) return std::nullopt;
    const bool cut = c.has("tube.axis.from") || c.has("tube.axis.to");
    if (const auto part = part_of(check, kind, tube.axis->length()); !part) {
      return std::nullopt;
    } else if (cut) {
      from = part->first;
      tube.axis = geometry::subrange(tube.axis, part->first, part->second);
    }
    if (reversed) tube.axis = geometry::reverse(tube.axis);
    if (cut || reversed) tube.axis = geometry::with_normal(tube.axis, normal);
  } catch (const geometry::GeometryError& error) {
    report(check, c.has("tube.axis.file") ? "tube.axis.file" : "tube.axis", error);
    return std::nullopt;
  }
  if (!numbers) return std::nullopt;
  const std::string key = check.given("tube.clearance") ? "tube.clearance"
                          : check.given("tube.radius")  ? "tube.radius"
                                                        : "tube.axis.file";
  try {
    const double length = tube.axis->length();
    if (numbers->size() == 1) {
      tube.clearance = geometry::make_constant((*numbers)[0]);
    } else if (own_clearance) {
      std::vector<double> S, value;
      for (std::size_t i = 0; i < numbers->size(); i += 2) {
        S.push_back((*numbers)[i]);
        value.push_back((*numbers)[i + 1]);
      }
      tube.clearance = geometry::make_table(S, value, length);
    } else {
      tube.clearance = radius_clearance(check, *fit, (*numbers)[1] - c.centreline->radius[0], from, length, reversed);
    }
    geometry::check_tube(tube);
  } catch (const geometry::GeometryError& error) {
    report(check, key, error, advice(check, kind));
    return std::nullopt;
  }
  return tube;
}

}  // namespace tendril::io

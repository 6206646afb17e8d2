// [tube] and [tube.axis] to a geometry::Tube. What geometry refuses is reported at the key that caused it.

#include <algorithm>
#include <cmath>

#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/axis_transforms.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/geometry/error.hpp"
#include "tendril/geometry/fitted_axes.hpp"
#include "tendril/geometry/tube_check.hpp"
#include "tendril/io/assemble.hpp"

namespace tendril::io {
namespace {

using geometry::AxisPtr;
using geometry::ClearancePtr;
using geometry::Vec3;

constexpr double kSurveyDeviation = 0.01;  // of the smallest clearance: well below what a contact position can feel

Vec3 vector(const Case& c, const std::string& key, const Vec3& fallback) {
  return {c.component(key, 0, fallback[0]), c.component(key, 1, fallback[1]), c.component(key, 2, fallback[2])};
}

void report(const Check& check, const std::string& key, const geometry::GeometryError& error) {
  for (const geometry::Issue& found : error.issues) {
    Issue& issue = check.add(key, found.field + ": " + found.problem);
    issue.hint = found.hint;
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
    numbers.resize(2 * c.centreline->radius.size());
    for (std::size_t i = 0; i < c.centreline->radius.size(); ++i) numbers[2 * i + 1] = c.centreline->radius[i];
  } else if (c.has(key)) {
    numbers = c.numbers.at(key);
  } else {
    return std::nullopt;
  }
  for (std::size_t i = numbers.size() == 1 ? 0 : 1; i < numbers.size(); i += 2) numbers[i] += outside ? *rod : -*rod;
  if (const double least = smallest(numbers); !(least > 0)) {
    Issue& issue = check.add(key == "file" ? "tube.axis.file" : key, "the rod does not fit into the tube");
    issue.value = "clearance " + shortest(least) + " with a rod of radius " + shortest(*rod);
    issue.bound = "> 0";
    return std::nullopt;
  }
  return numbers;
}

AxisPtr make_whole_axis(const Case& c, const std::string& kind, double deviation, const geometry::Normal& normal) {
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
  if (!c.centreline) return nullptr;
  if (kind == "points")
    return geometry::make_points(c.centreline->points, c.number("tube.axis.smoothing"), normal).axis;
  return geometry::make_survey(c.centreline->md, c.centreline->inc, c.centreline->azi, deviation, normal).axis;
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

// S of each point on the curve through (or near) them: its foot, found by Newton from the chord's estimate.
std::vector<double> places_of(const geometry::Axis& axis, const std::vector<Vec3>& points) {
  std::vector<double> S{0.0};
  for (std::size_t i = 1; i < points.size(); ++i) {
    double s = S.back() + (points[i] - points[i - 1]).norm();
    for (int iteration = 0; iteration < 8; ++iteration) {
      s = std::clamp(s, S.back(), axis.length());
      const geometry::AxisPoint at = axis.at(s);
      const double step = (points[i] - at.position).dot(at.frame.col(2));
      s += step;
      if (std::abs(step) < 1e-13 * axis.length()) break;
    }
    S.push_back(std::clamp(s, S.back(), axis.length()));
  }
  S.back() = axis.length();
  return S;
}

// Clearance from the radius column: rows at S of the whole curve, of which [from, from + length] is used.
ClearancePtr clearance_along(const std::vector<double>& whole, const std::vector<double>& pairs, double from,
                             double length, bool reversed) {
  std::vector<double> S, value;
  const double smallest_hop = 1e-9 * length;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const double at = whole[i] - from;
    if (!S.empty() && at <= S.back() + smallest_hop) continue;
    S.push_back(at);
    value.push_back(pairs[2 * i + 1]);
  }
  if (reversed) {
    for (double& at : S) at = length - at;
    std::reverse(S.begin(), S.end());
    std::reverse(value.begin(), value.end());
  }
  return geometry::make_table(S, value, length);
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
  const bool file_failed = check.issues.has("tube.axis.file");
  std::optional<std::vector<double>> numbers;
  if (!file_failed || check.given("tube.clearance") || check.given("tube.radius"))
    numbers = clearance_numbers(check, radius_in_file);
  if (!keys_good) return std::nullopt;

  geometry::Tube tube;
  tube.side = c.word("tube.side", "inside") == "outside" ? geometry::Side::outside : geometry::Side::inside;
  double from = 0.0;
  const bool reversed = c.word("tube.axis.reverse") == "true";
  std::vector<double> file_S;
  try {
    const double deviation = c.number("tube.axis.deviation", numbers ? kSurveyDeviation * smallest(*numbers) : 0.0);
    if (kind == "survey" && !(deviation > 0)) return std::nullopt;  // the clearance is missing, which has been reported
    geometry::Normal normal;
    if (c.has("tube.axis.normal")) normal = vector(c, "tube.axis.normal", Vec3::Zero());
    tube.axis = make_whole_axis(c, kind, deviation, normal);
    if (!tube.axis) return std::nullopt;
    if (numbers && radius_in_file && !check.given("tube.clearance") && !check.given("tube.radius")) {
      file_S = places_of(*tube.axis, c.centreline->points);
    }
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
    } else if (file_S.empty()) {
      std::vector<double> S, value;
      for (std::size_t i = 0; i < numbers->size(); i += 2) {
        S.push_back((*numbers)[i]);
        value.push_back((*numbers)[i + 1]);
      }
      tube.clearance = geometry::make_table(S, value, length);
    } else {
      tube.clearance = clearance_along(file_S, *numbers, from, length, reversed);
    }
    geometry::check_tube(tube);
  } catch (const geometry::GeometryError& error) {
    report(check, key, error);
    return std::nullopt;
  }
  return tube;
}

}  // namespace tendril::io

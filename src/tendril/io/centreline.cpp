// Centrelines (x, y, z[, radius]) and directional surveys (md, inc, azi) from CSV files, converted to case units.

#include <cmath>
#include <numbers>

#include "tendril/io/assemble.hpp"
#include "tendril/io/csv.hpp"

namespace tendril::io {
namespace {

constexpr std::size_t kMaxRows =
    2000000;  // twice the longest centreline in use; one spline piece is some hundred bytes

const std::vector<std::string> kX{"x", "px", "points:0"}, kY{"y", "py", "points:1"}, kZ{"z", "pz", "points:2"};
const std::vector<std::string> kRadius{"radius", "r", "maximuminscribedsphereradius", "misr"};
const std::vector<std::string> kMd{"md", "measured depth", "measured_depth", "depth", "dept", "mdepth"};
const std::vector<std::string> kInc{"inc", "incl", "inclination", "deviation", "dev"};
const std::vector<std::string> kAzi{"azi", "azim", "azimuth", "az", "hazi"};

// Size of a column's unit in case units: SI, or 1 for a dimensionless case, whose numbers are taken as given.
double scale_of(const CsvTable& table, std::size_t column, Dimension dimension, bool si, Issues& issues) {
  if (table.columns.empty() || table.columns[column].unit.empty())
    return dimension == Dimension::angle ? std::numbers::pi / 180 : 1.0;
  if (!si && dimension == Dimension::length) return 1.0;
  try {
    return parse_unit(table.columns[column].unit, dimension);
  } catch (const UnitError& error) {
    Issue& issue =
        add_at(issues, table, table.header_line, "column `" + table.columns[column].name + "`: " + error.what());
    issue.hint = error.hint;
    return 1.0;
  }
}

// Column indices by name, or by position in a file without header.
std::vector<std::size_t> find_columns(const CsvTable& table, const std::vector<std::vector<std::string>>& wanted,
                                      Issues& issues) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    std::size_t column = table.columns.empty() ? (i < table.width ? i : CsvTable::npos) : table.column(wanted[i]);
    if (column == CsvTable::npos) {
      Issue& issue = add_at(issues, table, table.columns.empty() ? table.lines.front() : table.header_line,
                            "column `" + wanted[i].front() + "` is missing");
      for (const CsvColumn& c : table.columns) issue.value += (issue.value.empty() ? "columns " : ", ") + c.name;
      for (std::size_t k = 1; k < wanted[i].size(); ++k)
        issue.bound += (k > 1 ? ", " : "also known as ") + wanted[i][k];
    }
    found.push_back(column);
  }
  return found;
}

// In a dimensionless case lengths keep their numbers, so their units must at least agree.
void same_units(const CsvTable& table, const std::vector<std::size_t>& columns, Issues& issues) {
  for (const std::size_t column : columns) {
    if (table.columns.empty() || table.columns[column].unit == table.columns[columns.front()].unit) continue;
    add_at(issues, table, table.header_line, "lengths of this file have different units").hint =
        "set units = \"si\" to have them converted";
    return;
  }
}

}  // namespace

Centreline read_points_file(const std::string& path, const std::string& name, bool si, Issues& issues,
                            std::vector<std::string>& notes) {
  Centreline out;
  const CsvTable table = read_csv(path, name, kMaxRows, issues);
  if (table.rows() == 0) return out;
  auto columns = find_columns(table, {kX, kY, kZ}, issues);
  if (!issues.empty()) return out;
  std::size_t radius = table.columns.empty() ? (table.width > 3 ? 3 : CsvTable::npos) : table.column(kRadius);
  std::vector<double> scale;
  if (radius != CsvTable::npos) columns.push_back(radius);
  for (const std::size_t column : columns) scale.push_back(scale_of(table, column, Dimension::length, si, issues));
  if (!si) same_units(table, columns, issues);
  if (!si && !table.columns.empty() && !table.columns[columns[0]].unit.empty()) {
    notes.push_back(name + ": lengths are taken as written, in " + table.columns[columns[0]].unit +
                    " (units = \"dimensionless\")");
  }
  out.points.reserve(table.rows());
  long repeated = 0, thin = 0;
  int repeated_line = 0, thin_line = 0;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const geometry::Vec3 point(table.at(i, columns[0]) * scale[0], table.at(i, columns[1]) * scale[1],
                               table.at(i, columns[2]) * scale[2]);
    if (!out.points.empty() && point == out.points.back() && repeated++ == 0) repeated_line = table.lines[i];
    out.points.push_back(point);
    if (radius == CsvTable::npos) continue;
    out.radius.push_back(table.at(i, radius) * scale[3]);
    if (!(out.radius.back() > 0) && thin++ == 0) thin_line = table.lines[i];
  }
  const auto more = [](long count) {
    return count > 1 ? " (and " + std::to_string(count - 1) + " more)" : std::string();
  };
  if (repeated > 0)
    add_at(issues, table, repeated_line, "this point repeats the one before it" + more(repeated)).hint =
        "remove the duplicates";
  if (thin > 0) add_at(issues, table, thin_line, "the radius must be > 0" + more(thin));
  if (table.rows() < 2) add_at(issues, table, table.lines[0], "a curve needs at least two points");
  return out;
}

Centreline read_survey_file(const std::string& path, const std::string& name, bool si, Issues& issues,
                            std::vector<std::string>& notes) {
  Centreline out;
  const CsvTable table = read_csv(path, name, kMaxRows, issues);
  if (table.rows() == 0) return out;
  const auto columns = find_columns(table, {kMd, kInc, kAzi}, issues);
  if (!issues.empty()) return out;
  const double md_scale = scale_of(table, columns[0], Dimension::length, si, issues);
  const auto degrees = [&](std::size_t column) {
    const double size = scale_of(table, column, Dimension::angle, si, issues);
    return size == std::numbers::pi / 180 ? 1.0 : size * 180 / std::numbers::pi;
  };
  const double inc_scale = degrees(columns[1]), azi_scale = degrees(columns[2]);
  if (!si && !table.columns.empty() && !table.columns[columns[0]].unit.empty()) {
    notes.push_back(name + ": depths are taken as written, in " + table.columns[columns[0]].unit +
                    " (units = \"dimensionless\")");
  }
  constexpr double kDegreeRounding = 1e-9;  // of a conversion from rad
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const double md = table.at(i, columns[0]) * md_scale, inc = table.at(i, columns[1]) * inc_scale,
                 azi = table.at(i, columns[2]) * azi_scale;
    if (!out.md.empty() && md <= out.md.back()) {
      Issue& issue = add_at(issues, table, table.lines[i], "measured depth must increase from station to station");
      issue.value = shortest(table.at(i, columns[0])) + " after " + shortest(table.at(i - 1, columns[0]));
    }
    if (inc < 0 || inc > 180 + kDegreeRounding) {
      Issue& issue = add_at(issues, table, table.lines[i], "inclination is out of bounds");
      issue.value = shortest(inc) + " deg";
      issue.bound = ">= 0 and <= 180 deg, from vertical";
    }
    if (azi < 0 || azi > 360 + kDegreeRounding) {
      Issue& issue = add_at(issues, table, table.lines[i], "azimuth is out of bounds");
      issue.value = shortest(azi) + " deg";
      issue.bound = ">= 0 and <= 360 deg, clockwise from north";
    }
    if (issues.size() >= 20) break;  // a wrong column repeats itself on every line
    out.md.push_back(md);
    out.inc.push_back(inc);
    out.azi.push_back(azi);
  }
  if (table.rows() < 2) add_at(issues, table, table.lines[0], "a survey needs at least two stations");
  return out;
}

}  // namespace tendril::io

#include "quality.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "console.hpp"
#include "tables.hpp"
#include "tendril/geometry/error.hpp"
#include "tendril/geometry/tube_check.hpp"
#include "tendril/io/centreline.hpp"

namespace tendril::app {
namespace {

using geometry::Vec3;
using Row = std::vector<std::string>;

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kSurveyDeviation = 1e-3;  // m, of the spline from the minimum-curvature hole
constexpr double kDoglegLength = 30.0;     // m

std::string cell(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-"; }

// What is printed of all files together.
struct Report {
  std::vector<Row> points, surveys;
  std::vector<std::string> findings;
  int refused = 0;

  void refuse(const std::string& name, const std::vector<io::Issue>& issues) {
    ++refused;
    message(io::render(issues, use_colour(stderr)));
    findings.push_back(name + ": refused: " + issues.front().message);
  }
};

// One path of a centreline file.
void points_row(const io::Centreline& line, const std::string& name, const QualityOptions& options, Report& report) {
  std::optional<double> smoothing;
  if (options.smoothing == "auto" && !line.radius.empty()) smoothing = io::automatic_smoothing(line);
  if (!options.smoothing.empty() && options.smoothing != "auto") smoothing = io::parse_number(options.smoothing);
  Row row{name, std::to_string(line.points.size()), line.unit.empty() ? "-" : line.unit};
  const auto radius_range = [&](double value) { return line.radius.empty() ? std::string("-") : cell(value); };
  const auto extremes = std::minmax_element(line.radius.begin(), line.radius.end());
  const std::string narrow = radius_range(line.radius.empty() ? 0 : *extremes.first),
                    wide = radius_range(line.radius.empty() ? 0 : *extremes.second);
  try {
    const io::CentrelineFit fit = io::fit_centreline(line, smoothing, {}, 0.0);
    geometry::Tube tube{fit.axis.axis, geometry::make_constant(1.0), geometry::Side::inside};
    const double length = tube.length();
    double tolerance = 0.0;
    if (!line.radius.empty()) {
      tolerance = io::radius_tolerance(line, fit.smoothing);
      tube.clearance = io::fit_radius(line, fit, 0.0, tolerance, 0.0, length, false).clearance;
    }
    std::vector<geometry::Issue> issues;
    const geometry::TubeQuality q = geometry::measure_tube(tube, issues);
    const bool folds = !line.radius.empty() && !issues.empty();
    for (const std::string& text : {cell(length), narrow, wide, cell(line.cleaning.step_min),
                                    cell(line.cleaning.step_max), cell(q.total_bend * kDegrees), cell(q.curvature_max),
                                    line.radius.empty() ? std::string("-") : cell(q.curvature_clearance_max),
                                    cell(line.radius.empty() ? q.curvature_max_S : q.curvature_clearance_max_S),
                                    fit.smoothing > 0 ? cell(fit.smoothing) : std::string("exact"),
                                    cell(fit.axis.largest_deviation), std::string(folds ? "folds" : "good")})
      row.push_back(text);
    if (fit.automatic)
      report.findings.push_back(name + ": an exact curve would fold the tube: smoothed within " + cell(fit.smoothing) +
                                " (15 % of the median radius), largest deviation " + cell(fit.axis.largest_deviation) +
                                " at S = " + cell(fit.axis.deviation_S));
    if (folds) {
      ++report.refused;
      report.findings.push_back(name + ": refused: radius x curvature " + cell(q.curvature_clearance_max) +
                                " at S = " + cell(q.curvature_clearance_max_S) + " (radius " +
                                cell(tube.clearance->at(q.curvature_clearance_max_S)[0]) + "), must stay below 1");
    }
  } catch (const geometry::GeometryError& error) {
    ++report.refused;
    for (const std::string& text : Row{"-", narrow, wide, cell(line.cleaning.step_min), cell(line.cleaning.step_max),
                                       "-", "-", "-", "-", "-", "-", "refused"})
      row.push_back(text);
    report.findings.push_back(name + ": refused: " + error.what());
  }
  report.points.push_back(std::move(row));
}

void points_file(const std::shared_ptr<const io::Source>& source, const std::string& name,
                 const QualityOptions& options, Report& report) {
  io::CentrelineRequest request;
  request.radius_array = options.radius_array;
  request.path.branch = options.branch;
  request.path.ends = options.ends;
  const auto read = [&](const std::string& label) {
    io::Issues issues;
    std::vector<std::string> notes;
    const io::Complain complain = [&](const std::string&, const std::string& message) -> io::Issue& {
      return issues.add({source, 0, 0, 1}, "", message);
    };
    const io::Centreline line = io::read_points(source, request, issues, complain, notes);
    if (!issues.empty()) return report.refuse(label, issues.list());
    points_row(line, label, options, report);
    for (const std::string& note : notes) {
      if (note.find("taken as written") == std::string::npos &&
          std::find(report.findings.begin(), report.findings.end(), note) == report.findings.end())
        report.findings.push_back(note);
    }
  };
  if (!options.branch.empty() || !options.ends.empty()) return read(name);
  // A tree: from its widest end to every other one.
  io::Issues issues;
  const io::PolylineFile file = io::read_polylines(source, options.radius_array, issues);
  const std::vector<io::TreeEnd> ends =
      issues.empty() && file.lines.size() > 1 ? io::tree_ends(file) : std::vector<io::TreeEnd>{};
  if (ends.size() <= 2) return read(name);
  std::size_t from = 0;
  for (std::size_t i = 1; i < ends.size() && !file.radius.empty(); ++i) {
    if (file.radius[ends[i].point] > file.radius[ends[from].point]) from = i;
  }
  report.findings.push_back(name + ": a tree of " + std::to_string(file.lines.size()) +
                            " lines; its ends: " + io::list_ends(file, ends));
  constexpr std::size_t kMostPaths = 40;
  for (std::size_t to = 0, shown = 0; to < ends.size() && shown < kMostPaths; ++to) {
    if (to == from) continue;
    ++shown;
    request.path.ends = {from, to};
    read(fmt::format("{} ends = [{}, {}]", name, from, to));
  }
}

Vec3 tangent(double inc, double azi) {
  inc /= kDegrees, azi /= kDegrees;
  return {std::sin(inc) * std::cos(azi), std::sin(inc) * std::sin(azi), std::cos(inc)};
}

void survey_file(const std::shared_ptr<const io::Source>& source, const std::string& name, Report& report) {
  io::CentrelineRequest request;
  request.si = true;
  io::Issues issues;
  std::vector<std::string> notes;
  const io::Complain complain = [&](const std::string&, const std::string& message) -> io::Issue& {
    return issues.add({source, 0, 0, 1}, "", message);
  };
  const io::Centreline line = io::read_survey(source, request, issues, complain, notes);
  if (!issues.empty()) return report.refuse(name, issues.list());
  double bend = 0.0, sharpest = 0.0, where = line.md.front();
  for (std::size_t i = 1; i < line.md.size(); ++i) {
    const Vec3 a = tangent(line.inc[i - 1], line.azi[i - 1]), b = tangent(line.inc[i], line.azi[i]);
    const double angle = std::atan2(a.cross(b).norm(), a.dot(b)) * kDegrees;
    bend += angle;
    const double severity = angle / (line.md[i] - line.md[i - 1]) * kDoglegLength;
    if (severity > sharpest) sharpest = severity, where = line.md[i - 1];
  }
  Row row{name, std::to_string(line.md.size()), cell(line.md.back() - line.md.front())};
  try {
    const geometry::FittedAxis axis = geometry::make_survey(line.md, line.inc, line.azi, kSurveyDeviation);
    const Vec3 end = axis.axis->at(axis.axis->length()).position;
    for (const std::string& text :
         {cell(end.z()), cell(std::hypot(end.x(), end.y())), cell(*std::max_element(line.inc.begin(), line.inc.end())),
          cell(line.cleaning.step_min), cell(line.cleaning.step_max), cell(bend), cell(sharpest), cell(where),
          cell(axis.largest_deviation), std::string("good")})
      row.push_back(text);
  } catch (const geometry::GeometryError& error) {
    ++report.refused;
    for (int i = 0; i < 9; ++i) row.push_back("-");
    row.push_back("refused");
    report.findings.push_back(name + ": refused: " + error.what());
  }
  report.surveys.push_back(std::move(row));
  for (const std::string& note : notes) report.findings.push_back(note);
}

bool is_survey(const std::shared_ptr<const io::Source>& source) {
  const io::FileFormat format = io::format_of(source->name, source->text);
  if (format == io::FileFormat::csv) return io::names_a_survey(source);
  return format == io::FileFormat::las || format == io::FileFormat::witsml;
}

// Columns are aligned to the right, names to the left.
std::string table(std::vector<Row> rows) {
  std::size_t width = 0;
  for (const Row& row : rows) width = std::max(width, row.front().size());
  for (Row& row : rows) row.front() += std::string(width - row.front().size(), ' ');
  return aligned(rows);
}

}  // namespace

bool is_geometry(const std::string& file) {
  const std::filesystem::path path(file);
  if (path.extension() == ".toml") return false;
  return io::is_geometry_file(file, path.extension() == ".json" ? io::read_text_file(file, io::kMaxFileBytes) : "");
}

int quality(const QualityOptions& options) {
  if (!options.smoothing.empty() && options.smoothing != "auto") {
    const auto number = io::parse_number(options.smoothing);
    if (!number || !(*number >= 0) || !std::isfinite(*number)) {
      message("tendril: --smoothing: a number >= 0, in the unit of the file, or auto\n");
      return kUsage;
    }
  }
  Report report;
  for (const std::string& file : options.files) {
    const std::string name = std::filesystem::path(file).filename().string();
    const auto source = io::read_source(file, name);
    if (is_survey(source))
      survey_file(source, name, report);
    else
      points_file(source, name, options, report);
  }
  if (!report.points.empty()) {
    report.points.insert(report.points.begin(),
                         {"centreline", "points", "unit", "length", "r min", "r max", "step min", "step max",
                          "bend deg", "K max", "K r max", "at S", "smoothed", "deviation", ""});
    print(table(report.points));
  }
  if (!report.surveys.empty()) {
    report.surveys.insert(report.surveys.begin(),
                          {"survey", "stations", "length m", "depth m", "offset m", "inc deg", "step min", "step max",
                           "bend deg", "deg/30m", "at md", "deviation", ""});
    print((report.points.empty() ? "" : "\n") + table(report.surveys));
  }
  if (!options.quiet && !report.findings.empty()) {
    std::string text = "findings\n";
    for (const std::string& finding : report.findings) text += "  " + finding + "\n";
    print("\n" + text);
  }
  return report.refused > 0 ? kInvalid : kSolved;
}

}  // namespace tendril::app

#pragma once
// What the readers of this directory return: a centreline file as points and lines, a survey as stations, numbers as
// written with the units the file names. Readers take the whole text, report everything wrong with it as issues with
// line and column, and never allocate more than a small multiple of the text's own size.

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tendril/geometry/axis.hpp"
#include "tendril/io/diagnostics.hpp"

namespace tendril::io {

constexpr std::size_t kMaxFileBytes = std::size_t{512} << 20;
constexpr std::size_t kMaxFilePoints = 2000000;  // twice the longest centreline in use

enum class FileFormat { csv, vtp, simvascular_path, slicer_markups, las, witsml };

/// "VTK PolyData", "LAS", ...
std::string_view format_name(FileFormat format);

/// By what the text starts with, and by the extension where the text does not tell; CSV if neither does.
FileFormat format_of(std::string_view name, std::string_view text);

/// Whether the name or the text is that of a centreline or survey file rather than of a case.
bool is_geometry_file(std::string_view name, std::string_view text);

/// Polylines, with the radius of the tube at each point where the file has one.
struct PolylineFile {
  std::shared_ptr<const Source> source;
  std::vector<geometry::Vec3> points;           // as written; RAS turned to LPS
  std::vector<double> radius;                   // as many, or none
  std::vector<std::vector<std::size_t>> lines;  // indices of points
  std::string unit, radius_unit;                // as written; empty: the file does not say
  std::vector<int> rows;                        // line of the file of each point; empty: they share `place`
  Place place, radius_place;                    // of the points as a whole, and of their radius
  std::vector<std::string> notes;

  /// Where point i is written.
  Place place_of(std::size_t i) const { return rows.empty() ? place : Place{source, rows[i], 1, 1}; }
  /// " (point 17)" for files whose points have no line of their own.
  std::string index_text(std::size_t i) const { return rows.empty() ? " (point " + std::to_string(i) + ")" : ""; }
};

/// Stations of a directional survey, in the order of the file.
struct SurveyFile {
  std::shared_ptr<const Source> source;
  std::vector<double> md, inc, azi;         // as written
  std::string md_unit, inc_unit, azi_unit;  // as written; empty: the file does not say
  int units_row = 0;                        // line that names them; 0: none
  std::vector<int> rows;                    // line of the file of each station
  std::vector<std::string> notes;

  Place place_of(std::size_t i) const { return {source, rows[i], 1, 1}; }
};

/// Point array that holds the radius; empty: MaximumInscribedSphereRadius, Radius, ...
PolylineFile read_polylines(const std::shared_ptr<const Source>& source, const std::string& radius_array,
                            Issues& issues);

/// Whether the header of a table names the columns of a survey.
bool names_a_survey(const std::shared_ptr<const Source>& source);

SurveyFile read_stations(const std::shared_ptr<const Source>& source, Issues& issues);

/// Lower case, letters and digits only: names of columns and arrays are compared in this form.
std::string plain_name(std::string_view name);

/// Names under which a radius, a measured depth, an inclination and an azimuth are known, in plain form.
const std::vector<std::string>& radius_names();
const std::vector<std::string>& depth_names();
const std::vector<std::string>& inclination_names();
const std::vector<std::string>& azimuth_names();

/// A number and nothing else; "nan" and "inf" are numbers here.
std::optional<double> parse_number(std::string_view text);

// One reader each.
PolylineFile read_polydata(const std::shared_ptr<const Source>& source, const std::string& radius_array,
                           Issues& issues);
PolylineFile read_simvascular_path(const std::shared_ptr<const Source>& source, Issues& issues);
PolylineFile read_slicer_markups(const std::shared_ptr<const Source>& source, Issues& issues);
PolylineFile read_points_table(const std::shared_ptr<const Source>& source, const std::string& radius_array,
                               Issues& issues);
SurveyFile read_survey_table(const std::shared_ptr<const Source>& source, Issues& issues);
SurveyFile read_las(const std::shared_ptr<const Source>& source, Issues& issues);
SurveyFile read_witsml(const std::shared_ptr<const Source>& source, Issues& issues);

}  // namespace tendril::io

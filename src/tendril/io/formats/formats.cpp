// Which format a file has, and the names that its columns and arrays go by.

#include <charconv>

#include "tendril/io/formats/polyline_file.hpp"

namespace tendril::io {
namespace {

bool ends_with(std::string_view text, std::string_view tail) {
  if (text.size() < tail.size()) return false;
  for (std::size_t i = 0; i < tail.size(); ++i) {
    const char c = text[text.size() - tail.size() + i];
    if ((c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c) != tail[i]) return false;
  }
  return true;
}

std::string_view start_of(std::string_view text) {
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
  const std::size_t from = text.find_first_not_of(" \t\r\n");
  return from == std::string_view::npos ? std::string_view{} : text.substr(from);
}

void legacy_vtk(const std::shared_ptr<const Source>& source, Issues& issues) {
  issues.add({source, 1, 1, 1}, "", "this is the legacy format of VTK").hint = "save it as XML (.vtp)";
}

bool is_legacy_vtk(std::string_view text) { return start_of(text).substr(0, 14) == "# vtk DataFile"; }

void wrong_kind(const std::shared_ptr<const Source>& source, FileFormat format, const char* kind, const char* other,
                Issues& issues) {
  Issue& issue =
      issues.add({source, 0, 0, 1}, "", "this file cannot be read with kind = \"" + std::string(kind) + "\"");
  issue.value = format_name(format);
  issue.hint = "kind = \"" + std::string(other) + "\"?";
}

}  // namespace

std::string_view format_name(FileFormat format) {
  switch (format) {
    case FileFormat::csv:
      return "table of text";
    case FileFormat::vtp:
      return "VTK PolyData";
    case FileFormat::simvascular_path:
      return "SimVascular path";
    case FileFormat::slicer_markups:
      return "Slicer markups";
    case FileFormat::las:
      return "LAS";
    case FileFormat::witsml:
      return "WITSML trajectory";
  }
  return "";
}

FileFormat format_of(std::string_view name, std::string_view text) {
  const std::string_view start = start_of(text).substr(0, 4096);
  if (!start.empty() && start.front() == '<') {
    if (start.find("<VTKFile") != std::string_view::npos) return FileFormat::vtp;
    if (start.find("rajectory") != std::string_view::npos) return FileFormat::witsml;
    if (start.find("<path") != std::string_view::npos) return FileFormat::simvascular_path;
    return ends_with(name, ".pth")   ? FileFormat::simvascular_path
           : ends_with(name, ".vtp") ? FileFormat::vtp
                                     : FileFormat::witsml;
  }
  if (!start.empty() && start.front() == '{') return FileFormat::slicer_markups;
  if (!start.empty() && start.front() == '~') return FileFormat::las;
  if (ends_with(name, ".vtp")) return FileFormat::vtp;
  if (ends_with(name, ".pth")) return FileFormat::simvascular_path;
  if (ends_with(name, ".mrk.json")) return FileFormat::slicer_markups;
  if (ends_with(name, ".las")) return FileFormat::las;
  return FileFormat::csv;
}

bool is_geometry_file(std::string_view name, std::string_view text) {
  for (const char* extension :
       {".csv", ".vtp", ".pth", ".mrk.json", ".las", ".xml", ".witsml", ".dat", ".txt", ".tsv"}) {
    if (ends_with(name, extension)) return true;
  }
  const std::string_view start = start_of(text).substr(0, 4096);
  return !start.empty() && (start.front() == '<' || start.front() == '~' ||
                            (start.front() == '{' && start.find("\"markups\"") != std::string_view::npos));
}

PolylineFile read_polylines(const std::shared_ptr<const Source>& source, const std::string& radius_array,
                            Issues& issues) {
  const FileFormat format = format_of(source->name, source->text);
  if (is_legacy_vtk(source->text)) {
    legacy_vtk(source, issues);
    return {};
  }
  switch (format) {
    case FileFormat::vtp:
      return read_polydata(source, radius_array, issues);
    case FileFormat::simvascular_path:
      return read_simvascular_path(source, issues);
    case FileFormat::slicer_markups:
      return read_slicer_markups(source, issues);
    case FileFormat::csv:
      return read_points_table(source, radius_array, issues);
    default:
      wrong_kind(source, format, "points", "survey", issues);
      return {};
  }
}

SurveyFile read_stations(const std::shared_ptr<const Source>& source, Issues& issues) {
  const FileFormat format = format_of(source->name, source->text);
  switch (format) {
    case FileFormat::las:
      return read_las(source, issues);
    case FileFormat::witsml:
      return read_witsml(source, issues);
    case FileFormat::csv:
      return read_survey_table(source, issues);
    default:
      wrong_kind(source, format, "survey", "points", issues);
      return {};
  }
}

std::string plain_name(std::string_view name) {
  std::string out;
  for (const char c : name) {
    if (c >= 'A' && c <= 'Z') out += static_cast<char>(c - 'A' + 'a');
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) out += c;
  }
  return out;
}

const std::vector<std::string>& radius_names() {
  static const std::vector<std::string> names{"maximuminscribedsphereradius", "radius",          "misr", "r",
                                              "inscribedsphereradius",        "centerlineradius"};
  return names;
}

const std::vector<std::string>& depth_names() {
  static const std::vector<std::string> names{"md", "measureddepth", "mdepth", "depthmd", "depth", "dept"};
  return names;
}

const std::vector<std::string>& inclination_names() {
  static const std::vector<std::string> names{"inc", "incl", "inclination",     "deviation",
                                              "dev", "devi", "holeinclination", "sdev"};
  return names;
}

const std::vector<std::string>& azimuth_names() {
  static const std::vector<std::string> names{"azi",  "azim", "azimuth",     "az",          "hazi", "holeazimuth",
                                              "azit", "azig", "azimuthtrue", "azimuthgrid", "haz"};
  return names;
}

std::optional<double> parse_number(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || end.ec != std::errc() || end.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace tendril::io

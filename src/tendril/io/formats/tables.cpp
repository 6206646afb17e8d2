// Tables of text with a centreline (x, y, z and perhaps a radius) or a survey (md, inc, azi).

#include "tendril/io/csv.hpp"
#include "tendril/io/formats/polyline_file.hpp"

namespace tendril::io {
namespace {

using Names = std::vector<std::string>;

const Names kX{"x", "px", "points0"}, kY{"y", "py", "points1"}, kZ{"z", "pz", "points2"};

Names together(const std::vector<Names>& lists) {
  Names all;
  for (const Names& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

// Column indices by name, or by position in a file without header.
std::vector<std::size_t> find_columns(const CsvTable& table, const std::vector<Names>& wanted, Issues& issues) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const std::size_t column = table.columns.empty() ? (i < table.width ? i : CsvTable::npos) : table.column(wanted[i]);
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

std::string unit_of(const CsvTable& table, std::size_t column) {
  return table.columns.empty() ? std::string() : table.columns[column].unit;
}

void same_unit(const CsvTable& table, std::size_t a, std::size_t b, Issues& issues) {
  if (unit_of(table, a) == unit_of(table, b)) return;
  const auto shown = [&](std::size_t column) {
    const std::string unit = unit_of(table, column);
    return table.columns[column].name + (unit.empty() ? " without unit" : " in " + unit);
  };
  Issue& issue = add_at(issues, table, table.header_line, "columns that belong together have different units");
  issue.value = shown(a) + ", " + shown(b);
  issue.bound = "the same unit";
}

void tell_preamble(const CsvTable& table, std::vector<std::string>& notes) {
  if (table.preamble > 0)
    notes.push_back(std::to_string(table.preamble) + (table.preamble == 1 ? " line" : " lines") +
                    " above the header skipped");
}

}  // namespace

bool names_a_survey(const std::shared_ptr<const Source>& source) {
  constexpr std::size_t kLook = 1 << 16;  // the header is near the start
  const auto start = std::make_shared<Source>(Source{source->name, source->text.substr(0, kLook), false});
  Issues ignored;
  const CsvTable table = read_csv(start, kMaxFilePoints,
                                  together({depth_names(), inclination_names(), azimuth_names(), kX, kY, kZ}), ignored);
  const auto has = [&](const Names& names) { return table.column(names) != CsvTable::npos; };
  if (has(kX) && has(kY)) return false;
  return has(depth_names()) + has(inclination_names()) + has(azimuth_names()) >= 2;
}

PolylineFile read_points_table(const std::shared_ptr<const Source>& source, const std::string& radius_array,
                               Issues& issues) {
  PolylineFile out;
  out.source = source;
  const Names radius_wanted = radius_array.empty() ? radius_names() : Names{plain_name(radius_array)};
  const CsvTable table = read_csv(source, kMaxFilePoints, together({kX, kY, kZ}), issues);
  if (table.rows() == 0) return out;
  const auto columns = find_columns(table, {kX, kY, kZ}, issues);
  if (!issues.empty()) return out;
  same_unit(table, columns[0], columns[1], issues);
  if (issues.empty()) same_unit(table, columns[0], columns[2], issues);
  const std::size_t radius =
      table.columns.empty() ? (table.width > 3 ? 3 : CsvTable::npos) : table.column(radius_wanted);
  if (radius == CsvTable::npos && !radius_array.empty()) {
    Issue& issue = add_at(issues, table, table.header_line > 0 ? table.header_line : table.lines.front(),
                          "column `" + radius_array + "` is missing");
    for (const CsvColumn& c : table.columns) issue.value += (issue.value.empty() ? "columns " : ", ") + c.name;
  }
  if (!issues.empty()) return out;
  out.unit = unit_of(table, columns[0]);
  if (radius != CsvTable::npos) out.radius_unit = unit_of(table, radius);
  if (out.radius_unit.empty()) out.radius_unit = out.unit;
  out.place = {source, table.header_line > 0 ? table.header_line : table.lines.front(), 1, 1};
  out.points.reserve(table.rows());
  std::vector<std::size_t> line(table.rows());
  for (std::size_t i = 0; i < table.rows(); ++i) {
    out.points.emplace_back(table.at(i, columns[0]), table.at(i, columns[1]), table.at(i, columns[2]));
    if (radius != CsvTable::npos) out.radius.push_back(table.at(i, radius));
    line[i] = i;
  }
  out.rows = table.lines;
  out.lines.push_back(std::move(line));
  tell_preamble(table, out.notes);
  return out;
}

SurveyFile read_survey_table(const std::shared_ptr<const Source>& source, Issues& issues) {
  SurveyFile out;
  out.source = source;
  const CsvTable table =
      read_csv(source, kMaxFilePoints, together({depth_names(), inclination_names(), azimuth_names()}), issues);
  if (table.rows() == 0) return out;
  const auto columns = find_columns(table, {depth_names(), inclination_names(), azimuth_names()}, issues);
  if (!issues.empty()) return out;
  same_unit(table, columns[1], columns[2], issues);
  out.md_unit = unit_of(table, columns[0]);
  out.inc_unit = unit_of(table, columns[1]);
  out.azi_unit = unit_of(table, columns[2]);
  out.units_row = table.header_line;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    out.md.push_back(table.at(i, columns[0]));
    out.inc.push_back(table.at(i, columns[1]));
    out.azi.push_back(table.at(i, columns[2]));
  }
  out.rows = table.lines;
  tell_preamble(table, out.notes);
  return out;
}

}  // namespace tendril::io

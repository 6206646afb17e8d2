#include "tendril/io/csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "tendril/io/formats/polyline_file.hpp"

namespace tendril::io {
namespace {

constexpr int kMaxPreamble = 200;  // lines above the header

std::string_view trim(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '"'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

char sniff_delimiter(std::string_view line) {
  for (const char c : {';', '\t', ','}) {
    if (line.find(c) != std::string_view::npos) return c;
  }
  return ' ';
}

void split(std::string_view line, char delimiter, std::vector<std::string_view>& cells) {
  cells.clear();
  if (delimiter == ' ') {
    for (std::size_t i = 0; i < line.size();) {
      while (i < line.size() && (line[i] == ' ' || line[i] == '\t' || line[i] == '\r')) ++i;
      const std::size_t from = i;
      while (i < line.size() && line[i] != ' ' && line[i] != '\t' && line[i] != '\r') ++i;
      if (i > from) cells.push_back(trim(line.substr(from, i - from)));
    }
    return;
  }
  for (std::size_t from = 0;;) {
    const std::size_t to = line.find(delimiter, from);
    cells.push_back(trim(line.substr(from, to == std::string_view::npos ? to : to - from)));
    if (to == std::string_view::npos) break;
    from = to + 1;
  }
}

bool parse_cell(std::string_view cell, bool decimal_comma, double& value) {
  if (!cell.empty() && cell.front() == '+') cell.remove_prefix(1);
  std::string fixed;
  if (decimal_comma && cell.find(',') != std::string_view::npos) {
    fixed = std::string(cell);
    fixed[fixed.find(',')] = '.';
    cell = fixed;
  }
  const auto result = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return result.ec == std::errc() && result.ptr == cell.data() + cell.size() && !cell.empty();
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

// "x_mm", "x [mm]", "x (mm)", "Azi(deg)", "md" -> name and unit.
CsvColumn column_of(std::string_view cell) {
  const std::size_t bracket = cell.find_first_of("[(");
  if (bracket != std::string_view::npos) {
    const std::size_t close = cell.find_first_of("])", bracket);
    return {lower(trim(cell.substr(0, bracket))),
            std::string(trim(cell.substr(bracket + 1, close == std::string_view::npos ? close : close - bracket - 1)))};
  }
  const std::size_t bar = cell.rfind('_');
  if (bar != std::string_view::npos && bar + 1 < cell.size()) {
    const std::string_view unit = cell.substr(bar + 1);
    for (const std::string_view known : {"m", "mm", "cm", "um", "km", "in", "ft", "deg", "rad"}) {
      if (unit == known) return {lower(cell.substr(0, bar)), std::string(unit)};
    }
  }
  return {lower(cell), ""};
}

bool row_of_units(const std::vector<std::string_view>& cells) {
  for (const std::string_view cell : cells) {
    const std::string unit =
        lower(cell.size() > 2 && (cell.front() == '[' || cell.front() == '(') ? cell.substr(1, cell.size() - 2) : cell);
    bool known = unit.empty() || unit == "-";
    for (const std::string_view name :
         {"m", "mm", "cm", "um", "km", "in", "ft", "feet", "deg", "degrees", "rad", "\xC2\xB0"})
      known = known || unit == name;
    if (!known) return false;
  }
  return true;
}

// Line of the header that has at least two of these names, 0 if there is none.
int header_in(std::string_view text, const std::vector<std::string>& names) {
  std::vector<std::string_view> cells;
  int line_number = 0;
  for (std::size_t from = 0; from < text.size() && line_number < kMaxPreamble;) {
    const std::size_t to = std::min(text.find('\n', from), text.size());
    const std::string_view line = trim(text.substr(from, to - from));
    from = to + 1;
    ++line_number;
    constexpr std::size_t kLongestHeader = 10000;
    if (line.empty() || line.front() == '#' || line.size() > kLongestHeader) continue;
    split(line, sniff_delimiter(line), cells);
    int known = 0;
    for (const std::string_view cell : cells)
      known += std::find(names.begin(), names.end(), plain_name(column_of(cell).name)) != names.end();
    if (known >= 2) return line_number;
  }
  return 0;
}

}  // namespace

Issue& add_at(Issues& issues, const CsvTable& table, int line, std::string message) {
  return issues.add({table.source, line, 1, 1}, "", std::move(message));
}

std::size_t CsvTable::column(const std::vector<std::string>& names) const {
  for (const std::string& name : names) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (plain_name(columns[i].name) == name) return i;
    }
  }
  return npos;
}

CsvTable read_csv(const std::shared_ptr<const Source>& source, std::size_t max_rows,
                  const std::vector<std::string>& header_names, Issues& issues) {
  CsvTable table;
  table.source = source;
  std::string_view text = table.source->text;
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
  const int header = header_in(text, header_names);
  table.preamble = std::max(0, header - 1);

  // One message for each kind of defect: the first place and how many more.
  struct Defect {
    int line = 0;
    long count = 0;
    std::string value;
  } bad_number, not_finite, short_row;
  const auto note = [](Defect& defect, int line, std::string value) {
    if (defect.count++ == 0) defect.line = line, defect.value = std::move(value);
  };

  std::vector<std::string_view> cells;
  char delimiter = 0;
  bool decimal_comma = false, first_row = true;
  int line_number = 0;
  for (std::size_t from = 0; from < text.size();) {
    std::size_t to = text.find('\n', from);
    if (to == std::string_view::npos) to = text.size();
    const std::string_view line = trim(text.substr(from, to - from));
    from = to + 1;
    ++line_number;
    if (line.empty() || line.front() == '#' || line_number < header) continue;
    if (delimiter == 0) {
      delimiter = sniff_delimiter(line);
      decimal_comma = delimiter == ';';
    }
    split(line, delimiter, cells);
    if (first_row) {
      double number = 0.0;
      bool numeric = false;
      for (const auto cell : cells) numeric = numeric || parse_cell(cell, decimal_comma, number);
      if (!numeric && table.header_line == 0) {
        table.header_line = line_number;
        for (const auto cell : cells) table.columns.push_back(column_of(cell));
        continue;
      }
      if (!numeric && row_of_units(cells) && cells.size() == table.columns.size()) {
        for (std::size_t i = 0; i < cells.size(); ++i) {
          std::string_view unit = cells[i];
          if (unit.size() > 2 && (unit.front() == '[' || unit.front() == '(')) unit = unit.substr(1, unit.size() - 2);
          if (unit == "-") unit = {};
          std::string& known = table.columns[i].unit;
          if (!known.empty() && !unit.empty() && known != unit && issues.empty()) {
            Issue& issue = add_at(issues, table, line_number,
                                  "header and row of units disagree about column `" + table.columns[i].name + "`");
            issue.value = std::string(unit);
            issue.bound = known + ", as in the header";
          }
          if (!unit.empty()) known = std::string(unit);
        }
        continue;
      }
      first_row = false;
      table.width = table.columns.empty() ? cells.size() : table.columns.size();
    }
    if (cells.size() < table.width) {
      note(short_row, line_number, std::to_string(cells.size()) + " columns");
      continue;
    }
    if (table.rows() == max_rows) {
      Issue& issue = add_at(issues, table, line_number, "the file has too many rows");
      issue.bound = "at most " + std::to_string(max_rows);
      issue.hint = "thin the points out, or smooth them first";
      return table;
    }
    table.lines.push_back(line_number);
    for (std::size_t i = 0; i < table.width; ++i) {
      double value = 0.0;
      if (!parse_cell(cells[i], decimal_comma, value)) {
        note(bad_number, line_number, "\"" + std::string(cells[i]) + "\" in column " + std::to_string(i + 1));
      } else if (!std::isfinite(value)) {
        note(not_finite, line_number, "\"" + std::string(cells[i]) + "\" in column " + std::to_string(i + 1));
      }
      table.values.push_back(value);
    }
  }
  const auto report = [&](const Defect& defect, const std::string& message, const std::string& bound) {
    if (defect.count == 0) return;
    const std::string more = defect.count > 1 ? " (and on " + std::to_string(defect.count - 1) + " more lines)" : "";
    Issue& issue = add_at(issues, table, defect.line, message + more);
    issue.value = defect.value;
    issue.bound = bound;
  };
  report(short_row, "this row is too short", std::to_string(table.width) + " columns");
  report(bad_number, "this is not a number", "");
  report(not_finite, "this is not a finite number", "");
  if (table.rows() == 0 && issues.empty()) issues.add({table.source, 0, 0, 1}, "", "the file has no rows of numbers");
  return table;
}

}  // namespace tendril::io

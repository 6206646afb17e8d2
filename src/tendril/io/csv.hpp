#pragma once
// Tables of numbers as people export them: comma, semicolon, tab or blanks between columns, a header with names and
// units ("x_mm", "md [ft]", "inc (deg)") or none, a row of units, decimal commas beside semicolons, '#' comments.

#include <string>
#include <vector>

#include "tendril/io/diagnostics.hpp"

namespace tendril::io {

struct CsvColumn {
  std::string name;  // lower case, without its unit
  std::string unit;  // as written; empty: none
};

struct CsvTable {
  std::shared_ptr<const Source> source;
  int header_line = 0;             // 0: no header
  int preamble = 0;                // lines skipped above it
  std::vector<CsvColumn> columns;  // empty: no header
  std::size_t width = 0;           // columns of the first row of numbers
  std::vector<double> values;      // row by row, `width` each
  std::vector<int> lines;          // line of each row

  std::size_t rows() const { return lines.size(); }
  double at(std::size_t row, std::size_t column) const { return values[row * width + column]; }
  /// Index of the first column with the first of these names (plain_name) that there is, or npos.
  std::size_t column(const std::vector<std::string>& names) const;
  static constexpr std::size_t npos = static_cast<std::size_t>(-1);
};

/// Everything wrong with the content goes to `issues`, each kind once with its first line. A row with two of
/// `header_names` (plain_name) among its cells is the header, and what is above it is skipped; without one the header
/// is a first row without numbers.
CsvTable read_csv(const std::shared_ptr<const Source>& source, std::size_t max_rows,
                  const std::vector<std::string>& header_names, Issues& issues);

/// Issue at a line of the table.
Issue& add_at(Issues& issues, const CsvTable& table, int line, std::string message);

}  // namespace tendril::io

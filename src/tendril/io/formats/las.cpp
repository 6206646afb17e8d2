// LAS well logs, 1.2 and 2.0 (wrapped or not) and 3.0 with a comma, tab or space between values. The survey is in the
// curve section, or in the Inclinometry sections of LAS 3. Rows whose station has the file's NULL value are left out.

#include <algorithm>
#include <cmath>

#include "tendril/io/formats/polyline_file.hpp"

namespace tendril::io {
namespace {

constexpr std::size_t kMaxCurves = 1000;

std::string_view trim(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

// "DEPT.M   1000.0 : measured depth"
struct HeaderLine {
  std::string mnemonic, unit, value;
};

HeaderLine header_line(std::string_view line) {
  const std::size_t dot = line.find('.');
  if (dot == std::string_view::npos) return {};
  HeaderLine out;
  out.mnemonic = trim(line.substr(0, dot));
  const std::size_t blank = std::min(line.find_first_of(" \t:", dot + 1), line.size());
  out.unit = line.substr(dot + 1, blank - dot - 1);
  const std::size_t colon = line.rfind(':');
  const std::size_t stop = colon == std::string_view::npos || colon < blank ? line.size() : colon;
  out.value = trim(line.substr(blank, stop - blank));
  return out;
}

struct Curve {
  std::string name, unit;
};

enum class Section { other, version, well, curves, data };

class Reader {
 public:
  Reader(const std::shared_ptr<const Source>& source, Issues& issues) : source_(source), issues_(issues) {}

  SurveyFile read() {
    SurveyFile out;
    out.source = source_;
    const std::string_view text = source_->text;
    inclinometry_ = find_inclinometry(text);
    int number = 0;
    for (std::size_t from = 0; from < text.size() && !stop_;) {
      const std::size_t to = std::min(text.find('\n', from), text.size());
      const std::string_view line = trim(text.substr(from, to - from));
      from = to + 1;
      ++number;
      if (line.empty() || line.front() == '#') continue;
      if (line.front() == '~') {
        section(line, number);
      } else if (section_ == Section::data) {
        data(line, number, out);
      } else {
        header(line, number);
      }
    }
    if (!row_.empty() && !stop_) short_row(row_line_);
    if (issues_.empty()) finish(out);
    return out;
  }

 private:
  static bool find_inclinometry(std::string_view text) {
    for (std::size_t at = text.find('~'); at != std::string_view::npos; at = text.find('~', at + 1)) {
      if (plain_name(text.substr(at, 25)).rfind("inclinometrydata", 0) == 0) return true;
    }
    return false;
  }

  void section(std::string_view line, int number) {
    const std::string name = plain_name(line.substr(0, line.find('|')));
    const bool incl = name.rfind("inclinometry", 0) == 0;
    section_ = Section::other;
    if (name.empty()) return;
    if (incl) {
      if (name.find("definition") != std::string::npos) section_ = Section::curves;
      if (name.find("data") != std::string::npos) section_ = Section::data;
    } else if (name[0] == 'v') {
      section_ = Section::version;
    } else if (name[0] == 'w') {
      section_ = Section::well;
    } else if (!inclinometry_ && (name[0] == 'c' || name.rfind("logdefinition", 0) == 0)) {
      section_ = Section::curves;
    } else if (!inclinometry_ && (name[0] == 'a' || name.rfind("logdata", 0) == 0)) {
      section_ = Section::data;
    }
    if (section_ == Section::data) begin_data(number);
  }

  void header(std::string_view line, int number) {
    const HeaderLine h = header_line(line);
    const std::string name = plain_name(h.mnemonic);
    if (section_ == Section::version) {
      if (name == "wrap") wrapped_ = plain_name(h.value) == "yes";
      if (name == "dlm") {
        const std::string word = plain_name(h.value);
        delimiter_ = word == "comma" ? ',' : word == "tab" ? '\t' : ' ';
      }
    } else if (section_ == Section::well && name == "null") {
      null_ = parse_number(h.value);
    } else if (section_ == Section::curves && !h.mnemonic.empty()) {
      if (curves_.size() < kMaxCurves) {
        curves_.push_back({h.mnemonic, h.unit});
        curve_lines_.push_back(number);
      }
    }
  }

  // The three curves of a survey, by mnemonic.
  void begin_data(int number) {
    struct Wanted {
      const char* word;
      const std::vector<std::string>& names;
    };
    const Wanted wanted[3] = {
        {"measured depth", depth_names()}, {"inclination", inclination_names()}, {"azimuth", azimuth_names()}};
    for (int q = 0; q < 3; ++q) {
      const auto it = std::find_if(curves_.begin(), curves_.end(), [&](const Curve& curve) {
        const auto& names = wanted[q].names;
        return std::find(names.begin(), names.end(), plain_name(curve.name)) != names.end();
      });
      if (it != curves_.end()) {
        column_[q] = static_cast<std::size_t>(it - curves_.begin());
        continue;
      }
      Issue& issue = issues_.add({source_, curve_lines_.empty() ? number : curve_lines_.front(), 1, 1}, "",
                                 std::string("the curve of the ") + wanted[q].word + " is missing");
      for (const Curve& curve : curves_) issue.value += (issue.value.empty() ? "curves " : ", ") + curve.name;
      for (const std::string& name : wanted[q].names) issue.bound += (issue.bound.empty() ? "one of " : ", ") + name;
      stop_ = true;
    }
  }

  void data(std::string_view line, int number, SurveyFile& out) {
    if (row_.empty()) row_line_ = number;
    const auto cell = [&](std::string_view text) {
      text = trim(text);
      const auto value = parse_number(text);
      if (!value && bad_++ == 0) bad_line_ = number, bad_text_ = text.substr(0, 40);
      row_.push_back(value.value_or(0.0));
    };
    if (delimiter_ == ' ') {
      for (std::size_t from = 0; (from = line.find_first_not_of(" \t", from)) != std::string_view::npos;) {
        const std::size_t to = std::min(line.find_first_of(" \t", from), line.size());
        cell(line.substr(from, to - from));
        from = to;
      }
    } else {
      for (std::size_t from = 0;;) {
        const std::size_t to = line.find(delimiter_, from);
        cell(line.substr(from, to == std::string_view::npos ? to : to - from));
        if (to == std::string_view::npos) break;
        from = to + 1;
      }
    }
    if (wrapped_ && row_.size() < curves_.size()) return;
    if (row_.size() < curves_.size()) return short_row(number);
    if (out.md.size() >= kMaxFilePoints) {
      issues_.add({source_, number, 1, 1}, "", "the file has too many rows").bound =
          "at most " + std::to_string(kMaxFilePoints);
      stop_ = true;
      return;
    }
    const double md = row_[column_[0]], inc = row_[column_[1]], azi = row_[column_[2]];
    row_.clear();
    const auto absent = [&](double value) { return null_ && value == *null_; };
    if (absent(md) || absent(inc) || absent(azi)) {
      ++absent_;
      return;
    }
    if (!(std::isfinite(md) && std::isfinite(inc) && std::isfinite(azi)) && not_finite_++ == 0)
      not_finite_line_ = row_line_;
    out.md.push_back(md);
    out.inc.push_back(inc);
    out.azi.push_back(azi);
    out.rows.push_back(row_line_);
  }

  void short_row(int number) {
    Issue& issue = issues_.add({source_, number, 1, 1}, "", "this row is too short");
    issue.value = std::to_string(row_.size()) + " values";
    issue.bound = std::to_string(curves_.size()) + ", one for each curve";
    stop_ = true;
  }

  void finish(SurveyFile& out) {
    const auto more = [](long count) {
      return count > 1 ? " (and " + std::to_string(count - 1) + " more)" : std::string();
    };
    if (bad_ > 0)
      issues_.add({source_, bad_line_, 1, 1}, "", "this is not a number" + more(bad_)).value = "\"" + bad_text_ + "\"";
    if (not_finite_ > 0)
      issues_.add({source_, not_finite_line_, 1, 1}, "", "this is not a finite number" + more(not_finite_));
    if (out.md.empty() && issues_.empty()) {
      Issue& issue = issues_.add({source_, 0, 0, 1}, "", "the file has no stations");
      issue.hint = absent_ > 0 ? "in every row depth, inclination or azimuth has the NULL value" : "";
    }
    if (!issues_.empty()) return;
    out.md_unit = curves_[column_[0]].unit;
    out.inc_unit = curves_[column_[1]].unit;
    out.azi_unit = curves_[column_[2]].unit;
    out.units_row = curve_lines_[column_[0]];
    if (absent_ > 0) out.notes.push_back(std::to_string(absent_) + " rows left out that have the NULL value");
  }

  std::shared_ptr<const Source> source_;
  Issues& issues_;
  Section section_ = Section::other;
  bool inclinometry_ = false, wrapped_ = false, stop_ = false;
  char delimiter_ = ' ';
  std::optional<double> null_;
  std::vector<Curve> curves_;
  std::vector<int> curve_lines_;
  std::size_t column_[3] = {0, 0, 0};
  std::vector<double> row_;
  int row_line_ = 0;
  long bad_ = 0, not_finite_ = 0, absent_ = 0;
  int bad_line_ = 0, not_finite_line_ = 0;
  std::string bad_text_;
};

}  // namespace

SurveyFile read_las(const std::shared_ptr<const Source>& source, Issues& issues) {
  return Reader(source, issues).read();
}

}  // namespace tendril::io

#include "tendril/report/page.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "tendril/report/json_text.hpp"
#include "tendril/report/page_template.hpp"
#include "tendril/version.hpp"

namespace tendril::report {
namespace {

constexpr std::string_view kPlace = "\"TENDRIL_RESULT\"";
constexpr std::size_t kMaxTrace = 2000;  // points of a response curve: more than any screen shows

struct Column {
  std::string_view name;
  std::vector<std::string_view> cells;
};

struct StepText {
  std::string head;  // members without fields and state, compact, without the braces
  std::vector<Column> columns;
  std::vector<std::size_t> pinned;  // rows that thinning keeps: ends and junctions
  std::size_t rows = 0, bytes = 0;  // of the fields
};

double number(std::string_view text) {
  double value = NAN;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

void append_member(std::string& out, std::string_view key, std::string_view value) {
  if (!out.empty()) out += ',';
  out.append("\"").append(key).append("\":");
  append_compact(out, value);
}

StepText read_step(std::string_view text) {
  StepText step;
  const std::vector<TextMember> object = members(text);
  for (const TextMember& member : object) {
    if (member.key == "state") continue;
    if (member.key != "fields") {
      append_member(step.head, member.key, member.value);
      continue;
    }
    for (const TextMember& column : members(member.value)) {
      step.columns.push_back({column.key, items(column.value)});
      for (const std::string_view cell : step.columns.back().cells) step.bytes += cell.size() + 1;
    }
  }
  if (step.columns.empty()) return step;
  step.rows = step.columns.front().cells.size();
  for (const Column& column : step.columns) {
    if (column.cells.size() != step.rows) throw std::invalid_argument("fields of different length");
  }
  if (step.rows == 0) return step;
  std::vector<double> places;
  if (const std::string_view contacts = find(object, "contacts"); !contacts.empty()) {
    for (const std::string_view contact : items(contacts)) {
      const auto of = members(contact);
      places.push_back(number(find(of, "start")));
      places.push_back(number(find(of, "end")));
    }
  }
  std::sort(places.begin(), places.end());
  const auto S = std::find_if(step.columns.begin(), step.columns.end(), [](const Column& c) { return c.name == "S"; });
  step.pinned.push_back(0);
  if (S != step.columns.end()) {
    const double near = 1e-7 * std::abs(number(S->cells.back()));  // both sides of a junction
    for (std::size_t row = 1; row + 1 < step.rows; ++row) {
      const double at = number(S->cells[row]);
      const auto it = std::lower_bound(places.begin(), places.end(), at - near);
      if (it != places.end() && *it <= at + near) step.pinned.push_back(row);
    }
  }
  step.pinned.push_back(step.rows - 1);
  return step;
}

// At most `limit` rows: the pinned ones and even steps through the rest; even steps through all when too many are
// pinned.
std::vector<std::size_t> choose_rows(const StepText& step, std::size_t limit) {
  std::vector<std::size_t> rows;
  const std::size_t n = step.rows;
  if (n <= limit) {
    for (std::size_t i = 0; i < n; ++i) rows.push_back(i);
    return rows;
  }
  const std::size_t pinned = step.pinned.size() <= limit ? step.pinned.size() : 0;
  const std::size_t even = std::max<std::size_t>(limit - pinned, 2);
  for (std::size_t i = 0; i < even; ++i) rows.push_back(i * (n - 1) / (even - 1));
  if (pinned > 0) rows.insert(rows.end(), step.pinned.begin(), step.pinned.end());
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

std::string thin_trace(std::string_view trace, std::size_t& kept) {
  const std::vector<std::string_view> points = items(trace);
  std::string out = "[";
  kept = std::min(points.size(), kMaxTrace);
  for (std::size_t i = 0; i < kept; ++i) {
    if (i > 0) out += ',';
    append_compact(out, points[kept < 2 ? i : i * (points.size() - 1) / (kept - 1)]);
  }
  return out + "]";
}

}  // namespace

bool available() { return !page_template().empty(); }

std::string page(std::string_view result, const PageOptions& options) {
  if (!available()) throw std::logic_error("this build has no report page");
  return fill(page_template(), result, options);
}

std::string fill(std::string_view page_template, std::string_view result, const PageOptions& options) {
  const std::size_t place = page_template.find(kPlace);
  if (place == std::string_view::npos || page_template.find(kPlace, place + 1) != std::string_view::npos)
    throw std::logic_error("a page template holds \"TENDRIL_RESULT\" once");

  std::string head;  // everything but the steps
  std::vector<StepText> steps;
  bool seen = false;
  std::size_t trace_points = 0, trace_kept = 0;
  for (const TextMember& member : members(result)) {
    if (member.key == "steps") {
      seen = true;
      for (const std::string_view step : items(member.value)) steps.push_back(read_step(step));
    } else if (member.key == "trace") {
      trace_points = items(member.value).size();
      head += std::string(head.empty() ? "" : ",") + "\"trace\":" + thin_trace(member.value, trace_kept);
    } else {
      append_member(head, member.key, member.value);
    }
  }
  if (!seen) throw std::invalid_argument("a result has `steps`");

  // Rows that fit: what the template, the heads and a note leave of the limit.
  std::size_t used = page_template.size() + head.size() + 1000, field_bytes = 0, rows = 0, with_fields = 0;
  for (const StepText& step : steps) {
    used += step.head.size() + 300;  // 300: names of the columns
    field_bytes += step.bytes;
    rows += step.rows;
    with_fields += step.rows > 0;
  }
  const std::size_t room = options.max_bytes > used ? options.max_bytes - used : 0;
  std::size_t limit = rows, keep_steps = with_fields;
  if (field_bytes > room) {
    const double fits = static_cast<double>(room) / (static_cast<double>(field_bytes) / static_cast<double>(rows));
    limit = static_cast<std::size_t>(fits / static_cast<double>(with_fields));
    if (limit < options.min_rows) {
      limit = options.min_rows;
      keep_steps = std::clamp<std::size_t>(static_cast<std::size_t>(fits) / limit, 1, with_fields);
    }
  }

  std::string out(page_template.substr(0, place)), list;
  std::size_t kept = 0, number_with_fields = 0, steps_kept = 0;
  for (const StepText& step : steps) {
    if (!list.empty()) list += ',';
    list.append("{").append(step.head);
    if (step.rows > 0) {
      // even choice of keep_steps among with_fields, the last one always in it
      const std::size_t i = ++number_with_fields;
      if (i * keep_steps / with_fields != (i - 1) * keep_steps / with_fields) {
        ++steps_kept;
        const std::vector<std::size_t> chosen = choose_rows(step, limit);
        kept += chosen.size();
        list.append(step.head.empty() ? "" : ",").append("\"fields\":{");
        for (const Column& column : step.columns) {
          list.append(&column == &step.columns.front() ? "" : ",").append("\"").append(column.name).append("\":[");
          for (const std::size_t row : chosen) list.append(row == chosen.front() ? "" : ",").append(column.cells[row]);
          list += ']';
        }
        list += '}';
      }
    }
    list += '}';
  }
  const auto text = [](std::size_t n) { return std::to_string(n); };
  out += "{\"page\":{\"tendril\":\"" + std::string(version()) + "\",\"thinned\":";
  if (kept == rows && trace_kept == trace_points) {
    out += "null";
  } else {
    out += "{\"rows\":" + text(rows) + ",\"rows_kept\":" + text(kept) + ",\"steps\":" + text(with_fields) +
           ",\"steps_kept\":" + text(steps_kept) + ",\"trace\":" + text(trace_points) +
           ",\"trace_kept\":" + text(trace_kept) + "}";
  }
  out += "},\"result\":{" + head + (head.empty() ? "" : ",") + "\"steps\":[" + list + "]}}";
  out += page_template.substr(place + kPlace.size());
  return out;
}

}  // namespace tendril::report

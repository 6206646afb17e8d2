#include "tendril/io/diagnostics.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <tuple>

namespace tendril::io {
namespace {

std::string line_of(const std::string& text, int line) {
  std::size_t from = 0;
  for (int i = 1; i < line; ++i) {
    from = text.find('\n', from);
    if (from == std::string::npos) return {};
    ++from;
  }
  std::size_t to = text.find('\n', from);
  if (to == std::string::npos) to = text.size();
  if (to > from && text[to - 1] == '\r') --to;
  return text.substr(from, to - from);
}

bool continuation_byte(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

// Long lines are cut around the column, so that an inline list of points does not fill the screen.
constexpr int kExcerptBefore = 60, kExcerptAfter = 60;

std::string caret_block(const Issue& issue) {
  int column = 1;  // in bytes; the issue counts characters
  for (int i = 1; i < issue.column && column <= static_cast<int>(issue.excerpt.size()); ++i) {
    do ++column;
    while (column <= static_cast<int>(issue.excerpt.size()) && continuation_byte(issue.excerpt[column - 1]));
  }
  int from = std::max(0, column - 1 - kExcerptBefore);
  int to = std::min<int>(static_cast<int>(issue.excerpt.size()), column - 1 + kExcerptAfter);
  while (from > 0 && continuation_byte(issue.excerpt[from])) --from;
  while (to < static_cast<int>(issue.excerpt.size()) && continuation_byte(issue.excerpt[to])) ++to;
  std::string shown = (from > 0 ? "..." : "") + issue.excerpt.substr(from, to - from) +
                      (to < static_cast<int>(issue.excerpt.size()) ? "..." : "");
  const int caret_byte = column - 1 - from + (from > 0 ? 3 : 0);
  std::string marks;
  for (int i = 0; i < caret_byte && i < static_cast<int>(shown.size()); ++i) {
    if (!continuation_byte(shown[i])) marks += shown[i] == '\t' ? '\t' : ' ';
  }
  marks += '^';
  int marked = 1;
  for (int i = caret_byte + 1; i < static_cast<int>(shown.size()) && marked < issue.length; ++i) {
    if (continuation_byte(shown[i])) continue;
    marks += '~';
    ++marked;
  }
  const std::string number = std::to_string(issue.line);
  const std::string gutter(std::max<std::size_t>(number.size(), 5), ' ');
  return std::string(gutter.size() - number.size(), ' ') + number + " | " + shown + "\n" + gutter + " | " + marks +
         "\n";
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// Twice the edit distance in which swapping two neighbours is one edit (optimal string alignment); a wrong case is half
// an edit, so that kn is nearer to kN than to km.
int distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<int>> d(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = static_cast<int>(2 * i);
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = static_cast<int>(2 * j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int swap_in = a[i - 1] == b[j - 1] ? 0 : lower(a[i - 1]) == lower(b[j - 1]) ? 1 : 2;
      d[i][j] = std::min({d[i - 1][j] + 2, d[i][j - 1] + 2, d[i - 1][j - 1] + swap_in});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 2);
    }
  }
  return d[a.size()][b.size()];
}

std::string summary(const std::vector<Issue>& issues) {
  std::string text = render(issues);
  if (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

}  // namespace

InputError::InputError(std::vector<Issue> issues) : std::runtime_error(summary(issues)), issues_(std::move(issues)) {}

Issue& Issues::add(const Place& place, std::string key, std::string message) {
  Issue issue;
  if (place.source) {
    issue.file = place.source->name;
    issue.excerpt = place.line > 0 ? line_of(place.source->text, place.line) : std::string();
  }
  issue.line = place.line;
  issue.column = place.column;
  issue.length = place.length;
  issue.key = std::move(key);
  issue.message = std::move(message);
  list_.push_back(std::move(issue));
  return list_.back();
}

bool Issues::has(std::string_view key) const {
  return std::any_of(list_.begin(), list_.end(), [&](const Issue& issue) {
    return issue.key == key || (issue.key.size() > key.size() && issue.key.compare(0, key.size(), key) == 0 &&
                                issue.key[key.size()] == '.');
  });
}

void Issues::finish() {
  if (list_.empty()) return;
  // File by file in the order they came up, then by place; overrides keep their order.
  std::vector<std::string> files;
  for (const Issue& issue : list_) {
    if (std::find(files.begin(), files.end(), issue.file) == files.end()) files.push_back(issue.file);
  }
  const auto rank = [&](const Issue& issue) {
    const auto file = std::find(files.begin(), files.end(), issue.file) - files.begin();
    const bool override_text = issue.file == "--set";
    return std::tuple(file, override_text ? 0 : issue.line, override_text ? 0 : issue.column);
  };
  std::stable_sort(list_.begin(), list_.end(), [&](const Issue& a, const Issue& b) { return rank(a) < rank(b); });
  throw InputError(std::move(list_));
}

std::string render(const Issue& issue, bool colour) {
  const char* bold = colour ? "\033[1m" : "";
  const char* red = colour ? "\033[1;31m" : "";
  const char* off = colour ? "\033[0m" : "";
  std::string text = bold + issue.file;
  if (issue.line > 0) text += ":" + std::to_string(issue.line) + ":" + std::to_string(std::max(issue.column, 1));
  text += std::string(": ") + red + "error: " + off + bold + issue.message + off + "\n";
  if (issue.line > 0 && !issue.excerpt.empty()) text += caret_block(issue);
  if (!issue.value.empty()) text += "        found: " + issue.value + "\n";
  if (!issue.bound.empty()) text += "      allowed: " + issue.bound + "\n";
  if (!issue.hint.empty()) text += "         hint: " + issue.hint + "\n";
  return text;
}

std::string render(const std::vector<Issue>& issues, bool colour) {
  std::string text;
  for (const Issue& issue : issues) text += render(issue, colour);
  return text;
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  int best_distance = 2 * std::max<int>(1, static_cast<int>(word.size()) / 3) + 1;
  for (const std::string& candidate : candidates) {
    const int d = distance(word, candidate);
    if (d < best_distance) {
      best_distance = d;
      best = candidate;
    }
  }
  return best;
}

std::string shortest(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return std::string(buffer, end);
}

}  // namespace tendril::io

#include "tendril/geometry/error.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace tendril::geometry {

namespace {

std::string message(const std::vector<Issue>& issues) {
  std::string text;
  for (const Issue& issue : issues) {
    if (!text.empty()) text += '\n';
    text += issue.field + ": " + issue.problem;
    if (!issue.hint.empty()) text += " (" + issue.hint + ")";
  }
  return text;
}

}  // namespace

GeometryError::GeometryError(std::vector<Issue> found)
    : std::runtime_error(message(found)),
      S(found.at(0).S),
      value(found[0].value),
      bound(found[0].bound),
      what_field(found[0].field),
      hint(found[0].hint),
      issues(std::move(found)) {}

std::string number_text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

void throw_if_any(std::vector<Issue> issues) {
  if (!issues.empty()) throw GeometryError(std::move(issues));
}

void require_positive(std::vector<Issue>& issues, const std::string& field, double value) {
  if (std::isfinite(value) && value > 0.0) return;
  issues.push_back({field, 0.0, value, 0.0, "is " + number_text(value) + ", must be a number greater than 0", ""});
}

void require_finite(std::vector<Issue>& issues, const std::string& field, double value) {
  if (std::isfinite(value)) return;
  issues.push_back({field, 0.0, value, 0.0, "is " + number_text(value) + ", must be a finite number", ""});
}

}  // namespace tendril::geometry

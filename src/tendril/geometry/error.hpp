#pragma once
// The one exception of this room: wrong geometric input, with every problem found at once. Each issue says where
// (arc length S, or a list index in the field's name), what was found, what is allowed, and what to do about it.
// Units are those of the input.

#include <stdexcept>
#include <string>
#include <vector>

namespace tendril::geometry {

/// One problem of the input.
struct Issue {
  std::string field;  // the quantity's name in the field's language, e.g. "clearance", "points[3]"
  double S = 0.0;     // place along the reference curve [length]; 0 where it has none
  double value = 0.0;
  double bound = 0.0;
  std::string problem;  // complete sentence, readable by itself
  std::string hint;     // what to change; may be empty
};

struct GeometryError : std::runtime_error {
  double S;  // place, value and bound of the first issue
  double value;
  double bound;
  std::string what_field;
  std::string hint;
  std::vector<Issue> issues;  // all of them, never empty

  explicit GeometryError(std::vector<Issue> found);
  explicit GeometryError(Issue one) : GeometryError(std::vector<Issue>{std::move(one)}) {}
};

/// Shortest decimal text that reads back as the same number (for messages).
std::string number_text(double value);

/// Throws when the list is not empty.
void throw_if_any(std::vector<Issue> issues);

/// An issue unless value is finite and > 0.
void require_positive(std::vector<Issue>& issues, const std::string& field, double value);

/// An issue unless value is finite.
void require_finite(std::vector<Issue>& issues, const std::string& field, double value);

}  // namespace tendril::geometry

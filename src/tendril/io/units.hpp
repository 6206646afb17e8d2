#pragma once
// Quantities with units: "9 5/8 in", "12 klbf", "19.5 lb/ft", "3 deg/30m", "895 N mm^2" to SI. Force is a base
// dimension here. Mass appears only in weights per length, where kg/m and lb/ft mean the weight of that mass under
// standard gravity 9.80665 m/s^2; "lb" as a force is refused, because it is ambiguous.

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>

namespace tendril::io {

/// What a key measures; decides which units it accepts and how its values are labelled.
enum class Dimension {
  none,
  length,
  force,
  moment,            // force length
  stiffness,         // force length^2
  force_per_length,  // weights, pressures on the rod
  pressure,          // moduli
  angle,
  curvature,  // angle or 1 per length
  density,
};

/// Thrown by the parser; `hint` may be empty.
struct UnitError : std::runtime_error {
  std::string hint;
  UnitError(const std::string& message, std::string hint_ = {}) : std::runtime_error(message), hint(std::move(hint_)) {}
};

/// A number or a fraction with a unit, in SI. Throws UnitError.
double parse_quantity(std::string_view text, Dimension dimension);

/// A unit alone ("mm", "ft"): its size in SI. Throws UnitError.
double parse_unit(std::string_view unit, Dimension dimension);

/// "m", "N", "N m", ...; empty for none. Angles are in rad.
std::string_view si_unit(Dimension dimension);

/// Words for messages and the schema, e.g. "a length".
std::string_view describe(Dimension dimension);

/// Examples of accepted strings, e.g. "9.625 in".
std::string_view example(Dimension dimension);

}  // namespace tendril::io

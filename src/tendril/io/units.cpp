#include "tendril/io/units.hpp"

#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "tendril/io/diagnostics.hpp"

namespace tendril::io {
namespace {

constexpr double kGravity = 9.80665;   // standard gravity [m/s^2]
constexpr double kPound = 0.45359237;  // [kg], exact
constexpr double kInch = 0.0254, kFoot = 0.3048;
constexpr double kGallon = 231 * kInch * kInch * kInch;  // US [m^3]
constexpr double kPoundForce = kPound * kGravity;        // [N], exact

// Exponents of length, force, mass, angle.
using Exponents = std::array<int, 4>;

struct Unit {
  std::string_view name;
  double size;
  Exponents exponents;
};

constexpr Exponents kLength{1, 0, 0, 0}, kForce{0, 1, 0, 0}, kMass{0, 0, 1, 0}, kAngle{0, 0, 0, 1};
constexpr Exponents kMoment{1, 1, 0, 0}, kPressure{-2, 1, 0, 0}, kMassPerLength{-1, 0, 1, 0}, kDensity{-3, 0, 1, 0};

constexpr Unit kUnits[] = {
    {"m", 1, kLength},
    {"mm", 1e-3, kLength},
    {"cm", 1e-2, kLength},
    {"um", 1e-6, kLength},
    {"km", 1e3, kLength},
    {"in", kInch, kLength},
    {"inch", kInch, kLength},
    {"inches", kInch, kLength},
    {"\"", kInch, kLength},
    {"ft", kFoot, kLength},
    {"foot", kFoot, kLength},
    {"feet", kFoot, kLength},
    {"N", 1, kForce},
    {"mN", 1e-3, kForce},
    {"daN", 10, kForce},
    {"kN", 1e3, kForce},
    {"MN", 1e6, kForce},
    {"lbf", kPoundForce, kForce},
    {"klbf", 1e3 * kPoundForce, kForce},
    {"kip", 1e3 * kPoundForce, kForce},
    {"kips", 1e3 * kPoundForce, kForce},
    {"ozf", kPoundForce / 16, kForce},
    {"kgf", kGravity, kForce},
    {"gf", 1e-3 * kGravity, kForce},
    {"tf", 1e3 * kGravity, kForce},
    {"Nm", 1, kMoment},
    {"Nmm", 1e-3, kMoment},
    {"mNm", 1e-3, kMoment},
    {"kNm", 1e3, kMoment},
    {"MNm", 1e6, kMoment},
    {"Pa", 1, kPressure},
    {"kPa", 1e3, kPressure},
    {"MPa", 1e6, kPressure},
    {"GPa", 1e9, kPressure},
    {"bar", 1e5, kPressure},
    {"psi", kPoundForce / (kInch * kInch), kPressure},
    {"ksi", 1e3 * kPoundForce / (kInch * kInch), kPressure},
    {"Mpsi", 1e6 * kPoundForce / (kInch * kInch), kPressure},
    {"rad", 1, kAngle},
    {"mrad", 1e-3, kAngle},
    {"deg", std::numbers::pi / 180, kAngle},
    {"degree", std::numbers::pi / 180, kAngle},
    {"degrees", std::numbers::pi / 180, kAngle},
    {"kg", 1, kMass},
    {"g", 1e-3, kMass},
    {"lb", kPound, kMass},
    {"lbs", kPound, kMass},
    {"lbm", kPound, kMass},
    {"ppf", kPound / kFoot, kMassPerLength},
    {"gal", kGallon, {3, 0, 0, 0}},
    {"ppg", kPound / kGallon, kDensity},
};

// Signs that keyboards offer, in plain letters.
std::string plain(std::string_view text) {
  static constexpr std::pair<std::string_view, std::string_view> kTable[] = {
      {"\xC2\xB5", "u"}, {"\xCE\xBC", "u"},     {"\xC2\xB0", "deg"},   {"\xC2\xB2", "^2"}, {"\xC2\xB3", "^3"},
      {"\xC2\xB7", "*"}, {"\xE2\x8B\x85", "*"}, {"\xE2\x88\x92", "-"}, {"\xC2\xA0", " "},  {"\xE2\x80\xB3", "\""}};
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    bool replaced = false;
    for (const auto& [from, to] : kTable) {
      if (text.substr(i, from.size()) == from) {
        out += to;
        i += from.size();
        replaced = true;
        break;
      }
    }
    if (!replaced) out += text[i++];
  }
  return out;
}

bool letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '"' || c == '%' || (c & 0x80); }
bool digit(char c) { return c >= '0' && c <= '9'; }

struct Measure {
  double size = 1.0;
  Exponents exponents{};
};

std::string unit_hint(const std::string& name) {
  std::vector<std::string> names;
  for (const Unit& unit : kUnits) names.emplace_back(unit.name);
  const std::string best = nearest(name, names);
  return best.empty()
             ? "units known: m mm cm km in ft, N kN MN daN lbf klbf kgf, N m, Pa MPa GPa psi ksi, rad deg, kg lb"
             : "did you mean `" + best + "`?";
}

const Unit& find_unit(const std::string& name) {
  for (const Unit& unit : kUnits) {
    if (unit.name == name) return unit;
  }
  if (name == "klb" || name == "klbs") throw UnitError("`" + name + "` is ambiguous as a force", "write klbf");
  throw UnitError("unknown unit `" + name + "`", unit_hint(name));
}

// Products separated by a space, '*', '.' or '-'; '/' divides by the next factor, which may carry a number: deg/30m.
Measure parse_units(std::string_view text) {
  Measure measure;
  std::size_t i = 0;
  bool divide = false, first = true;
  auto skip = [&] {
    while (i < text.size() && text[i] == ' ') ++i;
  };
  for (skip(); i < text.size(); skip()) {
    if (!first || text[i] == '/') {
      if (text[i] == '/') {
        if (divide) throw UnitError("a unit is missing after '/'");
        divide = true;
        ++i;
        first = false;
        continue;
      }
      if (text[i] == '*' || text[i] == '.' || text[i] == '-') {
        ++i;
        continue;
      }
    }
    first = false;
    double factor = 1.0;
    if (digit(text[i])) {
      if (!divide) throw UnitError("a unit was expected before `" + std::string(text.substr(i)) + "`");
      const auto result = std::from_chars(text.data() + i, text.data() + text.size(), factor);
      i = static_cast<std::size_t>(result.ptr - text.data());
      skip();
    }
    const std::size_t from = i;
    while (i < text.size() && letter(text[i])) ++i;
    const std::string name(text.substr(from, i - from));
    if (name.empty()) throw UnitError("cannot read the unit `" + std::string(text) + "`");
    int power = 1;
    if (i < text.size() && (text[i] == '^' || digit(text[i]))) {
      if (text[i] == '^') ++i;
      const auto result = std::from_chars(text.data() + i, text.data() + text.size(), power);
      if (result.ec != std::errc() || power < -9 || power > 9)
        throw UnitError("cannot read the exponent in `" + std::string(text) + "`");
      i = static_cast<std::size_t>(result.ptr - text.data());
    }
    const Unit& unit = find_unit(name);
    const int sign = divide ? -power : power;
    measure.size *= std::pow(unit.size, sign) * (divide ? 1.0 / factor : factor);
    for (int k = 0; k < 4; ++k) measure.exponents[k] += sign * unit.exponents[k];
    divide = false;
  }
  if (divide) throw UnitError("a unit is missing after '/'");
  return measure;
}

Exponents exponents_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::none:
      return {0, 0, 0, 0};
    case Dimension::length:
      return kLength;
    case Dimension::force:
      return kForce;
    case Dimension::moment:
      return kMoment;
    case Dimension::stiffness:
      return {2, 1, 0, 0};
    case Dimension::force_per_length:
      return {-1, 1, 0, 0};
    case Dimension::pressure:
      return kPressure;
    case Dimension::angle:
      return kAngle;
    case Dimension::curvature:
      return {-1, 0, 0, 1};
    case Dimension::density:
      return kDensity;
  }
  return {};
}

double convert(const Measure& measure, Dimension dimension, std::string_view text) {
  if (measure.exponents == exponents_of(dimension)) return measure.size;
  if (dimension == Dimension::force_per_length && measure.exponents == kMassPerLength) return measure.size * kGravity;
  if (dimension == Dimension::curvature && measure.exponents == Exponents{-1, 0, 0, 0}) return measure.size;
  const bool pounds = measure.exponents == Exponents{0, 0, 1, 0} || measure.exponents == Exponents{1, 0, 1, 0} ||
                      measure.exponents == Exponents{2, 0, 1, 0} || measure.exponents == Exponents{-2, 0, 1, 0};
  if (pounds && text.find("lb") != std::string_view::npos) {
    throw UnitError("`lb` is ambiguous as a force", "write lbf (pound-force)");
  }
  throw UnitError("`" + std::string(text) + "` is not the unit of " + std::string(describe(dimension)),
                  "for example \"" + std::string(example(dimension)) + "\"");
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

// "9.625", "9 5/8", "9-5/8", "5/8"; returns the rest of the text.
double parse_number(std::string_view text, std::string_view& rest) {
  std::size_t i = 0;
  double sign = 1.0;
  if (i < text.size() && (text[i] == '+' || text[i] == '-')) sign = text[i++] == '-' ? -1.0 : 1.0;
  auto whole = [&](std::size_t from) -> std::optional<std::pair<double, std::size_t>> {
    std::size_t to = from;
    while (to < text.size() && digit(text[to])) ++to;
    if (to == from || to - from > 9) return std::nullopt;
    double value = 0;
    std::from_chars(text.data() + from, text.data() + to, value);
    return std::pair{value, to};
  };
  if (const auto first = whole(i)) {
    std::size_t at = first->second;
    double integer = 0.0;
    auto numerator = first;
    if (at < text.size() && (text[at] == ' ' || text[at] == '-')) {  // a whole number before the fraction
      while (at < text.size() && text[at] == ' ') ++at;
      if (at < text.size() && text[at] == '-') ++at;
      integer = first->first;
      numerator = whole(at);
    }
    if (numerator && numerator->second < text.size() && text[numerator->second] == '/') {
      const auto denominator = whole(numerator->second + 1);
      if (denominator && denominator->first > 0 &&
          (denominator->second == text.size() || text[denominator->second] == ' ' ||
           letter(text[denominator->second]))) {
        rest = text.substr(denominator->second);
        return sign * (integer + numerator->first / denominator->first);
      }
    }
  }
  double value = 0.0;
  const bool starts = i < text.size() && (digit(text[i]) || text[i] == '.');
  const auto result = std::from_chars(text.data() + i, text.data() + text.size(), value);
  if (!starts || result.ec != std::errc()) {
    throw UnitError("\"" + std::string(text) + "\" does not start with a number",
                    "write a number and a unit, as in \"9.625 in\"");
  }
  rest = text.substr(static_cast<std::size_t>(result.ptr - text.data()));
  if (!rest.empty() && rest.front() == ',') {
    throw UnitError("cannot read \"" + std::string(text) + "\"",
                    "the decimal sign is a point, and digits are not grouped");
  }
  return sign * value;
}

}  // namespace

double parse_unit(std::string_view unit, Dimension dimension) {
  const std::string text = plain(unit);
  return convert(parse_units(text), dimension, trimmed(text));
}

double parse_quantity(std::string_view raw, Dimension dimension) {
  const std::string text = plain(raw);
  std::string_view rest;
  const double number = parse_number(trimmed(text), rest);
  rest = trimmed(rest);
  if (rest.empty()) {
    if (dimension == Dimension::none) return number;
    throw UnitError("\"" + std::string(raw) + "\" has no unit",
                    "write a number without quotes for " + std::string(si_unit(dimension)) + ", or add the unit");
  }
  if (dimension == Dimension::none) throw UnitError("this value has no unit", "write the number without quotes");
  const double value = number * convert(parse_units(rest), dimension, rest);
  if (!std::isfinite(value)) throw UnitError("\"" + std::string(raw) + "\" is not a finite number");
  return value;
}

std::string_view si_unit(Dimension dimension) {
  switch (dimension) {
    case Dimension::none:
      return "";
    case Dimension::length:
      return "m";
    case Dimension::force:
      return "N";
    case Dimension::moment:
      return "N m";
    case Dimension::stiffness:
      return "N m^2";
    case Dimension::force_per_length:
      return "N/m";
    case Dimension::pressure:
      return "Pa";
    case Dimension::angle:
      return "rad";
    case Dimension::curvature:
      return "rad/m";
    case Dimension::density:
      return "kg/m^3";
  }
  return "";
}

std::string_view describe(Dimension dimension) {
  switch (dimension) {
    case Dimension::none:
      return "a pure number";
    case Dimension::length:
      return "a length";
    case Dimension::force:
      return "a force";
    case Dimension::moment:
      return "a moment";
    case Dimension::stiffness:
      return "a bending or twisting stiffness";
    case Dimension::force_per_length:
      return "a force per length";
    case Dimension::pressure:
      return "a modulus";
    case Dimension::angle:
      return "an angle";
    case Dimension::curvature:
      return "a curvature";
    case Dimension::density:
      return "a density";
  }
  return "";
}

std::string_view example(Dimension dimension) {
  switch (dimension) {
    case Dimension::none:
      return "1.5";
    case Dimension::length:
      return "9 5/8 in";
    case Dimension::force:
      return "12 klbf";
    case Dimension::moment:
      return "3 kN m";
    case Dimension::stiffness:
      return "895 N mm^2";
    case Dimension::force_per_length:
      return "19.5 lb/ft";
    case Dimension::pressure:
      return "210 GPa";
    case Dimension::angle:
      return "45 deg";
    case Dimension::curvature:
      return "3 deg/30m";
    case Dimension::density:
      return "10 ppg";
  }
  return "";
}

}  // namespace tendril::io

// Quantities with units against their definitions (exact inch, foot, pound and standard gravity).

#include <gtest/gtest.h>

#include <numbers>

#include "tendril/io/units.hpp"

namespace tendril::io {
namespace {

constexpr double kRounding = 4e-16;  // relative: a product of a few exact factors

void expect(const char* text, Dimension dimension, double value) {
  EXPECT_NEAR(parse_quantity(text, dimension), value, kRounding * std::abs(value)) << text;
}

TEST(Units, LengthsInDecimalsAndFractions) {
  expect("9.625 in", Dimension::length, 9.625 * 0.0254);
  expect("9 5/8 in", Dimension::length, 9.625 * 0.0254);
  expect("9-5/8 in", Dimension::length, 9.625 * 0.0254);
  expect("5/8 in", Dimension::length, 0.625 * 0.0254);
  expect("-9 5/8 in", Dimension::length, -9.625 * 0.0254);
  expect("8 1/2\"", Dimension::length, 8.5 * 0.0254);
  expect("150 mm", Dimension::length, 0.15);
  expect("150mm", Dimension::length, 0.15);
  expect("1e3 ft", Dimension::length, 304.8);
  expect("12 \xC2\xB5m", Dimension::length, 12e-6);
}

TEST(Units, ForcesMomentsAndStiffnesses) {
  const double lbf = 0.45359237 * 9.80665;
  expect("12 klbf", Dimension::force, 12000 * lbf);
  expect("-20 kN", Dimension::force, -20000);
  expect("3 kN m", Dimension::moment, 3000);
  expect("3 kN*m", Dimension::moment, 3000);
  expect("3 kN\xC2\xB7m", Dimension::moment, 3000);
  expect("3 kNm", Dimension::moment, 3000);
  expect("10 ft-lbf", Dimension::moment, 10 * 0.3048 * lbf);
  expect("895 N mm^2", Dimension::stiffness, 895e-6);
  expect("895 N mm\xC2\xB2", Dimension::stiffness, 895e-6);
  expect("895 N mm2", Dimension::stiffness, 895e-6);
  expect("210 GPa", Dimension::pressure, 210e9);
  expect("30 Mpsi", Dimension::pressure, 30e6 * lbf / (0.0254 * 0.0254));
}

TEST(Units, WeightsPerLengthMayBeMasses) {
  const double lbf_per_ft = 0.45359237 * 9.80665 / 0.3048;
  expect("19.5 lb/ft", Dimension::force_per_length, 19.5 * lbf_per_ft);
  expect("19.5 lbf/ft", Dimension::force_per_length, 19.5 * lbf_per_ft);
  expect("19.5 ppf", Dimension::force_per_length, 19.5 * lbf_per_ft);
  expect("2 kg/m", Dimension::force_per_length, 2 * 9.80665);
  expect("250 N/m", Dimension::force_per_length, 250);
}

TEST(Units, AnglesAndCurvatures) {
  expect("45 deg", Dimension::angle, std::numbers::pi / 4);
  expect("45\xC2\xB0", Dimension::angle, std::numbers::pi / 4);
  expect("3 deg/30m", Dimension::curvature, 3 * std::numbers::pi / 180 / 30);
  expect("3 deg/30 m", Dimension::curvature, 3 * std::numbers::pi / 180 / 30);
  expect("3 deg/100ft", Dimension::curvature, 3 * std::numbers::pi / 180 / 30.48);
}

void refused(const char* text, Dimension dimension, const char* message, const char* hint) {
  try {
    const double value = parse_quantity(text, dimension);
    ADD_FAILURE() << text << " was read as " << value;
  } catch (const UnitError& error) {
    EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << text << ": " << error.what();
    EXPECT_NE(error.hint.find(hint), std::string::npos) << text << ": " << error.hint;
  }
}

TEST(Units, RefusalsSayWhy) {
  refused("12 lb", Dimension::force, "ambiguous", "lbf");
  refused("12 klb", Dimension::force, "ambiguous", "klbf");
  refused("3 ft lb", Dimension::moment, "ambiguous", "lbf");
  refused("12 kn", Dimension::force, "unknown unit `kn`", "`kN`");
  refused("12 N", Dimension::length, "not the unit of a length", "in");
  refused("12", Dimension::length, "has no unit", "m");
  refused("twelve m", Dimension::length, "does not start with a number", "9.625 in");
  refused("9,625 in", Dimension::length, "cannot read", "point");
  refused("3 deg/", Dimension::curvature, "missing after '/'", "");
  refused("20 5 N", Dimension::force, "a unit was expected", "");
  refused("nan m", Dimension::length, "does not start with a number", "");
  refused("1e999 m", Dimension::length, "does not start with a number", "");
  refused("5/0 in", Dimension::length, "", "");
  refused("", Dimension::length, "does not start with a number", "");
  refused("1.5 m", Dimension::none, "has no unit", "without quotes");
}

}  // namespace
}  // namespace tendril::io

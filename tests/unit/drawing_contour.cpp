// Level lines: exact crossings, closed and open lines, saddles, holes in the data.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tendril/drawing/contour.hpp"

namespace tendril::drawing {
namespace {

std::vector<double> evenly(double a, double b, int parts) {
  std::vector<double> x;
  for (int i = 0; i <= parts; ++i) x.push_back(a + (b - a) * i / parts);
  return x;
}

template <class F>
std::vector<double> table(const std::vector<double>& x, const std::vector<double>& y, F f) {
  std::vector<double> v;
  for (double b : y)
    for (double a : x) v.push_back(f(a, b));
  return v;
}

TEST(LevelLines, ACircleIsOneClosedLineOnTheExactLevel) {
  const auto f = [](double a, double b) { return a * a + std::exp(0.25 * b) * b * b; };
  const auto x = evenly(-2, 2, 37), y = evenly(-2, 1.3, 41);
  const auto lines = level_lines(x, y, table(x, y, f), 0.8, f);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].x.front(), lines[0].x.back());
  EXPECT_EQ(lines[0].y.front(), lines[0].y.back());
  EXPECT_GT(lines[0].x.size(), 40u);
  for (std::size_t i = 0; i < lines[0].x.size(); ++i) EXPECT_NEAR(f(lines[0].x[i], lines[0].y[i]), 0.8, 1e-9);
}

TEST(LevelLines, AHyperbolaIsTwoOpenLinesThatDoNotCross) {
  const auto f = [](double a, double b) { return a * b; };
  const auto x = evenly(-1, 1, 20), y = evenly(-1, 1, 20);
  const auto lines = level_lines(x, y, table(x, y, f), 1e-3, f);
  ASSERT_EQ(lines.size(), 2u);
  for (const auto& line : lines)
    for (std::size_t i = 1; i < line.x.size(); ++i) EXPECT_GT(line.x[i] * line.x[0], 0.0);
}

TEST(LevelLines, CellsWithoutDataAreLeftOut) {
  const auto f = [](double a, double b) {
    return std::hypot(a, b) < 0.3 ? std::numeric_limits<double>::quiet_NaN() : b;
  };
  const auto x = evenly(-1, 1, 21), y = evenly(-1, 1, 21);
  const auto lines = level_lines(x, y, table(x, y, f), 0.0);
  EXPECT_EQ(lines.size(), 2u);
  EXPECT_TRUE(level_lines(x, y, table(x, y, f), 5.0).empty());
}

}  // namespace
}  // namespace tendril::drawing

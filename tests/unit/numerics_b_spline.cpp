// Bernstein polynomials and B-splines: against powers, random splines there and back, bounds that hold.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tendril/numerics/b_spline.hpp"

namespace tendril::numerics {
namespace {

constexpr double rounding = 1e-13;  // of numbers of order 1 after some ten operations each

double uniform(std::mt19937_64& engine) { return 2 * static_cast<double>(engine() >> 11) * 0x1.0p-53 - 1; }

TEST(Bernstein, InterpolatesIntegratesAndMultiplies) {
  const std::vector<double> x = {0.1, 0.3, 0.55, 0.9};
  std::vector<double> y;
  const auto p = [](double t) { return 1 - 2 * t + 3 * t * t - t * t * t; };
  for (const double t : x) y.push_back(p(t));
  const Bernstein c = interpolant(x, y), integral = integrated(c, 0.5, 7.0), square = product(c, c);
  const auto [left, right] = split(c, 0.3);
  for (const double t : {0.0, 0.2, 0.5, 1.0}) {
    EXPECT_NEAR(value(c, t), p(t), rounding);
    EXPECT_NEAR(value(integral, t), 7 + 0.5 * (t - t * t + t * t * t - std::pow(t, 4) / 4), rounding);
    EXPECT_NEAR(value(square, t), p(t) * p(t), rounding);
    EXPECT_NEAR(value(left, t), p(0.3 * t), rounding);
    EXPECT_NEAR(value(right, t), p(0.3 + 0.7 * t), rounding);
  }
}

TEST(Bernstein, BoundsHoldAndAreClose) {
  std::mt19937_64 engine(3);
  for (int trial = 0; trial < 50; ++trial) {
    Bernstein c(9);
    for (double& v : c) v = uniform(engine);
    const auto [low, high] = bounds(c, 1e-9);
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (int i = 0; i <= 20000; ++i) {
      least = std::min(least, value(c, i / 20000.0));
      most = std::max(most, value(c, i / 20000.0));
    }
    EXPECT_LE(low, least);
    EXPECT_GE(high, most);
    // Sampling misses a smooth extremum by at most |c''| h²/8, h = 1/20000; |c''| <= 56 * 4.
    EXPECT_NEAR(low, least, 1e-7);
    EXPECT_NEAR(high, most, 1e-7);
  }
}

/// A spline given by its control points, cut into pieces and put together again.
TEST(BSpline, PiecesBecomeTheSameSpline) {
  std::mt19937_64 engine(11);
  const std::vector<double> breaks = {0.0, 0.4, 0.5, 1.3, 2.0};
  for (const int order : {1, 3, 5, 8, 10})
    for (const int continuity : {-1, 0, 2}) {
      if (continuity >= order - 1) continue;
      BSpline s;
      s.order = order;
      s.knots.assign(order, breaks.front());
      for (std::size_t i = 1; i + 1 < breaks.size(); ++i)
        s.knots.insert(s.knots.end(), order - 1 - continuity, breaks[i]);
      s.knots.insert(s.knots.end(), order, breaks.back());
      s.control.resize(s.knots.size() - order);
      for (double& v : s.control) v = uniform(engine);
      std::vector<Bernstein> pieces;
      for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        std::vector<double> x, y;
        for (int j = 0; j < order; ++j) {
          x.push_back((j + 0.5) / order);
          y.push_back(s.value(breaks[i] + (breaks[i + 1] - breaks[i]) * x.back()));
        }
        pieces.push_back(interpolant(x, y));
      }
      const BSpline back = b_spline(order, continuity, breaks, pieces);
      EXPECT_EQ(back.knots, s.knots);
      ASSERT_EQ(back.control.size(), s.control.size());
      // Interpolation and extrapolation into neighbours up to eight times as long: conditioning about 1e4.
      for (std::size_t j = 0; j < s.control.size(); ++j) EXPECT_NEAR(back.control[j], s.control[j], 1e-9) << order;
    }
}

TEST(BSpline, DerivativesAreThoseOfThePolynomial) {
  // x³ on [0, 2] in two pieces.
  std::vector<Bernstein> pieces;
  for (const double a : {0.0, 1.0}) {
    std::vector<double> x, y;
    for (const double t : {0.0, 0.3, 0.7, 1.0}) {
      x.push_back(t);
      y.push_back(std::pow(a + t, 3));
    }
    pieces.push_back(interpolant(x, y));
  }
  const BSpline s = b_spline(4, 2, {0, 1, 2}, pieces);
  EXPECT_EQ(s.control.size(), 5u);
  for (const double x : {0.0, 0.4, 1.0, 1.7, 2.0}) {
    EXPECT_NEAR(s.value(x), x * x * x, rounding);
    EXPECT_NEAR(s.value(x, 1), 3 * x * x, rounding);
    EXPECT_NEAR(s.value(x, 2), 6 * x, rounding);
    EXPECT_NEAR(s.value(x, 3), 6, 10 * rounding);
  }
  EXPECT_EQ(s.value(0.5, 4), 0);
  EXPECT_LE(s.bounds().first, 0);
  EXPECT_GE(s.bounds().second, 8 - rounding);
}

}  // namespace
}  // namespace tendril::numerics

// Scales, clipping, thinning and text: the parts of a picture.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "tendril/drawing/polyline.hpp"
#include "tendril/drawing/scale.hpp"
#include "tendril/drawing/text.hpp"

namespace tendril::drawing {
namespace {

// The number a label shows; \u2212 is the minus sign, \u00D7 times.
double shown(std::string label) {
  const std::size_t minus = label.find("\u2212");
  if (minus != std::string::npos) label.replace(minus, 3, "-");
  return std::atof(label.c_str());
}

TEST(Ticks, AreRoundInsideAndTruthful) {
  for (const auto& [from, to] : {std::pair{-0.037, 0.052}, {0.0, 1.0}, {-7.07, -70.7}, {17.2, 17.9}, {-3.0, 99.0}}) {
    const Scale scale{from, to, false};
    const std::vector<Tick> list = ticks(scale, 5);
    EXPECT_GE(list.size(), 3u);
    EXPECT_LE(list.size(), 9u);
    for (const Tick& t : list) {
      EXPECT_GE(t.value, std::min(from, to) - 1e-9);
      EXPECT_LE(t.value, std::max(from, to) + 1e-9);
      EXPECT_NEAR(shown(t.label), t.value, 1e-12) << t.label;  // round numbers: the label is the whole truth
    }
  }
}

TEST(Ticks, OfLargeAndSmallNumbersCarryTheirPower) {
  EXPECT_EQ(ticks({0, 3e6, false}, 3).back().label, "3\u00D710\u2076");
  EXPECT_EQ(ticks({0, 2e-7, false}, 2).back().label, "2\u00D710\u207B\u2077");
}

TEST(Ticks, OfLogarithmicAxesAreDecades) {
  std::vector<double> labelled;
  for (const Tick& t : ticks({1e-8, 1.0, true}, 8)) {
    if (!t.label.empty()) labelled.push_back(t.value);
  }
  ASSERT_EQ(labelled.size(), 9u);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(std::log10(labelled[i]), static_cast<double>(i) - 8, 1e-12);
  EXPECT_TRUE(std::isnan((Scale{1, 10, true})(-1)));
}

TEST(Scale, DoesNotBlowUpNoise) {
  const Scale scale = scale_of({1.0, 1.0 + 1e-15, 1.0 - 1e-15}, false);
  EXPECT_LT(scale.from, 0.9);
  EXPECT_GT(scale.to, 1.1);
}

TEST(Clip, CutsAtTheFrame) {
  const Box box{0, 0, 10, 10};
  const auto pieces = clip({{-5, 5}, {15, 5}, {15, 8}, {5, 8}, {NAN, 0}, {1, 1}, {2, 2}}, box);
  ASSERT_EQ(pieces.size(), 3u);
  EXPECT_EQ(pieces[0].points, (std::vector<Point>{{0, 5}, {10, 5}}));
  EXPECT_EQ(pieces[1].points, (std::vector<Point>{{10, 8}, {5, 8}}));
  EXPECT_EQ(pieces[1].first, 2u);
  EXPECT_EQ(pieces[2].points, (std::vector<Point>{{1, 1}, {2, 2}}));
}

TEST(Clip, KeepsTheAreaOfPolygons) {
  // A unit square turned by 45° and half outside: the triangle of area ½ stays.
  const double h = std::sqrt(0.5);
  const auto part = clip_polygon({{-h, 5}, {0, 5 - h}, {h, 5}, {0, 5 + h}}, {0, 0, 10, 10});
  double twice = 0;
  for (std::size_t i = 0; i < part.size(); ++i) {
    const auto &a = part[i], &b = part[(i + 1) % part.size()];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  EXPECT_NEAR(std::abs(twice) / 2, 0.5, 1e-14);
}

TEST(Simplify, StaysWithinItsTolerance) {
  std::vector<Point> line;
  for (int i = 0; i <= 2000; ++i) line.push_back({0.1 * i, 50 * std::sin(0.01 * i)});
  const auto thin = simplify(line, 0.05);
  EXPECT_LT(thin.size(), 200u);
  for (const Point& p : line) {
    std::size_t k = 0;
    while (k + 2 < thin.size() && thin[k + 1][0] < p[0]) ++k;
    const double t = (p[0] - thin[k][0]) / (thin[k + 1][0] - thin[k][0]);
    // The slope is at most 5, so the vertical distance is at most sqrt(26) times the true one.
    EXPECT_LE(std::abs(thin[k][1] + t * (thin[k + 1][1] - thin[k][1]) - p[1]), 0.05 * std::sqrt(26.0));
  }
}

TEST(Text, SetsSubscriptsOnlyWhereMeant) {
  EXPECT_EQ(plain_text("F_3 and L_{c} of end_force^2"), "F3 and Lc of end_force2");
  EXPECT_EQ(plain_text("d_3·D_3, x_iα"), "d3·D3, x_iα");
  EXPECT_EQ(text_html("κ_m^2 < T_{max}"), "κ<sub>m</sub><sup>2</sup> &lt; T<sub>max</sub>");
  EXPECT_EQ(text_spans("a<b", 10), "a&lt;b");
  EXPECT_NE(text_spans("F_3 x", 10).find("<tspan dy=\"2.2\" font-size=\"7.5\">3</tspan>"), std::string::npos);
}

TEST(Text, WrapsBetweenWords) {
  const auto lines = wrap_text("one two three four", 10, text_width("one two", 10) + 1);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0], "one two");
}

TEST(Colours, DivergeFromGrey) {
  EXPECT_EQ(diverging_colour(0), "#bebebe");
  EXPECT_NE(diverging_colour(1), diverging_colour(-1));
  EXPECT_EQ(diverging_colour(7), diverging_colour(1));
}

}  // namespace
}  // namespace tendril::drawing

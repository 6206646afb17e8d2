// Windows of a long rod: cut out and solved on its own a window repeats the whole; put together the parts are the
// whole. Stretches that pull open over the length a beam asks for.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "tendril/continuation/study.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/geometry/fitted_axes.hpp"
#include "tendril/segmentation/seeding.hpp"
#include "tendril/segmentation/windows.hpp"

namespace {

using namespace tendril;
using namespace tendril::segmentation;

PressureTable table_of(double (*p)(double), double from, double to, int samples) {
  std::vector<double> S, value;
  for (int i = 0; i <= samples; ++i) {
    S.push_back(from + (to - from) * i / samples);
    value.push_back(p(S.back()));
  }
  return {S, value};
}

TEST(SegmentationWindows, AParabolicDipOpensOverRootFiveOfItsLength) {
  const auto table = table_of([](double x) { return (x - 2.0) * (x - 2.0) - 1.0; }, -3.0, 7.0, 2000);
  double a = 0.0, b = 4.5;
  ASSERT_TRUE(table.opening(a, b));
  // the table is straight between its 2000 places: second order in 1/2000
  EXPECT_NEAR(a, 2.0 - std::sqrt(5.0), 1e-5);
  EXPECT_NEAR(b, 2.0 + std::sqrt(5.0), 1e-5);
  // k (l² - x²)³ with 720 k = p'' = 2
  double w[4];
  table.lift(a, b, 2.5, w);
  const double y = 5.0 - 0.25, k = 2.0 / 720.0;
  EXPECT_NEAR(w[0], k * y * y * y, 1e-5);
  EXPECT_NEAR(w[1], -6.0 * k * 0.5 * y * y, 1e-5);
  EXPECT_NEAR(w[2], k * y * (24.0 * 0.25 - 6.0 * y), 1e-5);
  EXPECT_NEAR(w[3], k * (72.0 * 0.5 * y - 48.0 * 0.125), 1e-5);
}

TEST(SegmentationWindows, AKinkedDipOpensOverEightThirdsOfItsLength) {
  // ∫ (l² - x²)(|x| - d) dx = 0: l = 8d/3
  const auto table = table_of([](double x) { return std::abs(x) - 0.3; }, -2.0, 2.0, 400);
  double a = -0.7, b = 0.6;
  ASSERT_TRUE(table.opening(a, b));
  EXPECT_NEAR(a, -0.8, 1e-9);
  EXPECT_NEAR(b, 0.8, 1e-9);
  double w[4];
  table.lift(a, b, b, w);
  for (int n = 0; n < 3; ++n) EXPECT_NEAR(w[n], 0.0, 1e-12);  // fits the wall in place, slope and curvature
  table.lift(a, b, 0.0, w);
  EXPECT_GT(w[0], 0.0);
}

TEST(SegmentationWindows, NothingOpensWhereNothingPulls) {
  const auto table = table_of([](double x) { return 1.0 + x * x; }, -2.0, 2.0, 100);
  double a = -0.5, b = 0.5;
  EXPECT_FALSE(table.opening(a, b));
}

/// A hole whose inclination swings: 600 m, a contact every 30 m.
Problem undulating_well() {
  std::vector<double> md, inc, azi;
  for (int s = 0; s <= 600; s += 10) {
    md.push_back(s);
    inc.push_back(75.0 + 1.5 * std::sin(2.0 * M_PI * s / 60.0));
    azi.push_back(40.0);
  }
  Problem p;
  p.tube.axis = geometry::make_survey(md, inc, azi, 0.01 * 0.04445, {}).axis;
  p.tube.clearance = geometry::make_constant(0.04445);
  p.rod = {1.2285e6, 1.2285e6 / 1.3, 703.9e6};
  p.load.force = {0.0, 0.0, 250.0};
  p.end.kind = End::Kind::sleeve;
  p.end_position = p.tube.length();
  p.axial_value = -20e3;
  return p;
}

TEST(SegmentationWindows, AWindowRepeatsTheWhole) {
  const Problem problem = undulating_well();
  const auto r = continuation::solve(problem, {});
  ASSERT_EQ(r.status, continuation::Status::converged) << r.message;
  EXPECT_EQ(r.steps[0].stability, "stable");
  EXPECT_GE(r.steps[0].contacts.size(), 10u);
  Chain whole;
  ASSERT_TRUE(whole.restore(r.steps[0].state, std::make_shared<Mechanics>(problem)));
  const auto windows = tile(whole, 16.0, 8.0);
  ASSERT_GE(windows.size(), 3u);
  EXPECT_EQ(windows.front().from, whole.S(0));
  EXPECT_EQ(windows.back().to, whole.S(whole.segments()));
  std::vector<Chain> parts;
  for (const Window& w : windows) {
    if (!parts.empty()) EXPECT_EQ(w.from, (&w)[-1].to);
    Chain part = cut(whole, w.first, w.last);
    ASSERT_TRUE(part.solve_adaptive({Closure::Kind::parameter, 0, 0.0}, {}, 2e-9).converged);
    for (int i = 0; i <= 20; ++i) {
      const double S = w.from + (w.to - w.from) * i / 20;
      double a[17], b[17];
      whole.sample(S, a, nullptr);
      part.sample(S, b, nullptr);
      EXPECT_NEAR(a[0], b[0], 1e-8 * 0.04445 / 600);  // of the clearance
      EXPECT_NEAR(a[4], b[4], 1e-8 * 0.04445 / 600);
      EXPECT_NEAR(a[15] / b[15], 1.0, 1e-7);  // F3
    }
    parts.push_back(part);
  }
  Chain again = splice(whole, windows, parts);
  EXPECT_EQ(again.pattern().line, whole.pattern().line);
  for (int j = 0; j <= whole.segments(); ++j) EXPECT_NEAR(again.S(j), whole.S(j), 1e-8);
  const auto s = again.solve({Closure::Kind::parameter, 0, 0.0}, {});
  EXPECT_TRUE(s.converged);
}

TEST(SegmentationWindows, TheSameBitsEveryTime) {
  const auto a = continuation::solve(undulating_well(), {}), b = continuation::solve(undulating_well(), {});
  ASSERT_EQ(a.steps[0].state.size(), b.steps[0].state.size());
  EXPECT_EQ(std::memcmp(a.steps[0].state.data(), b.steps[0].state.data(), a.steps[0].state.size() * sizeof(double)), 0);
}

}  // namespace

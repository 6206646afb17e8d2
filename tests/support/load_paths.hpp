#pragma once
// Paths whose events are compared: other listed values, other steps, loading and unloading.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "support/problems.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/io/case.hpp"

namespace tendril::test {

struct Loading {
  std::function<segmentation::Problem(double)> family;
  double from = 0.0, to = 0.0;
};

/// A case under examples/, along its own path's parameter or another.
inline Loading example(const std::string& name, double to, const std::string& parameter = {}) {
  std::vector<std::string> overrides{"path.values=[" + std::to_string(to) + "]"};
  if (!parameter.empty()) overrides.push_back("path.parameter=" + parameter);
  auto text = std::make_shared<io::Case>(
      io::read_case(std::string(TENDRIL_SOURCE_DIR) + "/examples/" + name + ".toml", overrides));
  return {[text](double p) { return io::build_problem(*text, p); }, io::study_path(*text).start, to};
}

inline segmentation::Problem weightless(std::shared_ptr<const geometry::Axis> axis) {
  segmentation::Problem p;
  p.tube.axis = std::move(axis);
  p.tube.clearance = geometry::make_constant(0.04);
  p.rod = {1.0, 0.75, {}};
  p.end.kind = segmentation::End::Kind::sleeve;
  p.end_position = 1.0;
  return p;
}

/// A rod in a nearly straight tube under a held end force: it bows, and snaps to the wall.
inline Loading bow(double to) {
  return {[](double force) {
            segmentation::Problem p = weightless(geometry::make_arc(500.0, 1.0));
            p.axial_value = Scalar(force, 1.0);
            return p;
          },
          -5.0, to};
}

/// A rod fed into a straight tube: it buckles, touches, and leaves its plane.
inline Loading straight_tube(double to) {
  return {[](double length) {
            segmentation::Problem p = weightless(geometry::make_straight(1.0));
            p.axial = segmentation::AxialControl::rod_length;
            p.axial_value = Scalar(length, 1.0);
            return p;
          },
          1.0002, to};
}

inline continuation::Result follow(const Loading& loading, const std::vector<double>& values, double max_step = 0.25) {
  continuation::StudyOptions options;
  options.max_step = max_step;
  return continuation::follow(loading.family, {loading.from, values, true}, options);
}

// Loads of events carry the mesh they were sharpened on, 2 % of the tolerance 1e-8; a place where a pressure vanishes
// is that of a minimum, known to the square root of the pressure's error.
constexpr double event_load = 1e-8, event_place = 1e-6;

inline void expect_same_events(const std::vector<continuation::Event>& a, const std::vector<continuation::Event>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].kind, b[i].kind);
    EXPECT_NEAR(a[i].parameter / b[i].parameter, 1, event_load) << a[i].kind;
    EXPECT_NEAR(a[i].S, b[i].S, event_place) << a[i].kind;
    EXPECT_NEAR(a[i].rod_length / b[i].rod_length, 1, event_load) << a[i].kind;
  }
}

/// Six lists and three largest steps between the same ends.
inline void expect_independent(const Loading& loading, std::vector<std::vector<double>> shares) {
  const continuation::Result reference = follow(loading, {loading.to});
  ASSERT_EQ(reference.status, continuation::Status::converged) << reference.message;
  ASSERT_FALSE(reference.events.empty());
  const auto& last = reference.steps.back();
  std::vector<double> tenths, many;
  for (int i = 1; i < 10; ++i) tenths.push_back(0.1 * i);
  for (int i = 1; i < 31; ++i) many.push_back(i / 31.0);
  for (auto more : std::vector<std::vector<double>>{{0.5}, {0.37}, tenths, many, {0.01, 0.77, 0.98}, {0.123, 0.1234}})
    shares.push_back(std::move(more));
  const auto expect_same = [&](const continuation::Result& r) {
    ASSERT_EQ(r.status, continuation::Status::converged) << r.message;
    expect_same_events(r.events, reference.events);
    EXPECT_NEAR(r.steps.back().rod_length / last.rod_length, 1, event_load);
    EXPECT_EQ(r.steps.back().contacts.size(), last.contacts.size());
    EXPECT_EQ(r.steps.back().stability, last.stability);
  };
  for (const auto& list : shares) {
    std::vector<double> values;
    for (const double f : list) values.push_back(loading.from + f * (loading.to - loading.from));
    values.push_back(loading.to);
    SCOPED_TRACE(std::to_string(values.size()) + " values, the first at " + std::to_string(values.front()));
    expect_same(follow(loading, values));
  }
  for (const double max_step : {0.4, 0.1}) {
    SCOPED_TRACE("largest step " + std::to_string(max_step));
    expect_same(follow(loading, {loading.to}, max_step));
  }
}

/// There and back: the same events in reverse order, each undone.
inline void expect_mirrored(const Loading& loading) {
  const std::map<std::string, std::string> undone{{"contact_appears", "contact_leaves"},
                                                  {"point_to_line", "line_to_point"},
                                                  {"line_splits", "contacts_merge"},
                                                  {"contacts_merge", "line_splits"},
                                                  {"branch_point", "branch_point"}};
  const continuation::Result r = follow(loading, {loading.to, loading.from + 1e-3 * (loading.to - loading.from)});
  ASSERT_EQ(r.status, continuation::Status::converged) << r.message;
  const std::size_t n = r.events.size() / 2;
  ASSERT_EQ(r.events.size(), 2 * n);
  ASSERT_GT(n, 0u);
  for (std::size_t i = 0; i < n; ++i) {
    const auto &there = r.events[i], &back = r.events[2 * n - 1 - i];
    EXPECT_EQ(back.kind, undone.at(there.kind)) << i;
    EXPECT_NEAR(back.parameter / there.parameter, 1, event_load) << there.kind;
    EXPECT_NEAR(back.rod_length / there.rod_length, 1, event_load) << there.kind;
    // symmetric twins happen together, in the same order along the rod both times
    EXPECT_NEAR(std::abs(back.S - 0.5), std::abs(there.S - 0.5), event_place) << there.kind;
  }
}

}  // namespace tendril::test

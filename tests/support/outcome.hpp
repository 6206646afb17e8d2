#pragma once
// What every system of the thesis must hand over: rows that hold, data in equal columns, pictures with named axes,
// truthful progress, and an end when asked to stop.

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tendril/reproduce/system.hpp"

namespace tendril::test {

inline const reproduce::System& system_named(const std::string& name) {
  for (const reproduce::System& s : reproduce::systems()) {
    if (s.name == name) return s;
  }
  throw std::runtime_error("no system " + name);
}

inline void expect_sound(const reproduce::Outcome& outcome) {
  EXPECT_FALSE(outcome.rows.empty());
  for (const reproduce::Row& row : outcome.rows) {
    EXPECT_LE(std::abs(row.computed - row.expected), row.tolerance)
        << row.quantity << ": computed " << row.computed << ", expected " << row.expected << " (" << row.source << ")";
    EXPECT_FALSE(row.source.empty()) << row.quantity;
  }
  EXPECT_FALSE(outcome.data.empty());
  EXPECT_FALSE(outcome.pictures.empty());
  std::set<std::string> files = {"table"};
  for (const reproduce::Data& data : outcome.data) {
    EXPECT_TRUE(files.insert(data.name).second) << "two files " << data.name;
    ASSERT_EQ(data.columns.size(), data.value.size()) << data.name;
    for (const auto& column : data.value) EXPECT_EQ(column.size(), data.value.front().size()) << data.name;
  }
  files = {};
  for (const reproduce::Picture& picture : outcome.pictures) {
    EXPECT_TRUE(files.insert(picture.name).second) << "two pictures " << picture.name;
    EXPECT_FALSE(picture.caption.empty()) << picture.name;
    for (const drawing::Panel& panel : picture.figure.panels) {
      EXPECT_FALSE(panel.axes && (panel.x_label.empty() || panel.y_label.empty())) << picture.name << panel.title;
      std::size_t points = 0;
      for (const drawing::Curve& c : panel.curves) {
        ASSERT_EQ(c.x.size(), c.y.size()) << picture.name;
        points += c.x.size();
      }
      EXPECT_GT(points, 0u) << picture.name << ": an empty panel " << panel.title;
    }
  }
}

/// Computes the system, judges what it hands over and how it reports progress; stops when asked to.
inline reproduce::Outcome expect_sound(const reproduce::System& system) {
  double last = 0.0;
  reproduce::Outcome outcome = system.compute([&](double fraction, const std::string&) {
    EXPECT_GE(fraction, last - 1e-12) << "progress goes back";
    EXPECT_LE(fraction, 1.0 + 1e-12);
    last = fraction;
    return true;
  });
  EXPECT_GT(last, 0.9) << "progress ends early";
  expect_sound(outcome);
  EXPECT_THROW(system.compute([](double, const std::string&) { return false; }), reproduce::Interrupted);
  return outcome;
}

}  // namespace tendril::test

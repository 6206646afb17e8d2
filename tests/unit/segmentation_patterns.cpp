// Elementary changes of the contact pattern: every arrow, its inverse, and the order of the places.
#include <gtest/gtest.h>

#include <algorithm>

#include "tendril/segmentation/pattern_edit.hpp"

namespace {

using namespace tendril::segmentation;

void expect_pattern(const Pattern& q, std::vector<char> line, std::vector<double> S) {
  EXPECT_EQ(q.line, line);
  ASSERT_EQ(q.S.size(), S.size());
  for (std::size_t i = 0; i < S.size(); ++i) EXPECT_NEAR(q.S[i], S[i], 1e-15);
  EXPECT_EQ(q.S.size() + 1, q.line.size());
  EXPECT_TRUE(std::is_sorted(q.S.begin(), q.S.end()));
  for (std::size_t j = 0; j + 1 < q.line.size(); ++j) EXPECT_FALSE(q.line[j] && q.line[j + 1]);  // no line | line
}

const Pattern clear_of_wall{{0}, {}};
const Pattern mixed{{0, 1, 0, 0, 1, 0}, {0.1, 0.3, 0.5, 0.7, 0.9}};  // line, point at 0.5, line

TEST(SegmentationPatterns, PointsAppearAndLeave) {
  expect_pattern(insert_point(clear_of_wall, 0, 0.4), {0, 0}, {0.4});
  expect_pattern(insert_point(mixed, 0, 0.05), {0, 0, 1, 0, 0, 1, 0}, {0.05, 0.1, 0.3, 0.5, 0.7, 0.9});
  expect_pattern(insert_point(mixed, 3, 0.6), {0, 1, 0, 0, 0, 1, 0}, {0.1, 0.3, 0.5, 0.6, 0.7, 0.9});
  expect_pattern(insert_point(mixed, 5, 0.95), {0, 1, 0, 0, 1, 0, 0}, {0.1, 0.3, 0.5, 0.7, 0.9, 0.95});
  expect_pattern(remove_point(mixed, 2), {0, 1, 0, 1, 0}, {0.1, 0.3, 0.7, 0.9});
  EXPECT_EQ(remove_point(insert_point(mixed, 3, 0.6), 3), mixed);
}

TEST(SegmentationPatterns, APointBecomesALineOrTwoPoints) {
  expect_pattern(point_to_line(mixed, 2, 0.04), {0, 1, 0, 1, 0, 1, 0}, {0.1, 0.3, 0.48, 0.52, 0.7, 0.9});
  expect_pattern(point_to_two(mixed, 2, 0.04), {0, 1, 0, 0, 0, 1, 0}, {0.1, 0.3, 0.48, 0.52, 0.7, 0.9});
  expect_pattern(remove_segment(point_to_line(mixed, 2, 0.04), 3), mixed.line, mixed.S);
  expect_pattern(remove_segment(point_to_two(mixed, 2, 0.04), 3), mixed.line, mixed.S);
}

TEST(SegmentationPatterns, ALineSplitsInsideOrLeavesAPointAtItsEnd) {
  expect_pattern(split_line(mixed, 1, 0.2, 0.02, 0.1, 0.3), {0, 1, 0, 1, 0, 0, 1, 0},
                 {0.1, 0.19, 0.21, 0.3, 0.5, 0.7, 0.9});
  expect_pattern(split_line(mixed, 1, 0.105, 0.02, 0.1, 0.3), {0, 0, 1, 0, 0, 1, 0}, {0.1, 0.12, 0.3, 0.5, 0.7, 0.9});
  expect_pattern(split_line(mixed, 4, 0.895, 0.02, 0.7, 0.9), {0, 1, 0, 0, 1, 0, 0}, {0.1, 0.3, 0.5, 0.7, 0.88, 0.9});
  // the stretch between the halves vanishes again: one line
  expect_pattern(remove_segment(split_line(mixed, 1, 0.2, 0.02, 0.1, 0.3), 2), mixed.line, mixed.S);
}

TEST(SegmentationPatterns, AVanishingSegmentMergesItsContacts) {
  expect_pattern(remove_segment(mixed, 1), {0, 0, 0, 1, 0}, {0.2, 0.5, 0.7, 0.9});  // line -> point
  expect_pattern(remove_segment(mixed, 2), {0, 1, 0, 1, 0}, {0.1, 0.3, 0.7, 0.9});  // line end takes the point
  expect_pattern(remove_segment(mixed, 3), {0, 1, 0, 1, 0}, {0.1, 0.3, 0.7, 0.9});
  const Pattern points{{0, 0, 0}, {0.4, 0.5}};
  expect_pattern(remove_segment(points, 1), {0, 0}, {0.45});  // two points -> one
  expect_pattern(remove_segment(points, 0), {0, 0}, {0.5});   // a contact reaches the end
  expect_pattern(remove_segment(points, 2), {0, 0}, {0.4});
  EXPECT_EQ(remove_segment(clear_of_wall, 0), clear_of_wall);  // the only segment stays
}

TEST(SegmentationPatterns, Counting) {
  EXPECT_EQ(point_contacts(clear_of_wall), 0);
  EXPECT_EQ(line_contacts(clear_of_wall), 0);
  EXPECT_EQ(point_contacts(mixed), 1);
  EXPECT_EQ(line_contacts(mixed), 2);
  EXPECT_EQ(point_contacts(point_to_two(mixed, 2, 0.04)), 2);
  EXPECT_EQ(line_contacts(point_to_line(mixed, 2, 0.04)), 3);
}

}  // namespace

// The system point_contact: every row of its table, and what the criterion is for: a rod kept at one point beyond it
// passes through the wall.
#include <gtest/gtest.h>

#include <cmath>

#include "tendril/reproduce/point_contact_states.hpp"
#include "tendril/reproduce/systems.hpp"
#include "tendril/segmentation/pattern_checks.hpp"

namespace tendril::reproduce {
namespace {

TEST(ReproducePointContact, EveryRowHolds) {
  const Outcome outcome = point_contact_system().compute({});
  EXPECT_GE(outcome.rows.size(), 30u);
  for (const Row& row : outcome.rows)
    EXPECT_LE(std::abs(row.computed - row.expected), row.tolerance) << row.quantity << ": " << row.computed;
  for (const Data& data : outcome.data) {
    EXPECT_EQ(data.columns.size(), data.value.size()) << data.name;
    for (const auto& column : data.value) EXPECT_EQ(column.size(), data.value.front().size()) << data.name;
  }
}

TEST(ReproducePointContact, StopsWhenAsked) {
  EXPECT_THROW(point_contact_system().compute([](double done, const std::string&) { return done < 0.3; }), Interrupted);
}

double smallest_gap(const point_contact::Chain& c) {
  double least = HUGE_VAL;
  for (int i = 1; i <= 200; ++i) least = std::min(least, segmentation::relative_gap(c, 1, c.S(1) + 1e-3 * i));
  return least;
}

TEST(ReproducePointContact, TheCriterionTellsWhetherTheRodPassesThroughTheWall) {
  for (const double load : {-2.0, -2.6}) {
    const auto c = point_contact::point_state(0.05, true, load);
    EXPECT_LT(segmentation::curvature_excess(c, 0), 0.0);
    EXPECT_GT(smallest_gap(c), 0.0) << load;
  }
  for (const double load : {-2.7, -3.0}) {
    const auto c = point_contact::point_state(0.05, true, load);
    EXPECT_GT(segmentation::curvature_excess(c, 0), 0.0);
    EXPECT_LT(smallest_gap(c), 0.0) << load;
  }
}

TEST(ReproducePointContact, TheUnsymmetricStateBendsInEveryDirection) {
  const auto point = point_contact::point_state(0.05, true, -2.0);
  const auto c = point_contact::contact(point_contact::oblique_state(point));
  // the state is chosen so that every jump condition has something to say
  EXPECT_GT(std::abs(c.before.kg), 0.1);
  EXPECT_GT(std::abs(c.before.kn), 1.0);
  EXPECT_GT(c.R, 5.0);
}

}  // namespace
}  // namespace tendril::reproduce

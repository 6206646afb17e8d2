// The systems lagrangian and small_inclination: every row of their tables, data that fits its columns.
#include <gtest/gtest.h>

#include <cmath>

#include "tendril/reproduce/systems.hpp"

namespace tendril::reproduce {
namespace {

void expect_rows(const System& system, std::size_t least) {
  const Outcome outcome = system.compute({});
  EXPECT_GE(outcome.rows.size(), least);
  for (const Row& row : outcome.rows)
    EXPECT_LE(std::abs(row.computed - row.expected), row.tolerance) << row.quantity << ": " << row.computed;
  for (const Data& data : outcome.data) {
    EXPECT_EQ(data.columns.size(), data.value.size()) << data.name;
    for (const auto& column : data.value) EXPECT_EQ(column.size(), data.value.front().size()) << data.name;
  }
  EXPECT_EQ(outcome.pictures.size(), 2u);
}

TEST(ReproduceLagrangian, EveryRowHolds) { expect_rows(lagrangian_system(), 100); }

TEST(ReproduceSmallInclination, EveryRowHolds) { expect_rows(small_inclination_system(), 31); }

TEST(ReproduceLagrangian, StopsWhenAsked) {
  EXPECT_THROW(lagrangian_system().compute([](double done, const std::string&) { return done < 0.1; }), Interrupted);
}

}  // namespace
}  // namespace tendril::reproduce

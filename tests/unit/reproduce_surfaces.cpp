// The systems surface_rods and sphere: every row of their tables holds, nothing is left out.
#include <gtest/gtest.h>

#include <cmath>

#include "tendril/reproduce/systems.hpp"

namespace tendril::reproduce {
namespace {

void expect_sound(const Outcome& outcome, std::size_t rows, std::size_t pictures) {
  EXPECT_GE(outcome.rows.size(), rows);
  for (const Row& row : outcome.rows)
    EXPECT_LE(std::abs(row.computed - row.expected), row.tolerance) << row.quantity << ": " << row.source;
  EXPECT_EQ(outcome.pictures.size(), pictures);
  for (const Data& data : outcome.data) {
    ASSERT_EQ(data.columns.size(), data.value.size()) << data.name;
    for (const auto& column : data.value) EXPECT_EQ(column.size(), data.value.front().size()) << data.name;
  }
}

TEST(ReproduceSurfaces, RodsAndStringsOnSurfaces) {
  const Outcome outcome = surface_rods_system().compute({});
  expect_sound(outcome, 43, 3);
  ASSERT_EQ(outcome.data.size(), 2u);
  EXPECT_EQ(outcome.data[0].value[0].size(), 5u * 301u);  // no rod ends early
  EXPECT_EQ(outcome.data[1].value[0].size(), 8u);         // every tension is reached
}

TEST(ReproduceSurfaces, StopWhenAsked) {
  for (const System& system : {surface_rods_system(), sphere_system()})
    EXPECT_THROW(system.compute([](double done, const std::string&) { return done < 0.1; }), Interrupted);
}

TEST(ReproduceSurfaces, Sphere) {
  const Outcome outcome = sphere_system().compute({});
  expect_sound(outcome, 43, 5);
  const Data& gallery = outcome.data[1];
  EXPECT_EQ(gallery.name, "gallery");
  EXPECT_EQ(gallery.value[0].size(), 20u);
}

}  // namespace
}  // namespace tendril::reproduce

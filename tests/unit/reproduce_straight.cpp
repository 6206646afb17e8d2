// The systems of straight tubes: every row of their tables holds, and the tables are as long as their pages say.
#include <gtest/gtest.h>

#include <cmath>

#include "tendril/closed_form/localized_rod.hpp"
#include "tendril/reproduce/systems.hpp"

namespace tendril::reproduce {
namespace {

void every_row_holds(const System& system, std::size_t rows) {
  const Outcome outcome = system.compute({});
  EXPECT_EQ(outcome.rows.size(), rows);
  for (const Row& row : outcome.rows)
    EXPECT_LE(std::abs(row.computed - row.expected), row.tolerance) << row.quantity << ": " << row.computed;
  for (const Data& data : outcome.data) {
    EXPECT_EQ(data.columns.size(), data.value.size()) << data.name;
    for (const auto& column : data.value) EXPECT_EQ(column.size(), data.value.front().size()) << data.name;
  }
  for (const Picture& picture : outcome.pictures)
    for (const auto& panel : picture.figure.panels) EXPECT_FALSE(panel.curves.empty()) << picture.name;
}

TEST(ReproduceStraight, PlanarElastica) { every_row_holds(planar_elastica_system(), 50); }
TEST(ReproduceStraight, StraightConduit) { every_row_holds(straight_conduit_system(), 59); }
TEST(ReproduceStraight, StraightTube) { every_row_holds(straight_tube_system(), 76); }

/// The closed form of the localized rod satisfies what it was derived from, by differences: r' = t, and M + r x F
/// constant along and across the axis.
TEST(LocalizedRod, IsInEquilibrium) {
  const closed_form::LocalizedRod rod{30.0, 1.7 * std::sqrt(30.0)};
  for (const double s : {-0.7, -0.2, 0.05, 0.4}) {
    const double h = 1e-3;
    const auto a = rod.at(s - 2 * h), b = rod.at(s - h), x = rod.at(s), c = rod.at(s + h), d = rod.at(s + 2 * h);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR((8 * (c.r[i] - b.r[i]) - (d.r[i] - a.r[i])) / (12 * h), x.t[i], 1e-6);  // fifth derivative, h⁴
      EXPECT_NEAR((8 * (c.t[i] - b.t[i]) - (d.t[i] - a.t[i])) / (12 * h), x.t1[i], 1e-4);
    }
    // M·D3 + (r x F)·D3 = M; F has no moment about the axis it is parallel to
    EXPECT_NEAR(x.t[0] * x.t1[1] - x.t[1] * x.t1[0] + rod.torque * x.t[2], rod.torque, 1e-11);
    EXPECT_NEAR(x.t[0] * x.t[0] + x.t[1] * x.t[1] + x.t[2] * x.t[2], 1, 1e-14);
  }
  EXPECT_NEAR(rod.at(3.0).r[2] - rod.at(-3.0).r[2], 6.0 - rod.shortening(), 1e-5);  // exp(-2 a √T s)
}

}  // namespace
}  // namespace tendril::reproduce

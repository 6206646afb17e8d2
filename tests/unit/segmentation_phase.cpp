// The phase of an axisymmetric problem: a state is turned about the axis until its largest eccentricity lies along D1,
// with everything that belongs to it.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/segmentation/chain.hpp"

namespace {

using namespace tendril;

TEST(SegmentationPhase, AStateIsTurnedWithItsHighestDerivatives) {
  segmentation::Problem problem;
  problem.tube.axis = geometry::make_straight(1.0);
  problem.tube.clearance = geometry::make_constant(0.05);
  problem.end.kind = segmentation::End::Kind::sleeve;
  const double angle = 0.7, c = std::cos(angle), s = std::sin(angle);
  segmentation::Chain chain(std::make_shared<segmentation::Mechanics>(problem), 6);
  // untwisted, in the plane at this angle: f = 0.3 S²(1 - S)², a shear force along it
  chain.build({{0}, {}}, 5, [&](double S, double* u, double* length) {
    const double f[4] = {0.3 * S * S * (1 - S) * (1 - S), 0.3 * (2 * S - 6 * S * S + 4 * S * S * S),
                         0.3 * (2 - 12 * S + 12 * S * S), 0.3 * (24 * S - 12)};
    std::fill(u, u + 17, 0.0);
    for (int j = 0; j < 4; ++j) u[j] = c * f[j], u[4 + j] = s * f[j];
    u[11] = c * (1.0 + S), u[12] = c, u[13] = s * (1.0 + S), u[14] = s;
    u[15] = -20.0;
    *length = S;
  });
  ASSERT_TRUE(chain.needs_phase());
  double u[17], length;
  for (const double S : {0.03, 0.29, 0.5, 0.81}) {
    chain.sample(S, u, &length);
    const double rounding = 1e-11;  // forces up to 20, derivatives up to 1e2
    EXPECT_NEAR(u[0], 0.3 * S * S * (1 - S) * (1 - S), 1e-3 * 0.3) << "along D1, to the mesh of five pieces";
    for (const int i : {4, 5, 6, 7, 13, 14}) EXPECT_NEAR(u[i], 0.0, rounding) << "input " << i << " at " << S;
  }
}

}  // namespace

// A whole well, vertical to horizontal, from its survey to a certified contact pattern of about a hundred contacts;
// with hardly any bending stiffness, the soft string. Where its data lie beside the checkout (not redistributed with
// it).

#include <gtest/gtest.h>

#include <filesystem>

#include "support/cosserat.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/io/case.hpp"

namespace tendril::test {
namespace {

using continuation::Status;
using continuation::Step;

const std::string survey = std::string(TENDRIL_SOURCE_DIR) + "/../shared/data/wells/wellpathpy_10H.csv";
constexpr double weight = 250.0;  // N/m

segmentation::Problem well(double axial_force, double softness = 1.0) {
  const std::string text = R"(schema = 1
title = "wellpathpy 10H, 5 in drill pipe in an 8 1/2 in hole"
units = "si"
[rod]
axial_stiffness = "703.9 MN"
bending_stiffness = )" + std::to_string(1.2285e6 / softness) +
                           R"(
poisson_ratio = 0.3
outer_diameter = "5 in"
weight_per_length = 250.0
[tube]
side = "inside"
radius = "4 1/4 in"
[tube.axis]
kind = "survey"
file = ")" + survey + R"("
[start]
kind = "clamped"
[end]
kind = "sleeve"
axial_force = )" + std::to_string(axial_force) +
                           "\ntorque = 0.0\n";
  return io::build_problem(io::parse_case(text, "well.toml", io::Format::toml));
}

class WholeWell : public testing::TestWithParam<double> {};

TEST_P(WholeWell, IsFoundFromNothing) {
  if (!std::filesystem::exists(survey)) GTEST_SKIP() << "no well data beside the checkout: " << survey;
  const segmentation::Problem p = well(GetParam());
  const auto r = continuation::solve(p, {});
  ASSERT_EQ(r.status, Status::converged) << r.message;
  const Step& s = r.steps[0];
  EXPECT_EQ(s.stability, "stable");
  EXPECT_GT(s.contacts.size(), 80u);
  EXPECT_LE(s.certificate.balance, 1e-8);
  EXPECT_LE(s.certificate.error, 1e-8);
  EXPECT_LE(s.certificate.continuity, 1e-8);
  EXPECT_GE(s.certificate.gap_min, -1e-7);
  EXPECT_GE(s.certificate.reaction_min, -1e-7);
  EXPECT_NEAR(s.axial_force_end, GetParam(), 1e-3);
  // energy H + σ·r is one number along the rod: tension at the top is the weight of the depth, to the bending at the
  // ends
  const double depth = p.tube.axis->at(p.tube.length()).position.z();
  EXPECT_NEAR((s.axial_force_start - s.axial_force_end) / (weight * depth), 1, 1e-3);
  const SolvedRod rod(p, s);
  EXPECT_LT(free_segments_against_integration(rod, p.tube.length()).largest(), 1e-7);
}

INSTANTIATE_TEST_SUITE_P(Loads, WholeWell, testing::Values(0.0, -50e3));

/// The whole of the well of examples/well_forge.toml, 3339 m with a station every 3 m: two hundred contacts, some only
/// centimetres apart.
TEST(ForgeWell, IsFoundFromNothing) {
  const segmentation::Problem p = io::build_problem(io::read_case(
      std::string(TENDRIL_SOURCE_DIR) + "/examples/well_forge.toml", {"tube.axis.from=0", "tube.axis.to=3339"}));
  const auto r = continuation::solve(p, {});
  ASSERT_EQ(r.status, Status::converged) << r.message;
  const Step& s = r.steps[0];
  EXPECT_EQ(s.stability, "stable");
  EXPECT_GT(s.contacts.size(), 150u);
  EXPECT_LE(s.certificate.balance, 1e-8);
  EXPECT_LE(s.certificate.error, 1e-8);
  EXPECT_LE(s.certificate.continuity, 1e-8);
  EXPECT_GE(s.certificate.gap_min, -1e-8);
  EXPECT_GE(s.certificate.reaction_min, -1e-8);
  const double depth = p.tube.axis->at(p.tube.length()).position.z();
  EXPECT_NEAR((s.axial_force_start - s.axial_force_end) / (weight * depth), 1, 1e-3);  // as above
  const SolvedRod rod(p, s);
  // under 650 kN the unstable direction grows by e every 1.4 m, and the longest free span has some 40 m
  EXPECT_LT(free_segments_against_integration(rod, p.tube.length(), 32).largest(), 1e-7);
}

TEST(SoftString, IsTheLimitOfAHundredthOfTheStiffness) {
  if (!std::filesystem::exists(survey)) GTEST_SKIP() << "no well data beside the checkout: " << survey;
  const segmentation::Problem p = well(0.0, 100.0);
  const auto r = continuation::solve(p, {});
  ASSERT_EQ(r.status, Status::converged) << r.message;
  const Step& step = r.steps[0];
  EXPECT_LE(step.certificate.balance, 1e-8);
  const SolvedRod rod(p, step);
  const double L = p.tube.length(), bin = 30.0;
  const int bins = static_cast<int>(L / bin);
  // the wall's push and the soft string's w n + T κ, both as vectors averaged over the bin
  std::vector<Vector3d> solved(bins, Vector3d::Zero()), soft(bins, Vector3d::Zero());
  const auto add = [&](double S, const Vector3d& force) {
    const int b = static_cast<int>(S / bin);
    if (b >= 0 && b < bins) solved[b] += force / bin;
  };
  const auto inwards = [&](double S) { return Vector3d(-rod.at(S).normal); };
  for (const auto& c : step.contacts) {
    if (!c.line) {
      add(c.start, c.force_vector);
      continue;
    }
    add(c.start, c.force_start.value_or(0.0) * inwards(c.start));
    add(c.end, c.force_end.value_or(0.0) * inwards(c.end));
    const int n = std::max(20, static_cast<int>((c.end - c.start) / 0.02)), j = rod.segment_at(0.5 * (c.start + c.end));
    const double h = (c.end - c.start) / n;
    for (int i = 0; i < n; ++i) {
      const double S = c.start + h * (i + 0.5);
      add(S, h * rod.pressure(j, S) * inwards(S));
    }
  }
  // T is the weight hanging below
  const double bottom = p.tube.axis->at(L).position.z();
  double largest = 0.0;
  for (int b = 0; b < bins; ++b) {
    constexpr int samples = 3000;
    for (int i = 0; i < samples; ++i) {
      const auto axis = p.tube.axis->at(bin * (b + (i + 0.5) / samples));
      const Vector3d t = axis.frame.col(2), w(0, 0, weight);
      const Vector3d curvature = axis.frame.col(0) * axis.U[0][1] - axis.frame.col(1) * axis.U[0][0];
      const double T = weight * (bottom - axis.position.z());
      soft[b] += (w - w.dot(t) * t + T * curvature) / samples;
    }
    largest = std::max(largest, soft[b].norm());
  }
  // The string does not follow the axis: steep and taut it crosses from wall to wall, and T times the change of its
  // inclination to the axis moves 30 m averages by up to 6 % of the largest. Counted, the balance must close
  // everywhere; where the hole lies flat enough for one wall to carry it, from 800 m on, the plain formula must do.
  const auto off_axis = [&](double S) {
    const auto axis = p.tube.axis->at(S);
    return Vector3d(weight * (bottom - axis.position.z()) * (rod.at(S).d.col(2) - axis.frame.col(2)));
  };
  for (int b = 0; b < bins; ++b) {
    if (b * bin < 50.0 || (b + 1) * bin > L - 50.0) continue;
    SCOPED_TRACE("from " + std::to_string(b * bin) + " m");
    const Vector3d string = soft[b] + (off_axis((b + 1) * bin) - off_axis(b * bin)) / bin;
    EXPECT_LT((solved[b] + string).norm(), 0.02 * largest);
    if (b * bin >= 800.0) EXPECT_NEAR(solved[b].norm(), soft[b].norm(), 0.02 * largest);
  }
}

}  // namespace
}  // namespace tendril::test

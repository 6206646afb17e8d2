// Stresses in the section: resultants recovered by integration, the largest von Mises stress against a search over the
// section, strains against Hooke's law, lateral contraction (A.1.3-4 with their first terms corrected).

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "tendril/rod/section_stress.hpp"

namespace tendril::rod {
namespace {

constexpr double rounding = 1e-13;  // relative

class SectionStresses : public testing::TestWithParam<CircularSection> {};

const Resultants given_resultants[] = {{100, 2, -3, 4}, {-80, 0.5, 0.1, -3}, {0, 0, 0, 2},
                                       {0, 1, 1, 0},    {50, 0, 0, 0},       {-200, -2, 5, 6}};

/// Integral over the section, exact for the polynomials of degree 2 that occur.
template <class F>
double over(const CircularSection& section, F f) {
  using Gauss = boost::math::quadrature::gauss<double, 15>;
  constexpr int around = 16;
  double sum = 0;
  for (int i = 0; i < around; ++i) {
    const double angle = 2 * M_PI * i / around;
    sum += Gauss::integrate([&](double r) { return r * f(r * std::cos(angle), r * std::sin(angle)); },
                            section.inner_diameter / 2, section.radius()) *
           2 * M_PI / around;
  }
  return sum;
}

TEST_P(SectionStresses, IntegrateToForceAndMoment) {  // (A.1.7)
  const CircularSection& section = GetParam();
  EXPECT_NEAR(over(section, [](double, double) { return 1; }) / section.area(), 1, rounding);
  EXPECT_NEAR(over(section, [](double a1, double) { return a1 * a1; }) / section.second_moment(), 1, rounding);
  for (const Resultants& r : given_resultants) {
    const auto s = [&](double a1, double a2) { return stress_at(section, r, a1, a2); };
    EXPECT_NEAR(over(section, [&](double a, double b) { return s(a, b).s33; }), r.F3, 1e-12 * 200);
    EXPECT_NEAR(over(section, [&](double a, double b) { return b * s(a, b).s33; }), r.M1, 1e-12 * 10);
    EXPECT_NEAR(over(section, [&](double a, double b) { return -a * s(a, b).s33; }), r.M2, 1e-12 * 10);
    EXPECT_NEAR(over(section, [&](double a, double b) { return a * s(a, b).s32 - b * s(a, b).s31; }), r.M3, 1e-12 * 10);
    EXPECT_NEAR(over(section, [&](double a, double b) { return s(a, b).s31; }), 0, 1e-12 * 200);
  }
}

TEST_P(SectionStresses, LargestVonMisesIsThatOfASearch) {
  const CircularSection& section = GetParam();
  const Elasticity steel{200e3, 0.3};
  for (const Resultants& r : given_resultants) {
    double most = 0;
    const double inner = section.inner_diameter / 2;
    for (int i = 0; i <= 40; ++i)
      for (int j = 0; j < 20000; ++j) {
        const double rho = inner + (section.radius() - inner) * i / 40, angle = 2 * M_PI * j / 20000;
        most = std::max(most, stress_at(section, r, rho * std::cos(angle), rho * std::sin(angle)).von_mises());
      }
    // The search misses the place by at most half a step around, 1.6e-4 rad: cos of it is 1 - 1.2e-8.
    EXPECT_NEAR(section_stress(section, steel, r).von_mises / most, 1, 2e-8);
  }
}

TEST_P(SectionStresses, StrainIsThatOfHooke) {
  const CircularSection& section = GetParam();
  const Elasticity steel{200e3, 0.3};
  for (const Resultants& r : given_resultants) {
    const SectionStress s = section_stress(section, steel, r);
    // The strain tensor at the point of the largest stress, its eigenvalues by another way.
    const double normal = (r.F3 < 0 ? -1 : 1) * (std::abs(s.axial) + s.bending);
    Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();
    stress(2, 2) = normal;
    stress(0, 2) = stress(2, 0) = s.torsion;
    const Eigen::Matrix3d strain =
        (1 + steel.poisson_ratio) / steel.young_modulus * stress -
        steel.poisson_ratio / steel.young_modulus * stress.trace() * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d principal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(strain).eigenvalues();
    EXPECT_NEAR(s.strain / principal.cwiseAbs().maxCoeff(), 1, 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Sections, SectionStresses,
                         testing::Values(CircularSection{0.8, 0.0}, CircularSection{0.8, 0.5}),
                         [](const auto& i) { return i.param.inner_diameter > 0 ? "tube" : "solid"; });

TEST(SectionStress, WarnsAboveTwoPercent) {
  EXPECT_EQ(small_strain_warning(0.0199), "");
  EXPECT_NE(small_strain_warning(0.031).find("3.1 %"), std::string::npos);
}

}  // namespace
}  // namespace tendril::rod

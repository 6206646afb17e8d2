// Closed-form axes and their transforms: definitions by differences, positions by their parametric equations, laws.

#include <gtest/gtest.h>

#include <numbers>

#include "geometry_checks.hpp"
#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/axis_transforms.hpp"
#include "tendril/geometry/error.hpp"

namespace {

using namespace tendril::geometry;
using geometry_checks::defects;

constexpr double kPi = std::numbers::pi;
constexpr double kRounding = 1e-14;   // a few operations on numbers of size one
constexpr double kDifference = 1e-9;  // order six at h = 1e-3 of lengths with rates below 10: (10 h)^6 + eps/h

void expect_sound(const AxisPtr& axis, double h = 1e-3) {
  const auto worst = defects(*axis, h);
  EXPECT_LT(worst.tangent, kDifference);
  EXPECT_LT(worst.frame, kDifference);
  EXPECT_LT(worst.derivatives, kDifference);
  EXPECT_LT(worst.orthonormal, kRounding);
}

TEST(GeometryAxes, HelixFollowsItsEquationOnBothHands) {
  for (double pitch : {0.7, -0.7, 1.3, kPi / 2}) {
    const double r = 0.3, length = 5.0;
    const auto axis = make_helix(r, pitch, length);
    for (double S : {0.0, 0.4, 2.2, 5.0}) {
      const double omega = S * std::sin(pitch) / r;
      const Vec3 expected(r * std::cos(omega), r * std::sin(omega), S * std::cos(pitch));
      EXPECT_LT((axis->at(S).position - expected).norm(), kRounding);
    }
    EXPECT_NEAR(axis->at(1.0).U[0].norm(), std::pow(std::sin(pitch), 2) / r, kRounding);
    expect_sound(axis);
  }
}

TEST(GeometryAxes, HelixHasTheBishopFrameOfTheThesis) {
  // Model section 7: U1 = K sinΦ, U2 = K cosΦ, Φ = -τ S for D1(0) the Frenet normal (-e_x at S = 0).
  const double theta = kPi / 4, r = 1.0 / (kPi * std::sqrt(2.0));
  const auto axis = make_helix(r, theta, 1.0);
  const double K = 0.5 / r, tau = 0.5 / r;
  EXPECT_LT((axis->at(0.0).frame.col(0) + Vec3::UnitX()).norm(), kRounding);
  for (double S : {0.0, 0.3, 1.0}) {
    const auto U = axis->at(S).U;
    EXPECT_NEAR(U[0][0], K * std::sin(-tau * S), kRounding);
    EXPECT_NEAR(U[0][1], K * std::cos(tau * S), kRounding);
    EXPECT_EQ(U[0][2], 0.0);
    EXPECT_NEAR(U[3][0], K * std::pow(tau, 3) * std::cos(tau * S), 50 * kRounding);  // magnitudes K tau^3 = 24
  }
}

TEST(GeometryAxes, ArcStraightAndTorusAreWhereTheContractPutsThem) {
  const auto arc = make_arc(2.0, 3.0);
  const double a = 1.1 / 2.0;
  EXPECT_LT((arc->at(1.1).position - Vec3(2 * (1 - std::cos(a)), 0, 2 * std::sin(a))).norm(), kRounding);
  EXPECT_LT((arc->at(0.0).frame.col(0) - Vec3::UnitX()).norm(), kRounding);
  EXPECT_NEAR(arc->at(2.0).U[0][1], 0.5, kRounding);
  expect_sound(arc);

  const auto torus = make_torus(1.5);
  EXPECT_NEAR(torus->length(), 3 * kPi, kRounding);
  EXPECT_LT((torus->at(1.5 * kPi / 2).position - Vec3(0, 1.5, 0)).norm(), kRounding);
  EXPECT_LT((torus->at(torus->length()).position - torus->at(0).position).norm(), kRounding);
  EXPECT_LT((torus->at(torus->length()).frame - torus->at(0).frame).norm(), kRounding);
  expect_sound(torus);
  // The torus frame of model section 7: D1 = e_r gives D2 = -e_z, U = (0, -1/a, 0).
  const auto program = make_torus(1.0, Vec3(1, 0, 0));
  EXPECT_LT((program->at(0.7).U[0] - Vec3(0, -1, 0)).norm(), kRounding);
  EXPECT_LT((program->at(0.7).frame.col(1) + Vec3::UnitZ()).norm(), kRounding);

  const auto line = make_straight(3.0, Vec3(0, 3, 4), Vec3(1, 2, 3));
  EXPECT_LT((line->at(2.5).position - Vec3(1, 3.5, 5)).norm(), kRounding);
  EXPECT_LT((line->at(2.5).frame.col(0) - Vec3::UnitX()).norm(), kRounding);
  EXPECT_EQ(line->at(1.0).U[0].norm(), 0.0);
  // First world axis not along D3: x is, so y.
  EXPECT_LT((make_straight(1.0, Vec3(2, 0, 0))->at(0.5).frame.col(0) - Vec3::UnitY()).norm(), kRounding);
}

TEST(GeometryAxes, NormalSetsTheFirstDirector) {
  const Vec3 wished(1, 2, 3);
  for (const auto& axis : {make_helix(0.3, 0.7, 2.0, wished), make_straight(1.0, Vec3(1, 1, 0), Vec3::Zero(), wished),
                           with_normal(make_torus(1.0), wished)}) {
    const auto p = axis->at(0.0);
    const Vec3 D3 = p.frame.col(2), expected = (wished - wished.dot(D3) * D3).normalized();
    EXPECT_LT((p.frame.col(0) - expected).norm(), kRounding);
    expect_sound(axis);
  }
}

TEST(GeometryAxes, TransformsKeepTheDefinitions) {
  const auto helix = make_helix(0.3, 0.7, 2.0);
  const auto law = [](double S) {
    return std::array<double, 5>{std::sin(2 * S), 2 * std::cos(2 * S), -4 * std::sin(2 * S), -8 * std::cos(2 * S),
                                 16 * std::sin(2 * S)};
  };
  const Mat3 turn = Eigen::AngleAxisd(0.8, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  for (const auto& axis :
       {rotate_translate(helix, turn, Vec3(1, 2, 3)), mirror(helix, Vec3(1, 1, 0)), reverse(helix),
        subrange(helix, 0.5, 1.5), with_frame_twist(helix, law), mirror(with_frame_twist(helix, law)),
        reverse(with_frame_twist(helix, law)), scaled(with_frame_twist(helix, law), 1.7)}) {
    expect_sound(axis);
  }
  EXPECT_GT(std::abs(with_frame_twist(helix, law)->at(0.1).U[0][2]), 1.0);
  EXPECT_NEAR(scaled(helix, 10.0)->length(), 20.0, kRounding);
  EXPECT_LT((reverse(helix)->at(0.5).position - helix->at(1.5).position).norm(), kRounding);
  EXPECT_LT((reverse(reverse(helix))->at(0.5).frame - helix->at(0.5).frame).norm(), kRounding);
  // A mirrored right-handed helix is a left-handed one.
  const auto left = make_helix(0.3, -0.7, 2.0), image = mirror(helix, Vec3::UnitY());
  EXPECT_LT((image->at(1.3).position - left->at(1.3).position).norm(), kRounding);
  EXPECT_LT((image->at(1.3).frame - left->at(1.3).frame).norm(), kRounding);
}

TEST(GeometryAxes, KnotsMoveWithTheTransforms) {
  struct Knotted final : Axis {  // a straight line that claims knots
    AxisPtr line = make_straight(4.0);
    std::vector<double> places{1.0, 2.5};
    double length() const override { return 4.0; }
    AxisPoint at(double S) const override { return line->at(S); }
    const std::vector<double>& knots() const override { return places; }
  };
  const auto axis = std::make_shared<Knotted>();
  EXPECT_EQ(reverse(axis)->knots(), (std::vector<double>{1.5, 3.0}));
  EXPECT_EQ(scaled(axis, 2.0)->knots(), (std::vector<double>{2.0, 5.0}));
  EXPECT_EQ(subrange(axis, 1.0, 3.0)->knots(), (std::vector<double>{1.5}));
}

TEST(GeometryAxes, WrongInputIsRefusedWithEveryProblem) {
  try {
    make_helix(-1.0, 2.0, 0.0);
    FAIL();
  } catch (const GeometryError& error) {
    ASSERT_EQ(error.issues.size(), 3u);
    EXPECT_EQ(error.what_field, "radius");
    EXPECT_EQ(error.value, -1.0);
    EXPECT_EQ(error.issues[2].field, "pitch_angle");
    EXPECT_NE(std::string(error.what()).find("length: is 0"), std::string::npos);
  }
  EXPECT_THROW(make_straight(1.0, Vec3::Zero()), GeometryError);
  EXPECT_THROW(make_straight(std::nan("")), GeometryError);
  EXPECT_THROW(make_straight(1.0, Vec3::UnitZ(), Vec3::Zero(), Vec3(0, 0, 2)), GeometryError);
  EXPECT_THROW(make_arc(0.0, 1.0), GeometryError);
  EXPECT_THROW(make_torus(-2.0), GeometryError);
  EXPECT_THROW(rotate_translate(make_torus(1.0), 2.0 * Mat3::Identity(), Vec3::Zero()), GeometryError);
  try {
    subrange(make_straight(4.0), 1.0, 5.0);
    FAIL();
  } catch (const GeometryError& error) {
    EXPECT_EQ(error.value, 5.0);
    EXPECT_EQ(error.bound, 4.0);
  }
}

}  // namespace

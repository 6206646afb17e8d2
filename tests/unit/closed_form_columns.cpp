// Buckling loads and the planar elastica between two walls, against integrated shapes.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "tendril/closed_form/columns.hpp"

namespace tendril::closed_form {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double euler = 4.0 * pi * pi;  // of a clamped rod, B = L = 1
// Runge-Kutta of order 4 with 4000 steps over a unit length and wave numbers up to 20: (20/4000)^4 ~ 6e-10.
constexpr double integration = 1e-8;

template <class State, class Rate>
State integrate(State y, double length, int steps, Rate&& rate) {
  const auto add = [](State a, const State& b, double w) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += w * b[i];
    return a;
  };
  const double h = length / steps;
  for (int i = 0; i < steps; ++i) {
    const State a = rate(y), b = rate(add(y, a, h / 2)), c = rate(add(y, b, h / 2)), d = rate(add(y, c, h));
    y = add(add(add(add(y, a, h / 6), b, h / 3), c, h / 3), d, h / 6);
  }
  return y;
}

/// x, y, slope, curvature after the arc: B θ'' = -P sinθ + V cosθ, thrust P along -x, wall force V along y.
std::array<double, 4> elastica(double curvature, double thrust, double shear, double length) {
  return integrate(std::array<double, 4>{0, 0, 0, curvature}, length, 4000, [&](const std::array<double, 4>& q) {
    return std::array<double, 4>{std::cos(q[2]), std::sin(q[2]), q[3],
                                 -thrust * std::sin(q[2]) + shear * std::cos(q[2])};
  });
}

TEST(ClosedFormColumns, EulerLoadsOfTheClampedRod) {
  EXPECT_NEAR(euler_load_clamped(1, 1.0, 1.0), euler, 1e-13);
  EXPECT_NEAR(euler_load_clamped(2, 1.0, 1.0), 80.762914225, 1e-9);  // 4 z², tan z = z, z = 4.493409457909
  EXPECT_NEAR(euler_load_clamped(3, 1.0, 1.0), 4.0 * euler, 1e-12);
  EXPECT_NEAR(euler_load_clamped(1, 2.0, 3.0), euler * 3.0 / 4.0, 1e-13);
  for (int n = 1; n < 8; ++n) EXPECT_LT(euler_load_clamped(n, 1, 1), euler_load_clamped(n + 1, 1, 1));
}

/// |det| of the clamped boundary conditions of w'''' - i m w''' + P w'' = 0 from the integrated fundamental solutions.
double clamped_determinant(double torque, double thrust) {
  using Complex = std::complex<double>;
  using State = std::array<Complex, 4>;
  const auto rate = [&](const State& w) { return State{w[1], w[2], w[3], Complex(0, torque) * w[3] - thrust * w[2]}; };
  const State a = integrate(State{0, 0, 1, 0}, 1.0, 4000, rate), b = integrate(State{0, 0, 0, 1}, 1.0, 4000, rate);
  return std::abs(a[0] * b[1] - a[1] * b[0]);
}

TEST(ClosedFormColumns, GreenhillTorqueOfTheClampedRodIsTheFirstRoot) {
  EXPECT_NEAR(greenhill_torque_clamped(0.0, 1.0, 1.0), 8.986818915818, 1e-11);
  for (const double thrust : {-30.0, -5.0, 0.0, 5.0, 39.0}) {
    const double torque = greenhill_torque_clamped(thrust, 1.0, 1.0);
    EXPECT_LT(clamped_determinant(torque, thrust), integration) << "thrust " << thrust;
    // No earlier root: the determinant stays clear of zero on the way from no torque.
    for (double part = 0.0; part < 0.96; part += 0.05)
      EXPECT_GT(clamped_determinant(part * torque, thrust), 1e-5) << "thrust " << thrust << ", part " << part;
  }
  EXPECT_NEAR(greenhill_torque_clamped(euler * (1 - 1e-10), 1.0, 1.0), 0.0, 1e-3);
  EXPECT_NEAR(greenhill_torque_clamped(5.0 / 4, 2.0, 1.0), greenhill_torque_clamped(5.0, 1.0, 1.0) / 2, 1e-12);
  EXPECT_THROW(greenhill_torque_clamped(40.0, 1.0, 1.0), std::domain_error);
}

TEST(ClosedFormColumns, GreenhillTorqueOfTheHingedRod) {
  EXPECT_NEAR(greenhill_torque_hinged(0.0, 1.0, 1.0), 2 * pi, 1e-14);
  EXPECT_NEAR(greenhill_torque_hinged(pi * pi, 1.0, 1.0), 0.0, 1e-14);
  EXPECT_THROW(greenhill_torque_hinged(9.9, 1.0, 1.0), std::domain_error);
}

TEST(ClosedFormColumns, FirstContactIsAnElasticaBetweenClamps) {
  for (const double slope : {0.01, 0.4, 1.3}) {
    const PlanarState s = first_contact(slope, 1.0, 1.0);
    const double curvature = 2.0 * std::sqrt(s.thrust) * std::sin(slope / 2);  // ½κ² + P(1 - ...): zero at slope a
    const auto middle = elastica(curvature, s.thrust, 0.0, 0.5);
    EXPECT_NEAR(middle[0], s.span / 2, integration);
    EXPECT_NEAR(middle[1], s.clearance, integration);
    EXPECT_NEAR(middle[2], 0.0, integration) << "the rod is parallel to the wall where it touches";
    EXPECT_LT(middle[3], 0.0) << "and curved away from it";
  }
}

TEST(ClosedFormColumns, PointToLineHasNoCurvatureAtTheContact) {
  for (const double slope : {0.01, 0.3, 0.9}) {
    const PlanarState s = point_to_line(slope, 1.0, 1.0);
    const auto middle = elastica(0.0, s.thrust, s.reaction / 2, 0.5);
    EXPECT_NEAR(middle[0], s.span / 2, integration);
    EXPECT_NEAR(middle[1], s.clearance, integration);
    EXPECT_NEAR(middle[2], 0.0, integration);
    EXPECT_NEAR(middle[3], 0.0, 20 * integration) << "curvature scales with the wave number";
    EXPECT_NEAR(std::tan(slope), 2 * s.clearance / s.span, 1e-14);
  }
}

TEST(ClosedFormColumns, FlatPartIsAClampedColumnAtItsEulerLoad) {
  for (const double slope : {0.01, 0.3, 0.9}) {
    const PlanarState s = flat_part_buckles(slope, 1.0, 1.0);
    EXPECT_NEAR(2 * s.arc_length + s.flat_length, 1.0, 1e-15);
    EXPECT_NEAR(s.thrust, euler_load_clamped(1, s.flat_length, 1.0), 1e-12 * s.thrust);
    const auto end = elastica(0.0, s.thrust, s.reaction / 2, s.arc_length);
    EXPECT_NEAR(2 * end[0] + s.flat_length, s.span, integration);
    EXPECT_NEAR(end[1], s.clearance, integration);
    EXPECT_NEAR(end[2], 0.0, integration);
    EXPECT_NEAR(end[3], 0.0, 50 * integration);
  }
}

TEST(ClosedFormColumns, SmallClearanceGivesLoadsOneFourAndNine) {
  // Corrections are of the order of (h/D)².
  const double h = 1e-4, second_order = 50 * h * h;
  EXPECT_NEAR(first_contact_at_span(h, 1.0, 1.0).thrust / euler, 1.0, second_order);
  EXPECT_NEAR(point_to_line_at_span(h, 1.0, 1.0).thrust / euler, 4.0, 4 * second_order);
  EXPECT_NEAR(flat_part_buckles_at_span(h, 1.0, 1.0).thrust / euler, 9.0, 9 * second_order);
}

TEST(ClosedFormColumns, GivenSpanAndClearanceAreMet) {
  const double h = 0.3, span = 4.0, B = 2.5;
  for (const PlanarState& s :
       {first_contact_at_span(h, span, B), point_to_line_at_span(h, span, B), flat_part_buckles_at_span(h, span, B)}) {
    EXPECT_NEAR(s.clearance, h, 1e-13);
    EXPECT_NEAR(s.span, span, 1e-13);
    EXPECT_GT(s.rod_length, span);
  }
  EXPECT_THROW(flat_part_buckles_at_span(0.4, 1.0, 1.0), std::domain_error);
  EXPECT_THROW(first_contact_at_span(0.0, 1.0, 1.0), std::domain_error);
  EXPECT_THROW(point_to_line(1.6, 1.0, 1.0), std::domain_error);
}

}  // namespace
}  // namespace tendril::closed_form

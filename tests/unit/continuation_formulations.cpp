// solve.formulation: the Lagrangian twin of a solved state for every kind of end and load, and the small inclination
// approximation with its distance from the exact state.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tendril/continuation/formulations.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/reproduce/lagrangian_conduit.hpp"

namespace tendril::continuation {
namespace {

using segmentation::AxialControl;
using segmentation::End;
using segmentation::Formulation;
using segmentation::Problem;
using segmentation::TwistControl;
using segmentation::Which;

Result solve_as(const Problem& p, Formulation f, double tolerance = 1e-10) {
  StudyOptions o;
  o.solve.tolerance = tolerance;
  o.solve.formulation = f;
  o.fields = true;
  o.field_points = 61;
  return solve(p, o);
}

// Both asked 1e-10; moments are two derivatives of the eccentricity.
constexpr double agreement = 1e-9;

void expect_twin(const Problem& p) {
  const Result r = solve_as(p, Formulation::lagrangian);
  ASSERT_EQ(r.status, Status::converged) << r.message;
  const Step& s = r.steps.at(0);
  ASSERT_TRUE(s.comparison);
  const Comparison& d = *s.comparison;
  EXPECT_LT(std::max({d.place, d.directors, d.force, d.moment, d.rod_length}), agreement);
  EXPECT_GT(d.place, 0.0);  // not one and the same
  // what is reported is the twin's, contact by contact and field by field
  const Step e = solve_as(p, Formulation::eulerian).steps.at(0);
  ASSERT_EQ(e.contacts.size(), s.contacts.size());
  const double F = 1.0 + std::abs(e.axial_force_end);
  for (std::size_t i = 0; i < e.contacts.size(); ++i) {
    const Contact &a = e.contacts[i], &b = s.contacts[i];
    EXPECT_NEAR(a.start, b.start, 1e-8);
    EXPECT_NEAR(a.end, b.end, 1e-8);
    EXPECT_NEAR(a.s_start, b.s_start, 1e-8);
    EXPECT_NEAR(a.angle_start, b.angle_start, 1e-7);
    EXPECT_NEAR(a.force, b.force, 1e-7 * F);
    EXPECT_LT((a.force_vector - b.force_vector).norm(), 1e-7 * F);
    EXPECT_NEAR(a.pressure_min, b.pressure_min, 1e-6 * F);
    EXPECT_NEAR(a.pressure_mid, b.pressure_mid, 1e-6 * F);
  }
  for (std::size_t i = 0; i < e.fields.S.size(); ++i) {
    EXPECT_NEAR(e.fields.x[i], s.fields.x[i], agreement);
    EXPECT_NEAR(e.fields.phi[i], s.fields.phi[i], 1e-8);
    EXPECT_NEAR(e.fields.M1[i], s.fields.M1[i], 1e-7);
  }
  EXPECT_NEAR(e.push, s.push, 1e-7 * F);
}

TEST(Formulations, TwinOfThePointAndTheLineContact) {
  const double T0 = reproduce::helical_conduit_force();
  expect_twin(reproduce::helical_conduit_case(1.0 / 20, -2.0 * T0));
  expect_twin(reproduce::helical_conduit_case(1.0 / 40, -5.0 * T0));
}

Problem bent() {
  Problem p;
  p.tube.axis = geometry::make_helix(0.4, 0.6, 1.0);
  p.tube.clearance = geometry::make_constant(0.03);
  p.rod = {1.0, 0.8, 900.0};
  p.end.kind = End::Kind::sleeve;
  p.end_position = 1.0;
  p.start.eccentricity[0] = 0.01;
  p.start.slope[1] = 0.05;
  p.end.eccentricity[1] = -0.012;
  p.axial_value = -6.0;
  p.twist_value = 1.5;
  return p;
}

TEST(Formulations, TwinUnderWeightAndCouple) {
  Problem p = bent();
  p.load.force = {0.0, -60.0, 25.0};
  expect_twin(p);
  p.load.couple = {0.3, -0.2, 0.8};
  expect_twin(p);
}

TEST(Formulations, TwinOfEveryKindOfEnd) {
  Problem pinned = bent();
  pinned.start.kind = End::Kind::pinned;
  pinned.start.roll = 0.4;
  pinned.end.kind = End::Kind::pinned;
  expect_twin(pinned);
  Problem turned = bent();
  turned.twist = TwistControl::twist;
  turned.twist_value = 2.2;
  turned.axial_at = Which::start;
  expect_twin(turned);
  Problem pushed = bent();
  pushed.axial = AxialControl::push;
  pushed.axial_value = 5.0;
  pushed.twist_at = Which::start;
  expect_twin(pushed);
  Problem held = bent();
  held.axial = AxialControl::rod_length;
  held.axial_value = solve_as(bent(), Formulation::eulerian).steps.at(0).rod_length * 1.002;
  expect_twin(held);
}

TEST(Formulations, SmallInclinationSaysHowFarItIs) {
  const double T0 = reproduce::helical_conduit_force();
  const Result r = solve_as(reproduce::helical_conduit_case(1.0 / 20, -1.25 * T0), Formulation::small_inclination);
  ASSERT_EQ(r.status, Status::outside_validity) << "an approximation is not a certified state";
  EXPECT_NE(r.message.find("not a state of the exact equations"), std::string::npos) << r.message;
  const Step& s = r.steps.at(0);
  ASSERT_TRUE(s.comparison);
  EXPECT_NEAR(s.comparison->place, 0.0394342 - 0.0198592, 5e-4);  // largest near the middle
  EXPECT_NEAR(s.comparison->rod_length, 1.070851154 - s.rod_length, 1e-8);
  EXPECT_GT(s.certificate.equilibrium, 1e-3);  // an approximation does not pass as an exact state
  const Result line = solve_as(reproduce::helical_conduit_case(1.0 / 40, -2.5 * T0), Formulation::small_inclination);
  EXPECT_EQ(line.status, Status::outside_validity);
}

}  // namespace
}  // namespace tendril::continuation

// Rods that vary along their length: a constant law against the uniform rod, states against the independent
// integration of the Cosserat rod (support/cosserat.hpp), steps as the limit of steep laws, closed forms.

#include <gtest/gtest.h>

#include <cmath>

#include "segmentation_helical.hpp"
#include "support/cosserat.hpp"
#include "support/problems.hpp"
#include "tendril/continuation/report_state.hpp"
#include "tendril/segmentation/certificate.hpp"

namespace {

using namespace tendril;
using segmentation::Chain;
using segmentation::Closure;
using segmentation::Mechanics;
using segmentation::Problem;

/// The law of one piece after another, each constant.
rod::SectionEntry part(double from, double to, const rod::Rod& a, const rod::Rod& b, rod::SectionEntry::Between how) {
  rod::SectionEntry e;
  e.from = from;
  e.to = to;
  e.rod[0] = a;
  e.rod[1] = b;
  e.between = how;
  return e;
}

rod::Rod times(rod::Rod rod, double f) {
  rod.bending_stiffness *= f;
  rod.torsional_stiffness *= f;
  if (rod.axial_stiffness) *rod.axial_stiffness *= f;
  return rod;
}

/// The same pattern on another rod, from a solved state.
Chain on(const Chain& c, const Problem& problem) {
  const auto mechanics = std::make_shared<Mechanics>(problem, helical::T0);
  Chain out(mechanics, c.k());
  out.set_parameter(c.parameter());
  std::vector<double> points;
  for (int j = 0; j < c.segments(); ++j)
    for (int i = 1; i < c.segment(j).pieces(); ++i) points.push_back(c.segment(j).place(i, c.S(j), c.S(j + 1)));
  out.build(c.pattern(), points, [&](double S, double* u, double* s) { c.sample(S, u, s); });
  return out;
}

continuation::Step solved(Chain& c) {
  const auto s = c.solve_adaptive({Closure::Kind::parameter, 0, c.parameter()}, {}, helical::tolerance);
  EXPECT_TRUE(s.converged) << s.reason;
  return continuation::describe(c, 0);
}

// Line contact, point contacts and a free rod: the same rod written as a law of three equal pieces.
TEST(VaryingRod, ConstantLawIsTheUniformRod) {
  for (const int kind : {0, 1, 2}) {
    Chain c = kind == 0 ? helical::free_chain(-1.25) : kind == 1 ? helical::point_chain(-1.8) : helical::line_chain(-5);
    const auto uniform = solved(c);
    for (const bool from_end : {false, true}) {
      Problem p = helical::problem();
      const double o = from_end ? -1.4 : 0.0;
      p.law = rod::section_law(p.rod, 0.0,
                               {part(o + 0.2, o + 0.4, p.rod, p.rod, rod::SectionEntry::Between::linear),
                                part(o + 0.4, o + 0.63, p.rod, p.rod, rod::SectionEntry::Between::smooth)},
                               from_end);
      Chain v = on(c, p);
      const auto varying = solved(v);
      EXPECT_NEAR(varying.rod_length, uniform.rod_length, 1e-11);
      EXPECT_NEAR(varying.axial_force_start, uniform.axial_force_start, 1e-9);
      ASSERT_EQ(varying.contacts.size(), uniform.contacts.size());
      for (std::size_t i = 0; i < varying.contacts.size(); ++i) {
        EXPECT_NEAR(varying.contacts[i].start, uniform.contacts[i].start, 1e-9);
        EXPECT_NEAR(varying.contacts[i].s_start, uniform.contacts[i].s_start, 1e-9);
        EXPECT_NEAR(varying.contacts[i].force, uniform.contacts[i].force, 1e-8 * uniform.contacts[i].force);
      }
      EXPECT_LT(varying.certificate.balance, 1e-9);
      EXPECT_LT(varying.certificate.continuity, 1e-9);
      EXPECT_LT(varying.certificate.equilibrium, 1e-6);
    }
  }
}

// Steps, linear and smooth changes of every property, in a curved tube with weight, with and without a point contact,
// against the integration from break to break.
TEST(VaryingRod, AgreesWithTheIntegratedCosseratRod) {
  for (const bool contact : {false, true}) {
    Chain c = contact ? helical::point_chain(-1.8) : helical::free_chain(-1.2);
    Problem p = helical::problem();
    const rod::Rod &a = p.rod, b = times(a, 1.3), d = times(a, 0.8);
    p.law = rod::section_law(a, 1.0,
                             {part(0.15, 0.35, a, b, rod::SectionEntry::Between::linear),
                              part(0.35, 0.5, b, b, rod::SectionEntry::Between::constant),
                              part(0.7, 0.9, a, d, rod::SectionEntry::Between::smooth)},
                             false);
    for (auto& piece : p.law.pieces) piece.weight = {0.5, 0.2, 0, 0, 0};
    p.load.weight_direction = {0.0, 0.6, 0.8};
    Chain v = on(c, p);
    const auto step = solved(v);
    EXPECT_LT(step.certificate.balance, 1e-9);
    EXPECT_LT(step.certificate.continuity, 1e-9);
    p.axial_value.value = step.axial_force_end;
    const test::SolvedRod rod(p, step);
    EXPECT_LT(test::free_segments_against_integration(rod, 1.0).largest(), 1e-8) << contact;
  }
}

// The law counted from the far end is the same law, whatever the length turns out to be.
TEST(VaryingRod, MayBeMeasuredFromItsEnd) {
  Problem p = helical::problem();
  const rod::Rod &a = p.rod, b = times(a, 1.2);
  p.law = rod::section_law(a, 0.0, {part(0.3, 0.6, a, b, rod::SectionEntry::Between::linear)}, false);
  Chain c = on(helical::point_chain(-1.8), p);
  const auto from_start = solved(c);
  const double l = from_start.rod_length;
  p.law = rod::section_law(a, 0.0, {part(0.3 - l, 0.6 - l, a, b, rod::SectionEntry::Between::linear)}, true);
  Chain e = on(helical::point_chain(-1.8), p);
  const auto from_end = solved(e);
  EXPECT_NEAR(from_end.rod_length, l, 1e-10);
  EXPECT_NEAR(from_end.contacts[0].start, from_start.contacts[0].start, 1e-9);
  EXPECT_NEAR(from_end.contacts[0].s_start, from_start.contacts[0].s_start, 1e-9);
}

// A step is what steep linear changes tend to, with an error of first order in their width: the mean of 1/B over the
// change is not that of the step.
TEST(VaryingRod, StepIsTheLimitOfSteepLaws) {
  Problem p = helical::problem();
  const rod::Rod &a = p.rod, b = times(a, 1.5);
  std::vector<double> length;
  for (const double width : {0.001, 0.0005, 0.0}) {
    std::vector<rod::SectionEntry> entries;
    if (width > 0.0)
      entries.push_back(part(0.6 - 0.5 * width, 0.6 + 0.5 * width, a, b, rod::SectionEntry::Between::linear));
    entries.push_back(part(0.6 + 0.5 * width, 5.0, b, b, rod::SectionEntry::Between::constant));
    p.law = rod::section_law(a, 0.0, entries, false);
    Chain c = on(helical::point_chain(-1.5), p);
    length.push_back(solved(c).rod_length);
  }
  EXPECT_GT(std::abs(length[0] - length[2]), 1e-8);
  EXPECT_NEAR((length[0] - length[2]) / (length[1] - length[2]), 2.0, 0.1);
}

// A rod with the tube's own curvature lies in it without force, turned the right way; turned by half a turn it does
// not.
TEST(VaryingRod, UnstressedRodTakesItsShape) {
  Problem p;
  constexpr double radius = 2.0;
  p.tube.axis = geometry::make_arc(radius, 1.0);
  p.tube.clearance = geometry::make_constant(0.1);
  p.rod = {1.0, 0.75, 400.0};
  p.end.kind = segmentation::End::Kind::sleeve;
  p.end_position = 1.0;
  rod::SectionEntry e = part(-1.0, 5.0, p.rod, p.rod, rod::SectionEntry::Between::constant);
  for (auto& k : e.curvature) k[1] = 1.0 / radius;  // about d2: towards d1
  p.law = rod::section_law(p.rod, 0.0, {e}, false);
  Chain c(std::make_shared<Mechanics>(p, 0.0), 7);
  c.build({{0}, {}}, 8, [](double S, double* u, double* s) {
    std::fill_n(u, formulation::FreeRod::inputs, 0.0);
    *s = S;
  });
  const auto step = solved(c);
  EXPECT_NEAR(step.rod_length, 1.0, 1e-10);
  double u[formulation::state_inputs], s;
  for (const double S : {0.0, 0.3, 0.8}) {
    c.sample(S, u, &s);
    for (const int i : {0, 4, 11, 13, 15}) EXPECT_NEAR(u[i], 0.0, 1e-9) << S;
  }
  const auto& P = c.mechanics().problem;
  const auto k = formulation::FreeRod::kinematics<double>(formulation::lift<double>(P.section(0.8), 0.0, 0.0), u[0],
                                                          u[1], u[2], u[4], u[5], u[6]);
  for (const double M : P.moments(k, u)) EXPECT_NEAR(M, 0.0, 1e-8);
}

// A bent tip in a straight tube: turning the rod at its start turns the whole state.
TEST(VaryingRod, BentTipTurnsWithTheRoll) {
  const auto at_roll = [](double roll) {
    Problem p;
    p.tube.axis = geometry::make_straight(1.0);
    p.tube.clearance = geometry::make_constant(0.2);
    p.rod = {1.0, 0.75, std::nullopt};
    p.start.roll = roll;
    p.end.kind = segmentation::End::Kind::sleeve;
    p.end_position = 1.0;
    rod::SectionEntry e = part(0.6, 0.9, p.rod, p.rod, rod::SectionEntry::Between::constant);
    for (auto& k : e.curvature) k[0] = 0.8, k[1] = 0.3;
    p.law = rod::section_law(p.rod, 0.0, {e}, false);
    Chain c(std::make_shared<Mechanics>(p, 0.0), 7);
    c.build({{0}, {}}, 8, [roll](double S, double* u, double* s) {
      std::fill_n(u, formulation::FreeRod::inputs, 0.0);
      u[8] = roll;
      *s = S;
    });
    const auto step = solved(c);
    EXPECT_LT(step.certificate.balance, 1e-9);
    EXPECT_LT(step.certificate.continuity, 1e-9);
    const test::SolvedRod rod(p, step);
    EXPECT_LT(test::free_segments_against_integration(rod, 1.0).largest(), 1e-8);
    return rod.at(0.55);
  };
  const auto a = at_roll(0.0), b = at_roll(0.7);
  ASSERT_GT(a.r.head<2>().norm(), 1e-3);
  const Eigen::Rotation2Dd turn(0.7);
  EXPECT_LT((turn * a.r.head<2>() - b.r.head<2>()).norm(), 1e-9);
  EXPECT_LT((turn * a.F.head<2>() - b.F.head<2>()).norm(), 1e-7);
}

// Two pieces, clamped at the start, a small force across the tip: w = f [(1 - b³)/(3 B1) + b³/(3 B2)], b the length of
// the second; the slope squared, about 1e-8, is what beam theory leaves out.
TEST(VaryingRod, SteppedCantilever) {
  constexpr double f = 1e-4, cut = 0.4, b = 1.0 - cut, soft = 0.01;
  Problem p;
  p.tube.axis = geometry::make_straight(1.2);
  p.tube.clearance = geometry::make_constant(0.3);
  p.rod = {1.0, 0.75, std::nullopt};
  p.end.kind = segmentation::End::Kind::free;
  p.end.tip.force = {f, 0.0, 0.0};
  p.axial = segmentation::AxialControl::rod_length;
  p.axial_value = 1.0;
  p.end_position = 1.0;
  const rod::Rod second = times(p.rod, soft);
  p.law = rod::section_law(p.rod, 0.0, {part(cut, 5.0, second, second, rod::SectionEntry::Between::constant)}, false);
  Chain c(std::make_shared<Mechanics>(p, 0.0), 7);
  c.build({{0}, {}}, 8, [](double S, double* u, double* s) {
    std::fill_n(u, formulation::FreeRod::inputs, 0.0);
    *s = S;
  });
  const auto step = solved(c);
  double u[formulation::state_inputs];
  c.sample(c.S(1), u, nullptr);
  const double w = f * ((1.0 - b * b * b) / 3.0 + b * b * b / (3.0 * soft));
  EXPECT_NEAR(u[0] * 1.2 / w, 1.0, 1e-4);
  EXPECT_LT(step.certificate.balance, 1e-9);
}

// A line contact over a smooth change of the stiffness: pressure, forces and moments against the balance of its parts;
// over a kink, with the reaction there.
TEST(VaryingRod, LineContactCarriesTheChange) {
  for (const auto how : {rod::SectionEntry::Between::smooth, rod::SectionEntry::Between::linear}) {
    Problem p = helical::problem();
    const rod::Rod &a = p.rod, b = times(a, 1.02);
    p.law = rod::section_law(
        a, 0.0, {part(0.45, 0.75, a, b, how), part(0.75, 5.0, b, b, rod::SectionEntry::Between::constant)}, false);
    Chain c = on(helical::line_chain(-5.0), p);
    const auto step = solved(c);
    EXPECT_LT(step.certificate.balance, 1e-8);
    EXPECT_LT(step.certificate.continuity, 1e-9);
    const test::SolvedRod rod(p, step);
    if (how == rod::SectionEntry::Between::smooth) {
      EXPECT_LT(test::line_contacts_against_balance(rod).largest(), 1e-6);
    }
    EXPECT_LT(test::free_segments_against_integration(rod, 1.0).largest(), 1e-8);
  }
}

}  // namespace

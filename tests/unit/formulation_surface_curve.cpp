// The curve on the ringed surface as the equations see it, against the geometry room's own derivation and against
// differences along the curve, where nothing vanishes: U1, U2, U3, U', Q', Q'', β', β''.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "formulation_tube.hpp"
#include "tendril/formulation/line_contact.hpp"
#include "tendril/geometry/ringed_surface.hpp"

namespace {

using namespace tendril;
using formulation::LineContact;
using formulation::Section;
using formulation_tube::GeneralTube;
using formulation_tube::slope;

constexpr double rounding = 1e-11;   // some hundred operations on terms up to 1e2
constexpr double difference = 1e-8;  // sixth order, h = 5e-3

std::array<formulation::V3<double>, 3> first_three(const Section& s) { return {s.U[0], s.U[1], s.U[2]}; }

TEST(FormulationSurfaceCurve, AgreesWithTheGeometryRoomOnRandomSections) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> r(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    Section s;
    for (auto& u : s.U)
      for (double& c : u) c = 2.0 * r(random);
    s.Q = {0.16 + 0.1 * r(random), 0.5 * r(random), r(random), 2 * r(random), 0.0};
    const double b = 3.2 * r(random), b1 = 4 * r(random), b2 = 8 * r(random), b3 = 20 * r(random);
    const auto triple = [](const formulation::V3<double>& v) { return geometry::Triple<double>{{v[0], v[1], v[2]}}; };
    const geometry::RingSection<double> ring{triple(s.U[0]), triple(s.U[1]), triple(s.U[2]), s.Q[0],
                                             s.Q[1],         s.Q[2],         s.Q[3]};
    const geometry::RingedSurface<double> surface(ring, b);
    const geometry::CurveOnTube<double> expected(surface, b1, b2);
    const auto c =
        LineContact::curve<double>(formulation::lift(s, 0.0, 0.0), formulation::lift_clearance(s, 0.0, 0.0), b, b1, b2);
    const auto j =
        LineContact::curve_jet<double>(first_three(s), formulation::lift_clearance(s, 0.0, 0.0), b, b1, b2, b3);
    const double size = 1 + std::abs(expected.dkappa_n);
    EXPECT_NEAR(c.J1bar, expected.Jbar1, rounding);
    EXPECT_NEAR(c.kn, expected.kappa_n, rounding * size);
    EXPECT_NEAR(c.kg, expected.kappa_g, rounding * size);
    EXPECT_NEAR(c.tg, expected.tau_g, rounding * size);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(c.N[i], surface.N[i], rounding);
      EXPECT_NEAR(c.t[i], expected.t[i], rounding);
      EXPECT_NEAR(c.gv[i], expected.gv[i], rounding);
    }
    EXPECT_NEAR(j.kn.v, expected.kappa_n, rounding * size);
    EXPECT_NEAR(j.kg.v, expected.kappa_g, rounding * size);
    EXPECT_NEAR(j.kn.d, expected.dkappa_n, rounding * size);  // without β'''
    EXPECT_NEAR(geometry::second_angle_derivative(surface, expected, c.kg), b2, 1e-9);
  }
}

TEST(FormulationSurfaceCurve, TotalDerivativesAlongACurve) {
  const GeneralTube tube;
  const auto beta = [](double S, int d) { return GeneralTube::wave(S, 0.6, 1.1, 1.9, 0.8)[d]; };
  const auto curve = [&](double S) {
    const Section s = tube.at(S);
    return LineContact::curve<double>(formulation::lift(s, 0.0, 0.0), formulation::lift_clearance(s, 0.0, 0.0),
                                      beta(S, 0), beta(S, 1), beta(S, 2));
  };
  for (const double S : {0.2, 0.9, 1.6}) {
    const Section s = tube.at(S);
    const auto j = LineContact::curve_jet<double>(first_three(s), formulation::lift_clearance(s, 0.0, 0.0), beta(S, 0),
                                                  beta(S, 1), beta(S, 2), beta(S, 3));
    EXPECT_NEAR(j.J1bar.d, slope([&](double x) { return curve(x).J1bar; }, S), difference);
    EXPECT_NEAR(j.kn.d, slope([&](double x) { return curve(x).kn; }, S), difference);
    EXPECT_NEAR(j.kg.d, slope([&](double x) { return curve(x).kg; }, S), difference);
    EXPECT_NEAR(j.tg.d, slope([&](double x) { return curve(x).tg; }, S), difference);
    for (int i = 0; i < 3; ++i)  // components in D
      EXPECT_NEAR(j.gv[i].d, slope([&](double x) { return curve(x).gv[i]; }, S), difference);
    // Darboux: t' = (κ_g g + κ_n N)/J̄1, N' = -(κ_n t + τ_g g)/J̄1, full derivatives
    const auto full = [&](const formulation::V3<numerics::Jet<double>>& v) {
      const auto turn = numerics::cross(s.U[0], formulation::V3<double>{v[0].v, v[1].v, v[2].v});
      return formulation::V3<double>{v[0].d + turn[0], v[1].d + turn[1], v[2].d + turn[2]};
    };
    const auto dt = full(j.t), dN = full(j.N);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(dt[i], (j.kg.v * j.gv[i].v + j.kn.v * j.N[i].v) / j.J1bar.v, rounding);
      EXPECT_NEAR(dN[i], -(j.kn.v * j.t[i].v + j.tg.v * j.gv[i].v) / j.J1bar.v, rounding);
    }
  }
}

}  // namespace

#include "tendril/reproduce/straight_conduit_states.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/segmentation/pattern_checks.hpp"
#include "tendril/segmentation/seeding.hpp"

namespace tendril::reproduce::straight_conduit {
namespace {

using formulation::FreeRod;
using segmentation::Chain;
using segmentation::Closure;
using segmentation::End;
using segmentation::Mechanics;
using segmentation::Problem;
constexpr double pi = std::numbers::pi;

Problem straight(double clearance, double eta) {
  Problem p;
  p.tube.axis = geometry::make_straight(1.0);
  p.tube.clearance = geometry::make_constant(clearance);
  p.rod = {1.0, 0.75, {}};
  if (eta > 0.0) p.rod.axial_stiffness = 1.0 / (eta * eta);
  p.end.kind = End::Kind::sleeve;
  p.end_position = 1.0;
  return p;
}

bool solve(Chain& chain, double tolerance) {
  segmentation::NewtonOptions options;
  options.tolerance = 1e-2 * tolerance;
  return chain.solve_adaptive({Closure::Kind::parameter, 0, 0.0}, options, tolerance).converged;
}

struct Fields {
  formulation::FreeRod::Kinematics<double> k;
  double u[FreeRod::inputs], s, M3, J1;
};
Fields fields_at(const Chain& c, double S) {
  Fields f;
  c.sample(S, f.u, &f.s);
  const auto& P = c.mechanics().problem;
  f.k = FreeRod::kinematics<double>(formulation::lift<double>(P.section(S), 0.0, 0.0), f.u[0], f.u[1], f.u[2], f.u[4],
                                    f.u[5], f.u[6]);
  f.M3 = FreeRod::twisting_moment<double>(P.material, f.k, f.u[15], f.u[9]);
  f.J1 = FreeRod::stretch(P.material, f.u[15]) * f.k.J1bar;
  return f;
}

}  // namespace

SolvedHelix solve_helix(const closed_form::Helix& helix, const closed_form::SurfaceState& state, double eta,
                        bool on_wall, bool around) {
  const double r = helix.radius, slope = std::tan(helix.angle), rate = slope / r, turn = rate;  // β = rate S
  Problem p = straight(on_wall ? r : 3.0 * r, eta);
  if (around) p.tube.side = geometry::Side::outside;
  p.start.eccentricity[0] = r;
  p.start.slope[1] = slope;
  p.end.eccentricity[0] = r * std::cos(turn);
  p.end.eccentricity[1] = r * std::sin(turn);
  p.end.slope[0] = -slope * std::sin(turn);
  p.end.slope[1] = slope * std::cos(turn);
  p.axial_value = state.F_3;
  p.twist_value = state.M_3;
  const auto mechanics = std::make_shared<Mechanics>(p, 0.0);
  Chain chain(mechanics, 7);
  const double pull = closed_form::axial_resultants(helix, state).force;
  // a helix whose angle (on the wall) or radius (free) is wrong in between by some per cent
  const auto guess = [&](double S, double* u, double* s) {
    std::fill_n(u, FreeRod::inputs, 0.0);
    const double w = 0.04 * std::sin(pi * S), w1 = 0.04 * pi * std::cos(pi * S), w2 = -pi * pi * w;
    const double beta = rate * S + (on_wall ? w : 0.0), b1 = rate + (on_wall ? w1 : 0.0), b2 = on_wall ? w2 : 0.0;
    const double R = r * (on_wall ? 1.0 : 1.0 + w), R1 = on_wall ? 0.0 : r * w1, R2 = on_wall ? 0.0 : r * w2;
    const double c = std::cos(beta), sn = std::sin(beta), radial = R2 - R * b1 * b1, round = 2.0 * R1 * b1 + R * b2;
    u[0] = R * c;
    u[1] = R1 * c - R * b1 * sn;
    u[2] = radial * c - round * sn;
    u[4] = R * sn;
    u[5] = R1 * sn + R * b1 * c;
    u[6] = radial * sn + round * c;
    u[15] = state.F_3;
    const auto k = FreeRod::kinematics<double>(formulation::lift<double>(mechanics->problem.section(S), 0.0, 0.0), u[0],
                                               u[1], u[2], u[4], u[5], u[6]);
    const double J1 = FreeRod::stretch(mechanics->problem.material, u[15]) * k.J1bar;
    u[9] = (1.0 + mechanics->problem.material.nu) * state.M_3 / J1 - k.c;
    u[8] = u[9] * S;
    *s = S / (state.alpha * std::cos(helix.angle));
    if (on_wall) {
      segmentation::balance_shear(mechanics->problem, S, u);
    } else {  // one force along the axis
      u[11] = pull * k.k1[2];
      u[13] = pull * k.k2[2];
    }
  };
  chain.build(on_wall ? segmentation::Pattern{{1}, {}} : segmentation::Pattern{{0}, {}}, 10, guess);
  SolvedHelix out;
  out.exact_length = 1.0 / (state.alpha * std::cos(helix.angle));
  if (!solve(chain, 1e-11)) {
    out.difference = HUGE_VAL;
    return out;
  }
  const auto exact = closed_form::axial_resultants(helix, state);
  for (int i = 0; i <= 200; ++i) {
    const double S = i / 200.0;
    const Fields f = fields_at(chain, std::min(S, 1.0 - 1e-14));
    const double place = std::hypot(f.u[0] - r * std::cos(rate * S), f.u[4] - r * std::sin(rate * S)) / r;
    const double force = f.u[11] * f.k.k1[2] + f.u[13] * f.k.k2[2] + f.u[15] * f.k.t[2];
    const double scale = std::max(std::abs(exact.force), std::abs(state.F_3));
    out.difference = std::max({out.difference, place, std::abs(f.u[15] - state.F_3) / scale,
                               std::abs(force - exact.force) / scale, std::abs(f.M3 / state.M_3 - 1.0)});
    if (i != 100) continue;
    out.force_along_axis = force;
    // M = -J1 h k1 + J1 p k2 + M3 d3
    out.moment_along_axis = -f.J1 * f.k.h * f.k.k1[2] + f.J1 * f.k.p * f.k.k2[2] + f.M3 * f.k.t[2];
  }
  out.rod_length = fields_at(chain, 1.0 - 1e-15).s;
  if (on_wall) out.pressure = -mechanics->problem.sign * segmentation::pressure(chain, 0, 0.5);
  return out;
}

closed_form::LocalizedRod localized(double m, double decay) {
  const double root = decay / std::sqrt(1.0 - 0.25 * m * m);
  return {root * root, m * root};
}

SolvedLocalized solve_localized(const closed_form::LocalizedRod& rod, bool exact_ends) {
  // s at which the closed form passes the place S, the middle at S = 1/2
  const auto place = [&](double S) {
    double s = S - 0.5;
    for (int i = 0; i < 60; ++i) {
      const auto at = rod.at(s);
      const double step = (S - 0.5 - at.r[2]) / at.t[2];
      s += step;
      if (std::abs(step) < 1e-16) break;
    }
    return s;
  };
  const auto eccentricity = [&](double S, double* u) {  // δ1, δ1', δ1'' and δ2, δ2', δ2''
    const auto at = rod.at(place(S));
    for (int c = 0; c < 2; ++c) {
      u[3 * c] = at.r[c];
      u[3 * c + 1] = at.t[c] / at.t[2];
      u[3 * c + 2] = (at.t1[c] * at.t[2] - at.t[c] * at.t1[2]) / (at.t[2] * at.t[2] * at.t[2]);
    }
  };
  Problem p = straight(2.0 * rod.furthest(), 0.0);
  if (exact_ends) {
    double a[6], b[6];
    eccentricity(0.0, a);
    eccentricity(1.0, b);
    for (int c = 0; c < 2; ++c) {
      p.start.eccentricity[c] = a[3 * c];
      p.start.slope[c] = a[3 * c + 1];
      p.end.eccentricity[c] = b[3 * c];
      p.end.slope[c] = b[3 * c + 1];
    }
  }
  const double s0 = place(0.0), s1 = place(1.0);
  p.axial_value = exact_ends ? rod.pull * rod.at(s1).t[2] : rod.pull;
  p.twist_value = rod.torque;
  const auto mechanics = std::make_shared<Mechanics>(p, 0.0);
  Chain chain(mechanics, 7);
  chain.build({{0}, {}}, 40, [&](double S, double* u, double* s) {
    std::fill_n(u, FreeRod::inputs, 0.0);
    double e[6];
    eccentricity(S, e);
    // straight at the ends when clamped there, by a smooth factor that is 1 in the middle
    double f = 1.0, f1 = 0.0, f2 = 0.0;
    if (!exact_ends) {
      const double x = 2.0 * S - 1.0, y = 1.0 - std::pow(x, 8);
      f = y * y;
      f1 = 2.0 * y * (-8.0 * std::pow(x, 7)) * 2.0;
      f2 = (2.0 * std::pow(8.0 * std::pow(x, 7), 2) - 2.0 * y * 56.0 * std::pow(x, 6)) * 4.0;
    }
    for (int c = 0; c < 2; ++c) {
      u[4 * c] = f * e[3 * c];
      u[4 * c + 1] = f * e[3 * c + 1] + f1 * e[3 * c];
      u[4 * c + 2] = f * e[3 * c + 2] + 2.0 * f1 * e[3 * c + 1] + f2 * e[3 * c];
    }
    const auto k = FreeRod::kinematics<double>(formulation::lift<double>(mechanics->problem.section(S), 0.0, 0.0), u[0],
                                               u[1], u[2], u[4], u[5], u[6]);
    u[15] = rod.pull * k.t[2];
    u[9] = (1.0 + mechanics->problem.material.nu) * rod.torque / k.J1bar - k.c;
    u[8] = u[9] * S;
    *s = place(S) - s0;
    u[11] = rod.pull * k.k1[2];
    u[13] = rod.pull * k.k2[2];
  });
  SolvedLocalized out;
  // where the bend sits is held by no more than exp(-a √T Z): rounding is that much larger there
  if (!solve(chain, 1e-9)) {
    out.difference = HUGE_VAL;
    out.shortening = std::nan("");
    return out;
  }
  for (int i = 0; i <= 320; ++i) {
    const double S = std::min(i / 320.0, 1.0 - 1e-14);
    const Fields f = fields_at(chain, S);
    double e[6];
    eccentricity(S, e);
    out.S.push_back(S);
    out.delta1.push_back(f.u[0]);
    out.delta2.push_back(f.u[4]);
    out.exact1.push_back(e[0]);
    out.exact2.push_back(e[3]);
    out.difference = std::max(out.difference, std::hypot(f.u[0] - e[0], f.u[4] - e[3]));
    if (i == 160) out.cosine_in_the_middle = f.k.t[2];
  }
  out.shortening = fields_at(chain, 1.0 - 1e-15).s - 1.0;
  return out;
}

}  // namespace tendril::reproduce::straight_conduit

#include "tendril/continuation/formulations.hpp"

#include <algorithm>
#include <cmath>

#include "tendril/continuation/report_state.hpp"
#include "tendril/continuation/small_inclination.hpp"
#include "tendril/numerics/gauss.hpp"

namespace tendril::continuation {

using formulation::FreeRod;
using numerics::cross;
using numerics::dot;
using numerics::operator+;
using numerics::operator-;
using numerics::operator*;
using segmentation::AxialControl;
using segmentation::Chain;
using segmentation::ScaledProblem;
using segmentation::TwistControl;
using segmentation::Which;

namespace {

double norm(const V3<double>& a) { return std::sqrt(dot(a, a)); }

/// Components in D to the world.
V3<double> world(const formulation::Section& s, const V3<double>& a) {
  return a[0] * s.D[0] + a[1] * s.D[1] + a[2] * s.D[2];
}

LagrangianEnd world_end(const ScaledProblem& P, bool right) {
  const auto& held = right ? P.end : P.start;
  const auto section = P.section(right ? P.now(P.end_position) : 0.0);
  const V3<double> offset{P.now(held.eccentricity[0]), P.now(held.eccentricity[1]), 0.0};
  LagrangianEnd e;
  e.position = section.R + world(section, offset);
  e.D1 = section.D[0], e.D2 = section.D[1], e.D3 = section.D[2];
  if (held.kind != segmentation::End::Kind::pinned) {
    const V3<double> slope = V3<double>{P.now(held.slope[0]), P.now(held.slope[1]), 1.0} + cross(section.U[0], offset);
    e.tangent = (1.0 / norm(slope)) * world(section, slope);
  }
  const bool twisted = P.source.twist_at == (right ? Which::end : Which::start);
  if (!twisted)
    e.roll = P.now(held.roll);
  else if (P.source.twist == TwistControl::twist)
    e.roll = P.now(P.twist);
  else
    e.torque = P.now(P.twist);
  return e;
}

LagrangianProblem world_problem(const ScaledProblem& P) {
  LagrangianProblem w;
  w.rod.material = P.material;
  w.rod.tube = tube_in_world(P.source.tube, P.L, P.now(P.source.clearance_scale));
  const double f = P.now(P.source.body_force_scale) * P.L * P.L * P.L / P.B;
  const double m = P.now(P.source.body_couple_scale) * P.L * P.L / P.B;
  for (int i = 0; i < 3; ++i) {
    w.rod.force[i] = f * P.source.load.force[i];
    w.rod.couple[i] = m * P.source.load.couple[i];
  }
  w.start = world_end(P, false);
  w.end = world_end(P, true);
  w.push = P.source.axial == AxialControl::push;
  w.axial_at_start = P.source.axial_at == Which::start && P.source.axial != AxialControl::rod_length;
  return w;
}

double unstressed(const Chain& chain, double S) {
  double u[FreeRod::inputs], s;
  chain.sample(S, u, &s);
  return s;
}

/// Largest differences at equal s; the sides of a contact, where the force jumps, are left out.
Comparison compare(const Chain& chain, const LagrangianRod& rod) {
  Comparison d;
  d.with = "eulerian";
  double F = 1e-300, M = 1e-300;
  const double end = chain.S(chain.segments());
  for (int i = 0; i <= 200; ++i) {
    const double S = end * i / 200;
    const LagrangianSection a = world_section(chain, S);
    F = std::max(F, norm(a.F));
    M = std::max(M, norm(a.M));
    bool beside = false;
    for (int j = 1; j < rod.segments(); ++j) beside = beside || std::abs(a.s - rod.cut(j)) < 1e-7;
    if (beside) continue;
    const LagrangianSection b = rod.at(a.s);
    d.place = std::max(d.place, norm(a.r - b.r));
    d.directors = std::max({d.directors, norm(a.d1 - b.d1), norm(a.d3 - b.d3)});
    d.force = std::max(d.force, norm(a.F - b.F));
    d.moment = std::max(d.moment, norm(a.M - b.M));
  }
  d.force /= F;
  d.moment /= M;
  d.rod_length = std::abs(rod.length() - unstressed(chain, end));
  return d;
}

/// Angle on the wall next to a known one.
double angle_near(const TubeView& v, double near) {
  return near + std::remainder(std::atan2(v.delta2, v.delta1) - near, 2.0 * M_PI);
}

Vec3 eigen(const V3<double>& a, double f) { return f * Vec3(a[0], a[1], a[2]); }

/// `side`: sign of ρ that presses.
void line_forces(const LagrangianRod& rod, int j, double side, double force_unit, double length_unit, Contact& c) {
  const auto& segment = rod.segment(j);
  const auto& gauss = numerics::gauss_table(7);
  const double span = rod.cut(j + 1) - rod.cut(j);
  V3<double> resultant{};
  double sum = 0.0, low = HUGE_VAL, high = -HUGE_VAL;
  for (int i = 0; i < segment.pieces(); ++i) {
    const double a = segment.place(i, 0.0, 1.0), h = segment.place(i + 1, 0.0, 1.0) - a;
    for (int g = 0; g < 7; ++g) {
      const LagrangianSection x = rod.at(j, a + h * gauss.c[g]);
      const double weight = h * gauss.b[g] * span;
      resultant = resultant + (weight * x.pressure) * x.N;
      sum += weight * side * x.pressure;
    }
  }
  double lowest = 0.0;
  const auto pressure = [&](double x) { return side * rod.at(j, std::clamp(x, 0.0, 1.0)).pressure; };
  for (int i = 0; i <= 400; ++i) {
    const double p = pressure(i / 400.0);
    if (p < low) low = p, lowest = i / 400.0;
    high = std::max(high, p);
  }
  for (double h = 1.0 / 400; h > 1e-6; h *= 0.5)  // down to the minimum between the places
    for (double x : {lowest - h, lowest + h})
      if (const double p = pressure(x); p < low) low = p, lowest = std::clamp(x, 0.0, 1.0);
  c.force_distributed = sum * force_unit;
  c.force_vector = eigen(resultant, force_unit);
  c.pressure_min = low * force_unit / length_unit;
  c.pressure_max = high * force_unit / length_unit;
  c.pressure_mid = side * rod.at_place(0.5 * (c.start + c.end) / length_unit).pressure * force_unit / length_unit;
}

void overwrite_contacts(const ScaledProblem& P, const LagrangianRod& rod, Step& step) {
  const double L = P.L, F = P.force_unit();
  const auto end_force = [&](int j, double place, double& magnitude) {
    const LagrangianSection x = rod.at(j, 0.0);
    const TubeView v = seen_from_tube(rod.problem(), x, place / L);
    const double R = dot(x.F - rod.at(j - 1, 1.0).F, v.N);
    magnitude = std::abs(R) * F;
    return eigen(v.N, -R * F);
  };
  std::size_t at = 0;
  for (int j = 0; j < rod.segments(); ++j) {
    step.segments[j].start = seen_from_tube(rod.problem(), rod.at(j, 0.0), step.segments[j].start / L).S * L;
    step.segments[j].end = seen_from_tube(rod.problem(), rod.at(j, 1.0), step.segments[j].end / L).S * L;
    const bool line = step.segments[j].line;
    if (!line && (j == 0 || step.segments[j - 1].line)) continue;
    Contact& c = step.contacts[at++];
    const TubeView a = seen_from_tube(rod.problem(), rod.at(j, 0.0), c.start / L);
    c.start = a.S * L;
    c.s_start = rod.cut(j) * L;
    c.angle_start = angle_near(a, c.angle_start);
    if (!line) {
      c.end = c.start, c.s_end = c.s_start, c.angle_end = c.angle_start;
      c.force_vector = end_force(j, c.start, c.force);
      continue;
    }
    const TubeView b = seen_from_tube(rod.problem(), rod.at(j, 1.0), c.end / L);
    c.end = b.S * L;
    c.s_end = rod.cut(j + 1) * L;
    c.angle_end = angle_near(b, c.angle_end);
    line_forces(rod, j, -P.sign, F, L, c);
    double start_force, last_force;
    c.force_vector += end_force(j, c.start, start_force);
    c.force_vector += end_force(j + 1, c.end, last_force);
    c.force_start = start_force;
    c.force_end = last_force;
    c.force = start_force + last_force + c.force_distributed;
  }
}

void overwrite_fields(const ScaledProblem& P, const LagrangianRod& rod, Fields& f) {
  const double L = P.L, F = P.force_unit(), M = P.moment_unit();
  for (std::size_t i = 0; i < f.S.size(); ++i) {
    const LagrangianSection x = rod.at(f.s[i] / L);
    const TubeView v = seen_from_tube(rod.problem(), x, f.S[i] / L);
    f.S[i] = v.S * L;
    f.x[i] = x.r[0] * L, f.y[i] = x.r[1] * L, f.z[i] = x.r[2] * L;
    f.delta1[i] = v.delta1 * L, f.delta2[i] = v.delta2 * L;
    f.phi[i] += std::remainder(v.phi - f.phi[i], 2.0 * M_PI);
    f.gap[i] = P.sign * v.gap * L;
    f.pressure[i] = -P.sign * x.pressure * F / L;
    f.F1[i] = v.F[0] * F, f.F2[i] = v.F[1] * F, f.F3[i] = v.F[2] * F;
    f.M1[i] = v.M[0] * M, f.M2[i] = v.M[1] * M, f.M3[i] = v.M[2] * M;
    f.kappa[i] = std::hypot(v.M[0], v.M[1]) / x.stretch / L;
  }
}

}  // namespace

LagrangianSection world_section(const Chain& chain, double S) {
  const ScaledProblem& P = chain.mechanics().problem;
  double u[FreeRod::inputs];
  LagrangianSection c;
  chain.sample(S, u, &c.s);
  const auto section = P.section(S);
  const auto k =
      FreeRod::kinematics<double>(formulation::lift<double>(section, 0.0, 0.0), u[0], u[1], u[2], u[4], u[5], u[6]);
  const V3<double> k1 = world(section, k.k1), k2 = world(section, k.k2);
  c.r = section.R + world(section, {u[0], u[4], 0.0});
  c.d3 = world(section, k.t);
  c.d1 = std::cos(u[8]) * k1 + std::sin(u[8]) * k2;
  c.F = u[11] * k1 + u[13] * k2 + u[15] * c.d3;
  c.stretch = FreeRod::stretch(P.material, u[15]);
  const double J1 = c.stretch * k.J1bar;
  c.M = (-J1 * k.h) * k1 + (J1 * k.p) * k2 + FreeRod::twisting_moment<double>(P.material, k, u[15], u[9]) * c.d3;
  c.line = chain.is_line(chain.segment_at(S));
  return c;
}

LagrangianTwin lagrangian_twin(const Chain& chain, double tolerance) {
  LagrangianTwin out;
  const ScaledProblem& P = chain.mechanics().problem;
  const int n = chain.segments();
  if (chain.is_line(0) || chain.is_line(n - 1)) {
    out.reason = "a line contact that reaches an end of the rod";
    return out;
  }
  if (chain.needs_phase()) {
    out.reason = "an axisymmetric problem, whose states may be turned about the axis";
    return out;
  }
  LagrangianPattern pattern;
  std::vector<double> cuts{0.0};
  for (int j = 0; j < n; ++j) {
    pattern.push_back(chain.is_line(j));
    cuts.push_back(unstressed(chain, chain.S(j + 1)));
  }
  const auto guess = [&](double s) {
    double lo = 0.0, hi = chain.S(n);
    for (int it = 0; it < 52; ++it) {
      const double mid = 0.5 * (lo + hi);
      (unstressed(chain, mid) < s ? lo : hi) = mid;
    }
    return world_section(chain, 0.5 * (lo + hi));
  };
  std::vector<double> knots;  // as exact as the Eulerian state, far below a piece
  for (double S : P.knots) knots.push_back(unstressed(chain, S));
  LagrangianRod rod(world_problem(P), pattern, cuts, guess, 8, 7, knots);
  collocation::BvpOptions o;
  o.tolerance = 0.1 * tolerance;
  o.newton_tolerance = std::clamp(1e-3 * tolerance, 1e-12, 1e-9);
  collocation::BvpSummary s;
  if (P.source.axial == AxialControl::rod_length) {
    rod.bvp().set_parameter(dot(guess(cuts.back()).F, guess(cuts.back()).d3));
    s = rod.solve_length(P.now(P.axial), o);
  } else {
    s = rod.solve_force(P.now(P.axial), o);
  }
  if (!s.converged) {
    out.reason = s.reason;
    return out;
  }
  out.difference = compare(chain, rod);
  out.difference.error = s.error;
  out.rod = std::move(rod);
  return out;
}

void report_lagrangian(const Chain& chain, double tolerance, int field_points, Step& step) {
  const ScaledProblem& P = chain.mechanics().problem;
  const LagrangianTwin twin = lagrangian_twin(chain, tolerance);
  if (!twin.rod) {
    step.status = Status::not_converged;
    step.message = "not solved in the Lagrangian form: " + twin.reason + "; the Eulerian state is given";
    return;
  }
  const LagrangianRod& rod = *twin.rod;
  const double L = P.L, F = P.force_unit(), M = P.moment_unit();
  const LagrangianSection a = rod.at(0, 0.0), b = rod.at(rod.segments() - 1, 1.0);
  step.rod_length = rod.length() * L;
  step.axial_force_start = dot(a.F, a.d3) * F, step.axial_force_end = dot(b.F, b.d3) * F;
  step.torque_start = dot(a.M, a.d3) * M, step.torque_end = dot(b.M, b.d3) * M;
  const LagrangianSection& e = P.source.axial_at == Which::start ? a : b;
  const double F3 = dot(e.F, e.d3), M3 = dot(e.M, e.d3);
  step.push = -(0.5 * (dot(e.M, e.M) - M3 * M3) + F3 + 0.5 * P.material.eta2 * F3 * F3) * F;
  overwrite_contacts(P, rod, step);
  if (field_points > 0) overwrite_fields(P, rod, step.fields);
  step.comparison = twin.difference;
  step.certificate.error = std::max(step.certificate.error, twin.difference.error);
  step.branch += "; solved again in the Lagrangian form";
  const Comparison& d = twin.difference;
  const double worst = std::max({d.place, d.directors, d.force, d.moment, d.rod_length});
  if (!(worst <= 10.0 * std::max(tolerance, 1e-11)) && step.status == Status::converged) {
    step.status = Status::not_converged;
    step.message = "the Lagrangian and the Eulerian state differ by " + std::to_string(worst);
  }
}

Step small_inclination_step(const segmentation::Problem& problem, double tolerance, int field_points) {
  collocation::BvpOptions o;
  o.tolerance = 0.1 * tolerance;
  o.newton_tolerance = std::clamp(1e-3 * tolerance, 1e-12, 1e-9);
  const SmallInclinationOutcome found = small_inclination(problem, o);
  Step step;
  if (!found.rod) {
    step.message = "small inclination approximation: " + found.reason;
    return step;
  }
  step = describe(*found.rod, field_points);
  step.status = found.outside_domain ? Status::outside_validity : Status::converged;
  step.message = found.reason;
  step.branch = "small inclination approximation";
  // its faults as a state of the exact equations, and how far it is from the exact state that it leads to
  Chain chain = exact_start(*found.rod);
  const auto c = segmentation::certify(chain);
  step.certificate = {c.equilibrium, c.gap_min,          c.reaction_min, c.curvature_max, c.continuity,
                      c.balance,     c.invariant_spread, c.error,        c.strain_max,    c.phase_multiplier};
  const Chain approximate = chain;
  const auto s = chain.solve_adaptive({segmentation::Closure::Kind::parameter, 0, chain.parameter()}, {}, o.tolerance);
  if (!s.converged) return step;
  Comparison d;
  d.with = "exact, same contacts";
  double F = 1e-300, M = 1e-300;
  const double end = chain.S(chain.segments());
  for (int i = 0; i <= 200; ++i) {
    const LagrangianSection x = world_section(chain, end * i / 200), y = world_section(approximate, end * i / 200);
    const auto z = found.rod->at(end * i / 200);
    F = std::max(F, norm(x.F));
    M = std::max(M, norm(x.M));
    d.place = std::max(d.place, norm(x.r - y.r));
    d.directors = std::max({d.directors, norm(x.d1 - y.d1), norm(x.d3 - y.d3)});
    const double* v = z.inputs;
    double u[FreeRod::inputs], length;
    chain.sample(end * i / 200, u, &length);
    d.force = std::max(d.force, std::hypot(u[11] - v[11], u[13] - v[13], u[15] - v[15]));
    const double M3 = dot(x.M, x.d3);
    const auto section = chain.mechanics().problem.section(end * i / 200);
    const auto k =
        FreeRod::kinematics<double>(formulation::lift<double>(section, 0.0, 0.0), u[0], u[1], u[2], u[4], u[5], u[6]);
    const double J1 = x.stretch * k.J1bar;
    d.moment = std::max(d.moment, std::hypot(-J1 * k.h - z.M1, J1 * k.p - z.M2, M3 - z.M3));
    d.rod_length = std::abs(length - z.s);
  }
  d.force /= F;
  d.moment /= M;
  step.comparison = d;
  return step;
}

}  // namespace tendril::continuation

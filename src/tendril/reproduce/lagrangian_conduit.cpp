#include "tendril/reproduce/lagrangian_conduit.hpp"

#include <cmath>
#include <numbers>

#include "tendril/closed_form/helical_conduit.hpp"
#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"

namespace tendril::reproduce {

using collocation::BvpOptions;
using continuation::LagrangianPattern;
using continuation::LagrangianProblem;
using continuation::LagrangianRod;
using continuation::LagrangianSection;
using numerics::cross;
using numerics::operator+;
using numerics::operator*;
using std::numbers::pi;

namespace {

constexpr double pitch = pi / 4, eta = 1.0 / 20, torque = -1.0;
const double radius = 1 / (pi * std::numbers::sqrt2);
const double torsion = std::sin(pitch) * std::cos(pitch) / radius, curvature = torsion;

LagrangianProblem world_problem(double clearance) {
  const segmentation::Problem p = helical_conduit_case(clearance, 0.0);
  LagrangianProblem w;
  w.rod.material = {eta * eta, 1.0 / 3.0};
  w.rod.tube = continuation::tube_in_world(p.tube, 1.0);
  const auto a = w.rod.tube(0.0), b = w.rod.tube(1.0);
  w.start = {a.R[0], a.D1[0], a.D2[0], a.R[1], a.R[1], 0.0, 0.0};
  w.end = {b.R[0], b.D1[0], b.D2[0], b.R[1], b.R[1], {}, torque};
  return w;
}

}  // namespace

double helical_conduit_force() {
  return std::abs(torsion * (torque - torsion) / (1 + eta * eta * torsion * torsion));  // (II.3.19)
}

segmentation::Problem helical_conduit_case(double clearance, double T) {
  // D1 is the Frenet normal in the middle: half the torsion's angle from it at the start
  const double half = 0.5 * torsion;
  const geometry::Vec3 normal(-1, 0, 0), binormal(0, -std::cos(pitch), std::sin(pitch));
  segmentation::Problem p;
  p.tube.axis = geometry::make_helix(radius, pitch, 1.0, std::cos(half) * normal + std::sin(half) * binormal);
  p.tube.clearance = geometry::make_constant(clearance);
  p.rod = {1.0, 0.75, 1 / (eta * eta)};
  p.end.kind = segmentation::End::Kind::sleeve;
  p.end_position = 1.0;
  p.axial_value = segmentation::Scalar(T, 1.0);
  p.twist_value = torque;
  return p;
}

LagrangianOutcome lagrangian_conduit(double clearance, double T, Touch touch, double tolerance) {
  const LagrangianProblem w = world_problem(clearance);
  const double T0 = -helical_conduit_force();
  LagrangianOutcome out;
  BvpOptions loose, fine;
  loose.tolerance = 1e-6;
  loose.newton_tolerance = 1e-9;
  fine.tolerance = tolerance;
  fine.newton_tolerance = 0.1 * tolerance;
  const auto failed = [&](const std::string& where, const std::string& why) {
    out.reason = where + ": " + why;
    return out;
  };
  // the rod on the axis, directors turning as M3 asks; its length is that of the axis over its stretch
  const double alpha = 1 + eta * eta * T0, length = 1 / alpha;
  const auto on_axis = [&](double s) {
    const auto t = w.rod.tube(s * alpha);
    LagrangianSection c;
    const double turn = (torque * 4.0 / 3.0) * s;
    c.r = t.R[0];
    c.d3 = t.R[1];
    c.d1 = std::cos(turn) * t.D1[0] + std::sin(turn) * t.D2[0];
    c.F = T0 * c.d3;
    c.M = alpha * cross(t.R[1], t.R[2]) + torque * c.d3;
    return c;
  };
  LagrangianRod rod(w, {false}, {0.0, length}, on_axis, 6);
  const auto eccentricity = [&](const LagrangianRod& r) {
    const auto v = continuation::seen_from_tube(w, r.at(0.5 * r.length()), 0.5);
    return std::hypot(v.delta1, v.delta2);
  };
  auto s = rod.solve_force(T0, loose);
  if (!s.converged) return failed("rod on the axis", s.reason);
  // load in steps: to the end, or until the wall is reached in the middle
  const int steps = 24;
  for (int i = 1; i <= steps; ++i) {
    const double fraction = touch == Touch::none ? 1.0 : 1.0 * i / steps;
    s = rod.solve_force(T0 + fraction * fraction * (T - T0), touch == Touch::none ? fine : loose);
    if (!s.converged) return failed("free rod", s.reason);
    if (touch == Touch::none || eccentricity(rod) > clearance) break;
  }
  if (touch != Touch::none) {
    const double half = 0.5 * rod.length(), begin = rod.axial_value();
    LagrangianRod point(
        w, {false, false}, {0.0, half, 2 * half}, [&](double x) { return rod.at(x); }, 6);
    s = point.solve_force(begin, touch == Touch::point && begin == T ? fine : loose);
    if (!s.converged) return failed("first contact", s.reason);
    if (touch == Touch::point) {
      s = point.solve_force(0.5 * (begin + T), loose);
      if (s.converged) s = point.solve_force(T, fine);
      if (!s.converged) return failed("point contact", s.reason);
      rod = std::move(point);
    } else {
      // on until the rod bends away from the wall less than the wall itself: the place opens on the wrong side
      for (double f = begin; s.converged; f += 0.1 * T0 * (T < T0 ? 1.0 : -1.0)) {
        s = point.solve_force(f, loose);
        const double c = point.cut(1), beside = 0.02;
        if (continuation::seen_from_tube(w, point.at(c - beside), 0.5).gap < 0.0) break;
        if (std::abs(f) > std::abs(T)) return failed("point contact", "no transition to line contact");
      }
      const double c = point.cut(1), seed = 0.02, end = point.length();
      const auto guess = [&](double x) {
        LagrangianSection g = point.at(x);
        if (std::abs(x - c) <= seed) g.F = 0.5 * (point.at(c - seed).F + point.at(c + seed).F);
        return g;
      };
      LagrangianRod line(w, {false, true, false}, {0.0, c - seed, c + seed, end}, guess, 6);
      line.bvp().set_parameter(point.axial_value());
      s = line.solve_segment_length(1, 2 * seed, loose);
      if (!s.converged) return failed("seed of the line contact", s.reason);
      // to the load in steps that are cut where Newton fails
      double here = line.axial_value(), stride = 0.125 * (T - here);
      while (here != T && std::abs(stride) > 1e-4 * std::abs(T0)) {
        const LagrangianRod keep = line;
        const bool last = std::abs(T - here) <= 1.0001 * std::abs(stride);
        s = line.solve_force(last ? T : here + stride, last ? fine : loose);
        if (s.converged) {
          here = line.axial_value();
        } else {
          line = keep;
          stride *= 0.5;
        }
      }
      if (!s.converged) return failed("line contact", s.reason);
      rod = std::move(line);
    }
  }
  out.converged = true;
  out.rod = std::move(rod);
  return out;
}

}  // namespace tendril::reproduce

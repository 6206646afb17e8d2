#include "tendril/reproduce/point_contact_states.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "tendril/closed_form/helical_conduit.hpp"
#include "tendril/formulation/convert.hpp"
#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/segmentation/pattern_checks.hpp"

namespace tendril::reproduce::point_contact {
namespace {

using formulation::FreeRod;
using segmentation::Closure;
using segmentation::Mechanics;
using segmentation::Problem;

constexpr double pi = std::numbers::pi, eta = 1.0 / 20, torque = -1.0;
constexpr closed_form::HelicalConduit axis{pi / 4, std::numbers::sqrt2 / (2 * pi)};

/// The thesis' conduit (II.3.3): clamped on the axis, a sleeve on the axis at the far end, pulled there by T = p.
Problem conduit(double clearance, bool extensible) {
  Problem P;
  P.tube.axis = geometry::make_helix(axis.helix_radius, axis.pitch_angle, 1.0);
  P.tube.clearance = geometry::make_constant(clearance);
  P.rod.bending_stiffness = 1.0;
  P.rod.torsional_stiffness = 0.75;
  if (extensible) P.rod.axial_stiffness = 1.0 / (eta * eta);
  P.end.kind = segmentation::End::Kind::sleeve;
  P.end_position = {1.0, 0.0};
  P.axial_value = {0.0, 1.0};
  P.twist_value = {torque, 0.0};
  return P;
}

double axis_force(bool extensible) { return closed_form::axis_tension(axis, torque, extensible ? eta : 0.0); }

/// Loads are given over |T0|.
void solve_at(Chain& c, double load, bool extensible) {
  const Closure at{Closure::Kind::parameter, 0, load * std::abs(axis_force(extensible))};
  const auto summary = c.solve_adaptive(at, {}, accuracy);
  if (!summary.converged) throw std::runtime_error("helical conduit: " + summary.reason);
}

/// Components in space of a vector given in the frame of a section.
V3<double> in_space(const formulation::Section& s, const V3<double>& v) {
  V3<double> w{};
  for (int i = 0; i < 3; ++i)
    for (int d = 0; d < 3; ++d) w[i] += v[d] * s.D[d][i];
  return w;
}

}  // namespace

void walk_to(Chain& c, double load, bool extensible) {
  const double from = c.parameter() / std::abs(axis_force(extensible));
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(load - from) / 0.3)));
  for (int i = 1; i <= steps; ++i) solve_at(c, from + (load - from) * i / steps, extensible);
}

Chain free_state(double clearance, bool extensible, double load) {
  const double T0 = axis_force(extensible);
  Chain c(std::make_shared<Mechanics>(conduit(clearance, extensible), 0.0), 7);
  c.set_parameter(T0);
  c.build({{0}, {}}, 8, [T0](double S, double* u, double* s) {
    std::fill_n(u, FreeRod::inputs, 0.0);
    u[15] = T0;
    s[0] = S;
  });
  solve_at(c, -1.0, extensible);
  walk_to(c, load, extensible);
  return c;
}

Chain point_state(double clearance, bool extensible, double load) {
  Chain c = free_state(clearance, extensible, -1.28).recut({{0, 0}, {0.5}});
  walk_to(c, load, extensible);
  return c;
}

Chain line_state(const Chain& flat, double load) {
  Chain c = flat.recut({{0, 1, 0}, {0.495, 0.505}});
  for (double span : {0.01, 0.1})
    if (const auto s = c.solve_adaptive({Closure::Kind::span, 1, span}, {}, accuracy); !s.converged)
      throw std::runtime_error("line contact: " + s.reason);
  walk_to(c, load, true);
  return c;
}

Chain oblique_state(const Chain& point) {
  Chain c = point;
  Problem P = conduit(0.05, true);
  P.axial_value = {-2.0 * std::abs(axis_force(true)), 0.0};
  P.end.eccentricity[0] = {0.0, 0.01};
  P.end.eccentricity[1] = {0.0, -0.015};
  P.load.force = {0.0, 0.0, -5.0};
  P.body_force_scale = {0.0, 1.0};
  c.rebind(std::make_shared<Mechanics>(P, 0.0));
  c.set_parameter(0.0);
  for (double p : {0.0, 0.5, 1.0}) {
    const auto summary = c.solve_adaptive({Closure::Kind::parameter, 0, p}, {}, accuracy);
    if (!summary.converged) throw std::runtime_error("oblique state: " + summary.reason);
  }
  return c;
}

double zero(Chain& c, double a, double b, bool extensible, const std::function<double(const Chain&)>& f) {
  walk_to(c, a, extensible);
  double fa = f(c);
  for (int i = 0; i < 30; ++i) {
    walk_to(c, b, extensible);
    const double fb = f(c);
    if (std::abs(b - a) < 1e-12 || fb == 0.0 || fb == fa) break;
    const double next = b - fb * (b - a) / (fb - fa);
    a = b, fa = fb, b = next;
  }
  return b;
}

Side side_of(const Chain& c, int segment, bool after) {
  const auto& P = c.mechanics().problem;
  const auto& g = c.segment(segment);
  const double a = c.S(segment), b = c.S(segment + 1), S = after ? a : b;
  const formulation::Section section = P.section(S);
  double u[FreeRod::inputs];
  g.evaluate_local(after ? 0 : g.pieces() - 1, after ? 0.0 : 1.0, a, b, u, nullptr);
  const auto l = formulation::lift<double>(section, 0.0, 0.0);
  const auto k = FreeRod::kinematics<double>(l, u[0], u[1], u[2], u[4], u[5], u[6]);
  const auto q = FreeRod::shape<double>(l, u);
  const double r = std::hypot(u[0], u[4]), cb = u[0] / r, sb = u[4] / r;
  const auto n = formulation::touch_basis<double>(k, cb, sb, section.Q[1]);
  const auto along_N = [&](double x1, double x2) { return x1 * n.n1 + x2 * n.n2; };
  const auto along_g = [&](double x1, double x2) { return x1 * n.n2 - x2 * n.n1; };  // N x d3 = n2 k1 - n1 k2
  Side s;
  s.t = k.t;
  s.alpha = FreeRod::stretch(P.material, u[15]);
  const double J1 = s.alpha * k.J1bar;
  // κ n = J̄1 (d3)'; its derivative in space, d3'' = (p' - c h) k1 + (h' + c p) k2 + ... d3
  s.kn = k.J1bar * along_N(k.p, k.h);
  s.kg = k.J1bar * along_g(k.p, k.h);
  const double t2_1 = q.pp - q.c * q.h, t2_2 = q.hp + q.c * q.p;
  s.kn_s = J1 * (q.Jp * along_N(k.p, k.h) + k.J1bar * along_N(t2_1, t2_2));
  s.kg_s = J1 * (q.Jp * along_g(k.p, k.h) + k.J1bar * along_g(t2_1, t2_2));
  s.Fn = along_N(u[11], u[13]);
  s.Fg = along_g(u[11], u[13]);
  s.F3 = u[15];
  s.F3_s = J1 * u[16];
  s.alpha_s = P.material.eta2 * s.F3_s;
  s.M3 = FreeRod::twisting_moment<double>(P.material, k, u[15], u[9]);
  const double turning = (u[0] * u[5] - u[4] * u[1]) / (r * r);
  s.kn_wall = formulation::LineContact::curve<double>(l, formulation::lift_clearance<double>(section, 0.0, 0.0),
                                                      std::atan2(sb, cb), turning, 0.0)
                  .kn;
  // gap h = ς (Q - |δ|) with h' = 0: |δ|'', |δ|''' from |δ|² = δ·δ
  const double d1 = (u[0] * u[1] + u[4] * u[5]) / r;
  const double d2 = (u[1] * u[1] + u[5] * u[5] + u[0] * u[2] + u[4] * u[6] - d1 * d1) / r;
  const double d3 = (3.0 * (u[1] * u[2] + u[5] * u[6] - d1 * d2) + u[0] * u[3] + u[4] * u[7]) / r;
  const double J1_slope = P.material.eta2 * u[16] * k.J1bar + s.alpha * q.Jp;
  const double h2 = P.sign * (section.Q[2] - d2), h3 = P.sign * (section.Q[3] - d3);
  s.gap_s2 = J1 * J1 * h2;
  s.gap_s3 = J1 * J1 * (J1 * h3 + 3.0 * J1_slope * h2);
  return s;
}

Section section_at(const Chain& c, int segment, double S) {
  const auto& P = c.mechanics().problem;
  const formulation::Section section = P.section(S);
  double u[FreeRod::inputs], s = 0.0;
  c.segment(segment).evaluate(S, c.S(segment), c.S(segment + 1), u, &s);
  const auto k =
      FreeRod::kinematics<double>(formulation::lift<double>(section, 0.0, 0.0), u[0], u[1], u[2], u[4], u[5], u[6]);
  const double r = std::hypot(u[0], u[4]);
  const auto n = formulation::touch_basis<double>(k, u[0] / r, u[4] / r, section.Q[1]);
  V3<double> force, curvature, N;
  for (int i = 0; i < 3; ++i) {
    force[i] = u[11] * k.k1[i] + u[13] * k.k2[i] + u[15] * k.t[i];
    curvature[i] = k.J1bar * k.t1[i];
    N[i] = n.n1 * k.k1[i] + n.n2 * k.k2[i];
  }
  return {
      s, u[15], in_space(section, force), in_space(section, curvature), in_space(section, k.t), in_space(section, N)};
}

Contact contact(const Chain& c) {
  const auto& P = c.mechanics().problem;
  Contact k{side_of(c, 0, false), side_of(c, 1, true), segmentation::reaction(c, 0), P.material.eta2, 0.0};
  const formulation::Section section = P.section(c.S(1));
  double u[FreeRod::inputs], length = 0.0;
  c.segment(1).evaluate(1.0, c.S(1), 1.0, u, &length);
  c.segment(1).evaluate_local(0, 0.0, c.S(1), 1.0, u, nullptr);
  const V3<double> near = section_at(c, 0, 0.0).force, far = section_at(c, 1, 1.0).force;
  const V3<double> weight = in_space(section, section.sigma), normal = in_space(section, {u[0], u[4], 0.0});
  for (int i = 0; i < 3; ++i)
    k.resultant += (far[i] - near[i] + length * weight[i]) * normal[i] / std::hypot(u[0], u[4]);
  return k;
}

}  // namespace tendril::reproduce::point_contact

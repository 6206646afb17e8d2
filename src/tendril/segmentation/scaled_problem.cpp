#include "tendril/segmentation/scaled_problem.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "tendril/formulation/convert.hpp"
#include "tendril/formulation/jacobians.hpp"
#include "tendril/numerics/target.hpp"

namespace tendril::segmentation {
namespace {

using formulation::Fields;
using formulation::FreeRod;
using formulation::LineContact;
using formulation::Material;
using formulation::Section;
using numerics::Pack;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Scalar scaled(const Scalar& s, double factor) { return {s.value * factor, s.rate * factor}; }

// Several places at once where the machine has the registers for it; elsewhere one place after the other is as fast.
TENDRIL_WIDE void free_jacobians(const Material& m, const Fields<Pack>& s, bool loads_move, const Pack* u, Pack* out,
                                 Pack* jac) {
  formulation::free_rod_jacobian<Pack>(m, s, loads_move, u, out, jac);
}

TENDRIL_WIDE void free_highest(const Material& m, const Fields<Pack>& s, const Pack* u, Pack* out, Pack* top) {
  formulation::free_rod_highest<Pack>(m, s, u, out, top);
}

TENDRIL_WIDE void free_residuals(const Material& m, const Fields<Pack>& s, const Pack* u, Pack* out) {
  FreeRod::residual<Pack>(m, formulation::lift<Pack>(s, Pack(0.0), Pack(0.0)), u, out, out + FreeRod::components);
}

TENDRIL_WIDE void line_jacobians(const Material& m, const Fields<Pack>& s, const Pack* u, Pack* out, Pack* jac) {
  formulation::line_contact_jacobian<Pack>(m, s, u, out, jac);
}

TENDRIL_WIDE void line_residuals(const Material& m, const Fields<Pack>& s, const Pack* u, Pack* out) {
  LineContact::residual<Pack>(m, formulation::lift<Pack>(s, Pack(0.0), Pack(0.0)),
                              formulation::lift_clearance<Pack>(s, Pack(0.0), Pack(0.0)), u, out,
                              out + LineContact::components);
}

/// The formulation holds while d3·D3 > 0, C3 > 0 and the stretch is positive.
bool valid_free(const Material& m, double U1, double U2, double d1, double d2, double F3) {
  return 1.0 - d1 * U2 + d2 * U1 > 0.0 && 1.0 + m.eta2 * F3 > 0.0;
}
bool valid_free(const Material& m, const Section& s, const double* u) {
  return valid_free(m, s.U[0][0], s.U[0][1], u[0], u[4], u[15]);
}

void forbid(Pack* out, int equations, int lane) {
  for (int e = 0; e < equations; ++e) out[e].set(lane, nan);
}

}  // namespace

ScaledProblem::ScaledProblem(const Problem& problem, double parameter) : source(problem), p0(parameter), p(parameter) {
  const Problem& p = source;
  L = p.tube.length();
  B = p.rod.bending_stiffness;
  material.eta2 = p.rod.axial_stiffness ? B / (*p.rod.axial_stiffness * L * L) : 0.0;
  material.nu = B / p.rod.torsional_stiffness - 1.0;
  if (!p.law.uniform()) law = p.law.scaled(L, B);
  mark();
  curved = law.curved();
  sign = p.tube.sign();
  auto end_of = [&](const End& e) {
    ScaledEnd s;
    s.kind = e.kind;
    for (int i = 0; i < 2; ++i) {
      s.eccentricity[i] = scaled(e.eccentricity[i], 1.0 / L);
      s.slope[i] = e.slope[i];
    }
    s.roll = e.roll;
    s.tip = {e.tip.force / force_unit(), e.tip.couple / moment_unit(), e.tip.follower};
    return s;
  };
  start = end_of(p.start);
  end = end_of(p.end);
  end_position = p.end_position.value > 0.0 ? scaled(p.end_position, 1.0 / L) : Scalar{1.0};
  axial = scaled(p.axial_value, p.axial == AxialControl::rod_length ? 1.0 / L : 1.0 / force_unit());
  twist = scaled(p.twist_value, p.twist == TwistControl::torque ? 1.0 / moment_unit() : 1.0);
  for (double k : p.tube.axis->knots()) knots.push_back(k / L);
  for (double k : p.tube.clearance->knots()) knots.push_back(k / L);
  for (const auto* field : {&p.load.force_field, &p.load.couple_field})
    for (double k : field->S) knots.push_back(k / L);
  std::sort(knots.begin(), knots.end());
  std::vector<double> kept;
  for (double k : knots)
    if (k > 1e-9 && k < 1.0 - 1e-9 && (kept.empty() || k - kept.back() > 1e-9)) kept.push_back(k);
  knots = kept;
  const bool heavy = varies() && !p.load.weight_direction.isZero();
  weightless = p.load.force.isZero() && p.load.force_field.none() && !p.load.couples() && !heavy;
  // what the unstressed rod's curvature does depends on how the directors are turned
  bool straight = !curved, mirror = p.planar && !curved;
  std::vector<double> places = knots;
  for (int i = 0; i <= 200; ++i) places.push_back(end_position.value * i / 200.0);
  for (const double S : places) {
    const Section s = section(S);
    clearance_max = std::max(clearance_max, s.Q[0]);
    for (double u : s.U[0]) straight = straight && std::abs(u) < 1e-13;
    for (int c = 0; c < 2; ++c)
      straight =
          straight && std::abs(s.sigma[c]) < 1e-13 && std::abs(s.mu[c]) < 1e-13 && std::abs(s.gravity[c]) < 1e-13;
    for (const double out : {s.U[0][0], s.U[0][2], s.sigma[1], s.mu[0], s.mu[2], s.gravity[1]})
      mirror = mirror && std::abs(out) < 1e-13;
  }
  for (const auto& load : point_loads) {
    const Section s = section(load.on_rod ? 0.0 : std::min(load.at, 1.0));
    const auto F = in_frame(s, load.force), M = in_frame(s, load.couple);
    for (int c = 0; c < 2; ++c) straight = straight && std::abs(F[c]) < 1e-13 && std::abs(M[c]) < 1e-13;
    for (const double out : {F[1], M[0], M[2]}) mirror = mirror && std::abs(out) < 1e-13;
  }
  axisymmetric = straight;
  for (const ScaledEnd* e : {&start, &end})
    for (int i = 0; i < 2; ++i)
      axisymmetric = axisymmetric && e->eccentricity[i].value == 0.0 && e->slope[i].value == 0.0;
  if (tip_free() && !end.tip.none()) {  // only a load along the axis leaves the symmetries alone
    Eigen::Vector3d across[2] = {end.tip.force, end.tip.couple};
    const auto frame = source.tube.axis->at(end_position.value * L).frame;
    for (auto& a : across) {
      if (!end.tip.follower) a = (frame.transpose() * a).eval();
      axisymmetric = axisymmetric && std::hypot(a[0], a[1]) < 1e-13;
    }
    mirror = mirror && !end.tip.follower && std::abs(across[0][1]) < 1e-13 && std::abs(across[1][0]) < 1e-13 &&
             std::abs(across[1][2]) < 1e-13;
  }
  const auto none = [](const Scalar& s) { return s.value == 0.0 && s.rate == 0.0; };
  for (const ScaledEnd* e : {&start, &end}) mirror = mirror && none(e->eccentricity[1]) && none(e->slope[1]);
  const Scalar& roll = p.twist_at == Which::end ? start.roll : end.roll;
  planar = mirror && roll.rate == 0.0 &&
           (p.twist == TwistControl::torque ? none(twist) : twist.value == roll.value && twist.rate == 0.0);
}

void ScaledProblem::mark() {
  point_loads = source.point_loads;
  collars = source.collars;
  if (point_loads.empty() && collars.empty()) {
    marks.assign(law.pieces.size(), {});
    return;
  }
  if (law.uniform())
    law = rod::section_law(source.rod, 0.0, std::vector<rod::SectionPiece>{}, source.law.from_end).scaled(L, B);
  for (auto& c : collars) {
    c.s /= L;
    c.height /= L;
    law.cut_at(c.s);
  }
  for (auto& l : point_loads) {
    l.at /= L;
    l.force /= force_unit();
    l.couple /= moment_unit();
    if (l.on_rod) law.cut_at(l.at);
  }
  marks.assign(law.pieces.size(), {});
  for (std::size_t i = 0; i < collars.size(); ++i) marks[law.piece_at(collars[i].s)].collar = static_cast<int>(i);
  for (std::size_t i = 0; i < point_loads.size(); ++i)
    if (point_loads[i].on_rod) marks[law.piece_at(point_loads[i].at)].load = static_cast<int>(i);
}

Section ScaledProblem::section(double S) const {
  Section s;
  s.S = S;
  const auto a = source.tube.axis->at(S * L);
  const auto q = source.tube.clearance->at(S * L);
  double f = L;
  for (int j = 0; j < 4; ++j, f *= L)
    for (int i = 0; i < 3; ++i) s.U[j][i] = a.U[j][i] * f;
  f = 1.0 / L;
  for (int j = 0; j < 5; ++j, f *= L) {
    s.Q[j] = now(source.clearance_scale) * q[j] * f;
    s.Q_rate[j] = source.clearance_scale.rate * q[j] * f;
  }
  const double force = L * L * L / B, couple = L * L / B;
  const auto& load = source.load;
  Eigen::Vector3d sf = load.force, mf = load.couple;
  const bool field = !load.force_field.none() || !load.couple_field.none();
  if (field) {
    Eigen::Vector3d slope;
    sf += load.force_field.at(S * L, &slope);
    slope = a.frame.transpose() * slope * (now(source.body_force_scale) * force * L);
    for (int i = 0; i < 3; ++i) s.sigma_slope[i] = slope[i];
    mf += load.couple_field.at(S * L, &slope);
    slope = a.frame.transpose() * slope * (now(source.body_couple_scale) * couple * L);
    for (int i = 0; i < 3; ++i) s.mu_slope[i] = slope[i];
  }
  sf = a.frame.transpose() * sf * force;
  mf = a.frame.transpose() * mf * couple;
  for (int i = 0; i < 3; ++i) {
    s.R[i] = a.position[i] / L;
    for (int d = 0; d < 3; ++d) s.D[d][i] = a.frame(i, d);
    s.sigma[i] = now(source.body_force_scale) * sf[i];
    s.sigma_rate[i] = source.body_force_scale.rate * sf[i];
    s.mu[i] = now(source.body_couple_scale) * mf[i];
    s.mu_rate[i] = source.body_couple_scale.rate * mf[i];
  }
  if (varies()) {
    const Eigen::Vector3d g = a.frame.transpose() * source.load.weight_direction;
    for (int i = 0; i < 3; ++i) {
      s.gravity[i] = now(source.body_force_scale) * g[i];
      s.gravity_rate[i] = source.body_force_scale.rate * g[i];
    }
  }
  return s;
}

formulation::Material ScaledProblem::material_at(const double* u, bool line) const {
  if (!varies()) return material;
  const int at = line ? formulation::VaryingLine::piece : formulation::VaryingFree::piece;
  const auto p = law.pieces[static_cast<std::size_t>(u[at])].at<double>(u[at - 2]);
  return {p.e, 1.0 / p.C - 1.0, p.B, {p.k1, p.k2}};
}

formulation::V3<double> ScaledProblem::body_force_at(const Section& s, const double* u) const {
  formulation::V3<double> sigma = s.sigma;
  if (!varies()) return sigma;
  const auto piece = static_cast<std::size_t>(u[formulation::VaryingFree::piece]);
  const double weight = law.pieces[piece].at<double>(u[17]).weight;
  for (int i = 0; i < 3; ++i) sigma[i] += weight * s.gravity[i];
  return sigma;
}

LineContact::Wall ScaledProblem::wall(const Section& s, const double* line) const {
  if (!varies()) return LineContact::wall(material, s, line);
  const auto piece = static_cast<std::size_t>(line[formulation::VaryingLine::piece]);
  return formulation::VaryingLine::wall(law.pieces[piece], curved, s, line).wall;
}

void ScaledProblem::line_to_free(const Section& s, const double* line, double* free) const {
  formulation::line_to_free(material_at(line, true), s, wall(s, line), line, free);
  if (varies()) std::copy_n(line + 11, 3, free + 17);
}

void ScaledProblem::free_to_line(const Section& s, const double* free, double near, double* line) const {
  formulation::free_to_line(material_at(free), s, free, near, line);
  if (varies()) std::copy_n(free + 17, 3, line + 11);
}

std::array<double, 3> ScaledProblem::moments(const FreeRod::Kinematics<double>& k, const double* u) const {
  const Material m = material_at(u);
  const double J1 = FreeRod::stretch(m, u[15]) * k.J1bar, c = std::cos(u[8]), s = std::sin(u[8]);
  return {m.bending * (-J1 * k.h - (m.natural[0] * c - m.natural[1] * s)),
          m.bending * (J1 * k.p - (m.natural[0] * s + m.natural[1] * c)),
          FreeRod::twisting_moment<double>(m, k, u[15], u[9])};
}

const collocation::System* Mechanics::system(bool is_line, int piece, bool near) const {
  if (near) return &near_wall;
  if (!problem.varies()) return is_line ? static_cast<const collocation::System*>(&line) : &free;
  return is_line ? static_cast<const collocation::System*>(varying_line_[piece].get()) : varying_free_[piece].get();
}

void Mechanics::vary() {
  for (int i = 0; i < static_cast<int>(problem.law.pieces.size()); ++i) {
    varying_free_.push_back(std::make_unique<VaryingFreeSystem>(&problem, i));
    varying_line_.push_back(std::make_unique<VaryingLineSystem>(&problem, i));
  }
}

const Fields<Pack>& ScaledProblem::fields(const double* S, int count) const {
  // The mesh of a problem whose ends stay is asked for again and again.
  if (cache_.empty()) cache_.resize(cache_size);
  std::uint64_t key = 0;
  for (const double x : {S[0], S[count - 1], p}) key = (key ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15ULL;
  CachedFields& c = cache_[(key >> 40) % cache_size];
  if (c.count == count && c.first == S[0] && c.last == S[count - 1] && c.middle == S[count / 2] && c.p == p)
    return c.fields;
  c = {count, S[0], S[count / 2], S[count - 1], p, {}};
  for (int lane = 0; lane < Pack::lanes; ++lane) {
    const Section s = section(S[std::min(lane, count - 1)]);  // idle lanes repeat the last place
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 4; ++j) c.fields.U[j][i].set(lane, s.U[j][i]);
      c.fields.sigma[i].set(lane, s.sigma[i]);
      c.fields.mu[i].set(lane, s.mu[i]);
      c.fields.sigma_rate[i].set(lane, s.sigma_rate[i]);
      c.fields.gravity[i].set(lane, s.gravity[i]);
      c.fields.gravity_rate[i].set(lane, s.gravity_rate[i]);
      c.fields.mu_rate[i].set(lane, s.mu_rate[i]);
      c.fields.sigma_slope[i].set(lane, s.sigma_slope[i]);
      c.fields.mu_slope[i].set(lane, s.mu_slope[i]);
    }
    for (int j = 0; j < 5; ++j) {
      c.fields.Q[j].set(lane, s.Q[j]);
      c.fields.Q_rate[j].set(lane, s.Q_rate[j]);
    }
  }
  return c.fields;
}

FreeSystem::FreeSystem(const ScaledProblem* problem) : problem_(problem) {
  order.assign(FreeRod::order.begin(), FreeRod::order.end());
  first.assign(FreeRod::first.begin(), FreeRod::first.end());
  quadratures = FreeRod::quadratures;
  inputs = FreeRod::inputs;
}

void FreeSystem::residual(double S, const double* u, double* out) const {
  const Section s = problem_->section(S);
  if (!valid_free(problem_->material, s, u)) {
    std::fill(out, out + FreeRod::components + 1, nan);
    return;
  }
  FreeRod::residual<double>(problem_->material, formulation::lift<double>(s, 0.0, 0.0), u, out,
                            out + FreeRod::components);
}

void FreeSystem::jacobian(double S, const double* u, double* out, double* jac) const {
  const Section s = problem_->section(S);
  formulation::free_rod_jacobian<double>(problem_->material, s, true, u, out, jac);
  if (!valid_free(problem_->material, s, u)) std::fill(out, out + FreeRod::components + 1, nan);
}

void FreeSystem::residuals(const double* S, int count, const Pack* u, Pack* out) const {
  if (!numerics::wide_units()) return System::residuals(S, count, u, out);
  const Fields<Pack>& s = problem_->fields(S, count);
  free_residuals(problem_->material, s, u, out);
  for (int i = 0; i < count; ++i)
    if (!valid_free(problem_->material, s.U[0][0][i], s.U[0][1][i], u[0][i], u[4][i], u[15][i]))
      forbid(out, FreeRod::components + 1, i);
}

void FreeSystem::jacobians(const double* S, int count, const Pack* u, Pack* out, Pack* jac) const {
  if (!numerics::wide_units()) return System::jacobians(S, count, u, out, jac);
  const Fields<Pack>& s = problem_->fields(S, count);
  free_jacobians(problem_->material, s, problem_->loads_move(), u, out, jac);
  for (int i = 0; i < count; ++i)
    if (!valid_free(problem_->material, s.U[0][0][i], s.U[0][1][i], u[0][i], u[4][i], u[15][i]))
      forbid(out, FreeRod::components + 1, i);
}

void FreeSystem::highest(const double* S, int count, const Pack* u, Pack* out, Pack* top) const {
  if (!numerics::wide_units()) return System::highest(S, count, u, out, top);
  const Fields<Pack>& s = problem_->fields(S, count);
  free_highest(problem_->material, s, u, out, top);
  for (int i = 0; i < count; ++i)
    if (!valid_free(problem_->material, s.U[0][0][i], s.U[0][1][i], u[0][i], u[4][i], u[15][i]))
      forbid(out, FreeRod::components + 1, i);
}

LineSystem::LineSystem(const ScaledProblem* problem) : problem_(problem) {
  order.assign(LineContact::order.begin(), LineContact::order.end());
  first.assign(LineContact::first.begin(), LineContact::first.end());
  quadratures = LineContact::quadratures;
  inputs = LineContact::inputs;
}

void LineSystem::residual(double S, const double* u, double* out) const {
  const Section s = problem_->section(S);
  if (!(1.0 + problem_->material.eta2 * u[9] > 0.0)) {
    std::fill(out, out + LineContact::components + 1, nan);
    return;
  }
  LineContact::residual<double>(problem_->material, formulation::lift<double>(s, 0.0, 0.0),
                                formulation::lift_clearance<double>(s, 0.0, 0.0), u, out,
                                out + LineContact::components);
}

void LineSystem::jacobian(double S, const double* u, double* out, double* jac) const {
  const Section s = problem_->section(S);
  formulation::line_contact_jacobian<double>(problem_->material, s, u, out, jac);
  if (!(1.0 + problem_->material.eta2 * u[9] > 0.0)) std::fill(out, out + LineContact::components + 1, nan);
}

void LineSystem::residuals(const double* S, int count, const Pack* u, Pack* out) const {
  if (!numerics::wide_units()) return System::residuals(S, count, u, out);
  line_residuals(problem_->material, problem_->fields(S, count), u, out);
  for (int i = 0; i < count; ++i)
    if (!(1.0 + problem_->material.eta2 * u[9][i] > 0.0)) forbid(out, LineContact::components + 1, i);
}

void LineSystem::jacobians(const double* S, int count, const Pack* u, Pack* out, Pack* jac) const {
  if (!numerics::wide_units()) return System::jacobians(S, count, u, out, jac);
  line_jacobians(problem_->material, problem_->fields(S, count), u, out, jac);
  for (int i = 0; i < count; ++i)
    if (!(1.0 + problem_->material.eta2 * u[9][i] > 0.0)) forbid(out, LineContact::components + 1, i);
}

}  // namespace tendril::segmentation

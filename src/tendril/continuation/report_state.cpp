#include "tendril/continuation/report_state.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "tendril/formulation/convert.hpp"
#include "tendril/segmentation/cold_start.hpp"
#include "tendril/segmentation/collars.hpp"
#include "tendril/segmentation/stability.hpp"
#include "tendril/segmentation/tip.hpp"

namespace tendril::continuation {

using formulation::FreeRod;
using formulation::LineContact;
using segmentation::Chain;

namespace {

struct SectionValues {
  double S, s, u[formulation::state_inputs], M1, M2, M3, kappa, H, lambda;
  std::array<double, 3> r;
};

SectionValues values_at(const Chain& c, double S) {
  SectionValues v;
  v.S = S;
  c.sample(S, v.u, &v.s);
  const auto& P = c.mechanics().problem;
  const auto sec = P.section(S);
  const auto k = FreeRod::kinematics<double>(formulation::lift<double>(sec, 0.0, 0.0), v.u[0], v.u[1], v.u[2], v.u[4],
                                             v.u[5], v.u[6]);
  const auto m = P.material_at(v.u);
  const double J1 = FreeRod::stretch(m, v.u[15]) * k.J1bar;
  std::tie(v.M1, v.M2, v.M3) = std::tuple_cat(P.moments(k, v.u));
  v.kappa = k.J1bar * std::hypot(k.h, k.p);
  v.H = P.varies() ? 0.5 * m.bending * J1 * J1 * (k.h * k.h + k.p * k.p) : 0.5 * (v.M1 * v.M1 + v.M2 * v.M2);
  v.H += v.u[15] + 0.5 * m.eta2 * v.u[15] * v.u[15];
  v.lambda = v.H;
  const auto force = P.body_force_at(sec, v.u);
  for (int i = 0; i < 3; ++i) {
    v.r[i] = sec.R[i] + v.u[0] * sec.D[0][i] + v.u[4] * sec.D[1][i];
    double sigma = 0.0;
    for (int d = 0; d < 3; ++d) sigma += force[d] * sec.D[d][i];
    v.lambda += sigma * v.r[i];
  }
  return v;
}

Vec3 eigen(const std::array<double, 3>& a, double f) { return Vec3(a[0], a[1], a[2]) * f; }

double angle_at(const Chain& c, int segment, bool right) {
  const auto& seg = c.segment(segment);
  double u[formulation::state_inputs];
  seg.evaluate_local(right ? seg.pieces() - 1 : 0, right ? 1.0 : 0.0, c.S(segment), c.S(segment + 1), u, nullptr);
  return c.is_line(segment) ? u[0] : std::atan2(u[4], u[0]);
}

// Even steps over the rod, both sides of every junction (F, and p, jump there), and no segment with fewer than
// eight steps (or those of the whole rod), or short spans between many contacts would not be seen.
std::vector<double> output_places(const Chain& chain, int points) {
  const int least = std::min(8, points - 1);
  constexpr double kBeside = 1e-9;  // of the segment on the left: far below what the fields resolve
  const int n = chain.segments();
  std::vector<double> S;
  for (int i = 0; i < points; ++i) S.push_back(chain.S(n) * i / (points - 1.0));
  for (int j = 0; j < n; ++j) {
    const double a = chain.S(j), span = chain.S(j + 1) - a;
    if (j > 0) S.push_back(a);
    if (j + 1 < n) S.push_back(a + span * (1.0 - kBeside));
    const auto& segment = chain.segment(j);
    for (int q = 0; q + 1 < segment.parts(); ++q)  // at a point load or a collar too
      if (const auto& cut = segment.cut(q); cut.load >= 0 || cut.collar >= 0)
        S.insert(S.end(), {cut.S - span * kBeside, cut.S});
    if (span * (points - 1.0) < least * chain.S(n) * (1.0 - kBeside))
      for (int i = 1; i < least; ++i) S.push_back(a + span * i / least);
  }
  std::sort(S.begin(), S.end());
  S.erase(std::unique(S.begin(), S.end()), S.end());
  return S;
}

}  // namespace

Step describe(Chain& chain, int points) {
  const auto& P = chain.mechanics().problem;
  const double L = P.L, F = P.force_unit(), M = P.moment_unit();
  Step out;
  const int n = chain.segments();
  const auto all_margins = segmentation::margins(chain);
  const auto collars = segmentation::collar_states(chain);
  const SectionValues a = values_at(chain, chain.S(0)), b = values_at(chain, chain.S(n));
  const double s0 = P.law.from_end ? a.s : 0.0;  // reported from the rod's start
  out.rod_length = (b.s - a.s) * L;
  out.axial_force_start = a.u[15] * F;
  out.axial_force_end = b.u[15] * F;
  out.torque_start = a.M3 * M;
  out.torque_end = b.M3 * M;
  const SectionValues& e = P.source.axial_at == segmentation::Which::start ? a : b;
  out.push = -e.H * F;
  for (int j = 0; j < n; ++j) {
    out.segments.push_back({chain.is_line(j), j == 0 ? 0.0 : chain.S(j) * L, chain.S(j + 1) * L});
    Contact c;
    if (chain.is_line(j)) {
      c.line = true;
      c.start = j == 0 ? 0.0 : chain.S(j) * L;
      c.end = chain.S(j + 1) * L;
      const auto& seg = chain.segment(j);
      c.s_start = (seg.state(0)[7] - s0) * L;
      c.s_end = (seg.state(seg.pieces())[7] - s0) * L;
      c.angle_start = angle_at(chain, j, false);
      c.angle_end = angle_at(chain, j, true);
      const auto wall = segmentation::line_force(chain, j);
      c.force_distributed = wall.magnitude * F;
      c.force_vector = eigen(wall.force, F);
      c.force = c.force_distributed;
      for (int side : {0, 1}) {
        const int k = side == 0 ? j - 1 : j;
        if (k < 0 || k + 1 >= n) continue;
        const auto end = segmentation::junction_force(chain, k);
        (side == 0 ? c.force_start : c.force_end) = end.magnitude * F;
        c.force += end.magnitude * F;
        c.force_vector += eigen(end.force, F);
      }
      double low = HUGE_VAL, high = -HUGE_VAL;
      const double span = chain.S(j + 1) - chain.S(j);
      for (int i = 0; i <= 400; ++i) {
        const double p = segmentation::pressure(chain, j, chain.S(j) + span * std::clamp(i / 400.0, 1e-9, 1.0 - 1e-9));
        low = std::min(low, p);
        high = std::max(high, p);
      }
      for (const auto& m : all_margins)
        if (m.kind == segmentation::CheckKind::pressure && m.index == j) low = std::min(low, m.raw);
      c.pressure_min = low * F / L;
      c.pressure_max = high * F / L;
      c.pressure_mid = segmentation::pressure(chain, j, chain.S(j) + 0.5 * span) * F / L;
      out.contacts.push_back(c);
    }
    for (const auto& x : collars) {
      if (x.segment != j || !x.touches) continue;
      Contact point;
      point.collar = true;
      point.start = point.end = x.S * L;
      point.s_start = point.s_end = (x.s - s0) * L;
      point.angle_start = point.angle_end = x.angle;
      point.force = x.reaction * F;
      point.force_vector = eigen(x.N, -P.sign * x.reaction * F);
      out.contacts.push_back(point);
    }
    if (j + 1 < n && !chain.is_line(j) && !chain.is_line(j + 1)) {
      Contact point;
      point.start = point.end = chain.S(j + 1) * L;
      const auto& seg = chain.segment(j);
      point.s_start = point.s_end = (seg.state(seg.pieces())[11] - s0) * L;
      point.angle_start = point.angle_end = angle_at(chain, j, true);
      const auto wall = segmentation::junction_force(chain, j);
      point.force = wall.magnitude * F;
      point.force_vector = eigen(wall.force, F);
      out.contacts.push_back(point);
    }
  }
  if (chain.tip_rests()) {
    Contact point;
    point.start = point.end = chain.S(n) * L;
    point.s_start = point.s_end = b.s * L;
    point.angle_start = point.angle_end = angle_at(chain, n - 1, true);
    const auto tip = segmentation::tip_forces(chain);
    point.force = segmentation::tip_state(chain).reaction * F;
    point.force_vector = eigen(tip.wall, F);
    out.contacts.push_back(point);
  } else if (chain.is_line(n - 1) && segmentation::open_across(P)) {
    Contact& line = out.contacts.back();
    const auto tip = segmentation::tip_forces(chain);
    line.force_end = segmentation::tip_state(chain).reaction * F;
    line.force += *line.force_end;
    line.force_vector += eigen(tip.wall, F);
  }
  const auto c = segmentation::certify(chain);
  out.certificate = {c.equilibrium, c.gap_min,          c.reaction_min, c.curvature_max, c.continuity,
                     c.balance,     c.invariant_spread, c.error,        c.strain_max,    c.phase_multiplier};
  chain.store(out.state);
  if (points > 0) {
    Fields& f = out.fields;
    const std::vector<double> S = output_places(chain, points);
    for (double x : S) {
      const SectionValues v = values_at(chain, x);
      const int j = chain.segment_at(x);
      f.S.push_back(x * L);
      f.s.push_back((v.s - s0) * L);
      f.x.push_back(v.r[0] * L);
      f.y.push_back(v.r[1] * L);
      f.z.push_back(v.r[2] * L);
      f.delta1.push_back(v.u[0] * L);
      f.delta2.push_back(v.u[4] * L);
      f.phi.push_back(v.u[8]);
      f.gap.push_back(P.sign * (P.section(x).Q[0] - std::hypot(v.u[0], v.u[4])) * L);
      f.pressure.push_back(chain.is_line(j) ? segmentation::pressure(chain, j, x) * F / L : 0.0);
      f.F1.push_back(v.u[11] * F);
      f.F2.push_back(v.u[13] * F);
      f.F3.push_back(v.u[15] * F);
      f.M1.push_back(v.M1 * M);
      f.M2.push_back(v.M2 * M);
      f.M3.push_back(v.M3 * M);
      f.kappa.push_back(v.kappa / L);
    }
  }
  return out;
}

namespace {

segmentation::StabilityReport second_variation(const Chain& chain) {
  const auto& P = chain.mechanics().problem;
  const auto d = segmentation::discovery_problem(P);
  segmentation::StabilityProblem q;
  q.tube = d.tube;
  q.data = d.data;
  q.start = d.start;
  q.end = d.end;
  q.end_position = chain.S(chain.segments());
  if (P.tip_free()) {
    const auto frame = P.source.tube.axis->at(q.end_position * P.L).frame;
    q.tip_force = frame.transpose() * P.end.tip.force;
  }
  if (chain.tip_rests()) {
    q.tip_rests = true;
    q.tip_reaction = segmentation::tip_state(chain).reaction;
  }
  const SectionValues a = values_at(chain, 0.0);
  q.lambda = a.lambda;
  q.torque = a.M3;
  q.twist_held = P.source.twist == segmentation::TwistControl::twist;
  q.rotation_free = chain.turns_freely();
  q.eccentricity = [&](double S) {
    double u[formulation::state_inputs];
    chain.sample(std::clamp(S, 0.0, chain.S(chain.segments())), u, nullptr);
    formulation::Vector6 e;
    e << u[0], u[1], u[2], u[4], u[5], u[6];
    return e;
  };
  q.data.loads.clear();  // where they act is known: λ is that of the state
  q.data.potential = nullptr;
  if (P.varies() || q.data.force_field) q.lambda_at = [&](double S) { return values_at(chain, S).lambda; };
  if (P.varies()) {
    q.data.properties = [&](double S) {
      double u[formulation::state_inputs];
      chain.sample(S, u, nullptr);
      return P.law.pieces[static_cast<std::size_t>(u[formulation::VaryingFree::piece])].at<double>(u[17]);
    };
  }
  const int n = chain.segments();
  for (int j = 0; j < n; ++j) {
    for (int cut = 0; cut + 1 < chain.segment(j).parts(); ++cut) q.breaks.push_back(chain.segment(j).cut(cut).S);
    if (chain.is_line(j)) {
      segmentation::LineReaction l;
      l.start = chain.S(j);
      l.end = chain.S(j + 1);
      if (j > 0) l.reaction_start = segmentation::reaction(chain, j - 1);
      if (j + 1 < n) l.reaction_end = segmentation::reaction(chain, j);
      l.pressure = [&chain, j](double S) {
        return segmentation::pressure(chain, j, std::clamp(S, chain.S(j), chain.S(j + 1)));
      };
      q.lines.push_back(l);
    } else if (j + 1 < n && !chain.is_line(j + 1)) {
      q.points.push_back({chain.S(j + 1), segmentation::reaction(chain, j)});
    }
  }
  for (const auto& x : segmentation::collar_states(chain))
    if (x.touches) q.points.push_back({x.S, x.reaction, true});
  std::sort(q.points.begin(), q.points.end(), [](const auto& x, const auto& y) { return x.S < y.S; });
  return segmentation::stability(q);
}

}  // namespace

int unstable_directions(const Chain& chain) {
  if (chain.mechanics().problem.curved) return 0;
  const auto r = second_variation(chain);
  return chain.mechanics().problem.source.axial == segmentation::AxialControl::push ? r.negative_dead_push
                                                                                    : r.negative_held_length;
}

StabilityVerdict judge_stability(const Chain& chain) {
  const auto& P = chain.mechanics().problem;
  const int n = chain.segments();
  if (P.source.load.couples()) return {"unknown", "body couples are not conservative"};
  if (!P.source.load.force_field.none())
    return {"unknown", "a body force that changes along the axis is not conservative"};
  for (const auto& l : P.point_loads) {
    if (!l.couple.isZero()) return {"unknown", "a couple fixed in the world is not conservative"};
    if (!l.on_rod) return {"unknown", "a force that stays at its place on the axis is not conservative"};
  }
  if (P.tip_free()) {
    const auto& tip = P.source.end.tip;
    const bool axial = P.source.axial == segmentation::AxialControl::axial_force && P.now(P.axial) != 0.0;
    if (!tip.couple.isZero() || (tip.follower && !tip.none()) || axial ||
        (P.source.twist == segmentation::TwistControl::torque && P.now(P.twist) != 0.0))
      return {"unknown", "the load on the tip is not conservative"};
  }
  if (P.curved) return {"unknown", "the second variation of a rod that is curved without stress is not computed"};
  const auto r = second_variation(chain);
  using segmentation::AxialControl;
  if (P.tip_free())  // what can be held is the length of the rod that is fed in
    return r.negative_held_length == 0 ? StabilityVerdict{"stable", "stable at held length"}
                                       : StabilityVerdict{"unstable", std::to_string(r.negative_held_length) +
                                                                          " unstable mode(s) at held length"};
  if (P.source.axial == AxialControl::rod_length)
    return r.negative_held_length == 0 ? StabilityVerdict{"stable", "stable at held length"}
                                       : StabilityVerdict{"unstable", std::to_string(r.negative_held_length) +
                                                                          " unstable mode(s) at held length"};
  if (P.source.axial == AxialControl::push)
    return r.negative_dead_push == 0 ? StabilityVerdict{"stable", "stable under dead push"}
                                     : StabilityVerdict{"unstable", std::to_string(r.negative_dead_push) +
                                                                        " unstable mode(s) under dead push"};
  if (r.negative_held_length > 0)
    return {"unstable", std::to_string(r.negative_held_length) + " unstable mode(s) at held length"};
  // a held axial force is not conservative: the state must also answer more force with less length fed in
  segmentation::Problem slope = P.source;
  auto still = [&](segmentation::Scalar& s, const segmentation::Scalar& scaled, double unit) {
    s = {P.now(scaled) * unit, 0.0};
  };
  for (auto [to, from] : {std::pair{&slope.start, &P.start}, std::pair{&slope.end, &P.end}}) {
    for (int i = 0; i < 2; ++i) {
      still(to->eccentricity[i], from->eccentricity[i], P.L);
      still(to->slope[i], from->slope[i], 1.0);
    }
    still(to->roll, from->roll, 1.0);
  }
  slope.clearance_scale = {P.now(P.source.clearance_scale)};
  slope.body_force_scale = {P.now(P.source.body_force_scale)};
  slope.point_load_scale = {P.now(P.source.point_load_scale)};
  slope.end_position = {P.now(P.end_position) * P.L};
  still(slope.twist_value, P.twist, P.source.twist == segmentation::TwistControl::torque ? P.moment_unit() : 1.0);
  slope.axial_value = {P.now(P.axial) * P.force_unit(), P.force_unit()};
  auto mechanics = std::make_shared<segmentation::Mechanics>(slope, P.p);
  Chain c = chain;
  c.rebind(mechanics);
  std::vector<double> t;
  if (!c.tangent({segmentation::Closure::Kind::parameter, 0, c.parameter()}, t))
    return {"unknown", "the state is singular under its end force"};
  const int last = n - 1;
  const int column = c.column_of_state(last, c.segment(last).pieces(), c.segment(last).states() - 1);
  const int start = c.column_of_state(0, 0, c.segment(0).states() - 1);
  const double slope_length = t[column] - t[start];  // d(rod length)/dF3
  // a straight inextensible rod on the axis answers with nothing: zero up to rounding, scaled
  if (slope_length < 1e-14) return {"stable", "stable under its end force"};
  return {"unstable", "stable at held length, but the end force falls as rod is fed in"};
}

}  // namespace tendril::continuation

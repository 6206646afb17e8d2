#include "tendril/segmentation/collars.hpp"

#include <algorithm>
#include <cmath>

#include "tendril/formulation/free_rod.hpp"

namespace tendril::segmentation {

using formulation::FreeRod;
using formulation::Section;
using formulation::V3;

namespace {

std::array<double, 3> world(const Section& s, const V3<double>& c) {
  std::array<double, 3> w{};
  for (int i = 0; i < 3; ++i) w[i] = c[0] * s.D[0][i] + c[1] * s.D[1][i] + c[2] * s.D[2][i];
  return w;
}

std::array<double, 3> place_of(const Section& s, const double* u) {
  auto r = world(s, {u[0], u[4], 0.0});
  for (int i = 0; i < 3; ++i) r[i] += s.R[i];
  return r;
}

template <class F>
void each_cut(const Chain& chain, const F& f) {
  for (int j = 0; j < chain.segments(); ++j)
    for (int q = 0; q + 1 < chain.segment(j).parts(); ++q) f(j, q, chain.segment(j).cut(q));
}

/// Force in D on one side.
V3<double> force_at(const Section& s, const double* u) {
  const auto k =
      FreeRod::kinematics<double>(formulation::lift<double>(s, 0.0, 0.0), u[0], u[1], u[2], u[4], u[5], u[6]);
  V3<double> F;
  for (int i = 0; i < 3; ++i) F[i] = u[11] * k.k1[i] + u[13] * k.k2[i] + u[15] * k.t[i];
  return F;
}

}  // namespace

void state_at_cut(const Chain& chain, int segment, int cut, int side, double* u) {
  const CutSegment& s = chain.segment(segment);
  const auto& part = s.part(cut + side);
  const double a = s.left(cut + side, chain.S(segment)), b = s.right(cut + side, chain.S(segment + 1));
  double v[formulation::state_inputs];
  part.evaluate_local(side == 0 ? part.pieces() - 1 : 0, side == 0 ? 1.0 : 0.0, a, b, v, nullptr);
  v[part.system().inputs] = s.law(cut + side);
  const ScaledProblem& P = chain.mechanics().problem;
  if (chain.is_line(segment))
    P.line_to_free(P.section(s.cut(cut).S), v, u);
  else
    std::copy_n(v, formulation::state_inputs, u);
}

std::vector<CollarState> collar_states(const Chain& chain) {
  std::vector<CollarState> out;
  const ScaledProblem& P = chain.mechanics().problem;
  if (P.collars.empty()) return out;
  each_cut(chain, [&](int j, int q, const Cut& cut) {
    if (cut.collar < 0) return;
    CollarState c{cut.collar, j, q, cut.S, cut.s};
    const Section sec = P.section(cut.S);
    double before[formulation::state_inputs], behind[formulation::state_inputs];
    state_at_cut(chain, j, q, 0, before);
    state_at_cut(chain, j, q, 1, behind);
    const double radius = std::hypot(behind[0], behind[4]), Q = P.collar_clearance(cut.collar, sec);
    c.angle = std::atan2(behind[4], behind[0]);
    c.touches = chain.touches(cut.collar);
    c.gap = P.sign * (Q - radius) / Q;
    c.place = place_of(sec, behind);
    if (c.touches) {
      const double C3 = 1.0 - behind[0] * sec.U[0][1] + behind[4] * sec.U[0][0], w = std::hypot(C3, sec.Q[1]);
      const V3<double> N{C3 * behind[0] / radius / w, C3 * behind[4] / radius / w, -sec.Q[1] / w};
      V3<double> jump = force_at(sec, behind);
      const V3<double> F = force_at(sec, before);
      V3<double> load{};
      if (cut.load >= 0) load = in_frame(sec, P.now(P.source.point_load_scale) * P.point_loads[cut.load].force);
      for (int i = 0; i < 3; ++i) jump[i] += load[i] - F[i];
      c.reaction = P.sign * numerics::dot(jump, N);
      c.N = world(sec, N);
    }
    out.push_back(c);
  });
  return out;
}

std::vector<LoadState> load_states(const Chain& chain) {
  std::vector<LoadState> out;
  const ScaledProblem& P = chain.mechanics().problem;
  if (P.point_loads.empty()) return out;
  each_cut(chain, [&](int j, int q, const Cut& cut) {
    if (cut.load < 0) return;
    const auto& load = P.point_loads[cut.load];
    LoadState l{cut.load, j, q, cut.S, cut.s};
    double u[formulation::state_inputs];
    state_at_cut(chain, j, q, 1, u);
    l.s = u[17];
    l.place = place_of(P.section(cut.S), u);
    for (int i = 0; i < 3; ++i) {
      l.force[i] = P.now(P.source.point_load_scale) * load.force[i];
      l.couple[i] = P.now(P.source.point_load_scale) * load.couple[i];
    }
    out.push_back(l);
  });
  return out;
}

std::vector<Pattern> collar_patterns(const Pattern& pattern, const std::vector<int>& collars, std::size_t count) {
  std::vector<Pattern> out;
  const auto change = [&](const std::vector<int>& which) {
    Pattern r = pattern;
    r.collar.resize(count, 0);
    for (const int i : which) r.collar[i] = !r.collar[i];
    if (std::none_of(r.collar.begin(), r.collar.end(), [](char t) { return t != 0; })) r.collar.clear();
    out.push_back(r);
  };
  change(collars);
  if (collars.size() > 1)
    for (const int i : collars) change({i});
  return out;
}

}  // namespace tendril::segmentation

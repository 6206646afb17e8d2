#include "tendril/segmentation/discrete_start.hpp"

#include <algorithm>
#include <cmath>

#include "tendril/segmentation/seeding.hpp"
#include "tendril/segmentation/tip.hpp"

namespace tendril::segmentation {

using formulation::FreeRod;

namespace {

/// Loads that change along the axis, point loads and collars, the latter where they lie in a rod `ratio` times as long
/// as its tube.
void spread_loads(const ScaledProblem& P, double ratio, DiscoveryProblem& d) {
  constexpr double half = 1e-3;  // of the tube: half the stretch that stands for a collar
  const double from = P.law.from_end ? d.end_position : 0.0, w = half * d.end_position;
  for (std::size_t i = 0; i < P.collars.size(); ++i) {
    const double S = from + P.collars[i].s / ratio;
    if (S - w > 0.0 && S + w < d.end_position)
      d.data.collars.push_back({S - w, S + w, static_cast<int>(i), P.collars[i].height});
  }
  std::vector<std::array<double, 2>> axial;  // S, force along the axis
  for (const auto& load : P.point_loads) {
    DiscreteRodData::NodeLoad x;
    x.S = load.on_rod ? from + load.at / ratio : load.at;
    if (!(x.S > 0.0 && x.S < d.end_position)) continue;
    const auto frame = P.source.tube.axis->at(x.S * P.L).frame;
    const double scale = P.now(P.source.point_load_scale);
    const Eigen::Vector3d F = scale * (frame.transpose() * load.force), M = scale * (frame.transpose() * load.couple);
    x.load << F[0], M[1], F[1], -M[0];
    d.data.loads.push_back(x);
    axial.push_back({x.S, F[2]});
  }
  const auto& load = P.source.load;
  if (load.force_field.none() && P.point_loads.empty()) return;
  const double unit = P.now(P.source.body_force_scale) * P.L * P.L * P.L / P.B;
  d.data.force_field = [field = load.force_field, unit, L = P.L](double S) -> Eigen::Vector3d {
    return unit * field.at(S * L);
  };
  constexpr int steps = 4000;
  std::vector<double> sum{0.0};
  const double h = 1.0 / steps;
  for (int i = 0; i < steps; ++i) {
    const double S = (i + 0.5) * h;
    const Eigen::Vector3d D3 = P.source.tube.axis->at(S * P.L).frame.col(2);
    sum.push_back(sum.back() + h * D3.dot(d.data.force_field(S)));
  }
  const auto start = P.source.tube.axis->at(0.0);
  const double base = d.data.force_field(0.0).dot(start.position) / P.L;
  d.data.potential = [sum, base, axial](double S) {
    const double at = std::clamp(S, 0.0, 1.0) * steps;
    const auto i = std::min<std::size_t>(static_cast<std::size_t>(at), steps - 1);
    double out = base + sum[i] + (at - i) * (sum[i + 1] - sum[i]);
    for (const auto& [place, force] : axial)
      if (S > place) out += force;
    return out;
  };
}

}  // namespace

DiscoveryProblem discovery_problem(const ScaledProblem& P) {
  DiscoveryProblem d;
  d.tube = P.source.tube;
  d.data.eta2 = P.material.eta2;
  d.data.nu = P.material.nu;
  d.data.body_force = P.now(P.source.body_force_scale) * P.source.load.force * (P.L * P.L * P.L / P.B);
  d.data.clearance_scale = P.now(P.source.clearance_scale);
  auto held = [&](const ScaledProblem::ScaledEnd& e) {
    HeldEnd h;
    h.pinned = e.kind == End::Kind::pinned;
    h.guided = e.kind == End::Kind::guided;
    h.free = e.kind == End::Kind::free;
    for (int i = 0; i < 2; ++i) {
      h.eccentricity[i] = P.now(e.eccentricity[i]);
      h.slope[i] = P.now(e.slope[i]);
    }
    return h;
  };
  d.start = held(P.start);
  d.end = held(P.end);
  d.end_position = P.now(P.end_position);
  d.axial = P.source.axial;
  d.axial_at = P.source.axial_at;
  d.axial_value = P.now(P.axial);
  if (P.tip_free()) {
    const TipLoad& tip = P.end.tip;
    const auto frame = P.source.tube.axis->at(std::min(d.end_position, 1.0) * P.L).frame;
    d.tip_force = tip.follower ? tip.force : Eigen::Vector3d(frame.transpose() * tip.force);
    d.tip_couple = tip.follower ? tip.couple : Eigen::Vector3d(frame.transpose() * tip.couple);
    d.axial_at = Which::end;
    if (P.tip_place_free()) {
      d.axial = AxialControl::axial_force;
      d.axial_value = 0.0;
      d.end_position = std::min(1.0, P.now(P.axial));
    }
    if (d.twist == TwistControl::torque) d.twist_value += d.tip_couple[2];
  }
  d.twist = P.source.twist;
  d.twist_value = P.now(P.twist);
  if (d.twist == TwistControl::twist) {
    const double other = P.source.twist_at == Which::end ? P.now(P.start.roll) : P.now(P.end.roll);
    d.twist_value = P.source.twist_at == Which::end ? d.twist_value - other : other - d.twist_value;
  }
  d.turns = P.source.turns;
  const double ratio = P.source.axial == AxialControl::rod_length ? P.now(P.axial) / d.end_position : 1.0;
  spread_loads(P, ratio, d);
  d.length_unit = P.L;
  d.force_unit = P.force_unit();
  if (P.varies()) {
    d.data.weight_direction = P.now(P.source.body_force_scale) * P.source.load.weight_direction;
    // where the sections lie in a rod as long as the tube, or as long as it is
    const double end = P.law.from_end ? d.end_position : 0.0;
    d.data.properties = [law = P.law, ratio, end](double S) { return law.at(ratio * (S - end)); };
  }
  return d;
}

namespace {

/// The discrete state as a smooth start for collocation: quintic Hermite through δ, δ' and the mean of δ'' of the
/// neighbouring elements; axial force from H, shear from moment balance, twist from M3.
class DiscreteSampler {
 public:
  DiscreteSampler(const ScaledProblem& P, const DiscoveryResult& d) : P_(P), data_(discovery_problem(P).data), d_(d) {
    const auto& S = d.state.S;
    const std::size_t n = S.size();
    for (auto& side : second_)
      for (auto& component : side) component.assign(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      // Where the section steps the curvature does: each side keeps its own.
      const bool step = d.properties && i > 0 && i + 1 < n &&
                        std::abs(d.properties(S[i] + 1e-9).B - d.properties(S[i] - 1e-9).B) > 1e-6;
      double weight[2] = {0.0, 0.0};
      for (int side : {-1, 1}) {
        if ((side < 0 && i == 0) || (side > 0 && i + 1 == n)) continue;
        const double h = side < 0 ? S[i] - S[i - 1] : S[i + 1] - S[i];
        const auto u = evaluate(d.state, S[i] + side * 1e-7 * h);
        for (int to = 0; to < 2; ++to) {
          if (step && to != (side > 0)) continue;
          second_[to][0][i] += u[2] / h;
          second_[to][1][i] += u[5] / h;
          weight[to] += 1.0 / h;
        }
      }
      for (int to = 0; to < 2; ++to)
        for (int c = 0; c < 2; ++c) second_[to][c][i] /= weight[to];
    }
  }

  void operator()(double S, double* u, double* s) const {
    std::fill_n(u, FreeRod::inputs, 0.0);
    const auto& nodes = d_.state.S;
    const std::size_t i = std::clamp<std::ptrdiff_t>(
        std::upper_bound(nodes.begin(), nodes.end(), S) - nodes.begin() - 1, 0, nodes.size() - 2);
    const double h = nodes[i + 1] - nodes[i], x = (S - nodes[i]) / h;
    for (int c = 0; c < 2; ++c) {
      const auto &a = d_.state.u[i], &b = d_.state.u[i + 1];
      quintic(a[2 * c], a[2 * c + 1], second_[1][c][i], b[2 * c], b[2 * c + 1], second_[0][c][i + 1], h, x, u + 4 * c);
    }
    const auto sec = P_.section(S);
    const auto l = formulation::lift<double>(sec, 0.0, 0.0);
    const auto k = FreeRod::kinematics<double>(l, u[0], u[1], u[2], u[4], u[5], u[6]);
    // λ = ½ω² + F3 + ½η²F3² + σ·r
    double potential = 0.0;
    for (int i2 = 0; i2 < 3; ++i2)
      potential += sec.sigma[i2] * (sec.R[0] * sec.D[i2][0] + sec.R[1] * sec.D[i2][1] + sec.R[2] * sec.D[i2][2]);
    potential += sec.sigma[0] * u[0] + sec.sigma[1] * u[4];
    if (data_.potential) {
      const Eigen::Vector3d R(sec.R[0], sec.R[1], sec.R[2]);
      potential += data_.potential(S) - data_.force_field(S).dot(R);
    }
    formulation::Material m = P_.material;
    if (P_.varies()) {
      const auto section = d_.properties(S);
      if (d_.gain) potential -= d_.gain(S);
      m = {section.e, 1.0 / section.C - 1.0, section.B, {}};
      for (int c = 0; c < 3; ++c) {
        double at = c < 2 ? u[4 * c] : 0.0;
        for (int i2 = 0; i2 < 3; ++i2) at += sec.R[i2] * sec.D[c][i2];
        potential += section.weight * sec.gravity[c] * at;
      }
    }
    const double H = d_.state.lambda - potential, eta2 = m.eta2;
    // α²(η⁻² + κ²) = 2H + η⁻² (III.1.41), for E = F3 + ½η²F3²; κ: curvature of the centreline, B in it
    const double kappa2 = m.bending * ((k.p * k.p + k.h * k.h) * k.J1bar * k.J1bar);
    const double E = (H - 0.5 * kappa2) / (1.0 + eta2 * kappa2);
    const double F3 = 2.0 * E / (1.0 + std::sqrt(std::max(1.0 + 2.0 * eta2 * E, 1e-2)));
    u[15] = F3;
    const double J1 = FreeRod::stretch(m, F3) * k.J1bar;
    u[9] = (1.0 + m.nu) * d_.state.torque / J1 - k.c;
    u[8] = d_.phi[i] + x * (d_.phi[i + 1] - d_.phi[i]);
    *s = d_.s[i] + x * (d_.s[i + 1] - d_.s[i]);
    balance_shear(P_, S, u);
  }

 private:
  static void quintic(double a0, double a1, double a2, double b0, double b1, double b2, double h, double x,
                      double* out) {
    const double c0 = a0, c1 = h * a1, c2 = 0.5 * h * h * a2;
    const double r0 = b0 - c0 - c1 - c2, r1 = h * b1 - c1 - 2.0 * c2, r2 = h * h * b2 - 2.0 * c2;
    const double c3 = 10.0 * r0 - 4.0 * r1 + 0.5 * r2, c4 = -15.0 * r0 + 7.0 * r1 - r2,
                 c5 = 6.0 * r0 - 3.0 * r1 + 0.5 * r2;
    out[0] = c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * c5))));
    out[1] = (c1 + x * (2 * c2 + x * (3 * c3 + x * (4 * c4 + x * 5 * c5)))) / h;
    out[2] = (2 * c2 + x * (6 * c3 + x * (12 * c4 + x * 20 * c5))) / (h * h);
    out[3] = (6 * c3 + x * (24 * c4 + x * 60 * c5)) / (h * h * h);
  }
  const ScaledProblem& P_;
  DiscreteRodData data_;
  const DiscoveryResult& d_;
  std::vector<double> second_[2][2];  // δ1'', δ2'' of the left and the right side of the nodes
};

Pattern found_pattern(const DiscoveryResult& d, bool tip_may_rest) {
  Pattern q;
  if (std::any_of(d.collars.begin(), d.collars.end(), [](char t) { return t != 0; })) q.collar = d.collars;
  q.line.push_back(0);
  const auto& nodes = d.state.S;
  const double end = nodes.back(), size = end - nodes[nodes.size() - 2];
  q.tip = tip_may_rest && d.tip_reaction > 0.0;
  for (const FoundContact& c : d.contacts) {
    if (c.line) {
      const bool from_start = c.start <= 1e-9, to_end = c.end >= end - (tip_may_rest ? 2.0 * size : 1e-9);
      if (to_end) q.tip = false;
      if (from_start && to_end) return {{1}, {}, false, q.collar};
      if (from_start) {
        q = {{1, 0}, {c.end}, q.tip, q.collar};
      } else if (to_end) {
        q.S.push_back(c.start);
        q.line.push_back(1);
      } else {
        q.S.push_back(c.start);
        q.line.push_back(1);
        q.S.push_back(c.end);
        q.line.push_back(0);
      }
    } else if (c.start > 1e-9 && c.start < end - (q.tip ? 2.0 * size : 1e-9)) {
      q.S.push_back(c.start);
      q.line.push_back(0);
    }
  }
  return q;
}

}  // namespace

Chain sharp_start(const std::shared_ptr<Mechanics>& mechanics, const DiscoveryResult& found, int k, int pieces) {
  const ScaledProblem& P = mechanics->problem;
  const DiscreteSampler sampler(P, found);
  Chain c(mechanics, k);
  c.set_parameter(P.p);
  c.set_tip_place(found.state.S.back());
  c.build(found_pattern(found, open_across(P)), pieces, [&](double S, double* u, double* s) { sampler(S, u, s); });
  return c;
}

}  // namespace tendril::segmentation

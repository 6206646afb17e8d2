#include "tendril/segmentation/discovery_sections.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "tendril/segmentation/discovery_search.hpp"

namespace tendril::segmentation {

namespace {

/// What a state says of its sections.
struct Layout {
  rod::SectionLaw law;
  std::vector<double> S, s;  // of the nodes; s as the law counts it
  std::vector<double> at, gain;
  std::vector<int> piece;  // at quadrature points

  double s_at(double x) const {
    const std::size_t i =
        std::clamp<std::ptrdiff_t>(std::upper_bound(S.begin(), S.end(), x) - S.begin(), 1, std::ssize(S) - 1);
    return s[i - 1] + (x - S[i - 1]) / (S[i] - S[i - 1]) * (s[i] - s[i - 1]);
  }
  double S_at(double y) const {
    const std::size_t i =
        std::clamp<std::ptrdiff_t>(std::upper_bound(s.begin(), s.end(), y) - s.begin(), 1, std::ssize(s) - 1);
    return S[i - 1] + (y - s[i - 1]) / (s[i] - s[i - 1]) * (S[i] - S[i - 1]);
  }
  double gain_at(double x) const {
    const int k = law.piece_at(s_at(x));
    const std::size_t i =
        std::clamp<std::ptrdiff_t>(std::upper_bound(at.begin(), at.end(), x) - at.begin(), 1, std::ssize(at) - 1);
    if (piece[i] != k) return gain[i - 1];  // across a break λ jumps
    if (piece[i - 1] != k) return gain[i];
    const double f = std::clamp((x - at[i - 1]) / (at[i] - at[i - 1]), 0.0, 1.0);
    return gain[i - 1] + f * (gain[i] - gain[i - 1]);
  }
};

}  // namespace

double lay_sections(const rod::SectionLaw& law, const DiscoveryResult& found, DiscoveryProblem& problem) {
  auto out = std::make_shared<Layout>();
  out->law = law;
  out->S = found.state.S;
  out->s = found.s;
  if (law.from_end)
    for (double& x : out->s) x -= found.s.back();
  // F3 and M go on along the rod; λ = ½M²/B + F3 + ½eF3² + σ·r then changes with 1/B, e and the weight.
  const DiscreteRod rod(problem.tube, problem.data, found.state.S);
  const double L = problem.tube.length();
  double M2 = 0.0, F2 = 0.0, gr = 0.0;
  rod::Properties<double> before{};
  for (const QuadraturePoint& q : rod.points()) {
    const auto x = rod.at(q, found.state.u);
    const auto d = formulation::density_invariants(q.section, x);
    const double eta2 = problem.data.eta2 * d.softness;
    const double s1 = formulation::reduced_density(d, found.state.lambda, problem.data.eta2).s1;
    const double bending = 0.5 * d.t2 / (s1 * s1);  // ½Bκ²
    const double F = axial_force(found.state.lambda - d.y - bending, eta2);
    const auto axis = problem.tube.axis->at(std::min(q.S * L, L));
    const Eigen::Vector3d g = axis.frame.transpose() * problem.data.weight_direction;
    const double height = problem.data.weight_direction.dot(axis.position) / L + g[0] * x[0] + g[1] * x[3];
    const auto here = law.at(out->s_at(q.S));
    const double m2 = 2.0 * bending * q.section.bending, f2 = F * F;
    if (out->at.empty()) {
      out->gain.push_back(0.0);
    } else {
      out->gain.push_back(out->gain.back() + 0.25 * (M2 + m2) * (1.0 / here.B - 1.0 / before.B) +
                          0.25 * (F2 + f2) * (here.e - before.e) + 0.5 * (gr + height) * (here.weight - before.weight));
    }
    out->at.push_back(q.S);
    out->piece.push_back(law.piece_at(out->s_at(q.S)));
    before = here;
    M2 = m2;
    F2 = f2;
    gr = height;
  }
  std::vector<double> breaks;
  for (const rod::SectionPiece& p : law.pieces) {
    if (!(p.from > out->s.front() && p.from < out->s.back())) continue;
    const double S = out->S_at(p.from), last = breaks.empty() ? 0.0 : breaks.back();
    if (S - last > 1e-4 && problem.end_position - S > 1e-4) breaks.push_back(S);
  }
  double moved = breaks.size() == problem.data.breaks.size() ? 0.0 : 1.0;
  for (std::size_t i = 0; i < breaks.size() && moved < 1.0; ++i)
    moved = std::max(moved, std::abs(breaks[i] - problem.data.breaks[i]));
  problem.data.breaks = std::move(breaks);
  problem.data.properties = [out](double S) { return out->law.at(out->s_at(S)); };
  problem.data.gain = [out](double S) { return out->gain_at(S); };
  return moved;
}

DiscoveryResult discover_sections(const rod::SectionLaw& law, DiscoveryProblem& problem,
                                  const DiscoveryOptions& options) {
  DiscoveryResult found = discover(problem, options);
  if (law.uniform()) return found;
  constexpr int rounds = 6;
  constexpr double still = 1e-4;
  for (int round = 0; round < rounds && found.converged && !options.stop.asked(); ++round) {
    DiscoveryProblem next = problem;
    const double moved = lay_sections(law, found, next);
    DiscoveryOptions again = options;
    again.initial = &found.state;
    again.coarse = nullptr;
    again.ease = false;
    again.elements = static_cast<int>(found.state.S.size()) - 1;
    DiscoveryResult settled = discover(next, again);
    if (!settled.converged) break;
    problem = std::move(next);
    settled.iterations += found.iterations;
    settled.factorisations += found.factorisations;
    found = std::move(settled);
    if (moved < still) break;
  }
  return found;
}

}  // namespace tendril::segmentation

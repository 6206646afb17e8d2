#include "tendril/segmentation/discovery.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tendril/segmentation/discovery_search.hpp"

namespace tendril::segmentation {

namespace {

std::string digits(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", x);
  return text;
}

}  // namespace

DiscoveryResult Search::run() {
  guess();
  DiscoveryResult r;
  r.dead_push = true;
  if (o_.perturb && o_.initial == nullptr && p_.tube.side == geometry::Side::inside) perturb(0.02 * s_.clearance);
  const auto saved = eq_.u;
  const double wall_stiffness = eq_.wall_stiffness;
  const auto state = [&](bool ok, const char* why) {
    r.converged = ok;
    if (!ok) r.message = why;
    return ok;
  };
  bool ok = false;
  if (o_.coarse != nullptr) {
    r.dead_push = o_.coarse->dead_push;
    ok = state(resume(), "the finer minimisation did not settle");
  } else {
    if (o_.ease)
      ok = ease() && sharpen();
    else if (p_.axial != AxialControl::rod_length && !o_.march_length)
      ok = direct() && sharpen();
  }
  const auto folds = [&](const std::string& reached) {
    r.reach = reach_;
    r.message = reached + reach_.words(p_.length_unit);
  };
  if (!ok && o_.ease) {
    eq_.anchor_stiffness = 0.0;
    state(false, "the rod did not settle while its ties were loosened");
    if (!reach_.within()) folds("let go of the axis, ");
  } else if (!ok && o_.coarse == nullptr) {
    r.dead_push = false;
    eq_.u = saved;
    std::fill(eq_.wall_multiplier.begin(), eq_.wall_multiplier.end(), 0.0);
    eq_.tip_multiplier = 0.0;
    iterations_ = 0;
    reach_ = {};
    eq_.wall_stiffness = wall_stiffness;
    ok = state(march(), "the length march found no state that meets the axial control") &&
         state(release() && sharpen(), "the minimisation did not settle");
    if (!ok && !reach_.within())
      folds(p_.axial == AxialControl::rod_length
                ? ""
                : (p_.axial == AxialControl::push ? "at a push of " : "at an axial force of ") +
                      digits(best_ * p_.force_unit) + " of " + digits(p_.axial_value * p_.force_unit) + ", ");
  }
  if (ok) {
    r.dead_push = !eq_.length_held;
    reach_ = {};
    see_reach();
    r.reach = reach_;
  }
  r.converged = ok;
  r.iterations = iterations_;
  r.factorisations = factorisations_;
  const auto& rod = eq_.rod();
  const auto t = eq_.totals(eq_.u);
  r.state = {rod.nodes(), eq_.u, eq_.lambda, eq_.torque, t.length};
  if (!t.valid) {
    r.converged = false;
    r.state = {};
    r.message = "the minimisation left the validity of the formulation";
    return r;
  }
  r.H_start = eq_.lambda - potential(false);
  r.H_end = eq_.lambda - potential(true);
  r.axial_force_start = axial_force(r.H_start - eq_.end_bending_energy(false), p_.data.eta2);
  r.axial_force_end = axial_force(r.H_end - eq_.end_bending_energy(true), p_.data.eta2);
  r.s.assign(1, 0.0);
  r.phi.assign(1, 0.0);
  const auto& q = rod.points();
  for (std::size_t i = 0; i < q.size(); ++i) {
    const auto d = formulation::density_invariants(q[i].section, rod.at(q[i], eq_.u));
    const double s1 = formulation::reduced_density(d, eq_.lambda, p_.data.eta2).s1;
    if (i % 3 == 0) {
      r.s.push_back(r.s.back());
      r.phi.push_back(r.phi.back());
    }
    r.s.back() += q[i].weight * s1;
    const double softness = p_.data.properties ? 1.0 / p_.data.properties(q[i].S).C : 1.0 + p_.data.nu;
    r.phi.back() += q[i].weight * (softness * eq_.torque * s1 - d.c);  // φ' = ((1+ν)M3 - ω3)/J1
    r.wall_S.push_back(q[i].S);
    r.wall_weight.push_back(q[i].weight);
    r.wall_pressure.push_back(eq_.wall_pressure(i));
    r.wall_gap.push_back(-eq_.wall_penetration(i));
  }
  std::vector<double> of_rod = r.wall_pressure;
  double largest = 0.0;
  for (const double p : of_rod) largest = std::max(largest, p);
  for (std::size_t i = 0; i < q.size(); ++i) {
    if (q[i].collar < 0) continue;
    const auto c = static_cast<std::size_t>(q[i].collar);
    if (r.collars.size() <= c) r.collars.resize(c + 1, 0);
    if (of_rod[i] > 1e-4 * largest) r.collars[c] = 1;
    of_rod[i] = 0.0;
  }
  r.contacts = read_contacts(rod, eq_.u, s_.clearance, of_rod, r.wall_gap);
  if (p_.end.open()) r.tip_reaction = eq_.tip_reaction();
  r.properties = p_.data.properties;
  r.gain = p_.data.gain;
  r.force_slope = slopes().force;
  eq_.length_held = true;
  eq_.length_compliance = 1e-12 * s_.clearance * s_.clearance;
  r.negative = eq_.negative_eigenvalues(1e-5 * (10.0 + 0.25 * eq_.lambda * eq_.lambda));
  return r;
}

std::string Reach::words(double length_unit) const {
  if (inclination < least_inclination)
    return "the rod turns away from the axis: d3·D3 = " + digits(inclination) +
           " at S = " + digits(inclination_S * length_unit);
  return "the rod comes to the axis' centre of curvature: 1 - K·Δ = " + digits(spread) +
         " at S = " + digits(spread_S * length_unit);
}

formulation::Vector6 evaluate(const DiscreteState& state, double S) {
  const auto it = std::upper_bound(state.S.begin(), state.S.end(), S);
  const auto k = std::clamp<std::ptrdiff_t>(it - state.S.begin() - 1, 0, std::ssize(state.S) - 2);
  const double h = state.S[k + 1] - state.S[k];
  const auto shape = hermite((S - state.S[k]) / h, h);
  const Vector4 &a = state.u[k], &b = state.u[k + 1];
  formulation::Vector6 x;
  x.head<3>() = shape * Vector4(a[0], a[1], b[0], b[1]);
  x.tail<3>() = shape * Vector4(a[2], a[3], b[2], b[3]);
  return x;
}

namespace {

/// Nodes of a state, every element cut to the given share of the bending length there: of a rod under its axial force,
/// or pressed on the wall.
std::vector<double> finer_nodes(const DiscoveryProblem& problem, const DiscreteState& state, double share) {
  const DiscreteRod rod(problem.tube, problem.data, state.S);
  std::vector<double> nodes{state.S.front()};
  for (std::size_t e = 0; e + 1 < state.S.size(); ++e) {
    const double h = state.S[e + 1] - state.S[e];
    double length = h / share;
    for (int k = 0; k < DiscreteRod::points_per_element; ++k) {
      const auto& q = rod.points()[DiscreteRod::points_per_element * e + k];
      const auto d = formulation::density_invariants(q.section, rod.at(q, state.u));
      const double F = axial_force(state.lambda - d.y - 0.5 * d.t2, problem.data.eta2);
      const double load = q.section.force.norm() + std::abs(F) * q.section.U.head<2>().norm();
      length = std::min(
          {length, 1.0 / std::sqrt(std::max(std::abs(F), 1e-9)), std::pow(q.clearance / std::max(load, 1e-9), 0.25)});
    }
    const int parts = static_cast<int>(std::ceil(h / (share * length) - 1e-9));
    for (int i = 1; i <= parts; ++i) nodes.push_back(state.S[e] + h * i / parts);
  }
  return nodes;
}

DiscoveryResult refine(const DiscoveryProblem& problem, DiscoveryOptions options) {
  const DiscreteState& state = options.coarse->state;
  std::vector<double> nodes = finer_nodes(problem, state, options.fineness);
  Scales s = scales_of(problem, options);
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) s.size = std::min(s.size, nodes[i + 1] - nodes[i]);
  options.initial = &state;
  options.perturb = options.leave;
  options.march_length = false;
  DiscreteRod rod(problem.tube, problem.data, std::move(nodes));
  return Search(problem, options, s, std::move(rod)).run();
}

}  // namespace

DiscoveryResult discover(const DiscoveryProblem& problem, const DiscoveryOptions& options) {
  if (options.coarse != nullptr) return refine(problem, options);
  const Scales s = scales_of(problem, options);
  const double L = problem.tube.length();
  std::vector<double> knots;
  for (const double k : problem.tube.axis->knots()) knots.push_back(k / L);
  for (const double k : problem.tube.clearance->knots()) knots.push_back(k / L);
  std::sort(knots.begin(), knots.end());
  std::vector<double> required;
  const auto require = [&](double S) {
    if (S > 1e-6 && S < problem.end_position - 1e-6) required.push_back(S);
  };
  for (const auto& x : problem.data.collars) {
    require(x.from);
    require(x.to);
  }
  for (const auto& x : problem.data.loads) require(x.S);
  for (const double S : problem.data.breaks) require(S);
  std::sort(required.begin(), required.end());
  required.erase(std::unique(required.begin(), required.end(), [](double a, double b) { return b - a < 1e-6; }),
                 required.end());
  DiscreteRod rod(problem.tube, problem.data, discrete_rod_nodes(problem.end_position, s.size, knots, required));
  return Search(problem, options, s, std::move(rod)).run();
}

}  // namespace tendril::segmentation
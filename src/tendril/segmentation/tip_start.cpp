#include "tendril/segmentation/tip_start.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tendril::segmentation {

void place_tip(const ScaledProblem& P, DiscoveryOptions options, DiscoveryProblem& problem) {
  const double wanted = P.now(P.axial);
  std::optional<double> low, high;  // places with too short and too long a rod
  double best = problem.end_position, least = HUGE_VAL;
  DiscreteState last;
  for (int k = 0; k < 8; ++k) {
    const DiscoveryResult found = discover(problem, options);
    if (found.converged) {
      const double off = wanted - found.state.length;
      if (std::abs(off) < least) {
        least = std::abs(off);
        best = problem.end_position;
      }
      if (least < 1e-4 * wanted) break;
      (off > 0.0 ? low : high) = problem.end_position;
      // a place further on takes about as much more rod, unless a step between the two is known to take too much
      double next = std::clamp(problem.end_position + off, 0.5 * problem.end_position, 1.0);
      if (low && high && !(next > std::min(*low, *high) && next < std::max(*low, *high))) next = 0.5 * (*low + *high);
      if (next == problem.end_position) break;
      problem.end_position = next;
      last = found.state;
      options.initial = &last;
    } else {
      problem.end_position *= k % 2 == 0 ? 1.01 : 0.985;
      problem.end_position = std::min(problem.end_position, 1.0);
    }
  }
  problem.end_position = best;
}

SwitcherSummary solve_by_place(Chain& chain, const SwitcherOptions& options) {
  const auto mechanics = chain.mechanics_ptr();
  const ScaledProblem& P = mechanics->problem;
  const double p = chain.parameter(), wanted = P.now(P.axial);
  const Closure here{Closure::Kind::parameter, 0, p};
  ScaledProblem held = P;
  held.source.axial = AxialControl::axial_force;
  held.source.axial_at = Which::end;
  held.axial = {0.0, 0.0};
  held.end_position = {chain.S(chain.segments()), 0.0};
  Chain at = chain;
  at.rebind(std::make_shared<Mechanics>(held));
  SwitcherSummary sum = switch_contact_pattern(at, here, options);
  if (!sum.converged) return sum;
  const auto length_of = [](const Chain& c) {
    double u[formulation::state_inputs], start, s;
    c.sample(c.S(0), u, &start);
    c.sample(c.S(c.segments()), u, &s);
    return s - start;
  };
  double length = length_of(at), step = wanted - length;
  for (int tries = 0; tries < 60 && length != wanted; ++tries) {
    const double next = std::abs(wanted - length) <= std::abs(step) * (1.0 + 1e-9) ? wanted : length + step;
    ScaledProblem given = P;
    given.axial = {next, 0.0};
    Chain c = at;
    c.rebind(std::make_shared<Mechanics>(given));
    const SwitcherSummary s = switch_contact_pattern(c, here, options);
    sum.newton_iterations += s.newton_iterations;
    sum.factorisations += s.factorisations;
    sum.patterns_tried += s.patterns_tried;
    if (s.converged) {
      at = std::move(c);
      length = next;
      continue;
    }
    step *= 0.3;
    if (std::abs(step) < 1e-6 * wanted) {
      sum.converged = false;
      sum.reason = "the rod could not be brought to its length: " + s.reason;
      return sum;
    }
  }
  at.rebind(mechanics);
  chain = std::move(at);
  sum.converged = length == wanted;
  return sum;
}

}  // namespace tendril::segmentation

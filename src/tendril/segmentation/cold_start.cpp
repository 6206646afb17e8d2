#include "tendril/segmentation/cold_start.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "tendril/segmentation/discovery_sections.hpp"
#include "tendril/segmentation/pattern_edit.hpp"
#include "tendril/segmentation/pattern_windows.hpp"
#include "tendril/segmentation/ramp.hpp"
#include "tendril/segmentation/seeding.hpp"
#include "tendril/segmentation/tip.hpp"
#include "tendril/segmentation/tip_start.hpp"

namespace tendril::segmentation {

using formulation::FreeRod;

namespace {

/// Straight guess on the line between the end eccentricities (the axis itself when both are zero).
void plain_guess(const ScaledProblem& P, double S, double* u, double* s) {
  std::fill_n(u, FreeRod::inputs, 0.0);
  const double end = P.tip_place_free() ? std::min(1.0, P.now(P.axial)) : P.now(P.end_position), x = S / end;
  for (int c = 0; c < 2; ++c) {
    const double a = P.now(P.start.eccentricity[c]), b = P.now(P.end.eccentricity[c]);
    const double sa = end * P.now(P.start.slope[c]), sb = end * P.now(P.end.slope[c]);
    const double c2 = 3 * (b - a) - 2 * sa - sb, c3 = -2 * (b - a) + sa + sb;
    u[4 * c] = a + x * (sa + x * (c2 + x * c3));
    u[4 * c + 1] = (sa + x * (2 * c2 + x * 3 * c3)) / end;
    u[4 * c + 2] = (2 * c2 + x * 6 * c3) / (end * end);
    u[4 * c + 3] = 6 * c3 / (end * end * end);
  }
  u[15] = P.source.axial == AxialControl::axial_force ? P.now(P.axial)
          : P.source.axial == AxialControl::push      ? -P.now(P.axial)
                                                      : 0.0;
  *s = S;
  if (P.source.axial == AxialControl::rod_length) *s = S * P.now(P.axial) / end;
}

constexpr std::size_t many_contacts = 8;

void add(SwitcherSummary& to, const SwitcherSummary& from) {
  to.newton_iterations += from.newton_iterations;
  to.factorisations += from.factorisations;
  to.patterns_tried += from.patterns_tried;
  to.nested_solves += from.nested_solves;
  to.nested_fallbacks += from.nested_fallbacks;
}

}  // namespace

DiscreteState discrete_state(const Chain& chain) {
  DiscreteState out;
  double u[formulation::state_inputs], s, start;
  chain.sample(chain.S(0), u, &start);
  const auto add_node = [&](double S) {
    chain.sample(S, u, &s);
    out.S.push_back(S);
    out.u.emplace_back(u[0], u[1], u[4], u[5]);
  };
  for (int j = 0; j < chain.segments(); ++j) {
    const auto& seg = chain.segment(j);
    constexpr int parts = 3;
    for (int i = 0; i < parts * seg.pieces(); ++i) {
      const double a = seg.place(i / parts, chain.S(j), chain.S(j + 1)),
                   b = seg.place(i / parts + 1, chain.S(j), chain.S(j + 1));
      add_node(a + (b - a) * (i % parts) / parts);
    }
  }
  add_node(chain.S(chain.segments()));
  out.length = s - start;
  return out;
}

namespace {

/// The searches one after the other, each from the least energy to the sharp pattern.
ColdStart search(const std::shared_ptr<Mechanics>& mechanics, const SolveOptions& solve, const SwitcherOptions& given,
                 const std::function<bool(const Chain&)>& accept, const DiscreteState* from) {
  ColdStart out;
  const ScaledProblem& P = mechanics->problem;
  const Closure here{Closure::Kind::parameter, 0, P.p};
  const numerics::Stop& stop = given.newton.stop;
  auto pieces_for = [&](std::size_t nodes) { return std::clamp(static_cast<int>(nodes) / 4, 8, 4000); };
  auto attempt = [&](Chain chain, const std::string& how, int most_patterns) {
    SwitcherOptions options = given;
    options.max_patterns = std::min(most_patterns, given.max_patterns);
    options.guess = true;
    const bool in_windows = chain.segments() >= long_chain && !options.nested;
    const Chain guess = P.tip_place_free() ? chain : Chain();
    SwitcherSummary s =
        in_windows ? switch_in_windows(chain, options, true) : switch_contact_pattern(chain, here, options);
    add(out.effort, s);
    if (!s.converged && P.tip_place_free()) {
      chain = guess;
      s = solve_by_place(chain, options);
      add(out.effort, s);
    }
    if (!s.converged) {
      out.reason = s.reason;
      return false;
    }
    if (chain.S(chain.segments()) > 1.0 + 1e-9) {
      out.reason = "the tip lies beyond the end of the axis";
      return false;
    }
    if (guide_fault(chain) > 1e-9) {  // rounding of the row that holds the slope is far below
      out.reason = "a line of contact reaches the guided end, where the wall does not run along the axis";
      return false;
    }
    const bool good = !accept || accept(chain);
    if (good || !out.converged) {
      out.converged = true;
      out.chain = std::move(chain);
      out.branch = how;
    }
    return good;
  };

  if (!from && (solve.branch == BranchRule::symmetric || solve.branch == BranchRule::nearest)) {
    Chain c(mechanics, solve.collocation_points);
    c.set_parameter(P.p);
    if (P.tip_place_free()) c.set_tip_place(std::min(1.0, P.now(P.axial)));
    c.build({{0}, {}}, 10, [&](double S, double* u, double* s) { plain_guess(P, S, u, s); });
    if (attempt(c, "reached from the axis without perturbation", 60)) return out;
  }
  DiscoveryOptions d;
  d.perturb = solve.branch != BranchRule::symmetric;
  d.planar = solve.branch == BranchRule::planar;
  d.stop = stop;
  d.initial = from;
  DiscoveryProblem problem = discovery_problem(P);
  if (P.tip_place_free()) place_tip(P, d, problem);
  std::string why, folded;
  bool upright = false;  // a least-energy state within the formulation's reach was found
  enum class Search { direct, march, ease };
  struct Round {
    Search search;
    int refinement;
  };
  int elements = 0;
  for (const Round& round : {Round{Search::direct, 1}, Round{Search::march, 1}, Round{Search::ease, 1},
                             Round{Search::direct, 2}, Round{Search::march, 2}}) {
    if (stop.asked()) break;
    if (from != nullptr && (round.refinement > 1 || round.search != Search::direct)) break;
    d.march_length = round.search == Search::march;
    d.ease = round.search == Search::ease;
    d.elements = round.refinement > 1 ? round.refinement * elements : 0;
    if (d.march_length && problem.axial == AxialControl::rod_length) continue;  // marched anyway
    if (round.refinement > 1 && !upright && !folded.empty()) continue;          // nothing there to be seen better
    DiscoveryProblem laid = problem;
    const DiscoveryResult coarse = discover_sections(P.law, laid, d);
    if (coarse.state.S.size() > 1 && elements == 0) elements = static_cast<int>(coarse.state.S.size());
    if (!coarse.reach.within()) {
      if (folded.empty() || coarse.converged)
        folded = coarse.converged ? "in the least-energy state, " + coarse.reach.words(P.L) : coarse.message;
      out.reach = coarse.reach;
      if (!coarse.converged || coarse.reach.inclination < 0.1 || coarse.reach.spread < 0.05) continue;
    }
    if (coarse.converged)
      upright = upright || coarse.reach.within();
    else
      why = coarse.message;
    if (coarse.state.S.size() < 2) continue;
    // Many contacts are worth finding well before the sharp solve, few only where the coarse state is no start. A poor
    // start asks for many changes of the pattern: a finer state is the cheaper way then.
    struct Trial {
      double fineness;
      int patterns;
    };
    constexpr std::array<Trial, 4> few{{{0.0, 8}, {0.25, 12}, {0.1, 24}, {0.05, 60}}};
    constexpr std::array<Trial, 4> many{{{0.25, 60}, {0.1, 60}, {0.0, 60}, {0.05, 60}}};
    int unaccepted = 0;
    const bool few_contacts = !coarse.converged || coarse.contacts.size() < many_contacts;
    for (const Trial& trial : few_contacts ? few : many) {
      if (stop.asked()) break;
      DiscoveryResult finer;
      if (trial.fineness > 0.0) {
        if (!coarse.converged) break;
        DiscoveryOptions o = d;
        o.elements = 0;
        o.initial = nullptr;
        o.coarse = &coarse;
        o.leave = d.perturb && out.converged;
        o.fineness = trial.fineness;
        finer = discover(laid, o);
        if (!finer.converged) continue;
      }
      const DiscoveryResult& found = trial.fineness > 0.0 ? finer : coarse;
      const Chain c = sharp_start(mechanics, found, solve.collocation_points,
                                  pieces_for(few_contacts ? found.state.S.size() : coarse.state.S.size()));
      if (attempt(c,
                  d.ease           ? "least energy released from the axis, then the sharp pattern"
                  : d.march_length ? "least energy along growing length, then the sharp pattern"
                                   : "least energy, then the sharp pattern",
                  trial.patterns))
        return out;
      if (out.converged && unaccepted++ > 1) break;  // another state is wanted
    }
  }
  if (!out.converged) {
    if (stop.asked()) {
      out.reason = stop.reason();
      return out;
    }
    if (!upright && !folded.empty()) {
      out.outside_validity = true;
      out.reason = folded;
      return out;
    }
    std::string tried =
        "tried the least-energy state at two resolutions, directly, along growing length and released from the axis";
    if (!why.empty()) tried += " (" + why + ")";
    out.reason = tried + (out.reason.empty() ? "" : "; the sharp pattern: " + out.reason);
  }
  return out;
}

}  // namespace

ColdStart cold_start(const std::shared_ptr<Mechanics>& mechanics, const SolveOptions& solve,
                     const SwitcherOptions& given, const std::function<bool(const Chain&)>& accept,
                     const DiscreteState* from) {
  ColdStart out = search(mechanics, solve, given, accept, from);
  const ScaledProblem& P = mechanics->problem;
  const bool any = solve.branch == BranchRule::stable || solve.branch == BranchRule::nearest;
  if (out.converged || out.outside_validity || from != nullptr || !any || P.tip_place_free()) return out;
  for (const Ramp& ramp : ramps(P)) {
    if (given.newton.stop.asked()) break;
    const auto easy = std::make_shared<Mechanics>(ramp.at(0.0), P.p);
    ColdStart start = search(easy, solve, given, accept, nullptr);
    add(out.effort, start.effort);
    if (!start.converged) continue;
    const auto downhill = [&](const std::shared_ptr<Mechanics>& there, Chain& chain) {
      const DiscreteState here = discrete_state(chain);
      ColdStart next = search(there, solve, given, accept, &here);
      add(out.effort, next.effort);
      if (next.converged) chain = std::move(next.chain);
      return next.converged;
    };
    Chain chain = start.chain;
    const SwitcherSummary s = follow_ramp(ramp, chain, mechanics, given, downhill);
    add(out.effort, s);
    if (!s.converged) continue;
    const bool good = !accept || accept(chain);
    if (good || !out.converged) {
      out.converged = true;
      out.chain = std::move(chain);
      out.branch = start.branch + ", then led on from " + ramp.from;
    }
    if (good) break;
  }
  if (out.converged) return out;
  if (given.newton.stop.asked())
    out.reason = given.newton.stop.reason();
  else
    out.reason += "; nor could an easier problem be led to it";
  return out;
}

}  // namespace tendril::segmentation

#pragma once
// Seeded insertions: a rod with a free tip fed into a random tube in equal steps, and the state at the end found from
// nothing as well. L about 1, B = 1.
//   axes        random smooth space curves, total bend up to three turns, largest clearance times curvature at most 0.5
//   clearance   as in the campaign
//   rods        uniform, or with a tip that tapers to between 1/3 and 1/100 of the stiffness; some heavy, up to 20 B/L³
//   motion      from a tenth of the axis' length to 85 % of it

#include <ctime>

#include "support/campaign.hpp"
#include "tendril/continuation/session.hpp"

namespace tendril::test {

struct InsertionDraw {
  Problem problem;
  double from = 0, to = 0;
  std::string words;
};

inline InsertionDraw insertion_draw(std::uint64_t seed) {
  Dice dice(seed + 7000000);
  for (;;) {
    InsertionDraw d;
    std::ostringstream words;
    words.precision(3);
    words << "seed " << seed << ": ";
    Problem& p = d.problem;
    const double bend = dice.between(0.1, 6 * pi);
    words << "bend " << bend;
    p.tube.axis = campaign::smooth_axis(dice, bend);
    const double L = p.tube.length();
    p.tube.clearance = campaign::draw_clearance(dice, L, words);
    const bool tapers = dice.chance(0.4), heavy = dice.chance(0.3);
    const double softest = std::pow(10.0, dice.between(-2, -0.5)), taper = dice.between(0.05, 0.3);
    const double weight = dice.between(0, 20);
    const Vector3d down = dice.direction();
    try {
      if (geometry::check_tube(p.tube).curvature_clearance_max > 0.5) continue;
    } catch (const geometry::GeometryError&) {
      continue;
    }
    p.rod = {1.0, 0.75, {}};
    if (tapers) {
      rod::SectionEntry tip;
      tip.from = -taper * L;
      tip.between = rod::SectionEntry::Between::linear;
      tip.rod[0] = p.rod;
      tip.rod[1] = {softest, 0.75 * softest, {}};
      tip.weight[0] = tip.weight[1] = heavy ? weight : 0.0;
      p.law = rod::section_law(p.rod, heavy ? weight : 0.0, std::vector<rod::SectionEntry>{tip}, true);
      words << ", tip of " << taper << " tapers to " << softest;
    }
    if (heavy) {
      if (tapers)
        p.load.weight_direction = down;
      else
        p.load.force = weight * down;
      words << ", weight " << weight;
    }
    p.end.kind = End::Kind::free;
    p.axial = segmentation::AxialControl::rod_length;
    d.from = 0.1 * L;
    d.to = 0.85 * L;
    p.axial_value = d.from;
    d.words = words.str();
    return d;
  }
}

struct InsertionOutcome {
  enum class End { equal, other_branch, differ, lost, no_start, no_cold } end = End::lost;
  std::string words, reason;
  int steps = 0, lost = 0, jumps = 0, contacts = 0;
  std::size_t events = 0;
  std::vector<double> ms;  // of the processor, step by step
  double worst() const { return ms.empty() ? 0.0 : *std::max_element(ms.begin(), ms.end()); }
};

/// The same contacts where the same forces act.
inline bool same_contacts(const continuation::Step& a, const continuation::Step& b, double L) {
  if (a.contacts.size() != b.contacts.size()) return false;
  double most = 1.0;
  for (const auto& c : a.contacts) most = std::max(most, c.force);
  for (std::size_t i = 0; i < a.contacts.size(); ++i) {
    const auto &x = a.contacts[i], &y = b.contacts[i];
    // places are as sharp as the root of the tolerance where curvatures are equal on both sides
    if (x.line != y.line || std::abs(x.start - y.start) > 1e-5 * L || std::abs(x.end - y.end) > 1e-5 * L ||
        std::abs(x.force - y.force) > 1e-5 * most)
      return false;
  }
  return true;
}

inline InsertionOutcome run_insertion(std::uint64_t seed, int steps) {
  using continuation::Session;
  const auto now = [] { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  InsertionDraw d = insertion_draw(seed);
  InsertionOutcome o;
  o.words = d.words;
  continuation::StudyOptions options;
  Session session(d.problem, options);
  if (!session.ready()) {
    o.end = InsertionOutcome::End::no_start;
    o.reason = session.reason();
    return o;
  }
  for (int i = 1; i <= steps; ++i) {
    const double begun = now();
    const auto motion = session.advance(d.from + (d.to - d.from) * i / steps - session.fed());
    o.ms.push_back(now() - begun);
    o.jumps += motion.jumped;
    o.steps = i;
    if (motion.reached) continue;
    o.lost = steps - i + 1;
    o.reason = motion.reason;
    break;
  }
  o.events = session.events().size();
  const auto there = session.state();
  o.contacts = static_cast<int>(there.contacts.size());
  if (o.lost > 0) return o;
  const bool good = there.status == continuation::Status::converged;
  if (!good) o.reason = there.message;
  d.problem.axial_value = session.fed();
  const auto cold = continuation::solve(d.problem, options).steps.at(0);
  if (cold.status != continuation::Status::converged) {
    o.end = InsertionOutcome::End::no_cold;
    o.reason = "cold start: " + cold.message;
  } else if (good && same_contacts(there, cold, d.problem.tube.length())) {
    o.end = InsertionOutcome::End::equal;
  } else if (good) {
    o.end = there.branch != cold.branch ? InsertionOutcome::End::other_branch : InsertionOutcome::End::differ;
  } else {
    o.end = InsertionOutcome::End::differ;
  }
  return o;
}

}  // namespace tendril::test

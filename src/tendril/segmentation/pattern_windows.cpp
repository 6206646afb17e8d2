#include "tendril/segmentation/pattern_windows.hpp"

#include <algorithm>

#include "tendril/segmentation/windows.hpp"

namespace tendril::segmentation {

namespace {

void add(SwitcherSummary& to, const SwitcherSummary& from) {
  to.newton_iterations += from.newton_iterations;
  to.factorisations += from.factorisations;
  to.patterns_tried += from.patterns_tried;
}

void add(SwitcherSummary& to, const NewtonSummary& from) {
  to.newton_iterations += from.iterations;
  to.factorisations += from.factorisations;
}

/// One window, switched; wider where it fails.
bool settle(const Chain& whole, Window& w, Chain& part, SwitcherOptions options, SwitcherSummary& sum) {
  for (int attempt = 0; attempt < 2; ++attempt) {
    part = cut(whole, w.first, w.last);
    options.from = 0.5 * (w.first + w.from);
    options.to = 0.5 * (w.last + w.to);
    const SwitcherSummary s = switch_contact_pattern(part, {Closure::Kind::parameter, 0, whole.parameter()}, options);
    add(sum, s);
    if (s.converged) return true;
    sum.reason = s.reason;
    const auto wider = around(whole, {w.first, w.last}, 6.0, 4.0);
    w.first = wider.front().first;
    w.last = wider.back().last;
  }
  return false;
}

/// All windows; those that fail keep the state of the whole.
int settle_all(Chain& chain, std::vector<Window> windows, const SwitcherOptions& options, SwitcherSummary& sum) {
  std::vector<Window> done;
  std::vector<Chain> parts;
  int failed = 0;
  for (Window& w : windows) {
    Chain part;
    if (settle(chain, w, part, options, sum)) {
      done.push_back(w);
      parts.push_back(std::move(part));
    } else {
      ++failed;
    }
  }
  chain = splice(chain, done, parts);
  return failed;
}

}  // namespace

SwitcherSummary switch_in_windows(Chain& chain, const SwitcherOptions& options, bool guess) {
  constexpr int rounds = 12;
  SwitcherSummary sum;
  SwitcherOptions inner = options;
  inner.windows = false;
  inner.max_patterns = 24;
  const Closure here{Closure::Kind::parameter, 0, chain.parameter()};
  inner.guess = guess;
  if (guess) settle_all(chain, tile(chain, 16.0, 8.0), inner, sum);
  inner.guess = false;
  for (int round = 0; round < rounds; ++round) {
    const NewtonSummary s = chain.solve_adaptive(here, options.newton, options.accuracy);
    add(sum, s);
    ++sum.patterns_tried;
    if (options.observer) options.observer(chain, s);
    if (!s.converged) {
      sum.reason = s.reason;
      return sum;
    }
    const auto bad = violations(chain, margins(chain), options.tolerance);
    if (bad.empty()) {
      sum.converged = true;
      sum.reason.clear();
      return sum;
    }
    std::vector<double> places;
    for (const Margin& m : bad) places.push_back(m.S);
    settle_all(chain, around(chain, places, 6.0 + 2.0 * round, 8.0), inner, sum);
  }
  sum.reason = "the contact pattern did not settle within the allowed number of changes";
  return sum;
}

}  // namespace tendril::segmentation

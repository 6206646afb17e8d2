#include "tendril/continuation/study_detail.hpp"

#include <algorithm>
#include <cstdio>

#include "tendril/continuation/formulations.hpp"
#include "tendril/continuation/report_state.hpp"
#include "tendril/continuation/self_contact.hpp"

namespace tendril::continuation {

using segmentation::Chain;

namespace {

std::string scientific(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2e", value);
  return text;
}

/// What forbids calling a state converged; empty when the certificate holds.
std::string broken_certificate(const Certificate& c, double tolerance) {
  const double t = std::max(tolerance, 1e-11);
  auto fail = [](const char* what, double value) { return std::string(what) + " " + scientific(value); };
  if (!(c.error <= t)) return "estimated error above the tolerance";
  if (!(c.gap_min >= -10.0 * t)) return fail("penetration of the wall, relative gap", c.gap_min);
  if (!(c.reaction_min >= -10.0 * t)) return fail("tensile reaction, relative", c.reaction_min);
  if (!(c.continuity <= 10.0 * t)) return "forces or moments jump at a junction";
  if (!(c.balance <= 10.0 * t)) return "the whole rod is not in balance with its reactions";
  if (!(c.invariant_spread <= 10.0 * t))
    return fail("first integrals vary along the rod, relative spread", c.invariant_spread);
  // the equations hold the highest derivatives, which converge with three orders less than the fields
  if (!(c.equilibrium <= 100.0 * t))
    return fail("the equations do not hold between nodes, scaled residual", c.equilibrium);
  return "";
}

}  // namespace

segmentation::SwitcherOptions switcher_options(const segmentation::SolveOptions& s) {
  segmentation::SwitcherOptions o;
  o.accuracy = 0.2 * s.tolerance;  // first integrals add up errors of several fields
  o.newton.residual_line_search = s.residual_line_search;
  o.nested = s.nested;
  o.newton.tolerance = std::clamp(1e-3 * s.tolerance, 1e-13, 1e-9);
  const double tighten = std::min(1.0, s.tolerance / 1e-8);
  o.tolerance.gap *= tighten;
  o.tolerance.reaction *= tighten;
  o.tolerance.pressure *= tighten;
  return o;
}

Step judged_step(Chain& chain, const StudyOptions& options, const segmentation::SwitcherOptions& switcher,
                 const std::string& how, std::optional<double> parameter) {
  // several fields add up in a first integral: where it spreads beyond the tolerance the mesh is refined
  double accuracy = switcher.accuracy;
  segmentation::NewtonOptions newton = switcher.newton;
  newton.stop = {};  // the last good state of what was stopped is still certified
  for (int round = 0; round < 3; ++round, accuracy *= 0.1) {
    const auto c = segmentation::certify(chain);
    if (c.invariant_spread <= options.solve.tolerance && c.balance <= options.solve.tolerance) break;
    Chain finer = chain;
    if (!finer.solve_adaptive({segmentation::Closure::Kind::parameter, 0, chain.parameter()}, newton, 0.1 * accuracy)
             .converged)
      break;
    chain = finer;
  }
  Step s = describe(chain, options.fields ? options.field_points : 0);
  s.parameter = parameter;
  const auto verdict = judge_stability(chain);
  s.stability = verdict.word;
  s.branch = how + "; " + verdict.why;
  if (s.stability == "unstable" && options.solve.branch == segmentation::BranchRule::stable)
    s.branch += "; no stable state was found";
  const std::string broken = broken_certificate(s.certificate, options.solve.tolerance);
  s.status = broken.empty() ? Status::converged : Status::not_converged;
  s.message = broken;
  if (s.message.empty()) s.message = self_contact_warning(chain, chain.mechanics().problem.source.rod_diameter);
  if (options.solve.formulation == segmentation::Formulation::lagrangian)
    report_lagrangian(chain, options.solve.tolerance, options.fields ? options.field_points : 0, s);
  return s;
}

void judge_approximation(Step& s, double tolerance) {
  if (s.status != Status::converged) return;
  const std::string broken = broken_certificate(s.certificate, tolerance);
  if (broken.empty()) return;
  s.status = Status::outside_validity;
  s.message = "a first-order approximation, not a state of the exact equations: " + broken;
  if (!s.comparison) return;
  char text[96];
  std::snprintf(text, sizeof text, "; it is %.2g lengths from the exact state with the same contacts",
                s.comparison->place);
  s.message += text;
}

}  // namespace tendril::continuation

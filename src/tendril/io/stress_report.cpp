#include "tendril/io/stress_report.hpp"

#include <algorithm>
#include <memory>

#include "tendril/continuation/report_state.hpp"
#include "tendril/segmentation/chain.hpp"

namespace tendril::io {

std::optional<StressReport> stress_report(const Case& c, const continuation::Step& step) {
  if (!c.has("rod.young_modulus") || c.has("rod.section") || step.state.empty()) return std::nullopt;
  const double p = step.parameter.value_or(0.0);
  const segmentation::Problem problem = step.parameter ? build_problem(c, p) : build_problem(c);
  segmentation::Chain chain;
  if (!chain.restore(step.state, std::make_shared<segmentation::Mechanics>(problem, p))) return std::nullopt;
  const continuation::Fields f = continuation::describe(chain, 4001).fields;
  rod::CircularSection section{c.number("rod.diameter"), 0.0};
  if (!c.has("rod.diameter")) section = {c.number("rod.outer_diameter"), c.number("rod.inner_diameter")};
  // EI = E I and GJ = G 2I: Poisson's ratio from the stiffnesses, however it was given.
  const rod::Elasticity material{c.number("rod.young_modulus"),
                                 problem.rod.bending_stiffness / problem.rod.torsional_stiffness - 1};
  StressReport report;
  double strain = 0.0;
  for (std::size_t i = 0; i < f.S.size(); ++i) {
    const rod::SectionStress s = rod::section_stress(section, material, {f.F3[i], f.M1[i], f.M2[i], f.M3[i]});
    strain = std::max(strain, s.strain);
    if (i == 0 || s.von_mises > report.section.von_mises) report = {f.S[i], s};
  }
  report.section.strain = strain;
  return report;
}

}  // namespace tendril::io

#include "tendril/segmentation/ramp.hpp"

#include <algorithm>
#include <cmath>

namespace tendril::segmentation {

namespace {

/// The problem as it is at its present parameter, nothing moving.
Problem still(const ScaledProblem& P) {
  Problem p = P.source;
  const auto set = [&](Scalar& to, const Scalar& scaled, double unit) { to = {P.now(scaled) * unit, 0.0}; };
  for (const auto& [to, from] : {std::pair{&p.start, &P.start}, std::pair{&p.end, &P.end}}) {
    for (int i = 0; i < 2; ++i) {
      set(to->eccentricity[i], from->eccentricity[i], P.L);
      set(to->slope[i], from->slope[i], 1.0);
    }
    set(to->roll, from->roll, 1.0);
  }
  for (Scalar* s : {&p.clearance_scale, &p.body_force_scale, &p.body_couple_scale}) *s = {P.now(*s), 0.0};
  set(p.end_position, P.end_position, P.L);
  set(p.axial_value, P.axial, p.axial == AxialControl::rod_length ? P.L : P.force_unit());
  set(p.twist_value, P.twist, p.twist == TwistControl::torque ? P.moment_unit() : 1.0);
  return p;
}

/// The law with every property led from its mean along the rod to its own course.
rod::SectionLaw evened(const rod::SectionLaw& law, double length, double t) {
  constexpr int samples = 200;
  double B = 0.0, C = 0.0, A = 0.0, w = 0.0;
  for (int i = 0; i < samples; ++i) {
    const auto p = law.at(length * ((i + 0.5) / samples - (law.from_end ? 1.0 : 0.0)));
    B += std::log(p.B) / samples;
    C += std::log(p.C) / samples;
    A += p.e > 0.0 ? std::log(1.0 / p.e) / samples : 0.0;
    w += p.weight / samples;
  }
  rod::SectionLaw out = law;
  const auto lead = [t](rod::SectionPiece::Polynomial& c, double mean) {
    for (double& x : c) x *= t;
    c[0] += (1.0 - t) * mean;
  };
  for (rod::SectionPiece& p : out.pieces) {
    lead(p.bending, std::exp(B));
    lead(p.torsion, std::exp(C));
    if (!p.inextensible) lead(p.axial, std::exp(A));
    lead(p.weight, w);
    for (auto& k : p.curvature) lead(k, 0.0);
  }
  return out;
}

}  // namespace

std::vector<Ramp> ramps(const ScaledProblem& P) {
  std::vector<Ramp> out;
  const Problem p = still(P);
  const double length = p.axial == AxialControl::rod_length ? p.axial_value.value : p.tube.length();
  if (P.varies())
    out.push_back({"an even section", [p, length](double t) {
                     Problem q = p;
                     if (t < 1.0) q.law = evened(p.law, length, t);
                     return q;
                   }});
  const bool inside = p.tube.side == geometry::Side::inside;
  const bool by_length = p.axial == AxialControl::rod_length;
  if (!by_length)
    out.push_back({"a small load", [p](double t) {
                     Problem q = p;
                     q.axial_value.value *= t;
                     q.twist_value.value *= t;
                     q.body_force_scale.value *= t;
                     q.body_couple_scale.value *= t;
                     return q;
                   }});
  else
    out.push_back({"no weight and no torque", [p](double t) {
                     Problem q = p;
                     q.twist_value.value *= t;
                     q.body_force_scale.value *= t;
                     q.body_couple_scale.value *= t;
                     return q;
                   }});
  const bool off_axis = std::any_of(std::begin(P.start.eccentricity), std::end(P.start.eccentricity),
                                    [](const Scalar& s) { return s.value != 0.0; }) ||
                        std::any_of(std::begin(P.end.eccentricity), std::end(P.end.eccentricity),
                                    [](const Scalar& s) { return s.value != 0.0; });
  if (inside && !off_axis && !by_length)
    out.push_back({"a narrower tube", [p](double t) {
                     Problem q = p;
                     q.clearance_scale.value *= 0.3 + 0.7 * t;
                     return q;
                   }});
  return out;
}

SwitcherSummary follow_ramp(const Ramp& ramp, Chain& chain, const std::shared_ptr<Mechanics>& mechanics,
                            const SwitcherOptions& given,
                            const std::function<bool(const std::shared_ptr<Mechanics>&, Chain&)>& downhill) {
  constexpr double first = 0.1, least = 2e-4;
  constexpr int most_steps = 400, most_jumps = 12;
  SwitcherSummary sum;
  SwitcherOptions options = given;
  options.max_patterns = std::min(given.max_patterns, 24);
  const double p = mechanics->problem.p;
  double at = 0.0, step = first;
  int jumps = 0;
  for (int k = 0; k < most_steps && at < 1.0; ++k) {
    if (options.newton.stop.asked()) {
      sum.reason = options.newton.stop.reason();
      return sum;
    }
    const double next = std::min(1.0, at + step);
    const auto there = next < 1.0 ? std::make_shared<Mechanics>(ramp.at(next), p) : mechanics;
    Chain c = chain;
    c.rebind(there);
    const SwitcherSummary s = switch_contact_pattern(c, {Closure::Kind::parameter, 0, p}, options);
    sum.newton_iterations += s.newton_iterations;
    sum.factorisations += s.factorisations;
    sum.patterns_tried += s.patterns_tried;
    if (s.converged) {
      chain = std::move(c);
      at = next;
      step *= 1.6;
      continue;
    }
    step *= 0.4;
    if (step > least) continue;
    // the state ends here: the next one downhill, a little further on
    const double beyond = std::min(1.0, at + 0.02);
    const auto farther = beyond < 1.0 ? std::make_shared<Mechanics>(ramp.at(beyond), p) : mechanics;
    Chain other = chain;
    if (++jumps > most_jumps || !downhill(farther, other)) {
      sum.reason = s.reason;
      return sum;
    }
    chain = std::move(other);
    at = beyond;
    step = 0.02;
  }
  sum.converged = at >= 1.0;
  return sum;
}

}  // namespace tendril::segmentation

#pragma once
// The judge of the campaign: what a solved state is worth by an evaluation that shares no equation with the solver
// (support/cosserat.hpp): Lagrangian equations along free segments and lines, end conditions, gap between nodes, jumps
// at the contacts with their signs, pressure, vector balance. All figures relative; nothing is taken from the
// certificate.

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <tuple>

#include "support/campaign.hpp"
#include "support/cosserat.hpp"
#include "tendril/continuation/study.hpp"

namespace tendril::test {

struct Judgement {
  double equations = 0;    // largest fault of the Lagrangian equations, free and line
  double ends = 0;         // largest fault of an end condition
  double junctions = 0;    // jump of what must be continuous, by L, 1, the largest force and moment
  double balance = 0;      // of forces over the whole rod with the reported contacts, by the largest force
  double gap = 1;          // least signed gap over the clearance, free segments
  double reaction = 1;     // least reaction or pressure, compressive positive, by the largest force (over L)
  double inclination = 1;  // least d3·D3
  double stretch = 1;      // least α
  double spread = 1;       // least 1 - K·Δ

  /// What is wrong with it, if anything is worse than `tolerance`.
  std::string fault(double tolerance) const {
    const auto say = [](const char* what, double x) {
      return std::string(what) + " " + std::to_string(x * 1e9) + "e-9";
    };
    if (!(equations <= tolerance)) return say("the equations are off by", equations);
    if (!(ends <= tolerance)) return say("an end condition is off by", ends);
    if (!(junctions <= tolerance)) return say("a jump at a junction of", junctions);
    if (!(balance <= tolerance)) return say("the rod's balance is off by", balance);
    if (!(gap >= -tolerance)) return say("the rod enters the wall, relative gap", gap);
    if (!(reaction >= -tolerance)) return say("the wall pulls, relative force", reaction);
    return "";
  }
};

inline Judgement judge(const Problem& p, const continuation::Step& step) {
  using segmentation::AxialControl;
  using segmentation::TwistControl;
  using segmentation::Which;
  Judgement out;
  const SolvedRod rod(p, step);
  const double L = p.tube.length(), inside = 1e-13 * L, B = p.rod.bending_stiffness;
  const int n = rod.segments();
  double F = B / (L * L), M_scale = B / L;
  for (int j = 0; j < n; ++j) {
    const double a = rod.place(j) + inside, b = rod.place(j + 1) - inside;
    constexpr int samples = 200;
    std::vector<double> gap(samples + 1);
    const auto gap_at = [&](double S) {
      const Section x = rod.at(S);
      return rod.sign() * (1 - x.eccentricity / x.clearance);
    };
    for (int i = 0; i <= samples; ++i) {
      const Section x = rod.at(a + (b - a) * i / samples);
      F = std::max(F, x.F.norm());
      M_scale = std::max(M_scale, x.M.norm());
      const geometry::AxisPoint axis = p.tube.axis->at(x.S);
      const Vector3d D3 = axis.frame.col(2), W = axis.frame * axis.U[0];
      out.inclination = std::min(out.inclination, x.d.col(2).dot(D3));
      out.spread = std::min(out.spread, 1 + W.cross(Vector3d(x.r - axis.position)).dot(D3));
      out.stretch = std::min(out.stretch, x.stretch);
      gap[i] = rod.sign() * (1 - x.eccentricity / x.clearance);
    }
    if (rod.is_line(j)) continue;
    for (int i = 0; i <= samples; ++i) {
      out.gap = std::min(out.gap, gap[i]);
      if (i == 0 || i == samples || gap[i] > gap[i - 1] || gap[i] > gap[i + 1] || gap[i] > 0.02) continue;
      // golden section between the neighbours
      double from = a + (b - a) * (i - 1) / samples, to = a + (b - a) * (i + 1) / samples;
      for (int k = 0; k < 40; ++k) {
        const double x = to - 0.6180339887 * (to - from), y = from + 0.6180339887 * (to - from);
        (gap_at(x) < gap_at(y) ? to : from) = gap_at(x) < gap_at(y) ? y : x;
      }
      out.gap = std::min(out.gap, gap_at(0.5 * (from + to)));
    }
  }
  // ---- equations ----
  const int pieces = std::max(4, static_cast<int>(std::sqrt(F / B) * L / 2));
  out.equations = std::max(free_segments_against_integration(rod, L, pieces, B / (L * L), B / L).largest(),
                           line_contacts_against_balance(rod, 24, B / (L * L), B / L).largest());
  // ---- contacts ----
  for (int j = 0; j < n; ++j) {
    if (j + 1 < n) {
      const Section x = rod.at(rod.place(j + 1) - inside), y = rod.at(rod.place(j + 1) + inside);
      const Vector3d jump = y.F - x.F;
      const double R = rod.sign() * jump.dot(x.normal);
      out.reaction = std::min(out.reaction, R / F);
      out.junctions = std::max({out.junctions, (y.r - x.r).norm() / L, (y.d - x.d).norm(), (y.M - x.M).norm() / M_scale,
                                (jump - jump.dot(x.normal) * x.normal).norm() / F,
                                std::abs(x.eccentricity / x.clearance - 1), std::abs(y.s - x.s) / L});
    }
    if (!rod.is_line(j)) continue;
    const double a = rod.place(j) + inside, b = rod.place(j + 1) - inside;
    for (int i = 0; i <= 200; ++i)
      out.reaction = std::min(out.reaction, rod.pressure(j, a + (b - a) * i / 200) * std::min(L, b - a) / F);
  }
  // ---- ends ----
  const Section first = rod.at(0), last = rod.at(rod.place(n));
  const bool free = p.end.kind == End::Kind::free, guided = p.end.kind == End::Kind::guided;
  if (!free || p.axial != AxialControl::rod_length)  // else the place is what comes out
    out.ends = std::abs(rod.place(n) - p.end_position.value) / L;
  // What bears an end that nothing holds across: the load on it, or the guide along the rod; the wall does the rest,
  // along its normal.
  Vector3d support = last.F;
  if (free || guided) {
    const Vector3d t = last.d.col(2), across = (last.r - p.tube.axis->at(last.S).position).normalized();
    double wall = 0;  // along the outward normal
    if (std::abs(last.eccentricity / last.clearance - 1) < 1e-9)
      wall = free ? (last.F - p.end.tip.force).dot(last.normal) : last.F.dot(across) / last.normal.dot(across);
    support = last.F - wall * last.normal;
    out.ends = std::max(
        out.ends, (free ? Vector3d(support - p.end.tip.force) : Vector3d(support - support.dot(t) * t)).norm() / F);
    out.reaction = std::min(out.reaction, -rod.sign() * wall / F);
    out.gap = std::min(out.gap, rod.sign() * (1 - last.eccentricity / last.clearance));
    if (free) support = p.end.tip.force;
  }
  if (free) out.ends = std::max(out.ends, last.M.norm() / M_scale);
  for (const auto& [x, e] : {std::pair{first, p.start}, std::pair{last, p.end}}) {
    if (e.kind == End::Kind::free) continue;
    const geometry::AxisPoint axis = p.tube.axis->at(x.S);
    const Vector3d D1 = axis.frame.col(0), D2 = axis.frame.col(1), D3 = axis.frame.col(2);
    const Vector3d a = e.eccentricity[0].value * D1 + e.eccentricity[1].value * D2;
    if (e.kind == End::Kind::guided) {  // dδ/dS = 0, wherever it lies
      const Vector3d W = axis.frame * axis.U[0];
      out.ends = std::max(out.ends, (x.d.col(2) - (D3 + W.cross(Vector3d(x.r - axis.position))).normalized()).norm());
      continue;
    }
    out.ends = std::max(out.ends, (x.r - axis.position - a).norm() / L);
    if (e.kind == End::Kind::pinned) {
      out.ends = std::max(out.ends, (x.M - x.M.dot(x.d.col(2)) * x.d.col(2)).norm() / M_scale);
    } else {
      const Vector3d W = axis.frame * axis.U[0];
      const Vector3d t = D3 + e.slope[0].value * D1 + e.slope[1].value * D2 + W.cross(a);
      out.ends = std::max(out.ends, (x.d.col(2) - t.normalized()).norm());
    }
  }
  const Section& axial = p.axial_at == Which::end ? last : first;
  const double F3 = axial.F.dot(axial.d.col(2)), M3 = last.M.dot(last.d.col(2));
  const double bending2 = axial.M.squaredNorm() - std::pow(axial.M.dot(axial.d.col(2)), 2);
  const auto section = rod.rod().properties(axial.s, p.axial_at == Which::end ? first.s : last.s);
  const double push = -(0.5 * bending2 / section.B + F3 + 0.5 * section.e * F3 * F3);
  const double wanted = p.axial_value.value;
  if (!free || p.axial == AxialControl::rod_length)
    out.ends = std::max(out.ends, p.axial == AxialControl::axial_force ? std::abs(F3 - wanted) / F
                                  : p.axial == AxialControl::push      ? std::abs(push - wanted) / F
                                                                       : std::abs(last.s - first.s - wanted) / L);
  if (p.twist == TwistControl::torque) out.ends = std::max(out.ends, std::abs(M3 - p.twist_value.value) / M_scale);
  // ---- the whole rod, with the contacts as reported ----
  Vector3d sum = support - first.F + rod.rod().load_between(first.s, last.s);
  for (const auto& c : step.contacts) sum += c.force_vector;
  out.balance = sum.norm() / F;
  return out;
}

/// One problem of the campaign from start to end.
struct CampaignOutcome {
  enum class Kind { solved, unstable, refused, dropped, failed, wrong } kind = Kind::failed;
  std::uint64_t seed = 0;
  double seconds = 0;
  int contacts = 0;
  std::string words, reason, branch;
  std::string cause;  // dropped: why
  Judgement judgement;
};

/// A solved state counts when the judge finds nothing worse than this.
constexpr double campaign_tolerance = 1e-6;

inline CampaignOutcome run_campaign_problem(std::uint64_t seed, CampaignRules rules = CampaignRules::all,
                                            double max_seconds = 30.0) {
  using Kind = CampaignOutcome::Kind;
  CampaignOutcome out;
  out.seed = seed;
  const CampaignProblem c = campaign_problem(seed, rules);
  out.words = c.words;
  if (c.stretch_small) {
    out.kind = Kind::dropped;
    out.cause = "stretch < 0.3";
    out.reason = "the stretch falls below 0.3 by the axial load alone";
    return out;
  }
  continuation::StudyOptions options;
  options.solve.max_seconds = max_seconds;
  const auto begun = std::chrono::steady_clock::now();
  const auto r = continuation::solve(c.problem, options);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  out.reason = r.message;
  if (r.status != continuation::Status::converged) {
    out.kind = r.status == continuation::Status::outside_validity ? Kind::refused : Kind::failed;
    if (out.kind == Kind::refused) {
      // "d3·D3 = 0.05", or "1 - K·Δ = 0.01": where the search for a state ended
      const std::tuple<const char*, double, const char*> limits[] = {{"d3·D3 = ", 0.2, "d3·D3 < 0.2"},
                                                                     {"1 - K·Δ = ", 0.1, "1 - K·Δ < 0.1"}};
      for (const auto& [what, least, cause] : limits)
        if (const auto at = r.message.find(what); out.cause.empty() && at != std::string::npos)
          if (std::atof(r.message.c_str() + at + std::strlen(what)) < least) out.cause = cause;
      if (r.message.find("the rod is too short") != std::string::npos) out.cause = "rod too short to reach";
      if (!out.cause.empty()) out.kind = Kind::dropped;
    }
    return out;
  }
  const auto& s = r.steps.front();
  out.contacts = static_cast<int>(s.contacts.size());
  out.branch = s.branch;
  out.judgement = judge(c.problem, s);
  if (const std::string fault = out.judgement.fault(campaign_tolerance); !fault.empty()) {
    out.kind = Kind::wrong;
    out.reason = fault;
  } else if (out.judgement.inclination < 0.2 || out.judgement.stretch < 0.3 || out.judgement.spread < 0.1) {
    out.kind = Kind::dropped;
    out.cause = out.judgement.inclination < 0.2 ? "d3·D3 < 0.2"
                : out.judgement.stretch < 0.3   ? "stretch < 0.3"
                                                : "1 - K·Δ < 0.1";
    out.reason = "d3·D3 " + std::to_string(out.judgement.inclination) + ", stretch " +
                 std::to_string(out.judgement.stretch) + " in the state itself";
  } else {
    out.kind = s.stability == "stable" ? Kind::solved : Kind::unstable;
    if (out.kind == Kind::unstable) out.reason = s.branch;
  }
  return out;
}

}  // namespace tendril::test

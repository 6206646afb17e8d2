// The thesis' rod in a helical conduit (II.3.3, IV.2): half a turn at 45°, clamped on the axis, a sleeve on the axis at
// the far end, M3 = -1, the end force from T0 to 35 |T0| either way, clearances 1/40 and 1/20. All states are followed
// from the rod on the axis by the path follower. L = B = 1.

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "tendril/continuation/report_state.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/reproduce/helical_conduit_detail.hpp"
#include "tendril/reproduce/systems.hpp"

namespace tendril::reproduce {
namespace conduit {

Problem Conduit::problem(double clearance, double T) const {
  const double half = 0.5 * shape.torsion();
  const Eigen::Vector3d normal(-1, 0, 0), binormal(0, -std::cos(kPitch), std::sin(kPitch));
  Problem p;
  p.tube.axis =
      geometry::make_helix(shape.helix_radius, kPitch, 1.0, std::cos(half) * normal + std::sin(half) * binormal);
  p.tube.clearance = geometry::make_constant(clearance);
  p.rod = {1.0, 0.75, 1 / (kEta * kEta)};
  p.end.kind = segmentation::End::Kind::sleeve;
  p.end_position = 1.0;
  p.axial_value = segmentation::Scalar(T, 1.0);
  p.twist_value = kTorque;
  return p;
}

Chain Conduit::state(double clearance, const Step& step) const {
  Chain chain;
  chain.restore(step.state,
                std::make_shared<segmentation::Mechanics>(problem(clearance, *step.parameter), *step.parameter));
  return chain;
}

}  // namespace conduit
namespace {

using namespace conduit;

using drawing::Curve;
using drawing::Panel;
constexpr double kAsked = 1e-9;  // H is a sum of squares, so its spread is a few times the error asked
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Middle middle_of(const Chain& chain) {
  double u[formulation::FreeRod::inputs], s = 0;
  chain.sample(0.5, u, &s);
  const auto& P = chain.mechanics().problem;
  const auto k = formulation::FreeRod::kinematics<double>(formulation::lift<double>(P.section(0.5), 0.0, 0.0), u[0],
                                                          u[1], u[2], u[4], u[5], u[6]);
  return {u[0], k.J1bar * std::hypot(k.p, k.h), 1 - k.t[2] * k.t[2]};
}

struct Follower {
  const Conduit& conduit;
  const Progress& progress;
  double begin = 0, share = 1;  // of the whole

  Result operator()(double clearance, double from, const std::vector<double>& values, const Step* start) const {
    std::atomic<bool> stop{false};
    continuation::Path path;
    path.start = from;
    path.values = values;
    continuation::StudyOptions options;
    options.solve.tolerance = kAsked;
    options.solve.branch = segmentation::BranchRule::nearest;  // the symmetric branch, as in the thesis
    options.initial = start ? &start->state : nullptr;
    options.stop = &stop;
    options.progress = [&](double fraction, const std::string& what) {
      if (!progress(begin + share * fraction,
                    "clearance 1/" + std::to_string(std::lround(1 / clearance)) + ", " + what))
        stop = true;
    };
    Result r = continuation::follow([&](double T) { return conduit.problem(clearance, T); }, path, options);
    if (stop) throw Interrupted{};
    if (r.status != continuation::Status::converged)
      throw std::runtime_error("the path was not followed: " + r.message);
    return r;
  }
};

std::vector<double> loads_of(int side, double last) {
  std::vector<double> loads;
  for (double t = side > 0 ? -0.9 : -1.05; side * t < side * (side > 0 ? 4.0 : -3.5); t += side * 0.1)
    loads.push_back(t);
  for (double t = side > 0 ? 4 : -4; side * t <= side * last + 1e-9; t += side * 1.0) loads.push_back(t);
  for (const double t : {-1.25, -24.3, -24.34, -24.36, -24.4, -24.45, -24.5, -24.6, -24.75}) {
    if (side < 0 && t >= last) loads.push_back(t);
  }
  std::sort(loads.begin(), loads.end(), [&](double a, double b) { return side * a < side * b; });
  loads.erase(std::unique(loads.begin(), loads.end(), [](double a, double b) { return std::abs(a - b) < 1e-9; }),
              loads.end());
  return loads;
}

const Event* event(const Result& r, const std::string& kind) {
  for (const Event& e : r.events) {
    if (e.kind == kind) return &e;
  }
  throw std::runtime_error("no event " + kind + " on the path");
}

/// A quantity just before an event, from two states beside it: linear, so right to the square of the distance.
struct BeforeEvent {
  std::vector<Step> steps;
  std::vector<Middle> middle;
  double extrapolated(const std::function<double(const Step&, const Middle&)>& quantity) const {
    const double a = quantity(steps[0], middle[0]), b = quantity(steps[1], middle[1]);
    return 2 * b - a;  // at distances 2h and h
  }
};

struct Expected {
  double clearance;
  int side;
  double first, first_length, line, line_length, reaction;
};
// Model's own boundary value solutions with a general-purpose solver and the world-frame rod.
constexpr Expected kTransitions[] = {{1.0 / 40, +1, -0.720354515, 0.984149288, 0.614146894, 0.952369152, 10.07501747},
                                     {1.0 / 20, +1, -0.281948695, 0.948599452, 3.327296290, 0.871643590, 24.21949381},
                                     {1.0 / 40, -1, -1.178887788, 1.051427956, -2.006721010, 1.075190813, 7.50280625},
                                     {1.0 / 20, -1, -1.290510413, 1.085193598, -2.640046467, 1.127716284, 13.16761489}};
struct LineState {
  double clearance, load, start, end_force, pressure, length;
};
constexpr LineState kLines[] = {
    {1.0 / 20, -5, 0.386028, 15.01659, 35.5468, 1.1979060}, {1.0 / 20, -10, 0.308279, 27.16998, 115.6401, 1.3355420},
    {1.0 / 40, -5, 0.348736, 11.47938, 51.4669, 1.1502132}, {1.0 / 40, -10, 0.278517, 20.31662, 123.1830, 1.2784074},
    {1.0 / 40, 5, 0.383236, 12.88791, 108.9659, 0.8717895}, {1.0 / 40, 10, 0.345356, 19.29295, 229.3559, 0.7993206}};

const char* kTwin = "world-frame rod, general-purpose solver";
/// Half a unit of the last printed digit, and what the solver's own accuracy (1e-9 of the largest) may add to it.
double printed(int decimals, double size = 1.0) { return 0.5 * std::pow(10.0, -decimals) + 5 * kAsked * size; }

std::string name_of(double clearance, int side) {
  return std::string(clearance > 0.03 ? "ε = 1/20" : "ε = 1/40") + (side > 0 ? ", tension" : ", compression");
}

void transition_rows(Outcome& out, const Conduit& conduit, const Branch& branch, const Expected& e,
                     const BeforeEvent& before) {
  const std::string where = name_of(branch.clearance, branch.side) + ": ";
  const Event* first = event(branch.result, "contact_appears");
  const Event* line = event(branch.result, "point_to_line");
  out.rows.push_back({where + "first contact, T/|T0|", first->parameter / conduit.unit, e.first, printed(9), kTwin});
  out.rows.push_back({where + "first contact, ℓ/L", first->rod_length, e.first_length, printed(9), kTwin});
  out.rows.push_back({where + "point to line, T/|T0|", line->parameter / conduit.unit, e.line, printed(9, 10), kTwin});
  out.rows.push_back({where + "point to line, ℓ/L", line->rod_length, e.line_length, printed(9), kTwin});
  // The extrapolation from 1e-5 of the stretch of load away is exact to 1e-9 or so of the reaction.
  out.rows.push_back({where + "point to line, R [B/L²]",
                      before.extrapolated([](const Step& s, const Middle&) { return s.contacts.at(0).force; }),
                      e.reaction, 0.5e-8 + 1e-8 * e.reaction, kTwin});
  const double K = conduit.shape.curvature(), eps = branch.clearance;
  const double excess = before.extrapolated([&](const Step&, const Middle& m) {
    const double limit = branch.side > 0 ? (eps * K - m.sin2) / (eps * (1 - eps * K))   // (II.3.22), corrected
                                         : (eps * K + m.sin2) / (eps * (1 + eps * K));  // (II.3.22)
    return (m.curvature - limit) / K;
  });
  out.rows.push_back({where + "point to line, κ beyond its limit [K]", excess, 0.0, 1e-7,
                      branch.side > 0 ? "(II.3.22), sign corrected" : "(II.3.22)"});
}

void free_state(Outcome& out, const Conduit& conduit, const Branch& branch) {
  Chain chain = conduit.state(branch.clearance, branch.at(-1.25, conduit.unit));
  const Step s = continuation::describe(chain, 401);
  const auto& f = s.fields;
  const std::string where = "no contact, T = -1.25 |T0|: ";
  out.rows.push_back({where + "δ1(1/2) [L]", f.delta1.at(200), -0.0394342078, printed(10), kTwin});
  out.rows.push_back({where + "δ2(1/4) [L]", f.delta2.at(100), 0.0013138644, printed(10), kTwin});
  out.rows.push_back({where + "ℓ/L", s.rod_length, 1.0708511544, printed(10), kTwin});
  out.data.push_back({"fields_free",
                      {"xi [-]", "delta1 [L]", "delta2 [L]", "F1 [B/L^2]", "F2 [B/L^2]", "F3 [B/L^2]", "M1 [B/L]",
                       "M2 [B/L]", "M3 [B/L]"},
                      {f.S, f.delta1, f.delta2, f.F1, f.F2, f.F3, f.M1, f.M2, f.M3}});
  out.pictures.push_back(free_picture(f));
}

void lift_off(Outcome& out, const Conduit& conduit, const Branch& branch, const BeforeEvent& before) {
  const Event* split = event(branch.result, "line_splits");
  const std::string where = "ε = 1/20, lift-off in the middle: ";
  const double load = split->parameter / conduit.unit;
  out.rows.push_back({where + "T/|T0|", load, -24.3653829, printed(7, 100), kTwin});
  out.rows.push_back({where + "T/|T0|, thesis", load, -24.37, 0.5e-2, "thesis IV.2, two decimals printed"});
  out.rows.push_back({where + "ℓ/L", split->rod_length, 1.927172826, printed(9, 10), kTwin});
  const auto first = [](const Step& s) -> const Contact& { return s.contacts.at(0); };
  out.rows.push_back({where + "start of the contact [L]",
                      before.extrapolated([&](const Step& s, const Middle&) { return first(s).start; }), 0.19849423,
                      printed(8, 10), kTwin});
  out.rows.push_back({where + "end reaction [B/L²]",
                      before.extrapolated([&](const Step& s, const Middle&) { return *first(s).force_start; }),
                      73.8925428, printed(7, 1000), kTwin});
  out.rows.push_back({where + "pressure in the middle [B/L³]",
                      before.extrapolated([&](const Step& s, const Middle&) { return first(s).pressure_mid; }), 0.0,
                      1e-5, "condition of the event"});
}

Outcome compute(const Progress& progress) {
  const Conduit conduit;
  Outcome out;
  std::vector<Branch> branches;
  std::vector<Marked> events;
  const struct {
    double clearance;
    int side;
    double last;
  } runs[] = {{1.0 / 40, -1, -35}, {1.0 / 40, +1, 35}, {1.0 / 20, -1, -28}, {1.0 / 20, +1, 35}};
  out.rows.push_back({"T0 L²/B, M3 = -1", conduit.T0, -7.069, 0.5e-3, "thesis II.3.3.1, three decimals printed"});
  double spread = 0, balance = 0, gap = 0, tensile = 0;
  for (int i = 0; i < 4; ++i) {
    const auto& run = runs[i];
    Follower follow{conduit, progress, 0.25 * i, 0.22};
    Branch b{run.clearance, run.side, {}, {}};
    std::vector<double> values = loads_of(run.side, run.last);
    for (double& v : values) v *= conduit.unit;
    b.result = follow(run.clearance, conduit.T0, values, nullptr);
    for (const Step& s : b.result.steps) {
      const Chain chain = conduit.state(b.clearance, s);
      b.middle.push_back(middle_of(chain));
      spread = std::max(spread, s.certificate.invariant_spread);
      balance = std::max(balance, s.certificate.balance);
      gap = std::min(gap, s.certificate.gap_min);
      tensile = std::min(tensile, s.certificate.reaction_min);
    }
    const auto just_before = [&](double at, double h) {
      // From the last state before it, on to two places beside it.
      const Step* from = nullptr;
      for (const Step& s : b.result.steps) {
        if (run.side * (at - *s.parameter) > 3 * h) from = &s;
      }
      if (!from) throw std::runtime_error("no state before the event");
      follow.begin += follow.share;
      follow.share = 0.01;
      BeforeEvent before;
      before.steps = follow(run.clearance, *from->parameter, {at - run.side * 2 * h, at - run.side * h}, from).steps;
      for (const Step& s : before.steps) before.middle.push_back(middle_of(conduit.state(run.clearance, s)));
      return before;
    };
    const Event *first = event(b.result, "contact_appears"), *line = event(b.result, "point_to_line");
    const double stretch = std::abs(line->parameter - first->parameter);
    const BeforeEvent before = just_before(line->parameter, 1e-4 * stretch),
                      touching = just_before(first->parameter, 1e-4 * stretch);
    const Expected& expected = *std::find_if(std::begin(kTransitions), std::end(kTransitions), [&](const Expected& e) {
      return e.clearance == run.clearance && e.side == run.side;
    });
    transition_rows(out, conduit, b, expected, before);
    events.push_back({run.clearance > 0.03 ? 1 : 0, run.clearance, static_cast<double>(run.side),
                      first->parameter / conduit.unit, first->rod_length, line->parameter / conduit.unit,
                      line->rod_length,
                      before.extrapolated([](const Step& s, const Middle&) { return s.contacts.at(0).force; }),
                      touching.extrapolated([](const Step&, const Middle& m) { return m.curvature; }),
                      before.extrapolated([](const Step&, const Middle& m) { return m.curvature; })});
    for (const LineState& e : kLines) {
      if (e.clearance != run.clearance || e.load * run.side < 0) continue;
      const Step& s = b.at(e.load, conduit.unit);
      const Contact& c = s.contacts.at(0);
      const std::string where =
          name_of(run.clearance, run.side) + ", T = " + std::to_string(static_cast<int>(e.load)) + " |T0|: ";
      out.rows.push_back({where + "start of the contact [L]", c.start, e.start, printed(6), kTwin});
      out.rows.push_back({where + "end reaction [B/L²]", *c.force_start, e.end_force, printed(5, 100), kTwin});
      out.rows.push_back(
          {where + "pressure in the middle [B/L³]", c.pressure_mid, e.pressure, printed(4, 1000), kTwin});
      out.rows.push_back({where + "ℓ/L", s.rod_length, e.length, printed(7, 10), kTwin});
    }
    if (run.clearance > 0.03 && run.side < 0) {
      const Event* split = event(b.result, "line_splits");
      lift_off(out, conduit, b, just_before(split->parameter, 1e-5 * std::abs(split->parameter)));
    }
    branches.push_back(std::move(b));
  }
  out.rows.push_back({"all states: spread of H and M3 along the rod", spread, 0.0, 10 * kAsked, "first integrals"});
  out.rows.push_back({"all states: force and moment balance of the whole rod", balance, 0.0, 10 * kAsked, "statics"});
  out.rows.push_back(
      {"all states: deepest penetration / ε", std::min(gap, 0.0), 0.0, 10 * kAsked, "unilateral contact"});
  out.rows.push_back(
      {"all states: largest tensile reaction, scaled", std::min(tensile, 0.0), 0.0, 10 * kAsked, "unilateral contact"});

  const std::vector<Course> courses = {joined(branches[0], branches[1]), joined(branches[2], branches[3])};
  out.data.push_back(course_data("response_40", courses[0], conduit.unit));
  out.data.push_back(course_data("response_20", courses[1], conduit.unit));
  Data list{"events",
            {"epsilon [L]", "T/|T0| [-]", "rod length l/L [-]", "S [L]",
             "kind (0 contact, 1 point to line, 2 line splits, 3 branch point)"},
            std::vector<std::vector<double>>(5)};
  for (const Branch& b : branches) {
    for (const Event& e : b.result.events) {
      const double kind = e.kind == "contact_appears" ? 0
                          : e.kind == "point_to_line" ? 1
                          : e.kind == "line_splits"   ? 2
                          : e.kind == "branch_point"  ? 3
                                                      : kNaN;
      const double row[] = {b.clearance, e.parameter / conduit.unit, e.rod_length, e.S, kind};
      for (std::size_t k = 0; k < 5; ++k) list.value[k].push_back(row[k]);
      if (kind == 3) {
        char text[200];
        std::snprintf(
            text, sizeof text,
            "At T = %.4f |T0| (ε/L = 1/%.0f) the symmetric states lose their stability to asymmetric ones; the "
            "thesis, and these pictures, go on along the symmetric branch.",
            e.parameter / conduit.unit, 1 / b.clearance);
        out.notes.push_back(text);
      }
    }
  }
  out.data.push_back(list);

  out.pictures.push_back(early_picture(conduit, courses, events));
  free_state(out, conduit, branches[2]);

  out.pictures.push_back(late_picture(conduit, courses, events));
  const std::string arrows =
      " Black: the rod; vermillion: in contact; arrows: the concentrated forces on the rod at the ends of the contact.";
  out.pictures.push_back(body_picture(conduit, "fig_IV_2_2", "Fig. IV.2.2: the rod under tension." + arrows,
                                      {{&branches[1], 10}, {&branches[1], 35}}));
  out.pictures.push_back(body_picture(conduit, "fig_IV_2_3", "Fig. IV.2.3: the buckled rod." + arrows,
                                      {{&branches[0], -10}, {&branches[0], -35}}));
  out.pictures.push_back(body_picture(
      conduit, "fig_IV_2_4", "Fig. IV.2.4: the buckled rod as its middle leaves the wall, and beyond." + arrows,
      {{&branches[2], -24.36}, {&branches[2], -28}}));
  out.notes.push_back(
      "The thesis speaks of the magnitude of the end force growing from T0: that is the compression branch. The "
      "tension "
      "branch (Fig. IV.2.2) passes through T = 0.");
  progress(1.0, "done");
  return out;
}

}  // namespace

System helical_conduit_system() {
  return {"helical_conduit",
          "Rod in a helical conduit",
          "II.3.3, IV.2; Figs. II.3.2, II.3.3, IV.2.1 to IV.2.4",
          "A straight rod pushed or pulled in half a turn of a helical conduit: free, one point of contact, a line of "
          "contact, lift-off of its middle, for two clearances.",
          compute,
          3.4};
}

}  // namespace tendril::reproduce

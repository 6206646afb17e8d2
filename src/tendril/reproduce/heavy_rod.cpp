// Non-uniqueness of heavy rods (II.4, Fig. II.4.1): clamp and frictionless sleeve a distance L apart, weight 5 B/L³
// across, no end thrust, the end torque varied. The whole response curve is followed in the world frame, through its
// folds and beyond the place where the Eulerian map ends; states and the first fold again by the Eulerian formulation.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "tendril/closed_form/columns.hpp"
#include "tendril/continuation/path_follower.hpp"
#include "tendril/continuation/report_state.hpp"
#include "tendril/reproduce/heavy_rod_states.hpp"
#include "tendril/reproduce/systems.hpp"

namespace tendril::reproduce {
namespace {

using namespace heavy;
using collocation::BoundaryValueProblem;
using continuation::Branch;
using continuation::BranchEvent;

constexpr double kWeight = 5.0, kTorque = 7.0, kLongest = 25.0;
constexpr double kAsked = 1e-10, kNaN = std::numeric_limits<double>::quiet_NaN();
// Two formulations, each right to 1e-10 between nodes relative to its largest values (F up to w ℓ/2).
constexpr double kAgreement = 1e-9;
enum Function : int { kLength, kAdvance, kDeflection, kStiffness, kAtTorque, kLoop };

struct Stretch {                                          // of the response curve
  double weight, start, longest, max_step, begin, share;  // begin, share: of the progress
};

Branch response(const Stretch& stretch,
                const std::vector<std::function<double(const BoundaryValueProblem&)>>& functions,
                const Progress& progress) {
  BoundaryValueProblem rod = rod_problem(stretch.weight, Vary::torque);
  continuation::BranchOptions options;
  options.max_step = stretch.max_step;
  options.p_min = -1;
  options.p_max = 12;
  options.solve.tolerance = kAsked;
  options.functions = functions;
  bool asked_to_stop = false;
  int count = 0;
  options.stop = [&](const BoundaryValueProblem& b) {
    asked_to_stop = progress && !progress(stretch.begin + stretch.share * std::min(1.0, ++count / 70.0),
                                          "following the response curve");
    return asked_to_stop || length_of(b) > stretch.longest;
  };
  if (!rod.solve(collocation::Closure::at(stretch.start), options.solve).converged)
    throw std::runtime_error("the rod at the start of the response curve was not found");
  Branch branch = continuation::follow(rod, options);
  if (asked_to_stop) throw Interrupted{};
  if (branch.failed) throw std::runtime_error("the response curve ends: " + branch.ended);
  return branch;
}

std::vector<const BranchEvent*> events(const Branch& branch, BranchEvent::Kind kind, int function = -1) {
  std::vector<const BranchEvent*> list;
  for (const BranchEvent& e : branch.events) {
    if (e.kind == kind && (kind != BranchEvent::Kind::zero || e.function == function)) list.push_back(&e);
  }
  return list;
}

std::vector<Place> places(const Branch& branch) {
  std::vector<Place> list;
  const auto add = [&](double arclength, double p, const std::vector<double>& v, int sign) {
    list.push_back({arclength, p, v[kLength], v[kAdvance], v[kDeflection], v[kStiffness], sign});
  };
  for (const auto& point : branch.points) {
    // At held length the determinant is that at held force times dℓ/dF3.
    const bool turned = point.values[kStiffness] * branch.points.front().values[kStiffness] < 0;
    add(point.arclength, point.p, point.values, point.sign * (turned ? -1 : 1));
  }
  for (const BranchEvent& e : branch.events) {
    if (e.kind == BranchEvent::Kind::fold || e.function == kAtTorque || e.function == kLoop)
      add(e.arclength, e.p, e.values, 0);
  }
  std::stable_sort(list.begin(), list.end(), [](const Place& a, const Place& b) { return a.arclength < b.arclength; });
  return list;
}

/// Sum of what a section carries that is one number along the rod: ½|M|² - ½M3² + F3 + σ·r.
double invariant(const Section& s) {
  const double M3 = s.M.dot(s.t);
  return 0.5 * (s.M.squaredNorm() - M3 * M3) + s.F.dot(s.t) - kWeight * s.r.z();
}

void state_rows(Outcome& out, const std::string& name, const BranchEvent& event) {
  const std::string where = "state (" + name + "), M3 = 7 B/L: ";
  segmentation::Chain chain = eulerian_state(event.problem, kWeight, 0.1 * kAsked);
  const continuation::Step s = continuation::describe(chain, 3);
  out.rows.push_back({where + "ℓ/L", length_of(event.problem), s.rod_length, kAgreement, "Eulerian twin"});
  const Section middle = section_at(event.problem, 0.5);
  out.rows.push_back({where + "sag in the middle [L]", -middle.r.z(), -s.fields.z.at(1), kAgreement, "Eulerian twin"});
  out.rows.push_back(
      {where + "sideways in the middle [L]", middle.r.y(), 0.0, kAgreement, "half turn about the vertical"});
  const Section start = section_at(event.problem, 0.0);
  out.rows.push_back({where + "bending moment at the clamp [B/L]", std::hypot(start.M.y(), start.M.z()),
                      std::hypot(s.fields.M1.at(0), s.fields.M2.at(0)), 10 * kAgreement, "Eulerian twin"});
  double least = HUGE_VAL, largest = -HUGE_VAL;
  for (int i = 0; i <= 200; ++i) {
    const double value = invariant(section_at(event.problem, i / 200.0));
    least = std::min(least, value);
    largest = std::max(largest, value);
  }
  out.rows.push_back(
      {where + "spread of ½κ² + F3 + σ·r [B/L²]", largest - least, 0.0, 10 * kAgreement, "first integral"});
}

/// Torque and length at the first fold by the path follower of the Eulerian formulation.
continuation::Event eulerian_fold(const BranchEvent& start) {
  segmentation::Chain chain = eulerian_state(start.problem, kWeight, 0.1 * kAsked);
  continuation::FollowOptions options;
  options.switcher.accuracy = 0.1 * kAsked;
  options.max_steps = 60;
  continuation::PathFollower follower(chain, options);
  follower.to(9.0);  // cannot be reached: it turns back before
  for (const continuation::Event& e : follower.events) {
    if (e.kind == "fold") return e;
  }
  throw std::runtime_error("the path follower found no fold");
}

/// The Eulerian formulation's own verdict (second variation and dF3/dℓ) against the sign of dF3/dℓ here.
int verdicts_that_differ(const Branch& branch, const Progress& progress) {
  int differ = 0, seen = 0;
  for (const BranchEvent& e : branch.events) {
    if (e.kind != BranchEvent::Kind::zero || e.function <= kLoop) continue;
    const segmentation::Chain chain = eulerian_state(e.problem, kWeight, 1e-9);
    differ += (continuation::judge_stability(chain).word == "stable") != (e.values[kStiffness] < 0);
    if (progress && !progress(0.7 + 0.01 * ++seen, "judging stability")) throw Interrupted{};
  }
  if (seen < 8) throw std::runtime_error("too few states to judge");
  return differ;
}

Data body_data(const std::string& name, const BoundaryValueProblem& rod) {
  Data d{name,
         {"s [L]", "x [L]", "y [L]", "z [L]", "F3 [B/L^2]", "bending moment [B/L]"},
         std::vector<std::vector<double>>(6)};
  for (int i = 0; i <= 400; ++i) {
    const Section c = section_at(rod, i / 400.0);
    const double M3 = c.M.dot(c.t);
    const double row[] = {length_of(rod) * i / 400,
                          c.r.x(),
                          c.r.y(),
                          c.r.z(),
                          c.F.dot(c.t),
                          std::sqrt(std::max(0.0, c.M.squaredNorm() - M3 * M3))};
    for (std::size_t k = 0; k < 6; ++k) d.value[k].push_back(row[k]);
  }
  return d;
}

std::string text(const char* format, double a, double b = 0, double c = 0) {
  char buffer[400];
  std::snprintf(buffer, sizeof buffer, format, a, b, c);
  return buffer;
}

/// Torque at the first fold of a rod of this weight.
double first_fold(double weight, const Progress& progress, double begin) {
  const Branch branch = response({weight, 8.0, 1.01, 0.05, begin, 0.05}, {}, progress);
  const auto folds = events(branch, BranchEvent::Kind::fold);
  if (folds.empty()) throw std::runtime_error("no fold of the light rod");
  return folds.front()->p;
}

Outcome compute(const Progress& progress) {
  Outcome out;
  std::vector<std::function<double(const BoundaryValueProblem&)>> functions = {
      length_of,
      least_advance,
      largest_deflection,
      [](const BoundaryValueProblem& b) { return stiffness_of_feeding(b, kWeight); },
      [](const BoundaryValueProblem& b) { return b.parameter() - kTorque; },
      [](const BoundaryValueProblem& b) { return length_of(b) - 5.0; }};
  for (const double at : {2.5, 4.0, 5.5, 6.5, 7.9})  // states to judge by the other formulation, on both branches
    functions.emplace_back([at](const BoundaryValueProblem& b) { return b.parameter() - at; });
  const Branch branch = response({kWeight, 0.0, kLongest, 0.4, 0.0, 0.65}, functions, progress);
  const auto folds = events(branch, BranchEvent::Kind::fold),
             same = events(branch, BranchEvent::Kind::zero, kStiffness),
             states = events(branch, BranchEvent::Kind::zero, kAtTorque),
             loop = events(branch, BranchEvent::Kind::zero, kLoop),
             turns = events(branch, BranchEvent::Kind::zero, kAdvance);
  if (folds.size() != 3 || same.size() != 3 || states.size() != 2 || loop.size() != 1 || turns.size() != 2)
    throw std::runtime_error("the response curve does not look as it should");
  const std::vector<Place> list = places(branch);

  const continuation::Event eulerian = eulerian_fold(*states[0]);
  out.rows.push_back({"first fold: M3 [B/L]", folds[0]->p, eulerian.parameter, kAgreement, "Eulerian path follower"});
  out.rows.push_back({"first fold: ℓ/L", folds[0]->values[kLength], eulerian.rod_length, 1e-7,
                      "Eulerian path follower (ℓ is steep there)"});
  const char* ordinal[] = {"first", "second", "third"};
  for (std::size_t i = 0; i < 3; ++i)
    out.rows.push_back({std::string(ordinal[i]) + " fold: M3 where dF3/dℓ = 0 [B/L]", same[i]->p, folds[i]->p,
                        kAgreement, "fold of the curve"});
  state_rows(out, "b", *states[0]);
  state_rows(out, "c", *states[1]);
  const auto changes = std::count_if(list.begin(), list.end(), [](const Place& p) { return p.sign < 0; });
  out.rows.push_back({"states of the curve unstable at held length", static_cast<double>(changes), 0.0, 0.0,
                      "sign of the determinant at held length"});
  out.rows.push_back({"states on which two verdicts of stability differ",
                      static_cast<double>(verdicts_that_differ(branch, progress)), 0.0, 0.0,
                      "second variation of the Eulerian twin"});
  // The fold of a light rod approaches Greenhill's torque like w^(2/3), the cusp of the perfect rod's bifurcation; that
  // term and the next are removed.
  constexpr double kLight = 1e-3;
  const double one = first_fold(kLight, progress, 0.85), eight = first_fold(8 * kLight, progress, 0.9),
               more = first_fold(64 * kLight, progress, 0.95);
  const double once = one + (one - eight) / 3, twice = eight + (eight - more) / 3;
  out.rows.push_back({"weight -> 0: M3 at the fold [B/L]", once + (once - twice) / 15,
                      closed_form::greenhill_torque_clamped(0, 1, 1), 1e-6,
                      "Greenhill's torque; extrapolated in w^(2/3)"});
  {
    constexpr double kSmall = 0.05;
    BoundaryValueProblem rod = rod_problem(kSmall, Vary::torque);
    collocation::BvpOptions options;
    options.tolerance = kAsked;
    if (!rod.solve(collocation::Closure::at(0.0), options).converged)
      throw std::runtime_error("the light rod was not found");
    out.rows.push_back({"M3 = 0, w = 0.05 B/L³: sag 384 B δ/(w L⁴)", 384 * -section_at(rod, 0.5).r.z() / kSmall, 1.0,
                        1e-6, "clamped beam, to the square of w"});
  }

  Data curve{"response",
             {"M3 [B/L]", "rod length l/L [-]", "largest deflection [L]", "smallest d3.D3 [-]", "dF3/dl [B/L^3]",
              "stable at F3 = 0 (1) or not (0)"},
             std::vector<std::vector<double>>(6)};
  for (const Place& p : list) {
    const double row[] = {p.torque, p.length, p.deflection, p.advance, p.stiffness, p.stiffness < 0 ? 1.0 : 0.0};
    for (std::size_t k = 0; k < 6; ++k) curve.value[k].push_back(row[k]);
  }
  out.data = {curve, body_data("state_b", states[0]->problem), body_data("state_c", states[1]->problem),
              body_data("state_d", loop[0]->problem)};

  Picture diagram{
      "fig_II_4_1a",
      "Fig. II.4.1(a), with the path that joins the thesis' two branches: length of the rod against the end "
      "torque, weight 5 B/L³, no end thrust. On the right the same near the first fold.",
      {}};
  const std::vector<const BranchEvent*> marked = {states[0], states[1], loop[0]};
  diagram.figure.panels = {
      response_panel("whole curve", list, folds, marked, {"b", "c", "d"}, true, kLongest),
      response_panel("near the first fold", list, folds, marked, {"b", "c", "d"}, false, kLongest)};
  diagram.figure.panel_height = 360;
  diagram.figure.panel_width = 460;
  Picture bodies{
      "fig_II_4_1bc",
      "Fig. II.4.1(b, c): two equilibria under the same torque, weight and end thrust, and (d) a hanging loop "
      "farther on the same curve. Dashed: projections on the horizontal and the vertical plane. The deflection "
      "of (b) is drawn five times too large, as in the thesis.",
      {}};
  bodies.figure.columns = 3;
  bodies.figure.panel_width = 380;
  bodies.figure.panel_height = 420;
  bodies.figure.panels = {
      body("(b) M_3 = 7 B/L, " + text("ℓ = %.4f L, deflection × 5", states[0]->values[kLength]), states[0]->problem, 5),
      body("(c) M_3 = 7 B/L, " + text("ℓ = %.4f L", states[1]->values[kLength]), states[1]->problem, 1),
      body(text("(d) M_3 = %.4f B/L, ℓ = 5 L", loop[0]->p), loop[0]->problem, 1)};
  out.pictures = {diagram, bodies};

  out.notes = {
      text("One curve joins the thesis' branches: from M3 = 0 it rises to a fold at M3 = %.6f B/L (ℓ = %.6f L), and "
           "falls "
           "back through state (c)",
           folds[0]->p, folds[0]->values[kLength]) +
          text(" to a second fold at %.6f (ℓ = %.4f L) and a third at ", folds[1]->p, folds[1]->values[kLength]) +
          text("%.6f (ℓ = %.3f L), from where ever longer rods hang from ever smaller torques.", folds[2]->p,
               folds[2]->values[kLength]),
      std::string("With F3 = 0 held the states are stable before the first fold, unstable from there to the second, "
                  "stable to the third and unstable after it. At held length the determinant never changes sign, so no "
                  "state loses its stability singly: state (c) is reached by feeding rod in."),
      text("Between M3 = %.6f and %.6f on the falling part the rod turns back on the axis (d3·D3 < 0 somewhere): the "
           "Eulerian map ends there, and only the world-frame formulation can follow.",
           turns[0]->p, turns[1]->p),
      "The thesis does not print stretch or direction of the weight; here the rod is inextensible, the axis horizontal "
      "and the "
      "weight vertical. M3 < 0 gives the mirror image."};
  if (progress) progress(1.0, "done");
  return out;
}

}  // namespace

System heavy_rod_system() {
  return {
      "heavy_rod",
      "Non-uniqueness of heavy rods",
      "II.4; Fig. II.4.1",
      "A heavy rod twisted between a clamp and a frictionless sleeve has several equilibria for one torque: the whole "
      "response curve with its folds, and where it is stable.",
      compute,
      1.8};
}

}  // namespace tendril::reproduce

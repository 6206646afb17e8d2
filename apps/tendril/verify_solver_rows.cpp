// The rows that the solver must reproduce: the helical conduit of the thesis, loads in units of |T0|, and the rod
// between two walls against its closed forms. Each path is followed once and read for all its rows.
#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "tendril/closed_form/columns.hpp"
#include "tendril/closed_form/helical_conduit.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "verify_rows.hpp"

namespace tendril::app {
namespace {

using continuation::Event;
using continuation::Result;
using continuation::Step;
using segmentation::Problem;
using segmentation::Scalar;
constexpr double pi = std::numbers::pi;

/// Half a unit of the last printed decimal and the accuracy asked of the solver, relative.
constexpr double solver_accuracy = 1e-8;
double printed(int decimals, double value) {
  return 0.6 * std::pow(10.0, -decimals) + 2 * solver_accuracy * std::abs(value);
}

// ---- the helical conduit: Θ = π/4, Σ = 1/(π√2), η = 1/20, ν = 1/3, M3 = -1, L = B = 1 ----
constexpr double pitch_angle = pi / 4, eta = 1.0 / 20, torque = -1.0;
const double helix_radius = 1.0 / (pi * std::sqrt(2.0));

double axis_tension() { return closed_form::axis_tension({pitch_angle, helix_radius}, torque, eta); }

/// Rod clamped on the axis and held by a sleeve on it at the far end, under F3(1) = tension.
Problem helical_conduit(double clearance, Scalar tension) {
  // D1 is the Frenet normal in the middle: at S = 0 it is turned by τ/2 from the normal towards the binormal.
  const double half = 0.5 * closed_form::HelicalConduit{pitch_angle, helix_radius}.torsion();
  const Eigen::Vector3d normal(-1, 0, 0), binormal(0, -std::cos(pitch_angle), std::sin(pitch_angle));
  Problem p;
  p.tube.axis =
      geometry::make_helix(helix_radius, pitch_angle, 1.0, std::cos(half) * normal + std::sin(half) * binormal);
  p.tube.clearance = geometry::make_constant(clearance);
  p.rod = {1.0, 0.75, 1.0 / (eta * eta)};
  p.end.kind = segmentation::End::Kind::sleeve;
  p.end_position = 1.0;
  p.axial_value = tension;
  p.twist_value = torque;
  return p;
}

/// Follows the end force from T0 through `loads` (in |T0|).
Result follow_conduit(double clearance, const std::vector<double>& loads) {
  const double T0 = axis_tension();
  continuation::Path path;
  path.start = T0;
  for (const double load : loads) path.values.push_back(load * std::abs(T0));
  return continuation::follow([clearance](double T) { return helical_conduit(clearance, Scalar(T, 1.0)); }, path, {});
}

/// Collects the rows of one group. A missing event or state gives a row that cannot pass, with the reason in its name.
class Group {
 public:
  Group(std::vector<VerifyRow>& rows, std::string name) : rows_(rows), name_(std::move(name)) {}

  void add(const std::string& quantity, std::optional<double> computed, double expected, double tolerance,
           const std::string& missing) {
    const double number = computed.value_or(std::numeric_limits<double>::quiet_NaN());
    rows_.push_back({name_ + ": " + quantity + (computed ? "" : " (" + missing + ")"), number, expected, tolerance});
  }

 private:
  std::vector<VerifyRow>& rows_;
  std::string name_;
};

const Event* find_event(const Result& r, const std::string& kind) {
  const auto it = std::find_if(r.events.begin(), r.events.end(), [&](const Event& e) { return e.kind == kind; });
  return it == r.events.end() ? nullptr : &*it;
}

/// The step at this load, if it converged.
const Step* find_step(const Result& r, double parameter) {
  for (const Step& s : r.steps)
    if (s.parameter && std::abs(*s.parameter - parameter) < 1e-12 * std::abs(parameter) &&
        s.status == continuation::Status::converged)
      return &s;
  return nullptr;
}

std::string why(const Result& r, const std::string& missing) {
  return r.message.empty() ? missing : missing + ": " + r.message;
}

struct ContinuousState {
  double load, start, end_force, pressure_mid, rod_length;
  int decimals_force, decimals_pressure;
};
struct ConduitSide {
  const char* name;
  double clearance;
  double first_contact, point_to_line, reaction;  // loads in |T0|, force of the point as it turns into a line
  double length_first, length_line;               // rod length at these two events
  std::vector<ContinuousState> states;            // line contact from S to 1 - S
  std::optional<double> lift_off;                 // load at which the pressure vanishes in the middle
  double lift_off_length = 0.0;
};

const std::vector<ConduitSide>& conduit_sides() {
  static const std::vector<ConduitSide> sides = {
      {"conduit 1/40 tension",
       1.0 / 40,
       -0.720354515,
       0.614146894,
       10.07501747,
       0.984149288,
       0.952369152,
       {{5, 0.383236, 12.88791, 108.9659, 0.8717895, 5, 4}, {10, 0.345356, 19.29295, 229.3559, 0.7993206, 5, 4}},
       {}},
      {"conduit 1/20 tension", 1.0 / 20, -0.281948695, 3.327296290, 24.21949381, 0.948599452, 0.871643590, {}, {}},
      {"conduit 1/40 compression",
       1.0 / 40,
       -1.178887788,
       -2.006721010,
       7.50280625,
       1.051427956,
       1.075190813,
       {{-5, 0.348736, 11.47938, 51.4669, 1.1502132, 5, 4}, {-10, 0.278517, 20.31662, 123.1830, 1.2784074, 5, 4}},
       {}},
      {"conduit 1/20 compression",
       1.0 / 20,
       -1.290510413,
       -2.640046467,
       13.16761489,
       1.085193598,
       1.127716284,
       {{-5, 0.386028, 15.01659, 35.5468, 1.1979060, 5, 4}, {-10, 0.308279, 27.16998, 115.6401, 1.3355420, 5, 4}},
       -24.3653829,
       1.927172826},
  };
  return sides;
}

void conduit_rows(std::vector<VerifyRow>& rows, const ConduitSide& side) {
  Group group(rows, side.name);
  // Just before the point turns into a line the force of the point is read; R changes by 1e-8 of itself over that step.
  const double before = side.point_to_line - 1e-8 * (side.point_to_line - side.first_contact);
  std::vector<double> loads{before};
  for (const ContinuousState& s : side.states) loads.push_back(s.load);
  if (side.lift_off) loads.push_back(*side.lift_off * (1 + 1e-3));
  if (loads.size() == 1) loads.push_back(side.point_to_line * 1.02);
  const double T0 = std::abs(axis_tension());
  const Result r = follow_conduit(side.clearance, loads);

  const auto event_rows = [&](const char* kind, const std::string& label, double load, int decimals, double length) {
    const Event* e = find_event(r, kind);
    const std::string missing = why(r, std::string("no event ") + kind);
    group.add(label + ", T/|T0|", e ? std::optional(e->parameter / T0) : std::nullopt, load, printed(decimals, load),
              missing);
    group.add(label + ", rod length", e ? std::optional(e->rod_length) : std::nullopt, length, printed(9, length),
              missing);
  };
  event_rows("contact_appears", "first contact", side.first_contact, 9, side.length_first);
  event_rows("point_to_line", "point to line", side.point_to_line, 9, side.length_line);
  const Step* point = find_step(r, before * T0);
  const bool one = point && point->contacts.size() == 1;
  group.add("point to line, force", one ? std::optional(point->contacts[0].force) : std::nullopt, side.reaction,
            printed(8, side.reaction) + 1e-7 * side.reaction, why(r, "no single contact"));

  for (const ContinuousState& s : side.states) {
    const Step* step = find_step(r, s.load * T0);
    const bool line = step && step->contacts.size() == 1 && step->contacts[0].line;
    const std::string at = "T = " + std::to_string(static_cast<int>(s.load)) + " |T0|, ",
                      missing = why(r, "no single line contact");
    const auto value = [&](auto&& read) {
      return line ? std::optional<double>(read(step->contacts[0])) : std::nullopt;
    };
    using C = continuation::Contact;
    group.add(at + "start of the line", value([](const C& c) { return c.start; }), s.start, printed(6, s.start),
              missing);
    group.add(at + "end of the line", value([](const C& c) { return c.end; }), 1 - s.start, printed(6, 1.0), missing);
    group.add(at + "end force", value([](const C& c) { return c.force_end.value_or(0.0); }), s.end_force,
              printed(s.decimals_force, s.end_force), missing);
    group.add(at + "pressure in the middle", value([](const C& c) { return c.pressure_mid; }), s.pressure_mid,
              printed(s.decimals_pressure, s.pressure_mid), missing);
    group.add(at + "rod length", line ? std::optional(step->rod_length) : std::nullopt, s.rod_length,
              printed(7, s.rod_length), missing);
  }
  if (side.lift_off) event_rows("line_splits", "lift-off in the middle", *side.lift_off, 7, side.lift_off_length);
}

void free_state_rows(std::vector<VerifyRow>& rows) {
  Group group(rows, "conduit, free, T = -1.25 |T0|");
  const double T0 = std::abs(axis_tension());
  continuation::StudyOptions options;
  options.fields = true;
  const Result r = continuation::solve(helical_conduit(1.0 / 20, -1.25 * T0), options);
  const Step* step = r.steps.empty() || r.steps[0].status != continuation::Status::converged ? nullptr : &r.steps[0];
  const std::string missing = why(r, "not solved");
  const auto field = [&](const std::vector<double> continuation::Fields::*column, double S) -> std::optional<double> {
    if (!step) return std::nullopt;
    for (std::size_t i = 0; i < step->fields.S.size(); ++i)
      if (std::abs(step->fields.S[i] - S) < 1e-12) return (step->fields.*column)[i];
    return std::nullopt;
  };
  group.add("delta1 in the middle", field(&continuation::Fields::delta1, 0.5), -0.0394342078, printed(10, 0.05),
            missing);
  group.add("delta2 at S = 1/4", field(&continuation::Fields::delta2, 0.25), 0.0013138644, printed(10, 0.05), missing);
  group.add("rod length", step ? std::optional(step->rod_length) : std::nullopt, 1.0708511544, printed(10, 1.07),
            missing);
}

/// Straight rod between clamps on the axis of a straight tube, lengthened; in the plane. Against columns.hpp.
void planar_rows(std::vector<VerifyRow>& rows) {
  constexpr double clearance = 0.05, span = 1.0;
  Group group(rows, "straight tube 1/20, planar");
  const closed_form::PlanarState touch = closed_form::first_contact_at_span(clearance, span, 1.0),
                                 line = closed_form::point_to_line_at_span(clearance, span, 1.0);
  const auto family = [&](double rod_length) {
    Problem p;
    p.tube.axis = geometry::make_straight(span);
    p.tube.clearance = geometry::make_constant(clearance);
    p.rod = {1.0, 0.75, std::nullopt};
    p.end.kind = segmentation::End::Kind::sleeve;
    p.end_position = span;
    p.axial = segmentation::AxialControl::rod_length;
    p.axial_value = Scalar(rod_length, 1.0);
    return p;
  };
  continuation::Path path;
  path.start = span + 0.2 * (touch.rod_length - span);  // bent already: the straight rod is exactly at its branch point
  path.values = {line.rod_length + 0.1 * (line.rod_length - touch.rod_length)};
  continuation::StudyOptions options;
  options.solve.branch = segmentation::BranchRule::planar;
  const Result r = continuation::follow(family, path, options);
  const auto event_rows = [&](const char* kind, const std::string& label, const closed_form::PlanarState& s) {
    const Event* e = find_event(r, kind);
    const std::string missing = why(r, std::string("no event ") + kind);
    group.add(label + ", rod length", e ? std::optional(e->rod_length) : std::nullopt, s.rod_length,
              2 * solver_accuracy * s.rod_length, missing);
    group.add(label + ", end force", e ? std::optional(e->axial_force_end) : std::nullopt, -s.thrust,
              20 * solver_accuracy * s.thrust, missing);
  };
  event_rows("contact_appears", "first contact", touch);
  event_rows("point_to_line", "point to line", line);
}

/// A block of rows; wrong input inside would be our bug, and must show as a row that fails.
template <class Block>
void guarded(std::vector<VerifyRow>& rows, const std::string& name, Block&& block) {
  try {
    block();
  } catch (const std::exception& e) {
    Group(rows, name).add("solve", std::nullopt, 0.0, 0.0, e.what());
  }
}

}  // namespace

void append_solver_rows(std::vector<VerifyRow>& rows) {
  guarded(rows, "conduit, free", [&] { free_state_rows(rows); });
  for (const ConduitSide& side : conduit_sides()) guarded(rows, side.name, [&] { conduit_rows(rows, side); });
  guarded(rows, "straight tube 1/20, planar", [&] { planar_rows(rows); });
}

}  // namespace tendril::app

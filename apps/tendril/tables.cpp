#include "tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tendril/geometry/tube_check.hpp"
#include "tendril/io/centreline.hpp"
#include "tendril/io/result_json.hpp"
#include "tendril/io/stress_report.hpp"

namespace tendril::app {
namespace {

using continuation::Contact;
using continuation::Result;
using continuation::Step;
using io::Dimension;

std::string unit(const io::Case& c, Dimension dimension) {
  const std::string text(io::si_unit(dimension));
  return c.si && !text.empty() ? " " + text : std::string();
}

// Tables are for people: rounding noise of a quantity, this small beside its fellows, is printed as 0. Files keep it.
constexpr double kNoise = 1e-10;

std::string cell(double value, double scale = 0.0) {
  if (std::abs(value) < kNoise * scale) value = 0.0;
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "-";
}
std::string cell(const std::optional<double>& value) { return value ? cell(*value) : "-"; }

std::string contacts(const io::Case& c, const Step& step) {
  if (step.contacts.empty()) return "  no contact\n";
  std::vector<std::vector<std::string>> rows{{"#", "kind", "start", "end", "angle", "to", "force", "at start", "at end",
                                              "between", "p min", "p mid", "p max"}};
  if (c.si) rows.push_back({"", "", "m", "m", "deg", "deg", "N", "N", "N", "N", "N/m", "N/m", "N/m"});
  const double angle_unit = c.si ? 180 / std::numbers::pi : 1.0;
  for (std::size_t i = 0; i < step.contacts.size(); ++i) {
    const Contact& k = step.contacts[i];
    const auto line = [&](const std::string& text) { return k.line ? text : std::string(); };
    rows.push_back({std::to_string(i + 1), kind_name(k), cell(k.start), line(cell(k.end)),
                    cell(k.angle_start * angle_unit, angle_unit), line(cell(k.angle_end * angle_unit, angle_unit)),
                    cell(k.force), line(cell(k.force_start)), line(cell(k.force_end)), line(cell(k.force_distributed)),
                    line(cell(k.pressure_min)), line(cell(k.pressure_mid)), line(cell(k.pressure_max))});
  }
  return aligned(rows);
}

std::string step_text(const io::Case& c, const Step& step, std::size_t index, std::size_t count) {
  std::string out;
  std::string title = count > 1 ? fmt::format("step {} of {}", index + 1, count) : "state";
  if (step.parameter && c.path)
    title += fmt::format(": {} = {}{}", c.path->parameter, cell(*step.parameter), unit(c, c.path->dimension));
  out += fmt::format("{} [{}]\n", title, io::status_name(step.status));
  if (!step.message.empty()) out += "  " + step.message + "\n";
  if (step.segments.empty()) return out + "  no state to show\n";
  double force = std::max({std::abs(step.axial_force_start), std::abs(step.axial_force_end), std::abs(step.push)});
  for (const Contact& k : step.contacts) force = std::max(force, std::abs(k.force));
  const double moment = force * step.rod_length;
  out += fmt::format("  rod length {}{}; F3 {} .. {}{}; M3 {} .. {}{}; push {}{}\n", cell(step.rod_length),
                     unit(c, Dimension::length), cell(step.axial_force_start, force), cell(step.axial_force_end, force),
                     unit(c, Dimension::force), cell(step.torque_start, moment), cell(step.torque_end, moment),
                     unit(c, Dimension::moment), cell(step.push, force), unit(c, Dimension::force));
  out += contacts(c, step);
  if (const auto stress = io::stress_report(c, step)) {
    const rod::SectionStress& s = stress->section;
    const std::string u = unit(c, Dimension::pressure);
    out += fmt::format(
        "  stress: largest von Mises {}{} at S = {} (axial {}, bending {}, torsion {}); largest strain {:.3g} %\n",
        cell(s.von_mises), u, cell(stress->S), cell(s.axial, s.von_mises), cell(s.bending),
        cell(s.torsion, s.von_mises), 100 * s.strain);
    const std::string warning = rod::small_strain_warning(s.strain);
    if (!warning.empty()) out += "  warning: " + warning + "\n";
  }
  out += fmt::format("  stability: {}{}{}\n", step.stability, step.branch.empty() ? "" : "; branch: ", step.branch);
  const auto& k = step.certificate;
  out += fmt::format(
      "  certificate: equilibrium {:.1e}, error {:.1e}, balance {:.1e}, continuity {:.1e}, invariants {:.1e}, gap min "
      "{:.2g}, reaction min {:.2g}, strain max {:.2g}\n",
      k.equilibrium, k.error, k.balance, k.continuity, k.invariant_spread, k.gap_min, k.reaction_min, k.strain_max);
  if (const auto& d = step.comparison)
    out += fmt::format(
        "  differences from {}: place {:.1e} L, directors {:.1e}, force {:.1e}, moment {:.1e} of the largest, rod "
        "length "
        "{:.1e} L\n",
        d->with, d->place, d->directors, d->force, d->moment, d->rod_length);
  return out;
}

// Of an axis from points or a survey: what the file holds and how the curve lies to it.
std::string curve_text(const io::Case& c) {
  if (!c.centreline) return "";
  const io::Centreline& line = *c.centreline;
  const std::string m = unit(c, Dimension::length);
  const bool survey = line.points.empty();
  std::string out = fmt::format("  {}: {} {}", line.format.empty() ? "points" : line.format,
                                survey ? line.md.size() : line.points.size(), survey ? "stations" : "points");
  if (!line.name.empty())
    out += fmt::format(", steps {} .. {}{}", cell(line.cleaning.step_min), cell(line.cleaning.step_max), m);
  if (!line.radius.empty()) {
    const auto [least, most] = std::minmax_element(line.radius.begin(), line.radius.end());
    out += fmt::format(", radius {} .. {}{}", cell(*least), cell(*most), m);
  }
  out += "\n";
  if (c.curve.smoothing > 0)
    out += fmt::format("  smooth curve: within {}{}{}; largest deviation {}{} at S = {}\n", cell(c.curve.smoothing), m,
                       survey ? " of minimum curvature" : " of every point", cell(c.curve.deviation), m,
                       cell(c.curve.deviation_S));
  if (c.curve.radius_smoothing > 0)
    out +=
        fmt::format("  smooth radius: within {}{}; largest deviation {}{} at S = {}\n", cell(c.curve.radius_smoothing),
                    m, cell(c.curve.radius_deviation), m, cell(c.curve.radius_deviation_S));
  return out;
}

}  // namespace

std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> width(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) width[i] = std::max(width[i], row[i].size());
  }
  std::string out;
  for (const auto& row : rows) {
    std::string line = " ";
    for (std::size_t i = 0; i < row.size(); ++i) line += fmt::format(" {:>{}}", row[i], width[i]);
    out += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return out;
}

std::string describe(const io::Case& c, const Result& result) {
  std::string out = (c.title.empty() ? c.name : c.title) + "\n";
  for (std::size_t i = 0; i < result.steps.size(); ++i)
    out += "\n" + step_text(c, result.steps[i], i, result.steps.size());
  if (c.path) {
    out += "\nevents\n";
    std::vector<std::vector<std::string>> rows{{c.path->parameter, "event", "S", "rod length", "F3 at end"}};
    if (c.si) rows.push_back({std::string(io::si_unit(c.path->dimension)), "", "m", "m", "N"});
    for (const auto& event : result.events) {
      rows.push_back({fmt::format("{:.9g}", event.parameter), event.kind, cell(event.S), cell(event.rod_length),
                      cell(event.axial_force_end)});
    }
    out += result.events.empty() ? "  none\n" : aligned(rows);
  }
  out += fmt::format("\n{}{}{}\n", io::status_name(result.status), result.message.empty() ? "" : ": ", result.message);
  return out;
}

std::string describe(const io::Case& c) {
  const segmentation::Problem problem = io::build_problem(c);
  const geometry::TubeQuality tube = geometry::check_tube(c.tube);
  const std::string m = unit(c, Dimension::length);
  std::string out = fmt::format("{}: valid{}{}\n", c.name, c.title.empty() ? "" : " - ", c.title);
  out += fmt::format(
      "  rod: EI {}{}, GJ {}{}, EA {}\n", cell(problem.rod.bending_stiffness), unit(c, Dimension::stiffness),
      cell(problem.rod.torsional_stiffness), unit(c, Dimension::stiffness),
      problem.rod.axial_stiffness ? cell(*problem.rod.axial_stiffness) + unit(c, Dimension::force) : "infinite");
  out += fmt::format("  axis: {}, length {}{}, total bend {:.4g} deg, largest curvature {}{} at S = {}\n",
                     c.word("tube.axis.kind"), cell(tube.length), m, tube.total_bend * 180 / std::numbers::pi,
                     cell(tube.curvature_max), c.si ? " 1/m" : "", cell(tube.curvature_max_S));
  out += curve_text(c);
  out += fmt::format("  clearance: {} .. {}{}; clearance x curvature at most {:.3g} (must stay below 1), at S = {}\n",
                     cell(tube.clearance_min), cell(tube.clearance_max), m, tube.curvature_clearance_max,
                     cell(tube.curvature_clearance_max_S));
  if (problem.load.force.norm() > 0) {
    out += fmt::format("  body force: [{}, {}, {}]{}\n", cell(problem.load.force[0]), cell(problem.load.force[1]),
                       cell(problem.load.force[2]), unit(c, Dimension::force_per_length));
  }
  if (c.path && c.path->motion) {
    out += fmt::format("  insertion: {} through {}\n", c.path->parameter, cell(c.path->values.back()));
  } else if (c.path) {
    out += fmt::format("  path: {} from {} through {} value{}{}\n", c.path->parameter, cell(c.path->start),
                       c.path->values.size(), c.path->values.size() == 1 ? "" : "s",
                       c.path->smooth ? "" : " (each rebuilds the problem)");
  }
  return out;
}

}  // namespace tendril::app

#include "branches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "console.hpp"
#include "tables.hpp"
#include "tendril/continuation/states.hpp"
#include "tendril/io/atomic_file.hpp"
#include "tendril/io/case.hpp"
#include "tendril/io/result_json.hpp"

namespace tendril::app {
namespace {

using continuation::StateFound;
using continuation::StatesFound;

std::string contacts_of(const continuation::Step& step) {
  const auto lines = std::count_if(step.contacts.begin(), step.contacts.end(), [](const auto& k) { return k.line; });
  const auto points = static_cast<std::ptrdiff_t>(step.contacts.size()) - lines;
  std::string out;
  if (points > 0) out += fmt::format("{} point{}", points, points > 1 ? "s" : "");
  if (lines > 0) out += fmt::format("{}{} line{}", out.empty() ? "" : ", ", lines, lines > 1 ? "s" : "");
  return out.empty() ? "none" : out;
}

std::string table(const io::Case& c, const StatesFound& found) {
  const auto unit = [&](io::Dimension d) {
    const std::string text(io::si_unit(d));
    return c.si && !text.empty() ? " " + text : std::string();
  };
  // names to the left, numbers to the right
  std::vector<std::vector<std::string>> rows{{"state", "stability", "rod length" + unit(io::Dimension::length),
                                              "energy" + (c.si ? std::string(" J") : ""),
                                              "end force" + unit(io::Dimension::force), "contacts"}};
  const auto cell = [](double x) { return std::isfinite(x) ? fmt::format("{:.8g}", x) : std::string("-"); };
  for (std::size_t i = 0; i < found.states.size(); ++i) {
    const StateFound& s = found.states[i];
    rows.push_back({std::to_string(i + 1), s.step.stability, cell(s.step.rod_length), cell(s.energy),
                    cell(s.step.axial_force_end), contacts_of(s.step)});
  }
  std::string out = fmt::format("{} state{} found in {} searches\n", found.states.size(),
                                found.states.size() == 1 ? "" : "s", found.starts) +
                    aligned(rows) + "\n";
  for (std::size_t i = 0; i < found.states.size(); ++i) {
    const StateFound& s = found.states[i];
    out += fmt::format("  {}: {}; {}\n", i + 1, s.kind(), s.step.branch);
    if (!s.step.message.empty()) out += "     " + s.step.message + "\n";
  }
  return out;
}

std::string json(const io::Case& c, const StatesFound& found, bool fields) {
  continuation::Result all;
  for (const StateFound& s : found.states) all.steps.push_back(s.step);
  all.status = found.states.empty() ? continuation::Status::not_converged : continuation::Status::converged;
  for (const auto& s : all.steps)
    if (s.status != continuation::Status::converged) all.status = s.status;
  all.message = found.message;
  auto j = nlohmann::ordered_json::parse(io::result_json(c, all, fields));
  auto& list = j["branches"] = nlohmann::ordered_json::array();
  for (const StateFound& s : found.states) {
    nlohmann::ordered_json x;
    x["kind"] = s.kind();
    x["energy"] = s.energy;
    x["weight_potential"] = s.weight;
    x["on_axis"] = s.on_axis;
    x["planar"] = s.planar;
    x["symmetric"] = s.symmetric;
    if (s.twin_of >= 0) {
      x["twin_of"] = s.twin_of;
      x["twin"] = s.twin;
    }
    list.push_back(std::move(x));
  }
  return j.dump(1) + "\n";
}

}  // namespace

int branches(const RunOptions& options) {
  const io::Case c = io::read_case(options.case_file, options.overrides);
  if (!options.quiet) {
    for (const std::string& note : c.notes) message("note: " + note + "\n");
    if (c.path) message("note: the states of the case as written; its [path] is not followed\n");
  }
  catch_interrupts();
  StatesFound found;
  {
    Progress bar(!options.quiet);
    continuation::StudyOptions study;
    study.solve = io::solve_options(c);
    study.solve.max_seconds = options.max_seconds;
    study.fields = options.fields;
    study.stop = &interrupted();
    study.progress = [&](double fraction, const std::string& what) { bar.update(fraction, what); };
    found = continuation::find_states(io::build_problem(c), study);
  }
  if (options.json == "-") {
    print(json(c, found, options.fields));
  } else {
    if (!options.json.empty()) io::write_file(options.json, json(c, found, options.fields));
    print(table(c, found));
  }
  if (interrupted()) {
    message("interrupted: what was found until then is given\n");
    return kInterrupted;
  }
  if (found.interrupted && !options.quiet) message("note: the time allowed ended the search\n");
  if (!found.states.empty()) return kSolved;
  message("tendril: " + found.message + "\n");
  return kNotConverged;
}

}  // namespace tendril::app

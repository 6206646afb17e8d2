// WITSML trajectories, 1.3/1.4 (<trajectory><trajectoryStation>) and 2.x (<Trajectory><TrajectoryStation>): measured
// depth, inclination and azimuth of each station with their units (uom). Stations may come in any order.

#include <algorithm>
#include <numeric>

#include "tendril/io/formats/polyline_file.hpp"
#include "tendril/io/formats/xml_text.hpp"

namespace tendril::io {
namespace {

void collect(pugi::xml_node node, std::string_view name, std::vector<pugi::xml_node>& found, int depth) {
  constexpr int kDeepest = 8;  // of envelopes around the trajectory
  for (const pugi::xml_node one : node) {
    if (one.type() != pugi::node_element) continue;
    if (local_name(one) == name)
      found.push_back(one);
    else if (depth < kDeepest)
      collect(one, name, found, depth + 1);
  }
}

}  // namespace

SurveyFile read_witsml(const std::shared_ptr<const Source>& source, Issues& issues) {
  SurveyFile out;
  out.source = source;
  const XmlText xml(source, source->text.size(), issues);
  if (!xml.good()) return out;
  std::vector<pugi::xml_node> trajectories;
  collect(xml.root(), "trajectory", trajectories, 0);
  if (trajectories.size() != 1) {
    Issue& issue =
        issues.add(trajectories.empty() ? Place{source, 1, 1, 1} : xml.place(trajectories[1]), "",
                   trajectories.empty() ? "the file has no trajectory" : "the file has several trajectories");
    issue.value = std::to_string(trajectories.size());
    issue.bound = "exactly one <trajectory>";
    issue.hint = trajectories.empty() ? "" : "keep the one that is meant";
    return out;
  }
  struct Quantity {
    const char* name;
    std::vector<double>* values;
    std::string* unit;
    const char* common;  // units that need no issue of their own
  };
  const Quantity quantities[3] = {{"md", &out.md, &out.md_unit, "m"},
                                  {"incl", &out.inc, &out.inc_unit, "dega"},
                                  {"azi", &out.azi, &out.azi_unit, "dega"}};
  std::size_t stations = 0, upright = 0;
  for (const pugi::xml_node station : trajectories[0]) {
    if (local_name(station) != "trajectorystation") continue;
    if (++stations > kMaxFilePoints || issues.size() >= 20) break;
    double row[3] = {0, 0, 0};
    for (int q = 0; q < 3; ++q) {
      const pugi::xml_node element = child(station, quantities[q].name);
      if (!element) {
        if (q == 2 && row[1] == 0) {  // azimuth means nothing there and is left out by some writers
          ++upright;
          continue;
        }
        Issue& issue =
            issues.add(xml.place(station), "", std::string("the station has no `") + quantities[q].name + "`");
        issue.bound = "md, incl and azi";
        continue;
      }
      const auto value = parse_number(text_of(element));
      if (!value) {
        Issue& issue = issues.add(xml.place(element), "", "this is not a number");
        issue.value = "\"" + std::string(text_of(element).substr(0, 40)) + "\"";
        continue;
      }
      row[q] = *value;
      const std::string unit = element.attribute("uom").value();
      std::string& known = *quantities[q].unit;
      if (stations == 1 || known.empty()) {
        known = unit;
      } else if (unit != known) {
        Issue& issue = issues.add(xml.place(element), "", "stations have different units");
        issue.value = unit;
        issue.bound = known + ", as the stations before";
      }
    }
    for (int q = 0; q < 3; ++q) quantities[q].values->push_back(row[q]);
    out.rows.push_back(xml.line(station));
  }
  if (stations == 0) issues.add(xml.place(trajectories[0]), "", "the trajectory has no stations");
  if (upright > 0) out.notes.push_back(std::to_string(upright) + " vertical stations without azimuth: taken as 0");
  if (!std::is_sorted(out.md.begin(), out.md.end()) && issues.empty()) {
    std::vector<std::size_t> order(out.md.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return out.md[a] < out.md[b]; });
    SurveyFile sorted = out;
    for (std::size_t i = 0; i < order.size(); ++i) {
      sorted.md[i] = out.md[order[i]], sorted.inc[i] = out.inc[order[i]], sorted.azi[i] = out.azi[order[i]];
      sorted.rows[i] = out.rows[order[i]];
    }
    sorted.notes.push_back("stations sorted by measured depth");
    return sorted;
  }
  return out;
}

}  // namespace tendril::io

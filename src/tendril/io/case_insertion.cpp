// The [insertion] of a case: what is moved, where to, and what a case asks of the mechanics.

#include <cmath>

#include "tendril/io/assemble.hpp"

namespace tendril::io {

void read_insertion(Case& c, const Node& table, const Locator& where, Issues& issues) {
  const Check check{c, where, issues};
  if (c.path || check.given("path.parameter")) {
    check.add("insertion", "a case has a [path] or an [insertion], not both");
    return;
  }
  const std::string kind = c.word("end.kind");
  const bool by_length = kind == "free" || kind == "tip" || c.has("end.rod_length") || c.has("start.rod_length");
  PathRequest path;
  path.motion = true;
  path.parameter = by_length ? "end.rod_length" : "end.position";
  path.dimension = Dimension::length;
  const Member *list = table.find("values"), *to = table.find("to");
  if (list && to) {
    check.add("insertion.to", "`insertion.to` and `insertion.values` exclude each other");
  } else if (list) {
    if (list->value.kind != Node::Kind::array || list->value.items.empty()) {
      issues.add(list->value.place, "insertion.values", "`insertion.values` must be a list of at least one number");
    } else {
      std::vector<double> values;
      for (const Node& item : list->value.items) {
        const auto value = read_quantity(item, *find_key("insertion.values"), Dimension::length, c.si, issues);
        if (value && !(*value > 0.0)) {
          Issue& issue = issues.add(item.place, "insertion.values", "a length of rod, or a place, must be positive");
          issue.value = shortest(*value);
          issue.bound = "> 0";
        }
        if (value) values.push_back(*value);
      }
      c.numbers["insertion.values"] = values;
      path.values = values;
    }
  } else if (to) {
    if (c.has("insertion.to")) path.values = {c.number("insertion.to")};
  } else {
    Issue& issue = check.add("insertion", "[insertion] needs `to`, or `values`");
    issue.hint = "to = 0.3 feeds the rod in to that length";
  }
  if (!by_length && c.tube.axis)
    for (double value : path.values)
      if (value > c.tube.length() * (1.0 + 1e-12)) {
        Issue& issue = check.add(list ? "insertion.values" : "insertion.to", "the far end would lie beyond the axis");
        issue.value = shortest(value);
        issue.bound = "<= " + shortest(c.tube.length()) + ", the length of the axis";
      }
  if (c.has("insertion.rotation") && c.word("start.kind") == "pinned" && c.has("start.torque"))
    check.add("insertion.rotation", "the inlet cannot be turned: its torque is given");
  if (c.word("solve.formulation", "eulerian") != "eulerian")
    check.add("insertion", "an insertion is solved in the Eulerian formulation only");
  if (issues.empty()) c.path = std::move(path);
}

continuation::Insertion insertion(const Case& c) {
  continuation::Insertion i;
  if (const auto it = c.numbers.find("insertion.values"); it != c.numbers.end()) i.values = it->second;
  i.to = c.number("insertion.to");
  i.step = c.number("insertion.step");
  i.rotation = c.number("insertion.rotation");
  return i;
}

continuation::Result run(const Case& c, const continuation::StudyOptions& options) {
  if (!c.path) return continuation::solve(build_problem(c), options);
  if (c.path->motion) return continuation::insert(build_problem(c), insertion(c), options);
  return continuation::follow([&](double p) { return build_problem(c, p); }, study_path(c), options);
}

}  // namespace tendril::io

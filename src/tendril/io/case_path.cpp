// The [path] of a case: which number it moves, where the case stands, and the problem at any value of it.

#include <algorithm>
#include <array>
#include <cmath>

#include "tendril/io/assemble.hpp"

namespace tendril::io {
namespace {

constexpr std::array<std::string_view, 4> kScales{"load.body_force.scale", "load.body_couple.scale", "load.point.scale",
                                                  "tube.clearance.scale"};

struct Target {
  std::string key;  // row of the table
  std::size_t index = 0;
};

// "end.slope.0" -> {end.slope, 0}
Target split(const std::string& parameter) {
  const std::size_t dot = parameter.rfind('.');
  if (dot != std::string::npos && dot + 2 == parameter.size() && parameter[dot + 1] >= '0' &&
      parameter[dot + 1] <= '2') {
    return {parameter.substr(0, dot), static_cast<std::size_t>(parameter[dot + 1] - '0')};
  }
  return {parameter, 0};
}

bool is_scale(const std::string& parameter) {
  return std::find(kScales.begin(), kScales.end(), parameter) != kScales.end();
}

// The scalar of the problem that is the parameter itself; none when the problem has to be built anew.
segmentation::Scalar* smooth_scalar(segmentation::Problem& problem, const std::string& parameter) {
  if (parameter == "load.body_force.scale") return &problem.body_force_scale;
  if (parameter == "load.body_couple.scale") return &problem.body_couple_scale;
  if (parameter == "load.point.scale") return &problem.point_load_scale;
  if (parameter == "tube.clearance.scale") return &problem.clearance_scale;
  if (parameter == "end.position") return &problem.end_position;
  const Target target = split(parameter);
  const std::size_t dot = target.key.find('.');
  const std::string end = target.key.substr(0, dot), name = dot == std::string::npos ? "" : target.key.substr(dot + 1);
  if (end != "start" && end != "end") return nullptr;
  segmentation::End& which = end == "start" ? problem.start : problem.end;
  if (name == "axial_force" || name == "push" || name == "rod_length") return &problem.axial_value;
  if (name == "torque" || name == "twist") return &problem.twist_value;
  if (name == "roll") return &which.roll;
  if (name == "eccentricity") return &which.eccentricity[target.index];
  if (name == "slope") return &which.slope[target.index];
  return nullptr;
}

bool can_move(const Key& key) {
  return (key.type == KeyType::number || key.type == KeyType::number_or_table || key.type == KeyType::pair ||
          key.type == KeyType::vector || key.type == KeyType::vector_or_table) &&
         key.path.compare(0, 5, "path.") != 0 && key.path.compare(0, 6, "solve.") != 0;
}

std::vector<std::string> parameters() {
  std::vector<std::string> names(kScales.begin(), kScales.end());
  for (const Key& key : keys()) {
    if (!can_move(key)) continue;
    const int components = key.type == KeyType::pair                                             ? 2
                           : key.type == KeyType::vector || key.type == KeyType::vector_or_table ? 3
                                                                                                 : 0;
    if (components == 0) names.push_back(key.path);
    for (int i = 0; i < components; ++i) names.push_back(key.path + "." + std::to_string(i));
  }
  return names;
}

}  // namespace

bool changes_tube(const std::string& parameter) {
  // rod diameters enter the clearance where the tube is given by its radius
  return (parameter.compare(0, 5, "tube.") == 0 && !is_scale(parameter)) ||
         parameter.find("diameter") != std::string::npos;
}

std::optional<double> current_value(const Case& c, const std::string& parameter) {
  if (is_scale(parameter)) return c.number(parameter, 1.0);
  const Target target = split(parameter);
  const Key* key = find_key(target.key);
  if (!key) return std::nullopt;
  if (c.numbers.count(target.key) != 0) {
    const auto& values = c.numbers.at(target.key);
    if (key->type == KeyType::number_or_table && values.size() > 1) return std::nullopt;
    if (key->type == KeyType::vector_or_table && values.size() > 3) return std::nullopt;
    return values.at(target.index);
  }
  if (parameter == "end.position" && c.tube.axis) return c.tube.length();
  const std::string name = target.key.substr(target.key.find('.') + 1);
  if (name == "eccentricity" || name == "slope" || name == "roll" || name == "body_force" || name == "body_couple")
    return 0.0;
  return std::nullopt;
}

void set_parameter(Case& c, const std::string& parameter, double value) {
  const Target target = split(parameter);
  const Key* key = is_scale(parameter) ? nullptr : find_key(target.key);
  const std::size_t count = !key                                                                    ? 1
                            : key->type == KeyType::pair                                            ? 2
                            : key->type == KeyType::vector || key->type == KeyType::vector_or_table ? 3
                                                                                                    : 1;
  std::vector<double>& values = c.numbers[is_scale(parameter) ? parameter : target.key];
  values.resize(std::max(values.size(), count), 0.0);
  values[is_scale(parameter) ? 0 : target.index] = value;
}

void read_path(Case& c, const Node& table, const Locator& where, Issues& issues) {
  const std::string parameter = c.word("path.parameter");
  if (parameter.empty()) return;  // reported as missing or of the wrong type
  const std::vector<std::string> known = parameters();
  const Place place = where.at("path.parameter");
  if (std::find(known.begin(), known.end(), parameter) == known.end()) {
    Issue& issue = issues.add(place, "path.parameter", "`path.parameter` does not name a number of the case");
    issue.value = "\"" + parameter + "\"";
    const Target target = split(parameter);
    const Key* key = find_key(target.key);
    const std::string near = nearest(parameter, known);
    if (key && (key->type == KeyType::pair || key->type == KeyType::vector || key->type == KeyType::vector_or_table)) {
      issue.hint = "name one component: \"" + target.key + ".0\"";
    } else if (!near.empty()) {
      issue.hint = "did you mean \"" + near + "\"?";
    }
    return;
  }
  PathRequest path;
  path.parameter = parameter;
  const Key* key = is_scale(parameter) ? nullptr : find_key(split(parameter).key);
  path.dimension = key ? key->dimension : Dimension::none;
  const std::optional<double> start = current_value(c, parameter);
  if (!start) {
    if (!issues.has(split(parameter).key) && c.tube.axis) {
      Issue& issue =
          issues.add(place, "path.parameter",
                     "the path starts from the case's own value of `" + parameter + "`, which it does not give");
      issue.hint = "give `" + parameter + "` a value in its table";
    }
    return;
  }
  path.start = *start;

  const Check check{c, where, issues};
  std::vector<std::pair<double, Place>> values;
  const auto number = [&](const Node& node, const char* name) {
    const auto value = read_quantity(node, *find_key(std::string("path.") + name), path.dimension, c.si, issues);
    if (value) values.emplace_back(*value, node.place);
    return value;
  };
  const Member *list = table.find("values"), *from = table.find("from"), *to = table.find("to"),
               *steps = table.find("steps");
  if (list && (from || to || steps)) {
    const char* other = from ? "path.from" : to ? "path.to" : "path.steps";
    issues.add(where.at(other), other, "`" + std::string(other) + "` and `path.values` exclude each other");
  } else if (list) {
    if (list->value.kind != Node::Kind::array || list->value.items.empty()) {
      issues.add(list->value.place, "path.values", "`path.values` must be a list of at least one number");
    } else {
      for (const Node& item : list->value.items) number(item, "values");
    }
  } else if (from && to && steps) {
    const auto a = number(from->value, "from"), b = number(to->value, "to");
    const double count = c.number("path.steps");
    values.clear();
    for (int i = 0; a && b && i < count; ++i) {
      const double t = i / (count - 1);
      values.emplace_back(i + 1 == count ? *b : *a + t * (*b - *a), i == 0 ? from->value.place : to->value.place);
    }
  } else {
    Issue& issue = issues.add(where.at("path"), "path", "[path] needs `values`, or all of `from`, `to` and `steps`");
    issue.hint = "values = [...] lists the values to report";
  }
  for (const auto& [value, unused] : values) path.values.push_back(value);
  if (!issues.empty()) return;

  // Each listed value must make a valid case by itself.
  segmentation::Problem probe = assemble(check, &c.tube);
  path.smooth = smooth_scalar(probe, parameter) != nullptr;
  for (const auto& [value, value_place] : values) {
    const bool low = !key || (key->open_min ? value > key->min : value >= key->min);
    const bool positive_scale = parameter != "tube.clearance.scale" || value > 0;
    if (!low || (key && value > key->max) || !positive_scale) {
      Issue& issue = issues.add(value_place, "path", "this value is out of bounds for `" + parameter + "`");
      issue.value = shortest(value);
      issue.bound = key ? accepted(*key) : "a number > 0";
      continue;
    }
    Case moved = c;
    set_parameter(moved, parameter, value);
    const Locator here{nullptr, value_place};
    Issues found;
    assemble({moved, here, found}, changes_tube(parameter) ? nullptr : &c.tube);
    if (parameter == "tube.clearance.scale") check_scaled_tube({moved, here, found}, c.tube, value);
    for (Issue& issue : found.list()) {
      issue.message = "at this value of `" + parameter + "`: " + issue.message;
      issues.list().push_back(std::move(issue));
    }
  }
  c.path = std::move(path);
}

segmentation::Problem build_problem(const Case& c, double parameter) {
  Issues issues;
  if (!c.path || c.path->motion) return build_problem(c);
  Case moved = c;
  set_parameter(moved, c.path->parameter, parameter);
  const Place place{std::make_shared<Source>(Source{c.name, "", false}), 0, 0, 1};
  segmentation::Problem problem =
      assemble({moved, {nullptr, place}, issues}, changes_tube(c.path->parameter) ? nullptr : &c.tube);
  issues.finish();
  if (c.path->smooth) {
    segmentation::Scalar* scalar = smooth_scalar(problem, c.path->parameter);
    *scalar = {parameter, 1.0};
  }
  return problem;
}

segmentation::Problem build_problem(const Case& c) {
  Issues issues;
  const Place place{std::make_shared<Source>(Source{c.name, "", false}), 0, 0, 1};
  segmentation::Problem problem = assemble({c, {nullptr, place}, issues}, &c.tube);
  issues.finish();
  return problem;
}

segmentation::SolveOptions solve_options(const Case& c) {
  segmentation::SolveOptions options;
  options.tolerance = c.number("solve.tolerance", options.tolerance);
  const std::string branch = c.word("solve.branch", "stable");
  using segmentation::BranchRule;
  options.branch = branch == "symmetric" ? BranchRule::symmetric
                   : branch == "planar"  ? BranchRule::planar
                   : branch == "nearest" ? BranchRule::nearest
                                         : BranchRule::stable;
  options.collocation_points = static_cast<int>(c.number("solve.collocation_points", options.collocation_points));
  options.residual_line_search = c.word("solve.damping") == "residual";
  using segmentation::Formulation;
  const std::string formulation = c.word("solve.formulation");
  if (formulation == "lagrangian") options.formulation = Formulation::lagrangian;
  if (formulation == "small_inclination") options.formulation = Formulation::small_inclination;
  options.nested = c.word("solve.nested") == "true";
  return options;
}

continuation::Path study_path(const Case& c) {
  if (!c.path) return {};
  return {c.path->start, c.path->values, c.path->smooth};
}

}  // namespace tendril::io

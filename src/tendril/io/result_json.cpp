#include "tendril/io/result_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tendril/geometry/tube_check.hpp"
#include "tendril/io/stress_report.hpp"
#include "tendril/version.hpp"

namespace tendril::io {
namespace {

using Json = nlohmann::ordered_json;
using continuation::Contact;
using continuation::Result;
using continuation::Step;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

Json list(const std::vector<double>& values) {
  Json out = Json::array();
  for (const double value : values) out.push_back(number(value));
  return out;
}

// Lists of plain values stay on one line; numbers by to_chars.
void dump(const Json& json, std::string& out, int indent) {
  const auto new_line = [&](int by) { out += '\n' + std::string(static_cast<std::size_t>(by), ' '); };
  if (json.is_object() && !json.empty()) {
    out += '{';
    bool first = true;
    for (const auto& [key, value] : json.items()) {
      if (!first) out += ',';
      first = false;
      new_line(indent + 2);
      out += Json(key).dump() + ": ";
      dump(value, out, indent + 2);
    }
    new_line(indent);
    out += '}';
  } else if (json.is_array() && !json.empty()) {
    const bool flat = std::none_of(json.begin(), json.end(), [](const Json& item) { return item.is_structured(); });
    out += '[';
    for (std::size_t i = 0; i < json.size(); ++i) {
      if (i > 0) out += flat ? ", " : ",";
      if (!flat) new_line(indent + 2);
      dump(json[i], out, indent + 2);
    }
    if (!flat) new_line(indent);
    out += ']';
  } else if (json.is_number_float()) {
    out += shortest(json.get<double>());
  } else {
    out += json.dump(-1, ' ', false, Json::error_handler_t::replace);
  }
}

Json contact_json(const Contact& contact) {
  Json json;
  json["kind"] = kind_name(contact);
  json["start"] = number(contact.start);
  json["end"] = number(contact.line ? contact.end : contact.start);
  json["s_start"] = number(contact.s_start);
  json["s_end"] = number(contact.line ? contact.s_end : contact.s_start);
  json["angle_start"] = number(contact.angle_start);
  json["angle_end"] = number(contact.line ? contact.angle_end : contact.angle_start);
  const auto of_line = [&](const Json& value) {
    return contact.line ? value : Json(nullptr);
  };  // a point has `force` only
  json["force_start"] = of_line(number(contact.force_start));
  json["force_end"] = of_line(number(contact.force_end));
  json["force_distributed"] = of_line(number(contact.force_distributed));
  json["force"] = number(contact.force);
  json["force_vector"] = list({contact.force_vector[0], contact.force_vector[1], contact.force_vector[2]});
  json["pressure_min"] = of_line(number(contact.pressure_min));
  json["pressure_max"] = of_line(number(contact.pressure_max));
  json["pressure_mid"] = of_line(number(contact.pressure_mid));
  return json;
}

Json certificate_json(const continuation::Certificate& c) {
  return {{"equilibrium", number(c.equilibrium)},
          {"gap_min", number(c.gap_min)},
          {"reaction_min", number(c.reaction_min)},
          {"curvature_max", number(c.curvature_max)},
          {"continuity", number(c.continuity)},
          {"balance", number(c.balance)},
          {"invariant_spread", number(c.invariant_spread)},
          {"error", number(c.error)},
          {"strain_max", number(c.strain_max)},
          {"phase_multiplier", number(c.phase_multiplier)}};
}

Json fields_json(const continuation::Fields& f) {
  Json json;
  const std::pair<const char*, const std::vector<double>*> columns[] = {
      {"S", &f.S},           {"s", &f.s},           {"x", &f.x},     {"y", &f.y},     {"z", &f.z},
      {"delta1", &f.delta1}, {"delta2", &f.delta2}, {"phi", &f.phi}, {"gap", &f.gap}, {"pressure", &f.pressure},
      {"F1", &f.F1},         {"F2", &f.F2},         {"F3", &f.F3},   {"M1", &f.M1},   {"M2", &f.M2},
      {"M3", &f.M3},         {"kappa", &f.kappa}};
  for (const auto& [name, values] : columns) json[name] = list(*values);
  return json;
}

Json stress_json(const StressReport& r) {
  return {{"S", number(r.S)},
          {"von_mises", number(r.section.von_mises)},
          {"axial", number(r.section.axial)},
          {"bending", number(r.section.bending)},
          {"torsion", number(r.section.torsion)},
          {"strain_max", number(r.section.strain)}};
}

Json step_json(const Case& c, const Step& step, bool fields) {
  Json json;
  json["parameter"] = number(step.parameter);
  json["status"] = status_name(step.status);
  json["message"] = step.message;
  json["rod_length"] = number(step.rod_length);
  json["axial_force_start"] = number(step.axial_force_start);
  json["axial_force_end"] = number(step.axial_force_end);
  json["torque_start"] = number(step.torque_start);
  json["torque_end"] = number(step.torque_end);
  json["push"] = number(step.push);
  json["contacts"] = Json::array();
  for (const Contact& contact : step.contacts) json["contacts"].push_back(contact_json(contact));
  json["segments"] = Json::array();
  for (const auto& segment : step.segments) {
    json["segments"].push_back(
        {{"kind", segment.line ? "line" : "free"}, {"start", number(segment.start)}, {"end", number(segment.end)}});
  }
  json["stability"] = step.stability;
  json["branch"] = step.branch;
  json["certificate"] = certificate_json(step.certificate);
  if (const auto& d = step.comparison)
    json["comparison"] = {
        {"with", d->with},           {"place", number(d->place)},   {"directors", number(d->directors)},
        {"force", number(d->force)}, {"moment", number(d->moment)}, {"rod_length", number(d->rod_length)},
        {"error", number(d->error)}};
  json["effort"] = {{"newton_iterations", step.effort.newton_iterations},
                    {"factorisations", step.effort.factorisations},
                    {"patterns_tried", step.effort.patterns_tried},
                    {"wall_seconds", number(step.effort.wall_seconds)}};
  if (const auto stress = stress_report(c, step)) json["stress"] = stress_json(*stress);
  if (fields) json["fields"] = fields_json(step.fields);
  const bool finite = std::all_of(step.state.begin(), step.state.end(), [](double v) { return std::isfinite(v); });
  json["state"] = finite ? list(step.state) : Json::array();
  return json;
}

// "tube.axis.radius" into nested objects. Keys that a path put in place of a scale are not keys of the file.
void put(Json& root, const std::string& path, Json value) {
  Json* at = &root;
  std::size_t from = 0;
  for (std::size_t dot; (dot = path.find('.', from)) != std::string::npos; from = dot + 1)
    at = &(*at)[path.substr(from, dot - from)];
  (*at)[path.substr(from)] = std::move(value);
}

// The value kept under `name`, if there is one, at a path of the output.
void put_value(Json& out, const std::string& path, const Case& c, const Key& key, const std::string& name) {
  if (const auto text = c.words.find(name); text != c.words.end())
    put(out, path, key.type == KeyType::boolean ? Json(text->second == "true") : Json(text->second));
  const auto it = c.numbers.find(name);
  if (it == c.numbers.end()) return;
  const std::vector<double>& values = it->second;
  if (key.type == KeyType::integer) {
    put(out, path, static_cast<long>(values[0]));
  } else if ((key.type == KeyType::number_or_table && values.size() > 1) ||
             (key.type == KeyType::vector_or_table && values.size() > 3)) {
    const std::size_t width = key.type == KeyType::number_or_table ? 2 : 4;
    Json rows = Json::array();
    for (std::size_t i = 0; i + width <= values.size(); i += width)
      rows.push_back(list(std::vector<double>(values.begin() + i, values.begin() + i + width)));
    put(out, path, rows);
  } else {
    put(out, path, values.size() == 1 ? number(values[0]) : list(values));
  }
}

// The case as understood: keys in the order of the table, numbers in case units, then what follows from them.
Json case_json(const Case& c) {
  Json json;
  json["file"] = c.name;
  for (const Key& key : keys()) {
    if (key.type == KeyType::tables) {
      Json rows = Json::array();
      for (int i = 0; i < static_cast<int>(c.number(key.path)); ++i) {
        Json row = Json::object();
        for (const Key* child : children(key.path)) {
          const std::string name = child->path.substr(key.path.size() + 1);
          put_value(row, name, c, *child, key.path + "." + std::to_string(i) + "." + name);
        }
        rows.push_back(row);
      }
      if (!rows.empty()) put(json, key.path, rows);
    } else {
      put_value(json, key.path, c, key, key.path);
    }
  }
  if (c.path && !c.path->motion) put(json, "path.values", list(c.path->values));
  if (const auto it = c.numbers.find("insertion.values"); it != c.numbers.end()) put(json, it->first, list(it->second));
  const segmentation::Problem problem = build_problem(c);
  Json resolved;
  resolved["units"] = c.si ? "m, N, N m, rad" : "as given";
  if (c.path && c.si) resolved["path_unit"] = si_unit(c.path->dimension);
  resolved["bending_stiffness"] = number(problem.rod.bending_stiffness);
  resolved["torsional_stiffness"] = number(problem.rod.torsional_stiffness);
  resolved["axial_stiffness"] = number(problem.rod.axial_stiffness);
  resolved["body_force"] = list({problem.load.force[0], problem.load.force[1], problem.load.force[2]});
  if (c.has("load.fluid_density")) resolved["buoyancy_factor"] = number(buoyancy_factor(c));
  resolved["axis_length"] = number(c.tube.length());
  resolved["clearance_start"] = number(c.tube.clearance->at(0.0)[0]);
  resolved["clearance_end"] = number(c.tube.clearance->at(c.tube.length())[0]);
  json["resolved"] = resolved;
  return json;
}

// The tube as sampled for drawings: even steps that turn by less than 3 degrees on average, and the knots.
Json tube_json(const Case& c) {
  constexpr double kStepsMin = 400, kStepsMax = 4000;
  const double length = c.tube.length(), bend = geometry::check_tube(c.tube).total_bend;
  const double steps = std::clamp(std::ceil(bend * 60 / std::numbers::pi), kStepsMin, kStepsMax);
  std::vector<double> S;
  for (double i = 0; i < steps; ++i) S.push_back(length * i / steps);
  S.push_back(length);
  S.insert(S.end(), c.tube.axis->knots().begin(), c.tube.axis->knots().end());
  std::sort(S.begin(), S.end());
  S.erase(std::unique(S.begin(), S.end()), S.end());

  Json json;
  json["side"] = c.tube.side == geometry::Side::inside ? "inside" : "outside";
  json["rod_radius"] = number(rod_radius(c));
  const char* names[] = {"S", "x", "y", "z", "D1x", "D1y", "D1z", "D2x", "D2y", "D2z", "clearance", "curvature"};
  for (const char* name : names) json[name] = Json::array();
  for (const double at : S) {
    const geometry::AxisPoint p = c.tube.axis->at(at);
    const double values[] = {at,
                             p.position[0],
                             p.position[1],
                             p.position[2],
                             p.frame(0, 0),
                             p.frame(1, 0),
                             p.frame(2, 0),
                             p.frame(0, 1),
                             p.frame(1, 1),
                             p.frame(2, 1),
                             c.tube.clearance->at(at)[0],
                             std::hypot(p.U[0][0], p.U[0][1])};
    for (std::size_t i = 0; i < std::size(names); ++i) json[names[i]].push_back(number(values[i]));
  }
  return json;
}

[[noreturn]] void not_a_result(const Node& node, const std::string& path, const std::string& message) {
  Issues issues;
  issues.add(node.place, "", message).hint = "a result file is what `tendril run --json " + path + "` writes";
  issues.finish();
  throw std::logic_error("unreachable");
}

constexpr std::size_t kMaxBytes = std::size_t{1} << 30;

const Member* result_steps(const Node& root, const std::string& path) {
  const Member* steps = root.find("steps");
  if (!root.find("result_schema") || !steps || steps->value.kind != Node::Kind::array)
    not_a_result(root, path, "this is not a result file");
  return steps;
}

}  // namespace

std::string_view status_name(continuation::Status status) {
  switch (status) {
    case continuation::Status::converged:
      return "converged";
    case continuation::Status::not_converged:
      return "not_converged";
    case continuation::Status::outside_validity:
      return "outside_validity";
  }
  return "";
}

std::string result_json(const Case& c, const Result& result, bool fields) {
  Json json;
  json["tendril"] = version();
  json["result_schema"] = 1;
  json["case"] = case_json(c);
  json["status"] = status_name(result.status);
  json["message"] = result.message;
  json["interrupted"] = result.interrupted;
  json["notes"] = c.notes;
  if (fields) json["tube"] = tube_json(c);
  json["steps"] = Json::array();
  for (const Step& step : result.steps) json["steps"].push_back(step_json(c, step, fields));
  json["events"] = Json::array();
  for (const auto& event : result.events) {
    json["events"].push_back({{"parameter", number(event.parameter)},
                              {"kind", event.kind},
                              {"S", number(event.S)},
                              {"rod_length", number(event.rod_length)},
                              {"axial_force_end", number(event.axial_force_end)}});
  }
  json["trace"] = Json::array();
  for (const auto& point : result.trace) {
    json["trace"].push_back({{"parameter", number(point.parameter)},
                             {"rod_length", number(point.rod_length)},
                             {"axial_force_end", number(point.axial_force_end)},
                             {"torque_end", number(point.torque_end)},
                             {"contacts", point.contacts}});
  }
  std::string out;
  dump(json, out, 0);
  return out + "\n";
}

std::string read_result(const std::string& path) {
  const auto source = std::make_shared<Source>(Source{path, read_text_file(path, kMaxBytes), false});
  result_steps(parse_json(source), path);
  return source->text;
}

std::vector<double> read_state(const std::string& path) {
  const auto source = std::make_shared<Source>(Source{path, read_text_file(path, kMaxBytes), false});
  const Node root = parse_json(source);
  const Member* steps = result_steps(root, path);
  for (auto step = steps->value.items.rbegin(); step != steps->value.items.rend(); ++step) {
    const Member* state = step->find("state");
    if (!state || state->value.kind != Node::Kind::array || state->value.items.empty()) continue;
    std::vector<double> values;
    for (const Node& item : state->value.items) {
      if (!item.is_number() || !std::isfinite(item.number))
        not_a_result(item, path, "a state is a list of finite numbers");
      values.push_back(item.number);
    }
    return values;
  }
  not_a_result(steps->value, path, "no step of this result has a state to start from");
}

}  // namespace tendril::io

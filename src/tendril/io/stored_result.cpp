#include "tendril/io/stored_result.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "tendril/io/result_json.hpp"

namespace tendril::io {
namespace {

using Json = nlohmann::ordered_json;
using namespace continuation;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double number(const Json& json) { return json.is_null() ? kNone : json.get<double>(); }
std::optional<double> optional(const Json& json) { return json.is_null() ? std::nullopt : std::optional(number(json)); }

std::vector<double> numbers(const Json& json) {
  std::vector<double> out;
  out.reserve(json.size());
  for (const Json& item : json) out.push_back(number(item));
  return out;
}

Status status(const std::string& name) {
  for (const Status s : {Status::converged, Status::outside_validity})
    if (name == status_name(s)) return s;
  return Status::not_converged;
}

Contact contact(const Json& json) {
  Contact k;
  const auto of_line = [&](const char* name) { return json.at(name).is_null() ? 0.0 : number(json.at(name)); };
  k.line = json.at("kind") == "line";
  k.collar = json.at("kind") == "collar";
  k.start = number(json.at("start")), k.end = number(json.at("end"));
  k.s_start = number(json.at("s_start")), k.s_end = number(json.at("s_end"));
  k.angle_start = number(json.at("angle_start")), k.angle_end = number(json.at("angle_end"));
  k.force_start = optional(json.at("force_start")), k.force_end = optional(json.at("force_end"));
  k.force = number(json.at("force")), k.force_distributed = of_line("force_distributed");
  for (int i = 0; i < 3; ++i) k.force_vector[i] = number(json.at("force_vector").at(i));
  k.pressure_min = of_line("pressure_min"), k.pressure_max = of_line("pressure_max");
  k.pressure_mid = of_line("pressure_mid");
  return k;
}

Step step(const Json& json) {
  Step s;
  s.parameter = optional(json.at("parameter"));
  s.status = status(json.at("status"));
  s.message = json.at("message");
  s.rod_length = number(json.at("rod_length"));
  s.axial_force_start = number(json.at("axial_force_start")), s.axial_force_end = number(json.at("axial_force_end"));
  s.torque_start = number(json.at("torque_start")), s.torque_end = number(json.at("torque_end"));
  s.push = number(json.at("push"));
  for (const Json& item : json.at("contacts")) s.contacts.push_back(contact(item));
  for (const Json& item : json.at("segments"))
    s.segments.push_back({item.at("kind") == "line", number(item.at("start")), number(item.at("end"))});
  s.stability = json.at("stability");
  s.branch = json.at("branch");
  const Json& c = json.at("certificate");
  const std::pair<const char*, double Certificate::*> figures[] = {
      {"equilibrium", &Certificate::equilibrium},
      {"gap_min", &Certificate::gap_min},
      {"reaction_min", &Certificate::reaction_min},
      {"curvature_max", &Certificate::curvature_max},
      {"continuity", &Certificate::continuity},
      {"balance", &Certificate::balance},
      {"invariant_spread", &Certificate::invariant_spread},
      {"error", &Certificate::error},
      {"strain_max", &Certificate::strain_max},
      {"phase_multiplier", &Certificate::phase_multiplier}};
  for (const auto& [name, member] : figures) s.certificate.*member = number(c.at(name));
  if (json.contains("fields"))
    for (const FieldColumn& column : field_columns())
      s.fields.*column.values = numbers(json.at("fields").at(column.name));
  s.state = numbers(json.at("state"));
  return s;
}

void read_case(const Json& json, Case& c) {
  c.name = json.value("file", "");
  c.title = json.value("title", "");
  c.si = json.value("units", "") == "si";
  for (const Key& key : keys()) {
    const Json* at = &json;
    for (std::size_t from = 0; at && from < key.path.size();) {
      const std::size_t dot = std::min(key.path.find('.', from), key.path.size());
      const auto found = at->is_object() ? at->find(key.path.substr(from, dot - from)) : at->end();
      at = at->is_object() && found != at->end() ? &*found : nullptr;
      from = dot + 1;
    }
    if (at && at->is_number()) c.numbers[key.path] = {at->get<double>()};
    if (at && at->is_string()) c.words[key.path] = at->get<std::string>();
  }
  if (!json.contains("path")) return;
  PathRequest path;
  path.parameter = c.word("path.parameter");
  const std::size_t dot = path.parameter.rfind('.');  // a component of a vector, or a number of its own
  const Key* key = find_key(path.parameter);
  if (!key && dot != std::string::npos) key = find_key(path.parameter.substr(0, dot));
  if (key) path.dimension = key->dimension;
  path.values = numbers(json.at("path").at("values"));
  c.path = path;
}

std::vector<TubeSection> sections(const Json& json) {
  std::vector<TubeSection> out(json.at("S").size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto at = [&](const std::string& name) { return number(json.at(name).at(i)); };
    out[i].S = at("S"), out[i].clearance = at("clearance");
    out[i].position = {at("x"), at("y"), at("z")};
    out[i].D1 = {at("D1x"), at("D1y"), at("D1z")};
    out[i].D2 = {at("D2x"), at("D2y"), at("D2z")};
  }
  return out;
}

}  // namespace

StoredResult read_stored_result(const std::string& path) {
  StoredResult stored;
  const std::string text = read_result(path);
  try {
    const Json json = Json::parse(text);
    stored.version = json.at("tendril");
    stored.case_text = json.at("case").dump();
    read_case(json.at("case"), stored.c);
    stored.result.status = status(json.at("status"));
    stored.result.message = json.at("message");
    stored.result.interrupted = json.value("interrupted", false);
    for (const Json& item : json.at("steps")) stored.result.steps.push_back(step(item));
    for (const Json& item : json.at("events"))
      stored.result.events.push_back({number(item.at("parameter")), item.at("kind"), number(item.at("S")),
                                      number(item.at("rod_length")), number(item.at("axial_force_end"))});
    for (const Json& item : json.at("trace"))
      stored.result.trace.push_back({number(item.at("parameter")), number(item.at("rod_length")),
                                     number(item.at("axial_force_end")), number(item.at("torque_end")),
                                     item.at("contacts").get<int>()});
    if (json.contains("tube")) stored.tube = sections(json.at("tube"));
  } catch (const Json::exception& error) {
    Issues issues;
    issues.add({std::make_shared<Source>(Source{path, "", false}), 0, 0, 1}, "",
               std::string("this result file is not complete: ") + error.what());
    issues.finish();
  }
  return stored;
}

}  // namespace tendril::io

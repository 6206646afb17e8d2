// The key table as a JSON Schema, for editors and other programs.

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tendril/io/keys.hpp"

namespace tendril::io {
namespace {

using Json = nlohmann::ordered_json;

Json quantity(const Key& key) {
  Json number = {{"type", "number"}};
  if (std::isfinite(key.min)) number[key.open_min ? "exclusiveMinimum" : "minimum"] = key.min;
  if (std::isfinite(key.max)) number["maximum"] = key.max;
  // path values take the unit of their parameter, so a string is allowed there too
  if (key.dimension == Dimension::none && key.path.compare(0, 5, "path.") != 0) return number;
  return {{"anyOf", Json::array({number, {{"type", "string"}, {"minLength", 1}}})}};
}

Json list_of(const Json& item, std::size_t count) {
  return {{"type", "array"}, {"items", item}, {"minItems", count}, {"maxItems", count}};
}

Json member(const Key& key);

Json object(std::string_view path) {
  Json properties = Json::object(), required = Json::array();
  for (const Key* child : children(path)) {
    const std::string name = child->path.substr(path.empty() ? 0 : path.size() + 1);
    properties[name] = member(*child);
    if (child->required) required.push_back(name);
  }
  Json out = {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
  if (!required.empty()) out["required"] = required;
  return out;
}

// A key that is not of this axis kind is refused, and kinds that cannot do without one require it.
Json axis_kinds() {
  Json rules = Json::array();
  for (const std::string& kind : find_key("tube.axis.kind")->words) {
    Json forbidden = Json::array(), required = Json::array();
    for (const Key* key : children("tube.axis")) {
      const std::string name = key->path.substr(std::string_view("tube.axis.").size());
      const bool mine = key->kinds.empty() || std::find(key->kinds.begin(), key->kinds.end(), kind) != key->kinds.end();
      if (!mine) forbidden.push_back({{"required", Json::array({name})}});
    }
    if (kind == "straight" || kind == "arc" || kind == "helix") required.push_back("length");
    if (kind == "helix") required.insert(required.end(), {"radius", "pitch_angle"});
    if (kind == "torus") required.push_back("major_radius");
    if (kind == "survey") required.push_back("file");
    Json then = {{"not", {{"anyOf", forbidden}}}};
    if (!required.empty()) then["required"] = required;
    rules.push_back(
        {{"if", {{"properties", {{"kind", {{"const", kind}}}}}, {"required", Json::array({"kind"})}}}, {"then", then}});
  }
  return rules;
}

Json member(const Key& key) {
  Json out;
  switch (key.type) {
    case KeyType::table:
      out = object(key.path);
      break;
    case KeyType::number:
      out = quantity(key);
      break;
    case KeyType::integer:
      out = {{"type", "integer"}};
      if (std::isfinite(key.min)) out["minimum"] = static_cast<long>(key.min);
      if (std::isfinite(key.max)) out["maximum"] = static_cast<long>(key.max);
      break;
    case KeyType::integers: {
      const Json one = {{"type", "integer"}, {"minimum", 0}};
      out = {{"anyOf", Json::array({one, {{"type", "array"}, {"minItems", 1}, {"items", one}}})}};
      if (key.path == "tube.axis.ends") out = list_of(one, 2);
      break;
    }
    case KeyType::boolean:
      out = {{"type", "boolean"}};
      break;
    case KeyType::text:
      out = {{"type", "string"}};
      break;
    case KeyType::word:
      out = {{"type", "string"}, {"enum", key.words}};
      break;
    case KeyType::pair:
      out = list_of(quantity(key), 2);
      break;
    case KeyType::vector:
      out = list_of(quantity(key), 3);
      break;
    case KeyType::points:
      out = {{"type", "array"}, {"minItems", 2}, {"items", list_of(quantity(key), 3)}};
      break;
    case KeyType::numbers:
      out = {{"type", "array"}, {"minItems", 1}, {"items", quantity(key)}};
      break;
    case KeyType::tables:
      out = {{"type", "array"}, {"items", object(key.path)}};
      break;
    case KeyType::number_or_pair:
      out = {{"anyOf", Json::array({quantity(key), list_of(quantity(key), 2)})}};
      break;
    case KeyType::number_or_table: {
      Json plain = {{"anyOf", Json::array({{{"type", "number"}}, {{"type", "string"}}})}};
      out = {
          {"anyOf", Json::array({quantity(key), {{"type", "array"}, {"minItems", 2}, {"items", list_of(plain, 2)}}})}};
      break;
    }
    case KeyType::vector_or_table: {
      Json plain = {{"anyOf", Json::array({{{"type", "number"}}, {{"type", "string"}}})}};
      out = {{"anyOf", Json::array({list_of(quantity(key), 3),
                                    {{"type", "array"}, {"minItems", 2}, {"items", list_of(plain, 4)}}})}};
      break;
    }
    case KeyType::not_yet:
      out = {{"not", Json::object()}};
      break;
  }
  std::string doc = key.doc;
  if (key.dimension != Dimension::none) doc += " [si: " + std::string(si_unit(key.dimension)) + "]";
  if (!key.fallback.empty()) doc += "; default: " + key.fallback;
  out["description"] = doc;
  if (key.path == "tube.axis") out["allOf"] = axis_kinds();
  return out;
}

}  // namespace

std::string json_schema() {
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Tendril case file, schema 1"}};
  const Json root = object("");
  for (const auto& [name, value] : root.items()) schema[name] = value;
  return schema.dump(2) + "\n";
}

}  // namespace tendril::io

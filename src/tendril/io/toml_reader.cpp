// TOML text to the document tree. The only translation unit that sees toml++, which is slow to compile.

#define TOML_EXCEPTIONS 1
#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

#include <cmath>

#include "tendril/io/diagnostics.hpp"
#include "tendril/io/document.hpp"

namespace tendril::io {
namespace {

Place place_of(const std::shared_ptr<const Source>& source, const toml::source_region& region) {
  Place place{source, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column), 1};
  if (region.end.line == region.begin.line && region.end.column > region.begin.column) {
    place.length = static_cast<int>(region.end.column - region.begin.column);
  }
  return place;
}

Node convert(const std::shared_ptr<const Source>& source, const toml::node& in) {
  Node out;
  out.place = place_of(source, in.source());
  if (const auto* table = in.as_table()) {
    out.kind = Node::Kind::table;
    for (const auto& [key, value] : *table) {
      out.members.push_back({std::string(key.str()), place_of(source, key.source()), convert(source, value)});
    }
  } else if (const auto* array = in.as_array()) {
    out.kind = Node::Kind::array;
    out.items.reserve(array->size());
    for (const auto& item : *array) out.items.push_back(convert(source, item));
  } else if (const auto* string = in.as_string()) {
    out.kind = Node::Kind::string;
    out.text = string->get();
  } else if (const auto* integer = in.as_integer()) {
    out.kind = Node::Kind::integer;
    out.number = static_cast<double>(integer->get());
    out.text = std::to_string(integer->get());
  } else if (const auto* number = in.as_floating_point()) {
    out.kind = Node::Kind::number;
    out.number = number->get();
    out.text = std::isfinite(out.number) ? shortest(out.number) : (std::isnan(out.number) ? "nan" : "inf");
  } else if (const auto* boolean = in.as_boolean()) {
    out.kind = Node::Kind::boolean;
    out.boolean = boolean->get();
    out.text = out.boolean ? "true" : "false";
  } else {  // dates and times: no key takes one, so they are refused as strings of the wrong form
    out.kind = Node::Kind::null;
    out.text = "a date or time";
  }
  return out;
}

std::string hint_for(const std::string& text, const toml::source_position& at, std::string_view message) {
  std::size_t from = 0;
  for (toml::source_index i = 1; i < at.line && from != std::string::npos; ++i) {
    from = text.find('\n', from);
    if (from != std::string::npos) ++from;
  }
  if (from != std::string::npos && at.column > 0) {
    std::size_t here = from + at.column - 1;
    while (here > from && (text[here - 1] == '.' || text[here - 1] == '-' || text[here - 1] == '+')) --here;
    if (here < text.size()) {
      std::size_t dot = here;
      while (dot < text.size() && (text[dot] == '-' || text[dot] == '+')) ++dot;
      if (dot < text.size() && text[dot] == '.') return "a TOML number has a digit before its point: write 0.5, not .5";
    }
  }
  if (message.find("redefin") != std::string_view::npos) return "each key and each [table] may appear once";
  return {};
}

}  // namespace

Node parse_toml(const std::shared_ptr<const Source>& source) {
  try {
    const toml::table table = toml::parse(std::string_view(source->text), std::string_view(source->name));
    Node root = convert(source, table);
    root.place = {source, 1, 1, 1};
    return root;
  } catch (const toml::parse_error& error) {
    Issues issues;
    Issue& issue = issues.add(place_of(source, error.source()), "", "TOML syntax: " + std::string(error.description()));
    issue.hint = hint_for(source->text, error.source().begin, error.description());
    issues.finish();
    throw;  // not reached
  }
}

}  // namespace tendril::io

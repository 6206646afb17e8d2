#pragma once
// The one table of case-file keys. Validation, `tendril schema`, `tendril explain` and did-you-mean all come from it,
// so they cannot drift apart.

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tendril/io/units.hpp"

namespace tendril::io {

enum class KeyType {
  table,
  tables,  // any number of tables, [[rod.section]]; the keys of the i-th are kept under "rod.section.i"
  number,  // a quantity of the row's dimension
  integer,
  integers,  // one or a list of them
  boolean,
  text,
  word,             // one of `words`
  pair,             // two quantities
  vector,           // three quantities
  number_or_pair,   // a quantity, or two: at the two ends of a stretch
  number_or_table,  // a quantity or [[S, value], ...]
  vector_or_table,  // three quantities or [[S, x, y, z], ...]
  points,           // [[x, y, z], ...]
  numbers,          // list of quantities
  not_yet,          // known, refused with the row's text
};

struct Key {
  std::string path;  // "end.axial_force"
  KeyType type = KeyType::table;
  Dimension dimension = Dimension::none;
  std::string doc = {};       // one line
  std::string fallback = {};  // default, for people; empty: none
  bool required = false;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open_min = false;  // value > min instead of >=
  std::vector<std::string> words = {};
  std::vector<std::string> alternatives = {};  // strings that a number may be instead
  std::vector<std::string> kinds = {};         // axis kinds a key of [tube.axis] belongs to; empty: all
  std::vector<std::string> not_yet = {};       // words known to the format that this version refuses
};

/// All keys, tables before their members.
const std::vector<Key>& keys();

const Key* find_key(std::string_view path);

/// Paths of the direct members of a table ("" is the root).
std::vector<const Key*> children(std::string_view path);

/// "a number > 0", "one of inside, outside", ...: what a key accepts.
std::string accepted(const Key& key);

/// What to write instead of an unknown key: a near name in the same table, or the table it belongs to.
std::string suggest_key(std::string_view path);

/// Text of `tendril explain PATH`; a table lists its members. Empty when there is no such key.
std::string explain(std::string_view path);

/// JSON Schema (draft-07) of the case file.
std::string json_schema();

}  // namespace tendril::io

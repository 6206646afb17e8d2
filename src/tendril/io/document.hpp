#pragma once
// The text of an input file as a tree of values that remember where they were written. TOML and JSON give the same
// tree, so everything above it (keys, units, checks, messages) is written once. Columns count characters from 1.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tendril::io {

/// One text that was read: a file, or one `--set` override.
struct Source {
  std::string name;  // as the user wrote it
  std::string text;
  bool is_override = false;
};

/// A position in a source. Line 0: the source as a whole.
struct Place {
  std::shared_ptr<const Source> source;
  int line = 0, column = 0;
  int length = 1;  // characters to underline
};

struct Member;

struct Node {
  enum class Kind { null, boolean, integer, number, string, array, table } kind = Kind::null;
  Place place;
  bool boolean = false;
  double number = 0.0;  // integers too
  std::string text;     // strings: the value; others: as written, for messages
  std::vector<Node> items;
  std::vector<Member> members;

  bool is_number() const { return kind == Kind::integer || kind == Kind::number; }
  const Member* find(std::string_view key) const;
  Member* find(std::string_view key);
};

struct Member {
  std::string key;
  Place place;
  Node value;
};

/// "a string", "an array", ...: the kind in the words of a message.
std::string_view kind_name(Node::Kind kind);

/// Parse a text; syntax errors throw InputError with their position.
Node parse_toml(const std::shared_ptr<const Source>& source);
Node parse_json(const std::shared_ptr<const Source>& source);

/// Read a whole file. Throws FileError.
std::string read_text_file(const std::string& path, std::size_t max_bytes);

}  // namespace tendril::io

// Document tree to Case: overrides, then every key against the table (known, right type, in bounds), then the parts.

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "tendril/io/assemble.hpp"
#include "tendril/io/centreline.hpp"

namespace tendril::io {
namespace {

constexpr std::size_t kMaxCaseBytes = std::size_t{64} << 20;  // long centrelines belong into a CSV file
constexpr std::size_t kMaxInlinePoints = 100000;

std::string found(const Node& node) {
  if (node.kind == Node::Kind::string) return "\"" + node.text + "\"";
  if (node.kind == Node::Kind::array || node.kind == Node::Kind::table) return std::string(kind_name(node.kind));
  return node.text;
}

void wrong_type(const Node& node, const Key& key, Issues& issues, const std::string& wanted) {
  const std::string what = node.kind == Node::Kind::null ? node.text : std::string(kind_name(node.kind));
  Issue& issue = issues.add(node.place, key.path, "`" + key.path + "` must be " + wanted + ", not " + what);
  issue.value = found(node);
  issue.bound = accepted(key);
  if (node.kind == Node::Kind::null && node.text == "null") issue.hint = "leave the key out";
}

bool within(double value, const Node& node, const Key& key, Issues& issues) {
  const bool low = key.open_min ? value > key.min : value >= key.min;
  if (low && value <= key.max) return true;
  Issue& issue = issues.add(node.place, key.path, "`" + key.path + "` is out of bounds");
  issue.value = found(node);
  issue.bound = accepted(key);
  return false;
}

class Walker {
 public:
  Walker(Case& c, Issues& issues, std::map<std::string, Place>& places) : c_(c), issues_(issues), places_(places) {}

  void table(const Node& node, const std::string& path, const Place& header) { table(node, path, path, header); }

  /// `name`: the path under which the values are kept, the number of the table included where there are several.
  void table(const Node& node, const std::string& path, const std::string& name, const Place& header) {
    for (const Member& member : node.members) {
      const std::string key_path = path.empty() ? member.key : path + "." + member.key;
      const Key* known = find_key(key_path);
      if (!known) {
        Issue& issue = issues_.add(member.place, key_path, "unknown key `" + key_path + "`");
        issue.hint = suggest_key(key_path);
        continue;
      }
      Key key = *known;
      if (name != path) key.path = name + "." + member.key;
      const bool is_table = key.type == KeyType::table;
      places_[key.path] = is_table ? member.place : member.value.place;
      value(member.value, key, member.place);
    }
    for (const Key* child : children(path)) {
      const std::string name = child->path.substr(path.empty() ? 0 : path.size() + 1);
      if (!child->required || node.find(name)) continue;
      const bool is_table = child->type == KeyType::table;
      Issue& issue = issues_.add(
          header, child->path, is_table ? "missing table [" + child->path + "]" : "missing key `" + child->path + "`");
      issue.bound = is_table ? "" : accepted(*child);
      issue.hint = child->doc;
    }
  }

 private:
  void value(const Node& node, const Key& key, const Place& key_place) {
    switch (key.type) {
      case KeyType::table:
        if (node.kind != Node::Kind::table) return wrong_type(node, key, issues_, "a table");
        return table(node, key.path, key_place);
      case KeyType::tables: {
        const bool good = node.kind == Node::Kind::array &&
                          std::all_of(node.items.begin(), node.items.end(),
                                      [](const Node& item) { return item.kind == Node::Kind::table; });
        if (!good) return wrong_type(node, key, issues_, accepted(key));
        for (std::size_t i = 0; i < node.items.size(); ++i) {
          const std::string name = key.path + "." + std::to_string(i);
          places_[name] = node.items[i].place.line > 0 ? node.items[i].place : key_place;
          table(node.items[i], key.path, name, places_[name]);
        }
        c_.numbers[key.path] = {static_cast<double>(node.items.size())};
        return;
      }
      case KeyType::not_yet: {
        issues_.add(key_place, key.path, "`" + key.path + "`: " + key.doc);
        return;
      }
      case KeyType::boolean:
        if (node.kind != Node::Kind::boolean) return wrong_type(node, key, issues_, "true or false");
        c_.words[key.path] = node.text;
        return;
      case KeyType::text:
      case KeyType::word:
        if (node.kind != Node::Kind::string) return wrong_type(node, key, issues_, "a string");
        if (key.type == KeyType::text || word(node, key)) c_.words[key.path] = node.text;
        return;
      case KeyType::integer:
        if (node.kind != Node::Kind::integer) return wrong_type(node, key, issues_, "an integer");
        if (key.path == "schema" && node.number != 1) {
          Issue& issue = issues_.add(node.place, key.path, "schema " + node.text + " is not known to this version");
          issue.bound = "1";
          return;
        }
        if (within(node.number, node, key, issues_)) c_.numbers[key.path] = {node.number};
        return;
      case KeyType::number:
      case KeyType::numbers:
        if (key.path.compare(0, 5, "path.") == 0) return;  // read with the parameter's unit, read_path
        if (key.type == KeyType::numbers) return;          // read_insertion
        if (node.kind == Node::Kind::string &&
            std::find(key.alternatives.begin(), key.alternatives.end(), node.text) != key.alternatives.end()) {
          c_.words[key.path] = node.text;
          return;
        }
        if (const auto number = read_quantity(node, key, key.dimension, c_.si, issues_))
          c_.numbers[key.path] = {*number};
        return;
      case KeyType::integers:
        return integers(node, key);
      case KeyType::number_or_pair:
        if (node.kind == Node::Kind::array) return row(node, key, 2);
        if (const auto number = read_quantity(node, key, key.dimension, c_.si, issues_))
          c_.numbers[key.path] = {*number};
        return;
      case KeyType::pair:
        return row(node, key, 2);
      case KeyType::vector:
        return row(node, key, 3);
      case KeyType::number_or_table:
        return number_or_table(node, key, 1);
      case KeyType::vector_or_table:
        if (node.kind != Node::Kind::array || node.items.empty() || node.items[0].kind != Node::Kind::array)
          return row(node, key, 3);
        return number_or_table(node, key, 3);
      case KeyType::points:
        return points(node, key);
    }
  }

  bool word(const Node& node, const Key& key) {
    for (const std::string& word : key.words) {
      if (word == node.text) return true;
    }
    for (const std::string& word : key.not_yet) {
      if (word != node.text) continue;
      Issue& issue = issues_.add(node.place, key.path, "`" + key.path + "` = \"" + word + "\" is not available yet");
      issue.bound = accepted(key);
      return false;
    }
    Issue& issue = issues_.add(node.place, key.path, "`" + key.path + "` does not know \"" + node.text + "\"");
    issue.bound = accepted(key);
    const std::string near = nearest(node.text, key.words);
    if (!near.empty()) issue.hint = "did you mean \"" + near + "\"?";
    return false;
  }

  void row(const Node& node, const Key& key, std::size_t count) {
    if (node.kind != Node::Kind::array) return wrong_type(node, key, issues_, accepted(key));
    if (node.items.size() != count) {
      Issue& issue = issues_.add(node.place, key.path, "`" + key.path + "` must be " + accepted(key));
      issue.value = std::to_string(node.items.size()) + " values";
      return;
    }
    std::vector<double> values;
    for (const Node& item : node.items) {
      if (const auto number = read_quantity(item, key, key.dimension, c_.si, issues_)) values.push_back(*number);
    }
    if (values.size() == count) c_.numbers[key.path] = std::move(values);
  }

  void integers(const Node& node, const Key& key) {
    std::vector<double> values;
    const auto take = [&](const Node& item) {
      if (item.kind != Node::Kind::integer) return wrong_type(item, key, issues_, accepted(key));
      if (within(item.number, item, key, issues_)) values.push_back(item.number);
    };
    const bool list = node.kind == Node::Kind::array;
    if (list) {
      for (const Node& item : node.items) take(item);
    } else {
      take(node);
    }
    const std::size_t wanted = key.path == "tube.axis.ends" ? 2 : 1;
    if (list && (wanted == 2 ? node.items.size() != 2 : node.items.empty())) {
      Issue& issue = issues_.add(node.place, key.path, "`" + key.path + "` must be " + accepted(key));
      issue.value = std::to_string(node.items.size()) + " values";
      return;
    }
    if (values.size() == (list ? node.items.size() : 1) && values.size() >= wanted)
      c_.numbers[key.path] = std::move(values);
  }

  /// A quantity, or rows of S and `count` quantities.
  void number_or_table(const Node& node, const Key& key, std::size_t count) {
    const std::string form = count == 1 ? "[S, value]" : "[S, x, y, z]";
    if (node.kind != Node::Kind::array) {
      if (const auto number = read_quantity(node, key, key.dimension, c_.si, issues_)) c_.numbers[key.path] = {*number};
      return;
    }
    Key place = key;  // S has the same unit and no lower bound
    place.min = -HUGE_VAL;
    std::vector<double> values;
    bool good = true;
    double last = -HUGE_VAL;
    for (const Node& pair : node.items) {
      if (pair.kind != Node::Kind::array || pair.items.size() != count + 1) {
        Issue& issue = issues_.add(pair.place, key.path,
                                   "each row of `" + key.path + "` is " + (count == 1 ? "a pair " : "") + form);
        issue.value = found(pair);
        good = false;
        continue;
      }
      const auto S = read_quantity(pair.items[0], place, Dimension::length, c_.si, issues_);
      std::vector<double> row;
      for (std::size_t i = 1; i <= count; ++i)
        if (const auto value = read_quantity(pair.items[i], key, key.dimension, c_.si, issues_)) row.push_back(*value);
      good = good && S && row.size() == count;
      if (!S || row.size() != count) continue;
      if (*S <= last) {
        Issue& issue =
            issues_.add(pair.items[0].place, key.path, "S must increase from row to row in `" + key.path + "`");
        issue.value = shortest(*S) + " after " + shortest(last);
        good = false;
      }
      last = *S;
      values.push_back(*S);
      values.insert(values.end(), row.begin(), row.end());
    }
    if (node.items.size() < 2) {
      Issue& issue = issues_.add(node.place, key.path, "a table of `" + key.path + "` has at least two rows " + form);
      issue.value = std::to_string(node.items.size()) + " rows";
      good = false;
    }
    if (good) c_.numbers[key.path] = std::move(values);
  }

  void points(const Node& node, const Key& key) {
    if (node.kind != Node::Kind::array) return wrong_type(node, key, issues_, accepted(key));
    if (node.items.size() > kMaxInlinePoints) {
      Issue& issue = issues_.add(node.place, key.path, "too many inline points");
      issue.value = std::to_string(node.items.size());
      issue.bound = "at most " + std::to_string(kMaxInlinePoints);
      issue.hint = "put them into a CSV file and name it with `tube.axis.file`";
      return;
    }
    auto centreline = std::make_shared<Centreline>();
    bool good = true;
    for (const Node& item : node.items) {
      if (item.kind != Node::Kind::array || item.items.size() != 3) {
        Issue& issue = issues_.add(item.place, key.path, "a point has three coordinates [x, y, z]");
        issue.value = found(item);
        good = false;
        continue;
      }
      geometry::Vec3 point;
      for (int i = 0; i < 3; ++i) {
        const auto number = read_quantity(item.items[i], key, key.dimension, c_.si, issues_);
        good = good && number;
        point[i] = number.value_or(0.0);
      }
      if (good && !centreline->points.empty() && point == centreline->points.back()) {
        issues_.add(item.place, key.path, "this point repeats the one before it");
        good = false;
      }
      centreline->points.push_back(point);
    }
    if (node.items.size() < 2) {
      Issue& issue = issues_.add(node.place, key.path, "a curve needs at least two points");
      issue.value = std::to_string(node.items.size());
      good = false;
    }
    if (good) c_.centreline = centreline;
    c_.words[key.path] = "inline";
  }

  Case& c_;
  Issues& issues_;
  std::map<std::string, Place>& places_;
};

CentrelineRequest request_of(const Case& c) {
  CentrelineRequest request;
  request.si = c.si;
  request.unit = c.word("tube.axis.file_unit");
  request.radius_array = c.word("tube.axis.radius_array");
  for (const auto& [key, list] :
       {std::pair{"tube.axis.branch", &request.path.branch}, std::pair{"tube.axis.ends", &request.path.ends}}) {
    if (const auto it = c.numbers.find(key); it != c.numbers.end()) {
      for (const double value : it->second) list->push_back(static_cast<std::size_t>(value));
    }
  }
  // Points of the case are in its own unit, those of the file in the file's.
  double scale = 1.0;
  if (c.si && !request.unit.empty()) {
    try {
      scale = parse_unit(request.unit, Dimension::length);
    } catch (const UnitError&) {  // reported where the file is read
    }
  }
  const auto point = [&](const std::string& key, std::optional<geometry::Vec3>& out) {
    if (!c.has(key)) return;
    out = geometry::Vec3(c.component(key, 0), c.component(key, 1), c.component(key, 2)) / scale;
  };
  point("tube.axis.start_near", request.path.start_near);
  point("tube.axis.end_near", request.path.end_near);
  return request;
}

void load_centreline(Case& c, const Locator& where, Issues& issues, const std::string& directory) {
  const std::string kind = c.word("tube.axis.kind"), file = c.word("tube.axis.file");
  if (file.empty() || (kind != "points" && kind != "survey")) return;
  for (const char* key : {"tube.axis.branch", "tube.axis.ends", "tube.axis.start_near", "tube.axis.end_near"}) {
    if (issues.has(key)) return;  // without it the file would be complained of for nothing
  }
  const std::filesystem::path given(file);
  const std::string path = given.is_absolute() ? file : (std::filesystem::path(directory) / given).string();
  Issues in_file, in_case;
  const Complain complain = [&](const std::string& key, const std::string& message) -> Issue& {
    return in_case.add(where.at(key), key, message);
  };
  try {
    const CentrelineRequest request = request_of(c);
    const auto source = read_source(path, file);
    auto read = kind == "points" ? read_points(source, request, in_file, complain, c.notes)
                                 : read_survey(source, request, in_file, complain, c.notes);
    if (in_file.empty() && in_case.empty()) c.centreline = std::make_shared<Centreline>(std::move(read));
  } catch (const FileError& error) {
    Issue& issue = issues.add(where.at("tube.axis.file"), "tube.axis.file", "cannot read the file of `tube.axis.file`");
    issue.value = error.what();
    issue.hint = "the name is relative to the directory of the case file";
    issue.unreadable = true;
  }
  for (Issue& issue : in_file.list()) {
    issue.key = "tube.axis.file";
    issues.list().push_back(std::move(issue));
  }
  for (Issue& issue : in_case.list()) issues.list().push_back(std::move(issue));
}

}  // namespace

std::optional<double> read_quantity(const Node& node, const Key& key, Dimension dimension, bool si, Issues& issues) {
  double value = 0.0;
  if (node.is_number()) {
    value = node.number;
  } else if (node.kind == Node::Kind::string && dimension != Dimension::none) {
    if (!si && node.text.find_first_of("0123456789") == std::string::npos) {
      wrong_type(node, key, issues, "a number");
      return std::nullopt;
    }
    if (!si) {
      Issue& issue = issues.add(node.place, key.path, "`" + key.path + "` has a unit, but units = \"dimensionless\"");
      issue.value = found(node);
      issue.hint = "write a number, or set units = \"si\"";
      return std::nullopt;
    }
    try {
      value = parse_quantity(node.text, dimension);
    } catch (const UnitError& error) {
      Issue& issue = issues.add(node.place, key.path, "`" + key.path + "`: " + error.what());
      issue.value = found(node);
      issue.bound = std::string(describe(dimension)) + ", e.g. \"" + std::string(example(dimension)) + "\"";
      issue.hint = error.hint;
      return std::nullopt;
    }
  } else {
    wrong_type(node, key, issues, "a number");
    return std::nullopt;
  }
  if (!std::isfinite(value)) {
    Issue& issue = issues.add(node.place, key.path, "`" + key.path + "` must be a finite number");
    issue.value = found(node);
    return std::nullopt;
  }
  if (!within(value, node, key, issues)) return std::nullopt;
  return value;
}

Case parse_case(const std::string& text, const std::string& name, Format format,
                const std::vector<std::string>& overrides, const std::string& directory) {
  const auto source = std::make_shared<Source>(Source{name, text, false});
  Issues issues;
  Node root = text.find_first_not_of(" \t\r\n") == std::string::npos ? Node{}
              : format == Format::json                               ? parse_json(source)
                                                                     : parse_toml(source);
  if (root.kind == Node::Kind::table ? root.members.empty() : root.kind == Node::Kind::null) {
    issues.add({source, 1, 1, 1}, "", "the case file is empty").hint =
        "`tendril explain` lists the keys; examples/ has complete cases";
    issues.finish();
  }
  if (root.kind != Node::Kind::table) {
    issues.add({source, 1, 1, 1}, "", "a case is a table of keys, not " + std::string(kind_name(root.kind)));
    issues.finish();
  }
  for (const std::string& override_text : overrides) apply_override(root, override_text, issues);

  Case c;
  c.name = name;
  if (const Member* units = root.find("units"))
    c.si = units->value.kind == Node::Kind::string && units->value.text == "si";
  std::map<std::string, Place> places;
  const Place top{source, 1, 1, 1};
  Walker(c, issues, places).table(root, "", top);
  c.title = c.word("title");
  const Locator where{&places, top};
  load_centreline(c, where, issues, directory);

  const Check check{c, where, issues, &c.notes, &c.curve};
  segmentation::Problem problem = assemble(check, nullptr);
  c.tube = problem.tube;
  if (const Member* path = root.find("path"); path && path->value.kind == Node::Kind::table)
    read_path(c, path->value, where, issues);
  if (const Member* motion = root.find("insertion"); motion && motion->value.kind == Node::Kind::table)
    read_insertion(c, motion->value, where, issues);
  issues.finish();
  return c;
}

Case read_case(const std::string& file, const std::vector<std::string>& overrides) {
  const std::string text = read_text_file(file, kMaxCaseBytes);
  const std::filesystem::path path(file);
  const Format format = path.extension() == ".json" ? Format::json : Format::toml;
  return parse_case(text, file, format, overrides, path.parent_path().string());
}

double Case::number(const std::string& key, double fallback) const { return component(key, 0, fallback); }

double Case::component(const std::string& key, std::size_t i, double fallback) const {
  const auto it = numbers.find(key);
  return it == numbers.end() || i >= it->second.size() ? fallback : it->second[i];
}

std::string Case::word(const std::string& key, const std::string& fallback) const {
  const auto it = words.find(key);
  return it == words.end() ? fallback : it->second;
}

}  // namespace tendril::io

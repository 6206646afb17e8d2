// `--set key=value`: changes to the document tree before it is read, so that every check sees them and errors point at
// the override itself.

#include "tendril/io/assemble.hpp"

namespace tendril::io {

void apply_override(Node& root, const std::string& text, Issues& issues) {
  auto source = std::make_shared<Source>(Source{"--set", text, true});
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    issues.add({source, 1, 1, static_cast<int>(text.size())}, "", "an override is written key=value").hint =
        "for example --set end.axial_force=-2.5";
    return;
  }
  std::string path = text.substr(0, equals);
  while (!path.empty() && path.back() == ' ') path.pop_back();
  const std::string value = text.substr(equals + 1);
  const bool remove = value.find_first_not_of(' ') == std::string::npos;

  Node parsed;
  if (!remove) {
    // The text itself is a TOML document whose value has the columns of the override.
    const std::string padded = "x" + std::string(equals - 1, ' ') + "=" + value;
    const std::size_t first = value.find_first_not_of(' ');
    try {
      const Node document = parse_toml(std::make_shared<Source>(Source{"--set", padded, true}));
      if (document.members.size() != 1) throw InputError({});
      parsed = document.members.front().value;
      if (parsed.kind == Node::Kind::null) throw InputError({});  // a date
    } catch (const InputError& error) {
      const char c = value[first];
      if (c == '[' || c == '{' || c == '"' || c == '\'') {
        for (Issue issue : error.issues()) {
          issue.excerpt = text;
          issues.list().push_back(issue);
        }
        return;
      }
      parsed.kind = Node::Kind::string;  // shells eat quotes: sleeve, 12 klbf
      parsed.text = value.substr(first);
    }
    const std::function<void(Node&)> relocate = [&](Node& node) {
      if (node.place.source)
        node.place.source = source;
      else
        node.place = {source, 1, static_cast<int>(equals + first) + 2, static_cast<int>(value.size() - first)};
      for (Node& item : node.items) relocate(item);
      for (Member& member : node.members) {
        member.place.source = source;
        relocate(member.value);
      }
    };
    relocate(parsed);
  }

  const Place key_place{source, 1, 1, static_cast<int>(path.size())};
  Node* node = &root;
  for (std::size_t from = 0;;) {
    const std::size_t dot = path.find('.', from);
    const std::string name = path.substr(from, dot == std::string::npos ? dot : dot - from);
    const bool last = dot == std::string::npos;
    if (name.empty()) {
      issues.add(key_place, path, "`" + path + "` is not a key path");
      return;
    }
    if (node->kind == Node::Kind::array) {
      std::size_t index = name.size();
      if (name.find_first_not_of("0123456789") == std::string::npos && name.size() < 9)
        index = std::stoul(name);
      else
        index = node->items.size();
      if (index >= node->items.size() || (last && remove)) {
        issues.add(key_place, path, "`" + path + "`: the array has no element `" + name + "` to set").value =
            std::to_string(node->items.size()) + " elements";
        return;
      }
      if (last) {
        node->items[index] = std::move(parsed);
        return;
      }
      node = &node->items[index];
    } else if (node->kind == Node::Kind::table) {
      Member* member = node->find(name);
      if (last && remove) {
        if (!member) {
          issues.add(key_place, path, "`" + path + "` is not in the case, so it cannot be removed").hint =
              suggest_key(path);
        } else {
          node->members.erase(node->members.begin() + (member - node->members.data()));
        }
        return;
      }
      if (last) {
        if (member)
          *member = {name, key_place, std::move(parsed)};
        else
          node->members.push_back({name, key_place, std::move(parsed)});
        return;
      }
      if (!member) {
        Node table;
        table.kind = Node::Kind::table;
        table.place = key_place;
        node->members.push_back({name, key_place, std::move(table)});
        member = &node->members.back();
      }
      node = &member->value;
    } else {
      issues.add(key_place, path, "`" + path.substr(0, from - 1) + "` is not a table");
      return;
    }
    from = dot + 1;
  }
}

}  // namespace tendril::io

#include "tendril/report/json_text.hpp"

#include <stdexcept>

namespace tendril::report {
namespace {

constexpr std::string_view kSpace = " \t\r\n";
constexpr int kMaxDepth = 64;  // a result nests a handful

class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) { space(); }

  [[noreturn]] void broken() const { throw std::invalid_argument("broken JSON at byte " + std::to_string(at_)); }
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool take(char c) {
    if (peek() != c) return false;
    ++at_;
    space();
    return true;
  }
  void expect(char c) {
    if (!take(c)) broken();
  }
  bool done() const { return at_ == text_.size(); }

  std::string_view string() {
    const std::size_t from = at_;
    if (peek() != '"') broken();
    for (++at_; peek() != '"'; ++at_) {
      if (at_ >= text_.size()) broken();
      if (peek() == '\\') ++at_;
    }
    ++at_;
    return ended(from);
  }

  std::string_view value(int depth = 0) {
    if (depth > kMaxDepth) broken();
    const std::size_t from = at_;
    if (peek() == '"') return string();
    if (peek() == '{' || peek() == '[') {
      const bool object = peek() == '{';
      const char close = object ? '}' : ']';
      take(text_[at_]);
      for (bool first = true; peek() != close; first = false) {
        if (!first) expect(',');
        if (object) {
          string();
          expect(':');
        }
        value(depth + 1);
      }
      ++at_;
      return ended(from);
    }
    at_ = std::min(text_.find_first_of(",]} \t\r\n\"{[:", at_), text_.size());
    if (at_ == from) broken();
    return ended(from);
  }

 private:
  void space() { at_ = std::min(text_.find_first_not_of(kSpace, at_), text_.size()); }
  std::string_view ended(std::size_t from) {
    const std::string_view out = text_.substr(from, at_ - from);
    space();
    return out;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

std::vector<TextMember> members(std::string_view value) {
  Scanner scan(value);
  std::vector<TextMember> out;
  scan.expect('{');
  while (scan.peek() != '}') {
    if (!out.empty()) scan.expect(',');
    const std::string_view key = scan.string();
    scan.expect(':');
    out.push_back({key.substr(1, key.size() - 2), scan.value()});
  }
  scan.expect('}');
  if (!scan.done()) scan.broken();
  return out;
}

std::vector<std::string_view> items(std::string_view value) {
  Scanner scan(value);
  std::vector<std::string_view> out;
  scan.expect('[');
  while (scan.peek() != ']') {
    if (!out.empty()) scan.expect(',');
    out.push_back(scan.value());
  }
  scan.expect(']');
  if (!scan.done()) scan.broken();
  return out;
}

std::string_view find(const std::vector<TextMember>& object, std::string_view key) {
  for (const TextMember& member : object) {
    if (member.key == key) return member.value;
  }
  return {};
}

void append_compact(std::string& out, std::string_view value) {
  bool inside = false;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const char c = value[i];
    if (inside && c == '\\' && i + 1 < value.size()) {
      out += c;
      out += value[++i];
    } else if (c == '<') {
      out += "\\u003c";
    } else if (inside || kSpace.find(c) == std::string_view::npos) {
      if (c == '"') inside = !inside;
      out += c;
    }
  }
}

}  // namespace tendril::report

// JSON text to the document tree, with positions (RFC 8259: no comments, no duplicate keys, no NaN).

#include <charconv>
#include <cmath>

#include "tendril/io/diagnostics.hpp"
#include "tendril/io/document.hpp"

namespace tendril::io {
namespace {

constexpr int kMaxDepth = 64;  // deeper than any case or result; keeps hostile files off the stack

class Parser {
 public:
  explicit Parser(std::shared_ptr<const Source> source) : source_(std::move(source)), text_(source_->text) {
    if (text_.substr(0, 3) == "\xEF\xBB\xBF") at_ = line_start_ = 3;
  }

  Node document() {
    skip_space();
    Node root = value(0);
    skip_space();
    if (at_ < text_.size()) fail("text after the end of the document");
    return root;
  }

 private:
  [[noreturn]] void fail(std::string message) {
    Issues issues;
    issues.add(here(), "", "JSON syntax: " + std::move(message));
    issues.finish();
    throw std::logic_error("unreachable");
  }

  Place here() const { return {source_, line_, static_cast<int>(at_ - line_start_) - wide_ + 1, 1}; }

  void skip_space() {
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\n') {
        ++line_;
        line_start_ = at_ + 1;
        wide_ = 0;
      } else if (c != ' ' && c != '\t' && c != '\r') {
        break;
      }
    }
  }

  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  bool word(std::string_view expected) {
    if (text_.substr(at_, expected.size()) != expected) return false;
    at_ += expected.size();
    return true;
  }

  Node value(int depth) {
    if (depth > kMaxDepth) fail("nested deeper than " + std::to_string(kMaxDepth) + " levels");
    Node node;
    node.place = here();
    const std::size_t from = at_;
    const char c = peek();
    if (at_ >= text_.size()) fail("a value is missing at the end of the file");
    if (c == '{') {
      object(node, depth);
    } else if (c == '[') {
      array(node, depth);
    } else if (c == '"') {
      node.kind = Node::Kind::string;
      node.text = string();
    } else if (c == '-' || (c >= '0' && c <= '9')) {
      number(node);
    } else if (word("true") || word("false")) {
      node.kind = Node::Kind::boolean;
      node.boolean = c == 't';
      node.text = node.boolean ? "true" : "false";
    } else if (word("null")) {
      node.text = "null";
    } else {
      fail("a value was expected");
    }
    if (node.place.line == line_) node.place.length = static_cast<int>(at_ - from);
    return node;
  }

  void object(Node& node, int depth) {
    node.kind = Node::Kind::table;
    ++at_;
    skip_space();
    if (peek() == '}') {
      ++at_;
      return;
    }
    while (true) {
      skip_space();
      if (peek() != '"') fail("a key in double quotes was expected");
      Member member;
      member.place = here();
      const std::size_t from = at_;
      member.key = string();
      member.place.length = static_cast<int>(at_ - from);
      if (node.find(member.key)) {
        at_ = from;
        fail("the key \"" + member.key + "\" appears twice");
      }
      skip_space();
      if (peek() != ':') fail("':' was expected after the key");
      ++at_;
      skip_space();
      member.value = value(depth + 1);
      node.members.push_back(std::move(member));
      skip_space();
      if (peek() == ',') {
        ++at_;
        continue;
      }
      if (peek() == '}') break;
      fail("',' or '}' was expected");
    }
    ++at_;
  }

  void array(Node& node, int depth) {
    node.kind = Node::Kind::array;
    ++at_;
    skip_space();
    if (peek() == ']') {
      ++at_;
      return;
    }
    while (true) {
      skip_space();
      node.items.push_back(value(depth + 1));
      skip_space();
      if (peek() == ',') {
        ++at_;
        continue;
      }
      if (peek() == ']') break;
      fail("',' or ']' was expected");
    }
    ++at_;
  }

  void number(Node& node) {
    std::size_t end = at_;
    auto digits = [&] {
      const std::size_t from = end;
      while (end < text_.size() && text_[end] >= '0' && text_[end] <= '9') ++end;
      return end > from;
    };
    if (text_[end] == '-') ++end;
    const std::size_t first = end;
    if (!digits()) fail("a digit was expected");
    if (text_[first] == '0' && end > first + 1) fail("a number does not start with 0");
    bool integer = true;
    if (end < text_.size() && text_[end] == '.') {
      integer = false;
      ++end;
      if (!digits()) fail("a digit was expected after the point");
    }
    if (end < text_.size() && (text_[end] == 'e' || text_[end] == 'E')) {
      integer = false;
      ++end;
      if (end < text_.size() && (text_[end] == '+' || text_[end] == '-')) ++end;
      if (!digits()) fail("a digit was expected in the exponent");
    }
    node.text = std::string(text_.substr(at_, end - at_));
    node.kind = integer ? Node::Kind::integer : Node::Kind::number;
    const auto result = std::from_chars(text_.data() + at_, text_.data() + end, node.number);
    if (result.ec == std::errc::result_out_of_range) {  // too large is refused later, with its key, as not finite
      const bool tiny = node.text.find("e-") != std::string::npos || node.text.find("E-") != std::string::npos;
      node.number = tiny ? 0.0 : HUGE_VAL;
    }
    at_ = end;
  }

  unsigned hex4() {
    unsigned code = 0;
    if (at_ + 4 > text_.size()) fail("four hexadecimal digits were expected");
    const auto result = std::from_chars(text_.data() + at_, text_.data() + at_ + 4, code, 16);
    if (result.ptr != text_.data() + at_ + 4) fail("four hexadecimal digits were expected");
    at_ += 4;
    return code;
  }

  static void append_utf8(std::string& out, unsigned code) {
    if (code < 0x80) {
      out += static_cast<char>(code);
    } else if (code < 0x800) {
      out += static_cast<char>(0xC0 | (code >> 6));
      out += static_cast<char>(0x80 | (code & 0x3F));
    } else if (code < 0x10000) {
      out += static_cast<char>(0xE0 | (code >> 12));
      out += static_cast<char>(0x80 | ((code >> 6) & 0x3F));
      out += static_cast<char>(0x80 | (code & 0x3F));
    } else {
      out += static_cast<char>(0xF0 | (code >> 18));
      out += static_cast<char>(0x80 | ((code >> 12) & 0x3F));
      out += static_cast<char>(0x80 | ((code >> 6) & 0x3F));
      out += static_cast<char>(0x80 | (code & 0x3F));
    }
  }

  std::string string() {
    std::string out;
    ++at_;
    while (true) {
      if (at_ >= text_.size() || text_[at_] == '\n') fail("the string is not closed");
      const char c = text_[at_++];
      if (c == '"') return out;
      if (static_cast<unsigned char>(c) < 0x20) fail("a control character inside a string");
      if (c != '\\') {
        if ((static_cast<unsigned char>(c) & 0xC0) == 0x80) ++wide_;
        out += c;
        continue;
      }
      const char escape = peek();
      ++at_;
      switch (escape) {
        case '"':
        case '\\':
        case '/':
          out += escape;
          break;
        case 'b':
          out += '\b';
          break;
        case 'f':
          out += '\f';
          break;
        case 'n':
          out += '\n';
          break;
        case 'r':
          out += '\r';
          break;
        case 't':
          out += '\t';
          break;
        case 'u': {
          unsigned code = hex4();
          if (code >= 0xD800 && code < 0xDC00) {
            if (!word("\\u")) fail("half of a surrogate pair");
            const unsigned low = hex4();
            if (low < 0xDC00 || low > 0xDFFF) fail("half of a surrogate pair");
            code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
          }
          append_utf8(out, code);
          break;
        }
        default:
          --at_;
          fail("unknown escape in a string");
      }
    }
  }

  std::shared_ptr<const Source> source_;
  std::string_view text_;
  std::size_t at_ = 0, line_start_ = 0;
  int line_ = 1;
  int wide_ = 0;  // continuation bytes so far in this line: columns count characters
};

}  // namespace

Node parse_json(const std::shared_ptr<const Source>& source) { return Parser(source).document(); }

}  // namespace tendril::io

#include "tendril/drawing/text.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>

namespace tendril::drawing {
namespace {

struct Run {
  std::string text;
  int shift = 0;  // -1 subscript, +1 superscript
};

bool alphanumeric(char c) {
  const auto first = static_cast<unsigned char>(c);  // of a character in UTF-8; Greek and Latin letters are two bytes
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (first >= 0xC3 && first < 0xE0);
}

std::size_t character_length(std::string_view text, std::size_t at) {
  const auto c = static_cast<unsigned char>(text[at]);
  const std::size_t length = c < 0x80 ? 1 : c < 0xE0 ? 2 : c < 0xF0 ? 3 : 4;
  return std::min(length, text.size() - at);
}

// `_` or `^` is markup before {...}, or before one character that ends its word: `F_3` but not `end_force`.
std::vector<Run> runs(std::string_view text) {
  std::vector<Run> list;
  const auto append = [&](std::string_view piece, int shift) {
    if (list.empty() || list.back().shift != shift) list.push_back({"", shift});
    list.back().text += piece;
  };
  for (std::size_t i = 0; i < text.size();) {
    const bool mark = (text[i] == '_' || text[i] == '^') && i > 0 && i + 1 < text.size();
    const int shift = text[i] == '_' ? -1 : 1;
    if (mark && text[i + 1] == '{') {
      const std::size_t close = text.find('}', i);
      if (close != std::string_view::npos) {
        append(text.substr(i + 2, close - i - 2), shift);
        i = close + 1;
        continue;
      }
    } else if (mark && alphanumeric(text[i + 1])) {
      const std::size_t length = character_length(text, i + 1);
      if (i + 1 + length == text.size() || !alphanumeric(text[i + 1 + length])) {
        append(text.substr(i + 1, length), shift);
        i += 1 + length;
        continue;
      }
    }
    const std::size_t length = character_length(text, i);
    append(text.substr(i, length), 0);
    i += length;
  }
  return list;
}

// In units of the font size.
double character_width(std::string_view c) {
  if (c.size() > 1) return c.size() == 2 ? 0.6 : 0.62;
  const std::string_view narrow = "iljI.,:;|'! ", slim = "ftr()[]{}/\\-\"*^", wide = "mMW@%";
  if (narrow.find(c[0]) != std::string_view::npos) return 0.28;
  if (slim.find(c[0]) != std::string_view::npos) return 0.35;
  if (wide.find(c[0]) != std::string_view::npos) return 0.88;
  if (c[0] >= 'A' && c[0] <= 'Z') return 0.7;
  if (c[0] == '<' || c[0] == '>' || c[0] == '=' || c[0] == '+' || c[0] == '~') return 0.6;
  return 0.556;
}

constexpr double kShiftedSize = 0.75;

}  // namespace

std::string escape_xml(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') out += c;
    }
  }
  return out;
}

double text_width(std::string_view text, double size) {
  double width = 0.0;
  for (const Run& run : runs(text)) {
    for (std::size_t i = 0; i < run.text.size();) {
      const std::size_t length = character_length(run.text, i);
      width += character_width(std::string_view(run.text).substr(i, length)) * (run.shift != 0 ? kShiftedSize : 1.0);
      i += length;
    }
  }
  constexpr double kWidestFont = 1.14;  // DejaVu Sans, where nothing narrower is installed
  return kWidestFont * width * size;
}

std::vector<std::string> wrap_text(const std::string& text, double size, double width) {
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    const std::string longer = line.empty() ? word : line + " " + word;
    if (!line.empty() && text_width(longer, size) > width) {
      lines.push_back(line);
      line = word;
    } else {
      line = longer;
    }
    begin = end + 1;
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

std::string text_spans(std::string_view text, double size) {
  std::string out;
  double raised = 0.0;  // of the pen above the base line [px]
  for (const Run& run : runs(text)) {
    const double wanted = run.shift > 0 ? 0.35 * size : run.shift < 0 ? -0.22 * size : 0.0;
    if (run.shift == 0 && raised == 0.0) {
      out += escape_xml(run.text);
      continue;
    }
    out += "<tspan dy=\"" + fixed(raised - wanted) + "\"";
    if (run.shift != 0) out += " font-size=\"" + fixed(kShiftedSize * size) + "\"";
    out += ">" + escape_xml(run.text) + "</tspan>";
    raised = wanted;
  }
  return out;
}

std::string text_html(std::string_view text) {
  std::string out;
  for (const Run& run : runs(text)) {
    const std::string content = escape_xml(run.text);
    out += run.shift < 0 ? "<sub>" + content + "</sub>" : run.shift > 0 ? "<sup>" + content + "</sup>" : content;
  }
  return out;
}

std::string plain_text(std::string_view text) {
  std::string out;
  for (const Run& run : runs(text)) out += run.text;
  return out;
}

std::string fixed(double value, int decimals) {
  char buffer[400];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals);
  std::string text(buffer, error == std::errc() ? end : buffer);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

}  // namespace tendril::drawing

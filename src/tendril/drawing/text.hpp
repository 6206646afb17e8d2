#pragma once
// Text of pictures: escaping, estimated widths (on the safe side for the usual fonts), wrapping, subscripts and
// superscripts.

#include <string>
#include <string_view>
#include <vector>

namespace tendril::drawing {

std::string escape_xml(std::string_view text);

/// Estimated width [px] at this font size; markup is not counted.
double text_width(std::string_view text, double size);

/// Lines no wider than `width` [px], broken at spaces.
std::vector<std::string> wrap_text(const std::string& text, double size, double width);

/// The text as content of an SVG <text>: escaped, `_` and `^` before one character or {...} set as shifted spans.
std::string text_spans(std::string_view text, double size);

/// The same for HTML, with <sub> and <sup>.
std::string text_html(std::string_view text);

/// Without the markup, for readers that see no typography.
std::string plain_text(std::string_view text);

/// Shortest decimal with at most `decimals` places.
std::string fixed(double value, int decimals = 2);

}  // namespace tendril::drawing

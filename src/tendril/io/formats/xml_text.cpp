#include "tendril/io/formats/xml_text.hpp"

#include <algorithm>
#include <cstring>

namespace tendril::io {

namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

}  // namespace

XmlText::XmlText(const std::shared_ptr<const Source>& source, std::size_t length, Issues& issues) : source_(source) {
  const std::string_view text = std::string_view(source->text).substr(0, length);
  line_starts_.push_back(0);
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') line_starts_.push_back(i + 1);
  }
  // parse_fragment: SimVascular writes two elements at the top. parse_doctype: only so that it can be refused.
  const pugi::xml_parse_result result = document_.load_buffer(
      text.data(), text.size(), pugi::parse_default | pugi::parse_fragment | pugi::parse_doctype, pugi::encoding_utf8);
  if (!result) {
    Issue& issue = issues.add(place(result.offset, 1), "", std::string("XML syntax: ") + result.description());
    issue.hint = "is the file complete?";
    return;
  }
  for (const pugi::xml_node node : document_) {
    if (node.type() != pugi::node_doctype) continue;
    issues.add(place(node.offset_debug(), 1), "", "document types (<!DOCTYPE ...>) are not accepted").hint =
        "remove it: none of the formats needs one";
    return;
  }
  good_ = true;
}

pugi::xml_node XmlText::top(std::string_view name) const {
  for (const pugi::xml_node node : document_) {
    if (node.type() == pugi::node_element && local_name(node) == name) return node;
  }
  return {};
}

Place XmlText::place(pugi::xml_node node) const {
  return place(node.offset_debug(), static_cast<int>(std::strlen(node.name())));
}

int XmlText::line(std::ptrdiff_t offset) const {
  const auto at = static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0));
  return static_cast<int>(std::upper_bound(line_starts_.begin(), line_starts_.end(), at) - line_starts_.begin());
}

Place XmlText::place(std::ptrdiff_t offset, int length) const {
  if (offset < 0) return {source_, 0, 0, 1};
  const auto at = static_cast<std::size_t>(offset);
  const int on = line(offset);
  const std::size_t start = line_starts_[static_cast<std::size_t>(on - 1)];
  const std::size_t stop = std::min(at, source_->text.size());
  const auto column = 1 + std::count_if(source_->text.begin() + static_cast<std::ptrdiff_t>(std::min(start, stop)),
                                        source_->text.begin() + static_cast<std::ptrdiff_t>(stop),
                                        [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
  return {source_, on, static_cast<int>(column), std::max(1, length)};
}

std::string local_name(pugi::xml_node node) {
  const std::string_view name = node.name();
  const std::size_t colon = name.rfind(':');
  return lower(colon == std::string_view::npos ? name : name.substr(colon + 1));
}

pugi::xml_node child(pugi::xml_node node, std::string_view name) {
  for (const pugi::xml_node one : node) {
    if (one.type() == pugi::node_element && local_name(one) == name) return one;
  }
  return {};
}

std::string_view text_of(pugi::xml_node node) {
  std::string_view text = node.text().get();
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace tendril::io

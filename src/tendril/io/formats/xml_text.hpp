#pragma once
// An XML text parsed by pugixml, whose elements know their line and column. Document types are refused, entities other
// than the five of XML itself are left as written. Not installed.

#include <pugixml.hpp>
#include <string_view>

#include "tendril/io/diagnostics.hpp"

namespace tendril::io {

class XmlText {
 public:
  /// Parse the first `length` bytes of the source; a syntax error becomes an issue.
  XmlText(const std::shared_ptr<const Source>& source, std::size_t length, Issues& issues);

  bool good() const { return good_; }
  pugi::xml_node root() const { return document_; }
  /// First element with this local name at the top, in any case of letters.
  pugi::xml_node top(std::string_view name) const;
  Place place(pugi::xml_node node) const;
  /// Its line alone, in logarithmic time.
  int line(pugi::xml_node node) const { return line(node.offset_debug()); }

 private:
  int line(std::ptrdiff_t offset) const;
  Place place(std::ptrdiff_t offset, int length) const;

  std::shared_ptr<const Source> source_;
  std::vector<std::size_t> line_starts_;
  pugi::xml_document document_;
  bool good_ = false;
};

/// Name without its namespace prefix, in lower case.
std::string local_name(pugi::xml_node node);

/// First child element with this local name (lower case).
pugi::xml_node child(pugi::xml_node node, std::string_view name);

/// Text of an element without blanks around it.
std::string_view text_of(pugi::xml_node node);

}  // namespace tendril::io

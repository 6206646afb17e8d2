// 3D Slicer markups (.mrk.json): the control points of each curve. Coordinates are RAS or LPS as the file says; both
// come out as LPS, the frame of DICOM and of Slicer's own VTK files. From one to the other x and y change their sign.

#include <charconv>

#include "tendril/io/formats/polyline_file.hpp"

namespace tendril::io {
namespace {

class Reader {
 public:
  Reader(PolylineFile& out, Issues& issues) : out_(out), issues_(issues) {}

  void markup(const Node& node, std::size_t index) {
    if (node.kind != Node::Kind::table) {
      issues_.add(node.place, "", "a markup is an object, not " + std::string(kind_name(node.kind)));
      return;
    }
    const Member* points = node.find("controlPoints");
    if (!points || points->value.kind != Node::Kind::array) {
      issues_.add(node.place, "", "the markup has no list `controlPoints`");
      return;
    }
    const bool ras = is_ras(node);
    const std::string unit = units(node);
    if (!out_.unit.empty() && out_.unit != unit) {
      Issue& issue = issues_.add(node.place, "", "the markups of this file have different units");
      issue.value = unit + " after " + out_.unit;
    }
    out_.unit = out_.radius_unit = unit;
    if (ras) {
      out_.notes.push_back("coordinates of markup " + std::to_string(index) +
                           " turned from RAS to LPS (x and y change their sign)");
    }
    std::vector<std::size_t> line;
    std::size_t skipped = 0;
    for (const Node& point : points->value.items) {
      if (const Member* status = point.find("positionStatus");
          status && status->value.text != "defined" && !status->value.text.empty()) {
        ++skipped;
        continue;
      }
      const Member* position = point.find("position");
      const bool three = position && position->value.kind == Node::Kind::array && position->value.items.size() == 3 &&
                         position->value.items[0].is_number() && position->value.items[1].is_number() &&
                         position->value.items[2].is_number();
      if (!three) {
        issues_.add(position ? position->value.place : point.place, "",
                    "a control point needs `position`, a list of three numbers");
        return;
      }
      const auto& xyz = position->value.items;
      const double sign = ras ? -1.0 : 1.0;
      line.push_back(out_.points.size());
      out_.points.emplace_back(sign * xyz[0].number, sign * xyz[1].number, xyz[2].number);
      out_.rows.push_back(position->value.place.line);
    }
    if (skipped > 0)
      out_.notes.push_back(std::to_string(skipped) + " control points without a defined position left out");
    radius(node, line.size());
    out_.lines.push_back(std::move(line));
  }

 private:
  bool is_ras(const Node& node) {
    const Member* member = node.find("coordinateSystem");
    if (!member) return false;
    const std::string& word = member->value.text;  // old files: 0 is RAS, 1 LPS
    if (word == "RAS" || word == "0") return true;
    if (word == "LPS" || word == "1") return false;
    Issue& issue = issues_.add(member->value.place, "", "unknown coordinate system");
    issue.value = "\"" + word + "\"";
    issue.bound = "LPS or RAS";
    return false;
  }

  static std::string units(const Node& node) {
    const Member* member = node.find("coordinateUnits");
    if (!member) return "mm";
    const Node& value = member->value;
    if (value.kind == Node::Kind::array && !value.items.empty()) return value.items.front().text;
    return value.text.empty() ? "mm" : value.text;
  }

  // A measurement with one value for each control point, as the extraction of centrelines writes it.
  void radius(const Node& node, std::size_t count) {
    const Member* measurements = node.find("measurements");
    if (!measurements || measurements->value.kind != Node::Kind::array) return;
    for (const Node& one : measurements->value.items) {
      const Member *name = one.find("name"), *values = one.find("controlPointValues");
      if (!name || !values || values->value.kind != Node::Kind::array || plain_name(name->value.text) != "radius")
        continue;
      if (values->value.items.size() != count) {
        Issue& issue = issues_.add(values->place, "", "the radius does not have one value for each control point");
        issue.value = std::to_string(values->value.items.size());
        issue.bound = std::to_string(count);
        return;
      }
      if (out_.radius.size() + count != out_.points.size()) return;  // earlier markups had none
      for (const Node& value : values->value.items) {
        if (!value.is_number()) {
          issues_.add(value.place, "", "a radius must be a number");
          return;
        }
        out_.radius.push_back(value.number);
      }
      return;
    }
  }

  PolylineFile& out_;
  Issues& issues_;
};

}  // namespace

PolylineFile read_slicer_markups(const std::shared_ptr<const Source>& source, Issues& issues) {
  PolylineFile out;
  out.source = source;
  out.place = {source, 1, 1, 1};
  Node root;
  try {
    root = parse_json(source);
  } catch (const InputError& error) {
    for (const Issue& issue : error.issues()) issues.list().push_back(issue);
    return out;
  }
  const Member* markups = root.find("markups");
  if (!markups || markups->value.kind != Node::Kind::array || markups->value.items.empty()) {
    Issue& issue = issues.add(markups ? markups->value.place : root.place, "", "this is not a file of markups");
    issue.bound = "{\"markups\": [{\"controlPoints\": [...]}]}";
    return out;
  }
  Reader reader(out, issues);
  std::size_t index = 0;
  for (const Node& markup : markups->value.items) {
    reader.markup(markup, index++);
    if (!issues.empty()) return out;
  }
  if (!out.radius.empty() && out.radius.size() != out.points.size()) {
    out.radius.clear();
    out.notes.push_back("radius left out: not every markup has one");
  }
  return out;
}

}  // namespace tendril::io

// SimVascular path (.pth): XML with a <path> of time steps, each with control points and the points of the curve
// through them. The curve's points are taken (of the first time step), the control points where there are none.

#include "tendril/io/formats/polyline_file.hpp"
#include "tendril/io/formats/xml_text.hpp"

namespace tendril::io {

PolylineFile read_simvascular_path(const std::shared_ptr<const Source>& source, Issues& issues) {
  PolylineFile out;
  out.source = source;
  const XmlText xml(source, source->text.size(), issues);
  if (!xml.good()) return out;
  const pugi::xml_node path = xml.top("path");
  const pugi::xml_node element = child(child(path, "timestep"), "path_element");
  if (!element) {
    Issue& issue = issues.add(path ? xml.place(path) : Place{source, 1, 1, 1}, "", "this is not a SimVascular path");
    issue.bound = "<path><timestep><path_element>";
    return out;
  }
  std::size_t steps = 0;
  for (const pugi::xml_node step : path) steps += local_name(step) == "timestep" ? 1 : 0;
  if (steps > 1) out.notes.push_back("the first of " + std::to_string(steps) + " time steps");
  out.place = xml.place(element);

  long bad = 0;
  const auto add = [&](pugi::xml_node at) {
    geometry::Vec3 point;
    int i = 0;
    for (const char* name : {"x", "y", "z"}) {
      const std::string_view text = at.attribute(name).value();
      const auto value = parse_number(text);
      if (!value && bad++ == 0) {
        Issue& issue = issues.add(
            xml.place(at), "",
            std::string("attribute `") + name + "` of a point is " + (text.empty() ? "missing" : "not a number"));
        if (!text.empty()) issue.value = "\"" + std::string(text.substr(0, 40)) + "\"";
      }
      point[i++] = value.value_or(0.0);
    }
    if (out.points.size() >= kMaxFilePoints) return;
    out.points.push_back(point);
    out.rows.push_back(xml.line(at));
  };
  for (const pugi::xml_node point : child(element, "path_points")) {
    if (local_name(point) != "path_point") continue;
    const pugi::xml_node position = child(point, "pos");
    add(position ? position : point);
  }
  if (out.points.empty()) {
    for (const pugi::xml_node point : child(element, "control_points")) {
      if (local_name(point) == "point") add(point);
    }
    if (!out.points.empty()) out.notes.push_back("control points, as the file has no path points");
  }
  if (out.points.empty()) issues.add(out.place, "", "the path has no points");
  std::vector<std::size_t> line(out.points.size());
  for (std::size_t i = 0; i < line.size(); ++i) line[i] = i;
  out.lines.push_back(std::move(line));
  return out;
}

}  // namespace tendril::io

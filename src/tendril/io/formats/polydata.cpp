// VTK PolyData XML (.vtp): points, lines, and the radius among the point arrays; ascii, base64 or appended, zlib or
// not.

#include <algorithm>
#include <charconv>
#include <cmath>

#include "tendril/io/formats/polyline_file.hpp"
#include "tendril/io/formats/vtk_array.hpp"
#include "tendril/io/formats/xml_text.hpp"

namespace tendril::io {
namespace {

constexpr std::size_t kMaxArrays = 1000;

// One file while it is read. Appended data are not XML when raw, so they are cut off before parsing.
class Reader {
 public:
  Reader(const std::shared_ptr<const Source>& source, const std::string& radius_array, Issues& issues)
      : source_(source), wanted_radius_(radius_array), issues_(issues) {}

  PolylineFile read() {
    PolylineFile out;
    out.source = source_;
    const std::string_view text = source_->text;
    std::size_t head = text.find("<AppendedData");
    if (head != std::string_view::npos) {
      const std::size_t close = text.find('>', head),
                        mark = text.find('_', close == std::string_view::npos ? head : close);
      if (close == std::string_view::npos || mark == std::string_view::npos || mark > close + 200) {
        issues_.add({source_, 0, 0, 1}, "", "the appended data do not start with \"_\"").hint = "is the file complete?";
        return out;
      }
      appended_ = text.substr(mark + 1);
      if (text.substr(head, close - head).find("base64") != std::string_view::npos) {
        appended_base64_ = true;
        appended_ = appended_.substr(0, appended_.find('<'));
      }
      // What follows is closed by hand; messages quote this part only.
      source_ =
          std::make_shared<Source>(Source{source_->name, std::string(text.substr(0, head)) + "</VTKFile>", false});
      out.source = source_;
    }
    const XmlText xml(source_, source_->text.size(), issues_);
    if (!xml.good()) return out;
    xml_ = &xml;
    place_ = {source_, 0, 0, 1};
    const pugi::xml_node file = xml.top("vtkfile");
    const std::string type = file.attribute("type").value();
    if (!file || type != "PolyData") {
      Issue& issue =
          issues_.add(file ? xml.place(file) : Place{source_, 1, 1, 1}, "", "this is not a VTK PolyData file");
      issue.value = file ? "type \"" + type + "\"" : "";
      issue.bound = "<VTKFile type=\"PolyData\">";
      return out;
    }
    if (!packing(file)) return out;
    std::size_t pieces = 0;
    for (const pugi::xml_node piece : child(file, "polydata")) {
      if (local_name(piece) != "piece") continue;
      ++pieces;
      if (!read_piece(piece, out)) return {};
    }
    out.place = place_;
    if (out.radius_place.line == 0) out.radius_place = place_;
    if (pieces == 0)
      issues_.add(xml.place(file), "", "the file has no <Piece>").hint = "is it complete?";
    else if (out.lines.empty())
      issues_.add(place_, "", "the file has no lines").hint =
          "a centreline is a PolyData with Lines; a surface (Polys) is not one";
    return out;
  }

 private:
  bool packing(pugi::xml_node file) {
    const std::string order = file.attribute("byte_order").value(), compressor = file.attribute("compressor").value(),
                      header = file.attribute("header_type").value();
    packing_.big_endian = order == "BigEndian";
    packing_.header_bytes = header == "UInt64" ? 8 : 4;
    packing_.zlib = compressor == "vtkZLibDataCompressor";
    if (compressor.empty() || packing_.zlib) return true;
    Issue& issue = issues_.add(xml_->place(file), "", "this compression is not supported");
    issue.value = compressor;
    issue.bound = "vtkZLibDataCompressor, or none";
    issue.hint = "write the file again with zlib or without compression";
    return false;
  }

  // A count that sizes an array; refused beyond what a centreline can have.
  std::optional<std::size_t> count(pugi::xml_node piece, const char* name) {
    const std::string_view text = piece.attribute(name).value();
    std::size_t value = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
    if (!text.empty() && end.ec == std::errc() && end.ptr == text.data() + text.size() && value <= kMaxFilePoints)
      return value;
    if (text.empty() && std::string_view(name) != "NumberOfPoints") return 0;
    Issue& issue =
        issues_.add(xml_->place(piece), "", std::string("`") + name + "` is not a count this reader accepts");
    issue.value = text.empty() ? "nothing" : "\"" + std::string(text.substr(0, 40)) + "\"";
    issue.bound = "a whole number up to " + std::to_string(kMaxFilePoints);
    return std::nullopt;
  }

  // `count` rows of an array with so many components; nothing after an issue.
  std::optional<std::vector<double>> numbers(pugi::xml_node array, std::size_t rows, int components) {
    const std::string name = array.attribute("Name").value(), format = array.attribute("format").value(),
                      type = array.attribute("type").value();
    const std::string label = "array \"" + (name.empty() ? std::string("Points") : name) + "\": ";
    const auto wrong = [&](const std::string& what, const std::string& value, const std::string& bound) -> Issue& {
      Issue& issue = issues_.add(xml_->place(array), "", label + what);
      issue.value = value;
      issue.bound = bound;
      return issue;
    };
    const int stated = array.attribute("NumberOfComponents").as_int(1);
    if (stated != components) {
      wrong("wrong number of components", std::to_string(stated), std::to_string(components));
      return std::nullopt;
    }
    if (vtk_type_bytes(type) == 0) {
      wrong("unknown type", "\"" + type + "\"", "Float64, Float32, Int64, Int32, ...");
      return std::nullopt;
    }
    const std::size_t total = rows * static_cast<std::size_t>(components);
    if (format == "ascii") return ascii(array, total, wrong);
    VtkPacking how = packing_;
    std::string_view data = text_of(array);
    how.base64 = true;
    if (format == "appended") {
      how.base64 = appended_base64_;
      const auto offset = static_cast<std::size_t>(array.attribute("offset").as_ullong());
      if (offset >= appended_.size()) {
        wrong("its offset lies beyond the appended data", std::to_string(offset),
              "< " + std::to_string(appended_.size()) + " bytes")
            .hint = "is the file complete?";
        return std::nullopt;
      }
      data = appended_.substr(offset);
    } else if (format != "binary") {
      wrong("unknown format", "\"" + format + "\"", "ascii, binary or appended");
      return std::nullopt;
    }
    try {
      return unpack(data, how, type, total);
    } catch (const VtkArrayError& error) {
      wrong(error.problem, error.value, error.bound).hint = error.hint;
      return std::nullopt;
    }
  }

  template <class Wrong>
  std::optional<std::vector<double>> ascii(pugi::xml_node array, std::size_t total, const Wrong& wrong) {
    const std::string_view text = text_of(array);
    if (total > text.size()) {  // a number takes at least one character
      wrong("too few numbers", "at most " + std::to_string(text.size()), std::to_string(total)).hint =
          "is the file complete?";
      return std::nullopt;
    }
    std::vector<double> out;
    out.reserve(total);
    for (std::size_t i = 0; i < text.size();) {
      const std::size_t from = text.find_first_not_of(" \t\r\n", i);
      if (from == std::string_view::npos) break;
      const std::size_t to = std::min(text.find_first_of(" \t\r\n", from), text.size());
      const auto value = parse_number(text.substr(from, to - from));
      if (!value) {
        wrong("this is not a number",
              "\"" + std::string(text.substr(from, std::min<std::size_t>(to - from, 40))) + "\"",
              "number " + std::to_string(out.size()) + " of the array");
        return std::nullopt;
      }
      if (out.size() == total) {
        wrong("too many numbers", "more than " + std::to_string(total), std::to_string(total));
        return std::nullopt;
      }
      out.push_back(*value);
      i = to;
    }
    if (out.size() == total) return out;
    wrong("too few numbers", std::to_string(out.size()), std::to_string(total)).hint = "is the file complete?";
    return std::nullopt;
  }

  bool read_piece(pugi::xml_node piece, PolylineFile& out) {
    const auto points = count(piece, "NumberOfPoints"), lines = count(piece, "NumberOfLines");
    if (!points || !lines) return false;
    const std::size_t before = out.points.size();
    if (before + *points > kMaxFilePoints || out.lines.size() + *lines > kMaxFilePoints) {
      Issue& issue = issues_.add(xml_->place(piece), "", "the file has too many points");
      issue.bound = "at most " + std::to_string(kMaxFilePoints);
      return false;
    }
    const pugi::xml_node coordinates = child(child(piece, "points"), "dataarray");
    if (*points == 0) return true;
    if (!coordinates) {
      issues_.add(xml_->place(piece), "", "the piece has no <Points>").hint = "is the file complete?";
      return false;
    }
    if (place_.line == 0) place_ = xml_->place(coordinates);
    const auto xyz = numbers(coordinates, *points, 3);
    if (!xyz) return false;
    for (std::size_t i = 0; i < *points; ++i)
      out.points.emplace_back((*xyz)[3 * i], (*xyz)[3 * i + 1], (*xyz)[3 * i + 2]);
    return read_radius(piece, *points, before, out) && (*lines == 0 || read_lines(piece, *lines, *points, before, out));
  }

  bool read_radius(pugi::xml_node piece, std::size_t points, std::size_t before, PolylineFile& out) {
    pugi::xml_node found;
    std::string names;
    std::size_t best = radius_names().size(), arrays = 0;
    for (const pugi::xml_node array : child(piece, "pointdata")) {
      if (local_name(array) != "dataarray" || ++arrays > kMaxArrays) continue;
      const std::string name = array.attribute("Name").value();
      names += (names.empty() ? "" : ", ") + name;
      if (!wanted_radius_.empty()) {
        if (name == wanted_radius_) found = array;
        continue;
      }
      const auto& known = radius_names();
      const auto rank =
          static_cast<std::size_t>(std::find(known.begin(), known.end(), plain_name(name)) - known.begin());
      if (rank < best) best = rank, found = array;
    }
    if (!found && !wanted_radius_.empty()) {
      Issue& issue = issues_.add(xml_->place(piece), "", "there is no point array \"" + wanted_radius_ + "\"");
      issue.value = names.empty() ? "no point arrays" : "point arrays " + names;
      return false;
    }
    if (!found != out.radius.empty() && before > 0) {
      issues_.add(xml_->place(piece), "", "only some pieces of the file have a radius").hint =
          "name the array with `tube.axis.radius_array`";
      return false;
    }
    if (!found) return true;
    const auto radius = numbers(found, points, 1);
    if (!radius) return false;
    out.radius.insert(out.radius.end(), radius->begin(), radius->end());
    if (out.radius_place.line == 0) out.radius_place = xml_->place(found);
    if (before == 0) out.notes.push_back("radius: point array " + std::string(found.attribute("Name").value()));
    return true;
  }

  bool read_lines(pugi::xml_node piece, std::size_t lines, std::size_t points, std::size_t before, PolylineFile& out) {
    pugi::xml_node connectivity, offsets;
    const pugi::xml_node cells = child(piece, "lines");
    for (const pugi::xml_node array : cells) {
      const std::string name = array.attribute("Name").value();
      if (name == "connectivity") connectivity = array;
      if (name == "offsets") offsets = array;
    }
    if (!connectivity || !offsets) {
      issues_.add(xml_->place(cells ? cells : piece), "", "the lines need the arrays connectivity and offsets");
      return false;
    }
    const auto stops = numbers(offsets, lines, 1);
    if (!stops) return false;
    const auto wrong = [&](pugi::xml_node array, std::size_t i, double value, const std::string& bound) {
      Issue& issue = issues_.add(xml_->place(array), "",
                                 std::string("array \"") + array.attribute("Name").value() + "\": entry " +
                                     std::to_string(i) + " is out of bounds");
      issue.value = shortest(value);
      issue.bound = bound;
      return false;
    };
    double last = 0;
    for (std::size_t i = 0; i < lines; ++i) {
      const double stop = (*stops)[i];
      if (!(stop >= last && stop <= 4.0 * kMaxFilePoints && stop == std::floor(stop)))
        return wrong(offsets, i, stop, ">= " + shortest(last) + " and <= " + std::to_string(4 * kMaxFilePoints));
      last = stop;
    }
    const auto indices = numbers(connectivity, static_cast<std::size_t>(last), 1);
    if (!indices) return false;
    for (std::size_t i = 0; i < indices->size(); ++i) {
      const double index = (*indices)[i];
      if (!(index >= 0 && index < static_cast<double>(points) && index == std::floor(index)))
        return wrong(connectivity, i, index, ">= 0 and < " + std::to_string(points) + ", the number of points");
    }
    std::size_t from = 0;
    for (std::size_t i = 0; i < lines; ++i) {
      const auto to = static_cast<std::size_t>((*stops)[i]);
      std::vector<std::size_t> line;
      for (std::size_t k = from; k < to; ++k) line.push_back(before + static_cast<std::size_t>((*indices)[k]));
      out.lines.push_back(std::move(line));
      from = to;
    }
    return true;
  }

  std::shared_ptr<const Source> source_;
  const std::string& wanted_radius_;
  Issues& issues_;
  const XmlText* xml_ = nullptr;
  VtkPacking packing_;
  std::string_view appended_;
  bool appended_base64_ = false;
  Place place_;
};

}  // namespace

PolylineFile read_polydata(const std::shared_ptr<const Source>& source, const std::string& radius_array,
                           Issues& issues) {
  return Reader(source, radius_array, issues).read();
}

}  // namespace tendril::io

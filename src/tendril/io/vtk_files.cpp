// ParaView files: PolyData XML with raw appended arrays (64-bit headers, little endian).

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>

#include "tendril/io/result_files.hpp"

namespace tendril::io {
namespace {

using continuation::Step;
using geometry::Vec3;

// Collects arrays behind the XML: offset, byte count, bytes.
class Appended {
 public:
  template <class T>
  std::string array(const std::string& name, const std::vector<T>& values, int components = 1) {
    const char* type = std::is_same_v<T, double> ? "Float64" : "Int64";
    std::string tag = "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                      std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(data_.size()) +
                      "\"/>\n";
    const std::uint64_t bytes = values.size() * sizeof(T);
    data_.append(reinterpret_cast<const char*>(&bytes), sizeof bytes);
    data_.append(reinterpret_cast<const char*>(values.data()), bytes);
    return tag;
  }
  const std::string& data() const { return data_; }

 private:
  std::string data_;
};

std::string poly_data(std::size_t points, const std::string& counts, const std::string& field_data,
                      const std::string& point_data, const std::string& point_array, const std::string& cells,
                      const Appended& appended) {
  const char* order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"" + std::string(order) +
         "\" header_type=\"UInt64\">\n<PolyData>\n" + field_data + "<Piece NumberOfPoints=\"" + std::to_string(points) +
         "\" " + counts + ">\n<PointData>\n" + point_data + "</PointData>\n<Points>\n" + point_array + "</Points>\n" +
         cells + "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_" + appended.data() +
         "\n</AppendedData>\n</VTKFile>\n";
}

std::vector<double> finite(const std::vector<double>& values, std::size_t count) {
  std::vector<double> out(values);
  out.resize(count, 0.0);
  for (double& v : out) v = std::isfinite(v) ? v : 0.0;
  return out;
}

}  // namespace

std::string rod_vtp(const Case& c, const Step& step) {
  const continuation::Fields& f = step.fields;
  const std::size_t n = std::min({f.x.size(), f.y.size(), f.z.size()});
  Appended appended;
  std::vector<double> xyz, tangent, radius(n, rod_radius(c).value_or(0.0));
  for (std::size_t i = 0; i < n; ++i) xyz.insert(xyz.end(), {f.x[i], f.y[i], f.z[i]});
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t a = i == 0 ? 0 : i - 1, b = i + 1 < n ? i + 1 : i;
    const Vec3 chord = Vec3(f.x[b], f.y[b], f.z[b]) - Vec3(f.x[a], f.y[a], f.z[a]);
    const Vec3 unit = chord.norm() > 0 ? Vec3(chord / chord.norm()) : Vec3(Vec3::Zero());
    tangent.insert(tangent.end(), {unit[0], unit[1], unit[2]});
  }
  xyz = finite(xyz, 3 * n);
  std::string point_data = appended.array("radius", radius) + appended.array("tangent", finite(tangent, 3 * n), 3);
  const std::pair<const char*, const std::vector<double>*> arrays[] = {
      {"S", &f.S},   {"s", &f.s},   {"gap", &f.gap},     {"pressure", &f.pressure},
      {"F1", &f.F1}, {"F2", &f.F2}, {"F3", &f.F3},       {"M1", &f.M1},
      {"M2", &f.M2}, {"M3", &f.M3}, {"kappa", &f.kappa}, {"phi", &f.phi}};
  for (const auto& [name, values] : arrays) point_data += appended.array(name, finite(*values, n));
  std::string field_data;
  if (step.parameter) {
    const std::string tag = appended.array("TimeValue", std::vector<double>{*step.parameter});
    field_data = "<FieldData>\n" +
                 std::string(tag).replace(tag.find("NumberOfComponents"), 0, "NumberOfTuples=\"1\" ") +
                 "</FieldData>\n";
  }
  const std::string points = appended.array("Points", xyz, 3);
  std::vector<std::int64_t> connectivity(n), offsets;
  for (std::size_t i = 0; i < n; ++i) connectivity[i] = static_cast<std::int64_t>(i);
  if (n > 0) offsets.push_back(static_cast<std::int64_t>(n));
  const std::string lines =
      "<Lines>\n" + appended.array("connectivity", connectivity) + appended.array("offsets", offsets) + "</Lines>\n";
  return poly_data(n,
                   "NumberOfVerts=\"0\" NumberOfLines=\"" + std::to_string(offsets.size()) +
                       "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\"",
                   field_data, point_data, points, lines, appended);
}

std::string tube_vtp(const Case& c) {
  constexpr int kSections = 801;  // with the corners below about 50 000 triangles: smooth on a laptop
  std::vector<TubeSection> sections;
  for (int i = 0; i < kSections; ++i) {
    const double length = c.tube.length(), S = i + 1 == kSections ? length : length * i / (kSections - 1);
    const geometry::AxisPoint at = c.tube.axis->at(S);
    sections.push_back({S, at.position, at.frame.col(0), at.frame.col(1), c.tube.clearance->at(S)[0]});
  }
  // The clearance leaves the rod's radius out; with it the wall is where the rod's surface touches.
  return tube_vtp(sections, rod_radius(c).value_or(0.0) * c.tube.sign());
}

std::string tube_vtp(const std::vector<TubeSection>& sections, double wall) {
  constexpr std::int64_t kAround = 32;
  const auto count = static_cast<std::int64_t>(sections.size());
  Appended appended;
  std::vector<double> xyz, clearance, places;
  for (const TubeSection& at : sections) {
    for (std::int64_t k = 0; k < kAround; ++k) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(kAround);
      const Vec3 p =
          at.position + std::max(at.clearance + wall, 0.0) * (std::cos(angle) * at.D1 + std::sin(angle) * at.D2);
      xyz.insert(xyz.end(), {p[0], p[1], p[2]});
      clearance.push_back(at.clearance);
      places.push_back(at.S);
    }
  }
  std::vector<std::int64_t> connectivity, offsets;
  for (std::int64_t i = 0; i + 1 < count; ++i) {
    for (std::int64_t k = 0; k < kAround; ++k) {
      const std::int64_t next = (k + 1) % kAround;
      connectivity.insert(connectivity.end(),
                          {i * kAround + k, i * kAround + next, (i + 1) * kAround + next, (i + 1) * kAround + k});
      offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    }
  }
  const std::string point_data = appended.array("clearance", clearance) + appended.array("S", places);
  const std::string points = appended.array("Points", xyz, 3);
  const std::string polys =
      "<Polys>\n" + appended.array("connectivity", connectivity) + appended.array("offsets", offsets) + "</Polys>\n";
  return poly_data(clearance.size(),
                   "NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
                       std::to_string(offsets.size()) + "\"",
                   "", point_data, points, polys, appended);
}

std::string paraview_list(const continuation::Result& result, const std::vector<std::string>& files) {
  std::string out =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (std::size_t i = 0; i < files.size(); ++i) {
    // ParaView sorts by time: the step number keeps the order in which the path was followed.
    out += "<DataSet timestep=\"" + std::to_string(i) + "\" group=\"\" part=\"0\" file=\"" + files[i] + "\" name=\"" +
           (result.steps[i].parameter ? shortest(*result.steps[i].parameter) : std::string()) + "\"/>\n";
  }
  return out + "</Collection>\n</VTKFile>\n";
}

}  // namespace tendril::io

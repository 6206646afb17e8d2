// [[rod.section]]: stretches that differ from [rod], as the section law of the rod.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tendril/io/assemble.hpp"

namespace tendril::io {
namespace {

using Between = rod::SectionEntry::Between;
using Polynomial = rod::SectionPiece::Polynomial;

constexpr int powers = 5;

Polynomial product(const Polynomial& a, const Polynomial& b) {  // of degrees that add to at most four
  Polynomial c{};
  for (int i = 0; i < powers; ++i)
    for (int j = 0; i + j < powers; ++j) c[i + j] += a[i] * b[j];
  return c;
}

Polynomial combined(double a, const Polynomial& p, double b, const Polynomial& q) {
  Polynomial c{};
  for (int i = 0; i < powers; ++i) c[i] = a * p[i] + b * q[i];
  return c;
}

/// One table: its values with those of [rod] where it has none.
class SectionReader {
 public:
  SectionReader(const Check& check, const rod::Rod& base, int index)
      : check_(check), c_(check.c), base_(base), name_("rod.section." + std::to_string(index)) {}

  const std::string& name() const { return name_; }
  bool from_end() const { return c_.word(at("measured_from"), "start") == "end"; }

  /// Distances of its two ends from the end of the rod it is measured from; false: reported.
  bool reach(double& from, double& to) const {
    const std::string end = check_.exactly_one(name_, {at("to"), at("length")}, "where the section ends");
    if (end.empty() || !c_.has(end)) return false;
    from = c_.number(at("from"));
    to = c_.number(end) + (end == at("length") ? from : 0.0);
    if (to > from) return true;
    Issue& issue = check_.add(end, "the section ends where it begins, or before");
    issue.value = shortest(to);
    issue.bound = "> " + shortest(from) + ", its `from`";
    return false;
  }

  /// The properties between s = low and s = high; `turned`: `from` is at the high end.
  rod::SectionPiece piece(double low, double high, bool turned) const {
    rod::SectionPiece p;
    p.from = p.origin = low;
    p.to = high;
    p.unit = high - low;
    turned_ = turned;
    stiffness(p);
    p.weight = values("weight_per_length", c_.number("rod.weight_per_length"));
    const Polynomial curvature = values("curvature", 0.0);
    const double angle = c_.number(at("curvature_angle"));
    // towards e = cos a d1 + sin a d2: d3' = κ e, so the twist vector is κ d3 × e
    p.curvature[0] = combined(-std::sin(angle), curvature, 0.0, curvature);
    p.curvature[1] = combined(std::cos(angle), curvature, 0.0, curvature);
    if (std::sin(angle) == 0.0) p.curvature[0] = {};
    return p;
  }

 private:
  const Check& check_;
  const Case& c_;
  const rod::Rod& base_;
  std::string name_;
  mutable bool turned_ = false;

  std::string at(const std::string& key) const { return name_ + "." + key; }
  bool given(const std::string& key) const { return check_.given(at(key)); }
  Between how() const { return c_.word(at("between"), "linear") == "smooth" ? Between::smooth : Between::linear; }

  std::array<double, 2> ends(const std::string& key, double fallback) const {
    std::array<double, 2> v{c_.component(at(key), 0, fallback), 0.0};
    v[1] = c_.component(at(key), 1, v[0]);
    if (turned_) std::swap(v[0], v[1]);
    return v;
  }
  Polynomial values(const std::string& key, double fallback) const {
    const auto v = ends(key, fallback);
    return rod::between(how(), v[0], v[1]);
  }

  void exclude(const std::string& key, const std::string& other) const {
    if (given(key)) check_.add(at(key), "`" + at(key) + "` and `" + at(other) + "` exclude each other");
  }

  void stiffness(rod::SectionPiece& p) const {
    p.inextensible = !base_.axial_stiffness && !given("axial_stiffness");
    const bool solid = given("diameter"), hollow = given("outer_diameter");
    if (solid || hollow) return circular(p, solid);
    for (const char* key : {"inner_diameter", "young_modulus", "shear_modulus"}) {
      if (!given(key)) continue;
      check_.add(at(key),
                 "`" + at(key) + "` needs a diameter: `" + at("diameter") + "` or `" + at("outer_diameter") + "`");
    }
    if (given("torsional_stiffness")) exclude("poisson_ratio", "torsional_stiffness");
    p.bending = values("bending_stiffness", base_.bending_stiffness);
    const double ratio = given("poisson_ratio") ? 1.0 / (1.0 + c_.number(at("poisson_ratio")))
                                                : base_.torsional_stiffness / base_.bending_stiffness;
    p.torsion =
        given("torsional_stiffness") ? values("torsional_stiffness", 1.0) : combined(ratio, p.bending, 0.0, p.bending);
    if (!p.inextensible) p.axial = values("axial_stiffness", base_.axial_stiffness.value_or(1.0));
    if (given("axial_stiffness") && !base_.axial_stiffness) {
      check_.add(at("axial_stiffness"), "a section is extensible where the rod is").hint =
          "give `rod.axial_stiffness` as well";
    }
  }

  void circular(rod::SectionPiece& p, bool solid) const {
    const std::string outer = solid ? "diameter" : "outer_diameter";
    for (const char* key : {"bending_stiffness", "torsional_stiffness", "axial_stiffness"}) exclude(key, outer);
    if (solid) {
      exclude("outer_diameter", "diameter");
      exclude("inner_diameter", "diameter");
    }
    const bool own = given("young_modulus");
    if (!own && !check_.given("rod.young_modulus")) {
      check_.add(at(outer), "`" + at(outer) + "` needs Young's modulus").hint =
          "`" + at("young_modulus") + "`, or `rod.young_modulus` for all sections";
      return;
    }
    const double E = c_.number(own ? at("young_modulus") : "rod.young_modulus");
    if (given("shear_modulus")) exclude("poisson_ratio", "shear_modulus");
    double G = E * 0.5 * base_.torsional_stiffness / base_.bending_stiffness;  // GJ/EI = 2G/E of a circle
    if (given("shear_modulus")) G = c_.number(at("shear_modulus"));
    if (given("poisson_ratio")) G = E / (2.0 * (1.0 + c_.number(at("poisson_ratio"))));
    const auto d = ends(outer, 1.0), i = ends("inner_diameter", 0.0);
    for (const int k : {0, 1}) {
      if (i[k] < d[k]) continue;
      Issue& issue = check_.add(at("inner_diameter"), "the inner diameter must be below the outer one");
      issue.value = shortest(i[k]);
      issue.bound = "< " + shortest(d[k]);
      return;
    }
    // linear diameters, or stiffnesses that go smoothly between their values at the ends
    Polynomial area, inertia;
    constexpr double pi = std::numbers::pi;
    if (how() == Between::linear) {
      const Polynomial D = rod::between(Between::linear, d[0], d[1]), I = rod::between(Between::linear, i[0], i[1]);
      const Polynomial D2 = product(D, D), I2 = product(I, I);
      area = combined(pi / 4, D2, -pi / 4, I2);
      inertia = combined(pi / 64, product(D2, D2), -pi / 64, product(I2, I2));
    } else {
      double A[2], J[2];
      for (const int k : {0, 1}) {
        A[k] = pi / 4 * (d[k] * d[k] - i[k] * i[k]);
        J[k] = pi / 64 * (std::pow(d[k], 4) - std::pow(i[k], 4));
      }
      area = rod::between(Between::smooth, A[0], A[1]);
      inertia = rod::between(Between::smooth, J[0], J[1]);
    }
    p.bending = combined(E, inertia, 0.0, inertia);
    p.torsion = combined(2.0 * G, inertia, 0.0, inertia);
    if (!p.inextensible) p.axial = combined(E, area, 0.0, area);
  }
};

}  // namespace

std::optional<ArcCount> arc_count(const Check& check) {
  const Case& c = check.c;
  std::vector<std::string> tables;
  for (const std::string of : {"rod.section", "rod.collar", "load.point"})
    for (int i = 0; i < static_cast<int>(c.number(of)); ++i) {
      const std::string name = of + "." + std::to_string(i);
      if (of != "load.point" || c.has(name + ".at")) tables.push_back(name);
    }
  const auto from_end = [&](const std::string& name) { return c.word(name + ".measured_from", "start") == "end"; };
  ArcCount out;
  const std::string length_key = c.has("end.rod_length") ? "end.rod_length" : "start.rod_length";
  out.length = c.number(length_key, HUGE_VAL);
  for (const std::string& name : tables) out.mixed = out.mixed || from_end(name) != from_end(tables.front());
  out.from_end = !tables.empty() && !out.mixed && from_end(tables.front());
  // What is measured from both ends has one arc length only where the length of the rod is given.
  if (out.mixed && (!c.has(length_key) || c.word("path.parameter") == length_key)) {
    if (check.issues.has(tables.back())) return std::nullopt;
    Issue& issue =
        check.add(tables.back(), "sections, collars or loads are measured from both ends of a rod whose length is " +
                                     std::string(c.has(length_key) ? "changed" : "not given"));
    issue.bound = "all measured_from = \"start\", or all \"end\"";
    issue.hint = "or give `end.rod_length`";
    return std::nullopt;
  }
  return out;
}

namespace {

/// A place on the rod, `name.at` as the rod is counted; nothing where it is not on it.
std::optional<double> place_on_rod(const Check& check, const ArcCount& arc, const std::string& name) {
  const Case& c = check.c;
  if (!c.has(name + ".at")) return std::nullopt;
  const double at = c.number(name + ".at");
  if (at < arc.length) return arc.at(at, c.word(name + ".measured_from", "start") == "end");
  Issue& issue = check.add(name + ".at", "the place is not on the rod");
  issue.value = shortest(at);
  issue.bound = "< " + shortest(arc.length) + ", the length of the rod";
  return std::nullopt;
}

void only_eulerian(const Check& check, const std::string& what) {
  const std::string formulation = check.c.word("solve.formulation", "eulerian");
  if (formulation == "eulerian" || check.issues.has("solve.formulation")) return;
  Issue& issue = check.add("solve.formulation", "this formulation does not treat " + what);
  issue.value = "\"" + formulation + "\"";
  issue.bound = "\"eulerian\"";
}

}  // namespace

std::vector<rod::Collar> assemble_collars(const Check& check) {
  const Case& c = check.c;
  std::vector<rod::Collar> out;
  const int count = static_cast<int>(c.number("rod.collar"));
  if (count == 0) return out;
  only_eulerian(check, "collars");
  const auto arc = arc_count(check);
  for (int i = 0; i < count && arc; ++i) {
    const std::string name = "rod.collar." + std::to_string(i);
    rod::Collar collar;
    const std::string size =
        check.exactly_one(name, {name + ".diameter", name + ".height"}, "how far the collar reaches");
    const auto radius = rod_radius(c);
    if (size == name + ".height") {
      collar.height = c.number(size);
    } else if (!size.empty() && c.has(size)) {
      if (!radius) {
        check.add(size, "`" + size + "` needs the diameter of the rod").hint =
            "`rod.diameter`, `rod.outer_diameter` or `tube.rod_radius`; or give the collar's `height`";
        continue;
      }
      collar.height = 0.5 * c.number(size) - *radius;
      if (!(collar.height > 0.0)) {
        Issue& issue = check.add(size, "a collar is thicker than the rod");
        issue.value = shortest(c.number(size));
        issue.bound = "> " + shortest(2.0 * *radius);
        continue;
      }
    }
    if (const auto s = place_on_rod(check, *arc, name)) {
      collar.s = *s;
      out.push_back(collar);
    }
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.s < b.s; });
  for (std::size_t i = 1; i < out.size(); ++i)
    if (!(out[i].s > out[i - 1].s)) check.add("rod.collar", "two collars sit at one place").value = shortest(out[i].s);
  return out;
}

std::vector<rod::PointLoad> assemble_point_loads(const Check& check) {
  const Case& c = check.c;
  std::vector<rod::PointLoad> out;
  const int count = static_cast<int>(c.number("load.point"));
  if (count == 0) return out;
  only_eulerian(check, "point loads");
  const auto arc = arc_count(check);
  for (int i = 0; i < count && arc; ++i) {
    const std::string name = "load.point." + std::to_string(i);
    rod::PointLoad load;
    const std::string where =
        check.exactly_one(name, {name + ".position", name + ".at"}, "a place of the axis, or one of the rod");
    for (int k = 0; k < 3; ++k) {
      load.force[k] = c.component(name + ".force", k);
      load.couple[k] = c.component(name + ".couple", k);
    }
    load.on_rod = where == name + ".at";
    load.at = c.number(name + ".position");
    if (load.on_rod) {
      const auto s = place_on_rod(check, *arc, name);
      if (!s) continue;
      load.at = *s;
    }
    for (const auto& other : out)
      if (other.on_rod == load.on_rod && other.at == load.at)
        check.add(name, "two point loads act at one place").hint = "add them up";
    out.push_back(load);
  }
  return out;
}

bool has_sections(const Case& c) { return c.number("rod.section") > 0.0; }

rod::SectionLaw assemble_sections(const Check& check, const rod::Rod& base) {
  const Case& c = check.c;
  const int count = static_cast<int>(c.number("rod.section"));
  if (count == 0) return {};
  struct Reach {
    int index;
    double low, high;
    bool from_end;
  };
  std::vector<SectionReader> readers;
  std::vector<Reach> reaches;
  for (int i = 0; i < count; ++i) readers.emplace_back(check, base, i);
  const auto arc = arc_count(check);
  if (!arc) return {};
  const bool from_end = arc->from_end, mixed = arc->mixed;
  const double length = arc->length;
  const std::string length_key = c.has("end.rod_length") ? "end.rod_length" : "start.rod_length";
  for (int i = 0; i < count; ++i) {
    double from = 0.0, to = 0.0;
    if (!readers[i].reach(from, to)) continue;
    if (to > length * (1 + 1e-12) && readers[i].from_end()) {  // more of it comes in as rod is fed
      if (check.notes)
        check.notes->push_back(readers[i].name() + " is longer than the rod, " + shortest(length) +
                               ": the rest of it lies behind the inlet");
    } else if (to > length * (1 + 1e-12)) {
      Issue& issue = check.add(readers[i].name() + ".to", "the section goes beyond the rod");
      issue.value = shortest(to);
      issue.bound = "<= " + shortest(length) + ", `" + length_key + "`";
      continue;
    }
    Reach r{i, from, to, readers[i].from_end()};
    if (r.from_end) {
      const double end = mixed ? length : 0.0;
      r.low = end - to;
      r.high = end - from;
    }
    reaches.push_back(r);
  }
  std::sort(reaches.begin(), reaches.end(), [](const Reach& a, const Reach& b) { return a.low < b.low; });
  std::vector<rod::SectionPiece> pieces;
  for (const Reach& r : reaches) {
    rod::SectionPiece p = readers[r.index].piece(r.low, r.high, r.from_end);
    const double rounding = 1e-9 * p.unit;
    if (!pieces.empty() && p.from < pieces.back().to - rounding) {
      Issue& issue = check.add(readers[r.index].name(), "two sections overlap");
      issue.value = "s = " + shortest(r.low) + " to " + shortest(r.high);
      issue.bound = "s >= " + shortest(pieces.back().to) + ", where the one before it ends";
      continue;
    }
    if (!pieces.empty() && p.from < pieces.back().to + rounding) p.from = pieces.back().to;
    pieces.push_back(p);
  }
  if (c.word("solve.formulation", "eulerian") != "eulerian") {
    Issue& issue = check.add("solve.formulation", "this formulation does not treat rods that vary");
    issue.value = "\"" + c.word("solve.formulation") + "\"";
    issue.bound = "\"eulerian\"";
  }
  if (!check.issues.empty()) return {};
  return rod::section_law(base, c.number("rod.weight_per_length"), pieces, from_end);
}

}  // namespace tendril::io

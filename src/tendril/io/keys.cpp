#include "tendril/io/keys.hpp"

#include <algorithm>
#include <cmath>

#include "tendril/io/diagnostics.hpp"

namespace tendril::io {
namespace {

using D = Dimension;
using T = KeyType;
using Words = std::vector<std::string>;

Key any(std::string path, T type, D dimension, std::string doc, std::string fallback = {}, Words kinds = {}) {
  Key key{std::move(path), type, dimension, std::move(doc), std::move(fallback)};
  key.kinds = std::move(kinds);
  return key;
}

Key required(Key key, bool is_required = true) {
  key.required = is_required;
  return key;
}

Key table(std::string path, std::string doc, bool is_required = false) {
  return required(any(std::move(path), T::table, D::none, std::move(doc)), is_required);
}

Key positive(std::string path, D dimension, std::string doc, std::string fallback = {}, Words kinds = {}) {
  Key key = any(std::move(path), T::number, dimension, std::move(doc), std::move(fallback), std::move(kinds));
  key.min = 0.0;
  key.open_min = true;
  return key;
}

Key word(std::string path, Words words, std::string doc, std::string fallback, bool is_required = false,
         Words not_yet = {}) {
  Key key = required(any(std::move(path), T::word, D::none, std::move(doc), std::move(fallback)), is_required);
  key.words = std::move(words);
  key.not_yet = std::move(not_yet);
  return key;
}

Key ranged(Key key, double min, double max, bool open_min = false) {
  key.min = min;
  key.max = max;
  key.open_min = open_min;
  return key;
}

Key over_section(std::string name, D dimension, std::string doc, std::string fallback, double min, bool open) {
  return ranged(any("rod.section." + name, T::number_or_pair, dimension, std::move(doc), std::move(fallback)), min,
                HUGE_VAL, open);
}

void section_keys(std::vector<Key>& k) {
  k.push_back(
      any("rod.section", T::tables, D::none,
          "[[rod.section]]: stretches that differ from [rod]; a value [a, b] goes from a at `from` to b at `to`"));
  Key from = any("rod.section.from", T::number, D::length, "where it begins, in unstressed length", "0");
  k.push_back(ranged(from, 0.0, HUGE_VAL));
  k.push_back(positive("rod.section.to", D::length, "where it ends; or length"));
  k.push_back(positive("rod.section.length", D::length, "how long it is, instead of to"));
  k.push_back(word("rod.section.measured_from", {"start", "end"},
                   "from which end of the rod `from` and `to` are measured: a tip moves with the end", "start"));
  k.push_back(word("rod.section.between", {"linear", "smooth"},
                   "how a value [a, b] goes from a to b; smooth: with zero slope at both ends", "linear"));
  const std::string base = "that of [rod]";
  k.push_back(over_section("axial_stiffness", D::force, "EA", base, 0.0, true));
  k.push_back(over_section("bending_stiffness", D::stiffness, "EI", base, 0.0, true));
  k.push_back(over_section("torsional_stiffness", D::stiffness, "GJ", "EI times GJ/EI of [rod]", 0.0, true));
  k.push_back(positive("rod.section.young_modulus", D::pressure, "E, with a section", "rod.young_modulus"));
  k.push_back(ranged(any("rod.section.poisson_ratio", T::number, D::none, "ν, gives G = E/(2(1+ν))", "that of [rod]"),
                     -1.0, 0.5, true));
  k.push_back(positive("rod.section.shear_modulus", D::pressure, "G, instead of poisson_ratio", "that of [rod]"));
  k.push_back(over_section("diameter", D::length, "diameter of a solid stretch: EI, EA and GJ follow", "", 0.0, true));
  k.push_back(over_section("outer_diameter", D::length, "outer diameter of a hollow stretch", "", 0.0, true));
  k.push_back(over_section("inner_diameter", D::length, "inner diameter of a hollow stretch", "0", 0.0, false));
  k.push_back(over_section("weight_per_length", D::force_per_length, "weight per unit length", base, 0.0, false));
  k.push_back(over_section("curvature", D::curvature, "curvature of the unstressed rod (J-tip, bent housing)", "0",
                           -HUGE_VAL, false));
  k.push_back(any("rod.section.curvature_angle", T::number, D::angle,
                  "the unstressed rod bends towards cos a d1 + sin a d2", "0"));
}

void rod_keys(std::vector<Key>& k) {
  k.push_back(table("rod", "The rod: of circular response, uniform and straight but for its sections.", true));
  k.push_back(positive("rod.axial_stiffness", D::force, "EA; leave out for an inextensible rod",
                       "inextensible, or from young_modulus"));
  k.push_back(positive("rod.bending_stiffness", D::stiffness, "EI"));
  k.push_back(positive("rod.torsional_stiffness", D::stiffness, "GJ"));
  k.push_back(positive("rod.young_modulus", D::pressure,
                       "E; with a section it gives EI, EA and GJ instead of the stiffnesses"));
  k.push_back(ranged(any("rod.poisson_ratio", T::number, D::none, "ν, gives G = E/(2(1+ν))"), -1.0, 0.5, true));
  k.push_back(positive("rod.shear_modulus", D::pressure, "G, instead of poisson_ratio"));
  k.push_back(positive("rod.diameter", D::length, "diameter of a solid rod"));
  k.push_back(positive("rod.outer_diameter", D::length, "outer diameter of a hollow rod"));
  k.push_back(ranged(any("rod.inner_diameter", T::number, D::length, "inner diameter of a hollow rod"), 0.0, HUGE_VAL));
  k.push_back(any("rod.inextensible", T::boolean, D::none, "ignore the EA that young_modulus would give", "false"));
  k.push_back(
      ranged(any("rod.weight_per_length", T::number, D::force_per_length,
                 "weight per unit length, in air where load.fluid_density tells what it hangs in; its direction "
                 "is load.gravity"),
             0.0, HUGE_VAL));
  k.push_back(positive("rod.density", D::density, "density of the rod's material, for its buoyancy",
                       "7850 kg/m^3 (steel) with units = \"si\""));
  section_keys(k);
  k.push_back(any("rod.collar", T::tables, D::none,
                  "[[rod.collar]]: stabilisers and tool joints: rings on the rod that touch the wall before it does"));
  k.push_back(required(positive("rod.collar.at", D::length, "where it sits, in unstressed length")));
  k.push_back(
      word("rod.collar.measured_from", {"start", "end"}, "from which end of the rod `at` is measured", "start"));
  k.push_back(positive("rod.collar.diameter", D::length, "its outer diameter; or height"));
  k.push_back(positive("rod.collar.height", D::length, "how far it stands out from the rod, instead of diameter"));
}

void tube_keys(std::vector<Key>& k) {
  k.push_back(
      table("tube", "The tube: a curve and the distance at which the rod's centreline touches the wall.", true));
  k.push_back(word("tube.side", {"inside", "outside"}, "side of the wall the rod is on", "inside"));
  k.push_back(ranged(
      any("tube.clearance", T::number_or_table, D::length,
          "distance from the axis at which the centreline touches: a number or [[S, value], ...] over the whole axis"),
      0.0, HUGE_VAL, true));
  k.push_back(ranged(any("tube.radius", T::number_or_table, D::length,
                         "radius of the wall, instead of clearance: a number or [[S, value], ...]",
                         "the radius column of tube.axis.file, if it has one"),
                     0.0, HUGE_VAL, true));
  k.push_back(ranged(any("tube.rod_radius", T::number, D::length,
                         "radius of the rod: clearance = radius - rod_radius inside, + outside",
                         "half of rod.diameter or rod.outer_diameter"),
                     0.0, HUGE_VAL));
  k.push_back(table("tube.axis", "The reference curve; `kind` says which of the other keys belong to it.", true));
  k.push_back(
      word("tube.axis.kind", {"straight", "arc", "helix", "torus", "points", "survey"}, "kind of curve", "", true));
  k.push_back(positive("tube.axis.length", D::length, "arc length", "", {"straight", "arc", "helix"}));
  k.push_back(any("tube.axis.direction", T::vector, D::none, "direction of the line", "[0, 0, 1]", {"straight"}));
  k.push_back(any("tube.axis.origin", T::vector, D::length, "start of the line", "[0, 0, 0]", {"straight"}));
  k.push_back(positive("tube.axis.radius", D::length, "radius of the arc, or of the cylinder the helix is on", "",
                       {"arc", "helix"}));
  k.push_back(positive("tube.axis.curvature", D::curvature, "1/radius of the arc, instead of radius", "", {"arc"}));
  k.push_back(ranged(any("tube.axis.pitch_angle", T::number, D::angle,
                         "angle between tangent and helix axis; > 0 right-handed, < 0 left-handed", "", {"helix"}),
                     -1.5707963267948966, 1.5707963267948966));
  k.push_back(positive("tube.axis.major_radius", D::length, "radius of the ring", "", {"torus"}));
  k.push_back(any("tube.axis.points", T::points, D::length, "points of the curve, [[x, y, z], ...], instead of file",
                  "", {"points"}));
  k.push_back(
      any("tube.axis.file", T::text, D::none,
          "file of the curve, relative to the case file. Points: a table x, y, z[, radius]; VTK PolyData (.vtp); "
          "SimVascular path (.pth); Slicer markups (.mrk.json). Survey: a table md, inc, azi; LAS; WITSML. Units "
          "from the file, of a table without them m and deg",
          "", {"points", "survey"}));
  k.push_back(any("tube.axis.file_unit", T::text, D::none,
                  "unit of the lengths of a file that does not name it, e.g. \"mm\" or \"cm\" (.vtp, .pth)",
                  "as the file says", {"points", "survey"}));
  k.push_back(any("tube.axis.radius_array", T::text, D::none,
                  "name of the file's radius: a point array of a .vtp, a column of a table",
                  "MaximumInscribedSphereRadius, Radius or another usual name", {"points"}));
  Key branch = any("tube.axis.branch", T::integers, D::none,
                   "line of a file with several, from 0; or lines that join, in order", "the only one", {"points"});
  branch.min = 0;
  k.push_back(std::move(branch));
  Key ends =
      any("tube.axis.ends", T::integers, D::none,
          "way through a tree of branches: the numbers of the ends from and to which it leads, as `tendril check "
          "FILE` lists them",
          "", {"points"});
  ends.min = 0;
  k.push_back(std::move(ends));
  k.push_back(any("tube.axis.start_near", T::vector, D::length,
                  "way through a tree of branches: from the end nearest to this point, in the file's coordinates", "",
                  {"points"}));
  k.push_back(any("tube.axis.end_near", T::vector, D::length,
                  "way through a tree of branches: to the end nearest to this point", "", {"points"}));
  Key smoothing =
      ranged(any("tube.axis.smoothing", T::number, D::length,
                 "tolerance of a smoothing spline: no point is moved farther; 0: exactly through them; "
                 "\"auto\": 15 % of the median radius",
                 "0; for a file with a radius \"auto\" where the exact curve would fold the tube", {"points"}),
             0.0, HUGE_VAL);
  smoothing.alternatives = {"auto"};
  k.push_back(std::move(smoothing));
  k.push_back(ranged(any("tube.axis.radius_smoothing", T::number, D::length,
                         "tolerance of a smoothing spline through the file's radius; 0: exactly through it",
                         "the smaller of smoothing and 5 % of the smallest radius", {"points"}),
                     0.0, HUGE_VAL));
  k.push_back(
      positive("tube.axis.deviation", D::length,
               "largest distance of the curve from the minimum-curvature one, whose curvature jumps at every station",
               "1 % of the smallest clearance", {"survey"}));
  k.push_back(any("tube.axis.from", T::number, D::length,
                  "use the curve from here on (S, or measured depth of a survey); S = 0 is then here", "its start"));
  k.push_back(any("tube.axis.to", T::number, D::length, "use the curve up to here (S, or measured depth of a survey)",
                  "its end"));
  k.push_back(any("tube.axis.normal", T::vector, D::none, "D1(0) is the part of this vector normal to the tangent",
                  "the Frenet normal at S = 0"));
  k.push_back(any("tube.axis.reverse", T::boolean, D::none, "run the curve from its other end", "false"));
}

void end_keys(std::vector<Key>& k, const std::string& end, const std::string& where) {
  const std::string p = end + ".";
  k.push_back(table(
      end,
      "The end of the rod at " + where +
          ". Over both ends: exactly one of axial_force, push, rod_length and one of torque, twist (of a free tip: "
          "axial_force or rod_length, and torque; none means no force, no torque).",
      true));
  if (end == "start")
    k.push_back(word(p + "kind", {"clamped", "sleeve", "pinned"},
                     "clamped, sleeve: position and tangent fixed; pinned: position fixed, no bending moment", "", true,
                     {"guided", "free", "tip"}));
  else
    k.push_back(word(p + "kind", {"clamped", "sleeve", "pinned", "guided", "free", "tip"},
                     "clamped, sleeve: position and tangent fixed; pinned: position fixed, no bending moment; guided: "
                     "along the axis, the place across free; free, tip: nothing held, the wall bears what touches it",
                     "", true));
  k.push_back(any(p + "eccentricity", T::pair, D::length, "δ in the frame D1, D2", "[0, 0]"));
  // d3·D3 > 0 asks for a slope that is finite; beyond 100 the rod stands within 0.6° of across the tube
  k.push_back(ranged(any(p + "slope", T::pair, D::none, "dδ/dS", "[0, 0]"), -100.0, 100.0));
  k.push_back(any(p + "roll", T::number, D::angle, "φ at this end, where neither torque nor twist is given", "0"));
  k.push_back(any(p + "axial_force", T::number, D::force, "F3 just inside the end, tension positive"));
  k.push_back(any(p + "push", T::number, D::force,
                  "thrust on the straight rod outside a frictionless sleeve, compression positive"));
  k.push_back(positive(p + "rod_length", D::length, "unstressed length of the rod between the ends"));
  k.push_back(any(p + "torque", T::number, D::moment, "M3, right-handed positive"));
  k.push_back(any(p + "twist", T::number, D::angle, "φ of the directors relative to the Bishop frame"));
  if (end == "end") {
    k.push_back(positive(p + "position", D::length, "S of the far end", "the length of the axis"));
    k.push_back(any(p + "tip_force", T::vector, D::force, "force on a free tip", "[0, 0, 0]"));
    k.push_back(any(p + "tip_couple", T::vector, D::moment, "couple on a free tip", "[0, 0, 0]"));
    k.push_back(word(p + "tip_frame", {"world", "rod"},
                     "the tip's load is dead, in the world frame, or follows the rod along d1, d2, d3", "world"));
    k.push_back(any(p + "turns", T::integer, D::none,
                    "whole turns of the rod around the tube between its ends (outside only)", "0"));
  }
}

void other_keys(std::vector<Key>& k) {
  k.push_back(table("load", "Loads per unit reference length, fixed in the world frame."));
  k.push_back(any("load.body_force", T::vector_or_table, D::force_per_length,
                  "force per length; a table over S goes straight from row to row", "[0, 0, 0]"));
  k.push_back(any("load.body_couple", T::vector_or_table, D::force, "couple per length, as body_force", "[0, 0, 0]"));
  k.push_back(any("load.gravity", T::vector, D::none,
                  "direction of the weight; only its direction counts, the magnitude is rod.weight_per_length",
                  "[0, 0, 9.80665] (down) for a survey, else none"));
  k.push_back(ranged(any("load.fluid_density", T::number, D::density,
                         "density of the fluid the rod hangs in: its weight is that in air times 1 - fluid_density / "
                         "rod.density",
                         "0"),
                     0.0, HUGE_VAL));
  k.push_back(any("load.point", T::tables, D::none,
                  "[[load.point]]: forces and couples at one place, fixed in the world frame"));
  k.push_back(
      positive("load.point.position", D::length, "S of the axis where it acts, whatever of the rod lies there"));
  k.push_back(positive("load.point.at", D::length, "or the place on the rod that it moves with, in unstressed length"));
  k.push_back(
      word("load.point.measured_from", {"start", "end"}, "from which end of the rod `at` is measured", "start"));
  k.push_back(any("load.point.force", T::vector, D::force, "force", "[0, 0, 0]"));
  k.push_back(any("load.point.couple", T::vector, D::moment, "couple", "[0, 0, 0]"));
  k.push_back(table("solve", "How to solve."));
  k.push_back(ranged(any("solve.tolerance", T::number, D::none, "relative error between nodes", "1e-8"), 1e-12, 1e-2));
  k.push_back(
      word("solve.branch", {"stable", "symmetric", "planar", "nearest"}, "which of several solutions", "stable"));
  k.push_back(
      word("solve.formulation", {"eulerian", "small_inclination", "lagrangian"},
           "which equations: exact; approximate (free segments and point contacts); the Eulerian state solved again "
           "in the world frame, differences reported",
           "eulerian"));
  k.push_back(ranged(any("solve.collocation_points", T::integer, D::none, "Gauss points of a subinterval", "7"), 4, 7));
  k.push_back(word("solve.damping", {"affine_invariant", "residual"},
                   "how Newton steps are damped: Deuflhard, or Algorithms IV.2-IV.3", "affine_invariant"));
  k.push_back(any("solve.nested", T::boolean, D::none,
                  "solve segment by segment (SolveSequence) instead of the chain at once", "false"));
  k.push_back(
      table("path", "One parameter, followed with event location: from the case as written to each value in turn."));
  k.push_back(required(
      any("path.parameter", T::text, D::none,
          "a number of the case (\"end.axial_force\", \"end.slope.0\", \"tube.axis.radius\"), \"end.position\", or "
          "\"load.body_force.scale\", \"load.body_couple.scale\", \"load.point.scale\", \"tube.clearance.scale\"")));
  k.push_back(any("path.values", T::numbers, D::none, "values to report, in order, in the unit of the parameter"));
  k.push_back(any("path.from", T::number, D::none, "first value, instead of values"));
  k.push_back(any("path.to", T::number, D::none, "last value, instead of values"));
  k.push_back(ranged(any("path.steps", T::integer, D::none, "number of equally spaced values, from and to included"), 2,
                     100000));
  k.push_back(
      table("insertion",
            "The rod fed in or withdrawn from the case as written, quasi-statically: the length of the rod where it "
            "is given or its tip is free, the place of the far end otherwise."));
  k.push_back(
      positive("insertion.to", D::length, "length of rod, or place of the far end, to go to; every step is reported"));
  k.push_back(any("insertion.values", T::numbers, D::length, "values to report, in order, instead of to"));
  k.push_back(positive("insertion.step", D::length, "longest motion at once", "a hundredth of the way"));
  k.push_back(any("insertion.rotation", T::number, D::angle, "turn of the inlet, spread evenly over the way", "0"));
}

std::vector<Key> make_keys() {
  std::vector<Key> k;
  k.push_back(required(ranged(any("schema", T::integer, D::none, "version of this format"), 1, 1)));
  k.push_back(any("title", T::text, D::none, "one line about the case"));
  k.push_back(word("units", {"dimensionless", "si"},
                   "dimensionless: any consistent set, numbers are read and reported as given; si: m, N, N m, and any "
                   "quantity may be a string with its unit",
                   "dimensionless"));
  rod_keys(k);
  tube_keys(k);
  end_keys(k, "start", "S = 0");
  end_keys(k, "end", "S = L");
  other_keys(k);
  return k;
}

std::string bounds(const Key& key) {
  const bool low = std::isfinite(key.min), high = std::isfinite(key.max);
  if (low && high && key.min == key.max) return shortest(key.min);
  std::string text;
  if (low) text += std::string(key.open_min ? "> " : ">= ") + shortest(key.min);
  if (low && high) text += " and ";
  if (high) text += "<= " + shortest(key.max);
  return text;
}

std::string joined(const Words& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

const std::vector<Key>& keys() {
  static const std::vector<Key> all = make_keys();
  return all;
}

const Key* find_key(std::string_view path) {
  for (const Key& key : keys()) {
    if (key.path == path) return &key;
  }
  return nullptr;
}

std::vector<const Key*> children(std::string_view path) {
  std::vector<const Key*> list;
  const std::string prefix = path.empty() ? "" : std::string(path) + ".";
  for (const Key& key : keys()) {
    if (key.path.size() > prefix.size() && key.path.compare(0, prefix.size(), prefix) == 0 &&
        key.path.find('.', prefix.size()) == std::string::npos) {
      list.push_back(&key);
    }
  }
  return list;
}

std::string accepted(const Key& key) {
  const std::string limit = bounds(key);
  const std::string with_limit = limit.empty() ? "" : " " + limit;
  switch (key.type) {
    case T::table:
      return "a table";
    case T::number:
      return "a number" + with_limit + (key.alternatives.empty() ? "" : ", or \"" + joined(key.alternatives) + "\"");
    case T::integer:
      return key.min == key.max ? limit : "an integer" + with_limit;
    case T::integers:
      return key.path == "tube.axis.ends" ? "two integers >= 0, [from, to]" : "an integer >= 0, or a list of them";
    case T::boolean:
      return "true or false";
    case T::text:
      return "a string";
    case T::word:
      return "one of " + joined(key.words);
    case T::pair:
      return "two numbers, [a, b]" + (limit.empty() ? "" : ", each" + with_limit);
    case T::vector:
      return "three numbers, [x, y, z]";
    case T::tables:
      return "tables, [[" + key.path + "]]";
    case T::number_or_pair:
      return "a number" + with_limit + ", or two, [a, b]";
    case T::number_or_table:
      return "a number" + with_limit + ", or a list of pairs [[S, value], ...]";
    case T::vector_or_table:
      return "three numbers, [x, y, z], or a list of rows [[S, x, y, z], ...]";
    case T::points:
      return "a list of points [[x, y, z], ...]";
    case T::numbers:
      return "a list of numbers";
    case T::not_yet:
      return "nothing yet: " + key.doc;
  }
  return "";
}

std::string suggest_key(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  const std::string parent(dot == std::string_view::npos ? "" : path.substr(0, dot));
  const std::string name(dot == std::string_view::npos ? path : path.substr(dot + 1));
  std::vector<std::string> siblings;
  for (const Key* key : children(parent)) siblings.push_back(key->path.substr(parent.empty() ? 0 : parent.size() + 1));
  const std::string near = nearest(name, siblings);
  if (!near.empty()) return "did you mean `" + near + "`?";
  std::string elsewhere;  // the right name in the wrong table
  for (const Key& key : keys()) {
    const std::size_t at = key.path.rfind('.');
    if (key.path.substr(at == std::string::npos ? 0 : at + 1) != name) continue;
    elsewhere += (elsewhere.empty() ? "`" : " or `") + key.path + "`";
  }
  if (!elsewhere.empty()) return "did you mean " + elsewhere + "?";
  return siblings.empty() ? "" : "keys here: " + joined(siblings);
}

std::string explain(std::string_view path) {
  const Key* key = find_key(path);
  if (!key && !path.empty()) return {};
  std::string text;
  if (key) {
    text = key->path + "\n  " + key->doc + "\n";
    if (key->type != T::table) text += "  accepts: " + accepted(*key) + "\n";
    if (key->dimension != D::none) {
      text += "  measures: " + std::string(describe(key->dimension)) + "; with units = \"si\" in " +
              std::string(si_unit(key->dimension)) + ", or a string such as \"" + std::string(example(key->dimension)) +
              "\"\n";
    }
    if (!key->kinds.empty()) text += "  belongs to kind: " + joined(key->kinds) + "\n";
    if (!key->not_yet.empty()) text += "  not available yet: " + joined(key->not_yet) + "\n";
    if (!key->fallback.empty()) text += "  default: " + key->fallback + "\n";
    if (key->required) text += "  required\n";
  }
  std::size_t width = 0;
  for (const Key* child : children(path)) width = std::max(width, child->path.size());
  for (const Key* child : children(path)) {
    text += "  " + child->path + std::string(width - child->path.size() + 2, ' ') + child->doc + "\n";
  }
  return text;
}

}  // namespace tendril::io

// From the numbers of a case to rod, load and ends; which keys exclude or need each other.

#include "tendril/io/assemble.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tendril::io {

using segmentation::AxialControl;
using segmentation::End;
using segmentation::Problem;
using segmentation::TwistControl;
using segmentation::Which;

Place Locator::at(std::string key) const {
  if (places) {
    while (true) {
      if (const auto it = places->find(key); it != places->end()) return it->second;
      const std::size_t dot = key.rfind('.');
      if (dot == std::string::npos) break;
      key.resize(dot);
    }
  }
  return fallback;
}

std::string Check::exactly_one(const std::string& table, const std::vector<std::string>& keys,
                               const std::string& why) const {
  std::string one, names;
  for (const std::string& key : keys) names += (names.empty() ? "`" : key == keys.back() ? " or `" : ", `") + key + "`";
  for (const std::string& key : keys) {
    if (!given(key)) continue;
    if (one.empty()) {
      one = key;
      continue;
    }
    Issue& issue = add(key, "`" + key + "` and `" + one + "` exclude each other");
    issue.bound = "exactly one of " + names;
    issue.hint = why;
  }
  // a table that is no table says nothing about its keys
  const bool unread = std::any_of(keys.begin(), keys.end(), [this](const std::string& key) {
    const std::string of = key.substr(0, key.rfind('.'));
    return std::any_of(issues.list().begin(), issues.list().end(), [&](const Issue& i) { return i.key == of; });
  });
  if (one.empty() && !unread) {
    Issue& issue = add(table, "one of " + names + " is missing");
    issue.bound = "exactly one of them";
    issue.hint = why;
  }
  return one;
}

namespace {

void refuse_with(const Check& check, const std::string& key, const std::string& other) {
  if (check.given(key)) check.add(key, "`" + key + "` and `" + other + "` exclude each other");
}

// Solid or hollow circle; outer diameter 0 when it is not given.
std::pair<double, double> diameters(const Case& c) {
  if (c.has("rod.diameter")) return {c.number("rod.diameter"), 0.0};
  return {c.number("rod.outer_diameter"), c.number("rod.inner_diameter")};
}

}  // namespace

std::optional<double> rod_radius(const Case& c) {
  if (c.has("tube.rod_radius")) return c.number("tube.rod_radius");
  const double outer = diameters(c).first;
  if (outer > 0) return outer / 2;
  return std::nullopt;
}

rod::Rod assemble_rod(const Check& check) {
  const Case& c = check.c;
  rod::Rod rod;
  if (check.given("rod.diameter") && check.given("rod.outer_diameter"))
    refuse_with(check, "rod.outer_diameter", "rod.diameter");
  const auto [outer, inner] = diameters(c);
  if (check.given("rod.inner_diameter") && !check.given("rod.outer_diameter")) {
    check.add("rod.inner_diameter", "`rod.inner_diameter` needs `rod.outer_diameter`");
  } else if (c.has("rod.inner_diameter") && c.has("rod.outer_diameter") && inner >= outer) {
    Issue& issue = check.add("rod.inner_diameter", "the inner diameter must be below the outer one");
    issue.value = shortest(inner);
    issue.bound = "< " + shortest(outer);
  }
  if (check.given("rod.young_modulus")) {
    for (const char* key : {"rod.bending_stiffness", "rod.torsional_stiffness", "rod.axial_stiffness"})
      refuse_with(check, key, "rod.young_modulus");
    const bool section = check.given("rod.diameter") || check.given("rod.outer_diameter");
    if (!section)
      check.add(
          "rod.young_modulus",
          "`rod.young_modulus` needs a section: `rod.diameter`, or `rod.outer_diameter` and `rod.inner_diameter`");
    const std::string shear =
        check.exactly_one("rod", {"rod.poisson_ratio", "rod.shear_modulus"}, "the twisting stiffness is G I_p");
    const double E = c.number("rod.young_modulus");
    const double G = shear == "rod.shear_modulus" ? c.number(shear) : E / (2 * (1 + c.number("rod.poisson_ratio")));
    const double area = std::numbers::pi / 4 * (outer * outer - inner * inner);
    const double inertia = std::numbers::pi / 64 * (std::pow(outer, 4) - std::pow(inner, 4));
    rod.bending_stiffness = E * inertia;
    rod.torsional_stiffness = 2 * G * inertia;
    if (c.word("rod.inextensible") != "true") rod.axial_stiffness = E * area;
    return rod;
  }
  refuse_with(check, "rod.shear_modulus", "rod.bending_stiffness");
  if (!check.given("rod.bending_stiffness")) {
    check.add("rod", "missing key `rod.bending_stiffness`").hint = "EI; or `rod.young_modulus` with a section";
  }
  const std::string twist =
      check.exactly_one("rod", {"rod.torsional_stiffness", "rod.poisson_ratio"}, "GJ, or ν in GJ = EI/(1+ν)");
  rod.bending_stiffness = c.number("rod.bending_stiffness", 1.0);
  rod.torsional_stiffness = twist == "rod.poisson_ratio" ? rod.bending_stiffness / (1 + c.number("rod.poisson_ratio"))
                                                         : c.number("rod.torsional_stiffness", 1.0);
  if (c.has("rod.axial_stiffness")) rod.axial_stiffness = c.number("rod.axial_stiffness");
  if (c.word("rod.inextensible") == "true") refuse_with(check, "rod.axial_stiffness", "rod.inextensible");
  return rod;
}

namespace {

/// The first key that gives the rod weight, or "".
std::string heavy_key(const Check& check) {
  if (check.given("rod.weight_per_length")) return "rod.weight_per_length";
  for (int i = 0; i < static_cast<int>(check.c.number("rod.section")); ++i) {
    const std::string key = "rod.section." + std::to_string(i) + ".weight_per_length";
    if (check.given(key)) return key;
  }
  return {};
}

}  // namespace

double buoyancy_factor(const Case& c) {
  constexpr double kSteel = 7850.0;  // [kg/m^3]
  return 1.0 - c.number("load.fluid_density") / c.number("rod.density", kSteel);
}

rod::BodyLoad assemble_load(const Check& check) {
  const Case& c = check.c;
  rod::BodyLoad load;
  const auto read = [&](const std::string& key, Eigen::Vector3d& constant, rod::LoadField& field) {
    const auto it = c.numbers.find(key);
    if (it == c.numbers.end()) return;
    const auto& v = it->second;
    if (v.size() == 3) constant = {v[0], v[1], v[2]};
    for (std::size_t i = 0; v.size() > 3 && i + 4 <= v.size(); i += 4) {
      field.S.push_back(v[i]);
      field.value.emplace_back(v[i + 1], v[i + 2], v[i + 3]);
    }
  };
  read("load.body_force", load.force, load.force_field);
  read("load.body_couple", load.couple, load.couple_field);
  const bool survey = c.word("tube.axis.kind") == "survey";
  const std::string weight_key = heavy_key(check);
  const bool weight = !weight_key.empty(), gravity = check.given("load.gravity");
  if (gravity && !weight) {
    check.add("load.gravity", "`load.gravity` needs `rod.weight_per_length`").hint =
        "or give the weight as `load.body_force`";
  }
  if (weight && !gravity && !survey) {
    Issue& issue = check.add(weight_key, "`" + weight_key + "` needs `load.gravity`");
    issue.hint = "the direction of the weight, e.g. gravity = [0, 0, -1] under [load]; a survey's default is down";
  }
  Eigen::Vector3d down = survey ? Eigen::Vector3d(0, 0, 1) : Eigen::Vector3d(0, 0, 0);
  if (c.has("load.gravity"))
    down = {c.component("load.gravity", 0), c.component("load.gravity", 1), c.component("load.gravity", 2)};
  if (check.given("load.fluid_density")) {
    if (!weight)
      check.add("load.fluid_density", "`load.fluid_density` needs `rod.weight_per_length`, the weight in air");
    if (!c.si && !check.given("rod.density"))
      check.add("load.fluid_density", "`load.fluid_density` needs `rod.density`").hint =
          "with units = \"si\" it is that of steel unless given";
  } else if (check.given("rod.density")) {
    check.add("rod.density", "`rod.density` is there for the buoyancy: it needs `load.fluid_density`");
  }
  if (down.norm() > 0) down *= buoyancy_factor(c) / down.norm();
  if (has_sections(c))
    load.weight_direction = down;  // the weight is that of the section
  else
    load.force += c.number("rod.weight_per_length") * down;
  return load;
}

namespace {

void assemble_tip(const Check& check, const std::string& kind, End& end) {
  const Case& c = check.c;
  if (end.kind == End::Kind::free || end.kind == End::Kind::guided)
    for (const char* key : {"end.eccentricity", "end.slope"})
      if (check.given(key)) {
        Issue& issue = check.add(key, "`" + std::string(key) + "` cannot be given: it follows from the solution");
        issue.value = "end.kind = \"" + kind + "\"";
      }
  for (const char* key : {"end.tip_force", "end.tip_couple", "end.tip_frame"})
    if (end.kind != End::Kind::free && check.given(key)) {
      Issue& issue = check.add(key, "`" + std::string(key) + "` belongs to a free tip");
      issue.value = "end.kind = \"" + kind + "\"";
      issue.bound = "end.kind = \"free\"";
    }
  for (int i = 0; i < 3; ++i) {
    end.tip.force[i] = c.component("end.tip_force", i);
    end.tip.couple[i] = c.component("end.tip_couple", i);
  }
  end.tip.follower = c.word("end.tip_frame") == "rod";
  const std::string formulation = c.word("solve.formulation", "eulerian");
  if ((end.kind == End::Kind::free || end.kind == End::Kind::guided) && formulation != "eulerian") {
    Issue& issue = check.add("solve.formulation", "this formulation does not treat a " + kind + " end");
    issue.value = "\"" + formulation + "\"";
    issue.bound = "\"eulerian\"";
  }
}

}  // namespace

void assemble_ends(const Check& check, Problem& problem) {
  const Case& c = check.c;
  for (const std::string name : {"start", "end"}) {
    End& end = name == "start" ? problem.start : problem.end;
    const std::string kind = c.word(name + ".kind");
    end.kind = kind == "sleeve"                    ? End::Kind::sleeve
               : kind == "pinned"                  ? End::Kind::pinned
               : kind == "guided"                  ? End::Kind::guided
               : (kind == "free" || kind == "tip") ? End::Kind::free
                                                   : End::Kind::clamped;
    if (name == "end") assemble_tip(check, kind, end);
    for (int i = 0; i < 2; ++i) {
      end.eccentricity[i] = c.component(name + ".eccentricity", i);
      end.slope[i] = c.component(name + ".slope", i);
      if (kind == "pinned" && end.slope[i].value != 0.0) {
        check.add(name + ".slope", "a pinned end has no prescribed slope").hint = "kind = \"sleeve\" fixes the tangent";
        break;
      }
    }
    end.roll = c.number(name + ".roll");
    if (check.given(name + ".push") && !kind.empty() && kind != "sleeve") {
      Issue& issue = check.add(name + ".push", "`push` is the thrust outside a sleeve");
      issue.value = "kind = \"" + kind + "\"";
      issue.bound = "kind = \"sleeve\"";
    }
  }
  std::vector<std::string> axials{"start.axial_force", "end.axial_force",  "start.push",
                                  "end.push",          "start.rod_length", "end.rod_length"};
  std::vector<std::string> twists{"start.torque", "end.torque", "start.twist", "end.twist"};
  std::string axial, twist;
  const auto any_given = [&](const std::vector<std::string>& keys) {
    return std::any_of(keys.begin(), keys.end(), [&](const std::string& key) { return check.given(key); });
  };
  if (problem.end.kind == End::Kind::free) {  // nothing given: no force, no torque
    for (const char* key : {"start.axial_force", "start.push", "end.push", "start.torque", "start.twist", "end.twist"})
      if (check.given(key)) {
        Issue& issue = check.add(key, "`" + std::string(key) + "` cannot be given: the tip is free");
        issue.hint =
            "a free tip has its own axial force and torque, zero unless `end.axial_force`, `end.torque` or "
            "`end.tip_force` tell";
      }
    axials = {"end.axial_force", "start.rod_length", "end.rod_length"};
    twists = {"end.torque"};
    if (any_given({"start.rod_length", "end.rod_length"}) && check.given("end.position")) {
      Issue& issue = check.add("end.position", "`end.position` and the length of the rod exclude each other");
      issue.hint = "the tip lies where the rod of that length reaches";
    }
  }
  if (problem.end.kind != End::Kind::free || any_given(axials))
    axial = check.exactly_one("end", axials, "along the axis one condition over both ends");
  if (problem.end.kind != End::Kind::free || any_given(twists))
    twist = check.exactly_one("end", twists, "about the tangent one condition over both ends");
  const auto at = [](const std::string& key) { return key.compare(0, 5, "start") == 0 ? Which::start : Which::end; };
  if (!axial.empty()) {
    const std::string what = axial.substr(axial.find('.') + 1);
    problem.axial = what == "push"         ? AxialControl::push
                    : what == "rod_length" ? AxialControl::rod_length
                                           : AxialControl::axial_force;
    problem.axial_at = at(axial);
    problem.axial_value = c.number(axial);
    if (c.word("end.kind") == "clamped" && what != "rod_length") {
      Issue& issue =
          check.add(axial, "an end clamped at S = L fixes the length of the rod: `" + axial + "` cannot be given");
      issue.bound = "`end.rod_length`";
      issue.hint = "kind = \"sleeve\" lets the rod slide through the end";
    }
  }
  if (!twist.empty()) {
    problem.twist = twist.find("torque") != std::string::npos ? TwistControl::torque : TwistControl::twist;
    problem.twist_at = at(twist);
    problem.twist_value = c.number(twist);
    const std::string roll = problem.twist_at == Which::start ? "start.roll" : "end.roll";
    if (check.given(roll)) {
      check.add(roll, "`" + roll + "` and `" + twist + "` exclude each other").hint =
          "the roll belongs to the other end";
    }
  }
  problem.turns = static_cast<int>(c.number("end.turns"));
  if (check.given("end.turns") && c.word("tube.side", "inside") != "outside") {
    check.add("end.turns", "`end.turns` belongs to side = \"outside\"");
  }
}

namespace {

/// An end on the wall may leave it or follow it, not cross it: the gap's slope ς(Q' - |δ|') into the span.
void check_wall_slope(const Check& check, const Problem& problem, const std::string& name, double Q,
                      double eccentricity) {
  constexpr double kOnWall = 1e-12, kFlat = 1e-9;  // rounding of a place over Q and of a slope
  if (std::abs(eccentricity - Q) > kOnWall * Q || check.issues.has(name + ".slope")) return;
  const End& end = name == "start" ? problem.start : problem.end;
  if (end.kind == End::Kind::pinned) return;
  const double S = name == "start" ? 0.0 : std::min(problem.end_position.value, problem.tube.length());
  const double wall = problem.clearance_scale.value * problem.tube.clearance->at(S)[1];
  const double out =
      (end.eccentricity[0].value * end.slope[0].value + end.eccentricity[1].value * end.slope[1].value) / eccentricity;
  const double side = problem.tube.side == geometry::Side::inside ? 1.0 : -1.0;
  const double opening = side * (wall - out) * (name == "start" ? 1.0 : -1.0);
  if (opening >= -kFlat) return;
  Issue& issue = check.add(name + ".slope", "the " + name + " of the rod lies on the wall and its slope crosses it");
  issue.value = "d|δ|/dS = " + shortest(out);
  issue.bound =
      std::string((side > 0) == (name == "start") ? "<= " : ">= ") + shortest(wall) + ", the wall's own slope";
}

}  // namespace

void check_together(const Check& check, const Problem& problem) {
  const double length = problem.tube.length();
  const double position = problem.end_position.value;
  constexpr double kRounding = 1e-12;  // of a length: an end on the wall or at the end of the axis is on it
  if (position > length * (1 + kRounding)) {
    Issue& issue = check.add("end.position", "the far end lies beyond the axis");
    issue.value = shortest(position);
    issue.bound = "<= " + shortest(length) + ", the length of the axis";
    return;
  }
  if (problem.tube.side == geometry::Side::inside)
    for (std::size_t i = 0; i < problem.collars.size(); ++i) {
      double least = HUGE_VAL;
      for (int k = 0; k <= 1000; ++k)
        least = std::min(least, problem.clearance_scale.value * problem.tube.clearance->at(position * k / 1000.0)[0]);
      if (problem.collars[i].height < least) continue;
      Issue& issue = check.add("rod.collar", "a collar does not fit into the tube");
      issue.value =
          "at s = " + shortest(problem.collars[i].s) + " it stands out by " + shortest(problem.collars[i].height);
      issue.bound = "< " + shortest(least) + ", the least clearance of the rod";
    }
  for (const std::string name : {"start", "end"}) {
    const End& end = name == "start" ? problem.start : problem.end;
    if (check.issues.has(name + ".eccentricity")) continue;
    const double Q = problem.clearance_scale.value *
                     problem.tube.clearance->at(name == "start" ? 0.0 : std::min(position, length))[0];
    const double eccentricity = std::hypot(end.eccentricity[0].value, end.eccentricity[1].value);
    const bool inside = problem.tube.side == geometry::Side::inside;
    if (inside ? eccentricity <= Q * (1 + kRounding) : eccentricity >= Q * (1 - kRounding)) {
      check_wall_slope(check, problem, name, Q, eccentricity);
      continue;
    }
    Issue& issue = check.add(name + ".eccentricity",
                             inside ? "the " + name + " of the rod lies beyond the wall"
                                    : "the " + name + " of the rod lies inside the tube it should wind around");
    issue.value = "|δ| = " + shortest(eccentricity);
    issue.bound = (inside ? "<= " : ">= ") + shortest(Q) + ", the clearance there";
  }
}

Problem assemble(const Check& check, const geometry::Tube* tube) {
  Problem problem;
  problem.rod = assemble_rod(check);
  problem.rod_diameter = 2.0 * rod_radius(check.c).value_or(0.0);
  problem.law = assemble_sections(check, problem.rod);
  problem.load = assemble_load(check);
  problem.collars = assemble_collars(check);
  problem.point_loads = assemble_point_loads(check);
  if (const auto count = arc_count(check)) problem.law.from_end = count->from_end;
  problem.point_load_scale = check.c.number("load.point.scale", 1.0);
  assemble_ends(check, problem);
  problem.clearance_scale = check.c.number("tube.clearance.scale", 1.0);
  problem.body_force_scale = check.c.number("load.body_force.scale", 1.0);
  problem.body_couple_scale = check.c.number("load.body_couple.scale", 1.0);
  const std::optional<geometry::Tube> built = tube ? *tube : assemble_tube(check);
  if (built) {
    problem.tube = *built;
    problem.end_position = check.c.number("end.position", built->length());
    check_together(check, problem);
  }
  return problem;
}

}  // namespace tendril::io

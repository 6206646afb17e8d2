// What a case becomes: numbers, units, defaults, the problem at a value of the path; TOML and JSON alike.

#include <cmath>
#include <numbers>

#include "io_support.hpp"

namespace tendril::io::test {
namespace {

using segmentation::AxialControl;
using segmentation::TwistControl;
using segmentation::Which;

constexpr double kRounding = 1e-15;  // relative, a few operations

TEST(Cases, TheProblemOfAPlainCase) {
  const Case c = read(kCase);
  const segmentation::Problem p = build_problem(c);
  EXPECT_EQ(p.rod.bending_stiffness, 1.0);
  EXPECT_EQ(p.rod.torsional_stiffness, 0.75);
  EXPECT_FALSE(p.rod.axial_stiffness);
  EXPECT_EQ(p.tube.length(), 1.0);
  EXPECT_EQ(p.tube.clearance->at(0.5)[0], 0.025);
  EXPECT_EQ(p.tube.side, geometry::Side::inside);
  EXPECT_EQ(p.axial, AxialControl::axial_force);
  EXPECT_EQ(p.axial_at, Which::end);
  EXPECT_EQ(p.axial_value.value, -7.0);
  EXPECT_EQ(p.axial_value.rate, 0.0);
  EXPECT_EQ(p.twist, TwistControl::torque);
  EXPECT_EQ(p.twist_value.value, -1.0);
  EXPECT_EQ(p.start.kind, segmentation::End::Kind::clamped);
  EXPECT_EQ(p.end.kind, segmentation::End::Kind::sleeve);
  EXPECT_EQ(p.end_position.value, 1.0);
  EXPECT_EQ(p.clearance_scale.value, 1.0);
  EXPECT_EQ(p.load.force.norm(), 0.0);
}

TEST(Cases, JsonIsTheSameModel) {
  const std::string json = R"({"schema": 1, "title": "test",
    "rod": {"bending_stiffness": 1.0, "torsional_stiffness": 0.75},
    "tube": {"clearance": 0.025, "axis": {"kind": "helix", "radius": 0.225, "pitch_angle": 0.785, "length": 1}},
    "start": {"kind": "clamped"},
    "end": {"kind": "sleeve", "axial_force": -7, "torque": -1e0}})";
  const Case a = read(kCase), b = parse_case(json, "case.json", Format::json);
  EXPECT_EQ(a.numbers, b.numbers);
  EXPECT_EQ(a.words, b.words);
  EXPECT_EQ(a.title, b.title);
}

TEST(Cases, JsonErrorsAreTheSameErrors) {
  const std::string json =
      "{\"schema\": 1,\n \"rod\": {\"bending_stiffness\": -1.0,\n  \"torsional_stifness\": 0.75},\n"
      " \"tube\": {\"clearance\": 0.025, \"axis\": {\"kind\": \"straight\", \"length\": 1}},\n"
      " \"start\": {\"kind\": \"clamped\"}, \"end\": {\"kind\": \"sleeve\", \"axial_force\": null, \"torque\": -1}}";
  const std::vector<Issue> issues = issues_of(json, {}, {}, Format::json);
  ASSERT_EQ(issues.size(), 4u) << render(issues);
  EXPECT_EQ(issues[0].line, 2);  // rod lacks GJ under its right name
  EXPECT_EQ(issues[1].line, 2);
  EXPECT_EQ(issues[1].column, 31);
  EXPECT_EQ(issues[2].line, 3);
  EXPECT_EQ(issues[2].column, 3);
  EXPECT_EQ(issues[2].hint, "did you mean `torsional_stiffness`?");
  EXPECT_EQ(issues[3].line, 5);
  EXPECT_EQ(issues[3].hint, "leave the key out");
}

TEST(Cases, SiQuantitiesAndSections) {
  const Case c = read(R"(schema = 1
units = "si"
[rod]
young_modulus = "210 GPa"
poisson_ratio = 0.3
outer_diameter = "5 in"
inner_diameter = "4.276 in"
weight_per_length = "19.5 lb/ft"
[tube]
radius = "8 1/2 in"
[tube.axis]
kind = "straight"
length = "100 ft"
direction = [0, 0, 2]
[start]
kind = "clamped"
[end]
kind = "sleeve"
push = "12 klbf"
twist = "90 deg"
[load]
gravity = [0, -3, 0]
)");
  const segmentation::Problem p = build_problem(c);
  const double D = 0.127, d = 4.276 * 0.0254, E = 210e9;
  const double EI = E * std::numbers::pi / 64 * (std::pow(D, 4) - std::pow(d, 4));
  EXPECT_NEAR(p.rod.bending_stiffness, EI, kRounding * EI);
  EXPECT_NEAR(p.rod.torsional_stiffness, EI / 1.3, kRounding * EI);
  EXPECT_NEAR(*p.rod.axial_stiffness, E * std::numbers::pi / 4 * (D * D - d * d), kRounding * E);
  EXPECT_NEAR(p.tube.length(), 30.48, kRounding * 30.48);
  EXPECT_NEAR(p.tube.clearance->at(1.0)[0], (8.5 - 2.5) * 0.0254, kRounding);
  EXPECT_EQ(p.axial, AxialControl::push);
  EXPECT_NEAR(p.axial_value.value, 12000 * 0.45359237 * 9.80665, 1e-11);
  EXPECT_EQ(p.twist, TwistControl::twist);
  EXPECT_NEAR(p.twist_value.value, std::numbers::pi / 2, kRounding);
  // only the direction of gravity counts
  EXPECT_NEAR(p.load.force[1], -19.5 * 0.45359237 * 9.80665 / 0.3048, 1e-12);
  EXPECT_EQ(p.load.force[0], 0.0);
}

TEST(Cases, OutsideClearanceAddsTheRadii) {
  const Case c = read(with("clearance = 0.025", "side = \"outside\"\nradius = 0.02\nrod_radius = 0.005",
                           with("\"clamped\"", "\"clamped\"\neccentricity = [0.03, 0]",
                                with("torque", "eccentricity = [0, 0.03]\nturns = 1\ntorque"))));
  const segmentation::Problem p = build_problem(c);
  EXPECT_NEAR(p.tube.clearance->at(0.0)[0], 0.025, kRounding);
  EXPECT_EQ(p.tube.side, geometry::Side::outside);
  EXPECT_EQ(p.turns, 1);
  EXPECT_EQ(p.start.eccentricity[0].value, 0.03);
  EXPECT_EQ(p.end.eccentricity[1].value, 0.03);
}

TEST(Cases, ConditionsMayBelongToTheStart) {
  const Case c = read(
      with("axial_force = -7.0\ntorque = -1.0\n", "", with("\"clamped\"", "\"sleeve\"\naxial_force = 3\ntwist = 0.5")));
  const segmentation::Problem p = build_problem(c);
  EXPECT_EQ(p.axial_at, Which::start);
  EXPECT_EQ(p.twist_at, Which::start);
  EXPECT_EQ(p.axial_value.value, 3.0);
}

TEST(Cases, OverridesReplaceAddRemoveAndIndex) {
  const Case c = read(kCase, {"end.axial_force=-2.5", "end.slope=[0.1,0]", "end.slope.1=0.2",
                              "title=", "solve.branch=planar", "end.kind=\"sleeve\""});
  EXPECT_EQ(c.number("end.axial_force"), -2.5);
  EXPECT_EQ(c.component("end.slope", 0), 0.1);
  EXPECT_EQ(c.component("end.slope", 1), 0.2);
  EXPECT_EQ(c.title, "");
  EXPECT_EQ(solve_options(c).branch, segmentation::BranchRule::planar);
  const Case swapped = read(kCase, {"end.axial_force=", "end.rod_length=1.1"});
  EXPECT_EQ(build_problem(swapped).axial, AxialControl::rod_length);
}

TEST(Cases, PartsOfTheAxisAndItsReverse) {
  const Case whole = read(kCase);
  const Case part = read(with("length = 1.0", "length = 1.0\nfrom = 0.25\nto = 0.75"));
  EXPECT_NEAR(part.tube.length(), 0.5, kRounding);
  const double kPlace = 1e-14;  // rounding of positions of order one
  EXPECT_LT((part.tube.axis->at(0.1).position - whole.tube.axis->at(0.35).position).norm(), kPlace);
  const Case back = read(with("length = 1.0", "length = 1.0\nreverse = true"));
  EXPECT_LT((back.tube.axis->at(0.1).position - whole.tube.axis->at(0.9).position).norm(), kPlace);
}

struct SmoothRow {
  const char* parameter;
  double start, value;
};

TEST(Paths, SmoothParametersCarryTheirRate) {
  const std::vector<SmoothRow> rows{{"end.axial_force", -7.0, -8.0},
                                    {"end.torque", -1.0, 2.0},
                                    {"end.slope.0", 0.0, 0.1},
                                    {"start.eccentricity.1", 0.0, 0.01},
                                    {"start.roll", 0.0, 1.0},
                                    {"end.position", 1.0, 0.8},
                                    {"load.body_force.scale", 1.0, 2.0},
                                    {"load.body_couple.scale", 1.0, 2.0},
                                    {"tube.clearance.scale", 1.0, 0.5}};
  for (const SmoothRow& row : rows) {
    const Case c =
        read(kCase + "[path]\nparameter = \"" + row.parameter + "\"\nvalues = [" + std::to_string(row.value) + "]\n");
    const continuation::Path path = study_path(c);
    EXPECT_TRUE(path.smooth) << row.parameter;
    EXPECT_EQ(path.start, row.start) << row.parameter;
    EXPECT_EQ(path.values, std::vector<double>{row.value}) << row.parameter;
    const segmentation::Problem p = build_problem(c, row.value);
    const std::vector<segmentation::Scalar> scalars{p.axial_value,           p.twist_value,       p.end.slope[0],
                                                    p.start.eccentricity[1], p.start.roll,        p.end_position,
                                                    p.body_force_scale,      p.body_couple_scale, p.clearance_scale};
    for (std::size_t i = 0; i < scalars.size(); ++i) {
      const bool mine = rows[i].parameter == std::string(row.parameter);
      EXPECT_EQ(scalars[i].rate, mine ? 1.0 : 0.0) << row.parameter << " at " << i;
      EXPECT_TRUE(!mine || scalars[i].value == row.value) << row.parameter;
    }
  }
}

TEST(Paths, OtherNumbersRebuildTheProblem) {
  const Case c = read(kCase + "[path]\nparameter = \"tube.axis.radius\"\nvalues = [0.3]\n");
  EXPECT_FALSE(study_path(c).smooth);
  EXPECT_NE(build_problem(c, 0.3).tube.axis, c.tube.axis);
  EXPECT_NEAR(build_problem(c, 0.3).tube.axis->at(0.0).position.norm(), 0.3, kRounding);
  const Case rod = read(kCase + "[path]\nparameter = \"rod.bending_stiffness\"\nvalues = [2]\n");
  EXPECT_FALSE(study_path(rod).smooth);
  EXPECT_EQ(build_problem(rod, 2.0).rod.bending_stiffness, 2.0);
  EXPECT_EQ(build_problem(rod, 2.0).tube.axis, rod.tube.axis);  // the geometry is shared
}

TEST(Paths, EquallySpacedValuesIncludeBothEnds) {
  const Case c = read(kCase + "[path]\nparameter = \"end.axial_force\"\nfrom = -8\nto = -10\nsteps = 5\n");
  EXPECT_EQ(study_path(c).values, (std::vector<double>{-8, -8.5, -9, -9.5, -10}));
}

TEST(Paths, ValuesHaveTheUnitOfTheParameter) {
  const Case c = read(with("title = \"test\"", "units = \"si\"") +
                      "[path]\nparameter = \"end.axial_force\"\nvalues = [\"-8 kN\", -9]\n");
  EXPECT_EQ(study_path(c).values, (std::vector<double>{-8000, -9}));
}

// A wire goes on behind the inlet: a tip longer than what is in the tube is cut there, and told.
TEST(Case, SectionFromTheTipMayBeginBehindTheInlet) {
  const std::string length = with("axial_force = -7.0", "rod_length = 1.2");
  const auto section = [&](const std::string& from) {
    return with("torsional_stiffness = 0.75",
                "torsional_stiffness = 0.75\n[[rod.section]]\nlength = 1.5\nbending_stiffness = 0.5\n" + from, length);
  };
  const Case c = read(section("measured_from = \"end\""));
  ASSERT_EQ(c.notes.size(), 1u);
  EXPECT_EQ(c.notes[0], "rod.section.0 is longer than the rod, 1.2: the rest of it lies behind the inlet");
  EXPECT_THROW(read(section("measured_from = \"start\"")), InputError);
}

}  // namespace
}  // namespace tendril::io::test

// Every class of wrong input: one message, at its exact line and column, with what is allowed and a hint.

#include "io_support.hpp"

namespace tendril::io::test {
namespace {

struct Expected {
  std::string text;
  int line, column;
  std::string key;
  std::string message, hint_or_bound;
  std::vector<std::string> overrides = {};
};

void check(const Expected& expected) {
  const std::vector<Issue> issues = issues_of(expected.text, expected.overrides);
  ASSERT_EQ(issues.size(), 1u) << expected.message << "\n" << render(issues);
  const Issue& issue = issues[0];
  EXPECT_EQ(issue.line, expected.line) << render(issue);
  EXPECT_EQ(issue.column, expected.column) << render(issue);
  EXPECT_EQ(issue.key, expected.key) << render(issue);
  EXPECT_NE(issue.message.find(expected.message), std::string::npos) << render(issue);
  EXPECT_NE((issue.hint + issue.bound).find(expected.hint_or_bound), std::string::npos) << render(issue);
}

TEST(CaseErrors, TheCaseItselfIsValid) { EXPECT_TRUE(issues_of(kCase).empty()) << render(issues_of(kCase)); }

TEST(CaseErrors, UnknownKeys) {
  check({kCase + "[laod]\n", 23, 2, "laod", "unknown key `laod`", "did you mean `load`?"});
  check({with("clearance = 0.025", "clearance = 0.025\nclearence = 0.3"), 10, 1, "tube.clearence",
         "unknown key `tube.clearence`", "did you mean `clearance`?"});
  check({with("length = 1.0", "length = 1.0\naxial_force = 2"), 15, 1, "tube.axis.axial_force", "unknown key",
         "`end.axial_force`"});
}

TEST(CaseErrors, WrongTypes) {
  check({with("-7.0", "\"minus seven\""), 21, 15, "end.axial_force", "must be a number, not a string", "a number"});
  check({with("-7.0", "[1]"), 21, 15, "end.axial_force", "must be a number, not an array", ""});
  check({with("-7.0", "true"), 21, 15, "end.axial_force", "must be a number, not a boolean", ""});
  check({with("schema = 1", "schema = 1.0"), 1, 10, "schema", "must be an integer", "1"});
  check({with("kind = \"clamped\"", "kind = \"clamped\"\neccentricity = 0.1"), 18, 16, "start.eccentricity",
         "two numbers", ""});
  check({with("kind = \"clamped\"", "kind = \"clamped\"\neccentricity = [0.1]"), 18, 16, "start.eccentricity",
         "two numbers", ""});
  check({with("kind = \"clamped\"", "kind = \"clamped\"\neccentricity = [0, \"a\"]"), 18, 20, "start.eccentricity",
         "must be a number", ""});
  check({with("title = \"test\"", "title = 5"), 2, 9, "title", "must be a string", ""});
  check({with("-7.0", "1979-05-27"), 21, 15, "end.axial_force", "must be a number", ""});
  check({with("[start]\nkind = \"clamped\"", "[[start]]\nkind = \"clamped\""), 16, 1, "start",
         "must be a table, not an array", ""});
}

TEST(CaseErrors, MissingKeysAndTables) {
  check({with("schema = 1\n", ""), 1, 1, "schema", "missing key `schema`", "1"});
  check({with("bending_stiffness = 1.0\n", ""), 4, 2, "rod", "missing key `rod.bending_stiffness`", "EI"});
  check({with("torsional_stiffness = 0.75\n", ""), 4, 2, "rod", "`rod.torsional_stiffness` or `rod.poisson_ratio`",
         "exactly one"});
  check({with("[start]\nkind = \"clamped\"\n", ""), 1, 1, "start", "missing table [start]", ""});
  check({with("kind = \"clamped\"\n", ""), 16, 2, "start.kind", "missing key `start.kind`",
         "one of clamped, sleeve, pinned"});
  check({with("pitch_angle = 0.785\n", ""), 10, 7, "tube.axis", "missing key `tube.axis.pitch_angle`", ""});
  check({with("clearance = 0.025\n", ""), 8, 2, "tube", "`tube.clearance` or `tube.radius` is missing", ""});
}

TEST(CaseErrors, BoundsAndNonFiniteNumbers) {
  check({with("bending_stiffness = 1.0", "bending_stiffness = -1.0"), 5, 21, "rod.bending_stiffness", "out of bounds",
         "> 0"});
  check({with("torsional_stiffness = 0.75", "torsional_stiffness = 0"), 6, 23, "rod.torsional_stiffness",
         "out of bounds", "> 0"});
  check({with("torque", "slope = [0, 1e9]\ntorque"), 22, 13, "end.slope", "out of bounds", "<= 100"});
  check({with("-7.0", "nan"), 21, 15, "end.axial_force", "must be a finite number", ""});
  check({with("-7.0", "-inf"), 21, 15, "end.axial_force", "must be a finite number", ""});
  check({with("0.785", "1.7"), 13, 15, "tube.axis.pitch_angle", "out of bounds", "<= 1.57"});
  check({with("schema = 1", "schema = 2"), 1, 10, "schema", "not known to this version", "1"});
  check({with("torsional_stiffness = 0.75", "poisson_ratio = 0.6"), 6, 17, "rod.poisson_ratio", "out of bounds",
         "<= 0.5"});
  check({kCase + "[solve]\ntolerance = 0\n", 24, 13, "solve.tolerance", "out of bounds", "1e-12"});
}

TEST(CaseErrors, Words) {
  check({with("\"helix\"", "\"helx\""), 11, 8, "tube.axis.kind", "does not know \"helx\"", "did you mean \"helix\"?"});
  check({with("\"clamped\"", "\"free\""), 17, 8, "start.kind", "not available yet", "clamped, sleeve, pinned"});
  check({kCase + "[solve]\nformulation = \"lagrangien\"\n", 24, 15, "solve.formulation", "does not know \"lagrangien\"",
         "did you mean \"lagrangian\"?"});
}

// Sections: unknown names and values, where they begin and end, what belongs together.
TEST(CaseErrors, Sections) {
  const auto section = [](const std::string& text) {
    return with("torsional_stiffness = 0.75", "torsional_stiffness = 0.75\n[[rod.section]]\n" + text);
  };
  check({section("length = 1.0\nbending_stifness = 2.0"), 9, 1, "rod.section.bending_stifness", "unknown key",
         "did you mean `bending_stiffness`?"});
  check({section("length = 1.0\nbending_stiffness = [1.0, 0.0]"), 9, 27, "rod.section.0.bending_stiffness",
         "out of bounds", "> 0"});
  check({section("length = 1.0\nmeasured_from = \"tip\""), 9, 17, "rod.section.0.measured_from",
         "does not know \"tip\"", "start, end"});
  check({section("from = 0.5\nto = 0.4"), 9, 6, "rod.section.0.to", "ends where it begins, or before", "> 0.5"});
  check({section("to = 0.4\n[[rod.section]]\nfrom = 0.3\nto = 0.5"), 9, 1, "rod.section.1", "two sections overlap",
         "s >= 0.4"});
  check({section("to = 0.4\n[[rod.section]]\nto = 0.2\nmeasured_from = \"end\""), 9, 1, "rod.section.1",
         "measured from both ends of a rod whose length is not given", "rod_length"});
  check({section("to = 0.4\ndiameter = 0.1"), 9, 12, "rod.section.0.diameter", "needs Young's modulus",
         "rod.young_modulus"});
  check({section("to = 0.4\nweight_per_length = 1.0"), 9, 21, "rod.section.0.weight_per_length", "needs `load.gravity`",
         "[0, 0, -1]"});
}

// Collars and loads: what is missing, what does not fit, what is in two places.
TEST(CaseErrors, CollarsAndLoads) {
  const auto rod = [](const std::string& text) {
    return with("torsional_stiffness = 0.75", "torsional_stiffness = 0.75\n" + text);
  };
  check({rod("[[rod.collar]]\nheight = 0.001"), 7, 1, "rod.collar.at", "missing key", ""});
  check({rod("[[rod.collar]]\nat = 0.3"), 7, 1, "rod.collar.0", "`rod.collar.0.height` is missing", "exactly one"});
  check({rod("[[rod.collar]]\nat = 0.3\ndiameter = 0.1"), 9, 12, "rod.collar.0.diameter",
         "needs the diameter of the rod", "tube.rod_radius"});
  check({rod("[[rod.collar]]\nat = 0.3\nheight = 7.0"), 7, 1, "rod.collar", "does not fit into the tube", "< "});
  check({rod("density = 2.0"), 7, 11, "rod.density", "needs `load.fluid_density`", ""});
  check({rod("[load]\nbody_force = [[0.0, 1, 2, 3]]"), 8, 14, "load.body_force", "at least two rows", ""});
  check(
      {rod("[load]\nbody_force = [[0.0, 1, 2, 3], [0.0, 1, 2, 3]]"), 8, 32, "load.body_force", "S must increase", ""});
  check({rod("density = 2.0\n[load]\nfluid_density = 1.0"), 9, 17, "load.fluid_density",
         "needs `rod.weight_per_length`", ""});
  check({rod("[[load.point]]\nforce = [1, 2, 3]"), 7, 1, "load.point.0", "is missing", "exactly one"});
}

TEST(CaseErrors, KeysThatExcludeEachOther) {
  check({with("torque", "push = 3.0\ntorque"), 22, 8, "end.push", "`end.push` and `end.axial_force` exclude each other",
         "exactly one of"});
  check({with("torque = -1.0", "torque = -1.0\ntwist = 0.1"), 23, 9, "end.twist",
         "`end.twist` and `end.torque` exclude each other", ""});
  check({with("torque = -1.0\n", ""), 19, 2, "end",
         "`start.torque`, `end.torque`, `start.twist` or `end.twist` is missing", ""});
  check({with("axial_force = -7.0\n", ""), 19, 2, "end", "`end.rod_length` is missing", ""});
  check({with("\"sleeve\"", "\"clamped\""), 21, 15, "end.axial_force", "fixes the length of the rod",
         "`end.rod_length`"});
  check({with("clearance = 0.025", "clearance = 0.025\nradius = 0.1\nrod_radius = 0.05"), 10, 10, "tube.radius",
         "exclude each other", ""});
  check({with("torsional_stiffness = 0.75", "torsional_stiffness = 0.75\npoisson_ratio = 0.3"), 7, 17,
         "rod.poisson_ratio", "exclude each other", ""});
  check({with("torsional_stiffness = 0.75", "poisson_ratio = 0.3\nyoung_modulus = 2\ndiameter = 0.1"), 5, 21,
         "rod.bending_stiffness", "exclude each other", ""});
  check({with("pitch_angle = 0.785", "pitch_angle = 0.785\nmajor_radius = 3"), 14, 16, "tube.axis.major_radius",
         "does not belong to kind = \"helix\"", "kind torus"});
  check({with("torque = -1.0", "torque = -1.0\nroll = 0.2"), 23, 8, "end.roll", "exclude each other", "other end"});
  check({with("torque = -1.0", "torque = -1.0\nturns = 2"), 23, 9, "end.turns", "belongs to side = \"outside\"", ""});
  check({with("axial_force = -7.0", "push = 7.0", with("\"sleeve\"", "\"pinned\"")), 21, 8, "end.push",
         "thrust outside a sleeve", "sleeve"});
  check({with("torsional_stiffness = 0.75", "torsional_stiffness = 0.75\nweight_per_length = 2"), 7, 21,
         "rod.weight_per_length", "needs `load.gravity`", "[load]"});
  check({kCase + "[load]\ngravity = [0, 0, 1]\n", 24, 11, "load.gravity", "needs `rod.weight_per_length`",
         "load.body_force"});
}

TEST(CaseErrors, Geometry) {
  check({with("torque", "eccentricity = [0.02, 0.02]\ntorque"), 22, 16, "end.eccentricity", "lies beyond the wall",
         "0.025"});
  check({with("clearance = 0.025", "side = \"outside\"\nclearance = 0.025",
              with("\"clamped\"", "\"clamped\"\neccentricity = [0, 0.1]")),
         21, 2, "end.eccentricity", "lies inside the tube", ">= 0.025"});
  check({with("0.025", "0.6"), 9, 13, "tube.clearance", "below 1", ""});
  check({with("0.025", "[[0.0, 0.1], [0.5, 0.1]]"), 9, 13, "tube.clearance", "the table ends at S = 0.5", ""});
  check({with("0.025", "[[0.0, 0.1], [0.5, -0.1], [1.0, 0.1]]"), 9, 32, "tube.clearance", "out of bounds", "> 0"});
  check({with("0.025", "[[0.0, 0.1], [0.0, 0.1], [1.0, 0.1]]"), 9, 27, "tube.clearance", "S must increase", ""});
  check({with("clearance = 0.025", "radius = 0.1\nrod_radius = 0.2"), 9, 10, "tube.radius", "does not fit", "> 0"});
  check({with("clearance = 0.025", "radius = 0.1"), 9, 10, "tube.radius", "needs the radius of the rod", "rod_radius"});
  check({with("length = 1.0", "length = 1.0\nto = 1.5"), 15, 6, "tube.axis.to", "outside the curve", "<= 1"});
  check({with("length = 1.0", "length = 1.0\nto = 0.5\nfrom = 0.6"), 15, 6, "tube.axis.to", "beyond `tube.axis.from`",
         "> 0.6"});
  check({with("torque", "eccentricity = [0.025, 0]\nslope = [-0.1, 0]\ntorque"), 23, 9, "end.slope",
         "lies on the wall and its slope crosses it", ">= 0"});
  EXPECT_TRUE(issues_of(with("torque", "eccentricity = [0.025, 0]\nslope = [0, 0.1]\ntorque")).empty());
  check({with("torque", "position = 1.5\ntorque"), 22, 12, "end.position", "beyond the axis", "<= 1"});
}

TEST(CaseErrors, Paths) {
  const std::string path = kCase + "[path]\n";
  check({path + "values = [1]\n", 23, 2, "path.parameter", "missing key `path.parameter`", ""});
  check({path + "parameter = \"end.axial_forse\"\nvalues = [1]\n", 24, 13, "path.parameter", "does not name a number",
         "did you mean \"end.axial_force\"?"});
  check({path + "parameter = \"end.slope\"\nvalues = [1]\n", 24, 13, "path.parameter", "does not name a number",
         "\"end.slope.0\""});
  check({path + "parameter = \"end.push\"\nvalues = [1]\n", 24, 13, "path.parameter", "which it does not give",
         "end.push"});
  check({path + "parameter = \"end.axial_force\"\n", 23, 2, "path", "needs `values`", ""});
  check({path + "parameter = \"end.axial_force\"\nvalues = []\n", 25, 10, "path.values", "at least one number", ""});
  check({path + "parameter = \"end.axial_force\"\nvalues = [1, nan]\n", 25, 14, "path.values", "finite", ""});
  check({path + "parameter = \"end.axial_force\"\nvalues = [1]\nto = 3\n", 26, 6, "path.to", "exclude each other", ""});
  check({path + "parameter = \"rod.bending_stiffness\"\nvalues = [2, -1]\n", 25, 14, "path", "out of bounds", "> 0"});
  check({path + "parameter = \"end.eccentricity.0\"\nvalues = [0.01, 0.03]\n", 25, 17, "end.eccentricity",
         "beyond the wall", "0.025"});
  check({path + "parameter = \"tube.clearance.scale\"\nvalues = [2, 100]\n", 25, 14, "tube.clearance", "below 1", ""});
}

TEST(CaseErrors, ATableThatIsNoneSaysNothingOfItsKeys) {
  const std::vector<Issue> issues = issues_of(kCase, {"end=1"});
  ASSERT_EQ(issues.size(), 1u) << render(issues);
  EXPECT_NE(issues[0].message.find("`end` must be a table"), std::string::npos) << render(issues);
}

TEST(CaseErrors, OverridesPointAtThemselves) {
  const std::vector<Issue> issues =
      issues_of(kCase, {"end.axial_forse=3", "rod.bending_stiffness = -2", "title", "end.slope.7=1"});
  ASSERT_EQ(issues.size(), 4u) << render(issues);
  for (const Issue& issue : issues) EXPECT_EQ(issue.file, "--set");
  const std::string text = render(issues);
  EXPECT_NE(
      text.find(
          "--set:1:1: error: unknown key `end.axial_forse`\n    1 | end.axial_forse=3\n      | ^~~~~~~~~~~~~~~\n"),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("--set:1:25: error: `rod.bending_stiffness` is out of bounds"), std::string::npos) << text;
  EXPECT_NE(text.find("an override is written key=value"), std::string::npos) << text;
}

TEST(CaseErrors, SyntaxHasAPlace) {
  const std::vector<Issue> number = issues_of(with("-7.0", "12O0.0"));
  ASSERT_EQ(number.size(), 1u);
  EXPECT_EQ(number[0].line, 21);
  EXPECT_EQ(number[0].column, 17);
  const std::vector<Issue> dot = issues_of(with("-7.0", ".5"));
  ASSERT_EQ(dot.size(), 1u);
  EXPECT_EQ(dot[0].line, 21);
  EXPECT_NE(dot[0].hint.find("write 0.5"), std::string::npos) << render(dot);
  const std::vector<Issue> twice = issues_of(with("torque = -1.0", "torque = -1.0\ntorque = -2.0"));
  ASSERT_EQ(twice.size(), 1u);
  EXPECT_EQ(twice[0].line, 23);

  const auto json = [](const std::string& text) { return issues_of(text, {}, {}, Format::json); };
  const std::vector<Issue> comma = json("{\n  \"schema\": 1\n  \"title\": \"x\"\n}");
  ASSERT_EQ(comma.size(), 1u);
  EXPECT_EQ(comma[0].line, 3);
  EXPECT_EQ(comma[0].column, 3);
  EXPECT_NE(comma[0].message.find("',' or '}' was expected"), std::string::npos);
  ASSERT_EQ(json("{\"schema\": 1, \"schema\": 1}").size(), 1u);
  EXPECT_EQ(json("{\"schema\": 1, \"schema\": 1}")[0].column, 15);
  EXPECT_NE(json("{\"schema\": NaN}")[0].message.find("a value was expected"), std::string::npos);
  EXPECT_EQ(json("{\"title\": \"\xC3\xA9\xC3\xA9\" \"q\": 1}")[0].column, 16);  // columns count characters
}

TEST(CaseErrors, EmptyAndForeignFiles) {
  for (const std::string text : {"", "  \n\n", "# only a comment\n"}) {
    const std::vector<Issue> issues = issues_of(text);
    ASSERT_EQ(issues.size(), 1u);
    EXPECT_EQ(issues[0].message, "the case file is empty");
  }
  EXPECT_EQ(issues_of("[1, 2]", {}, {}, Format::json).size(), 1u);
  EXPECT_EQ(issues_of("{}", {}, {}, Format::json)[0].message, "the case file is empty");
  EXPECT_EQ(issues_of(std::string(300, '['), {}, {}, Format::json).size(), 1u);
  EXPECT_EQ(issues_of(std::string("\x00\xFF\xFE\x01", 4)).size(), 1u);
  EXPECT_THROW(read_case("/no/such/file.toml"), FileError);
  EXPECT_THROW(read_case("/"), FileError);
}

TEST(CaseErrors, AllAtOnceInOrder) {
  std::string text = with("bending_stiffness = 1.0", "bending_stiffness = -1.0");
  text = with("\"helix\"", "\"helx\"", text);
  text = with("-7.0", "\"x\"", text);
  text += "[lod]\n";
  const std::vector<Issue> issues = issues_of(text);
  ASSERT_EQ(issues.size(), 4u) << render(issues);
  const int lines[] = {5, 11, 21, 23};
  for (int i = 0; i < 4; ++i) EXPECT_EQ(issues[i].line, lines[i]);
}

TEST(CaseErrors, CaretStandsUnderTheValueBehindWideCharacters) {
  const std::string text = render(issues_of(with("kind = \"clamped\"", "kind = \"clampéd\" # é")));
  EXPECT_NE(text.find("case.toml:17:8: error:"), std::string::npos) << text;
  EXPECT_NE(text.find("   17 | kind = \"clampéd\" # é\n      |        ^~~~~~~~~\n"), std::string::npos) << text;
}

TEST(CaseErrors, UnitsInCases) {
  std::string si = with("title = \"test\"", "units = \"si\"");
  check({with("-7.0", "\"-12 lb\"", si), 21, 15, "end.axial_force", "ambiguous", "lbf"});
  check({with("-7.0", "\"-12 kn\"", si), 21, 15, "end.axial_force", "unknown unit", "`kN`"});
  check({with("-7.0", "\"-12 mm\"", si), 21, 15, "end.axial_force", "not the unit of a force", "klbf"});
  check({with("-7.0", "\"-12 kN\""), 21, 15, "end.axial_force", "units = \"dimensionless\"", "units = \"si\""});
}

}  // namespace
}  // namespace tendril::io::test

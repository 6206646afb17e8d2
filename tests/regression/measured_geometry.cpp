// Every measured vessel and well beside the checkout goes into a case as it is (they are not redistributed;
// TENDRIL_DATA names another place). Lengths, depths and offsets are those their notes give; branches that fold are
// refused.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include "tendril/geometry/tube_check.hpp"
#include "tendril/io/case.hpp"

namespace tendril::test {
namespace {

namespace fs = std::filesystem;

fs::path data() {
  if (const char* place = std::getenv("TENDRIL_DATA")) return place;
  return fs::path(TENDRIL_SOURCE_DIR) / ".." / "shared" / "data";
}

std::string case_of(const std::string& kind, const fs::path& file, const std::string& axis = "") {
  const std::string tube = kind == "survey" ? "outer_diameter = \"5 in\"\n[tube]\nradius = \"4 1/4 in\"\n"
                                            : "diameter = \"0.889 mm\"\n[tube]\n";
  return "schema = 1\nunits = \"si\"\n[rod]\nbending_stiffness = 1.0\npoisson_ratio = 0.3\n" + tube +
         "[tube.axis]\nkind = \"" + kind + "\"\nfile = \"" + file.string() + "\"\n" + axis +
         "[start]\nkind = \"clamped\"\n[end]\nkind = \"sleeve\"\naxial_force = 0.0\ntorque = 0.0\n";
}

bool noted(const io::Case& c, const std::string& part) {
  for (const std::string& note : c.notes) {
    if (note.find(part) != std::string::npos) return true;
  }
  return false;
}

struct Vessel {
  const char* name;
  double length;        // mm, of the polygon or of another smoothing spline: to 3 %
  double narrow, wide;  // mm
  bool folds;
};

TEST(Measured, Vessels) {
  const fs::path directory = data() / "vessels";
  if (!fs::exists(directory)) GTEST_SKIP() << "no vessel data beside the checkout: " << directory;
  const Vessel vessels[] = {
      {"raw_vmtk_jitter_simvascular_demo", 430.07 - 15.81, 4.57, 12.67, false},  // less its two caps
      {"simvascular_arch_asc_to_desc", 118.52, 2.61, 3.85, false},
      {"simvascular_arch_branch1", 36.75, 0.77, 3.75, true},
      {"simvascular_arch_branch2", 40.36, 0.81, 3.75, true},
      {"simvascular_arch_branch3", 45.06, 0.82, 3.75, true},
      {"simvascular_arch_branch4", 39.71, 0.81, 3.85, false},
      {"simvascular_demo_aorta_left_iliac", 414.06, 4.57, 12.67, false},
      {"simvascular_demo_aorta_right_iliac", 432.80, 4.47, 12.67, false},
      {"vmtk_aorta_iliac_0", 77.81, 3.37, 7.58, false},
      {"vmtk_aorta_iliac_1", 76.16, 2.78, 7.58, false},
  };
  for (const Vessel& vessel : vessels) {
    SCOPED_TRACE(vessel.name);
    // a hair for a rod: the clearance is the radius of the vessel
    const std::string text = case_of("points", directory / (std::string(vessel.name) + ".csv"), "");
    const std::string hair =
        text.substr(0, text.find("diameter")) + "diameter = \"1 um\"\n" + text.substr(text.find("[tube]"));
    if (vessel.folds) {
      try {
        io::parse_case(hair, "vessel.toml", io::Format::toml);
        ADD_FAILURE() << "a tube that folds was accepted";
      } catch (const io::InputError& error) {
        ASSERT_FALSE(error.issues().empty());
        const io::Issue& issue = error.issues().front();
        EXPECT_EQ(issue.key, "tube.axis.file");
        EXPECT_NE(issue.message.find("clearance x curvature: is "), std::string::npos) << issue.message;
        EXPECT_NE(issue.message.find(" at S = "), std::string::npos) << issue.message;
        EXPECT_NE(issue.hint.find("smoothed already"), std::string::npos) << issue.hint;
      }
      continue;
    }
    const io::Case c = io::parse_case(hair, "vessel.toml", io::Format::toml);
    const geometry::TubeQuality q = geometry::check_tube(c.tube);
    EXPECT_NEAR(q.length * 1e3 / vessel.length, 1, 0.03);
    // the radius is smoothed within 5 % of the smallest
    EXPECT_NEAR(q.clearance_min * 1e3, vessel.narrow, 0.05 * vessel.narrow + 0.01);
    EXPECT_NEAR(q.clearance_max * 1e3, vessel.wide, 0.05 * vessel.narrow + 0.01);
    EXPECT_LE(c.curve.deviation, c.curve.smoothing);
    EXPECT_TRUE(noted(c, "converted from mm to m"));
    EXPECT_TRUE(noted(c, "largest deviation"));
    const bool raw = std::string(vessel.name).rfind("raw", 0) == 0;
    EXPECT_EQ(noted(c, "end cap"), raw);
    if (raw || std::string(vessel.name).rfind("vmtk", 0) == 0) EXPECT_TRUE(noted(c, "tiny step"));
    if (raw) EXPECT_TRUE(noted(c, "2 repeated points removed"));
    // from the other end
    const std::string from_end =
        hair.substr(0, hair.find("[start]")) + "reverse = true\n" + hair.substr(hair.find("[start]"));
    const io::Case back = io::parse_case(from_end, "vessel.toml", io::Format::toml);
    EXPECT_NEAR(back.tube.length(), q.length, 1e-12);
    EXPECT_LT((back.tube.axis->at(0).position - c.tube.axis->at(q.length).position).norm(), 1e-12);
    EXPECT_NEAR(back.tube.clearance->at(0)[0], c.tube.clearance->at(q.length)[0], 1e-6);  // smoothed from the other end
  }
}

struct Well {
  const char* name;
  double length, depth, offset, inclination;  // m, m, m, deg, to the digits of the notes
  std::size_t wraps;
};

TEST(Measured, Wells) {
  const fs::path directory = data() / "wells";
  if (!fs::exists(directory)) GTEST_SKIP() << "no well data beside the checkout: " << directory;
  const Well wells[] = {
      {"forge_16A_78_32", 3339.1, 2608.7, 1230.6, 69.4, 6}, {"iscwsa_1_erd_synthetic", 8000.0, 3521.1, 5914.3, 90, 0},
      {"nlog_P11_A_02", 2691.0, 1605.6, 993.2, 89.7, 1},    {"wellpathpy_10H", 2889.2, 1132.0, 2045.5, 90.9, 1},
      {"wellpathpy_9H", 2414.6, 1063.5, 1378.1, 91.5, 1},   {"wellpathpy_example", 2267.0, 2013.3, 940.6, 36.0, 1},
  };
  for (const Well& well : wells) {
    SCOPED_TRACE(well.name);
    const io::Case c =
        io::parse_case(case_of("survey", directory / (std::string(well.name) + ".csv")), "well.toml", io::Format::toml);
    const geometry::AxisPoint end = c.tube.axis->at(c.tube.length());
    EXPECT_NEAR(c.tube.length(), well.length, 0.051);
    EXPECT_NEAR(end.position.z(), well.depth, 0.051);
    EXPECT_NEAR(std::hypot(end.position.x(), end.position.y()), well.offset, 0.051);
    double steepest = 1.0;
    for (int i = 0; i <= 2000; ++i)
      steepest = std::min(steepest, c.tube.axis->at(c.tube.length() * i / 2000).frame(2, 2));
    EXPECT_NEAR(std::acos(steepest) * 180 / std::numbers::pi, well.inclination, 0.1);
    EXPECT_EQ(noted(c, "passes north " + std::to_string(well.wraps) + " time"), well.wraps > 0);
    EXPECT_LE(c.curve.deviation, c.curve.smoothing);
  }
}

}  // namespace
}  // namespace tendril::test

// Centrelines and surveys from CSV: units and headers recognised, every defect told once with its line.

#include <cmath>
#include <numbers>

#include "io_support.hpp"

namespace tendril::io::test {
namespace {

constexpr double kRounding = 1e-14;  // of lengths of order one

std::string points_case(const std::string& rest = "", const std::string& units = "si") {
  return "schema = 1\nunits = \"" + units +
         "\"\n[rod]\nbending_stiffness = 1.0\ntorsional_stiffness = 0.75\n[tube]\nclearance = 0.001\n"
         "[tube.axis]\nkind = \"points\"\nfile = \"line.csv\"\n" +
         rest + "[start]\nkind = \"clamped\"\n[end]\nkind = \"sleeve\"\naxial_force = 0.0\ntorque = 0.0\n";
}

std::string survey_case(const std::string& rest = "") {
  std::string text = points_case(rest);
  return with("\"points\"", "\"survey\"", text);
}

// A gentle curve, x = z²/4.
std::string curve(const std::string& header, double scale, const std::string& delimiter = ",",
                  const std::string& tail = "") {
  std::string text = header;
  for (int i = 0; i <= 10; ++i) {
    const double z = 0.1 * i;
    text += shortest(0.25 * z * z * scale) + delimiter + "0" + delimiter + shortest(z * scale) + tail + "\n";
  }
  return text;
}

TEST(Csv, HeadersUnitsAndDelimiters) {
  Scratch scratch;
  scratch.write("line.csv", curve("x,y,z\n", 1));
  const double length = read(points_case(), {}, scratch.path()).tube.length();
  // arc length of x = z²/4 on [0, 1]: z√(1+z²/4)/2 + asinh(z/2); the spline is exact for a parabola up to its
  // parametrisation
  EXPECT_NEAR(length, std::sqrt(1.25) / 2 + std::asinh(0.5), 1e-7);
  const std::string texts[] = {curve("", 1),
                               curve("x_mm,y_mm,z_mm\n", 1000),
                               curve("# made by hand\nX [mm];Y [mm];Z [mm]\n", 1000, ";"),
                               curve("x\ty\tz\nmm\tmm\tmm\n", 1000, "\t"),
                               curve("x y z\n", 1, "  "),
                               "\xEF\xBB\xBF" + curve("\"x (cm)\",\"y (cm)\",\"z (cm)\"\r\n", 100)};
  for (const std::string& text : texts) {
    scratch.write("line.csv", text);
    EXPECT_NEAR(read(points_case(), {}, scratch.path()).tube.length(), length, kRounding) << text.substr(0, 40);
  }
  std::string comma = curve("x;y;z\n", 1, ";");
  for (char& c : comma) c = c == '.' ? ',' : c;
  scratch.write("line.csv", comma);
  EXPECT_NEAR(read(points_case(), {}, scratch.path()).tube.length(), length, kRounding);
}

TEST(Csv, DimensionlessTakesNumbersAsWritten) {
  Scratch scratch;
  scratch.write("line.csv", curve("x_mm,y_mm,z_mm\n", 1));
  const Case c = read(points_case("", "dimensionless"), {}, scratch.path());
  EXPECT_NEAR(c.tube.length(), 1.04, 0.01);
  ASSERT_EQ(c.notes.size(), 1u);
  scratch.write("line.csv", curve("x_mm,y_m,z_mm\n", 1));
  EXPECT_EQ(issues_of(points_case("", "dimensionless"), {}, scratch.path()).size(), 1u);
}

TEST(Csv, RadiusColumnGivesTheClearance) {
  Scratch scratch;
  std::string text = "x_mm,y_mm,z_mm,MaximumInscribedSphereRadius_mm\n";
  for (int i = 0; i <= 10; ++i) text += "0,0," + std::to_string(10 * i) + "," + shortest(5.0 - 0.1 * i) + "\n";
  scratch.write("line.csv", text);
  const std::string plain = with("clearance = 0.001\n", "rod_radius = \"0.5 mm\"\n", points_case());
  const Case c = read(plain, {}, scratch.path());
  EXPECT_NEAR(c.tube.clearance->at(0.0)[0], 0.0045, kRounding);
  EXPECT_NEAR(c.tube.clearance->at(0.05)[0], 0.0040, kRounding);
  EXPECT_NEAR(c.tube.clearance->at(0.1)[0], 0.0035, kRounding);
  const Case part =
      read(with("file = \"line.csv\"\n", "file = \"line.csv\"\nfrom = 0.02\nto = 0.06\nreverse = true\n", plain), {},
           scratch.path());
  EXPECT_NEAR(part.tube.length(), 0.04, kRounding);
  EXPECT_NEAR(part.tube.clearance->at(0.0)[0], 0.0039, kRounding);
  EXPECT_NEAR(part.tube.clearance->at(0.04)[0], 0.0043, kRounding);
  const std::vector<Issue> issues = issues_of(with("clearance = 0.001\n", "", points_case()), {}, scratch.path());
  ASSERT_EQ(issues.size(), 1u) << render(issues);
  EXPECT_NE(issues[0].message.find("needs the radius of the rod"), std::string::npos);
}

void defect(const std::string& text, bool survey, int line, const std::string& message) {
  Scratch scratch;
  scratch.write("line.csv", text);
  const std::vector<Issue> issues = issues_of(survey ? survey_case() : points_case(), {}, scratch.path());
  ASSERT_EQ(issues.size(), 1u) << message << "\n" << render(issues);
  EXPECT_EQ(issues[0].line, line) << render(issues);
  EXPECT_EQ(issues[0].file, "line.csv");
  EXPECT_NE(issues[0].message.find(message), std::string::npos) << render(issues);
}

TEST(Csv, DefectsOfPointFilesAreToldOnceWithTheirLine) {
  defect("x,y,z\n0,0,0\n0,0,nan\n0,0,2\n0,0,inf\n", false, 3, "not a finite number (and on 1 more lines)");
  defect("x,y,z\n0,0,0\n0,0,one\n0,0,2\n", false, 3, "this is not a number");
  defect("x,y,z\n0,0,0\n0,1\n0,0,2\n", false, 3, "too short");
  defect("x,y,depth\n0,0,0\n0,0,1\n", false, 1, "column `z` is missing");
  defect("x_mm,y_mm,z_m\n0,0,0\n0,0,1\n", false, 1, "different units");
  defect("x_mm,y_mm,z_mm\ncm,cm,cm\n0,0,0\n0,0,1\n", false, 2, "disagree about column `x`");
  defect("x_furlong,y,z\n0,0,0\n0,0,1\n", false, 1, "column `x` is missing");
  defect("x [kg],y [kg],z [kg]\n0,0,0\n0,0,1\n", false, 1, "not the unit of a length");
  defect("x,y,z,radius\n0,0,0,1\n0,0,1,-1\n0,0,2,1\n", false, 3, "the radius must be > 0");
  defect("", false, 0, "no rows of numbers");
  defect("x,y,z\n", false, 0, "no rows of numbers");
}

TEST(Csv, DefectsOfSurveysAreToldWithTheirLine) {
  defect("md_m,inc_deg,azi_deg\n0,0,0\n30,0,0\n20,1,0\n60,1,0\n", true, 4, "measured depth must increase");
  defect("md_m,inc_deg,azi_deg\n0,0,0\n30,0,0\n30,1,0\n", true, 4, "measured depth must increase");
  defect("md_m,inc_deg,azi_deg\n0,0,0\n30,1,400\n", true, 3, "azimuth is out of bounds");
  defect("md_m,inc_deg,azi_deg\n0,0,0\n30,-5,0\n", true, 3, "inclination is out of bounds");
  defect("md_m,inc_deg\n0,0\n30,1\n", true, 1, "column `azi` is missing");
}

TEST(Csv, SurveysInFeetAndWithoutHeader) {
  Scratch scratch;
  const std::string rows_ft = "0,10,350\n100,12,355\n200,15,5\n300,15,10\n";
  scratch.write("line.csv", "MD (ft),Inc (deg),Azi (deg)\n" + rows_ft);
  const Case feet = read(survey_case(), {}, scratch.path());
  EXPECT_NEAR(feet.tube.length(), 300 * 0.3048, 1e-11);
  const Case part = read(survey_case("from = \"100 ft\"\nto = 60.96\n"), {}, scratch.path());
  EXPECT_NEAR(part.tube.length(), 30.48, 1e-11);
  const Eigen::Vector3d down =
      build_problem(
          read(with("torsional_stiffness = 0.75", "torsional_stiffness = 0.75\nweight_per_length = 2.0", survey_case()),
               {}, scratch.path()))
          .load.force;
  EXPECT_EQ(down, Eigen::Vector3d(0, 0, 2));
  // tangent at the top: inclination 10°, azimuth 350° (north-west), z down
  const double deg = std::numbers::pi / 180;
  const Eigen::Vector3d t(std::sin(10 * deg) * std::cos(350 * deg), std::sin(10 * deg) * std::sin(350 * deg),
                          std::cos(10 * deg));
  EXPECT_LT((feet.tube.axis->at(0).frame.col(2) - t).norm(),
            1e-6);                     // blended over a length that keeps 1 % of the clearance
  scratch.write("line.csv", rows_ft);  // no header: metres and degrees
  EXPECT_NEAR(read(survey_case(), {}, scratch.path()).tube.length(), 300, 1e-9);
}

TEST(Csv, UnreadableFilePointsAtItsKey) {
  const std::vector<Issue> issues = issues_of(points_case(), {}, "/no/such/directory");
  ASSERT_EQ(issues.size(), 1u);
  EXPECT_TRUE(issues[0].unreadable);
  EXPECT_EQ(issues[0].line, 10);
  EXPECT_EQ(issues[0].column, 8);
}

}  // namespace
}  // namespace tendril::io::test

// Centreline and survey files in every format and packing against the formulas of tests/data/make_fixtures.py; paths
// through trees; cleaning and smoothing, with what is told of them.

#include <cmath>

#include "io_support.hpp"
#include "tendril/geometry/tube_check.hpp"
#include "tendril/io/centreline.hpp"

namespace tendril::io::test {
namespace {

using geometry::Vec3;

constexpr double kRounding = 1e-14;  // of numbers of order ten that are printed and read back
const std::string kData = std::string(TENDRIL_SOURCE_DIR) + "/tests/data/";

std::shared_ptr<const Source> text_of(const std::string& name, const std::string& text) {
  return std::make_shared<Source>(Source{name, text, false});
}

struct Read {
  Centreline line;
  std::vector<std::string> notes;
  std::vector<Issue> issues;

  bool noted(const std::string& part) const {
    for (const std::string& note : notes) {
      if (note.find(part) != std::string::npos) return true;
    }
    return false;
  }
};

Read read_line(const std::shared_ptr<const Source>& source, const CentrelineRequest& request = {},
               bool survey = false) {
  Read out;
  Issues in_file, in_case;
  const Complain complain = [&](const std::string& key, const std::string& message) -> Issue& {
    return in_case.add({source, 0, 0, 1}, key, message);
  };
  out.line = survey ? read_survey(source, request, in_file, complain, out.notes)
                    : read_points(source, request, in_file, complain, out.notes);
  out.issues = in_file.list();
  out.issues.insert(out.issues.end(), in_case.list().begin(), in_case.list().end());
  return out;
}

Read read_line(const std::string& file, const CentrelineRequest& request = {}, bool survey = false) {
  return read_line(read_source(kData + file, file), request, survey);
}

// The formulas of make_fixtures.py: x, y, z, radius.
Eigen::Vector4d trunk(int k) { return {0.02 * k * k, 0.0, 3.0 * k, 5 - 0.1 * k}; }
Eigen::Vector4d left(int j) {
  Eigen::Vector4d p = trunk(10) + Eigen::Vector4d(0.6 * j, 0.25 * j, 2.5 * j, 0);
  p[3] = 4 - 0.1 * j;
  return p;
}
Eigen::Vector4d right(int j) {
  Eigen::Vector4d p = trunk(10) + Eigen::Vector4d(0.4 * j - 0.08 * j * j, -0.3 * j, 2.5 * j, 0);
  p[3] = 4 - 0.12 * j;
  return p;
}
std::vector<Eigen::Vector4d> way(bool to_left) {
  std::vector<Eigen::Vector4d> points;
  for (int k = 0; k <= 10; ++k) points.push_back(trunk(k));
  for (int j = 1; j <= 10; ++j) points.push_back(to_left ? left(j) : right(j));
  return points;
}

void expect_points(const Read& read, const std::vector<Eigen::Vector4d>& wanted, double scale, double tolerance) {
  ASSERT_TRUE(read.issues.empty()) << render(read.issues);
  ASSERT_EQ(read.line.points.size(), wanted.size());
  ASSERT_EQ(read.line.radius.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_LT((read.line.points[i] - scale * wanted[i].head<3>()).norm(), tolerance) << i;
    EXPECT_NEAR(read.line.radius[i], scale * wanted[i][3], tolerance) << i;
  }
}

CentrelineRequest between(std::size_t from, std::size_t to) {
  CentrelineRequest request;
  request.path.ends = {from, to};
  return request;
}

TEST(Vtp, EveryPackingGivesTheSamePoints) {
  for (const char* name : {"ascii", "base64", "base64_zlib", "appended_raw", "appended_raw_zlib", "appended_base64",
                           "appended_base64_zlib"}) {
    SCOPED_TRACE(name);
    const std::string file = std::string("tree_") + name + ".vtp";
    expect_points(read_line(file, between(0, 1)), way(true), 1, 1e-13);
    expect_points(read_line(file, between(0, 2)), way(false), 1, 1e-13);
  }
  // single precision: 2^-24 of 55
  expect_points(read_line("tree_big_endian_float32.vtp", between(0, 2)), way(false), 1, 4e-6);
}

TEST(Vtp, APathLeadsFromEitherEnd) {
  std::vector<Eigen::Vector4d> back = way(false);
  std::reverse(back.begin(), back.end());
  expect_points(read_line("tree_base64.vtp", between(2, 0)), back, 1, 1e-13);
  // across the fork, from one branch into the other
  std::vector<Eigen::Vector4d> across;
  for (int j = 10; j >= 1; --j) across.push_back(left(j));
  across.push_back(trunk(10));
  for (int j = 1; j <= 10; ++j) across.push_back(right(j));
  expect_points(read_line("tree_base64.vtp", between(1, 2)), across, 1, 1e-13);
  // cells of two points, and lines that share the trunk, are the same tree
  expect_points(read_line("cells.vtp", between(0, 1)), way(true), 1, 1e-13);
  expect_points(read_line("vmtk.vtp", between(2, 0)), back, 1, 1e-13);
}

TEST(Vtp, APathByLinesOrByThePlaceOfItsEnds) {
  CentrelineRequest request;
  request.path.branch = {0, 2};
  expect_points(read_line("tree_ascii.vtp", request), way(false), 1, 1e-13);
  request.path.branch = {2, 0};  // the first line is turned to meet the second
  std::vector<Eigen::Vector4d> back = way(false);
  std::reverse(back.begin(), back.end());
  expect_points(read_line("tree_ascii.vtp", request), back, 1, 1e-13);
  request.path.branch = {1};
  const Read one = read_line("vmtk.vtp", request);
  expect_points(one, way(false), 1, 1e-13);
  request = {};
  request.path.start_near = Vec3(-3, -2, 60);
  request.path.end_near = Vec3(1, 0, 0);
  expect_points(read_line("cells.vtp", request), back, 1, 1e-13);
}

TEST(Vtp, ATreeWithoutAChoiceListsItsEnds) {
  const Read read = read_line("tree_ascii.vtp");
  ASSERT_EQ(read.issues.size(), 1u);
  EXPECT_EQ(read.issues[0].key, "tube.axis.file");
  EXPECT_NE(read.issues[0].message.find("3 lines with 3 ends"), std::string::npos) << read.issues[0].message;
  EXPECT_NE(read.issues[0].value.find("2 at (-2, -3, 55), radius 2.8"), std::string::npos) << read.issues[0].value;
  EXPECT_EQ(read_line("tree_ascii.vtp", between(0, 3)).issues.at(0).key, "tube.axis.ends");
  CentrelineRequest request;
  request.path.branch = {7};
  EXPECT_EQ(read_line("tree_ascii.vtp", request).issues.at(0).key, "tube.axis.branch");
  request.path.branch = {0, 1, 2};  // 2 starts at the fork, where 1 did
  EXPECT_EQ(read_line("tree_ascii.vtp", request).issues.at(0).key, "tube.axis.branch");
}

TEST(Vtp, LengthsNeedTheirUnit) {
  CentrelineRequest request = between(0, 1);
  request.si = true;
  const Read none = read_line("tree_ascii.vtp", request);
  ASSERT_EQ(none.issues.size(), 1u);
  EXPECT_NE(none.issues[0].hint.find("file_unit"), std::string::npos);
  request.unit = "mm";
  const Read read = read_line("tree_ascii.vtp", request);
  expect_points(read, way(true), 1e-3, 1e-16);
  EXPECT_TRUE(read.noted("converted from mm to m"));
  request.radius_array = "Radius";
  const Read wrong = read_line("tree_ascii.vtp", request);
  ASSERT_EQ(wrong.issues.size(), 1u);
  EXPECT_EQ(wrong.issues[0].value, "point arrays MaximumInscribedSphereRadius");
}

TEST(Points, SimVascularAndSlicer) {
  CentrelineRequest request;
  request.si = true;
  request.unit = "cm";
  const Read path = read_line("curve.pth", request);
  ASSERT_EQ(path.line.points.size(), 11u);
  for (int k = 0; k <= 10; ++k) EXPECT_LT((path.line.points[k] - 1e-3 * trunk(k).head<3>()).norm(), 1e-16) << k;
  request.unit.clear();
  for (const char* file : {"curve_lps.mrk.json", "curve_ras.mrk.json"}) {
    const Read read = read_line(file, request);
    ASSERT_TRUE(read.issues.empty()) << render(read.issues);
    ASSERT_EQ(read.line.points.size(), 11u);
    ASSERT_EQ(read.line.radius.size(), 11u);
    for (int k = 0; k <= 10; ++k) {
      EXPECT_LT((read.line.points[k] - 1e-3 * trunk(k).head<3>()).norm(), 1e-16) << file << k;
      EXPECT_NEAR(read.line.radius[k], 1e-3 * trunk(k)[3], 1e-18) << file << k;
    }
    EXPECT_EQ(read.noted("RAS to LPS"), std::string(file) == "curve_ras.mrk.json");
  }
}

TEST(Surveys, LasAndWitsmlGiveTheSameStations) {
  CentrelineRequest request;
  request.si = true;
  for (const char* file :
       {"survey_12.las", "survey_20_wrapped.las", "survey_30.las", "survey_witsml_14.xml", "survey_witsml_20.xml"}) {
    SCOPED_TRACE(file);
    const Read read = read_line(file, request, true);
    ASSERT_TRUE(read.issues.empty()) << render(read.issues);
    ASSERT_EQ(read.line.md.size(), 31u);
    for (int k = 0; k <= 30; ++k) {
      EXPECT_NEAR(read.line.md[k], 30.0 * k, 2e-13);  // feet and back
      EXPECT_NEAR(read.line.inc[k], std::min(2.0 * k, 40.0), kRounding);
      EXPECT_NEAR(read.line.azi[k], std::fmod(350.0 + 2 * k, 360), kRounding);
    }
    EXPECT_EQ(read.line.cleaning.wraps, 1u);
    EXPECT_TRUE(read.noted("passes north 1 time"));
  }
  EXPECT_TRUE(read_line("survey_12.las", request, true).noted("1 rows left out that have the NULL value"));
  EXPECT_TRUE(read_line("survey_30.las", request, true).noted("converted from FT to m"));
  EXPECT_TRUE(read_line("survey_witsml_20.xml", request, true).noted("sorted by measured depth"));
}

TEST(Surveys, LinesAboveTheHeaderAreSkipped) {
  const std::string text =
      "Company: 7 Seas\nWell;1\n\nStation,Measured Depth (ft),Inclination (deg),Azimuth (deg)\n1,0,0,0\n2,100,1,10\n";
  CentrelineRequest request;
  request.si = true;
  const Read read = read_line(text_of("s.csv", text), request, true);
  ASSERT_TRUE(read.issues.empty()) << render(read.issues);
  EXPECT_NEAR(read.line.md[1], 30.48, kRounding);
  EXPECT_TRUE(read.noted("3 lines above the header skipped"));
}

// ---- cleaning ----

// A gentle arc of radius 100 about a vessel of radius 5, a point each 0.5.
std::vector<Vec3> arc(int points) {
  std::vector<Vec3> out;
  for (int i = 0; i < points; ++i) out.emplace_back(100 * (1 - std::cos(0.005 * i)), 0, 100 * std::sin(0.005 * i));
  return out;
}

TEST(Cleaning, DuplicatesCapsAndTinyStepsGoAndAreTold) {
  const std::vector<Vec3> good = arc(100);
  std::vector<Vec3> points{good[0] - Vec3(0, 0, 5.0)};
  for (int i = 0; i < 100; ++i) {
    points.push_back(good[i]);
    if (i == 20) points.push_back(good[i]);
    if (i == 40) points.push_back(good[i] + Vec3(1e-4, 0, 1e-4));
  }
  points.push_back(good[99] + 5.0 * (good[99] - good[98]).normalized());
  std::vector<double> radius(points.size(), 5.0);
  std::vector<int> rows;
  const CleaningReport report = clean_points(points, radius, rows, "mm");
  EXPECT_EQ(report.points_before, 104u);
  EXPECT_EQ(report.points_after, 100u);
  EXPECT_EQ(report.duplicates, 1u);
  EXPECT_EQ(report.caps, 2u);
  EXPECT_EQ(report.tiny, 1u);
  EXPECT_EQ(report.notes.size(), 4u);
  EXPECT_EQ(points, good);
  EXPECT_EQ(radius.size(), 100u);
}

TEST(Cleaning, GoodPointsStayAndAHugeStepIsTold) {
  std::vector<Vec3> points = arc(100);
  std::vector<double> radius(100, 5.0);
  std::vector<int> rows;
  EXPECT_TRUE(clean_points(points, radius, rows, "mm").notes.empty());
  EXPECT_EQ(points.size(), 100u);
  // without a radius, spacing that differs by less than a hundredfold is the user's own
  for (int i = 1; i < 10; ++i) points.push_back(points[99] + Vec3(0, 0, 0.006 * i));
  radius.clear();
  EXPECT_EQ(clean_points(points, radius, rows, "mm").points_after, 109u);
  points = arc(100);
  points.erase(points.begin() + 30, points.begin() + 60);
  const CleaningReport gap = clean_points(points, radius, rows, "mm");
  ASSERT_EQ(gap.notes.size(), 1u);
  EXPECT_NE(gap.notes[0].find("huge step of 15.48 mm at S = 14.5 mm"), std::string::npos) << gap.notes[0];
}

TEST(Cleaning, RepeatedStationsGo) {
  std::vector<double> md{0, 30, 30, 60}, inc{0, 1, 1, 2}, azi{0, 359, 359, 1};
  std::vector<int> rows{2, 3, 4, 5};
  const CleaningReport report = clean_stations(md, inc, azi, rows, "m");
  EXPECT_EQ(report.duplicates, 1u);
  EXPECT_EQ(report.wraps, 2u);
  EXPECT_EQ(rows, (std::vector<int>{2, 3, 5}));
}

TEST(Smoothing, JitterIsSmoothedWithinAStatedTolerance) {
  // jitter of 0.15 on points 0.5 apart: the exact curve folds the tube of radius 5, the arc itself has K r = 0.05
  Centreline line;
  line.points = arc(100);
  for (int i = 0; i < 100; ++i) line.points[i].x() += 0.15 * std::sin(2.7 * i * i);
  line.radius.assign(100, 5.0);
  const CentrelineFit fit = fit_centreline(line, {}, {}, 0.0);
  EXPECT_TRUE(fit.automatic);
  EXPECT_DOUBLE_EQ(fit.smoothing, 0.75);
  EXPECT_LE(fit.axis.largest_deviation, 0.75);
  const auto clearance =
      fit_radius(line, fit, -0.5, radius_tolerance(line, fit.smoothing), 0, fit.axis.axis->length(), false);
  EXPECT_NEAR(clearance.clearance->at(20.0)[0], 4.5, 1e-9);
  EXPECT_LT(geometry::check_tube({fit.axis.axis, clearance.clearance, geometry::Side::inside}).curvature_clearance_max,
            0.5);
  // what needs no smoothing gets none
  line.points = arc(100);
  const CentrelineFit exact = fit_centreline(line, {}, {}, 0.0);
  EXPECT_EQ(exact.smoothing, 0.0);
  EXPECT_LT(exact.axis.largest_deviation, 1e-12);
}

// ---- whole cases ----

std::string vessel_case(const std::string& axis) {
  return "schema = 1\nunits = \"si\"\n[rod]\nbending_stiffness = \"900 N mm^2\"\npoisson_ratio = 0.3\ndiameter = \"1 "
         "mm\"\n"
         "[tube]\n[tube.axis]\nkind = \"points\"\n" +
         axis + "[start]\nkind = \"clamped\"\n[end]\nkind = \"sleeve\"\naxial_force = -0.1\ntorque = 0.0\n";
}

TEST(FilesOfCases, ABranchOfATreeFromEitherEnd) {
  const std::string file = "file = \"tree_base64_zlib.vtp\"\nfile_unit = \"mm\"\n";
  const Case c = read(vessel_case(file + "ends = [0, 2]\n"), {}, kData);
  const Case back = read(vessel_case(file + "ends = [2, 0]\n"), {}, kData);
  const Case reversed = read(vessel_case(file + "branch = [0, 2]\nreverse = true\n"), {}, kData);
  const double length = c.tube.length();
  EXPECT_NEAR(back.tube.length(), length, 1e-13);
  EXPECT_NEAR(c.tube.clearance->at(0)[0], 4.5e-3, 1e-12);  // radius 5 mm less 0.5 mm
  EXPECT_NEAR(c.tube.clearance->at(length)[0], 2.3e-3, 1e-12);
  EXPECT_NEAR(back.tube.clearance->at(0)[0], 2.3e-3, 1e-12);
  EXPECT_LT((back.tube.axis->at(0.01).position - c.tube.axis->at(length - 0.01).position).norm(), 1e-12);
  EXPECT_LT((reversed.tube.axis->at(0.01).position - c.tube.axis->at(length - 0.01).position).norm(), 1e-12);
  EXPECT_NE(render(issues_of(vessel_case(file), {}, kData)).find("which path is meant?"), std::string::npos);
  const Case near =
      read(vessel_case(file + "start_near = [0, 0, 0]\nend_near = [\"-2 mm\", \"-3 mm\", \"50 mm\"]\n"), {}, kData);
  EXPECT_NEAR(near.tube.length(), length, 1e-15);
}

TEST(FilesOfCases, SmoothingKeysAreCheckedAndDescribed) {
  const std::string file = "file = \"tree_ascii.vtp\"\nfile_unit = \"mm\"\nends = [0, 1]\n";
  const Case smooth = read(vessel_case(file + "smoothing = \"auto\"\n"), {}, kData);
  EXPECT_NEAR(smooth.curve.smoothing, 0.15 * 4e-3, 1e-12);
  EXPECT_LE(smooth.curve.deviation, smooth.curve.smoothing);
  EXPECT_LE(smooth.curve.radius_deviation, 0.05 * 3e-3);
  const Case exact = read(vessel_case(file + "smoothing = 0\n"), {}, kData);
  EXPECT_EQ(exact.curve.smoothing, 0.0);
  EXPECT_EQ(issues_of(vessel_case(file + "smoothing = \"some\"\n"), {}, kData).size(), 1u);
  EXPECT_EQ(
      issues_of(vessel_case("file = \"curve.pth\"\nfile_unit = \"cm\"\nsmoothing = \"auto\"\n"), {}, kData).size(), 2u);
  EXPECT_EQ(issues_of(vessel_case("file = \"tree_ascii.vtp\"\nends = [0]\n"), {}, kData).size(), 1u);
  EXPECT_EQ(issues_of(vessel_case("file = \"curve_lps.mrk.json\"\nfile_unit = \"cm\"\n"), {}, kData).size(), 1u);
}

}  // namespace
}  // namespace tendril::io::test

// Bad centreline and survey files: one clear message each, with file, line, value, bound and hint; and the readers
// under a seeded mutator, which must end in points or in issues, never in anything else.

#include <cmath>
#include <cstdlib>
#include <random>

#include "io_support.hpp"
#include "tendril/geometry/error.hpp"
#include "tendril/io/centreline.hpp"

namespace tendril::io::test {
namespace {

const std::string kData = std::string(TENDRIL_SOURCE_DIR) + "/tests/data/";

std::string fixture(const std::string& name) { return Scratch::slurp(kData + name); }

/// Issues of reading a text under a name, as points or as a survey.
std::vector<Issue> issues_of_file(const std::string& name, const std::string& text, bool survey) {
  Issues issues;
  const auto source = std::make_shared<Source>(Source{name, text, false});
  CentrelineRequest request;
  request.si = true;
  request.unit = survey ? "" : "mm";
  request.path.branch = survey ? std::vector<std::size_t>{} : std::vector<std::size_t>{0};
  std::vector<std::string> notes;
  const Complain complain = [&](const std::string& key, const std::string& message) -> Issue& {
    return issues.add({source, 0, 0, 1}, key, message);
  };
  survey ? read_survey(source, request, issues, complain, notes)
         : read_points(source, request, issues, complain, notes);
  return issues.list();
}

/// One issue at this line with these words.
void one_issue(const std::string& name, const std::string& text, bool survey, int line, const std::string& message,
               const std::string& value = "") {
  const std::vector<Issue> issues = issues_of_file(name, text, survey);
  ASSERT_EQ(issues.size(), 1u) << message << "\n" << render(issues);
  EXPECT_EQ(issues[0].file, name);
  EXPECT_EQ(issues[0].line, line) << render(issues);
  EXPECT_NE(issues[0].message.find(message), std::string::npos) << render(issues);
  EXPECT_NE(issues[0].value.find(value), std::string::npos) << render(issues);
  EXPECT_FALSE(issues[0].message.empty());
}

TEST(BadFiles, Vtp) {
  const auto ascii = [](const std::string& from, const std::string& to) {
    return with(from, to, fixture("tree_ascii.vtp"));
  };
  const auto packed = [](const std::string& from, const std::string& to) {
    return with(from, to, fixture("tree_base64_zlib.vtp"));
  };
  one_issue("t.vtp", "", false, 1, "not a VTK PolyData file");
  one_issue("t.vtp", "<VTKFile type=\"PolyData\"><PolyData>", false, 1, "XML syntax");
  one_issue("t.vtp", "<VTKFile type=\"ImageData\"/>", false, 1, "not a VTK PolyData file", "ImageData");
  one_issue("t.vtp", "<VTKFile type=\"PolyData\"/>", false, 1, "no <Piece>");
  one_issue("t.vtp", "# vtk DataFile Version 3.0\nx\nASCII\n", false, 1, "legacy format");
  one_issue("t.vtp", "<!DOCTYPE a [<!ENTITY b \"c\">]>\n" + fixture("tree_ascii.vtp"), false, 1, "document types");
  one_issue("t.vtp", ascii("NumberOfPoints=\"31\"", "NumberOfPoints=\"99999999999\""), false, 4, "`NumberOfPoints`",
            "99999999999");
  one_issue("t.vtp", ascii("NumberOfPoints=\"31\"", "NumberOfPoints=\"1999999\""), false, 11, "too few numbers");
  one_issue("t.vtp", ascii("NumberOfLines=\"3\"", "NumberOfLines=\"0\""), false, 11, "no lines");
  one_issue("t.vtp", ascii("NumberOfPoints=\"31\"", "NumberOfPoints=\"0\""), false, 0, "no lines");
  one_issue("t.vtp", ascii("0.02 0.0 3.0", "0.02 nan 3.0"), false, 11, "not a finite number (point 1)", "nan");
  one_issue("t.vtp", ascii("0.02 0.0 3.0", "0.02 zero 3.0"), false, 11, "this is not a number", "\"zero\"");
  one_issue("t.vtp", ascii("5.0 4.9 4.8", "5.0 0 4.8"), false, 6, "the radius must be > 0 (point 1)", "0");
  one_issue("t.vtp", ascii("0 1 2 3 4 5", "0 1 77 3 4 5"), false, 16, "entry 2 is out of bounds", "77");
  one_issue("t.vtp", ascii("11 22 33", "11 22 7"), false, 19, "entry 2 is out of bounds", "7");
  one_issue("t.vtp", ascii("11 22 33", "1 22 33"), false, 11, "at least two points", "1");
  one_issue("t.vtp", ascii("Float64\" Name=\"Points\"", "Float99\" Name=\"Points\""), false, 11, "unknown type",
            "Float99");
  one_issue("t.vtp", packed("vtkZLibDataCompressor", "vtkLZ4DataCompressor"), false, 2, "compression is not supported",
            "vtkLZ4DataCompressor");
  one_issue("t.vtp", packed("eJxjYAABEYdZM0FA2MEYDI", "eJxjYAABEYdZM0F!2MEYDI"), false, 6, "this is not base64", "'!'");
  one_issue("t.vtp", packed("eJxjYAABEYdZM0FA2MEYDI", "eJxjYAABEYdZM0FAAAAYDI"), false, 6, "zlib data are damaged");
  const std::string raw = fixture("tree_appended_raw.vtp");
  one_issue("t.vtp", raw.substr(0, raw.find("</AppendedData>") - 20), false, 13, "the data end within an array");
  one_issue("t.vtp", raw.substr(0, raw.find("</AppendedData>") - 200), false, 13, "offset lies beyond");
  const std::string base64 = fixture("tree_base64.vtp");
  const std::size_t at = base64.find("Name=\"Points\"");
  const std::size_t to = base64.find("\n</DataArray>", at);
  one_issue("t.vtp", std::string(base64).erase(to - 81, 81), false, 11, "the data end within an array");
}

TEST(BadFiles, PathsAndMarkups) {
  one_issue("p.pth", "<format version=\"1.0\"/><path id=\"1\"/>", false, 1, "not a SimVascular path");
  one_issue("p.pth", with("x=\"0.002\"", "x=\"\"", fixture("curve.pth")), false, 18,
            "attribute `x` of a point is missing");
  one_issue("p.pth", with("x=\"0.002\"", "x=\"inf\"", fixture("curve.pth")), false, 18, "not a finite number");
  one_issue("m.mrk.json", "{\"markups\": []}", false, 1, "not a file of markups");
  one_issue("m.mrk.json", "{\"markups\": [", false, 1, "JSON syntax");
  one_issue("m.mrk.json", "{\"markups\": [{\"controlPoints\": []}]}", false, 1, "");
  one_issue("m.mrk.json", with("\"LPS\"", "\"XYZ\"", fixture("curve_lps.mrk.json")), false, 5,
            "unknown coordinate system");
  one_issue("m.mrk.json", "{\"markups\": [{\"controlPoints\": [{\"position\": [1, 2]}]}]}", false, 1, "three numbers");
}

TEST(BadFiles, Tables) {
  one_issue("t.csv", "x,y,z\n1,2,3\n", false, 2, "at least two points", "1");
  one_issue("t.csv", "x,y,z\n1,2,3\n1,2,3\n", false, 2, "all points of the curve are the same");
  one_issue("t.csv", "x,y,z,radius\n0,0,0,1\n0,0,1,0\n0,0,2,1\n", false, 3, "the radius must be > 0", "0");
  one_issue("t.csv", "x,y,z\n0,0,0\n0,0,1e300\n", false, 3, "not a finite number");
}

TEST(BadFiles, Surveys) {
  const auto las = [](const std::string& from, const std::string& to) {
    return with(from, to, fixture("survey_12.las"));
  };
  one_issue("s.las", las("INCL.DEG", "XXXX.DEG"), true, 11, "the curve of the inclination is missing",
            "DEPT, GR, XXXX, AZIM");
  one_issue("s.las", las("    60.0   40.600", "    20.0   40.600"), true, 18, "measured depth must increase",
            "20 after 30");
  one_issue("s.las", las("40.600    4.000  354.000", "40.600    4.000  400.000"), true, 18, "azimuth is out of bounds",
            "400");
  one_issue("s.las", las("40.600    4.000", "40.600   -5.000"), true, 18, "inclination is out of bounds", "-5");
  one_issue("s.las", las("40.600    4.000", "40.600      nan"), true, 18, "not a finite number");
  one_issue("s.las", las("40.600    4.000", "40.600     four"), true, 18, "this is not a number", "four");
  one_issue("s.las", las("40.600    4.000", "40.600"), true, 18, "too short", "3 values");
  one_issue("s.las", las("INCL.DEG", "INCL.BAR"), true, 11, "the unit of the file");
  one_issue("s.las", "~V\nVERS. 2.0:\n~C\nMD.M:\nINC.DEG:\nAZI.DEG:\n~A\n", true, 0, "no stations");
  const auto xml = [](const std::string& from, const std::string& to) {
    return with(from, to, fixture("survey_witsml_14.xml"));
  };
  one_issue("s.xml", xml("<azi uom=\"dega\">354.0</azi>", ""), true, 7, "the station has no `azi`");
  one_issue("s.xml", xml("<md uom=\"m\">60.0", "<md uom=\"ft\">60.0"), true, 7, "stations have different units", "ft");
  one_issue("s.xml", xml(">60.0<", ">sixty<"), true, 7, "this is not a number", "sixty");
  one_issue("s.xml", xml("<incl uom=\"dega\">4.0<", "<incl uom=\"dega\">-5<"), true, 7, "inclination is out of bounds");
  one_issue("s.xml", "<trajectorys></trajectorys>", true, 1, "no trajectory");
  one_issue("s.xml", "<trajectorys><trajectory/></trajectorys>", true, 1, "no stations");
  one_issue("s.csv", "md_m,inc_deg,azi_rad\n0,0,0\n30,1,1\n", true, 1, "different units", "inc in deg, azi in rad");
  one_issue("s.csv", "md,inc,azi\n0,0,0\n", true, 2, "at least two stations");
  // a file of the other kind
  one_issue("t.vtp", fixture("tree_ascii.vtp"), true, 0, "cannot be read with kind = \"survey\"", "VTK PolyData");
  one_issue("s.las", fixture("survey_12.las"), false, 0, "cannot be read with kind = \"points\"", "LAS");
}

// ---- the mutator ----

// Deterministic for a seed: flips, cuts, repeats and swaps pieces, and writes numbers that readers trip over.
std::string mutated(std::string text, std::mt19937& random) {
  static const std::vector<std::string> kNasty{"0",
                                               "-1",
                                               "nan",
                                               "inf",
                                               "1e308",
                                               "-1e-320",
                                               "99999999999999999999",
                                               "4294967295",
                                               "18446744073709551615",
                                               "",
                                               "<",
                                               ">",
                                               "&amp;",
                                               "\"",
                                               "\n",
                                               "~A\n",
                                               "{",
                                               "[[[[",
                                               "=",
                                               std::string(1, '\0'),
                                               "\xFF\xFE",
                                               "AAAA",
                                               "~C\n",
                                               "</",
                                               "<!--",
                                               "<![CDATA["};
  const bool cut_too = random() % 3 == 0;
  const auto below = [&](std::size_t n) { return n == 0 ? 0 : random() % n; };
  for (std::size_t count = 1 + below(3); count > 0 && !text.empty(); --count) {
    const std::size_t at = below(text.size()), length = 1 + below(below(8) == 0 ? text.size() - at : 6);
    switch (below(cut_too ? 6 : 5)) {
      case 0:
        text[at] = static_cast<char>(random());
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(below(text.size()), text.substr(at, length));
        break;
      case 3:
        text.insert(at, kNasty[below(kNasty.size())]);
        break;
      case 4: {  // a number becomes another one
        const std::size_t digit = text.find_first_of("0123456789", at);
        if (digit == std::string::npos) break;
        const std::size_t end = std::min(text.find_first_not_of("0123456789.eE-", digit), text.size());
        text.replace(digit, end - digit, kNasty[below(9)]);
        break;
      }
      default:
        text.resize(at);
    }
  }
  return text;
}

TEST(Fuzz, MutatedFilesGiveIssuesOrFinitePoints) {
  // Enough to reach every reader's branches; the whole test takes about a second without sanitizers.
  // TENDRIL_FUZZ=N takes N times as many, from another seed.
  const char* more = std::getenv("TENDRIL_FUZZ");
  const int times = more ? std::max(1, std::atoi(more)) : 1;
  const int mutations = 600 * times;
  int good = 0, refused = 0, folded = 0;
  for (const char* name : {"tree_ascii.vtp",
                           "tree_base64.vtp",
                           "tree_base64_zlib.vtp",
                           "tree_appended_raw.vtp",
                           "tree_appended_raw_zlib.vtp",
                           "tree_appended_base64.vtp",
                           "tree_appended_base64_zlib.vtp",
                           "tree_big_endian_float32.vtp",
                           "cells.vtp",
                           "vmtk.vtp",
                           "curve.pth",
                           "curve_lps.mrk.json",
                           "curve_ras.mrk.json",
                           "survey_12.las",
                           "survey_20_wrapped.las",
                           "survey_30.las",
                           "survey_witsml_14.xml",
                           "survey_witsml_20.xml",
                           "points.csv",
                           "survey.csv"}) {
    SCOPED_TRACE(name);
    const bool survey = std::string(name).rfind("survey", 0) == 0;
    const std::string original =
        std::string(name) == "points.csv"
            ? "x_mm,y_mm,z_mm,radius_mm\n0,0,0,4\n0.1,0,2,4\n0.3,0,4,4\n0.6,0,6,3.9\n1,0,8,3.9\n"
        : std::string(name) == "survey.csv" ? "well\nmd;inc;azi\nm;deg;deg\n0;0;0\n30,5;1;350\n60;2;10\n90;2;11\n"
                                            : fixture(name);
    ASSERT_FALSE(original.empty());
    std::mt19937 random(20260100u + static_cast<unsigned>(times));
    for (int i = 0; i < mutations; ++i) {
      const auto source = std::make_shared<Source>(Source{name, mutated(original, random), false});
      Issues issues;
      std::vector<std::string> notes;
      const Complain complain = [&](const std::string& key, const std::string& message) -> Issue& {
        return issues.add({source, 0, 0, 1}, key, message);
      };
      CentrelineRequest request;
      request.si = i % 2 == 0;
      request.unit = i % 3 == 0 ? "mm" : "";
      if (i % 5 == 0) request.path.branch = {0};
      if (i % 5 == 1) request.path.ends = {0, 1};
      const Centreline line = survey ? read_survey(source, request, issues, complain, notes)
                                     : read_points(source, request, issues, complain, notes);
      if (!issues.empty()) {
        ++refused;
        EXPECT_FALSE(render(issues.list()).empty());
        EXPECT_LE(issues.size(), 25u) << i;
        continue;
      }
      ++good;
      try {
        if (survey) {
          ASSERT_GE(line.md.size(), 2u) << i;
          const auto fit =
              geometry::make_survey(line.md, line.inc, line.azi, 0.01 * (line.md.back() - line.md.front()));
          EXPECT_TRUE(std::isfinite(fit.axis->length())) << i;
        } else {
          ASSERT_GE(line.points.size(), 2u) << i;
          for (const auto& point : line.points) ASSERT_TRUE(point.allFinite()) << i;
          for (const double radius : line.radius) ASSERT_GT(radius, 0.0) << i;
          const CentrelineFit fit = fit_centreline(line, {}, {}, 0.0);
          EXPECT_TRUE(std::isfinite(fit.axis.axis->length())) << i;
        }
      } catch (const geometry::GeometryError& error) {
        ++folded;
        EXPECT_FALSE(error.issues.empty());
      }
    }
  }
  // mutations must reach both sides, or the test tests nothing
  EXPECT_GT(good, 500);
  EXPECT_GT(refused, 1000);
  RecordProperty("good", good);
  RecordProperty("refused", refused);
  RecordProperty("folded", folded);
}

}  // namespace
}  // namespace tendril::io::test

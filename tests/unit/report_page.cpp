// The page holds the result's tokens as they are written, ends no script element early, and thins what is too large.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tendril/report/json_text.hpp"
#include "tendril/report/page.hpp"

namespace tendril::report {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kTemplate = "<html><script id=\"r\">\"TENDRIL_RESULT\"</script></html>";

std::string inside(const std::string& page) {
  const std::size_t from = page.find("id=\"r\">") + 7;
  return page.substr(from, page.find("</script>", from) - from);
}

// A result with steps of `rows` rows; numbers with all their digits.
std::string result(int steps, int rows) {
  std::string out = "{ \"tendril\": \"1\",\n \"steps\": [";
  for (int i = 0; i < steps; ++i) {
    out += std::string(i ? "," : "") + "{\"parameter\": " + std::to_string(i) +
           ", \"contacts\": [{\"start\": 0.30000000000000004, \"end\": 0.5}], \"state\": [1, 2], \"fields\": {";
    for (const char* name : {"S", "gap"}) {
      out += std::string(name[0] == 'S' ? "" : ",") + "\"" + name + "\": [";
      for (int row = 0; row < rows; ++row) {
        // both sides of a junction at the contact's start
        const std::string S = row == rows / 3       ? "0.3"
                              : row == rows / 3 + 1 ? "0.30000000000000004"
                                                    : Json(row / (rows - 1.0)).dump();
        out += (row ? ", " : "") + (name[0] == 'S' ? S : std::string("-1.2345678901234567e-05"));
      }
      out += "]";
    }
    out += "}}";
  }
  return out + "], \"trace\": []}";
}

TEST(ReportPage, CopiesTokens) {
  const std::string text =
      R"({"a": [ -0.0, 0.1000000000000000055511151231257827, 1E+2, null ], "steps": [ {"x": 5e-324, "state": [1]} ]})";
  const std::string page = inside(fill(kTemplate, text));
  EXPECT_NE(page.find(R"("a":[-0.0,0.1000000000000000055511151231257827,1E+2,null])"), std::string::npos) << page;
  EXPECT_NE(page.find(R"("steps":[{"x":5e-324}])"), std::string::npos) << page;
  EXPECT_TRUE(Json::parse(page)["page"]["thinned"].is_null());
}

TEST(ReportPage, EndsNoScriptEarly) {
  const std::string hostile = "</script><!-- <script> \\\" \\\\";
  const std::string text = R"({"case": {"title": ")" + hostile + R"(", "</script>": 1}, "steps": []})";
  const std::string page = fill(kTemplate, text);
  EXPECT_EQ(page.find("<!--"), std::string::npos);
  EXPECT_EQ(page.find("</script>"), page.rfind("</script>"));
  const Json read = Json::parse(inside(page))["result"]["case"];
  EXPECT_EQ(read["title"], "</script><!-- <script> \" \\");
  EXPECT_EQ(read["</script>"], 1);
}

TEST(ReportPage, KeepsWhiteSpaceInStringsOnly) {
  const std::string page = inside(fill(kTemplate, "{ \"steps\" : [ ] , \"a b\" : \" c \\n \" }"));
  EXPECT_NE(page.find("\"a b\":\" c \\n \""), std::string::npos) << page;
}

TEST(ReportPage, ThinsRowsButNotJunctions) {
  PageOptions options;
  options.max_bytes = 60'000;
  const std::string text = result(4, 2000);
  ASSERT_GT(text.size(), 2 * options.max_bytes);
  const std::string page = fill(kTemplate, text, options);
  EXPECT_LE(page.size(), options.max_bytes);
  const Json read = Json::parse(inside(page));
  EXPECT_EQ(read["page"]["thinned"]["rows"], 8000);
  long kept = 0;
  for (const Json& step : read["result"]["steps"]) {
    const std::vector<double> S = step["fields"]["S"];
    EXPECT_EQ(step["fields"]["gap"].size(), S.size());
    EXPECT_EQ(S.front(), 0.0);
    EXPECT_EQ(S.back(), 1.0);
    EXPECT_EQ(std::count(S.begin(), S.end(), 0.3), 1);
    EXPECT_EQ(std::count(S.begin(), S.end(), 0.30000000000000004), 1);
    EXPECT_EQ(step["fields"]["gap"][0], -1.2345678901234567e-05);
    kept += static_cast<long>(S.size());
  }
  EXPECT_EQ(read["page"]["thinned"]["rows_kept"], kept);
  EXPECT_GE(kept, 4 * 101);
}

TEST(ReportPage, DropsFieldsOfStepsWhenRowsAreFew) {
  PageOptions options;
  options.max_bytes = 60'000;
  const std::string page = fill(kTemplate, result(40, 400), options);
  EXPECT_LE(page.size(), options.max_bytes);
  const Json read = Json::parse(inside(page)), steps = read["result"]["steps"];
  ASSERT_EQ(steps.size(), 40u);
  const long with = std::count_if(steps.begin(), steps.end(), [](const Json& s) { return s.contains("fields"); });
  EXPECT_GT(with, 3);
  EXPECT_LT(with, 40);
  EXPECT_EQ(read["page"]["thinned"]["steps_kept"], with);
  EXPECT_TRUE(steps.back().contains("fields"));
  for (const Json& step : steps) EXPECT_TRUE(step.contains("contacts"));
}

TEST(ReportPage, RefusesWhatIsNoResult) {
  for (const char* text : {"", "[]", "{", "{\"steps\": [}", "{\"a\": 1}", "{\"steps\": [], \"a\": \"x}",
                           "{\"steps\": []} 1", "{\"steps\": [{\"fields\": {\"S\": [1], \"s\": []}}]}"})
    EXPECT_THROW(fill(kTemplate, text), std::invalid_argument) << text;
  EXPECT_THROW(fill(kTemplate, "{\"steps\": " + std::string(10000, '[')), std::invalid_argument);
  EXPECT_THROW(fill("no place", "{\"steps\": []}"), std::logic_error);
}

}  // namespace
}  // namespace tendril::report

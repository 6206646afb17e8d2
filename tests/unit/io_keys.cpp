// The key table and what is made of it: explanations, suggestions, the JSON Schema.

#include <nlohmann/json.hpp>

#include "io_support.hpp"
#include "tendril/io/keys.hpp"

namespace tendril::io::test {
namespace {

using Json = nlohmann::json;

TEST(Keys, EveryKeyHasATableAndALine) {
  for (const Key& key : keys()) {
    EXPECT_FALSE(key.doc.empty()) << key.path;
    EXPECT_EQ(key.doc.find('\n'), std::string::npos) << key.path;
    const std::size_t dot = key.path.rfind('.');
    if (dot == std::string::npos) continue;
    const Key* parent = find_key(key.path.substr(0, dot));
    ASSERT_NE(parent, nullptr) << key.path;
    EXPECT_TRUE(parent->type == KeyType::table || parent->type == KeyType::tables) << key.path;
  }
}

TEST(Keys, Explanations) {
  EXPECT_NE(explain("end.axial_force").find("tension positive"), std::string::npos);
  EXPECT_NE(explain("tube.axis").find("tube.axis.pitch_angle"), std::string::npos);
  EXPECT_NE(explain("").find("rod"), std::string::npos);
  EXPECT_EQ(explain("tube.axs"), "");
  EXPECT_EQ(suggest_key("tube.axs"), "did you mean `axis`?");
  EXPECT_EQ(suggest_key("torque"), "did you mean `start.torque` or `end.torque`?");
}

TEST(Keys, NearestPrefersTheCaseAndSwaps) {
  EXPECT_EQ(nearest("kn", {"km", "kN"}), "kN");
  EXPECT_EQ(nearest("rnu", {"report", "run"}), "run");
  EXPECT_EQ(nearest("zzzz", {"run", "check"}), "");
}

// The table as the schema sees it: every key, closed objects, the required ones.
void compare(const Json& schema, const std::string& path) {
  EXPECT_EQ(schema["additionalProperties"], false) << path;
  std::size_t count = 0;
  for (const Key* key : children(path)) {
    const std::string name = key->path.substr(path.empty() ? 0 : path.size() + 1);
    ASSERT_TRUE(schema["properties"].contains(name)) << key->path;
    ++count;
    const Json& own = schema["properties"][name];
    const bool listed = schema.contains("required") && std::find(schema["required"].begin(), schema["required"].end(),
                                                                 name) != schema["required"].end();
    EXPECT_EQ(listed, key->required) << key->path;
    if (key->type == KeyType::table) compare(own, key->path);
    EXPECT_EQ(own.contains("enum") ? own["enum"].size() : 0u, key->words.size()) << key->path;
  }
  EXPECT_EQ(schema["properties"].size(), count) << path;
}

TEST(Keys, SchemaIsTheTable) {
  const Json schema = Json::parse(json_schema());
  EXPECT_EQ(schema["$schema"], "http://json-schema.org/draft-07/schema#");
  compare(schema, "");
  EXPECT_EQ(schema["properties"]["rod"]["properties"]["bending_stiffness"]["anyOf"][0]["exclusiveMinimum"], 0.0);
}

TEST(Examples, AllAreValid) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(TENDRIL_SOURCE_DIR) + "/examples")) {
    if (entry.path().extension() != ".toml") continue;
    ++count;
    try {
      const Case c = read_case(entry.path().string());
      build_problem(c);
      EXPECT_TRUE(std::filesystem::exists(entry.path().parent_path() / (entry.path().stem().string() + ".md")))
          << entry.path();
    } catch (const InputError& error) {
      ADD_FAILURE() << error.what();
    }
  }
  EXPECT_GE(count, 10u);
}

}  // namespace
}  // namespace tendril::io::test

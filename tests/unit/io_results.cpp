// Result files: the keys that scripts rely on, numbers that read back exactly, no NaN, files whole or not at all.

#include <sys/resource.h>

#include <bit>
#include <cmath>
#include <csignal>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "io_support.hpp"
#include "tendril/io/atomic_file.hpp"
#include "tendril/io/result_files.hpp"
#include "tendril/io/result_json.hpp"

namespace tendril::io::test {
namespace {

using Json = nlohmann::json;

continuation::Result sample() {
  continuation::Result result;
  result.status = continuation::Status::converged;
  continuation::Step step;
  step.parameter = -7.1;
  step.status = continuation::Status::converged;
  step.rod_length = 0.1 + 0.2;  // not 0.3
  step.axial_force_end = -1.0 / 3.0;
  step.push = std::numeric_limits<double>::quiet_NaN();
  continuation::Contact point, line;
  point.start = point.end = 0.25;
  point.force = 3.5;
  line.line = true;
  line.start = 0.4;
  line.end = 0.6;
  line.force_start = 1.5;  // no force_end: a clamp
  line.force_distributed = 2.0;
  line.force = 3.5;
  line.pressure_mid = 5e-324;  // the smallest number there is
  step.contacts = {point, line};
  step.segments = {{false, 0.0, 0.4}, {true, 0.4, 0.6}, {false, 0.6, 1.0}};
  step.stability = "stable";
  step.state = {1.0, -0.0, 1e300, 0.1};
  continuation::Fields& f = step.fields;
  for (auto* column : {&f.S, &f.s, &f.x, &f.y, &f.z, &f.delta1, &f.delta2, &f.phi, &f.gap, &f.pressure, &f.F1, &f.F2,
                       &f.F3, &f.M1, &f.M2, &f.M3, &f.kappa}) {
    *column = {0.0, 0.5, 1.0};
  }
  result.steps = {step};
  result.events.push_back({-7.05, "contact_appears", 0.5, 1.01, -7.05});
  result.trace.push_back({-7.02, 1.0, -7.02, -1.0, 0});
  return result;
}

TEST(Results, TheTubeIsSampledAsItIs) {
  const Case c = read_case(std::string(TENDRIL_SOURCE_DIR) + "/examples/guidewire_vessel.toml");
  const Json tube = Json::parse(result_json(c, sample(), true))["tube"];
  EXPECT_FALSE(Json::parse(result_json(c, sample(), false)).contains("tube"));
  EXPECT_EQ(tube["side"], "inside");
  EXPECT_EQ(tube["rod_radius"], *rod_radius(c));
  const std::vector<double> S = tube["S"];
  ASSERT_GT(S.size(), 400u);
  EXPECT_EQ(S.front(), 0.0);
  EXPECT_EQ(S.back(), c.tube.length());
  EXPECT_TRUE(std::is_sorted(S.begin(), S.end()));
  for (std::size_t i = 0; i < S.size(); i += 37) {
    const geometry::AxisPoint at = c.tube.axis->at(S[i]);
    const char* names[] = {"x", "y", "z"};
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(tube[names[k]][i], at.position[k]);
      EXPECT_EQ(tube[std::string("D1") + names[k]][i], at.frame(k, 0));
      EXPECT_EQ(tube[std::string("D2") + names[k]][i], at.frame(k, 1));
    }
    EXPECT_EQ(tube["clearance"][i], c.tube.clearance->at(S[i])[0]);
    EXPECT_EQ(tube["curvature"][i], std::hypot(at.U[0][0], at.U[0][1]));
  }
}

TEST(Results, JsonHasTheKeysAndReadsBackExactly) {
  const Case c = read(kCase + "[path]\nparameter = \"end.axial_force\"\nvalues = [-7.1]\n");
  const std::string text = result_json(c, sample(), true);
  EXPECT_EQ(text.find("nan"), std::string::npos);
  const Json json = Json::parse(text);
  for (const char* key : {"tendril", "result_schema", "case", "status", "message", "steps", "events", "trace"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["status"], "converged");
  EXPECT_EQ(json["case"]["end"]["axial_force"], -7.0);
  const Json& step = json["steps"][0];
  for (const char* key :
       {"parameter", "status", "rod_length", "axial_force_start", "axial_force_end", "torque_start", "torque_end",
        "push", "contacts", "segments", "stability", "branch", "certificate", "effort", "fields", "state"}) {
    EXPECT_TRUE(step.contains(key)) << key;
  }
  EXPECT_EQ(step["rod_length"].get<double>(), 0.1 + 0.2);
  EXPECT_EQ(step["axial_force_end"].get<double>(), -1.0 / 3.0);
  EXPECT_TRUE(step["push"].is_null());
  const Json &point = step["contacts"][0], &line = step["contacts"][1];
  EXPECT_EQ(point["kind"], "point");
  EXPECT_EQ(point["end"], point["start"]);
  EXPECT_TRUE(point["force_start"].is_null());
  EXPECT_EQ(line["kind"], "line");
  EXPECT_EQ(line["force_start"], 1.5);
  EXPECT_TRUE(line["force_end"].is_null());
  EXPECT_EQ(line["pressure_mid"].get<double>(), 5e-324);
  EXPECT_EQ(line["force_vector"].size(), 3u);
  for (const char* key : {"equilibrium", "gap_min", "reaction_min", "curvature_max", "continuity", "balance",
                          "invariant_spread", "error", "strain_max"}) {
    EXPECT_TRUE(step["certificate"].contains(key)) << key;
  }
  for (const char* key : {"newton_iterations", "factorisations", "patterns_tried", "wall_seconds"})
    EXPECT_TRUE(step["effort"].contains(key)) << key;
  for (const char* key : {"S", "s", "x", "y", "z", "delta1", "delta2", "phi", "gap", "pressure", "F1", "F2", "F3", "M1",
                          "M2", "M3", "kappa"}) {
    EXPECT_EQ(step["fields"][key].size(), 3u) << key;
  }
  for (const char* key : {"parameter", "kind", "S", "rod_length", "axial_force_end"})
    EXPECT_TRUE(json["events"][0].contains(key)) << key;
  EXPECT_FALSE(Json::parse(result_json(c, sample(), false))["steps"][0].contains("fields"));
}

TEST(Results, StateComesBackBitForBit) {
  Scratch scratch;
  const Case c = read(kCase);
  write_file(scratch / "r.json", result_json(c, sample(), false));
  const std::vector<double> state = read_state(scratch / "r.json");
  const std::vector<double> expected = sample().steps[0].state;
  ASSERT_EQ(state.size(), expected.size());
  for (std::size_t i = 0; i < state.size(); ++i)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(state[i]), std::bit_cast<std::uint64_t>(expected[i]));
  scratch.write("other.json", "{\"a\": 1}");
  EXPECT_THROW(read_state(scratch / "other.json"), InputError);
  scratch.write("broken.json", "{\"a\": 1");
  EXPECT_THROW(read_state(scratch / "broken.json"), InputError);
  EXPECT_THROW(read_state(scratch / "none.json"), FileError);
}

TEST(Results, TablesHaveUnitsAndOneRowEach) {
  const Case si = read(with("title = \"test\"", "units = \"si\""));
  const std::string contacts = contacts_csv(si, sample());
  EXPECT_NE(contacts.find("start [m],end [m]"), std::string::npos);
  EXPECT_NE(contacts.find("force [N]"), std::string::npos);
  EXPECT_EQ(std::count(contacts.begin(), contacts.end(), '\n'), 3);
  EXPECT_EQ(contacts.find("nan"), std::string::npos);
  const std::string fields = fields_csv(read(kCase), sample());
  EXPECT_EQ(fields.substr(0, fields.find('\n')),
            "step,parameter,S,s,x,y,z,delta1,delta2,phi [rad],gap,pressure,F1,F2,F3,M1,M2,M3,kappa");
  EXPECT_EQ(std::count(fields.begin(), fields.end(), '\n'), 4);
}

// Reads one appended array of a .vtp back.
std::vector<double> appended(const std::string& vtp, const std::string& name) {
  const std::size_t tag = vtp.find("Name=\"" + name + "\"");
  const std::size_t offset = std::stoul(vtp.substr(vtp.find("offset=\"", tag) + 8));
  const std::size_t base =
      vtp.find("<AppendedData encoding=\"raw\">\n_") + std::strlen("<AppendedData encoding=\"raw\">\n_");
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, vtp.data() + base + offset, sizeof bytes);
  std::vector<double> values(bytes / sizeof(double));
  std::memcpy(values.data(), vtp.data() + base + offset + sizeof bytes, bytes);
  return values;
}

TEST(Results, TheSweptWallLiesOneClearanceFromTheAxis) {
  const Case c = read(kCase);
  const std::string vtp = tube_vtp(c);
  const std::vector<double> points = appended(vtp, "Points"), S = appended(vtp, "S");
  ASSERT_EQ(points.size(), 3 * S.size());
  for (std::size_t i = 0; i < S.size(); i += 97) {
    const geometry::AxisPoint at = c.tube.axis->at(S[i]);
    const Eigen::Vector3d p(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
    EXPECT_NEAR((p - at.position).norm(), 0.025, 1e-15);  // rounding
    EXPECT_NEAR((p - at.position).dot(at.frame.col(2)), 0.0, 1e-15);
  }
  EXPECT_EQ(appended(rod_vtp(c, sample().steps[0]), "gap"), (std::vector<double>{0.0, 0.5, 1.0}));
}

TEST(Files, AreWholeOrNotThere) {
  Scratch scratch;
  write_file(scratch / "a.txt", "first");
  write_file(scratch / "a.txt", "second");
  EXPECT_EQ(Scratch::slurp(scratch / "a.txt"), "second");
  EXPECT_THROW(write_file("/no/such/directory/a.txt", "x"), FileError);
  EXPECT_THROW(write_file(scratch.path(), "x"), FileError);
  EXPECT_THROW(write_file("/dev/full", "x"), FileError);

  // A disk that fills up, played by a limit on the size of files: the old content stays, nothing is left beside it.
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  getrlimit(RLIMIT_FSIZE, &limit);
  const rlimit small{1000, limit.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW(write_file(scratch / "a.txt", std::string(100000, 'x')), FileError);
  EXPECT_THROW(write_file(scratch / "b.txt", std::string(100000, 'x')), FileError);
  setrlimit(RLIMIT_FSIZE, &limit);
  EXPECT_EQ(Scratch::slurp(scratch / "a.txt"), "second");
  std::size_t entries = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(scratch.path())) ++entries;
  EXPECT_EQ(entries, 1u);
}

}  // namespace
}  // namespace tendril::io::test

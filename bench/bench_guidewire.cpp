// A tapered guidewire fed 300 mm into an iliac artery and aorta, half a millimetre at a time:
//   bench_guidewire [--file CSV] [--uniform] [--withdraw] [--steps FILE] [--from MM] [--to MM] [--step MM]
// The table: steps, lost, jumps, substeps, factorisations, time of a step; then the log of events. The centreline is
// that of SimVascular's demonstration, as distributed, sought in shared/ beside the checkout or one level above.
// `--steps` writes a line for every step, `--withdraw` measures the way back as well.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tendril/continuation/session.hpp"
#include "tendril/io/case.hpp"

namespace {

using namespace tendril;

/// Of the processor: what others do on the machine does not count.
double milliseconds() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::string find_vessel() {
  const std::string name = "data/vessels/simvascular_demo_aorta_right_iliac.csv";
  std::filesystem::path at = TENDRIL_SOURCE_DIR;
  for (int up = 0; up < 4; ++up, at = at.parent_path()) {
    const auto file = at / "shared" / name;
    if (std::filesystem::exists(file)) return file.string();
    if (!at.has_parent_path()) break;
  }
  return {};
}

segmentation::Problem guidewire(const std::string& file, bool uniform, double length) {
  std::string text = R"(
schema = 1
units = "si"
[rod]
bending_stiffness = "1000 N mm^2"
poisson_ratio = 0.3
diameter = "0.889 mm"
)";
  if (!uniform)
    text += R"([[rod.section]]
measured_from = "end"
length = "40 mm"
bending_stiffness = ["1 N mm^2", "1000 N mm^2"]
)";
  text += R"([tube]
side = "inside"
[tube.axis]
kind = "points"
reverse = true
file = ")" +
          file + R"("
[start]
kind = "clamped"
[end]
kind = "free"
rod_length = "300 mm"
)";
  segmentation::Problem p = io::build_problem(io::parse_case(text, "guidewire", io::Format::toml));
  p.axial_value = 1e-3 * length;  // the wire goes on behind the inlet
  return p;
}

struct StepRecord {
  double fed, ms;
  continuation::Session::Motion motion;
  int contacts, lines;
};

double percentile(std::vector<double> v, double q) {
  if (v.empty()) return 0.0;
  std::sort(v.begin(), v.end());
  return v[std::min<std::size_t>(static_cast<std::size_t>(q * v.size()), v.size() - 1)];
}

void table(const char* name, const std::vector<StepRecord>& steps, int wanted) {
  std::vector<double> ms;
  int jumps = 0, lost = wanted - static_cast<int>(steps.size());
  long substeps = 0, factorisations = 0, iterations = 0;
  for (const auto& s : steps) {
    ms.push_back(s.ms);
    lost += !s.motion.reached;
    jumps += s.motion.jumped;
    substeps += s.motion.substeps;
    factorisations += s.motion.factorisations;
    iterations += s.motion.newton_iterations;
  }
  const double n = std::max<std::size_t>(steps.size(), 1);
  std::printf("%-10s %5d steps, %d lost, %d jumps, %.2f substeps, %.2f factorisations, %.1f iterations a step\n", name,
              wanted, lost, jumps, substeps / n, factorisations / n, iterations / n);
  std::printf("%-10s ms a step: median %.1f, 90 %% %.1f, 99 %% %.1f, largest %.1f\n", "", percentile(ms, 0.5),
              percentile(ms, 0.9), percentile(ms, 0.99), percentile(ms, 1.0));
}

}  // namespace

int main(int argc, char** argv) {
  std::string file, log;
  bool uniform = false, withdraw = false;
  double from = 10.0, to = 300.0, step = 0.5;
  for (int i = 1; i < argc; ++i) {
    const auto next = [&]() -> const char* { return i + 1 < argc ? argv[++i] : "0"; };
    if (!std::strcmp(argv[i], "--uniform")) uniform = true;
    if (!std::strcmp(argv[i], "--withdraw")) withdraw = true;
    if (!std::strcmp(argv[i], "--file")) file = next();
    if (!std::strcmp(argv[i], "--steps")) log = next();
    if (!std::strcmp(argv[i], "--from")) from = std::atof(next());
    if (!std::strcmp(argv[i], "--to")) to = std::atof(next());
    if (!std::strcmp(argv[i], "--step")) step = std::atof(next());
  }
  if (file.empty()) file = find_vessel();
  if (file.empty()) {
    std::printf("bench_guidewire: skipped, shared/data/vessels is not beside the checkout (or give --file CSV)\n");
    return 0;
  }
  double begun = milliseconds();
  const auto problem = guidewire(file, uniform, from);
  std::printf("read in %.0f ms: axis of %.1f mm\n", milliseconds() - begun, 1e3 * problem.tube.length());
  begun = milliseconds();
  continuation::Session session(problem, {});
  if (!session.ready()) {
    std::printf("no start: %s\n", session.reason().c_str());
    return 1;
  }
  std::printf("start at %g mm found in %.0f ms\n", from, milliseconds() - begun);
  std::FILE* out = log.empty() ? nullptr : std::fopen(log.c_str(), "w");
  const auto drive = [&](double end, std::vector<StepRecord>& steps) {
    const int n = static_cast<int>(std::round(std::abs(end - 1e3 * session.fed()) / step));
    const double first = session.fed(), way = 1e-3 * end - first;
    for (int i = 1; i <= n; ++i) {
      const double t = milliseconds();
      const auto motion = session.advance(first + way * i / n - session.fed());
      const double ms = milliseconds() - t;
      const auto& c = session.chain();
      int lines = 0;
      for (int j = 0; j < c.segments(); ++j) lines += c.is_line(j);
      steps.push_back({1e3 * session.fed(), ms, motion, c.segments() - 1 - lines, lines});
      if (out) {
        std::fprintf(
            out, "%8.3f %8.2f ms %3d substeps %3ld factors %4ld iterations %3d segments %2d lines %6d unknowns%s %s\n",
            1e3 * session.fed(), ms, motion.substeps, motion.factorisations, motion.newton_iterations, c.segments(),
            lines, c.unknowns(), motion.jumped ? " JUMP" : "", motion.reason.c_str());
        std::fflush(out);
      }
      if (!motion.reached) {
        std::printf("ends at %.4f mm: %s\n", 1e3 * session.fed(), motion.reason.c_str());
        break;
      }
    }
    return n;
  };
  std::vector<StepRecord> in, back;
  const int n = drive(to, in);
  table("in", in, n);
  const auto state = session.state();
  std::printf("there: %s, %s, %zu contacts, error %.1e\n",
              state.status == continuation::Status::converged ? "certified" : state.message.c_str(),
              state.stability.c_str(), state.contacts.size(), state.certificate.error);
  if (withdraw) {
    const int m = drive(from, back);
    table("back", back, m);
  }
  std::printf("events:\n");
  for (const auto& e : session.events())
    std::printf("  %-16s at %9.4f mm of rod, S = %8.3f mm\n", e.kind.c_str(), 1e3 * e.parameter, 1e3 * e.S);
  if (out) std::fclose(out);
  bool lost = in.size() < static_cast<std::size_t>(n);
  for (const auto& s : in) lost = lost || !s.motion.reached;
  return lost ? 1 : 0;
}

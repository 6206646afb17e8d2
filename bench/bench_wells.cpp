// Wells with more and more contacts: the survey of examples/well_forge.toml taken longer, and a hole that undulates
// evenly. Cold: from nothing to the certified state. Warm: one load step, from the stored state of a load one per cent
// smaller. `per_contact` is the cost of one contact, `ratio` that cost over the one of the shortest well: 1 where the
// cost is linear in the number of contacts.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <map>
#include <string>

#include "tendril/continuation/study.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/geometry/fitted_axes.hpp"
#include "tendril/io/case.hpp"

namespace {

using namespace tendril;

/// The last `length` metres before 3300 m of the real well.
segmentation::Problem real_well(int length, double load) {
  return io::build_problem(io::read_case(std::string(TENDRIL_SOURCE_DIR) + "/examples/well_forge.toml",
                                         {"tube.axis.from=" + std::to_string(3300 - length), "tube.axis.to=3300",
                                          "end.axial_force=" + std::to_string(load)}));
}

/// A hole at 75 degrees whose inclination swings by 1.5 degrees every 60 m, one station every 10 m.
segmentation::Problem undulating_well(int length, double load) {
  std::vector<double> md, inc, azi;
  for (int s = 0; s <= length; s += 10) {
    md.push_back(s);
    inc.push_back(75.0 + 1.5 * std::sin(2.0 * M_PI * s / 60.0));
    azi.push_back(40.0);
  }
  segmentation::Problem p;
  p.tube.axis = geometry::make_survey(md, inc, azi, 0.01 * 0.04445, {}).axis;
  p.tube.clearance = geometry::make_constant(0.04445);
  p.rod = {1.2285e6, 1.2285e6 / 1.3, 703.9e6};
  p.load.force = {0.0, 0.0, 250.0};
  p.end.kind = segmentation::End::Kind::sleeve;
  p.end_position = p.tube.length();
  p.axial_value = load;
  return p;
}

using Well = segmentation::Problem (*)(int, double);

void measure(benchmark::State& state, Well well, bool warm, const std::string& name) {
  constexpr double load = -20e3;
  const int length = static_cast<int>(state.range(0));
  static std::map<std::string, double> first;
  continuation::StudyOptions options;
  continuation::Result before;
  if (warm) {
    before = continuation::solve(well(length, 0.99 * load), options);
    if (before.status != continuation::Status::converged) return state.SkipWithError(before.message.c_str());
    options.initial = &before.steps[0].state;
  }
  const segmentation::Problem problem = well(length, load);
  continuation::Result r;
  const auto begun = std::chrono::steady_clock::now();
  for (auto _ : state) benchmark::DoNotOptimize(r = continuation::solve(problem, options));
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count() / state.iterations();
  if (r.status != continuation::Status::converged) return state.SkipWithError(r.message.c_str());
  const double contacts = static_cast<double>(r.steps[0].contacts.size()), each = seconds / contacts;
  first.try_emplace(name, each);
  state.counters["contacts"] = contacts;
  state.counters["per_contact_ms"] = 1e3 * each;
  state.counters["ratio"] = each / first[name];
}

void real_cold(benchmark::State& state) { measure(state, real_well, false, "real cold"); }
void real_warm(benchmark::State& state) { measure(state, real_well, true, "real warm"); }
void undulating_cold(benchmark::State& state) { measure(state, undulating_well, false, "undulating cold"); }
void undulating_warm(benchmark::State& state) { measure(state, undulating_well, true, "undulating warm"); }

BENCHMARK(real_cold)->Arg(300)->Arg(600)->Arg(900)->Arg(1500)->Unit(benchmark::kMillisecond);
BENCHMARK(real_warm)->Arg(300)->Arg(600)->Arg(900)->Arg(1500)->Unit(benchmark::kMillisecond);
BENCHMARK(undulating_cold)->RangeMultiplier(2)->Range(300, 4800)->Unit(benchmark::kMillisecond);
BENCHMARK(undulating_warm)->RangeMultiplier(2)->Range(300, 4800)->Unit(benchmark::kMillisecond);

}  // namespace

// Whole solves through the one entry of the mechanics: a free problem cold and warm, and a contact state.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "free_problem.hpp"
#include "tendril/continuation/study.hpp"

namespace {

using namespace tendril;

void count(benchmark::State& state, const continuation::Result& r) {
  if (r.status != continuation::Status::converged) return state.SkipWithError(r.message.c_str());
  state.counters["newton"] = static_cast<double>(r.steps.at(0).effort.newton_iterations);
  state.counters["factorisations"] = static_cast<double>(r.steps.at(0).effort.factorisations);
}

void free_cold(benchmark::State& state) {
  const segmentation::Problem problem = bench::free_problem();
  continuation::StudyOptions options;
  options.solve.branch = segmentation::BranchRule::nearest;
  continuation::Result r;
  for (auto _ : state) benchmark::DoNotOptimize(r = continuation::solve(problem, options));
  count(state, r);
}
BENCHMARK(free_cold)->Unit(benchmark::kMillisecond);

/// From the stored state of a load one per cent smaller.
void free_warm(benchmark::State& state) {
  continuation::StudyOptions options;
  options.solve.branch = segmentation::BranchRule::nearest;
  const continuation::Result before = continuation::solve(bench::free_problem(19.8), options);
  if (before.steps.empty()) return state.SkipWithError("no start");
  options.initial = &before.steps[0].state;
  const segmentation::Problem problem = bench::free_problem();
  continuation::Result r;
  for (auto _ : state) benchmark::DoNotOptimize(r = continuation::solve(problem, options));
  count(state, r);
}
BENCHMARK(free_warm)->Unit(benchmark::kMillisecond);

/// Helical conduit of the thesis at -10 |T0|: contact pattern found from nothing, checked, stability judged.
void conduit_cold(benchmark::State& state) {
  segmentation::Problem p;
  p.tube.axis = geometry::make_helix(1.0 / (std::numbers::pi * std::sqrt(2.0)), std::numbers::pi / 4, 1.0);
  p.tube.clearance = geometry::make_constant(0.05);
  p.rod = {1.0, 0.75, 400.0};
  p.end.kind = segmentation::End::Kind::sleeve;
  p.end_position = 1.0;
  p.axial_value = -70.69032970971682;
  p.twist_value = -1.0;
  continuation::Result r;
  for (auto _ : state) benchmark::DoNotOptimize(r = continuation::solve(p, {}));
  count(state, r);
}
BENCHMARK(conduit_cold)->Unit(benchmark::kMillisecond);

}  // namespace

// Solves the shared free problem at the tolerance given, as often as asked, and prints fields and the best times as
// JSON: our half of compare_scipy.py. Cold: a whole study from nothing, judged and certified. Warm: one boundary value
// problem on the mesh of the cold solution, from the solution one per cent of the load away and on its factors, as the
// steps along a path begin; the error between nodes is estimated.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>

#include "free_problem.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/segmentation/chain.hpp"

int main(int argc, char** argv) {
  using namespace tendril;
  if (argc != 3) {
    std::fprintf(stderr, "usage: compare_free TOLERANCE REPEATS\n");
    return 2;
  }
  const segmentation::Problem problem = bench::free_problem();
  continuation::StudyOptions options;
  options.solve.tolerance = std::atof(argv[1]);
  options.solve.branch = segmentation::BranchRule::nearest;
  double best = 1e300;
  for (int i = 0; i < std::atoi(argv[2]); ++i) {
    const auto began = std::chrono::steady_clock::now();
    const continuation::Result r = continuation::solve(problem, options);
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
    if (r.status != continuation::Status::converged) {
      std::fprintf(stderr, "not converged: %s\n", r.message.c_str());
      return 1;
    }
  }
  options.fields = true;
  const continuation::Result result = continuation::solve(problem, options);
  const continuation::Fields& f = result.steps.at(0).fields;
  // warm: the chain alone, on the mesh of the cold solution, from the solution at 1/1.01 of the load; error estimated
  segmentation::Problem moving = problem;
  const double load = problem.axial_value.value;
  moving.axial_value = {load, 1.0};
  const auto mechanics = std::make_shared<segmentation::Mechanics>(moving, load);
  using segmentation::Closure;
  segmentation::NewtonOptions newton{.tolerance = std::max(1e-13, 1e-3 * options.solve.tolerance)};
  segmentation::Chain near;
  if (!near.restore(result.steps.at(0).state, mechanics)) return 1;
  if (!near.solve({Closure::Kind::parameter, 0, load / 1.01}, newton).converged) return 1;
  newton.keep_factors = true;  // as along a path
  double warm = 1e300;
  for (int i = 0; i < std::atoi(argv[2]); ++i) {
    segmentation::Chain chain = near;
    const auto began = std::chrono::steady_clock::now();
    if (!chain.solve({Closure::Kind::parameter, 0, load}, newton).converged) return 1;
    chain.estimate_error();
    warm = std::min(warm, std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
  }
  std::printf("{\"seconds\": %.9g, \"warm_seconds\": %.9g", best, warm);
  const std::pair<const char*, const std::vector<double>*> columns[] = {
      {"S", &f.S},   {"delta1", &f.delta1}, {"delta2", &f.delta2}, {"F1", &f.F1},
      {"F2", &f.F2}, {"F3", &f.F3},         {"M1", &f.M1},         {"M2", &f.M2}};
  for (const auto& [name, values] : columns) {
    std::printf(", \"%s\": [", name);
    for (std::size_t i = 0; i < values->size(); ++i) std::printf("%s%.17g", i ? ", " : "", (*values)[i]);
    std::printf("]");
  }
  std::printf("}\n");
}

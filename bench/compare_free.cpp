// Solves the shared free problem cold at the tolerance given, as often as asked, and prints fields and the best time as
// JSON: our half of compare_scipy.py. No search for other branches: one boundary value problem, as the other half
// solves.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "free_problem.hpp"
#include "tendril/continuation/study.hpp"

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
  std::printf("{\"seconds\": %.9g", best);
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

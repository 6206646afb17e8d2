#pragma once
// The one entry of the mechanics for every face (program, Python): solve one problem or follow a path of problems.

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tendril/continuation/result.hpp"
#include "tendril/segmentation/problem.hpp"

namespace tendril::continuation {

/// A path through problems: `at(p)` is the problem at parameter p; scalars that follow p smoothly carry their rate,
/// which enables arclength steps. `smooth` is false when p rebuilds the geometry or the rod (then p itself is stepped).
struct Path {
  double start = 0;            // the case's own value of the parameter
  std::vector<double> values;  // listed values, in order
  bool smooth = true;
};

struct StudyOptions {
  segmentation::SolveOptions solve;
  bool fields = false;  // fill Step::fields
  int field_points = 401;
  double max_step = 0.25;                        // along a path: largest scaled change of any unknown in one step
  const std::vector<double>* initial = nullptr;  // Step::state to start from (--from); none: cold start
  const std::atomic<bool>* stop = nullptr;       // set from outside (Ctrl-C): keep what is done and return
  std::function<void(double fraction, const std::string& what)> progress;  // optional observer
};

/// One state.
Result solve(const segmentation::Problem& problem, const StudyOptions& options);
/// A path; `family(p)` must be pure. Events on all stretches are reported; steps hold the listed values only.
Result follow(const std::function<segmentation::Problem(double)>& family, const Path& path,
              const StudyOptions& options);

}  // namespace tendril::continuation

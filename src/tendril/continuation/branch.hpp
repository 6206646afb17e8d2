#pragma once
// A solution branch of a boundary value problem in its parameter p, followed by pseudo-arclength: tangent predictor,
// Newton on the plane normal to the tangent, so that folds are passed; folds, branch points (the bordered determinant
// changes sign) and zeros of the user's functions are located on the branch. Arclength is measured in the unknowns over
// their typical sizes, averaged over the segments, and p over its scale (Keller 1977; Seydel, ch. 4-5).

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tendril/collocation/boundary_value_problem.hpp"

namespace tendril::continuation {

using collocation::BoundaryValueProblem;

struct BranchOptions {
  double first_step = 0.02, max_step = 0.2, min_step = 1e-8;  // of arclength
  int max_points = 400;
  int direction = 1;                           // sign of dp at the start
  double p_min = -HUGE_VAL, p_max = HUGE_VAL;  // the branch ends, exactly there, where p leaves this range
  double smallest_cosine = 0.9;                // between the tangents of two points: otherwise the step is cut
  double event_tolerance = 1e-10;              // of arclength, relative to the step an event is located in
  collocation::BvpOptions solve;
  /// Functions of a solved state whose zeros are located.
  std::vector<std::function<double(const BoundaryValueProblem&)>> functions;
  /// Called with every point; true ends the branch there.
  std::function<bool(const BoundaryValueProblem&)> stop;
};

struct BranchPoint {
  double p = 0.0, arclength = 0.0;
  std::vector<double> values;  // of the functions
  int sign = 0;  // of the determinant at fixed p: changes at every fold and branch point, relative to the first point
};

struct BranchEvent {
  enum class Kind { fold, branch_point, zero } kind = Kind::fold;
  int function = -1;  // zero: which
  double p = 0.0, arclength = 0.0;
  std::vector<double> values;
  BoundaryValueProblem problem;  // the state
  std::vector<double> kernel;    // branch point: direction of the crossing branch, of unit length in the metric
};

struct Branch {
  std::vector<BranchPoint> points;
  std::vector<BranchEvent> events;
  std::string ended;  // "parameter range", "stopped", "points", or why no further step was found
  bool failed = false;
};

/// Follow the branch through the solved state of `problem`, which ends up at the last point.
Branch follow(BoundaryValueProblem& problem, const BranchOptions& options);

/// State on the branch that crosses at a branch point, at distance `size` along its kernel (negative: the other way).
std::optional<BoundaryValueProblem> leave(const BranchEvent& event, double size,
                                          const collocation::BvpOptions& options = {});

}  // namespace tendril::continuation

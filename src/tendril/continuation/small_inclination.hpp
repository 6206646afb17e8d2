#pragma once
// Solver of the small inclination approximation (II.2.4): free segments between point contacts. A line contact is
// outside its domain and said so. The result is an approximation of the case, or a first guess for the exact solver.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tendril/collocation/boundary_value_problem.hpp"
#include "tendril/continuation/result.hpp"
#include "tendril/formulation/small_inclination.hpp"
#include "tendril/segmentation/chain.hpp"

namespace tendril::continuation {

/// Everything at one section, scaled; inputs in the layout of the exact contact-free form (FreeRod).
struct SmallInclinationSection {
  double S = 0.0, s = 0.0, inputs[17] = {}, M1 = 0.0, M2 = 0.0, M3 = 0.0;
};

class SmallInclinationRod {
 public:
  /// `contacts`: guessed S of the point contacts, ascending. Start: the ends' eccentricity blended along the axis, or
  /// `like`.
  SmallInclinationRod(std::shared_ptr<const segmentation::ScaledProblem> problem, const std::vector<double>& contacts,
                      const SmallInclinationRod* like = nullptr, int pieces = 8);
  /// `axial`: the case's axial condition (F3, push or length), scaled.
  collocation::BvpSummary solve(double axial, const collocation::BvpOptions& options);

  int segments() const { return bvp_.segments(); }
  double place(int j) const;  // S where segment j begins
  SmallInclinationSection at(double S) const;
  SmallInclinationSection at(int segment, double x) const;
  double reaction(int j) const;  // jump of F·N at the beginning of segment j (j = 1..)
  const segmentation::ScaledProblem& problem() const { return *problem_; }

 private:
  std::shared_ptr<const segmentation::ScaledProblem> problem_;
  collocation::BoundaryValueProblem bvp_;
};

struct SmallInclinationOutcome {
  bool converged = false;
  bool outside_domain = false;  // a line contact would be needed
  std::string reason;
  std::optional<SmallInclinationRod> rod;
};
/// The state of the case, its point contacts found one by one (largest penetration first).
SmallInclinationOutcome small_inclination(const segmentation::Problem& problem, const collocation::BvpOptions& options);

/// The exact form's chain filled with the approximate state, to be solved from there.
segmentation::Chain exact_start(const SmallInclinationRod& rod, int pieces = 8);

/// The approximate state as a step of a result, case's units; fields with `points` rows when points > 0.
Step describe(const SmallInclinationRod& rod, int points);

}  // namespace tendril::continuation

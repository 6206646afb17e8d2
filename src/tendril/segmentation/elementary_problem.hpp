#pragma once
// SolveElmProb (Algorithm IV.2): one elementary problem with its boundary data given, by collocation with condensation
// piece by piece and a damped Newton iteration, the mesh refined to the tolerance. The sensitivities of both end states
// to all boundary data and to the two ends come from further right-hand sides on the last factors, not from
// differences.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tendril/collocation/segment.hpp"
#include "tendril/segmentation/chain.hpp"

namespace tendril::segmentation {

/// Boundary data (IV.1.9, IV.1.15). Free: left φ δ1 δ1' δ2 δ2', right F3 M3 δ1 δ1' δ2 δ2'. Line contact: left ψ β β',
/// right F3 M3 β β'. M3 replaces the thesis' φ', which alone does not fix the twisting moment of a free end.
struct BoundaryData {
  std::vector<double> left, right;
  double S_a = 0.0, S_b = 1.0;
  int count() const { return static_cast<int>(left.size() + right.size()) + 2; }

  static constexpr int left_count(bool line) { return line ? 3 : 5; }
  static constexpr int right_count(bool line) { return line ? 4 : 6; }
  /// Datum i in the order left, right, S_a, S_b.
  double& at(int i);
};

struct ElementaryOptions {
  NewtonOptions newton;
  double accuracy = 1e-8;  // mesh tolerance, relative, between nodes
  bool sensitivities = true;
};

struct ElementarySolution {
  bool converged = false;
  std::string reason;  // why not
  collocation::Segment segment;
  double error = 0.0;  // estimated, relative, between nodes
  int iterations = 0, factorisations = 0;
  Eigen::MatrixXd left_rate, right_rate;  // d(end state)/d(datum): states x count()
};

bool is_line(const collocation::Segment& segment);
/// The boundary data that `segment` satisfies, between S_a and S_b.
BoundaryData boundary_data(const ScaledProblem& problem, const collocation::Segment& segment, double S_a, double S_b);

/// `guess` fixes the kind (its system) and the first mesh. The arc length s starts from 0.
ElementarySolution solve_elm_prob(const ScaledProblem& problem, const BoundaryData& data,
                                  const collocation::Segment& guess, const ElementaryOptions& options);

}  // namespace tendril::segmentation

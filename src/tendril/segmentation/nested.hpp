#pragma once
// The nested procedures of IV.1: PropagateSolution (Algorithm IV.4) solves the elementary problems one by one from the
// right end to the left for given junctions, handing on F3 and M3; SolveSequence (Algorithm IV.5) moves the junctions
// until curvatures, transverse force and director angle are continuous (IV.1.16-17). Its Jacobian is assembled from the
// sensitivities of the elementary problems along the propagation. Oracle and fallback of the one Newton over the chain.
//
// Junction unknowns: y holds S, β, β', φ of every junction in turn. Supports as in the thesis: both ends clamped or in
// a sleeve, roll given at the start, axial force and torque at the end; the load parameter is held.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tendril/segmentation/chain.hpp"
#include "tendril/segmentation/elementary_problem.hpp"

namespace tendril::segmentation {

struct SequenceOptions {
  NewtonOptions newton;    // of the median loop; the elementary problems inherit it
  double accuracy = 1e-8;  // mesh tolerance
  bool broyden = false;    // rank-one updates of the Jacobian instead of sensitivities at every step
};

struct Propagation {
  bool converged = false;
  std::string reason;                       // why not
  std::vector<ElementarySolution> element;  // along the rod
  Eigen::VectorXd residual;  // ⟦κ_g⟧, ⟦κ_n⟧, ⟦F_g⟧, ⟦φ⟧ of every junction, right minus left
  Eigen::MatrixXd jacobian;  // d(residual)/dy, when asked for
  int iterations = 0, factorisations = 0;
};

struct SequenceSummary {
  bool converged = false;
  int iterations = 0;  // of the median loop
  int propagations = 0, jacobians = 0;
  int elementary_iterations = 0, factorisations = 0;
  double correction = 0.0;  // last scaled correction of y
  std::string reason;       // why not
};

/// Why the nested procedures do not treat this problem; empty when they do.
std::string nested_refusal(const Chain& chain);

/// Junction unknowns of a chain.
Eigen::VectorXd junction_unknowns(const Chain& chain);

/// PropagateSolution at the mechanics' present load parameter; `guess` gives kinds and first meshes.
Propagation propagate_solution(const ScaledProblem& problem, const Eigen::VectorXd& y,
                               const std::vector<collocation::Segment>& guess, const SequenceOptions& options,
                               bool sensitivities);

/// SolveSequence with the chain's state as first guess, at the given load parameter. The chain takes over the solution;
/// it is left alone when there is none.
SequenceSummary solve_sequence(Chain& chain, double parameter, const SequenceOptions& options);

}  // namespace tendril::segmentation

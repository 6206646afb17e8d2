#pragma once
// Solver of the Lagrangian formulation (II.1): a rod held at both ends, sliding through one of them or of given length,
// over a pattern of free, point-contact and line-contact segments of unknown lengths, as one boundary value problem in
// the world frame. The end force or the rod's whole length is given. The pattern is the caller's: nothing is searched,
// gap and reactions are reported. Independent of the Eulerian solver: only the collocation core is shared. Scaled by
// L and B, N outward.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "tendril/collocation/boundary_value_problem.hpp"
#include "tendril/formulation/lagrangian_rod.hpp"
#include "tendril/geometry/tube.hpp"

namespace tendril::continuation {

using formulation::V3;

/// Derivatives of a tube in the world frame, scaled by L.
std::function<formulation::TubeJet(double S)> tube_in_world(const geometry::Tube& tube, double L,
                                                            double clearance_scale = 1.0);

/// How one end is held. The frame is the tube's there; φ is measured in it (k basis: minimal rotation of D onto d3).
struct LagrangianEnd {
  V3<double> position{}, D1{}, D2{}, D3{};
  std::optional<V3<double>> tangent;  // d3; none: pinned, M1 = M2 = 0
  std::optional<double> roll;         // φ; none: M3 = torque
  double torque = 0.0;
};

struct LagrangianProblem {
  formulation::LagrangianRodData rod;
  LagrangianEnd start, end;
  bool push = false;            // the axial condition: -H instead of F3
  bool axial_at_start = false;  // at which end
};

/// Unit quaternion of directors (orthonormal, right-handed).
formulation::Quaternion<double> attitude(const V3<double>& d1, const V3<double>& d2, const V3<double>& d3);

/// A section of the rod, world frame.
struct LagrangianSection {
  double s = 0.0, stretch = 1.0;
  V3<double> r{}, d1{}, d3{}, F{}, M{};
  bool line = false;
  V3<double> N{};         // outward normal, line contact
  double pressure = 0.0;  // ρ along N, line contact
};

/// The same seen from the tube: closest place on the axis, components in D1, D2 and in the k basis (minimal rotation of
/// D onto d3).
struct TubeView {
  double S = 0.0, delta1 = 0.0, delta2 = 0.0, phi = 0.0, gap = 0.0;  // gap: Q - |δ|
  V3<double> F{}, M{}, N{};
};
TubeView seen_from_tube(const LagrangianProblem& problem, const LagrangianSection& section, double S_guess);

/// Segments in order: true is a line contact; two free neighbours touch the wall at a point between them.
using LagrangianPattern = std::vector<bool>;

class LagrangianRod {
 public:
  using Guess = std::function<LagrangianSection(double s)>;
  /// cuts: s of the segments' ends in the guess, one more than segments. k Gauss points a piece. knots: s in the guess
  /// where a line contact passes a kink of the tube's higher derivatives, to be mesh points.
  LagrangianRod(LagrangianProblem problem, LagrangianPattern pattern, const std::vector<double>& cuts,
                const Guess& guess, int pieces = 8, int k = 7, const std::vector<double>& knots = {});

  /// The axial condition's value given: F3, or the push.
  collocation::BvpSummary solve_force(double value, const collocation::BvpOptions& options);
  /// Length of the whole rod held, the axial value found; or that of one segment.
  collocation::BvpSummary solve_length(double length, const collocation::BvpOptions& options);
  collocation::BvpSummary solve_segment_length(int j, double length, const collocation::BvpOptions& options);

  int segments() const { return static_cast<int>(pattern_.size()); }
  double length() const { return cut(segments()); }
  double cut(int j) const;  // s where segment j begins
  double axial_value() const { return bvp_->parameter(); }
  LagrangianSection at(double s) const;
  LagrangianSection at(int segment, double x) const;
  /// The section whose closest place on the axis is S.
  LagrangianSection at_place(double S) const;
  /// Concentrated force at the beginning of segment j (j = 1..): jump of F·N, R > 0 presses inside.
  double jump(int j) const;
  const LagrangianProblem& problem() const { return *problem_; }
  const collocation::Segment& segment(int j) const { return bvp_->segment(j); }
  collocation::BoundaryValueProblem& bvp() { return *bvp_; }

 private:
  std::shared_ptr<LagrangianProblem> problem_;  // the systems point to its rod
  LagrangianPattern pattern_;
  collocation::BvpSummary solve_lengths(int first, int last, double length, const collocation::BvpOptions& options);
  std::optional<collocation::BoundaryValueProblem> bvp_;
};

}  // namespace tendril::continuation

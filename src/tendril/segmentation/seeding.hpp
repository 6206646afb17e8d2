#pragma once
// Starting states for contact patterns in which something new has a small but finite length.

#include <array>
#include <vector>

#include "tendril/segmentation/chain.hpp"

namespace tendril::segmentation {

/// Shear forces F1, F2 of a free state from the moment equations (II.2.51-52), all else given (17 free inputs).
void balance_shear(const ScaledProblem& problem, double S, double* u);

/// A line's pressure along a stretch, straight between the places given, with its moments.
class PressureTable {
 public:
  PressureTable() = default;
  PressureTable(std::vector<double> S, const std::vector<double>& p);
  bool empty() const { return S_.empty(); }
  /// The stretch [a, b] over which a beam under the load -p fits the wall at both ends in place, slope and curvature:
  /// ∫ (b-t)(t-a) p dt = ∫ (b-t)(t-a) t p dt = 0. Starts from a, b; false where there is none within the table.
  bool opening(double& a, double& b) const;
  /// Distance of that beam from the wall and its first three derivatives; the fourth is -p.
  void lift(double a, double b, double S, double* w) const;

 private:
  std::vector<double> S_;
  std::vector<std::array<double, 4>> moment_;  // ∫ t^k p from the first place, t from the middle of the table
  std::vector<double> p_;
  double middle_ = 0.0;
  std::array<double, 4> moments(double S) const;
};

struct Opening {
  int segment = 0;      // line segment that opens
  double S = 0.0;       // middle of the new free stretch
  double span = 0.0;    // its length 2l
  double k = 0.0;       // the rod leaves the wall by k (l² - x²)³,
  PressureTable table;  // or as the beam does under this pressure
};

/// Opening of given span around S where the pressure just vanishes: 720 k = p̂''.
Opening opening_at(const Chain& chain, int segment, double S, double span);
/// One opening for every stretch of line contact that pulls with more than `tolerance` of the largest contact force, by
/// descending place, over the length at which the beam fits the wall with equal curvature at both ends: of a parabolic
/// dip of half-length a, l = √5 a.
std::vector<Opening> tensile_stretches(const Chain& chain, double tolerance);

/// Lines opened over the given stretches. Where a stretch reaches an end of its line, a point contact stays behind.
/// `free_segment` receives the index of the last opening's free stretch.
Chain open_lines(const Chain& at, const std::vector<Opening>& openings, int& free_segment);

/// Junctions of `after` that `before` does not have (nothing of `before` within `distance`).
std::vector<int> new_junctions(const Pattern& before, const Pattern& after, double distance = 1e-12);

/// First stage of the next: solve with the `fresh` junctions held where they are, at the present parameter, and release
/// them. The chain keeps its guess when that fails.
NewtonSummary settle_fresh_junctions(Chain& chain, const std::vector<int>& fresh, const NewtonOptions& options);

/// Solve a chain whose `fresh` junctions are guesses: first with them held in place, then released. Without the first
/// stage Newton tends to collapse a short new stretch to nothing, which solves every equation too.
NewtonSummary solve_with_fresh_junctions(Chain& chain, const std::vector<int>& fresh, const Closure& closure,
                                         const NewtonOptions& options, double tolerance);

}  // namespace tendril::segmentation

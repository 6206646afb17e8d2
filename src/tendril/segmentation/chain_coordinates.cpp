// Which free segments are written in wall coordinates.
#include <algorithm>
#include <cmath>

#include "tendril/formulation/near_wall.hpp"
#include "tendril/segmentation/chain.hpp"

namespace tendril::segmentation {

using formulation::FreeRod;

namespace {

/// A stretch that leaves the wall by less than this, of the clearance, is written in wall coordinates; by more than
/// `far`, no longer. In δ1, δ2 it would have three of the sixteen digits less.
constexpr double close = 1e-3, far = 1e-2;
constexpr int looks = 8;

}  // namespace

// `sampler` is asked for the state in the contact-free form. S_ and line_ are set.
bool Chain::hardly_leaves(int j, const Sampler& sampler) const {
  const ScaledProblem& P = mechanics_->problem;
  if (P.planar || P.varies() || line_[j] || j == 0 || j + 1 >= static_cast<int>(line_.size())) return false;
  double u[formulation::state_inputs], s;
  for (int i = 1; i < looks; ++i) {
    const double S = S_[j] + (S_[j + 1] - S_[j]) * i / looks, Q = P.section(S).Q[0];
    sampler(S, u, &s);
    if (!(std::abs(std::hypot(u[0], u[4]) - Q) < close * Q)) return false;
  }
  return true;
}

void Chain::change_coordinates(int j, const collocation::System* system) {
  const collocation::Segment old = segment_[j];
  const ScaledProblem& P = mechanics_->problem;
  const double a = S_[j], b = S_[j + 1];
  const bool near = system == &mechanics_->near_wall;
  std::vector<double> inside;
  for (int i = 1; i < old.pieces(); ++i) inside.push_back(old.place(i, a, b));
  segment_[j] = CutSegment(collocation::Segment(system, k_));
  double beta = 0.0;
  segment_[j].part(0).initialise_on(a, b, inside, [&](double S, double* u, double* s) {
    old.evaluate(S, a, b, u, s);
    if (!near) return;
    formulation::free_to_wall(P.section(S), beta, u);
    beta = u[formulation::NearWall::angle];
  });
  factored_ = false;
}

void Chain::choose_coordinates() {
  const ScaledProblem& P = mechanics_->problem;
  for (int j = 1; j + 1 < segments(); ++j) {
    if (line_[j]) continue;
    if (!near_wall(j)) {
      const auto& s = segment_[j];
      if (hardly_leaves(j, [&](double S, double* u, double* q) { s.evaluate(S, S_[j], S_[j + 1], u, q); }))
        change_coordinates(j, &mechanics_->near_wall);
      continue;
    }
    double most = 0.0;
    for (int i = 0; i <= segment_[j].pieces(); ++i)
      most = std::max(most, std::abs(segment_[j].state(i)[segment_[j].state_index(1)]) /
                                P.section(segment_[j].place(i, S_[j], S_[j + 1])).Q[0]);
    if (most > far) change_coordinates(j, &mechanics_->free);
  }
}

void Chain::use_eccentricities() {
  for (int j = 0; j < segments(); ++j)
    if (near_wall(j)) change_coordinates(j, &mechanics_->free);
}

}  // namespace tendril::segmentation

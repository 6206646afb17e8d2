#pragma once
// One elementary problem of the chain, cut where the rod passes a break of its section law or a collar: parts that are
// collocation problems of their own, between places S that are unknowns. A uniform rod has one part, and everything
// passes straight to it. To a reader the parts are one segment; at a cut its states are those behind the cut.

#include <algorithm>
#include <cassert>
#include <vector>

#include "tendril/collocation/segment.hpp"
#include "tendril/formulation/varying_rod.hpp"

namespace tendril::segmentation {

/// A cut at the arc length s of the rod or, `placed`, at a given S, and what sits there: a collar, a point load.
struct Cut {
  double S = 0.0, s = 0.0;
  int collar = -1, load = -1;
  bool placed = false;
};

class CutSegment {
 public:
  CutSegment() = default;
  explicit CutSegment(collocation::Segment whole) : parts_{std::move(whole)}, law_{0} {}
  /// Parts in order; cuts between them; law[i] is the piece of the section law of part i, -1: the rod is uniform.
  CutSegment(std::vector<collocation::Segment> parts, std::vector<Cut> cuts, std::vector<int> law)
      : parts_(std::move(parts)), cuts_(std::move(cuts)), law_(std::move(law)), varies_(true) {
    first_piece_.assign(1, 0);
    for (const auto& p : parts_) first_piece_.push_back(first_piece_.back() + p.pieces());
  }

  int parts() const { return static_cast<int>(parts_.size()); }
  collocation::Segment& part(int i) { return parts_[i]; }
  const collocation::Segment& part(int i) const { return parts_[i]; }
  int law(int part) const { return law_[part]; }
  const Cut& cut(int i) const { return cuts_[i]; }
  void move_cut(int i, double S) { cuts_[i].S = S; }
  /// Ends of a part of the segment [a, b].
  double left(int part, double a) const { return part == 0 ? a : cuts_[part - 1].S; }
  double right(int part, double b) const { return part + 1 == parts() ? b : cuts_[part].S; }
  /// After a part was laid anew.
  void count() {
    if (varies_)
      for (int i = 0; i < parts(); ++i) first_piece_[i + 1] = first_piece_[i] + parts_[i].pieces();
  }

  const collocation::System& system() const { return parts_.front().system(); }
  const collocation::System& system_of(int piece) const { return parts_[part_of(piece)].system(); }
  int states() const { return parts_.front().states(); }
  int points_per_piece() const { return parts_.front().points_per_piece(); }
  int state_index(int component, int derivative = 0) const { return parts_.front().state_index(component, derivative); }
  int pieces() const { return varies_ ? first_piece_.back() : parts_.front().pieces(); }
  /// Part that piece i belongs to; i becomes the piece within it. The place behind the last piece belongs to the last.
  int part_of(int& i) const {
    int q = 0;
    if (varies_)
      while (q + 1 < parts() && i >= first_piece_[q + 1]) ++q;
    if (q > 0) i -= first_piece_[q];
    return q;
  }
  double place(int i, double a, double b) const {
    const int q = part_of(i);
    return parts_[q].place(i, left(q, a), right(q, b));
  }
  double* state(int i) {
    const int q = part_of(i);
    return parts_[q].state(i);
  }
  const double* state(int i) const {
    const int q = part_of(i);
    return parts_[q].state(i);
  }

  /// Inputs, for a varying rod with the piece of the law behind them, and s. At a cut: behind it.
  void evaluate(double S, double a, double b, double* inputs, double* s) const {
    int q = 0;
    while (q + 1 < parts() && S >= cuts_[q].S) ++q;
    parts_[q].evaluate(S, left(q, a), right(q, b), inputs, s);
    if (varies_) complete(q, inputs, s);
  }
  void evaluate_local(int i, double x, double a, double b, double* inputs, double* s) const {
    const int q = part_of(i);
    parts_[q].evaluate_local(i, x, left(q, a), right(q, b), inputs, s);
    if (varies_) complete(q, inputs, s);
  }

  /// As a plain segment, where there is only one part: for the procedures of uniform rods.
  operator const collocation::Segment&() const {  // NOLINT: a segment without cuts is one
    assert(parts() == 1);
    return parts_.front();
  }

 private:
  std::vector<collocation::Segment> parts_;
  std::vector<Cut> cuts_;
  std::vector<int> law_, first_piece_;
  bool varies_ = false;

  void complete(int q, double* inputs, double* s) const {
    const int n = parts_[q].system().inputs;
    inputs[n] = law_[q];
    if (s) *s = inputs[n - 2];
  }
};

}  // namespace tendril::segmentation

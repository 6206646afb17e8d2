#pragma once
// Where the states of a motion lead: the fields and the places of the contacts, extrapolated part by part at equal
// shares of a part's length. There they are smooth: a contact, a break of the section and the tip are at 0 or 1.

#include <deque>
#include <vector>

#include "tendril/segmentation/chain.hpp"

namespace tendril::continuation {

/// The same elementary problems in the same order, cut at the same breaks, in the same coordinates.
bool same_structure(const segmentation::Chain& a, const segmentation::Chain& b);

/// The complete iterate of `state` on the mesh of `mesh`, share for share (layout of Chain::gather_all).
void gather_on_mesh(const segmentation::Chain& state, const segmentation::Chain& mesh, std::vector<double>& x);

/// Earlier states on one structure, the latest first.
class Trend {
 public:
  void clear() { past_.clear(); }
  bool empty() const { return past_.empty(); }
  /// The state left behind; forgets those on another structure than `now`.
  void push(segmentation::Chain left, double value, const segmentation::Chain& now);
  /// Moves `chain`, a copy of the present state at `from`, to where the trend leads at `to`. False: there is none.
  bool lead(segmentation::Chain& chain, double from, double to) const;

 private:
  struct Past {
    segmentation::Chain chain;
    double value;
  };
  std::deque<Past> past_;
};

}  // namespace tendril::continuation

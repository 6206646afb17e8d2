#pragma once
// All states that can be found for one load: searches from several starts (the axis, the least-energy states, waves and
// helices of several lengths, turned and wound both ways), what is the same state counted once, twins named.

#include <vector>

#include "tendril/continuation/study.hpp"

namespace tendril::continuation {

struct StateFound {
  Step step;               // `branch` tells how it was reached and how its stability was judged
  double energy = 0.0;     // bending, twisting and stretching, case's units [force length]
  double weight = 0.0;     // potential of the body force about the world origin [force length]
  bool on_axis = false;    // no eccentricity
  bool planar = false;     // the eccentricity keeps to one plane of the frame D1, D2
  bool symmetric = false;  // the same seen from the other end
  int twin_of = -1;        // index of an earlier state that this one repeats
  const char* twin = "";   // "mirrored" | "turned" | "reversed" | "reversed and mirrored"
  /// What kind of state this is, in words.
  std::string kind() const;
};

struct StatesFound {
  std::vector<StateFound> states;  // stable ones first, by rod length
  int starts = 0;                  // searches made
  bool interrupted = false;
  std::string message;  // why there is none
};

/// One load, no path. Deterministic; obeys max_seconds and stop.
StatesFound find_states(const segmentation::Problem& problem, const StudyOptions& options);

}  // namespace tendril::continuation

#pragma once
// Insertion and withdrawal as a study: a session driven through a list of lengths (or places of the far end), reported
// there, with every event on the way.

#include "tendril/continuation/session.hpp"

namespace tendril::continuation {

struct Insertion {
  std::vector<double> values;  // to report, in order: length of rod fed in or place of the far end   [length]
  double to = 0.0;             // instead of values: from the case as written in steps of `step`
  double step = 0.0;           // longest motion at once [length]; 0: a hundredth of the way
  double rotation = 0.0;       // of the inlet, spread evenly over the whole way [rad]
};

/// Steps hold the listed values only, intermediate states go to `trace`, events of all the way are told. A motion that
/// cannot go on keeps what was reached.
Result insert(const segmentation::Problem& problem, const Insertion& insertion, const StudyOptions& options);

}  // namespace tendril::continuation

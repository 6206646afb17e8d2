#pragma once
// The page of computed systems: one HTML file with everything inside (pictures as SVG), readable offline and on paper.

#include <string>
#include <vector>

#include "tendril/reproduce/system.hpp"

namespace tendril::app {

struct Computed {
  const reproduce::System* system = nullptr;
  reproduce::Outcome outcome;
  std::string failure;  // why there is no outcome, empty if there is
  bool finished = false;
};

/// The row of the table holds.
bool holds(const reproduce::Row& row);
/// Finished, with rows, and every row holds.
bool holds(const Computed& computed);
/// The largest |difference| / tolerance of the table; 0 without rows.
double worst_share(const Computed& computed);
/// "12 of 12 hold", "not computed: ...".
std::string verdict(const Computed& computed);

/// With `subdirectories` the files of a system lie in one named after it, else beside the page.
std::string gallery_page(const std::vector<Computed>& systems, bool subdirectories);

}  // namespace tendril::app

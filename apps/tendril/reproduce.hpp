#pragma once
// `tendril reproduce`: the systems of the thesis, computed anew, with their data, pictures, tables and a page.

#include <string>

namespace tendril::app {

struct ReproduceOptions {
  std::string name;  // of a system, "all", or empty: list them
  std::string out;   // directory; empty: print the table only
  bool quiet = false;
};

/// Exit code 0 when every row holds, 4 when one does not or a system fails, 130 when interrupted.
int reproduce(const ReproduceOptions& options);

}  // namespace tendril::app

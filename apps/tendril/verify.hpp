#pragma once
// `tendril verify`: quantities that are known in closed form or printed in the literature, computed anew.

#include <string>
#include <vector>

namespace tendril::app {

struct VerifyRow {
  std::string quantity;  // what, where, in which units
  double computed = 0.0;
  double expected = 0.0;
  double tolerance = 0.0;  // on |computed - expected|
};

/// Every check of this version.
std::vector<VerifyRow> verify_rows();

/// Prints the table; exit code 0 when every row is within its tolerance, else 4.
int verify();

}  // namespace tendril::app

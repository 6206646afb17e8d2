#include "verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "console.hpp"

namespace tendril::app {

int verify() {
  const std::vector<VerifyRow> rows = verify_rows();
  std::size_t width = 8, failed = 0;
  for (const VerifyRow& row : rows) width = std::max(width, row.quantity.size());
  std::string out = fmt::format("{:<{}}  {:>18}  {:>18}  {:>11}  {:>9}\n", "quantity", width, "computed", "expected",
                                "difference", "tolerance");
  for (const VerifyRow& row : rows) {
    const double difference = row.computed - row.expected;
    const bool good = std::abs(difference) <= row.tolerance;  // false for NaN
    failed += good ? 0 : 1;
    out += fmt::format("{:<{}}  {:>18.10g}  {:>18.10g}  {:>11.2e}  {:>9.1e}{}\n", row.quantity, width, row.computed,
                       row.expected, difference, row.tolerance, good ? "" : "  FAILED");
  }
  out += rows.empty() ? "nothing was verified\n"
                      : fmt::format("{} of {} within tolerance\n", rows.size() - failed, rows.size());
  print(out);
  return rows.empty() || failed > 0 ? kNotConverged : kSolved;
}

}  // namespace tendril::app

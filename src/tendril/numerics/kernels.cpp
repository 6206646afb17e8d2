#include "tendril/numerics/kernels.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define TENDRIL_CLONES __attribute__((target_clones("arch=haswell", "default")))
#else
#define TENDRIL_CLONES
#endif

namespace tendril::numerics {

TENDRIL_CLONES void subtract_multiple(double* __restrict row, const double* __restrict pivot, double m, int n) {
  for (int j = 0; j < n; ++j) row[j] -= m * pivot[j];
}

TENDRIL_CLONES bool factor_and_solve(double* a, int n, int columns, int ld, int* pivots) {
  for (int p = 0; p < n; ++p) {
    int best = p;
    double most = std::abs(a[static_cast<std::size_t>(p) * ld + p]);
    for (int r = p + 1; r < n; ++r) {
      const double v = std::abs(a[static_cast<std::size_t>(r) * ld + p]);
      if (v > most) {
        most = v;
        best = r;
      }
    }
    pivots[p] = best;
    if (!(most > 0.0) || !std::isfinite(most)) return false;
    double* __restrict pr = a + static_cast<std::size_t>(p) * ld;
    if (best != p) {
      double* br = a + static_cast<std::size_t>(best) * ld;
      for (int j = 0; j < columns; ++j) std::swap(pr[j], br[j]);
    }
    const double inv = 1.0 / pr[p];
    for (int r = p + 1; r < n; ++r) {
      double* __restrict row = a + static_cast<std::size_t>(r) * ld;
      const double m = row[p] * inv;
      row[p] = m;
      if (m == 0.0) continue;
      for (int j = p + 1; j < columns; ++j) row[j] -= m * pr[j];
    }
  }
  for (int p = n - 1; p >= 0; --p) {
    double* __restrict pr = a + static_cast<std::size_t>(p) * ld;
    for (int q = p + 1; q < n; ++q) {
      const double m = pr[q];
      if (m == 0.0) continue;
      const double* __restrict qr = a + static_cast<std::size_t>(q) * ld;
      for (int j = n; j < columns; ++j) pr[j] -= m * qr[j];
    }
    const double inv = 1.0 / pr[p];
    for (int j = n; j < columns; ++j) pr[j] *= inv;
  }
  return true;
}

TENDRIL_CLONES void solve_factored(const double* a, int n, int ld, const int* pivots, double* b) {
  for (int p = 0; p < n; ++p)
    if (pivots[p] != p) std::swap(b[p], b[pivots[p]]);
  for (int p = 0; p < n; ++p) {
    const double* row = a + static_cast<std::size_t>(p) * ld;
    double f = b[p];
    for (int j = 0; j < p; ++j) f -= row[j] * b[j];
    b[p] = f;
  }
  for (int p = n - 1; p >= 0; --p) {
    const double* row = a + static_cast<std::size_t>(p) * ld;
    double f = b[p];
    for (int j = p + 1; j < n; ++j) f -= row[j] * b[j];
    b[p] = f / row[p];
  }
}

}  // namespace tendril::numerics

#include "tendril/numerics/kernels.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

#include "tendril/numerics/pack.hpp"
#include "tendril/numerics/target.hpp"

namespace tendril::numerics {
namespace {

/// Row at or below p with the largest entry of column c; its size is returned in `most`.
inline int pivot_row(const double* a, int n, int ld, int p, int c, double& most) {
  int best = p;
  most = std::abs(a[static_cast<std::size_t>(p) * ld + c]);
  for (int r = p + 1; r < n; ++r) {
    const double v = std::abs(a[static_cast<std::size_t>(r) * ld + c]);
    if (v > most) {
      most = v;
      best = r;
    }
  }
  return best;
}

inline void swap_rows(double* a, double* b, int n) {
  for (int j = 0; j < n; ++j) std::swap(a[j], b[j]);
}

/// Backward substitution of `width` columns from column `first` on, eight at a time where they allow it.
inline void back_substitute(double* a, int n, int ld, int first, int width) {
  int j = first;
  for (; j + 16 <= first + width; j += 16)
    for (int p = n - 1; p >= 0; --p) {
      double* pr = a + static_cast<std::size_t>(p) * ld;
      Pack s = Pack::load(pr + j), t = Pack::load(pr + j + 8);
      for (int q = p + 1; q < n; ++q) {
        const double* qr = a + static_cast<std::size_t>(q) * ld + j;
        const Pack m(pr[q]);
        s -= m * Pack::load(qr);
        t -= m * Pack::load(qr + 8);
      }
      const Pack inv(1.0 / pr[p]);
      (s * inv).store(pr + j);
      (t * inv).store(pr + j + 8);
    }
  for (int p = n - 1; p >= 0 && j < first + width; --p) {
    double* __restrict pr = a + static_cast<std::size_t>(p) * ld;
    for (int q = p + 1; q < n; ++q) {
      const double m = pr[q];
      const double* __restrict qr = a + static_cast<std::size_t>(q) * ld;
      for (int i = j; i < first + width; ++i) pr[i] -= m * qr[i];
    }
    const double inv = 1.0 / pr[p];
    for (int i = j; i < first + width; ++i) pr[i] *= inv;
  }
}

inline double dot(const double* a, const double* b, int n) {
  Pack s(0.0);
  int j = 0;
  for (; j + 8 <= n; j += 8) s += Pack::load(a + j) * Pack::load(b + j);
  double sum = s.sum();
  for (; j < n; ++j) sum += a[j] * b[j];
  return sum;
}

}  // namespace

TENDRIL_CLONES void subtract_multiple(double* __restrict row, const double* __restrict pivot, double m, int n) {
  for (int j = 0; j < n; ++j) row[j] -= m * pivot[j];
}

// Two columns are eliminated together, so that every other row is read and written half as often.
TENDRIL_FLATTEN_CLONES bool factor_and_solve(double* a, int n, int columns, int ld, int* pivots) {
  for (int p = 0; p < n; p += 2) {
    double most;
    double* __restrict first = a + static_cast<std::size_t>(p) * ld;
    pivots[p] = pivot_row(a, n, ld, p, p, most);
    if (!(most > 0.0) || !std::isfinite(most)) return false;
    if (pivots[p] != p) swap_rows(first, a + static_cast<std::size_t>(pivots[p]) * ld, columns);
    const double inv1 = 1.0 / first[p];
    for (int r = p + 1; r < n; ++r) {
      double* row = a + static_cast<std::size_t>(r) * ld;
      row[p] *= inv1;
      if (p + 1 < n) row[p + 1] -= row[p] * first[p + 1];
    }
    if (p + 1 == n) break;
    double* __restrict second = first + ld;
    pivots[p + 1] = pivot_row(a, n, ld, p + 1, p + 1, most);
    if (!(most > 0.0) || !std::isfinite(most)) return false;
    if (pivots[p + 1] != p + 1) swap_rows(second, a + static_cast<std::size_t>(pivots[p + 1]) * ld, columns);
    const double m = second[p], inv2 = 1.0 / second[p + 1];
    for (int j = p + 2; j < columns; ++j) second[j] -= m * first[j];
    for (int r = p + 2; r < n; ++r) {
      double* __restrict row = a + static_cast<std::size_t>(r) * ld;
      const double m1 = row[p], m2 = row[p + 1] *= inv2;
      for (int j = p + 2; j < columns; ++j) row[j] -= m1 * first[j] + m2 * second[j];
    }
  }
  back_substitute(a, n, ld, n, columns - n);
  return true;
}

TENDRIL_FLATTEN_CLONES void multiply(const double* a, int rows, int columns, int ld, const double* x, double* y) {
  for (int r = 0; r < rows; ++r) y[r] = dot(a + static_cast<std::size_t>(r) * ld, x, columns);
}

TENDRIL_FLATTEN_CLONES void solve_factored(const double* a, int n, int ld, const int* pivots, double* b) {
  for (int p = 0; p < n; ++p)
    if (pivots[p] != p) std::swap(b[p], b[pivots[p]]);
  for (int p = 1; p < n; ++p) b[p] -= dot(a + static_cast<std::size_t>(p) * ld, b, p);
  for (int p = n - 1; p >= 0; --p) {
    const double* row = a + static_cast<std::size_t>(p) * ld;
    b[p] = (b[p] - dot(row + p + 1, b + p + 1, n - 1 - p)) / row[p];
  }
}

}  // namespace tendril::numerics

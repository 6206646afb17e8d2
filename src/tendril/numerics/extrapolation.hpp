#pragma once
// Initial value problems y' = f(x, y) by Gragg's smoothed midpoint rule extrapolated in h² (Bulirsch and Stoer; Hairer,
// Norsett & Wanner I, II.9), order up to 18, the error controlled step by step. Works over any scalar: dual numbers
// give the derivatives of the solution with respect to whatever they carry; the values alone control the steps.

#include <algorithm>
#include <array>
#include <cmath>

#include "tendril/numerics/dual.hpp"

namespace tendril::numerics {

struct IntegrationOptions {
  double tolerance = 1e-13;   // estimated error of a step <= tolerance (1 + |y|), every component
  double first_step = 0.05;   // of |x1 - x0|
  double least_step = 1e-10;  // of |x1 - x0|: below it the solution is taken to have a singularity
  int max_steps = 100000;
};

struct IntegrationSummary {
  bool completed = false;
  const char* reason = "";  // when not completed
  double reached = 0.0;     // x
  int steps = 0;
};

/// Advances y from x0 to x1. `f(x, y, slope)` returns false where it is not defined (the step is then shortened).
template <class T, std::size_t n, class F>
IntegrationSummary integrate(const F& f, double x0, double x1, std::array<T, n>& y,
                             const IntegrationOptions& options = {}) {
  using State = std::array<T, n>;
  constexpr int columns = 9, aim = 7;  // the step aims at convergence in the row `aim`
  IntegrationSummary sum;
  sum.reached = x0;
  const double length = x1 - x0;
  if (length == 0.0) {
    sum.completed = true;
    return sum;
  }
  double h = options.first_step * length;
  std::array<State, columns> table;
  State slope, a, b, k;
  while (sum.steps < options.max_steps) {
    const bool last = std::abs(h) >= std::abs(x1 - sum.reached) * (1.0 - 1e-12);
    if (last) h = x1 - sum.reached;
    ++sum.steps;
    bool defined = f(sum.reached, y, slope), accepted = false;
    double factor = 0.25;
    for (int row = 0; row < columns && defined; ++row) {
      const int parts = 2 * (row + 1);
      const double w = h / parts;
      a = y;
      for (std::size_t i = 0; i < n; ++i) b[i] = y[i] + w * slope[i];
      for (int m = 1; m < parts && defined; ++m) {
        defined = f(sum.reached + m * w, b, k);
        for (std::size_t i = 0; i < n; ++i) {
          const T next = a[i] + (2.0 * w) * k[i];
          a[i] = b[i];
          b[i] = next;
        }
      }
      defined = defined && f(sum.reached + h, b, k);
      if (!defined) break;
      // T_(row, 0), then Aitken-Neville in h²; table[j] holds the last row's entry of column j
      State entry;
      for (std::size_t i = 0; i < n; ++i) entry[i] = 0.5 * (a[i] + b[i] + w * k[i]);
      double error = HUGE_VAL;
      for (int column = 1; column <= row; ++column) {
        const double ratio = double(row + 1) / (row + 1 - column), q = 1.0 / (ratio * ratio - 1.0);
        State better;
        for (std::size_t i = 0; i < n; ++i) better[i] = entry[i] + q * (entry[i] - table[column - 1][i]);
        if (column == row) {
          error = 0.0;
          for (std::size_t i = 0; i < n; ++i) {
            const double e = std::abs(value(better[i]) - value(entry[i])) / (1.0 + std::abs(value(y[i])));
            error = std::isfinite(e) ? std::max(error, e) : HUGE_VAL;
          }
        }
        table[column - 1] = entry;
        entry = better;
      }
      table[row] = entry;
      if (row >= 3 && error <= options.tolerance) {
        y = entry;
        accepted = true;
        factor = row < aim ? std::min(2.0, 1.0 + 0.25 * (aim - row)) : row == aim ? 1.0 : 0.8;
        break;
      }
      if (row == columns - 1 && std::isfinite(error))
        factor = std::clamp(0.8 * std::pow(options.tolerance / error, 1.0 / (2 * row + 1)), 0.1, 0.7);
    }
    if (accepted) {
      sum.reached = last ? x1 : sum.reached + h;
      if (last) {
        sum.completed = true;
        return sum;
      }
    }
    h *= factor;
    if (std::abs(h) < options.least_step * std::abs(length)) {
      sum.reason = "the step has become too small: the solution leaves the domain or blows up";
      return sum;
    }
  }
  sum.reason = "too many steps";
  return sum;
}

}  // namespace tendril::numerics

#pragma once
// A contact-free stretch that hardly leaves the wall, in wall coordinates: the angle β of the section's eccentricity
// and its normal offset n = |δ| - Q in place of δ1 and δ2, with the same orders; all other inputs are those of the
// contact-free form. A rod that opens over a length l leaves the wall by l⁴, soon less than the last digit of δ: the
// offset keeps all its digits, and "n = n' = n'' = 0 at the end" is exact. Complex: δ1 + i δ2 = (Q + n) exp(iβ).
// Singular where |δ| = 0.

#include <array>
#include <cmath>

#include "tendril/formulation/free_rod.hpp"

namespace tendril::formulation {

struct NearWall {
  /// Places of β and n, each with its derivatives, in the inputs.
  static constexpr int angle = 0, offset = 4;

  /// Parts of δ and its derivatives along exp(iβ) and i exp(iβ).
  template <class T>
  struct Parts {
    std::array<T, 4> along, across;
  };

  /// `count` - 1 derivatives; rho: |δ| = Q + n and its derivatives.
  template <int count, class T>
  static Parts<T> parts(const std::array<T, 4>& rho, const T* b) {
    Parts<T> p;
    p.along[0] = rho[0];
    p.across[0] = T(0.0);
    p.along[1] = rho[1];
    p.across[1] = rho[0] * b[1];
    p.along[2] = rho[2] - rho[0] * b[1] * b[1];
    p.across[2] = 2.0 * (rho[1] * b[1]) + rho[0] * b[2];
    if constexpr (count > 3) {
      p.along[3] = rho[3] - 3.0 * (rho[1] * b[1] * b[1]) - 3.0 * (rho[0] * b[1] * b[2]);
      p.across[3] = 3.0 * (rho[2] * b[1]) + 3.0 * (rho[1] * b[2]) + rho[0] * b[3] - rho[0] * b[1] * b[1] * b[1];
    }
    return p;
  }

  /// δ1 and δ2 with `count` - 1 derivatives, d[stride] apart, from β and n.
  template <int count, class T>
  static void eccentricity(const std::array<T, 4>& Q, const T* b, const T* n, T* d1, T* d2) {
    using std::cos;
    using std::sin;
    std::array<T, 4> rho = Q;
    for (int j = 0; j < count; ++j) rho[j] = rho[j] + n[j];
    const Parts<T> p = parts<count>(rho, b);
    const T c = cos(b[0]), s = sin(b[0]);
    for (int j = 0; j < count; ++j) {
      d1[j] = p.along[j] * c - p.across[j] * s;
      d2[j] = p.along[j] * s + p.across[j] * c;
    }
  }
};

/// Inputs (17) in the contact-free form of inputs in wall coordinates, in place.
void wall_to_free(const Section& s, double* u);
/// The other way; β is chosen within π of `near`.
void free_to_wall(const Section& s, double near, double* u);
/// jac (row-major, `rows` x (inputs + 2)) with respect to contact-free inputs becomes the one with respect to the wall
/// coordinates u; the last two columns are d/dS and d/dp.
void wall_columns(const Section& s, const double* u, int rows, double* jac);

}  // namespace tendril::formulation

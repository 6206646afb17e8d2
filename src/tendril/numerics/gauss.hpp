#pragma once
// Gauss-Legendre collocation tables on [0,1] for the Runge-Kutta monomial basis (Ascher, Mattheij & Russell, ch. 5):
// Lagrange polynomials at the k Gauss points and their repeated integrals at the points, at 1 and at any place.

#include <array>
#include <vector>

#include "tendril/numerics/pack.hpp"

namespace tendril::numerics {

constexpr int max_points = 7;  // k = 4..7
constexpr int max_order = 3;   // highest derivative collocated

struct GaussTable {
  int k = 0;
  std::array<double, max_points> c{};  // Gauss points in (0,1)
  std::array<double, max_points> b{};  // weights, sum 1
  // integral[p][g][l]: p-fold integral from 0 of the l-th Lagrange polynomial at c[g] (p = 0: identity)
  std::array<std::array<std::array<double, max_points>, max_points>, max_order + 1> integral{};
  // at_one[p][l]: the same at 1
  std::array<std::array<double, max_points>, max_order + 1> at_one{};
  // the same with the points or the polynomials side by side, unused lanes 0
  Pack c_pack;
  std::array<std::array<Pack, max_points>, max_order + 1> over_polynomials;  // [p][g], lanes l
  std::array<std::array<Pack, max_points>, max_order + 1> over_points;       // [p][l], lanes g
  // legendre_integral[p]: max over [0,1] of |p-fold integral of the shifted Legendre polynomial P_k|
  std::array<double, max_order + 1> legendre_integral{};
  // monomial coefficients of the Lagrange polynomials, lagrange[l][m] of x^m
  std::array<std::array<double, max_points>, max_points> lagrange{};

  /// p-fold integrals of all Lagrange polynomials at x in [0,1]: out[l]
  void basis(int p, double x, double* out) const;
};

/// Table for k = 4..7 (immutable, built once).
const GaussTable& gauss_table(int k);

}  // namespace tendril::numerics

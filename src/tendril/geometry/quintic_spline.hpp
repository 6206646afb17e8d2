#pragma once
// Interpolating spline of degree five with four continuous derivatives (order 6, not-a-knot ends) through n values at
// ascending nodes, one or more components at a time; fewer than six nodes give the polynomial of degree n - 1. Linear
// cost in n: the B-spline collocation matrix is banded and totally positive, so elimination needs no pivoting
// (de Boor, A Practical Guide to Splines, ch. XIII). Stored as Taylor coefficients of each piece at its left end.

#include <array>
#include <cstddef>
#include <vector>

namespace tendril::geometry {

/// Piecewise polynomial of degree 5 with `Dim` components.
template <int Dim>
struct PiecewiseQuintic {
  using Piece = std::array<std::array<double, Dim>, 6>;  // value = Σ piece[j] x^j, x measured from the piece's left end

  std::vector<double> breaks;  // pieces + 1, ascending
  std::vector<Piece> pieces;

  /// Piece that holds t (right-hand piece at a break; end pieces beyond the ends).
  std::size_t piece_of(double t) const;
  /// Value and five derivatives at t.
  Piece derivatives(double t) const;
};

/// Value and five derivatives of a piece at x from its left end.
template <int Dim>
typename PiecewiseQuintic<Dim>::Piece piece_derivatives(const typename PiecewiseQuintic<Dim>::Piece& a, double x) {
  typename PiecewiseQuintic<Dim>::Piece d;
  for (int c = 0; c < Dim; ++c) {
    const double a0 = a[0][c], a1 = a[1][c], a2 = a[2][c], a3 = a[3][c], a4 = a[4][c], a5 = a[5][c];
    d[0][c] = a0 + x * (a1 + x * (a2 + x * (a3 + x * (a4 + x * a5))));
    d[1][c] = a1 + x * (2 * a2 + x * (3 * a3 + x * (4 * a4 + x * 5 * a5)));
    d[2][c] = 2 * a2 + x * (6 * a3 + x * (12 * a4 + x * 20 * a5));
    d[3][c] = 6 * a3 + x * (24 * a4 + x * 60 * a5);
    d[4][c] = 24 * a4 + x * 120 * a5;
    d[5][c] = 120 * a5;
  }
  return d;
}

/// The interpolant. `nodes` strictly ascending and finite, at least two; values[i] belongs to nodes[i].
template <int Dim>
PiecewiseQuintic<Dim> interpolate_quintic(const std::vector<double>& nodes,
                                          const std::vector<std::array<double, Dim>>& values);

/// Spline with given interior knots (ascending), interpolating at as many sites as it has coefficients
/// (knots + 6), which must interlace with the knots (Schoenberg-Whitney). The ends are those of the sites.
template <int Dim>
PiecewiseQuintic<Dim> interpolate_quintic(const std::vector<double>& interior_knots, const std::vector<double>& sites,
                                          const std::vector<std::array<double, Dim>>& values);

/// Smoothest spline (least weighted sum of squared third-derivative coefficients, a close upper bound of the integral
/// of the squared third derivative) that stays within `tolerance` > 0 of every value
/// (Euclidean); the interpolant itself if none does.
template <int Dim>
PiecewiseQuintic<Dim> smooth_quintic(const std::vector<double>& nodes,
                                     const std::vector<std::array<double, Dim>>& values, double tolerance);

}  // namespace tendril::geometry

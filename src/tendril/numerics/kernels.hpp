#pragma once
// Dense inner kernels on raw arrays. Each is compiled for the baseline and for wider vector units; the choice is made
// once when the program is loaded, so results on one machine do not depend on threads or order.

namespace tendril::numerics {

/// row[j] -= m * pivot[j], j < n
void subtract_multiple(double* row, const double* pivot, double m, int n);

/// Gaussian elimination with partial pivoting of the n leading columns of an n x columns row-major array (leading
/// dimension ld), applied to all columns; afterwards columns n.. hold the solution of A X = B, the leading block its LU
/// factors. pivots[i] is the row exchanged with row i. False if singular.
bool factor_and_solve(double* a, int n, int columns, int ld, int* pivots);

/// y = A x of a rows x columns row-major array.
void multiply(const double* a, int rows, int columns, int ld, const double* x, double* y);

/// Solve with the factors left by factor_and_solve, one right-hand side in place.
void solve_factored(const double* a, int n, int ld, const int* pivots, double* b);

}  // namespace tendril::numerics

#pragma once
// Complete elliptic integrals and Jacobi's functions for the elastica on a plane and on a sphere. The last argument is
// always the PARAMETER m = k^2 (the standard library and Boost take the modulus k), 0 <= m < 1.
// Sources: arithmetic-geometric mean and descending Landen chain, DLMF 19.8 and 22.20; Carlson's forms,
// DLMF 19.25, 19.36.

namespace tendril::closed_form {

/// K(m) = ∫ dθ / √(1 - m sin²θ) over a quarter period.
double complete_k(double m);
/// E(m) = ∫ √(1 - m sin²θ) dθ over a quarter period; m = 1 allowed.
double complete_e(double m);
/// Π(n|m) = ∫ dθ / ((1 - n sin²θ) √(1 - m sin²θ)) over a quarter period, n < 1 (negative n included).
double complete_pi(double n, double m);

struct Jacobi {
  double sn, cn, dn;
};
/// sn, cn, dn of argument u; m = 1 allowed (tanh, sech, sech).
Jacobi jacobi(double u, double m);

}  // namespace tendril::closed_form

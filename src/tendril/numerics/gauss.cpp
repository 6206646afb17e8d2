#include "tendril/numerics/gauss.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tendril::numerics {
namespace {

/// Legendre polynomial P_n and its derivative at t in (-1,1).
std::array<long double, 2> legendre(int n, long double t) {
  long double p0 = 1, p1 = t;
  for (int j = 2; j <= n; ++j) {
    const long double p2 = ((2 * j - 1) * t * p1 - (j - 1) * p0) / j;
    p0 = p1;
    p1 = p2;
  }
  return {p1, n * (p0 - t * p1) / (1 - t * t)};
}

GaussTable build(int k) {
  GaussTable g;
  g.k = k;
  std::array<long double, max_points> x{};
  for (int i = 0; i < k; ++i) {
    long double t = -std::cos(M_PIl * (i + 0.75L) / (k + 0.5L));
    for (int it = 0; it < 50; ++it) {
      const auto [p, dp] = legendre(k, t);
      t -= p / dp;
    }
    const long double dp = legendre(k, t)[1];
    x[i] = 0.5L * (1 + t);
    g.c[i] = static_cast<double>(x[i]);
    g.b[i] = static_cast<double>(1.0L / ((1 - t * t) * dp * dp));
  }
  // Lagrange polynomials in monomials, then integrate term by term (k <= 7: long double keeps full precision)
  std::array<std::array<long double, max_points>, max_points> coef{};
  for (int l = 0; l < k; ++l) {
    std::array<long double, max_points + 1> poly{};
    poly[0] = 1;
    int degree = 0;
    for (int j = 0; j < k; ++j) {
      if (j == l) continue;
      const long double s = 1 / (x[l] - x[j]);
      for (int m = degree + 1; m >= 0; --m) poly[m] = ((m > 0 ? poly[m - 1] : 0) - x[j] * poly[m]) * s;
      ++degree;
    }
    for (int m = 0; m < k; ++m) {
      coef[l][m] = poly[m];
      g.lagrange[l][m] = static_cast<double>(poly[m]);
    }
  }
  auto integral = [&](int p, int l, long double at) {
    long double sum = 0;
    for (int m = k - 1; m >= 0; --m) {
      long double f = coef[l][m];
      for (int q = 1; q <= p; ++q) f /= m + q;
      sum = sum * at + f;
    }
    for (int q = 0; q < p; ++q) sum *= at;
    return sum;
  };
  for (int p = 0; p <= max_order; ++p)
    for (int l = 0; l < k; ++l) {
      for (int q = 0; q < k; ++q)
        g.integral[p][q][l] = p == 0 ? (q == l ? 1.0 : 0.0) : static_cast<double>(integral(p, l, x[q]));
      g.at_one[p][l] = static_cast<double>(integral(p, l, 1.0L));
    }
  g.c_pack = Pack(0.0);
  for (int q = 0; q < k; ++q) g.c_pack.set(q, g.c[q]);
  for (int p = 0; p <= max_order; ++p)
    for (int q = 0; q < max_points; ++q) {
      g.over_polynomials[p][q] = g.over_points[p][q] = Pack(0.0);
      for (int l = 0; l < k; ++l) {
        g.over_polynomials[p][q].set(l, g.integral[p][q][l]);
        g.over_points[p][q].set(l, g.integral[p][l][q]);
      }
    }
  // largest value of the repeated integrals of P_k(2x-1): coefficients by the recurrence in monomials of x
  std::array<long double, max_points + 1> p0{}, p1{};
  p0[0] = 1;
  p1[0] = -1;
  p1[1] = 2;
  for (int j = 2; j <= k; ++j) {
    std::array<long double, max_points + 1> p2{};
    for (int m = 0; m <= j; ++m) p2[m] = ((2 * j - 1) * ((m > 0 ? 2 * p1[m - 1] : 0) - p1[m]) - (j - 1) * p0[m]) / j;
    p0 = p1;
    p1 = p2;
  }
  for (int p = 0; p <= max_order; ++p) {
    long double most = 0;
    for (int i = 0; i <= 400; ++i) {
      const long double at = i / 400.0L;
      long double sum = 0;
      for (int m = k; m >= 0; --m) {
        long double f = p1[m];
        for (int q = 1; q <= p; ++q) f /= m + q;
        sum = sum * at + f;
      }
      for (int q = 0; q < p; ++q) sum *= at;
      most = std::max(most, std::abs(sum));
    }
    g.legendre_integral[p] = static_cast<double>(most);
  }
  return g;
}

}  // namespace

void GaussTable::basis(int p, double x, double* out) const {
  for (int l = 0; l < k; ++l) {
    double sum = 0;
    for (int m = k - 1; m >= 0; --m) {
      double f = lagrange[l][m];
      for (int q = 1; q <= p; ++q) f /= m + q;
      sum = sum * x + f;
    }
    for (int q = 0; q < p; ++q) sum *= x;
    out[l] = sum;
  }
}

const GaussTable& gauss_table(int k) {
  static const std::array<GaussTable, 4> tables{build(4), build(5), build(6), build(7)};
  assert(k >= 4 && k <= 7);
  return tables[k - 4];
}

}  // namespace tendril::numerics

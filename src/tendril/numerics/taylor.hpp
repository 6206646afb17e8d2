#pragma once
// Truncated Taylor polynomials in two variables: every partial derivative of f(u, v) up to the total order D, carried
// through arithmetic exactly. Coefficient (i, j) is the derivative divided by i! j!.

#include <array>
#include <cmath>

namespace tendril::numerics {

template <int D>
struct Taylor2 {
  static constexpr int size = (D + 1) * (D + 2) / 2;
  /// Place of the coefficient of u^i v^j: by total order, then by j.
  static constexpr int at(int i, int j) { return (i + j) * (i + j + 1) / 2 + j; }

  std::array<double, size> c{};

  Taylor2() = default;
  Taylor2(double value) { c[0] = value; }  // NOLINT: a number is a constant
  static Taylor2 u(double value) {
    Taylor2 x(value);
    if constexpr (D > 0) x.c[at(1, 0)] = 1.0;
    return x;
  }
  static Taylor2 v(double value) {
    Taylor2 x(value);
    if constexpr (D > 0) x.c[at(0, 1)] = 1.0;
    return x;
  }
  /// The partial derivative itself.
  double derivative(int i, int j) const {
    double f = c[at(i, j)];
    for (int n = 2; n <= i; ++n) f *= n;
    for (int n = 2; n <= j; ++n) f *= n;
    return f;
  }

  friend Taylor2 operator+(Taylor2 a, const Taylor2& b) {
    for (int n = 0; n < size; ++n) a.c[n] += b.c[n];
    return a;
  }
  friend Taylor2 operator-(Taylor2 a, const Taylor2& b) {
    for (int n = 0; n < size; ++n) a.c[n] -= b.c[n];
    return a;
  }
  friend Taylor2 operator-(Taylor2 a) {
    for (double& x : a.c) x = -x;
    return a;
  }
  friend Taylor2 operator*(const Taylor2& a, const Taylor2& b) {
    Taylor2 r;
    for (int p = 0; p <= D; ++p)
      for (int j = 0; j <= p; ++j)
        for (int q = 0; q + p <= D; ++q)
          for (int k = 0; k <= q; ++k) r.c[at(p - j + q - k, j + k)] += a.c[at(p - j, j)] * b.c[at(q - k, k)];
    return r;
  }
  friend Taylor2 operator*(double a, Taylor2 b) {
    for (double& x : b.c) x *= a;
    return b;
  }
  friend Taylor2 operator*(const Taylor2& a, double b) { return b * a; }
  friend Taylor2 operator/(const Taylor2& a, double b) { return (1.0 / b) * a; }
  friend Taylor2 operator/(const Taylor2& a, const Taylor2& b) {
    std::array<double, D + 1> f;  // of 1/x at b, divided by n!
    f[0] = 1.0 / b.c[0];
    for (int n = 1; n <= D; ++n) f[n] = -f[n - 1] / b.c[0];
    return a * b.compose(f);
  }

  /// f(x) from the Taylor coefficients of f at the value of x (Horner in the part without constant).
  Taylor2 compose(const std::array<double, D + 1>& f) const {
    Taylor2 h = *this;
    h.c[0] = 0.0;
    Taylor2 r(f[D]);
    for (int n = D - 1; n >= 0; --n) {
      r = r * h;
      r.c[0] += f[n];
    }
    return r;
  }
};

namespace detail {
/// Coefficients of sin (phase 0) or cos (phase 1) at x.
template <int D>
std::array<double, D + 1> sine_series(double x, int phase) {
  const std::array<double, 4> cycle{std::sin(x), std::cos(x), -std::sin(x), -std::cos(x)};
  std::array<double, D + 1> f;
  double factorial = 1.0;
  for (int n = 0; n <= D; ++n) {
    if (n > 0) factorial *= n;
    f[n] = cycle[(n + phase) % 4] / factorial;
  }
  return f;
}
}  // namespace detail

template <int D>
Taylor2<D> sin(const Taylor2<D>& x) {
  return x.compose(detail::sine_series<D>(x.c[0], 0));
}
template <int D>
Taylor2<D> cos(const Taylor2<D>& x) {
  return x.compose(detail::sine_series<D>(x.c[0], 1));
}
template <int D>
Taylor2<D> exp(const Taylor2<D>& x) {
  std::array<double, D + 1> f;
  f[0] = std::exp(x.c[0]);
  for (int n = 1; n <= D; ++n) f[n] = f[n - 1] / n;
  return x.compose(f);
}
/// x to a constant real power, x > 0.
template <int D>
Taylor2<D> pow(const Taylor2<D>& x, double power) {
  std::array<double, D + 1> f;
  f[0] = std::pow(x.c[0], power);
  for (int n = 1; n <= D; ++n) f[n] = f[n - 1] * (power - (n - 1)) / (n * x.c[0]);
  return x.compose(f);
}
template <int D>
Taylor2<D> sqrt(const Taylor2<D>& x) {
  return pow(x, 0.5);
}

}  // namespace tendril::numerics

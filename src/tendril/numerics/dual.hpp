#pragma once
// Forward dual numbers: a value and its N partial derivatives, carried through arithmetic exactly. N is fixed at
// compile time so that the derivative loops unroll and vectorise; the partials are reals R, one number or several side
// by side (pack.hpp). Nesting (Jet<Dual<N>>) gives derivatives of derivatives.

#include <array>
#include <cmath>
#include <type_traits>

namespace tendril::numerics {

template <int N, class R = double>
struct Dual {
  R v = 0.0;
  std::array<R, N> d{};

  /// f(i) for every partial; a loop stays a loop where each turn is wide enough by itself.
  template <class F>
  static void each(const F& f) {
    if constexpr (std::is_same_v<R, double>) {
      for (int i = 0; i < N; ++i) f(i);
    } else {
#pragma GCC unroll 1
      for (int i = 0; i < N; ++i) f(i);
    }
  }

  Dual() = default;
  Dual(double value) : v(value) {}  // NOLINT: a number is a constant
  explicit Dual(const R& value) requires(!std::is_same_v<R, double>) : v(value) {}
  static Dual seed(const R& value, int index, double slope = 1.0) {
    Dual x(value);
    x.d[index] = slope;
    return x;
  }

  Dual& operator+=(const Dual& b) {
    v += b.v;
    each([&](int i) { d[i] += b.d[i]; });
    return *this;
  }
  Dual& operator-=(const Dual& b) {
    v -= b.v;
    each([&](int i) { d[i] -= b.d[i]; });
    return *this;
  }
  friend Dual operator+(Dual a, const Dual& b) { return a += b; }
  friend Dual operator-(Dual a, const Dual& b) { return a -= b; }
  friend Dual operator+(Dual a, double b) {
    a.v += b;
    return a;
  }
  friend Dual operator+(double b, Dual a) {
    a.v += b;
    return a;
  }
  friend Dual operator-(Dual a, double b) {
    a.v -= b;
    return a;
  }
  friend Dual operator-(double b, const Dual& a) {
    Dual r;
    r.v = b - a.v;
    each([&](int i) { r.d[i] = -a.d[i]; });
    return r;
  }
  friend Dual operator-(const Dual& a) { return 0.0 - a; }
  friend Dual operator*(const Dual& a, const Dual& b) {
    Dual r;
    r.v = a.v * b.v;
    each([&](int i) { r.d[i] = a.v * b.d[i] + b.v * a.d[i]; });
    return r;
  }
  friend Dual operator*(Dual a, double b) {
    a.v *= b;
    each([&](int i) { a.d[i] *= b; });
    return a;
  }
  friend Dual operator*(double b, const Dual& a) { return a * b; }
  // by a real that is not a plain number
  friend Dual operator*(Dual a, const R& b) requires(!std::is_same_v<R, double>) {
    a.v *= b;
    each([&](int i) { a.d[i] *= b; });
    return a;
  }
  friend Dual operator*(const R& b, const Dual& a) requires(!std::is_same_v<R, double>) { return a * b; }
  friend Dual operator+(const R& b, Dual a) requires(!std::is_same_v<R, double>) {
    a.v += b;
    return a;
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const R q = 1.0 / b.v, f = a.v * q;
    Dual r;
    r.v = f;
    each([&](int i) { r.d[i] = (a.d[i] - f * b.d[i]) * q; });
    return r;
  }
  friend Dual operator/(const Dual& a, double b) { return a * (1.0 / b); }
  friend Dual operator/(double a, const Dual& b) {
    const R f = a / b.v;
    return b.chain(f, -f / b.v);
  }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  Dual& operator/=(const Dual& b) { return *this = *this / b; }

  /// f(x) for a scalar function with value f and slope df at x.v.
  Dual chain(const R& f, const R& df) const {
    Dual r;
    r.v = f;
    each([&](int i) { r.d[i] = df * d[i]; });
    return r;
  }
};

template <int N, class R>
Dual<N, R> sqrt(const Dual<N, R>& x) {
  using std::sqrt;
  const R f = sqrt(x.v);
  return x.chain(f, 0.5 / f);
}
template <int N, class R>
Dual<N, R> sin(const Dual<N, R>& x) {
  using std::cos;
  using std::sin;
  return x.chain(sin(x.v), cos(x.v));
}
template <int N, class R>
Dual<N, R> cos(const Dual<N, R>& x) {
  using std::cos;
  using std::sin;
  return x.chain(cos(x.v), -sin(x.v));
}
template <int N>
Dual<N> atan2(const Dual<N>& y, const Dual<N>& x) {
  const double r = 1.0 / (x.v * x.v + y.v * y.v);
  Dual<N> a(std::atan2(y.v, x.v));
  for (int i = 0; i < N; ++i) a.d[i] = (x.v * y.d[i] - y.v * x.d[i]) * r;
  return a;
}

inline double value(double x) { return x; }
template <int N>
double value(const Dual<N>& x) {
  return x.v;
}

/// Value and total derivative along one direction (here: along the curve), over any inner scalar.
template <class T>
struct Jet {
  T v{}, d{};
  Jet() = default;
  Jet(double value) : v(value), d(0.0) {}  // NOLINT
  Jet(const T& value, const T& slope) : v(value), d(slope) {}
  friend Jet operator+(const Jet& a, const Jet& b) { return {a.v + b.v, a.d + b.d}; }
  friend Jet operator-(const Jet& a, const Jet& b) { return {a.v - b.v, a.d - b.d}; }
  friend Jet operator-(const Jet& a) { return {-a.v, -a.d}; }
  friend Jet operator*(const Jet& a, const Jet& b) { return {a.v * b.v, a.v * b.d + a.d * b.v}; }
  friend Jet operator*(double a, const Jet& b) { return {a * b.v, a * b.d}; }
  friend Jet operator*(const Jet& a, double b) { return {b * a.v, b * a.d}; }
  friend Jet operator/(const Jet& a, const Jet& b) {
    const T q = a.v / b.v;
    return {q, (a.d - q * b.d) / b.v};
  }
  friend Jet operator+(const Jet& a, double b) { return {a.v + b, a.d}; }
  friend Jet operator+(double b, const Jet& a) { return {a.v + b, a.d}; }
  friend Jet operator-(double b, const Jet& a) { return {b - a.v, -a.d}; }
  friend Jet operator-(const Jet& a, double b) { return {a.v - b, a.d}; }
  friend Jet operator/(double b, const Jet& a) { return Jet(b) / a; }
  Jet& operator+=(const Jet& b) { return *this = *this + b; }
  Jet& operator-=(const Jet& b) { return *this = *this - b; }
};
template <class T>
Jet<T> sqrt(const Jet<T>& x) {
  using std::sqrt;
  const T f = sqrt(x.v);
  return {f, 0.5 * (x.d / f)};
}
template <class T>
Jet<T> sin(const Jet<T>& x) {
  using std::cos;
  using std::sin;
  return {sin(x.v), cos(x.v) * x.d};
}
template <class T>
Jet<T> cos(const Jet<T>& x) {
  using std::cos;
  using std::sin;
  return {cos(x.v), -(sin(x.v) * x.d)};
}
template <class T>
double value(const Jet<T>& x) {
  return value(x.v);
}

}  // namespace tendril::numerics

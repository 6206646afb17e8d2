#include "tendril/closed_form/small_clearance.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "tendril/closed_form/columns.hpp"
#include "tendril/numerics/dual_newton.hpp"

namespace tendril::closed_form {
namespace {

/// w = A (1 - cos kx) + B (kx - sin kx) from the clamp to the contact at a, one component.
template <class T>
struct OuterSpan {
  T A, B, second, third;  // w'' and w''' at a
  OuterSpan(const T& k, const T& a, const T& place, const T& slope) {
    using std::cos;
    using std::sin;
    const T c = cos(k * a), s = sin(k * a), one = 1.0 - c, arc = k * a - s;
    const T det = k * (one * one - s * arc);
    A = (place * (k * one) - arc * slope) / det;
    B = (one * slope - (k * s) * place) / det;
    second = k * k * (A * c + B * s);
    third = k * k * k * (B * c - A * s);
  }
};

/// ∫ w'² over the span, A and B its amplitudes.
double stretched(double A, double B, double k, double a) {
  const double c = std::cos(k * a), s = std::sin(k * a), s2 = std::sin(2 * k * a);
  return k * k *
         (A * A * (a / 2 - s2 / (4 * k)) + 2 * A * B * ((1 - c) / k - s * s / (2 * k)) +
          B * B * (1.5 * a - 2 * s / k + s2 / (4 * k)));
}

/// The rod from the clamp to the middle with its outer contact at w = exp(-iθ), slope i q exp(-iθ). Conditions on it:
/// curvature continuous (two), no force around the tube (one).
template <class T>
struct Half {
  T k, a, b;
  OuterSpan<T> X, Y;
  T c1, c2, d1, d2;  // inside: X = x0 + c1 (cos ky - 1) + c2 (sin ky - ky), Y = d1 y + d2 sin ky, y <= 0
  T middle;          // X at y = 0
  std::array<T, 3> condition{};
  T outer;  // reaction
  Half(const T& push_root, const T& place, const T& theta, const T& q, bool touches)
      : k(push_root),
        a(place),
        b(0.5 - place),
        X(k, a, cosine(theta), q * sine(theta)),
        Y(k, a, -sine(theta), q * cosine(theta)) {
    const T C = cosine(k * b), S = sine(k * b), ct = cosine(theta), st = sine(theta);
    if (touches) {  // X(0) = 1 as well
      const T det = k * ((C - 1.0) * (C - 1.0) - S * (k * b - S));
      const T left = ct - 1.0, right = q * st;
      c1 = (left * (k * (C - 1.0)) - (k * b - S) * right) / det;
      c2 = ((C - 1.0) * right - (k * S) * left) / det;
      middle = T(1.0);
    } else {
      c1 = q * st / (k * S);
      c2 = T(0.0);
      middle = ct - c1 * (C - 1.0);
    }
    d2 = (st - q * b * ct) / (S - k * b * C);
    d1 = q * ct - d2 * k * C;
    const T x2 = k * k * (c2 * S - c1 * C), y2 = k * k * d2 * S;
    const T x3 = -(k * k * k * (c1 * S + c2 * C)), y3 = -(k * k * k * d2 * C);
    condition = {x2 - X.second, y2 - Y.second, (x3 - X.third) * st + (y3 - Y.third) * ct};
    outer = (y3 - Y.third) * st - (x3 - X.third) * ct;
  }
  static T cosine(const T& x) {
    using std::cos;
    return cos(x);
  }
  static T sine(const T& x) {
    using std::sin;
    return sin(x);
  }
};

SmallClearanceState described(const Half<double>& h, double theta) {
  SmallClearanceState s;
  s.found = true;
  s.push = h.k * h.k;
  s.place = h.a;
  s.turn = 2 * theta;
  s.outer = h.outer;
  s.middle = -2 * h.c2 * h.k * h.k * h.k;
  const double k = h.k, b = h.b, C = std::cos(k * b), S = std::sin(k * b), S2 = std::sin(2 * k * b);
  // X' = -c1 k sin ky + c2 k (cos ky - 1), Y' = d1 + d2 k cos ky over [-b, 0]
  const double x = k * k *
                   (h.c1 * h.c1 * (b / 2 - S2 / (4 * k)) + 2 * h.c1 * h.c2 * (S * S / (2 * k) - (1 - C) / k) +
                    h.c2 * h.c2 * (1.5 * b - 2 * S / k + S2 / (4 * k)));
  const double y = h.d1 * h.d1 * b + 2 * h.d1 * h.d2 * S + h.d2 * h.d2 * k * k * (b / 2 + S2 / (4 * k));
  s.slack = stretched(h.X.A, h.X.B, k, h.a) + stretched(h.Y.A, h.Y.B, k, h.a) + x + y;  // twice half of it
  return s;
}

// Starting values: the two-point state at 2.5 Euler loads, from which all others are reached.
constexpr std::array<double, 3> start{0.3649, 0.7954, 4.0};
constexpr double euler = 4 * std::numbers::pi * std::numbers::pi;

/// (a, θ, q) at this push, by steps of the push from the start.
bool reach(double push, bool touches, std::array<double, 3>& x) {
  const double from = (touches ? 3.0 : 2.5) * euler;
  const int steps = 1 + static_cast<int>(std::abs(push - from) / (0.05 * euler));
  for (int i = 0; i <= steps; ++i) {
    const double k = std::sqrt(from + (push - from) * i / steps);
    const auto f = [&](const auto& u, auto& r) {
      using T = std::decay_t<decltype(u[0])>;
      r = Half<T>(T(k), u[0], u[1], u[2], touches).condition;
      return true;
    };
    if (!numerics::solve_dual_newton<3>(f, x).converged) return false;
  }
  return true;
}

}  // namespace

SmallClearanceState planar_point(double push) {
  const double k = std::sqrt(push);
  const OuterSpan<double> span(k, 0.5, 1.0, 0.0);
  SmallClearanceState s;
  s.found = true;
  s.push = push;
  s.outer = 2 * span.third;  // the jump of w''' pushes inwards
  s.slack = stretched(span.A, span.B, k, 0.5);
  return s;
}

SmallClearanceState spatial_point_splits() {
  const double push = euler_load_clamped(2, 1.0, 1.0), k = std::sqrt(push);
  SmallClearanceState s = planar_point(push);
  const OuterSpan<double> x(k, 0.5, 1.0, 0.0);
  // sideways w = y' times the mode with a node at the contact; the gap 1 - |δ| stays least there while x'' + y'² <= 0
  const double slope = std::sqrt(-x.second);
  const double c = std::cos(0.5 * k), sn = std::sin(0.5 * k);
  const double B = slope / (k * (1 - c + sn * (sn - 0.5 * k) / (1 - c))), A = B * (sn - 0.5 * k) / (1 - c);
  s.slack += stretched(A, B, k, 0.5);
  return s;
}

SmallClearanceState two_points(double push) {
  std::array<double, 3> x = start;
  if (!reach(push, false, x)) return {};
  return described(Half<double>(std::sqrt(push), x[0], x[1], x[2], false), x[1]);
}

SmallClearanceState third_point_appears() {
  std::array<double, 3> x = start;
  if (!reach(2.95 * euler, false, x)) return {};
  std::array<double, 4> u{x[0], x[1], x[2], std::sqrt(2.95 * euler)};
  const auto f = [](const auto& v, auto& r) {
    using T = std::decay_t<decltype(v[0])>;
    const Half<T> h(v[3], v[0], v[1], v[2], false);
    r = {h.condition[0], h.condition[1], h.condition[2], h.middle - 1.0};
    return true;
  };
  if (!numerics::solve_dual_newton<4>(f, u).converged) return {};
  return described(Half<double>(u[3], u[0], u[1], u[2], false), u[1]);
}

SmallClearanceState three_points(double push) {
  std::array<double, 3> x = start;
  if (!reach(3.0 * euler, false, x) || !reach(push, true, x)) return {};
  return described(Half<double>(std::sqrt(push), x[0], x[1], x[2], true), x[1]);
}

}  // namespace tendril::closed_form

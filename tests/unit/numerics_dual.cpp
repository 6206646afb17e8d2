// Dual numbers and jets: every operation against its known derivative and against central differences, chains of all
// operations at once, and the two nested (derivatives of derivatives).
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tendril/numerics/dual.hpp"

namespace {

using tendril::numerics::Dual;
using tendril::numerics::Jet;
using tendril::numerics::value;

constexpr double rounding = 4e-15;   // a few operations on numbers below 5
constexpr double difference = 1e-9;  // fourth-order central differences at h = 1e-3: h^4 f^(5)/30 + eps/h

using D2 = Dual<2>;

double slope(const std::function<double(double)>& f, double x, double h = 1e-3) {
  return (8.0 * (f(x + h) - f(x - h)) - (f(x + 2 * h) - f(x - 2 * h))) / (12.0 * h);
}

/// f of two variables, at (x, y), on duals and on doubles.
template <class F>
void expect_partials(F f, double x, double y) {
  const D2 r = f(D2::seed(x, 0), D2::seed(y, 1));
  EXPECT_NEAR(r.v, f(x, y), rounding * (1 + std::abs(r.v)));
  EXPECT_NEAR(r.d[0], slope([&](double t) { return double(f(t, y)); }, x), difference * (1 + std::abs(r.d[0])));
  EXPECT_NEAR(r.d[1], slope([&](double t) { return double(f(x, t)); }, y), difference * (1 + std::abs(r.d[1])));
}

TEST(NumericsDual, EveryOperationAgreesWithDifferences) {
  using std::atan2;
  using std::cos;
  using std::sin;
  using std::sqrt;
  for (const auto& [x, y] : {std::pair{1.3, 0.7}, std::pair{-0.4, 2.1}, std::pair{2.2, -1.6}}) {
    SCOPED_TRACE(::testing::Message() << "x " << x << " y " << y);
    expect_partials([](auto a, auto b) { return a + b; }, x, y);
    expect_partials([](auto a, auto b) { return a - b; }, x, y);
    expect_partials([](auto a, auto b) { return a * b; }, x, y);
    expect_partials([](auto a, auto b) { return a / b; }, x, y);
    expect_partials([](auto a, auto b) { return -a + 2.0 * b; }, x, y);
    expect_partials([](auto a, auto b) { return (a + 2.5) - (1.5 + b); }, x, y);
    expect_partials([](auto a, auto b) { return (a - 2.5) * (1.5 - b); }, x, y);
    expect_partials([](auto a, auto b) { return (a * 3.0) + (b / 4.0); }, x, y);
    expect_partials([](auto a, auto b) { return 3.0 / a - 0.5 / (b * b); }, x, y);
    expect_partials([](auto a, auto b) { return sqrt(a * a + b * b); }, x, y);
    expect_partials([](auto a, auto b) { return sin(a) * cos(b); }, x, y);
    expect_partials([](auto a, auto b) { return cos(a * b); }, x, y);
    expect_partials([](auto a, auto b) { return atan2(a, b); }, x, y);
    expect_partials(
        [](auto a, auto b) {
          auto c = a;
          c += b;
          c *= a;
          c -= sin(b);
          c /= a * a + 1.0;
          return c;
        },
        x, y);
  }
}

TEST(NumericsDual, KnownDerivatives) {
  const double x = 0.83, y = -1.2;
  const D2 a = D2::seed(x, 0, 2.0), b = D2::seed(y, 1);  // d/d(x/2): slope 2
  EXPECT_NEAR((a * a * a).d[0], 2.0 * 3 * x * x, rounding);
  EXPECT_NEAR((1.0 / a).d[0], -2.0 / (x * x), rounding);
  EXPECT_NEAR((a / b).d[1], -x / (y * y), rounding);
  EXPECT_NEAR(sqrt(a).d[0], 1.0 / std::sqrt(x), rounding);
  EXPECT_NEAR(sin(b).d[1], std::cos(y), rounding);
  EXPECT_NEAR(cos(b).d[1], -std::sin(y), rounding);
  EXPECT_NEAR(atan2(a, b).d[0], 2.0 * y / (x * x + y * y), rounding);
  EXPECT_NEAR(atan2(a, b).d[1], -x / (x * x + y * y), rounding);
  EXPECT_EQ(atan2(a, b).v, std::atan2(x, y));  // the quadrant, too
  EXPECT_EQ((a + 1.0).d[1], 0.0);
  EXPECT_EQ(D2(3.0).d[0], 0.0);
  EXPECT_EQ(value(a), x);
}

TEST(NumericsJet, SlopeAlongALineIsTheDirectionalDerivative) {
  // the same function on a jet whose arguments move as x + 3 t, y - 2 t
  const auto f = [](auto x, auto y) {
    using std::cos;
    using std::sin;
    using std::sqrt;
    auto r = sqrt(1.0 + x * x) / (2.5 - cos(y)) + 3.0 / (x + 4.0) - sin(x * y) * 0.5;
    r += 2.0 * (x - 1.0) * (1.0 - y);
    r -= -x / 3.0 * y;
    return r;
  };
  using J = Jet<double>;
  const double x = 0.9, y = -0.6;
  const auto run = [&](auto X, auto Y) {
    // jets divide by a jet, not by a number: lift the constant
    using T = decltype(X);
    auto r = sqrt(1.0 + X * X) / (2.5 - cos(Y)) + 3.0 / (X + 4.0) - sin(X * Y) * 0.5;
    r += 2.0 * (X - 1.0) * (1.0 - Y);
    r -= -X / T(3.0) * Y;
    return r;
  };
  const J r = run(J{x, 3.0}, J{y, -2.0});
  EXPECT_NEAR(r.v, f(x, y), rounding);
  EXPECT_NEAR(r.d, slope([&](double t) { return f(x + 3 * t, y - 2 * t); }, 0.0), difference);
  EXPECT_EQ(value(r), r.v);
}

TEST(NumericsJet, NestedInDualsGivesMixedSecondDerivatives) {
  // f = sin(x y)/sqrt(1 + x²): the jet's slope is f_x, its dual parts are f_xx and f_xy
  const auto f = [](const auto& x, const auto& y) {
    using std::sin;
    using std::sqrt;
    return sin(x * y) / sqrt(1.0 + x * x);
  };
  using T = Dual<2>;
  using J = Jet<T>;
  const double x = 0.7, y = 1.9;
  const J r = f(J{T::seed(x, 0), T(1.0)}, J{T::seed(y, 1), T(0.0)});
  const double w = std::sqrt(1 + x * x), s = std::sin(x * y), c = std::cos(x * y);
  const double fx = y * c / w - x * s / (w * w * w);
  const double fxy = c / w - x * y * s / w - x * x * c / (w * w * w);
  const double fxx = -y * y * s / w - 2 * x * y * c / (w * w * w) - s / (w * w * w) + 3 * x * x * s / std::pow(w, 5);
  EXPECT_NEAR(r.v.v, s / w, rounding);
  EXPECT_NEAR(r.v.d[0], fx, rounding);
  EXPECT_NEAR(r.d.v, fx, rounding);
  EXPECT_NEAR(r.d.d[0], fxx, 4 * rounding);
  EXPECT_NEAR(r.d.d[1], fxy, 4 * rounding);
}

TEST(NumericsJet, JetOfJetGivesSecondDerivatives) {
  using J = Jet<Jet<double>>;
  const double x = 0.4;
  const J t{Jet<double>{x, 1.0}, Jet<double>{1.0, 0.0}};
  const J r = sqrt(cos(t) * cos(t) + 3.0 * sin(t));
  const auto g = [](double u) { return std::sqrt(std::cos(u) * std::cos(u) + 3 * std::sin(u)); };
  const double q = g(x), q2 = -2 * std::cos(x) * std::sin(x) + 3 * std::cos(x);
  const double q3 = -2 * std::cos(2 * x) - 3 * std::sin(x);
  EXPECT_NEAR(r.v.v, q, rounding);
  EXPECT_NEAR(r.d.v, 0.5 * q2 / q, rounding);
  EXPECT_NEAR(r.v.d, 0.5 * q2 / q, rounding);
  EXPECT_NEAR(r.d.d, 0.5 * q3 / q - 0.25 * q2 * q2 / (q * q * q), rounding);
}

}  // namespace

// The generic boundary value driver on problems with known solutions: order of convergence, unknown constants and
// lengths, several segments, periodic and coupled conditions, closures, meshes adapted to a tolerance.
#include <gtest/gtest.h>

#include <cmath>

#include "tendril/collocation/boundary_value_problem.hpp"

namespace {

using namespace tendril::collocation;

struct Bratu {  // u'' + p e^u = 0
  std::vector<int> order{2};
  int quadratures = 0;
  template <class T>
  void operator()(const T&, const T* u, const T& p, T* out) const {
    out[0] = u[2] + p * exp_of(u[0]);
  }
  static double exp_of(double x) { return std::exp(x); }
  template <int N>
  static tendril::numerics::Dual<N> exp_of(const tendril::numerics::Dual<N>& x) {
    const double e = std::exp(x.v);
    return x.chain(e, e);
  }
};

BoundaryValueProblem bratu(int k) {
  auto ends = make_conditions<4>(2, [](const auto* e, const auto&, auto* r) {
    r[0] = e[0];
    r[1] = e[2];
  });
  return {{std::make_shared<DualSystem<Bratu, 3>>(Bratu{})}, ends, k};
}

double bratu_theta(double p, bool upper) {  // θ = sqrt(2p) cosh(θ/4)
  double lo = upper ? 4 * 1.1996786402577339 : 0.0, hi = upper ? 40.0 : 4 * 1.1996786402577339;
  auto f = [&](double t) { return t - std::sqrt(2 * p) * std::cosh(t / 4); };
  for (int i = 0; i < 200; ++i) {
    const double m = 0.5 * (lo + hi);
    ((f(m) > 0) == (f(lo) > 0) ? lo : hi) = m;
  }
  return 0.5 * (lo + hi);
}

double bratu_exact(double theta, double x) {
  return -2 * std::log(std::cosh((x - 0.5) * theta / 2) / std::cosh(theta / 4));
}

double bratu_error(int k, int pieces) {
  auto b = bratu(k);
  b.initialise([](int, double, double* u, double*) { u[0] = u[1] = u[2] = 0.0; }, pieces);
  BvpOptions o;
  o.adapt = false;
  o.newton_tolerance = 1e-14;
  EXPECT_TRUE(b.solve(Closure::at(2.0), o).converged);
  const double theta = bratu_theta(2.0, false);
  double most = 0.0, u[3];
  for (int i = 0; i <= 200; ++i) {
    b.evaluate(0, i / 200.0, u, nullptr);
    most = std::max(most, std::abs(u[0] - bratu_exact(theta, i / 200.0)));
  }
  return most;
}

TEST(BoundaryValueProblem, ConvergesWithOrderKPlusTwoBetweenNodes) {
  const double coarse = bratu_error(4, 4), fine = bratu_error(4, 8);
  EXPECT_NEAR(std::log2(coarse / fine), 6.0, 0.5);  // a few pieces: not yet quite asymptotic
}

TEST(BoundaryValueProblem, AdaptsItsMeshToTheTolerance) {
  auto b = bratu(5);
  b.initialise([](int, double x, double* u, double*) { u[0] = 4 * x * (1 - x), u[1] = 4 - 8 * x, u[2] = -8; }, 2);
  BvpOptions o;
  o.tolerance = 1e-11;
  const auto s = b.solve(Closure::at(3.5), o);
  ASSERT_TRUE(s.converged) << s.reason;
  EXPECT_LE(s.error, 1e-11);
  const double theta = bratu_theta(3.5, false);
  double u[3];
  for (double x : {0.1, 0.33, 0.5, 0.77}) {
    b.evaluate(0, x, u, nullptr);
    EXPECT_NEAR(u[0], bratu_exact(theta, x), 3e-10);  // near the fold errors grow by some 10
  }
}

TEST(BoundaryValueProblem, ClosesWithAConditionOnTheEnds) {
  // the slope at the left end is prescribed, p follows: a state beyond the fold, where p alone is ambiguous
  auto b = bratu(7);
  const double theta = bratu_theta(2.0, true), slope = theta * std::tanh(theta / 4);
  b.initialise([&](int, double x, double* u,
                   double*) { u[0] = slope * x * (1 - x), u[1] = slope * (1 - 2 * x), u[2] = -2 * slope; },
               8);
  b.set_parameter(1.0);
  auto one = make_conditions<4>(1, [=](const auto* e, const auto&, auto* r) { r[0] = e[1] - slope; });
  const auto s = b.solve(Closure::where(one));
  ASSERT_TRUE(s.converged) << s.reason;
  EXPECT_NEAR(b.parameter(), 2.0, 1e-9);  // mesh tolerance 1e-10 times the condition of p on the slope
}

struct Oscillator {  // u'' = -λ² u with λ, and the integral of u², unknown
  std::vector<int> order{2, 1};
  int quadratures = 1;
  template <class T>
  void operator()(const T&, const T* u, const T& p, T* out) const {
    out[0] = u[2] + p * p * (u[3] * u[3] * u[0]);
    out[1] = u[4];
    out[2] = u[0] * u[0];
  }
};

TEST(BoundaryValueProblem, FindsAnUnknownConstantAndAQuadrature) {
  // the second eigenfunction of a string, normalised by the slope at the left end
  auto ends = make_conditions<8>(4, [](const auto* e, const auto&, auto* r) {
    r[0] = e[0], r[1] = e[1] - 1.0, r[2] = e[3];  // u, u', integral at the left end
    r[3] = e[4];                                  // u at the right end
  });
  BoundaryValueProblem b({std::make_shared<DualSystem<Oscillator, 5>>(Oscillator{})}, ends, 7);
  b.initialise(
      [](int, double x, double* u, double* q) {
        u[0] = std::sin(6 * x) / 6, u[1] = std::cos(6 * x), u[2] = -6 * std::sin(6 * x), u[3] = 6, u[4] = 0, q[0] = 0;
      },
      6);
  const auto s = b.solve(Closure::at(1.0));
  ASSERT_TRUE(s.converged) << s.reason;
  EXPECT_NEAR(b.end_value(0, true, 1), 2 * M_PI, 1e-10);
  EXPECT_NEAR(b.ends().back(), 1 / (8 * M_PI * M_PI), 1e-12);
}

struct Column {  // u'' = v, v' = w, with a length: x in [0,1], du/dx = ℓ u'
  std::vector<int> order{1, 1, 1};
  int quadratures = 0;
  double omega = 1.0;
  template <class T>
  void operator()(const T&, const T* u, const T&, T* out) const {
    out[0] = u[1] - u[4] * u[2];                    // u' = ℓ v
    out[1] = u[3] + u[4] * (omega * omega) * u[0];  // v' = -ω² ℓ u
    out[2] = u[5];                                  // ℓ' = 0
  }
};

TEST(BoundaryValueProblem, JoinsSegmentsOfUnknownLengthWhereAValueIsMet) {
  // v' = -ω²u with ω = 1, then ω = 2, switching where u = 1/2; total length L = 2: every number is known
  auto ends = make_conditions<12>(6, [](const auto* e, const auto&, auto* r) {
    const auto *left0 = e, *right0 = e + 3, *left1 = e + 6, *right1 = e + 9;
    r[0] = left0[0], r[1] = left0[1] - 1.0;
    r[2] = right0[0] - 0.5;
    r[3] = left1[0] - right0[0], r[4] = left1[1] - right0[1];
    r[5] = right0[2] + right1[2] - 2.0;
  });
  Column second;
  second.omega = 2.0;
  BoundaryValueProblem b(
      {std::make_shared<DualSystem<Column, 6>>(Column{}), std::make_shared<DualSystem<Column, 6>>(second)}, ends, 7);
  b.initialise(
      [](int j, double x, double* u, double*) {
        u[0] = j == 0 ? 0.5 * x : 0.5, u[1] = 0.5, u[2] = 1 - x, u[3] = -1, u[4] = j == 0 ? 0.5 : 1.5, u[5] = 0;
      },
      4);
  const auto s = b.solve(Closure::at(0.0));
  ASSERT_TRUE(s.converged) << s.reason;
  const double l0 = std::asin(0.5), l1 = 2 - l0, v = std::cos(l0);
  EXPECT_NEAR(b.end_value(0, true, 2), l0, 1e-10);
  EXPECT_NEAR(b.end_value(1, true, 0), 0.5 * std::cos(2 * l1) + 0.5 * v * std::sin(2 * l1), 1e-10);
}

struct Forced {  // u' = v, v' = -p u + cos 2πx
  std::vector<int> order{1, 1};
  int quadratures = 0;
  template <class T>
  void operator()(const T& x, const T* u, const T& p, T* out) const {
    using std::cos;
    out[0] = u[1] - u[2];
    out[1] = u[3] + p * u[0] - cos(2 * M_PI * x);
  }
};

TEST(BoundaryValueProblem, TakesPeriodicConditions) {
  auto ends = make_conditions<4>(2, [](const auto* e, const auto&, auto* r) {
    r[0] = e[0] - e[2];
    r[1] = e[1] - e[3];
  });
  BoundaryValueProblem b({std::make_shared<DualSystem<Forced, 4>>(Forced{})}, ends, 7);
  b.initialise([](int, double, double* u, double*) { u[0] = u[1] = u[2] = u[3] = 0; }, 6);
  ASSERT_TRUE(b.solve(Closure::at(3.0)).converged);
  double u[4];
  b.evaluate(0, 0.3, u, nullptr);
  EXPECT_NEAR(u[0], std::cos(2 * M_PI * 0.3) / (3 - 4 * M_PI * M_PI), 1e-10);
}

TEST(BoundaryValueProblem, SaysWhyItFails) {
  auto b = bratu(5);
  b.initialise([](int, double, double* u, double*) { u[0] = u[1] = u[2] = 0.0; }, 8);
  const auto s = b.solve(Closure::at(4.0));  // beyond the fold at 3.51 there is no solution
  EXPECT_FALSE(s.converged);
  EXPECT_FALSE(s.reason.empty());
}

}  // namespace

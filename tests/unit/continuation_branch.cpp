// Branches of boundary value problems: the fold of the Bratu problem against its closed form, bifurcations of the
// planar elastica, zeros of functions, meshes that change on the way.
#include <gtest/gtest.h>

#include <cmath>

#include "tendril/continuation/branch.hpp"

namespace {

using namespace tendril::collocation;
using namespace tendril::continuation;

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

TEST(Branch, PassesTheFoldOfTheBratuProblem) {
  auto ends = make_conditions<4>(2, [](const auto* e, const auto&, auto* r) { r[0] = e[0], r[1] = e[2]; });
  BoundaryValueProblem b({std::make_shared<DualSystem<Bratu, 3>>(Bratu{})}, ends, 7);
  b.initialise([](int, double, double* u, double*) { u[0] = u[1] = u[2] = 0.0; }, 3);
  BranchOptions o;
  o.max_step = 0.5;
  o.p_min = 0.05;
  o.solve.tolerance = 1e-11;
  // slope at the left end θ tanh(θ/4): its passage through 8
  o.functions = {[](const BoundaryValueProblem& c) { return c.end_value(0, false, 0, 1) - 8.0; }};
  ASSERT_TRUE(b.solve(Closure::at(0.1), o.solve).converged);
  const Branch branch = follow(b, o);
  ASSERT_FALSE(branch.failed) << branch.ended;
  EXPECT_EQ(branch.ended, "parameter range");
  EXPECT_DOUBLE_EQ(branch.points.back().p, 0.05);
  ASSERT_EQ(branch.events.size(), 2u);
  EXPECT_EQ(branch.events[0].kind, BranchEvent::Kind::fold);
  const double z = 1.1996786402577339;  // z tanh z = 1; λ = 8 z²/cosh² z
  EXPECT_NEAR(branch.events[0].p, 8 * z * z / std::pow(std::cosh(z), 2), 1e-10);
  EXPECT_EQ(branch.points.front().sign, 1);
  EXPECT_EQ(branch.points.back().sign, -1);
  EXPECT_EQ(branch.events[1].kind, BranchEvent::Kind::zero);
  double theta = 8.0;
  for (int i = 0; i < 60; ++i) theta = 8.0 / std::tanh(theta / 4);
  EXPECT_NEAR(branch.events[1].p, theta * theta / 2 / std::pow(std::cosh(theta / 4), 2), 1e-9);
  EXPECT_NEAR(branch.events[1].values[0], 0.0, 1e-8);
}

struct Elastica {  // θ'' + p sin θ = 0: strut under the thrust p
  std::vector<int> order{2};
  int quadratures = 0;
  template <class T>
  void operator()(const T&, const T* u, const T& p, T* out) const {
    using std::sin;
    out[0] = u[2] + p * sin(u[0]);
  }
};

TEST(Branch, FindsTheBucklingLoadsAndTheCrossingBranch) {
  auto ends = make_conditions<4>(2, [](const auto* e, const auto&, auto* r) { r[0] = e[1], r[1] = e[3]; });
  BoundaryValueProblem b({std::make_shared<DualSystem<Elastica, 3>>(Elastica{})}, ends, 7);
  b.initialise([](int, double, double* u, double*) { u[0] = u[1] = u[2] = 0.0; }, 6);
  BranchOptions o;
  o.p_max = 50.0;
  o.max_step = 2.0;
  b.set_parameter_scale(1.0);
  ASSERT_TRUE(b.solve(Closure::at(1.0), o.solve).converged);
  const Branch branch = follow(b, o);
  ASSERT_FALSE(branch.failed) << branch.ended;
  ASSERT_EQ(branch.events.size(), 2u);
  for (int n : {1, 2}) {
    EXPECT_EQ(branch.events[n - 1].kind, BranchEvent::Kind::branch_point);
    EXPECT_NEAR(branch.events[n - 1].p, n * n * M_PI * M_PI, 1e-6);  // equations singular beside it: half the digits
  }
  // on the crossing branch: L = 1 spans half a period, √p = 2 K(sin a/2) with a the end slope
  const auto beyond = leave(branch.events[0], 0.5);
  ASSERT_TRUE(beyond);
  const double a = beyond->end_value(0, false, 0);
  EXPECT_GT(std::abs(a), 0.3);
  EXPECT_NEAR(std::sqrt(beyond->parameter()), 2 * std::comp_ellint_1(std::sin(std::abs(a) / 2)), 1e-8);
}

}  // namespace

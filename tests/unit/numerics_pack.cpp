// Eight numbers side by side, and duals over them: every lane is the computation with its own numbers.
#include <gtest/gtest.h>

#include <cmath>

#include "tendril/numerics/dual.hpp"
#include "tendril/numerics/kernels.hpp"
#include "tendril/numerics/pack.hpp"

namespace {

using tendril::numerics::Dual;
using tendril::numerics::Pack;

constexpr double rounding = 1e-14;

template <class T>
T formula(const T& x, const T& y) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  return sin(x * y) / (2.0 + cos(y)) + sqrt(x * x + 1.0) - 3.0 / x;
}

TEST(NumericsPack, LanesAndTheirDerivativesAreIndependent) {
  Pack x, y;
  for (int i = 0; i < Pack::lanes; ++i) x.set(i, 0.5 + 0.3 * i), y.set(i, 2.0 - 0.7 * i);
  const Pack f = formula(x, y);
  using D = Dual<2, Pack>;
  const D d = formula(D::seed(x, 0), D::seed(y, 1));
  for (int i = 0; i < Pack::lanes; ++i) {
    const auto one = formula(Dual<2>::seed(x[i], 0), Dual<2>::seed(y[i], 1));
    EXPECT_NEAR(f[i], formula(x[i], y[i]), rounding);
    EXPECT_NEAR(d.v[i], one.v, rounding);
    for (int q = 0; q < 2; ++q) EXPECT_NEAR(d.d[q][i], one.d[q], 10 * rounding);
  }
}

TEST(NumericsPack, SumAndLargestTakeEveryLane) {
  for (int i = 0; i < Pack::lanes; ++i) {
    Pack a(0.0);
    a.set(i, 3.0);
    EXPECT_EQ(a.sum(), 3.0);
    EXPECT_EQ(a.largest(), 3.0);
    EXPECT_EQ(tendril::numerics::magnitude(-a)[i], 3.0);
  }
}

TEST(NumericsPack, MultiplyTakesRowsAnyLength) {
  const int rows = 3, columns = 11, ld = 13;
  std::vector<double> a(rows * ld), x(columns), y(rows);
  for (int i = 0; i < rows * ld; ++i) a[i] = std::cos(i);
  for (int j = 0; j < columns; ++j) x[j] = std::sin(3 * j);
  tendril::numerics::multiply(a.data(), rows, columns, ld, x.data(), y.data());
  for (int r = 0; r < rows; ++r) {
    double sum = 0.0;
    for (int j = 0; j < columns; ++j) sum += a[r * ld + j] * x[j];
    EXPECT_NEAR(y[r], sum, rounding * columns);
  }
}

}  // namespace

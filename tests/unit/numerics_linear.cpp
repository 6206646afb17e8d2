// The frontal LU on random almost-block-diagonal systems with border columns, and the dense kernels, against Eigen's
// dense factorisations: solution, sign of the determinant, further right-hand sides, singular systems.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>

#include "tendril/numerics/frontal.hpp"
#include "tendril/numerics/kernels.hpp"

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using tendril::numerics::FrontalLU;

/// Backward stable elimination: residual relative to |A||x| a small multiple of n eps.
constexpr double backward = 1e-13;

/// left rows | pieces of n states with a border | ... | right rows with the rest, as a chain of collocation pieces.
struct BlockSystem {
  int columns = 0;
  std::vector<std::vector<int>> blocks;
  std::vector<std::vector<double>> values;  // row-major over the block's columns
  std::vector<int> rows;

  BlockSystem(std::mt19937& random, int states, int pieces, int border, double row_spread = 0.0) {
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    columns = (pieces + 1) * states + border;
    const int left = states / 2;
    auto add = [&](std::vector<int> cols, int n) {
      std::vector<double> v(n * cols.size());
      for (int r = 0; r < n; ++r) {
        const double f = std::pow(10.0, row_spread * u(random));
        for (std::size_t c = 0; c < cols.size(); ++c) v[r * cols.size() + c] = f * u(random);
      }
      blocks.push_back(std::move(cols));
      rows.push_back(n);
      values.push_back(std::move(v));
    };
    const auto states_of = [&](std::vector<int>& c, int i) {
      for (int q = 0; q < states; ++q) c.push_back(i * states + q);
    };
    std::vector<int> c;
    states_of(c, 0);
    add(c, left);
    for (int i = 0; i < pieces; ++i) {
      c.clear();
      states_of(c, i);
      for (int b = 0; b < border; ++b) c.push_back((pieces + 1) * states + b);
      states_of(c, i + 1);
      add(c, states);
    }
    c.clear();
    states_of(c, pieces);
    for (int b = 0; b < border; ++b) c.push_back((pieces + 1) * states + b);
    add(c, states - left + border);
  }

  MatrixXd dense() const {
    int n = 0;
    for (int r : rows) n += r;
    MatrixXd A = MatrixXd::Zero(n, columns);
    int row = 0;
    for (std::size_t b = 0; b < blocks.size(); ++b)
      for (int r = 0; r < rows[b]; ++r, ++row)
        for (std::size_t c = 0; c < blocks[b].size(); ++c) A(row, blocks[b][c]) = values[b][r * blocks[b].size() + c];
    return A;
  }
  bool factor(FrontalLU& lu) const {
    lu.begin();
    for (std::size_t b = 0; b < blocks.size(); ++b) lu.add_block(rows[b], values[b].data());
    return lu.finish();
  }
};

TEST(NumericsFrontal, SolvesRandomBorderedSystems) {
  std::mt19937 random(7);
  int positive = 0, negative = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const int states = 2 + trial % 7, pieces = 1 + trial % 9, border = trial % 4;
    const BlockSystem s(random, states, pieces, border, trial % 3 ? 3.0 : 0.0);
    const MatrixXd A = s.dense();
    ASSERT_EQ(A.rows(), A.cols());
    FrontalLU lu;
    lu.analyse(s.columns, s.blocks);
    ASSERT_TRUE(s.factor(lu));
    EXPECT_EQ(lu.size(), A.cols());
    const Eigen::PartialPivLU<MatrixXd> reference(A);
    for (int k = 0; k < 3; ++k) {  // several right-hand sides with the same factors
      const VectorXd x = VectorXd::Random(A.cols()), b = A * x;
      VectorXd y(A.cols());
      lu.solve({b.data(), std::size_t(b.size())}, {y.data(), std::size_t(y.size())});
      // rows may differ in size by 10^6: componentwise against |A||x|
      const VectorXd size = A.cwiseAbs() * y.cwiseAbs() + b.cwiseAbs();
      EXPECT_LT(((A * y - b).cwiseQuotient(size)).lpNorm<Eigen::Infinity>(), backward) << "trial " << trial;
      const VectorXd z = reference.solve(b);
      const double condition =
          1 /
          Eigen::PartialPivLU<MatrixXd>(A.rowwise().lpNorm<Eigen::Infinity>().cwiseInverse().asDiagonal() * A).rcond();
      EXPECT_LT((y - z).lpNorm<Eigen::Infinity>(), backward * condition * (1 + x.lpNorm<Eigen::Infinity>()));
    }
    const double log_free_determinant = reference.determinant();
    EXPECT_EQ(lu.determinant_sign(), log_free_determinant > 0 ? 1 : -1) << "trial " << trial;
    (log_free_determinant > 0 ? positive : negative)++;
  }
  EXPECT_GT(positive, 5);  // both signs occurred
  EXPECT_GT(negative, 5);
}

TEST(NumericsFrontal, DeterminantChangesSignWithTwoRowsOrOneColumn) {
  std::mt19937 random(3);
  BlockSystem s(random, 5, 4, 2);
  FrontalLU lu;
  lu.analyse(s.columns, s.blocks);
  ASSERT_TRUE(s.factor(lu));
  const int sign = lu.determinant_sign();
  const std::size_t w = s.blocks[2].size();
  std::swap_ranges(s.values[2].begin(), s.values[2].begin() + w, s.values[2].begin() + w);
  ASSERT_TRUE(s.factor(lu));
  EXPECT_EQ(lu.determinant_sign(), -sign);
  for (std::size_t b = 0; b < s.blocks.size(); ++b)
    for (std::size_t c = 0; c < s.blocks[b].size(); ++c)
      if (s.blocks[b][c] == 7)
        for (int r = 0; r < s.rows[b]; ++r) s.values[b][r * s.blocks[b].size() + c] *= -1;
  ASSERT_TRUE(s.factor(lu));
  EXPECT_EQ(lu.determinant_sign(), sign);
}

TEST(NumericsFrontal, SingularSystemsAreDetectedAndTheNextOneIsNot) {
  std::mt19937 random(11);
  const BlockSystem good(random, 4, 5, 1);
  FrontalLU lu;
  lu.analyse(good.columns, good.blocks);
  {
    BlockSystem s = good;  // a column without entries
    for (std::size_t b = 0; b < s.blocks.size(); ++b)
      for (std::size_t c = 0; c < s.blocks[b].size(); ++c)
        if (s.blocks[b][c] == 9)
          for (int r = 0; r < s.rows[b]; ++r) s.values[b][r * s.blocks[b].size() + c] = 0.0;
    EXPECT_FALSE(s.factor(lu));
    EXPECT_EQ(lu.determinant_sign(), 0);
  }
  {
    BlockSystem s = good;  // two equal rows: eliminated by the same operations, so exactly
    const std::size_t w = s.blocks[3].size();
    std::copy_n(s.values[3].begin(), w, s.values[3].begin() + w);
    EXPECT_FALSE(s.factor(lu));
    EXPECT_EQ(lu.determinant_sign(), 0);
  }
  {
    BlockSystem s = good;  // not a number
    s.values[2][5] = std::numeric_limits<double>::quiet_NaN();
    const bool ok = s.factor(lu);
    std::vector<double> b(s.columns, 1.0), x(s.columns);
    if (ok) lu.solve(b, x);
    bool finite = true;
    for (double v : x) finite = finite && std::isfinite(v);
    EXPECT_FALSE(ok && finite);  // never a number out of a not-a-number
  }
  EXPECT_TRUE(good.factor(lu));
  EXPECT_NE(lu.determinant_sign(), 0);
}

TEST(NumericsFrontal, MoreRowsThanColumnsAreRefused) {
  FrontalLU lu;
  lu.analyse(1, {{0}, {0}});
  lu.begin();
  const double one = 1.0, two = 2.0;
  lu.add_block(1, &one);
  lu.add_block(1, &two);
  EXPECT_FALSE(lu.finish());
  EXPECT_EQ(lu.determinant_sign(), 0);
}

TEST(NumericsKernels, FactorAndSolveAgainstEigen) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  for (int n : {1, 2, 5, 12, 28, 42}) {
    const int right = 13, ld = (n + right + 3) / 4 * 4;
    RowMajor a = RowMajor::Random(n, ld);
    const RowMajor A = a.leftCols(n), B = a.middleCols(n, right), padding = a.rightCols(ld - n - right);
    std::vector<int> pivots(n);
    ASSERT_TRUE(tendril::numerics::factor_and_solve(a.data(), n, n + right, ld, pivots.data()));
    const RowMajor X = a.middleCols(n, right);
    const double size = (A.cwiseAbs() * X.cwiseAbs()).maxCoeff() + 1;
    EXPECT_LT((A * X - B).cwiseAbs().maxCoeff(), backward * size);
    EXPECT_EQ(a.rightCols(ld - n - right), padding);  // untouched
    VectorXd b = VectorXd::Random(n), x = b;
    tendril::numerics::solve_factored(a.data(), n, ld, pivots.data(), x.data());
    EXPECT_LT((A * x - b).cwiseAbs().maxCoeff(), backward * ((A.cwiseAbs() * x.cwiseAbs()).maxCoeff() + 1));
  }
}

TEST(NumericsKernels, SingularAndNotANumberAreRefused) {
  int pivots[3];
  double zero[9] = {1, 2, 3, 2, 4, 6, 1, 0, 1};
  EXPECT_FALSE(tendril::numerics::factor_and_solve(zero, 3, 3, 3, pivots));
  for (int place = 0; place < 9; ++place) {
    double a[9] = {4, 1, 2, 1, 5, 1, 2, 1, 6};
    a[place] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(tendril::numerics::factor_and_solve(a, 3, 3, 3, pivots)) << "entry " << place;
  }
}

TEST(NumericsKernels, SubtractMultipleOfAnyLength) {
  for (int n : {0, 1, 3, 4, 7, 8, 33}) {
    VectorXd row = VectorXd::Random(n + 1), pivot = VectorXd::Random(n + 1);
    const VectorXd before = row;
    tendril::numerics::subtract_multiple(row.data(), pivot.data(), 1.7, n);
    // a fused multiply-add may round once instead of twice
    for (int i = 0; i < n; ++i) EXPECT_NEAR(row[i], before[i] - 1.7 * pivot[i], 5e-16);
    EXPECT_EQ(row[n], before[n]);
  }
}

}  // namespace

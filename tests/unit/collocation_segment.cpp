// Gauss collocation on model problems with known solutions: dimension of the space, continuity, superconvergence at
// mesh points, order between them, exact linearisation of a piece with moving ends, error estimate and mesh adaptation.
#include <gtest/gtest.h>

#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

#include "collocation_model.hpp"

namespace {

using namespace collocation_model;

constexpr double from = 0.0, to = 1.0;

struct Errors {
  double nodes = 0.0;               // root mean square over mesh points of u, u'/ω, u''/ω², v and q
  std::array<double, 6> between{};  // largest error of every input
};

double exact_quadrature(const Mixed& m, double S) {
  return boost::math::quadrature::gauss_kronrod<double, 61>::integrate(
      [&](double t) {
        double u[6];
        m.inputs_at(t, u);
        return u[0] * u[4];
      },
      from, S, 6, 1e-14);
}

Errors errors(const Mixed& m, const Segment& s) {
  Errors e;
  double u[6], x[6], q[1];
  for (int i = 0; i <= s.pieces(); ++i) {
    m.inputs_at(s.place(i, from, to), x);
    const double* z = s.state(i);
    double square = 0.0;
    for (int j = 0; j < 3; ++j) square += std::pow((z[j] - x[j]) / std::pow(m.omega, j), 2);
    square += std::pow(z[3] - x[4], 2) + std::pow(z[4] - exact_quadrature(m, s.place(i, from, to)), 2);
    e.nodes += square / (s.pieces() + 1);
  }
  for (int i = 0; i < s.pieces(); ++i)
    for (int l = 0; l <= 40; ++l) {
      const double a = s.place(i, from, to), b = s.place(i + 1, from, to);
      s.evaluate_local(i, l / 40.0, from, to, u, q);
      m.inputs_at(a + (b - a) * l / 40.0, x);
      for (int j = 0; j < 6; ++j) e.between[j] = std::max(e.between[j], std::abs(u[j] - x[j]));
    }
  e.nodes = std::sqrt(e.nodes);
  return e;
}

class CollocationOrder : public ::testing::TestWithParam<int> {};

TEST_P(CollocationOrder, SuperconvergesAtMeshPoints) {
  const int k = GetParam();
  const Mixed m(k == 7 ? 9.0 : 6.0);
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;  // least squares in log h, log error
  for (const int pieces : {4, 5, 6, 7, 8, 10, 12, 15, 18}) {
    const double error = errors(m, solved_mixed(m, k, pieces, from, to)).nodes;
    if (error < 2e-13 || error > 1e-5) continue;  // rounding; not yet asymptotic
    const double x = -std::log(pieces), y = std::log(error);
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  ASSERT_GE(n, 3);
  // the phase of the oscillation on the mesh makes single meshes scatter by up to a factor 3
  EXPECT_NEAR((n * sxy - sx * sy) / (n * sxx - sx * sx), 2 * k, 0.7);
}

TEST_P(CollocationOrder, HasOrderKPlusMBetweenMeshPoints) {
  const int k = GetParam();
  const Mixed m(k == 4 ? 7.0 : k == 5 ? 9.0 : k == 6 ? 12.0 : 15.0);
  const int coarse = k == 4 ? 8 : 6;
  const Errors a = errors(m, solved_mixed(m, k, coarse, from, to));
  const Errors b = errors(m, solved_mixed(m, k, 2 * coarse, from, to));
  // inputs u u' u'' u''' v v': order k + m - j of the j-th derivative
  const int m_less_j[6] = {3, 2, 1, 0, 1, 0};
  for (int j = 0; j < 6; ++j)
    EXPECT_NEAR(std::log2(a.between[j] / b.between[j]), k + m_less_j[j], 0.6) << "input " << j;
}

INSTANTIATE_TEST_SUITE_P(Points, CollocationOrder, ::testing::Values(4, 5, 6, 7));

TEST(CollocationSegment, NewtonConvergesQuadraticallyFromAPerturbedStart) {
  const Mixed m(3.0);
  Segment s(&m, 5);
  s.initialise(from, to, {}, 5, [&](double S, double* u, double* q) {
    m.inputs_at(S, u);
    for (int j = 0; j < 6; ++j) u[j] += 0.1 * std::sin(5 * S + j);
    q[0] = S;
  });
  EXPECT_LT(solve(s, from, to, mixed_ends(m, from, to), 6), 1e-12);
  EXPECT_LT(errors(m, s).nodes, 1e-7);
}

TEST(CollocationSegment, PiecesJoinWithAllDerivativesBelowTheOrder) {
  const Mixed m(4.0);
  const Segment s = solved_mixed(m, 4, 5, from, to);
  double l[6], r[6], ql[1], qr[1];
  for (int i = 0; i + 1 < s.pieces(); ++i) {
    s.evaluate_local(i, 1.0, from, to, l, ql);
    s.evaluate_local(i + 1, 0.0, from, to, r, qr);
    for (int j : {0, 1, 2, 4}) EXPECT_NEAR(l[j], r[j], 1e-12 * std::pow(m.omega, j));
    EXPECT_NEAR(ql[0], qr[0], 1e-13);
  }
  // the right place is found, and on the mesh points, too
  for (int i = 0; i < s.pieces(); ++i) {
    const double a = s.place(i, from, to), b = s.place(i + 1, from, to);
    EXPECT_EQ(s.piece_at(0.5 * (a + b), from, to), i);
    EXPECT_EQ(s.piece_at(a, from, to), i);
    s.evaluate(a, from, to, l, ql);
    for (int j : {0, 1, 2}) EXPECT_EQ(l[j], s.state(i)[j]);
  }
  EXPECT_EQ(s.piece_at(to, from, to), s.pieces() - 1);
}

TEST(CollocationSegment, HighestDerivativesAreThoseAtTheGaussPoints) {
  const Mixed m(2.0);
  Segment s = solved_mixed(m, 6, 3, from, to);
  const auto& table = tendril::numerics::gauss_table(6);
  double u[6], q[1];
  for (int i = 0; i < s.pieces(); ++i)
    for (int g = 0; g < table.k; ++g) {
      s.evaluate_local(i, table.c[g], from, to, u, q);
      for (int c = 0; c < m.components(); ++c)
        EXPECT_NEAR(s.highest(i, g, c), u[m.first[c] + m.order[c]], 1e-11);  // rounding of the Lagrange polynomials
    }
}

TEST(CollocationSegment, DerivativesOfAPieceAreThoseOfItsPolynomial) {
  const Mixed m(4.0);
  const Segment s = solved_mixed(m, 6, 3, from, to);
  const double h = 1e-3, at = 0.41;
  double u[6], p[6], n[6], p2[6], n2[6];
  s.evaluate(at, from, to, u, nullptr);
  s.evaluate(at + h, from, to, p, nullptr);
  s.evaluate(at - h, from, to, n, nullptr);
  s.evaluate(at + 2 * h, from, to, p2, nullptr);
  s.evaluate(at - 2 * h, from, to, n2, nullptr);
  for (int j : {0, 1, 2, 4})  // fourth-order differences of derivatives up to ω^7
    EXPECT_NEAR((8 * (p[j] - n[j]) - (p2[j] - n2[j])) / (12 * h), u[j + 1], 1e-8) << j;
}

TEST(CollocationSegment, QuadratureInsideAPieceIsTheIntegral) {
  const Mixed m(2.0);
  const Segment s = solved_mixed(m, 7, 4, from, to);
  double u[6], q[1];
  for (double S : {0.0, 0.13, 0.5, 0.77, 1.0}) {
    s.evaluate(S, from, to, u, q);
    EXPECT_NEAR(q[0], exact_quadrature(m, S), 1e-9);  // order k + 1 with ωh = 1/2: (ωh)^8 times some 1e-7
  }
}

/// One piece alone: its map z_i -> z_{i+1} with the local equations solved, at moved data.
std::vector<double> mismatch(Segment s, int piece, double a, double b) {
  Condensed c;
  const std::size_t local = s.local().size() / s.pieces();
  std::vector<double> dw(local), zero(s.states(), 0.0);
  for (int it = 0; it < 8; ++it) {
    EXPECT_TRUE(s.condense(piece, a, b, c));
    s.local_correction(piece, zero.data(), 0, 0, 0, dw.data());
    for (std::size_t l = 0; l < local; ++l) s.local()[piece * local + l] += dw[l];
  }
  EXPECT_TRUE(s.condense(piece, a, b, c));
  return c.residual;
}

TEST(CollocationSegment, LinearisationOfAPieceAgreesWithDifferences) {
  Mixed m(3.0);
  m.p = 1.3;  // not the p of the manufactured solution: nothing cancels
  const double a = 0.1, b = 0.9;
  Segment s(&m, 5);
  s.initialise(a, b, std::vector{0.4}, 5, [&](double S, double* u, double* q) {
    m.inputs_at(S, u);
    q[0] = 0.3 * S;
  });
  const std::size_t local = s.local().size() / s.pieces();
  for (int i = 0; i < s.pieces(); ++i) {  // satisfy the local equations
    Condensed c;
    std::vector<double> dw(local), zero(s.states(), 0.0);
    for (int it = 0; it < 8; ++it) {
      ASSERT_TRUE(s.condense(i, a, b, c));
      s.local_correction(i, zero.data(), 0, 0, 0, dw.data());
      for (std::size_t l = 0; l < local; ++l) s.local()[i * local + l] += dw[l];
    }
    ASSERT_TRUE(s.condense(i, a, b, c));
    const int ns = s.states(), width = ns + 3;
    const double h = 1e-4, tolerance = 2e-6;  // second-order differences: h² times third derivatives up to 100
    for (int q = 0; q < width; ++q) {
      std::vector<double> r[2];
      for (int side = 0; side < 2; ++side) {
        const double d = side ? h : -h;
        Segment t = s;
        Mixed moved = m;
        t.rebind(&moved);
        if (q < ns) t.state(i)[q] += d;
        if (q == ns + 2) moved.p += d;
        r[side] = mismatch(t, i, a + (q == ns ? d : 0.0), b + (q == ns + 1 ? d : 0.0));
      }
      for (int e = 0; e < ns; ++e) {
        const double slope = (r[1][e] - r[0][e]) / (2 * h);
        EXPECT_NEAR(c.rows[e * width + q], slope, tolerance * (1 + std::abs(slope)))
            << "piece " << i << " row " << e << " column " << q;
      }
    }
  }
}

TEST(CollocationSegment, LocalCorrectionFollowsStatesEndsAndParameter) {
  Mixed m(3.0);
  const double a = 0.1, b = 0.9, h = 1e-5;
  Segment s(&m, 4);
  s.initialise(a, b, {}, 3, [&](double S, double* u, double* q) {
    m.inputs_at(S, u);
    q[0] = 0.0;
  });
  const std::size_t local = s.local().size() / s.pieces();
  const auto settle = [&](Segment& t, double left, double right) {
    Condensed c;
    std::vector<double> dw(local), zero(t.states(), 0.0);
    for (int it = 0; it < 8; ++it) {
      ASSERT_TRUE(t.condense(1, left, right, c));
      t.local_correction(1, zero.data(), 0, 0, 0, dw.data());
      for (std::size_t l = 0; l < local; ++l) t.local()[local + l] += dw[l];
    }
  };
  settle(s, a, b);
  const std::vector<double> dz = {0.3, -0.5, 0.7, 0.2, 0.0};
  const double da = 0.4, db = -0.6, dp = 0.5;
  std::vector<double> dw(local);
  Condensed c;
  ASSERT_TRUE(s.condense(1, a, b, c));
  s.local_correction(1, dz.data(), da, db, dp, dw.data());
  Segment moved[2] = {s, s};
  Mixed systems[2] = {m, m};
  for (int side = 0; side < 2; ++side) {
    const double f = side ? h : -h;
    systems[side].p += f * dp;
    moved[side].rebind(&systems[side]);
    for (int q = 0; q < 5; ++q) moved[side].state(1)[q] += f * dz[q];
    settle(moved[side], a + f * da, b + f * db);
  }
  for (std::size_t l = 0; l < local; ++l) {
    const double slope = (moved[1].local()[local + l] - moved[0].local()[local + l]) / (2 * h);
    EXPECT_NEAR(dw[l], slope, 1e-6 * (1 + std::abs(slope))) << l;
  }
}

TEST(CollocationSegment, ResidualWithKeptFactorsIsThatOfCondense) {
  const Mixed m(3.0);
  Segment s(&m, 6);
  s.initialise(from, to, {}, 3, [&](double S, double* u, double* q) {
    m.inputs_at(S, u);
    u[3] += 0.05;
    q[0] = S;
  });
  Condensed c;
  std::vector<double> r(s.states());
  for (int i = 0; i < s.pieces(); ++i) {
    ASSERT_TRUE(s.condense(i, from, to, c));
    ASSERT_TRUE(s.residual(i, from, to, r));
    for (int e = 0; e < s.states(); ++e) EXPECT_NEAR(r[e], c.residual[e], 1e-13);
  }
}

TEST(CollocationSegment, ErrorEstimateIsOfTheSizeOfTheErrorBetweenNodes) {
  for (int k = 4; k <= 7; ++k) {
    const Mixed m(k <= 5 ? 5.0 : 8.0);
    const Segment s = solved_mixed(m, k, 7, from, to);
    std::vector<double> estimate;
    s.estimate_error(from, to, estimate);
    ASSERT_EQ(estimate.size(), std::size_t(7 * 6));
    double u[6], x[6];
    std::array<double, 6> most_true{}, most_estimated{};
    for (int i = 0; i < s.pieces(); ++i)
      for (int j = 0; j < 6; ++j) {
        for (int l = 0; l <= 40; ++l) {
          const double a = s.place(i, from, to), b = s.place(i + 1, from, to);
          s.evaluate_local(i, l / 40.0, from, to, u, nullptr);
          m.inputs_at(a + (b - a) * l / 40.0, x);
          most_true[j] = std::max(most_true[j], std::abs(u[j] - x[j]));
        }
        most_estimated[j] = std::max(most_estimated[j], estimate[i * 6 + j]);
      }
    for (int j = 0; j < 6; ++j) {
      const double ratio = most_estimated[j] / most_true[j];
      EXPECT_GT(ratio, 0.3) << "k " << k << " input " << j << " error " << most_true[j];
      EXPECT_LT(ratio, 10.0) << "k " << k << " input " << j << " error " << most_true[j];
    }
  }
}

Segment solved_layers(const Layers& m, int k, int pieces) {
  double l[3], r[3];
  m.inputs_at(0, l);
  m.inputs_at(1, r);
  Segment s(&m, k);
  s.initialise(0, 1, {}, pieces, [&](double, double* u, double*) { u[0] = u[1] = u[2] = 0.0; });
  EXPECT_LT(solve(s, 0, 1, {{false, 0, l[0]}, {true, 0, r[0]}}, 3), 1e-11);  // linear: one step and its check
  return s;
}

TEST(CollocationSegment, StiffLinearProblemIsStable) {
  // λh = 12.5 on the coarse mesh: between the layers there is nothing to resolve, and no oscillation may appear
  const Layers m(200.0);
  const Segment s = solved_layers(m, 4, 16);
  double u[3];
  for (double S : {0.3, 0.47, 0.62}) {
    s.evaluate(S, 0, 1, u, nullptr);
    EXPECT_NEAR(u[0], std::cos(S), 1e-2);
  }
}

TEST(CollocationSegment, AdaptationEquidistributesTheErrorOverLayers) {
  const Layers m(60.0);
  const int k = 5;
  const double tolerance = 1e-8, l = std::cos(0) + 1 + std::exp(-60.0), r = std::cos(1.0) + 1 + std::exp(-60.0);
  Segment s = solved_layers(m, k, 6);
  std::vector<double> e, ratio;
  double most = HUGE_VAL;
  for (int round = 0; round < 6 && most > 1; ++round) {
    s.estimate_error(0, 1, e);
    ratio.assign(s.pieces(), 0.0);
    most = 0;
    for (int i = 0; i < s.pieces(); ++i) most = std::max(most, ratio[i] = e[3 * i] / tolerance);
    if (most <= 1) break;
    s.adapt(0, 1, {}, ratio, 4.0);
    solve(s, 0, 1, {{false, 0, l}, {true, 0, r}}, 3);
  }
  EXPECT_LE(most, 1.0);
  double u[3], x[3], error = 0.0;
  for (int i = 0; i <= 2000; ++i) {
    s.evaluate(i / 2000.0, 0, 1, u, nullptr);
    m.inputs_at(i / 2000.0, x);
    error = std::max(error, std::abs(u[0] - x[0]));
  }
  EXPECT_LT(error, 3 * tolerance);
  // dense in the layers: pieces there are much smaller than in the middle
  const double first = s.place(1, 0, 1), middle_left = s.place(s.piece_at(0.5, 0, 1), 0, 1);
  const double middle = s.place(s.piece_at(0.5, 0, 1) + 1, 0, 1) - middle_left;
  EXPECT_LT(first, 0.2 * middle);
  // shares of ratio^(1/(k+1)) differ little once the mesh has settled
  for (int round = 0; round < 3; ++round) {
    s.estimate_error(0, 1, e);
    for (int i = 0; i < s.pieces(); ++i) ratio[i] = e[3 * i] / tolerance;
    s.adapt(0, 1, {}, ratio, 4.0);
    solve(s, 0, 1, {{false, 0, l}, {true, 0, r}}, 3);
    ratio.resize(s.pieces());
  }
  s.estimate_error(0, 1, e);
  double low = HUGE_VAL, high = 0.0;
  for (int i = 0; i < s.pieces(); ++i) {
    const double share = std::pow(e[3 * i] / tolerance, 1.0 / (k + 1));
    low = std::min(low, share);
    high = std::max(high, share);
  }
  EXPECT_LT(high / low, 4.0);  // a whole number of pieces, defects taken at their ends
  const Segment even = solved_layers(m, k, s.pieces());
  even.estimate_error(0, 1, e);
  double even_most = 0.0;
  for (int i = 0; i < even.pieces(); ++i) even_most = std::max(even_most, e[3 * i] / tolerance);
  EXPECT_GT(std::pow(even_most, 1.0 / (k + 1)), 2 * high);
}

TEST(CollocationSegment, AdaptationOnARefinedMeshKeepsTheSolution) {
  const Mixed m(4.0);
  Segment s = solved_mixed(m, 7, 4, from, to);
  const Segment before = s;
  const std::vector<double> ratio = {1.0, 3e5, 1.0, 1.0};
  s.adapt(from, to, {}, ratio, 1.0);
  EXPECT_GT(s.pieces(), 4);
  double u[6], v[6], q[1], w[1];
  for (int i = 0; i <= 50; ++i) {
    before.evaluate(i / 50.0, from, to, u, q);
    s.evaluate(i / 50.0, from, to, v, w);
    for (int j : {0, 1, 2, 4}) EXPECT_NEAR(u[j], v[j], 1e-6);
    EXPECT_NEAR(q[0], w[0], 1e-7);
  }
}

TEST(CollocationSegment, KnotsAreMeshPointsAndTheMeshFollowsItsEnds) {
  const Mixed m(2.0);
  Segment s(&m, 4);
  const std::vector<double> knots = {-0.5, 0.35, 0.7, 1.5};  // those outside do not count
  const auto check = [&] {
    int found = 0;
    for (int i = 1; i < s.pieces(); ++i)
      for (double k : {0.35, 0.7}) found += std::abs(s.place(i, 0, 1) - k) < 1e-14;
    EXPECT_EQ(found, 2);
    for (const auto& [a, b] : {std::pair{0.0, 1.0}, std::pair{0.2, 0.9}, std::pair{-0.3, 1.4}}) {
      EXPECT_DOUBLE_EQ(s.place(0, a, b), a);
      EXPECT_DOUBLE_EQ(s.place(s.pieces(), a, b), b);
      for (int i = 0; i < s.pieces(); ++i) EXPECT_LT(s.place(i, a, b), s.place(i + 1, a, b));
    }
  };
  s.initialise(0, 1, knots, 9, [&](double S, double* u, double* q) {
    m.inputs_at(S, u);
    q[0] = 0.0;
  });
  EXPECT_EQ(s.pieces(), 9);
  check();
  s.adapt(0, 1, knots, std::vector<double>(s.pieces(), 50.0), 1.0);
  check();
  EXPECT_TRUE(s.aligned(0, 1, knots, 1e-12));
  EXPECT_FALSE(s.aligned(0, 1.02, knots, 1e-3));  // the mesh stretched: its points are off by 0.7 %
  EXPECT_TRUE(s.aligned(0, 1.02, knots, 0.02));
  EXPECT_FALSE(s.aligned(0, 1, std::vector{0.351}, 1e-6));
}

TEST(CollocationSegment, SpaceHasTheDimensionOfItsSmoothness) {
  // k coefficients of every component on every piece, and one state
  const Mixed m(2.0);
  for (int k = 4; k <= 7; ++k)
    for (int pieces : {1, 3, 8}) {
      Segment s(&m, k);
      s.initialise(0, 1, {}, pieces, [&](double S, double* u, double* q) {
        m.inputs_at(S, u);
        q[0] = 0.0;
      });
      EXPECT_EQ(s.local().size() + s.states() - m.quadratures, std::size_t(2 * k * pieces + 4));
      EXPECT_EQ(s.states_data().size(), std::size_t((pieces + 1) * s.states()));
    }
}

TEST(CollocationSegment, SingularAndBackwardPiecesAreRefused) {
  const Mixed m(2.0);
  Segment s = solved_mixed(m, 4, 3, from, to);
  Condensed c;
  std::vector<double> r(s.states());
  ASSERT_TRUE(s.condense(0, from, to, c));
  EXPECT_FALSE(s.residual(0, 1.0, 0.0, r));
  s.state(1)[0] = NAN;
  EXPECT_FALSE(s.condense(1, from, to, c));
}

}  // namespace

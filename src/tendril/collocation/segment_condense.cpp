// Local condensation of one piece: the rows of its collocation equations over the local unknowns w, eliminated to the
// map z_i -> z_{i+1} with its derivatives; residuals and corrections on the kept factors.
#include <algorithm>
#include <cmath>

#include "tendril/collocation/segment.hpp"
#include "tendril/collocation/segment_limits.hpp"
#include "tendril/numerics/kernels.hpp"
#include "tendril/numerics/target.hpp"

namespace tendril::collocation {

using numerics::Pack;

// Inputs at all Gauss points of a piece, one lane each; idle lanes hold the left mesh point's.
TENDRIL_FLATTEN_CLONES void Segment::gauss_inputs(const double* z, const double* w, double h, Pack* u) const {
  const int n = system_->components(), k = table_->k;
  const Pack x = Pack(h) * table_->c_pack;
  for (int c = 0; c < n; ++c) {
    const int m = system_->order[c];
    Pack* uc = u + system_->first[c];
    const double* zc = z + state_first_[c];
    double hp = 1.0;
    for (int j = m; j >= 0; --j) {
      Pack sum(0.0);
      for (int i = m - 1; i >= j; --i) sum = Pack(zc[i]) + sum * x * Pack(1.0 / (i + 1 - j));  // Σ x^(i-j)/(i-j)! z_i
      const auto& t = table_->over_points[m - j];
      Pack tail(0.0);
      for (int l = 0; l < k; ++l) tail += t[l] * Pack(w[c * k + l]);
      uc[j] = sum + Pack(hp) * tail;
      hp *= h;
    }
  }
}

/// The local rows of a piece, row e k + g: columns of w (c k + l), z, S_i, h, p, residual; scaled by their largest
/// coefficient of w. The quadratures' rows (weighted sums over the Gauss points) go to Q.
struct Segment::Assembly {
  const System& system;
  const numerics::GaussTable& table;
  const int* state_first;
  int z_columns, local, width;
  double h;
  const double *z, *w;
  const Pack *u, *r, *jac;
  double *A, *scale, *Q, *increment;

  bool run() const;
};

TENDRIL_FLATTEN_CLONES bool Segment::Assembly::run() const {
  const int n = system.components(), k = table.k, nq = system.quadratures, cols = system.inputs + 2;
  const int zc = local, sc = local + z_columns, rc = sc + 3, q_width = local + z_columns + 3;
  const Pack x = Pack(h) * table.c_pack;
  Pack weights(0.0);
  for (int g = 0; g < k; ++g) weights.set(g, table.b[g]);
  // derivative of the inputs with respect to the width h at fixed local coordinate
  Pack du[most_inputs];
  for (int c = 0; c < n; ++c) {
    const int m = system.order[c];
    const double* zz = z + state_first[c];
    double hp = 1.0;  // h^(m-j-1)
    for (int j = m - 1; j >= 0; --j, hp *= h) {
      Pack sum(0.0), tail(0.0);
      for (int q = m - 1; q > j; --q) sum = Pack(zz[q]) + sum * x * Pack(1.0 / (q - j));
      const auto& t = table.over_points[m - j];
      for (int l = 0; l < k; ++l) tail += t[l] * Pack(w[c * k + l]);
      du[system.first[c] + j] = table.c_pack * sum + Pack((m - j) * hp) * tail;
    }
    du[system.first[c] + m] = Pack(0.0);
  }
  for (int e = 0; e < n + nq; ++e) {
    const Pack* je = jac + e * cols;
    const bool quadrature = e >= n;
    double* row =
        quadrature ? Q + static_cast<std::size_t>(e - n) * q_width : A + static_cast<std::size_t>(e) * k * width;
    Pack dh = je[system.inputs] * table.c_pack;
    for (int c = 0; c < n; ++c) {
      const int m = system.order[c];
      const Pack* jc = je + system.first[c];
      Pack f[numerics::max_order + 1];
      double hp = h;
      for (int j = m - 1; j >= 0; --j, hp *= h) {
        f[j] = jc[j] * Pack(hp);
        dh += jc[j] * du[system.first[c] + j];
      }
      // columns of w: the highest derivative itself, the lower ones through the integrals
      Pack sum(0.0);
      for (int g = 0; g < k; ++g) {
        Pack a(0.0);
        a.set(g, jc[m][g]);
        for (int j = 0; j < m; ++j) a += Pack(f[j][g]) * table.over_polynomials[m - j][g];
        if (quadrature)
          sum += Pack(h * table.b[g]) * a;
        else
          a.store(row + g * width + c * k);  // the lanes beyond k are overwritten by what follows
      }
      if (quadrature)
        for (int l = 0; l < k; ++l) row[c * k + l] = sum[l];
    }
    for (int c = 0; c < n; ++c) {
      const int m = system.order[c];
      const Pack* jc = je + system.first[c];
      for (int q = 0; q < m; ++q) {  // columns of z: Σ_{j <= q} x^(q-j)/(q-j)! G_j
        Pack a = jc[0];
        for (int j = 1; j <= q; ++j) a = a * x * Pack(1.0 / (q - j + 1)) + jc[j];
        if (quadrature)
          row[zc + state_first[c] + q] = (a * weights).sum() * h;
        else
          for (int g = 0; g < k; ++g) row[g * width + zc + state_first[c] + q] = a[g];
      }
    }
    const Pack &ds = je[system.inputs], &dp = je[system.inputs + 1];
    if (quadrature) {
      increment[e - n] = (r[e] * weights).sum() * h;
      row[sc] = (ds * weights).sum() * h;
      row[sc + 1] = (dh * weights).sum() * h + (r[e] * weights).sum();
      row[sc + 2] = (dp * weights).sum() * h;
      if (!std::isfinite(increment[e - n])) return false;
      continue;
    }
    for (int g = 0; g < k; ++g) {
      double* a = row + g * width;
      a[sc] = ds[g], a[sc + 1] = dh[g], a[sc + 2] = dp[g], a[rc] = r[e][g];
      for (int j = rc + 1; j < width; ++j) a[j] = 0.0;
      Pack most(0.0);
      int j = 0;
      for (; j + 8 <= local; j += 8) most = numerics::larger(most, numerics::magnitude(Pack::load(a + j)));
      double largest = most.largest();
      for (; j < local; ++j) largest = std::max(largest, std::abs(a[j]));
      if (!(largest > 0.0) || !std::isfinite(largest) || !std::isfinite(r[e][g])) return false;
      const double inv = 1.0 / largest;
      scale[e * k + g] = inv;
      for (int i = 0; i < width; ++i) a[i] *= inv;
    }
  }
  return true;
}

bool Segment::condense(int i, double a, double b, Condensed& out) {
  const int n = system_->components(), k = table_->k, nq = system_->quadratures;
  const double s0 = place(i, a, b), h = place(i + 1, a, b) - s0;
  const double* z = state(i);
  const double* w = &w_[static_cast<std::size_t>(i) * local_];
  double* A = &factors_[static_cast<std::size_t>(i) * local_ * width_];
  condensed_width_[i] = h;
  double* Qr = quad_rows_.data() + static_cast<std::size_t>(i) * nq * (z_columns_ + 3 + local_);
  const int zc = local_;
  double S[Pack::lanes], q_increment[most_equations] = {};
  for (int g = 0; g < k; ++g) S[g] = s0 + h * table_->c[g];
  Pack *u = scratch_.data(), *r = u + system_->inputs, *jac = r + system_->equations();
  gauss_inputs(z, w, h, u);
  system_->jacobians(S, k, u, r, jac);
  for (int e = 0; e < n + nq; ++e)
    for (int g = k; g < Pack::lanes; ++g) r[e].set(g, 0.0);  // idle lanes carry no weight, and must not carry a NaN
  for (int e = n * (system_->inputs + 2); e < (n + nq) * (system_->inputs + 2); ++e)
    for (int g = k; g < Pack::lanes; ++g) jac[e].set(g, 0.0);
  const Assembly assembly{*system_,
                          *table_,
                          state_first_.data(),
                          z_columns_,
                          local_,
                          width_,
                          h,
                          z,
                          w,
                          u,
                          r,
                          jac,
                          A,
                          &row_scale_[static_cast<std::size_t>(i) * local_],
                          Qr,
                          q_increment};
  if (!assembly.run()) return false;
  int* pivots = &pivots_[static_cast<std::size_t>(i) * local_];
  if (!numerics::factor_and_solve(A, local_, width_, width_, pivots)) return false;
  // columns zc.. now hold X with  dw = -X (dz, dS_i, dh, dp) - X_r
  const int out_cols = states_ + 3, span = width_ - local_;
  out.rows.assign(static_cast<std::size_t>(states_) * out_cols, 0.0);
  out.residual.assign(states_, 0.0);
  const double wa0 = 1.0 - share_[i], wb0 = share_[i], wbh = share_[i + 1] - share_[i], wah = -wbh;
  double combo[most_inputs + 16];
  for (int c = 0; c < n; ++c) {
    const int m = system_->order[c];
    double hp = h, hp1 = 1.0;
    for (int j = m - 1; j >= 0; --j, hp *= h, hp1 *= h) {
      const int row = state_first_[c] + j;
      double* o = &out.rows[static_cast<std::size_t>(row) * out_cols];
      const auto& t = table_->at_one[m - j];
      std::fill(combo, combo + span, 0.0);
      double tail = 0.0;
      for (int l = 0; l < k; ++l) {
        numerics::subtract_multiple(combo, A + static_cast<std::size_t>(c * k + l) * width_ + zc, t[l], span);
        tail += t[l] * w[c * k + l];
      }
      double value = hp * (tail + combo[z_columns_ + 3]), dh = (m - j) * hp1 * tail, mono = 1.0;
      for (int q = j; q < m; ++q) {
        value += mono * z[state_first_[c] + q];
        o[state_first_[c] + q] -= mono;
        if (q + 1 < m) dh += mono * z[state_first_[c] + q + 1];
        mono *= h / (q - j + 1);
      }
      for (int q = 0; q < z_columns_; ++q) o[q] -= hp * combo[q];
      const double ds = hp * combo[z_columns_], dhh = hp * combo[z_columns_ + 1] + dh;
      o[states_] -= ds * wa0 + dhh * wah;
      o[states_ + 1] -= ds * wb0 + dhh * wbh;
      o[states_ + 2] -= hp * combo[z_columns_ + 2];
      out.residual[row] = state(i + 1)[row] - value;
    }
  }
  for (int qd = 0; qd < nq; ++qd) {
    const int row = z_columns_ + qd;
    double* o = &out.rows[static_cast<std::size_t>(row) * out_cols];
    const double* qr = Qr + static_cast<std::size_t>(qd) * (z_columns_ + 3 + local_);
    std::fill(combo, combo + span, 0.0);
    for (int q = 0; q < z_columns_ + 3; ++q) combo[q] = qr[local_ + q];
    for (int l = 0; l < local_; ++l)
      if (qr[l] != 0.0)
        numerics::subtract_multiple(combo, A + static_cast<std::size_t>(l) * width_ + zc, qr[l], z_columns_ + 4);
    o[row] = -1.0;
    for (int q = 0; q < z_columns_; ++q) o[q] -= combo[q];
    const double ds = combo[z_columns_], dhh = combo[z_columns_ + 1];
    o[states_] -= ds * wa0 + dhh * wah;
    o[states_ + 1] -= ds * wb0 + dhh * wbh;
    o[states_ + 2] -= combo[z_columns_ + 2];
    out.residual[row] = state(i + 1)[row] - (z[row] + q_increment[qd] + combo[z_columns_ + 3]);
  }
  return true;
}

bool Segment::residual(int i, double a, double b, std::span<double> out, double* square) {
  const int n = system_->components(), k = table_->k, nq = system_->quadratures;
  const double s0 = place(i, a, b), h = place(i + 1, a, b) - s0;
  if (!(h > 0.0)) return false;
  const double* z = state(i);
  const double* w = &w_[static_cast<std::size_t>(i) * local_];
  double* A = &factors_[static_cast<std::size_t>(i) * local_ * width_];
  const double* scale = &row_scale_[static_cast<std::size_t>(i) * local_];
  const double* Qr = quad_rows_.data() + static_cast<std::size_t>(i) * nq * (z_columns_ + 3 + local_);
  const int rc = local_ + z_columns_ + 3;
  double S[Pack::lanes], q_increment[most_equations] = {}, rhs[numerics::max_points * most_equations];
  for (int g = 0; g < k; ++g) S[g] = s0 + h * table_->c[g];
  Pack *u = scratch_.data(), *r = u + system_->inputs;
  gauss_inputs(z, w, h, u);
  system_->residuals(S, k, u, r);
  for (int e = 0; e < n; ++e)
    for (int g = 0; g < k; ++g) {
      const double f = r[e][g] * scale[e * k + g];
      if (!std::isfinite(f)) return false;
      rhs[e * k + g] = f;
      if (square) *square += f * f;
    }
  for (int e = 0; e < nq; ++e)
    for (int g = 0; g < k; ++g) q_increment[e] += h * table_->b[g] * r[n + e][g];
  numerics::solve_factored(A, local_, width_, &pivots_[static_cast<std::size_t>(i) * local_], rhs);
  for (int l = 0; l < local_; ++l) A[static_cast<std::size_t>(l) * width_ + rc] = rhs[l];
  for (int c = 0; c < n; ++c) {
    const int m = system_->order[c];
    double hp = h, condensed = condensed_width_[i];
    for (int j = m - 1; j >= 0; --j, hp *= h, condensed *= condensed_width_[i]) {
      const auto& t = table_->at_one[m - j];
      double tail = 0.0, correction = 0.0, mono = 1.0;
      for (int l = 0; l < k; ++l) {
        tail += t[l] * w[c * k + l];
        correction += t[l] * rhs[c * k + l];
      }
      // the correction of w belongs to the frozen Jacobian, hence to the width it was computed with
      double value = hp * tail - condensed * correction;
      for (int q = j; q < m; ++q) {
        value += mono * z[state_first_[c] + q];
        mono *= h / (q - j + 1);
      }
      out[state_first_[c] + j] = state(i + 1)[state_first_[c] + j] - value;
    }
  }
  for (int qd = 0; qd < nq; ++qd) {
    const double* qr = Qr + static_cast<std::size_t>(qd) * (z_columns_ + 3 + local_);
    double add = q_increment[qd];
    for (int l = 0; l < local_; ++l) add -= qr[l] * rhs[l];
    out[z_columns_ + qd] = state(i + 1)[z_columns_ + qd] - z[z_columns_ + qd] - add;
  }
  return true;
}

void Segment::local_correction(int i, const double* dz, double da, double db, double dp, double* dw) const {
  const double* A = &factors_[static_cast<std::size_t>(i) * local_ * width_];
  double d[most_inputs + 4];
  std::copy_n(dz, z_columns_, d);
  d[z_columns_] = da + share_[i] * (db - da);
  d[z_columns_ + 1] = (share_[i + 1] - share_[i]) * (db - da);
  d[z_columns_ + 2] = dp;
  d[z_columns_ + 3] = 1.0;
  numerics::multiply(A + local_, local_, z_columns_ + 4, width_, d, dw);
  for (int l = 0; l < local_; ++l) dw[l] = -dw[l];
}

}  // namespace tendril::collocation

#include "tendril/collocation/segment.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "tendril/numerics/kernels.hpp"
#include "tendril/numerics/target.hpp"

namespace tendril::collocation {

using numerics::Pack;

namespace {

constexpr int most_inputs = 64, most_equations = 32;

}  // namespace

void Segment::layout() {
  state_first_.clear();
  int n = 0;
  for (int m : system_->order) {
    state_first_.push_back(n);
    n += m;
  }
  z_columns_ = n;
  states_ = n + system_->quadratures;
  local_ = system_->components() * table_->k;
  width_ = local_ + (z_columns_ + 4 + 7) / 8 * 8;
  scratch_.resize(system_->inputs + system_->equations() * (system_->inputs + 3));
  assert(system_->inputs <= most_inputs && system_->equations() <= most_equations);
}

void Segment::initialise(double a, double b, std::span<const double> knots, int pieces, const Sampler& sampler) {
  std::vector<double> inside;
  const double margin = 1e-9 * (b - a);
  for (double s : knots)
    if (s > a + margin && s < b - margin) inside.push_back(s);
  std::vector<double> points;
  double left = a;
  for (std::size_t j = 0; j <= inside.size(); ++j) {
    const double right = j < inside.size() ? inside[j] : b;
    const int n = std::max(1, static_cast<int>(std::lround(pieces * (right - left) / (b - a))));
    for (int i = 1; i < n; ++i) points.push_back(left + (right - left) * i / n);
    if (j < inside.size()) points.push_back(right);
    left = right;
  }
  initialise_on(a, b, points, sampler);
}

void Segment::initialise_on(double a, double b, std::span<const double> points, const Sampler& sampler) {
  std::vector<double> s{a};
  s.insert(s.end(), points.begin(), points.end());
  s.push_back(b);
  pieces_ = static_cast<int>(s.size()) - 1;
  share_.assign(s.size(), 0.0);
  for (int i = 0; i <= pieces_; ++i) share_[i] = i == pieces_ ? 1.0 : (s[i] - a) / (b - a);
  const int n = system_->components(), k = table_->k;
  z_.assign(s.size() * states_, 0.0);
  w_.assign(static_cast<std::size_t>(pieces_) * local_, 0.0);
  double u[most_inputs], q[most_equations];
  for (int i = 0; i <= pieces_; ++i) {
    sampler(s[i], u, q);
    double* z = state(i);
    for (int c = 0; c < n; ++c)
      for (int j = 0; j < system_->order[c]; ++j) z[state_first_[c] + j] = u[system_->first[c] + j];
    for (int j = 0; j < system_->quadratures; ++j) z[z_columns_ + j] = q[j];
  }
  for (int i = 0; i < pieces_; ++i)
    for (int g = 0; g < k; ++g) {
      sampler(s[i] + (s[i + 1] - s[i]) * table_->c[g], u, q);
      for (int c = 0; c < n; ++c)
        w_[static_cast<std::size_t>(i) * local_ + c * k + g] = u[system_->first[c] + system_->order[c]];
    }
  condensed_width_.assign(pieces_, 0.0);
  factors_.assign(static_cast<std::size_t>(pieces_) * local_ * width_, 0.0);
  pivots_.assign(static_cast<std::size_t>(pieces_) * local_, 0);
  row_scale_.assign(static_cast<std::size_t>(pieces_) * local_, 1.0);
  quad_rows_.assign(static_cast<std::size_t>(pieces_) * system_->quadratures * (z_columns_ + 3 + local_), 0.0);
}

bool Segment::aligned(double a, double b, std::span<const double> knots, double distance) const {
  for (double q : knots) {
    if (q <= a + distance || q >= b - distance) continue;
    const int i = piece_at(q, a, b);
    if (std::min(q - place(i, a, b), place(i + 1, a, b) - q) > distance) return false;
  }
  return true;
}

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
  const int zc = local_, rc = local_ + z_columns_ + 3;
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
  (void)rc;
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

int Segment::piece_at(double S, double a, double b) const {
  int low = 0, high = pieces_;
  while (high - low > 1) {
    const int mid = (low + high) / 2;
    (place(mid, a, b) <= S ? low : high) = mid;
  }
  return low;
}

void Segment::evaluate(double S, double a, double b, double* inputs, double* quadratures) const {
  const int i = piece_at(S, a, b);
  const double s0 = place(i, a, b), h = place(i + 1, a, b) - s0;
  evaluate_local(i, (S - s0) / h, a, b, inputs, quadratures);
}

void Segment::evaluate_local(int i, double x, double a, double b, double* inputs, double* quadratures) const {
  const int n = system_->components(), k = table_->k, nq = system_->quadratures;
  const double s0 = place(i, a, b), h = place(i + 1, a, b) - s0;
  const double* z = state(i);
  const double* w = &w_[static_cast<std::size_t>(i) * local_];
  double basis[numerics::max_order + 1][numerics::max_points];
  for (int p = 0; p <= numerics::max_order; ++p) table_->basis(p, x, basis[p]);
  for (int c = 0; c < n; ++c) {
    const int m = system_->order[c];
    double hp = 1.0;
    for (int j = m; j >= 0; --j, hp *= h) {
      double sum = 0.0, tail = 0.0;
      for (int q = m - 1; q >= j; --q) sum = z[state_first_[c] + q] + sum * x * h / (q + 1 - j);
      for (int l = 0; l < k; ++l) tail += basis[m - j][l] * w[c * k + l];
      inputs[system_->first[c] + j] = sum + hp * tail;
    }
  }
  if (nq > 0 && quadratures) {
    // integrate the integrand's interpolant from the left mesh point
    Pack u[most_inputs], r[most_equations];
    double S[Pack::lanes];
    for (int q = 0; q < nq; ++q) quadratures[q] = z[z_columns_ + q];
    if (x == 0.0) return;
    for (int g = 0; g < k; ++g) S[g] = s0 + h * table_->c[g];
    gauss_inputs(z, w, h, u);
    system_->residuals(S, k, u, r);
    for (int g = 0; g < k; ++g)
      for (int q = 0; q < nq; ++q) quadratures[q] += h * basis[1][g] * r[n + q][g];
  }
}

// Inputs of a piece at its left (side 0) or right end.
void Segment::end_inputs(int i, int side, double* u) const {
  const double* z = state(i + side);
  const double* w = &w_[static_cast<std::size_t>(i) * local_];
  const int k = table_->k;
  for (int c = 0; c < system_->components(); ++c) {
    const int m = system_->order[c];
    for (int j = 0; j < m; ++j) u[system_->first[c] + j] = z[state_first_[c] + j];
    double top = 0.0;
    for (int l = 0; l < k; ++l) top += (side ? table_->at_one[0][l] : table_->lagrange[l][0]) * w[c * k + l];
    u[system_->first[c] + m] = top;
  }
}

void Segment::estimate_error(double a, double b, std::vector<double>& error) const {
  const int n = system_->components();
  error.assign(static_cast<std::size_t>(pieces_) * system_->inputs, 0.0);
  // both ends of four pieces at a time
  constexpr int pieces_at_once = Pack::lanes / 2;
  std::vector<Pack> scratch(scratch_.size());
  Pack *u = scratch.data(), *r = u + system_->inputs, *highest = r + system_->equations();
  double x[most_inputs], S[Pack::lanes], top[most_equations * (most_equations + 1)];
  int pivots[most_equations];
  for (int first = 0; first < pieces_; first += pieces_at_once) {
    const int count = 2 * std::min(pieces_at_once, pieces_ - first);
    for (int lane = 0; lane < Pack::lanes; ++lane) {
      if (lane < count) {
        const int i = first + lane / 2;
        end_inputs(i, lane % 2, x);
        S[lane] = place(i + lane % 2, a, b);
      }
      for (int j = 0; j < system_->inputs; ++j) u[j].set(lane, x[j]);  // idle lanes repeat the last place
    }
    system_->highest(S, count, u, r, highest);
    for (int i = first; i < first + count / 2; ++i) {
      double defect[most_equations] = {};
      for (int side = 0; side < 2; ++side) {
        const int lane = 2 * (i - first) + side;
        for (int e = 0; e < n; ++e) {
          for (int c = 0; c < n; ++c) top[e * (n + 1) + c] = highest[e * n + c][lane];
          top[e * (n + 1) + n] = r[e][lane];
        }
        if (!numerics::factor_and_solve(top, n, n + 1, n + 1, pivots)) continue;
        for (int c = 0; c < n; ++c) defect[c] = std::max(defect[c], std::abs(top[c * (n + 1) + n]));
      }
      const double h = place(i + 1, a, b) - place(i, a, b);
      double* out = &error[static_cast<std::size_t>(i) * system_->inputs];
      for (int c = 0; c < n; ++c) {
        const int m = system_->order[c];
        double hp = 1.0;
        for (int j = m; j >= 0; --j, hp *= h)
          out[system_->first[c] + j] = defect[c] * hp * table_->legendre_integral[m - j];
      }
    }
  }
}

void Segment::adapt(double a, double b, std::span<const double> knots, std::span<const double> ratio, double safety) {
  const int k = table_->k;
  const Segment old = *this;
  const double margin = 1e-9 * (b - a);
  std::vector<double> fixed{a};
  for (double s : knots)
    if (s > a + margin && s < b - margin) fixed.push_back(s);
  fixed.push_back(b);
  // density of wanted pieces on the old mesh, then equal shares between fixed points
  std::vector<double> left(pieces_ + 1), density(pieces_);
  for (int i = 0; i <= pieces_; ++i) left[i] = place(i, a, b);
  for (int i = 0; i < pieces_; ++i)
    density[i] = std::pow(std::clamp(safety * ratio[i], 1e-6, 1e6), 1.0 / (k + 1)) / (left[i + 1] - left[i]);
  std::vector<double> cumulative(pieces_ + 1, 0.0);
  for (int i = 0; i < pieces_; ++i) cumulative[i + 1] = cumulative[i] + density[i] * (left[i + 1] - left[i]);
  auto total_to = [&](double s) {
    const int i =
        std::clamp(static_cast<int>(std::upper_bound(left.begin(), left.end(), s) - left.begin()) - 1, 0, pieces_ - 1);
    return cumulative[i] + density[i] * (s - left[i]);
  };
  std::vector<double> points;
  for (std::size_t j = 0; j + 1 < fixed.size(); ++j) {
    const double c0 = total_to(fixed[j]), c1 = total_to(fixed[j + 1]);
    int count = std::max(1, static_cast<int>(std::ceil(c1 - c0)));
    if (fixed.size() == 2) count = std::max(count, 2);
    for (int q = 1; q < count; ++q) {
      const double target = c0 + (c1 - c0) * q / count;
      const int i = std::clamp(
          static_cast<int>(std::upper_bound(cumulative.begin(), cumulative.end(), target) - cumulative.begin()) - 1, 0,
          pieces_ - 1);
      points.push_back(left[i] + (target - cumulative[i]) / density[i]);
    }
    if (j + 2 < fixed.size()) points.push_back(fixed[j + 1]);
  }
  initialise_on(a, b, points, [&](double S, double* u, double* q) { old.evaluate(S, a, b, u, q); });
}

}  // namespace tendril::collocation

#include "tendril/collocation/segment.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "tendril/numerics/kernels.hpp"

namespace tendril::collocation {
namespace {

constexpr int most_inputs = 64, most_equations = 32;

double factorial(int n) { return n <= 1 ? 1.0 : n == 2 ? 2.0 : 6.0; }

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
  width_ = (local_ + z_columns_ + 4 + 3) / 4 * 4;
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
        w_[static_cast<std::size_t>(i) * local_ + g * n + c] = u[system_->first[c] + system_->order[c]];
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

void Segment::gauss_inputs(const double* z, const double* w, double h, int g, double* u) const {
  const int n = system_->components(), k = table_->k;
  const double x = h * table_->c[g];
  for (int c = 0; c < n; ++c) {
    const int m = system_->order[c];
    double* uc = u + system_->first[c];
    const double* zc = z + state_first_[c];
    double hp = 1.0;
    for (int j = m; j >= 0; --j) {
      double sum = 0.0;
      for (int i = m - 1; i >= j; --i) sum = zc[i] + sum * x / (i + 1 - j);  // Horner: sum x^(i-j)/(i-j)! z_i
      double tail = 0.0;
      if (j == m) {
        tail = w[g * n + c];
      } else {
        const auto& a = table_->integral[m - j][g];
        for (int l = 0; l < k; ++l) tail += a[l] * w[l * n + c];
      }
      uc[j] = sum + hp * tail;
      hp *= h;
    }
  }
}

bool Segment::condense(int i, double a, double b, Condensed& out) {
  const int n = system_->components(), k = table_->k, nq = system_->quadratures, cols = system_->inputs + 2;
  const double s0 = place(i, a, b), h = place(i + 1, a, b) - s0;
  const double* z = state(i);
  const double* w = &w_[static_cast<std::size_t>(i) * local_];
  double* A = &factors_[static_cast<std::size_t>(i) * local_ * width_];
  double* scale = &row_scale_[static_cast<std::size_t>(i) * local_];
  condensed_width_[i] = h;
  double* Qr = quad_rows_.data() + static_cast<std::size_t>(i) * nq * (z_columns_ + 3 + local_);
  const int zc = local_, sc = local_ + z_columns_, rc = sc + 3;
  std::fill(A, A + static_cast<std::size_t>(local_) * width_, 0.0);
  std::fill(Qr, Qr + static_cast<std::size_t>(nq) * (z_columns_ + 3 + local_), 0.0);
  double u[most_inputs], r[most_equations], jac[most_equations * (most_inputs + 2)], du[most_inputs];
  double q_increment[most_equations] = {};
  for (int g = 0; g < k; ++g) {
    gauss_inputs(z, w, h, g, u);
    const double x = h * table_->c[g], cg = table_->c[g];
    system_->jacobian(s0 + x, u, r, jac);
    // derivative of the inputs with respect to the width h at fixed local coordinate
    for (int c = 0; c < n; ++c) {
      const int m = system_->order[c];
      const double* zz = z + state_first_[c];
      for (int j = 0; j < m; ++j) {
        double sum = 0.0;
        for (int q = m - 1; q > j; --q) sum = zz[q] + sum * x / (q - j);
        double tail = 0.0;
        const auto& t = table_->integral[m - j][g];
        for (int l = 0; l < k; ++l) tail += t[l] * w[l * n + c];
        du[system_->first[c] + j] = cg * sum + (m - j) * std::pow(h, m - j - 1) * tail;
      }
      du[system_->first[c] + m] = 0.0;
    }
    for (int e = 0; e < n + nq; ++e) {
      const double* je = jac + e * cols;
      double *row, *zrow, *srow;
      double weight = 1.0;
      if (e < n) {
        row = A + static_cast<std::size_t>(g * n + e) * width_;
        zrow = row + zc;
        srow = row + sc;
      } else {
        row = Qr + static_cast<std::size_t>(e - n) * (z_columns_ + 3 + local_);
        zrow = row + local_;
        srow = zrow + z_columns_;
        weight = h * table_->b[g];
        q_increment[e - n] += weight * r[e];
      }
      double dh = je[system_->inputs] * cg;
      for (int c = 0; c < n; ++c) {
        const int m = system_->order[c];
        const double* jc = je + system_->first[c];
        row[g * n + c] += weight * jc[m];
        double hp = h;
        for (int j = m - 1; j >= 0; --j, hp *= h) {
          const double f = weight * jc[j];
          if (f == 0.0) continue;
          const auto& t = table_->integral[m - j][g];
          for (int l = 0; l < k; ++l) row[l * n + c] += f * hp * t[l];
          double mono = f;
          for (int q = j; q < m; ++q) {
            zrow[state_first_[c] + q] += mono;
            mono *= x / (q + 1 - j);
          }
          dh += jc[j] * du[system_->first[c] + j];
        }
      }
      srow[0] += weight * je[system_->inputs];
      srow[1] += weight * dh + (e < n ? 0.0 : table_->b[g] * r[e]);
      srow[2] += weight * je[system_->inputs + 1];
      if (e < n) {
        row[rc] = r[e];
        double most = 0.0;
        for (int j = 0; j < local_; ++j) most = std::max(most, std::abs(row[j]));
        if (!(most > 0.0) || !std::isfinite(most) || !std::isfinite(r[e])) return false;
        const double inv = 1.0 / most;
        scale[g * n + e] = inv;
        for (int j = 0; j <= rc; ++j) row[j] *= inv;
      } else if (!std::isfinite(r[e])) {
        return false;
      }
    }
  }
  int* pivots = &pivots_[static_cast<std::size_t>(i) * local_];
  if (!numerics::factor_and_solve(A, local_, rc + 1, width_, pivots)) return false;
  // columns zc.. now hold X with  dw = -X (dz, dS_i, dh, dp) - X_r
  const int out_cols = states_ + 3;
  out.rows.assign(static_cast<std::size_t>(states_) * out_cols, 0.0);
  out.residual.assign(states_, 0.0);
  const double wa0 = 1.0 - share_[i], wb0 = share_[i], wbh = share_[i + 1] - share_[i], wah = -wbh;
  double combo[most_inputs + 8];
  for (int c = 0; c < n; ++c) {
    const int m = system_->order[c];
    for (int j = 0; j < m; ++j) {
      const int row = state_first_[c] + j;
      double* o = &out.rows[static_cast<std::size_t>(row) * out_cols];
      const double hp = std::pow(h, m - j), hp1 = std::pow(h, m - j - 1);
      const auto& t = table_->at_one[m - j];
      std::fill(combo, combo + z_columns_ + 4, 0.0);
      double tail = 0.0;
      for (int l = 0; l < k; ++l) {
        const double* X = A + static_cast<std::size_t>(l * n + c) * width_ + zc;
        for (int q = 0; q < z_columns_ + 4; ++q) combo[q] -= t[l] * X[q];
        tail += t[l] * w[l * n + c];
      }
      double value = hp * (tail + combo[z_columns_ + 3]), dh = (m - j) * hp1 * tail;
      for (int q = j; q < m; ++q) {
        const double mono = std::pow(h, q - j) / factorial(q - j);
        value += mono * z[state_first_[c] + q];
        o[state_first_[c] + q] -= mono;
        if (q > j) dh += std::pow(h, q - j - 1) / factorial(q - j - 1) * z[state_first_[c] + q];
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
    std::fill(combo, combo + z_columns_ + 4, 0.0);
    for (int q = 0; q < z_columns_ + 3; ++q) combo[q] = qr[local_ + q];
    for (int l = 0; l < local_; ++l) {
      const double f = qr[l];
      if (f == 0.0) continue;
      const double* X = A + static_cast<std::size_t>(l) * width_ + zc;
      for (int q = 0; q < z_columns_ + 4; ++q) combo[q] -= f * X[q];
    }
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
  double u[most_inputs], r[most_equations], q_increment[most_equations] = {};
  double rhs[numerics::max_points * most_equations];
  for (int g = 0; g < k; ++g) {
    gauss_inputs(z, w, h, g, u);
    system_->residual(s0 + h * table_->c[g], u, r);
    for (int e = 0; e < n; ++e) {
      if (!std::isfinite(r[e])) return false;
      rhs[g * n + e] = r[e] * scale[g * n + e];
      if (square) *square += rhs[g * n + e] * rhs[g * n + e];
    }
    for (int e = 0; e < nq; ++e) q_increment[e] += h * table_->b[g] * r[n + e];
  }
  numerics::solve_factored(A, local_, width_, &pivots_[static_cast<std::size_t>(i) * local_], rhs);
  for (int l = 0; l < local_; ++l) A[static_cast<std::size_t>(l) * width_ + rc] = rhs[l];
  for (int c = 0; c < n; ++c) {
    const int m = system_->order[c];
    for (int j = 0; j < m; ++j) {
      const auto& t = table_->at_one[m - j];
      double tail = 0.0, correction = 0.0;
      for (int l = 0; l < k; ++l) {
        tail += t[l] * w[l * n + c];
        correction += t[l] * rhs[l * n + c];
      }
      // the correction of w belongs to the frozen Jacobian, hence to the width it was computed with
      double value = std::pow(h, m - j) * tail - std::pow(condensed_width_[i], m - j) * correction;
      for (int q = j; q < m; ++q) value += std::pow(h, q - j) / factorial(q - j) * z[state_first_[c] + q];
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
  const double ds = da + share_[i] * (db - da);
  const double dh = (share_[i + 1] - share_[i]) * (db - da);
  for (int l = 0; l < local_; ++l) {
    const double* X = A + static_cast<std::size_t>(l) * width_ + local_;
    double sum = X[z_columns_ + 3] + ds * X[z_columns_] + dh * X[z_columns_ + 1] + dp * X[z_columns_ + 2];
    for (int q = 0; q < z_columns_; ++q) sum += dz[q] * X[q];
    dw[l] = -sum;
  }
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
      for (int l = 0; l < k; ++l) tail += basis[m - j][l] * w[l * n + c];
      inputs[system_->first[c] + j] = sum + hp * tail;
    }
  }
  if (nq > 0 && quadratures) {
    // integrate the integrand's interpolant from the left mesh point
    double u[most_inputs], r[most_equations];
    for (int q = 0; q < nq; ++q) quadratures[q] = z[z_columns_ + q];
    if (x != 0.0)
      for (int g = 0; g < k; ++g) {
        gauss_inputs(z, w, h, g, u);
        system_->residual(s0 + h * table_->c[g], u, r);
        for (int q = 0; q < nq; ++q) quadratures[q] += h * basis[1][g] * r[n + q];
      }
  }
}

void Segment::estimate_error(double a, double b, std::vector<double>& error) const {
  const int n = system_->components(), k = table_->k, cols = system_->inputs + 2;
  error.assign(static_cast<std::size_t>(pieces_) * system_->inputs, 0.0);
  double u[most_inputs], r[most_equations], jac[most_equations * (most_inputs + 2)];
  double top[most_equations * (most_equations + 1)];
  int pivots[most_equations];
  for (int i = 0; i < pieces_; ++i) {
    const double s0 = place(i, a, b), h = place(i + 1, a, b) - s0;
    double defect[most_equations] = {};
    for (double x : {0.0, 1.0}) {
      evaluate_local(i, x, a, b, u, nullptr);
      system_->jacobian(s0 + h * x, u, r, jac);
      for (int e = 0; e < n; ++e) {
        for (int c = 0; c < n; ++c) top[e * (n + 1) + c] = jac[e * cols + system_->first[c] + system_->order[c]];
        top[e * (n + 1) + n] = r[e];
      }
      if (!numerics::factor_and_solve(top, n, n + 1, n + 1, pivots)) continue;
      for (int c = 0; c < n; ++c) defect[c] = std::max(defect[c], std::abs(top[c * (n + 1) + n]));
    }
    double* out = &error[static_cast<std::size_t>(i) * system_->inputs];
    for (int c = 0; c < n; ++c) {
      const int m = system_->order[c];
      for (int j = 0; j <= m; ++j)
        out[system_->first[c] + j] = defect[c] * std::pow(h, m - j) * table_->legendre_integral[m - j];
    }
  }
  (void)k;
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

#include "tendril/collocation/segment.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "tendril/collocation/segment_limits.hpp"
#include "tendril/numerics/kernels.hpp"

namespace tendril::collocation {

using numerics::Pack;

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
  evaluate_own(i, x, a, b, inputs, quadratures);
  system_->present(place(i, a, b) * (1.0 - x) + place(i + 1, a, b) * x, inputs);
}

void Segment::evaluate_own(int i, double x, double a, double b, double* inputs, double* quadratures) const {
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
  initialise_on(a, b, points, [&](double S, double* u, double* q) {
    const int i = old.piece_at(S, a, b);
    const double s0 = old.place(i, a, b), h = old.place(i + 1, a, b) - s0;
    const bool node = S == a || S == b || std::binary_search(points.begin(), points.end(), S);
    old.evaluate_own(i, (S - s0) / h, a, b, u, node ? q : nullptr);  // quadratures are kept at mesh points only
  });
}

bool Segment::stay(double a0, double b0, double a, double b, std::span<const double> knots) {
  if (a0 == a && b0 == b) return true;
  std::vector<double> inside;
  for (int i = 1; i < pieces_; ++i) inside.push_back(place(i, a0, b0));
  if (inside.empty() || !(inside.front() > a) || !(inside.back() < b)) return true;  // carried along after all
  for (int i = 1; i < pieces_; ++i) share_[i] = (inside[i - 1] - a) / (b - a);
  constexpr double hardly = 1e-2;  // of the piece: nothing to be laid anew
  if (std::abs(a - a0) < hardly * (inside.front() - a) && std::abs(b - b0) < hardly * (b - inside.back())) return true;
  // an end's first and last piece against the mean of the mesh and their neighbour
  const double mean = (b0 - a0) / pieces_;
  constexpr double shortest = 0.03, longest = 1.15;
  bool changed = false;
  for (const bool left : {true, false}) {
    const auto width = [&]() { return left ? inside.front() - a : b - inside.back(); };
    const auto typical = [&]() {
      double most = 0.0;  // of the three nearest
      for (std::size_t i = 1; i < inside.size() && i < 4; ++i)
        most = std::max(most,
                        left ? inside[i] - inside[i - 1] : inside[inside.size() - i] - inside[inside.size() - i - 1]);
      return most > 0.0 ? most : mean;
    };
    while (inside.size() > 1 && width() < shortest * typical()) {
      inside.erase(left ? inside.begin() : inside.end() - 1);
      changed = true;
    }
    if (inside.empty()) continue;
    const double from = left ? a : inside.back(), to = left ? inside.front() : b, room = shortest * typical();
    std::vector<double> more;
    for (double s : knots)
      if (s > from + room && s < to - room) more.push_back(s);
    // errors grow with a high power of the width: a piece that has grown by a little is cut where its neighbour would
    // be
    if (more.empty() && width() > longest * typical()) more.push_back(left ? to - typical() : from + typical());
    changed = changed || !more.empty();
    inside.insert(left ? inside.begin() : inside.end(), more.begin(), more.end());
  }
  if (!changed) return true;
  const Segment old = *this;
  initialise_on(a, b, inside, [&](double S, double* u, double* q) { old.evaluate(S, a, b, u, q); });
  return false;
}

}  // namespace tendril::collocation

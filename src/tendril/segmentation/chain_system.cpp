// The linear system of the chain: numbering, linearisation, residuals, and its responses.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tendril/segmentation/chain.hpp"
#include "tendril/segmentation/in_plane.hpp"

namespace tendril::segmentation {

void Chain::number() {
  factored_ = false;
  first_column_.clear();
  int column = 0;
  for (const auto& s : segment_) {
    first_column_.push_back(column);
    column += (s.pieces() + 1) * s.states();
  }
  state_columns_ = column;
  const int p = column_of_p(), multiplier = p + 1;
  blocks_.clear();
  auto states = [&](std::vector<int>& cols, int j, int i) {
    for (int q = 0; q < segment_[j].states(); ++q) cols.push_back(column_of_state(j, i, q));
  };
  std::vector<int> cols;
  states(cols, 0, 0);
  cols.push_back(column_of_S(0));
  cols.push_back(p);
  blocks_.push_back(cols);
  for (int j = 0; j < segments(); ++j) {
    for (int i = 0; i < segment_[j].pieces(); ++i) {
      cols.clear();
      states(cols, j, i);
      cols.push_back(column_of_S(j));
      cols.push_back(column_of_S(j + 1));
      cols.push_back(p);
      states(cols, j, i + 1);
      if (phase_ && j == phase_segment_ && i == phase_piece_) cols.push_back(multiplier);
      blocks_.push_back(cols);
    }
    if (j + 1 < segments()) {
      cols.clear();
      states(cols, j, segment_[j].pieces());
      states(cols, j + 1, 0);
      cols.push_back(column_of_S(j + 1));
      cols.push_back(p);
      blocks_.push_back(cols);
    }
  }
  cols.clear();
  states(cols, segments() - 1, segment_.back().pieces());
  cols.push_back(column_of_S(segments()));
  cols.push_back(p);
  blocks_.push_back(cols);
  blocks_.emplace_back();  // the closure's, known when a system is solved
}

void Chain::add_rows(int block, int rows, double* values) {
  const auto& cols = blocks_[block];
  const int width = static_cast<int>(cols.size());
  for (int r = 0; r < rows; ++r) {
    double most = 0.0, terms = 0.0;
    for (int c = 0; c < width; ++c) {
      terms += std::abs(values[r * width + c] * unknown_[cols[c]]);
      most = std::max(most, std::abs(values[r * width + c] *= scale_[cols[c]]));
    }
    row_rounding_.push_back(std::numeric_limits<double>::epsilon() * terms);
    row_weight_.push_back(most > 0.0 ? 1.0 / most : 1.0);
  }
  lu_.add_block(rows, values);
}

std::vector<int> Chain::closure_columns(const Closure& closure) const {
  switch (closure.kind) {
    case Closure::Kind::parameter:
      return {column_of_p()};
    case Closure::Kind::unknown:
      return {closure.index};
    case Closure::Kind::span:
      return {column_of_S(closure.index), column_of_S(closure.index + 1)};
  }
  return {};
}

bool Chain::assemble(const Closure& closure) {
  factored_ = false;
  mechanics_->problem.p = p_;
  typical();
  scales(scale_);
  // the closure's columns complete the structure
  const std::vector<int> cols = closure_columns(closure);
  if (blocks_.back() != cols) {
    blocks_.back() = cols;
    lu_.analyse(unknowns(), blocks_);
  }
  lu_.begin();
  rhs_.clear();
  row_weight_.clear();
  row_rounding_.clear();
  gather(unknown_);
  int block = 0;
  bool ok = true;
  double r[64];
  auto add = [&](auto&& rows_of) {
    values_.assign(static_cast<std::size_t>(32) * blocks_[block].size(), 0.0);
    const int n = rows_of(r, values_.data());
    for (int i = 0; i < n; ++i) {
      ok = ok && std::isfinite(r[i]);
      rhs_.push_back(-r[i]);
    }
    add_rows(block++, n, values_.data());
  };
  add([&](double* q, double* v) { return left_rows(q, v); });
  collocation::Condensed condensed;
  for (int j = 0; j < segments() && ok; ++j) {
    auto& s = segment_[j];
    const int ns = s.states();
    for (int i = 0; i < s.pieces() && ok; ++i) {
      if (!s.condense(i, S_[j], S_[j + 1], condensed)) {
        ok = false;
        break;
      }
      add([&](double* q, double* v) {
        const bool phase = phase_ && j == phase_segment_ && i == phase_piece_;
        const int width = 2 * ns + 3 + (phase ? 1 : 0);
        for (int row = 0; row < ns; ++row) {
          std::copy_n(&condensed.rows[static_cast<std::size_t>(row) * (ns + 3)], ns + 3, v + row * width);
          v[row * width + ns + 3 + row] = 1.0;
          q[row] = condensed.residual[row];
        }
        if (mechanics_->problem.planar) keep_piece_in_plane(line_[j], s.state(i), s.state(i + 1), q, v, width);
        if (!phase) return ns;
        q[9] += multiplier_;  // a tangential point force: must come out 0
        v[9 * width + width - 1] = 1.0;
        q[ns] = s.state(i + 1)[3];  // δ2 = 0
        v[ns * width + ns + 3 + 3] = 1.0;
        return ns + 1;
      });
    }
    if (j + 1 < segments() && ok) add([&](double* q, double* v) { return junction_rows(j, q, v); });
  }
  if (ok) {
    add([&](double* q, double* v) { return right_rows(q, v); });
    add([&](double* q, double* v) { return closure_row(closure, q, v); });
    ok = lu_.finish();
  }
  return factored_ = ok;
}

bool Chain::residual(const Closure& closure, std::vector<double>& rhs) {
  mechanics_->problem.p = p_;
  rhs.clear();
  bool ok = true;
  double r[64], square = 0.0;
  values_.assign(32 * 64, 0.0);
  auto take = [&](int n) {
    for (int i = 0; i < n; ++i) {
      ok = ok && std::isfinite(r[i]);
      rhs.push_back(-r[i]);
    }
  };
  take(left_rows(r, values_.data()));
  for (int j = 0; j < segments(); ++j) {
    auto& s = segment_[j];
    for (int i = 0; i < s.pieces(); ++i) {
      int n = s.states();
      if (!s.residual(i, S_[j], S_[j + 1], std::span<double>(r, n), &square)) return false;
      if (mechanics_->problem.planar) keep_piece_in_plane(line_[j], s.state(i), s.state(i + 1), r);
      if (phase_ && j == phase_segment_ && i == phase_piece_) {
        r[9] += multiplier_;
        r[n++] = s.state(i + 1)[3];
      }
      take(n);
    }
    if (j + 1 < segments()) {
      std::fill(values_.begin(), values_.end(), 0.0);
      take(junction_rows(j, r, values_.data()));
    }
  }
  std::fill(values_.begin(), values_.end(), 0.0);
  take(right_rows(r, values_.data()));
  std::fill(values_.begin(), values_.end(), 0.0);
  take(closure_row(closure, r, values_.data()));
  for (std::size_t i = 0; i < rhs.size(); ++i) square += row_weight_[i] * row_weight_[i] * rhs[i] * rhs[i];
  merit_ = 0.5 * square;
  return ok;
}

void Chain::local_changes(const std::vector<double>& dx, std::vector<double>& dw) {
  std::size_t n = 0;
  for (const auto& s : segment_) n += s.local().size();
  dw.resize(n);
  std::size_t at = 0;
  for (int j = 0; j < segments(); ++j) {
    const auto& s = segment_[j];
    const std::size_t local = s.local().size() / s.pieces();
    for (int i = 0; i < s.pieces(); ++i, at += local)
      s.local_correction(i, &dx[column_of_state(j, i, 0)], dx[column_of_S(j)], dx[column_of_S(j + 1)],
                         dx[column_of_p()], &dw[at]);
  }
}

void Chain::apply(const std::vector<double>& x0, const std::vector<double>& w0, const std::vector<double>& dx,
                  double damping) {
  std::vector<double> x(x0);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += damping * dx[i];
  scatter(x);
  std::size_t at = 0;
  for (auto& s : segment_)
    for (double& w : s.local()) w = w0[at++];
}

bool Chain::tangent(const Closure& closure, std::vector<double>& t) {
  if (!assemble(closure)) return false;
  std::vector<double> b(rhs_.size(), 0.0);
  b.back() = 1.0;  // the closure row comes last
  t.assign(unknowns(), 0.0);
  lu_.solve(b, t);
  for (std::size_t i = 0; i < t.size(); ++i) t[i] *= scale_[i];
  return true;
}

double Chain::rounding_level() const {
  std::vector<double> b(row_rounding_.size()), y(unknowns());
  double most = 0.0;
  for (int signs = 1; signs <= 2; ++signs) {  // deterministic, without pattern
    for (std::size_t i = 0; i < b.size(); ++i)
      b[i] = std::cos(signs * 2.3 * static_cast<double>(i) * (1.0 + 0.01 * i)) > 0.0 ? row_rounding_[i]
                                                                                     : -row_rounding_[i];
    lu_.solve(b, y);
    for (double v : y) most = std::max(most, std::abs(v));
  }
  return std::isfinite(most) ? most : 0.0;
}

bool Chain::response(const Closure& closure, std::vector<double>& y, int load_case) {
  if (!assemble(closure)) return false;
  std::vector<double> load(rhs_.size());
  for (std::size_t i = 0; i < load.size(); ++i) load[i] = std::cos(load_case * (1.0 + 1.7 * static_cast<double>(i)));
  load.back() = 0.0;  // the closure row comes last
  y.assign(unknowns(), 0.0);
  lu_.solve(load, y);
  return true;
}

}  // namespace tendril::segmentation

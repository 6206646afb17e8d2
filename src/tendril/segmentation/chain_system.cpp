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
    first_column_.emplace_back();
    for (int q = 0; q < s.parts(); ++q) {
      if (q > 0) ++column;  // the place of the cut
      first_column_.back().push_back(column);
      column += (s.part(q).pieces() + 1) * s.states();
    }
  }
  state_columns_ = column;
  const int p = column_of_p(), multiplier = p + 1;
  blocks_.clear();
  auto states = [&](std::vector<int>& cols, int j, int part, int i) {
    const int ns = segment_[j].states();
    for (int q = 0; q < ns; ++q) cols.push_back(first_column_[j][part] + i * ns + q);
  };
  std::vector<int> cols;
  states(cols, 0, 0, 0);
  cols.push_back(column_of_S(0));
  cols.push_back(p);
  blocks_.push_back(cols);
  each_part([&](int j, int part, const collocation::Segment& s, double, double) {
    for (int i = 0; i < s.pieces(); ++i) {
      cols.clear();
      states(cols, j, part, i);
      cols.push_back(column_of_left(j, part));
      cols.push_back(column_of_right(j, part));
      cols.push_back(p);
      states(cols, j, part, i + 1);
      if (in_phase(j, part, i)) cols.push_back(multiplier);
      blocks_.push_back(cols);
    }
    const bool last = part + 1 == segment_[j].parts();
    if (last && j + 1 == segments()) return;
    cols.clear();  // a junction, or a cut
    states(cols, j, part, s.pieces());
    states(cols, last ? j + 1 : j, last ? 0 : part + 1, 0);
    cols.push_back(column_of_right(j, part));
    cols.push_back(p);
    blocks_.push_back(cols);
  });
  cols.clear();
  states(cols, segments() - 1, segment_.back().parts() - 1, segment_.back().part(segment_.back().parts() - 1).pieces());
  cols.push_back(column_of_S(segments()));
  cols.push_back(p);
  blocks_.push_back(cols);
  blocks_.emplace_back();  // the closure's, known when a system is solved
}

bool Chain::in_phase(int segment, int part, int piece) const {
  if (!phase_ || segment != phase_segment_) return false;
  int i = phase_piece_;
  return segment_[segment].part_of(i) == part && i == piece;
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
  each_part([&](int j, int part, const collocation::Segment&, double a, double b) {
    auto& s = segment_[j].part(part);
    const int ns = s.states();
    for (int i = 0; i < s.pieces() && ok; ++i) {
      if (!s.condense(i, a, b, condensed)) {
        ok = false;
        break;
      }
      add([&](double* q, double* v) {
        const bool phase = in_phase(j, part, i);
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
    if (part + 1 < segment_[j].parts()) {
      if (ok) add([&](double* q, double* v) { return cut_rows(j, part, q, v); });
    } else if (j + 1 < segments() && ok) {
      add([&](double* q, double* v) { return junction_rows(j, q, v); });
    }
  });
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
  bool evaluated = true;
  each_part([&](int j, int part, const collocation::Segment&, double a, double b) {
    auto& s = segment_[j].part(part);
    for (int i = 0; i < s.pieces() && evaluated; ++i) {
      int n = s.states();
      if (!s.residual(i, a, b, std::span<double>(r, n), &square)) {
        evaluated = false;
        return;
      }
      if (mechanics_->problem.planar) keep_piece_in_plane(line_[j], s.state(i), s.state(i + 1), r);
      if (in_phase(j, part, i)) {
        r[9] += multiplier_;
        r[n++] = s.state(i + 1)[3];
      }
      take(n);
    }
    if (!evaluated || (part + 1 == segment_[j].parts() && j + 1 == segments())) return;
    std::fill(values_.begin(), values_.end(), 0.0);
    take(part + 1 < segment_[j].parts() ? cut_rows(j, part, r, values_.data()) : junction_rows(j, r, values_.data()));
  });
  if (!evaluated) return false;
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
  each_part([&](int, int, const collocation::Segment& s, double, double) { n += s.local().size(); });
  dw.resize(n);
  std::size_t at = 0;
  each_part([&](int j, int part, const collocation::Segment& s, double, double) {
    const std::size_t local = s.local().size() / s.pieces();
    for (int i = 0; i < s.pieces(); ++i, at += local)
      s.local_correction(i, &dx[first_column_[j][part] + i * s.states()], dx[column_of_left(j, part)],
                         dx[column_of_right(j, part)], dx[column_of_p()], &dw[at]);
  });
}

void Chain::set_local(const double* w) {
  for (auto& s : segment_)
    for (int q = 0; q < s.parts(); ++q)
      for (double& x : s.part(q).local()) x = *w++;
}

void Chain::gather_local(std::vector<double>& w) const {
  w.clear();
  each_part([&](int, int, const collocation::Segment& s, double, double) {
    w.insert(w.end(), s.local().begin(), s.local().end());
  });
}

void Chain::apply(const std::vector<double>& x0, const std::vector<double>& w0, const std::vector<double>& dx,
                  double damping) {
  std::vector<double> x(x0);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += damping * dx[i];
  scatter(x);
  set_local(w0.data());
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

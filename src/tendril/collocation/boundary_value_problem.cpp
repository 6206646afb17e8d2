// Structure, linearisation and state of a boundary value problem; its Newton iteration is in
// boundary_value_newton.cpp.
#include "tendril/collocation/boundary_value_problem.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tendril::collocation {

BoundaryValueProblem::BoundaryValueProblem(Systems systems, Conditions conditions, int k)
    : system_(std::move(systems)), conditions_(std::move(conditions)) {
  for (const auto& s : system_) segment_.emplace_back(s.get(), k);
  knots_.resize(segment_.size());
  floor_.resize(segment_.size());
  for (std::size_t j = 0; j < segment_.size(); ++j) {
    floor_[j].assign(segment_[j].states(), 1.0);
    ends_ += 2 * segment_[j].states();
  }
  assert(conditions_.count == ends_ / 2);
}

void BoundaryValueProblem::initialise(const Sampler& sampler, int pieces, std::vector<std::vector<double>> knots) {
  if (!knots.empty()) knots_ = std::move(knots);
  bind();
  for (int j = 0; j < segments(); ++j)
    segment_[j].initialise(0.0, 1.0, knots_[j], pieces, [&](double x, double* u, double* q) { sampler(j, x, u, q); });
  number();
  solved_ = false;
}

void BoundaryValueProblem::set_scale(int segment, std::vector<double> floor) {
  assert(static_cast<int>(floor.size()) == segment_[segment].states());
  floor_[segment] = std::move(floor);
}

void BoundaryValueProblem::bind() const {
  for (const auto& s : system_) s->p = p_;
}

void BoundaryValueProblem::number() {
  first_column_.clear();
  state_columns_ = 0;
  for (const auto& s : segment_) {
    first_column_.push_back(state_columns_);
    state_columns_ += (s.pieces() + 1) * s.states();
  }
  analysed_ = false;
}

int BoundaryValueProblem::column_of_end(int index) const {
  if (index == ends_) return column_of_p();
  for (int j = 0;; ++j) {
    const int n = segment_[j].states();
    if (index < n) return column_of_state(j, 0, index);
    if (index < 2 * n) return column_of_state(j, segment_[j].pieces(), index - n);
    index -= 2 * n;
  }
}

std::vector<double> BoundaryValueProblem::ends() const {
  std::vector<double> e;
  for (const auto& s : segment_) {
    e.insert(e.end(), s.state(0), s.state(0) + s.states());
    e.insert(e.end(), s.state(s.pieces()), s.state(s.pieces()) + s.states());
  }
  return e;
}

int BoundaryValueProblem::pieces() const {
  int n = 0;
  for (const auto& s : segment_) n += s.pieces();
  return n;
}

void BoundaryValueProblem::evaluate(int segment, double x, double* inputs, double* quadratures) const {
  bind();
  segment_[segment].evaluate(x, 0.0, 1.0, inputs, quadratures);
}

double BoundaryValueProblem::end_value(int segment, bool right, int component, int derivative) const {
  const Segment& s = segment_[segment];
  return s.state(right ? s.pieces() : 0)[s.state_index(component, derivative)];
}

void BoundaryValueProblem::gather(std::vector<double>& x) const {
  x.clear();
  for (const auto& s : segment_) x.insert(x.end(), s.states_data().begin(), s.states_data().end());
  x.push_back(p_);
}

void BoundaryValueProblem::gather_all(std::vector<double>& x) const {
  gather(x);
  for (const auto& s : segment_) x.insert(x.end(), s.local().begin(), s.local().end());
}

void BoundaryValueProblem::scatter_all(const std::vector<double>& x) {
  std::size_t at = 0;
  for (auto& s : segment_)
    for (double& z : s.states_data()) z = x[at++];
  p_ = x[at++];
  for (auto& s : segment_)
    for (double& w : s.local()) w = x[at++];
}

void BoundaryValueProblem::update_scale() {
  scale_.assign(unknowns(), 1.0);
  for (int j = 0; j < segments(); ++j) {
    const auto& s = segment_[j];
    std::vector<double> most = floor_[j];
    for (int i = 0; i <= s.pieces(); ++i)
      for (int q = 0; q < s.states(); ++q) most[q] = std::max(most[q], std::abs(s.state(i)[q]));
    for (int i = 0; i <= s.pieces(); ++i) std::copy(most.begin(), most.end(), &scale_[column_of_state(j, i, 0)]);
  }
  scale_[column_of_p()] = p_scale_ > 0.0 ? p_scale_ : std::max(1.0, std::abs(p_));
}

std::vector<double> BoundaryValueProblem::metric() {
  update_scale();
  std::vector<double> m(unknowns());
  for (int i = 0; i < unknowns(); ++i) m[i] = 1.0 / (scale_[i] * scale_[i]);
  for (int j = 0; j < segments(); ++j) {
    const auto& s = segment_[j];
    for (int i = 0; i <= s.pieces(); ++i) {  // trapezoidal rule over the segment
      const double left = s.place(std::max(i - 1, 0), 0.0, 1.0), right = s.place(std::min(i + 1, s.pieces()), 0.0, 1.0);
      for (int q = 0; q < s.states(); ++q) m[column_of_state(j, i, q)] *= 0.5 * (right - left) / s.states();
    }
  }
  return m;
}

void BoundaryValueProblem::conditions_at(const Closure& closure, bool with_jacobian) {
  const std::vector<double> e = ends();
  const int n = conditions_.count, extra = closure.kind == Closure::Kind::condition ? 1 : 0;
  r_.assign(n + extra, 0.0);
  jac_.assign(with_jacobian ? static_cast<std::size_t>(n + extra) * (ends_ + 1) : 0, 0.0);
  conditions_.evaluate(e.data(), p_, r_.data(), with_jacobian ? jac_.data() : nullptr);
  if (extra)
    closure.condition.evaluate(e.data(), p_, &r_[n],
                               with_jacobian ? &jac_[static_cast<std::size_t>(n) * (ends_ + 1)] : nullptr);
}

bool BoundaryValueProblem::look(const Closure& closure) {
  const std::size_t size = static_cast<std::size_t>(conditions_.count + 1) * (ends_ + 1);
  bool fresh = pattern_.size() != size;
  if (fresh) pattern_.assign(size, 0);
  conditions_at(closure, true);
  for (std::size_t i = 0; i < jac_.size(); ++i)
    if (jac_[i] != 0.0 && !pattern_[i]) {
      pattern_[i] = 1;
      fresh = true;
    }
  return fresh;
}

// Conditions enter where the last end they read is complete; what reads one end only keeps no other end in the front.
void BoundaryValueProblem::arrange(const Closure& closure) {
  const int rows = conditions_.count + (closure.kind == Closure::Kind::condition ? 1 : 0);
  std::vector<int> end_of(ends_ + 1, 0);
  for (int j = 0, at = 0; j < segments(); ++j)
    for (int side = 0; side < 2; ++side)
      for (int q = 0; q < segment_[j].states(); ++q) end_of[at++] = 2 * j + side;
  std::vector<std::vector<int>> rows_at(2 * segments());
  for (int r = 0; r < rows; ++r) {
    int last = 0;
    for (int c = 0; c < ends_; ++c)
      if (pattern_[static_cast<std::size_t>(r) * (ends_ + 1) + c]) last = std::max(last, end_of[c]);
    rows_at[last].push_back(r);
  }
  blocks_.clear();
  columns_.clear();
  for (int e = 0; e < 2 * segments(); ++e) {
    const int j = e / 2, n = segment_[j].states();
    if (e % 2 == 1)
      for (int i = 0; i < segment_[j].pieces(); ++i) {
        std::vector<int> columns;
        for (int q = 0; q < n; ++q) columns.push_back(column_of_state(j, i, q));
        columns.push_back(column_of_p());
        for (int q = 0; q < n; ++q) columns.push_back(column_of_state(j, i + 1, q));
        blocks_.push_back({j, i, {}, {}});
        columns_.push_back(std::move(columns));
      }
    if (rows_at[e].empty()) continue;
    Block b{-1, -1, rows_at[e], {}};
    std::vector<int> columns;
    for (int c = 0; c <= ends_; ++c)
      if (std::any_of(b.rows.begin(), b.rows.end(),
                      [&](int r) { return pattern_[static_cast<std::size_t>(r) * (ends_ + 1) + c] != 0; })) {
        b.ends.push_back(c);
        columns.push_back(column_of_end(c));
      }
    blocks_.push_back(std::move(b));
    columns_.push_back(std::move(columns));
  }
}

bool BoundaryValueProblem::assemble(const Closure& closure, int held) {
  bind();
  update_scale();
  const bool changed = look(closure);
  if (changed || !analysed_ || held != held_) {
    arrange(closure);
    if (held >= 0) columns_.push_back({held});
    lu_.analyse(unknowns(), columns_);
    held_ = held;
    analysed_ = true;
  }
  rhs_.clear();
  lu_.begin();
  std::vector<double> values;
  Condensed condensed;
  const int closing = held >= 0 ? -1 : conditions_.count;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    const auto& columns = columns_[b];
    const std::size_t width = columns.size();
    int rows;
    if (block.segment >= 0) {
      Segment& s = segment_[block.segment];
      rows = s.states();
      if (!s.condense(block.piece, 0.0, 1.0, condensed)) return false;
      values.assign(rows * width, 0.0);
      for (int r = 0; r < rows; ++r) {
        const double* from = &condensed.rows[static_cast<std::size_t>(r) * (rows + 3)];
        double* to = &values[r * width];
        std::copy_n(from, rows, to);
        to[rows] = from[rows + 2];
        to[rows + 1 + r] = 1.0;
        rhs_.push_back(-condensed.residual[r]);
      }
    } else {
      rows = static_cast<int>(block.rows.size());
      values.assign(rows * width, 0.0);
      for (int r = 0; r < rows; ++r) {
        for (std::size_t c = 0; c < width; ++c)
          values[r * width + c] = jac_[static_cast<std::size_t>(block.rows[r]) * (ends_ + 1) + block.ends[c]];
        if (block.rows[r] == closing) closure_row_ = static_cast<int>(rhs_.size());
        rhs_.push_back(-r_[block.rows[r]]);
      }
    }
    for (int r = 0; r < rows; ++r)
      for (std::size_t c = 0; c < width; ++c) values[r * width + c] *= scale_[columns[c]];
    lu_.add_block(rows, values.data());
  }
  if (held >= 0) {
    const double one = 1.0;
    lu_.add_block(1, &one);
    closure_row_ = static_cast<int>(rhs_.size());
    rhs_.push_back(closure.kind == Closure::Kind::parameter ? (closure.value - p_) / scale_[held] : 0.0);
  }
  for (double v : rhs_)
    if (!std::isfinite(v)) return false;
  if (!lu_.finish()) return false;
  if (held >= 0) {  // direction with the held unknown growing by its scale
    std::vector<double> one(rhs_.size(), 0.0);
    one[closure_row_] = 1.0;
    plane_.assign(unknowns(), 0.0);
    lu_.solve(one, plane_);
  }
  return true;
}

bool BoundaryValueProblem::residual(const Closure& closure) {
  bind();
  conditions_at(closure, false);
  rhs_.clear();
  double out[256];
  for (const Block& block : blocks_) {
    if (block.segment >= 0) {
      Segment& s = segment_[block.segment];
      if (!s.residual(block.piece, 0.0, 1.0, std::span<double>(out, s.states()))) return false;
      for (int q = 0; q < s.states(); ++q) rhs_.push_back(-out[q]);
    } else {
      for (int r : block.rows) rhs_.push_back(-r_[r]);
    }
  }
  if (held_ >= 0) rhs_.push_back(closure.kind == Closure::Kind::parameter ? (closure.value - p_) / scale_[held_] : 0.0);
  return std::all_of(rhs_.begin(), rhs_.end(), [](double v) { return std::isfinite(v); });
}

// Scaled correction for the present right-hand side. On a plane: normal · (x + dx) = value by bordering.
void BoundaryValueProblem::correction(const Closure& closure, std::vector<double>& dx) {
  dx.assign(unknowns(), 0.0);
  lu_.solve(rhs_, dx);
  if (closure.kind != Closure::Kind::plane) return;
  std::vector<double> x;
  gather(x);
  double rest = closure.value, slope = 0.0;
  for (int i = 0; i < unknowns(); ++i) {
    rest -= closure.normal[i] * (x[i] + scale_[i] * dx[i]);
    slope += closure.normal[i] * scale_[i] * plane_[i];
  }
  for (int i = 0; i < unknowns(); ++i) dx[i] += rest / slope * plane_[i];
}

void BoundaryValueProblem::local_changes(const std::vector<double>& dx, std::vector<double>& dw) const {
  std::size_t n = 0;
  for (const auto& s : segment_) n += s.local().size();
  dw.resize(n);
  std::size_t at = 0;
  for (int j = 0; j < segments(); ++j) {
    const std::size_t local = segment_[j].local().size() / segment_[j].pieces();
    for (int i = 0; i < segment_[j].pieces(); ++i, at += local)
      segment_[j].local_correction(i, &dx[column_of_state(j, i, 0)], 0.0, 0.0, dx[column_of_p()], &dw[at]);
  }
}

}  // namespace tendril::collocation

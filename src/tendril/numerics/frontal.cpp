#include "tendril/numerics/frontal.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "tendril/numerics/kernels.hpp"

namespace tendril::numerics {

void FrontalLU::analyse(int columns, const std::vector<std::vector<int>>& block_columns) {
  columns_ = columns;
  block_columns_ = block_columns;
  std::vector<int> last(columns, -1);
  for (std::size_t b = 0; b < block_columns.size(); ++b)
    for (int c : block_columns[b]) last[c] = static_cast<int>(b);
  ready_.assign(block_columns.size(), {});
  for (int c = 0; c < columns; ++c) {
    assert(last[c] >= 0);
    ready_[last[c]].push_back(c);
  }
  // Largest number of columns in the front at any time fixes the leading dimension.
  std::vector<char> active(columns, 0);
  int width = 0, widest = 0;
  for (std::size_t b = 0; b < block_columns.size(); ++b) {
    for (int c : block_columns[b])
      if (!active[c]) {
        active[c] = 1;
        ++width;
      }
    widest = std::max(widest, width);
    width -= static_cast<int>(ready_[b].size());
  }
  ld_ = (widest + 7) / 8 * 8;
  slot_of_column_.assign(columns, -1);
}

void FrontalLU::begin() {
  std::fill(slot_of_column_.begin(), slot_of_column_.end(), -1);
  front_columns_.clear();
  front_rows_.clear();
  front_.clear();
  steps_.clear();
  upper_column_.clear();
  upper_value_.clear();
  lower_row_.clear();
  lower_value_.clear();
  row_scale_.clear();
  next_block_ = next_row_ = 0;
  singular_ = false;
}

void FrontalLU::add_block(int rows, const double* values) {
  const auto& columns = block_columns_[next_block_];
  const int width = static_cast<int>(columns.size());
  for (int c : columns)
    if (slot_of_column_[c] < 0) {
      slot_of_column_[c] = static_cast<int>(front_columns_.size());
      front_columns_.push_back(c);
    }
  const std::size_t first = front_rows_.size();
  front_.resize((first + rows) * ld_, 0.0);
  for (int r = 0; r < rows; ++r) {
    double* row = &front_[(first + r) * ld_];
    std::fill(row, row + ld_, 0.0);
    double most = 0.0;
    for (int j = 0; j < width; ++j) most = std::max(most, std::abs(values[r * width + j]));
    const double scale = most > 0 && std::isfinite(most) ? 1.0 / most : 1.0;  // row equilibration
    row_scale_.push_back(scale);
    for (int j = 0; j < width; ++j) row[slot_of_column_[columns[j]]] += scale * values[r * width + j];
    front_rows_.push_back(next_row_++);
  }
  for (int c : ready_[next_block_]) eliminate(c);
  ++next_block_;
}

void FrontalLU::eliminate(int column) {
  const int slot = slot_of_column_[column];
  const int rows = static_cast<int>(front_rows_.size());
  int best = -1;
  double most = 0.0;
  for (int r = 0; r < rows; ++r) {
    const double a = std::abs(front_[static_cast<std::size_t>(r) * ld_ + slot]);
    if (a > most) {
      most = a;
      best = r;
    }
  }
  if (best < 0 || !std::isfinite(most)) {
    singular_ = true;
    return;
  }
  const int width = static_cast<int>(front_columns_.size());
  const int last_slot = width - 1;
  // Move the pivot column to the last slot, so that the remaining columns stay contiguous.
  if (slot != last_slot) {
    for (int r = 0; r < rows; ++r) {
      double* row = &front_[static_cast<std::size_t>(r) * ld_];
      std::swap(row[slot], row[last_slot]);
    }
    front_columns_[slot] = front_columns_[last_slot];
    slot_of_column_[front_columns_[slot]] = slot;
  }
  front_columns_.pop_back();
  slot_of_column_[column] = -1;
  // Move the pivot row to the end.
  if (best != rows - 1) {
    double* a = &front_[static_cast<std::size_t>(best) * ld_];
    double* b = &front_[static_cast<std::size_t>(rows - 1) * ld_];
    std::swap_ranges(a, a + width, b);
    std::swap(front_rows_[best], front_rows_[rows - 1]);
  }
  double* pivot_row = &front_[static_cast<std::size_t>(rows - 1) * ld_];
  const double pivot = pivot_row[last_slot];
  Step step{front_rows_[rows - 1],
            column,
            static_cast<int>(upper_value_.size()),
            0,
            static_cast<int>(lower_value_.size()),
            0,
            pivot};
  for (int j = 0; j < last_slot; ++j)
    if (pivot_row[j] != 0.0) {
      upper_column_.push_back(front_columns_[j]);
      upper_value_.push_back(pivot_row[j]);
    }
  step.upper_end = static_cast<int>(upper_value_.size());
  for (int r = 0; r < rows - 1; ++r) {
    double* row = &front_[static_cast<std::size_t>(r) * ld_];
    const double a = row[last_slot];
    if (a == 0.0) continue;
    const double m = a / pivot;
    subtract_multiple(row, pivot_row, m, last_slot);
    row[last_slot] = 0.0;
    lower_row_.push_back(front_rows_[r]);
    lower_value_.push_back(m);
  }
  step.lower_end = static_cast<int>(lower_value_.size());
  std::fill(pivot_row, pivot_row + width, 0.0);
  steps_.push_back(step);
  front_rows_.pop_back();
  front_.resize(static_cast<std::size_t>(rows - 1) * ld_);
}

bool FrontalLU::finish() {
  if (static_cast<int>(steps_.size()) != columns_ || !front_rows_.empty()) singular_ = true;
  return !singular_;
}

void FrontalLU::solve(std::span<const double> b, std::span<double> x) const {
  assert(!singular_ && static_cast<int>(b.size()) == next_row_ && static_cast<int>(x.size()) == columns_);
  work_.resize(b.size());
  for (std::size_t i = 0; i < b.size(); ++i) work_[i] = b[i] * row_scale_[i];
  for (const Step& s : steps_) {
    const double f = work_[s.row];
    if (f == 0.0) continue;
    for (int i = s.lower_begin; i < s.lower_end; ++i) work_[lower_row_[i]] -= lower_value_[i] * f;
  }
  for (auto s = steps_.rbegin(); s != steps_.rend(); ++s) {
    double f = work_[s->row];
    for (int i = s->upper_begin; i < s->upper_end; ++i) f -= upper_value_[i] * x[upper_column_[i]];
    x[s->column] = f / s->pivot;
  }
}

int FrontalLU::determinant_sign() const {
  if (singular_) return 0;
  // det = sign of the permutation row -> column times the product of the pivots
  std::vector<int> column_of_row(columns_, -1);
  int sign = 1;
  for (const Step& s : steps_) {
    column_of_row[s.row] = s.column;
    if (s.pivot < 0) sign = -sign;
  }
  std::vector<char> seen(columns_, 0);
  for (int i = 0; i < columns_; ++i) {
    int length = 0;
    for (int j = i; !seen[j]; j = column_of_row[j]) {
      seen[j] = 1;
      ++length;
    }
    if (length > 0 && length % 2 == 0) sign = -sign;
  }
  return sign;
}

}  // namespace tendril::numerics

#pragma once
// Frontal LU with row pivoting for almost-block-diagonal systems with borders (an unknown that many blocks share simply
// stays in the front until its last block). Rows arrive block by block; a column is eliminated as soon as no later
// block touches it, choosing the largest pivot among the rows of the front. Same stability as a banded LU with partial
// pivoting. The factors are kept for further right-hand sides.

#include <span>
#include <vector>

namespace tendril::numerics {

class FrontalLU {
 public:
  /// Announce the structure: for every row block the columns it touches, in the order the blocks will arrive.
  void analyse(int columns, const std::vector<std::vector<int>>& block_columns);

  void begin();
  /// Add the next block: `rows` rows, row-major over that block's columns.
  void add_block(int rows, const double* values);
  /// True when the system is square and every column found a nonzero pivot.
  bool finish();

  /// Solve in place: b has one entry per row (in order of arrival); x one per column.
  void solve(std::span<const double> b, std::span<double> x) const;

  int determinant_sign() const;  // sign of det of the (row-equilibrated) matrix, 0 if singular
  int size() const { return columns_; }

 private:
  struct Step {  // one elimination
    int row, column;
    int upper_begin, upper_end;  // into upper_* : remaining entries of the pivot row
    int lower_begin, lower_end;  // into lower_* : multipliers
    double pivot;
  };
  int columns_ = 0;
  std::vector<std::vector<int>> block_columns_;
  std::vector<std::vector<int>> ready_;  // columns complete after block b
  std::vector<int> slot_of_column_;      // -1: not in the front
  std::vector<int> front_columns_, front_rows_;
  std::vector<double> front_;  // row-major, ld_ columns
  int ld_ = 0, next_block_ = 0, next_row_ = 0;
  std::vector<Step> steps_;
  std::vector<int> upper_column_, lower_row_;
  std::vector<double> upper_value_, lower_value_, row_scale_;
  mutable std::vector<double> work_;
  bool singular_ = false;

  void eliminate(int column);
};

}  // namespace tendril::numerics

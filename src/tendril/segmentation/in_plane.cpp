#include "tendril/segmentation/in_plane.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tendril/segmentation/chain.hpp"

namespace tendril::segmentation {
namespace {

int states(bool line) { return line ? 8 : 12; }

/// Angles (φ, β, ψ) keep their constant value, everything else is zero.
double fault(bool line, int state, const double* z) {
  const bool angle = line ? state == 0 || state == 3 : state == 6;
  return angle ? 0.0 : z[state];
}

void keep(int row, double value, int column, double* r, double* values, int width) {
  r[row] = value;
  if (!values) return;
  std::fill_n(values + row * width, width, 0.0);
  values[row * width + column] = 1.0;
}

}  // namespace

void keep_piece_in_plane(bool line, const double* z_left, const double* z_right, double* r, double* values, int width) {
  const auto& out = out_of_plane(line);
  for (int i = 0; i < 3; ++i) keep(out[i], fault(line, out[i], z_right), states(line) + 3 + out[i], r, values, width);
  for (int i = 3; i < 6; ++i) keep(out[i], fault(line, out[i], z_left), out[i], r, values, width);
}

void keep_end_in_plane(bool line, bool left, const int* rows, const double* z, double* r, double* values, int width) {
  const auto& out = out_of_plane(line);
  for (int i = 0; i < 3; ++i) {
    const int q = out[left ? i : 3 + i];
    keep(rows[i], fault(line, q, z), q, r, values, width);
  }
}

void keep_junction_in_plane(bool left_line, bool right_line, const std::array<int, 6>& rows, const double* z_left,
                            const double* z_right, double* r, double* values) {
  const int nl = states(left_line), width = nl + states(right_line) + 2;
  for (int i = 0; i < 3; ++i) {
    const int a = out_of_plane(right_line)[i], b = out_of_plane(left_line)[3 + i];
    keep(rows[i], fault(right_line, a, z_right), nl + a, r, values, width);
    keep(rows[3 + i], fault(left_line, b, z_left), b, r, values, width);
  }
}

void Chain::flatten() {
  const ScaledProblem& P = mechanics_->problem;
  if (!P.planar) return;
  const double roll = P.now(P.source.twist_at == Which::end ? P.start.roll : P.end.roll);
  for (int j = 0; j < segments(); ++j)
    for (int part = 0; part < segment_[j].parts(); ++part) {
      auto& s = segment_[j].part(part);
      for (int i = 0; i <= s.pieces(); ++i) {
        double* z = s.state(i);
        for (const int q : out_of_plane(line_[j])) z[q] -= fault(line_[j], q, z);
        if (line_[j])
          z[0] = std::numbers::pi * std::round(z[0] / std::numbers::pi);  // on one wall or the other
        else
          z[6] = roll;
      }
      // highest derivatives: free δ1 δ2 φ F1 F2 F3, line β ψ F_g F3
      for (int i = 0; i < s.pieces(); ++i)
        for (int g = 0; g < s.points_per_piece(); ++g)
          for (const int c : line_[j] ? std::array{0, 1, 2} : std::array{1, 2, 4}) s.highest(i, g, c) = 0.0;
    }
}

}  // namespace tendril::segmentation

#pragma once
// The planar chain: in a plane of symmetry, δ2 = 0, the equations of what leaves the plane separate from the others.
// Their rows give way to "stays as it is", so that the linear system is that of the planar problem: its determinant,
// its singular states and its bifurcations are those of a rod between two parallel walls. Half of these unknowns are
// held from the left neighbour and half from the right, as the end conditions are.

#include <array>

namespace tendril::segmentation {

/// Unknowns that leave the plane; the first three are held at the left end, the others at the right.
/// Free: δ2, δ2', φ | δ2'', φ', F2. Line contact: β, β', ψ | β'', ψ', F_g.
inline constexpr std::array<int, 6> free_out_of_plane{3, 4, 6, 5, 7, 9}, line_out_of_plane{0, 1, 3, 2, 4, 5};
inline constexpr const std::array<int, 6>& out_of_plane(bool line) {
  return line ? line_out_of_plane : free_out_of_plane;
}

/// Rows r and derivatives (row-major, `width` columns) rewritten; `values` may be null. z: states at the places.
/// A piece: columns z_i | S_a S_b p | z_{i+1} | ...
void keep_piece_in_plane(bool line, const double* z_left, const double* z_right, double* r, double* values = nullptr,
                         int width = 0);
/// An end: columns z | ...; `rows` are the three rows that leave the plane.
void keep_end_in_plane(bool line, bool left, const int* rows, const double* z, double* r, double* values, int width);
/// A junction: columns z of the left segment | z of the right | S p; `rows` are the six rows that leave the plane.
void keep_junction_in_plane(bool left_line, bool right_line, const std::array<int, 6>& rows, const double* z_left,
                            const double* z_right, double* r, double* values);

}  // namespace tendril::segmentation

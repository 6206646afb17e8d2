#pragma once
// A C4 quintic spline curve R(t) run by its true arc length, with its Bishop frame. Every piece is cut into cells short
// enough for convergent power series about their middle: x(σ), parameter from arc length (reversion of σ = ∫|R'|dx),
// and the angle ψ between the Bishop frame and the frame carried from the middle by the minimal rotation. Evaluation is
// then three polynomials and no iteration; both series are cut at rounding, so R is C4 in S to rounding.

#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/quintic_spline.hpp"

namespace tendril::geometry {

/// The curve as an axis: the spline's breaks become its knots. Throws where the spline stops (|R'| below 1/20 of its
/// mean on the piece) or kinks (cells of 1/1024 of a piece would not be short enough).
AxisPtr make_spline_axis(const PiecewiseQuintic<3>& curve, const Normal& normal);

/// Arc length of the spline from its start to each of the ascending parameters t.
std::vector<double> arc_lengths(const PiecewiseQuintic<3>& curve, const std::vector<double>& t);

}  // namespace tendril::geometry

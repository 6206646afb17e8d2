#pragma once
// A collocation solution in B-form: component c of order m_c is a spline of order k + m_c with m_c - 1 continuous
// derivatives on the mesh, k N + m_c control points (IV.1.1-6: orders k+3, k+2, k+1 in C2, C1, C0). The conversion is
// exact; bounds of values and of the distance from the axis follow from control points.

#include <utility>
#include <vector>

#include "tendril/collocation/segment.hpp"
#include "tendril/numerics/b_spline.hpp"

namespace tendril::collocation {

/// Component on every piece, on [0,1].
std::vector<numerics::Bernstein> bernstein_pieces(const Segment& segment, int component, double a, double b);

/// All components over [a, b].
std::vector<numerics::BSpline> b_splines(const Segment& segment, double a, double b);

/// Bounds of u_1² + u_2² of two components of the same order over the whole segment, each to within `accuracy` on the
/// safe side.
std::pair<double, double> squared_norm_bounds(const Segment& segment, int component_1, int component_2, double a,
                                              double b, double accuracy);

}  // namespace tendril::collocation

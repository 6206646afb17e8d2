#pragma once
// Axes made from axes: moved, scaled, mirrored, reversed, cut, or carrying another frame. Every wrapper holds its
// original and transforms each section, so derivatives stay as exact as the original's. Frames are carried along (a
// reversed or mirrored frame keeps ±D1 and stays right-handed); with_normal starts the frame anew.

#include <array>
#include <functional>

#include "tendril/geometry/axes.hpp"

namespace tendril::geometry {

/// Same curve, frame turned by a constant angle about D3 so that D1(0) is the part of `normal` normal to D3(0); without
/// a normal the default of axes.hpp.
AxisPtr with_normal(AxisPtr axis, const Normal& normal = {});

/// R -> rotation R + shift. `rotation` must be a rotation matrix (to 1e-12).
AxisPtr rotate_translate(AxisPtr axis, const Mat3& rotation, const Vec3& shift);

/// R -> factor R, factor > 0.
AxisPtr scaled(AxisPtr axis, double factor);

/// Mirror image in the plane through the origin with this normal: D1 -> M D1, D2 -> -M D2, (U1, U2, U3) -> (-U1, U2,
/// -U3).
AxisPtr mirror(AxisPtr axis, const Vec3& plane_normal = Vec3::UnitX());

/// Run from the other end: S -> L - S, D1 kept, D2 and D3 opposite, (U1, U2, U3) -> (-U1, U2, U3).
AxisPtr reverse(AxisPtr axis);

/// The part S0 <= S <= S1, its arc length counted from S0.
AxisPtr subrange(AxisPtr axis, double S0, double S1);

/// γ, γ', γ'', γ''', γ'''' at S [rad length^-j].
using FrameAngle = std::function<std::array<double, 5>(double)>;

/// Same curve with the frame turned about D3 by γ(S): U3 -> U3 + γ'. For laws that must not depend on the frame.
AxisPtr with_frame_twist(AxisPtr axis, FrameAngle gamma);

}  // namespace tendril::geometry

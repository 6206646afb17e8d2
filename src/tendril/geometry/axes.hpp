#pragma once
// Reference curves in closed form. Straight line, arc, helix and torus ring are one family, the curves of constant
// curvature and torsion, whose Bishop frame is exact: D1 = cosΦ n + sinΦ b with Φ' = -τ, U1 = κ sinΦ, U2 = κ cosΦ
// (II.3, model section 7). D1(0) is the given normal's part normal to D3(0); without one it is the Frenet normal at
// S = 0, or on a straight line the first world axis not along D3. D2 = D3 x D1.

#include <memory>
#include <optional>

#include "tendril/geometry/axis.hpp"

namespace tendril::geometry {

using AxisPtr = std::shared_ptr<const Axis>;
using Normal = std::optional<Vec3>;  // wished direction of D1(0), world; need not be normal to D3(0) nor of unit length

/// Straight line from `origin` along `direction` (any length > 0).
AxisPtr make_straight(double length, const Vec3& direction = Vec3::UnitZ(), const Vec3& origin = Vec3::Zero(),
                      const Normal& normal = {});

/// Circular arc in the x-z plane from the origin, starting along z and bending towards +x.
AxisPtr make_arc(double radius, double length, const Normal& normal = {});

/// R = (r cos ω, r sin ω, z) from ω = 0. pitch_angle: between tangent and helix axis [rad], > 0 right-handed,
/// < 0 left-handed, at most π/2 in magnitude.
AxisPtr make_helix(double radius, double pitch_angle, double length, const Normal& normal = {});

/// Ring of radius `major_radius` in the x-y plane from (major_radius, 0, 0), counter-clockwise about z, run once.
AxisPtr make_torus(double major_radius, const Normal& normal = {});

/// D1(0) and with it the frame (columns) for tangent D3, wished normal, and curvature vector R''(0) for the default.
/// A curvature below `straight_below` counts as none. Throws if the wished normal is along D3.
Mat3 starting_frame(const Vec3& D3, const Normal& normal, const Vec3& curvature_vector, double straight_below);

}  // namespace tendril::geometry

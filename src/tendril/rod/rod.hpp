#pragma once
// A uniform, initially straight rod with circular response: bending, twisting and stretching stiffness (II.1.4).

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace tendril::rod {

struct Rod {
  double bending_stiffness = 1.0;         // EI = B                       [force length^2]
  double torsional_stiffness = 1.0;       // GJ = C                       [force length^2]
  std::optional<double> axial_stiffness;  // EA = A; none: inextensible   [force]
};

/// A vector of the world frame over the axis: straight between the places S (ascending), constant beyond them.
struct LoadField {
  std::vector<double> S;               // [length]
  std::vector<Eigen::Vector3d> value;  // as many

  bool none() const { return S.empty(); }
  /// Value and slope at a place; at one of `S` the slope behind it.
  Eigen::Vector3d at(double place, Eigen::Vector3d* slope = nullptr) const;
};

/// Forces and couples per unit reference length, fixed in the world frame.
struct BodyLoad {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   // [force/length]
  Eigen::Vector3d couple = Eigen::Vector3d::Zero();  // [force]
  LoadField force_field, couple_field;               // the same over the axis, in addition
  // Of a varying rod: direction of the section's weight (`SectionLaw`), 1 long for weight as given.
  Eigen::Vector3d weight_direction = Eigen::Vector3d::Zero();
  bool couples() const { return !couple.isZero() || !couple_field.none(); }
};

/// A concentrated force and couple, fixed in the world frame, at a place S of the axis or, `on_rod`, at the arc length
/// s of the rod, counted as its section law is.
struct PointLoad {
  bool on_rod = false;
  double at = 0.0;                                   // [length]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   // [force]
  Eigen::Vector3d couple = Eigen::Vector3d::Zero();  // [force length]
};

/// A stabiliser or tool joint: a ring on the rod at s, counted as the section law is, that stands out from it by
/// `height` and so touches the wall before the rod does.
struct Collar {
  double s = 0.0, height = 0.0;  // [length]
};

}  // namespace tendril::rod

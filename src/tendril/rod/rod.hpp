#pragma once
// A uniform, initially straight rod with circular response: bending, twisting and stretching stiffness (II.1.4).

#include <Eigen/Core>
#include <optional>

namespace tendril::rod {

struct Rod {
  double bending_stiffness = 1.0;         // EI = B                       [force length^2]
  double torsional_stiffness = 1.0;       // GJ = C                       [force length^2]
  std::optional<double> axial_stiffness;  // EA = A; none: inextensible   [force]
};

/// Forces and couples per unit reference length, fixed in the world frame.
struct BodyLoad {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   // [force/length]
  Eigen::Vector3d couple = Eigen::Vector3d::Zero();  // [force]
  // Of a varying rod: direction of the section's weight (`SectionLaw`), 1 long for weight as given.
  Eigen::Vector3d weight_direction = Eigen::Vector3d::Zero();
};

}  // namespace tendril::rod

#pragma once
// The global problem: one rod, one tube, two ends, one load. Case's units throughout; the solvers scale by the
// axis length and the bending stiffness themselves. A value that follows the path parameter p carries its rate d/dp.

#include <Eigen/Core>
#include <vector>

#include "tendril/geometry/tube.hpp"
#include "tendril/rod/rod.hpp"
#include "tendril/rod/section_law.hpp"

namespace tendril::segmentation {

/// A scalar of the problem and its derivative with respect to the path parameter.
struct Scalar {
  double value = 0.0;
  double rate = 0.0;
  Scalar() = default;
  Scalar(double v, double r = 0.0) : value(v), rate(r) {}  // NOLINT: a number is a scalar that does not move
};

/// Force and couple on a free tip: dead, in the world frame, or following the rod, along its directors d1, d2, d3.
struct TipLoad {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   // [force]
  Eigen::Vector3d couple = Eigen::Vector3d::Zero();  // [force length]
  bool follower = false;
  bool none() const { return force.isZero() && couple.isZero(); }
};

/// Where and how the centreline is held at one end. Guided: the tangent is the axis', the place in the section free, no
/// force across. Free (the far end only): neither is held; a wall that the tip meets bears it without friction.
struct End {
  enum class Kind { clamped, sleeve, pinned, guided, free } kind = Kind::clamped;
  Scalar eccentricity[2];  // δ1, δ2                     [length] (not used when guided or free)
  Scalar slope[2];         // dδ1/dS, dδ2/dS             [-] (not used when pinned, guided or free)
  Scalar roll;             // φ at this end when this end fixes it  [rad]
  TipLoad tip;             // free
};

enum class AxialControl { axial_force, push, rod_length };  // F3 inside the end | -H | unstressed length
enum class TwistControl { torque, twist };                  // M3 | φ of the directors
enum class Which { start, end };
enum class BranchRule { stable, symmetric, planar, nearest };

/// Small inclination and Lagrangian states are reported with their differences from the Eulerian ones.
enum class Formulation { eulerian, small_inclination, lagrangian };

struct SolveOptions {
  double tolerance = 1e-8;  // relative, between nodes
  BranchRule branch = BranchRule::stable;
  Formulation formulation = Formulation::eulerian;
  int collocation_points = 7;         // k = 4..7
  double max_seconds = 0.0;           // 0: no limit
  bool residual_line_search = false;  // Algorithms IV.2-IV.3 instead of the affine-invariant damping
  bool nested = false;                // SolveSequence (Broyden/sensitivity) instead of the chain Newton
};

struct Problem {
  geometry::Tube tube;
  Scalar clearance_scale{1.0};  // multiplies Q(S)
  rod::Rod rod;
  rod::SectionLaw law;  // of a rod that varies along its length; `rod` then is only its scale
  rod::BodyLoad load;
  std::vector<rod::PointLoad> point_loads;
  std::vector<rod::Collar> collars;  // ascending
  Scalar body_force_scale{1.0};
  Scalar body_couple_scale{1.0};
  Scalar point_load_scale{1.0};
  End start, end;
  Scalar end_position;  // S of the far end (default: the axis' length)     [length]
  AxialControl axial = AxialControl::axial_force;
  Which axial_at = Which::end;  // which end the axial condition belongs to
  Scalar axial_value;           // [force], a free tip's is added to its load; or, rod_length, [length]
  TwistControl twist = TwistControl::torque;
  Which twist_at = Which::end;  // the other end fixes the roll φ
  Scalar twist_value;           // [force length] or [rad]
  int turns = 0;                // outside problems: winding between the ends
  double rod_diameter = 0.0;    // outer; 0: not known. Tells where the rod meets itself     [length]
  bool planar = false;          // hold rod and wall to the plane of D1 and D3, where that is a plane of symmetry
};

}  // namespace tendril::segmentation

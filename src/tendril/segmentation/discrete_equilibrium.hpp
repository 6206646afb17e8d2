#pragma once
// Minimisation of the discrete rod's energy against the wall under one axial and one torsional control: modified
// Newton, shifted by the mass matrix until the inertia is that of a minimum (an implicit step of viscous motion), with
// a line search. Held length: the saddle in λ is solved inside the merit function, so the merit is the energy at that
// length; an inextensible rod gets a small compliance d(λ - λ0) in series, removed by updating λ0. Held twist likewise,
// with M3 for λ.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tendril/numerics/stop.hpp"
#include "tendril/segmentation/discrete_rod.hpp"

namespace tendril::segmentation {

class DiscreteEquilibrium {
 public:
  explicit DiscreteEquilibrium(DiscreteRod rod);

  const DiscreteRod& rod() const { return rod_; }

  // ---- controls ----
  std::vector<Vector4> fixed;  // 1: degree of freedom held, 0: free
  bool length_held = false;
  double length_target = 1.0;      // unstressed length
  double length_compliance = 0.0;  // d, in series with the rod
  double length_multiplier = 0.0;  // λ0
  bool twist_held = false;
  double twist_target = 0.0;  // φ(end) - φ(start)
  double twist_length = 1.0;  // length the torsional stiffness is taken over
  double twist_share = 1.0;   // mean torsional compliance over that of the scale
  // ---- wall ----
  double wall_stiffness = 0.0;          // per unit S
  std::vector<double> wall_multiplier;  // at the quadrature points, >= 0
  std::vector<double> wall_share;       // at the quadrature points: of the stiffness, 1 unless set
  // ---- of an end that nothing holds across ----
  Vector4 tip_load = Vector4::Zero();                       // conjugate to δ1, δ1', δ2, δ2' of the last node
  std::vector<std::pair<std::size_t, Vector4>> node_loads;  // the same of other nodes: point loads
  bool tip_wall = false;
  double tip_stiffness = 0.0, tip_multiplier = 0.0;
  double tip_reaction() const;  // of the wall on the last node, compressive > 0
  // ---- ties to a given state: ½ k |δ - anchor|² per unit S ----
  double anchor_stiffness = 0.0;
  std::vector<Vector4> anchor;
  numerics::Stop stop;  // asked before every step
  // ---- state ----
  std::vector<Vector4> u;
  double lambda = 0.0, torque = 0.0;

  struct Totals {
    double merit = 0.0, length = 0.0, length_rate = 0.0, writhe = 0.0;  // writhe: ∫ c dS
    double lambda = 0.0, torque = 0.0;
    bool valid = false;
  };
  Totals totals(const std::vector<Vector4>& at);

  struct Report {
    bool converged = false;
    int iterations = 0, factorisations = 0;
  };
  /// Steps until a full one corrects no eccentricity by more than `tolerance`.
  Report minimise(double tolerance, int max_iterations, double step_cap);

  void update_wall_multipliers();
  /// Force of the wall on the rod per unit S at a quadrature point, compressive > 0.
  double wall_pressure(std::size_t point) const;
  double wall_penetration(std::size_t point) const;  // ς(|δ| - Q)
  double stiffness(std::size_t point) const { return wall_stiffness * wall_share[point]; }

  /// Negative eigenvalues of the energy at the held (or, `length_held` false, free) length and twist, on the present
  /// wall set. Eigenvalues above -shift in the L² metric are not counted.
  int negative_eigenvalues(double shift);
  /// Direction of a negative eigenvalue, largest |δ| = 1; nothing when there is none below -shift.
  std::optional<std::vector<Vector4>> unstable_direction(double shift);
  /// dλ/dℓ at equilibrium with twist control as set, and du/dℓ.
  double lambda_slope(std::vector<Vector4>& du);
  /// ∂e/∂δ'' at an end from the residual of its held slope (a clamped end's bending moment), free end: zero.
  Eigen::Vector2d end_couple(bool at_end);
  /// ½κ² at an end from end_couple.
  double end_bending_energy(bool at_end);

 private:
  struct Cached {
    formulation::DensityInvariants q;
  };
  void assemble();
  double tip_reaction_at(const Vector4& node) const;
  int factor(double shift);  // negative eigenvalues of the constrained problem
  void border_solve(std::vector<Vector4>& x, const Eigen::Vector2d& rhs, Eigen::Vector2d& y);
  void hold(std::vector<Vector4>& x) const;
  int borders() const { return (length_held ? 1 : 0) + (twist_held ? 1 : 0); }

  DiscreteRod rod_;
  BlockTridiagonal mass_, K_, shifted_;
  std::vector<Vector4> gradient_, free_gradient_, apart_, pull_;
  std::vector<Vector4> border_[2], solved_[2];
  Eigen::Matrix2d schur_;
  Eigen::Vector2d border_diagonal_ = Eigen::Vector2d::Zero();
  std::vector<Cached> cache_;
};

}  // namespace tendril::segmentation

#pragma once
// Discovery of the contact pattern from nothing: a stable equilibrium of the rod in its tube as a minimiser of the
// discrete energy (discrete_rod.hpp) with a penalised wall, sharpened by multiplier updates (augmented Lagrangian).
// What comes out is a start for the sharp solvers: fields to a few digits, loaded stretches of wall read as points and
// lines. Scaled by L and B.

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "tendril/numerics/stop.hpp"
#include "tendril/segmentation/discrete_rod.hpp"
#include "tendril/segmentation/problem.hpp"

namespace tendril::segmentation {

/// One end of the discrete rod: clamped or sleeve fix δ and δ', pinned fixes δ, guided fixes δ', free nothing.
struct HeldEnd {
  bool pinned = false, guided = false, free = false;
  bool open() const { return guided || free; }
  /// 1: δ1, δ1', δ2, δ2' held.
  Vector4 held() const {
    const double place = open() ? 0.0 : 1.0, slope = pinned || free ? 0.0 : 1.0;
    return {place, slope, place, slope};
  }
  Eigen::Vector2d eccentricity = Eigen::Vector2d::Zero();  // [L]
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();         // dδ/dS
};

struct DiscoveryProblem {
  geometry::Tube tube;
  DiscreteRodData data;
  HeldEnd start, end;
  double end_position = 1.0;  // [L]
  AxialControl axial = AxialControl::axial_force;
  Which axial_at = Which::end;
  Eigen::Vector3d tip_force = Eigen::Vector3d::Zero(), tip_couple = Eigen::Vector3d::Zero();  // of a free end, in D
  double axial_value = 0.0;  // F3 [B/L²] (of a free end, beyond its load) | push P = -H [B/L²] | length [L]
  TwistControl twist = TwistControl::torque;
  double twist_value = 0.0;                    // M3 [B/L] | φ(end) - φ(start) [rad]
  int turns = 0;                               // outside: winding of the start guess
  double length_unit = 1.0, force_unit = 1.0;  // L and B/L², for messages
};

/// Nodal state; a previous one may serve as start (interpolated to the new nodes).
struct DiscreteState {
  std::vector<double> S;   // nodes                     [L]
  std::vector<Vector4> u;  // δ1, δ1', δ2, δ2'
  double lambda = 0.0;     // ½ω² + F3 + ½η²F3² + σ·r   [B/L²]
  double torque = 0.0;     // M3                        [B/L]
  double length = 0.0;     // unstressed                [L]
};

/// δ1, δ1', δ1'', δ2, δ2', δ2'' of a nodal state at S.
formulation::Vector6 evaluate(const DiscreteState& state, double S);

struct DiscoveryOptions {
  int elements = 0;           // 0: from the bending length and the axis, at least 40
  bool perturb = true;        // leave symmetric states along unstable modes
  bool planar = false;        // hold δ2 = 0
  bool march_length = false;  // skip the direct attempt at fixed λ
  bool ease = false;          // from the rod tied to the start guess, the ties loosened
  const DiscreteState* initial = nullptr;
  // A result to be refined: its elements are cut to `fineness` of the local bending length, its state and wall pressure
  // are where the search starts.
  const struct DiscoveryResult* coarse = nullptr;
  double fineness = 0.25;
  bool leave = false;          // the refined state is left along an unstable direction that the coarse one did not show
  double tolerance = 1e-6;     // largest last correction of δ / clearance <= tolerance
  int multiplier_updates = 4;  // of the wall
  int max_iterations = 800;    // Newton iterations altogether
  numerics::Stop stop;         // asked before every step of a minimisation
};

/// A stretch of loaded wall.
struct FoundContact {
  bool line = false;
  double start = 0.0, end = 0.0;              // S [L] (equal for a point)
  double angle_start = 0.0, angle_end = 0.0;  // β
  double force = 0.0;                         // sum of magnitudes [B/L²], lines: ends included
  double force_start = 0.0, force_end = 0.0;  // lines: estimated concentrated ends
};

/// How near a state is to where the formulation ends: least d3·D3 and least C3 = 1 - K·Δ, each with its place [L].
struct Reach {
  double inclination = 1.0, inclination_S = 0.0;
  double spread = 1.0, spread_S = 0.0;
  /// Below these nothing is asked of the sharp solvers.
  static constexpr double least_inclination = 0.2, least_spread = 0.1;
  bool within() const { return inclination >= least_inclination && spread >= least_spread; }
  std::string words(double length_unit) const;
};

struct DiscoveryResult {
  bool converged = false;
  std::string message;
  DiscreteState state;
  std::vector<double> phi, s;                                   // at the nodes, from 0 at the start
  std::function<rod::Properties<double>(double S)> properties;  // of a varying rod, as they were taken
  std::function<double(double S)> gain;
  double axial_force_start = 0.0, axial_force_end = 0.0;  // F3 [B/L²]
  double H_start = 0.0, H_end = 0.0;                      // λ - σ·r at the ends
  bool dead_push = false;                                 // found at held λ
  Reach reach;               // of the state; of a search that failed, of its minima on the way
  double force_slope = 0.0;  // dF3/dℓ at the controlled end at fixed torque/twist
  int negative = 0;          // negative eigenvalues at fixed length (symmetry shifted away)
  std::vector<double> wall_S, wall_pressure, wall_gap;  // at quadrature points: compressive force per unit S, gap
  std::vector<double> wall_weight;                      // quadrature weights dS
  std::vector<FoundContact> contacts;                   // ordered in S
  std::vector<char> collars;                            // that touch the wall; empty: none
  double tip_reaction = 0.0;                            // of an end open across that rests on the wall [B/L²]
  int iterations = 0, factorisations = 0;
};

/// Loaded stretches of wall read as points and lines, from the pressure (per unit S) and the gap at the quadrature
/// points.
std::vector<FoundContact> read_contacts(const DiscreteRod& rod, const std::vector<Vector4>& u, double clearance,
                                        const std::vector<double>& pressure_at, const std::vector<double>& gap_at);

DiscoveryResult discover(const DiscoveryProblem& problem, const DiscoveryOptions& options);

}  // namespace tendril::segmentation

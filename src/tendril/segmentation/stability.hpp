#pragma once
// Second variation of a sharp equilibrium on its contact pattern, by the discrete rod's Hessian at the sharp state's
// own values. Lagrangian: energy minus reaction times the least gap near each contact, g = ς(Q - |δ|). With v = v_n e_r
// + v_t e_t:
//   point contact   v_n = 0,               + R̂ [ ς v_t²/|δ| + (v_n')²/g'' ]       (the contact may move along the wall)
//   line contact    v_n = v_n' = 0 on it,  + ∫ p̂ ς v_t²/|δ| dS + R̂ ς v_t²/|δ| at its ends
// R̂, p̂ compressive, conjugate to δ: the normal of a ringed surface gives them the factor C3/√(C3² + Q'²).
//   collar          v_n = 0,               + R̂ ς v_t²/|δ|                         (taken where it lies on the axis)
//   resting tip     v_n + (|δ|' - Q') dS = 0,  + R̂ ς v_t²/|δ|   (dS: the free tip moves along at held rod length)
// Stable under a held end force: no negative eigenvalue at held length and dF3/dℓ < 0 along the equilibria.

#include <functional>
#include <vector>

#include "tendril/segmentation/discovery.hpp"

namespace tendril::segmentation {

struct PointReaction {
  double S = 0.0;         // [L]
  double reaction = 0.0;  // R̂ = ςR >= 0 [B/L²]
  bool collar = false;    // held at its place of the rod, which may stand at an angle to the wall
};

struct LineReaction {
  double start = 0.0, end = 0.0;                    // [L]; may reach an end of the rod
  double reaction_start = 0.0, reaction_end = 0.0;  // R̂ at its ends [B/L²]
  std::function<double(double)> pressure;           // -ςρ(S) >= 0 per unit reference length [B/L³]
};

struct StabilityProblem {
  geometry::Tube tube;
  DiscreteRodData data;
  HeldEnd start, end;
  bool tip_rests = false;                               // an end open across rests on the wall,
  double tip_reaction = 0.0;                            // R̂ there [B/L²]
  Eigen::Vector3d tip_force = Eigen::Vector3d::Zero();  // dead load of a free tip, in D [B/L²]
  double end_position = 1.0;
  double lambda = 0.0;  // ½ω² + F3 + ½η²F3² + σ·r = H + σ·r, one number along the rod   [B/L²]
  // Of a varying rod: λ at S, as it is there (the section law is held where it lies: docs/theory/varying_rods.md)
  std::function<double(double)> lambda_at;
  double torque = 0.0;      // M3                                                               [B/L]
  bool twist_held = false;  // the twist of the ends is held, not the torque
  std::function<formulation::Vector6(double)> eccentricity;  // S -> δ1, δ1', δ1'', δ2, δ2', δ2''
  std::vector<PointReaction> points;                         // ascending
  std::vector<LineReaction> lines;                           // ascending
  std::vector<double> breaks;  // where the section or λ jumps: on nodes, or an element would be too stiff [L]
  bool rotation_free = false;  // rotation about the axis costs nothing: one tangential value is held
};

struct StabilityOptions {
  int elements = 0;         // 0: as discovery
  double tolerance = 1e-6;  // eigenvalues above -tolerance (10 + λ²/4) in the L² metric are not counted
};

struct StabilityReport {
  int negative_held_length = 0;  // negative eigenvalues at held rod length
  int negative_dead_push = 0;    // the same with λ held: a dead push behind a sleeve
  double lowest = 0.0;           // lowest eigenvalue at held length, L² metric of δ [B/L⁴]
  std::vector<double> S;         // nodes and the lowest mode there, largest |δ| = 1
  std::vector<Vector4> mode;
};

StabilityReport stability(const StabilityProblem& problem, const StabilityOptions& options = {});

}  // namespace tendril::segmentation

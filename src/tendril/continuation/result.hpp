#pragma once
// What a solve hands to its faces: plain data in the case's units, the result keys of the JSON file one to one.

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace tendril::continuation {

using Vec3 = Eigen::Vector3d;

enum class Status { converged, not_converged, outside_validity };

struct Contact {
  bool line = false, collar = false;             // kind
  double start = 0, end = 0;                     // S                                        [length]
  double s_start = 0, s_end = 0;                 // along the unstressed rod                 [length]
  double angle_start = 0, angle_end = 0;         // β                                        [rad]
  std::optional<double> force_start, force_end;  // concentrated, line contacts; none at a clamp   [force]
  double force_distributed = 0;                  // ∫ p ds                                   [force]
  double force = 0;                              // sum of magnitudes                        [force]
  Vec3 force_vector = Vec3::Zero();              // world resultant ON the rod               [force]
  double pressure_min = 0, pressure_max = 0, pressure_mid = 0;  // per unit reference length, compressive > 0
};

inline const char* kind_name(const Contact& k) { return k.collar ? "collar" : k.line ? "line" : "point"; }

struct SegmentSpan {
  bool line = false;
  double start = 0, end = 0;  // S [length]
};

/// What no state has told.
constexpr double untold = std::numeric_limits<double>::quiet_NaN();

struct Certificate {  // all dimensionless
  double equilibrium = untold, gap_min = untold, reaction_min = untold, curvature_max = untold, continuity = untold;
  double balance = untold, invariant_spread = untold, error = untold, strain_max = untold;
  double phase_multiplier = untold;  // multiplier of the phase condition; must come out 0
};

/// Largest differences from the same state by other means (solve.formulation), scaled by L, the largest force and
/// moment.
struct Comparison {
  std::string with;  // what it was compared with
  double place = 0, directors = 0, force = 0, moment = 0, rod_length = 0;
  double error = 0;  // estimated by the solver of the reported state
};

struct Effort {
  long newton_iterations = 0, factorisations = 0, patterns_tried = 0;
  double wall_seconds = 0;
};

struct Fields {  // one row per output point, the columns of the contract
  std::vector<double> S, s, x, y, z, delta1, delta2, phi, gap, pressure, F1, F2, F3, M1, M2, M3, kappa;
};

struct Step {
  std::optional<double> parameter;
  Status status = Status::not_converged;
  std::string message;  // why, where, what was tried; converged: empty, or a warning (the rod meets itself)
  double rod_length = untold, axial_force_start = untold, axial_force_end = untold;
  double torque_start = untold, torque_end = untold, push = untold;
  std::vector<Contact> contacts;
  std::vector<SegmentSpan> segments;
  std::string stability = "unknown";  // "stable" | "unstable" | "unknown"
  std::string branch;
  Certificate certificate;
  std::optional<Comparison> comparison;
  Effort effort;
  Fields fields;              // filled on request
  std::vector<double> state;  // opaque: pattern, mesh and unknowns; accepted by StudyOptions::initial
};

struct Event {
  double parameter = 0;
  std::string kind;  // contract's names
  double S = 0, rod_length = 0, axial_force_end = 0;
  double contact_force = 0;  // of all contacts, sum of magnitudes, in the state located [force]
};

struct TracePoint {  // intermediate states of a path
  double parameter = 0, rod_length = 0, axial_force_end = 0, torque_end = 0;
  int contacts = 0;
};

struct Result {
  Status status = Status::not_converged;
  std::string message;
  std::vector<Step> steps;
  std::vector<Event> events;
  std::vector<TracePoint> trace;
  bool interrupted = false;
};

}  // namespace tendril::continuation

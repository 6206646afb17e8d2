#pragma once
// A free tip, and a guided end: where nothing holds the rod across. A free tip carries its load, F = f and M = c; one
// that rests on the wall touches it at a point without tangency, |δ| = Q, and the wall adds -ςR̂ N to the force on it:
//   free      F·k1 = f·k1, F·k2 = f·k2, F·d3 = f·d3,             M = c
//   resting   |δ| = Q, (F - f)·e_β = 0, (F - f)·(Q' e_r + C3 D3) = 0, M = c;   R̂ = -ς (F - f)·N >= 0
// (both tangents of the wall are normal to N). A guided end holds δ' = 0 in place of the couple and has its axial
// condition like any other end. On a line contact that reaches the tip, F·g = f·g and M·N = c·N; the wall bears the
// rest of the force, but no couple: M·g = c·g is checked.

#include "tendril/segmentation/chain.hpp"
#include "tendril/segmentation/end_state.hpp"
#include "tendril/segmentation/pattern_checks.hpp"

namespace tendril::segmentation {

/// The tip's load in D; dS as in formulation::lift. d1, d2, d3 in D where the load follows the rod.
template <class T>
struct TipLoadInD {
  formulation::V3<T> force, couple;
  TipLoadInD(const ScaledProblem& P, const formulation::Section& sec, const T& dS, const formulation::V3<T>& d1,
             const formulation::V3<T>& d2, const formulation::V3<T>& d3) {
    const TipLoad& load = P.end.tip;
    auto put = [&](const Eigen::Vector3d& f, formulation::V3<T>& out) {
      if (load.follower) {
        for (int i = 0; i < 3; ++i) out[i] = f[0] * d1[i] + f[1] * d2[i] + f[2] * d3[i];
        return;
      }
      formulation::V3<double> c{};
      for (int d = 0; d < 3; ++d)
        for (int i = 0; i < 3; ++i) c[d] += sec.D[d][i] * f[i];
      const auto rate = numerics::cross(c, sec.U[0]);  // of a world-fixed vector's components: x' = -U × x
      for (int d = 0; d < 3; ++d) out[d] = c[d] + rate[d] * dS;
    };
    put(load.force, force);
    put(load.couple, couple);
  }
};

/// Where a tip that is not held across stands.
struct TipState {
  double reaction = 0.0;  // R̂ [B/L²], of a tip that rests on the wall (at the end of a line: what the wall adds there)
  double gap = 0.0;       // ς(Q - |δ|)/Q
  double approach = 0.0;  // -d(gap)/dS·L/Q: positive where the rod comes to the wall from inside
  double couple = 0.0;    // a line up to the tip: M·g - c·g, which the wall cannot bear [B/L]
  double push = 0.0;      // F·d3 [B/L²]
};

/// The far end is free or guided.
bool open_across(const ScaledProblem& problem);
TipState tip_state(const Chain& chain);
/// Slope |dδ/dS| of the rod at a guided far end, which must be 0; 0 at other ends. A line up to the guide has the
/// wall's slope instead: where the clearance changes there, the two exclude each other.
double guide_fault(const Chain& chain);

/// Force and couple of the outside on a free tip, and the wall's force where it rests; world frame, scaled.
struct TipForces {
  std::array<double, 3> place{}, load{}, couple{}, wall{};
};
TipForces tip_forces(const Chain& chain);

/// Segment j taken out; where a contact thereby comes to a tip, it is the tip that rests on the wall.
Pattern without_segment(const Chain& chain, const Pattern& q, int j);
/// Patterns to try where a condition of the tip is violated, the likeliest first.
std::vector<Pattern> tip_patterns(const Chain& chain, CheckKind violated);

/// All rows of a far end that is free; first four rows of one that is guided (see Chain's end rows).
/// Columns: states of the end, S of the end, p. `law`: piece of the section law at the tip of a varying rod.
int free_tip_rows(const ScaledProblem& P, bool line, bool rests, int law, const double* z, double S, double* r,
                  double* values);

}  // namespace tendril::segmentation

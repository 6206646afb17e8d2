#pragma once
// States of a rod in a straight tube whose closed form is known, solved by the Eulerian chain from guesses that are not
// the solution, and compared with the closed form between the nodes. L = B = 1.

#include <vector>

#include "tendril/closed_form/helix.hpp"
#include "tendril/closed_form/localized_rod.hpp"

namespace tendril::reproduce::straight_conduit {

struct SolvedHelix {
  double force_along_axis = 0, moment_along_axis = 0;  // of the solved state, in the middle  [B/L²], [B/L]
  double rod_length = 0, exact_length = 0;             // unstressed, over the axis' length 1
  double pressure = 0;                                 // ρ in the middle, on the wall        [B/L³]
  // largest difference of δ/radius (or β), and of the forces over the largest, at 200 places; HUGE_VAL: not solved
  double difference = 0;
};
/// The rod between two sections of the helix, with its end force and torque; on the wall (inside the tube or around it)
/// or free of it.
SolvedHelix solve_helix(const closed_form::Helix& helix, const closed_form::SurfaceState& state, double eta,
                        bool on_wall, bool around);

/// m = M/√(BT), decay a √T over the axis' length 1.
closed_form::LocalizedRod localized(double m, double decay);

struct SolvedLocalized {
  double difference = 0;            // largest, of place, over the axis' length; HUGE_VAL: not solved
  double shortening = 0;            // rod length minus 1
  double cosine_in_the_middle = 0;  // d3·D3
  std::vector<double> S, delta1, delta2, exact1, exact2;
};
/// Over the axis' length 1, the localized part in the middle; ends held on the closed form, or clamped on the axis.
SolvedLocalized solve_localized(const closed_form::LocalizedRod& rod, bool exact_ends);

}  // namespace tendril::reproduce::straight_conduit

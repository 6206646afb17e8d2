#pragma once
// Twin of the straight tube's states: half the rod shot through the world frame, r' = t, t' = M x t, M' = F x t with F
// constant between the contacts, from the clamp to the middle, where half a turn about the x axis takes the rod to
// itself. Inextensible, no weight; one, two or three point contacts. Shares no equation with the Eulerian solver.
// B = 1, tube length 1.

#include <array>
#include <string>

#include "tendril/continuation/result.hpp"

namespace tendril::reproduce {

struct TubeTwin {
  bool converged = false;
  std::string reason;
  double rod_length = 0, place = 0;  // of the first contact (1/2 for the only one)
  double turn = 0;                   // about the axis between the outer contacts [rad]
  double outer = 0, middle = 0;      // reactions; the only one is `middle`    [B/L²]
};
/// From the forces of a solved step (with fields) as a first guess, solved anew for its push and torque.
TubeTwin twin_of(const continuation::Step& step, double clearance);

}  // namespace tendril::reproduce

#pragma once
// The knots of the thesis' figures and their duals as members of one family: the closed rod of one winding whose number
// of revolutions, as a real number, grows or shrinks from that of the Villarceau circle. Private to the system torus.

#include <functional>
#include <string>
#include <vector>

#include "tendril/continuation/branch.hpp"
#include "tendril/reproduce/torus_knot.hpp"

namespace tendril::reproduce::torus {

/// A solved closed rod of `revolutions` about the axis and `windings` around the tube, relatively prime.
struct Knot {
  int revolutions = 1, windings = 1;
  Family unit;                   // one winding
  BoundaryValueProblem winding;  // solved
  int met = 1;                   // first, second, ... state of this type along the family; 0: found by energy
  int crossings = 0;             // how often the whole rod passes through itself: above 0 it is no knot of its type
  std::string name() const;      // "(5,1)* no. 2", * where it passes through itself
  double turn() const { return static_cast<double>(revolutions) / windings; }
};

constexpr double accuracy = 1e-11;  // of the states between nodes

/// The Villarceau circle, solved.
BoundaryValueProblem villarceau_circle(const Rod& rod);

struct Gallery {
  std::vector<Knot> knots;
  std::vector<double> turns, slopes, H;  // the whole family, for the picture
  // numbers of revolutions: where the family turns back; where another crosses; where only β'(0) = 0
  std::vector<double> folds, branch_points, other_origins;
};
/// F3 = `force` at ξ = 0 throughout; with the knots of one winding and 3 to 5 revolutions that do not pass through
/// themselves, which the family misses: found as stationary energies from rough starts, untwisted rods only. `going` is
/// called at every point, false interrupts.
Gallery gallery(const Rod& rod, double force, const std::function<bool(double turn)>& going);

/// The same knot as one problem over all its windings, periodic ends, solved: no symmetry assumed.
BoundaryValueProblem whole(const Knot& knot, Family& family);

/// A knot followed in F3(0) from its state at F3 = 0.
struct Loads {
  Family family;
  std::vector<BoundaryValueProblem> asked;  // states at the loads asked for, in the order met
  std::vector<double> force, slope, length;
  std::vector<double> folds, branch_points;  // F3(0)
  double least_along = 1.0;                  // smallest d3·D3 at the last state
  std::string ended;
};
/// Towards `end`, with the states at `asked` and (if reached) at `end`, each solved again to `accuracy`. Ends, too,
/// where d3·D3 falls below `floor`.
Loads loads(const Knot& knot, double end, const std::vector<double>& asked, double floor = 0.0);

}  // namespace tendril::reproduce::torus

#pragma once
// Solved states of the thesis' helical conduit with one contact, and both sides of a contact in the terms of section 5
// of the notation. The derivatives at the contact are the solution's own, one-sided, not differences. Private to the
// system point_contact.

#include <functional>

#include "tendril/numerics/vec3.hpp"
#include "tendril/segmentation/chain.hpp"

namespace tendril::reproduce::point_contact {

using numerics::V3;
using segmentation::Chain;

/// Relative, of the states between nodes; their highest derivatives at the end of a piece lose two or three digits.
constexpr double accuracy = 1e-13;

/// The contact-free rod at T = -|T0|, at rest on the axis, or pushed to another load, whether it fits or not. Loads are
/// T over |T0|.
Chain free_state(double clearance, bool extensible, double load = -1.0);
/// One point contact in the middle (where the wall would have to pull it, too).
Chain point_state(double clearance, bool extensible, double load);
/// The extensible rod at T = -2|T0| under weight and with an eccentric far end: nothing is symmetric.
Chain oblique_state(const Chain& point);
/// A line contact in place of the point contact at its transition.
Chain line_state(const Chain& flat, double load);

/// To another load, in steps of at most 0.3 |T0|.
void walk_to(Chain& chain, double load, bool extensible);
/// Load at which `f` of the solved chain vanishes, by the secant from two loads; the chain ends there.
double zero(Chain& chain, double a, double b, bool extensible, const std::function<double(const Chain&)>& f);

/// One side of a contact: values, and rates per reference length.
struct Side {
  double alpha, kn, kg, kn_wall, Fn, Fg, F3, M3;  // κn, κg of the rod; κn_wall of the surface along d3
  double alpha_s, kn_s, kg_s, F3_s;               // rates; N and N x d3 of the contact held fixed
  double gap_s2, gap_s3;                          // second and third derivative of the gap
  V3<double> t;
};
/// `after`: the side s⁺ of the junction at the left end of the segment; otherwise the side s⁻ at its right end.
Side side_of(const Chain& chain, int segment, bool after);

struct Contact {
  Side before, after;
  double R, eta2;
  double resultant;  // (F(1) - F(0) + weight)·N: what the wall must take, from the far ends of the rod
};
/// The point contact of a chain of two free segments.
Contact contact(const Chain& chain);

/// A free section in space.
struct Section {
  double s, F3;
  V3<double> force, curvature, t, N;
};
Section section_at(const Chain& chain, int segment, double S);

}  // namespace tendril::reproduce::point_contact

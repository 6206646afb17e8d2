#pragma once
// Line contacts that carry nothing: a rod without weight or torque lies along a straight wall without pressing on it,
// held only by the reactions at the ends of the contact. Nothing then tells the ends of such a line apart from their
// neighbourhood to first order: with a clamp beyond the free arc, the place of the end is a double root of the
// equations (both curvatures of the arc vanish), so Newton's method loses half the digits. What Newton needs instead is
// offered here: the condition at a held end as a number, and the load at which the stretch leaves the wall by buckling.

#include "tendril/segmentation/chain.hpp"

namespace tendril::segmentation {

/// The line contact presses with less than a millionth of the reactions (or of B/L² where these are smaller).
bool carries_nothing(const Chain& chain, int segment);
/// Some line contact of the chain carries nothing.
bool has_flat_line(const Chain& chain);

/// Normal part of δ'' of the free side minus that of the wall at a line's end: zero unless the end is held.
double curvature_mismatch(const Chain& chain, int junction);

/// Positive while the stretch of a line that carries nothing stays straight: the determinant that vanishes when the
/// rod, clamped at both ends of the contact, has a neighbouring equilibrium off the wall; 1 for a stretch without
/// thrust.
double buckling_margin(const Chain& chain, int segment);

}  // namespace tendril::segmentation

#pragma once
// Elementary changes of a contact pattern (the arrows of Fig. IV.1.1): a point appears or leaves, a point becomes a
// line or splits in two, a line shrinks to a point or splits, contacts merge.

#include "tendril/segmentation/chain.hpp"

namespace tendril::segmentation {

/// Free segment j touches at S: free | free.
Pattern insert_point(const Pattern& q, int j, double S);
/// The point contact at junction k leaves: its two free segments become one.
Pattern remove_point(const Pattern& q, int k);
/// The point at junction k becomes a line of length `span`.
Pattern point_to_line(const Pattern& q, int k, double span);
/// The point at junction k becomes two points `span` apart.
Pattern point_to_two(const Pattern& q, int k, double span);
/// Line j opens over `span` around S; at its ends a point stays behind.
Pattern split_line(const Pattern& q, int j, double S, double span, double S_left, double S_right);
/// Segment j vanishes: a line becomes a point; two contacts merge.
Pattern remove_segment(const Pattern& q, int j);

int point_contacts(const Pattern& q);
int line_contacts(const Pattern& q);

}  // namespace tendril::segmentation

#pragma once
// One path out of a file of polylines: a line, lines joined at their ends, or the shortest way through a tree of
// branches between two of its ends.

#include <functional>
#include <optional>
#include <vector>

#include "tendril/io/formats/polyline_file.hpp"

namespace tendril::io {

/// What the case says about the path; everything empty: the only one there is.
struct PathChoice {
  std::vector<std::size_t> branch;                     // lines to join, in order
  std::vector<std::size_t> ends;                       // two numbers of ends, from and to
  std::optional<geometry::Vec3> start_near, end_near;  // the ends nearest to these points  [unit of the file]
};

/// An end of the tree: a point that only one way leaves.
struct TreeEnd {
  std::size_t point;  // index of a point of the file
};

/// Ends in the order of the file. Points that coincide to 1e-6 of the extent are one.
std::vector<TreeEnd> tree_ends(const PolylineFile& file);

/// "0 at (1.2, 3, 4), radius 5", one for each end.
std::string list_ends(const PolylineFile& file, const std::vector<TreeEnd>& ends);

/// Indices of the points along the path. A choice that cannot be is reported through `complain(key, message)`, where
/// key is that of the case ("tube.axis.ends"); then the path is empty.
std::vector<std::size_t> choose_path(const PolylineFile& file, const PathChoice& choice,
                                     const std::function<Issue&(const std::string&, const std::string&)>& complain);

}  // namespace tendril::io

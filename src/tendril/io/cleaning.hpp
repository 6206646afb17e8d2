#pragma once
// What must be taken out of a measured centreline or survey before a smooth curve can go through it, and what a reader
// of the result should know of it. Everything that is done is counted and told; nothing is done silently.

#include <string>
#include <vector>

#include "tendril/geometry/axis.hpp"

namespace tendril::io {

/// What was found and done. Lengths in the unit of the data.
struct CleaningReport {
  std::size_t points_before = 0, points_after = 0;
  std::size_t duplicates = 0;             // equal to the one before
  std::size_t tiny = 0;                   // nearer to the one before than the spacing of the rest warrants
  std::size_t caps = 0;                   // end caps: first or last hop of about one radius
  std::size_t wraps = 0;                  // surveys: stations across north from the one before
  double step_min = 0.0, step_max = 0.0;  // of what is left
  double step_max_place = 0.0;            // chord length, or measured depth, where the longest step begins
  std::vector<std::string> notes;         // one sentence for each finding
};

/// Points of a centreline; `radius` and `rows` (lines of the file) are empty or as long. Removes, in this order:
/// - duplicates,
/// - end caps: a first or last hop of 0.5 to 1.5 times the radius there, and over four times the median hop, which
///   centreline extraction adds from the cap of the model to the first sphere,
/// - tiny steps: hops below 1 % of the median hop, or 5 % of it where that is also below 5 % of the radius, in which
///   extraction repeats a point with its rounding error. The ends stay.
/// Steps over twenty times the median are told, not changed. `unit` is for the notes.
CleaningReport clean_points(std::vector<geometry::Vec3>& points, std::vector<double>& radius, std::vector<int>& rows,
                            const std::string& unit);

/// Stations of a survey [length, deg, deg]: repeated stations are removed; azimuths that pass north and depths without
/// a station for long are told.
CleaningReport clean_stations(std::vector<double>& md, std::vector<double>& inc, std::vector<double>& azi,
                              std::vector<int>& rows, const std::string& unit);

}  // namespace tendril::io

#pragma once
// `tendril quality FILE...`, and `tendril check FILE` for a centreline or survey: what a file holds, what had to be
// cleaned, and whether a tube can be made of it.

#include <optional>
#include <string>
#include <vector>

namespace tendril::app {

struct QualityOptions {
  std::vector<std::string> files;
  std::string smoothing;  // a number in the file's unit, "auto", or empty: as for a case
  std::vector<std::size_t> branch, ends;
  std::string radius_array;
  bool quiet = false;
};

/// Tables on standard output, findings below them; kInvalid if a file is refused.
int quality(const QualityOptions& options);

/// Whether the file is a centreline or survey rather than a case. Throws io::FileError.
bool is_geometry(const std::string& file);

}  // namespace tendril::app

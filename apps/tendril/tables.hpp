#pragma once
// Results in words: what a person reads on the terminal.

#include <string>
#include <vector>

#include "tendril/continuation/result.hpp"
#include "tendril/io/case.hpp"

namespace tendril::app {

/// Contact table, state and certificate of each step, then the events.
std::string describe(const io::Case& c, const continuation::Result& result);

/// What `tendril check` understood of a case.
std::string describe(const io::Case& c);

/// Right-aligned columns, as wide as their widest cell. UTF-8 is not used in cells.
std::string aligned(const std::vector<std::vector<std::string>>& rows);

}  // namespace tendril::app

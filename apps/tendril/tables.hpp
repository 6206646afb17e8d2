#pragma once
// Results in words: what a person reads on the terminal.

#include <string>

#include "tendril/continuation/result.hpp"
#include "tendril/io/case.hpp"

namespace tendril::app {

/// Contact table, state and certificate of each step, then the events.
std::string describe(const io::Case& c, const continuation::Result& result);

/// What `tendril check` understood of a case.
std::string describe(const io::Case& c);

}  // namespace tendril::app

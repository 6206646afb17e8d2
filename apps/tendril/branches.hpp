#pragma once
// `tendril branches CASE`: every state that several searches find for one load.

#include "commands.hpp"

namespace tendril::app {

/// Table on standard output, or JSON; kNotConverged when there is no state.
int branches(const RunOptions& options);

}  // namespace tendril::app

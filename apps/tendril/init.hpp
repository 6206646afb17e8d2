#pragma once
// `tendril init`: a commented case to start from, with the data files it names.

#include <string>
#include <vector>

namespace tendril::app {

/// Names of the starter cases.
const std::vector<std::string>& starters();

/// Writes the files into `directory`; existing ones only with `force`.
int init(const std::string& kind, const std::string& directory, bool force);

}  // namespace tendril::app

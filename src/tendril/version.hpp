#pragma once
// Version of the library, as written into every result.

namespace tendril {

/// "major.minor.patch"
const char* version();

}  // namespace tendril

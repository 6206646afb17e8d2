#include "tendril/version.hpp"

namespace tendril {

const char* version() { return TENDRIL_VERSION; }

}  // namespace tendril

#include "tendril/reproduce/systems.hpp"

namespace tendril::reproduce {

const std::vector<System>& systems() {
  static const std::vector<System> all = {
      point_contact_system(),
  };
  return all;
}

}  // namespace tendril::reproduce

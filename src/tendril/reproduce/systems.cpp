#include "tendril/reproduce/systems.hpp"

namespace tendril::reproduce {

const std::vector<System>& systems() {
  static const std::vector<System> all = {
      lagrangian_system(),         //
      small_inclination_system(),  //
      planar_elastica_system(),    //
      straight_conduit_system(),   //
      straight_tube_system(),      //
      helical_conduit_system(),    //
      heavy_rod_system(),          //
      surface_rods_system(),       //
      sphere_system(),             //
      torus_system(),              //
      point_contact_system(),      //
      methods_system(),            //
      stresses_system(),           //
  };
  return all;
}

}  // namespace tendril::reproduce

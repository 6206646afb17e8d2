#pragma once
// One function per system, each in the source of its name; systems.cpp lists them.

#include "tendril/reproduce/system.hpp"

namespace tendril::reproduce {

System lagrangian_system();
System small_inclination_system();
System planar_elastica_system();
System straight_conduit_system();
System straight_tube_system();
System helical_conduit_system();
System heavy_rod_system();
System surface_rods_system();
System sphere_system();
System torus_system();
System point_contact_system();
System methods_system();
System stresses_system();

}  // namespace tendril::reproduce

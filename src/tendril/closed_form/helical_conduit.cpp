#include "tendril/closed_form/helical_conduit.hpp"

#include "tendril/closed_form/helix.hpp"

namespace tendril::closed_form {

double HelicalConduit::curvature() const { return Helix{helix_radius, pitch_angle}.curvature(); }
double HelicalConduit::torsion() const { return Helix{helix_radius, pitch_angle}.torsion(); }

double axis_tension(const HelicalConduit& conduit, double M_3, double eta) {
  // The rod on the axis is a free helix on the cylinder that carries the axis.
  return free_helix_tension({conduit.helix_radius, conduit.pitch_angle}, M_3, eta);  // (II.3.19)
}

}  // namespace tendril::closed_form

#pragma once
// The inextensible, untwisted (M3 = 0) rod on a torus from its energy alone: ∫ ½κ² ds + H length is stationary among
// curves β = ξ/turn + Σ c_k sin(k ξ/turn), with H chosen so that F3 = H - ½κ² has the given value at ξ = 0. No equation
// of equilibrium enters, only κ = |r' x r''|/|r'|³: the twin of the boundary value problem. One winding, symmetric
// about its crossing of the outer equator.

#include <vector>

namespace tendril::reproduce::torus {

struct EnergyTwin {
  bool converged = false;
  double slope = 0.0;   // dβ/dξ at ξ = 0
  double length = 0.0;  // of one winding
  double H = 0.0;
  double rest = 0.0;  // size of the last two coefficients: what is left out
  std::vector<double> coefficients;
};

/// `turn`: azimuth of one winding over 2π. `beta`: start, at the places (i + ½)/n of half a winding. `terms`: sines.
EnergyTwin energy_twin(double epsilon, double turn, double force, const std::vector<double>& beta, int terms);

}  // namespace tendril::reproduce::torus

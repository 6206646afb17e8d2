#pragma once
// How a least-energy state of the discrete rod is reached: the moves of the search, each from one settled minimum to
// another. `discovery.cpp` puts them in order and reads the result.

#include "tendril/segmentation/discovery.hpp"
#include "tendril/segmentation/discrete_equilibrium.hpp"

namespace tendril::segmentation {

/// Typical sizes of a problem, scaled by L and B.
struct Scales {
  double clearance = 1.0;  // typical Q
  double force = 40.0;     // typical |F3|
  double size = 0.025;     // element
};

Scales scales_of(const DiscoveryProblem& p, const DiscoveryOptions& o);

/// F3 of F3 + ½η²F3² = excess.
double axial_force(double excess, double eta2);

class Search {
 public:
  Search(const DiscoveryProblem& p, const DiscoveryOptions& o, const Scales& s, DiscreteRod rod);

  DiscoveryResult run();

 private:
  void guess();
  void warm();
  void perturb(double amplitude);
  bool settle(double tolerance, int iterations);
  bool settle_as_minimum(double tolerance);
  double control();                     // controlled quantity at the present state
  double potential(bool at_end) const;  // σ·r at an end
  double target() const;                // its wanted value
  double wanted_lambda();               // λ that would meet the control with the end's present bending
  bool direct();
  bool ease();
  bool march();
  void see_reach();
  bool release();
  bool resume();
  bool sharpen();
  struct Slopes {
    double lambda = 0.0, force = 0.0;  // d/dℓ
    bool known = false;
  };
  Slopes slopes();
  bool at_end() const { return p_.axial_at == Which::end; }

  const DiscoveryProblem& p_;
  const DiscoveryOptions o_;
  Scales s_;
  DiscreteEquilibrium eq_;
  int iterations_ = 0, factorisations_ = 0;
  Reach reach_;        // of the states settled in this attempt
  double best_ = 0.0;  // control nearest to what is wanted on a march
};

}  // namespace tendril::segmentation

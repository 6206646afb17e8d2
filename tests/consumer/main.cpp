// Uses the installed headers and the compiled library, and checks one number known in closed form.
#include <cmath>
#include <cstdio>

#include "tendril/closed_form/helical_conduit.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/version.hpp"

int main() {
  const double pi = std::acos(-1.0);
  const double T0 = tendril::closed_form::axis_tension({pi / 4, 1 / (pi * std::sqrt(2.0))}, -1.0, 0.05);
  std::printf("tendril %s: T0 = %.10f\n", tendril::version(), T0);
  return std::abs(T0 + 7.0690329710) < 1e-9 ? 0 : 1;
}

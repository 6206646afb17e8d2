#pragma once
// The thesis' rod in a helical conduit (model section 7): clearance 1/20, clamped on the axis at the near end, sleeve
// at the far end, pulled by T = f |T0|. In compression it touches once at the middle, then along a line about it.

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/segmentation/chain.hpp"

namespace helical {

using namespace tendril;
using segmentation::Chain;
using segmentation::Closure;
using segmentation::Mechanics;
using segmentation::Problem;

constexpr double T0 = -7.069032970971682;  // τ (M3 - τ)/(1 + η² τ²)
constexpr double clearance = 0.05;
constexpr double tolerance = 1e-9;  // of the solves, between nodes

inline Problem problem() {
  Problem P;
  P.tube.axis = geometry::make_helix(1.0 / (M_PI * std::sqrt(2.0)), M_PI / 4, 1.0);
  P.tube.clearance = geometry::make_constant(clearance);
  P.rod.bending_stiffness = 1;
  P.rod.axial_stiffness = 400;
  P.rod.torsional_stiffness = 0.75;
  P.end.kind = segmentation::End::Kind::sleeve;
  P.axial_value = {T0, 1.0};
  P.twist_value = {-1.0, 0};
  P.end_position = {1.0, 0};
  return P;
}

/// Solve at T = f |T0| (f < 0: compression).
inline bool solve_at(Chain& c, double f) {
  return c.solve_adaptive({Closure::Kind::parameter, 0, f * std::abs(T0)}, {}, tolerance).converged;
}

/// The rod clear of the wall, whether it fits or not.
inline Chain free_chain(double f, int k = 7) {
  Chain c(std::make_shared<Mechanics>(problem(), T0), k);
  c.set_parameter(T0);
  c.build({{0}, {}}, 8, [](double S, double* u, double* s) {
    std::fill_n(u, formulation::FreeRod::inputs, 0.0);
    u[15] = T0;
    s[0] = S;
  });
  bool ok = true;
  for (double g : {-1.0, -1.1, -1.2}) ok = ok && solve_at(c, g);
  if (!(ok && solve_at(c, f))) throw std::runtime_error("the free rod was not found");
  return c;
}

/// One point contact.
inline Chain point_chain(double f, int k = 7) {
  Chain c = free_chain(-1.28, k).recut({{0, 0}, {0.5}});
  bool ok = true;
  for (double g : {-1.3, -1.5, -2.0, -2.5})
    if (g > f) ok = ok && solve_at(c, g);
  if (!(ok && solve_at(c, f))) throw std::runtime_error("the point contact was not found");
  return c;
}

/// One line contact of the given length; T follows.
inline Chain line_chain_of_span(double span, int k = 7) {
  Chain c = point_chain(-2.64, k).recut({{0, 1, 0}, {0.495, 0.505}});
  for (double x : {0.01, span})
    if (!c.solve_adaptive({Closure::Kind::span, 1, x}, {}, tolerance).converged)
      throw std::runtime_error("the line contact was not found");
  return c;
}

inline Chain line_chain(double f, int k = 7) {
  Chain c = line_chain_of_span(0.01, k);
  bool ok = true;
  for (double g : {-3.0, -4.0, -5.0, -7.0, -10.0, -15.0, -20.0, -23.0})
    if (g > f) ok = ok && solve_at(c, g);
  if (!(ok && solve_at(c, f))) throw std::runtime_error("the line contact was not found");
  return c;
}

}  // namespace helical

#pragma once
// Closed rods on a torus of major radius 1 and minor radius ε (III.2.5) as periodic boundary value problems of the
// line-contact equations. A knot makes n revolutions about the torus' axis and m windings around its tube; its
// independent variable is the azimuth, ξ = 2π n x with x in [0,1]. Right-handed frame D1 = e_r, D2 = -e_z, D3 = e_θ,
// U = (0, -1, 0), N outward. Scaled: major radius = B = 1. The rod is weightless and frictionless.
//
// Turning everything about the axis changes nothing, and two quantities are conserved: the axial moment
// (M + r x F)·e_z and H. So one condition fixes the phase, β(0) = 0 on the outer equator, and the load, F3 there; the
// two conserved quantities would make two of the conditions of periodicity redundant. They are kept: a force λ along
// e_θ and a drag μ along d3, both constant, are further unknowns and must come out 0.

#include <array>
#include <vector>

#include "tendril/collocation/boundary_value_problem.hpp"
#include "tendril/formulation/section.hpp"

namespace tendril::reproduce::torus {

using collocation::BoundaryValueProblem;
using numerics::V3;

struct Rod {
  double epsilon = 0.2;  // minor radius
  formulation::Material material;
  double M3 = 0.0;  // twisting moment
};

/// A family of closed rods in the problem's parameter p.
struct Family {
  Rod rod;
  int windings = 1;                      // m, around the tube
  enum class Vary { turn, force } vary;  // p: revolutions n (any real number); or F3(0) = p + p³
  double held = 0.0;                     // the other one
  double turn(double p) const { return vary == Vary::turn ? p : held; }
  double force(double p) const { return vary == Vary::force ? p + p * p * p : held; }
};
/// p with p + p³ = force.
double force_parameter(double force);

/// The family's problem with the state of `sampler` on `pieces` pieces. Throws geometry::GeometryError where the
/// Eulerian form cannot hold the curve: without a revolution, d3·D3 = 0.
BoundaryValueProblem make_problem(const Family& family, double p, int pieces,
                                  const BoundaryValueProblem::Sampler& sampler);
/// The Villarceau circle as a start: one winding, one revolution, F3 = 0.
BoundaryValueProblem::Sampler villarceau_sampler(const Rod& rod);
/// β = ξ/turn + Σ c_k sin(k ξ/turn) as a start, one winding in `turn` revolutions with F3 + ½κ² = H.
BoundaryValueProblem::Sampler series_sampler(const Rod& rod, double turn, double H, const std::vector<double>& c);
/// A solved state as the start of another family with the same or a multiple number of windings.
BoundaryValueProblem::Sampler repeated(const BoundaryValueProblem& problem, int times);

/// The rod at one azimuth. Vectors in space: e_z is the torus' axis, ξ = 0 on e_x.
struct Point {
  double xi, beta, slope, s;  // azimuth, polar angle, dβ/dξ, arc length
  V3<double> r, d3, N, F, M;
  double kn, kg, tg, Fg, Fn, F3, M3, rho, alpha;
  double along;  // d3·D3
  double H, axial_moment;
};
Point point_at(const Family& family, const BoundaryValueProblem& problem, double x);
std::vector<Point> points(const Family& family, const BoundaryValueProblem& problem, int count);

/// What a solved knot must satisfy, each as its largest deviation.
struct Faults {
  double phase, drag;      // the multipliers λ, μ
  double M3;               // from the value asked for
  double H, axial_moment;  // spread of what is conserved
  double closure;          // jump of F, M in space and of ρ where the ends meet, after the turn between them
  double force, moment;    // balance in space, F + ∫ρN ds and M + ∫α d3 x F ds, over every piece of the mesh
};
Faults faults(const Family& family, const BoundaryValueProblem& problem);

}  // namespace tendril::reproduce::torus

// Rods on a torus (III.2.5): circles in closed form, the knots of Figs. III.2.2 and III.2.4 with their duals, and the
// knot (1,5) under forces from -20 to 10^4 (Fig. III.2.3) with the geodesic as its limit. Inextensible, M3 = 0, ε = 1/5
// as in the thesis; F3 is given on the outer equator. (p,q) counts p revolutions about the axis and q windings around
// the tube, as the figures seem to do; (III.2.62) counts the other way round.

#include "tendril/closed_form/torus.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tendril/formulation/line_contact.hpp"
#include "tendril/geometry/error.hpp"
#include "tendril/reproduce/systems.hpp"
#include "tendril/reproduce/torus_report.hpp"

namespace tendril::reproduce {
namespace {

using namespace torus;

constexpr double pi = std::numbers::pi, epsilon = 0.2;

/// Villarceau circles: every field against (III.2.60-61), for the bare rod and a twisted, extensible one.
void villarceau_rows(std::vector<Row>& rows) {
  for (const auto& [rod, name] : {std::pair{Rod{epsilon, {}, 0.0}, "M3 = 0, inextensible"},
                                  std::pair{Rod{epsilon, {0.01, 0.3}, 1.3}, "M3 = 1.3, η = 1/10, ν = 0.3"}}) {
    const Family family{rod, 1, Family::Vary::turn, 0.0};
    double beta = 0.0, curvature = 0.0, force = 0.0;
    for (const Point& p : points(family, villarceau_circle(rod), 200)) {
      const auto v = closed_form::villarceau(epsilon, closed_form::Hand::right, p.xi, rod.M3);
      beta = std::max({beta, std::abs(p.beta - v.beta), std::abs(p.slope - v.beta_prime)});
      curvature = std::max({curvature, std::abs(p.kg - v.state.kappa_g), std::abs(p.kn - v.state.kappa_n),
                            std::abs(p.tg - v.state.tau_g)});
      force = std::max({force, std::abs(p.Fg - v.state.F_g), std::abs(p.Fn - v.state.F_n), std::abs(p.F3),
                        std::abs(p.rho), std::abs(p.M3 - rod.M3)});
    }
    const std::string circle = std::string("Villarceau circle, ") + name;
    rows.push_back({circle + ": largest error of β, β'", beta, 0.0, exact, "(III.2.60)"});
    rows.push_back({circle + ": of κ_g, κ_n, τ_g [1/R]", curvature, 0.0, exact, "(III.2.61), N outward"});
    rows.push_back({circle + ": of F_g, F_n, F3, ρ, M3", force, 0.0, exact, "free ring: F = M3 κ b, ρ = 0"});
  }
}

/// Parallels satisfy the equations; meridians cannot be written in them.
void circle_rows(Outcome& out) {
  const formulation::Material material{0.01, 0.3};
  double rest = 0.0, pressure = 0.0;
  for (const double beta : {0.0, 0.8, 0.5 * pi, pi})
    for (const double F3 : {0.0, 4.0}) {
      if (F3 != 0.0 && beta != 0.0 && beta != pi) continue;
      const auto s = closed_form::torus_parallel(epsilon, beta, F3, 1.7, 0.1);
      formulation::Section section;
      section.U[0] = {0.0, -1.0, 0.0};
      section.Q[0] = epsilon;
      std::array<double, 11> u{};
      u[0] = beta;
      u[5] = (1.0 + material.nu) * s.M_3 * (1.0 + epsilon * std::cos(beta)) / s.alpha;  // ψ' = (1+ν) M3/J1
      u[7] = s.F_g;
      u[9] = s.F_3;
      double r[4], ds;
      formulation::LineContact::residual<double>(material, formulation::lift<double>(section, 0.0, 0.0),
                                                 formulation::lift_clearance<double>(section, 0.0, 0.0), u.data(), r,
                                                 &ds);
      for (double x : r) rest = std::max(rest, std::abs(x));
      const auto wall = formulation::LineContact::wall(material, section, u.data());
      pressure = std::max({pressure, std::abs(wall.rho - s.rho), std::abs(wall.Fn - s.F_n)});
    }
  out.rows.push_back({"parallels, M3 = 1.7, extensible: residual of (III.2.30-35)", rest, 0.0, exact,
                      "closed form: κ_g F3 = 0 (III.2.59)"});
  out.rows.push_back({"parallels: largest error of ρ, F_n", pressure, 0.0, exact, "-α κ_n F3 or 0; κ_g M3"});
  try {
    const Family none{Rod{epsilon, {}, 0.0}, 1, Family::Vary::turn, 0.0};
    make_problem(none, 0.0, 8, villarceau_sampler(none.rod));
  } catch (const geometry::GeometryError& e) {
    out.notes.push_back(std::string("Meridians are refused: ") + e.what());
  }
}

Outcome compute(const Progress& progress) {
  const auto report = [&](double fraction, const std::string& what) { return !progress || progress(fraction, what); };
  const auto go = [&](double fraction, const std::string& what) {
    if (!report(fraction, what)) throw Interrupted{};
  };
  Outcome out;
  go(0.0, "circles");
  villarceau_rows(out.rows);
  circle_rows(out);
  const Gallery all = gallery({epsilon, {}, 0.0}, 0.0, [&](double turn) {
    return report(0.05 + 0.4 * std::max(0.0, turn - 1.0) / 5.0, "closed rods of " + text(turn) + " revolutions");
  });
  go(0.5, "whole knots");
  report_knots(all, out);
  go(0.7, "axial force");
  report_loads(all, out);
  report(1.0, "done");
  return out;
}

}  // namespace

System torus_system() {
  return {
      "torus",
      "Rods on a torus: circles, knots, geodesics",
      "III.2.5; Figs. III.2.2-4",
      "Parallels, meridians and Villarceau circles in closed form; elastic torus knots and their duals with periodic "
      "ends; a knot from compression to its geodesic limit.",
      compute,
      6.3};
}

}  // namespace tendril::reproduce

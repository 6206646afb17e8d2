// Rods and strings bound to parametric surfaces (III.1): closed forms, first integrals, balance in the world frame, two
// solvers against each other.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tendril/closed_form/helix.hpp"
#include "tendril/closed_form/sphere.hpp"
#include "tendril/closed_form/strings.hpp"
#include "tendril/closed_form/torus.hpp"
#include "tendril/formulation/surface_rod_problem.hpp"
#include "tendril/reproduce/surface_rods_detail.hpp"
#include "tendril/reproduce/systems.hpp"

namespace tendril::reproduce {

namespace on_surfaces {

namespace {

using namespace formulation;
using geometry::Triple;
constexpr double pi = std::numbers::pi;

double most(double a, double b) { return std::max(a, std::abs(b)); }

/// Clamped by collocation at 1e-11, from states evenly spaced along the rod.
collocation::BoundaryValueProblem collocated(const ClampedSurfaceRod& problem,
                                             const std::vector<SurfaceRodState<double>>& guess, std::string& reason) {
  auto bvp = surface_rod_problem(problem.rod, clamped_conditions(problem));
  guess_from(bvp, problem.rod, guess, problem.length, 16);
  collocation::BvpOptions options;
  options.tolerance = 1e-11;
  options.newton_tolerance = 1e-12;
  const auto summary = bvp.solve(collocation::Closure::at(0.0), options);
  reason = summary.converged ? "" : summary.reason;
  return bvp;
}

void helix_rows(Outcome& out) {
  const double radius = 0.6, angle = 0.7, F_3 = 1.3, M_3 = -0.8, eta = 0.2, length = 3.0;
  const auto e = closed_form::helix_on_cylinder({radius, angle}, F_3, M_3, eta);   // N outward
  const SurfaceRod rod{geometry::cylinder(radius), eta * eta, 1.0 / 3.0, {}, {}};  // N to the axis
  const SurfaceRodState<double> start{0.0, 0.0, angle, 0.0, -e.F_g, F_3, M_3, 0.0};
  const double up = e.alpha * std::cos(angle), around = e.alpha * std::sin(angle) / radius;
  const auto difference = [&](const std::vector<SurfaceRodSection>& sections, double& rho) {
    double d = 0.0;
    rho = 0.0;
    for (const auto& x : sections) {
      d = most(most(most(d, x.kappa_g), x.F_g + e.F_g), x.F_3 - F_3);
      d = most(most(d, x.state[iu] - up * x.s), x.state[iv] - around * x.s);
      rho = most(rho, x.rho + e.rho);
    }
    return d;
  };
  double rho = 0.0;
  const auto curve = integrate_surface_rod(rod, start, evenly(0.0, length, 12));
  double d = curve.summary.completed ? difference(curve.section, rho) : HUGE_VAL;
  out.rows.push_back({"helix on a cylinder, integrated: shape and force", d, 0.0, exact, "(II.3.13), closed form"});
  out.rows.push_back({"helix on a cylinder, integrated: pressure", rho, 0.0, exact, "(II.3.18), closed form"});
  // the same between clamps, from a straighter rod without force
  std::string reason;
  const std::array<double, 3> left{0.0, 0.0, angle}, right{up * length, around * length, angle};
  const auto bvp = collocated({rod, length, left, right, M_3},
                              {{0, 0, angle, 0, 0, 0, M_3, 0}, {right[0], right[1], angle, 0, 0, 0, M_3, 0}}, reason);
  d = reason.empty() ? difference(sections_of(bvp, rod, 30), rho) : HUGE_VAL;
  out.rows.push_back({"helix on a cylinder, clamped ends: shape and force", d, 0.0, exact, "(II.3.13), closed form"});
  out.rows.push_back({"helix on a cylinder, clamped ends: pressure", rho, 0.0, exact, "(II.3.18), closed form"});
}

void sphere_row(Outcome& out) {
  const double sigma = 0.5, kappa_max = 1.7, M_3 = 1.4;
  const closed_form::SphereElastica e(sigma, kappa_max);
  const SurfaceRod rod{geometry::sphere(1.0), 0.0, 0.0, {}, {}};
  const double length = 0.8 * e.period();
  const SurfaceRodState<double> start{0.3, 0.0, 1.1, -kappa_max, -M_3, 0.5 * (sigma - kappa_max * kappa_max), M_3, 0.0};
  const auto curve = integrate_surface_rod(rod, start, evenly(0.0, length, 8));
  std::vector<SurfaceRodState<double>> guess;
  for (auto x : curve.section) {
    for (const int i : {ikappa_g, iF_g, iF_3}) x.state[i] *= 0.9;
    guess.push_back(x.state);
  }
  const auto& end = curve.section.back().state;
  std::string reason;
  const auto bvp = collocated(
      {rod, length, {start[iu], start[iv], start[itheta]}, {end[iu], end[iv], end[itheta]}, M_3}, guess, reason);
  double d = reason.empty() ? 0.0 : HUGE_VAL;
  for (const auto& x : sections_of(bvp, rod, 40)) {
    const auto s = e.state(x.s, M_3);
    d = most(most(most(most(d, x.kappa_g + s.kappa_g), x.F_g + s.F_g), x.F_n + s.F_n), x.F_3 - s.F_3);
  }
  out.rows.push_back({"elastica on a sphere, clamped ends: curvature and force", d, 0.0, exact,
                      reason.empty() ? "(III.1.59), (III.1.62)" : reason});
}

void villarceau_row(Outcome& out) {
  const double minor = 0.4, M_3 = 0.9, turn = 2.0 * pi, tilt = std::asin(minor);
  const SurfaceRod rod{geometry::torus(1.0, minor), 0.0, 0.0, {}, {}};
  std::string reason;
  const auto bvp = collocated({rod, turn, {0.0, 0.0, tilt}, {turn, turn, tilt}, M_3},
                              {{0, 0, tilt, 0, M_3, 0, M_3, 0}, {turn, turn, tilt, 0, M_3, 0, M_3, 0}}, reason);
  double d = reason.empty() ? 0.0 : HUGE_VAL, rho = d;
  for (const auto& x : sections_of(bvp, rod, 48)) {
    const double xi = x.state[iu], root = std::sqrt((1.0 + minor) / (1.0 - minor));
    d = most(most(d, x.F_3),
             std::remainder(x.state[iv] - 2.0 * std::atan2(root * std::sin(xi / 2), std::cos(xi / 2)), 2 * pi));
    d = most(d, std::hypot(x.kappa_g, x.kappa_n) - 1.0);
    rho = most(rho, x.rho);
  }
  out.rows.push_back({"Villarceau circle of a torus: place, curvature 1, tension 0", d, 0.0, exact, "(III.2.61)"});
  out.rows.push_back({"Villarceau circle of a torus: pressure", rho, 0.0, exact, "free ring"});
}

void law_rows(Outcome& out) {
  double energy = 0.0, axial = 0.0, twist = 0.0;
  for (const Example& x : examples()) {
    SurfaceRod rod = model_of(x);
    const auto heavy = integrate_surface_rod(rod, x.start, evenly(0.0, x.length, 12));
    rod.body_force = {};
    const auto weightless = integrate_surface_rod(rod, x.start, evenly(0.0, 0.6 * x.length, 12));
    for (const auto* c : {&heavy, &weightless}) {
      const SurfaceRod& m = c == &heavy ? model_of(x) : rod;
      if (!c->summary.completed) energy = HUGE_VAL;
      const auto moment = [](const SurfaceRodSection& q) { return q.M[2] + q.r[0] * q.F[1] - q.r[1] * q.F[0]; };
      for (const auto& q : c->section) {
        energy = most(energy, surface_rod_energy(m, q) - surface_rod_energy(m, c->section.front()));
        twist = most(twist, q.M_3 - x.start[iM_3]);
        if (x.name == "sphere" || x.name == "cylinder" || x.name == "torus")
          axial = most(axial, moment(q) - moment(c->section.front()));
      }
    }
  }
  out.rows.push_back(
      {"five surfaces: first integral H + σ·r, largest change", energy, 0.0, exact, "(III.1.41) with weight"});
  out.rows.push_back({"five surfaces: twisting moment, largest change", twist, 0.0, exact, "(III.1.33)"});
  out.rows.push_back(
      {"surfaces of revolution: axial moment, largest change", axial, 0.0, exact, "normals meet the axis"});
}

void invariance_rows(Outcome& out) {
  // the torus again, in skew parameters a, b: u = a + 0.4 b², v = b - 0.3 sin a
  const auto plain = geometry::torus(1.0, 0.35);
  const auto skew = geometry::surface_from([](const auto& a, const auto& b) {
    using T = std::decay_t<decltype(a)>;
    const T u = a + 0.4 * (b * b), v = b - 0.3 * sin(a), rho = 1.0 + 0.35 * cos(v);
    return Triple<T>{{rho * cos(u), rho * sin(u), 0.35 * sin(v)}};
  });
  const double a = 0.3, b = 0.5, u = a + 0.4 * b * b, v = b - 0.3 * std::sin(a), theta = 0.9;
  const auto d = geometry::surface_direction<double>(geometry::lift(plain->patch(u, v), u, v), theta);
  const auto zero = geometry::surface_direction<double>(geometry::lift(skew->patch(a, b), a, b), 0.0);
  const double other = std::atan2(dot(d.t, zero.g), dot(d.t, zero.t));
  const SurfaceRod one{plain, 0.02, 0.3, {0.1, 0.2, -1.0}, {}}, two{skew, 0.02, 0.3, {0.1, 0.2, -1.0}, {}};
  const auto p = integrate_surface_rod(one, {u, v, theta, 0.4, 0.5, 1.1, -0.7, 0.0}, evenly(0.0, 0.8, 4));
  const auto q = integrate_surface_rod(two, {a, b, other, 0.4, 0.5, 1.1, -0.7, 0.0}, evenly(0.0, 0.8, 4));
  double most_of_all = p.summary.completed && q.summary.completed ? 0.0 : HUGE_VAL;
  for (std::size_t i = 0; i < std::min(p.section.size(), q.section.size()); ++i) {
    for (int k = 0; k < 3; ++k) {
      most_of_all = most(most_of_all, p.section[i].r[k] - q.section[i].r[k]);
      most_of_all = most(most_of_all, p.section[i].F[k] - q.section[i].F[k]);
      most_of_all = most(most_of_all, p.section[i].M[k] - q.section[i].M[k]);
    }
  }
  out.rows.push_back(
      {"torus in skew parameters: place, force, moment", most_of_all, 0.0, exact, "the same rod in plain ones"});
  // invariants of a curve by the printed formulas
  double formulas = 0.0;
  for (const Example& x : examples()) {
    const double pu = x.start[iu], pv = x.start[iv], angle = x.start[itheta], kappa_g = 0.7;
    const auto patch = x.surface->patch(pu, pv);
    const auto e = geometry::surface_direction<double>(geometry::lift(patch, pu, pv), angle);
    using D = numerics::Dual<1>;
    const D du = D::seed(pu, 0, e.u_rate), dv = D::seed(pv, 0, e.v_rate);
    const auto along =
        geometry::surface_direction<D>(geometry::lift(patch, du, dv), D::seed(angle, 0, kappa_g + e.geodesic_turning));
    const auto c = geometry::curve_invariants(patch, e.u_rate, e.v_rate, along.u_rate.d[0], along.v_rate.d[0]);
    formulas = most(most(most(formulas, c.kappa_g - kappa_g), c.kappa_n - e.kappa_n), c.tau_g - e.tau_g);
  }
  out.rows.push_back({"five surfaces: κ_g, κ_n, τ_g of a curve", formulas, 0.0, exact, "(III.1.13-19) as printed"});
}

void solver_rows(Outcome& out) {
  // shooting and collocation on the same clamped, heavy, twisted rods
  for (const Example& x : examples()) {
    const SurfaceRod rod = model_of(x);
    const double length = 0.6 * x.length;
    const auto curve = integrate_surface_rod(rod, x.start, evenly(0.0, length, 8));
    auto right = curve.section.back().state;
    right[iu] += 0.03;  // not the rod it was
    ClampedSurfaceRod problem{
        rod, length, {x.start[iu], x.start[iv], x.start[itheta]}, {right[iu], right[iv], right[itheta]}, x.start[iM_3]};
    std::vector<SurfaceRodState<double>> guess;
    for (const auto& s : curve.section) guess.push_back(s.state);
    std::string reason;
    const auto bvp = collocated(problem, guess, reason);
    const auto y = state_at(bvp, 0.0);
    const auto shot = solve_clamped(problem, {x.start[ikappa_g], x.start[iF_g], x.start[iF_3]});
    double d = reason.empty() && shot.converged ? 0.0 : HUGE_VAL;
    for (const int i : {ikappa_g, iF_g, iF_3}) d = most(d, shot.start[i] - y[i]);
    out.rows.push_back({"clamped rod on the " + x.name + ": κ_g, F at its end, shooting against collocation", d, 0.0,
                        exact, reason.empty() ? "two discretisations" : reason + shot.reason});
  }
}

}  // namespace

std::vector<double> evenly(double from, double to, int parts) {
  std::vector<double> s;
  for (int i = 0; i <= parts; ++i) s.push_back(from + (to - from) * i / parts);
  return s;
}

void add_rod_rows(Outcome& out) {
  helix_rows(out);
  sphere_row(out);
  villarceau_row(out);
  law_rows(out);
  invariance_rows(out);
  solver_rows(out);
}

void add_string_rows(Outcome& out) {
  const auto add = [&out](const char* name, double computed, double expected, const char* source) {
    out.rows.push_back({name, computed, expected, exact, source});
  };
  const auto arc = solve_geodesic(geometry::sphere(1.0), {-0.4, 0.0}, {0.6, 1.5}, {1.0, 1.5});
  add("great circle between two points: length", arc.converged ? arc.length : HUGE_VAL,
      std::acos(std::sin(-0.4) * std::sin(0.6) + std::cos(0.4) * std::cos(0.6) * std::cos(1.5)),
      "spherical cosine rule");
  const auto helix = solve_geodesic(geometry::cylinder(0.5), {0.0, 0.0}, {1.0, 2.5 * pi}, {1.2, 4.0});
  add("helix of a cylinder between two points: length", helix.converged ? helix.length : HUGE_VAL,
      std::hypot(1.0, 1.25 * pi), "unrolled");
  const auto clairaut = closed_form::spheroid_geodesic(1.0, 1.5, 0.8);
  const SurfaceString light{geometry::ellipsoid(1.0, 1.0, 1.5), 0.0, {}};
  const auto wave = integrate_string(light, {0.0, 0.0, pi / 2 - 0.8, 1.0}, {0.0, clairaut.length / 4, clairaut.length});
  add("geodesic of a spheroid: largest reduced latitude", wave.section.size() > 1 ? wave.section[1].state[0] : HUGE_VAL,
      0.8, "Clairaut, K, E and Π");
  add("geodesic of a spheroid: longitude gained per oscillation", wave.section.back().state[1], clairaut.longitude,
      "Clairaut, K, E and Π");
  const auto winding = closed_form::torus_geodesic(0.35, 1.9);
  const SurfaceString ring{geometry::torus(1.0, 0.35), 0.0, {}};
  const auto around =
      integrate_string(ring, {0.0, 0.0, std::acos(winding.clairaut() / 1.35), 1.0}, {0.0, winding.length});
  add("geodesic winding around a torus: azimuth gained per winding", around.section.back().state[0], winding.turn,
      "Clairaut, quadrature");
  add("geodesic winding around a torus: polar angle after a winding", around.section.back().state[1], 2.0 * pi,
      "Clairaut, quadrature");
  const SurfaceString stretched{geometry::sphere(1.0), 0.1, {}};
  const auto taut = integrate_string(stretched, {0.0, 0.0, 0.7, 1.0}, {0.0, 1.0});
  add("taut elastic string on a sphere: pressure", taut.section.back().rho, -1.1, "(III.1.54)");
  const closed_form::Catenary catenary{0.8, 1.3, 0.05};
  const SurfaceString plane{geometry::vertical_plane(), 0.05, {0.0, 0.0, -1.3}};
  const auto hung =
      solve_string(plane, 1.5, {catenary.x(-0.5), catenary.z(-0.5)}, {catenary.x(1.0), catenary.z(1.0)}, {-0.5, 1.0});
  add("elastic catenary hung in a plane: tension at its left end", hung.converged ? hung.start[3] : HUGE_VAL,
      catenary.tension(-0.5), "closed form");
  const SurfaceString column{geometry::cylinder(0.6), 0.05, {0.0, 0.0, -1.3}};
  const auto wound = integrate_string(column, {0.0, 0.0, pi / 2, 0.8}, {0.0, 2.0});
  add("elastic catenary on a vertical cylinder: height", wound.section.back().state[0], catenary.z(2.0),
      "closed form, unrolled");
  add("elastic catenary on a vertical cylinder: angle", wound.section.back().state[1], catenary.x(2.0) / 0.6,
      "closed form, unrolled");
  // over a lying cylinder: F_3 - w z and the axial pull are constant
  const auto lying = geometry::surface_from([](const auto& u, const auto& v) {
    using T = std::decay_t<decltype(u)>;
    return Triple<T>{{u, 0.6 * cos(v), 0.6 * sin(v)}};
  });
  const auto over = integrate_string({lying, 0.0, {0.0, 0.0, -1.3}}, {0.0, 0.1, 1.2, 2.0}, evenly(0.0, 2.0, 20));
  double change = over.summary.completed ? 0.0 : HUGE_VAL;
  for (const auto& x : over.section) {
    const auto& first = over.section.front();
    change =
        most(most(change, x.F_3 * x.t[0] - first.F_3 * first.t[0]), x.F_3 - first.F_3 - 1.3 * (x.r[2] - first.r[2]));
  }
  add("heavy string over a lying cylinder: F_3 - w z and axial pull, largest change", change, 0.0, "first integrals");
  for (const double lowest : {-0.6, 0.2}) {
    const closed_form::SphericalCatenary arch(2.0, lowest, 0.5);
    const SurfaceString string{geometry::sphere(1.0), 0.0, {0.0, 0.0, -2.0}};
    const auto curve = integrate_string(string, {std::asin(lowest), 0.0, pi / 2, 0.5}, {0.0, arch.length()});
    add(lowest < 0 ? "heavy string on a sphere, lowest at z = -0.6: highest point"
                   : "heavy string on a sphere, lowest at z = 0.2: highest point",
        std::sin(curve.section.back().state[0]), arch.highest(), "root of the first integrals' cubic");
    add(lowest < 0 ? "heavy string on a sphere, lowest at z = -0.6: longitude"
                   : "heavy string on a sphere, lowest at z = 0.2: longitude",
        curve.section.back().state[1], arch.longitude(), "first integrals by quadrature");
  }
}

}  // namespace on_surfaces

namespace {

Outcome compute(const Progress& progress) {
  Outcome out;
  const auto step = [&](double done, const char* what) {
    if (progress && !progress(done, what)) throw Interrupted{};
  };
  step(0.0, "rods on surfaces");
  out.pictures.push_back(on_surfaces::rods(out));
  step(0.3, "closed forms and laws");
  on_surfaces::add_rod_rows(out);
  step(0.6, "from rod to string");
  out.pictures.push_back(on_surfaces::rod_to_string(out));
  step(0.8, "strings");
  on_surfaces::add_string_rows(out);
  out.pictures.push_back(on_surfaces::strings(out));
  step(1.0, "done");
  return out;
}

}  // namespace

System surface_rods_system() {
  return {"surface_rods",
          "Rods and strings bound to surfaces",
          "III.1 (Lagrangian formulation), III.1.3.2",
          "Rods with weight, torque and stretch on any parametric surface; geodesics and catenaries.",
          &compute,
          0.8};
}

}  // namespace tendril::reproduce

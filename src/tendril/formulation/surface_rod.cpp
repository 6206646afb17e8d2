#include "tendril/formulation/surface_rod.hpp"

#include <cmath>

#include "tendril/geometry/error.hpp"
#include "tendril/numerics/dual_newton.hpp"
#include "tendril/numerics/gauss.hpp"

namespace tendril::formulation {

namespace {

constexpr int points = 7;  // Gauss points per piece of the balance

std::array<double, 3> combine(double a, const std::array<double, 3>& x, double b, const std::array<double, 3>& y,
                              double c, const std::array<double, 3>& z) {
  std::array<double, 3> r;
  for (int i = 0; i < 3; ++i) r[i] = a * x[i] + b * y[i] + c * z[i];
  return r;
}
double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
std::array<double, 3> cross(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

SurfaceRodSection surface_rod_section(const SurfaceRod& rod, double s, const SurfaceRodState<double>& y) {
  SurfaceRodSection x;
  x.s = s;
  x.state = y;
  const auto patch = rod.surface->patch(y[iu], y[iv]);
  const auto d = geometry::surface_direction<double>(geometry::lift(patch, y[iu], y[iv]), y[itheta]);
  x.r = patch(0, 0).c;
  x.t = d.t.c;
  x.g = d.g.c;
  x.N = d.N.c;
  x.alpha = 1.0 + rod.eta_squared * y[iF_3];
  x.kappa_g = y[ikappa_g];
  x.kappa_n = d.kappa_n;
  x.tau_g = d.tau_g;
  x.F_g = y[iF_g];
  x.F_3 = y[iF_3];
  x.M_3 = y[iM_3];
  // F_n and its derivative along the solution
  SurfaceRodState<double> slope;
  surface_rod_slope(rod, y, slope, x.F_n);
  using D = numerics::Dual<1>;
  SurfaceRodState<D> along, ignored;
  for (int i = 0; i < surface_rod_states; ++i) along[i] = D::seed(y[i], 0, slope[i]);
  D F_n;
  surface_rod_slope(rod, along, ignored, F_n);
  x.rho = -(F_n.d[0] + x.alpha * (x.kappa_n * x.F_3 + x.tau_g * x.F_g) + dot(x.N, rod.body_force));  // (III.1.29)
  x.F = combine(x.F_g, x.g, x.F_n, x.N, x.F_3, x.t);                                                 // (III.1.26)
  x.M = combine(-x.alpha * x.kappa_n, x.g, x.alpha * x.kappa_g, x.N, x.M_3, x.t);                    // (III.1.27)
  return x;
}

void check_surface_rod(const SurfaceRod& rod, const SurfaceRodState<double>& start, const std::vector<double>& s) {
  static constexpr const char* name[surface_rod_states] = {"u", "v", "theta", "kappa_g", "F_g", "F_3", "M_3", "psi"};
  std::vector<geometry::Issue> issues;
  for (int i = 0; i < surface_rod_states; ++i) geometry::require_finite(issues, name[i], start[i]);
  if (!(rod.eta_squared >= 0.0) || !std::isfinite(rod.eta_squared))
    issues.push_back({"eta_squared", 0.0, rod.eta_squared, 0.0,
                      "is " + geometry::number_text(rod.eta_squared) + ", must be a number not below 0",
                      "0 is the inextensible rod"});
  if (!(rod.nu > -1.0) || !std::isfinite(rod.nu))
    issues.push_back({"nu", 0.0, rod.nu, -1.0,
                      "is " + geometry::number_text(rod.nu) + ", must be a number greater than -1", "nu = B/C - 1"});
  if (s.empty()) issues.push_back({"s", 0.0, 0.0, 1.0, "is empty, must hold at least one place", ""});
  for (std::size_t i = 1; i < s.size(); ++i) {
    if (s[i] > s[i - 1]) continue;
    issues.push_back({"s[" + std::to_string(i) + "]", s[i], s[i], s[i - 1], "does not exceed the place before it",
                      "sort the places"});
    break;
  }
  if (issues.empty()) {
    const auto patch = rod.surface->patch(start[iu], start[iv]);
    const auto normal = geometry::cross(patch(1, 0), patch(0, 1));
    const double area = std::sqrt(geometry::dot(normal, normal));
    if (!(area > 0.0))
      issues.push_back({"surface", 0.0, area, 0.0, "is singular at the start, S_u x S_v = 0",
                        "turn the surface or choose other parameters"});
  }
  geometry::throw_if_any(std::move(issues));
}

SurfaceRodCurve integrate_surface_rod(const SurfaceRod& rod, const SurfaceRodState<double>& start,
                                      const std::vector<double>& s, const numerics::IntegrationOptions& options) {
  check_surface_rod(rod, start, s);
  SurfaceRodCurve curve;
  SurfaceRodState<double> y = start;
  const auto slope = [&rod](double, const SurfaceRodState<double>& x, SurfaceRodState<double>& dx) {
    double F_n;
    return surface_rod_slope(rod, x, dx, F_n);
  };
  curve.summary.completed = true;
  curve.section.push_back(surface_rod_section(rod, s.front(), y));
  numerics::IntegrationOptions between = options;
  between.first_step = 1.0;  // the places asked for are usually close
  int steps = 0;
  for (std::size_t i = 1; i < s.size(); ++i) {
    curve.summary = numerics::integrate(slope, s[i - 1], s[i], y, between);
    curve.summary.steps = steps += curve.summary.steps;
    if (!curve.summary.completed) break;
    curve.section.push_back(surface_rod_section(rod, s[i], y));
  }
  return curve;
}

std::vector<double> balance_places(double length, int pieces) {
  const auto& table = numerics::gauss_table(points);
  std::vector<double> s{0.0};
  for (int i = 0; i < pieces; ++i)
    for (int j = 0; j < points; ++j) s.push_back(length * (i + table.c[j]) / pieces);
  s.push_back(length);
  return s;
}

Imbalance world_imbalance(const SurfaceRod& rod, const std::vector<SurfaceRodSection>& sections, int pieces) {
  const auto& table = numerics::gauss_table(points);
  const SurfaceRodSection &a = sections.front(), &b = sections.back();
  std::array<double, 3> force{}, moment{};
  const auto add = [](std::array<double, 3>& sum, double w, const std::array<double, 3>& x) {
    for (int i = 0; i < 3; ++i) sum[i] += w * x[i];
  };
  add(force, 1.0, b.F);
  add(force, -1.0, a.F);
  add(moment, 1.0, b.M);
  add(moment, 1.0, cross(b.r, b.F));
  add(moment, -1.0, a.M);
  add(moment, -1.0, cross(a.r, a.F));
  for (std::size_t n = 1; n + 1 < sections.size(); ++n) {
    const SurfaceRodSection& x = sections[n];
    const double w = table.b[(n - 1) % points] * (b.s - a.s) / pieces;
    std::array<double, 3> load = rod.body_force;
    add(load, x.rho, x.N);
    add(force, w, load);
    add(moment, w, cross(x.r, load));
    add(moment, w, rod.body_couple);
  }
  Imbalance most;
  for (int i = 0; i < 3; ++i) {
    most.force = std::fmax(most.force, std::abs(force[i]));
    most.moment = std::fmax(most.moment, std::abs(moment[i]));
  }
  return most;
}

double surface_rod_energy(const SurfaceRod& rod, const SurfaceRodSection& x) {
  const double bending = x.alpha * x.alpha * (x.kappa_g * x.kappa_g + x.kappa_n * x.kappa_n);
  return 0.5 * bending + x.F_3 + 0.5 * rod.eta_squared * x.F_3 * x.F_3 + dot(rod.body_force, x.r);
}

SurfaceRodSolution solve_clamped(const ClampedSurfaceRod& problem, const std::array<double, 3>& guess,
                                 const numerics::IntegrationOptions& options) {
  check_surface_rod(problem.rod,
                    {problem.left[0], problem.left[1], problem.left[2], guess[0], guess[1], guess[2], problem.M_3, 0.0},
                    {0.0, problem.length});
  // the fourth unknown is M_3 at the left: a body couple turns it on the way
  using D = numerics::Dual<4>;
  static constexpr int unknown[4] = {ikappa_g, iF_g, iF_3, iM_3};
  const auto slope = [&problem](double, const SurfaceRodState<D>& x, SurfaceRodState<D>& dx) {
    D F_n;
    return surface_rod_slope(problem.rod, x, dx, F_n);
  };
  const auto miss = [&](const std::array<D, 4>& x, std::array<D, 4>& r) {
    SurfaceRodState<D> y;
    for (int i = 0; i < 3; ++i) y[i] = problem.left[i];
    for (int i = 0; i < 4; ++i) y[unknown[i]] = x[i];
    if (!numerics::integrate(slope, 0.0, problem.length, y, options).completed) return false;
    for (int i = 0; i < 3; ++i) r[i] = y[i] - problem.right[i];
    r[3] = y[iM_3] - problem.M_3;
    return true;
  };
  std::array<double, 4> x{guess[0], guess[1], guess[2], problem.M_3};
  const auto newton = numerics::solve_dual_newton<4>(miss, x);
  SurfaceRodSolution solution;
  solution.converged = newton.converged;
  solution.reason = newton.reason;
  solution.iterations = newton.iterations;
  for (int i = 0; i < 3; ++i) solution.start[i] = problem.left[i];
  for (int i = 0; i < 4; ++i) solution.start[unknown[i]] = x[i];
  return solution;
}

}  // namespace tendril::formulation

#include "tendril/formulation/surface_string.hpp"

#include <cmath>

#include "tendril/geometry/error.hpp"
#include "tendril/numerics/dual_newton.hpp"

namespace tendril::formulation {

namespace {

StringSection section_of(const SurfaceString& string, double s, const StringState<double>& y) {
  StringSection x;
  x.s = s;
  x.state = y;
  const auto patch = string.surface->patch(y[0], y[1]);
  const auto d = geometry::surface_direction<double>(geometry::lift(patch, y[0], y[1]), y[2]);
  StringState<double> slope;
  string_slope(string, y, slope, x.kappa_g);
  x.r = patch(0, 0).c;
  x.t = d.t.c;
  x.N = d.N.c;
  x.alpha = 1.0 + string.eta_squared * y[3];
  x.kappa_n = d.kappa_n;
  x.F_3 = y[3];
  double load = 0.0;
  for (int i = 0; i < 3; ++i) load += x.N[i] * string.body_force[i];
  x.rho = -(x.alpha * x.kappa_n * x.F_3 + load);  // (III.1.51)
  return x;
}

/// Shooting from `from` to `to`; `start` makes the state and the length of the two unknowns.
template <class Start>
StringSolution shoot(const SurfaceString& string, const std::array<double, 2>& to, std::array<double, 2> x,
                     const Start& start) {
  using D = numerics::Dual<2>;
  const auto miss = [&](const std::array<D, 2>& unknown, std::array<D, 2>& r) {
    StringState<D> y;
    D length;
    start(unknown, y, length);
    if (!(length.v > 0.0) || !(y[3].v > 0.0)) return false;
    const auto slope = [&](double, const StringState<D>& at, StringState<D>& dy) {
      D kappa_g;
      if (!string_slope(string, at, dy, kappa_g)) return false;
      for (D& rate : dy) rate = rate * length;  // over s/length in [0, 1]
      return true;
    };
    if (!numerics::integrate(slope, 0.0, 1.0, y).completed) return false;
    for (int i = 0; i < 2; ++i) r[i] = y[i] - to[i];
    return true;
  };
  const auto newton = numerics::solve_dual_newton<2>(miss, x);
  StringSolution solution;
  solution.converged = newton.converged;
  solution.reason = newton.reason;
  solution.iterations = newton.iterations;
  StringState<D> y;
  D length;
  start(std::array<D, 2>{D(x[0]), D(x[1])}, y, length);
  for (int i = 0; i < 4; ++i) solution.start[i] = y[i].v;
  solution.length = length.v;
  return solution;
}

}  // namespace

StringCurve integrate_string(const SurfaceString& string, const StringState<double>& start,
                             const std::vector<double>& s, const numerics::IntegrationOptions& options) {
  std::vector<geometry::Issue> issues;
  for (int i = 0; i < 3; ++i) geometry::require_finite(issues, i == 0 ? "u" : i == 1 ? "v" : "theta", start[i]);
  geometry::require_positive(issues, "F_3", start[3]);  // a string carries tension only
  if (s.empty()) issues.push_back({"s", 0.0, 0.0, 1.0, "is empty, must hold at least one place", ""});
  geometry::throw_if_any(std::move(issues));
  StringCurve curve;
  StringState<double> y = start;
  const auto slope = [&string](double, const StringState<double>& x, StringState<double>& dx) {
    double kappa_g;
    return string_slope(string, x, dx, kappa_g);
  };
  curve.summary.completed = true;
  curve.section.push_back(section_of(string, s.front(), y));
  numerics::IntegrationOptions between = options;
  between.first_step = 1.0;
  int steps = 0;
  for (std::size_t i = 1; i < s.size(); ++i) {
    curve.summary = numerics::integrate(slope, s[i - 1], s[i], y, between);
    curve.summary.steps = steps += curve.summary.steps;
    if (!curve.summary.completed) break;
    curve.section.push_back(section_of(string, s[i], y));
  }
  return curve;
}

StringSolution solve_string(const SurfaceString& string, double length, const std::array<double, 2>& from,
                            const std::array<double, 2>& to, const std::array<double, 2>& guess) {
  return shoot(string, to, guess, [&](const auto& x, auto& y, auto& l) {
    y = {from[0], from[1], x[0], x[1]};
    l = length;
  });
}

StringSolution solve_geodesic(const geometry::SurfacePtr& surface, const std::array<double, 2>& from,
                              const std::array<double, 2>& to, const std::array<double, 2>& guess) {
  return shoot({surface}, to, guess, [&](const auto& x, auto& y, auto& l) {
    y = {from[0], from[1], x[0], 1.0};
    l = x[1];
  });
}

}  // namespace tendril::formulation

// The rod on a sphere (III.1.5): wavelength and angular progression, the map and gallery of closed elasticae
// (Figs. III.1.3-4), the extensible rod (Fig. III.1.5); each closed form against the general solver for surface-bound
// rods or a quadrature.
#include "tendril/closed_form/sphere.hpp"

#include <algorithm>
#include <cmath>

#include "tendril/reproduce/sphere_detail.hpp"
#include "tendril/reproduce/systems.hpp"

namespace tendril::reproduce {

namespace {

using namespace on_sphere;
using closed_form::SphereElastica;
using closed_form::SphereRod;
namespace bound = formulation;

/// (III.1.66) integrated over the period: the trapezoidal rule of a periodic analytic function.
double longitude_by_quadrature(const SphereElastica& rod) {
  double sum = 0.0;
  constexpr int parts = 4096;
  for (int i = 0; i < parts; ++i) sum += rod.longitude_rate(rod.period() * i / parts);
  return sum * rod.period() / parts;
}

void add_inextensible(Outcome& out) {
  struct Case {
    double sigma, kappa_max;
  };
  for (const Case c : {Case{0.5, 1.7}, Case{-1.3, 0.9}, Case{0.3, 2.5}, Case{-3.0, 1.2}, Case{2.0, 1.8}, Case{1.0, 1.2},
                       Case{6.0, 3.0}, Case{4.0, 2.2}}) {
    const SphereElastica rod(c.sigma, c.kappa_max);
    out.rows.push_back({text(rod.wavelike() ? "wavelength Λ(σ = %g, κ_m = %g)" : "progression Δϑ(σ = %g, κ_m = %g)",
                             c.sigma, c.kappa_max),
                        rod.longitude_per_period(), longitude_by_quadrature(rod), exact,
                        rod.wavelike() ? "(III.1.68), factor corrected, against (III.1.66) by quadrature"
                                       : "(III.1.69), factor corrected, against (III.1.66) by quadrature"});
  }
  // limits of both families and the jump at κ_σ = 2, extrapolated from both sides
  out.rows.push_back({"Δϑ/2π of the circle κ_g = 1.5, small orbits about it", progression(0.0, 2.25),
                      std::sqrt(1.0 + 1.0 / 2.25), exact, "linearised: sqrt(1 + 1/κ_m²)"});
  const auto towards = [](double square, double side) {
    double value = 0.0;
    const double weight[4] = {4.0, -6.0, 4.0, -1.0};  // cubic extrapolation to 0 from h, 2h, 3h, 4h
    for (int i = 0; i < 4; ++i) value += weight[i] * progression(2.0 + side * 1e-3 * (i + 1), square);
    return 2.0 * pi * value;
  };
  out.rows.push_back({"jump of Λ across κ_σ = 2 at κ_m² = 1.5", towards(1.5, -1.0) - towards(1.5, 1.0), 4.0 * pi, exact,
                      "4π (III.1.5.1)"});
  out.rows.push_back({"jump of Δϑ across κ_σ = 2 at κ_m² = 6", towards(6.0, -1.0) - towards(6.0, 1.0), 2.0 * pi, exact,
                      "2π (III.1.5.1)"});
  double small = 0.0;
  for (const double kappa_sigma : {0.7, 5.0}) {
    const double limit = (kappa_sigma < 2.0 ? 1.0 : -1.0) * std::sqrt(2.0 / kappa_sigma);
    // analytic in κ_m²: extrapolated to 0 from three places
    const double h = 2e-5, at_0 = 3.0 * progression(kappa_sigma, h) - 3.0 * progression(kappa_sigma, 2.0 * h) +
                                  progression(kappa_sigma, 3.0 * h);
    small = std::max(small, std::abs(at_0 - limit));
  }
  out.rows.push_back({"Λ/2π for κ_m -> 0, largest difference at κ_σ = 0.7, 5", small, 0.0, exact,
                      "±sqrt(2/κ_σ), linearised about the equator"});

  // the general solver, with torque, over one period
  const double M_3 = 1.4;
  for (const Case c : {Case{0.5, 1.7}, Case{-1.3, 0.9}, Case{2.0, 1.8}, Case{6.0, 3.0}}) {
    const SphereElastica rod(c.sigma, c.kappa_max);
    const bound::SurfaceRod model{geometry::sphere(1.0), 0.0, 0.0, {}, {}};
    std::vector<double> s;
    for (int i = 0; i <= 40; ++i) s.push_back(rod.period() * i / 40);
    const auto curve = bound::integrate_surface_rod(model, crest(rod, c.kappa_max, c.sigma, M_3), s);
    double state = curve.summary.completed ? 0.0 : HUGE_VAL, place = state, moment = state;
    const double I = std::sqrt(1.0 + 0.25 * (std::pow(c.kappa_max, 4) + c.sigma * c.sigma) +
                               0.5 * c.sigma * (2.0 - c.kappa_max * c.kappa_max));  // (III.1.67)
    for (const auto& x : curve.section) {
      const auto e = rod.state(x.s, M_3);  // N outward there
      for (double d : {x.kappa_g + e.kappa_g, x.F_g + e.F_g, x.F_n + e.F_n, x.F_3 - e.F_3, x.rho + e.rho})
        state = std::max(state, std::abs(d));
      place = std::max(place, std::abs(x.r[2] - rod.height(x.s)));
      const double total =
          std::hypot(x.M[0] + x.r[1] * x.F[2] - x.r[2] * x.F[1], x.M[1] + x.r[2] * x.F[0] - x.r[0] * x.F[2],
                     x.M[2] + x.r[0] * x.F[1] - x.r[1] * x.F[0]);
      moment = std::max(moment, std::abs(total - I));
    }
    const auto name = text("over a period at σ = %g, κ_m = %g, M_3 = %g: ", c.sigma, c.kappa_max, M_3);
    out.rows.push_back({name + "κ_g, F, ρ", state, 0.0, exact, "(III.1.59-64) against the general solver"});
    out.rows.push_back({name + "height ζ", place, 0.0, exact, "(III.1.66) against the general solver"});
    out.rows.push_back({name + "total moment", moment, 0.0, exact, "(III.1.67) against the general solver"});
  }
}

void add_extensible(Outcome& out) {
  for (const double eta : {1.0 / 20.0, 1.0 / 5.0}) {
    const double sigma = eta < 0.1 ? 10.0 : 3.0;
    // the other root of I(κ, 0) = I(0, 0), by bisection
    const double there = SphereRod::integral_squared(sigma, eta, 0.0, 0.0);
    double low = 0.2 * std::sqrt(sigma), high = 10.0 * std::sqrt(sigma);
    for (int i = 0; i < 200; ++i) {
      const double middle = 0.5 * (low + high);
      (SphereRod::integral_squared(sigma, eta, middle, 0.0) < there ? low : high) = middle;
    }
    out.rows.push_back({text("separatrix κ_m² at σ = %g, η = 1/%g", sigma, 1.0 / eta),
                        SphereRod::separatrix(sigma, eta), low * low, exact,
                        "(III.1.74), corrected, against the root of I(0,0) = I(κ_m,0)"});
  }
  const double M_3 = 0.7;
  struct Case {
    double sigma, share;  // of the least I
  };
  for (const Case c : {Case{-10.0, 1.2}, Case{10.0, 1.2}, Case{10.0, 2.2}}) {
    const double stationary =
        std::sqrt(std::max(0.0, std::pow(SphereRod::alpha_0(c.sigma, slender), 2) - 1.0 / (slender * slender) - 1.0));
    const double I = c.share * std::sqrt(SphereRod::integral_squared(c.sigma, slender, stationary, 0.0));
    const SphereRod orbit(c.sigma, slender, I);
    const double inverse = 1.0 / (slender * slender), crest_curvature = orbit.kappa_max();
    const bound::SurfaceRod model{geometry::sphere(1.0), slender * slender, 0.3, {}, {}};
    const bound::SurfaceRodState<double> start{
        0.1, 0.2, 0.3, crest_curvature, -M_3, inverse * (orbit.stretch(crest_curvature) - 1.0), M_3, 0.0};
    std::vector<double> s;
    for (int i = 0; i <= 40; ++i) s.push_back(orbit.period() * i / 40);
    const auto curve = bound::integrate_surface_rod(model, start, s);
    const std::string name = text("extensible, σ = %g, I = %.4g: ", c.sigma, I);
    if (!curve.summary.completed) {
      out.rows.push_back({name + "integration", gap, 0.0, exact, curve.summary.reason});
      continue;
    }
    double moment = 0.0, pressure = 0.0, slopes = 0.0;
    for (const auto& x : curve.section) {
      const double rate = -(x.F_g + x.kappa_n * M_3);  // (α κ_g)'/α (III.1.36)
      const double slope = rate * (1.0 + inverse + x.kappa_g * x.kappa_g) / (1.0 + inverse);
      moment =
          std::max(moment, std::abs(std::sqrt(SphereRod::integral_squared(c.sigma, slender, x.kappa_g, slope)) - I));
      pressure = std::max(pressure, std::abs(x.rho - orbit.inward_pressure(x.kappa_g, slope, M_3)));
      slopes = std::max(slopes, std::abs(slope * slope - std::pow(orbit.slope(x.kappa_g), 2)));
    }
    out.rows.push_back({name + "κ_g after half a period", curve.section[20].kappa_g, orbit.kappa_min(), exact,
                        "extremum from 1 ∓ d, period by quadrature, against the general solver"});
    out.rows.push_back({name + "κ_g after a period", curve.section[40].kappa_g, orbit.kappa_max(), exact, "the same"});
    out.rows.push_back({name + "total moment I along the rod", moment, 0.0, exact, "(III.1.72)"});
    out.rows.push_back({name + "κ_g'^2 on the orbit", slopes, 0.0, exact, "(III.1.72) solved for κ_g'"});
    out.rows.push_back({name + "pressure", pressure, 0.0, exact, "(III.1.71) against (III.1.29)"});
  }
}

Outcome compute(const Progress& progress) {
  Outcome out;
  const auto step = [&](double done, const char* what) {
    if (progress && !progress(done, what)) throw Interrupted{};
  };
  step(0.0, "wavelength and angular progression");
  add_inextensible(out);
  step(0.2, "map of the closed elasticae");
  out.pictures.push_back(wavelength());
  out.pictures.push_back(map(out));
  out.pictures.push_back(gallery(out, progress));
  step(0.7, "extensible rod");
  add_extensible(out);
  out.pictures.push_back(phase_portrait());
  out.pictures.push_back(extrema(out));
  out.notes.push_back(
      "The thesis prints q and the parameters of its twenty elasticae in the picture only; the members here are chosen "
      "to have the properties its text names: (a,b,c,d), (e,f), (i,g,h) on contours that lose one turn at κ_σ = 2, "
      "(n,k,l) "
      "and (r,o,p) two, (m) a circle, (q) the equator.");
  out.notes.push_back(
      "Extensible rod: with the extreme stretches 1 ∓ d explicit, period and extrema need no numerical root finding; "
      "the "
      "thesis states that no closed form is known.");
  step(1.0, "done");
  return out;
}

}  // namespace

System sphere_system() {
  return {"sphere",
          "Rod on a sphere",
          "III.1.5; Figs. III.1.3, III.1.4, III.1.5",
          "Closed forms of the elastica on a sphere, closed curves, and the extensible rod.",
          &compute,
          0.8};
}

}  // namespace tendril::reproduce

// The extensible rod on the sphere: phase portrait and extrema of Fig. III.1.5.
#include <algorithm>
#include <stdexcept>

#include "tendril/reproduce/sphere_detail.hpp"

namespace tendril::reproduce::on_sphere {

namespace {

using closed_form::SphereRod;

/// κ_g' of the inextensible rod (A.3.9) squared.
double elastica_slope_squared(double sigma, double I, double kappa) {
  const double square = kappa * kappa;
  return I * I - 0.25 * (square * (square - 2.0 * sigma) + (2.0 + sigma) * (2.0 + sigma));
}

}  // namespace

Picture phase_portrait() {
  Picture picture{"phase_portrait",
                  "Phase portraits of the total moment, η = 1/20 (Fig. III.1.5a): extensible rod (solid), inextensible "
                  "(dashed), the separatrix in black, the stationary circles as dots.",
                  {}};
  picture.figure.panel_width = 430.0;
  picture.figure.panel_height = 360.0;
  for (const double sigma : {-10.0, 10.0}) {
    drawing::Panel panel;
    panel.title = sigma < 0.0 ? "σ = −10 B/R²" : "σ = 10 B/R²";
    panel.x_label = "geodesic curvature κ_g [1/R]";
    panel.y_label = "its slope κ_g' [1/R²]";
    const double at_rest = std::sqrt(SphereRod::integral_squared(sigma, slender, 0.0, 0.0));
    std::vector<double> integrals = sigma < 0.0 ? std::vector<double>{4.3, 5.5, 8.0, 12.0, 17.0}
                                                : std::vector<double>{3.6, 4.5, 5.4, at_rest, 7.5, 10.0, 14.0, 18.0};
    int shown = 0;
    for (double I : integrals) {
      const bool border = I == at_rest;
      // exactly on the separatrix the closed form is at the edge of a family: a hair inside
      const SphereRod orbit(sigma, slender, border ? I * (1.0 + 1e-12) : I);
      drawing::Curve solid, dashed;
      solid.colour = border ? 6 : 0;
      dashed.colour = border ? 6 : 1;
      dashed.line = drawing::Line::dashed;
      dashed.width = 1.2;
      if (shown++ == 0) solid.label = "extensible, η = 1/20", dashed.label = "inextensible";
      const double low = orbit.kappa_min(), high = orbit.kappa_max();
      const double inner = sigma - 2.0 * std::sqrt(std::max(0.0, I * I - 1.0 - sigma)),
                   outer = std::sqrt(sigma + 2.0 * std::sqrt(std::max(0.0, I * I - 1.0 - sigma)));
      for (const double side : {1.0, -1.0}) {
        for (int i = 0; i <= 360; ++i) {
          const double angle = i * pi / 180, up = angle <= pi ? 1.0 : -1.0;
          const double k = 0.5 * (high + low) + 0.5 * (high - low) * std::cos(angle);
          solid.x.push_back(side * k);
          solid.y.push_back(up * orbit.slope(k));
          const double lowest = inner > 0.0 ? std::sqrt(inner) : -outer;
          const double e = 0.5 * (outer + lowest) + 0.5 * (outer - lowest) * std::cos(angle);
          dashed.x.push_back(side * e);
          dashed.y.push_back(up * std::sqrt(std::max(0.0, elastica_slope_squared(sigma, I, e))));
        }
        for (auto* c : {&solid, &dashed}) c->x.push_back(gap), c->y.push_back(gap);
        if (orbit.wavelike()) break;
      }
      panel.curves.push_back(std::move(solid));
      panel.curves.push_back(std::move(dashed));
    }
    drawing::Curve rest;
    rest.line = drawing::Line::none;
    rest.mark = drawing::Mark::circle;
    rest.colour = 2;
    rest.label = "stationary";
    rest.x = {0.0};
    rest.y = {0.0};
    if (sigma > 0.0) {
      const double k = std::sqrt(std::pow(SphereRod::alpha_0(sigma, slender), 2) - 1.0 / (slender * slender) - 1.0);
      rest.x = {-k, 0.0, k};
      rest.y = {0.0, 0.0, 0.0};
    }
    panel.curves.push_back(rest);
    picture.figure.panels.push_back(std::move(panel));
  }
  return picture;
}

Picture extrema(Outcome& out) {
  Picture picture{"extrema",
                  "Extrema of the geodesic curvature for given total moment I, η = 1/20 (Fig. III.1.5b): extensible "
                  "(solid), inextensible (dashed). Yellow: non-inflectional solutions, bounded by the corrected "
                  "(III.1.74); green: the stationary circles.",
                  {}};
  picture.figure.columns = 1;
  picture.figure.panel_width = 700.0;
  picture.figure.panel_height = 480.0;
  drawing::Panel panel;
  panel.title = "Extrema of the geodesic curvature";
  panel.x_label = "tension parameter σ [B/R²]";
  panel.y_label = "extrema of κ_g [1/R]";
  constexpr double most = 32.0;
  panel.x_range = {{-most, most}};
  panel.y_range = {{-9.0, 9.0}};
  drawing::Curve region, stationary;
  region.filled = true;
  region.colour = 4;
  region.opacity = 0.25;
  region.label = "non-inflectional";
  stationary.colour = 2;
  stationary.width = 2.2;
  stationary.label = "stationary circles";
  for (int i = 0; i <= 200; ++i) {
    const double sigma = most * (i / 200.0) * (i / 200.0);
    region.x.push_back(sigma);
    region.y.push_back(std::sqrt(SphereRod::separatrix(sigma, slender)));
  }
  for (int i = 200; i >= 0; --i) region.x.push_back(region.x[i]), region.y.push_back(-region.y[i]);
  for (int i = -200; i <= 200; ++i) {
    const double sigma = most * (i / 200.0) * (i / 200.0), inverse = 1.0 / (slender * slender);
    const double square = std::pow(SphereRod::alpha_0(sigma, slender), 2) - inverse - 1.0;
    stationary.x.push_back(sigma);
    stationary.y.push_back(std::copysign(std::sqrt(std::max(0.0, square)), i));
  }
  panel.curves.push_back(region);
  panel.curves.push_back(stationary);
  Data table{"extrema",
             {"I", "sigma [B/R^2]", "kappa_min [1/R]", "kappa_max [1/R]", "inextensible kappa_min [1/R]",
              "inextensible kappa_max [1/R]"},
             std::vector<std::vector<double>>(6)};
  bool first = true;
  for (const double I : {1.5, 3.0, 6.0, 9.0, 12.0}) {
    drawing::Curve solid, dashed;
    solid.colour = 0;
    dashed.colour = 1;
    dashed.line = drawing::Line::dashed;
    dashed.width = 1.2;
    if (first) solid.label = "extensible, η = 1/20", dashed.label = "inextensible";
    first = false;
    std::vector<double> sigmas, outer, inner, e_outer, e_inner;
    for (int i = 0; i <= 3000; ++i) {
      const double sigma = -most + 2.0 * most * i / 3000;
      double high = gap, low = gap, e_high = gap, e_low = gap;
      try {
        const SphereRod orbit(sigma, slender, I);
        high = orbit.kappa_max();
        low = orbit.kappa_min();
      } catch (const std::domain_error&) {  // no orbit of this moment at this tension
      }
      const double root = I * I - 1.0 - sigma;
      if (root >= 0.0 && sigma + 2.0 * std::sqrt(root) >= 0.0) {
        e_high = std::sqrt(sigma + 2.0 * std::sqrt(root));
        e_low = sigma > 2.0 * std::sqrt(root) ? std::sqrt(sigma - 2.0 * std::sqrt(root)) : -e_high;
      }
      sigmas.push_back(sigma), outer.push_back(high), inner.push_back(low);
      e_outer.push_back(e_high), e_inner.push_back(e_low);
      if (i % 30 == 0 && (std::isfinite(high) || std::isfinite(e_high))) {
        const double line[] = {I, sigma, low, high, e_low, e_high};
        for (int c = 0; c < 6; ++c) table.value[c].push_back(line[c]);
      }
    }
    // both extrema and their mirror images; the jump from wavelike to orbit-like is a break
    const auto draw = [&](drawing::Curve curve, const std::vector<double>& high, const std::vector<double>& low) {
      for (const double sign : {1.0, -1.0}) {
        for (const auto* branch : {&high, &low}) {
          for (std::size_t i = 0; i < sigmas.size(); ++i) {
            if (i > 0 && ((*branch)[i] > 0.0) != ((*branch)[i - 1] > 0.0))
              curve.x.push_back(gap), curve.y.push_back(gap), curve.x.push_back(sigmas[i]), curve.y.push_back(0.0);
            curve.x.push_back(sigmas[i]);
            curve.y.push_back(sign * (*branch)[i]);
          }
          curve.x.push_back(gap), curve.y.push_back(gap);
        }
      }
      panel.curves.push_back(std::move(curve));
    };
    draw(solid, outer, inner);
    draw(dashed, e_outer, e_inner);
    panel.words.push_back({-2.0 - 2.0 * I, 0.0, text("I = %g", I)});  // the equator: I = |1 + σ/2|
  }
  picture.figure.panels.push_back(std::move(panel));
  out.data.push_back(std::move(table));
  return picture;
}

}  // namespace tendril::reproduce::on_sphere

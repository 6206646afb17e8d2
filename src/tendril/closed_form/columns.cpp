#include "tendril/closed_form/columns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tendril/closed_form/domain.hpp"
#include "tendril/closed_form/elliptic.hpp"

namespace tendril::closed_form {
namespace {

constexpr double pi = std::numbers::pi;

/// Bisection to the last bit between `low` and `high`, where f changes sign.
template <class F>
double root(F&& f, double low, double high) {
  const bool rising = f(high) > 0.0;
  for (;;) {
    const double middle = low + 0.5 * (high - low);
    if (middle <= low || middle >= high) return middle;
    ((f(middle) > 0.0) == rising ? high : low) = middle;
  }
}

void check(double length, double bending_stiffness) {
  require(length > 0.0 && std::isfinite(length), "length", length, "positive");
  require(bending_stiffness > 0.0 && std::isfinite(bending_stiffness), "bending stiffness", bending_stiffness,
          "positive");
}

/// k-th positive root of tan z = z, between kπ and (k + 1/2)π.
double tangent_root(int k) {
  return root([](double z) { return std::sin(z) - z * std::cos(z); }, k * pi, (k + 0.5) * pi);
}

struct Arc {
  double K, chord;  // K(m), c = 2 E/K - 1
};
Arc arc(double slope) {
  const double m = std::sin(0.5 * slope) * std::sin(0.5 * slope), K = complete_k(m);
  return {K, 2.0 * complete_e(m) / K - 1.0};
}

void check_slope(double slope, double bound, const char* text) {
  require(slope > 0.0 && slope < bound, "slope", slope, text);
}

}  // namespace

double euler_load_clamped(int n, double length, double bending_stiffness) {
  require(n >= 1, "number of the buckling mode", n, "1 or more");
  check(length, bending_stiffness);
  // Half length times wave number: multiples of π (symmetric) and the roots of tan z = z (antisymmetric) alternate.
  const double z = n % 2 == 1 ? pi * (n + 1) / 2 : tangent_root(n / 2);
  return 4.0 * z * z * bending_stiffness / (length * length);
}

double greenhill_torque_hinged(double thrust, double length, double bending_stiffness) {
  check(length, bending_stiffness);
  const double room = pi * pi / (length * length) - thrust / bending_stiffness;
  require(room >= 0.0, "thrust", thrust, "at most Euler's load, pi^2 B/L^2");
  return 2.0 * bending_stiffness * std::sqrt(room);
}

double greenhill_torque_clamped(double thrust, double length, double bending_stiffness) {
  check(length, bending_stiffness);
  const double P = thrust * length * length / bending_stiffness;
  require(P <= 4.0 * pi * pi, "thrust", thrust, "at most Euler's load, 4 pi^2 B/L^2");
  // Complex deflection w = c0 + c1 s + c2 e^{ias} + c3 e^{ibs}, a, b = m/2 ± √(m²/4 + P), clamped at ±1/2.
  const auto condition = [P](double m) {
    const double r2 = 0.25 * m * m + P;
    const double r = std::sqrt(std::max(r2, 0.0)), u = 0.25 * m + 0.5 * r, v = 0.25 * m - 0.5 * r;  // a/2, b/2
    return v * std::sin(v) * (std::sin(u) - u * std::cos(u)) - u * std::sin(u) * (std::sin(v) - v * std::cos(v));
  };
  // Below m² = -4P (tension) the roots a, b are complex and the rod is stable. v = 0 (P = 0) and u = v are spurious
  // roots, so the search starts beyond them and looks for the first change of sign.
  if (P == 0.0) return 2.0 * tangent_root(1) * bending_stiffness / length;
  if (P == 4.0 * pi * pi) return 0.0;
  const double step = 1e-2;
  double low = (P < 0.0 ? 2.0 * std::sqrt(-P) : 0.0) + 1e-6, at_low = condition(low);
  for (;;) {
    const double high = low + step, at_high = condition(high);
    if ((at_low > 0.0) != (at_high > 0.0)) return root(condition, low, high) * bending_stiffness / length;
    low = high;
    at_low = at_high;
  }
}

PlanarState first_contact(double slope, double rod_length, double bending_stiffness) {
  check(rod_length, bending_stiffness);
  check_slope(slope, pi, "between 0 and pi");
  const Arc quarter = arc(slope);
  PlanarState s;
  s.slope = slope;
  s.rod_length = rod_length;
  s.arc_length = 0.5 * rod_length;
  s.clearance = rod_length * std::sin(0.5 * slope) / quarter.K;
  s.span = rod_length * quarter.chord;
  require(s.span > 0.0, "span of the bent rod", s.span, "positive");
  s.thrust = 16.0 * quarter.K * quarter.K * bending_stiffness / (rod_length * rod_length);
  return s;
}

PlanarState point_to_line(double slope, double rod_length, double bending_stiffness) {
  check(rod_length, bending_stiffness);
  check_slope(slope, 0.5 * pi, "between 0 and pi/2");
  const Arc wave = arc(slope);  // each half of the rod is one whole wave, its line of thrust inclined by a
  const double force = 64.0 * wave.K * wave.K * bending_stiffness / (rod_length * rod_length);
  PlanarState s;
  s.slope = slope;
  s.rod_length = rod_length;
  s.arc_length = 0.5 * rod_length;
  s.clearance = s.arc_length * wave.chord * std::sin(slope);
  s.span = rod_length * wave.chord * std::cos(slope);
  s.thrust = force * std::cos(slope);
  s.reaction = 2.0 * force * std::sin(slope);
  return s;
}

PlanarState flat_part_buckles(double slope, double rod_length, double bending_stiffness) {
  check(rod_length, bending_stiffness);
  check_slope(slope, 0.5 * pi, "between 0 and pi/2");
  const Arc wave = arc(slope);
  // c_f = l π/(2 K √cos a) from equal thrust in the arcs and, at its buckling load, in the flat part.
  const double ratio = pi / (2.0 * wave.K * std::sqrt(std::cos(slope)));
  const double l = rod_length / (2.0 + ratio);
  const double force = 16.0 * wave.K * wave.K * bending_stiffness / (l * l);
  PlanarState s;
  s.slope = slope;
  s.rod_length = rod_length;
  s.arc_length = l;
  s.flat_length = ratio * l;
  s.clearance = l * wave.chord * std::sin(slope);
  s.span = 2.0 * l * wave.chord * std::cos(slope) + s.flat_length;
  s.thrust = force * std::cos(slope);
  s.reaction = 2.0 * force * std::sin(slope);
  return s;
}

namespace {

/// The state with clearance/span as given; the rod length then follows from the span by scale.
template <class State>
PlanarState at_span(State&& state, double clearance, double span, double bending_stiffness, double steepest) {
  check(span, bending_stiffness);
  require(clearance > 0.0 && std::isfinite(clearance), "clearance", clearance, "positive");
  const auto excess = [&](double slope) {
    const PlanarState s = state(slope, 1.0, 1.0);
    return s.clearance * span - clearance * s.span;
  };
  require(excess(steepest) > 0.0, "clearance over span", clearance / span, "smaller: the rod would fold back");
  const double slope = root(excess, 0.0, steepest);
  return state(slope, span / state(slope, 1.0, 1.0).span, bending_stiffness);
}

}  // namespace

PlanarState first_contact_at_span(double clearance, double span, double bending_stiffness) {
  return at_span(first_contact, clearance, span, bending_stiffness, 2.28);  // the chord vanishes at a = 2.2814
}
PlanarState point_to_line_at_span(double clearance, double span, double bending_stiffness) {
  return at_span(point_to_line, clearance, span, bending_stiffness, 1.57);
}
PlanarState flat_part_buckles_at_span(double clearance, double span, double bending_stiffness) {
  return at_span(flat_part_buckles, clearance, span, bending_stiffness, 1.1);  // h/D is largest near a = 1.12
}

}  // namespace tendril::closed_form

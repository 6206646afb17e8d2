#include "tendril/segmentation/discovery_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tendril::segmentation {

using formulation::Vector6;
using std::numbers::pi;

Scales scales_of(const DiscoveryProblem& p, const DiscoveryOptions& o) {
  Scales s;
  const double L = p.tube.length();
  const int samples = 200;
  double curvature = 0.0, largest = 0.0;
  s.clearance = 1e300;
  for (int i = 0; i <= samples; ++i) {
    const double S = std::min(p.end_position * i / samples * L, L);
    const auto U = p.tube.axis->at(S).U;
    curvature = std::max(curvature, std::hypot(U[0][0], U[0][1]) * L);
    const double Q = p.data.clearance_scale * p.tube.clearance->at(S)[0] / L;
    s.clearance = std::min(s.clearance, Q);
    largest = std::max(largest, Q);
  }
  const double weight = p.data.largest_force();
  s.force = 4.0 * pi * pi / (p.end_position * p.end_position);
  if (p.axial != AxialControl::rod_length) s.force = std::max(s.force, std::abs(p.axial_value) + weight);
  // Bending length of a rod under axial force, of a rod lying on the wall, and of the axis itself.
  const double length =
      std::min({1.0 / std::sqrt(s.force), std::pow(s.clearance / std::max(weight, 1e-9), 0.25),
                std::pow(s.clearance / std::max(s.force * curvature, 1e-9), 0.25), 1.5 / std::max(curvature, 1e-9)});
  int n = o.elements;
  if (n <= 0) n = std::clamp(static_cast<int>(std::ceil(p.end_position / (0.8 * length))), 48, 6000);
  s.size = p.end_position / n;
  return s;
}

Search::Search(const DiscoveryProblem& p, const DiscoveryOptions& o, const Scales& s, DiscreteRod rod)
    : p_(p), o_(o), s_(s), eq_(std::move(rod)) {
  eq_.stop = o.stop;
  auto& f = eq_.fixed;
  f.front() = p.start.held();
  f.back() = p.end.held();
  if (o.planar)
    for (auto& v : f) v.tail<2>().setOnes();
  // Penetration decays over about one element: stiffer walls than the mesh can show only slow the search.
  eq_.wall_stiffness = std::max(4.0 / std::pow(s.size, 4), 20.0 * s.force * s.force);
  // An inextensible (or nearly so) rod gets a compliance that loses 1 % of the slack a buckled rod finds in its tube.
  if (p.data.eta2 * p.end_position < 0.01 * s.clearance * s.clearance)
    eq_.length_compliance = 0.01 * s.clearance * s.clearance;
  if (p.end.open()) {  // the wall meets the end itself; around the last nodes it is left to it
    eq_.tip_wall = true;
    eq_.tip_stiffness = eq_.wall_stiffness * s.size;
    const double last = eq_.rod().nodes()[eq_.rod().node_count() - 2];
    for (std::size_t i = 0; i < eq_.rod().points().size(); ++i)
      if (eq_.rod().points()[i].S > last) eq_.wall_share[i] = 0.0;
    eq_.tip_load = Vector4(p.tip_force[0], p.tip_couple[1], p.tip_force[1], -p.tip_couple[0]);
  }
  if (o.coarse != nullptr) warm();
  eq_.torque = p.twist == TwistControl::torque ? p.twist_value : 0.0;
  eq_.twist_held = p.twist == TwistControl::twist;
  eq_.twist_target = p.twist_value;
  eq_.twist_length = p.end_position;
  if (p.data.properties) {
    double compliance = 0.0, length = 0.0;
    for (const auto& q : eq_.rod().points()) {
      compliance += q.weight / (p.data.properties(q.S).C * (1.0 + p.data.nu));
      length += q.weight;
    }
    eq_.twist_share = compliance / length;
  }
}

// The wall of a refined search: stiff as each element's size asks, its pressure the coarse one's.
void Search::warm() {
  const auto& rod = eq_.rod();
  const auto &S = o_.coarse->wall_S, &p = o_.coarse->wall_pressure;
  for (std::size_t i = 0; i < rod.points().size(); ++i) {
    const auto& q = rod.points()[i];
    const double h = rod.nodes()[q.element + 1] - rod.nodes()[q.element];
    if (eq_.wall_share[i] == 0.0) continue;
    eq_.wall_share[i] = std::min(1.0, 4.0 / (std::pow(h, 4) * eq_.wall_stiffness));
    const std::size_t k =
        std::clamp<std::ptrdiff_t>(std::upper_bound(S.begin(), S.end(), q.S) - S.begin(), 1, std::ssize(S) - 1);
    const double x = std::clamp((q.S - S[k - 1]) / (S[k] - S[k - 1]), 0.0, 1.0);
    eq_.wall_multiplier[i] = p[k - 1] + x * (p[k] - p[k - 1]);
  }
}

void Search::guess() {
  const auto& S = eq_.rod().nodes();
  const std::size_t n = S.size();
  if (o_.initial != nullptr && o_.initial->S.size() >= 2) {
    const DiscreteState& from = *o_.initial;
    for (std::size_t i = 0; i < n; ++i) {
      const auto x = evaluate(from, S[i]);
      eq_.u[i] = Vector4(x[0], x[1], x[3], x[4]);
    }
    eq_.lambda = from.lambda;
    if (eq_.twist_held) eq_.torque = from.torque;
  } else if (p_.tube.side == geometry::Side::outside) {
    // Winding on the wall from one end's azimuth to the other's.
    const double b0 = std::atan2(p_.start.eccentricity[1], p_.start.eccentricity[0]);
    double b1 = std::atan2(p_.end.eccentricity[1], p_.end.eccentricity[0]);
    if (b1 - b0 > pi) b1 -= 2.0 * pi;
    if (b1 - b0 < -pi) b1 += 2.0 * pi;
    const double rate = (b1 - b0 + 2.0 * pi * p_.turns) / p_.end_position;
    for (std::size_t i = 0; i < n; ++i) {
      const double b = b0 + rate * S[i], Q = 1.001 * eq_.rod().clearance_at(S[i]);
      eq_.u[i] = Vector4(Q * std::cos(b), -Q * rate * std::sin(b), Q * std::sin(b), Q * rate * std::cos(b));
    }
  } else {
    // Straight line in δ between the ends.
    const Eigen::Vector2d rate = (p_.end.eccentricity - p_.start.eccentricity) / p_.end_position;
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector2d d = p_.start.eccentricity + rate * S[i];
      eq_.u[i] = Vector4(d[0], rate[0], d[1], rate[1]);
    }
  }
  const auto end = [](const HeldEnd& e, Vector4& v) {
    if (e.free) return;
    if (!e.guided) {
      v[0] = e.eccentricity[0];
      v[2] = e.eccentricity[1];
    }
    if (e.pinned) return;
    v[1] = e.slope[0];
    v[3] = e.slope[1];
  };
  end(p_.start, eq_.u.front());
  end(p_.end, eq_.u.back());
}

// A small lateral wave that is neither symmetric nor planar: it has a part along every buckling mode. Where many waves
// fit it is a helix, so that a long rod winds one way.
void Search::perturb(double amplitude) {
  const auto& S = eq_.rod().nodes();
  const double waves = std::max(1.0, std::sqrt(0.5 * s_.force) * p_.end_position / (2.0 * pi)), k = 2.0 * pi * waves;
  const bool helix = waves > 2.0;
  for (std::size_t i = 1; i + 1 < S.size(); ++i) {
    const double x = S[i] / p_.end_position, e = std::sin(pi * x), de = pi * std::cos(pi * x);
    for (int j = 0; j < (o_.planar ? 1 : 2); ++j) {
      const double phase = 0.4 + 0.5 * pi * j, c = amplitude * (helix || j == 0 ? 1.0 : 0.35), mean = helix ? 0.1 : 0.7;
      const double f = mean + std::sin(k * x + phase), df = k * std::cos(k * x + phase);
      eq_.u[i][2 * j] += c * e * e * f;
      eq_.u[i][2 * j + 1] += c * (2.0 * e * de * f + e * e * df) / p_.end_position;
    }
  }
}

bool Search::settle(double tolerance, int iterations) {
  const auto r =
      eq_.minimise(tolerance * s_.clearance, std::min(iterations, o_.max_iterations - iterations_), 0.5 * s_.clearance);
  iterations_ += r.iterations;
  factorisations_ += r.factorisations;
  see_reach();
  return r.converged;
}

void Search::see_reach() {
  const auto& rod = eq_.rod();
  for (const auto& q : rod.points()) {
    const auto d = formulation::density_invariants(q.section, rod.at(q, eq_.u));
    if (d.g3 < reach_.inclination) {
      reach_.inclination = d.g3;
      reach_.inclination_S = q.S;
    }
    if (const double C3 = d.g3 * std::sqrt(d.a); C3 < reach_.spread) {
      reach_.spread = C3;
      reach_.spread_S = q.S;
    }
  }
}

// A stationary state that is no minimum (the straight rod) is left along its unstable direction.
bool Search::settle_as_minimum(double tolerance) {
  for (int tries = 0; tries < 6; ++tries) {
    if (!settle(tolerance, 1000)) return false;
    if (!o_.perturb) return true;
    const double below = 1e-5 * (10.0 + 0.25 * eq_.lambda * eq_.lambda);
    const auto way = eq_.unstable_direction(below);
    if (!way) return true;
    for (std::size_t i = 0; i < eq_.u.size(); ++i) eq_.u[i] += 0.1 * s_.clearance * (*way)[i];
  }
  return false;
}

double Search::potential(bool at_end) const {
  const auto& rod = eq_.rod();
  const auto d = rod.section_at(at_end ? rod.nodes().back() : rod.nodes().front());
  const Vector4& v = at_end ? eq_.u.back() : eq_.u.front();
  return d.force_potential + d.force[0] * v[0] + d.force[1] * v[2];
}

double Search::control() {
  if (p_.axial == AxialControl::rod_length) return eq_.totals(eq_.u).length;
  const double H = eq_.lambda - potential(at_end());
  if (p_.axial == AxialControl::push) return -H;
  return axial_force(H - eq_.end_bending_energy(at_end()), p_.data.eta2);
}

// A free tip carries its load's share along d3, and the wall's where it rests on it.
double Search::target() const {
  if (p_.axial != AxialControl::axial_force || !p_.end.free) return p_.axial_value;
  const Vector4& v = eq_.u.back();
  const auto section = eq_.rod().section_at(eq_.rod().nodes().back());
  Vector6 x;
  x << v[0], v[1], 0.0, v[2], v[3], 0.0;
  Eigen::Vector3d t = section.V1 * x;
  t[2] += 1.0;
  t.normalize();
  double force = p_.axial_value + p_.tip_force.dot(t);
  const double r = std::hypot(v[0], v[2]);
  if (r > 0.0) force -= eq_.rod().sign() * eq_.tip_reaction() * (v[0] * t[0] + v[2] * t[1]) / r;
  return force;
}

double Search::wanted_lambda() {
  if (p_.axial == AxialControl::push) return potential(at_end()) - p_.axial_value;
  const double T = target();
  return T + 0.5 * p_.data.eta2 * T * T + eq_.end_bending_energy(at_end()) + potential(at_end());
}

// Minimum at fixed λ (dead push), λ corrected until the control is met. Fails where that push has no minimum nearby.
bool Search::direct() {
  eq_.length_held = false;
  eq_.lambda = wanted_lambda();
  if (!settle_as_minimum(1e-3)) return false;
  // A rod fed in without bound coils up until the elements no longer resolve it.
  for (std::size_t i = 0; i + 1 < eq_.u.size(); ++i) {
    const auto &a = eq_.u[i], &b = eq_.u[i + 1];
    const double turn = std::atan2(a[0] * b[2] - a[2] * b[0], a[0] * b[0] + a[2] * b[2]);
    const double radius = std::min(std::hypot(a[0], a[2]), std::hypot(b[0], b[2]));
    if (radius > 0.5 * s_.clearance && std::abs(turn) > 1.0) return false;
  }
  return true;
}

// The rod tied to where it starts, all loads on it, the ties loosened until they are gone: the ramp on which a rod that
// finds no support is seen to leave.
bool Search::ease() {
  eq_.anchor = eq_.u;
  eq_.lambda = 0.0;
  eq_.length_held = true;
  const auto start = eq_.totals(eq_.u);
  if (!start.valid) return false;
  const bool by_length = p_.axial == AxialControl::rod_length;
  double curvature = 0.0;
  for (const auto& q : eq_.rod().points()) curvature = std::max(curvature, q.section.U.head<2>().norm());
  const double load = p_.data.largest_force() + s_.force * (1.0 + curvature) + curvature * curvature * curvature;
  const double first = 10.0 * load / s_.clearance, last = 1e-3;
  eq_.length_held = by_length;
  double stiffness = first, factor = 0.3;
  auto u = eq_.u;
  double lambda = eq_.lambda, torque = eq_.torque;
  while (iterations_ < o_.max_iterations) {
    const double share = std::clamp(std::log(first / stiffness) / std::log(first / last), 0.0, 1.0);
    eq_.anchor_stiffness = stiffness > last ? stiffness : 0.0;
    if (by_length) {
      eq_.length_target = start.length + share * (p_.axial_value - start.length);
      eq_.twist_length = eq_.length_target;
    } else {
      eq_.lambda = wanted_lambda();
    }
    if (eq_.anchor_stiffness > 0.0 ? settle(1e-2, 60) : settle_as_minimum(1e-3)) {
      if (eq_.anchor_stiffness == 0.0) return true;
      u = eq_.u;
      lambda = eq_.lambda;
      torque = eq_.torque;
      factor = std::max(0.1, factor * factor);
    } else {
      if (factor > 0.9 || stiffness == first || !reach_.within()) return false;
      stiffness /= factor;
      factor = std::sqrt(factor);
      eq_.u = u;
      eq_.lambda = lambda;
      eq_.torque = torque;
    }
    stiffness *= factor;
  }
  return false;
}

// Length by length from the rod that fits the start, each a minimum; stops where the control passes its target.
bool Search::march() {
  eq_.length_held = true;
  eq_.lambda = 0.0;
  const auto start = eq_.totals(eq_.u);
  if (!start.valid) return false;
  eq_.length_target = start.length;
  eq_.length_multiplier = 0.0;
  const double wanted = p_.axial_value, scale = std::max(std::abs(wanted), 1.0);
  const double sense = p_.axial == AxialControl::push ? -1.0 : 1.0;  // stable: F3 falls, the push rises with the length
  if (p_.axial == AxialControl::rod_length) eq_.length_target = wanted;
  // The compliance in series stays in: its target is then a little off the rod's length, which sharpen() sets right.
  const auto converge = [&](double length) {
    eq_.length_target = length;
    eq_.twist_length = length;
    return settle_as_minimum(1e-4);
  };
  if (p_.axial == AxialControl::rod_length) return converge(wanted);
  if (!converge(eq_.length_target)) return false;
  best_ = control();
  double excess = sense * (control() - wanted);  // > 0: lengthen
  double step =
      (0.05 * s_.clearance * s_.clearance * s_.force + p_.data.eta2 * 0.05 * s_.force) * (excess > 0 ? 1 : -1);
  struct Point {
    double length, excess, lambda;
    std::vector<Vector4> u;
  };
  Point last{eq_.length_target, excess, eq_.lambda, eq_.u};
  std::optional<Point> beyond;
  for (int k = 0; k < 120 && iterations_ < o_.max_iterations; ++k) {
    if (std::abs(last.excess) < 1e-3 * scale) return true;
    double length = last.length + step;
    if (beyond) {
      double f = std::clamp(last.excess / (last.excess - beyond->excess), 0.1, 0.9);
      if (k % 3 == 2) f = 0.5;
      length = last.length + f * (beyond->length - last.length);
      if (std::abs(beyond->length - last.length) < 1e-10) return false;  // the control jumps over its target
    }
    eq_.u = last.u;
    eq_.lambda = last.lambda;
    if (!converge(length)) {
      step *= 0.4;
      if (std::abs(step) < 1e-9 || beyond || reach_.inclination < 0.1) return false;
      continue;
    }
    Point next{length, sense * (control() - wanted), eq_.lambda, eq_.u};
    if (std::abs(next.excess) < std::abs(best_ - wanted)) best_ = control();
    if (next.excess * last.excess <= 0.0) {
      beyond = next;
      if (std::abs(next.excess) < 1e-3 * scale) return true;
      continue;
    }
    if (!beyond) {
      // Secant, at most doubled: towards the target when the slope is the stable one, else simply on.
      const double slope = (next.excess - last.excess) / (next.length - last.length);
      double ahead = -next.excess / slope;
      step = std::copysign(std::min(2.0 * std::abs(step), 0.05), step);
      if (ahead * step > 0.0 && std::abs(ahead) < std::abs(step)) step = 1.02 * ahead;
    }
    last = next;
  }
  return false;
}

// A coarser state on finer elements, under the control it was found with.
bool Search::resume() {
  if (o_.coarse->dead_push) return direct() && sharpen();
  eq_.length_held = true;
  eq_.length_target = p_.axial == AxialControl::rod_length ? p_.axial_value : o_.coarse->state.length;
  eq_.length_multiplier = eq_.lambda;
  eq_.twist_length = eq_.length_target;
  return settle_as_minimum(1e-4) && sharpen();
}

// A state that is also a minimum under its dead push is sharpened under that: λ is then the better control in stiff
// states.
bool Search::release() {
  if (p_.axial == AxialControl::rod_length) return true;
  eq_.length_held = false;
  eq_.length_held = eq_.negative_eigenvalues(0.0) > 0;
  return true;
}

// dλ/dℓ and dF3/dℓ at the controlled end, the latter by a small step along the tangent for the end's bending energy.
Search::Slopes Search::slopes() {
  std::vector<Vector4> du;
  Slopes s;
  s.lambda = eq_.lambda_slope(du);
  double size = 0.0;
  for (const auto& v : du) size = std::max({size, std::abs(v[0]), std::abs(v[2])});
  // A straight rod on its axis changes no length: no slope.
  if (!std::isfinite(s.lambda) || !(size > 0.0) || std::abs(s.lambda) > 1e15) return {};
  const double step = 1e-4 * s_.clearance / size, before = eq_.end_bending_energy(at_end()), lambda = eq_.lambda;
  const auto u = eq_.u;
  for (std::size_t i = 0; i < du.size(); ++i) eq_.u[i] += step * du[i];
  eq_.lambda += step * s.lambda;
  const double rate = (eq_.end_bending_energy(at_end()) - before) / step;
  eq_.u = u;
  eq_.lambda = lambda;
  const double F = axial_force(lambda - potential(at_end()) - before, p_.data.eta2);
  s.force = (s.lambda - rate) / (1.0 + p_.data.eta2 * F);
  s.known = std::isfinite(s.force);
  return s;
}

// Multiplier updates of the wall, with the last corrections of λ or of the length towards the control.
bool Search::sharpen() {
  const bool by_length = p_.axial == AxialControl::rod_length;
  const double scale = by_length ? s_.clearance * s_.clearance * s_.force : std::max(std::abs(p_.axial_value), 1.0);
  double lambda_old = 0.0, off_old = 0.0;
  for (int k = 0; k < o_.multiplier_updates + 10; ++k) {
    const bool updating = k < o_.multiplier_updates;
    if (updating) {
      eq_.update_wall_multipliers();
      if (k == 0) eq_.wall_stiffness *= 4.0, eq_.tip_stiffness *= 4.0;
    }
    const double off = control() - target();
    if (eq_.length_held) {
      const auto slope = slopes();
      const double length = eq_.totals(eq_.u).length;
      double change = 0.0;
      if (by_length)
        change = -off;
      else if (slope.known)
        change = -off / (p_.axial == AxialControl::push ? -slope.lambda : slope.force);
      eq_.length_target = length + change;
      eq_.length_multiplier = eq_.lambda + (slope.known ? slope.lambda * change : 0.0);
    } else if (k > 0 && std::abs(off) > 1e-7 * scale) {
      double slope = p_.axial == AxialControl::push ? -1.0 : 1.0;
      if (k > 1 && eq_.lambda != lambda_old) {
        const double secant = (off - off_old) / (eq_.lambda - lambda_old);
        if (secant * slope > 0.0) slope = secant;
      }
      lambda_old = eq_.lambda;
      off_old = off;
      eq_.lambda -= off / slope;
    }
    if (eq_.twist_held) eq_.twist_length = eq_.totals(eq_.u).length;
    if (!settle_as_minimum(k + 1 < o_.multiplier_updates ? 1e-4 : o_.tolerance)) return false;
    if (!updating && std::abs(control() - target()) < 1e-6 * scale) return true;
  }
  return false;
}

double axial_force(double excess, double eta2) {  // F3 + ½η²F3² = excess
  const double root = 1.0 + 2.0 * eta2 * excess;
  return 2.0 * excess / (1.0 + std::sqrt(std::max(root, 0.0)));
}

}  // namespace tendril::segmentation

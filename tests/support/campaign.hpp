#pragma once
// Campaign: seeded everyday problems of every kind the solver claims to handle, L about 1 and B = 1.
//   axes        straight, arcs, helices and random smooth space curves, total bend up to three turns (6π),
//               largest clearance times curvature at most 0.5
//   clearance   0.2 to 5 % of the length, constant or varying
//   rods        uniform, or with steps and tapers of the stiffness along their length (campaign_rods.hpp)
//   ends        clamped, sleeve, pinned, guided; axial force, push or rod length; on the axis, off it, or on the wall;
//               free tips, of given place or of given length of rod, that hang or rest on the wall, with a dead load
//   loads       compression up to 40 first Euler loads of the straight rod with these ends, tension up to 100 B/L²,
//               torque or twist up to 4, weight up to 300 B/L³ in any direction
//   outside     tension, or compression below the first Euler load
// The same seed is the same problem with every standard library. What varies, guides or frees is drawn from dice of its
// own (`draw_special`).

#include <Eigen/Geometry>
#include <algorithm>

#include "support/campaign_rods.hpp"
#include "support/problems.hpp"
#include "tendril/geometry/error.hpp"

namespace tendril::test {

struct CampaignProblem {
  Problem problem;
  std::string words;           // what it is, for messages
  double euler = 0;            // first Euler load of the straight rod [force]
  bool stretch_small = false;  // α < 0.3 by the axial load alone: to be dropped
};

namespace campaign {

/// A curve of unit length whose Bishop curvatures are sums of harmonics, with total bend `bend`.
inline geometry::AxisPtr smooth_axis(Dice& dice, double bend) {
  constexpr int harmonics = 4, fine = 4000;
  std::array<std::array<double, harmonics>, 2> a{}, phase{};
  for (int c = 0; c < 2; ++c)
    for (int k = 0; k < harmonics; ++k) {
      a[c][k] = dice.between(-1, 1) / (1 + 0.5 * k);
      phase[c][k] = dice.between(0, 2 * pi);
    }
  const auto curvature = [&](double t, int c) {
    double u = 0;
    for (int k = 0; k < harmonics; ++k) u += a[c][k] * std::cos(pi * k * t + phase[c][k]);
    return u;
  };
  double total = 0;
  for (int i = 0; i < fine; ++i) {
    const double t = (i + 0.5) / fine;
    total += std::hypot(curvature(t, 0), curvature(t, 1)) / fine;
  }
  const int points = 17 + 3 * static_cast<int>(std::ceil(bend)), hop = fine / (points - 1);
  std::vector<Vector3d> out{Vector3d::Zero()};
  Eigen::Matrix3d D = Eigen::Matrix3d::Identity();
  Vector3d r = Vector3d::Zero();
  const int steps = hop * (points - 1);
  for (int i = 0; i < steps; ++i) {
    const double t = (i + 0.5) / steps, h = 1.0 / steps, f = bend / total * h;
    const Vector3d U = f * (curvature(t, 0) * D.col(0) + curvature(t, 1) * D.col(1));
    const double angle = U.norm();
    const Vector3d axis = angle > 0 ? Vector3d(U / angle) : Vector3d::UnitX();
    r += h * (Eigen::AngleAxisd(0.5 * angle, axis) * D.col(2));
    D = Eigen::AngleAxisd(angle, axis).toRotationMatrix() * D;
    if ((i + 1) % hop == 0) out.push_back(r);
  }
  return geometry::make_points(out).axis;
}

inline geometry::AxisPtr draw_axis(Dice& dice, std::ostringstream& words) {
  const double kind = dice.between(0, 1), bend = dice.between(0.1, 6 * pi);
  if (kind < 0.1) {
    words << "straight";
    return geometry::make_straight(1.0, dice.direction());
  }
  if (kind < 0.2) {
    words << "arc, bend " << std::min(bend, 5.0);
    return geometry::make_arc(1 / std::min(bend, 5.0), 1.0);
  }
  if (kind < 0.4) {
    const double angle = dice.between(0.15, 1.3) * (dice.chance(0.5) ? 1 : -1);
    const double helix_bend = bend * std::abs(std::sin(angle));  // `bend` is the turning about the helix' own axis
    words << "helix, angle " << angle << ", bend " << helix_bend;
    return geometry::make_helix(std::pow(std::sin(angle), 2) / helix_bend, angle, 1.0);
  }
  words << "curve, bend " << bend;
  return smooth_axis(dice, bend);
}

/// Clearance of [0.002, 0.05] of the length everywhere.
inline geometry::ClearancePtr draw_clearance(Dice& dice, double L, std::ostringstream& words) {
  const double Q = 0.002 * std::pow(25.0, dice.between(0, 1));
  const bool varying = dice.chance(0.5);
  const double amplitude = dice.between(0.1, 0.5), waves = dice.between(0.3, 2), phase = dice.between(0, 2 * pi);
  words << ", Q " << Q;
  if (!varying) return geometry::make_constant(Q * L);
  words << " varying by " << amplitude;
  constexpr int nodes = 13;
  std::vector<double> S, q;
  for (int i = 0; i < nodes; ++i) {
    const double t = static_cast<double>(i) / (nodes - 1);
    S.push_back(L * t);
    q.push_back(L * std::clamp(Q * (1 + amplitude * std::sin(2 * pi * waves * t + phase)), 0.002, 0.05));
  }
  return geometry::make_table(S, q, L);
}

inline void draw_rod(Dice& dice, Problem& p, std::ostringstream& words) {
  p.rod.torsional_stiffness = dice.between(0.6, 1.0);
  const bool extensible = dice.chance(0.5);
  const double EA = 400 * std::pow(100.0, dice.between(0, 1));
  if (extensible) p.rod.axial_stiffness = EA;
  words << (extensible ? ", EA " + std::to_string(EA) : ", inextensible");
}

/// Where the centreline is held at one end: mostly on the axis, some off it, some on the wall.
inline void draw_place(Dice& dice, End& e, double Q, double dQ, bool outside) {
  const double where = dice.between(0, 1), angle = dice.between(-pi, pi);
  const double share = dice.between(0.1, 0.8), slope = dice.between(-0.1, 0.1), slope_angle = dice.between(-pi, pi);
  const Eigen::Vector2d n(std::cos(angle), std::sin(angle));
  double distance = 0, rate = 0;
  if (outside) {
    distance = (1 + 0.5 * share) * Q;
  } else if (where > 0.8 && e.kind != End::Kind::pinned) {
    distance = Q;  // on the wall, along it: a pin there could not let the rod turn
    rate = dQ;
  } else if (where > 0.5) {
    distance = share * Q;
  }
  for (int i = 0; i < 2; ++i) {
    e.eccentricity[i] = distance * n[i];
    e.slope[i] = rate * n[i];
  }
  if (!outside && where > 0.5 && where < 0.65) {
    const double gentle = std::min(1.0, 40 * Q);  // what a short stretch of the clearance can take up
    e.slope[0] = gentle * slope * std::cos(slope_angle);
    e.slope[1] = gentle * slope * std::sin(slope_angle);
  }
}

/// What goes beyond the uniform rod held at both ends, from dice of its own.
struct Special {
  bool varying = false, guided = false, free = false;
  double weight = 100;  // of the base rod that the sections are drawn from
  Dice dice{0};
};

inline Special draw_special(std::uint64_t seed, bool outside) {
  Special s;
  s.dice = Dice(0x51DE0000u + seed);
  s.varying = s.dice.chance(0.35);
  const double end = s.dice.between(0, 1);
  s.guided = !outside && end < 0.12;
  s.free = !outside && end > 0.85;
  return s;
}

/// Of the softest section; infinite for an inextensible rod.
inline double least_axial_stiffness(const Problem& p, double L) {
  if (!p.rod.axial_stiffness) return HUGE_VAL;
  double least = *p.rod.axial_stiffness;
  if (!p.law.uniform())
    for (int i = 0; i <= 200; ++i) least = std::min(least, 1 / p.law.at(L * (i / 200.0 - p.law.from_end)).e);
  return least;
}

/// The far end let go: at a given place, or with a given length of rod, which ends within the tube whatever way it
/// takes. Nothing but its weight and a dead force loads it.
inline void free_tip(Dice& dice, Problem& p, double L, double weight, double EA, std::ostringstream& words) {
  p.end = End();
  p.end.kind = End::Kind::free;
  p.twist = segmentation::TwistControl::torque;
  p.twist_value = 0;
  const double share = dice.between(0.4, 0.98), force = dice.between(0, 20);
  if (dice.chance(0.5)) p.end.tip.force = force * dice.direction();
  if (dice.chance(0.5)) {
    const double shortest = 1 - geometry::check_tube(p.tube).curvature_clearance_max;
    p.axial = segmentation::AxialControl::rod_length;
    p.axial_value = share * shortest * L / (1 + (weight * L + p.end.tip.force.norm()) / EA);
    words << ", free tip at rod length " << p.axial_value.value;
  } else {
    p.axial = segmentation::AxialControl::axial_force;
    p.axial_value = 0;
    p.end_position = share * L;
    words << ", free tip at " << share;
  }
  words << " under " << p.end.tip.force.norm();
}

}  // namespace campaign

/// Which of the rules are drawn from: `held` leaves out rods that vary, guided ends and free tips.
enum class CampaignRules { all, held };

inline CampaignProblem campaign_problem(std::uint64_t seed, CampaignRules rules = CampaignRules::all) {
  using segmentation::AxialControl;
  using segmentation::TwistControl;
  using segmentation::Which;
  Dice dice(0x5EED0000u + seed);
  for (;;) {
    CampaignProblem c;
    Problem& p = c.problem;
    std::ostringstream words;
    words.precision(6);
    words << "seed " << seed << ": ";
    p.tube.axis = campaign::draw_axis(dice, words);
    const double L = p.tube.length();
    p.tube.clearance = campaign::draw_clearance(dice, L, words);
    const bool outside = dice.chance(0.15);
    p.tube.side = outside ? geometry::Side::outside : geometry::Side::inside;
    if (outside) words << ", outside";
    try {
      if (geometry::check_tube(p.tube).curvature_clearance_max > 0.5) continue;
    } catch (const geometry::GeometryError&) {
      continue;
    }
    campaign::draw_rod(dice, p, words);
    p.end_position = L;
    // ---- ends ----
    const double a = dice.between(0, 1), b = dice.between(0, 1), control = dice.between(0, 1);
    p.start.kind = a < 0.5 ? End::Kind::clamped : a < 0.75 ? End::Kind::sleeve : End::Kind::pinned;
    p.end.kind = b < 0.7 ? End::Kind::sleeve : End::Kind::pinned;
    p.axial = control < 0.45  ? AxialControl::axial_force
              : control < 0.7 ? AxialControl::push
                              : AxialControl::rod_length;
    if (p.axial == AxialControl::rod_length && b < 0.35) p.end.kind = End::Kind::clamped;
    if (p.axial != AxialControl::rod_length && dice.chance(0.2) && p.start.kind != End::Kind::clamped)
      p.axial_at = Which::start;
    for (auto [e, S] : {std::pair{&p.start, 0.0}, std::pair{&p.end, L}}) {
      const auto Q = p.tube.clearance->at(S);
      campaign::draw_place(dice, *e, Q[0], Q[1], outside);
    }
    const campaign::Special special =
        rules == CampaignRules::all ? campaign::draw_special(seed, outside) : campaign::Special();
    if (special.guided) p.end.kind = End::Kind::guided;
    if (special.free) {
      p.start.kind = p.end.kind = End::Kind::clamped;  // until it is freed
      p.axial = AxialControl::axial_force;
      p.axial_at = Which::end;
    }
    const int pins = (p.start.kind == End::Kind::pinned) + (p.end.kind == End::Kind::pinned);
    c.euler = (pins == 0 ? 4 * pi * pi : pins == 1 ? 20.190728556 : pi * pi) / (L * L);
    Dice more = special.dice;
    const double uniform_euler = special.guided ? campaign::euler_load(p, L) : c.euler;
    std::ostringstream parts;
    parts.precision(4);
    if (special.varying) campaign::draw_sections(more, p, L, special.weight, parts);
    c.euler = special.varying ? campaign::euler_load(p, L) : uniform_euler;
    // ---- loads ----
    const double sense = dice.between(0, 1), size = dice.between(0, 1);
    double F = 0;  // tension positive
    if (outside)
      F = sense < 0.3 ? -size * c.euler : 100 * size;
    else if (sense < 0.6)
      F = -40 * size * c.euler;
    else if (sense < 0.9)
      F = 100 * size;
    words << ", F3 " << F << " (" << -F / c.euler << " Euler)";
    const double EA = campaign::least_axial_stiffness(p, L);
    c.stretch_small = 1 + F / EA < 0.3;
    if (p.axial == AxialControl::rod_length) {
      // Slack of the order that this force would feed into a straight tube; a rod that can be stretched is.
      double Q = 0;
      for (int i = 0; i <= 20; ++i) Q += p.tube.clearance->at(L * i / 20)[0] / 21;
      double slack = F < 0 ? -0.25 * F * uniform_euler / c.euler * Q * Q : 0.0;
      // An inextensible rod must reach from end to end, around an axis as straight as it may be.
      if (!p.rod.axial_stiffness) slack += (outside ? 8 : 4) * Q * Q / (L * L);
      p.axial_value = L * (1 + slack) / (1 + F / EA);
      words << ", rod length " << p.axial_value.value;
    } else {
      p.axial_value = p.axial == AxialControl::push ? -F : F;
      words << (p.axial == AxialControl::push ? " push" : " force") << (p.axial_at == Which::start ? " at start" : "");
    }
    const double kind = dice.between(0, 1), M = dice.between(-4, 4);
    p.twist = kind > 0.8 ? TwistControl::twist : TwistControl::torque;
    p.twist_value = kind < 0.25 ? 0.0 : M;
    words << (p.twist == TwistControl::twist ? ", twist " : ", M3 ") << p.twist_value.value;
    const bool heavy = dice.chance(0.5);
    const double weight = dice.between(0, 300);
    const Vector3d down = dice.direction();
    if (heavy) p.load.force = weight * down;
    words << ", weight " << (heavy ? weight : 0.0);
    if (special.varying) {
      p.load.force.setZero();
      p.load.weight_direction = (heavy ? weight / special.weight : 0.0) * down;
      words << parts.str();
    }
    if (special.free) campaign::free_tip(more, p, L, heavy ? weight : 0.0, EA, words);
    static const char* kinds[] = {"clamped", "sleeve", "pinned", "guided", "free"};
    words << ", " << kinds[static_cast<int>(p.start.kind)] << "-" << kinds[static_cast<int>(p.end.kind)];
    c.words = words.str();
    return c;
  }
}

}  // namespace tendril::test

#pragma once
// The same physical problem put differently: moved, mirrored, run from the other end, in other units, in a frame with
// its own twist. Each returns the other problem and carries a contact of the first to what the second must report.

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "support/problems.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/geometry/axis_transforms.hpp"

namespace tendril::test {

struct Twin {
  std::string law;
  Problem problem;
  bool reversed = false;                               // contacts come in the opposite order
  double length = 1, force = 1, torque = 1;            // factors
  std::function<double(double)> place;                 // S -> S
  std::function<double(double, double)> angle;         // (β, S) -> β
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  // of world vectors
};

inline Twin moved(const Problem& p, Dice& dice) {
  Twin t;
  t.law = "moved";
  t.problem = p;
  t.turn = Eigen::AngleAxisd(dice.between(0.3, 3), dice.direction()).toRotationMatrix();
  t.problem.tube.axis = geometry::rotate_translate(p.tube.axis, t.turn, dice.between(0, 5) * dice.direction());
  t.problem.load.force = t.turn * p.load.force;
  t.place = [](double S) { return S; };
  t.angle = [](double b, double) { return b; };
  return t;
}

/// D1 -> M D1, D2 -> -M D2: what turns right-handed turns left-handed, δ2 and β change sign.
inline Twin mirrored(const Problem& p, Dice& dice) {
  Twin t;
  t.law = "mirrored";
  t.problem = p;
  const Vector3d n = dice.direction();
  t.turn = Eigen::Matrix3d::Identity() - 2 * n * n.transpose();
  t.problem.tube.axis = geometry::mirror(p.tube.axis, n);
  t.problem.load.force = t.turn * p.load.force;
  t.problem.twist_value.value *= -1;
  for (End* e : {&t.problem.start, &t.problem.end}) {
    e->eccentricity[1].value *= -1;
    e->slope[1].value *= -1;
    e->roll.value *= -1;
  }
  t.problem.turns = -p.turns;
  t.torque = -1;
  t.place = [](double S) { return S; };
  t.angle = [](double b, double) { return -b; };
  return t;
}

/// S -> L - S, D1 kept, D2 and D3 turned over. Tension and twist keep their signs; the conditions change ends.
inline Twin reversed(const Problem& p, Dice&) {
  Twin t;
  t.law = "reversed";
  t.problem = p;
  t.problem.tube.axis = geometry::reverse(p.tube.axis);
  t.problem.start = p.end;
  t.problem.end = p.start;
  for (End* e : {&t.problem.start, &t.problem.end}) {
    e->eccentricity[1].value *= -1;
    e->slope[0].value *= -1;
  }
  const auto other = [](segmentation::Which w) {
    return w == segmentation::Which::end ? segmentation::Which::start : segmentation::Which::end;
  };
  t.problem.axial_at = other(p.axial_at);
  t.problem.twist_at = other(p.twist_at);
  t.reversed = true;
  const double L = p.tube.length();
  t.place = [L](double S) { return L - S; };
  t.angle = [](double b, double) { return -b; };
  return t;
}

inline Twin in_other_units(const Problem& p, Dice& dice) {
  Twin t;
  t.law = "in other units";
  t.problem = p;
  const double l = std::exp(dice.between(-6, 6)), f = std::exp(dice.between(-6, 6));
  t.problem.tube.axis = geometry::scaled(p.tube.axis, l);
  t.problem.tube.clearance = geometry::scaled(p.tube.clearance, l);
  t.problem.rod.bending_stiffness *= f * l * l;
  t.problem.rod.torsional_stiffness *= f * l * l;
  if (t.problem.rod.axial_stiffness) *t.problem.rod.axial_stiffness *= f;
  t.problem.load.force *= f / l;
  t.problem.axial_value.value *= f;
  t.problem.twist_value.value *= f * l;
  t.problem.end_position.value *= l;
  for (End* e : {&t.problem.start, &t.problem.end})
    for (auto& x : e->eccentricity) x.value *= l;
  t.length = l;
  t.force = f;
  t.torque = f * l;
  t.place = [l](double S) { return l * S; };
  t.angle = [](double b, double) { return b; };
  return t;
}

/// Frame turned by γ(S), zero with zero slope at the start: U3 = γ'. For ends on the axis.
inline Twin in_twisted_frame(const Problem& p, Dice& dice) {
  Twin t;
  t.law = "in a twisted frame";
  t.problem = p;
  const double a = dice.between(-3, 3), w = dice.between(1, 6) / p.tube.length(), shift = dice.between(-pi, pi);
  const auto gamma = [a, w, shift](double S) { return a * std::sin(w * S) + shift; };
  t.problem.tube.axis = geometry::with_frame_twist(p.tube.axis, [a, w, shift](double S) {
    const double s = a * std::sin(w * S), c = a * std::cos(w * S);
    return std::array<double, 5>{s + shift, w * c, -w * w * s, -w * w * w * c, w * w * w * w * s};
  });
  t.place = [](double S) { return S; };
  t.angle = [gamma](double b, double S) { return b - gamma(S); };
  return t;
}

/// Largest relative differences between the twin's answer and what it must be.
struct LawFault {
  bool same_contacts = true;
  double length = 0, place = 0, angle = 0, force = 0, end_force = 0;
  std::string words;
};

inline LawFault compare(const Twin& t, const Problem& p, const continuation::Step& a, const continuation::Step& b) {
  LawFault f;
  const double L = p.tube.length();
  f.length = std::abs(b.rod_length / t.length / a.rod_length - 1);
  double F = std::max(std::abs(a.axial_force_start), std::abs(a.axial_force_end));
  for (const auto& c : a.contacts) F = std::max(F, c.force);
  const auto forces = [&](double x, double y) { f.end_force = std::max(f.end_force, std::abs(x / t.force - y) / F); };
  forces(b.axial_force_start, t.reversed ? a.axial_force_end : a.axial_force_start);
  forces(b.axial_force_end, t.reversed ? a.axial_force_start : a.axial_force_end);
  f.same_contacts = a.contacts.size() == b.contacts.size();
  for (std::size_t i = 0; f.same_contacts && i < a.contacts.size(); ++i) {
    const auto& x = t.reversed ? a.contacts[a.contacts.size() - 1 - i] : a.contacts[i];
    const auto& y = b.contacts[i];
    f.same_contacts = x.line == y.line;
    const double s0 = t.reversed ? x.end : x.start, s1 = t.reversed ? x.start : x.end;
    const double b0 = t.reversed ? x.angle_end : x.angle_start, b1 = t.reversed ? x.angle_start : x.angle_end;
    f.place = std::max(
        {f.place, std::abs(y.start - t.place(s0)) / t.length / L, std::abs(y.end - t.place(s1)) / t.length / L});
    f.angle = std::max({f.angle, std::abs(std::remainder(y.angle_start - t.angle(b0, s0), 2 * pi)),
                        std::abs(std::remainder(y.angle_end - t.angle(b1, s1), 2 * pi))});
    f.force = std::max({f.force, std::abs(y.force / t.force - x.force) / F,
                        (y.force_vector / t.force - t.turn * x.force_vector).norm() / F,
                        std::abs(y.force_distributed / t.force - x.force_distributed) / F});
  }
  return f;
}

}  // namespace tendril::test

#pragma once
// Rods of the campaign that vary along their length, and the first Euler load of any rod with any ends: the least P of
// ∫ B w''² = P ∫ w'² by Hermite elements.

#include <Eigen/Eigenvalues>

#include "support/problems.hpp"

namespace tendril::test::campaign {

/// Smallest compression that buckles the straight rod of length L with these ends (free ends: with nothing held).
inline double euler_load(const Problem& p, double L) {
  constexpr int elements = 48, nodes = elements + 1;
  const double h = L / elements;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(2 * nodes, 2 * nodes), G = K;
  const double offset = p.law.from_end ? L : 0.0;
  for (int e = 0; e < elements; ++e)
    for (const double x : {0.1127016653792583, 0.5, 0.8872983346207417}) {
      const double weight = h * (x == 0.5 ? 4.0 / 9.0 : 5.0 / 18.0), s = h * (e + x) - offset;
      const double B = p.law.uniform() ? p.rod.bending_stiffness : p.law.at(s).B;
      const Eigen::Vector4d d1(6 * x * (x - 1) / h, 1 + x * (3 * x - 4), 6 * x * (1 - x) / h, x * (3 * x - 2));
      const Eigen::Vector4d d2((12 * x - 6) / (h * h), (6 * x - 4) / h, (6 - 12 * x) / (h * h), (6 * x - 2) / h);
      K.block<4, 4>(2 * e, 2 * e) += weight * B * d2 * d2.transpose();
      G.block<4, 4>(2 * e, 2 * e) += weight * d1 * d1.transpose();
    }
  std::vector<int> kept;
  const auto held = [](End::Kind k, bool place) {
    return place ? k != End::Kind::guided && k != End::Kind::free : k != End::Kind::pinned && k != End::Kind::free;
  };
  for (int i = 0; i < 2 * nodes; ++i) {
    const bool place = i % 2 == 0;
    if (!(i < 2 && held(p.start.kind, place)) && !(i >= 2 * nodes - 2 && held(p.end.kind, place))) kept.push_back(i);
  }
  const Eigen::MatrixXd k = K(kept, kept), g = G(kept, kept);
  return 1 / Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(g, k, Eigen::EigenvaluesOnly)
                 .eigenvalues()
                 .maxCoeff();
}

/// Steps, a taper towards one end, or three rods joined, softer or stiffer by up to 30 times; axial stiffness and
/// weight go as the section, the square root of the bending stiffness. `weight`: of the base rod, per length.
inline void draw_sections(Dice& dice, Problem& p, double L, double weight, std::ostringstream& words) {
  const double kind = dice.between(0, 1);
  const auto entry = [&](double from, double to, rod::SectionEntry::Between how, double first, double last) {
    rod::SectionEntry e;
    e.from = from * L;
    e.to = to * L;
    e.between = how;
    for (int i = 0; i < 2; ++i) {
      const double r = i == 0 ? first : last;
      e.rod[i].bending_stiffness = p.rod.bending_stiffness * r;
      e.rod[i].torsional_stiffness = p.rod.torsional_stiffness * r;
      if (p.rod.axial_stiffness) e.rod[i].axial_stiffness = *p.rod.axial_stiffness * std::sqrt(r);
      e.weight[i] = weight * std::sqrt(r);
    }
    return e;
  };
  using Between = rod::SectionEntry::Between;
  const double a = dice.between(0.1, 0.5), b = dice.between(0.5, 0.95);
  const double first = std::pow(10.0, dice.between(-1.5, 1)), second = std::pow(10.0, dice.between(-1.5, 1));
  const bool from_end = dice.chance(0.5), smooth = dice.chance(0.5);
  const double origin = from_end ? -1.0 : 0.0;
  std::vector<rod::SectionEntry> parts;
  if (kind < 0.35) {
    parts = {entry(origin + a, origin + b, Between::constant, first, first)};
    words << ", a stretch " << first << " times as stiff";
  } else if (kind < 0.7) {
    // beyond a taper the rod keeps what it has come to
    const Between how = smooth ? Between::smooth : Between::linear;
    parts = {entry(origin + a, origin + b, how, 1, first),
             entry(origin + b, origin + 2, Between::constant, first, first)};
    words << ", tapering to " << first;
  } else {
    parts = {entry(origin + a, origin + b, Between::constant, first, first),
             entry(origin + b, origin + 2, Between::constant, second, second)};
    words << ", stretches " << first << " and " << second << " times as stiff";
  }
  p.law = rod::section_law(p.rod, weight, parts, from_end);
}

}  // namespace tendril::test::campaign

#include "tendril/rod/section_law.hpp"

#include <algorithm>
#include <cmath>

namespace tendril::rod {
namespace {

bool zero(const SectionPiece::Polynomial& p) {
  return std::all_of(p.begin(), p.end(), [](double x) { return x == 0.0; });
}

}  // namespace

SectionPiece::Polynomial between(SectionEntry::Between how, double a, double b) {
  switch (how) {
    case SectionEntry::Between::constant:
      return {a, 0.0, 0.0, 0.0, 0.0};
    case SectionEntry::Between::linear:
      return {a, b - a, 0.0, 0.0, 0.0};
    case SectionEntry::Between::smooth:
      return {a, 0.0, 3.0 * (b - a), -2.0 * (b - a), 0.0};
  }
  return {};
}

SectionPiece section_piece(const SectionEntry& e) {
  SectionPiece p;
  p.from = p.origin = e.from;
  p.to = e.to;
  p.unit = e.to - e.from;
  p.bending = between(e.between, e.rod[0].bending_stiffness, e.rod[1].bending_stiffness);
  p.torsion = between(e.between, e.rod[0].torsional_stiffness, e.rod[1].torsional_stiffness);
  p.inextensible = !e.rod[0].axial_stiffness || !e.rod[1].axial_stiffness;
  if (!p.inextensible) p.axial = between(e.between, *e.rod[0].axial_stiffness, *e.rod[1].axial_stiffness);
  p.weight = between(e.between, e.weight[0], e.weight[1]);
  for (int i = 0; i < 2; ++i) p.curvature[i] = between(e.between, e.curvature[0][i], e.curvature[1][i]);
  return p;
}

bool SectionPiece::curved() const { return !zero(curvature[0]) || !zero(curvature[1]); }

bool SectionLaw::curved() const {
  return std::any_of(pieces.begin(), pieces.end(), [](const SectionPiece& p) { return p.curved(); });
}

int SectionLaw::piece_at(double s) const {
  const auto it =
      std::upper_bound(pieces.begin(), pieces.end(), s, [](double x, const SectionPiece& p) { return x < p.from; });
  return std::max<int>(0, static_cast<int>(it - pieces.begin()) - 1);
}

SectionLaw SectionLaw::scaled(double length, double stiffness) const {
  SectionLaw out = *this;
  const auto multiply = [](SectionPiece::Polynomial& p, double f) {
    for (double& x : p) x *= f;
  };
  for (SectionPiece& p : out.pieces) {
    for (double* x : {&p.from, &p.to, &p.origin, &p.unit}) *x /= length;
    multiply(p.bending, 1.0 / stiffness);
    multiply(p.torsion, 1.0 / stiffness);
    multiply(p.axial, length * length / stiffness);
    multiply(p.weight, length * length * length / stiffness);
    for (auto& k : p.curvature) multiply(k, length);
  }
  return out;
}

int SectionLaw::cut_at(double s) {
  const int i = piece_at(s);
  if (pieces[i].from == s) return i;
  SectionPiece behind = pieces[i];
  behind.from = pieces[i].to = s;
  pieces.insert(pieces.begin() + i + 1, behind);
  return i + 1;
}

SectionLaw section_law(const Rod& base, double weight, const std::vector<SectionPiece>& pieces, bool from_end) {
  SectionLaw law;
  law.from_end = from_end;
  const auto fill = [&](double from, double to) {
    SectionEntry e;
    e.rod[0] = e.rod[1] = base;
    e.weight[0] = e.weight[1] = weight;
    e.from = from;
    e.to = to;
    SectionPiece p = section_piece(e);
    p.origin = 0.0;
    p.unit = 1.0;
    law.pieces.push_back(p);
  };
  double at = -HUGE_VAL;
  for (const SectionPiece& p : pieces) {
    if (p.from > at) fill(at, p.from);
    law.pieces.push_back(p);
    at = p.to;
  }
  fill(at, HUGE_VAL);
  return law;
}

SectionLaw section_law(const Rod& base, double weight, const std::vector<SectionEntry>& entries, bool from_end) {
  std::vector<SectionPiece> pieces;
  for (const SectionEntry& e : entries) pieces.push_back(section_piece(e));
  return section_law(base, weight, pieces, from_end);
}

}  // namespace tendril::rod

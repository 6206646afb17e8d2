#pragma once
// Rods that vary along their own unstressed length s: between two breaks every property of the section is a polynomial
// in s, across a break it may jump or kink. s is counted from the rod's start, or from its far end backwards (there s
// <= 0), so that a tapered tip stays with the tip however much rod there is. Equations: docs/theory/varying_rods.md.

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "tendril/rod/rod.hpp"

namespace tendril::rod {

/// Properties at s and their derivatives along s: stiffnesses B, C, compliance e = 1/A, weight, and the curvature of
/// the unstressed rod about d1 and d2.
template <class T>
struct Properties {
  T B, Bs, C, Cs, e, es, weight, k1, k1s, k2, k2s;
};

/// One stretch between breaks. Polynomials in x = (s - origin) / unit, lowest power first.
struct SectionPiece {
  using Polynomial = std::array<double, 5>;
  double from = 0.0, to = 0.0;  // [length]; the first begins at -infinity, the last ends at +infinity
  double origin = 0.0, unit = 1.0;
  Polynomial bending{}, torsion{};  // B, C                            [force length^2]
  Polynomial axial{};               // A, unless inextensible          [force]
  bool inextensible = true;
  Polynomial weight{};      // per unit unstressed length      [force/length]
  Polynomial curvature[2];  // of the unstressed rod: κ01 about d1, κ02 about d2, director frame   [1/length]

  SectionPiece() : curvature{Polynomial{}, Polynomial{}} {}

  template <class T>
  static void evaluate(const Polynomial& c, const T& x, double unit, T& value, T& slope) {
    value = T(c[4]);
    slope = T(0.0);
    for (int i = 3; i >= 0; --i) {
      slope = slope * x + value;
      value = value * x + c[i];
    }
    slope = slope * (1.0 / unit);
  }

  template <class T>
  Properties<T> at(const T& s) const {
    const T x = (s - origin) * (1.0 / unit);
    Properties<T> p;
    T ignored;
    evaluate(bending, x, unit, p.B, p.Bs);
    evaluate(torsion, x, unit, p.C, p.Cs);
    evaluate(weight, x, unit, p.weight, ignored);
    evaluate(curvature[0], x, unit, p.k1, p.k1s);
    evaluate(curvature[1], x, unit, p.k2, p.k2s);
    if (inextensible) {
      p.e = p.es = T(0.0);
    } else {
      T A, As;
      evaluate(axial, x, unit, A, As);
      p.e = 1.0 / A;
      p.es = -(As * p.e * p.e);
    }
    return p;
  }
  bool curved() const;
};

struct SectionLaw {
  std::vector<SectionPiece> pieces;  // ascending, without gaps; empty: the rod is uniform
  bool from_end = false;             // s is counted from the far end backwards

  bool uniform() const { return pieces.empty(); }
  bool curved() const;
  /// Piece that s belongs to; at a break, the one behind it.
  int piece_at(double s) const;
  Properties<double> at(double s) const { return pieces[piece_at(s)].at<double>(s); }
  /// The same in units: lengths by `length`, stiffnesses B and C by `stiffness`.
  SectionLaw scaled(double length, double stiffness) const;
  /// The same law with a break at s, if there is none: the piece that begins there.
  int cut_at(double s);
};

/// Part of a rod as a case gives it: values at its two ends and how they change between.
struct SectionEntry {
  enum class Between { constant, linear, smooth };  // smooth: cubic with zero slope at both ends
  double from = 0.0, to = 0.0;
  Between between = Between::constant;
  Rod rod[2];                                 // at from, at to
  double weight[2] = {0.0, 0.0};              // [force/length]
  double curvature[2][2] = {{0, 0}, {0, 0}};  // κ01, κ02 at from, at to
};

SectionPiece section_piece(const SectionEntry& entry);
/// Value that goes from a at `from` to b at `to`, as a polynomial.
SectionPiece::Polynomial between(SectionEntry::Between how, double a, double b);

/// The law that has the pieces where they are (ascending, not overlapping) and the base rod elsewhere.
SectionLaw section_law(const Rod& base, double weight, const std::vector<SectionPiece>& pieces, bool from_end);
/// The law that has the entries where they are (ascending, not overlapping) and the base rod elsewhere.
SectionLaw section_law(const Rod& base, double weight, const std::vector<SectionEntry>& entries, bool from_end);

}  // namespace tendril::rod

#pragma once
// Clearance laws Q(S): constant, interpolated from a table, given as a function, scaled. A table is interpolated by the
// quintic C4 spline (quintic_spline.hpp), one derivative smoother than the surface needs. Where that spline swings by
// more than a quarter of the steps nearby (jumps, very uneven nodes) or would not stay above 0, a C3 piecewise
// polynomial of degree 7, monotone between nodes, takes its place; so positive tables give positive clearances.

#include <functional>
#include <memory>
#include <vector>

#include "tendril/geometry/tube.hpp"

namespace tendril::geometry {

using ClearancePtr = std::shared_ptr<const Clearance>;

ClearancePtr make_constant(double clearance);

/// Through (S[i], clearance[i]); S ascending, covering [0, length] to 1e-6 of the length. One entry is a constant.
ClearancePtr make_table(const std::vector<double>& S, const std::vector<double>& clearance, double length);

/// A clearance and how far it lies from the table it was made of.
struct FittedClearance {
  ClearancePtr clearance;
  double largest_deviation;  // [length]
  double deviation_S;        // where it is [length]
};

/// The smoothest spline that stays within `tolerance` >= 0 of every entry of the table; make_table's where the
/// tolerance is 0 or that spline would not stay above 0.
FittedClearance make_smooth_table(const std::vector<double>& S, const std::vector<double>& clearance, double length,
                                  double tolerance);

/// `law(S)` returns Q and four derivatives; `knots` are the places where one of them jumps.
ClearancePtr make_analytic(std::function<std::array<double, 5>(double)> law, std::vector<double> knots = {});

/// factor * Q(S).
ClearancePtr scaled(ClearancePtr clearance, double factor);

}  // namespace tendril::geometry

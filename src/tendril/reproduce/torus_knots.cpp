// The knots of Figs. III.2.2 and III.2.4 and their duals at F3(0) = 0: table, data and pictures.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "tendril/reproduce/torus_report.hpp"

namespace tendril::reproduce::torus {
namespace {

struct Extremes {
  double rho_min = HUGE_VAL, rho_max = -HUGE_VAL, along = 1.0;
};
Extremes extremes(const std::vector<Point>& rod) {
  Extremes e;
  for (const Point& p : rod) {
    e.rho_min = std::min(e.rho_min, p.rho);
    e.rho_max = std::max(e.rho_max, p.rho);
    e.along = std::min(e.along, p.along);
  }
  return e;
}

/// How often the rod passes through itself: at the same azimuth two of its revolutions have the same angle. `rod` has
/// the same number of steps in every revolution.
int self_crossings(const std::vector<Point>& rod, int revolutions) {
  const int n = static_cast<int>(rod.size()) - 1, step = n / revolutions;
  const double closed = rod.back().beta;
  int count = 0;
  for (int j = 1; j < revolutions; ++j) {
    const auto turns = [&](int i) {  // between the two, whole turns around the tube
      const int k = i + j * step;
      const double ahead = k <= n ? rod[k].beta : rod[k - n].beta + closed;
      return static_cast<int>(std::floor((ahead - rod[i].beta) / (2.0 * M_PI)));
    };
    for (int i = 0; i < n; ++i) count += std::abs(turns(i + 1) - turns(i));
  }
  return count / 2;  // each is seen from both revolutions
}

}  // namespace

void report_knots(const Gallery& g, Outcome& out) {
  Faults all{};
  Data table{"knots",
             {"revolutions", "windings", "no.", "slope at xi = 0", "H [B/R^2]", "length [R]", "least rho [B/R^3]",
              "largest rho [B/R^3]", "least d3.D3", "self-crossings"},
             std::vector<std::vector<double>>(10)};
  std::vector<drawing::Panel> trivial, duals, nontrivial;
  drawing::Panel offsets = along_a_winding("β - qξ/p [rad]"), pressures = along_a_winding("ρ [B/R³]");
  double least_along = 1.0;
  std::string crossing;
  for (const Knot& k : g.knots) {
    Family family;
    const BoundaryValueProblem closed = whole(k, family);
    include(all, faults(family, closed), 1.0);
    include(all, faults(k.unit, k.winding), 1.0);
    const auto winding = points(k.unit, k.winding, 400);
    const auto rod = points(family, closed, std::min(2400, 400 * std::max(k.windings, k.revolutions)));
    const Extremes e = extremes(rod);
    least_along = std::min(least_along, e.along);
    const EnergyTwin twin = twin_of(k.unit, k.winding);
    out.rows.push_back(
        {k.name() + ": β' at ξ = 0", winding.front().slope, twin.converged ? twin.slope : NAN, exact, twin_source});
    out.rows.push_back({k.name() + ": length [R]", rod.back().s, twin.converged ? k.windings * twin.length : NAN,
                        exact * rod.back().s, twin_source});
    if (k.windings > 1)
      out.rows.push_back({k.name() + ": β' at ξ = 0, all windings as one problem", rod.front().slope,
                          winding.front().slope, exact, "one winding, repeated"});
    const int crossings = self_crossings(rod, k.revolutions);
    if (crossings > 0) crossing += (crossing.empty() ? "" : ", ") + k.name() + " " + std::to_string(crossings);
    const std::array<double, 10> line{double(k.revolutions),
                                      double(k.windings),
                                      double(k.met),
                                      winding.front().slope,
                                      winding.front().H,
                                      rod.back().s,
                                      e.rho_min,
                                      e.rho_max,
                                      e.along,
                                      double(crossings)};
    for (std::size_t i = 0; i < line.size(); ++i) table.value[i].push_back(line[i]);
    const drawing::Panel panel = body(k.name(), family.rod.epsilon, rod);
    if (k.revolutions == 1) {
      trivial.push_back(panel);
      offsets.curves.push_back(offset(k.name(), k.windings - 1, winding));
      pressures.curves.push_back(pressure(k.name(), k.windings - 1, winding));
    } else {
      (k.windings == 1 ? duals : nontrivial).push_back(panel);
    }
  }
  fault_rows("all knots", all, out.rows);
  out.data.push_back(table);
  const std::string colours = " Red: the torus pushes the rod outward (ρ > 0), blue: inward; hidden parts are faded.";
  out.pictures.push_back(bodies("trivial", "Trivial knots, F3(0) = 0, M3 = 0",
                                "Fig. III.2.2: one revolution with 1 to 6 windings. The Villarceau circle (1,1) is a "
                                "free ring; the others are pushed outward everywhere." +
                                    colours,
                                trivial, 3));
  Picture fields;
  fields.name = "trivial_fields";
  fields.caption =
      "Fig. III.2.2: offset of the trivial knots from the uniform winding, and the pressure, over one winding.";
  fields.figure.title = "Trivial knots over one winding";
  fields.figure.panels = {offsets, pressures};
  out.pictures.push_back(fields);
  out.pictures.push_back(
      bodies("duals", "Duals of the trivial knots, F3(0) = 0, M3 = 0",
             "One winding in 2 to 6 revolutions; (5,1) in the three states the family meets." + colours, duals, 3));
  out.pictures.push_back(bodies(
      "nontrivial", "Trefoils and cinquefoils, F3(0) = 0, M3 = 0",
      "Fig. III.2.4: the trefoils (2,3) and (3,2), the cinquefoil (2,5) and its dual (5,2)." + colours, nontrivial, 2));
  out.notes.push_back(
      "(p,q): p revolutions about the axis, q windings around the tube. (III.2.62) of the thesis counts the other way "
      "round, but its figures seem to count this way: of the trivial knots only those with one revolution are pushed "
      "outward everywhere at F3(0) = 0, as it says of Fig. III.2.2. All types are computed, so either reading is "
      "covered.");
  out.notes.push_back(
      "Which state: many types have several. Shown are those met when the number of revolutions per "
      "winding leaves 1, the Villarceau circle, at F3(0) = 0. The family turns back at " +
      text(g.folds) + " revolutions, so (5,1) is met three times. Other families cross it at " + text(g.branch_points) +
      " revolutions; at " + text(g.other_origins) +
      " it is only that β'(0) = 0, where another crossing of the outer equator may become ξ = 0.");
  out.notes.push_back(
      "F3(0) is the force where the rod crosses the outer equator at ξ = 0. Force and moment are continuous where the "
      "ends meet; the directors' roll need not be.");
  if (!crossing.empty())
    out.notes.push_back(
        "The rods have no thickness of their own: some closed states pass through themselves and are "
        "knots of their type up to such crossings only (number): " +
        crossing + ".");
  out.notes.push_back("Least d3·D3 of the knots at F3(0) = 0: " + text(least_along) +
                      "; all of them run along the tube and can be represented.");
}

}  // namespace tendril::reproduce::torus

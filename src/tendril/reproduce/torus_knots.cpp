// The knots of Figs. III.2.2 and III.2.4 and their duals at F3(0) = 0: table, data and pictures.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "tendril/formulation/surface_rod.hpp"
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

/// The surface-bound rod of III.1 started from the knot's state at many places: largest difference from the knot at the
/// next one. In pieces, because neighbouring solutions part exponentially.
double lagrangian_mismatch(const Knot& k) {
  const double epsilon = k.unit.rod.epsilon;
  const formulation::SurfaceRod rod{geometry::torus(1.0, epsilon), k.unit.rod.material.eta2, k.unit.rod.material.nu};
  const int pieces = 4 + static_cast<int>(8.0 * k.turn());
  // u is the azimuth; v and θ are measured the other way round: v = -β, θ = -ϑ (III.2.56)
  const auto state = [&](const Point& p) {
    return formulation::SurfaceRodState<double>{
        p.xi, -p.beta, -std::atan(epsilon * p.slope / (1.0 + epsilon * std::cos(p.beta))), p.kg, p.Fg, p.F3, p.M3, 0.0};
  };
  double worst = 0.0;
  const auto knot = points(k.unit, k.winding, pieces);
  for (int i = 0; i < pieces; ++i) {
    const auto curve = formulation::integrate_surface_rod(rod, state(knot[i]), {knot[i].s, knot[i + 1].s});
    if (!curve.summary.completed) return NAN;
    const auto &a = curve.section.back().state, b = state(knot[i + 1]);
    for (int q = 0; q < formulation::iM_3; ++q) worst = std::max(worst, std::abs(a[q] - b[q]));
  }
  return worst;
}

}  // namespace

void report_knots(const Gallery& g, Outcome& out) {
  Faults all{};
  Data table{"knots",
             {"revolutions", "windings", "no.", "slope at xi = 0", "H [B/R^2]", "length [R]", "least rho [B/R^3]",
              "largest rho [B/R^3]", "least d3.D3", "self-crossings"},
             std::vector<std::vector<double>>(10)};
  std::vector<drawing::Panel> trivial, duals, nontrivial, crossed;
  drawing::Panel offsets = along_a_winding("β - qξ/p [rad]"), pressures = along_a_winding("ρ [B/R³]");
  const BodyView view = torus_view(g.knots.front().unit.rod.epsilon);
  double least_along = 1.0;
  double lagrangian = 0.0;
  std::string crossing;
  for (const Knot& k : g.knots) {
    Family family;
    const BoundaryValueProblem closed = whole(k, family);
    include(all, faults(family, closed), 1.0);
    include(all, faults(k.unit, k.winding), 1.0);
    const auto winding = points(k.unit, k.winding, 400);
    const auto rod = points(family, closed, 200 * std::max(k.windings, k.revolutions));
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
    if (k.crossings > 0) crossing += (crossing.empty() ? "" : ", ") + k.name() + " " + std::to_string(k.crossings);
    const std::array<double, 10> line{double(k.revolutions),
                                      double(k.windings),
                                      double(k.met),
                                      winding.front().slope,
                                      winding.front().H,
                                      rod.back().s,
                                      e.rho_min,
                                      e.rho_max,
                                      e.along,
                                      double(k.crossings)};
    for (std::size_t i = 0; i < line.size(); ++i) table.value[i].push_back(line[i]);
    const drawing::Panel panel = body(k.name(), view, rod);
    if (k.revolutions == 1) {
      trivial.push_back(panel);
      offsets.curves.push_back(offset(k.name(), k.windings - 1, winding));
      pressures.curves.push_back(pressure(k.name(), k.windings - 1, winding));
    } else {
      (k.crossings > 0 ? crossed : k.windings == 1 ? duals : nontrivial).push_back(panel);
    }
    lagrangian = std::max(lagrangian, lagrangian_mismatch(k));
  }
  fault_rows("all knots", all, out.rows);
  out.rows.push_back({"all knots: place, direction, κ_g, F_g, F3 after each piece", lagrangian, 0.0, exact,
                      "surface-bound rod in the Lagrangian form (III.1), integrated"});
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
             "One winding in 2 to 5 revolutions: states that do not pass through themselves." + colours, duals, 2));
  out.pictures.push_back(bodies(
      "crossing", "Closed rods that pass through themselves, F3(0) = 0, M3 = 0",
      "States met by the family of one winding in a growing number of revolutions: in equilibrium each by itself, "
      "but no knots." +
          colours,
      crossed, 4));
  out.pictures.push_back(bodies("nontrivial", "Trefoils and cinquefoil, F3(0) = 0, M3 = 0",
                                "Fig. III.2.4: the trefoils (2,3) and (3,2), the cinquefoil (2,5)." + colours,
                                nontrivial, 3));
  out.notes.push_back(
      "(p,q): p revolutions about the axis, q windings around the tube. (III.2.62) of the thesis counts the other way "
      "round, but its figures seem to count this way: of the trivial knots only those with one revolution are pushed "
      "outward everywhere at F3(0) = 0, as it says of Fig. III.2.2. All types are computed, so either reading is "
      "covered.");
  out.notes.push_back(
      "Which state: many types have several. (2,1), (3,2) and all with one revolution are those met when the number of "
      "revolutions per winding leaves 1, the Villarceau circle, at F3(0) = 0. The family turns back at " +
      text(g.folds) + " revolutions, other families cross it at " + text(g.branch_points) + "; at " +
      text(g.other_origins) +
      " it is only that β'(0) = 0, where another crossing of the outer equator may become ξ = 0.");
  out.notes.push_back(
      "From 3 revolutions per winding on, and at (5,2), the family's states (marked *) pass through themselves: they "
      "are "
      "closed equilibria, but no knots. Number of crossings: " +
      crossing +
      ". (3,1), (4,1) and (5,1) without the mark are other states, found as stationary energies; for (6,1) "
      "and (5,2) none that does not pass through itself is known to us.");
  out.notes.push_back(
      "F3(0) is the force where the rod crosses the outer equator at ξ = 0. Force and moment are continuous where the "
      "ends meet; the directors' roll need not be.");
  out.notes.push_back("Least d3·D3 of the knots at F3(0) = 0: " + text(least_along) +
                      "; all of them run along the tube and can be represented.");
}

}  // namespace tendril::reproduce::torus

// Knots on a torus under axial force: (1,5) from -20 to 10^4 (Fig. III.2.3) and (2,1), whose curve turns back; both end
// at the geodesic of Clairaut's relation.

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <tuple>

#include "tendril/closed_form/torus.hpp"
#include "tendril/reproduce/torus_report.hpp"

namespace tendril::reproduce::torus {
namespace {

constexpr double pi = std::numbers::pi;

const Knot& find(const Gallery& g, int revolutions, int windings) {
  for (const Knot& k : g.knots)
    if (k.revolutions == revolutions && k.windings == windings) return k;
  throw std::logic_error("knot not in the gallery");
}

/// All windings of a knot from its first one, turned.
std::vector<Point> all_windings(const std::vector<Point>& winding, int count) {
  std::vector<Point> rod;
  for (int i = 0; i < count; ++i) {
    const double a = i * winding.back().xi, c = std::cos(a), s = std::sin(a);
    for (Point p : winding) {
      p.r = {c * p.r[0] - s * p.r[1], s * p.r[0] + c * p.r[1], p.r[2]};
      p.N = {c * p.N[0] - s * p.N[1], s * p.N[0] + c * p.N[1], p.N[2]};
      rod.push_back(p);
    }
  }
  return rod;
}

/// States at 2500, 5000 and 10⁴ against the closed geodesic: deviations fall as 1/F3, that of the length as 1/F3².
void geodesic_rows(const std::string& name, const Family& family, const std::vector<BoundaryValueProblem>& states,
                   std::vector<Row>& rows) {
  const double epsilon = family.rod.epsilon;
  const auto geodesic = closed_form::torus_geodesic(epsilon, 2.0 * pi * family.held);
  std::array<double, 3> slope, length, pressure, clairaut;
  for (int i = 0; i < 3; ++i) {
    const auto winding = points(family, states[i], 400);
    slope[i] = winding.front().slope;
    length[i] = winding.back().s;
    pressure[i] = clairaut[i] = 0.0;
    for (const Point& p : winding) {
      pressure[i] = std::max(pressure[i], std::abs(p.rho / winding.front().F3 + geodesic.kappa_n(p.beta)));
      clairaut[i] = std::max(clairaut[i], std::abs((1.0 + epsilon * std::cos(p.beta)) * p.along - geodesic.clairaut()));
    }
  }
  rows.push_back({name + ", geodesic limit: β' at ξ = 0", (8.0 * slope[2] - 6.0 * slope[1] + slope[0]) / 3.0,
                  geodesic.slope(0.0), 1e-5, "Clairaut; from 2500, 5000, 10⁴, rest of third order in 1/F3"});
  rows.push_back({name + ", geodesic limit: length of a winding [R]", (4.0 * length[2] - length[1]) / 3.0,
                  geodesic.length, 1e-8, "Clairaut; from 5000, 10⁴, rest of third order in 1/F3"});
  rows.push_back({name + ": deviation from C3 cosϑ = c, 5000 over 10⁴", clairaut[1] / clairaut[2], 2.0, 0.02,
                  "Clairaut; first order in 1/F3"});
  rows.push_back({name + ": deviation from ρ = -κ_n F3, 5000 over 10⁴", pressure[1] / pressure[2], 2.0, 0.02,
                  "(III.1.54), first order in 1/F3"});
}

struct Fields {
  std::vector<drawing::Panel> bodies;
  drawing::Panel offsets = along_a_winding("β - 5ξ [rad]"), pressures = along_a_winding("ρ/|F3(0)| [1/R]");
};

/// (1,5) at -20, 10 and 10⁴.
void figure_III_2_3(const Family& family, const std::vector<BoundaryValueProblem>& states, Outcome& out) {
  Fields f;
  const BodyView view = torus_view(family.rod.epsilon);
  Faults all{};
  for (int i = 0; i < 3; ++i) {
    const auto winding = points(family, states[i], 400);
    const double F = winding.front().F3;
    const std::string name = "F3(0) = " + text(F);
    include(all, faults(family, states[i]), std::max(1.0, std::abs(F)));
    const EnergyTwin twin = twin_of(family, states[i]);
    out.rows.push_back({"(1,5), " + name + ": β' at ξ = 0", winding.front().slope, twin.converged ? twin.slope : NAN,
                        exact, twin_source});
    f.bodies.push_back(body("(1,5), " + name, view, all_windings(winding, 5)));
    f.offsets.curves.push_back(offset(name, i, winding));
    f.pressures.curves.push_back(pressure(name, i, winding, std::abs(F)));
  }
  fault_rows("(1,5) at -20, 10, 10⁴, over |F3(0)|", all, out.rows);
  const auto geodesic = closed_form::torus_geodesic(family.rod.epsilon, 2.0 * pi * family.held);
  drawing::Curve offset, pressure;
  offset.label = pressure.label = "geodesic";
  offset.line = pressure.line = drawing::Line::dashed;
  offset.colour = pressure.colour = 7;
  double xi = 0.0;
  constexpr int n = 400;
  for (int i = 0; i <= n; ++i) {  // ξ(β) by Simpson's rule
    const double b = 2.0 * pi * i / n, h = 2.0 * pi / n;
    for (drawing::Curve* c : {&offset, &pressure}) c->x.push_back(xi / geodesic.turn);
    offset.y.push_back(b - 5.0 * xi);
    pressure.y.push_back(-geodesic.kappa_n(b));
    xi += h / 6.0 * (1.0 / geodesic.slope(b) + 4.0 / geodesic.slope(b + 0.5 * h) + 1.0 / geodesic.slope(b + h));
  }
  f.offsets.curves.push_back(offset);
  f.pressures.curves.push_back(pressure);
  out.pictures.push_back(
      bodies("axial_force", "Knot (1,5) under axial force, M3 = 0",
             "Fig. III.2.3: the torus pushes the rod inward everywhere at F3(0) = -20 (blue), outward "
             "at 10 and at 10⁴ (red), where the rod follows a geodesic.",
             f.bodies, 3));
  Picture fields;
  fields.name = "axial_force_fields";
  fields.caption =
      "Fig. III.2.3: offset from the uniform winding, and pressure over the axial force; dashed, on the curve of 10⁴: "
      "the geodesic with ρ = -κ_n F3.";
  fields.figure.title = "Knot (1,5) over one winding";
  fields.figure.panels = {f.offsets, f.pressures};
  out.pictures.push_back(fields);
}

drawing::Curve response(const std::string& label, int colour, const Loads& down, const Loads& up) {
  drawing::Curve c;
  c.label = label;
  c.colour = colour;
  const auto add = [&](double F, double slope) {
    c.x.push_back(std::asinh(F));
    c.y.push_back(slope);
  };
  for (std::size_t i = down.force.size(); i-- > 0;) add(down.force[i], down.slope[i]);
  for (std::size_t i = 0; i < up.force.size(); ++i) add(up.force[i], up.slope[i]);
  return c;
}

}  // namespace

void report_loads(const Gallery& g, Outcome& out) {
  const std::vector<double> far{2500.0, 5000.0};
  const Loads compressed = loads(find(g, 1, 5), -20.0, {}), pulled = loads(find(g, 1, 5), 1e4, {10.0, far[0], far[1]});
  const Loads down = loads(find(g, 2, 1), -20.0, {}, 0.05), up = loads(find(g, 2, 1), 1e4, far);
  if (compressed.asked.size() != 1 || pulled.asked.size() != 4 || up.asked.size() != 3)
    throw std::runtime_error("knots under axial force: " + compressed.ended + "; " + pulled.ended + "; " + up.ended);
  figure_III_2_3(pulled.family, {compressed.asked[0], pulled.asked[0], pulled.asked[3]}, out);
  geodesic_rows("(1,5)", pulled.family, {pulled.asked.begin() + 1, pulled.asked.end()}, out.rows);
  geodesic_rows("(2,1)", up.family, up.asked, out.rows);

  drawing::Panel family, loaded;
  family.title = "F3(0) = 0";
  family.x_label = "revolutions per winding [-]";
  loaded.title = "Knots under axial force";
  loaded.x_label = "asinh F3(0), F3 in B/R² [-]";
  family.y_label = loaded.y_label = "β' at ξ = 0 [-]";
  drawing::Curve line, marks;
  line.x = g.turns;
  line.y = g.slopes;
  line.colour = 0;
  marks.line = drawing::Line::none;
  marks.mark = drawing::Mark::circle;
  marks.colour = 1;
  marks.label = "states shown";
  for (const Knot& k : g.knots) {
    marks.x.push_back(k.turn());
    marks.y.push_back(point_at(k.unit, k.winding, 0.0).slope);
  }
  family.curves = {line, marks};
  loaded.curves = {response("(1,5)", 0, compressed, pulled), response("(2,1)", 2, down, up)};
  for (const auto& [turn, name, colour] :
       {std::tuple{0.2, "geodesic (1,5)", 0}, std::tuple{2.0, "geodesic (2,1)", 2}}) {
    drawing::Curve limit;
    limit.label = name;
    limit.colour = colour;
    limit.line = drawing::Line::dotted;
    limit.x = {std::asinh(1.0), std::asinh(1e4)};
    limit.y.assign(2, closed_form::torus_geodesic(pulled.family.rod.epsilon, 2.0 * pi * turn).slope(0.0));
    loaded.curves.push_back(limit);
  }
  Picture families;
  families.name = "families";
  families.caption =
      "Left: the family of closed rods followed from the Villarceau circle (1 revolution per winding) both ways; the "
      "states off the curve, at 3, 4 and 5, belong to other families. Right: the knots (1,5) and (2,1) followed in the "
      "axial force; the latter turns back several times.";
  families.figure.title = "Families of closed rods";
  families.figure.panels = {family, loaded};
  out.pictures.push_back(families);

  out.data.push_back({"family", {"revolutions per winding", "slope at xi = 0", "H [B/R^2]"}, {g.turns, g.slopes, g.H}});
  const auto series = [&](const std::string& name, const Loads& l) {
    out.data.push_back(
        {name, {"F3(0) [B/R^2]", "slope at xi = 0", "length of a winding [R]"}, {l.force, l.slope, l.length}});
  };
  series("force_1_5_compressed", compressed);
  series("force_1_5_pulled", pulled);
  series("force_2_1_compressed", down);
  series("force_2_1_pulled", up);
  const auto where = [](const std::vector<double>& at) {
    return at.empty() ? std::string("nowhere") : "at " + text(at);
  };
  std::vector<double> folds = compressed.folds, branch_points = compressed.branch_points;
  folds.insert(folds.end(), pulled.folds.begin(), pulled.folds.end());
  branch_points.insert(branch_points.end(), pulled.branch_points.begin(), pulled.branch_points.end());
  out.notes.push_back("(1,5) from F3(0) = -20 to 10⁴ folds " + where(folds) + "; other families cross it " +
                      where(branch_points) + ".");
  out.notes.push_back("(2,1) reaches its geodesic over folds at F3(0) = " + text(up.folds) + ". Pushed, it folds at " +
                      text(down.folds) + " and is left at " + text(down.force.back()) + ", where d3·D3 has fallen to " +
                      text(down.least_along) +
                      ": it turns across the tube and the Eulerian form cannot follow it further; -20 is not reached.");
}

}  // namespace tendril::reproduce::torus

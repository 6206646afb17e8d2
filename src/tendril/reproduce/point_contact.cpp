// Point contact (III.3) on solved states of the helical conduit: what is continuous and what jumps (III.3.2-9), how the
// gap opens next to a point and next to a line end (contact order), and the criterion (III.3.10) that ends the life of
// a point contact. Extensible and inextensible rods, with and without symmetry.

#include <algorithm>
#include <array>
#include <cmath>

#include "tendril/reproduce/point_contact_states.hpp"
#include "tendril/reproduce/systems.hpp"
#include "tendril/segmentation/pattern_checks.hpp"

namespace tendril::reproduce {
namespace {

using namespace point_contact;

constexpr double exact = 1e-10;  // of R

/// (III.3.2-9) at a point contact.
void jump_rows(const std::string& state, const Contact& c, std::vector<Row>& rows) {
  const Side &a = c.before, &b = c.after;
  const auto add = [&](const std::string& quantity, double computed, double expected, double tolerance,
                       const char* source) {
    rows.push_back({state + ": " + quantity, computed, expected, tolerance, source});
  };
  const double size = std::max(1.0, std::abs(c.R));
  const double kept = std::max({std::abs(b.F3 - a.F3) / size, std::abs(b.Fg - a.Fg) / size, std::abs(b.kg - a.kg),
                                std::abs(b.kn - a.kn), std::abs(b.M3 - a.M3), std::abs(b.t[0] - a.t[0]),
                                std::abs(b.t[1] - a.t[1]), std::abs(b.t[2] - a.t[2])});
  add("largest jump of d3, F_g, F3, κ_g, κ_n, M3", kept, 0.0, 1e-10, "(III.3.2-3)");
  add("⟦F_n⟧ [B/L²]", b.Fn - a.Fn, c.resultant, exact * size, "the wall's force from the forces at the rod's ends");
  const double kn = a.kn, kg = a.kg;
  if (c.eta2 > 0.0)
    add("⟦α'⟧ [1/L]", b.alpha_s - a.alpha_s, a.alpha * kn * c.eta2 * c.R, exact * size, "α κ_n η² R (III.3.4)");
  else
    add("⟦F3'⟧ [B/L³]", b.F3_s - a.F3_s, kn * c.R, exact * size * std::abs(kn), "κ_n R (III.3.7)");
  add("⟦κ_g'⟧ [1/L²]", b.kg_s - a.kg_s, -kg * kn * c.eta2 * c.R, exact * size,
      c.eta2 > 0.0 ? "-κ_g κ_n η² R (III.3.5)" : "0 (III.3.8)");
  add("⟦κ_n'⟧ [1/L²]", b.kn_s - a.kn_s, -(1.0 + c.eta2 * kn * kn) * c.R, exact * size,
      c.eta2 > 0.0 ? "-(1 + η² κ_n²) R (III.3.6)" : "-R (III.3.9)");
}

/// Life of the point contact: loads at which it begins and at which (III.3.10) ends it, with their printed values.
struct Life {
  double clearance, begins, ends, R;
  const char* name;
};
constexpr std::array<Life, 4> lives{{{0.05, -1.290510413, -2.640046467, 13.16761489, "ε = 1/20, outer wall"},
                                     {0.025, -1.178887788, -2.006721010, 7.50280625, "ε = 1/40, outer wall"},
                                     {0.05, -0.281948695, 3.327296290, 24.21949381, "ε = 1/20, inner wall"},
                                     {0.025, -0.720354515, 0.614146894, 10.07501747, "ε = 1/40, inner wall"}}};

drawing::Curve curve(std::string label, int colour, drawing::Line line = drawing::Line::solid) {
  drawing::Curve c;
  c.label = std::move(label);
  c.colour = colour;
  c.line = line;
  return c;
}

/// F_n, F_g, F3, κ_n, κ_g along s next to the contact of two chains (extensible, inextensible); N is that of the
/// contact.
void along_the_contact(const Chain& c, const std::string& name, int colour, std::vector<drawing::Panel>& panels,
                       Data& data) {
  const double S = c.S(1), window = 0.12;
  const Section middle = section_at(c, 0, S);
  const V3<double> g = numerics::cross(middle.N, middle.t);
  std::array<drawing::Curve, 4> curves;
  for (auto& one : curves) one = curve(name, colour);
  std::vector<std::vector<double>> columns(6);
  for (int segment : {0, 1})
    for (int i = 0; i <= 60; ++i) {
      const double x = S + window * (segment == 0 ? (i - 60) / 60.0 : i / 60.0);
      const Section p = section_at(c, segment, x);
      const std::array<double, 5> values{numerics::dot(p.force, middle.N), numerics::dot(p.force, g), p.F3,
                                         numerics::dot(p.curvature, middle.N), numerics::dot(p.curvature, g)};
      columns[0].push_back(p.s - middle.s);
      for (int q = 0; q < 5; ++q) columns[q + 1].push_back(values[q]);
      const std::array<int, 4> shown{0, 2, 3, 4};
      for (int q = 0; q < 4; ++q) {
        curves[q].x.push_back(p.s - middle.s);
        curves[q].y.push_back(values[shown[q]]);
      }
    }
  for (int q = 0; q < 4; ++q) panels[q].curves.push_back(curves[q]);
  data.value.insert(data.value.end(), columns.begin(), columns.end());
}

/// Gap over the distance from a contact, with its leading term.
void gap_curves(const Chain& c, int junction, int segment, bool after, int power, double coefficient,
                const std::string& name, int colour, drawing::Panel& panel, Data& data) {
  const double S = c.S(junction + 1), Q = c.mechanics().problem.section(S).Q[0];
  drawing::Curve gap = curve(name, colour), lead = curve("", colour, drawing::Line::dashed);
  double s0 = 0.0, u[formulation::FreeRod::inputs];
  c.segment(segment).evaluate(S, c.S(segment), c.S(segment + 1), u, &s0);
  std::vector<double> distance, height;
  for (int i = 0; i <= 60; ++i) {
    const double d = std::pow(10.0, -2.5 + 1.6 * i / 60.0);
    if (d > c.S(segment + 1) - c.S(segment)) break;
    const double x = after ? S + d : S - d;
    double s = 0.0;
    c.segment(segment).evaluate(x, c.S(segment), c.S(segment + 1), u, &s);
    distance.push_back(std::abs(s - s0));
    height.push_back(segmentation::relative_gap(c, segment, x) * Q);
    gap.x.push_back(distance.back());
    gap.y.push_back(height.back());
    lead.x.push_back(distance.back());
    lead.y.push_back(coefficient * std::pow(distance.back(), power));
  }
  panel.curves.push_back(gap);
  panel.curves.push_back(lead);
  data.columns.push_back(name + ": distance s [L]");
  data.columns.push_back(name + ": gap [L]");
  data.value.push_back(distance);
  data.value.push_back(height);
}

void pad(Data& data) {
  std::size_t longest = 0;
  for (const auto& v : data.value) longest = std::max(longest, v.size());
  for (auto& v : data.value) v.resize(longest, std::nan(""));
}

Outcome compute(const Progress& progress) {
  const auto report = [&](double fraction, const char* what) {
    if (progress && !progress(fraction, what)) throw Interrupted{};
  };
  Outcome out;

  // --- jump conditions ---
  report(0.0, "point contacts");
  const Chain extensible = point_state(0.05, true, -2.0), stiff = point_state(0.05, false, -2.0);
  const Chain oblique = oblique_state(extensible);
  jump_rows("η = 1/20", contact(extensible), out.rows);
  jump_rows("η = 1/20, weight, eccentric end", contact(oblique), out.rows);
  jump_rows("inextensible", contact(stiff), out.rows);

  Picture jumps;
  jumps.name = "jumps";
  jumps.caption =
      "Across a point contact in the helical conduit (ε = 1/20, T = -2|T0|): the normal force jumps by R; the axial "
      "force and the normal curvature have kinks, the geodesic curvature (almost) none. N and N x d3 are those of the "
      "contact.";
  jumps.figure.title = "Across a point contact";
  std::vector<drawing::Panel> panels(4);
  const std::array<const char*, 4> labels{"F·N [B/L²]", "F3 [B/L²]", "κn·N [1/L]", "κn·(N × d3) [1/L]"};
  for (int q = 0; q < 4; ++q) {
    panels[q].x_label = "s - s_c [L]";
    panels[q].y_label = labels[q];
  }
  Data across{"jumps", {}, {}};
  for (const char* name : {"eta = 1/20", "inextensible", "oblique"})
    for (const char* column :
         {"s - s_c [L]", "F.N [B/L^2]", "F.(N x d3) [B/L^2]", "F3 [B/L^2]", "kappa.N [1/L]", "kappa.(N x d3) [1/L]"})
      across.columns.push_back(std::string(name) + ": " + column);
  along_the_contact(extensible, "η = 1/20", 0, panels, across);
  along_the_contact(stiff, "inextensible", 1, panels, across);
  along_the_contact(oblique, "η = 1/20, weight, eccentric end", 2, panels, across);
  jumps.figure.panels = panels;
  out.pictures.push_back(jumps);
  out.data.push_back(across);

  // --- the criterion (III.3.10) ---
  drawing::Panel excess_panel, reaction_panel;
  excess_panel.title = "Criterion (III.3.10): ⟨κ⟩ ≤ 0";
  excess_panel.x_label = reaction_panel.x_label = "|T - T_1|/|T0|, T_1 the first contact [-]";
  excess_panel.y_label = "⟨κ⟩ = Q (κn·N - κ_n) [-]";
  reaction_panel.title = "Reaction";
  reaction_panel.y_label = "R [B/L²]";
  Data sweep{"criterion", {}, {}};
  Chain flat;  // at the transition, ε = 1/20, outer wall
  for (std::size_t i = 0; i < lives.size(); ++i) {
    const Life& life = lives[i];
    report(0.2 + 0.15 * i, life.name);
    const double away = life.ends < -1.0 ? -0.05 : 0.05;
    Chain c = free_state(life.clearance, true);
    const auto gap = [](const Chain& x) { return segmentation::relative_gap(x, 0, 0.5); };
    const double begins = zero(c, life.begins - 2.0 * away, life.begins - away, true, gap);
    Chain point = c.recut({{0, 0}, {0.5}});
    drawing::Curve excess = curve(life.name, static_cast<int>(i)), R = excess;
    std::vector<double> loads;
    for (int q = 0; q <= 10; ++q) {
      // a little past the end, where keeping the point is no longer admissible
      const double load = begins + (life.ends - begins) * (0.02 + 1.08 * q / 10.0);
      walk_to(point, load, true);
      loads.push_back(load);
      excess.x.push_back(std::abs(load - begins));
      excess.y.push_back(segmentation::curvature_excess(point, 0));
      R.x.push_back(std::abs(load - begins));
      R.y.push_back(segmentation::reaction(point, 0));
    }
    const double ends = zero(point, life.ends + away, life.ends - away, true,
                             [](const Chain& x) { return segmentation::curvature_excess(x, 0); });
    excess_panel.curves.push_back(excess);
    reaction_panel.curves.push_back(R);
    sweep.columns.push_back(std::string(life.name) + ": T/|T0| [-]");
    sweep.columns.push_back(std::string(life.name) + ": curvature excess [-]");
    sweep.columns.push_back(std::string(life.name) + ": R [B/L^2]");
    sweep.value.push_back(loads);
    sweep.value.push_back(excess.y);
    sweep.value.push_back(R.y);
    const char* source = "first-order form of the equations, solved separately; digits given";
    out.rows.push_back({std::string(life.name) + ": first contact T/|T0|", begins, life.begins, 6e-10, source});
    out.rows.push_back({std::string(life.name) + ": ⟨κ⟩ = 0 at T/|T0|", ends, life.ends, 6e-10, source});
    out.rows.push_back(
        {std::string(life.name) + ": R there [B/L²]", segmentation::reaction(point, 0), life.R, 6e-9, source});
    if (i == 0) flat = point;
  }
  drawing::Curve limit = curve("", -1, drawing::Line::dotted);
  limit.x = {0.0, 4.0};
  limit.y = {0.0, 0.0};
  limit.colour = 7;
  excess_panel.curves.push_back(limit);
  excess_panel.x_range = reaction_panel.x_range = {{0.0, 4.0}};
  out.data.push_back(sweep);
  Picture criterion;
  criterion.name = "criterion";
  criterion.caption =
      "The life of a point contact: it begins with R = 0 and ends where the rod is as curved towards the wall as the "
      "wall itself, ⟨κ⟩ = 0; above the dotted line a rod held at one point would pass through the wall on both sides.";
  criterion.figure.title = "From point to line";
  criterion.figure.panels = {excess_panel, reaction_panel};
  out.pictures.push_back(criterion);

  // --- contact order ---
  report(0.85, "contact order");
  const Chain line = line_state(flat, -5.0);
  drawing::Panel gaps;
  gaps.x_label = "distance along the rod |s - s_c| [L]";
  gaps.y_label = "gap [L]";
  gaps.x_log = gaps.y_log = true;
  Data opening{"contact_order", {}, {}};
  {
    const Contact k = contact(extensible);
    const double a2 = k.after.alpha * k.after.alpha, expected = a2 * (k.after.kn_wall - k.after.kn);
    out.rows.push_back(
        {"point contact (order 1): gap'' [1/L]", k.after.gap_s2, expected, 1e-10, "α² (κ_n of the wall - κn·N)"});
    gap_curves(extensible, 0, 1, true, 2, 0.5 * k.after.gap_s2, "point, T = -2|T0|", 0, gaps, opening);
  }
  {
    const Contact k = contact(flat);
    const double a2 = k.after.alpha * k.after.alpha;
    const double expected = 0.5 * a2 * (1.0 + k.eta2 * k.after.kn * k.after.kn) * k.R;
    out.rows.push_back({"transition (order 2): gap'' [1/L]", k.after.gap_s2, 0.0, 1e-10, "(III.3.10) with equality"});
    out.rows.push_back({"transition: gap''' on either side [1/L²]", 0.5 * (k.after.gap_s3 - k.before.gap_s3), expected,
                        exact * k.R, "α² (1 + η² κ_n²) R/2, from (III.3.6)"});
    gap_curves(flat, 0, 1, true, 3, k.after.gap_s3 / 6.0, "transition, T = -2.640|T0|", 1, gaps, opening);
  }
  {
    const Side s = side_of(line, 2, true);
    const double R = segmentation::reaction(line, 1), eta2 = line.mechanics().problem.material.eta2;
    const double expected = s.alpha * s.alpha * (1.0 + eta2 * s.kn * s.kn) * R;
    out.rows.push_back({"line end (order 2): gap'' [1/L]", s.gap_s2, 0.0, 1e-10, "κ_n is that of the wall"});
    out.rows.push_back(
        {"line end: gap''' [1/L²]", s.gap_s3, expected, exact * R, "α² (1 + η² κ_n²) R, from (III.3.6)"});
    gap_curves(line, 1, 2, true, 3, s.gap_s3 / 6.0, "line end, T = -5|T0|", 2, gaps, opening);
  }
  pad(opening);
  out.data.push_back(opening);
  Picture order;
  order.name = "contact_order";
  order.caption =
      "How the gap opens: quadratically next to a point contact (order 1), cubically at the transition and next to the "
      "end of a line (order 2). Dashed: the leading term predicted from the curvatures and the reaction.";
  order.figure.title = "Contact order";
  order.figure.columns = 1;
  order.figure.panel_width = 560.0;
  order.figure.panels = {gaps};
  out.pictures.push_back(order);

  out.notes.push_back(
      "Jumps are per reference length (the thesis' primes in (III.3.4-9)); R = ⟦F_n⟧ with N outward, and R >= 0 "
      "because "
      "the rod is inside.");
  out.notes.push_back(
      "The jump conditions follow from equilibrium, they are not imposed: the solver asks for continuity of place, "
      "tangent, roll, moment, F_g and F3 only.");
  out.notes.push_back(
      "A contact of order 3 or more carries no reaction: the cubic term of the gap is proportional to R.");
  report(1.0, "done");
  return out;
}

}  // namespace

System point_contact_system() {
  return {
      "point_contact",
      "Point contact: jumps, contact order, criterion",
      "III.3; Eqs. (III.3.2-10)",
      "What is continuous and what jumps where a rod touches a wall at one point, how the gap opens there, and when "
      "the point becomes a line.",
      compute,
      0.3};
}

}  // namespace tendril::reproduce

// Straight tube in three dimensions: a rod longer than its straight round tube touches the wall at one point in a
// plane, at one point in space, at two points, at three. Found along a path, with every event located and stability
// judged; against the limit of small clearance, which is approached with order two, and a shooting of half the rod.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "tendril/closed_form/columns.hpp"
#include "tendril/closed_form/small_clearance.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/reproduce/body.hpp"
#include "tendril/reproduce/lagrangian_conduit.hpp"
#include "tendril/reproduce/straight_tube_twin.hpp"
#include "tendril/reproduce/systems.hpp"

namespace tendril::reproduce {
namespace {

using closed_form::SmallClearanceState;
using continuation::Event;
using continuation::Result;
using continuation::Step;
using drawing::Curve;
using drawing::Panel;
using segmentation::AxialControl;
using segmentation::Scalar;
constexpr double euler = 4.0 * std::numbers::pi * std::numbers::pi;

enum class Control { push, slack };

/// x: push over 4π² B/L², or (rod length - 1)/h².
segmentation::Problem tube(double h, double torque, Control control, double x) {
  segmentation::Problem p;
  p.tube.axis = geometry::make_straight(1.0);
  p.tube.clearance = geometry::make_constant(h);
  p.rod = {1.0, 0.75, {}};
  p.end.kind = segmentation::End::Kind::sleeve;
  p.end_position = 1.0;
  p.axial = control == Control::push ? AxialControl::push : AxialControl::rod_length;
  p.axial_value = control == Control::push ? Scalar(euler * x, euler) : Scalar(1.0 + x * h * h, h * h);
  p.twist_value = torque;
  return p;
}

Result followed(double h, double torque, Control control, double from, std::vector<double> values) {
  continuation::StudyOptions options;
  options.solve.tolerance = 1e-9;
  options.fields = true;
  options.field_points = 301;
  return continuation::follow([=](double x) { return tube(h, torque, control, x); }, {from, std::move(values), true},
                              options);
}

const Event* event(const Result& r, const std::string& kind, int which = 0) {
  for (const Event& e : r.events)
    if (e.kind == kind && which-- == 0) return &e;
  return nullptr;
}

constexpr double none = std::numeric_limits<double>::quiet_NaN();

std::string number(double x, int digits) {
  std::string s = std::to_string(x);
  return s.substr(0, s.find('.') + 1 + digits);
}

double turn_of(const Step& s) {
  return std::abs(
      std::remainder(s.contacts.back().angle_start - s.contacts.front().angle_start, 2.0 * std::numbers::pi));
}

/// Quantities at three clearances h, 2h, 4h: the limit, free of h² and h⁴, and the order they show.
struct Limit {
  double value, order;
};
Limit limit_of(const std::array<double, 3>& v) {
  const double fine = v[0] + (v[0] - v[1]) / 3.0, coarse = v[1] + (v[1] - v[2]) / 3.0;
  return {fine + (fine - coarse) / 15.0, std::log2((v[2] - v[1]) / (v[1] - v[0]))};
}

void limit_rows(std::vector<Row>& rows, Data& data) {
  constexpr std::array<double, 3> clearance{0.002, 0.004, 0.008};
  // what is left is of order h⁶; the quantities change by some 20 h² = 1e-3 between these clearances
  constexpr double small = 1e-6, order_tolerance = 0.05;
  std::array<Result, 3> r;
  for (int i = 0; i < 3; ++i) r[i] = followed(clearance[i], 0.0, Control::push, 1.5, {2.5, 3.05});
  const auto add = [&](const std::string& what, double expected, const char* source, auto&& of) {
    std::array<double, 3> v{};
    for (int i = 0; i < 3; ++i) v[i] = of(r[i], clearance[i]);
    const Limit l = limit_of(v);
    rows.push_back({"h → 0: " + what, l.value, expected, small * std::max(1.0, std::abs(expected)), source});
    rows.push_back({"h → 0: " + what + ": order in h", l.order, 2.0, order_tolerance, "small-slope theory"});
    for (int i = 0; i < 3; ++i) {
      data.value[0].push_back(clearance[i]);
      data.value[1].push_back(static_cast<double>(rows.size() / 2));
      data.value[2].push_back(v[i]);
    }
  };
  const SmallClearanceState two = closed_form::two_points(2.5 * euler), three = closed_form::three_points(3.05 * euler),
                            third = closed_form::third_point_appears();
  constexpr const char* beam = "beam-column with wall, linear (closed_form/small_clearance)";
  add("planar point gives way sideways, P/4π²", closed_form::euler_load_clamped(2, 1, 1) / euler,
      "tan z = z: 2.0457485", [](const Result& x, double) {
        const Event* e = event(x, "branch_point");
        return e ? e->parameter : none;
      });
  add("third point appears, P/4π²", third.push / euler, "2.9803448, linear theory", [](const Result& x, double) {
    const Event* e = event(x, "contact_appears");
    return e ? e->parameter : none;
  });
  const auto state = [&](int step, const std::string& name, const SmallClearanceState& s, std::size_t contacts) {
    const auto with = [step, contacts](auto&& of) {
      return [step, contacts, of](const Result& x, double h) {
        if (static_cast<int>(x.steps.size()) <= step || x.steps[step].contacts.size() != contacts) return none;
        return of(x.steps[step], h);
      };
    };
    add(name + ": place of the first contact", s.place, beam,
        with([](const Step& q, double) { return q.contacts.front().start; }));
    add(name + ": angle between the outer contacts", s.turn, beam,
        with([](const Step& q, double) { return turn_of(q); }));
    add(name + ": outer reaction/h", s.outer, beam,
        with([](const Step& q, double h) { return q.contacts.front().force / h; }));
    if (contacts == 3)
      add(name + ": middle reaction/h", s.middle, beam,
          with([](const Step& q, double h) { return q.contacts[1].force / h; }));
    add(name + ": (ℓ - 1)/h²", s.slack, beam,
        with([](const Step& q, double h) { return (q.rod_length - 1.0) / (h * h); }));
  };
  state(0, "two points at P = 2.5", two, 2);
  state(1, "three points at P = 3.05", three, 3);
}

void twin_rows(const std::string& where, const Step& s, double h, std::vector<Row>& rows) {
  constexpr double asked = 1e-8;  // ten times the solver's 1e-9
  const TubeTwin t = twin_of(s, h);
  const auto add = [&](const char* what, double computed, double expected, double size) {
    rows.push_back(
        {where + what, computed, t.converged ? expected : none, asked * size, "half the rod shot in the world frame"});
  };
  const double R = std::max(t.outer, t.middle);
  add("ℓ/L", s.rod_length, t.rod_length, 1.0);
  if (s.contacts.size() == 1) {
    add("R [B/L²]", s.contacts[0].force, t.middle, 10.0 * R);
    return;
  }
  add("place of the first contact [L]", s.contacts[0].start, t.place, 10.0);
  add("angle between the outer contacts [rad]", turn_of(s), std::abs(std::remainder(t.turn, 2.0 * std::numbers::pi)),
      100.0);
  add("outer reaction [B/L²]", s.contacts[0].force, t.outer, 10.0 * R);
  if (s.contacts.size() == 3) add("middle reaction [B/L²]", s.contacts[1].force, t.middle, 10.0 * R);
}

Curve styled(std::string label, int colour, drawing::Line line = drawing::Line::solid,
             drawing::Mark mark = drawing::Mark::none) {
  Curve c;
  c.label = std::move(label);
  c.colour = colour;
  c.line = line;
  c.mark = mark;
  c.mark_size = 7;
  return c;
}

/// Response of one path in slack, cut at its events: free, one point, two, three.
void response(const Result& r, double h, int colour, const std::string& label, Panel& p) {
  Curve line = styled(label, colour);
  for (const auto& t : r.trace) {
    line.x.push_back((t.rod_length - 1.0) / (h * h));
    line.y.push_back(-t.axial_force_end / euler);
  }
  for (const auto& e : r.events) {  // the curve passes through its events
    const double x = (e.rod_length - 1.0) / (h * h);
    const auto at = std::lower_bound(line.x.begin(), line.x.end(), x) - line.x.begin();
    line.x.insert(line.x.begin() + at, x);
    line.y.insert(line.y.begin() + at, -e.axial_force_end / euler);
  }
  p.curves.push_back(line);
}

void marks(const std::vector<const Result*>& results, double h, Panel& p) {
  const struct {
    const char *kind, *label;
    drawing::Mark mark;
  } kinds[]{{"contact_appears", "contact appears", drawing::Mark::circle},
            {"branch_point", "leaves the plane", drawing::Mark::cross},
            {"point_splits", "point splits in two", drawing::Mark::square}};
  for (const auto& k : kinds) {
    Curve c = styled(k.label, 6, drawing::Line::none, k.mark);
    for (const Result* r : results)
      for (const auto& e : r->events)
        if (e.kind == k.kind) {
          c.x.push_back((e.rod_length - 1.0) / (h * h));
          c.y.push_back(-e.axial_force_end / euler);
        }
    p.curves.push_back(c);
  }
}

Outcome compute(const Progress& progress) {
  const auto report = [&](double fraction, const char* what) {
    if (progress && !progress(fraction, what)) throw Interrupted{};
  };
  Outcome out;
  Data limits{"straight_tube_limits",
              {"clearance h/L", "quantity (row of the table)", "value"},
              std::vector<std::vector<double>>(3)};
  Data path{"straight_tube_path",
            {"torque M [B/L]", "(rod length - 1)/h^2", "end force -F3 [B/L^2]", "contacts"},
            std::vector<std::vector<double>>(4)};
  report(0.0, "small clearances");
  limit_rows(out.rows, limits);

  constexpr double h = 0.05;
  report(0.4, "path at clearance 1/20");
  const std::vector<double> listed{2.5, 4.0, 8.0, 13.5};
  const std::array<double, 3> torques{0.0, 2.0, 4.0};
  std::vector<Result> results;
  for (const double M : torques) results.push_back(followed(h, M, Control::slack, 2.0, listed));
  const Result& plain = results.front();

  // the sequence, and the exact first contact
  const auto exact = closed_form::first_contact_at_span(h, 1.0, 1.0);
  if (const Event* e = event(plain, "contact_appears")) {
    out.rows.push_back({"h = 1/20: first contact, (ℓ - 1)/h²", e->parameter, (exact.rod_length - 1) / (h * h), 1e-7,
                        "h = L sin(a/2)/K; its limit is π²/4"});
    out.rows.push_back(
        {"h = 1/20: first contact, F L²/B", -e->axial_force_end, exact.thrust, 1e-8 * exact.thrust, "F = 16 K² B/L²"});
  } else {
    out.rows.push_back({"h = 1/20: first contact", none, exact.thrust, 0.0, "not found"});
  }
  const char* names[]{"planar point", "spatial point", "two points", "three points"};
  const std::size_t counts[]{1, 1, 2, 3};
  for (std::size_t m = 0; m < torques.size(); ++m)
    for (std::size_t i = 0; i < listed.size(); ++i) {
      const std::string where = "M = " + std::to_string(int(torques[m])) +
                                " B/L, (ℓ - 1)/h² = " + number(listed[i], 1) +
                                (m == 0 ? std::string(" (") + names[i] + ")" : "") + ": ";
      if (results[m].steps.size() <= i) {
        out.rows.push_back({where + "state", none, 0.0, 0.0, "path"});
        continue;
      }
      const Step& s = results[m].steps[i];
      if (m == 0)
        out.rows.push_back({where + "number of contacts", double(s.contacts.size()), double(counts[i]), 0.0,
                            "the sequence of the straight tube"});
      out.rows.push_back({where + "stable at held length (1)", s.stability == "stable" ? 1.0 : 0.0, 1.0, 0.0,
                          "second variation; no state of this path should be left"});
      double lines = 0.0;
      for (const auto& c : s.contacts) lines += c.line;
      if (lines == 0.0 && !s.contacts.empty()) twin_rows(where, s, h, out.rows);
    }
  for (std::size_t m = 0; m < torques.size(); ++m)
    for (const auto& t : results[m].trace) {
      const double row[]{torques[m], (t.rod_length - 1) / (h * h), -t.axial_force_end, double(t.contacts)};
      for (int q = 0; q < 4; ++q) path.value[q].push_back(row[q]);
    }

  report(0.8, "helical conduit");
  {  // the other half of the acceptance pair
    continuation::StudyOptions options;
    options.solve.branch = segmentation::BranchRule::nearest;
    options.solve.tolerance = 1e-9;
    const double unit = helical_conduit_force();
    const Result r = continuation::follow(
        [&](double x) {
          auto p = helical_conduit_case(1.0 / 40, x * unit);
          p.axial_value = Scalar(x * unit, unit);
          return p;
        },
        {-1.5, {-2.05}, true}, options);
    const Event* e = event(r, "point_to_line");
    out.rows.push_back({"acceptance pair: in the helical conduit (ε = 1/40) the point becomes a line at T/|T0|",
                        e ? e->parameter : none, -2.006721010, 5e-9, "Lagrangian solution, ten digits"});
    double lines = 0.0;
    for (const auto& q : plain.steps)
      for (const auto& c : q.contacts) lines += c.line;
    out.rows.push_back({"acceptance pair: lines among the listed states of the straight tube", lines, 0.0, 0.0,
                        "a line there would pull from zero length on"});
  }

  Panel left, cross;
  left.title = "response at clearance h = L/20";
  left.x_label = "rod length (ℓ - L) L/h² [-]";
  left.y_label = "end force -F_3 L²/(4π² B) [-]";
  const char* torque_names[]{"M = 0", "M = 2 B/L", "M = 4 B/L"};
  std::vector<const Result*> pointers;
  for (std::size_t m = 0; m < torques.size(); ++m) {
    response(results[m], h, static_cast<int>(m), torque_names[m], left);
    pointers.push_back(&results[m]);
  }
  Curve limit = styled("h → 0, M = 0", 7, drawing::Line::dashed);
  limit.width = 2.4;
  for (int i = 0; i <= 30; ++i) {
    const SmallClearanceState s =
        closed_form::planar_point(euler * (1.0 + 1e-9) + (closed_form::euler_load_clamped(2, 1, 1) - euler) * i / 30.0);
    limit.x.push_back(s.slack);
    limit.y.push_back(s.push / euler);
  }
  const SmallClearanceState split = closed_form::spatial_point_splits(), third = closed_form::third_point_appears();
  limit.x.push_back(split.slack);
  limit.y.push_back(split.push / euler);
  for (int i = 0; i <= 20; ++i) {
    const double x = 2.1 + (third.push / euler - 2.1) * i / 20.0;
    const SmallClearanceState s = closed_form::two_points(x * euler);
    if (!s.found) continue;
    limit.x.push_back(s.slack);
    limit.y.push_back(x);
  }
  left.curves.push_back(limit);
  marks(pointers, h, left);

  cross.title = "seen along the axis, M = 0";
  cross.x_label = "δ_1/h [-]";
  cross.y_label = "δ_2/h [-]";
  cross.equal_scale = true;
  Curve wall = styled("", 7);
  for (int i = 0; i <= 90; ++i) {
    wall.x.push_back(std::cos(2 * std::numbers::pi * i / 90));
    wall.y.push_back(std::sin(2 * std::numbers::pi * i / 90));
  }
  cross.curves.push_back(wall);
  std::vector<Panel> bodies;
  for (std::size_t i = 0; i < plain.steps.size() && i < 4; ++i) {
    const Step& s = plain.steps[i];
    Curve c = styled(names[i], static_cast<int>(i));
    for (std::size_t q = 0; q < s.fields.S.size(); ++q) {
      c.x.push_back(s.fields.delta1[q] / h);
      c.y.push_back(s.fields.delta2[q] / h);
    }
    cross.curves.push_back(c);
    Panel b = body_panel(names[i]);
    const drawing::View view{0.9, 0.25};
    const auto p = tube(h, 0.0, Control::slack, listed[i]);
    add_tube(b, view, p.tube, 1.0);
    add_rod(b, view, s.fields, 1e-4 * h);
    bodies.push_back(b);
  }
  Picture picture{
      "straight_tube",
      "Left: end force over rod length for torques 0, 2 and 4 B/L, all states stable at held length, with the "
      "events and the limit of small clearance. Right: the four kinds of state seen along the tube.",
      {}};
  picture.figure.title = "Rod in a straight round tube";
  picture.figure.panels = {left, cross};
  picture.figure.panel_height = 360;
  Picture shapes{
      "straight_tube_shapes",
      "The rod in its tube, clearance h = L/20, no torque: (ℓ - L) L/h² = 2.5, 4, 8, 13.5. Contacts in vermillion.",
      {}};
  shapes.figure.title = "Shapes";
  shapes.figure.columns = 4;
  shapes.figure.panel_width = 190;
  shapes.figure.panel_height = 420;
  shapes.figure.panels = bodies;
  out.pictures = {picture, shapes};
  out.data = {limits, path};
  out.notes = {
      "Under a held end force the span is crossed in jumps (fixed span, free length is subcritical at first contact); "
      "at "
      "held length every state of the sequence is stable and the path is continuous.",
      "In the limit h → 0 all spatial one-point states have one load, 2.0457485; at finite h the load falls slightly "
      "along them, so a dead push jumps from the planar point to two points.",
      "The planar continuation (point to line at 4, flat part buckles at 9) is system planar_elastica; it is unstable "
      "here."};
  report(1.0, "done");
  return out;
}

}  // namespace

System straight_tube_system() {
  return {"straight_tube", "Straight tube in three dimensions", "II.3.1-2, III.3, IV.1.4",
          "First contact, spatial one-point contact, two points and three, with torque 0 and more; the small-clearance "
          "limits; stability.",
          compute};
}

}  // namespace tendril::reproduce

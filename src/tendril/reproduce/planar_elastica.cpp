// Planar elastica (II.3.1): a straight rod, longer than the distance of its clamps, between two parallel walls. First
// contact, transition from a point to a line, buckling of the flat part: found by the path follower at fixed span and
// at fixed length, against the closed forms.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tendril/closed_form/columns.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"
#include "tendril/reproduce/systems.hpp"

namespace tendril::reproduce {
namespace {

using closed_form::PlanarState;
using continuation::Event;
using continuation::Result;
using drawing::Curve;
using drawing::Panel;
using segmentation::Scalar;
constexpr double euler = 4.0 * std::numbers::pi * std::numbers::pi;  // B/L²
constexpr double asked = 1e-8;

enum class Held { span, length };

segmentation::Problem between_walls(double clearance, Held held, double p) {
  segmentation::Problem q;
  q.tube.axis = geometry::make_straight(1.0);
  q.tube.clearance = geometry::make_constant(clearance);
  q.rod = {1.0, 0.75, {}};
  q.end.kind = segmentation::End::Kind::sleeve;
  q.end_position = held == Held::length ? Scalar(p, 1.0) : Scalar(1.0);
  q.axial = segmentation::AxialControl::rod_length;
  q.axial_value = held == Held::length ? Scalar(1.0) : Scalar(p, 1.0);
  return q;
}

Result followed(double clearance, Held held, double from, std::vector<double> values) {
  continuation::StudyOptions options;
  options.solve.branch = segmentation::BranchRule::planar;
  options.solve.tolerance = 1e-9;
  options.fields = true;
  options.field_points = 201;
  return continuation::follow([=](double p) { return between_walls(clearance, held, p); },
                              {from, std::move(values), true}, options);
}

struct Landmarks {
  PlanarState first, line, buckle;
};

/// The closed forms at a clearance h over the held length: by slope at fixed rod length.
PlanarState at_clearance(PlanarState (*state)(double, double, double), double clearance, double steepest) {
  double low = 1e-9, high = steepest;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (state(middle, 1.0, 1.0).clearance < clearance ? low : high) = middle;
  }
  return state(0.5 * (low + high), 1.0, 1.0);
}

Landmarks landmarks(double h, Held held) {
  if (held == Held::span)
    return {closed_form::first_contact_at_span(h, 1, 1), closed_form::point_to_line_at_span(h, 1, 1),
            closed_form::flat_part_buckles_at_span(h, 1, 1)};
  return {at_clearance(closed_form::first_contact, h, 2.2), at_clearance(closed_form::point_to_line, h, 1.1),
          at_clearance(closed_form::flat_part_buckles, h, 1.1)};
}

double moved(const PlanarState& s, Held held) { return held == Held::span ? s.rod_length : s.span; }

const Event* event(const Result& r, const char* kind) {
  const auto e = std::find_if(r.events.begin(), r.events.end(), [&](const Event& x) { return x.kind == kind; });
  return e == r.events.end() ? nullptr : &*e;
}

void event_rows(const std::string& where, const Event* e, const PlanarState& s, Held held, const char* name,
                const char* source, std::vector<Row>& rows) {
  const std::string start = where + ", " + name + ": ";
  const double none = std::nan("");
  rows.push_back({start + (held == Held::span ? "rod length [D]" : "span [L]"), e ? e->parameter : none, moved(s, held),
                  asked, source});
  rows.push_back({start + (held == Held::span ? "F D²/B" : "F L²/B"), e ? -e->axial_force_end : none, s.thrust,
                  asked * s.thrust, source});
  rows.push_back({start + (held == Held::span ? "R D²/B" : "R L²/B"), e ? e->contact_force : none, s.reaction,
                  asked * s.thrust, source});
}

constexpr const char* first_source = "h = L sin(a/2)/K, F = 16 K² B/L²";
constexpr const char* line_source = "h = (L/2) c sin a, F = 64 K² cos a B/L², R = 128 K² sin a B/L²";
constexpr const char* buckle_source = "16 K² cos a B/l² = 4π² B/c_f², h = l c sin a";

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

/// Response from the trace, events as marks, the closed form of the line phase dashed.
Panel response(const Result& r, const Landmarks& exact, Held held, double h) {
  Panel p;
  p.title = held == Held::span ? "fixed span D, h/D = 0.1" : "fixed length L, h/L = 0.1";
  p.x_label = held == Held::span ? "rod length L/D [-]" : "shortening 1 - D/L [-]";
  p.y_label = held == Held::span ? "thrust F D²/(4π² B) [-]" : "thrust F L²/(4π² B) [-]";
  const auto along = [&](double moved) { return held == Held::span ? moved : 1.0 - moved; };
  Curve free = styled("free", 2), point = styled("one point", 0), line = styled("line", 1);
  for (const auto& t : r.trace) {
    const double at = t.parameter;
    const bool past_first = held == Held::span ? at >= exact.first.rod_length - 1e-12 : at <= exact.first.span + 1e-12;
    const bool past_line = held == Held::span ? at >= exact.line.rod_length - 1e-12 : at <= exact.line.span + 1e-12;
    const bool past_end = held == Held::span ? at > exact.buckle.rod_length : at < exact.buckle.span;
    if (past_end) break;
    Curve& c = past_line ? line : past_first ? point : free;
    c.x.push_back(along(at));
    c.y.push_back(-t.axial_force_end / euler);
  }
  const auto reach = [&](Curve& c, const char* kind, bool at_its_end) {  // curves meet in the events
    const Event* e = event(r, kind);
    if (!e) return;
    c.x.insert(at_its_end ? c.x.end() : c.x.begin(), along(e->parameter));
    c.y.insert(at_its_end ? c.y.end() : c.y.begin(), -e->axial_force_end / euler);
  };
  reach(free, "contact_appears", true);
  reach(point, "contact_appears", false);
  reach(point, "point_to_line", true);
  reach(line, "point_to_line", false);
  reach(line, "line_splits", true);
  Curve dashed = styled("closed form of the line phase", 7, drawing::Line::dashed);
  const double width = 3.0;
  dashed.width = width;
  for (int i = 0; i <= 40; ++i) {
    // slopes between the two events; rod of two arcs and a flat part, scaled to what is held
    const double a = exact.line.slope + (exact.buckle.slope - exact.line.slope) * i / 40.0;
    const PlanarState two = closed_form::point_to_line(a, 1.0, 1.0);  // two arcs of length 1/2, no flat part
    const double scale = h / two.clearance;                           // arcs as high as the walls are apart
    const double flat = held == Held::span ? 1.0 - scale * two.span : 1.0 - scale;
    dashed.x.push_back(held == Held::span ? scale + flat : 1.0 - (scale * two.span + flat));
    dashed.y.push_back(two.thrust / (scale * scale) / euler);
  }
  p.curves = {dashed, free, point, line};
  const struct {
    const char* kind;
    const char* label;
    drawing::Mark mark;
  } marks[]{{"contact_appears", "first contact", drawing::Mark::circle},
            {"point_to_line", "point to line", drawing::Mark::square},
            {"line_splits", "flat part buckles", drawing::Mark::cross}};
  for (const auto& m : marks)
    if (const Event* e = event(r, m.kind)) {
      Curve c = styled(m.label, 6, drawing::Line::none, m.mark);
      c.x = {along(e->parameter)};
      c.y = {-e->axial_force_end / euler};
      p.curves.push_back(c);
    }
  return p;
}

Panel shapes(const Result& r, double h) {
  Panel p;
  p.title = "shapes at fixed span, h/D = 0.1";
  p.x_label = "along the walls [D]";
  p.y_label = "across [D]";
  p.y_range = {{-0.5 * h, 1.35 * h}};
  for (const double wall : {h}) {
    Curve c = styled("wall of the centreline", 7);
    c.width = 2.5;
    c.x = {0.0, 1.0};
    c.y = {wall, wall};
    p.curves.push_back(c);
  }
  const char* names[]{"free", "one point", "line", "line, about to buckle"};
  const int colours[]{2, 0, 1, 6};
  for (std::size_t i = 0; i < r.steps.size() && i < 4; ++i) {
    const auto& f = r.steps[i].fields;
    Curve c = styled(names[i], colours[i]);
    c.x = f.z;
    c.y = f.delta1;
    double most = 0.0;  // the wall touched is drawn above
    for (const double y : c.y) most = std::abs(y) > std::abs(most) ? y : most;
    if (most < 0.0)
      for (double& y : c.y) y = -y;
    p.curves.push_back(c);
  }
  return p;
}

Outcome compute(const Progress& progress) {
  const auto report = [&](double fraction, const std::string& what) {
    if (progress && !progress(fraction, what)) throw Interrupted{};
  };
  Outcome out;
  Data data{"planar_elastica",
            {"1: span held (D = 1), 2: length held (L = 1)", "clearance h", "rod length", "span", "thrust F [B/L^2]",
             "contacts"},
            std::vector<std::vector<double>>(6)};
  Picture picture{"planar_elastica",
                  "The planar elastica between parallel walls. Circles: first contact; squares: the point becomes a "
                  "line; crosses: the flat part buckles and the state jumps. Dashed: closed form of the line phase.",
                  {}};
  std::vector<Panel> panels;
  const struct {
    Held held;
    double h;
  } cases[]{{Held::span, 0.02}, {Held::span, 0.1}, {Held::span, 0.2}, {Held::length, 0.02}, {Held::length, 0.1}};
  double done = 0.0;
  for (const auto& c : cases) {
    const bool span = c.held == Held::span;
    const std::string where =
        std::string(span ? "fixed span, h/D = " : "fixed length, h/L = ") + std::to_string(c.h).substr(0, 4);
    report(done, where);
    done += 0.19;
    const Landmarks exact = landmarks(c.h, c.held);
    const double a = moved(exact.first, c.held), b = moved(exact.line, c.held), e = moved(exact.buckle, c.held);
    const double from = 1.0 + 0.6 * (a - 1.0);
    // listed values: one in each phase, one close to the end, one beyond
    const Result r =
        followed(c.h, c.held, from,
                 {1.0 + 0.9 * (a - 1.0), 0.5 * (a + b), 0.6 * b + 0.4 * e, 0.03 * b + 0.97 * e, 1.1 * e - 0.1 * b});
    event_rows(where, event(r, "contact_appears"), exact.first, c.held, "first contact", first_source, out.rows);
    event_rows(where, event(r, "point_to_line"), exact.line, c.held, "point to line", line_source, out.rows);
    event_rows(where, event(r, "line_splits"), exact.buckle, c.held, "flat part buckles", buckle_source, out.rows);
    double off_plane = 0.0;
    for (const auto& s : r.steps)
      for (const double y : s.fields.delta2) off_plane = std::max(off_plane, std::abs(y));
    out.rows.push_back(
        {where + ": largest distance from the plane", off_plane, 0.0, 1e-15, "planar, to the rounding of sin π"});
    for (const auto& t : r.trace) {
      const double row[]{span ? 1.0 : 2.0,  c.h, t.rod_length, span ? 1.0 : t.parameter, -t.axial_force_end,
                         double(t.contacts)};
      for (int i = 0; i < 6; ++i) data.value[i].push_back(row[i]);
    }
    if (c.h == 0.1) {
      panels.push_back(response(r, exact, c.held, c.h));
      if (span) panels.push_back(shapes(r, c.h));
    }
  }
  // span, length side by side, the shapes below
  if (panels.size() == 3) std::swap(panels[1], panels[2]);
  picture.figure.title = "Planar elastica between parallel walls";
  picture.figure.columns = 2;
  picture.figure.panels = panels;
  out.pictures.push_back(picture);
  out.data.push_back(data);
  out.notes = {
      "Planar states. In a round tube they are equilibria too; the point loses its stability out of the plane at "
      "2.0457 (small clearance, units of 4π² B/L²): see straight_tube.",
      "At the transition from point to line the equations are singular, and along the line phase the ends of the line "
      "are double roots: these states are interpolated from solved neighbours "
      "(docs/decisions/0014-states-beside-singular-ones).",
      "Where the flat part buckles the path ends: beyond, the state jumps to a pattern with more contacts.",
      "At h/L = 0.2 and fixed length the path finds first contact and point to line, and ends early on the line phase, "
      "before the flat part buckles: not in the table."};
  report(1.0, "done");
  return out;
}

}  // namespace

System planar_elastica_system() {
  return {"planar_elastica", "Planar elastica between parallel walls", "II.3.1",
          "First contact, point to line and buckling of the flat part, at fixed span and at fixed length, found by the "
          "path follower.",
          compute};
}

}  // namespace tendril::reproduce

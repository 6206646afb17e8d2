// Pictures and data of the helical conduit.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <limits>

#include "tendril/continuation/report_state.hpp"
#include "tendril/reproduce/body.hpp"
#include "tendril/reproduce/helical_conduit_detail.hpp"

namespace tendril::reproduce::conduit {
namespace {

using drawing::Curve;
using drawing::Panel;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double reaction(const Step& s, bool of_line) {
  if (s.contacts.empty() || s.contacts.front().line != of_line) return kNaN;
  return of_line ? s.contacts.front().force_start.value_or(kNaN) : s.contacts.front().force;
}

double contact_length(const Step& s) {
  double sum = 0;
  for (const Contact& c : s.contacts) sum += c.s_end - c.s_start;
  return sum;
}

using Quantity = std::function<double(const Step&, const Middle&)>;

Curve curve_of(const Course& course, double unit, const Quantity& quantity, const std::string& label, int colour,
               drawing::Line line = drawing::Line::solid) {
  Curve c;
  c.label = label;
  c.colour = colour;
  c.line = line;
  for (std::size_t i = 0; i < course.step.size(); ++i) {
    c.x.push_back(*course.step[i]->parameter / unit);
    c.y.push_back(quantity(*course.step[i], course.middle[i]));
  }
  return c;
}

Curve marks(std::vector<double> x, std::vector<double> y, drawing::Mark mark, int colour, const std::string& label) {
  Curve c;
  c.x = std::move(x);
  c.y = std::move(y);
  c.line = drawing::Line::none;
  c.mark = mark;
  c.mark_size = 7;
  c.colour = colour;
  c.label = label;
  return c;
}

Panel panel_of(const std::string& title, const std::string& x, const std::string& y) {
  Panel p;
  p.title = title;
  p.x_label = x;
  p.y_label = y;
  return p;
}

constexpr const char* kLoad = "end force T/|T_0| [-]";

/// A curve reaches out to the events themselves.
void insert(Curve& c, double x, double y) {
  const auto at = std::lower_bound(c.x.begin(), c.x.end(), x) - c.x.begin();
  c.x.insert(c.x.begin() + at, x);
  c.y.insert(c.y.begin() + at, y);
}

Panel response_panel(const std::string& title, const std::string& y, const std::vector<Course>& courses, double unit,
                     const Quantity& quantity, const std::vector<Marked>& events,
                     const std::function<double(const Marked&)>& first,
                     const std::function<double(const Marked&)>& line, bool named) {
  Panel p = panel_of(title, kLoad, y);
  for (std::size_t i = 0; i < courses.size(); ++i) {
    p.curves.push_back(
        curve_of(courses[i], unit, quantity, named ? (i == 0 ? "ε/L = 1/40" : "ε/L = 1/20") : "", static_cast<int>(i)));
  }
  for (const Marked& e : events) {
    const bool legend = named && &e == &events.front();
    if (first)
      p.curves.push_back(marks({e.first}, {first(e)}, drawing::Mark::circle, e.colour, legend ? "first contact" : ""));
    p.curves.push_back(marks({e.line}, {line(e)}, drawing::Mark::square, e.colour, legend ? "point to line" : ""));
  }
  return p;
}

/// A course with a break where the point becomes a line: the force halves there.
Panel reaction_panel(const std::string& title, const std::vector<Course>& courses, double unit,
                     const std::vector<Marked>& events) {
  Panel p = panel_of(title, kLoad, "reaction [B/L²]");
  for (std::size_t i = 0; i < courses.size(); ++i) {
    const int colour = static_cast<int>(i);
    Curve point = curve_of(
        courses[i], unit, [](const Step& s, const Middle&) { return reaction(s, false); }, "", colour);
    Curve line = curve_of(
        courses[i], unit, [](const Step& s, const Middle&) { return reaction(s, true); }, "", colour,
        drawing::Line::dashed);
    for (const Marked& e : events) {
      if (e.colour != colour) continue;
      insert(point, e.first, 0.0);
      insert(point, e.line, e.reaction);
      insert(line, e.line, e.reaction / 2);
    }
    if (i == 0) {
      point.label = "R of the point";
      line.label = "R_l = R_r at the ends of the line";
    }
    p.curves.push_back(point);
    p.curves.push_back(line);
  }
  for (const Marked& e : events) {
    p.curves.push_back(marks({e.first}, {0}, drawing::Mark::circle, e.colour, ""));
    p.curves.push_back(marks({e.line, e.line}, {e.reaction, e.reaction / 2}, drawing::Mark::square, e.colour, ""));
  }
  return p;
}

}  // namespace

Course joined(const Branch& compression, const Branch& tension) {
  Course c;
  c.clearance = compression.clearance;
  for (std::size_t i = compression.result.steps.size(); i-- > 0;) {
    c.step.push_back(&compression.result.steps[i]);
    c.middle.push_back(compression.middle[i]);
  }
  for (std::size_t i = 0; i < tension.result.steps.size(); ++i) {
    c.step.push_back(&tension.result.steps[i]);
    c.middle.push_back(tension.middle[i]);
  }
  return c;
}

Data course_data(const std::string& name, const Course& course, double unit) {
  Data d{name,
         {"T/|T0| [-]", "rod length l/L [-]", "delta1(1/2) [L]", "kappa(1/2)/K [-]", "contacts",
          "R of the point [B/L^2]", "R_l of the line [B/L^2]", "contact length L_c/L [-]",
          "pressure in the middle of the contact [B/L^3]", "stable (1) or not (0)"},
         std::vector<std::vector<double>>(10)};
  const double K = Conduit{}.shape.curvature();
  for (std::size_t i = 0; i < course.step.size(); ++i) {
    const Step& s = *course.step[i];
    const double row[] = {*s.parameter / unit,
                          s.rod_length,
                          course.middle[i].delta_1,
                          course.middle[i].curvature / K,
                          static_cast<double>(s.contacts.size()),
                          reaction(s, false),
                          reaction(s, true),
                          contact_length(s),
                          s.contacts.size() == 1 && s.contacts[0].line ? s.contacts[0].pressure_mid : kNaN,
                          s.stability == "stable" ? 1.0 : 0.0};
    for (std::size_t k = 0; k < 10; ++k) d.value[k].push_back(row[k]);
  }
  return d;
}

Picture early_picture(const Conduit& conduit, const std::vector<Course>& courses, const std::vector<Marked>& events) {
  const double K = conduit.shape.curvature();
  const auto length = [](const Step& s, const Middle&) { return s.rod_length; };
  Picture early{
      "fig_II_3_2",
      "Fig. II.3.2 (b-e): eccentricity and curvature in the middle, reaction and unstretched length against the "
      "end force, M3 = -1, T0 = -7.069 B/L². Circles: the contact appears; squares: the point becomes a line. "
      "Compression (left) brings the rod to the outer side of the bend, tension (right) to the inner one.",
      {}};
  early.figure.panels = {
      response_panel(
          "(b) eccentricity in the middle", "δ_1(½) [L]", courses, conduit.unit,
          [](const Step&, const Middle& m) { return m.delta_1; }, events,
          [](const Marked& e) { return e.side * e.clearance; }, [](const Marked& e) { return e.side * e.clearance; },
          true),
      reaction_panel("(c) reaction", courses, conduit.unit, events),
      response_panel(
          "(d) unstretched length", "ℓ/L [-]", courses, conduit.unit, length, events,
          [](const Marked& e) { return e.first_length; }, [](const Marked& e) { return e.line_length; }, false),
      response_panel(
          "(e) curvature in the middle", "κ/K [-]", courses, conduit.unit,
          [K](const Step&, const Middle& m) { return m.curvature / K; }, events,
          [K](const Marked& e) { return e.first_curvature / K; }, [K](const Marked& e) { return e.curvature / K; },
          false)};
  for (Panel& p : early.figure.panels) p.x_range = {{-3.5, 4.0}};
  return early;
}

Picture late_picture(const Conduit& conduit, const std::vector<Course>& courses, const std::vector<Marked>& events) {
  const auto length = [](const Step& s, const Middle&) { return s.rod_length; };
  Picture late{"fig_IV_2_1",
               "Fig. IV.2.1: unstretched length, reactions and contact length (along the unstretched rod, all contacts "
               "together) over all loads. At -24.365 |T0| the middle of the line leaves the wall of the wider conduit.",
               {}};
  late.figure.columns = 3;
  late.figure.panel_width = 400;
  late.figure.panel_height = 330;
  late.figure.panels = {
      response_panel(
          "(a) unstretched length", "ℓ/L [-]", courses, conduit.unit, length, events,
          [](const Marked& e) { return e.first_length; }, [](const Marked& e) { return e.line_length; }, true),
      reaction_panel("(b) reactions", courses, conduit.unit, events),
      response_panel(
          "(c) contact length", "L_c/L [-]", courses, conduit.unit,
          [](const Step& s, const Middle&) { return contact_length(s); }, events, nullptr,
          [](const Marked&) { return 0.0; }, false)};
  return late;
}

Picture body_picture(const Conduit& conduit, const std::string& name, const std::string& caption,
                     const std::vector<std::pair<const Branch*, double>>& states) {
  Picture picture{name, caption, {}};
  picture.figure.columns = 2;
  picture.figure.panel_width = 400;
  picture.figure.panel_height = 430;
  const drawing::View view{0.8, 0.2};
  double largest = 0;
  for (const auto& [branch, load] : states) {
    for (const Contact& c : branch->at(load, conduit.unit).contacts) {
      largest = std::max({largest, c.force_start.value_or(0), c.force_end.value_or(0)});
    }
  }
  for (const auto& [branch, load] : states) {
    const Step& step = branch->at(load, conduit.unit);
    const Problem problem = conduit.problem(branch->clearance, *step.parameter);
    Chain chain = conduit.state(branch->clearance, step);
    const Step drawn = continuation::describe(chain, 801);
    char text[64];
    std::snprintf(text, sizeof text, "T = %s%.4g |T_0|, ε/L = 1/%.0f", load < 0 ? "\u2212" : "", std::abs(load),
                  1 / branch->clearance);
    Panel panel = body_panel(text);
    add_tube(panel, view, problem.tube, 1.0);
    add_rod(panel, view, drawn.fields, 1e-9);
    for (const Contact& c : drawn.contacts) {
      for (const bool end : {false, true}) {
        const double force = (end ? c.force_end : c.force_start).value_or(0);
        const geometry::AxisPoint axis = problem.tube.axis->at(end ? c.end : c.start);
        const double angle = end ? c.angle_end : c.angle_start;
        const Eigen::Vector3d outward = std::cos(angle) * axis.frame.col(0) + std::sin(angle) * axis.frame.col(1);
        if (force < 0.05 * largest) continue;  // too short an arrow to be seen
        std::snprintf(text, sizeof text, "%.2f B/L²", force);
        // The wall pushes inwards.
        add_arrow(panel, view, axis.position + branch->clearance * outward, -0.14 * force / largest * outward, text);
      }
    }
    picture.figure.panels.push_back(panel);
  }
  return picture;
}

Picture free_picture(const continuation::Fields& f) {
  Picture picture{
      "fig_II_3_3",
      "Fig. II.3.3, the exact Eulerian solution: deflection, internal force and moment at T = -1.25 |T0|, "
      "M3 = -1, before contact. Components in the intermediate frame k1, k2, k3 = d3; those in the directors, with the "
      "Lagrangian solution and the small inclination, are in the system `lagrangian`.",
      {}};
  picture.figure.columns = 3;
  picture.figure.panel_width = 360;
  const auto add = [&](Panel& p, const std::vector<double>& y, const std::string& label) {
    Curve c;
    c.x = f.S;
    c.y = y;
    c.label = label;
    p.curves.push_back(c);
  };
  Panel delta = panel_of("eccentricity", "ξ = S/L [-]", "δ [L]"),
        force = panel_of("internal force", "ξ = S/L [-]", "F [B/L²]"),
        moment = panel_of("internal moment", "ξ = S/L [-]", "M [B/L]");
  add(delta, f.delta1, "δ_1");
  add(delta, f.delta2, "δ_2");
  add(force, f.F1, "F_1");
  add(force, f.F2, "F_2");
  add(force, f.F3, "F_3");
  add(moment, f.M1, "M_1");
  add(moment, f.M2, "M_2");
  add(moment, f.M3, "M_3");
  picture.figure.panels = {delta, force, moment};
  return picture;
}

}  // namespace tendril::reproduce::conduit

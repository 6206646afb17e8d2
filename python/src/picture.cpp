// A step as a compact picture for where the page of the result cannot be shown: the rod in its tube in an orthographic
// view, and what is along it. Draws the fields as they are.

#include <algorithm>
#include <cmath>
#include <utility>

#include "bindings.hpp"
#include "tendril/drawing/figure.hpp"
#include "tendril/io/result_files.hpp"

namespace tendril::python {
namespace {

using continuation::Step;
using drawing::Curve;
using drawing::Panel;

constexpr int kRod = 0, kContact = 1, kGround = 7;  // of the palette

struct Point {
  double right, up;
};

Point seen(const geometry::Vec3& p) {
  const auto q = drawing::project({}, {p[0], p[1], p[2]});
  return {q[0], q[1]};
}

/// The silhouette of the tube in which the centreline moves: its axis, the clearance to both sides of the view.
Curve silhouette(const geometry::Tube& tube, int places) {
  std::vector<Point> left, right;
  for (int i = 0; i < places; ++i) {
    const double S = tube.length() * i / (places - 1);
    const geometry::AxisPoint at = tube.axis->at(S);
    const Point p = seen(at.position), t = seen(at.frame.col(2));
    const double length = std::hypot(t.right, t.up), Q = tube.clearance->at(S)[0];
    if (!(length > 1e-6)) continue;  // looking along the tube
    left.push_back({p.right - Q * t.up / length, p.up + Q * t.right / length});
    right.push_back({p.right + Q * t.up / length, p.up - Q * t.right / length});
  }
  Curve curve;
  curve.colour = kGround, curve.opacity = 0.25, curve.filled = true, curve.line = drawing::Line::none;
  left.insert(left.end(), right.rbegin(), right.rend());
  for (const Point& p : left) curve.x.push_back(p.right), curve.y.push_back(p.up);
  return curve;
}

/// The fields' y (projected or a column) over the contacts, broken between them.
template <class X, class Y>
Curve at_contacts(const Step& step, const X& x, const Y& y) {
  Curve curve;
  curve.colour = kContact, curve.width = 4.0;
  for (const continuation::Contact& k : step.contacts) {
    const double end = k.line ? k.end : k.start;
    for (std::size_t i = 0; i < step.fields.S.size(); ++i) {
      if (step.fields.S[i] < k.start || step.fields.S[i] > end) continue;
      curve.x.push_back(x(i)), curve.y.push_back(y(i));
    }
    if (!k.line) curve.mark = drawing::Mark::circle;
    curve.x.push_back(NAN), curve.y.push_back(NAN);
  }
  return curve;
}

}  // namespace

std::string picture(const Solved& solved, std::size_t index) {
  const io::Case& c = solved.of->c;
  const Step& step = solved.result.steps.at(index);
  const continuation::Fields& f = step.fields;
  drawing::Figure figure;
  figure.title = c.title;
  figure.panel_width = 380.0, figure.panel_height = 240.0;

  Panel view;
  view.title = "rod in its tube";
  view.equal_scale = true, view.axes = false;
  view.curves.push_back(silhouette(c.tube, 401));
  const auto point = [&](std::size_t i) { return seen({f.x[i], f.y[i], f.z[i]}); };
  Curve rod;
  rod.colour = kRod, rod.width = 2.0;
  for (std::size_t i = 0; i < f.S.size(); ++i) rod.x.push_back(point(i).right), rod.y.push_back(point(i).up);
  view.curves.push_back(rod);
  view.curves.push_back(at_contacts(
      step, [&](std::size_t i) { return point(i).right; }, [&](std::size_t i) { return point(i).up; }));
  figure.panels.push_back(view);

  const auto label = [&](const std::string& name, io::Dimension dimension) {
    return c.si ? name + " [" + std::string(io::si_unit(dimension)) + "]" : name;
  };
  bool line = false;
  for (const continuation::Contact& k : step.contacts) line = line || k.line;
  for (const auto& [name, title] : {std::pair<std::string, const char*>{"gap", "gap to the wall"},
                                    {line ? "pressure" : "kappa", line ? "pressure of the wall" : "curvature"},
                                    {"F3", "axial force, tension positive"}}) {
    const auto columns = io::field_columns();
    const auto column = std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return c.name == name; });
    const std::vector<double>& values = f.*(column->values);
    Panel panel;
    panel.title = title;
    panel.x_label = label("S", io::Dimension::length), panel.y_label = label(name, column->dimension);
    Curve curve;
    curve.x = f.S, curve.y = values, curve.colour = kRod;
    panel.curves.push_back(curve);
    if (name != "pressure")  // which shows its contacts itself
      panel.curves.push_back(at_contacts(
          step, [&](std::size_t i) { return f.S[i]; }, [&](std::size_t i) { return values[i]; }));
    figure.panels.push_back(panel);
  }
  return drawing::render_svg(figure);
}

}  // namespace tendril::python

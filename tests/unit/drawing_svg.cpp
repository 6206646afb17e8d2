// Pictures: well-formed XML with every label, all data inside its frame, nothing outside the page, no legend on data,
// the same bytes every time.

#include <gtest/gtest.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <cmath>
#include <limits>
#include <sstream>

#include "tendril/drawing/figure.hpp"
#include "tendril/drawing/text.hpp"

namespace tendril::drawing {
namespace {

using Tree = boost::property_tree::ptree;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kWritten = 0.016;  // written with two decimals, and a frame's far side is a sum of two [px]

Curve wave(double amplitude, double phase, const std::string& label) {
  Curve c;
  c.label = label;
  for (int i = 0; i <= 400; ++i) {
    c.x.push_back(0.025 * i);
    c.y.push_back(amplitude * std::sin(0.025 * i + phase));
  }
  return c;
}

Panel labelled(const std::string& title, const std::string& x, const std::string& y) {
  Panel panel;
  panel.title = title;
  panel.x_label = x;
  panel.y_label = y;
  return panel;
}

Figure sample() {
  Figure figure;
  figure.title = "Forces & moments <of a rod>";
  Panel plain = labelled("(a) waves", "T/|T_0| [-]", "R [B/L²]");
  for (int k = 0; k < 4; ++k) plain.curves.push_back(wave(30, 0.4 * k, "case " + std::to_string(k)));
  plain.curves[1].line = Line::dashed;
  plain.curves[2].mark = Mark::square;
  plain.words = {{10, 0, "end of the path"}, {0, 30, "start"}};
  Panel zoomed = plain;
  zoomed.title = "(b) part of it";
  zoomed.x_range = {{2.0, 5.0}};
  zoomed.y_range = {{-10.0, 10.0}};
  Panel logarithmic = labelled("(c) convergence", "pieces", "error [-]");
  logarithmic.x_log = logarithmic.y_log = true;
  Curve errors;
  errors.label = "k = 4";
  errors.mark = Mark::circle;
  errors.x = {0, 2, 4, 8, 16};
  errors.y = {1, 1e-2, 1e-5, kNaN, 1e-11};
  logarithmic.curves = {errors};
  Panel valued = labelled("(d) pressure", "x [L]", "y [L]");
  valued.curves = {wave(1, 0, "")};
  valued.equal_scale = true;
  zoomed.words.push_back({3.0, 1.0, "seen"});
  valued.value_label = "p [B/L³]";
  for (const double x : valued.curves[0].x) valued.curves[0].value.push_back(100 * std::cos(x));
  figure.panels = {plain, zoomed, logarithmic, valued};
  return figure;
}

Tree parsed(const std::string& svg) {
  std::istringstream in(svg);
  Tree tree;
  boost::property_tree::read_xml(in, tree);
  return tree;
}

template <class Visit>
void each(const Tree& tree, const std::string& name, const Visit& visit) {
  for (const auto& [key, child] : tree) {
    if (key == name) visit(child);
    each(child, name, visit);
  }
}

std::string all_text(const Tree& tree) {
  std::string out = tree.data();
  for (const auto& [key, child] : tree) {
    if (key != "<xmlattr>") out += all_text(child);
  }
  return out;
}

double number(const Tree& element, const std::string& attribute) {
  return element.get<double>("<xmlattr>." + attribute);
}
std::string word(const Tree& element, const std::string& attribute) {
  return element.get<std::string>("<xmlattr>." + attribute, "");
}

std::vector<std::array<double, 2>> vertices(const std::string& d) {
  std::vector<std::array<double, 2>> list;
  std::string numbers = d;
  for (char& c : numbers) {
    if (c == 'M' || c == 'L' || c == 'Z' || c == ',') c = ' ';
  }
  std::istringstream in(numbers);
  for (double x, y; in >> x >> y;) list.push_back({x, y});
  return list;
}

struct Rect {
  double left, top, right, bottom;
  bool holds(double x, double y, double slack) const {
    return x >= left - slack && x <= right + slack && y >= top - slack && y <= bottom + slack;
  }
};

struct DrawnPanel {
  Rect frame{};
  std::vector<std::array<double, 2>> data;
  std::vector<Rect> legend;
};

std::vector<DrawnPanel> panels(const Tree& svg) {
  std::vector<DrawnPanel> list;
  each(svg, "g", [&](const Tree& group) {
    if (word(group, "class") != "panel") return;
    DrawnPanel panel;
    each(group, "rect", [&](const Tree& r) {
      if (word(r, "class") == "frame") {
        panel.frame = {number(r, "x"), number(r, "y"), number(r, "x") + number(r, "width"),
                       number(r, "y") + number(r, "height")};
      }
    });
    each(group, "g", [&](const Tree& inner) {
      if (word(inner, "class") == "data") {
        each(inner, "path", [&](const Tree& path) {
          for (const auto& p : vertices(word(path, "d"))) panel.data.push_back(p);
        });
        each(inner, "circle", [&](const Tree& c) { panel.data.push_back({number(c, "cx"), number(c, "cy")}); });
      } else if (word(inner, "class") == "legend") {
        each(inner, "text", [&](const Tree& t) {
          const double x = number(t, "x"), y = number(t, "y");
          panel.legend.push_back({x - 32, y - 12, x + text_width(all_text(t), number(t, "font-size")), y + 4});
        });
      }
    });
    list.push_back(panel);
  });
  return list;
}

TEST(Svg, HoldsEveryLabelAsText) {
  const Tree svg = parsed(render_svg(sample())).get_child("svg");
  std::string text;
  each(svg, "text", [&](const Tree& t) { text += all_text(t) + "\n"; });
  for (const char* label : {"Forces & moments <of a rod>", "(a) waves", "T/|T0| [-]", "R [B/L²]", "case 0", "case 3",
                            "end of the path", "seen", "error [-]", "k = 4", "p [B/L³]", "x [L]", "\u221220"}) {
    EXPECT_NE(text.find(label), std::string::npos) << label << "\n" << text;
  }
  // Once: in panel (b) its place lies beyond the range.
  EXPECT_EQ(text.find("start"), text.rfind("start"));
  EXPECT_EQ(svg.get<std::string>("title"), "Forces & moments <of a rod>");
  EXPECT_NE(svg.get<std::string>("desc").find("R [B/L²] against T/|T0|"), std::string::npos);
}

TEST(Svg, DrawsAllDataInsideTheFrames) {
  const auto drawn = panels(parsed(render_svg(sample())).get_child("svg"));
  ASSERT_EQ(drawn.size(), 4u);
  for (const DrawnPanel& panel : drawn) {
    ASSERT_GT(panel.data.size(), 2u);
    for (const auto& [x, y] : panel.data) EXPECT_TRUE(panel.frame.holds(x, y, kWritten)) << x << " " << y;
  }
  // Not numbers and what has no logarithm break the line: of five points three carry marks, two are joined.
  EXPECT_EQ(drawn[2].data.size(), 5u);
}

TEST(Svg, KeepsTextOnThePage) {
  const Tree svg = parsed(render_svg(sample())).get_child("svg");
  const double width = number(svg, "width"), height = number(svg, "height");
  each(svg, "text", [&](const Tree& t) {
    const double length = text_width(all_text(t), number(t, "font-size"));
    const std::string anchor = word(t, "text-anchor");
    const double back = anchor == "end" ? length : anchor == "middle" ? length / 2 : 0;
    const bool turned = !word(t, "transform").empty();
    const double at = turned ? number(t, "y") : number(t, "x"), other = turned ? number(t, "x") : number(t, "y");
    const double limit = turned ? height : width;
    EXPECT_GE(at - back, 0) << all_text(t);
    EXPECT_LE(at - back + length, limit) << all_text(t);
    EXPECT_GE(other, 10) << all_text(t);
    EXPECT_LE(other, (turned ? width : height) - 2) << all_text(t);
  });
}

TEST(Svg, PutsNoLegendOnData) {
  for (const DrawnPanel& panel : panels(parsed(render_svg(sample())).get_child("svg"))) {
    for (const Rect& entry : panel.legend) {
      for (const auto& [x, y] : panel.data) EXPECT_FALSE(entry.holds(x, y, 0)) << x << " " << y;
    }
  }
}

TEST(Svg, ScalesEqually) {
  // A circle stays one.
  Figure figure;
  Panel panel = labelled("", "x", "y");
  panel.equal_scale = true;
  Curve circle;
  for (int i = 0; i <= 360; ++i) {
    circle.x.push_back(3 + 2 * std::cos(i * M_PI / 180));
    circle.y.push_back(-1 + 2 * std::sin(i * M_PI / 180));
  }
  panel.curves = {circle};
  figure.panels = {panel};
  const auto drawn = panels(parsed(render_svg(figure)).get_child("svg"));
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
  for (const auto& [x, y] : drawn.at(0).data) {
    left = std::min(left, x), right = std::max(right, x);
    top = std::min(top, y), bottom = std::max(bottom, y);
  }
  EXPECT_NEAR(right - left, bottom - top, 2 * kWritten);
}

TEST(Svg, IsTheSameEveryTime) { EXPECT_EQ(render_svg(sample()), render_svg(sample())); }

TEST(Svg, FadesAColouredCurveAsOne) {
  // Faded part by part, the curve would show a dark dot wherever two parts overlap.
  Figure figure;
  figure.panels = {labelled("", "x", "y")};
  Curve faded = wave(1, 0, "");
  faded.opacity = 0.3;
  for (const double x : faded.x) faded.value.push_back(std::cos(x));
  figure.panels[0].curves = {faded};
  const std::string svg = render_svg(figure);
  EXPECT_EQ(svg.find("stroke-opacity"), std::string::npos);
  const auto group = svg.find("<g opacity=\"0.3");
  ASSERT_NE(group, std::string::npos);
  EXPECT_EQ(svg.find("<g opacity", group + 1), std::string::npos);
  EXPECT_NO_THROW(parsed(svg));
}

TEST(Svg, StandsEmptyFigures) {
  Figure figure;
  EXPECT_NO_THROW(parsed(render_svg(figure)));
  figure.panels.resize(1);
  figure.panels[0].curves.resize(1);
  figure.panels[0].curves[0].value = {kNaN};
  EXPECT_NO_THROW(parsed(render_svg(figure)));
}

TEST(View, LooksFromWhereItSays) {
  // From the x axis at the height of the plane: y to the right, z up, x towards the viewer.
  const auto p = project({0.0, 0.0}, {1, 2, 3});
  EXPECT_DOUBLE_EQ(p[0], 2);
  EXPECT_DOUBLE_EQ(p[1], 3);
  EXPECT_DOUBLE_EQ(p[2], 1);
  // From above: depth is z.
  EXPECT_NEAR(project({0.3, M_PI / 2}, {1, 2, 3})[2], 3, 1e-15);
}

}  // namespace
}  // namespace tendril::drawing

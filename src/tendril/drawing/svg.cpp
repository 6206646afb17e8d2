// Rendering. Room for ticks, labels and legends is measured first, so nothing is cut.
#include <algorithm>
#include <cmath>

#include "tendril/drawing/figure.hpp"
#include "tendril/drawing/layout.hpp"
#include "tendril/drawing/text.hpp"

namespace tendril::drawing {
namespace {

constexpr double kFigureTitle = 17;  // font size [px]
constexpr const char* kInk = "#222222";
constexpr const char* kFonts = "Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif";

std::string attribute(const char* name, double value) { return std::string(" ") + name + "=\"" + fixed(value) + "\""; }

std::string text_at(double x, double y, const std::string& text, double size, const char* anchor,
                    const std::string& more = "") {
  return "<text" + attribute("x", x) + attribute("y", y) + attribute("font-size", size) + " text-anchor=\"" + anchor +
         "\" xml:space=\"preserve\" fill=\"" + kInk + "\"" + more + ">" + text_spans(text, size) + "</text>\n";
}

std::string path_data(const std::vector<Point>& points) {
  std::string d;
  for (std::size_t i = 0; i < points.size(); ++i) {
    d += (i == 0 ? "M" : "L") + fixed(points[i][0]) + "," + fixed(points[i][1]);
  }
  return d;
}

std::string stroke(const Curve& curve, const std::string& colour) {
  std::string out = " fill=\"none\" stroke=\"" + colour + "\"" + attribute("stroke-width", curve.width) +
                    " stroke-linejoin=\"round\"";
  if (curve.line == Line::dashed) out += " stroke-dasharray=\"7 4\"";
  out += curve.line == Line::dotted  ? " stroke-dasharray=\"0.1 4\" stroke-linecap=\"round\""
         : curve.line == Line::solid ? " stroke-linecap=\"round\""
                                     : "";
  if (curve.opacity < 1) out += attribute("stroke-opacity", curve.opacity);
  return out;
}

std::string mark_at(const Curve& curve, const Point& p, const std::string& colour) {
  const double r = curve.mark_size / 2;
  const std::string paint = " fill=\"" + colour + "\" stroke=\"#ffffff\" stroke-width=\"0.8\"" +
                            (curve.opacity < 1 ? attribute("opacity", curve.opacity) : "") + "/>\n";
  if (curve.mark == Mark::circle) {
    return "<circle" + attribute("cx", p[0]) + attribute("cy", p[1]) + attribute("r", r) + paint;
  }
  if (curve.mark == Mark::square) {
    return "<rect" + attribute("x", p[0] - r) + attribute("y", p[1] - r) + attribute("width", 2 * r) +
           attribute("height", 2 * r) + paint;
  }
  return "<path d=\"" + path_data({{p[0] - r, p[1] - r}, {p[0] + r, p[1] + r}}) +
         path_data({{p[0] - r, p[1] + r}, {p[0] + r, p[1] - r}}) + "\" stroke=\"" + colour +
         "\" stroke-width=\"1.6\" fill=\"none\"/>\n";
}

std::string legend_entry(const Curve& c, const std::string& colour, double x, double y) {
  std::string out;
  const double middle = y - 4;
  if (c.filled) {
    out += "<rect" + attribute("x", x) + attribute("y", middle - 5) + attribute("width", kSample) +
           attribute("height", 10) + " fill=\"" + colour + "\"" + attribute("fill-opacity", c.opacity) + "/>\n";
  } else if (c.line != Line::none) {
    if (!c.value.empty()) {
      for (int k = 0; k < 5; ++k) {
        const double from = x + k * kSample / 5;
        out += "<path d=\"" + path_data({{from, middle}, {from + kSample / 5, middle}}) + "\" stroke=\"" +
               diverging_colour(-1 + 0.5 * k) + "\"" + attribute("stroke-width", c.width) + "/>\n";
      }
    } else {
      out += "<path d=\"" + path_data({{x, middle}, {x + kSample, middle}}) + "\"" + stroke(c, colour) + "/>\n";
    }
  }
  if (c.mark != Mark::none) out += mark_at(c, {x + kSample / 2, middle}, colour);
  return out + text_at(x + kSample + 6, y, c.label, kTick, "start");
}

std::string draw_legend(const Panel& panel, const Layout& l) {
  std::string out = "<g class=\"legend\">\n";
  if (l.legend_at) {
    double y = (*l.legend_at)[1] + 16;
    for (const std::size_t i : l.legend) {
      out += legend_entry(panel.curves[i], l.colour[i], (*l.legend_at)[0] + 8, y);
      y += kRow;
    }
  } else {
    double y = l.frame.bottom + l.bottom + 10;
    for (const auto& row : legend_rows(panel, l)) {
      double x = l.frame.left;
      for (const std::size_t i : row) {
        out += legend_entry(panel.curves[i], l.colour[i], x, y);
        x += legend_entry_width(panel.curves[i]) + 18;
      }
      y += kRow;
    }
  }
  return out + "</g>\n";
}

std::string draw_axes(const Layout& l) {
  const Box& f = l.frame;
  std::string grid, marks, words;
  const auto line = [](double x0, double y0, double x1, double y1) {
    return "M" + fixed(x0) + "," + fixed(y0) + "L" + fixed(x1) + "," + fixed(y1);
  };
  for (const Tick& t : l.x_ticks) {
    const double x = on_paper(l, t.value, l.y.from)[0];
    if (x < f.left - 0.5 || x > f.right + 0.5) continue;
    if (!t.label.empty()) grid += line(x, f.top, x, f.bottom);
    marks += line(x, f.bottom, x, f.bottom - (t.label.empty() ? 3 : 5));
    if (!t.label.empty()) words += text_at(x, f.bottom + 17, t.label, kTick, "middle");
  }
  for (const Tick& t : l.y_ticks) {
    const double y = on_paper(l, l.x.from, t.value)[1];
    if (y < f.top - 0.5 || y > f.bottom + 0.5) continue;
    if (!t.label.empty()) grid += line(f.left, y, f.right, y);
    marks += line(f.left, y, f.left + (t.label.empty() ? 3 : 5), y);
    if (!t.label.empty()) words += text_at(f.left - 7, y + 4, t.label, kTick, "end");
  }
  double y = f.bottom + 38;
  for (const std::string& text : l.x_label) {
    words += text_at((f.left + f.right) / 2, y, text, kLabel, "middle");
    y += kRow;
  }
  double x = f.left - 14 - widest(l.y_ticks) - kRow * (static_cast<double>(l.y_label.size()) - 1);
  const double middle = (f.top + f.bottom) / 2;
  for (const std::string& text : l.y_label) {
    words +=
        text_at(x, middle, text, kLabel, "middle", " transform=\"rotate(-90 " + fixed(x) + " " + fixed(middle) + ")\"");
    x += kRow;
  }
  return "<path d=\"" + grid + "\" stroke=\"#e4e4e4\" stroke-width=\"0.8\" fill=\"none\"/>\n<path d=\"" + marks +
         "\" stroke=\"" + kInk + "\" stroke-width=\"1\" fill=\"none\"/>\n" + words;
}

std::string draw_curve(const Curve& c, const Layout& l, std::size_t index) {
  constexpr double kTolerance = 0.04;  // [px]
  const std::string& colour = l.colour[index];
  const std::vector<Point>& line = l.line[index];
  std::string out;
  if (c.filled) {
    const std::vector<Point> area = clip_polygon(line, l.frame);
    if (!area.empty()) {
      out += "<path d=\"" + path_data(simplify(area, kTolerance)) + "Z\" fill=\"" + colour + "\"" +
             attribute("fill-opacity", c.opacity) + "/>\n";
    }
  } else if (c.line != Line::none && c.value.empty()) {
    std::string d;
    for (const Piece& piece : clip(line, l.frame)) d += path_data(simplify(piece.points, kTolerance));
    if (!d.empty()) out += "<path d=\"" + d + "\"" + stroke(c, colour) + "/>\n";
  } else if (c.line != Line::none) {
    constexpr int kShades = 40;  // on either side of zero
    // the parts overlap at their ends: they are faded as one
    Curve opaque = c;
    opaque.opacity = 1.0;
    if (c.opacity < 1.0) out += "<g" + attribute("opacity", c.opacity) + ">\n";
    for (const Piece& piece : clip(line, l.frame)) {
      const auto shade = [&](std::size_t k) {
        const std::size_t i = std::min(piece.first + k, c.value.size() - 1);
        const double mean = (c.value[i] + c.value[std::min(i + 1, c.value.size() - 1)]) / 2;
        return std::isfinite(mean) ? static_cast<int>(std::lround(kShades * mean / l.value_size)) : 0;
      };
      for (std::size_t k = 0; k + 1 < piece.points.size();) {
        std::size_t end = k + 1;
        while (end + 1 < piece.points.size() && shade(end) == shade(k)) ++end;
        const std::vector<Point> part(piece.points.begin() + static_cast<std::ptrdiff_t>(k),
                                      piece.points.begin() + static_cast<std::ptrdiff_t>(end) + 1);
        out += "<path d=\"" + path_data(simplify(part, kTolerance)) + "\"" +
               stroke(opaque, diverging_colour(static_cast<double>(shade(k)) / kShades)) + "/>\n";
        k = end;
      }
    }
    if (c.opacity < 1.0) out += "</g>\n";
  }
  if (c.mark == Mark::none) return out;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (!l.frame.holds(line[i])) continue;
    const bool valued = i < c.value.size() && std::isfinite(c.value[i]);
    out += mark_at(c, line[i], valued ? diverging_colour(c.value[i] / l.value_size) : colour);
  }
  return out;
}

std::string draw_colour_bar(const Panel& panel, const Layout& l) {
  const double x = l.frame.right + 14, height = l.frame.bottom - l.frame.top;
  std::string out = "<g class=\"colour-bar\" shape-rendering=\"crispEdges\">\n";
  constexpr int kParts = 60;
  for (int k = 0; k < kParts; ++k) {
    out += "<rect" + attribute("x", x) + attribute("y", l.frame.bottom - (k + 1) * height / kParts) +
           attribute("width", kBar) + attribute("height", height / kParts + 0.3) + " fill=\"" +
           diverging_colour(2 * (k + 0.5) / kParts - 1) + "\"/>\n";
  }
  out += "</g>\n";
  for (const Tick& t : l.value_ticks) {
    const double y = l.frame.bottom - (t.value / l.value_size + 1) / 2 * height;
    out += "<path d=\"" + path_data({{x + kBar, y}, {x + kBar + 4, y}}) + "\" stroke=\"" + kInk + "\"/>\n" +
           text_at(x + kBar + 7, y + 4, t.label, kTick, "start");
  }
  if (panel.value_label.empty()) return out;
  const double at = x + kBar + 7 + widest(l.value_ticks) + 16, middle = (l.frame.top + l.frame.bottom) / 2;
  return out + text_at(at, middle, panel.value_label, kLabel, "middle",
                       " transform=\"rotate(-90 " + fixed(at) + " " + fixed(middle) + ")\"");
}

std::string draw_panel(const Panel& panel, const Layout& l) {
  const Box& f = l.frame;
  std::string out = "<g class=\"panel\">\n";
  double y = f.top - 8 - 18 * (static_cast<double>(l.title.size()) - 1);
  for (const std::string& text : l.title) {
    out += text_at((f.left + f.right) / 2, y, text, kTitle, "middle", " font-weight=\"bold\"");
    y += 18;
  }
  if (panel.axes) out += draw_axes(l);
  out += "<g class=\"data\">\n";
  for (std::size_t i = 0; i < panel.curves.size(); ++i) out += draw_curve(panel.curves[i], l, i);
  out += "</g>\n";
  if (panel.axes) {
    out += "<rect class=\"frame\"" + attribute("x", f.left) + attribute("y", f.top) +
           attribute("width", f.right - f.left) + attribute("height", f.bottom - f.top) + " fill=\"none\" stroke=\"" +
           kInk + "\" stroke-width=\"1\"/>\n";
  }
  for (const PlacedWord& w : l.words) {
    out += text_at(w.x, w.y, w.word->text, kTick, w.right ? "start" : "end",
                   " stroke=\"#ffffff\" stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\"");
  }
  if (!l.legend.empty()) out += draw_legend(panel, l);
  if (l.value_size > 0) out += draw_colour_bar(panel, l);
  return out + "</g>\n";
}

std::string description(const Figure& figure) {
  std::string out;
  for (const Panel& panel : figure.panels) {
    out += out.empty() ? "" : " ";
    out += "Panel" + (panel.title.empty() ? "" : " " + plain_text(panel.title)) + ":";
    if (panel.axes) out += " " + plain_text(panel.y_label) + " against " + plain_text(panel.x_label) + ";";
    for (const Curve& c : panel.curves) out += c.label.empty() ? "" : " " + plain_text(c.label) + ",";
    out.back() = '.';
  }
  return out;
}

}  // namespace

std::string render_svg(const Figure& figure) {
  const std::size_t columns =
      std::max<std::size_t>(1, std::min(static_cast<std::size_t>(std::max(1, figure.columns)), figure.panels.size()));
  const std::size_t rows = (figure.panels.size() + columns - 1) / columns;
  const double width = static_cast<double>(columns) * figure.panel_width + 12;
  const std::vector<std::string> title = wrap_text(figure.title, kBold * kFigureTitle, width - 30);

  std::vector<Layout> layouts(figure.panels.size());
  std::vector<double> left(columns, 0.0);
  for (std::size_t i = 0; i < layouts.size(); ++i) {
    layouts[i] = measure(figure.panels[i], figure.panel_width - 80, figure.panel_height - 60);
    left[i % columns] = std::max(left[i % columns], layouts[i].left);
  }
  double y = 6 + 24 * static_cast<double>(title.size());
  for (std::size_t row = 0; row < rows; ++row) {
    double top = 0, extra = 0;
    for (std::size_t i = row * columns; i < std::min((row + 1) * columns, layouts.size()); ++i) {
      top = std::max(top, layouts[i].top);
    }
    for (std::size_t i = row * columns; i < std::min((row + 1) * columns, layouts.size()); ++i) {
      Layout& l = layouts[i];
      const double x = 6 + static_cast<double>(i % columns) * figure.panel_width;
      Box frame{x + left[i % columns], y + top, x + figure.panel_width - l.right, y + figure.panel_height - l.bottom};
      frame.right = std::max(frame.right, frame.left + 40);
      frame.bottom = std::max(frame.bottom, frame.top + 40);
      place(figure.panels[i], frame, l);
      if (legend_below(l))
        extra = std::max(extra, 8 + kRow * static_cast<double>(legend_rows(figure.panels[i], l).size()));
    }
    y += figure.panel_height + extra;
  }
  const double height = y + 6;

  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\"" + attribute("width", width) +
                    attribute("height", height) + " viewBox=\"0 0 " + fixed(width) + " " + fixed(height) +
                    "\" role=\"img\" font-family=\"" + kFonts + "\">\n";
  out += "<title>" + escape_xml(plain_text(figure.title)) + "</title>\n<desc>" + escape_xml(description(figure)) +
         "</desc>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  double baseline = 24;
  for (const std::string& text : title) {
    out += text_at(width / 2, baseline, text, kFigureTitle, "middle", " font-weight=\"bold\"");
    baseline += 24;
  }
  for (std::size_t i = 0; i < layouts.size(); ++i) out += draw_panel(figure.panels[i], layouts[i]);
  return out + "</svg>\n";
}

std::array<double, 3> project(const View& view, const std::array<double, 3>& p) {
  const double ca = std::cos(view.azimuth), sa = std::sin(view.azimuth);
  const double ce = std::cos(view.elevation), se = std::sin(view.elevation);
  const double towards = ca * p[0] + sa * p[1];  // horizontal part towards the viewer
  return {-sa * p[0] + ca * p[1], -se * towards + ce * p[2], ce * towards + se * p[2]};
}

}  // namespace tendril::drawing

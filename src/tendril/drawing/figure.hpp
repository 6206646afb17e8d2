#pragma once
// Pictures as plain data, and their rendering as SVG: panels with axes, curves, marks and words. Knows no mechanics.
// Everything drawn is vector graphics with text, deterministic to the byte. Legends stand where no data is, or below.

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace tendril::drawing {

enum class Line { solid, dashed, dotted, none };
enum class Mark { none, circle, square, cross };

struct Curve {
  std::vector<double> x, y;  // a NaN breaks the curve
  std::string label;         // in the legend; empty: none
  int colour = -1;           // of the palette; -1: the next one in turn
  Line line = Line::solid;
  Mark mark = Mark::none;
  double width = 1.6;         // [px]
  double opacity = 1.0;       // 0..1
  std::vector<double> value;  // one per vertex: colours the curve on a diverging scale, zero in the middle
  double mark_size = 6.0;     // [px]
  bool filled = false;        // the closed polygon is painted (with `opacity`) instead of its line
};

/// Text beside a place. In all texts `F_3`, `L_{c}`, `x^2` are set as subscripts and superscripts.
struct Word {
  double x = 0.0, y = 0.0;
  std::string text;
};

struct Panel {
  std::string title, x_label, y_label;  // labels with units, "F3 [B/L²]"
  std::vector<Curve> curves;
  std::vector<Word> words;
  std::optional<std::array<double, 2>> x_range, y_range;  // none: from the data
  bool x_log = false, y_log = false;
  bool equal_scale = false;  // one unit is as long in x as in y
  bool axes = true;          // false: no frame, ticks or labels (projected bodies)
  std::string value_label;   // of the colour bar, when a curve has values
};

struct Figure {
  std::string title;
  std::vector<Panel> panels;
  int columns = 2;
  double panel_width = 420.0, panel_height = 300.0;  // [px]
};

/// The figure as one SVG document (UTF-8, title and description inside for readers that cannot see it).
std::string render_svg(const Figure& figure);

/// Orthographic view of space: azimuth about z and elevation above the x-y plane [rad].
struct View {
  double azimuth = 0.6, elevation = 0.4;
};
/// Projected (right, up) and depth (towards the viewer) of a point.
std::array<double, 3> project(const View& view, const std::array<double, 3>& point);

}  // namespace tendril::drawing

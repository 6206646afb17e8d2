#pragma once
// One panel measured and placed: scales, ticks, the room around its frame, the curves on paper, words and legend where
// they hide nothing. Private to the renderer.

#include <optional>
#include <string>
#include <vector>

#include "tendril/drawing/figure.hpp"
#include "tendril/drawing/polyline.hpp"
#include "tendril/drawing/scale.hpp"

namespace tendril::drawing {

constexpr double kTick = 12, kLabel = 13, kTitle = 14;  // font sizes [px]
constexpr double kBold = 1.1;                           // bold letters are wider by this
constexpr double kRow = 17;                             // a line of a legend or label
constexpr double kSample = 26;                          // length of a legend's sample
constexpr double kBar = 12;                             // width of the colour bar

struct PlacedWord {
  double x = 0, y = 0;
  bool right = true;  // of its place
  const Word* word = nullptr;
};

struct Layout {
  Scale x, y;
  std::vector<Tick> x_ticks, y_ticks, value_ticks;
  std::vector<std::string> title, x_label, y_label;
  std::vector<std::string> colour;                  // of each curve
  double value_size = 0.0;                          // largest |value|, 0: no colour bar
  double left = 0, right = 0, top = 0, bottom = 0;  // margins around the frame
  Box frame;
  std::vector<std::vector<Point>> line;  // of each curve on paper, not cut
  std::vector<Point> data;               // what legends and words must not hide
  std::vector<std::size_t> legend;       // curves named in it
  std::optional<Point> legend_at;        // inside; none: below
  std::vector<PlacedWord> words;
};

/// Scales, ticks and margins, for a frame of about this size.
Layout measure(const Panel& panel, double width, double height);
/// Places everything inside `frame`.
void place(const Panel& panel, const Box& frame, Layout& layout);

Point on_paper(const Layout& layout, double x, double y);
double widest(const std::vector<Tick>& ticks);
double legend_entry_width(const Curve& curve);
/// Rows of entries that fit side by side below the frame.
std::vector<std::vector<std::size_t>> legend_rows(const Panel& panel, const Layout& layout);
bool legend_below(const Layout& layout);

}  // namespace tendril::drawing

#include "tendril/drawing/layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tendril/drawing/text.hpp"

namespace tendril::drawing {
namespace {

void choose_scales(const Panel& panel, Layout& l) {
  std::vector<double> xs, ys;
  for (const Curve& c : panel.curves) {
    for (std::size_t i = 0; i < std::min(c.x.size(), c.y.size()); ++i) {
      if (!std::isfinite(c.x[i]) || !std::isfinite(c.y[i])) continue;
      // With one range given, the other shows what lies inside it.
      const auto within = [](const std::optional<std::array<double, 2>>& range, double v) {
        return !range || (v >= std::min((*range)[0], (*range)[1]) && v <= std::max((*range)[0], (*range)[1]));
      };
      if (within(panel.x_range, c.x[i]) && within(panel.y_range, c.y[i])) {
        xs.push_back(c.x[i]);
        ys.push_back(c.y[i]);
      }
    }
    for (const double v : c.value) {
      if (std::isfinite(v)) l.value_size = std::max(l.value_size, std::abs(v));
    }
  }
  for (const Word& w : panel.words) {
    xs.push_back(w.x);
    ys.push_back(w.y);
  }
  l.x = panel.x_range ? Scale{(*panel.x_range)[0], (*panel.x_range)[1], panel.x_log} : scale_of(xs, panel.x_log);
  l.y = panel.y_range ? Scale{(*panel.y_range)[0], (*panel.y_range)[1], panel.y_log} : scale_of(ys, panel.y_log);
  if (l.value_size == 0.0 &&
      std::any_of(panel.curves.begin(), panel.curves.end(), [](const Curve& c) { return !c.value.empty(); })) {
    l.value_size = 1.0;
  }
}

void choose_colours(const Panel& panel, Layout& l) {
  int next = 0;
  for (const Curve& c : panel.curves) l.colour.push_back(palette(c.colour >= 0 ? c.colour : next++));
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    if (!panel.curves[i].label.empty()) l.legend.push_back(i);
  }
}

void widen_to_equal_scale(const Panel& panel, Layout& l) {
  if (!panel.equal_scale || panel.x_log || panel.y_log) return;
  const double width = l.frame.right - l.frame.left, height = l.frame.bottom - l.frame.top;
  const double unit = std::max(std::abs(l.x.to - l.x.from) / width, std::abs(l.y.to - l.y.from) / height);
  const auto widen = [&](Scale& s, double pixels) {
    const double centre = (s.from + s.to) / 2, half = (s.to > s.from ? 1 : -1) * unit * pixels / 2;
    s = {centre - half, centre + half, false};
  };
  widen(l.x, width);
  widen(l.y, height);
  if (!panel.axes) return;
  l.x_ticks = ticks(l.x, std::max(2, static_cast<int>(width / 75)));
  l.y_ticks = ticks(l.y, std::max(2, static_cast<int>(height / 48)));
}

// Curves on paper, and points on them close enough together that no box can slip between.
void put_on_paper(const Panel& panel, Layout& l) {
  l.line.clear();
  for (const Curve& c : panel.curves) {
    std::vector<Point> line;
    for (std::size_t i = 0; i < std::min(c.x.size(), c.y.size()); ++i) line.push_back(on_paper(l, c.x[i], c.y[i]));
    if (c.line != Line::none || c.filled) {
      for (const Piece& piece : clip(line, l.frame)) {
        for (std::size_t i = 0; i + 1 < piece.points.size(); ++i) {
          const Point &a = piece.points[i], &b = piece.points[i + 1];
          const int parts = 1 + static_cast<int>(std::hypot(b[0] - a[0], b[1] - a[1]) / 4);
          for (int k = 0; k < parts; ++k) {
            const double t = static_cast<double>(k) / parts;
            l.data.push_back({a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])});
          }
        }
        if (!piece.points.empty()) l.data.push_back(piece.points.back());
      }
    } else if (c.mark != Mark::none) {
      for (const Point& p : line) {
        if (l.frame.holds(p)) l.data.push_back(p);
      }
    }
    l.line.push_back(std::move(line));
  }
}

std::size_t hidden(const std::vector<Point>& data, const Box& box) {
  return static_cast<std::size_t>(
      std::count_if(data.begin(), data.end(), [&](const Point& p) { return box.holds(p); }));
}

// Each word where it hides least: right above its place, or in one of the other three quarters.
void place_words(const Panel& panel, Layout& l) {
  std::vector<Box> boxes;
  for (const Word& w : panel.words) {
    const Point p = on_paper(l, w.x, w.y);
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !l.frame.holds(p)) continue;
    const double width = text_width(w.text, kTick);
    std::size_t best = 0;
    PlacedWord choice;
    Box chosen;
    bool first = true;
    for (int quarter = 0; quarter < 4; ++quarter) {
      const bool right = quarter % 2 == 0, above = quarter < 2;
      const double x = p[0] + (right ? 6 : -6), y = p[1] + (above ? -6 : 15);
      const Box box{right ? x : x - width, y - 10, right ? x + width : x, y + 3};
      std::size_t cost = hidden(l.data, box);
      if (box.left < l.frame.left || box.right > l.frame.right || box.top < l.frame.top || box.bottom > l.frame.bottom)
        cost += 10000;
      for (const Box& other : boxes) cost += box.meets(other) ? 1000 : 0;
      if (!first && cost >= best) continue;
      best = cost;
      first = false;
      choice = {x, y, right, &w};
      chosen = box;
    }
    l.words.push_back(choice);
    boxes.push_back(chosen);
  }
  for (const Box& box : boxes) {  // a legend must not hide them either
    for (double x = box.left; x <= box.right; x += 4) {
      l.data.push_back({x, box.top});
      l.data.push_back({x, box.bottom});
    }
  }
}

void place_legend(const Panel& panel, Layout& l) {
  if (l.legend.empty()) return;
  double width = 0;
  for (const std::size_t i : l.legend) width = std::max(width, legend_entry_width(panel.curves[i]));
  const double w = width + 16, h = kRow * static_cast<double>(l.legend.size()) + 8;
  const double frame_width = l.frame.right - l.frame.left, frame_height = l.frame.bottom - l.frame.top;
  if (w > 0.7 * frame_width || h > 0.7 * frame_height) return;
  constexpr double kInset = 8, kClear = 5;
  // Corners first, then the rest of a grid.
  static const std::array<double, 5> part = {1.0, 0.0, 0.5, 0.75, 0.25};
  for (const std::size_t level : {2u, 3u, 5u}) {
    for (std::size_t j = 0; j < level; ++j) {
      for (std::size_t i = 0; i < level; ++i) {
        const double left = l.frame.left + kInset + part[i] * (frame_width - w - 2 * kInset);
        const double top = l.frame.top + kInset + (1 - part[j]) * (frame_height - h - 2 * kInset);
        if (hidden(l.data, {left - kClear, top - kClear, left + w + kClear, top + h + kClear}) == 0) {
          l.legend_at = Point{left, top};
          return;
        }
      }
    }
  }
}

}  // namespace

double legend_entry_width(const Curve& c) { return kSample + 6 + text_width(c.label, kTick); }

bool legend_below(const Layout& l) { return !l.legend.empty() && !l.legend_at; }

std::vector<std::vector<std::size_t>> legend_rows(const Panel& panel, const Layout& l) {
  std::vector<std::vector<std::size_t>> rows;
  double used = 0;
  for (const std::size_t i : l.legend) {
    const double width = legend_entry_width(panel.curves[i]) + 18;
    if (rows.empty() || used + width > l.frame.right - l.frame.left + 30) {
      rows.emplace_back();
      used = 0;
    }
    rows.back().push_back(i);
    used += width;
  }
  return rows;
}

double widest(const std::vector<Tick>& ticks) {
  double width = 0;
  for (const Tick& t : ticks) width = std::max(width, text_width(t.label, kTick));
  return width;
}

Point on_paper(const Layout& l, double x, double y) {
  return {l.frame.left + l.x(x) * (l.frame.right - l.frame.left),
          l.frame.bottom - l.y(y) * (l.frame.bottom - l.frame.top)};
}

Layout measure(const Panel& panel, double width, double height) {
  Layout l;
  choose_scales(panel, l);
  choose_colours(panel, l);
  l.title = wrap_text(panel.title, kBold * kTitle, width);
  l.top = 10 + (l.title.empty() ? 0 : 4 + 18 * static_cast<double>(l.title.size()));
  l.left = l.right = l.bottom = 12;
  if (panel.axes) {
    l.y_ticks = ticks(l.y, std::max(2, static_cast<int>(height / 48)));
    l.x_ticks = ticks(l.x, std::max(2, static_cast<int>(width / 75)));
    // Labels must not run into each other.
    for (int n = static_cast<int>(width / 75); n > 1 && widest(l.x_ticks) * 1.25 * (n + 1) > width; --n) {
      l.x_ticks = ticks(l.x, n);
    }
    l.x_label = wrap_text(panel.x_label, kLabel, width - 80);
    l.y_label = wrap_text(panel.y_label, kLabel, height - 40);
    l.left = 14 + widest(l.y_ticks) + (l.y_label.empty() ? 0 : 8 + kRow * static_cast<double>(l.y_label.size()));
    l.bottom = 24 + (l.x_label.empty() ? 0 : 4 + kRow * static_cast<double>(l.x_label.size()));
    l.right = 16 + widest(l.x_ticks) / 2;
  }
  if (l.value_size > 0) {
    l.value_ticks = ticks({-l.value_size, l.value_size, false}, 5);
    l.right = std::max(l.right, 12.0) + kBar + 8 + widest(l.value_ticks) + (panel.value_label.empty() ? 6 : 26);
  }
  return l;
}

void place(const Panel& panel, const Box& frame, Layout& l) {
  l.frame = frame;
  widen_to_equal_scale(panel, l);
  put_on_paper(panel, l);
  place_words(panel, l);
  place_legend(panel, l);
}

}  // namespace tendril::drawing

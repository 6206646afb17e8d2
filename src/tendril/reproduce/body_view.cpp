#include "tendril/reproduce/body_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tendril/drawing/contour.hpp"

namespace tendril::reproduce {

namespace {

constexpr int cells = 120;  // of the mesh along u and v
constexpr int faint = 7;    // palette entry of the net: grey

std::vector<double> evenly(double a, double b, int parts) {
  std::vector<double> x(parts + 1);
  for (int i = 0; i <= parts; ++i) x[i] = a + (b - a) * i / parts;
  return x;
}

}  // namespace

BodyView::BodyView(geometry::SurfacePtr surface, const BodyRange& range, const drawing::View& view)
    : surface_(std::move(surface)), range_(range), view_(view), depth_(pixels * pixels, -HUGE_VALF) {
  const auto u = evenly(range.u0, range.u1, cells), v = evenly(range.v0, range.v1, cells);
  std::vector<std::array<double, 3>> node;
  double right = -HUGE_VAL, top = -HUGE_VAL;
  left_ = bottom_ = HUGE_VAL;
  for (double b : v) {
    for (double a : u) {
      node.push_back(drawing::project(view_, surface_->patch(a, b)(0, 0).c));
      left_ = std::min(left_, node.back()[0]), right = std::max(right, node.back()[0]);
      bottom_ = std::min(bottom_, node.back()[1]), top = std::max(top, node.back()[1]);
    }
  }
  size_ = 1.02 * std::max(right - left_, top - bottom_);
  left_ -= 0.01 * size_, bottom_ -= 0.01 * size_;
  const auto fill = [&](const std::array<double, 3>& a, const std::array<double, 3>& b,
                        const std::array<double, 3>& c) {
    const double scale = pixels / size_;
    const auto px = [&](const std::array<double, 3>& p) { return (p[0] - left_) * scale; };
    const auto py = [&](const std::array<double, 3>& p) { return (p[1] - bottom_) * scale; };
    const double area = (px(b) - px(a)) * (py(c) - py(a)) - (px(c) - px(a)) * (py(b) - py(a));
    if (std::abs(area) < 1e-9) return;
    const int i0 = std::max(0, int(std::min({px(a), px(b), px(c)}))),
              j0 = std::max(0, int(std::min({py(a), py(b), py(c)})));
    const int i1 = std::min(pixels - 1, int(std::max({px(a), px(b), px(c)})) + 1);
    const int j1 = std::min(pixels - 1, int(std::max({py(a), py(b), py(c)})) + 1);
    for (int j = j0; j <= j1; ++j) {
      for (int i = i0; i <= i1; ++i) {
        const double x = i + 0.5, y = j + 0.5;
        const double wb = ((x - px(a)) * (py(c) - py(a)) - (px(c) - px(a)) * (y - py(a))) / area;
        const double wc = ((px(b) - px(a)) * (y - py(a)) - (x - px(a)) * (py(b) - py(a))) / area;
        if (wb < 0.0 || wc < 0.0 || wb + wc > 1.0) continue;
        float& d = depth_[static_cast<std::size_t>(j) * pixels + i];
        d = std::max(d, static_cast<float>((1.0 - wb - wc) * a[2] + wb * b[2] + wc * c[2]));
      }
    }
  };
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const auto &a = node[j * (cells + 1) + i], &b = node[j * (cells + 1) + i + 1];
      const auto &c = node[(j + 1) * (cells + 1) + i + 1], &d = node[(j + 1) * (cells + 1) + i];
      fill(a, b, c);
      fill(a, c, d);
    }
  }
}

bool BodyView::seen(const std::array<double, 3>& point) const {
  const auto p = drawing::project(view_, point);
  const int i = int((p[0] - left_) / size_ * pixels), j = int((p[1] - bottom_) / size_ * pixels);
  // hidden only when every pixel around lies clearly in front: rims stay visible
  float front = HUGE_VALF;
  for (int dj = -1; dj <= 1; ++dj) {
    for (int di = -1; di <= 1; ++di) {
      const int k = i + di, l = j + dj;
      if (k < 0 || l < 0 || k >= pixels || l >= pixels) return true;
      front = std::min(front, depth_[static_cast<std::size_t>(l) * pixels + k]);
    }
  }
  return p[2] >= front - 0.012 * size_;
}

void BodyView::draw_curve(drawing::Panel& panel, const std::vector<std::array<double, 3>>& points,
                          const drawing::Curve& style, double hidden_opacity) const {
  const double gap = std::numeric_limits<double>::quiet_NaN();
  drawing::Curve shown = style, hidden = style;
  shown.x.clear(), shown.y.clear(), shown.value.clear();
  hidden.x.clear(), hidden.y.clear(), hidden.value.clear();
  hidden.label.clear();
  hidden.opacity = style.opacity * hidden_opacity;
  const auto push = [&](drawing::Curve& c, std::size_t n) {
    const auto p = drawing::project(view_, points[n]);
    c.x.push_back(p[0]);
    c.y.push_back(p[1]);
    if (!style.value.empty()) c.value.push_back(style.value[n]);
  };
  const auto cut = [&](drawing::Curve& c) {
    c.x.push_back(gap);
    c.y.push_back(gap);
    if (!style.value.empty()) c.value.push_back(0.0);
  };
  bool before = true;
  for (std::size_t n = 0; n < points.size(); ++n) {
    const bool now = seen(points[n]);
    if (n > 0 && now != before) {
      push(before ? shown : hidden, n);  // the two parts meet
      cut(before ? shown : hidden);
    }
    push(now ? shown : hidden, n);
    before = now;
  }
  if (!hidden.x.empty() && hidden_opacity > 0.0) panel.curves.push_back(std::move(hidden));
  if (!shown.x.empty()) panel.curves.push_back(std::move(shown));
}

void BodyView::draw_body(drawing::Panel& panel, int u_lines, int v_lines) const {
  panel.axes = false;
  panel.equal_scale = true;
  drawing::Curve net;
  net.colour = faint;
  net.width = 0.6;
  net.opacity = 0.28;
  const auto line = [&](bool along_u, double fixed) {
    std::vector<std::array<double, 3>> points;
    for (double t : along_u ? evenly(range_.u0, range_.u1, cells) : evenly(range_.v0, range_.v1, cells))
      points.push_back((along_u ? surface_->patch(t, fixed) : surface_->patch(fixed, t))(0, 0).c);
    draw_curve(panel, points, net, 0.0);
  };
  for (double u : evenly(range_.u0, range_.u1, u_lines)) line(false, u);
  for (double v : evenly(range_.v0, range_.v1, v_lines)) line(true, v);
  // outline: the normal is at right angles to the line of sight
  const std::array<double, 3> sight{drawing::project(view_, {1.0, 0.0, 0.0})[2],
                                    drawing::project(view_, {0.0, 1.0, 0.0})[2],
                                    drawing::project(view_, {0.0, 0.0, 1.0})[2]};
  const auto u = evenly(range_.u0, range_.u1, cells), v = evenly(range_.v0, range_.v1, cells);
  std::vector<double> facing;
  for (double b : v) {
    for (double a : u) {
      const auto p = surface_->patch(a, b);
      const auto n = geometry::cross(p(1, 0), p(0, 1));
      facing.push_back(n[0] * sight[0] + n[1] * sight[1] + n[2] * sight[2]);
    }
  }
  drawing::Curve outline = net;
  outline.width = 1.1;
  outline.opacity = 0.7;
  for (const auto& level : drawing::level_lines(u, v, facing, 0.0)) {
    std::vector<std::array<double, 3>> points;
    for (std::size_t n = 0; n < level.x.size(); ++n) points.push_back(surface_->patch(level.x[n], level.y[n])(0, 0).c);
    draw_curve(panel, points, outline, 0.0);
  }
}

}  // namespace tendril::reproduce

#include "tendril/reproduce/body.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

namespace tendril::reproduce {
namespace {

using drawing::Curve;
using Eigen::Vector3d;
constexpr int kBlue = 0, kVermillion = 1, kBlack = 6, kGrey = 7;

void append(Curve& c, const drawing::View& view, const Vector3d& r) {
  const auto p = drawing::project(view, {r.x(), r.y(), r.z()});
  c.x.push_back(p[0]);
  c.y.push_back(p[1]);
}

Vector3d towards_viewer(const drawing::View& v) {
  return {std::cos(v.elevation) * std::cos(v.azimuth), std::cos(v.elevation) * std::sin(v.azimuth),
          std::sin(v.elevation)};
}

Curve styled(int colour, double width, double opacity = 1.0) {
  Curve c;
  c.colour = colour;
  c.width = width;
  c.opacity = opacity;
  return c;
}

}  // namespace

drawing::Panel body_panel(const std::string& title) {
  drawing::Panel panel;
  panel.title = title;
  panel.axes = false;
  panel.equal_scale = true;
  return panel;
}

void add_tube(drawing::Panel& panel, const drawing::View& view, const geometry::Tube& tube, double length) {
  constexpr int kParts = 240;
  const Vector3d eye = towards_viewer(view);
  Curve left = styled(kGrey, 1.0), right = left, shade = styled(kGrey, 0, 0.16), axis = styled(kGrey, 0.8);
  axis.line = drawing::Line::dashed;
  shade.filled = true;
  Curve back;
  for (int i = 0; i <= kParts; ++i) {
    const double S = length * i / kParts;
    const geometry::AxisPoint a = tube.axis->at(S);
    const double Q = tube.clearance->at(S)[0];
    const Vector3d across = a.frame.col(2).cross(eye).normalized() * Q;
    append(left, view, a.position + across);
    append(right, view, a.position - across);
    append(axis, view, a.position);
  }
  shade.x = left.x;
  shade.y = left.y;
  shade.x.insert(shade.x.end(), right.x.rbegin(), right.x.rend());
  shade.y.insert(shade.y.end(), right.y.rbegin(), right.y.rend());
  panel.curves.push_back(shade);
  for (const double S : {0.0, length}) {
    const geometry::AxisPoint a = tube.axis->at(S);
    const double Q = tube.clearance->at(S)[0];
    Curve ring = styled(kGrey, 1.0);
    for (int i = 0; i <= 48; ++i) {
      const double t = 2 * std::numbers::pi * i / 48;
      append(ring, view, a.position + Q * (std::cos(t) * a.frame.col(0) + std::sin(t) * a.frame.col(1)));
    }
    panel.curves.push_back(ring);
  }
  panel.curves.push_back(left);
  panel.curves.push_back(right);
  panel.curves.push_back(axis);
}

void add_rod(drawing::Panel& panel, const drawing::View& view, const continuation::Fields& f, double touching) {
  Curve rod = styled(kBlack, 2.2), contact = styled(kVermillion, 3.4);
  for (std::size_t i = 0; i < f.x.size(); ++i) {
    append(rod, view, {f.x[i], f.y[i], f.z[i]});
    if (f.gap[i] < touching) {
      append(contact, view, {f.x[i], f.y[i], f.z[i]});
    } else {
      contact.x.push_back(std::numeric_limits<double>::quiet_NaN());
      contact.y.push_back(contact.x.back());
    }
  }
  panel.curves.push_back(rod);
  panel.curves.push_back(contact);
}

void add_arrow(drawing::Panel& panel, const drawing::View& view, const Vector3d& tail, const Vector3d& vector,
               const std::string& label) {
  Curve arrow = styled(kBlue, 1.8);
  append(arrow, view, tail);
  append(arrow, view, tail + vector);
  const double dx = arrow.x[1] - arrow.x[0], dy = arrow.y[1] - arrow.y[0], size = std::hypot(dx, dy);
  if (size > 0) {
    const double head = 0.22 * vector.norm();
    for (const double side : {0.42, -0.42}) {
      const double c = std::cos(side), s = std::sin(side);
      arrow.x.push_back(arrow.x[1] - head * (c * dx - s * dy) / size);
      arrow.y.push_back(arrow.y[1] - head * (s * dx + c * dy) / size);
      arrow.x.push_back(arrow.x[1]);
      arrow.y.push_back(arrow.y[1]);
    }
  }
  if (!label.empty()) panel.words.push_back({arrow.x[1], arrow.y[1], label});
  panel.curves.push_back(arrow);
}

}  // namespace tendril::reproduce

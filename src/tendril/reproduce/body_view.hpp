#pragma once
// A parametric surface seen from afar with curves on it: what the surface hides is faded. Visibility by a depth buffer
// filled from the surface's own mesh, outlines where the normal turns away from the viewer.

#include <array>
#include <vector>

#include "tendril/drawing/figure.hpp"
#include "tendril/geometry/parametric_surface.hpp"

namespace tendril::reproduce {

struct BodyRange {
  double u0, u1, v0, v1;
};

class BodyView {
 public:
  BodyView(geometry::SurfacePtr surface, const BodyRange& range, const drawing::View& view);

  /// Outline and a net of parameter lines, both thin.
  void draw_body(drawing::Panel& panel, int u_lines, int v_lines) const;
  /// A curve on (or near) the surface: seen parts as `style`, hidden ones fainter.
  void draw_curve(drawing::Panel& panel, const std::vector<std::array<double, 3>>& points, const drawing::Curve& style,
                  double hidden_opacity = 0.22) const;

 private:
  static constexpr int pixels = 360;
  geometry::SurfacePtr surface_;
  BodyRange range_;
  drawing::View view_;
  double left_ = 0.0, bottom_ = 0.0, size_ = 1.0;
  std::vector<float> depth_;

  bool seen(const std::array<double, 3>& point) const;
};

}  // namespace tendril::reproduce

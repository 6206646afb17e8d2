#pragma once
// Backtracking line search on f = ½|F|² along a Newton direction p = -J⁻¹F (Algorithms IV.2-IV.3 with the corrections
// of docs/decisions: the slope is ∇f·p = -|F|² = -2f). Sufficient decrease with c1 = 1e-4 (IV.1.7); the next step
// minimises a quadratic, then a cubic model (Dennis & Schnabel, ch. 6), kept between a tenth and a half of the last
// step.

#include <algorithm>
#include <cmath>

namespace tendril::numerics {

class Backtracking {
 public:
  explicit Backtracking(double f0) : f0_(f0), slope_(-2.0 * f0) {}

  bool sufficient(double step, double f) const { return f <= f0_ + 1e-4 * step * slope_; }

  /// The step to try after `step` gave f; f may be infinite or not a number (the step left the domain).
  double next(double step, double f) {
    double model = 0.5 * step;
    const double rise = f - f0_ - slope_ * step;
    if (!std::isfinite(f)) {
      last_step_ = 0.0;
      return model;
    }
    if (last_step_ > 0.0) {
      const double r = rise / (step * step), r_last = last_rise_ / (last_step_ * last_step_);
      const double a = (r - r_last) / (step - last_step_);
      const double b = (step * r_last - last_step_ * r) / (step - last_step_);
      const double d = b * b - 3.0 * a * slope_;
      if (d >= 0.0) model = b <= 0.0 ? (-b + std::sqrt(d)) / (3.0 * a) : -slope_ / (b + std::sqrt(d));
    } else {
      model = -slope_ * step * step / (2.0 * rise);
    }
    last_step_ = step;
    last_rise_ = rise;
    return std::isfinite(model) ? std::clamp(model, 0.1 * step, 0.5 * step) : 0.5 * step;
  }

 private:
  double f0_, slope_;
  double last_step_ = 0.0, last_rise_ = 0.0;
};

}  // namespace tendril::numerics

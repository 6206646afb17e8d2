#include "tendril/segmentation/seeding.hpp"

#include <algorithm>
#include <cmath>

#include "tendril/segmentation/pattern_checks.hpp"
#include "tendril/segmentation/pattern_edit.hpp"

namespace tendril::segmentation {

void balance_shear(const ScaledProblem& P, double S, double* u) {
  using formulation::FreeRod;
  const auto s = P.section(S);
  const auto l = formulation::lift<double>(s, 0.0, 0.0);
  double r[FreeRod::components], q[1];
  u[11] = u[13] = 0.0;
  FreeRod::residual<double>(P.material, l, u, r, q);
  const double alpha = FreeRod::stretch(P.material, u[15]);
  u[13] = r[0] / alpha;
  u[11] = -r[1] / alpha;
}

Chain open_lines(const Chain& at, const std::vector<Opening>& openings, int& free_segment) {
  const ScaledProblem& P = at.mechanics().problem;
  Pattern q = at.pattern();
  struct Lift {
    double S, half, k;
  };
  std::vector<Lift> lifts;
  for (const Opening& o : openings) {
    const double a = at.S(o.segment), b = at.S(o.segment + 1), half = 0.5 * o.span;
    q = split_line(q, o.segment, o.S, o.span, a, b);
    free_segment = o.S - half <= a ? o.segment : o.segment + 1;
    if (o.S - half <= a || o.S + half >= b) continue;  // opens at an end: no symmetric bubble
    const double d = 0.5 * half;
    const double second = (pressure(at, o.segment, o.S + d) - 2.0 * pressure(at, o.segment, o.S) +
                           pressure(at, o.segment, o.S - d)) / (d * d);
    lifts.push_back({o.S, half, std::max(second, 0.0) / 720.0});
  }
  Chain c = at;
  int pieces = 0;
  for (int j = 0; j < at.segments(); ++j) pieces += at.segment(j).pieces();
  c.build(q, pieces, [&](double S, double* u, double* s) {
    at.sample(S, u, s);
    for (const Lift& l : lifts) {
      const double x = S - l.S, y = l.half * l.half - x * x;
      if (y <= 0.0) continue;
      // w and its first three derivatives along S
      const double w[4] = {l.k * y * y * y, -6.0 * l.k * x * y * y, l.k * y * (24.0 * x * x - 6.0 * y),
                           l.k * (72.0 * x * y - 48.0 * x * x * x)};
      // the wall normal turns little over the span: subtract along e(β) at the section
      const double r = std::hypot(u[0], u[4]), c1 = u[0] / r, c2 = u[4] / r;
      for (int n = 0; n < 4; ++n) {
        u[n] -= P.sign * c1 * w[n];
        u[4 + n] -= P.sign * c2 * w[n];
      }
      balance_shear(P, S, u);
    }
  });
  return c;
}

}  // namespace tendril::segmentation

#include "tendril/segmentation/flat_lines.hpp"

#include <algorithm>
#include <cmath>

#include "tendril/segmentation/pattern_checks.hpp"

namespace tendril::segmentation {

using formulation::FreeRod;
using formulation::LineContact;

bool carries_nothing(const Chain& chain, int segment) {
  if (!chain.is_line(segment)) return false;
  constexpr double negligible = 1e-6;
  double reactions = 1.0;
  for (int k : {segment - 1, segment})
    if (k >= 0 && k + 1 < chain.segments()) reactions = std::max(reactions, std::abs(reaction(chain, k)));
  const double a = chain.S(segment), span = chain.S(segment + 1) - a;
  for (int i = 0; i < 6; ++i)
    if (!(std::abs(pressure(chain, segment, a + span * (i + 0.5) / 6.0)) * span <= negligible * reactions))
      return false;
  return true;
}

bool has_flat_line(const Chain& chain) {
  for (int j = 0; j < chain.segments(); ++j)
    if (chain.is_line(j) && carries_nothing(chain, j)) return true;
  return false;
}

double curvature_mismatch(const Chain& chain, int junction) {
  const bool left_line = chain.is_line(junction);
  const auto& left = chain.segment(junction);
  const auto& right = chain.segment(junction + 1);
  double u[formulation::state_inputs];
  const int free = left_line ? junction + 1 : junction;
  chain.segment(free).evaluate_local(left_line ? 0 : left.pieces() - 1, left_line ? 0.0 : 1.0, chain.S(free),
                                     chain.S(free + 1), u, nullptr);
  const double* zc = left_line ? left.state(left.pieces()) : right.state(0);
  const auto Q = chain.mechanics().problem.section(chain.S(junction + 1)).Q;
  return std::cos(zc[0]) * u[2] + std::sin(zc[0]) * u[6] - (Q[2] - Q[0] * zc[1] * zc[1]);
}

double buckling_margin(const Chain& chain, int segment) {
  const double a = chain.S(segment), b = chain.S(segment + 1), span = b - a;
  double line[formulation::state_inputs];
  chain.segment(segment).evaluate(0.5 * (a + b), a, b, line, nullptr);
  const double c = std::cos(line[0]), s = std::sin(line[0]);
  // the stretch as a free rod, and what a curvature and a shear force along the normal at its start do to its end
  collocation::Segment rod(chain.mechanics().system(false, chain.segment(segment).law(0)), chain.k());
  std::vector<double> points;
  constexpr int pieces = 4;
  for (int i = 1; i < pieces; ++i) points.push_back(a + span * i / pieces);
  rod.initialise_on(a, b, points, [&](double S, double* u, double* q) {
    chain.sample(std::clamp(S, a + 1e-12 * span, b - 1e-12 * span), u, q);
  });
  const int n = rod.states();
  std::vector<double> v[2];
  for (int i = 0; i < 2; ++i) {
    v[i].assign(n, 0.0);
    v[i][i == 0 ? 2 : 8] = c;
    v[i][i == 0 ? 5 : 9] = s;
  }
  collocation::Condensed piece;
  std::vector<double> next(n);
  for (int i = 0; i < rod.pieces(); ++i) {
    if (!rod.condense(i, a, b, piece)) return -1.0;
    for (auto& x : v) {
      for (int row = 0; row < n; ++row) {
        next[row] = 0.0;
        for (int q = 0; q < n; ++q) next[row] -= piece.rows[static_cast<std::size_t>(row) * (n + 3) + q] * x[q];
      }
      x = next;
    }
  }
  const auto place = [&](const std::vector<double>& x) { return c * x[0] + s * x[3]; };
  const auto slope = [&](const std::vector<double>& x) { return c * x[1] + s * x[4]; };
  const double determinant = place(v[0]) * slope(v[1]) - place(v[1]) * slope(v[0]);
  return -12.0 * determinant / (span * span * span * span);  // of the beam without thrust: -span⁴/12
}

}  // namespace tendril::segmentation

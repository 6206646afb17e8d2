#include "tendril/collocation/b_splines.hpp"

#include <algorithm>
#include <cmath>

#include "tendril/numerics/gauss.hpp"

namespace tendril::collocation {

std::vector<numerics::Bernstein> bernstein_pieces(const Segment& segment, int component, double a, double b) {
  const System& system = segment.system();
  const int k = segment.points_per_piece(), m = system.order[component];
  const numerics::GaussTable& table = numerics::gauss_table(k);
  std::vector<double> inputs(system.inputs), quadratures(system.quadratures);
  const std::vector<double> x(table.c.begin(), table.c.begin() + k);
  std::vector<numerics::Bernstein> pieces;
  for (int i = 0; i < segment.pieces(); ++i) {
    const double h = segment.place(i + 1, a, b) - segment.place(i, a, b);
    // The highest derivative is the polynomial through its values at the Gauss points; the rest by integration.
    std::vector<double> highest(k);
    for (int g = 0; g < k; ++g) {
      segment.evaluate_local(i, x[g], a, b, inputs.data(), quadratures.data());
      highest[g] = inputs[system.first[component] + m];
    }
    numerics::Bernstein c = numerics::interpolant(x, highest);
    for (int j = m - 1; j >= 0; --j)
      c = numerics::integrated(c, h, segment.state(i)[segment.state_index(component, j)]);
    pieces.push_back(std::move(c));
  }
  return pieces;
}

std::vector<numerics::BSpline> b_splines(const Segment& segment, double a, double b) {
  std::vector<double> breaks;
  for (int i = 0; i <= segment.pieces(); ++i) breaks.push_back(segment.place(i, a, b));
  std::vector<numerics::BSpline> list;
  for (int c = 0; c < segment.system().components(); ++c) {
    const int m = segment.system().order[c];
    list.push_back(
        numerics::b_spline(segment.points_per_piece() + m, m - 1, breaks, bernstein_pieces(segment, c, a, b)));
  }
  return list;
}

std::pair<double, double> squared_norm_bounds(const Segment& segment, int component_1, int component_2, double a,
                                              double b, double accuracy) {
  const auto one = bernstein_pieces(segment, component_1, a, b), two = bernstein_pieces(segment, component_2, a, b);
  double low = HUGE_VAL, high = 0.0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    const auto [least, most] =
        numerics::bounds(numerics::sum(numerics::product(one[i], one[i]), numerics::product(two[i], two[i])), accuracy);
    low = std::min(low, least);
    high = std::max(high, most);
  }
  return {std::max(0.0, low), high};
}

}  // namespace tendril::collocation

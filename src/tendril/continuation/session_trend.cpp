#include "tendril/continuation/session_trend.hpp"

#include <algorithm>
#include <cmath>

#include "tendril/formulation/varying_rod.hpp"
#include "tendril/numerics/gauss.hpp"

namespace tendril::continuation {

using segmentation::Chain;

namespace {

constexpr std::size_t most_past = 2;  // a parabola through the present state
/// No part shrinks below this share of its length by extrapolation.
constexpr double least_span = 0.3;
/// Farther than this many of the last step nothing is extrapolated.
constexpr double farthest = 4.0;

}  // namespace

bool same_structure(const Chain& a, const Chain& b) {
  if (a.segments() != b.segments() || a.tip_rests() != b.tip_rests() || a.k() != b.k()) return false;
  for (int j = 0; j < a.segments(); ++j) {
    if (a.is_line(j) != b.is_line(j) || a.near_wall(j) != b.near_wall(j)) return false;
    if (a.segment(j).parts() != b.segment(j).parts()) return false;
    for (int q = 0; q < a.segment(j).parts(); ++q)
      if (a.segment(j).law(q) != b.segment(j).law(q)) return false;
  }
  return true;
}

void gather_on_mesh(const Chain& state, const Chain& mesh, std::vector<double>& x) {
  mesh.gather(x);
  const int p = mesh.column_of_p();
  x[p] = state.parameter();
  if (p + 1 < mesh.unknowns()) x[p + 1] = state.phase_multiplier();
  for (int j = 0; j <= mesh.segments(); ++j) x[mesh.column_of_S(j)] = state.S(j);
  double u[formulation::state_inputs], s[2] = {0.0, 0.0};
  std::vector<double> local;
  for (int j = 0; j < mesh.segments(); ++j) {
    int before = 0;  // pieces of the parts before
    for (int q = 0; q < mesh.segment(j).parts(); ++q) {
      const auto &to = mesh.segment(j).part(q), &from = state.segment(j).part(q);
      const double a = state.segment(j).left(q, state.S(j)), b = state.segment(j).right(q, state.S(j + 1));
      const auto& system = to.system();
      const int components = system.components(), k = to.points_per_piece();
      const int column = mesh.column_of_state(j, before, 0);
      before += to.pieces();
      if (q > 0) x[column - 1] = a;
      int i = 0;  // piece of `from`, ascending with the share
      const auto at = [&](double share, double* quadratures) {
        while (i + 1 < from.pieces() && share >= from.place(i + 1, 0.0, 1.0)) ++i;
        const double left = from.place(i, 0.0, 1.0), width = from.place(i + 1, 0.0, 1.0) - left;
        from.evaluate_own(i, (share - left) / width, a, b, u, quadratures);
      };
      const std::size_t first = local.size();
      local.resize(first + to.local().size());
      const std::size_t each = to.local().size() / to.pieces();
      for (int m = 0; m <= to.pieces(); ++m) {
        const double share = to.place(m, 0.0, 1.0);
        at(share, s);
        double* z = &x[column + m * to.states()];
        for (int c = 0; c < components; ++c)
          for (int d = 0; d < system.order[c]; ++d) z[to.state_index(c, d)] = u[system.first[c] + d];
        for (int c = 0; c < system.quadratures; ++c) z[to.states() - system.quadratures + c] = s[c];
        if (m == to.pieces()) break;
        const double width = to.place(m + 1, 0.0, 1.0) - share;
        for (int g = 0; g < k; ++g) {
          at(share + width * numerics::gauss_table(k).c[g], nullptr);
          for (int c = 0; c < components; ++c)
            local[first + m * each + c * k + g] = u[system.first[c] + system.order[c]];
        }
      }
    }
  }
  x.insert(x.end(), local.begin(), local.end());
}

void Trend::push(Chain left, double value, const Chain& now) {
  if (!same_structure(left, now)) past_.clear();
  std::erase_if(past_, [&](const Past& p) { return p.value == value || !same_structure(p.chain, now); });
  if (same_structure(left, now)) past_.push_front({std::move(left), value});
  if (past_.size() > most_past) past_.pop_back();
}

bool Trend::lead(Chain& chain, double from, double to) const {
  if (past_.empty() || past_[0].value == from) return false;
  std::vector<double> x, now;
  chain.gather_all(now);
  // Lagrange's weights of the present state and those before, in the motion
  std::vector<double> at{from};
  for (const Past& p : past_) at.push_back(p.value);
  if (at.size() > 2 && (at[0] - at[1]) * (at[1] - at[2]) <= 0.0) at.resize(2);  // it has turned back
  if (std::abs(to - from) > farthest * std::abs(from - at[1])) return false;
  std::vector<double> weight(at.size(), 1.0);
  for (std::size_t i = 0; i < at.size(); ++i)
    for (std::size_t j = 0; j < at.size(); ++j)
      if (i != j) weight[i] *= (to - at[j]) / (at[i] - at[j]);
  std::vector<double> change(now.size(), 0.0);
  for (std::size_t i = 1; i < at.size(); ++i) {
    gather_on_mesh(past_[i - 1].chain, chain, x);
    for (std::size_t c = 0; c < x.size(); ++c) change[c] += weight[i] * (x[c] - now[c]);
  }
  double share = 1.0;
  for (int j = 0; j < chain.segments(); ++j)
    for (int q = 0, before = 0; q < chain.segment(j).parts(); before += chain.segment(j).part(q++).pieces()) {
      const auto& s = chain.segment(j);
      const int left = q == 0 ? chain.column_of_S(j) : chain.column_of_state(j, before, 0) - 1;
      const int right =
          q + 1 == s.parts() ? chain.column_of_S(j + 1) : chain.column_of_state(j, before + s.part(q).pieces(), 0) - 1;
      const double width = now[right] - now[left], grows = change[right] - change[left];
      if (width + grows < least_span * width) share = std::min(share, (1.0 - least_span) * width / -grows);
    }
  for (std::size_t c = 0; c < now.size(); ++c) now[c] += share * change[c];
  chain.scatter_all(now);
  return true;
}

}  // namespace tendril::continuation

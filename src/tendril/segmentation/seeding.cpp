#include "tendril/segmentation/seeding.hpp"

#include <algorithm>
#include <array>
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

Opening opening_at(const Chain& chain, int segment, double S, double span) {
  const double d = 0.25 * span;
  const double second =
      (pressure(chain, segment, S + d) - 2.0 * pressure(chain, segment, S) + pressure(chain, segment, S - d)) / (d * d);
  return {segment, S, span, std::max(second, 0.0) / 720.0};
}

std::vector<Opening> tensile_stretches(const Chain& chain, double tolerance) {
  const auto minima = margins(chain);
  std::vector<Opening> out;
  for (int j = chain.segments() - 1; j >= 0; --j) {
    if (!chain.is_line(j)) continue;
    const auto& seg = chain.segment(j);
    const double a = chain.S(j), b = chain.S(j + 1);
    std::vector<std::array<double, 3>> zones;    // from, to, lowest pressure
    auto counts = [&](double from, double to) {  // a stretch that pulls noticeably has a minimum that says so
      return std::any_of(minima.begin(), minima.end(), [&](const Margin& m) {
        return m.kind == CheckKind::pressure && m.index == j && m.pull < -tolerance && m.S >= from - 1e-9 &&
               m.S <= to + 1e-9;
      });
    };
    bool inside = false;
    const int per_piece = 8, n = seg.pieces() * per_piece;
    double previous = a;
    for (int i = 0; i < n; ++i) {
      const double f = (i % per_piece + 0.5) / per_piece;
      const double x = seg.place(i / per_piece, a, b) * (1.0 - f) + seg.place(i / per_piece + 1, a, b) * f;
      const double p = pressure(chain, j, x);
      if (p < 0.0) {
        if (!inside) zones.push_back({i == 0 ? a : 0.5 * (previous + x), x, p});
        inside = true;
        zones.back()[1] = i == n - 1 ? b : x;
        zones.back()[2] = std::min(zones.back()[2], p);
      } else {
        inside = false;
      }
      previous = x;
    }
    std::erase_if(zones, [&](const auto& z) { return !counts(z[0], z[1]); });
    // a stretch too short for the samples: from its located minimum outwards
    for (const Margin& m : minima) {
      if (m.kind != CheckKind::pressure || m.index != j || m.pull >= -tolerance) continue;
      if (std::any_of(zones.begin(), zones.end(),
                      [&](const auto& z) { return m.S >= z[0] - 1e-9 && m.S <= z[1] + 1e-9; }))
        continue;
      auto edge = [&](double direction) {
        double step = 1e-7 * (b - a), x = m.S;
        for (int it = 0; it < 60; ++it, step *= 1.5) {
          x += direction * step;
          if (x <= a || x >= b) return std::clamp(x, a, b);
          if (pressure(chain, j, x) > 0.0) return x;
        }
        return x;
      };
      zones.push_back({edge(-1.0), edge(1.0), m.raw});
    }
    std::sort(zones.begin(), zones.end());
    // wanted openings, joined where they overlap
    std::vector<std::array<double, 3>> wanted;
    for (const auto& z : zones) {
      const double mid = 0.5 * (z[0] + z[1]), half = 0.5 * (z[1] - z[0]);
      const double reach = std::sqrt(5.0) * std::max(half, 1e-6 * (b - a));
      std::array<double, 3> w{std::max(a, mid - reach), std::min(b, mid + reach),
                              -z[2] / (360.0 * std::max(half * half, 1e-300))};
      if (z[0] <= a) w[0] = a;
      if (z[1] >= b) w[1] = b;
      if (!wanted.empty() && w[0] <= wanted.back()[1]) {
        wanted.back()[1] = w[1];
        wanted.back()[2] = 0.0;
      } else {
        wanted.push_back(w);
      }
    }
    for (auto w = wanted.rbegin(); w != wanted.rend(); ++w)
      out.push_back({j, 0.5 * ((*w)[0] + (*w)[1]), (*w)[1] - (*w)[0], (*w)[2]});
  }
  return out;
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
    if (o.S - half > a && o.S + half < b) lifts.push_back({o.S, half, o.k});
  }
  return at.recut(q, [&](double S, double* u, double* s) {
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
}

std::vector<int> new_junctions(const Pattern& before, const Pattern& after, double distance) {
  std::vector<int> fresh;
  for (std::size_t k = 0; k < after.S.size(); ++k)
    if (std::none_of(before.S.begin(), before.S.end(), [&](double s) { return std::abs(s - after.S[k]) <= distance; }))
      fresh.push_back(static_cast<int>(k));
  return fresh;
}

NewtonSummary settle_fresh_junctions(Chain& chain, const std::vector<int>& fresh, const NewtonOptions& options) {
  NewtonSummary s;
  if (fresh.empty()) return s;
  Chain held = chain;
  for (int k : fresh) held.hold(k, chain.S(k + 1));
  s = held.solve({Closure::Kind::parameter, 0, chain.parameter()}, options);
  if (s.converged) {
    for (int k : fresh) held.release(k);
    chain = held;
  }
  return s;
}

NewtonSummary solve_with_fresh_junctions(Chain& chain, const std::vector<int>& fresh, const Closure& closure,
                                         const NewtonOptions& options, double tolerance) {
  NewtonSummary total = settle_fresh_junctions(chain, fresh, options);
  const NewtonSummary s = chain.solve_adaptive(closure, options, tolerance);
  total.converged = s.converged;
  total.correction = s.correction;
  total.reason = s.reason;
  total.iterations += s.iterations;
  total.factorisations += s.factorisations;
  return total;
}

}  // namespace tendril::segmentation

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
  FreeRod::residual<double>(P.material, l, u, r, q);  // of a varying rod: a guess
  const double alpha = FreeRod::stretch(P.material, u[15]);
  u[13] = r[0] / alpha;
  u[11] = -r[1] / alpha;
}

Opening opening_at(const Chain& chain, int segment, double S, double span) {
  const double d = 0.25 * span;
  const double second =
      (pressure(chain, segment, S + d) - 2.0 * pressure(chain, segment, S) + pressure(chain, segment, S - d)) / (d * d);
  return {segment, S, span, std::max(second, 0.0) / 720.0, {}};
}

PressureTable::PressureTable(std::vector<double> S, const std::vector<double>& p)
    : S_(std::move(S)), p_(p), middle_(0.5 * (S_.front() + S_.back())) {
  moment_.assign(S_.size(), {});
  for (std::size_t i = 1; i < S_.size(); ++i) moment_[i] = moments(S_[i]);
}

std::array<double, 4> PressureTable::moments(double S) const {
  const auto it = std::lower_bound(S_.begin() + 1, S_.end() - 1, S);
  const std::size_t i = it - S_.begin() - 1;
  const double a = S_[i] - middle_, h = S - S_[i], slope = (p_[i + 1] - p_[i]) / (S_[i + 1] - S_[i]);
  std::array<double, 4> m = moment_[i];
  // Gauss with three points is exact for t³ p
  const double x[3] = {0.5 - 0.5 * std::sqrt(0.6), 0.5, 0.5 + 0.5 * std::sqrt(0.6)};
  const double w[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  for (int g = 0; g < 3; ++g) {
    const double t = a + h * x[g];
    double f = w[g] * h * (p_[i] + slope * h * x[g]);
    for (int k = 0; k < 4; ++k, f *= t) m[k] += f;
  }
  return m;
}

bool PressureTable::opening(double& a, double& b) const {
  const double first = S_.front(), last = S_.back();
  for (int it = 0; it < 60; ++it) {
    if (a < first || b > last || !(b > a)) return false;
    const auto ma = moments(a), mb = moments(b);
    std::array<double, 4> m;
    for (int k = 0; k < 4; ++k) m[k] = mb[k] - ma[k];
    const double u = a - middle_, v = b - middle_;
    // weight (v - t)(t - u) = -t² + (u + v) t - u v, and that times t
    const double g0 = -m[2] + (u + v) * m[1] - u * v * m[0], g1 = -m[3] + (u + v) * m[2] - u * v * m[1];
    const double g0v = m[1] - u * m[0], g0u = m[1] - v * m[0], g1v = m[2] - u * m[1], g1u = m[2] - v * m[1];
    const double det = g0u * g1v - g0v * g1u;
    const double du = -(g0 * g1v - g0v * g1) / det, dv = -(g0u * g1 - g0 * g1u) / det;
    const double most = 0.2 * (b - a), size = std::max(std::abs(du), std::abs(dv));
    if (!std::isfinite(size)) return false;
    const double damping = size > most ? most / size : 1.0;
    a += damping * du;
    b += damping * dv;
    if (size < 1e-6 * (b - a)) return a >= first && b <= last && b > a;
  }
  return false;
}

void PressureTable::lift(double a, double b, double S, double* w) const {
  const auto ma = moments(a), mb = moments(b), mx = moments(std::clamp(S, a, b));
  const double x = std::clamp(S, a, b) - middle_, v = b - middle_, d = x - (a - middle_);
  const double third = (v * (mb[0] - ma[0]) - (mb[1] - ma[1])) / (b - a);  // at a
  std::array<double, 4> m;
  for (int k = 0; k < 4; ++k) m[k] = mx[k] - ma[k];
  w[0] = third * d * d * d / 6.0 - (x * x * x * m[0] - 3.0 * x * x * m[1] + 3.0 * x * m[2] - m[3]) / 6.0;
  w[1] = third * d * d / 2.0 - (x * x * m[0] - 2.0 * x * m[1] + m[2]) / 2.0;
  w[2] = third * d - (x * m[0] - m[1]);
  w[3] = third - m[0];
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
    const auto crossing = [&](double pulls, double pushes) {  // where the pressure vanishes
      for (int it = 0; it < 30; ++it) {
        const double middle = 0.5 * (pulls + pushes);
        (pressure(chain, j, middle) < 0.0 ? pulls : pushes) = middle;
      }
      return 0.5 * (pulls + pushes);
    };
    bool inside = false;
    const int per_piece = 8, n = seg.pieces() * per_piece;
    double previous = a;
    for (int i = 0; i < n; ++i) {
      const double f = (i % per_piece + 0.5) / per_piece;
      const double x = seg.place(i / per_piece, a, b) * (1.0 - f) + seg.place(i / per_piece + 1, a, b) * f;
      const double p = pressure(chain, j, x);
      if (p < 0.0) {
        if (!inside) zones.push_back({i == 0 ? a : crossing(x, previous), x, p});
        inside = true;
        zones.back()[1] = i == n - 1 ? b : x;
        zones.back()[2] = std::min(zones.back()[2], p);
      } else {
        if (inside) zones.back()[1] = crossing(previous, x);
        inside = false;
      }
      previous = x;
    }
    std::erase_if(zones, [&](const auto& z) { return !counts(z[0], z[1]); });
    // a break of the section law that the wall does not carry
    for (int q = 0; q + 1 < seg.parts(); ++q) {
      const CutJump c = cut_jump(chain, j, q);
      if (!counts(c.S, c.S)) continue;
      const double half = std::max(0.5 * c.span / std::sqrt(5.0), 1e-4 * (b - a));
      zones.push_back({std::max(a, c.S - half), std::min(b, c.S + half), -std::abs(c.couple) / (half * half)});
    }
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
          if (pressure(chain, j, x) > 0.0) return crossing(x - direction * step, x);
        }
        return x;
      };
      zones.push_back({edge(-1.0), edge(1.0), m.raw});
    }
    std::sort(zones.begin(), zones.end());
    // wanted openings, joined where they overlap
    struct Wanted {
      double from, to, k;
      PressureTable table;
    };
    std::vector<Wanted> wanted;
    for (const auto& z : zones) {
      const double mid = 0.5 * (z[0] + z[1]), half = std::max(0.5 * (z[1] - z[0]), 1e-6 * (b - a));
      const double reach = std::sqrt(5.0) * half;
      Wanted w{std::max(a, mid - reach), std::min(b, mid + reach), -z[2] / (360.0 * half * half), {}};
      // the beam under the pressure as it is, where the opening stays clear of the line's ends
      if (z[0] > a && z[1] < b) {
        constexpr int samples = 120;
        constexpr double wide = 8.0;  // half-lengths of the dip
        const double from = std::max(a, mid - wide * half), to = std::min(b, mid + wide * half);
        std::vector<double> S, p;
        for (int i = 0; i <= samples; ++i) {
          S.push_back(from + (to - from) * i / samples);
          p.push_back(pressure(chain, j, S.back()));
        }
        PressureTable table(S, p);
        double from_fit = std::max(w.from, from), to_fit = std::min(w.to, to);
        if (table.opening(from_fit, to_fit) && from_fit < z[0] && to_fit > z[1]) {
          w.from = from_fit;
          w.to = to_fit;
          w.table = std::move(table);
        }
      }
      if (z[0] <= a) w.from = a;
      if (z[1] >= b) w.to = b;
      if (!wanted.empty() && w.from <= wanted.back().to) {
        wanted.back().to = std::max(wanted.back().to, w.to);
        wanted.back().k = 0.0;
        wanted.back().table = {};
      } else {
        wanted.push_back(std::move(w));
      }
    }
    for (auto w = wanted.rbegin(); w != wanted.rend(); ++w)
      out.push_back({j, 0.5 * (w->from + w->to), w->to - w->from, w->k, w->table});
  }
  return out;
}

Chain open_lines(const Chain& at, const std::vector<Opening>& openings, int& free_segment) {
  const ScaledProblem& P = at.mechanics().problem;
  Pattern q = at.pattern();
  struct Lift {
    double S, half, k;
    const PressureTable* table;
  };
  std::vector<Lift> lifts;
  for (const Opening& o : openings) {
    const double a = at.S(o.segment), b = at.S(o.segment + 1), half = 0.5 * o.span;
    q = split_line(q, o.segment, o.S, o.span, a, b);
    free_segment = o.S - half <= a ? o.segment : o.segment + 1;
    if (o.S - half > a && o.S + half < b) lifts.push_back({o.S, half, o.k, &o.table});
  }
  return at.recut(q, [&](double S, double* u, double* s) {
    at.sample(S, u, s);
    for (const Lift& l : lifts) {
      const double x = S - l.S, y = l.half * l.half - x * x;
      if (y <= 0.0) continue;
      // w and its first three derivatives along S
      double w[4] = {l.k * y * y * y, -6.0 * l.k * x * y * y, l.k * y * (24.0 * x * x - 6.0 * y),
                     l.k * (72.0 * x * y - 48.0 * x * x * x)};
      if (!l.table->empty()) l.table->lift(l.S - l.half, l.S + l.half, S, w);
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

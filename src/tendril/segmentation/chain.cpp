// The chain's pattern, its filling from other states, the phase condition.
#include "tendril/segmentation/chain.hpp"

#include <algorithm>
#include <cmath>

#include "tendril/formulation/convert.hpp"
#include "tendril/formulation/near_wall.hpp"
#include "tendril/numerics/kernels.hpp"

namespace tendril::segmentation {

using formulation::FreeRod;
using formulation::LineContact;

namespace {

/// A phase condition is needed where an axisymmetric problem has a state off the axis.
constexpr double phase_threshold = 1e-3;  // of the clearance

/// The highest derivatives from the equations, which are linear in them, all lower ones given.
void complete(const collocation::System& system, double S, double* u) {
  double r[12], jac[12 * 34], top[12 * 13];
  int pivots[12];
  const int n = system.components(), cols = system.inputs + 2;
  system.jacobian(S, u, r, jac);
  for (int e = 0; e < n; ++e) {
    if (!std::isfinite(r[e])) return;
    for (int c = 0; c < n; ++c) top[e * (n + 1) + c] = jac[e * cols + system.first[c] + system.order[c]];
    top[e * (n + 1) + n] = r[e];
  }
  if (!numerics::factor_and_solve(top, n, n + 1, n + 1, pivots)) return;
  for (int c = 0; c < n; ++c) u[system.first[c] + system.order[c]] -= top[c * (n + 1) + n];
}

}  // namespace

Pattern Chain::pattern() const {
  Pattern q;
  q.line = line_;
  q.S.assign(S_.begin() + 1, S_.end() - 1);
  q.tip = tip_;
  if (std::any_of(touching_.begin(), touching_.end(), [](char t) { return t != 0; })) q.collar = touching_;
  return q;
}

void Chain::take_pattern(const Pattern& pattern) {
  line_ = pattern.line;
  tip_ = pattern.tip;
  touching_ = pattern.collar;
  touching_.resize(mechanics_->problem.collars.size(), 0);
}

double Chain::far_end() const {
  const ScaledProblem& P = mechanics_->problem;
  return P.tip_place_free() && std::isfinite(tip_place_) ? tip_place_ : P.now(P.end_position);
}

void Chain::build(const Pattern& pattern, int pieces_total, const Sampler& sampler) {
  mechanics_->problem.p = p_;
  const ScaledProblem& P = mechanics_->problem;
  std::vector<double> points(P.knots);
  const double start = P.start_position, end = far_end() - start;
  for (int i = 1; i < pieces_total; ++i) points.push_back(start + end * i / pieces_total);
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  // knots stay, the even points give way to them
  std::vector<double> kept;
  for (double s : points) {
    const bool knot = std::binary_search(P.knots.begin(), P.knots.end(), s);
    const double room = 0.3 * end / pieces_total;
    if (knot) {
      while (!kept.empty() && s - kept.back() < room &&
             !std::binary_search(P.knots.begin(), P.knots.end(), kept.back()))
        kept.pop_back();
      kept.push_back(s);
    } else if (kept.empty() || s - kept.back() > room) {
      kept.push_back(s);
    }
  }
  build(pattern, kept, sampler);
}

void Chain::build(const Pattern& pattern, const std::vector<double>& points, const Sampler& sampler,
                  const LineSampler& on_wall) {
  const ScaledProblem& P = mechanics_->problem;
  mechanics_->problem.p = p_;
  take_pattern(pattern);
  S_.assign(1, mechanics_->problem.start_position);
  S_.insert(S_.end(), pattern.S.begin(), pattern.S.end());
  S_.push_back(far_end());
  const int n = static_cast<int>(line_.size());
  segment_.clear();
  held_.clear();
  double beta = 0.0;
  bool have_beta = false;
  const bool varies = P.varies();
  // of a varying rod: unstressed length where the sampler is asked, counted as the section law is
  double far_end = 0.0;
  const auto length = [&](double S) {
    double u[formulation::state_inputs], s;
    sampler(S, u, &s);
    return s - far_end;
  };
  if (varies && P.law.from_end) far_end = length(S_.back());
  const auto carry = [&](double* u, double s, int law, int inputs) {
    if (!varies) return;
    u[inputs] = s - far_end;
    u[inputs + 1] = 1.0;
    u[inputs + 2] = law;
  };
  for (int j = 0; j < n; ++j) {
    const bool line = line_[j], near = hardly_leaves(j, sampler);
    const double a = S_[j], b = S_[j + 1];
    // points too close to the ends of the segment, and to their neighbours' distance, are dropped; too few, and even
    // ones are used
    const auto first = std::upper_bound(points.begin(), points.end(), a);
    const auto last = std::lower_bound(first, points.end(), b);
    std::vector<double> inside(first, last);
    const auto crowded = [&](double distance, double next) { return distance <= std::min(0.02 * (b - a), 0.2 * next); };
    while (inside.size() > 1 && crowded(b - inside.back(), inside.back() - inside[inside.size() - 2]))
      inside.pop_back();
    while (inside.size() > 1 && crowded(inside[0] - a, inside[1] - inside[0])) inside.erase(inside.begin());
    if (inside.size() == 1 && std::min(inside[0] - a, b - inside[0]) <= 0.02 * (b - a)) inside.clear();
    for (int i = 1; inside.size() < 2 && i < 3; ++i) {
      const double s = a + (b - a) * i / 3.0;
      if (inside.empty() || std::abs(inside[0] - s) > 0.15 * (b - a)) inside.push_back(s);
    }
    std::sort(inside.begin(), inside.end());
    const auto fill = [&](double S, double* u, double* q, const collocation::System& system, int law) {
      if (!line) {
        sampler(S, u, q);
        carry(u, *q, law, FreeRod::inputs);
        if (near) {
          formulation::free_to_wall(P.section(S), have_beta ? beta : 0.0, u);
          beta = u[formulation::NearWall::angle];
          have_beta = true;
        }
      } else if (on_wall && on_wall(S, u, q)) {
        beta = u[0];  // the turn counted so far
        have_beta = true;
        carry(u, *q, law, LineContact::inputs);
        return;
      } else {
        double f[formulation::state_inputs];
        sampler(S, f, q);
        carry(f, *q, law, FreeRod::inputs);
        if (!have_beta) {
          beta = std::atan2(f[4], f[0]);
          have_beta = true;
        }
        P.free_to_line(P.section(S), f, beta, u);
        beta = u[0];
      }
      complete(system, S, u);
    };
    if (varies) {
      segment_.push_back(cut(j, inside, length, fill));
    } else {
      collocation::Segment whole(mechanics_->system(line, 0, near), k_);
      whole.initialise_on(a, b, inside, [&](double S, double* u, double* q) { fill(S, u, q, whole.system(), 0); });
      segment_.emplace_back(std::move(whole));
    }
    have_beta = false;
  }
  multiplier_ = 0.0;
  flatten();
  choose_phase();
  number();
}

CutSegment Chain::cut(int j, const std::vector<double>& inside, const std::function<double(double)>& length,
                      const CutFill& fill) const {
  const ScaledProblem& P = mechanics_->problem;
  const auto& pieces = P.law.pieces;
  constexpr double least = 1e-7;  // of the segment: a cut as close to an end as that is left out
  const double a = S_[j], b = S_[j + 1];
  std::vector<Cut> cuts;
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    double low = a + least * (b - a), high = b - least * (b - a);
    if (!(length(low) < pieces[i].from && length(high) > pieces[i].from)) continue;
    while (high - low > 1e-13 * (b - a)) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      (length(middle) < pieces[i].from ? low : high) = middle;
    }
    cuts.push_back({0.5 * (low + high), pieces[i].from, P.marks[i].collar, P.marks[i].load, false});
  }
  for (std::size_t i = 0; i < P.point_loads.size(); ++i) {
    const double S = P.point_loads[i].at;
    if (!P.point_loads[i].on_rod && S > a + least * (b - a) && S < b - least * (b - a))
      cuts.push_back({S, 0.0, -1, static_cast<int>(i), true});
  }
  std::sort(cuts.begin(), cuts.end(), [](const Cut& x, const Cut& y) { return x.S < y.S; });
  std::vector<collocation::Segment> parts;
  std::vector<int> law;
  for (std::size_t q = 0; q <= cuts.size(); ++q) {
    const double left = q == 0 ? a : cuts[q - 1].S, right = q == cuts.size() ? b : cuts[q].S;
    law.push_back(mechanics_->problem.law.piece_at(length(0.5 * (left + right))));
    std::vector<double> points;
    for (const double x : inside)
      if (x > left + 0.02 * (right - left) && x < right - 0.02 * (right - left)) points.push_back(x);
    if (points.size() < 2) points = {left + (right - left) / 3.0, right - (right - left) / 3.0};
    parts.emplace_back(mechanics_->system(line_[j], law.back()), k_);
    // the values before a cut are asked for before it
    const double last = q == cuts.size() ? right : right - 1e-12 * (right - left);
    parts.back().initialise_on(left, right, points, [&](double S, double* u, double* s) {
      fill(std::min(S, last), u, s, parts.back().system(), law.back());
    });
  }
  return {std::move(parts), std::move(cuts), std::move(law)};
}

void Chain::hold(int junction, double S) {
  factored_ = false;  // other conditions, other factors
  if (held_.empty()) held_.assign(segments(), std::nan(""));
  held_[junction] = S;
}

void Chain::release(int junction) {
  factored_ = false;
  if (!held_.empty()) held_[junction] = std::nan("");
}

bool Chain::any_held() const {
  return std::any_of(held_.begin(), held_.end(), [](double s) { return std::isfinite(s); });
}

Chain Chain::recut(const Pattern& pattern) const {
  return recut(pattern, [this](double S, double* u, double* s) { sample(S, u, s); });
}

Chain Chain::recut(const Pattern& pattern, const Sampler& sampler) const {
  Chain c(mechanics_, k_);
  c.p_ = p_;
  c.p_scale_ = p_scale_;
  c.tip_place_ = S_.back();
  std::vector<double> points;
  for (int j = 0; j < segments(); ++j)
    for (int i = 1; i < segment_[j].pieces(); ++i) points.push_back(segment_[j].place(i, S_[j], S_[j + 1]));
  c.build(pattern, points, sampler, [this](double S, double* line, double* s) {
    const int j = segment_at(S);
    if (!line_[j]) return false;
    segment_[j].evaluate(S, S_[j], S_[j + 1], line, s);
    return true;
  });
  return c;
}

void Chain::adopt(const Pattern& pattern, std::vector<collocation::Segment> segments) {
  mechanics_->problem.p = p_;
  take_pattern(pattern);
  if (!S_.empty()) tip_place_ = S_.back();
  S_.assign(1, mechanics_->problem.start_position);
  S_.insert(S_.end(), pattern.S.begin(), pattern.S.end());
  S_.push_back(far_end());
  held_.clear();
  segment_.clear();
  for (auto& s : segments) segment_.emplace_back(std::move(s));
  choose_phase();
  number();
  estimate_error();
}

int Chain::segment_at(double S) const {
  const auto it = std::upper_bound(S_.begin() + 1, S_.end() - 1, S);
  return static_cast<int>(it - S_.begin()) - 1;
}

void Chain::sample(double S, double* u, double* s) const {
  const int j = segment_at(S);
  if (!line_[j]) {
    segment_[j].evaluate(S, S_[j], S_[j + 1], u, s);
    return;
  }
  double line[formulation::state_inputs];
  segment_[j].evaluate(S, S_[j], S_[j + 1], line, s);
  mechanics_->problem.line_to_free(mechanics_->problem.section(S), line, u);
}

bool Chain::turns_freely() const {
  if (!mechanics_->problem.axisymmetric) return false;
  const auto& s = segment_.front();
  double most = 0.0;
  for (int i = 0; i <= s.pieces(); ++i) most = std::max(most, std::hypot(s.state(i)[0], s.state(i)[3]));
  return !line_.front() && most > phase_threshold * mechanics_->problem.clearance_max;
}

void Chain::choose_phase() {
  phase_ = needs_phase();
  if (!phase_) return;
  // the first contact, or the largest eccentricity, is turned to β = 0
  auto& s = segment_.front();
  phase_segment_ = 0;
  phase_piece_ = s.pieces() - 1;
  if (segments() == 1) {
    double most = -1.0;
    for (int i = 1; i < s.pieces(); ++i) {
      const double e = std::hypot(s.state(i)[0], s.state(i)[3]);
      if (e > most) {
        most = e;
        phase_piece_ = i - 1;
      }
    }
  }
  const double* z = s.state(phase_piece_ + 1);
  const double r = std::hypot(z[0], z[3]), c = z[0] / r, sn = z[3] / r;
  auto turn = [&](double& x, double& y) {
    const double a = c * x + sn * y, b = -sn * x + c * y;
    x = a;
    y = b;
  };
  const double angle = std::atan2(sn, c);
  for (int j = 0; j < segments(); ++j)
    for (int part = 0; part < segment_[j].parts(); ++part) {
      auto& seg = segment_[j].part(part);
      const int k = seg.points_per_piece();
      for (int i = 0; i <= seg.pieces(); ++i) {
        double* q = seg.state(i);
        if (line_[j]) {
          q[0] -= angle;
        } else if (near_wall(j)) {
          q[formulation::NearWall::angle] -= angle;
          turn(q[8], q[9]);
        } else {
          for (int d = 0; d < 3; ++d) turn(q[d], q[3 + d]);
          turn(q[8], q[9]);
        }
      }
      if (!line_[j])
        for (int i = 0; i < seg.pieces(); ++i)
          for (int g = 0; g < k; ++g) {
            if (!near_wall(j)) turn(seg.highest(i, g, 0), seg.highest(i, g, 1));
            turn(seg.highest(i, g, 3), seg.highest(i, g, 4));
          }
    }
}

}  // namespace tendril::segmentation

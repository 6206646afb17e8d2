#include "tendril/continuation/lagrangian.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tendril/continuation/lagrangian_conditions.hpp"

namespace tendril::continuation {

using collocation::BvpOptions;
using collocation::BvpSummary;
using collocation::Closure;
using collocation::DualSystem;
using formulation::LagrangianFree;
using formulation::LagrangianLine;
using formulation::Quaternion;
using formulation::TubeJet;
using numerics::cross;
using numerics::dot;
using numerics::operator+;
using numerics::operator-;
using numerics::operator*;

std::function<TubeJet(double)> tube_in_world(const geometry::Tube& tube, double L, double clearance_scale) {
  return [tube, L, clearance_scale](double S) {
    const geometry::AxisPoint a = tube.axis->at(S * L);
    const auto Q = tube.clearance->at(S * L);
    const auto world = [](const geometry::Vec3& v) { return V3<double>{v[0], v[1], v[2]}; };
    // the frame turns with W; W' .. in the world from the components' derivatives
    const geometry::Vec3 &U = a.U[0], &U1 = a.U[1], &U2 = a.U[2], &U3 = a.U[3];
    double unit = L;
    std::array<geometry::Vec3, 4> W = {U, U1, U2 + U.cross(U1), U3 + 2.0 * U.cross(U2) + U.cross(U.cross(U1))};
    for (auto& w : W) {
      w = unit * (a.frame * w);
      unit *= L;
    }
    const auto turned = [&W](const geometry::Vec3& D) {
      std::array<geometry::Vec3, 5> d;
      d[0] = D;
      d[1] = W[0].cross(d[0]);
      d[2] = W[1].cross(d[0]) + W[0].cross(d[1]);
      d[3] = W[2].cross(d[0]) + 2.0 * W[1].cross(d[1]) + W[0].cross(d[2]);
      d[4] = W[3].cross(d[0]) + 3.0 * W[2].cross(d[1]) + 3.0 * W[1].cross(d[2]) + W[0].cross(d[3]);
      return d;
    };
    TubeJet t;
    t.S = S;
    const auto D1 = turned(a.frame.col(0)), D2 = turned(a.frame.col(1)), D3 = turned(a.frame.col(2));
    t.R[0] = world(a.position / L);
    double power = 1.0 / L;
    for (int k = 0; k < 5; ++k) {
      t.D1[k] = world(D1[k]);
      t.D2[k] = world(D2[k]);
      t.R[k + 1] = world(D3[k]);
      t.Q[k] = clearance_scale * Q[k] * power;
      power *= L;
    }
    return t;
  };
}

Quaternion<double> attitude(const V3<double>& d1, const V3<double>& d2, const V3<double>& d3) {
  // the largest of the four components first: no cancellation (Shepperd)
  const double m[3][3] = {{d1[0], d2[0], d3[0]}, {d1[1], d2[1], d3[1]}, {d1[2], d2[2], d3[2]}};
  const double trace = m[0][0] + m[1][1] + m[2][2];
  Quaternion<double> q;
  const double size[4] = {trace, m[0][0], m[1][1], m[2][2]};
  const int i = static_cast<int>(std::max_element(size, size + 4) - size);
  if (i == 0) {
    q = {1.0 + trace, m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]};
  } else {
    const int a = i - 1, b = (a + 1) % 3, c = (a + 2) % 3;
    q[0] = m[c][b] - m[b][c];
    q[1 + a] = 1.0 + m[a][a] - m[b][b] - m[c][c];
    q[1 + b] = m[b][a] + m[a][b];
    q[1 + c] = m[c][a] + m[a][c];
  }
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (double& v : q) v /= norm;
  return q;
}

namespace {

Quaternion<double> attitude(const LagrangianSection& x) {
  return continuation::attitude(x.d1, cross(x.d3, x.d1), x.d3);
}

/// q and -q are one attitude: the sign that makes a family of them continuous from a given one.
class SignTable {
 public:
  template <class Family>
  SignTable(Quaternion<double> from, const Family& family) {
    for (int i = 0; i <= points; ++i) table_.push_back(from = closer(from, family(static_cast<double>(i) / points)));
  }
  Quaternion<double> follow(double fraction, const Quaternion<double>& q) const {
    return closer(table_[std::clamp(static_cast<int>(std::lround(fraction * points)), 0, points)], q);
  }

 private:
  static constexpr int points = 256;
  std::vector<Quaternion<double>> table_;
  static Quaternion<double> closer(const Quaternion<double>& to, const Quaternion<double>& q) {
    const double d = to[0] * q[0] + to[1] * q[1] + to[2] * q[2] + to[3] * q[3];
    return d < 0.0 ? Quaternion<double>{-q[0], -q[1], -q[2], -q[3]} : q;
  }
};

double angle_at(const TubeJet& t, const V3<double>& r) {
  const V3<double> off = r - t.R[0];
  return std::atan2(dot(off, t.D2[0]), dot(off, t.D1[0]));
}

}  // namespace

LagrangianRod::LagrangianRod(LagrangianProblem problem, LagrangianPattern pattern, const std::vector<double>& cuts,
                             const Guess& guess, int pieces, int k, const std::vector<double>& knots)
    : problem_(std::make_shared<LagrangianProblem>(std::move(problem))), pattern_(std::move(pattern)) {
  const int n = segments();
  collocation::BoundaryValueProblem::Systems systems;
  std::vector<double> places, start(n, 0.0);
  const auto* rod = &problem_->rod;
  double S = 0.0;
  const auto closest = [&](double s, double from) {
    return formulation::closest_place<decltype(rod->tube), double>(rod->tube, guess(s).r, from);
  };
  for (int j = 0; j < n; ++j) {
    if (pattern_[j])
      systems.push_back(
          std::make_shared<DualSystem<LagrangianLine, 2 * LagrangianLine::components>>(LagrangianLine{rod}));
    else
      systems.push_back(
          std::make_shared<DualSystem<LagrangianFree, 2 * LagrangianFree::components>>(LagrangianFree{rod}));
    start[j] = S;
    for (int i = 1; i <= 8; ++i) S = closest(cuts[j] + (cuts[j + 1] - cuts[j]) * i / 8, S);
    if (j + 1 < n) places.push_back(S);
  }
  bvp_.emplace(systems, lagrangian_conditions(problem_, pattern_, places), k);
  const SignTable signs(attitude(guess(0.0)), [&](double f) { return attitude(guess(f * cuts[n])); });
  std::vector<std::vector<double>> inside(n);
  for (int j = 0; j < n; ++j)
    for (double s : knots)
      if (pattern_[j] && s > cuts[j] && s < cuts[j + 1]) inside[j].push_back((s - cuts[j]) / (cuts[j + 1] - cuts[j]));
  std::vector<double> near = start, beta(n, 0.0);
  bvp_->initialise(
      [&](int j, double x, double* u, double*) {
        const double s = cuts[j] + (cuts[j + 1] - cuts[j]) * x;
        const LagrangianSection c = guess(s);
        const Quaternion<double> q = signs.follow(s / cuts[n], attitude(c));
        std::vector<double> v;
        if (pattern_[j]) {
          const double from = x == 0.0 ? start[j] : near[j];
          near[j] = closest(s, from);
          const TubeJet t = rod->tube(near[j]);
          double b = angle_at(t, c.r);
          if (x == 0.0) beta[j] = b;
          b += 2.0 * M_PI * std::round((beta[j] - b) / (2.0 * M_PI));
          beta[j] = b;
          const formulation::WallPoint<double> wall(t, near[j], b);
          v = {near[j], b};
          v.insert(v.end(), q.begin(), q.end());
          v.insert(v.end(), c.M.begin(), c.M.end());
          v.push_back(dot(c.F, c.d3));
          v.push_back(dot(c.F, cross(wall.N, c.d3)));
        } else {
          v.assign(c.r.begin(), c.r.end());
          v.insert(v.end(), q.begin(), q.end());
          v.insert(v.end(), c.F.begin(), c.F.end());
          v.insert(v.end(), c.M.begin(), c.M.end());
        }
        v.push_back(cuts[j + 1] - cuts[j]);
        for (std::size_t i = 0; i < v.size(); ++i) u[2 * i] = v[i], u[2 * i + 1] = 0.0;
        std::vector<double> rate(v.size());
        systems[j]->residual(x, u, rate.data());
        for (std::size_t i = 0; i < v.size(); ++i) u[2 * i + 1] = -rate[i];
      },
      pieces, inside);
}

BvpSummary LagrangianRod::solve_force(double value, const BvpOptions& options) {
  return bvp_->solve(Closure::at(value), options);
}

BvpSummary LagrangianRod::solve_length(double length, const BvpOptions& options) {
  return solve_lengths(0, segments(), length, options);
}

BvpSummary LagrangianRod::solve_segment_length(int j, double length, const BvpOptions& options) {
  return solve_lengths(j, j + 1, length, options);
}

BvpSummary LagrangianRod::solve_lengths(int first, int last, double length, const BvpOptions& options) {
  int ends = 0;
  std::vector<int> entries;  // of the segments' lengths among the ends
  for (int j = 0; j < segments(); ++j) {
    const int n = bvp_->segment(j).states();
    if (j >= first && j < last) entries.push_back(ends + n - 1);
    ends += 2 * n;
  }
  return bvp_->solve(Closure::where({1,
                                     [=](const double* e, double, double* r, double* jac) {
                                       r[0] = -length;
                                       if (jac) std::fill_n(jac, ends + 1, 0.0);
                                       for (int i : entries) {
                                         r[0] += e[i];
                                         if (jac) jac[i] = 1.0;
                                       }
                                     }}),
                     options);
}

double LagrangianRod::cut(int j) const {
  double s = 0.0;
  for (int i = 0; i < j; ++i) s += bvp_->end_value(i, false, pattern_[i] ? 11 : 13);
  return s;
}

LagrangianSection LagrangianRod::at(int j, double x) const {
  double u[2 * LagrangianFree::components];
  bvp_->evaluate(j, x, u, nullptr);
  LagrangianSection c;
  c.line = pattern_[j];
  const int l = c.line ? 22 : 26, iq = c.line ? 4 : 6, iM = c.line ? 12 : 20;
  c.s = cut(j) + x * u[l];
  const Quaternion<double> q{u[iq], u[iq + 2], u[iq + 4], u[iq + 6]};
  c.M = {u[iM], u[iM + 2], u[iM + 4]};
  c.d1 = formulation::director1(q);
  c.d3 = formulation::director3(q);
  if (c.line) {
    const TubeJet t = problem_->rod.tube(u[0]);
    const formulation::LagrangianContact<double> contact(problem_->rod, t, u[0], u[2], q, c.M, u[18], u[20]);
    c.r = formulation::WallPoint<double>(t, u[0], u[2]).X;
    c.F = contact.F;
    c.N = contact.N;
    c.pressure = formulation::lagrangian_pressure(problem_->rod, u);
  } else {
    c.r = {u[0], u[2], u[4]};
    c.F = {u[14], u[16], u[18]};
  }
  c.stretch = 1.0 + problem_->rod.material.eta2 * dot(c.F, c.d3);
  return c;
}

LagrangianSection LagrangianRod::at(double s) const {
  int j = 0;
  while (j + 1 < segments() && s >= cut(j + 1)) ++j;
  const double a = cut(j), b = cut(j + 1);
  return at(j, std::clamp((s - a) / (b - a), 0.0, 1.0));
}

LagrangianSection LagrangianRod::at_place(double S) const {
  // s(S) increases: bracket by bisection on the sign of (r - R(S))·D3(S), then secant steps
  const TubeJet t = problem_->rod.tube(S);
  const auto ahead = [&](double s) { return dot(at(s).r - t.R[0], t.R[1]); };
  double lo = 0.0, hi = length(), f_lo = ahead(lo), f_hi = ahead(hi);
  if (f_lo >= 0.0) return at(lo);
  if (f_hi <= 0.0) return at(hi);
  int side = 0;
  for (int it = 0; it < 100 && hi - lo > 1e-15; ++it) {
    double s = lo - f_lo * (hi - lo) / (f_hi - f_lo);
    if (!(s > lo && s < hi)) s = 0.5 * (lo + hi);
    const double f = ahead(s);
    if (std::abs(f) < 1e-16) return at(s);
    if (f < 0.0) {
      lo = s, f_lo = f;
      if (side == -1) f_hi *= 0.5;
      side = -1;
    } else {
      hi = s, f_hi = f;
      if (side == 1) f_lo *= 0.5;
      side = 1;
    }
  }
  return at(0.5 * (lo + hi));
}

double LagrangianRod::jump(int j) const {
  const LagrangianSection a = at(j - 1, 1.0), b = at(j, 0.0);
  double S = 0.0;
  for (int i = 1; i <= 16; ++i)
    S = formulation::closest_place<decltype(problem_->rod.tube), double>(problem_->rod.tube, at(cut(j) * i / 16).r, S);
  const TubeJet t = problem_->rod.tube(S);
  const V3<double> N = formulation::WallPoint<double>(t, S, angle_at(t, b.r)).N;
  return dot(b.F - a.F, N);
}

TubeView seen_from_tube(const LagrangianProblem& problem, const LagrangianSection& x, double S_guess) {
  TubeView v;
  const auto& tube = problem.rod.tube;
  v.S = formulation::closest_place<std::decay_t<decltype(tube)>, double>(tube, x.r, S_guess);
  const TubeJet t = tube(v.S);
  const V3<double> off = x.r - t.R[0], &D1 = t.D1[0], &D2 = t.D2[0], &D3 = t.R[1];
  v.delta1 = dot(off, D1);
  v.delta2 = dot(off, D2);
  v.gap = t.Q[0] - std::sqrt(v.delta1 * v.delta1 + v.delta2 * v.delta2);
  v.N = formulation::WallPoint<double>(t, v.S, angle_at(t, x.r)).N;
  // D turned by the smallest rotation that takes D3 to d3
  const auto turned = [&](const V3<double>& D) { return D - (dot(D, x.d3) / (1.0 + dot(D3, x.d3))) * (D3 + x.d3); };
  const V3<double> k[3] = {turned(D1), turned(D2), x.d3};
  for (int i = 0; i < 3; ++i) {
    v.F[i] = dot(x.F, k[i]);
    v.M[i] = dot(x.M, k[i]);
  }
  v.phi = std::atan2(dot(x.d1, k[1]), dot(x.d1, k[0]));
  return v;
}

}  // namespace tendril::continuation

#include "tendril/segmentation/nested.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tendril/numerics/line_search.hpp"
#include "tendril/segmentation/end_state.hpp"

namespace tendril::segmentation {
namespace {

using collocation::Segment;
using formulation::Section;
using numerics::Dual;

constexpr int per_junction = 4;  // S, β, β', φ; and ⟦κ_g⟧, ⟦κ_n⟧, ⟦F_g⟧, ⟦φ⟧

template <class T>
struct Wall {
  formulation::Lifted<T> l;
  std::array<T, 4> Q;
  Wall(const ScaledProblem& P, double S, const T& dS) {
    const Section sec = P.section(S);
    l = formulation::lift<T>(sec, dS, T(0.0));
    Q = formulation::lift_clearance<T>(sec, dS, T(0.0));
  }
};

using StateDual = Dual<13>;  // 12 states (8 of a line contact) and S

struct EndOf {
  StateDual x[12];
  Wall<StateDual> wall;
  EndOf(const ScaledProblem& P, const Segment& s, bool left, double S) : wall(P, S, StateDual::seed(0.0, 12)) {
    const double* z = s.state(left ? 0 : s.pieces());
    for (int i = 0; i < s.states(); ++i) x[i] = StateDual::seed(z[i], i);
  }
};

/// d(f)/dy from the rates of the end state and of the end's S.
Eigen::RowVectorXd rate(const StateDual& f, const Eigen::MatrixXd& state_rate, int column_of_S) {
  Eigen::RowVectorXd r = Eigen::RowVectorXd::Zero(state_rate.cols());
  for (int q = 0; q < state_rate.rows(); ++q) r += f.d[q] * state_rate.row(q);
  if (column_of_S >= 0) r[column_of_S] += f.d[12];
  return r;
}

/// One elementary problem's data from the junctions, with their derivatives with respect to y.
struct Deduced {
  BoundaryData data;
  Eigen::MatrixXd by_y;
};

/// Data of one side at a junction (unknowns S, β, β', φ): the angle first when `left`, then place and slope.
void junction_side(const ScaledProblem& P, bool line, bool left, const double* y, std::vector<Dual<4>>& out) {
  using T = Dual<4>;
  const T beta = T::seed(y[1], 1), slope = T::seed(y[2], 2), phi = T::seed(y[3], 3);
  const Wall<T> wall(P, y[0], T::seed(0.0, 0));
  const WallPlace<T> at(wall.l, wall.Q, beta, slope);
  if (line) {
    if (left) out.push_back(phi + at.turn);
    out.insert(out.end(), {beta, slope});
  } else {
    if (left) out.push_back(phi);
    out.insert(out.end(), {at.d1, at.d1p, at.d2, at.d2p});
  }
}

/// The same at an end of the rod; β is taken within half a turn of `near`.
void support_side(const ScaledProblem& P, bool line, bool left, double near, std::vector<Dual<4>>& out) {
  const auto& e = left ? P.start : P.end;
  const double e1 = P.now(e.eccentricity[0]), e2 = P.now(e.eccentricity[1]);
  const double s1 = P.now(e.slope[0]), s2 = P.now(e.slope[1]), roll = P.now(e.roll);
  if (!line) {
    if (left) out.push_back(roll);
    out.insert(out.end(), {e1, s1, e2, s2});
    return;
  }
  const double beta = near + wrapped(std::atan2(e2, e1) - near), slope = (e1 * s2 - e2 * s1) / (e1 * e1 + e2 * e2);
  if (left) {
    const Wall<double> wall(P, 0.0, 0.0);
    out.push_back(roll + WallPlace<double>(wall.l, wall.Q, beta, slope).turn);
  }
  out.insert(out.end(), {beta, slope});
}

Deduced deduce(const ScaledProblem& P, const Eigen::VectorXd& y, int j, int n, const Segment& guess,
               const double transmitted[2], const Eigen::MatrixXd& transmitted_rate) {
  const bool line = is_line(guess);
  Deduced d;
  std::vector<Dual<4>> left, right;
  if (j > 0)
    junction_side(P, line, true, &y[per_junction * (j - 1)], left);
  else
    support_side(P, line, true, guess.state(0)[0], left);
  if (j + 1 < n)
    junction_side(P, line, false, &y[per_junction * j], right);
  else
    support_side(P, line, false, guess.state(guess.pieces())[0], right);
  d.data.S_a = j > 0 ? y[per_junction * (j - 1)] : 0.0;
  d.data.S_b = j + 1 < n ? y[per_junction * j] : P.now(P.end_position);
  for (const auto& v : left) d.data.left.push_back(v.v);
  d.data.right = {transmitted[0], transmitted[1]};
  for (const auto& v : right) d.data.right.push_back(v.v);
  d.by_y = Eigen::MatrixXd::Zero(d.data.count(), y.size());
  const int nl = static_cast<int>(left.size()), total = d.data.count();
  if (j > 0) {
    for (int i = 0; i < nl; ++i)
      for (int q = 0; q < per_junction; ++q) d.by_y(i, per_junction * (j - 1) + q) = left[i].d[q];
    d.by_y(total - 2, per_junction * (j - 1)) = 1.0;
  }
  d.by_y.middleRows(nl, 2) = transmitted_rate;
  if (j + 1 < n) {
    for (std::size_t i = 0; i < right.size(); ++i)
      for (int q = 0; q < per_junction; ++q) d.by_y(nl + 2 + static_cast<int>(i), per_junction * j + q) = right[i].d[q];
    d.by_y(total - 1, per_junction * j) = 1.0;
  }
  return d;
}

/// The guess between new ends: as it is while its pieces keep a sound width, else stretched on a new mesh.
Segment between(const ScaledProblem& P, const Segment& s, const BoundaryData& from, const BoundaryData& to) {
  const double least = 0.05 * (to.S_b - to.S_a) / s.pieces();
  bool sound = true;
  for (int i = 0; i < s.pieces(); ++i) {
    const double before = s.place(i + 1, from.S_a, from.S_b) - s.place(i, from.S_a, from.S_b);
    const double now = s.place(i + 1, to.S_a, to.S_b) - s.place(i, to.S_a, to.S_b);
    sound = sound && (now > least || now > 0.3 * before);
  }
  if (sound) return s;
  Segment t = s;
  const double stretch = (from.S_b - from.S_a) / (to.S_b - to.S_a);
  t.initialise(to.S_a, to.S_b, P.knots, s.pieces(), [&](double S, double* u, double* q) {
    s.evaluate(from.S_a + stretch * (S - to.S_a), from.S_a, from.S_b, u, q);
  });
  return t;
}

/// Ends between which element j of a propagation over y was solved.
BoundaryData ends(const ScaledProblem& P, const Eigen::VectorXd& y, int j, int n) {
  BoundaryData d;
  d.S_a = j > 0 ? y[per_junction * (j - 1)] : 0.0;
  d.S_b = j + 1 < n ? y[per_junction * j] : P.now(P.end_position);
  return d;
}

}  // namespace

std::string nested_refusal(const Chain& chain) {
  const ScaledProblem& P = chain.mechanics().problem;
  const auto held = [](End::Kind k) { return k == End::Kind::clamped || k == End::Kind::sleeve; };
  if (!held(P.start.kind) || !held(P.end.kind)) return "the nested procedures treat clamped and sleeve ends only";
  if (P.source.axial != AxialControl::axial_force || P.source.axial_at != Which::end)
    return "the nested procedures need the axial force at the end";
  if (P.source.twist != TwistControl::torque || P.source.twist_at != Which::end)
    return "the nested procedures need the torque at the end and the roll at the start";
  if (chain.mechanics().problem.planar) return "the nested procedures do not treat planar problems";
  if (chain.needs_phase()) return "the nested procedures do not treat states that may turn freely about the axis";
  if (chain.any_held()) return "a junction is held in place";
  for (int j = 0; j + 1 < chain.segments(); ++j)
    if (chain.is_line(j) && chain.is_line(j + 1)) return "two line contacts follow one another";
  return "";
}

Eigen::VectorXd junction_unknowns(const Chain& chain) {
  const int n = chain.segments();
  Eigen::VectorXd y(per_junction * (n - 1));
  for (int k = 0; k + 1 < n; ++k) {
    const Segment &l = chain.segment(k), &r = chain.segment(k + 1);
    const double* zf = chain.is_line(k) ? r.state(0) : l.state(l.pieces());  // free side
    double* q = &y[per_junction * k];
    q[0] = chain.S(k + 1);
    q[3] = zf[6];
    if (chain.is_line(k) || chain.is_line(k + 1)) {
      const double* zc = chain.is_line(k) ? l.state(l.pieces()) : r.state(0);
      q[1] = zc[0];
      q[2] = zc[1];
    } else {
      q[1] = std::atan2(zf[3], zf[0]);
      q[2] = (zf[0] * zf[4] - zf[3] * zf[1]) / (zf[0] * zf[0] + zf[3] * zf[3]);
    }
  }
  return y;
}

Propagation propagate_solution(const ScaledProblem& P, const Eigen::VectorXd& y, const std::vector<Segment>& guess,
                               const SequenceOptions& options, bool sensitivities) {
  Propagation out;
  const int n = static_cast<int>(guess.size()), m = static_cast<int>(y.size());
  out.element.resize(n);
  ElementaryOptions elementary;
  elementary.newton = options.newton;
  elementary.accuracy = options.accuracy;
  elementary.sensitivities = sensitivities;
  double transmitted[2] = {P.now(P.axial), P.now(P.twist)};
  Eigen::MatrixXd transmitted_rate = Eigen::MatrixXd::Zero(2, m);
  std::vector<Eigen::MatrixXd> left_rate(n), right_rate(n);  // of the end states, with respect to y
  for (int j = n - 1; j >= 0; --j) {
    const Deduced d = deduce(P, y, j, n, guess[j], transmitted, transmitted_rate);
    ElementarySolution& e = out.element[j];
    e = solve_elm_prob(P, d.data, guess[j], elementary);
    out.iterations += e.iterations;
    out.factorisations += e.factorisations;
    if (!e.converged) {
      out.reason = e.reason;
      return out;
    }
    if (sensitivities) {
      left_rate[j] = e.left_rate * d.by_y;
      right_rate[j] = e.right_rate * d.by_y;
    }
    if (j == 0) break;
    const EndOf end(P, e.segment, true, d.data.S_a);
    const Transmitted<StateDual> t(P.material, is_line(e.segment), end.wall.l, end.wall.Q, end.x);
    transmitted[0] = t.F3.v;
    transmitted[1] = t.M3.v;
    if (sensitivities) {
      transmitted_rate.row(0) = rate(t.F3, left_rate[j], per_junction * (j - 1));
      transmitted_rate.row(1) = rate(t.M3, left_rate[j], per_junction * (j - 1));
    }
  }
  out.residual.resize(m);
  if (sensitivities) out.jacobian.resize(m, m);
  for (int k = 0; k + 1 < n; ++k) {
    const Segment &l = out.element[k].segment, &r = out.element[k + 1].segment;
    const int S = per_junction * k;
    const EndOf a(P, l, false, y[S]), b(P, r, true, y[S]);
    const JunctionSide<StateDual> left(P.material, is_line(l), a.wall.l, a.wall.Q, a.x);
    const JunctionSide<StateDual> right(P.material, is_line(r), b.wall.l, b.wall.Q, b.x);
    const StateDual* of_left[4] = {&left.kg, &left.kn, &left.Fg, &left.phi};
    const StateDual* of_right[4] = {&right.kg, &right.kn, &right.Fg, &right.phi};
    for (int q = 0; q < per_junction; ++q) {
      out.residual[S + q] = of_right[q]->v - of_left[q]->v;
      if (sensitivities)
        out.jacobian.row(S + q) = rate(*of_right[q], left_rate[k + 1], S) - rate(*of_left[q], right_rate[k], S);
    }
  }
  out.converged = out.residual.allFinite() && (!sensitivities || out.jacobian.allFinite());
  if (!out.converged) out.reason = "the jumps at the junctions are not finite";
  return out;
}

SequenceSummary solve_sequence(Chain& chain, double parameter, const SequenceOptions& options) {
  SequenceSummary sum;
  sum.reason = nested_refusal(chain);
  if (!sum.reason.empty()) return sum;
  ScaledProblem& P = chain.mechanics_ptr()->problem;
  const double p_before = chain.parameter(), end_before = chain.S(chain.segments());
  const int n = chain.segments(), m = per_junction * (n - 1);
  chain.use_eccentricities();
  Eigen::VectorXd y = junction_unknowns(chain), scale(m);
  P.p = parameter;

  auto propagate = [&](const Eigen::VectorXd& at, const Eigen::VectorXd& from, const std::vector<Segment>& guess,
                       bool sensitivities, double end_from) {
    std::vector<Segment> start;
    for (int j = 0; j < n; ++j) {
      BoundaryData was = ends(P, from, j, n);
      if (j + 1 == n) was.S_b = end_from;
      start.push_back(between(P, guess[j], was, ends(P, at, j, n)));
    }
    Propagation X = propagate_solution(P, at, start, options, sensitivities);
    ++sum.propagations;
    sum.jacobians += sensitivities;
    sum.elementary_iterations += X.iterations;
    sum.factorisations += X.factorisations;
    return X;
  };
  auto segments = [&](const Propagation& X) {
    std::vector<Segment> s;
    for (const auto& e : X.element) s.push_back(e.segment);
    return s;
  };
  auto fail = [&](const std::string& why) {
    sum.reason = why;
    P.p = p_before;
    return sum;
  };
  auto finish = [&](const Propagation& X) {
    Pattern pattern = chain.pattern();
    for (int k = 0; k + 1 < n; ++k) pattern.S[k] = y[per_junction * k];
    std::vector<Segment> solved = segments(X);
    double length = 0.0;  // s continues from segment to segment
    for (Segment& s : solved) {
      for (int i = 0; i <= s.pieces(); ++i) s.state(i)[s.states() - 1] += length;
      length = s.state(s.pieces())[s.states() - 1];
    }
    chain.set_parameter(parameter);
    chain.adopt(pattern, std::move(solved));
    sum.converged = true;
    return sum;
  };
  auto norm_of = [&](const Eigen::VectorXd& v) {
    const double most = v.size() ? v.cwiseQuotient(scale).lpNorm<Eigen::Infinity>() : 0.0;
    return std::isfinite(most) ? most : std::numeric_limits<double>::infinity();
  };

  std::vector<Segment> first;
  for (int j = 0; j < n; ++j) first.push_back(chain.segment(j));
  Propagation X = propagate(y, y, first, true, end_before);
  if (!X.converged) return fail(X.reason);
  if (m == 0) return finish(X);
  const double end = P.now(P.end_position);
  for (int i = 0; i < m; ++i) scale[i] = i % per_junction == 2 ? std::max(1.0, std::abs(y[i])) : 1.0;

  Eigen::MatrixXd J = X.jacobian;
  bool fresh = true;
  double damping = 1.0;
  while (sum.iterations < options.newton.max_iterations) {
    ++sum.iterations;
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(J * scale.asDiagonal());
    if (!lu.isInvertible()) return fail("the Jacobian of the junctions is singular");
    auto correction = [&](const Eigen::VectorXd& G) { return Eigen::VectorXd(-scale.cwiseProduct(lu.solve(G))); };
    const Eigen::VectorXd p = correction(X.residual);
    const double norm = norm_of(p);
    sum.correction = norm;
    if (!std::isfinite(norm)) return fail("the correction of the junctions is not finite");
    // no span may collapse within one step
    double limit = 1.0;
    for (int j = 0; j < n; ++j) {
      const BoundaryData now = ends(P, y, j, n), then = ends(P, y + p, j, n);
      const double h = now.S_b - now.S_a, h1 = then.S_b - then.S_a;
      if (h1 < 0.3 * h) limit = std::min(limit, 0.7 * h / (h - h1));
    }
    damping = std::min({1.0, limit, options.newton.residual_line_search ? 1.0 : damping});
    const Eigen::VectorXd weight = (J * scale.asDiagonal()).cwiseAbs().rowwise().maxCoeff().cwiseInverse();
    auto merit = [&](const Eigen::VectorXd& G) { return 0.5 * weight.cwiseProduct(G).squaredNorm(); };
    numerics::Backtracking search(merit(X.residual));
    const std::vector<Segment> base = segments(X);
    bool retry_fresh = false;
    for (;;) {
      const Eigen::VectorXd trial = y + damping * p;
      Propagation Xt = propagate(trial, y, base, !options.broyden, end);
      double bar_norm = std::numeric_limits<double>::infinity(), bend = 0.0, f = bar_norm;
      Eigen::VectorXd bar;
      if (Xt.converged) {
        bar = correction(Xt.residual);
        bar_norm = norm_of(bar);
        bend = norm_of(bar - (1.0 - damping) * p);
        f = merit(Xt.residual);
      }
      const double contraction = bar_norm / std::max(norm, 1e-300);
      // at rounding level of the elementary problems nothing better can be had
      const bool floor = norm < 1e-8 && contraction > 0.5 && bar_norm < 1e3 * options.newton.tolerance;
      if (damping > 0.99 && (bar_norm <= options.newton.tolerance || floor)) {
        sum.correction = bar_norm;
        const Propagation last = propagate(trial + bar, trial, segments(Xt), false, end);
        if (!last.converged) return fail(last.reason);
        y = trial + bar;
        return finish(last);
      }
      const bool descends =
          options.newton.residual_line_search ? search.sufficient(damping, f) : contraction < 1.0 - 0.25 * damping;
      const double best = bend > 0.0 ? 0.5 * damping * damping * norm / bend : 0.0;
      if (descends || (damping > 0.99 && norm < 1e-8 && contraction < 2.0)) {
        if (options.broyden) {  // secant condition with the least change, in scaled unknowns
          const Eigen::VectorXd s = damping * p, t = s.cwiseQuotient(scale.cwiseAbs2());
          J += (Xt.residual - X.residual - J * s) * t.transpose() / t.dot(s);
          fresh = false;
        } else {
          J = Xt.jacobian;
        }
        y = trial;
        X = std::move(Xt);
        damping = damping > 0.99 ? 1.0 : std::min(1.0, std::max(best, 0.5 * damping));
        break;
      }
      if (!fresh) {  // before a shorter step, a true Jacobian
        retry_fresh = true;
        break;
      }
      damping = options.newton.residual_line_search ? search.next(damping, f)
                                                    : std::clamp(best, 0.1 * damping, 0.5 * damping);
      if (damping < options.newton.min_damping)
        return fail(Xt.converged ? "the damped iteration over the junctions found no acceptable step" : Xt.reason);
    }
    if (retry_fresh) {
      X = propagate(y, y, base, true, end);
      if (!X.converged) return fail(X.reason);
      J = X.jacobian;
      fresh = true;
      damping = 1.0;
    }
  }
  return fail("the junctions did not converge within the allowed number of iterations");
}

}  // namespace tendril::segmentation

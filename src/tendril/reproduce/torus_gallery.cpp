#include "tendril/reproduce/torus_gallery.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tendril/reproduce/system.hpp"
#include "tendril/reproduce/torus_energy.hpp"

namespace tendril::reproduce::torus {
namespace {

using collocation::Closure;
using continuation::BranchEvent;
using continuation::BranchOptions;

constexpr double pi = std::numbers::pi;

/// How accurately states that are only passed are solved; those kept are solved again.
BranchOptions following(int direction, double last) {
  BranchOptions options;
  options.direction = direction;
  (direction < 0 ? options.p_min : options.p_max) = last;
  options.solve.tolerance = 1e-6;
  options.event_tolerance = 1e-5;
  options.max_step = 0.1;
  options.max_points = 300;
  return options;
}

void solve(BoundaryValueProblem& problem, double p) {
  collocation::BvpOptions options;
  options.tolerance = accuracy;
  const auto summary = problem.solve(Closure::at(p), options);
  if (!summary.converged) throw std::runtime_error("closed rod on the torus: " + summary.reason);
}

/// At the same azimuth two revolutions of the rod have the same angle.
int self_crossings(const Family& unit, const BoundaryValueProblem& winding, int revolutions, int windings) {
  // β of the whole rod, with the same number of places in every revolution, off the symmetric ones
  constexpr int step = 400;
  const int n = step * revolutions;
  const double turn = static_cast<double>(revolutions) / windings;
  std::vector<double> beta(n + 1);
  for (int i = 0; i <= n; ++i) {
    const double x = (i + 0.37) / step / turn, whole_turns = std::floor(x);
    beta[i] = point_at(unit, winding, x - whole_turns).beta + 2.0 * pi * whole_turns;
  }
  int count = 0;
  for (int j = 1; j < revolutions; ++j) {
    const auto between = [&](int i) {  // the two, in whole turns around the tube
      const int k = i + j * step;
      const double ahead = k <= n ? beta[k] : beta[k - n] + 2.0 * pi * windings;
      return static_cast<int>(std::floor((ahead - beta[i]) / (2.0 * pi)));
    };
    for (int i = 0; i < n; ++i) count += std::abs(between(i + 1) - between(i));
  }
  return count / 2;  // each is seen from both revolutions
}

/// A knot as stationary energy from a rough start, β = ξ/turn + Σ c_k sin(k ξ/turn), then as boundary value problem.
BoundaryValueProblem from_energy(const Family& family, double turn, const std::vector<double>& c) {
  constexpr int places = 200;
  std::vector<double> start;
  for (int i = 0; i < places; ++i) {
    const double angle = pi * (i + 0.5) / places;
    start.push_back(angle);
    for (std::size_t k = 0; k < c.size(); ++k) start.back() += c[k] * std::sin((k + 1) * angle);
  }
  const EnergyTwin twin = energy_twin(family.rod.epsilon, turn, family.held, start, 24 + static_cast<int>(16 * turn));
  if (!twin.converged) throw std::runtime_error("closed rod on the torus: the energy's iteration did not converge");
  BoundaryValueProblem problem = make_problem(family, turn, 12 + static_cast<int>(12 * turn),
                                              series_sampler(family.rod, turn, twin.H, twin.coefficients));
  solve(problem, turn);
  return problem;
}

}  // namespace

std::string Knot::name() const {
  std::string text = "(" + std::to_string(revolutions) + "," + std::to_string(windings) + ")";
  if (crossings > 0) text += "*";
  return met > 1 ? text + " no. " + std::to_string(met) : text;
}

BoundaryValueProblem villarceau_circle(const Rod& rod) {
  BoundaryValueProblem circle = make_problem({rod, 1, Family::Vary::turn, 0.0}, 1.0, 12, villarceau_sampler(rod));
  solve(circle, 1.0);
  return circle;
}

Gallery gallery(const Rod& rod, double force, const std::function<bool(double turn)>& going) {
  const Family family{rod, 1, Family::Vary::turn, force};
  const BoundaryValueProblem circle = villarceau_circle(rod);
  Gallery g;
  g.knots.push_back({1, 1, family, circle, 1, 0});
  struct Type {
    int revolutions, windings;
  };
  const std::vector<Type> few{{2, 3}, {1, 2}, {2, 5}, {1, 3}, {1, 4}, {1, 5}, {1, 6}},
      many{{3, 2}, {2, 1}, {5, 2}, {3, 1}, {4, 1}, {5, 1}, {6, 1}};
  for (const auto& types : {few, many}) {
    BoundaryValueProblem problem = circle;
    const double last = static_cast<double>(types.back().revolutions) / types.back().windings;
    BranchOptions options = following(last < 1.0 ? -1 : 1, last);
    for (std::size_t i = 0; i + 1 < types.size(); ++i) {
      const double turn = static_cast<double>(types[i].revolutions) / types[i].windings;
      options.functions.push_back([turn](const BoundaryValueProblem& q) { return q.parameter() - turn; });
    }
    std::vector<double> turns, slopes, H;
    options.stop = [&](const BoundaryValueProblem& q) {
      const Point start = point_at(family, q, 0.0);
      turns.push_back(q.parameter());
      slopes.push_back(start.slope);
      H.push_back(start.H);
      if (going && !going(q.parameter())) throw Interrupted{};
      return false;
    };
    auto branch = continuation::follow(problem, options);
    if (branch.failed) throw std::runtime_error("family of closed rods: " + branch.ended);
    std::vector<int> met(types.size(), 0);
    const auto keep = [&](std::size_t i, BoundaryValueProblem state) {
      const auto [revolutions, windings] = types[i];
      solve(state, static_cast<double>(revolutions) / windings);
      const int crossings = self_crossings(family, state, revolutions, windings);
      g.knots.push_back({revolutions, windings, family, std::move(state), ++met[i], crossings});
    };
    for (const BranchEvent& e : branch.events) {
      if (e.kind == BranchEvent::Kind::zero) keep(e.function, e.problem);
      if (e.kind == BranchEvent::Kind::fold) g.folds.push_back(e.p);
      if (e.kind == BranchEvent::Kind::branch_point) {
        const bool origin = std::abs(point_at(family, e.problem, 0.0).slope) < 1e-3;
        (origin ? g.other_origins : g.branch_points).push_back(e.p);
      }
    }
    options.stop(problem);  // the last place belongs to the curve, too
    keep(types.size() - 1, problem);
    if (last < 1.0) {  // one curve from few revolutions to many
      std::reverse(turns.begin(), turns.end());
      std::reverse(slopes.begin(), slopes.end());
      std::reverse(H.begin(), H.end());
    }
    g.turns.insert(g.turns.end(), turns.begin(), turns.end());
    g.slopes.insert(g.slopes.end(), slopes.begin(), slopes.end());
    g.H.insert(g.H.end(), H.begin(), H.end());
  }
  // Rough starts of knots that do not pass through themselves; none is known for (6,1).
  const std::vector<std::pair<int, std::vector<double>>> starts{
      {3, {-1.55, 0.53, 0.37}}, {4, {-1.46, 0.62, -0.44, -0.36}}, {5, {-1.54, 0.59, -0.43, 0.35, 0.37}}};
  if (rod.M3 == 0.0 && rod.material.eta2 == 0.0)
    for (const auto& [revolutions, c] : starts) {
      BoundaryValueProblem state = from_energy(family, revolutions, c);
      const int crossings = self_crossings(family, state, revolutions, 1);
      g.knots.push_back({revolutions, 1, family, std::move(state), 0, crossings});
      if (going && !going(revolutions)) throw Interrupted{};
    }
  return g;
}

BoundaryValueProblem whole(const Knot& knot, Family& family) {
  family = knot.unit;
  family.windings = knot.windings;
  BoundaryValueProblem problem = make_problem(family, knot.revolutions, knot.windings * knot.winding.pieces(),
                                              repeated(knot.winding, knot.windings));
  solve(problem, knot.revolutions);
  return problem;
}

Loads loads(const Knot& knot, double end, const std::vector<double>& asked, double floor) {
  Loads out;
  out.family = knot.unit;
  out.family.vary = Family::Vary::force;
  out.family.held = knot.turn();
  const double start = force_parameter(knot.unit.held);
  BoundaryValueProblem problem = make_problem(out.family, start, knot.winding.pieces(), repeated(knot.winding, 1));
  solve(problem, start);
  const double last = force_parameter(end);
  BranchOptions options = following(last < start ? -1 : 1, last);
  for (double force : asked)
    options.functions.push_back(
        [p = force_parameter(force)](const BoundaryValueProblem& q) { return q.parameter() - p; });
  options.stop = [&](const BoundaryValueProblem& q) {
    const auto all = points(out.family, q, 200);
    out.force.push_back(all.front().F3);
    out.slope.push_back(all.front().slope);
    out.length.push_back(all.back().s);
    out.least_along = 1.0;
    for (const Point& p : all) out.least_along = std::min(out.least_along, p.along);
    return out.least_along < floor;
  };
  const auto branch = continuation::follow(problem, options);
  out.ended = branch.ended;
  for (const BranchEvent& e : branch.events) {
    if (e.kind == BranchEvent::Kind::fold) out.folds.push_back(out.family.force(e.p));
    if (e.kind == BranchEvent::Kind::branch_point) out.branch_points.push_back(out.family.force(e.p));
    if (e.kind == BranchEvent::Kind::zero) {
      out.asked.push_back(e.problem);
      solve(out.asked.back(), force_parameter(asked[e.function]));
    }
  }
  options.stop(problem);  // the last place belongs to the curve, too
  if (std::abs(problem.parameter() - last) < 1e-9) {
    out.asked.push_back(problem);
    solve(out.asked.back(), last);
  }
  return out;
}

}  // namespace tendril::reproduce::torus

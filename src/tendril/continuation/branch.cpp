#include "tendril/continuation/branch.hpp"

#include <algorithm>
#include <cmath>

namespace tendril::continuation {

using collocation::BvpOptions;
using collocation::Closure;

namespace {

/// Direction of the branch at a state: unit tangent, plane normal (metric times tangent), signs of two determinants.
struct Direction {
  std::vector<double> tangent, normal;
  int fixed = 0, bordered = 0;
};

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// `along`: vector over the unknowns that the tangent must not oppose, weighted by `metric`.
bool direction(BoundaryValueProblem& b, const std::vector<double>& along, Direction& out) {
  const std::vector<double> metric = b.metric();
  const int ip = b.column_of_p();
  int held = ip;
  double most = 0.0;
  for (int i = 0; i < b.unknowns(); ++i)
    if (const double size = std::abs(along[i]) * std::sqrt(metric[i]); size > most) {
      most = size;
      held = i;
    }
  // p is held unless something else moves much faster
  if (std::abs(along[ip]) * std::sqrt(metric[ip]) > 0.5 * most) held = ip;
  if (!b.tangent(held, out.tangent)) return false;
  const int sign = b.determinant_sign();
  double square = 0.0, forward = 0.0;
  for (int i = 0; i < b.unknowns(); ++i) {
    square += metric[i] * out.tangent[i] * out.tangent[i];
    forward += metric[i] * out.tangent[i] * along[i];
  }
  const double unit = (forward < 0.0 ? -1.0 : 1.0) / std::sqrt(square);
  // Cramer: det with row c is det with the unit row of `held` times c·t, t the tangent with t[held] = 1
  out.bordered = unit > 0.0 ? sign : -sign;
  out.fixed = out.tangent[ip] > 0.0 ? sign : -sign;
  out.normal.resize(out.tangent.size());
  for (std::size_t i = 0; i < metric.size(); ++i) {
    out.tangent[i] *= unit;
    out.normal[i] = metric[i] * out.tangent[i];
  }
  return true;
}

class Follower {
 public:
  Follower(BoundaryValueProblem& b, const BranchOptions& o) : b_(b), o_(o) { fixed_mesh_.adapt = false; }
  Branch run();

 private:
  BoundaryValueProblem& b_;
  const BranchOptions& o_;
  BvpOptions fixed_mesh_;
  Branch out_;
  Direction here_, next_;
  std::vector<double> x1_, x2_;  // complete iterates at the ends of the step
  std::vector<double> values_, next_values_;
  double arc_ = 0.0, length_ = 0.0;
  int flip_fixed_ = 1, flip_bordered_ = 1;

  std::vector<double> values(const BoundaryValueProblem& b) const {
    std::vector<double> v;
    for (const auto& f : o_.functions) v.push_back(f(b));
    return v;
  }
  void record() { out_.points.push_back({b_.parameter(), arc_, values_, here_.fixed * flip_fixed_}); }
  bool step(double length);
  bool remesh();
  bool at(double sigma, BoundaryValueProblem& c) const;
  void locate(BranchEvent::Kind kind, int function);
  void events();
};

/// The state at arclength sigma of the present step.
bool Follower::at(double sigma, BoundaryValueProblem& c) const {
  const double f = sigma / length_;
  std::vector<double> x(x1_);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += f * (x2_[i] - x1_[i]);
  c.scatter_all(x);
  const std::vector<double> x0(x1_.begin(), x1_.begin() + c.unknowns());
  return c.solve(Closure::on_plane(here_.normal, dot(here_.normal, x0) + sigma), fixed_mesh_).converged;
}

// Zero of one test function along the step by the secant rule kept inside a shrinking bracket (Illinois).
void Follower::locate(BranchEvent::Kind kind, int function) {
  BoundaryValueProblem c = b_;
  std::vector<double> y, pairing;
  auto test = [&](double sigma, bool& ok) {
    ok = at(sigma, c);
    if (!ok) return 0.0;
    if (kind == BranchEvent::Kind::zero) return o_.functions[function](c);
    if (kind == BranchEvent::Kind::fold) {
      Direction d;
      ok = direction(c, here_.tangent, d);
      return ok ? d.tangent[c.column_of_p()] : 0.0;
    }
    // the response to a fixed load grows like 1/distance: its inverse passes through zero
    ok = c.response(here_.normal, y);
    if (!ok) return 0.0;
    if (pairing.empty()) {  // with the response where the bracket begins: nearly the kernel
      pairing = c.metric();
      for (std::size_t i = 0; i < y.size(); ++i) pairing[i] *= y[i];
      const double norm = std::sqrt(dot(pairing, y));
      for (double& v : pairing) v /= norm;
    }
    return 1.0 / dot(pairing, y);
  };
  bool ok = false;
  double lo = 0.0, hi = length_, f_lo = 0.0, f_hi = 0.0;
  for (int cut = 0;; ++cut) {
    f_lo = test(lo, ok);
    if (ok) f_hi = test(hi, ok);
    if (ok && f_lo * f_hi <= 0.0) break;
    // a response that hides the kernel: halve the bracket by the sign of the determinant
    Direction d;
    const double middle = 0.5 * (lo + hi);
    if (kind != BranchEvent::Kind::branch_point || cut > 20 || !at(middle, c) || !direction(c, here_.tangent, d))
      return;
    (d.bordered == here_.bordered ? lo : hi) = middle;
    pairing.clear();
  }
  double root = hi;
  if (f_lo == 0.0) root = lo;
  int side = 0;
  for (int it = 0; it < 60 && f_lo != 0.0 && f_hi != 0.0; ++it) {
    const double s = std::clamp(lo + (hi - lo) * f_lo / (f_lo - f_hi), lo + 1e-3 * (hi - lo), hi - 1e-3 * (hi - lo));
    const double f = test(s, ok);
    if (!ok) break;  // next to a branch point the equations are singular: the last estimate stands
    const double moved = std::abs(s - root);
    root = s;
    if (f == 0.0 || moved < o_.event_tolerance * length_) break;
    if (f * f_lo > 0.0) {
      lo = s, f_lo = f;
      if (side == 1) f_hi *= 0.5;
      side = 1;
    } else {
      hi = s, f_hi = f;
      if (side == -1) f_lo *= 0.5;
      side = -1;
    }
    if (hi - lo < o_.event_tolerance * length_) break;
  }
  if (!at(root, c) && kind != BranchEvent::Kind::branch_point) return;
  BranchEvent e{kind, function, c.parameter(), arc_ + root, values(c), c, {}};
  if (kind == BranchEvent::Kind::branch_point && !y.empty()) {
    const std::vector<double> metric = c.metric();
    double square = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) square += metric[i] * y[i] * y[i];
    for (double& v : y) v /= std::sqrt(square);
    e.kernel = y;
  }
  out_.events.push_back(std::move(e));
}

void Follower::events() {
  const std::size_t before = out_.events.size();
  const int ip = b_.column_of_p();
  if (here_.tangent[ip] * next_.tangent[ip] < 0.0) locate(BranchEvent::Kind::fold, -1);
  if (here_.bordered * next_.bordered < 0) locate(BranchEvent::Kind::branch_point, -1);
  for (std::size_t i = 0; i < values_.size(); ++i)
    if (values_[i] * next_values_[i] < 0.0 || (next_values_[i] == 0.0 && values_[i] != 0.0))
      locate(BranchEvent::Kind::zero, static_cast<int>(i));
  std::stable_sort(out_.events.begin() + static_cast<std::ptrdiff_t>(before), out_.events.end(),
                   [](const BranchEvent& a, const BranchEvent& b) { return a.arclength < b.arclength; });
}

/// One step of the given arclength from x1 (factors of its tangent at hand); false leaves the problem at x1.
bool Follower::step(double length) {
  length_ = length;
  b_.advance(here_.tangent, length);
  const std::vector<double> x0(x1_.begin(), x1_.begin() + b_.unknowns());
  bool ok = b_.solve(Closure::on_plane(here_.normal, dot(here_.normal, x0) + length), fixed_mesh_).converged;
  ok = ok && direction(b_, here_.tangent, next_);
  ok = ok && dot(here_.normal, next_.tangent) > o_.smallest_cosine;
  if (ok) {
    b_.gather_all(x2_);
    return true;
  }
  b_.scatter_all(x1_);
  std::vector<double> along = here_.tangent;
  direction(b_, along, here_);  // factors of the tangent again
  return false;
}

/// New mesh at the present point, and the direction on it.
bool Follower::remesh() {
  BoundaryValueProblem ahead = b_;
  ahead.advance(here_.tangent, 1e-3);
  const int fixed = here_.fixed * flip_fixed_, bordered = here_.bordered * flip_bordered_;
  for (int round = 0; round < 6; ++round) {
    b_.adapt(o_.solve.tolerance);
    BoundaryValueProblem moved = ahead.on_mesh_of(b_);
    std::vector<double> x, y;
    b_.gather(x);
    moved.gather(y);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] -= x[i];
    const std::vector<double> metric = b_.metric();
    std::vector<double> normal(y);
    for (std::size_t i = 0; i < normal.size(); ++i) normal[i] *= metric[i];
    if (!b_.solve(Closure::on_plane(normal, dot(normal, x)), fixed_mesh_).converged) return false;
    if (!direction(b_, y, here_)) return false;
    flip_fixed_ = fixed * here_.fixed;
    flip_bordered_ = bordered * here_.bordered;
    if (b_.estimate_error() <= o_.solve.tolerance || !o_.solve.adapt) return true;
  }
  return false;
}

Branch Follower::run() {
  fixed_mesh_ = o_.solve;
  fixed_mesh_.adapt = false;
  auto end = [&](const std::string& how, bool failed) {
    out_.ended = how;
    out_.failed = failed;
    return std::move(out_);
  };
  std::vector<double> along(b_.unknowns(), 0.0);
  along[b_.column_of_p()] = o_.direction;
  if (!direction(b_, along, here_)) return end("the start is a singular state", true);
  flip_fixed_ = here_.fixed;
  flip_bordered_ = here_.bordered;
  values_ = values(b_);
  record();
  double length = o_.first_step;
  while (static_cast<int>(out_.points.size()) < o_.max_points) {
    b_.gather_all(x1_);
    int cuts = 0;
    while (!step(length)) {
      length *= 0.4;
      ++cuts;
      if (length < o_.min_step) return end("no step along the branch converges", true);
    }
    const double p = b_.parameter();
    next_values_ = values(b_);
    if (p > o_.p_max || p < o_.p_min) {  // land on the end of the range
      const double p_end = p > o_.p_max ? o_.p_max : o_.p_min, p1 = x1_[b_.column_of_p()];
      std::vector<double> x(x1_);
      const double f = (p_end - p1) / (p - p1);
      for (std::size_t i = 0; i < x.size(); ++i) x[i] += f * (x2_[i] - x1_[i]);
      BoundaryValueProblem c = b_;
      c.scatter_all(x);
      if (c.solve(Closure::at(p_end), fixed_mesh_).converged && direction(c, here_.tangent, next_)) {
        b_ = c;
        b_.gather_all(x2_);
        length_ = dot(here_.normal, x2_) - dot(here_.normal, x1_);
        next_values_ = values(b_);
        events();
        arc_ += length_;
        here_ = next_;
        values_ = next_values_;
        record();
        return end("parameter range", false);
      }
    }
    events();
    arc_ += length_;
    here_ = next_;
    values_ = next_values_;
    record();
    if (o_.stop && o_.stop(b_)) return end("stopped", false);
    length = std::min(o_.max_step, length * (cuts == 0 ? 1.5 : 1.0));
    if (o_.solve.adapt && b_.estimate_error() > o_.solve.tolerance && !remesh())
      return end("the mesh could not be refined to the tolerance", true);
  }
  return end("points", false);
}

}  // namespace

Branch follow(BoundaryValueProblem& problem, const BranchOptions& options) { return Follower(problem, options).run(); }

std::optional<BoundaryValueProblem> leave(const BranchEvent& event, double size, const BvpOptions& options) {
  if (event.kernel.empty()) return std::nullopt;
  BoundaryValueProblem b = event.problem;
  const std::vector<double> metric = b.metric();
  std::vector<double> normal(event.kernel), x;
  for (std::size_t i = 0; i < normal.size(); ++i) normal[i] *= metric[i];
  b.gather_all(x);
  const std::vector<double> x0(x.begin(), x.begin() + b.unknowns());
  const double value = dot(normal, x0) + size;
  // start: the states moved along the kernel; the local unknowns follow in the first Newton step
  for (int i = 0; i < b.unknowns(); ++i) x[i] += size * event.kernel[i];
  b.scatter_all(x);
  if (!b.solve(Closure::on_plane(normal, value), options).converged) return std::nullopt;
  return b;
}

}  // namespace tendril::continuation

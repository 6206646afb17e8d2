// Corrector and events where the equations are singular at the very state looked for, but regular beside it: the state
// is a smooth function of a place or of the load across the singularity, so it is interpolated from solved neighbours.
#include <algorithm>
#include <cmath>
#include <functional>

#include "tendril/continuation/path_detail.hpp"
#include "tendril/continuation/path_follower.hpp"
#include "tendril/segmentation/flat_lines.hpp"

namespace tendril::continuation {

using segmentation::Chain;
using segmentation::CheckKind;
using segmentation::Closure;
using segmentation::Margin;

namespace {

struct Place {
  double t = 0.0, value = 0.0;
  std::vector<double> x;  // complete iterate
};

double newton_form(const std::vector<Place>& known, const std::vector<double>& d, double t) {
  double v = d.back();
  for (std::size_t i = d.size() - 1; i-- > 0;) v = v * (t - known[i].t) + d[i];
  return v;
}

std::vector<double> divided_differences(const std::vector<Place>& known) {
  std::vector<double> d;
  for (const auto& k : known) d.push_back(k.value);
  for (std::size_t j = 1; j < d.size(); ++j)
    for (std::size_t i = d.size() - 1; i >= j; --i) d[i] = (d[i] - d[i - 1]) / (known[i].t - known[i - j].t);
  return d;
}

/// Root of the interpolating polynomial in [lo, hi]; NaN where it has none.
double polynomial_root(const std::vector<Place>& known, double lo, double hi) {
  const auto d = divided_differences(known);
  const double at_lo = newton_form(known, d, lo);
  if (at_lo * newton_form(known, d, hi) > 0.0) return std::nan("");
  for (int it = 0; it < 80; ++it) {
    const double mid = 0.5 * (lo + hi);
    (newton_form(known, d, mid) * at_lo > 0.0 ? lo : hi) = mid;
  }
  return 0.5 * (lo + hi);
}

/// The iterate of the interpolating polynomial (Lagrange).
void blend(const std::vector<Place>& known, double t, std::vector<double>& x) {
  x.assign(known.front().x.size(), 0.0);
  for (std::size_t i = 0; i < known.size(); ++i) {
    double weight = 1.0;
    for (std::size_t j = 0; j < known.size(); ++j)
      if (j != i) weight *= (t - known[j].t) / (known[i].t - known[j].t);
    for (std::size_t q = 0; q < x.size(); ++q) x[q] += weight * known[i].x[q];
  }
}

/// Root of the value (and in its value the doubt, of the width) between eight solved places around `guess`, none nearer
/// than a fifth of `width`. `solve` fills value and iterate at place.t, starting from the iterate it finds there. From
/// the outside in, so that the inner ones, nearer to the singular state, start from good guesses; with an empty `start`
/// the outer two find their own. Doubtful roots are refused.
bool interpolate(const std::function<bool(Place&)>& solve, double guess, double width, std::vector<double> start,
                 Place& root) {
  for (int pass = 0; pass < 6; ++pass) {
    std::vector<Place> known;
    for (const double f : {1.0, -1.0, 0.7, -0.7, 0.45, -0.45, 0.2, -0.2}) {
      Place p;
      p.t = guess + f * width;
      if (known.size() < 2)
        p.x = start;
      else
        blend(known, p.t, p.x);
      if (!solve(p)) return false;
      known.push_back(std::move(p));
      if (known.size() == 2) {  // recentre where the trend points elsewhere
        const double slope = (known[0].value - known[1].value) / (2.0 * width);
        const double off = slope == 0.0 ? HUGE_VAL : -0.5 * (known[0].value + known[1].value) / slope;
        if (!std::isfinite(off)) return false;
        if (std::abs(off) > 0.1 * width && pass < 4) {
          guess += std::clamp(off, -8.0 * width, 8.0 * width);
          if (!start.empty()) start = known[off > 0.0 ? 0 : 1].x;
          break;
        }
      }
    }
    if (known.size() < 8) continue;
    const double t = polynomial_root(known, guess - width, guess + width);
    if (!std::isfinite(t) || std::abs(t - guess) > 0.18 * width) {
      if (!std::isfinite(t)) return false;
      guess = t;
      if (!start.empty()) start = known.back().x;
      continue;
    }
    const std::vector<Place> outer(known.begin(), known.begin() + 6);
    root.value = std::abs(polynomial_root(outer, guess - width, guess + width) - t) / width;  // doubt
    if (!(root.value < 1e-6)) return false;
    root.t = t;
    blend(known, t, root.x);
    return true;
  }
  return false;
}

/// The same state cut at other places, on the same shares of the segments.
Chain slid(const Chain& c, const std::vector<double>& S) {
  Chain out = c;
  std::vector<double> x;
  for (int j = 0; j < c.segments(); ++j) {
    auto& seg = out.segment(j);
    const double stretch = (S[j + 1] - S[j]) / (c.S(j + 1) - c.S(j));
    for (int q = 0; q + 1 < seg.parts(); ++q) seg.move_cut(q, S[j] + stretch * (seg.cut(q).S - c.S(j)));
    for (int q = 0; q < seg.parts(); ++q) {
      auto& part = seg.part(q);
      const double a = seg.left(q, S[j]), b = seg.right(q, S[j + 1]);
      std::vector<double> points;
      for (int i = 1; i < part.pieces(); ++i) points.push_back(part.place(i, a, b));
      part.initialise_on(a, b, points, [&](double at, double* u, double* s) {
        if (c.is_line(j))
          c.segment(j).evaluate(std::clamp(at, c.S(j), c.S(j + 1)), c.S(j), c.S(j + 1), u, s);
        else
          c.sample(std::min(at, c.S(c.segments())), u, s);
      });
    }
  }
  out.gather(x);
  for (int j = 0; j <= c.segments(); ++j) x[out.column_of_S(j)] = S[j];
  out.scatter(x);
  out.flatten();
  return out;
}

}  // namespace

bool PathFollower::locate_beside(const std::vector<double>& a, const std::vector<double>& b, double guess, Chain& at,
                                 Margin& m, const Closure& closure) {
  if (rebuild_) return false;
  const int column = closure.kind == Closure::Kind::parameter ? at.column_of_p() : closure.index;
  const double va = a[column], vb = b[column];
  Chain c = at;
  Margin found = m;
  std::vector<double> scale;
  c.scales(scale);
  const auto solve = [&](Place& p) {
    c.scatter_all(p.x);
    Closure here = closure;
    here.value = va + p.t * (vb - va);
    if (!correct(c, here, false)) return false;
    const auto all = segmentation::margins(c);
    const Margin* x = same_condition(all, m);
    if (!x) return false;
    found = *x;
    p.value = x->value;
    c.gather_all(p.x);
    return true;
  };
  std::vector<double> start(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) start[i] = a[i] + guess * (b[i] - a[i]);
  Place root;
  for (const double width : {0.02, 0.005, 0.06}) {  // of the size of what is stepped
    if (!interpolate(solve, guess, width * scale[column] / std::abs(vb - va), start, root)) continue;
    c.scatter_all(root.x);
    const auto all = segmentation::margins(c);
    if (const Margin* x = same_condition(all, m)) found = *x;
    m = found;
    at = c;
    return true;
  }
  return false;
}

bool PathFollower::correct_beside(Chain& c, const Closure& closure, bool adaptive) {
  std::vector<int> ends, side;
  for (int k = 0; k + 1 < c.segments(); ++k)
    if (c.is_line(k) != c.is_line(k + 1)) {
      ends.push_back(k);
      side.push_back(c.is_line(k) ? 1 : -1);
    }
  if (ends.empty() || closure.kind == Closure::Kind::unknown || rebuild_) {
    total_.reason = "the ends of a line contact that carries nothing are not determined";
    return false;
  }
  Chain h = c;
  std::vector<double> place;
  for (const int k : ends) place.push_back(c.S(k + 1));
  if (closure.kind == Closure::Kind::span) {
    const double middle = 0.5 * (c.S(closure.index) + c.S(closure.index + 1));
    for (std::size_t i = 0; i < ends.size(); ++i) {
      if (ends[i] == closure.index - 1) place[i] = middle - 0.5 * closure.value;
      if (ends[i] == closure.index) place[i] = middle + 0.5 * closure.value;
    }
  }
  double width = HUGE_VAL;  // small against the neighbours of every end
  for (const int k : ends)
    for (const int j : {k, k + 1}) width = std::min(width, (c.is_line(j) ? 0.3 : 0.03) * (c.S(j + 1) - c.S(j)));
  // All lines grow together by `shift` at each end: the symmetric states. Their middles move with the rod's far end.
  const auto& problem = c.mechanics().problem;
  const auto places = [&](double shift, double p) {
    const double far = problem.end_position.value + problem.end_position.rate * (p - problem.p0);
    const double stretch = far / c.S(c.segments());
    std::vector<double> S(c.segments() + 1);
    for (int j = 0; j <= c.segments(); ++j) S[j] = stretch * c.S(j);
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const std::size_t twin = side[i] < 0 ? i + 1 : i - 1;  // a line's other end, unless it ends with the rod
      const bool has_twin = twin < ends.size() && side[twin] != side[i];
      const double middle = has_twin ? 0.5 * (place[i] + place[twin]) : place[i];
      S[ends[i] + 1] = stretch * middle + (place[i] - middle) + side[i] * shift;
    }
    return S;
  };
  const auto held = [&](double shift, double p, bool refine) {
    const auto S = places(shift, p);
    for (const int k : ends) h.hold(k, S[k + 1]);
    return correct(h, {Closure::Kind::parameter, 0, p}, refine);
  };
  const auto mismatch = [&] { return segmentation::curvature_mismatch(h, ends.front()); };
  const bool load_free = closure.kind == Closure::Kind::span;
  const double p = load_free ? c.parameter() : closure.value;
  if (adaptive) {
    // a coarse mesh keeps apart the branches that cross at the singular state, and that shows beside it
    const double accuracy = options_.switcher.accuracy;
    bool fine = false;
    for (const double f : {1.0, 1e-2, 1e-4}) {
      options_.switcher.accuracy = std::max(f * accuracy, 1e-13);
      h = slid(c, places(width, p));
      Chain refined = c;
      const bool solved = held(width, p, true);
      if (solved) refined = h;
      options_.switcher.accuracy = accuracy;
      if (!solved) return fine;
      refined = slid(refined, places(0.0, p));
      for (const int k : ends) refined.release(k);
      if (!correct_beside(refined, closure, false)) continue;
      c = refined;
      fine = true;
      if (doubt_ < 1e-8) break;
    }
    return fine;
  }
  std::vector<double> start;
  const auto begin = [&](double shift) {
    h = slid(c, places(shift, p));
    h.gather_all(start);
  };
  const auto solve = [&](Place& at) {
    if (!load_free && at.x.empty()) {
      begin(at.t);
      at.x = start;
    }
    h.scatter_all(at.x);
    if (!held(load_free ? 0.0 : at.t, load_free ? at.t : p, false)) return false;
    at.value = mismatch();
    h.gather_all(at.x);
    return true;
  };
  double guess = 0.0, reach = width;
  if (load_free) {  // how far the load moves the mismatch as much as `width` does
    double wide[2];
    for (int i : {0, 1}) {
      begin(i == 0 ? width : -width);
      if (!held(i == 0 ? width : -width, p, false)) return false;
      wide[i] = mismatch();
    }
    begin(0.0);
    Place left, right;
    double per_load = 0.0, step = 1e-4 * std::max(1e-6, std::abs(p));
    for (int attempt = 0; attempt < 6 && per_load == 0.0; ++attempt, step *= 0.1) {
      left = {p - step, 0.0, start};
      right = {p + step, 0.0, start};
      if (solve(left) && solve(right) && std::abs(right.value - left.value) < 2.0 * std::abs(wide[0] - wide[1]))
        per_load = (right.value - left.value) / (2.0 * step);
    }
    if (per_load == 0.0) return false;
    guess = p - 0.5 * (left.value + right.value) / per_load;
    reach = std::abs(0.5 * (wide[0] - wide[1]) / per_load);
    start = right.x;
  } else {
    start.clear();  // each outer place starts from the given state cut there
  }
  Place root;
  if (!interpolate(solve, guess, reach, start, root)) {
    if (total_.reason.empty()) total_.reason = "the end of a line contact that carries nothing was not found";
    return false;
  }
  for (const int k : ends) h.release(k);
  h.scatter_all(root.x);
  for (const int k : ends)  // ends that do not move alike need not agree
    if (std::abs(segmentation::curvature_mismatch(h, k)) > 1e-6) {
      total_.reason = "the ends of a line contact that carries nothing are not symmetric";
      return false;
    }
  doubt_ = root.value;
  c = h;
  return true;
}

}  // namespace tendril::continuation

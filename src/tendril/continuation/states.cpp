#include "tendril/continuation/states.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "tendril/segmentation/cold_start.hpp"

namespace tendril::continuation {

using segmentation::Chain;
using segmentation::Mechanics;
using segmentation::Vector4;
using std::numbers::pi;

namespace {

constexpr int samples = 200;
using Profile = std::vector<std::complex<double>>;  // δ1 + iδ2 at equal steps of S, over the largest clearance

double largest(const Profile& z) {
  double m = 0.0;
  for (const auto& x : z) m = std::max(m, std::abs(x));
  return m;
}

Profile profile(const Chain& chain) {
  Profile z;
  const double a = chain.S(0), b = chain.S(chain.segments()), Q = chain.mechanics().problem.clearance_max;
  double u[formulation::state_inputs];
  for (int i = 0; i <= samples; ++i) {
    chain.sample(a + (b - a) * i / samples, u, nullptr);
    z.emplace_back(u[0] / Q, u[4] / Q);
  }
  return z;
}

/// Largest distance of b from the turned copy of a that lies nearest.
double apart_turned(const Profile& a, const Profile& b) {
  std::complex<double> c = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) c += std::conj(a[i]) * b[i];
  if (!(std::abs(c) > 0.0)) return largest(a) + largest(b);
  c /= std::abs(c);
  double m = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) m = std::max(m, std::abs(b[i] - c * a[i]));
  return m;
}

double apart(const Profile& a, const Profile& b) {
  double m = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) m = std::max(m, std::abs(b[i] - a[i]));
  return m;
}

Profile mirrored(Profile z) {
  for (auto& x : z) x = std::conj(x);
  return z;
}
Profile reversed(Profile z) {
  std::reverse(z.begin(), z.end());
  return z;
}

constexpr double same = 1e-5;  // of the clearance: solves agree to 1e-8, different states never came nearer than 1e-3

/// A wave of `waves` periods, phase and hand as given; hand 0: in one plane.
segmentation::DiscreteState wave(const segmentation::ScaledProblem& P, double waves, double phase, int hand) {
  segmentation::DiscreteState s;
  const double end = P.now(P.end_position), amplitude = 0.7 * P.clearance_max, k = 2.0 * pi * waves / end;
  constexpr int nodes = 240;
  for (int i = 0; i <= nodes; ++i) {
    const double S = end * i / nodes, x = pi * S / end, e = std::sin(x), de = pi / end * std::cos(x);
    Vector4 u = Vector4::Zero();
    for (int j = 0; j < 2; ++j) {
      const double shift = hand == 0 ? 0.0 : hand * 0.5 * pi * j;
      const double across = hand == 0 ? (j == 0 ? std::cos(phase) : std::sin(phase)) : 1.0;
      const double turn = hand == 0 ? 0.0 : phase;
      const double f = hand == 0 ? std::sin(k * S) : std::cos(k * S + turn - shift);
      const double df = k * (hand == 0 ? std::cos(k * S) : -std::sin(k * S + turn - shift));
      u[2 * j] = amplitude * across * e * f;
      u[2 * j + 1] = amplitude * across * (de * f + e * df);
    }
    s.S.push_back(S);
    s.u.push_back(u);
  }
  return s;
}

/// Integrals over the rod's own length, from the fields; the potential of dead loads that stay with the rod (of loads
/// that change along the axis there is none).
void energies(const segmentation::Problem& p, StateFound& f) {
  const Fields& x = f.step.fields;
  const bool varies = !p.law.uniform();
  const double counted = p.law.from_end ? f.step.rod_length : 0.0;  // the law's s is that of the fields less this
  const auto properties = [&](std::size_t i, double middle) {
    if (varies) return p.law.pieces[p.law.piece_at(middle - counted)].at<double>(x.s[i] - counted);
    rod::Properties<double> q{};
    q.B = p.rod.bending_stiffness;
    q.C = p.rod.torsional_stiffness;
    q.e = p.rod.axial_stiffness ? 1.0 / *p.rod.axial_stiffness : 0.0;
    return q;
  };
  const double scale = p.body_force_scale.value;
  for (std::size_t i = 0; i + 1 < x.s.size(); ++i) {
    const double ds = x.s[i + 1] - x.s[i], middle = 0.5 * (x.s[i] + x.s[i + 1]);
    for (const std::size_t k : {i, i + 1}) {
      const auto q = properties(k, middle);
      const Eigen::Vector3d weight = scale * (p.load.force + q.weight * p.load.weight_direction);
      f.energy += 0.5 * ds *
                  (0.5 * (x.M1[k] * x.M1[k] + x.M2[k] * x.M2[k]) / q.B + 0.5 * x.M3[k] * x.M3[k] / q.C +
                   0.5 * q.e * x.F3[k] * x.F3[k]);
      f.weight -= 0.5 * ds * weight.dot(Eigen::Vector3d(x.x[k], x.y[k], x.z[k]));
    }
  }
  for (const auto& load : p.point_loads) {
    if (!load.on_rod) continue;
    const double s = load.at + counted;
    const auto it = std::lower_bound(x.s.begin(), x.s.end(), s);
    if (it == x.s.begin() || it == x.s.end()) continue;
    const std::size_t k = it - x.s.begin();
    const double b = x.s[k] > x.s[k - 1] ? (s - x.s[k - 1]) / (x.s[k] - x.s[k - 1]) : 1.0;
    const Eigen::Vector3d r0(x.x[k - 1], x.y[k - 1], x.z[k - 1]), r1(x.x[k], x.y[k], x.z[k]);
    f.weight -= p.point_load_scale.value * load.force.dot(r0 + b * (r1 - r0));
  }
}

void name_twin(std::vector<StateFound>& states, const std::vector<Profile>& z, std::size_t i) {
  for (std::size_t k = 0; k < i; ++k) {
    if (std::abs(states[k].step.rod_length / states[i].step.rod_length - 1.0) > 1e-7) continue;
    const std::pair<Profile, const char*> images[] = {{z[k], "turned"},
                                                      {mirrored(z[k]), "mirrored"},
                                                      {reversed(z[k]), "reversed"},
                                                      {reversed(mirrored(z[k])), "reversed and mirrored"}};
    for (const auto& [image, word] : images)
      if (apart_turned(image, z[i]) < 10.0 * same) {
        states[i].twin_of = static_cast<int>(k);
        states[i].twin = word;
        return;
      }
  }
}

}  // namespace

std::string StateFound::kind() const {
  std::string out = on_axis ? "on the axis" : planar ? "in one plane" : "spatial";
  if (symmetric && !on_axis) out += ", the same from both ends";
  if (twin_of >= 0) out += ", state " + std::to_string(twin_of + 1) + " " + twin;
  return out;
}

StatesFound find_states(const segmentation::Problem& problem, const StudyOptions& options) {
  StatesFound out;
  const numerics::Stop stop{options.stop, options.solve.max_seconds, numerics::Stop::Clock::now()};
  const auto mechanics = std::make_shared<Mechanics>(problem, 0.0);
  const auto& P = mechanics->problem;
  segmentation::SwitcherOptions switcher;
  switcher.accuracy = 0.2 * options.solve.tolerance;
  switcher.newton.stop = stop;

  struct Raw {
    Chain chain;
    Profile z;
    std::string how;
  };
  std::vector<Raw> raw;
  std::string reason;
  const auto search = [&](segmentation::BranchRule rule, const std::string& from,
                          const segmentation::DiscreteState* shape) {
    if (stop.asked()) return;
    ++out.starts;
    segmentation::SolveOptions solve = options.solve;
    solve.branch = rule;
    const auto r = segmentation::cold_start(
        mechanics, solve, switcher,
        [&](const Chain& c) {
          const Profile z = profile(c);
          const bool turns = c.turns_freely();  // about the axis: the angle is nobody's
          for (const Raw& o : raw)
            if ((turns ? apart_turned(o.z, z) : apart(o.z, z)) < same) return false;
          raw.push_back({c, z, from});
          return false;
        },
        shape);
    if (!r.converged && reason.empty()) reason = r.reason;
  };
  using segmentation::BranchRule;
  const auto progress = [&](double fraction) {
    if (options.progress) options.progress(fraction, std::to_string(raw.size()) + " states so far");
  };
  progress(0.0);
  search(BranchRule::symmetric, "from the axis, symmetry kept", nullptr);
  progress(0.1);
  search(BranchRule::stable, "least energy", nullptr);
  progress(0.2);
  search(BranchRule::planar, "least energy in the plane of D1", nullptr);
  if (problem.tube.side == geometry::Side::inside) {
    for (const int waves : {1, 2, 3, 5}) {
      for (const int hand : {0, 1, -1})
        for (const double phase : {0.0, 0.5 * pi, pi, 1.5 * pi}) {
          if (hand != 0 && phase > pi) continue;
          const auto shape = wave(P, waves == 1 && hand == 0 ? 0.5 : waves, phase, hand);
          search(BranchRule::stable,
                 "from " +
                     std::string(hand == 0  ? "a wave of "
                                 : hand > 0 ? "a right-handed helix of "
                                            : "a left-handed helix of ") +
                     (waves == 1 && hand == 0 ? "half a" : std::to_string(waves)) + " turn(s) at " +
                     std::to_string(static_cast<int>(phase * 180 / pi + 0.5)) + " degrees",
                 &shape);
        }
      progress(0.2 + 0.2 * std::log2(waves));
    }
  }
  std::vector<std::pair<StateFound, Profile>> both;
  // Each state once more, certified and judged as any other solve.
  for (Raw& r : raw) {
    std::vector<double> stored;
    r.chain.store(stored);
    StudyOptions one = options;
    one.initial = &stored;
    one.solve.branch = BranchRule::nearest;
    one.fields = true;
    one.field_points = 2001;
    one.progress = {};
    const Result solved = solve(problem, one);
    if (solved.steps.empty() || solved.steps.front().segments.empty()) continue;
    StateFound f;
    f.step = solved.steps.front();
    const std::string stored_word = "continued from the stored state";
    if (f.step.branch.rfind(stored_word, 0) != 0) continue;  // lost: what was solved instead is another search's
    f.step.branch = r.how + f.step.branch.substr(stored_word.size());
    energies(problem, f);
    if (!options.fields) f.step.fields = {};
    const double size = largest(r.z);
    f.on_axis = size < same;
    // one plane: z² has one direction
    std::complex<double> square = 0.0;
    double sum = 0.0;
    for (const auto& x : r.z) {
      square += x * x;
      sum += std::norm(x);
    }
    f.planar = sum - std::abs(square) < 1e-9 * sum;
    const Profile back = reversed(r.z);
    f.symmetric = std::min(apart_turned(back, r.z), apart_turned(mirrored(back), r.z)) < 10.0 * same;
    both.emplace_back(std::move(f), r.z);
  }
  // stable ones first, then by length
  std::stable_sort(both.begin(), both.end(), [](const auto& a, const auto& b) {
    const bool x = a.first.step.stability == "stable", y = b.first.step.stability == "stable";
    return x != y ? x : a.first.step.rod_length < b.first.step.rod_length;
  });
  std::vector<Profile> z;
  for (auto& [s, p] : both) {
    out.states.push_back(std::move(s));
    z.push_back(std::move(p));
  }
  for (std::size_t i = 1; i < out.states.size(); ++i) name_twin(out.states, z, i);
  out.interrupted = stop.asked();
  if (out.states.empty()) out.message = reason.empty() ? "no state was found" : reason;
  return out;
}

}  // namespace tendril::continuation

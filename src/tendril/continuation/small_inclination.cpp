#include "tendril/continuation/small_inclination.hpp"

#include <algorithm>
#include <cmath>

namespace tendril::continuation {

using collocation::BvpOptions;
using collocation::BvpSummary;
using collocation::Closure;
using collocation::Conditions;
using formulation::SmallInclinationSystem;
using segmentation::AxialControl;
using segmentation::ScaledProblem;
using segmentation::TwistControl;
using segmentation::Which;

namespace {

constexpr int states = SmallInclinationSystem::states;
using D = numerics::Dual<2 * states + 1>;
using System = collocation::DualSystem<SmallInclinationSystem, SmallInclinationSystem::inputs>;

/// State at an end of a segment, derivatives with respect to S.
struct End {
  D d1[3], d2[3], turn, turn1, F1, F2, F3, Sa, Sb, s, alpha, w1, w2, M3;
  formulation::Section section;
  D dS;
  End(const ScaledProblem& P, const D* z, bool right) {
    Sa = z[11], Sb = z[12], s = z[13];
    const D f = 1.0 / (Sb - Sa), f2 = f * f;
    d1[0] = z[0], d1[1] = f * z[1], d1[2] = f2 * z[2];
    d2[0] = z[3], d2[1] = f * z[4], d2[2] = f2 * z[5];
    turn = z[6], turn1 = f * z[7];
    F1 = z[8], F2 = z[9], F3 = z[10];
    const D& S = right ? Sb : Sa;
    section = P.section(S.v);
    dS = S - S.v;
    const auto l = formulation::lift<D>(section, dS, D(0.0));
    alpha = 1.0 + P.material.eta2 * F3;
    w1 = alpha * (l.U[0][0] - d2[2]);
    w2 = alpha * (l.U[0][1] + d1[2]);
    M3 = (1.0 / (1.0 + P.material.nu)) * (alpha * turn1);
  }
  D push(const ScaledProblem& P) const {
    return -1.0 * (0.5 * (w1 * w1 + w2 * w2) + F3 + (0.5 * P.material.eta2) * (F3 * F3));
  }
};

/// What one end of the rod holds, besides the axial condition of the far end's twin.
int end_rows(const ScaledProblem& P, const End& e, bool right, const D& p, D* r) {
  const auto& held = right ? P.end : P.start;
  const Which which = right ? Which::end : Which::start;
  const auto& twist = P.source;
  int n = 0;
  r[n++] = e.d1[0] - P.now(held.eccentricity[0]);
  r[n++] = e.d2[0] - P.now(held.eccentricity[1]);
  if (held.kind == segmentation::End::Kind::pinned) {
    r[n++] = e.w1;
    r[n++] = e.w2;
  } else {
    r[n++] = e.d1[1] - P.now(held.slope[0]);
    r[n++] = e.d2[1] - P.now(held.slope[1]);
  }
  if (twist.twist_at != which)
    r[n++] = e.turn - P.now(held.roll);
  else if (twist.twist == TwistControl::torque)
    r[n++] = e.M3 - P.now(P.twist);
  else
    r[n++] = e.turn - P.now(P.twist);
  if (P.source.axial == AxialControl::rod_length) {
    if (right) r[n++] = e.s - p;
  } else if (P.source.axial_at == which) {
    r[n++] = P.source.axial == AxialControl::push ? e.push(P) - p : e.F3 - p;
  }
  if (right) {
    r[n++] = e.Sb - P.now(P.end_position);
  } else {
    r[n++] = e.Sa;
    r[n++] = e.s;
  }
  return n;
}

int point_rows(const ScaledProblem& P, const End& a, const End& b, D* r) {
  int n = 0;
  for (int i = 0; i < 3; ++i) {
    r[n++] = b.d1[i] - a.d1[i];
    r[n++] = b.d2[i] - a.d2[i];
  }
  r[n++] = b.turn - a.turn;
  r[n++] = b.turn1 - a.turn1;
  r[n++] = b.F3 - a.F3;
  r[n++] = b.s - a.s;
  r[n++] = b.Sa - a.Sb;
  const auto Q = formulation::lift_clearance<D>(a.section, a.dS, D(0.0));
  const D radius = sqrt(a.d1[0] * a.d1[0] + a.d2[0] * a.d2[0]);
  r[n++] = radius - Q[0];                                                 // (IV.1.10)
  r[n++] = (a.d1[0] * a.d1[1] + a.d2[0] * a.d2[1]) / radius - Q[1];       // (IV.1.11)
  r[n++] = ((b.F1 - a.F1) * a.d2[0] - (b.F2 - a.F2) * a.d1[0]) / radius;  // the jump is along N
  (void)P;
  return n;
}

Conditions conditions(std::shared_ptr<const ScaledProblem> P, int segments) {
  const int ends = 2 * states * segments;
  return {states * segments, [=](const double* e, double p, double* r, double* jac) {
            D z[2 * states], out[2 * states];
            int row = 0;
            auto block = [&](int first, int count, auto&& rows_of) {
              for (int i = 0; i < count; ++i) z[i] = D::seed(e[first + i], i);
              const int rows = rows_of();
              for (int i = 0; i < rows; ++i, ++row) {
                r[row] = out[i].v;
                if (!jac) continue;
                double* to = jac + static_cast<std::size_t>(row) * (ends + 1);
                std::fill_n(to, ends + 1, 0.0);
                std::copy_n(out[i].d.begin(), count, to + first);
                to[ends] = out[i].d[2 * states];
              }
            };
            const D parameter = D::seed(p, 2 * states);
            block(0, states, [&] { return end_rows(*P, End(*P, z, false), false, parameter, out); });
            for (int j = 0; j + 1 < segments; ++j)
              block((2 * j + 1) * states, 2 * states,
                    [&] { return point_rows(*P, End(*P, z, true), End(*P, z + states, false), out); });
            block(ends - states, states, [&] { return end_rows(*P, End(*P, z, true), true, parameter, out); });
          }};
}

collocation::BoundaryValueProblem::Systems systems(const std::shared_ptr<const ScaledProblem>& P, int segments) {
  collocation::BoundaryValueProblem::Systems all;
  for (int j = 0; j < segments; ++j) {
    SmallInclinationSystem f;
    f.material = P->material;
    f.section = [P](double S) { return P->section(S); };
    all.push_back(std::make_shared<System>(f));
  }
  return all;
}

}  // namespace

SmallInclinationRod::SmallInclinationRod(std::shared_ptr<const ScaledProblem> problem,
                                         const std::vector<double>& contacts, const SmallInclinationRod* like,
                                         int pieces)
    : problem_(std::move(problem)),
      bvp_(systems(problem_, static_cast<int>(contacts.size()) + 1),
           conditions(problem_, static_cast<int>(contacts.size()) + 1)) {
  const ScaledProblem& P = *problem_;
  std::vector<double> place{0.0};
  place.insert(place.end(), contacts.begin(), contacts.end());
  place.push_back(P.now(P.end_position));
  const double end = place.back();
  const double F3 = P.source.axial == AxialControl::axial_force ? P.now(P.axial) : 0.0;
  std::vector<std::vector<double>> knots(place.size() - 1);
  for (std::size_t j = 0; j + 1 < place.size(); ++j)
    for (double q : P.knots)
      if (q > place[j] && q < place[j + 1]) knots[j].push_back((q - place[j]) / (place[j + 1] - place[j]));
  bvp_.initialise(
      [&](int j, double x, double* u, double* quad) {
        const double h = place[j + 1] - place[j], S = place[j] + h * x, t = S / end;
        std::fill_n(u, SmallInclinationSystem::inputs, 0.0);
        if (like) {
          const SmallInclinationSection c = like->at(S);
          std::copy_n(c.inputs, 17, u);
          *quad = c.s;
        } else {
          // cubic blend of the ends' eccentricity, moments of the axis
          const double b[3] = {t * t * (3 - 2 * t), 6 * t * (1 - t) / end, 6 * (1 - 2 * t) / (end * end)};
          for (int c = 0; c < 2; ++c) {
            const double from = P.now(P.start.eccentricity[c]), step = P.now(P.end.eccentricity[c]) - from;
            u[4 * c] = from + step * b[0], u[4 * c + 1] = step * b[1], u[4 * c + 2] = step * b[2];
          }
          const auto section = P.section(S);
          const double alpha = 1.0 + P.material.eta2 * F3;
          const double M3 = P.source.twist == TwistControl::torque ? P.now(P.twist) : 0.0;
          const double rate = M3 / alpha;
          u[9] = (1 + P.material.nu) * rate, u[8] = u[9] * S;
          u[11] = alpha * (section.U[0][0] * rate - section.U[1][1]);
          u[13] = alpha * (section.U[1][0] + section.U[0][1] * rate);
          u[15] = F3;
          *quad = S / alpha;
        }
        double power = 1.0;
        for (int d = 1; d <= 3; ++d) {
          power *= h;
          u[d] *= power, u[4 + d] *= power;
          if (d <= 2) u[8 + d] *= power;
          if (d == 1)
            for (int i : {12, 14, 16}) u[i] *= power;
        }
        u[17] = place[j], u[19] = place[j + 1];
      },
      pieces, knots);
  std::vector<double> floor(states, 1.0);
  for (int i = 0; i < 6; ++i) floor[i] = P.clearance_max;
  for (int j = 0; j < segments(); ++j) bvp_.set_scale(j, floor);
}

BvpSummary SmallInclinationRod::solve(double axial, const BvpOptions& options) {
  return bvp_.solve(Closure::at(axial), options);
}

double SmallInclinationRod::place(int j) const {
  return j < segments() ? bvp_.end_value(j, false, 6) : bvp_.end_value(j - 1, true, 7);
}

SmallInclinationSection SmallInclinationRod::at(int j, double x) const {
  double u[SmallInclinationSystem::inputs];
  SmallInclinationSection c;
  bvp_.evaluate(j, x, u, &c.s);
  const double h = u[19] - u[17];
  c.S = u[17] + h * x;
  std::copy_n(u, 17, c.inputs);
  double power = 1.0;
  for (int d = 1; d <= 3; ++d) {
    power /= h;
    c.inputs[d] *= power, c.inputs[4 + d] *= power;
    if (d <= 2) c.inputs[8 + d] *= power;
    if (d == 1)
      for (int i : {12, 14, 16}) c.inputs[i] *= power;
  }
  const double* v = c.inputs;
  const double alpha = 1.0 + problem_->material.eta2 * v[15];
  const auto l = formulation::lift<double>(problem_->section(c.S), 0.0, 0.0);
  const formulation::SmallInclination<double> e(problem_->material, l, v, v + 4, v[9], alpha,
                                                problem_->material.eta2 * v[16]);
  c.M1 = e.w1, c.M2 = e.w2, c.M3 = e.M3;
  return c;
}

SmallInclinationSection SmallInclinationRod::at(double S) const {
  int j = 0;
  while (j + 1 < segments() && S >= place(j + 1)) ++j;
  const double a = place(j), b = place(j + 1);
  return at(j, std::clamp((S - a) / (b - a), 0.0, 1.0));
}

double SmallInclinationRod::reaction(int j) const {
  const auto a = at(j - 1, 1.0), b = at(j, 0.0);
  const double radius = std::hypot(a.inputs[0], a.inputs[4]);
  return ((b.inputs[11] - a.inputs[11]) * a.inputs[0] + (b.inputs[13] - a.inputs[13]) * a.inputs[4]) / radius;
}

SmallInclinationOutcome small_inclination(const segmentation::Problem& problem, const BvpOptions& options) {
  SmallInclinationOutcome out;
  const auto P = std::make_shared<const ScaledProblem>(problem);
  const double axial = P->now(P->axial), tolerance = 1e-7 * P->clearance_max;
  std::vector<double> contacts;
  SmallInclinationRod rod(P, contacts);
  BvpSummary s = rod.solve(axial, options);
  if (!s.converged && P->source.axial != AxialControl::rod_length) {
    // up to the load from none
    rod = SmallInclinationRod(P, contacts);
    for (int i = 0; i <= 10; ++i)
      if (s = rod.solve(axial * i / 10, options); !s.converged) break;
  }
  for (int round = 0; round < 24; ++round) {
    if (!s.converged) {
      out.reason = s.reason;
      return out;
    }
    // a contact that pulls goes, the deepest penetration becomes a contact
    int worst = 0;
    double least = -1e-9;
    for (int j = 1; j < rod.segments(); ++j)
      if (const double R = P->sign * rod.reaction(j); R < least) worst = j, least = R;
    contacts.clear();
    for (int j = 1; j < rod.segments(); ++j)
      if (j != worst) contacts.push_back(rod.place(j));
    const double end = rod.place(rod.segments());
    const auto depth_at = [&](double S) {
      const auto c = rod.at(S);
      return P->sign * (std::hypot(c.inputs[0], c.inputs[4]) - P->section(S).Q[0]);
    };
    if (worst == 0) {
      // into the wall on both sides of a touch: the rod wants to lie on it
      for (double c : contacts)
        if (std::min(depth_at(c - 0.01 * end), depth_at(c + 0.01 * end)) > tolerance) {
          out.outside_domain = true;
          out.reason = "the rod would lie on the wall around S = " + std::to_string(c * P->L) +
                       ": line contact is outside the small inclination approximation";
          out.rod = std::move(rod);
          return out;
        }
      double deepest = tolerance, where = -1.0;
      for (int i = 1; i < 1000; ++i) {
        const double S = end * i / 1000, depth = depth_at(S);
        if (depth > deepest) deepest = depth, where = S;
      }
      if (where < 0.0) {
        out.converged = true;
        out.rod = std::move(rod);
        return out;
      }
      contacts.push_back(where);
      std::sort(contacts.begin(), contacts.end());
    }
    SmallInclinationRod next(P, contacts, &rod);
    s = next.solve(axial, options);
    rod = std::move(next);
  }
  out.reason = "the contact pattern did not settle";
  return out;
}

segmentation::Chain exact_start(const SmallInclinationRod& rod, int pieces) {
  const ScaledProblem& P = rod.problem();
  segmentation::Chain chain(std::make_shared<segmentation::Mechanics>(P.source, P.p0), 7);
  segmentation::Pattern pattern;
  pattern.line.assign(rod.segments(), 0);
  for (int j = 1; j < rod.segments(); ++j) pattern.S.push_back(rod.place(j));
  chain.build(pattern, pieces * rod.segments(), [&](double S, double* u, double* s) {
    const auto c = rod.at(S);
    std::copy_n(c.inputs, 17, u);
    *s = c.s;
  });
  return chain;
}

Step describe(const SmallInclinationRod& rod, int points) {
  const ScaledProblem& P = rod.problem();
  const double L = P.L, F = P.force_unit(), M = P.moment_unit();
  const int n = rod.segments();
  const auto a = rod.at(0, 0.0), b = rod.at(n - 1, 1.0);
  Step out;
  out.rod_length = (b.s - a.s) * L;
  out.axial_force_start = a.inputs[15] * F;
  out.axial_force_end = b.inputs[15] * F;
  out.torque_start = a.M3 * M;
  out.torque_end = b.M3 * M;
  const auto& e = P.source.axial_at == Which::start ? a : b;
  const double F3 = e.inputs[15];
  out.push = -(0.5 * (e.M1 * e.M1 + e.M2 * e.M2) + F3 + 0.5 * P.material.eta2 * F3 * F3) * F;
  for (int j = 0; j < n; ++j) {
    out.segments.push_back({false, rod.place(j) * L, rod.place(j + 1) * L});
    if (j == 0) continue;
    const auto c = rod.at(j, 0.0);
    Contact point;
    point.start = point.end = c.S * L;
    point.s_start = point.s_end = c.s * L;
    point.angle_start = point.angle_end = std::atan2(c.inputs[4], c.inputs[0]);
    point.force = std::abs(rod.reaction(j)) * F;
    const auto section = P.section(c.S);
    const double radius = std::hypot(c.inputs[0], c.inputs[4]);
    for (int i = 0; i < 3; ++i)
      point.force_vector[i] =
          -rod.reaction(j) * F * (c.inputs[0] * section.D[0][i] + c.inputs[4] * section.D[1][i]) / radius;
    out.contacts.push_back(point);
  }
  Fields& f = out.fields;
  for (int i = 0; i < points; ++i) {
    const auto c = rod.at(rod.place(n) * i / (points - 1.0));
    const auto section = P.section(c.S);
    const double* u = c.inputs;
    double r[3];
    for (int q = 0; q < 3; ++q) r[q] = (section.R[q] + u[0] * section.D[0][q] + u[4] * section.D[1][q]) * L;
    f.S.push_back(c.S * L), f.s.push_back(c.s * L);
    f.x.push_back(r[0]), f.y.push_back(r[1]), f.z.push_back(r[2]);
    f.delta1.push_back(u[0] * L), f.delta2.push_back(u[4] * L), f.phi.push_back(u[8]);
    f.gap.push_back(P.sign * (section.Q[0] - std::hypot(u[0], u[4])) * L);
    f.pressure.push_back(0.0);
    f.F1.push_back(u[11] * F), f.F2.push_back(u[13] * F), f.F3.push_back(u[15] * F);
    f.M1.push_back(c.M1 * M), f.M2.push_back(c.M2 * M), f.M3.push_back(c.M3 * M);
    f.kappa.push_back(std::hypot(c.M1, c.M2) / (1.0 + P.material.eta2 * u[15]) / L);
  }
  return out;
}

}  // namespace tendril::continuation

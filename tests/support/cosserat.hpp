#pragma once
// An independent look at a solved rod: the Lagrangian Cosserat rod in the world frame, position, directors, force and
// moment over the rod's own arc length,
//   r' = α d3, α = 1 + F·d3/A,   d_j' = u x d_j, u = (M - M3 d3)/B + (M3/C) d3,   F' = -σ,   M' = -α d3 x F,
// integrated by an error-controlled Runge-Kutta method of order 8. It shares no equation with src/tendril/formulation;
// of a solved state it takes the eccentricity with two derivatives, φ, the forces and the pressure. Case's units.
// No body couple.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

#include "tendril/continuation/result.hpp"
#include "tendril/segmentation/chain.hpp"
#include "tendril/segmentation/pattern_checks.hpp"

namespace tendril::test {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Everything of one section of the rod, world frame.
struct Section {
  double S = 0, s = 0, stretch = 1;
  Vector3d r, F, M;
  Matrix3d d;       // columns d1, d2, d3
  Vector3d normal;  // outward normal of the tube's surface at the rod's polar angle
  double eccentricity = 0, clearance = 0;
};

/// Cosserat rod with its load: the right-hand side and its integral.
class CosseratRod {
 public:
  CosseratRod(const rod::Rod& rod, const Vector3d& load)
      : B_(rod.bending_stiffness),
        C_(rod.torsional_stiffness),
        compliance_(rod.axial_stiffness ? 1 / *rod.axial_stiffness : 0),
        load_(load) {}
  /// A rod that varies: `law` over s as the problem counts it, its weight along `direction`.
  CosseratRod(const rod::Rod& rod, const Vector3d& load, rod::SectionLaw law, const Vector3d& direction)
      : CosseratRod(rod, load) {
    law_ = std::move(law);
    direction_ = direction;
  }

  bool varies() const { return !law_.uniform(); }
  /// Properties at s; at a break, on the side of `towards`.
  rod::Properties<double> properties(double s, double towards) const {
    if (law_.uniform()) return {B_, 0, C_, 0, compliance_, 0, 0, 0, 0, 0, 0};
    return law_.pieces[law_.piece_at(s + 1e-9 * (towards - s))].at<double>(s);
  }

  /// What acts at one place of the rod from outside: a load, or a reaction of the wall.
  struct Push {
    double s = 0;
    Vector3d force = Vector3d::Zero(), couple = Vector3d::Zero();
  };
  std::vector<Push> pushes;                                                // ascending
  std::function<void(const Vector3d& r, Vector3d& f, Vector3d& m)> field;  // more force and couple per length at r

  /// The section at arc length `s` when the rod goes on from `from` under its loads and `pushes`.
  Section continued(const Section& from, double s) const {
    Section here = from;
    std::vector<std::pair<double, const Push*>> stops;  // break by break, push by push
    for (const rod::SectionPiece& p : law_.pieces) stops.emplace_back(p.from, nullptr);
    for (const Push& p : pushes) stops.emplace_back(p.s, &p);
    std::sort(stops.begin(), stops.end());
    for (const auto& [at, push] : stops) {
      if (!(at > from.s + 1e-12 && at < s - 1e-12)) continue;
      if (at > here.s + 1e-12) here = smoothly(here, at);
      if (!push) continue;
      here.F -= push->force;
      here.M -= push->couple;
    }
    return smoothly(here, s);
  }

  const Vector3d& load() const { return load_; }
  Vector3d load_at(double s) const { return load_ + properties(s, s).weight * direction_; }
  /// What is on the rod between two places: its load, and the weight of its sections, whose laws are polynomials.
  Vector3d load_between(double a, double b) const {
    Vector3d sum = (b - a) * load_;
    std::vector<double> cuts{a};
    for (const rod::SectionPiece& p : law_.pieces)
      if (p.from > a && p.from < b) cuts.push_back(p.from);
    cuts.push_back(b);
    using Gauss = boost::math::quadrature::gauss<double, 7>;
    for (std::size_t i = 0; i + 1 < cuts.size() && varies(); ++i)
      sum +=
          direction_ * Gauss::integrate([&](double s) { return properties(s, 0.5 * (cuts[i] + cuts[i + 1])).weight; },
                                        cuts[i], cuts[i + 1]);
    return sum;
  }
  double bending_stiffness() const { return B_; }
  double compliance() const { return compliance_; }

 private:
  double B_, C_, compliance_;
  Vector3d load_, direction_ = Vector3d::Zero();
  rod::SectionLaw law_;

  /// Within one piece of the law.
  Section smoothly(const Section& from, double s) const {
    using State = std::array<double, 18>;
    State y{};
    const auto part = [&y](int i) { return Eigen::Map<Vector3d>(y.data() + 3 * i); };
    part(0) = from.r;
    for (int j = 0; j < 3; ++j) part(1 + j) = from.d.col(j);
    part(4) = from.F;
    part(5) = from.M;
    const int piece = law_.uniform() ? 0 : law_.piece_at(0.5 * (from.s + s));
    const auto slope = [&](const State& x, State& dx, double at) {
      const auto get = [&x](int i) { return Eigen::Map<const Vector3d>(x.data() + 3 * i); };
      const auto set = [&dx](int i) { return Eigen::Map<Vector3d>(dx.data() + 3 * i); };
      const Vector3d d3 = get(3), F = get(4), M = get(5);
      const auto p = law_.uniform() ? properties(at, at) : law_.pieces[piece].at<double>(at);
      const double M3 = M.dot(d3), alpha = 1 + p.e * F.dot(d3);
      const Vector3d u = (M - M3 * d3) / p.B + M3 / p.C * d3 + p.k1 * get(1) + p.k2 * get(2);
      set(0) = alpha * d3;
      for (int j = 1; j <= 3; ++j) set(j) = u.cross(Vector3d(get(j)));
      Vector3d f = Vector3d::Zero(), m = Vector3d::Zero();
      if (field) field(get(0), f, m);
      set(4) = -load_ - p.weight * direction_ - f;
      set(5) = -alpha * d3.cross(F) - m;
    };
    namespace ode = boost::numeric::odeint;
    constexpr double accuracy = 1e-13;
    using Stepper = ode::runge_kutta_fehlberg78<State>;
    static const Stepper plain{};  // static, so zeroed: a copy of a fresh one reads its unset stages
    auto stepper = ode::make_controlled(accuracy, accuracy, plain);
    ode::integrate_adaptive(stepper, slope, y, from.s, s, 0.01 * (s - from.s));
    Section to;
    to.s = s;
    to.r = part(0);
    for (int j = 0; j < 3; ++j) to.d.col(j) = part(1 + j);
    to.F = part(4);
    to.M = part(5);
    to.stretch = 1 + properties(s, from.s).e * to.F.dot(to.d.col(2));
    return to;
  }
};

/// A step of a result, opened again for reading anywhere along the rod.
class SolvedRod {
 public:
  SolvedRod(const segmentation::Problem& problem, const continuation::Step& step)
      : problem_(problem),
        torque_(step.torque_end),
        L_(problem.tube.length()),
        B_(problem.rod.bending_stiffness),
        rod_(problem.rod, problem.body_force_scale.value * problem.load.force, problem.law,
             problem.body_force_scale.value * problem.load.weight_direction) {
    const auto mechanics = std::make_shared<segmentation::Mechanics>(problem, 0.0);
    if (!chain_.restore(step.state, mechanics)) throw std::runtime_error("the state of the step cannot be restored");
  }

  const CosseratRod& rod() const { return rod_; }
  int segments() const { return chain_.segments(); }
  bool is_line(int j) const { return chain_.is_line(j); }
  int segment_at(double S) const { return chain_.segment_at(S / L_); }
  double place(int j) const { return chain_.S(j) * L_; }
  double pressure(int j, double S) const { return segmentation::pressure(chain_, j, S / L_) * B_ / (L_ * L_ * L_); }

  Section at(double S) const {
    double u[20], s;
    chain_.sample(S / L_, u, &s);
    const geometry::AxisPoint axis = problem_.tube.axis->at(S);
    const Vector3d &D1 = axis.frame.col(0), &D2 = axis.frame.col(1), &D3 = axis.frame.col(2);
    // the frame turns as D_j' = W x D_j
    const Vector3d W = axis.frame * axis.U[0],
                   W1 = axis.frame * axis.U[1];  // U x U = 0: components differentiate alone
    const Vector3d a = u[0] * L_ * D1 + u[4] * L_ * D2, ap = u[1] * D1 + u[5] * D2, app = (u[2] * D1 + u[6] * D2) / L_;
    const Vector3d r1 = D3 + ap + W.cross(a);
    const Vector3d r2 = W.cross(D3) + app + 2 * W.cross(ap) + W1.cross(a) + W.cross(W.cross(a));
    Section x;
    x.S = S;
    x.s = s * L_;
    x.r = axis.position + a;
    const Vector3d t = r1.normalized();
    const double unit = B_ / (L_ * L_);
    rod::Properties<double> p{B_, 0, 0, 0, rod_.compliance(), 0, 0, 0, 0, 0, 0};
    if (rod_.varies()) p = problem_.law.pieces[static_cast<std::size_t>(u[19])].at<double>(x.s);
    x.stretch = 1 + p.e * u[15] * unit;
    // smallest rotation that takes D3 to t
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(D3, t);
    const Vector3d k1 = turn * D1, k2 = turn * D2;
    x.d.col(0) = std::cos(u[8]) * k1 + std::sin(u[8]) * k2;
    x.d.col(1) = t.cross(x.d.col(0));
    x.d.col(2) = t;
    x.F = unit * (u[11] * k1 + u[13] * k2 + u[15] * t);
    // a torque that is not constant: that of the solved state
    const bool twisted = problem_.law.curved() || problem_.load.couples() || !problem_.point_loads.empty();
    const double M3 = twisted ? twisting_moment(S / L_, u) : torque_;
    x.M = p.B * (x.stretch * r1.cross(r2) / std::pow(r1.norm(), 3) - p.k1 * x.d.col(0) - p.k2 * x.d.col(1)) + M3 * t;
    // surface X(S, β) = R + Q e
    const auto Q = problem_.tube.clearance->at(S);
    const double scale = problem_.clearance_scale.value;
    x.eccentricity = a.norm();
    x.clearance = scale * Q[0];
    const Vector3d e = a.normalized();
    const Vector3d along = D3 + scale * Q[1] * e + scale * Q[0] * (W.cross(e)), around = D3.cross(e);
    x.normal = around.cross(along).normalized();
    if (x.normal.dot(e) < 0) x.normal = -x.normal;
    return x;
  }

  double sign() const { return problem_.tube.sign(); }
  /// a < x < b cut into `panels` equal parts and at the knots of the tube, where the pressure may jump.
  std::vector<double> cuts(double a, double b, int panels) const {
    std::vector<double> out;
    for (int i = 0; i <= panels; ++i) out.push_back(a + (b - a) * i / panels);
    for (const auto* knots : {&problem_.tube.axis->knots(), &problem_.tube.clearance->knots()})
      for (const double x : *knots)
        if (x > a && x < b) out.push_back(x);
    for (int j = 0; j < chain_.segments(); ++j)
      for (int q = 0; q + 1 < chain_.segment(j).parts(); ++q)  // a break of the section law: the force may jump
        if (const double x = chain_.segment(j).cut(q).S * L_; x > a && x < b) out.push_back(x);
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end(), [&](double x, double y) { return y - x < 1e-9 * (b - a); }),
              out.end());
    return out;
  }

 private:
  double twisting_moment(double S, const double* u) const {
    const auto& P = chain_.mechanics().problem;
    const auto k = formulation::FreeRod::kinematics<double>(formulation::lift<double>(P.section(S), 0.0, 0.0), u[0],
                                                            u[1], u[2], u[4], u[5], u[6]);
    return P.moments(k, u)[2] * P.moment_unit();
  }
  segmentation::Problem problem_;
  double torque_, L_, B_;
  CosseratRod rod_;
  segmentation::Chain chain_;
};

/// Largest differences of two views of one section, relative to L, the largest force and the largest moment.
struct Difference {
  double place = 0, directors = 0, force = 0, moment = 0;
  void take(const Section& a, const Section& b, double L, double F, double M) {
    place = std::max(place, (a.r - b.r).norm() / L);
    directors = std::max(directors, (a.d - b.d).norm());
    force = std::max(force, (a.F - b.F).norm() / F);
    moment = std::max(moment, (a.M - b.M).norm() / M);
  }
  double largest() const { return std::max({place, directors, force, moment}); }
};

/// Each free segment integrated from its start to its end (in `pieces` hops, so that the growth of the rod's unstable
/// direction, exp(sqrt(F3/B) s), stays bounded) against the solved state.
/// `force`, `moment`: least scale of the two.
inline Difference free_segments_against_integration(const SolvedRod& rod, double L, int pieces = 4,
                                                    double force = 1e-300, double moment = 1e-300) {
  Difference worst;
  const double inside = 1e-13 * L;  // the forces jump at the contacts: stay on this side of them
  double F = force, M = moment;
  for (int i = 0; i <= 100; ++i) {
    const Section x = rod.at(rod.place(rod.segments()) * i / 100);
    F = std::max(F, x.F.norm());
    M = std::max(M, x.M.norm());
  }
  for (int j = 0; j < rod.segments(); ++j) {
    if (rod.is_line(j)) continue;
    const double a = rod.place(j) + inside, b = rod.place(j + 1) - inside;
    Section here = rod.at(a);
    for (int i = 1; i <= pieces; ++i) {
      const Section there = rod.at(a + (b - a) * i / pieces);
      worst.take(rod.rod().continued(here, there.s), there, L, F, M);
      here = there;
    }
  }
  return worst;
}

/// Line contacts: equilibrium of each of `panels` parts under the wall's pressure along the surface's own normal, the
/// constitutive moment, and the rod on the wall.
struct LineFault {
  double force = 0, moment = 0, off_wall = 0;
  double largest() const { return std::max({force, moment, off_wall}); }
};
/// `force`, `moment`: least scale of the two, for a rod that lies on its wall unbent.
inline LineFault line_contacts_against_balance(const SolvedRod& rod, int panels = 24, double force = 1e-300,
                                               double moment = 1e-300) {
  LineFault fault;
  for (int j = 0; j < rod.segments(); ++j) {
    if (!rod.is_line(j)) continue;
    const double a0 = rod.place(j), b0 = rod.place(j + 1), inside = std::max(1e-13 * (b0 - a0), 1e-15 * std::abs(b0));
    double F = force, M = moment;
    const std::vector<double> cuts = rod.cuts(a0 + inside, b0 - inside, panels);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const double a = cuts[i], b = cuts[i + 1];
      const Section A = rod.at(a + inside), E = rod.at(b - inside);
      F = std::max({F, A.F.norm(), E.F.norm()});
      M = std::max({M, A.M.norm(), E.M.norm()});
      Vector3d wall = Vector3d::Zero(), couple = Vector3d::Zero();
      // Gauss points by hand, because the integrands are vectors
      using Gauss = boost::math::quadrature::gauss<double, 10>;
      const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
      for (std::size_t q = 0; q < Gauss::abscissa().size(); ++q)
        for (const double side : {-1.0, 1.0}) {
          const double S = middle + side * half * Gauss::abscissa()[q];
          const Section x = rod.at(S);
          // ds = |r'| dS / α, with |r'| by differences
          const double h = 1e-4 * half;
          const Section left = rod.at(S - h), right = rod.at(S + h), far_left = rod.at(S - 2 * h),
                        far_right = rod.at(S + 2 * h);
          const Vector3d slope = (8 * (right.r - left.r) - (far_right.r - far_left.r)) / (12 * h);
          const double ds = slope.norm() / x.stretch * half * Gauss::weights()[q];
          wall += (-rod.sign() * rod.pressure(j, S) * x.normal + rod.rod().load_at(x.s)) * ds;
          couple += x.stretch * x.d.col(2).cross(x.F) * ds;
          fault.off_wall = std::max(fault.off_wall, std::abs(x.eccentricity / x.clearance - 1));
        }
      fault.force = std::max(fault.force, (E.F - A.F + wall).norm() / F);
      fault.moment = std::max(fault.moment, (E.M - A.M + couple).norm() / M);
    }
  }
  return fault;
}

}  // namespace tendril::test

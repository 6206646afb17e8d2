#include "tendril/reproduce/straight_tube_twin.hpp"

#include <cmath>

#include "tendril/numerics/dual_newton.hpp"
#include "tendril/numerics/extrapolation.hpp"

namespace tendril::reproduce {
namespace {

template <class T>
struct Rod {
  std::array<T, 9> y{};  // r, t, M
  std::array<T, 3> F{};

  bool go(const T& length) {
    // over x in [0, 1], so that the length may carry derivatives
    const auto slope = [&](double, const std::array<T, 9>& v, std::array<T, 9>& d) {
      const T *t = &v[3], *M = &v[6];
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        d[i] = length * t[i];
        d[3 + i] = length * (M[j] * t[k] - M[k] * t[j]);
        d[6 + i] = length * (F[j] * t[k] - F[k] * t[j]);
      }
      return true;
    };
    return numerics::integrate(slope, 0.0, 1.0, y).completed;
  }
};

/// Unknowns: F, M1, M2 at the clamp, half length, and with contacts beside the middle their arc length and reaction.
template <int K>
struct Shooting {
  double clearance, push, torque;
  bool touches_in_the_middle;

  template <class T>
  bool run(const std::array<T, K>& u, Rod<T>& rod, Rod<T>* contact, std::array<T, 2>* touch) const {
    using std::sqrt;
    rod.F = {u[0], u[1], u[2]};
    rod.y[5] = T(1.0);
    rod.y[6] = u[3];
    rod.y[7] = u[4];
    rod.y[8] = T(torque);
    if constexpr (K == 8) {
      if (!rod.go(u[6])) return false;
      const T r = sqrt(rod.y[0] * rod.y[0] + rod.y[1] * rod.y[1]);
      *touch = {r - clearance, (rod.y[0] * rod.y[3] + rod.y[1] * rod.y[4]) / r};
      *contact = rod;
      rod.F[0] = rod.F[0] + u[7] * rod.y[0] / r;  // F jumps by R N, N outward
      rod.F[1] = rod.F[1] + u[7] * rod.y[1] / r;
      return rod.go(u[5] - u[6]);
    } else {
      (void)contact;
      (void)touch;
      return rod.go(u[5]);
    }
  }

  template <class T>
  bool operator()(const std::array<T, K>& u, std::array<T, K>& r) const {
    Rod<T> rod, contact;
    std::array<T, 2> touch{};
    if (!run(u, rod, &contact, &touch)) return false;
    r[0] = rod.y[2] - 0.5;
    r[1] = rod.y[1];
    r[2] = rod.y[3];                                                        // t · x
    r[3] = rod.y[6] * 0.1;                                                  // M · x
    r[4] = touches_in_the_middle ? rod.y[0] - clearance : rod.F[0] * 0.01;  // no force there
    r[5] = (0.5 * (u[3] * u[3] + u[4] * u[4]) + u[2] + push) * 0.01;        // push = -H, at the clamp
    if constexpr (K == 8) {
      r[6] = touch[0];
      r[7] = touch[1];
    }
    return true;
  }
};

template <int K>
TubeTwin solve(const Shooting<K>& shooting, std::array<double, K> u) {
  TubeTwin out;
  numerics::DualNewtonOptions options;
  options.tolerance = 1e-11;
  const auto s = numerics::solve_dual_newton<K>(shooting, u, options);
  out.converged = s.converged;
  out.reason = s.reason;
  Rod<double> rod, contact;
  std::array<double, 2> touch{};
  if (!s.converged || !shooting.run(u, rod, &contact, &touch)) return out;
  out.rod_length = 2.0 * u[5];
  out.place = 0.5;
  if (shooting.touches_in_the_middle) out.middle = -2.0 * rod.F[0];
  if constexpr (K == 8) {
    out.place = contact.y[2];
    out.turn = -2.0 * std::atan2(contact.y[1], contact.y[0]);
    out.outer = u[7];
  }
  return out;
}

}  // namespace

TubeTwin twin_of(const continuation::Step& step, double clearance) {
  const auto& f = step.fields;
  const auto& contacts = step.contacts;
  TubeTwin out;
  if (f.S.empty() || contacts.empty() || contacts.size() > 3) {
    out.reason = "one to three contacts are needed";
    return out;
  }
  // turned so that the middle lies over the x axis
  const double first = contacts.front().angle_start;
  const double angle = first + 0.5 * std::remainder(contacts.back().angle_start - first, 2.0 * M_PI);
  const double c = std::cos(angle), s = std::sin(angle);
  const auto turned = [&](double x, double y) { return std::array<double, 2>{c * x + s * y, c * y - s * x}; };
  const auto F = turned(f.F1.front(), f.F2.front()), M = turned(f.M1.front(), f.M2.front());
  const double half = 0.5 * step.rod_length;
  // starts a little off: the solution is the twin's own
  const double off = 1.0 + 1e-3;
  if (contacts.size() == 1)
    return solve<6>(Shooting<6>{clearance, step.push, step.torque_end, true},
                    {off * F[0], F[1], f.F3.front(), off * M[0], M[1], half});
  return solve<8>(
      Shooting<8>{clearance, step.push, step.torque_end, contacts.size() == 3},
      {off * F[0], F[1], f.F3.front(), off * M[0], M[1], half, contacts.front().s_start, off * contacts.front().force});
}

}  // namespace tendril::reproduce

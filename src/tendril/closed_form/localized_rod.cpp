#include "tendril/closed_form/localized_rod.hpp"

#include <cmath>

#include "tendril/closed_form/domain.hpp"

namespace tendril::closed_form {
namespace {

double amplitude(const LocalizedRod& rod) {
  require(rod.pull > 0.0 && std::isfinite(rod.pull), "pull", rod.pull, "positive");
  const double a2 = 1.0 - 0.25 * rod.torque * rod.torque / rod.pull;
  require(a2 > 0.0 && rod.torque != 0.0, "torque", rod.torque, "not zero and below 2 sqrt(BT)");
  return std::sqrt(a2);
}

}  // namespace

double LocalizedRod::decay() const { return amplitude(*this) * std::sqrt(pull); }
double LocalizedRod::shortening() const { return 4.0 * amplitude(*this) / std::sqrt(pull); }
double LocalizedRod::steepest() const { return 2.0 * std::asin(amplitude(*this)); }

double LocalizedRod::furthest() const {
  const Place middle = at(0.0);
  return std::hypot(middle.r[0], middle.r[1]);
}

LocalizedRod::Place LocalizedRod::at(double s) const {
  const double a = amplitude(*this), root = std::sqrt(pull), x = a * root * s;
  const double sech = 1.0 / std::cosh(x), u = a * sech, u1 = -a * root * u * std::tanh(x);
  // θ from u = sin(θ/2); ψ' = M/(1 + cosθ)
  const double half = std::sqrt(1.0 - u * u), sine = 2.0 * u * half, cosine = 1.0 - 2.0 * u * u;
  const double theta1 = 2.0 * u1 / half;
  const double m = torque / root, psi = 0.5 * torque * s + std::atan(2.0 * a * std::tanh(x) / m);
  const double psi1 = 0.5 * torque / (half * half), cp = std::cos(psi), sp = std::sin(psi);
  Place p;
  p.t = {sine * cp, sine * sp, cosine};
  p.t1 = {theta1 * cosine * cp - sine * psi1 * sp, theta1 * cosine * sp + sine * psi1 * cp, -theta1 * sine};
  // M(s) = t x t' + M t; across the axis r x T D3 = -M(s)
  const double Mx = p.t[1] * p.t1[2] - p.t[2] * p.t1[1] + torque * p.t[0];
  const double My = p.t[2] * p.t1[0] - p.t[0] * p.t1[2] + torque * p.t[1];
  p.r = {My / pull, -Mx / pull, s - 2.0 * a / root * std::tanh(x)};
  return p;
}

}  // namespace tendril::closed_form

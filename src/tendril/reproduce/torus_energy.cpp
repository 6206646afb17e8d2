#include "tendril/reproduce/torus_energy.hpp"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <numbers>

#include "tendril/numerics/dual.hpp"

namespace tendril::reproduce::torus {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using numerics::Dual;
using numerics::Jet;

constexpr double pi = std::numbers::pi;

/// |r' x r''|² / (2 |r'|⁵) and |r'|: bending energy and length per azimuth, of β, β', β''.
template <class T>
void densities(double epsilon, const T& b, const T& b1, const T& b2, T& bending, T& length) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const T cb = cos(b), sb = sin(b), C3 = 1.0 + epsilon * cb;
  const T x1 = -(epsilon * (sb * b1)), z1 = -(epsilon * (cb * b1));
  const T x2 = -(epsilon * (cb * b1 * b1 + sb * b2)) - C3, y2 = -(2.0 * epsilon * (sb * b1)),
          z2 = epsilon * (sb * b1 * b1 - cb * b2);
  const T c1 = C3 * z2 - z1 * y2, c2 = z1 * x2 - x1 * z2, c3 = x1 * y2 - C3 * x2;
  const T square = x1 * x1 + C3 * C3 + z1 * z1;
  length = sqrt(square);
  bending = 0.5 * ((c1 * c1 + c2 * c2 + c3 * c3) / (square * square * length));
}

struct Value {
  VectorXd gradient, length_gradient;
  MatrixXd hessian;
  double length = 0.0;
};

class Functional {
 public:
  Functional(double epsilon, double turn, int terms, int places)
      : epsilon_(epsilon), wave_(1.0 / turn), terms_(terms), basis_(places) {
    const double half = pi * turn;
    weight_ = half / places;
    for (int i = 0; i < places; ++i) {
      const double xi = half * (i + 0.5) / places;
      basis_[i].resize(3, terms);
      for (int k = 0; k < terms; ++k) {
        const double w = (k + 1) * wave_;
        basis_[i].col(k) << std::sin(w * xi), w * std::cos(w * xi), -w * w * std::sin(w * xi);
      }
    }
  }

  Value at(const VectorXd& c, double H) const {
    Value v{VectorXd::Zero(terms_), VectorXd::Zero(terms_), MatrixXd::Zero(terms_, terms_), 0.0};
    using D = Dual<3>;
    const int places = static_cast<int>(basis_.size());
    for (int i = 0; i < places; ++i) {
      const Eigen::Vector3d u = basis_[i] * c + Eigen::Vector3d(pi * (i + 0.5) / places, wave_, 0.0);
      Eigen::Vector3d g, l;
      Eigen::Matrix3d h;
      for (int e = 0; e < 3; ++e) {
        Jet<D> x[3], bending, length;
        for (int j = 0; j < 3; ++j) x[j] = {D::seed(u[j], j), D(e == j ? 1.0 : 0.0)};
        densities(epsilon_, x[0], x[1], x[2], bending, length);
        g[e] = bending.d.v + H * length.d.v;
        l[e] = length.d.v;
        for (int j = 0; j < 3; ++j) h(e, j) = bending.d.d[j] + H * length.d.d[j];
        if (e == 0) v.length += weight_ * length.v.v;
      }
      v.gradient += weight_ * (basis_[i].transpose() * g);
      v.length_gradient += weight_ * (basis_[i].transpose() * l);
      v.hessian += weight_ * (basis_[i].transpose() * h * basis_[i]);
    }
    return v;
  }

  double slope(const VectorXd& c) const {
    double s = wave_;
    for (int k = 0; k < terms_; ++k) s += (k + 1) * wave_ * c[k];
    return s;
  }

  /// H = F3 + ½κ² at ξ = 0, where β = β'' = 0, and its derivative by the slope there.
  std::array<double, 2> multiplier(double slope, double force) const {
    using D = Dual<1>;
    D bending, length;
    densities<D>(epsilon_, D(0.0), D::seed(slope, 0), D(0.0), bending, length);
    const D H = bending / length + force;
    return {H.v, H.d[0]};
  }

  double wave() const { return wave_; }

 private:
  double epsilon_, wave_, weight_ = 0.0;
  int terms_;
  std::vector<MatrixXd> basis_;  // rows sin, its first and second derivative
};

}  // namespace

EnergyTwin energy_twin(double epsilon, double turn, double force, const std::vector<double>& beta, int terms) {
  const Functional f(epsilon, turn, terms, 3 * terms);
  VectorXd c = VectorXd::Zero(terms);
  const int n = static_cast<int>(beta.size());
  for (int k = 0; k < terms; ++k)
    for (int i = 0; i < n; ++i) {
      const double angle = pi * (i + 0.5) / n;
      c[k] += 2.0 / n * (beta[i] - angle) * std::sin((k + 1) * angle);
    }
  EnergyTwin twin;
  VectorXd slope_rate(terms);
  for (int k = 0; k < terms; ++k) slope_rate[k] = (k + 1) * f.wave();
  for (int iteration = 0; iteration < 60 && !twin.converged; ++iteration) {
    const auto [H, H_rate] = f.multiplier(f.slope(c), force);
    const Value v = f.at(c, H);
    const MatrixXd jacobian = v.hessian + H_rate * v.length_gradient * slope_rate.transpose();
    const VectorXd step = jacobian.partialPivLu().solve(v.gradient);
    if (!step.allFinite()) return twin;
    const double size = step.cwiseAbs().sum();  // bounds the change of β
    c -= std::min(1.0, 0.5 / size) * step;
    twin.converged = size < 1e-12 * (1.0 + c.cwiseAbs().maxCoeff());
  }
  twin.slope = f.slope(c);
  twin.H = f.multiplier(twin.slope, force)[0];
  twin.length = 2.0 * f.at(c, twin.H).length;
  twin.coefficients.assign(c.data(), c.data() + terms);
  twin.rest = std::abs(c[terms - 1]) + std::abs(c[terms - 2]);
  return twin;
}

}  // namespace tendril::reproduce::torus

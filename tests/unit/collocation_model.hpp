#pragma once
// Model problems with known solutions for the collocation core, and a plain dense Newton iteration over one segment:
// the states of all mesh points against the continuity rows of every piece and given end values.

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <vector>

#include "tendril/collocation/segment.hpp"

namespace collocation_model {

using tendril::collocation::Condensed;
using tendril::collocation::Segment;
using tendril::collocation::System;

/// Orders 3 and 1 and one quadrature, nonlinear, with the solution u = sin ωS + S²/4, v = exp(-S) + cos ωS, q = ∫ u v:
/// u''' + u u'' - p v u' = f, (1 + u²) v' + u' v = g. f and g are made from that solution at p = 1.
class Mixed final : public System {
 public:
  double omega, p = 1.0;

  explicit Mixed(double omega) : omega(omega) {
    order = {3, 1};
    first = {0, 4};
    quadratures = 1;
    inputs = 6;
  }
  /// u u' u'' u''' u'''' v v' v''
  void exact(double S, double* e) const {
    const double s = std::sin(omega * S), c = std::cos(omega * S), w = omega;
    e[0] = s + 0.25 * S * S;
    e[1] = w * c + 0.5 * S;
    e[2] = -w * w * s + 0.5;
    e[3] = -w * w * w * c;
    e[4] = w * w * w * w * s;
    e[5] = std::exp(-S) + c;
    e[6] = -std::exp(-S) - w * s;
    e[7] = std::exp(-S) - w * w * c;
  }
  void inputs_at(double S, double* u) const {
    double e[8];
    exact(S, e);
    for (int j = 0; j < 4; ++j) u[j] = e[j];
    u[4] = e[5];
    u[5] = e[6];
  }
  void residual(double S, const double* u, double* out) const override {
    double e[8];
    exact(S, e);
    out[0] = u[3] + u[0] * u[2] - p * u[4] * u[1] - (e[3] + e[0] * e[2] - e[5] * e[1]);
    out[1] = (1 + u[0] * u[0]) * u[5] + u[1] * u[4] - ((1 + e[0] * e[0]) * e[6] + e[1] * e[5]);
    out[2] = u[0] * u[4];
  }
  void jacobian(double S, const double* u, double* out, double* jac) const override {
    residual(S, u, out);
    std::fill(jac, jac + 3 * 8, 0.0);
    double e[8];
    exact(S, e);
    jac[0] = u[2];
    jac[1] = -p * u[4];
    jac[2] = u[0];
    jac[3] = 1.0;
    jac[4] = -p * u[1];
    jac[6] = -(e[4] + e[1] * e[2] + e[0] * e[3] - e[6] * e[1] - e[5] * e[2]);
    jac[7] = -u[4] * u[1];
    double* r = jac + 8;
    r[0] = 2 * u[0] * u[5];
    r[1] = u[4];
    r[4] = u[1];
    r[5] = 1 + u[0] * u[0];
    r[6] = -(2 * e[0] * e[1] * e[6] + (1 + e[0] * e[0]) * e[7] + e[2] * e[5] + e[1] * e[6]);
    r = jac + 16;
    r[0] = u[4];
    r[4] = u[0];
  }
};

/// Linear and stiff: u'' = λ² (u - cos S) - cos S, u = cos S + exp(-λ S) + exp(-λ (1 - S)): layers at both ends.
class Layers final : public System {
 public:
  double lambda;
  explicit Layers(double lambda) : lambda(lambda) {
    order = {2};
    first = {0};
    inputs = 3;
  }
  void inputs_at(double S, double* u) const {
    const double a = std::exp(-lambda * S), b = std::exp(-lambda * (1 - S));
    u[0] = std::cos(S) + a + b;
    u[1] = -std::sin(S) + lambda * (b - a);
    u[2] = -std::cos(S) + lambda * lambda * (a + b);
  }
  void residual(double S, const double* u, double* out) const override {
    out[0] = u[2] - lambda * lambda * (u[0] - std::cos(S)) + std::cos(S);
  }
  void jacobian(double S, const double* u, double* out, double* jac) const override {
    residual(S, u, out);
    jac[0] = -lambda * lambda;
    jac[1] = 0.0;
    jac[2] = 1.0;
    jac[3] = -(lambda * lambda + 1) * std::sin(S);
    jac[4] = 0.0;
  }
};

/// A prescribed value of one state: at the left end (point 0) or the right end.
struct EndValue {
  bool right;
  int state;
  double value;
};

/// Newton on all states with dense linear algebra. Returns the last correction; the iterate is left in the segment.
inline double solve(Segment& s, double a, double b, const std::vector<EndValue>& ends, int iterations = 12) {
  const int ns = s.states(), n = (s.pieces() + 1) * ns;
  double last = HUGE_VAL;
  std::vector<double> dw(s.local().size() / s.pieces());
  for (int it = 0; it < iterations; ++it) {
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd r(n);
    int row = 0;
    Condensed c;
    for (int i = 0; i < s.pieces(); ++i) {
      if (!s.condense(i, a, b, c)) return HUGE_VAL;
      for (int e = 0; e < ns; ++e, ++row) {
        for (int q = 0; q < ns; ++q) J(row, i * ns + q) = c.rows[e * (ns + 3) + q];
        J(row, (i + 1) * ns + e) = 1.0;
        r[row] = c.residual[e];
      }
    }
    for (const EndValue& v : ends) {
      const int column = (v.right ? s.pieces() : 0) * ns + v.state;
      J(row, column) = 1.0;
      r[row++] = s.states_data()[column] - v.value;
    }
    const Eigen::VectorXd dz = -J.partialPivLu().solve(r);
    for (int i = 0; i < s.pieces(); ++i) {
      s.local_correction(i, &dz[i * ns], 0, 0, 0, dw.data());
      for (std::size_t l = 0; l < dw.size(); ++l) s.local()[i * dw.size() + l] += dw[l];
    }
    for (int j = 0; j < n; ++j) s.states_data()[j] += dz[j];
    last = dz.lpNorm<Eigen::Infinity>();
    if (last < 1e-14) break;
  }
  return last;
}

inline std::vector<EndValue> mixed_ends(const Mixed& m, double a, double b) {
  double l[6], r[6];
  m.inputs_at(a, l);
  m.inputs_at(b, r);
  return {{false, 0, l[0]}, {false, 1, l[1]}, {true, 0, r[0]}, {true, 3, r[4]}, {false, 4, 0.0}};
}

/// The mixed problem on `pieces` equal pieces of [a, b], solved.
inline Segment solved_mixed(const Mixed& m, int k, int pieces, double a, double b) {
  Segment s(&m, k);
  s.initialise(a, b, {}, pieces, [&](double S, double* u, double* q) {
    m.inputs_at(S, u);
    q[0] = 0.0;
  });
  solve(s, a, b, mixed_ends(m, a, b));
  return s;
}

}  // namespace collocation_model

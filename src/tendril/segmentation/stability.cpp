#include "tendril/segmentation/stability.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace tendril::segmentation {

using formulation::Matrix6;
using formulation::Vector6;

namespace {

double dot(const std::vector<Vector4>& a, const std::vector<Vector4>& b) {
  double s = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) s += a[i].dot(b[i]);
  return s;
}

// Quadratic form K with borders B and -D on the free degrees of freedom.
struct BorderedForm {
  BlockTridiagonal K, M, shifted;
  std::vector<Vector4> fixed;
  std::vector<std::vector<Vector4>> borders;
  std::vector<double> diagonal;

  // Negative eigenvalues of K + shift M on the subspace (D = 0) or with the added stiffness (D > 0) of the first m
  // borders.
  int negative(double shift, const std::vector<int>& use) {
    const std::size_t n = K.diagonal.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vector4 f = Vector4::Ones() - fixed[i];
      shifted.diagonal[i] = f.asDiagonal() * (K.diagonal[i] + shift * M.diagonal[i]) * f.asDiagonal();
      shifted.diagonal[i].diagonal() += fixed[i];
      if (i > 0) {
        const Vector4 g = Vector4::Ones() - fixed[i - 1];
        shifted.left[i] = f.asDiagonal() * (K.left[i] + shift * M.left[i]) * g.asDiagonal();
      }
    }
    const int count = shifted.factor();
    used = use;
    solved.resize(use.size());
    schur = -Eigen::Matrix2d::Identity();
    for (std::size_t a = 0; a < use.size(); ++a) {
      solved[a] = borders[use[a]];
      shifted.solve(solved[a]);
    }
    for (std::size_t a = 0; a < use.size(); ++a)
      for (std::size_t b = 0; b < use.size(); ++b)
        schur(a, b) = -dot(borders[use[a]], solved[b]) - (a == b ? diagonal[use[a]] : 0.0);
    const Eigen::Matrix2d symmetric = 0.5 * (schur + schur.transpose());
    return count + static_cast<int>((symmetric_eigenvalues<2>(symmetric).array() < 0.0).count()) - 2;
  }

  // With the factors of the last count.
  void solve(std::vector<Vector4>& x) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = x[i].cwiseProduct(Vector4::Ones() - fixed[i]);
    shifted.solve(x);
    Eigen::Vector2d r = Eigen::Vector2d::Zero();
    for (std::size_t a = 0; a < used.size(); ++a) r[a] = -dot(borders[used[a]], x);
    const Eigen::Vector2d y = schur.inverse() * r;
    for (std::size_t a = 0; a < used.size(); ++a)
      for (std::size_t i = 0; i < x.size(); ++i) x[i] -= y[a] * solved[a][i];
  }

 private:
  std::vector<int> used;
  std::vector<std::vector<Vector4>> solved;
  Eigen::Matrix2d schur;
};

// Node values in the moving directions (v_n, v_n', v_t, v_t') to (v1, v1', v2, v2').
Matrix4 moving_directions(double beta, double beta1) {
  const double c = std::cos(beta), s = std::sin(beta);
  Matrix4 T;
  T << c, 0, -s, 0, -beta1 * s, c, -beta1 * c, -s, s, 0, c, 0, beta1 * c, s, -beta1 * s, c;
  return T;
}

}  // namespace

StabilityReport stability(const StabilityProblem& p, const StabilityOptions& options) {
  const double L = p.tube.length(), sign = p.tube.sign();
  // Mesh: contacts on nodes, elements of the bending length or of the shortest distance between contacts.
  std::vector<double> required;
  const auto require = [&](double S) {
    if (S > 1e-9 && S < p.end_position - 1e-9 && (required.empty() || S > required.back() + 1e-9))
      required.push_back(S);
  };
  std::vector<double> marks;
  for (const auto& c : p.points) marks.push_back(c.S);
  for (const auto& c : p.lines) {
    marks.push_back(c.start);
    marks.push_back(c.end);
  }
  std::sort(marks.begin(), marks.end());
  for (const double S : marks) require(S);
  int n = options.elements;
  if (n <= 0)
    n = std::clamp(static_cast<int>(std::ceil(1.25 * p.end_position * std::sqrt(std::abs(p.lambda)))), 64, 6000);
  std::vector<double> knots;
  for (const double k : p.tube.axis->knots()) knots.push_back(k / L);
  for (const double k : p.tube.clearance->knots()) knots.push_back(k / L);
  std::sort(knots.begin(), knots.end());
  DiscreteRod rod(p.tube, p.data, discrete_rod_nodes(p.end_position, p.end_position / n, knots, required));
  const auto& nodes = rod.nodes();
  const std::size_t count = nodes.size();

  BorderedForm form;
  form.K.resize(count);
  form.shifted.resize(count);
  form.M = rod.mass();
  form.fixed.assign(count, Vector4::Zero());
  form.borders.assign(2, std::vector<Vector4>(count, Vector4::Zero()));
  form.diagonal.assign(2, 0.0);
  double length = 0.0;
  const auto line_at = [&](double S) {
    return std::find_if(p.lines.begin(), p.lines.end(),
                        [&](const LineReaction& c) { return S > c.start - 1e-9 && S < c.end + 1e-9; });
  };
  // δ-conjugate share of a force along the outward normal: C3/√(C3² + Q'²).
  const auto conjugate = [&](double S, const Vector6& x) {
    const auto section = rod.section_at(S);
    const double C3 = 1.0 + (section.V1.row(2) * x).value();
    const double slope = p.data.clearance_scale * p.tube.clearance->at(S * L)[1];
    return C3 / std::hypot(C3, slope);
  };
  for (const auto& q : rod.points()) {
    const Vector6 x = p.eccentricity(q.S);
    auto d = formulation::density_derivatives(q.section, x, p.lambda, p.torque, p.data.eta2);
    if (const auto c = line_at(q.S); c != p.lines.end()) {
      const double radius = std::hypot(x[0], x[3]), e1 = x[0] / radius, e2 = x[3] / radius;
      const double k = sign * c->pressure(q.S) * d.s1 * conjugate(q.S, x) / radius;
      d.hessian(0, 0) += k * e2 * e2;
      d.hessian(3, 3) += k * e1 * e1;
      d.hessian(0, 3) -= k * e1 * e2;
      d.hessian(3, 0) -= k * e1 * e2;
    }
    DiscreteRod::scatter(q, d.hessian, q.weight, form.K);
    DiscreteRod::scatter(q, d.s1_gradient, q.weight, form.borders[0]);
    DiscreteRod::scatter(q, d.c_gradient, q.weight, form.borders[1]);
    form.diagonal[0] -= q.weight * d.s1_rate;
    length += q.weight * d.s1;
  }
  form.diagonal[1] = (1.0 + p.data.nu) * length;

  // Node by node: directions that follow the wall, held values, concentrated reactions.
  std::vector<Matrix4> turn(count, Matrix4::Identity());
  std::size_t widest = 0;
  double widest_radius = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double S = nodes[i];
    const Vector6 x = p.eccentricity(S);
    const double radius = std::hypot(x[0], x[3]);
    if (i > 0 && i + 1 < count && radius > widest_radius) {
      widest = i;
      widest_radius = radius;
    }
    const auto point = std::find_if(p.points.begin(), p.points.end(),
                                    [&](const PointReaction& c) { return std::abs(c.S - S) < 2e-9; });
    const auto line = line_at(S);
    const bool tip = p.tip_rests && i + 1 == count;
    if (point == p.points.end() && line == p.lines.end() && !tip) continue;
    const double beta = std::atan2(x[3], x[0]), beta1 = (x[0] * x[4] - x[3] * x[1]) / (radius * radius);
    turn[i] = moving_directions(beta, beta1);
    form.fixed[i][0] = 1.0;
    double R = 0.0;
    Matrix4 extra = Matrix4::Zero();  // in the moving directions
    if (line != p.lines.end()) {
      form.fixed[i][1] = 1.0;
      if (std::abs(S - line->start) < 2e-9) R += line->reaction_start;
      if (std::abs(S - line->end) < 2e-9) R += line->reaction_end;
      R *= conjugate(S, x);
    } else if (tip) {
      R = p.tip_reaction * conjugate(S, x);
    } else {
      R = point->reaction * conjugate(S, x);
      const double e1 = x[0] / radius, e2 = x[3] / radius;
      // |δ|'' = δ''·e_r + |δ| β'²
      const double radius2 = e1 * x[2] + e2 * x[5] + radius * beta1 * beta1;
      const double Q2 = p.data.clearance_scale * p.tube.clearance->at(S * L)[2] * L;
      const double opening = sign * (Q2 - radius2);
      if (opening > 1e-10 * (1.0 + std::abs(radius2)))
        extra(1, 1) = R / opening;
      else
        form.fixed[i][1] = 1.0;  // curvature limit: the contact no longer moves freely
    }
    extra(2, 2) = sign * R / radius;
    const Matrix4 back = turn[i].inverse();
    form.K.diagonal[i] += back.transpose() * extra * back;
  }
  if (p.rotation_free && widest_radius > 0.0 && turn[widest].isIdentity(0.0)) {
    const Vector6 x = p.eccentricity(nodes[widest]);
    turn[widest] = moving_directions(std::atan2(x[3], x[0]), 0.0);
  }
  if (p.rotation_free && widest_radius > 0.0) form.fixed[widest][2] = 1.0;
  for (std::size_t i = 0; i < count; ++i) {
    for (BlockTridiagonal* A : {&form.K, &form.M}) {
      A->diagonal[i] = (turn[i].transpose() * A->diagonal[i] * turn[i]).eval();
      if (i > 0) A->left[i] = (turn[i].transpose() * A->left[i] * turn[i - 1]).eval();
    }
    for (auto& b : form.borders) b[i] = (turn[i].transpose() * b[i]).eval();
  }
  form.fixed.front() = form.fixed.front().cwiseMax(p.start.held());
  form.fixed.back() = form.fixed.back().cwiseMax(p.end.held());
  double border_size = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    for (auto& b : form.borders) b[i] = b[i].cwiseProduct(Vector4::Ones() - form.fixed[i]);
    border_size = std::max(border_size, form.borders[0][i].cwiseAbs().maxCoeff());
  }

  StabilityReport report;
  std::vector<int> held, push;
  // The length of an inextensible straight rod on its axis does not change to first order: no constraint.
  if (border_size > 1e-12 || form.diagonal[0] > 0.0) held.push_back(0);
  if (p.twist_held) {
    held.push_back(1);
    push.push_back(1);
  }
  const double unit = 10.0 + 0.25 * p.lambda * p.lambda, shift = options.tolerance * unit;
  report.negative_dead_push = form.negative(shift, push);
  report.negative_held_length = form.negative(shift, held);
  // Lowest eigenvalue by bisection on the count, then its mode by inverse iteration just below it.
  double below = 0.0, above = 0.0;  // count(below) = 0, count(above) > 0, as eigenvalues
  if (form.negative(0.0, held) > 0) {
    for (below = -unit; form.negative(-below, held) > 0 && below > -1e18; below *= 4.0) {
    }
  } else {
    for (above = unit; form.negative(-above, held) == 0 && above < 1e18; above *= 4.0) {
    }
  }
  for (int k = 0; k < 60 && above - below > 1e-9 * (std::abs(above) + std::abs(below)); ++k) {
    const double middle = 0.5 * (above + below);
    (form.negative(-middle, held) > 0 ? above : below) = middle;
  }
  report.lowest = 0.5 * (above + below);
  form.negative(-(below - 1e-6 * unit), held);
  std::vector<Vector4> v(count), w;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = nodes[i] / p.end_position;
    v[i] = Vector4(std::sin(7.1 * x) + 0.3, 0.0, 0.4 * std::cos(9.7 * x) + 0.2, 0.0);
  }
  for (int k = 0; k < 4; ++k) {
    form.M.multiply(v, w);
    form.solve(w);
    double size = 0.0;
    for (const auto& b : w) size = std::max({size, std::abs(b[0]), std::abs(b[2])});
    for (std::size_t i = 0; i < count; ++i) v[i] = w[i] / size;
  }
  report.S = nodes;
  report.mode.resize(count);
  for (std::size_t i = 0; i < count; ++i) report.mode[i] = turn[i] * v[i];
  return report;
}

}  // namespace tendril::segmentation

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

// Borders: the rod's length, its twist, a tip's distance from the wall (multipliers), and how far the tip moves along.
enum Border { by_length, by_twist, by_tip_wall, by_tip_place, border_count };
using Matrix_b = Eigen::Matrix<double, border_count, border_count>;

// Quadratic form K with borders B and the corner C on the free degrees of freedom.
struct BorderedForm {
  BlockTridiagonal K, M, shifted;
  std::vector<Vector4> fixed;
  std::vector<std::vector<Vector4>> borders;
  Matrix_b corner = Matrix_b::Zero();  // of the length and the twist: minus their compliances

  // Negative eigenvalues of K + shift M, and of the tip's place if in use, where the multipliers in use hold.
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
    schur = -Matrix_b::Identity();
    for (std::size_t a = 0; a < use.size(); ++a) {
      solved[a] = borders[use[a]];
      shifted.solve(solved[a]);
    }
    int multipliers = border_count;  // those not in use are borders of their own, of one negative eigenvalue
    for (std::size_t a = 0; a < use.size(); ++a) {
      for (std::size_t b = 0; b < use.size(); ++b)
        schur(a, b) = corner(use[a], use[b]) - dot(borders[use[a]], solved[b]);
      if (use[a] == by_tip_place) --multipliers;
    }
    const Matrix_b symmetric = 0.5 * (schur + schur.transpose());
    return count + static_cast<int>((symmetric_eigenvalues<border_count>(symmetric).array() < 0.0).count()) -
           multipliers;
  }

  // With the factors of the last count.
  void solve(std::vector<Vector4>& x) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = x[i].cwiseProduct(Vector4::Ones() - fixed[i]);
    shifted.solve(x);
    Eigen::Matrix<double, border_count, 1> r = Eigen::Matrix<double, border_count, 1>::Zero();
    for (std::size_t a = 0; a < used.size(); ++a) r[a] = -dot(borders[used[a]], x);
    const Eigen::Matrix<double, border_count, 1> y = schur.inverse() * r;
    for (std::size_t a = 0; a < used.size(); ++a)
      for (std::size_t i = 0; i < x.size(); ++i) x[i] -= y[a] * solved[a][i];
  }

 private:
  std::vector<int> used;
  std::vector<std::vector<Vector4>> solved;
  Matrix_b schur;
};

// Node values in the moving directions (v_n, v_n', v_t, v_t') to (v1, v1', v2, v2').
Matrix4 moving_directions(double beta, double beta1) {
  const double c = std::cos(beta), s = std::sin(beta);
  Matrix4 T;
  T << c, 0, -s, 0, -beta1 * s, c, -beta1 * c, -s, s, 0, c, 0, beta1 * c, s, -beta1 * s, c;
  return T;
}

// A free tip moves along the tube with the rest: what that does to the energy, to the rod's length and to the distance
// from the wall. M = 0 at the tip, so that the density there is |r'| φ(m), φ = 2m/(1 + √(1 + 2η²m)), m = λ - σ·r.
void move_tip(const StabilityProblem& p, const DiscreteRod& rod, BorderedForm& form) {
  const double S = p.end_position, L = p.tube.length(), sign = p.tube.sign(), eta2 = p.data.eta2;
  const Vector6 x = p.eccentricity(S);
  const auto section = rod.section_at(S);
  const auto d = formulation::density_derivatives(section, x, p.lambda, p.torque, eta2);
  const auto frame = p.tube.axis->at(S * L).frame;
  const Eigen::Vector3d sigma = frame.transpose() * p.data.body_force;
  const Eigen::Vector3d r1 = section.V1 * x + Eigen::Vector3d::UnitZ(), r2 = section.c2 + section.V2 * x;
  const double size = r1.norm(), alpha_m = size / d.s1;  // α
  const double m = p.lambda - section.force_potential - section.force[0] * x[0] - section.force[1] * x[3];
  const double phi = 2.0 * m / (1.0 + std::sqrt(std::max(1.0 + 2.0 * eta2 * m, 0.0)));
  Vector6 cross = d.gradient - section.V1.transpose() * p.tip_force;
  double place = phi * r1.dot(r2) / size - size / alpha_m * sigma.dot(r1) - p.tip_force.dot(r2);
  if (p.tip_rests) {
    const double radius = std::hypot(x[0], x[3]), e1 = x[0] / radius, e2 = x[3] / radius;
    const double radius1 = e1 * x[1] + e2 * x[4], turn1 = (e1 * x[4] - e2 * x[1]) / radius;
    const double C3 = r1[2];
    const auto Q = p.tube.clearance->at(S * L);
    const double scale = p.data.clearance_scale;
    const double R = sign * p.tip_reaction * C3 / std::hypot(C3, scale * Q[1]);
    cross[0] -= R * e2 * turn1;
    cross[3] += R * e1 * turn1;
    cross[1] += R * e1;
    cross[4] += R * e2;
    place += R * (e1 * x[2] + e2 * x[5] + radius * turn1 * turn1 - scale * Q[2] * L);
    form.borders[by_tip_wall].back() = Vector4(e1, 0, e2, 0);
    form.corner(by_tip_wall, by_tip_place) = form.corner(by_tip_place, by_tip_wall) = radius1 - scale * Q[1];
  }
  form.borders[by_tip_place].back() = Vector4(cross[0], cross[1], cross[3], cross[4]);
  form.corner(by_tip_place, by_tip_place) = place;
  form.corner(by_tip_place, by_length) = form.corner(by_length, by_tip_place) = d.s1;
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
  std::vector<double> marks = p.breaks;
  for (const auto& c : p.points) marks.push_back(c.S);
  for (const auto& c : p.lines) {
    marks.push_back(c.start);
    marks.push_back(c.end);
  }
  std::sort(marks.begin(), marks.end());
  for (const double S : marks) require(S);
  int n = options.elements;
  double wave2 = std::abs(p.lambda);  // of the shortest bending length there is
  if (p.data.properties)
    for (int i = 0; i <= 200; ++i) {
      const double S = p.end_position * i / 200.0;
      wave2 = std::max(wave2, std::abs(p.lambda_at(S)) / p.data.properties(S).B);
    }
  if (n <= 0) n = std::clamp(static_cast<int>(std::ceil(1.25 * p.end_position * std::sqrt(wave2))), 64, 6000);
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
  form.borders.assign(border_count, std::vector<Vector4>(count, Vector4::Zero()));
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
    auto d = formulation::density_derivatives(q.section, x, p.lambda_at ? p.lambda_at(q.S) : p.lambda, p.torque,
                                              p.data.eta2);
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
    form.corner(by_length, by_length) += q.weight * d.s1_rate;
    length += q.weight * d.s1 * (p.data.properties ? 1.0 / (p.data.properties(q.S).C * (1.0 + p.data.nu)) : 1.0);
  }
  form.corner(by_twist, by_twist) = -(1.0 + p.data.nu) * length;

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
    if (!(tip && p.end.free)) form.fixed[i][0] = 1.0;
    double R = 0.0;
    Matrix4 extra = Matrix4::Zero();  // in the moving directions
    if (line != p.lines.end()) {
      form.fixed[i][1] = 1.0;
      if (std::abs(S - line->start) < 2e-9) R += line->reaction_start;
      if (std::abs(S - line->end) < 2e-9) R += line->reaction_end;
      R *= conjugate(S, x);
    } else if (!tip && point->collar) {
      R = point->reaction * conjugate(S, x);
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
  if (p.end.free) move_tip(p, rod, form);
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
  if (border_size > 1e-12 || form.corner(by_length, by_length) < 0.0 || p.end.free) held.push_back(by_length);
  if (p.twist_held) {
    held.push_back(by_twist);
    push.push_back(by_twist);
  }
  if (p.end.free) {
    held.push_back(by_tip_place);
    if (p.tip_rests) held.push_back(by_tip_wall);
    if (p.tip_rests) push.push_back(by_tip_wall);
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

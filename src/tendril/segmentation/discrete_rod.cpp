#include "tendril/segmentation/discrete_rod.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace tendril::segmentation {

using formulation::Matrix6;
using formulation::Vector6;

Eigen::Matrix<double, 3, 4> hermite(double x, double h) {
  Eigen::Matrix<double, 3, 4> n;
  n << 1 - x * x * (3 - 2 * x), h * x * (1 - x) * (1 - x), x * x * (3 - 2 * x), h * x * x * (x - 1),
      6 * x * (x - 1) / h, (1 - x) * (1 - 3 * x), 6 * x * (1 - x) / h, x * (3 * x - 2), (12 * x - 6) / (h * h),
      (6 * x - 4) / h, (6 - 12 * x) / (h * h), (6 * x - 2) / h;
  return n;
}

void BlockTridiagonal::resize(std::size_t n) {
  diagonal.resize(n);
  left.resize(n);
  pivot_inverse_.resize(n);
  gain_.resize(n);
  set_zero();
}

void BlockTridiagonal::set_zero() {
  for (auto& b : diagonal) b.setZero();
  for (auto& b : left) b.setZero();
}

int BlockTridiagonal::factor() {
  int negative = 0;
  Matrix4 D = Matrix4::Zero();
  for (std::size_t i = 0; i < diagonal.size(); ++i) {
    D = diagonal[i];
    if (i > 0) {
      gain_[i].noalias() = left[i] * pivot_inverse_[i - 1];
      D.noalias() -= gain_[i] * left[i].transpose();
    }
    // Values and slopes differ in size by the element length: equilibrate before inverting.
    Vector4 e = D.diagonal().cwiseAbs().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Matrix4 scaled = e.asDiagonal() * D * e.asDiagonal();
    const Eigen::LLT<Matrix4> llt(scaled);
    if (llt.info() == Eigen::Success) {
      pivot_inverse_[i] = e.asDiagonal() * llt.solve(Matrix4::Identity()) * e.asDiagonal();
    } else {
      Matrix4 V;
      Vector4 w = symmetric_eigenvalues<4>(scaled, &V);
      for (int k = 0; k < 4; ++k) {
        if (w[k] < 0.0) ++negative;
        if (std::abs(w[k]) < 1e-15) w[k] = w[k] < 0.0 ? -1e-15 : 1e-15;  // an exact zero pivot counts as a tiny one
      }
      pivot_inverse_[i] = e.asDiagonal() * (V * w.cwiseInverse().asDiagonal() * V.transpose()) * e.asDiagonal();
    }
  }
  return negative;
}

void BlockTridiagonal::solve(std::vector<Vector4>& x) const {
  const std::size_t n = diagonal.size();
  for (std::size_t i = 1; i < n; ++i) x[i].noalias() -= gain_[i] * x[i - 1];
  for (std::size_t i = n; i-- > 0;) {
    x[i] = (pivot_inverse_[i] * x[i]).eval();
    if (i + 1 < n) x[i].noalias() -= gain_[i + 1].transpose() * x[i + 1];
  }
}

void BlockTridiagonal::multiply(const std::vector<Vector4>& x, std::vector<Vector4>& y) const {
  const std::size_t n = diagonal.size();
  y.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    y[i].noalias() = diagonal[i] * x[i];
    if (i > 0) {
      y[i].noalias() += left[i] * x[i - 1];
      y[i - 1].noalias() += left[i].transpose() * x[i];
    }
  }
}

const DiscreteRodData::Stretch* DiscreteRodData::collar_at(double S) const {
  for (const Stretch& x : collars)
    if (S > x.from && S < x.to) return &x;
  return nullptr;
}

double DiscreteRodData::largest_force() const {
  double most = body_force.norm();
  if (force_field)
    for (int i = 0; i <= 200; ++i) most = std::max(most, (body_force + force_field(i / 200.0)).norm());
  return most;
}

DiscreteRod::DiscreteRod(const geometry::Tube& tube, const DiscreteRodData& data, std::vector<double> nodes)
    : tube_(tube), data_(data), scale_(tube.length()), sign_(tube.sign()), nodes_(std::move(nodes)) {
  const double x[3] = {0.5 - 0.5 * std::sqrt(0.6), 0.5, 0.5 + 0.5 * std::sqrt(0.6)};
  const double w[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  points_.resize(3 * (nodes_.size() - 1));
  for (std::size_t e = 0; e + 1 < nodes_.size(); ++e) {
    const double h = nodes_[e + 1] - nodes_[e];
    for (int k = 0; k < 3; ++k) {
      QuadraturePoint& q = points_[3 * e + k];
      q.element = static_cast<int>(e);
      q.S = nodes_[e] + h * x[k];
      q.weight = h * w[k];
      q.shape = hermite(x[k], h);
      q.clearance = clearance_at(q.S);
      if (const auto* c = data_.collar_at(q.S)) {
        q.collar = c->collar;
        q.clearance -= sign_ * c->height;
      }
      q.section = section_at(q.S);
    }
  }
}

double DiscreteRod::clearance_at(double S) const {
  return data_.clearance_scale * tube_.clearance->at(S * scale_)[0] / scale_;
}

formulation::DensitySection DiscreteRod::section_at(double S) const {
  const geometry::AxisPoint p = tube_.axis->at(std::min(S * scale_, scale_));
  Eigen::Vector3d force = data_.body_force;
  rod::Properties<double> section{};
  if (data_.properties) {
    section = data_.properties(S);
    force += section.weight * data_.weight_direction;
  }
  double potential = force.dot(p.position) / scale_;
  if (data_.force_field) {
    const Eigen::Vector3d changing = data_.force_field(S);
    force += changing;
    potential = data_.potential ? potential + data_.potential(S) : force.dot(p.position) / scale_;
  }
  const Eigen::Vector3d local = p.frame.transpose() * force;
  auto d = formulation::density_section(p.U[0] * scale_, p.U[1] * (scale_ * scale_), local.head<2>(), potential);
  if (data_.properties) {
    if (data_.gain) d.force_potential -= data_.gain(S);
    d.bending = section.B;
    d.softness = data_.eta2 > 0.0 ? section.e / data_.eta2 : 1.0;
  }
  return d;
}

Vector6 DiscreteRod::at(const QuadraturePoint& q, const std::vector<Vector4>& u) const {
  const Vector4 &a = u[q.element], &b = u[q.element + 1];
  Vector6 x;
  x.head<3>() = q.shape * Vector4(a[0], a[1], b[0], b[1]);
  x.tail<3>() = q.shape * Vector4(a[2], a[3], b[2], b[3]);
  return x;
}

int DiscreteRod::element_of(double S) const {
  const auto it = std::upper_bound(nodes_.begin(), nodes_.end(), S);
  return std::clamp(static_cast<int>(it - nodes_.begin()) - 1, 0, static_cast<int>(nodes_.size()) - 2);
}

Vector6 DiscreteRod::at(double S, const std::vector<Vector4>& u) const {
  const int e = element_of(S);
  const double h = nodes_[e + 1] - nodes_[e];
  const auto n = hermite((S - nodes_[e]) / h, h);
  Vector6 x;
  x.head<3>() = n * Vector4(u[e][0], u[e][1], u[e + 1][0], u[e + 1][1]);
  x.tail<3>() = n * Vector4(u[e][2], u[e][3], u[e + 1][2], u[e + 1][3]);
  return x;
}

void DiscreteRod::scatter(const QuadraturePoint& q, const Vector6& gradient, double weight, std::vector<Vector4>& g) {
  const Vector4 one = weight * (q.shape.transpose() * gradient.head<3>());
  const Vector4 two = weight * (q.shape.transpose() * gradient.tail<3>());
  Vector4 &a = g[q.element], &b = g[q.element + 1];
  a.head<2>() += one.head<2>();
  a.tail<2>() += two.head<2>();
  b.head<2>() += one.tail<2>();
  b.tail<2>() += two.tail<2>();
}

void DiscreteRod::scatter(const QuadraturePoint& q, const Matrix6& hessian, double weight, BlockTridiagonal& K) {
  const Eigen::Matrix<double, 3, 4> weighted = weight * q.shape;
  Matrix4 &aa = K.diagonal[q.element], &bb = K.diagonal[q.element + 1], &ba = K.left[q.element + 1];
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      const Matrix4 k = q.shape.transpose() * (hessian.block<3, 3>(3 * i, 3 * j) * weighted);
      aa.block<2, 2>(2 * i, 2 * j) += k.block<2, 2>(0, 0);
      bb.block<2, 2>(2 * i, 2 * j) += k.block<2, 2>(2, 2);
      ba.block<2, 2>(2 * i, 2 * j) += k.block<2, 2>(2, 0);
    }
  }
}

BlockTridiagonal DiscreteRod::mass() const {
  BlockTridiagonal M;
  M.resize(nodes_.size());
  Matrix6 identity = Matrix6::Zero();
  identity(0, 0) = identity(3, 3) = 1.0;
  for (const auto& q : points_) scatter(q, identity, q.weight, M);
  // Three points under-integrate the product of cubics slightly; a rotary part keeps the slopes' share definite.
  Matrix6 rotary = Matrix6::Zero();
  rotary(1, 1) = rotary(4, 4) = 1.0;
  for (const auto& q : points_) {
    const double h = nodes_[q.element + 1] - nodes_[q.element];
    scatter(q, rotary, 0.1 * h * h * q.weight, M);
  }
  return M;
}

std::vector<double> discrete_rod_nodes(double end, double size, const std::vector<double>& knots,
                                       const std::vector<double>& required) {
  std::vector<double> marks = required;
  marks.insert(marks.begin(), 0.0);
  marks.push_back(end);
  for (const double k : knots) {
    const auto it = std::lower_bound(marks.begin(), marks.end(), k);
    if (it == marks.begin() || it == marks.end()) continue;
    if (k - *(it - 1) > 0.2 * size && *it - k > 0.2 * size) marks.insert(it, k);
  }
  std::vector<double> nodes{0.0};
  for (std::size_t i = 0; i + 1 < marks.size(); ++i) {
    const int n = std::max(1, static_cast<int>(std::ceil((marks[i + 1] - marks[i]) / size - 1e-9)));
    for (int j = 1; j <= n; ++j) nodes.push_back(marks[i] + (marks[i + 1] - marks[i]) * j / n);
  }
  return nodes;
}

}  // namespace tendril::segmentation

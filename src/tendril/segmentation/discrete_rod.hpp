#pragma once
// Finite-element energy of a rod in the tube's coordinate: cubic Hermite eccentricity (δ, δ' at the nodes), the reduced
// density of formulation/energy_density.hpp at three Gauss points an element, rod length and total twist as borders.
// Scaled by the axis length L and the bending stiffness B. Block-tridiagonal LDL^T with inertia count for minimisation
// and stability.

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <vector>

#include "tendril/formulation/energy_density.hpp"
#include "tendril/geometry/tube.hpp"
#include "tendril/rod/section_law.hpp"

namespace tendril::segmentation {

using Vector4 = Eigen::Matrix<double, 4, 1>;  // δ1, δ1', δ2, δ2' of a node
using Matrix4 = Eigen::Matrix<double, 4, 4>;

/// Eigenvalues of a small symmetric matrix by cyclic Jacobi rotations; `vectors` (columns) on request.
template <int N>
Eigen::Matrix<double, N, 1> symmetric_eigenvalues(Eigen::Matrix<double, N, N> A,
                                                  Eigen::Matrix<double, N, N>* vectors = nullptr) {
  if (vectors != nullptr) vectors->setIdentity();
  for (int sweep = 0; sweep < 30; ++sweep) {
    double off = 0.0;
    for (int p = 0; p < N; ++p)
      for (int q = p + 1; q < N; ++q) {
        off += std::abs(A(p, q));
        if (A(p, q) == 0.0) continue;
        const double theta = 0.5 * (A(q, q) - A(p, p)) / A(p, q);
        const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
        const double c = 1.0 / std::hypot(t, 1.0), s = t * c;
        for (int k = 0; k < N; ++k) {
          const double a = A(k, p), b = A(k, q);
          A(k, p) = c * a - s * b;
          A(k, q) = s * a + c * b;
        }
        for (int k = 0; k < N; ++k) {
          const double a = A(p, k), b = A(q, k);
          A(p, k) = c * a - s * b;
          A(q, k) = s * a + c * b;
        }
        if (vectors == nullptr) continue;
        for (int k = 0; k < N; ++k) {
          const double a = (*vectors)(k, p), b = (*vectors)(k, q);
          (*vectors)(k, p) = c * a - s * b;
          (*vectors)(k, q) = s * a + c * b;
        }
      }
    if (!(off > 1e-18 * A.diagonal().cwiseAbs().maxCoeff())) break;
  }
  return A.diagonal();
}

/// Symmetric block-tridiagonal matrix: diagonal blocks and the blocks to the left of them; factored as L D L^T.
struct BlockTridiagonal {
  std::vector<Matrix4> diagonal, left;  // left[i] couples node i to node i-1 (left[0] unused)

  void resize(std::size_t n);
  void set_zero();
  /// Factors into `*this`'s storage of pivots; returns the number of negative eigenvalues.
  int factor();
  /// Solves in place after factor().
  void solve(std::vector<Vector4>& x) const;
  /// y = A x (before or after factor(): the matrix itself is kept).
  void multiply(const std::vector<Vector4>& x, std::vector<Vector4>& y) const;

 private:
  std::vector<Matrix4> pivot_inverse_, gain_;  // D_i^-1, left_i D_{i-1}^-1
};

/// One quadrature point, geometry frozen.
struct QuadraturePoint {
  double S = 0.0, weight = 0.0, clearance = 1.0;  // [L], [L], Q [L]
  int element = 0, collar = -1;                   // collar: the clearance is that of a collar of the rod
  Eigen::Matrix<double, 3, 4> shape;              // (value, d/dS, d²/dS²) of the four Hermite functions
  formulation::DensitySection section;
};

/// Rod and load data every density evaluation needs, scaled.
struct DiscreteRodData {
  double eta2 = 0.0;                                     // B/(A L²), 0: inextensible
  double nu = 0.0;                                       // B/C - 1
  Eigen::Vector3d body_force = Eigen::Vector3d::Zero();  // world [B/L³]
  double clearance_scale = 1.0;
  // A varying rod: properties of the section that lies at S (s is taken as it is in a straight rod or a known state),
  // the direction of its weight, and where the section law breaks [L]. Empty: uniform.
  std::function<rod::Properties<double>(double S)> properties;
  // What λ gains along a varying rod whose axial force and moment go on where the section changes (a known state's).
  std::function<double(double S)> gain;
  std::vector<double> breaks;
  Eigen::Vector3d weight_direction = Eigen::Vector3d::Zero();  // world
  // Loads that change along the axis: force per length [B/L³], world, in addition; ∫ of its part along the axis [B/L²].
  std::function<Eigen::Vector3d(double S)> force_field;
  std::function<double(double S)> potential;
  /// What acts on a node: F1, M2, F2, -M1 of a point load in D, conjugate to δ1, δ1', δ2, δ2'.
  struct NodeLoad {
    double S = 0.0;  // [L]
    Eigen::Matrix<double, 4, 1> load = Eigen::Matrix<double, 4, 1>::Zero();
  };
  std::vector<NodeLoad> loads;
  /// A short stretch, bounded by nodes, over which the wall meets a collar.
  struct Stretch {
    double from = 0.0, to = 0.0;  // [L]
    int collar = -1;
    double height = 0.0;  // [L]
  };
  std::vector<Stretch> collars;
  const Stretch* collar_at(double S) const;
  double largest_force() const;  // per length, where it is not concentrated
};

class DiscreteRod {
 public:
  static constexpr int points_per_element = 3;

  /// `nodes` ascending, scaled by the axis length.
  DiscreteRod(const geometry::Tube& tube, const DiscreteRodData& data, std::vector<double> nodes);

  std::size_t node_count() const { return nodes_.size(); }
  const std::vector<double>& nodes() const { return nodes_; }
  const std::vector<QuadraturePoint>& points() const { return points_; }
  const DiscreteRodData& data() const { return data_; }
  double sign() const { return sign_; }  // ς
  double clearance_at(double S) const;   // scaled

  /// δ1, δ1', δ1'', δ2, δ2', δ2'' at a quadrature point.
  formulation::Vector6 at(const QuadraturePoint& q, const std::vector<Vector4>& u) const;
  /// The same anywhere.
  formulation::Vector6 at(double S, const std::vector<Vector4>& u) const;
  int element_of(double S) const;

  /// Section data anywhere (scaled).
  formulation::DensitySection section_at(double S) const;

  /// Adds weight * (gradient, Hessian in x) of a quadrature point to the nodal gradient and matrix.
  static void scatter(const QuadraturePoint& q, const formulation::Vector6& gradient, double weight,
                      std::vector<Vector4>& g);
  static void scatter(const QuadraturePoint& q, const formulation::Matrix6& hessian, double weight,
                      BlockTridiagonal& K);
  /// Consistent L² mass matrix of the eccentricity.
  BlockTridiagonal mass() const;

 private:
  geometry::Tube tube_;
  DiscreteRodData data_;
  double scale_ = 1.0, sign_ = 1.0;
  std::vector<double> nodes_;
  std::vector<QuadraturePoint> points_;
};

/// Cubic Hermite functions (value left, slope left, value right, slope right) of an element of size h at x in [0, 1],
/// with two derivatives.
Eigen::Matrix<double, 3, 4> hermite(double x, double h);

/// Nodes on [0, end]: at most `size` apart, on every place of `required` (ascending, inside), and on the knots unless
/// these crowd closer than a fifth of `size` to another mark.
std::vector<double> discrete_rod_nodes(double end, double size, const std::vector<double>& knots,
                                       const std::vector<double>& required = {});

}  // namespace tendril::segmentation

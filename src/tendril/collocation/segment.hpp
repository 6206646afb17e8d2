#pragma once
// One boundary value problem on [S_a, S_b] by Gauss collocation in the Runge-Kutta monomial basis with local
// condensation (Ascher, Mattheij & Russell, ch. 5). The space: piecewise polynomials with m_c - 1 continuous
// derivatives, whose m_c-th derivative is a polynomial of degree k - 1 on every piece; k Gauss points a piece. The ends
// may be unknowns: every mesh point keeps its share of the length, S_i = S_a + share_i (S_b - S_a); `aligned` tells
// when the mesh has drifted off the knots of the data and wants a new one. State at a mesh point: derivatives 0..m_c-1
// of every component, then the quadratures.

#include <functional>
#include <span>
#include <vector>

#include "tendril/collocation/system.hpp"
#include "tendril/numerics/gauss.hpp"

namespace tendril::collocation {

/// Linearised continuity of one piece: z_{i+1} - step(z_i) over the columns z_i, S_a, S_b, p.
struct Condensed {
  std::vector<double> rows;      // row-major, states x (states + 3): -d z_{i+1}/d(z_i, S_a, S_b, p)
  std::vector<double> residual;  // z_{i+1} - predicted, at the current iterate, w corrected
};

class Segment {
 public:
  Segment() = default;
  Segment(const System* system, int k) : system_(system), table_(&numerics::gauss_table(k)) { layout(); }

  using Sampler = std::function<void(double S, double* inputs, double* quadratures)>;
  /// Mesh through the knots inside (a, b) with about `pieces` pieces, filled from the sampler.
  void initialise(double a, double b, std::span<const double> knots, int pieces, const Sampler& sampler);
  /// Same, with given interior points.
  void initialise_on(double a, double b, std::span<const double> points, const Sampler& sampler);
  /// Every knot inside (a, b) lies within `distance` of a mesh point.
  bool aligned(double a, double b, std::span<const double> knots, double distance) const;

  const System& system() const { return *system_; }
  void rebind(const System* system) { system_ = system; }
  int pieces() const { return pieces_; }
  int states() const { return states_; }
  int points_per_piece() const { return table_->k; }
  double place(int i, double a, double b) const { return a + share_[i] * (b - a); }
  double* state(int i) { return &z_[static_cast<std::size_t>(i) * states_]; }
  const double* state(int i) const { return &z_[static_cast<std::size_t>(i) * states_]; }
  int state_index(int component, int derivative = 0) const { return state_first_[component] + derivative; }

  /// Linearise piece i at the current iterate. False when the local system is singular or not finite.
  bool condense(int i, double a, double b, Condensed& out);
  /// Continuity residual of piece i with the factors of the last condense; remembers the corrections of w. Adds the
  /// squares of the row-scaled collocation residuals to `square`.
  bool residual(int i, double a, double b, std::span<double> out, double* square = nullptr);
  /// Correction of the local unknowns that belongs to given changes of z_i, S_a, S_b, p (after condense or residual).
  void local_correction(int i, const double* dz, double da, double db, double dp, double* dw) const;

  /// Local unknowns, piece by piece.
  std::vector<double>& local() { return w_; }
  const std::vector<double>& local() const { return w_; }
  /// Highest derivative of a component at a Gauss point of piece i.
  double& highest(int i, int point, int component) {
    return w_[static_cast<std::size_t>(i) * local_ + component * table_->k + point];
  }
  std::vector<double>& states_data() { return z_; }
  const std::vector<double>& states_data() const { return z_; }

  /// All inputs (derivatives 0..m_c) and quadratures at S, as the system presents them.
  void evaluate(double S, double a, double b, double* inputs, double* quadratures) const;
  /// The same on piece i at the local coordinate x in [0,1].
  void evaluate_local(int i, double x, double a, double b, double* inputs, double* quadratures) const;
  /// The same as the system's own unknowns.
  void evaluate_own(int i, double x, double a, double b, double* inputs, double* quadratures) const;
  int piece_at(double S, double a, double b) const;

  /// Estimated error between nodes of every input below the highest derivative and of the highest one, piece by piece:
  /// error[i * inputs + j]; from the defect at the ends of the pieces, whose shape is that of the Legendre polynomial
  /// P_k.
  void estimate_error(double a, double b, std::vector<double>& error) const;

  /// New mesh whose pieces have equal share of ratio^(1/(k+1)), ratio the error over its tolerance on the old pieces.
  void adapt(double a, double b, std::span<const double> knots, std::span<const double> ratio, double safety);

  /// The ends have moved from (a0, b0) to (a, b): the mesh points between stay where they were, S for S, with the
  /// states they have (a moving mesh would carry them along). Points that an end has come too close to go, knots that
  /// it has passed come in, a piece grown long is cut. True if the pieces are still the same ones.
  bool stay(double a0, double b0, double a, double b, std::span<const double> knots);

 private:
  const System* system_ = nullptr;
  const numerics::GaussTable* table_ = nullptr;
  int pieces_ = 0, states_ = 0, z_columns_ = 0, local_ = 0, width_ = 0;
  std::vector<int> state_first_;
  std::vector<double> share_, z_, w_;
  std::vector<double> factors_;  // per piece: local_ x width_ (LU | d w/d(z, S_i, h, p) | w correction)
  std::vector<int> pivots_;
  std::vector<double> row_scale_, condensed_width_;
  std::vector<numerics::Pack> scratch_;  // inputs | equations | Jacobian of one piece
  std::vector<double> quad_rows_;        // per piece: quadratures x (z_columns + 3 + local) derivative of the increment

  struct Assembly;
  void layout();
  void end_inputs(int i, int side, double* u) const;
  void gauss_inputs(const double* z, const double* w, double h, numerics::Pack* u) const;
};

}  // namespace tendril::collocation

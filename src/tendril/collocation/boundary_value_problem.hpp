#pragma once
// A boundary value problem over several segments, each a system on x in [0,1], with nonlinear conditions on the states
// at all their ends and one parameter p: one damped Newton iteration over all pieces (Gauss collocation with local
// condensation, frontal LU), and meshes adapted to a tolerance between nodes. Unknown constants and lengths are
// components with zero derivative. One more condition closes the system for p: p is held, or another condition on the
// ends, or a plane in the space of the unknowns (pseudo-arclength). Ascher, Mattheij & Russell, ch. 5-8.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tendril/collocation/dual_system.hpp"
#include "tendril/collocation/segment.hpp"
#include "tendril/numerics/frontal.hpp"

namespace tendril::collocation {

/// The condition that closes the system for p.
struct Closure {
  enum class Kind { parameter, condition, plane } kind = Kind::parameter;
  double value = 0.0;          // parameter: p; plane: normal · unknowns
  Conditions condition;        // condition: one row
  std::vector<double> normal;  // plane: over the unknowns of `gather`

  static Closure at(double p) { return {Kind::parameter, p, {}, {}}; }
  static Closure where(Conditions one) { return {Kind::condition, 0.0, std::move(one), {}}; }
  static Closure on_plane(std::vector<double> normal, double value) {
    return {Kind::plane, value, {}, std::move(normal)};
  }
};

struct BvpOptions {
  double tolerance = 1e-10;         // estimated error between nodes <= tolerance * scale, for every state
  double newton_tolerance = 1e-11;  // last simplified correction <= newton_tolerance * scale
  int max_iterations = 50;          // of Newton, on one mesh
  double min_damping = 1e-5;
  bool adapt = true;  // false: the mesh stays
  int max_meshes = 10;
  int max_pieces = 4000;  // of all segments together
};

struct BvpSummary {
  bool converged = false;
  std::string reason;  // why not
  int iterations = 0, factorisations = 0;
  double correction = 0.0;  // last scaled correction
  double error = 0.0;       // estimated between nodes, largest over the states, relative to their scales
};

class BoundaryValueProblem {
 public:
  using Systems = std::vector<std::shared_ptr<ParametricSystem>>;
  /// k = 4..7 Gauss points a piece. Conditions: one for every state of every segment. Copies share the systems, whose
  /// p follows whichever copy is at work: one thread at a time.
  BoundaryValueProblem(Systems systems, Conditions conditions, int k = 7);

  /// Inputs (derivatives 0..m_c of every component) and quadratures at x of a segment.
  using Sampler = std::function<void(int segment, double x, double* inputs, double* quadratures)>;
  /// `knots`: places in (0,1) that must stay mesh points, per segment (may be empty).
  void initialise(const Sampler& sampler, int pieces, std::vector<std::vector<double>> knots = {});
  /// Smallest typical size of every state of a segment (default 1): what the tolerances are relative to.
  void set_scale(int segment, std::vector<double> floor);
  void set_parameter(double p) { p_ = p; }
  void set_parameter_scale(double scale) { p_scale_ = scale; }

  /// A held p is set at once on a first guess; from a solved state it is reached along the tangent.
  BvpSummary solve(const Closure& closure, const BvpOptions& options = {});
  /// Largest error estimate between nodes over the scale of its state.
  double estimate_error();
  /// New meshes for `tolerance`; the state is carried over, not solved again.
  void adapt(double tolerance);
  /// The same state on another problem's meshes.
  BoundaryValueProblem on_mesh_of(const BoundaryValueProblem& other) const;

  int segments() const { return static_cast<int>(segment_.size()); }
  const Segment& segment(int j) const { return segment_[j]; }
  int pieces() const;
  double parameter() const { return p_; }
  void evaluate(int segment, double x, double* inputs, double* quadratures) const;
  /// Value (or lower derivative) of a component at an end of a segment.
  double end_value(int segment, bool right, int component, int derivative = 0) const;
  /// States at all ends, left0 | right0 | left1 | ...
  std::vector<double> ends() const;

  // The unknowns as one vector: states of all mesh points, then p; `_all` appends the local unknowns.
  int unknowns() const { return column_of_p() + 1; }
  int column_of_p() const { return state_columns_; }
  int column_of_state(int segment, int point, int state) const {
    return first_column_[segment] + point * segment_[segment].states() + state;
  }
  void gather(std::vector<double>& x) const;
  void gather_all(std::vector<double>& x) const;
  void scatter_all(const std::vector<double>& x);
  /// Weights of an inner product of unknowns that does not depend on the mesh: (1 / mesh points) / scale^2.
  std::vector<double> metric();

  /// Direction in which the state moves when unknown `held` grows by one and every condition still holds.
  bool tangent(int held, std::vector<double>& t);
  /// Move along a tangent just computed.
  void advance(const std::vector<double>& t, double step);
  /// Response of the unknowns to a fixed load on every condition, on the plane with this normal.
  bool response(const std::vector<double>& normal, std::vector<double>& y);
  /// Of the last factorised matrix (for `tangent`: with unknown `held` held). Its sign depends on the mesh.
  int determinant_sign() const { return lu_.determinant_sign(); }

 private:
  struct Block {  // of rows in the linear system: a piece, or conditions
    int segment = -1, piece = -1;
    std::vector<int> rows, ends;  // conditions: which, and the entries of (ends, p) they read
  };
  Systems system_;
  Conditions conditions_;
  std::vector<Segment> segment_;
  std::vector<std::vector<double>> knots_, floor_;
  double p_ = 0.0, p_scale_ = 0.0;
  std::vector<int> first_column_;
  int state_columns_ = 0, ends_ = 0;
  std::vector<char> pattern_;  // entries of the conditions' Jacobian ever seen different from zero
  std::vector<Block> blocks_;
  std::vector<std::vector<int>> columns_;
  numerics::FrontalLU lu_;
  bool analysed_ = false, solved_ = false;
  int held_ = -1, closure_row_ = -1;  // held unknown, -1: a condition closes; position of the closing row
  std::vector<double> scale_, rhs_, r_, jac_, plane_;

  void bind() const;
  void number();
  int column_of_end(int index) const;
  bool look(const Closure& closure);
  void arrange(const Closure& closure);
  void update_scale();
  void conditions_at(const Closure& closure, bool with_jacobian);
  bool assemble(const Closure& closure, int held);
  bool residual(const Closure& closure);
  void correction(const Closure& closure, std::vector<double>& dx);
  void local_changes(const std::vector<double>& dx, std::vector<double>& dw) const;
  BvpSummary newton(const Closure& closure, const BvpOptions& options);
  double error_ratios(double tolerance, std::vector<std::vector<double>>& ratio);
};

}  // namespace tendril::collocation

#pragma once
// The rod as a chain of elementary problems, and one Newton iteration over the whole chain: every segment condensed
// piece by piece, junction and end conditions, the unknown places S_k of the junctions, and the path parameter p with
// the one condition that closes the system. Block-banded with a thin border, so the cost is linear in the number of
// contacts.

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "tendril/collocation/segment.hpp"
#include "tendril/numerics/frontal.hpp"
#include "tendril/numerics/stop.hpp"
#include "tendril/segmentation/cut_segment.hpp"
#include "tendril/segmentation/scaled_problem.hpp"

namespace tendril::segmentation {

/// Kinds of the elementary problems in order, and the places between them (scaled). Two free neighbours: a point
/// contact.
struct Pattern {
  std::vector<char> line;         // n
  std::vector<double> S;          // n - 1
  bool tip = false;               // a free tip rests on the wall
  std::vector<char> collar = {};  // collars that touch the wall; empty: none does
  bool operator==(const Pattern&) const = default;
};

/// The condition that closes the system for the parameter p.
struct Closure {
  enum class Kind { parameter, unknown, span } kind = Kind::parameter;
  int index = 0;       // unknown: column; span: segment whose length is held
  double value = 0.0;  // p, the unknown's value, or the length
};

struct NewtonOptions {
  double tolerance = 1e-11;  // |last simplified correction| / scale below this: converged
  int max_iterations = 40;
  double min_damping = 1e-4;
  bool residual_line_search = false;  // Algorithms IV.2-IV.3 (corrected) instead of the natural monotonicity test
  numerics::Stop stop;                // asked before every iteration
  bool keep_factors = false;  // begin on the factors of the last solve, if of the same mesh, pattern and closure
};

struct NewtonSummary {
  bool converged = false;
  int iterations = 0, factorisations = 0;
  double correction = 0.0;  // last scaled correction
  std::string reason;       // why not
};

class Chain {
 public:
  Chain() = default;
  explicit Chain(std::shared_ptr<Mechanics> mechanics, int k) : mechanics_(std::move(mechanics)), k_(k) {}

  /// Free inputs (FreeRod layout) and s at S; used to fill the segments of a pattern.
  using Sampler = std::function<void(double S, double* u, double* s)>;
  /// Line-contact inputs and s at S where the state sampled lies on the wall; false elsewhere.
  using LineSampler = std::function<bool(double S, double* line, double* s)>;
  void build(const Pattern& pattern, int pieces_total, const Sampler& sampler);
  /// The same on given mesh points (ascending), with at least three pieces in every segment.
  void build(const Pattern& pattern, const std::vector<double>& points, const Sampler& sampler,
             const LineSampler& on_wall = {});
  /// The same state cut differently (pattern change), or another one on the same mesh points.
  Chain recut(const Pattern& pattern) const;
  Chain recut(const Pattern& pattern, const Sampler& sampler) const;
  /// Take over segments solved elsewhere, on the same mechanics and between the same ends.
  void adopt(const Pattern& pattern, std::vector<collocation::Segment> segments);

  NewtonSummary solve(const Closure& closure, const NewtonOptions& options);
  /// Solve, then refine the meshes until the error estimate between nodes meets `tolerance` (coarsen when far below).
  NewtonSummary solve_adaptive(const Closure& closure, const NewtonOptions& options, double tolerance);
  /// d(unknowns)/d(closure value) at the converged state (uses the factors of the last solve; refactors if needed).
  bool tangent(const Closure& closure, std::vector<double>& t);
  /// Response of the scaled unknowns to a load of the size of 1 on every condition but the closure, at the
  /// present state; load case 0 is 1 everywhere.
  bool response(const Closure& closure, std::vector<double>& y, int load_case = 0);

  /// Hold junction j at S instead of asking for tangency (point) or equal normal curvature (line end): a regular
  /// problem for starting new contacts. `release` restores the condition.
  void hold(int junction, double S);
  void release(int junction);
  bool held(int junction) const { return !held_.empty() && std::isfinite(held_[junction]); }
  bool any_held() const;

  Pattern pattern() const;
  int segments() const { return static_cast<int>(segment_.size()); }
  bool is_line(int j) const { return line_[j] != 0; }
  bool tip_rests() const { return tip_; }
  bool touches(int collar) const { return touching_[collar] != 0; }
  /// Where a free tip is to be sought when the rod's length is given (scaled S): the first guess of `build`.
  void set_tip_place(double S) { tip_place_ = S; }
  /// A free segment whose unknowns are wall coordinates (formulation/near_wall.hpp): between two contacts, where the
  /// rod hardly leaves the wall. Its `Segment` still evaluates to the inputs of the contact-free form.
  bool near_wall(int j) const { return &segment_[j].system() == &mechanics_->near_wall; }
  /// All free segments in δ1, δ2.
  void use_eccentricities();
  double S(int j) const { return S_[j]; }  // j = 0..n
  double parameter() const { return p_; }
  void set_parameter(double p) { p_ = p; }
  double phase_multiplier() const { return multiplier_; }
  const CutSegment& segment(int j) const { return segment_[j]; }
  CutSegment& segment(int j) { return segment_[j]; }
  const Mechanics& mechanics() const { return *mechanics_; }
  const std::shared_ptr<Mechanics>& mechanics_ptr() const { return mechanics_; }
  int k() const { return k_; }

  /// State at S in free form, whatever the segment (a line contact is converted).
  void sample(double S, double* u, double* s) const;
  int segment_at(double S) const;
  /// Largest estimated error between nodes over all components, relative to their scales; at least what rounding left
  /// of the last solve.
  double error() const { return error_; }
  double estimate_error();

  // Unknowns as one vector (states of all mesh points, S_0..S_n, p, multiplier), for predictors and step control.
  int unknowns() const;
  void gather(std::vector<double>& x) const;
  void scatter(const std::vector<double>& x);
  /// The same with the local unknowns appended: the complete iterate.
  void gather_all(std::vector<double>& x) const;
  void scatter_all(const std::vector<double>& x);
  /// Move along `t` (from `tangent`) by `step` of the closure's value, local unknowns included.
  void advance(const std::vector<double>& t, double step);
  double parameter_scale() const { return p_scale_; }
  void set_parameter_scale(double scale) { p_scale_ = scale; }
  /// The junctions have come from `before` (S_0..S_n) to where they are; the mesh points stay, S for S. True if the
  /// unknowns are the same ones.
  bool stay(const std::vector<double>& before);
  const std::vector<double>& places() const { return S_; }
  /// New meshes whose estimated errors are spread evenly and meet `tolerance`; the state is interpolated. `like`: a
  /// chain with the same meshes whose errors are taken, where the state here is none yet.
  void relay(double tolerance, const Chain* like = nullptr);
  /// Continue on another problem of the same family (a parameter that rebuilds geometry or rod).
  void rebind(std::shared_ptr<Mechanics> mechanics);
  /// Typical size of every unknown.
  void scales(std::vector<double>& d) const;
  int column_of_S(int j) const { return state_columns_ + j; }
  int column_of_p() const { return state_columns_ + segments() + 1; }
  int column_of_state(int segment, int point, int component) const {
    const int part = segment_[segment].part_of(point);
    return first_column_[segment][part] + point * segment_[segment].states() + component;
  }
  int determinant_sign() const { return lu_.determinant_sign(); }
  void store(std::vector<double>& out) const;  // opaque state for files
  bool restore(const std::vector<double>& in, std::shared_ptr<Mechanics> mechanics);
  /// In a planar problem: what leaves the plane is zero, exactly, and the contacts on one wall or the other.
  void flatten();
  /// Off the axis of an axisymmetric problem: turning it about the axis gives another solution.
  bool turns_freely() const;
  bool needs_phase() const { return turns_freely() && !mechanics_->problem.planar; }

 private:
  std::shared_ptr<Mechanics> mechanics_;
  int k_ = 7;
  std::vector<char> line_;
  std::vector<double> S_;
  std::vector<double> held_;  // per junction: place it is held at, NaN: free; empty: none
  std::vector<CutSegment> segment_;
  double p_ = 0.0, p_scale_ = 1.0, multiplier_ = 0.0, error_ = 0.0;
  bool tip_ = false;
  std::vector<char> touching_;                                   // per collar of the problem
  double tip_place_ = std::numeric_limits<double>::quiet_NaN();  // of the next build; NaN: the problem's end
  // structure of the linear system
  std::vector<std::vector<int>> first_column_;  // of every part; the place of the cut before it comes last before it
  int state_columns_ = 0;
  bool phase_ = false, factored_ = false;
  int phase_segment_ = 0, phase_piece_ = 0;
  int phase_component_ = 0;
  std::vector<std::vector<int>> blocks_;
  numerics::FrontalLU lu_;
  std::vector<double> scale_, rhs_, values_, unknown_;
  std::vector<double> row_weight_;    // of the rows of the last assembly
  std::vector<double> row_rounding_;  // of the residuals of the last assembly
  double rounding_ = 0.0;             // the last correction of a solve that came to rest at rounding, else 0
  double merit_ = 0.0;                // ½|F|² of the last residual, every row over its largest scaled coefficient
  struct StateScale {
    double d0, d1, d2, turn1, F, b1, b2;
  } typical_{};

  double far_end() const;  // S of the end for a pattern about to be built
  void number();
  /// Free segments between contacts in wall coordinates or not, as suits their state.
  void choose_coordinates();
  void change_coordinates(int j, const collocation::System* system);
  bool hardly_leaves(int j, const Sampler& sampler) const;
  bool in_phase(int segment, int part, int piece) const;
  void gather_local(std::vector<double>& w) const;
  void set_local(const double* w);
  int column_of_left(int segment, int part) const {
    return part == 0 ? column_of_S(segment) : first_column_[segment][part] - 1;
  }
  int column_of_right(int segment, int part) const {
    return part + 1 == segment_[segment].parts() ? column_of_S(segment + 1) : first_column_[segment][part + 1] - 1;
  }
  /// f(segment, part, its collocation problem, its ends) in order.
  template <class F>
  void each_part(const F& f) const {
    for (int j = 0; j < segments(); ++j)
      for (int q = 0; q < segment_[j].parts(); ++q)
        f(j, q, segment_[j].part(q), segment_[j].left(q, S_[j]), segment_[j].right(q, S_[j + 1]));
  }
  using CutFill = std::function<void(double S, double* u, double* s, const collocation::System& system, int law)>;
  /// Segment j of a varying rod on given mesh points; `length`: s at S, `fill`: inputs and s at S.
  CutSegment cut(int j, const std::vector<double>& points, const std::function<double(double)>& length,
                 const CutFill& fill) const;
  formulation::Material material_behind(int junction) const;
  /// Every part lies within the piece of the law it is for: no junction has passed a break.
  bool cuts_hold() const;
  /// Every collar and point load between the ends has its cut.
  bool marks_kept() const;
  void take_pattern(const Pattern& pattern);
  /// A junction that runs into a cut is put behind it; false: there is none, or the problem is not solved there.
  bool cross_cut(const Chain& before, const Closure& closure, const NewtonOptions& options, NewtonSummary& sum);
  int cut_rows(int segment, int cut, double* r, double* values) const;
  std::vector<int> closure_columns(const Closure& closure) const;
  void typical();
  void choose_phase();
  bool assemble(const Closure& closure);
  bool residual(const Closure& closure, std::vector<double>& rhs);
  void add_rows(int block, int rows, double* values);
  /// Correction of the scaled unknowns that the rounding of the residuals alone would ask for, on the last factors.
  double rounding_level() const;
  void apply(const std::vector<double>& x0, const std::vector<double>& w0, const std::vector<double>& dx,
             double damping);
  void local_changes(const std::vector<double>& dx, std::vector<double>& dw);
  bool admissible_geometry(const std::vector<double>& widths) const;
  // rows of residuals r and derivatives (row-major over the block's columns, zeroed by the caller); return their number
  int left_rows(double* r, double* values) const;
  int right_rows(double* r, double* values) const;
  int junction_rows(int j, double* r, double* values) const;
  int point_rows_near_wall(int j, double* r, double* values) const;
  int closure_row(const Closure& c, double* r, double* values) const;
  double error_ratio(int segment, int part, std::vector<double>& ratio, double tolerance) const;
};

}  // namespace tendril::segmentation

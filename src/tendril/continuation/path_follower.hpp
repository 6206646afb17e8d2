#pragma once
// Follows one state along the path parameter: predictor of second order, the chain Newton as corrector, local
// parametrisation (the unknown that changes fastest is held, so folds are seen), every step tested to have stayed on
// its branch, every change of the contact pattern located by solving the equations together with the event's condition,
// then the pattern changed and followed on. Where a stable branch ends, at a fold or where the load would have to go
// back after a change of pattern, the rod snaps to another stable state at that load. What is found depends neither on
// the values listed nor on the size of the steps.

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tendril/continuation/result.hpp"
#include "tendril/segmentation/contact_pattern_switcher.hpp"

namespace tendril::continuation {

struct FollowOptions {
  segmentation::SwitcherOptions switcher;
  double event_tolerance = 1e-10;  // |margin| at a located event
  double max_step = 0.25;          // largest scaled change of any unknown in one step
  int max_steps = 800;             // per stretch
  bool arclength = true;           // false: p itself is stepped (the problem is rebuilt for every p)
  double max_seconds = 0.0;        // since `begun`
  double begun = untold;           // on the steady clock [s]; untold: when the follower was made
  const std::atomic<bool>* stop = nullptr;
  /// Judges states: given, stable ones are followed only. Where the branch becomes unstable, one that branches off and
  /// is accepted is followed instead, or else what `snap` finds.
  std::function<bool(const segmentation::Chain&)> stable;
  /// A stable state at a parameter just beyond that of the given one, where its branch ends or has become unstable;
  /// `direction`: sign of dp onwards.
  std::function<std::optional<segmentation::Chain>(const segmentation::Chain&, int direction)> snap;
};

struct FollowSummary {
  bool reached = false;
  bool interrupted = false;
  std::string reason;  // why the stretch ended early
  std::string kind;    // "limit" (no stable state beyond) | "time" | "failure" | ""
  long newton_iterations = 0, factorisations = 0, patterns = 0;
};

/// The path's direction at a state.
struct Heading {
  std::vector<double> t;  // forward change of the complete iterate, largest scaled change 1; empty: not known
  double rate = 0.0;      // scaled change of the parameter in t, signed
  int hold = 0;           // the unknown that parametrises the path: p unless it changes ten times slower
  int sign = 0;           // of the determinant bordered by t, which only a branch point turns; 0: not known
  bool valid = false;
};

/// Whether a solved state lies on the branch through the state the step began at.
struct Arrival {
  double deviation = 0.0;  // from the predicted state, of the step
  double cosine = 1.0;     // between the headings at both ends
  bool sign_kept = true;   // of the bordered determinant
};
enum class Branching { same, crossed, elsewhere };
/// Same: near the predicted state, headings alike, sign kept. Crossed: the same but for the sign, and that well: a
/// branch point lies between. Elsewhere: another branch, or a step too long to tell.
Branching judge_arrival(const Arrival& arrival);

class PathFollower {
 public:
  /// `chain` is a converged admissible state. `rebuild` (may be empty) gives the mechanics at p when not smooth.
  PathFollower(segmentation::Chain chain, FollowOptions options,
               std::function<std::shared_ptr<segmentation::Mechanics>(double)> rebuild = {});

  FollowSummary to(double target);
  /// A state on the other branch through the branch point `at`, which may be interpolated: moved off along the kernel
  /// by `amplitude` of the unknown that changes most in it (scaled; either sign), the parameter free.
  std::optional<segmentation::Chain> branch_off(const segmentation::Chain& at, double amplitude);
  const segmentation::Chain& chain() const { return chain_; }
  segmentation::Chain& chain() { return chain_; }
  std::vector<Event> events;  // parameter, S etc. scaled as in the chain (the study converts)
  std::vector<TracePoint> trace;

 private:
  struct Step {
    segmentation::Chain next;
    std::vector<double> x1, x2;  // complete iterates at its ends
    Heading heading;             // at x2
    segmentation::Closure closure;
    double length = 0.0;  // scaled, of the unknown that changes most
    bool landing = false, crossed = false;
  };
  /// A contact pattern changed at an event.
  struct Change {
    bool done = false;
    int onward = 0;  // sign of dp along the new branch; 0: as before
    segmentation::Chain event;
  };

  segmentation::Chain chain_;
  FollowOptions options_;
  std::function<std::shared_ptr<segmentation::Mechanics>(double)> rebuild_;
  Heading heading_;                  // at chain_, if valid
  std::vector<double> previous_;     // complete iterate one step back on the same structure, empty if none
  double step_ = 0.02;               // scaled length of the next step
  int direction_ = 0;                // sign of dp along the path
  int folds_ = 0, events_here_ = 0;  // along the stretch; events at one parameter
  double last_event_p_ = untold;
  int last_count_ = -1;        // unstable directions of a state on the axis of an axisymmetric problem; -1: elsewhere
  double p_unit_ = 1.0;        // what counts as a change of the parameter of its own size
  double doubt_ = 0.0;         // of the last interpolated state, of the distance interpolated over
  bool interpolated_ = false;  // the event located last, between solved states: its own equations are singular
  double clock_start_ = 0.0;
  FollowSummary total_;

  // ---- path_step.cpp ----
  bool correct(segmentation::Chain& c, const segmentation::Closure& closure, bool adaptive, bool keep_factors = false);
  /// Heading at the solved state c, reached holding `hold`; forward: a difference of iterates that it must not oppose,
  /// or empty: the parameter goes by direction_.
  bool find_heading(segmentation::Chain& c, int hold, const std::vector<double>& forward, Heading& out);
  /// A step towards the target that stays on the branch; none, with the reason in total_: false.
  /// (`step_` is then the shorter length to go on with).
  bool take_step(double target, Step& step);
  /// The state at the target between the ends of a step that has passed it.
  bool land_between(double target, Step& step);
  /// Forget what belongs to the mesh and pattern left.
  void start_anew(double step);

  // ---- path_follower.cpp ----
  enum class Next { go_on, elsewhere, finished };
  enum class Vanishing { none, changed, landed, finished };
  /// A short stretch may be about to vanish: that is the next event, or the target lies before it.
  Vanishing at_vanishing(double target, FollowSummary& out);
  /// The end of the step violates `bad`: the first event within it is located and the pattern changed.
  Next at_violation(double target, Step& step, std::vector<segmentation::Margin> bad, FollowSummary& out);
  Next after_event(const segmentation::Chain& before, const Change& change, double target, FollowSummary& out);
  /// The branch through the stable state `before` goes no farther than `at`: to another stable state, or the end. Goes
  /// on along the branch where stable states are not asked for.
  Next at_limit(const segmentation::Chain& before, const segmentation::Chain& at, const std::string& what,
                double target, FollowSummary& out);
  Next at_fold(const Step& step, const segmentation::Chain& fold, double target, FollowSummary& out);
  /// Where the branch that goes on through chain_, near the fold of the one left, crosses that.
  std::optional<segmentation::Chain> crossing_near(const segmentation::Chain& fold);
  /// The branch is left for a stable one, if it has become unstable and there is one.
  bool at_branch_point(const segmentation::Chain& at, const Step& step, double target);
  /// chain_ is a state on another branch, reached from one at p_left: begin there.
  void settle(double target, double p_left);
  FollowSummary arrive(double target);
  FollowSummary ended(const std::string& reason, const std::string& kind);
  void record(const std::string& kind, double S, const segmentation::Chain& c);
  void note(const segmentation::NewtonSummary& s);

  // ---- path_events.cpp ----
  /// Between a (admissible) and b (violates m): the state where m's margin is zero.
  bool locate(const std::vector<double>& a, const std::vector<double>& b, segmentation::Chain& at,
              segmentation::Margin& m, const segmentation::Closure& closure);
  /// The same state on a mesh refined for it, so that an event does not carry the error of the mesh it was met on.
  void sharpen(segmentation::Chain& at, segmentation::Margin& m);
  /// The same where the equations are singular at the event itself: interpolated from solved places on both sides.
  bool locate_beside(const std::vector<double>& a, const std::vector<double>& b, double guess, segmentation::Chain& at,
                     segmentation::Margin& m, const segmentation::Closure& closure);

  // ---- path_limits.cpp ----
  /// The state between two iterates where the equations at fixed parameter are singular.
  /// None: the equations are regular in between.
  std::optional<segmentation::Chain> locate_branch_point(const std::vector<double>& from, const std::vector<double>& to,
                                                         const segmentation::Chain& on);
  /// The state between the iterates a and b where the parameter turns back.
  segmentation::Chain locate_fold(const std::vector<double>& a, const std::vector<double>& b,
                                  const segmentation::Chain& on);

  // ---- path_patterns.cpp ----
  /// `together`: conditions of one kind that vanish in state `at`, by descending index; `sharp`: the same state on a
  /// finer mesh, for the record.
  Change change_pattern(segmentation::Chain& at, const segmentation::Chain& sharp,
                        const std::vector<segmentation::Margin>& together);
  /// Change of the parameter that changes the fastest unknown by its own size: depends on the state alone. t: tangent
  /// of the chain at fixed parameter, empty where there is none.
  double natural_size(const segmentation::Chain& at, std::vector<double>& t);
  /// Sign of dp along which the value grows from the state `at`.
  int rising(const segmentation::Chain& at, const std::function<double(const segmentation::Chain&)>& value);
  /// The segments of `together` have vanished: two contacts are one, or a line is a point.
  Change collapse(const segmentation::Chain& at, const std::vector<segmentation::Margin>& together);
  /// Segments much shorter than their neighbours, the shortest first.
  std::vector<segmentation::Margin> short_spans() const;
  /// To the target by changing the length of a short segment with the load free.
  bool land_along_span(double target);
  /// `collapse` for the shortest segment (and its twins) when no further step converges, unless that lies beyond the
  /// target.
  Change collapse_shortest(double target, bool& beyond);

  // ---- path_singular.cpp ----
  /// `correct` where a line contact carries nothing (flat_lines.hpp): its ends are held at places beside the root,
  /// where the equations are regular, and the state is interpolated to the root of the condition given up.
  bool correct_beside(segmentation::Chain& c, const segmentation::Closure& closure, bool adaptive);
};

}  // namespace tendril::continuation

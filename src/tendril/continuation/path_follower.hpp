#pragma once
// Follows one state along the path parameter: secant or tangent predictor, the chain Newton as corrector, local
// parametrisation (the unknown that changes fastest is held, so folds are passed), every change of the contact pattern
// located by solving the equations together with the event's condition, then the pattern changed and followed on.

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
  double max_seconds = 0.0;
  const std::atomic<bool>* stop = nullptr;
  /// Judges states at a branch point: where the branch followed has become unstable, one that branches off and is
  /// accepted is followed instead.
  std::function<bool(const segmentation::Chain&)> stable;
  /// Called with the state just beyond a branch point, where it has become unstable: a stable state to go on from.
  std::function<std::optional<segmentation::Chain>(const segmentation::Chain&)> leave_branch;
};

struct FollowSummary {
  bool reached = false;
  bool interrupted = false;
  std::string reason;  // why the stretch ended early
  std::string kind;    // "validity" | "failure" | ""
  long newton_iterations = 0, factorisations = 0, patterns = 0;
};

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
  segmentation::Chain chain_;
  FollowOptions options_;
  std::function<std::shared_ptr<segmentation::Mechanics>(double)> rebuild_;
  std::vector<double> previous_;  // complete iterate one step back on the same structure, empty if none
  double step_ = 0.02;            // scaled step of the held unknown
  int direction_ = 0;             // sign of dp along the path
  int last_sign_ = 0;             // of the determinant at fixed p
  int last_count_ = -1;  // unstable directions of a state on the axis of an axisymmetric problem; -1: elsewhere
  double p_unit_ = 1.0;  // what counts as a change of the parameter of its own size
  double doubt_ = 0.0;   // of the last interpolated state, of the distance interpolated over
  double clock_start_ = 0.0;
  FollowSummary total_;

  bool correct(segmentation::Chain& c, const segmentation::Closure& closure, bool adaptive);
  /// The same where a line contact carries nothing (flat_lines.hpp): its ends are held at places beside the root, where
  /// the equations are regular, and the state is interpolated to the root of the condition given up.
  bool correct_beside(segmentation::Chain& c, const segmentation::Closure& closure, bool adaptive);
  void record(const std::string& kind, double S, const segmentation::Chain& c);
  /// Between a (admissible) and b (violates m): the state where m's margin is zero.
  bool locate(const std::vector<double>& a, const std::vector<double>& b, segmentation::Chain& at,
              segmentation::Margin& m, const segmentation::Closure& closure);
  /// The same where the equations are singular at the event itself: interpolated from solved places on both sides.
  bool locate_beside(const std::vector<double>& a, const std::vector<double>& b, double guess, segmentation::Chain& at,
                     segmentation::Margin& m, const segmentation::Closure& closure);
  /// The state between two iterates where the equations at fixed parameter are singular.
  /// None: the equations are regular in between.
  std::optional<segmentation::Chain> locate_branch_point(const std::vector<double>& from, const std::vector<double>& to,
                                                         const segmentation::Chain& on);
  /// The state between the iterates a and b where the parameter turns back.
  segmentation::Chain locate_fold(const std::vector<double>& a, const std::vector<double>& b,
                                  const segmentation::Chain& on);
  /// `together`: conditions of one kind that vanish in state `at`, by descending index.
  bool change_pattern(segmentation::Chain& at, const std::vector<segmentation::Margin>& together);
  /// The segments of `together` have vanished: two contacts are one, or a line is a point.
  bool collapse(const segmentation::Chain& at, const std::vector<segmentation::Margin>& together);
  /// The same for the shortest segment (and its twins) when no further step converges.
  bool collapse_shortest();
  void note(const segmentation::NewtonSummary& s);
};

}  // namespace tendril::continuation

#pragma once
// A rod in motion, quasi-statically: fed in or withdrawn at the inlet, or its far end moved along the tube, and the
// inlet turned. Every step starts from the last state and its trend; the contact pattern is switched where it must,
// events are told with the motion at which they happened (interpolated within the step). Where no state follows on from
// the last one, or where it has become unstable, the rod jumps: to the state found downhill in energy from there.

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tendril/continuation/session_trend.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/segmentation/contact_pattern_switcher.hpp"

namespace tendril::continuation {

/// What `advance` moves: the length of rod between the ends, or the place of the far end.
enum class Feed { length, position };

class Session {
 public:
  /// Solves the problem as it stands. A free tip whose place is given is fed by length all the same.
  Session(const segmentation::Problem& problem, const StudyOptions& options);

  bool ready() const { return reason_.empty(); }
  const std::string& reason() const { return reason_; }  // why there is no state

  struct Motion {
    bool reached = false;
    std::string reason;  // why not; the last state reached stays
    int substeps = 0;
    bool jumped = false;
    long newton_iterations = 0, factorisations = 0;
  };
  /// Feed more rod, or move the far end, by `distance` [length]; negative: withdraw.
  Motion advance(double distance);
  /// Turn the inlet by `angle` [rad]: the directors at the start.
  Motion rotate(double angle);
  /// Asked between the parts of a motion and before every pattern of contacts tried: true ends the motion, with the
  /// last state reached. Null: nothing does.
  void set_stop(const std::atomic<bool>* stop);
  /// What ends a motion early: that flag, and the time limit of the options from the session's start on.
  const numerics::Stop& stop() const { return switcher_.newton.stop; }

  Feed feed() const { return feed_; }
  double fed() const { return value_[0]; }       // length or place, in all [length]
  double rotation() const { return value_[1]; }  // φ at the start [rad]

  /// The present state, certified and judged; fields with `points` rows.
  Step state(int points = 0) const;
  TracePoint trace() const;
  const std::vector<Event>& events() const { return events_; }
  const segmentation::Chain& chain() const { return chain_; }

  struct Snapshot {
    std::vector<double> state;
    double value[2] = {0.0, 0.0};
    std::string how;
    std::size_t events = 0;
  };
  Snapshot snapshot() const;
  /// Back to a snapshot of this session; its events go with it.
  bool restore(const Snapshot& snapshot);

 private:
  Session() = default;
  segmentation::Problem problem_;
  StudyOptions options_;
  segmentation::SwitcherOptions switcher_;
  Feed feed_ = Feed::length;
  double value_[2] = {0.0, 0.0};  // fed, rotation
  int moving_ = 0;                // which of the two the chain's parameter is
  segmentation::Chain chain_;
  Trend trend_;
  std::string how_, reason_;
  bool moved_ = false;
  std::vector<Event> events_;

  std::shared_ptr<segmentation::Mechanics> mechanics(int moving) const;
  Motion move(int which, double distance);
  enum class Outcome { done, too_far, failed, axis_ends };
  Outcome step(double target, Motion& motion);
  /// To a stable state at `target`, sought downhill in energy; `unit` is the length of the motion asked for.
  bool jump(double target, double unit, Motion& motion);
  std::optional<segmentation::Chain> downhill(double value, bool from_here, Motion& motion) const;
  bool walk(segmentation::Chain& chain, double from, double to, Motion& motion) const;
  void note(const std::string& kind, double value, double S);
  void note_changes(const segmentation::Chain& before, const segmentation::Chain& after,
                    const std::vector<segmentation::Margin>& violated, double from, double to);
  void accept(segmentation::Chain next, double value);
  segmentation::Chain expected(double target, Motion& motion);
};

}  // namespace tendril::continuation

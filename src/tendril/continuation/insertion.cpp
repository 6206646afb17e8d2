#include "tendril/continuation/insertion.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace tendril::continuation {

namespace {

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

Result insert(const segmentation::Problem& problem, const Insertion& insertion, const StudyOptions& options) {
  const double begun = seconds();
  Result result;
  auto close = [&](Status status, const std::string& message) {
    result.status = status;
    result.message = message;
    return result;
  };
  if (options.progress) options.progress(0.0, "finding the contact pattern");
  Session session(problem, options);
  if (!session.ready()) {
    Step s;
    s.message = session.reason();
    result.steps.push_back(s);
    return close(Status::not_converged, session.reason());
  }
  std::vector<double> values = insertion.values;
  if (values.empty()) {
    const double way = insertion.to - session.fed();
    const int steps =
        insertion.step > 0.0 ? std::max(1, static_cast<int>(std::ceil(std::abs(way) / insertion.step - 1e-9))) : 100;
    for (int i = 1; i <= steps; ++i)
      values.push_back(i == steps ? insertion.to
                                  : session.fed() + (insertion.step > 0.0 ? std::copysign(i * insertion.step, way)
                                                                          : way * i / steps));
  }
  double whole = 0.0, at = session.fed();
  for (double v : values) {
    whole += std::abs(v - at);
    at = v;
  }
  const double longest = insertion.step > 0.0 ? insertion.step : std::max(whole / 100.0, 1e-300);
  result.trace.push_back(session.trace());
  double gone = 0.0, step_begun = begun;
  Status worst = Status::converged;
  std::string message;
  for (double value : values) {
    Effort effort;
    Session::Motion motion;
    motion.reached = true;
    const double from = session.fed();
    const int parts = std::max(1, static_cast<int>(std::ceil(std::abs(value - from) / longest - 1e-9)));
    for (int i = 1; i <= parts && motion.reached; ++i) {
      const double next = i == parts ? value : from + (value - from) * i / parts, distance = next - session.fed();
      if (distance == 0.0) continue;
      motion = session.advance(distance);
      effort.newton_iterations += motion.newton_iterations;
      effort.factorisations += motion.factorisations;
      if (motion.reached && insertion.rotation != 0.0 && whole > 0.0) {
        motion = session.rotate(insertion.rotation * std::abs(distance) / whole);
        effort.newton_iterations += motion.newton_iterations;
        effort.factorisations += motion.factorisations;
      }
      gone += std::abs(distance);
      result.trace.push_back(session.trace());
      if (options.progress && whole > 0.0) options.progress(gone / whole, "feeding the rod");
      if (session.stop().asked()) {
        motion.reached = motion.reached && i == parts && &value == &values.back();
        if (!motion.reached) motion.reason = session.stop().reason();
        result.interrupted = !motion.reached;
      }
    }
    Step s = session.state(options.fields ? options.field_points : 0);
    s.parameter = session.fed();
    if (!motion.reached) {
      s.status = Status::not_converged;
      s.message = "the motion ends: " + motion.reason + "; last good state given";
    }
    effort.wall_seconds = seconds() - step_begun;
    step_begun = seconds();
    s.effort = effort;
    if (s.status != Status::converged && worst == Status::converged) {
      worst = s.status;
      message = s.message;
    }
    result.steps.push_back(std::move(s));
    if (!motion.reached) break;
  }
  result.events = session.events();
  if (options.progress) options.progress(1.0, "done");
  return close(worst, message);
}

}  // namespace tendril::continuation

#pragma once
// When an iteration is to give up: a flag that somebody else sets (Ctrl-C), or a time that has passed. A value, passed
// down in the options of whatever may take long; the flag must outlive it.

#include <atomic>
#include <chrono>
#include <cstdio>
#include <string>

namespace tendril::numerics {

struct Stop {
  using Clock = std::chrono::steady_clock;
  const std::atomic<bool>* flag = nullptr;
  double seconds = 0.0;  // since `begun`; 0: no limit
  Clock::time_point begun{};

  bool interrupted() const { return flag != nullptr && flag->load(std::memory_order_relaxed); }
  bool late() const { return seconds > 0.0 && std::chrono::duration<double>(Clock::now() - begun).count() > seconds; }
  bool asked() const { return interrupted() || late(); }
  std::string reason() const {
    if (interrupted()) return "interrupted";
    char text[64];
    std::snprintf(text, sizeof text, "the time limit of %.6g s was reached", seconds);
    return text;
  }
};

}  // namespace tendril::numerics

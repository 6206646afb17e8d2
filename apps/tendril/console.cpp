#include "console.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include "tendril/io/diagnostics.hpp"

namespace tendril::app {
namespace {

// A signal handler reaches nothing but statics; a second Ctrl-C ends the program at once.
std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void on_interrupt(int) {
  if (stop.exchange(true)) ::_exit(kInterrupted);
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
}

const std::atomic<bool>& interrupted() { return stop; }

bool is_terminal(std::FILE* stream) { return ::isatty(::fileno(stream)) != 0; }

bool use_colour(std::FILE* stream) {
  const char* no_colour = std::getenv("NO_COLOR");
  const char* term = std::getenv("TERM");
  return is_terminal(stream) && !(no_colour && *no_colour) && !(term && std::strcmp(term, "dumb") == 0);
}

void print(std::string_view text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!written) throw io::FileError("standard output: cannot write: " + std::string(std::strerror(errno)));
}

void message(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stderr); }

Progress::Progress(bool wanted) : shown_(wanted && is_terminal(stderr)) {
  const char* term = std::getenv("TERM");
  if (term && std::strcmp(term, "dumb") == 0) shown_ = false;
}

Progress::~Progress() {
  if (drawn_) message("\r\033[K");
}

void Progress::update(double fraction, const std::string& what) {
  if (!shown_) return;
  const double now = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  if (now - last_ < 0.1) return;
  last_ = now;
  drawn_ = true;
  constexpr int kWidth = 30;
  const double part = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
  const int filled = static_cast<int>(part * kWidth);
  char percent[16];
  std::snprintf(percent, sizeof percent, "%3d %%", static_cast<int>(100 * part));
  message("\r\033[K[" + std::string(static_cast<std::size_t>(filled), '#') +
          std::string(static_cast<std::size_t>(kWidth - filled), '.') + "] " + percent + "  " + what.substr(0, 60));
}

}  // namespace tendril::app

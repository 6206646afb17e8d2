#pragma once
// Output conventions of the program: results on stdout, messages and progress on stderr, colour and animation only on
// a terminal, NO_COLOR and TERM=dumb obeyed.

#include <atomic>
#include <cstdio>
#include <string>
#include <string_view>

namespace tendril::app {

enum ExitCode {
  kSolved = 0,
  kInternal = 1,
  kUsage = 2,
  kInvalid = 3,
  kNotConverged = 4,
  kFile = 6,
  kInterrupted = 130
};

bool is_terminal(std::FILE* stream);
bool use_colour(std::FILE* stream);

/// To stdout; a failed write (full disk) throws io::FileError.
void print(std::string_view text);
/// To stderr.
void message(std::string_view text);

/// From now on Ctrl-C asks to stop; a second one ends the program at once.
void catch_interrupts();
const std::atomic<bool>& interrupted();

/// A bar on stderr while it is a terminal, nothing otherwise; redrawn at most ten times a second.
class Progress {
 public:
  explicit Progress(bool wanted);
  ~Progress();
  void update(double fraction, const std::string& what);

 private:
  bool shown_;
  bool drawn_ = false;
  double last_ = -1.0;
};

}  // namespace tendril::app

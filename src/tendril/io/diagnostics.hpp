#pragma once
// What is wrong with an input, all of it at once: every problem of a file is collected as an Issue with its place,
// value, bound and a hint, and thrown in one InputError. FileError is for files that cannot be read or written.

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tendril/io/document.hpp"

namespace tendril::io {

struct Issue {
  std::string file;  // "case.toml", "survey.csv", "--set"
  int line = 0;      // 1-based; 0: the file as a whole
  int column = 0;
  std::string key;  // key path, "end.axial_force"
  std::string message;
  std::string value;        // what was found
  std::string bound;        // what is allowed
  std::string hint;         // "did you mean `axial_force`?"
  std::string excerpt;      // the offending line
  int length = 1;           // characters under the caret
  bool unreadable = false;  // a file named by the input that cannot be read
};

class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Issue> issues);
  const std::vector<Issue>& issues() const { return issues_; }

 private:
  std::vector<Issue> issues_;
};

class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Collects issues; `finish` throws them if there are any.
class Issues {
 public:
  Issue& add(const Place& place, std::string key, std::string message);
  bool empty() const { return list_.empty(); }
  std::size_t size() const { return list_.size(); }
  bool has(std::string_view key) const;  // an issue at this key or below it
  std::vector<Issue>& list() { return list_; }
  void finish();

 private:
  std::vector<Issue> list_;
};

/// `file:line:col: error: ...`, the line, a caret, the hint; one block per issue.
std::string render(const Issue& issue, bool colour = false);
std::string render(const std::vector<Issue>& issues, bool colour = false);

/// The candidate nearest to `word` (transpositions count one), empty when none is near enough.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// The shortest decimal that reads back as the same double.
std::string shortest(double value);

}  // namespace tendril::io

#pragma once
// A result file read back as the data it was written from, to be written in another format. The case is known as far as
// the file tells it: units, title, numbers, path; its tube only as sampled sections (files written with fields).

#include <string>
#include <vector>

#include "tendril/continuation/result.hpp"
#include "tendril/io/case.hpp"
#include "tendril/io/result_files.hpp"

namespace tendril::io {

struct StoredResult {
  Case c;  // without tube and centreline
  continuation::Result result;
  std::vector<TubeSection> tube;  // empty without fields
  std::string version;            // of the program that wrote it
  std::string case_text;          // the `case` object as JSON
};

/// Throws FileError, InputError.
StoredResult read_stored_result(const std::string& path);

}  // namespace tendril::io

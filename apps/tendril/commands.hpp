#pragma once
// The commands that work on a case file.

#include <optional>
#include <string>
#include <vector>

namespace tendril::app {

struct RunOptions {
  std::string case_file;
  std::vector<std::string> overrides;  // key=value
  std::string json;                    // file, or "-" for stdout
  std::string out;                     // directory
  std::string from;                    // result file
  std::string report;                  // page
  bool fields = false;
  bool quiet = false;
  double max_seconds = 0.0;  // 0: no limit
};

int run(const RunOptions& options);
int check(const RunOptions& options);
int report(const std::string& result_file, const std::string& page_file);
int schema();
int explain(const std::string& key);

}  // namespace tendril::app

#include "commands.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "console.hpp"
#include "quality.hpp"
#include "tables.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/io/atomic_file.hpp"
#include "tendril/io/case.hpp"
#include "tendril/io/result_files.hpp"
#include "tendril/io/result_json.hpp"
#include "tendril/report/page.hpp"

namespace tendril::app {
namespace {

void notes(const io::Case& c, bool quiet) {
  if (quiet) return;
  for (const std::string& note : c.notes) message("note: " + note + "\n");
}

constexpr const char* kNoPage =
    "tendril: this program was built without the report page\n"
    "       build it where Node 18 or later and npm are installed, or take the report.html of another build of\n"
    "       this version (share/tendril/report.html) and configure with -DTENDRIL_REPORT_HTML=report.html\n";

}  // namespace

int run(const RunOptions& options) {
  const io::Case c = io::read_case(options.case_file, options.overrides);
  notes(c, options.quiet);
  std::vector<double> initial;
  if (!options.from.empty()) initial = io::read_state(options.from);
  if (!options.out.empty()) io::make_directory(options.out);  // fail before the work, not after it
  if (!options.report.empty() && !report::available()) {
    message(kNoPage);
    return kUsage;
  }

  catch_interrupts();
  continuation::Result result;
  {
    Progress bar(!options.quiet);
    continuation::StudyOptions study;
    study.solve = io::solve_options(c);
    study.solve.max_seconds = options.max_seconds;
    study.fields = options.fields || !options.out.empty() || !options.report.empty();
    study.initial = initial.empty() ? nullptr : &initial;
    study.stop = &interrupted();
    study.progress = [&](double fraction, const std::string& what) { bar.update(fraction, what); };
    result = io::run(c, study);
  }
  const bool stopped = result.interrupted || interrupted();

  const bool to_stdout = options.json == "-";
  if (to_stdout) {
    print(io::result_json(c, result, options.fields));
  } else if (!options.json.empty()) {
    io::write_file(options.json, io::result_json(c, result, options.fields));
  }
  if (!options.out.empty()) io::write_results(c, result, options.out);
  if (!options.report.empty()) io::write_file(options.report, report::page(io::result_json(c, result, true)));
  if (!to_stdout) print(describe(c, result));
  if (!options.quiet) {
    if (!options.json.empty() && !to_stdout) message("wrote " + options.json + "\n");
    if (!options.out.empty()) message("wrote " + options.out + "/\n");
    if (!options.report.empty()) message("wrote " + options.report + "\n");
  }
  if (stopped) {
    message("interrupted: what was reached until then is kept\n");
    return kInterrupted;
  }
  if (result.status == continuation::Status::converged) return kSolved;
  message(std::string("tendril: ") + std::string(io::status_name(result.status)) +
          (result.message.empty() ? "" : ": " + result.message) + "\n");
  return kNotConverged;
}

int check(const RunOptions& options) {
  if (is_geometry(options.case_file)) {
    QualityOptions file;
    file.files = {options.case_file};
    file.quiet = options.quiet;
    return quality(file);
  }
  const io::Case c = io::read_case(options.case_file, options.overrides);
  notes(c, options.quiet);
  print(describe(c));
  return kSolved;
}

int report(const std::string& result_file, const std::string& page_file) {
  if (!report::available()) {
    message(kNoPage);
    return kUsage;
  }
  const std::string text = io::read_result(result_file);
  std::string page;
  try {
    page = report::page(text);
  } catch (const std::invalid_argument& error) {
    message("tendril: " + result_file + ": " + error.what() + "\n");
    return kInvalid;
  }
  if (page_file == "-") {
    print(page);
  } else {
    io::write_file(page_file, page);
    message(fmt::format("wrote {} ({:.1f} MB)\n", page_file, static_cast<double>(page.size()) / 1e6));
  }
  return kSolved;
}

int schema() {
  print(io::json_schema());
  return kSolved;
}

int explain(const std::string& key) {
  const std::string text = io::explain(key);
  if (!text.empty()) {
    print(text);
    return kSolved;
  }
  const std::string hint = io::suggest_key(key);
  message("tendril: the case file has no key `" + key + "`" + (hint.empty() ? "" : "; " + hint) + "\n");
  return kUsage;
}

}  // namespace tendril::app

// tendril: solve, check and explain cases of slender rods in and around tubes.

#include <CLI/CLI.hpp>
#include <cstring>
#include <new>

#include "branches.hpp"
#include "commands.hpp"
#include "console.hpp"
#include "convert.hpp"
#include "init.hpp"
#include "quality.hpp"
#include "reproduce.hpp"
#include "shell.hpp"
#include "tendril/geometry/error.hpp"
#include "tendril/io/diagnostics.hpp"
#include "tendril/version.hpp"
#include "verify.hpp"

namespace {

using namespace tendril;
using namespace tendril::app;

constexpr const char* kExamples = R"(examples:
  tendril init well                                         a case to start from
  tendril check well.toml                                   is the case file right?
  tendril quality vessel.vtp survey.las                     is a centreline or survey file good?
  tendril run well.toml                                     solve, print contacts and events
  tendril run well.toml --json well.json --out results      and keep everything (CSV, ParaView)
  tendril run well.toml --report well.html                  and a page to look at or mail
  tendril run well.toml --set end.axial_force="-12 klbf"    change a key of the case
  tendril run well.toml --from well.json                    start from a stored state
  tendril branches well.toml                                all states found for one load, stable or not
  tendril explain tube.axis                                 what a key means
  tendril reproduce all -o gallery                          the systems of the thesis, computed and drawn
  tendril schema > case.schema.json                         for editors

exit codes: 0 solved, 1 internal error, 2 usage, 3 invalid input, 4 not converged or outside validity,
            6 file error, 130 interrupted
)";

std::vector<std::string> subcommand_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands({})) names.push_back(sub->get_name());
  return names;
}

int unknown_command(const CLI::App& app, const std::string& word) {
  const std::string near = io::nearest(word, subcommand_names(app));
  message("tendril: unknown command `" + word + "`" + (near.empty() ? "" : "; did you mean `" + near + "`?") +
          "\n       `tendril --help` lists the commands\n");
  return kUsage;
}

// The option nearest to a mistyped one, among those of the command that was given.
std::string option_hint(const CLI::App& app, int argc, char** argv) {
  const CLI::App* command = &app;
  for (const CLI::App* sub : app.get_subcommands({})) {
    if (argc > 1 && sub->get_name() == argv[1]) command = sub;
  }
  std::vector<std::string> names;
  for (const CLI::Option* option : command->get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  for (int i = 1; i < argc; ++i) {
    const std::string word = std::string(argv[i]).substr(0, std::strcspn(argv[i], "="));
    if (word.size() < 3 || word.compare(0, 2, "--") != 0 || std::find(names.begin(), names.end(), word) != names.end())
      continue;
    const std::string near = io::nearest(word, names);
    if (!near.empty()) return "; did you mean `" + near + "`?";
  }
  return "";
}

int guarded(const std::function<int()>& command) {
  try {
    return command();
  } catch (const io::InputError& error) {
    bool all_files = !error.issues().empty();
    for (const io::Issue& issue : error.issues()) all_files = all_files && issue.unreadable;
    message(io::render(error.issues(), use_colour(stderr)));
    const std::size_t count = error.issues().size();
    message(std::to_string(count) + (count == 1 ? " error\n" : " errors\n"));
    return all_files ? kFile : kInvalid;
  } catch (const io::FileError& error) {
    message("tendril: " + std::string(error.what()) + "\n");
    return kFile;
  } catch (const geometry::GeometryError& error) {
    message("tendril: " + std::string(error.what()) + "\n");
    return kInvalid;
  } catch (const std::bad_alloc&) {
    message("tendril: out of memory\n");
    return kInternal;
  } catch (const std::exception& error) {
    message("tendril: internal error: " + std::string(error.what()) + "\n");
    return kInternal;
  }
}

void case_options(CLI::App* sub, RunOptions& options) {
  sub->add_option("CASE", options.case_file, "case file: TOML, or JSON if it ends in .json")->required();
  sub->add_option("--set", options.overrides,
                  "change a key: key=value, value as in TOML; `key=` removes it. Repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  sub->add_flag("--quiet,-q", options.quiet, "no progress, no notes");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Slender elastic rods held inside or around tubes.", "tendril"};
  app.footer(kExamples);
  app.set_version_flag("--version,-V", std::string("tendril ") + tendril::version());
  app.require_subcommand(1);

  RunOptions options;
  CLI::App* run_command = app.add_subcommand("run", "solve a case: one state, or a path with its events");
  case_options(run_command, options);
  run_command->add_option("--json", options.json, "write the result as JSON (- for standard output)")
      ->type_name("FILE");
  run_command->add_option("--out", options.out, "write result.json, contacts.csv, fields.csv and ParaView files")
      ->type_name("DIR");
  run_command->add_flag("--fields", options.fields, "put the fields along the rod into the JSON");
  run_command->add_option("--from", options.from, "start from the state stored in a result")->type_name("RESULT.json");
  run_command->add_option("--report", options.report, "write a self-contained page of the result")
      ->type_name("PAGE.html");
  run_command->add_option("--max-seconds", options.max_seconds, "stop after this time and keep what was reached")
      ->check(CLI::PositiveNumber)
      ->type_name("SECONDS");

  RunOptions branches_options;
  CLI::App* branches_command =
      app.add_subcommand("branches", "all states found for one load: stability, length, energy, contacts");
  case_options(branches_command, branches_options);
  branches_command->add_option("--json", branches_options.json, "write the states as JSON (- for standard output)")
      ->type_name("FILE");
  branches_command->add_flag("--fields", branches_options.fields, "put the fields along the rods into the JSON");
  branches_command->add_option("--max-seconds", branches_options.max_seconds, "stop searching after this time")
      ->check(CLI::PositiveNumber)
      ->type_name("SECONDS");

  RunOptions check_options;
  CLI::App* check_command =
      app.add_subcommand("check", "validate a case, or a centreline or survey file, without solving");
  case_options(check_command, check_options);

  QualityOptions quality_options;
  CLI::App* quality_command = app.add_subcommand(
      "quality", "centreline and survey files: length, radius, bends, what had to be cleaned, is a tube to be had");
  quality_command->add_option("FILE", quality_options.files, "CSV, VTP, PTH, MRK.JSON, LAS or WITSML")->required();
  quality_command
      ->add_option("--smoothing", quality_options.smoothing,
                   "tolerance in the file's unit, 0 or auto; none: only where the exact curve would fold the tube")
      ->type_name("TOLERANCE");
  quality_command->add_option("--branch", quality_options.branch, "line of a file with several; or lines that join")
      ->type_name("LINE");
  quality_command->add_option("--ends", quality_options.ends, "way through a tree: from one end to another")
      ->expected(2)
      ->type_name("END");
  quality_command->add_option("--radius-array", quality_options.radius_array, "name of the radius")->type_name("NAME");
  quality_command->add_flag("--quiet,-q", quality_options.quiet, "only the tables");

  CLI::App* verify_command =
      app.add_subcommand("verify", "closed forms and printed numbers: computed, expected, difference");
  CLI::App* schema_command = app.add_subcommand("schema", "JSON Schema (draft-07) of the case file");
  std::string key;
  CLI::App* explain_command =
      app.add_subcommand("explain", "what a key of the case file means; a table lists its keys");
  explain_command->add_option("KEY", key, "key path, e.g. end.axial_force; none: all tables");

  ReproduceOptions reproduce_options;
  CLI::App* reproduce_command =
      app.add_subcommand("reproduce", "the systems of the thesis: tables, data, pictures; no NAME lists them");
  reproduce_command->add_option("NAME", reproduce_options.name, "name of a system, or all");
  reproduce_command->add_option("-o,--output", reproduce_options.out, "write CSV data, SVG pictures and a page")
      ->type_name("DIR");
  reproduce_command->add_flag("--quiet,-q", reproduce_options.quiet, "no progress, no notes");

  std::string result_file, page_file;
  CLI::App* report_command =
      app.add_subcommand("report", "one self-contained HTML page of a result, to look at or mail");
  report_command->add_option("RESULT", result_file, "result file; one written with --fields has the picture")
      ->required();
  report_command->add_option("-o,--output", page_file, "the page (- for standard output)")
      ->type_name("PAGE.html")
      ->required();

  std::string stored, format, converted;
  CLI::App* convert_command = app.add_subcommand("convert", "a result file as HDF5, CSV or ParaView files");
  convert_command->add_option("RESULT", stored, "result file")->required();
  convert_command->add_option("--to", format, "h5, csv or vtp; not needed where the name of the output tells")
      ->type_name("FORMAT");
  convert_command->add_option("-o,--output", converted, "file (h5) or directory (csv, vtp)")
      ->type_name("OUT")
      ->required();

  std::string starter, starter_directory;
  bool force = false;
  CLI::App* init_command =
      app.add_subcommand("init", "a commented case to start from: vessel, well, helix or straight");
  init_command->add_option("NAME", starter, "vessel, well, helix or straight")->required();
  init_command->add_option("-o,--output", starter_directory, "where to write it")->type_name("DIR");
  init_command->add_flag("--force", force, "replace files that are there");

  std::string shell;
  CLI::App* completion_command = app.add_subcommand("completion", "completion script for bash, zsh or fish");
  completion_command->add_option("SHELL", shell, "bash, zsh or fish")->required();
  CLI::App* man_command = app.add_subcommand("man", "the manual page, for man(1)");

  if (argc > 1 && argv[1][0] != '-') {
    const std::vector<std::string> names = subcommand_names(app);
    if (std::find(names.begin(), names.end(), argv[1]) == names.end()) return unknown_command(app, argv[1]);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0)
      return guarded([&] {  // --help, --version
        std::ostringstream out;
        app.exit(error, out, out);
        print(out.str());
        return kSolved;
      });
    message("tendril: " + std::string(error.what()) + option_hint(app, argc, argv) +
            "\n       `tendril --help` shows the usage\n");
    return kUsage;
  }

  return guarded([&]() -> int {
    if (run_command->parsed()) return run(options);
    if (branches_command->parsed()) return branches(branches_options);
    if (check_command->parsed()) return check(check_options);
    if (quality_command->parsed()) return quality(quality_options);
    if (verify_command->parsed()) return verify();
    if (schema_command->parsed()) return schema();
    if (explain_command->parsed()) return explain(key);
    if (report_command->parsed()) return report(result_file, page_file);
    if (convert_command->parsed()) return convert(stored, format, converted);
    if (init_command->parsed()) return init(starter, starter_directory, force);
    if (completion_command->parsed()) return complete(app, shell);
    if (man_command->parsed()) {
      print(man_page(app, tendril::version()));
      return kSolved;
    }
    return reproduce(reproduce_options);
  });
}

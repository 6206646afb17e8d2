// Case: reading, reading again with other values, solving.

#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <chrono>
#include <filesystem>
#include <future>
#include <optional>
#include <thread>

#include "bindings.hpp"
#include "tendril/continuation/study.hpp"

namespace tendril::python {
namespace {

constexpr std::size_t kMaxCaseBytes = std::size_t{64} << 20;

CasePtr parse(const std::string& text, const std::string& name, io::Format format,
              const std::vector<std::string>& overrides, const std::string& directory) {
  return std::make_shared<CaseText>(
      CaseText{io::parse_case(text, name, format, overrides, directory), text, directory, format, overrides});
}

CasePtr read(const std::string& file, const std::vector<std::string>& overrides) {
  const std::filesystem::path path(file);
  const io::Format format = path.extension() == ".json" ? io::Format::json : io::Format::toml;
  return parse(io::read_text_file(file, kMaxCaseBytes), file, format, overrides, path.parent_path().string());
}

}  // namespace

CasePtr replaced(const CaseText& original, const std::vector<std::string>& overrides) {
  std::vector<std::string> all = original.overrides;
  all.insert(all.end(), overrides.begin(), overrides.end());
  return parse(original.text, original.c.name, original.format, all, original.directory);
}

SolvedPtr solve(const CasePtr& of, int points, const std::vector<double>& initial, double max_seconds,
                const std::atomic<bool>& stop) {
  const io::Case& c = of->c;
  continuation::StudyOptions study;
  study.solve = io::solve_options(c);
  study.solve.max_seconds = max_seconds;
  study.fields = points > 0;
  if (points > 0) study.field_points = points;
  study.initial = initial.empty() ? nullptr : &initial;
  study.stop = &stop;
  auto solved = std::make_shared<Solved>();
  solved->of = of;
  solved->result = io::run(c, study);
  return solved;
}

void beside_interpreter(const std::function<void(const std::atomic<bool>& stop)>& work) {
  constexpr auto kLookForSignals = std::chrono::milliseconds(50);
  std::atomic<bool> stop{false};
  std::exception_ptr failure;
  std::optional<nb::python_error> signal;
  {
    const nb::gil_scoped_release release;
    std::promise<void> done;
    const std::future<void> over = done.get_future();
    std::thread thread([&] {
      try {
        work(stop);
      } catch (...) {
        failure = std::current_exception();
      }
      done.set_value();
    });
    while (over.wait_for(kLookForSignals) != std::future_status::ready) {
      if (signal) continue;
      const nb::gil_scoped_acquire acquire;
      if (PyErr_CheckSignals() != 0) {
        signal.emplace();
        stop = true;
      }
    }
    thread.join();
  }
  if (signal) throw nb::python_error(std::move(*signal));
  if (failure) std::rethrow_exception(failure);
}

void bind_case(nb::module_& m) {
  nb::class_<CaseText>(m, "Case")
      .def_static("read", &read, nb::arg("file"), nb::arg("overrides"), nb::call_guard<nb::gil_scoped_release>())
      .def_static(
          "parse",
          [](const std::string& text, const std::string& name, const std::vector<std::string>& overrides,
             const std::string& directory) { return parse(text, name, io::Format::toml, overrides, directory); },
          nb::arg("text"), nb::arg("name"), nb::arg("overrides"), nb::arg("directory"),
          nb::call_guard<nb::gil_scoped_release>())
      .def("replaced", &replaced, nb::arg("overrides"), nb::call_guard<nb::gil_scoped_release>())
      .def(
          "solve",
          [](const CasePtr& of, int points, const std::vector<double>& initial, double max_seconds) {
            SolvedPtr solved;
            beside_interpreter(
                [&](const std::atomic<bool>& stop) { solved = solve(of, points, initial, max_seconds, stop); });
            return solved;
          },
          nb::arg("points"), nb::arg("initial"), nb::arg("max_seconds"))
      .def_prop_ro("name", [](const CaseText& self) { return self.c.name; })
      .def_prop_ro("title", [](const CaseText& self) { return self.c.title; })
      .def_prop_ro("si", [](const CaseText& self) { return self.c.si; })
      .def_prop_ro("notes", [](const CaseText& self) { return self.c.notes; })
      .def_prop_ro("text", [](const CaseText& self) { return self.text; })
      .def_prop_ro("overrides", [](const CaseText& self) { return self.overrides; })
      .def_prop_ro("axis_kind", [](const CaseText& self) { return self.c.word("tube.axis.kind"); })
      .def_prop_ro("length", [](const CaseText& self) { return self.c.tube.length(); })
      .def_prop_ro("parameter",
                   [](const CaseText& self) -> std::optional<std::string> {
                     return self.c.path ? std::optional(self.c.path->parameter) : std::nullopt;
                   })
      .def_prop_ro("inserts", [](const CaseText& self) { return self.c.path && self.c.path->motion; });
  m.def("explain", &io::explain, nb::arg("key"));
  m.def("json_schema", &io::json_schema);
}

}  // namespace tendril::python

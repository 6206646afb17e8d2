#pragma once
// Shared by the parts of the module tendril._core: what a case and a result are on this side, and how a solve runs
// beside the interpreter. The binding moves data and releases the interpreter; it calculates nothing.

#include <nanobind/nanobind.h>

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tendril/continuation/result.hpp"
#include "tendril/io/case.hpp"

namespace tendril::python {

namespace nb = nanobind;

/// A case with the text it came from, so that it can be read again with other values.
struct CaseText {
  io::Case c;
  std::string text, directory;
  io::Format format = io::Format::toml;
  std::vector<std::string> overrides;  // key=value, as with --set
};
using CasePtr = std::shared_ptr<const CaseText>;

/// A result and the case it belongs to.
struct Solved {
  CasePtr of;
  continuation::Result result;
};
using SolvedPtr = std::shared_ptr<const Solved>;

/// The same text read again with more overrides. Throws InputError.
CasePtr replaced(const CaseText& original, const std::vector<std::string>& overrides);

/// What every face does with a case: one state, or its path.
SolvedPtr solve(const CasePtr& of, int points, const std::vector<double>& initial, double max_seconds,
                const std::atomic<bool>& stop);

/// Run `work` on a thread of its own with the interpreter released; Ctrl-C sets `stop` and is raised once it is over.
void beside_interpreter(const std::function<void(const std::atomic<bool>& stop)>& work);

/// A step with fields as one SVG document.
std::string picture(const Solved& solved, std::size_t index);

void bind_errors(nb::module_& m);
void bind_case(nb::module_& m);
void bind_result(nb::module_& m);
void bind_many(nb::module_& m);
void bind_session(nb::module_& m);

}  // namespace tendril::python

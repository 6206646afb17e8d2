// Many solves side by side: threads take the next index until none is left. Each solve is independent of the others, so
// the results are the same bits for any number of threads.

#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <mutex>
#include <thread>

#include "bindings.hpp"
#include "tendril/io/diagnostics.hpp"

namespace tendril::python {
namespace {

/// Calls work(i) for i < count. The failure with the smallest index is thrown; a stop leaves the rest undone.
void for_each_index(std::size_t count, int threads, const std::atomic<bool>& stop,
                    const std::function<void(std::size_t)>& work) {
  if (threads <= 0) threads = std::max(1u, std::thread::hardware_concurrency());
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  std::size_t failed = count;
  {
    std::vector<std::jthread> pool;
    for (std::size_t t = 0; t < std::min<std::size_t>(threads, count); ++t) {
      pool.emplace_back([&] {
        for (std::size_t i; !stop && (i = next++) < count;) {
          try {
            work(i);
          } catch (...) {
            const std::lock_guard lock(mutex);
            if (i < failed) failed = i, failure = std::current_exception();
          }
        }
      });
    }
  }
  if (failure) std::rethrow_exception(failure);
}

std::vector<SolvedPtr> solve_all(const std::vector<CasePtr>& cases, int threads, int points) {
  std::vector<SolvedPtr> results(cases.size());
  beside_interpreter([&](const std::atomic<bool>& stop) {
    for_each_index(cases.size(), threads, stop,
                   [&](std::size_t i) { results[i] = solve(cases[i], points, {}, 0.0, stop); });
  });
  return results;
}

/// The case with each list of overrides; what is wrong with any of them is thrown together, named by its sample.
std::vector<CasePtr> replace_all(const CasePtr& original, const std::vector<std::vector<std::string>>& overrides,
                                 int threads) {
  constexpr std::size_t kMostSamplesTold = 20;
  std::vector<CasePtr> cases(overrides.size());
  std::vector<std::vector<io::Issue>> issues(overrides.size());
  beside_interpreter([&](const std::atomic<bool>& stop) {
    for_each_index(overrides.size(), threads, stop, [&](std::size_t i) {
      try {
        cases[i] = replaced(*original, overrides[i]);
      } catch (const io::InputError& error) {
        issues[i] = error.issues();
      }
    });
  });
  std::vector<io::Issue> all;
  std::size_t told = 0;
  for (std::size_t i = 0; i < issues.size() && told < kMostSamplesTold; ++i) {
    for (io::Issue& issue : issues[i]) {
      issue.file = "sample " + std::to_string(i) + ", " + issue.file;
      all.push_back(std::move(issue));
    }
    told += issues[i].empty() ? 0 : 1;
  }
  if (!all.empty()) throw io::InputError(std::move(all));
  return cases;
}

}  // namespace

void bind_many(nb::module_& m) {
  m.def("solve_all", &solve_all, nb::arg("cases"), nb::arg("threads"), nb::arg("points"));
  m.def("replace_all", &replace_all, nb::arg("case"), nb::arg("overrides"), nb::arg("threads"));
}

}  // namespace tendril::python

// Insertions as a program: `insertions [TUBES [FIRST_SEED [STEPS]]] [--verbose]`. A rod is fed into every tube, the
// last state compared with one found from nothing. Exit code 1 when a step is lost or a last state is wrong.

#include "support/insertions.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>

using tendril::test::InsertionOutcome;
using End = InsertionOutcome::End;

namespace {

const char* word(End e) {
  switch (e) {
    case End::equal:
      return "equal";
    case End::other_branch:
      return "other branch";
    case End::differ:
      return "differ";
    case End::lost:
      return "lost";
    case End::no_start:
      return "no start";
    case End::no_cold:
      return "no cold start";
  }
  return "";
}

void print(const InsertionOutcome& o) {
  std::printf("%-13s %3d steps, %d lost, %d jumps, %zu events, %d contacts, slowest %.0f ms  %s\n", word(o.end),
              o.steps, o.lost, o.jumps, o.events, o.contacts, o.worst(), o.words.c_str());
  if (!o.reason.empty()) std::printf("              %s\n", o.reason.c_str());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<long> numbers;
  bool verbose = false;
  for (int i = 1; i < argc; ++i) {
    if (!std::strcmp(argv[i], "--verbose"))
      verbose = true;
    else
      numbers.push_back(std::atol(argv[i]));
  }
  const long tubes = numbers.size() > 0 ? numbers[0] : 100, first = numbers.size() > 1 ? numbers[1] : 1;
  const int steps = numbers.size() > 2 ? static_cast<int>(numbers[2]) : 200;
  std::vector<InsertionOutcome> all;
  std::map<End, int> count;
  std::vector<double> ms;
  long done = 0, lost = 0, jumps = 0, events = 0;
  for (long seed = first; seed < first + tubes; ++seed) {
    auto o = tendril::test::run_insertion(seed, steps);
    if (verbose || o.end == End::differ || o.end == End::lost || o.end == End::no_start || o.end == End::no_cold)
      print(o);
    ++count[o.end];
    done += o.steps;
    lost += o.end == End::no_start ? steps : o.lost;
    jumps += o.jumps;
    events += static_cast<long>(o.events);
    ms.insert(ms.end(), o.ms.begin(), o.ms.end());
    all.push_back(std::move(o));
  }
  std::sort(ms.begin(), ms.end());
  const auto percentile = [&](double q) {
    return ms.empty() ? 0.0 : ms[std::min<std::size_t>(static_cast<std::size_t>(q * ms.size()), ms.size() - 1)];
  };
  std::printf("\n%ld tubes, seeds from %ld: %ld steps, %ld lost, %ld jumps, %ld events\n", tubes, first, done, lost,
              jumps, events);
  std::printf("ms a step: median %.1f, 90 %% %.1f, 99 %% %.1f, largest %.1f\n", percentile(0.5), percentile(0.9),
              percentile(0.99), percentile(1.0));
  std::printf("the last state and a cold start's:");
  for (const End e : {End::equal, End::other_branch, End::differ, End::lost, End::no_start, End::no_cold})
    std::printf(" %s %d%s", word(e), count[e], e == End::no_cold ? "\n" : ",");
  std::stable_sort(all.begin(), all.end(), [](const InsertionOutcome& a, const InsertionOutcome& b) {
    const auto rank = [](const InsertionOutcome& o) {
      return o.end == End::equal ? 0 : o.end == End::other_branch ? 1 : 2;
    };
    return rank(a) != rank(b) ? rank(a) > rank(b) : a.worst() > b.worst();
  });
  std::printf("the worst ten:\n");
  for (std::size_t i = 0; i < std::min<std::size_t>(10, all.size()); ++i) print(all[i]);
  const bool good = lost == 0 && count[End::equal] + count[End::other_branch] == tubes;
  std::printf("%s\n", good ? "no step is lost, every last state is a cold start's or another certified one"
                           : "the insertions are not met");
  return good ? 0 : 1;
}

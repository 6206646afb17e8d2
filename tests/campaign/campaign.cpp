// The campaign as a program: `campaign [PROBLEMS [FIRST_SEED [THREADS]]] [--only SEED] [--held] [--verbose]`. Draws
// problems until PROBLEMS were not dropped, prints what became of them, the times and the worst ten. Exit code 1 when
// fewer than 99.5 % are certified and stable or one is wrong.

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <thread>

#include "support/campaign_judge.hpp"

using tendril::test::CampaignOutcome;
using Kind = CampaignOutcome::Kind;

namespace {

const char* word(Kind k) {
  switch (k) {
    case Kind::solved:
      return "solved";
    case Kind::unstable:
      return "unstable";
    case Kind::refused:
      return "refused";
    case Kind::dropped:
      return "dropped";
    case Kind::failed:
      return "failed";
    case Kind::wrong:
      return "wrong";
  }
  return "";
}

void print(const CampaignOutcome& o) {
  std::printf("%-8s %6.2f s  %2d contacts  %s\n", word(o.kind), o.seconds, o.contacts, o.words.c_str());
  if (!o.reason.empty()) std::printf("         %s\n", o.reason.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<long> numbers;
  bool verbose = false;
  auto rules = tendril::test::CampaignRules::all;
  long only = -1;
  for (int i = 1; i < argc; ++i) {
    if (!std::strcmp(argv[i], "--verbose"))
      verbose = true;
    else if (!std::strcmp(argv[i], "--held"))  // uniform rods held at both ends only
      rules = tendril::test::CampaignRules::held;
    else if (!std::strcmp(argv[i], "--only") && i + 1 < argc)
      only = std::atol(argv[++i]);
    else
      numbers.push_back(std::atol(argv[i]));
  }
  if (only >= 0) {
    const auto o = tendril::test::run_campaign_problem(only, rules);
    print(o);
    std::printf("         branch: %s\n", o.branch.c_str());
    const auto& j = o.judgement;
    std::printf(
        "         equations %.1e, ends %.1e, junctions %.1e, balance %.1e, gap %.2e, reaction %.2e, d3·D3 %.3f, "
        "stretch %.3f\n",
        j.equations, j.ends, j.junctions, j.balance, j.gap, j.reaction, j.inclination, j.stretch);
    return o.kind == Kind::solved ? 0 : 1;
  }
  const long wanted = numbers.size() > 0 ? numbers[0] : 1000, first = numbers.size() > 1 ? numbers[1] : 1;
  const long threads = numbers.size() > 2 ? numbers[2] : std::max(1u, std::thread::hardware_concurrency());
  std::map<long, CampaignOutcome> done;
  std::mutex mutex;
  long next = first, counted = 0;
  // Seeds in order until enough of them count, whatever thread is faster: what lies beyond is thrown away.
  const auto work = [&] {
    for (;;) {
      long seed;
      {
        const std::lock_guard lock(mutex);
        if (counted >= wanted) return;
        seed = next++;
      }
      CampaignOutcome o = tendril::test::run_campaign_problem(seed, rules);
      const std::lock_guard lock(mutex);
      counted += o.kind != Kind::dropped;
      if (verbose || (o.kind != Kind::solved && o.kind != Kind::dropped)) print(o);
      std::fflush(stdout);
      done.emplace(seed, std::move(o));
    }
  };
  std::vector<std::thread> pool;
  for (long i = 0; i < threads; ++i) pool.emplace_back(work);
  for (auto& t : pool) t.join();
  std::map<Kind, int> count;
  std::map<std::string, int> causes;
  std::vector<CampaignOutcome> kept;
  long problems = 0;
  for (auto& [seed, o] : done) {
    if (problems >= wanted) break;
    problems += o.kind != Kind::dropped;
    ++count[o.kind];
    if (o.kind == Kind::dropped) ++causes[o.cause];
    if (o.kind != Kind::dropped) kept.push_back(o);
  }
  std::vector<double> seconds;
  for (const auto& o : kept) seconds.push_back(o.seconds);
  std::sort(seconds.begin(), seconds.end());
  const auto percentile = [&](double q) {
    return seconds[std::min<std::size_t>(static_cast<std::size_t>(q * seconds.size()), seconds.size() - 1)];
  };
  std::printf("\n%ld problems, seeds from %ld\n", problems, first);
  for (const Kind k : {Kind::solved, Kind::unstable, Kind::refused, Kind::failed, Kind::wrong, Kind::dropped})
    std::printf("%-9s %5d\n", word(k), count[k]);
  for (const auto& [cause, times] : causes) std::printf("  %5d by %s\n", times, cause.c_str());
  if (seconds.empty()) return 1;
  std::printf("seconds: median %.3f, 90 %% %.3f, 99 %% %.3f, largest %.3f\n", percentile(0.5), percentile(0.9),
              percentile(0.99), seconds.back());
  std::stable_sort(kept.begin(), kept.end(), [](const CampaignOutcome& a, const CampaignOutcome& b) {
    const auto rank = [](const CampaignOutcome& o) {
      return o.kind == Kind::wrong      ? 4
             : o.kind == Kind::failed   ? 3
             : o.kind == Kind::unstable ? 2
                                        : o.kind == Kind::refused;
    };
    return rank(a) != rank(b) ? rank(a) > rank(b) : a.seconds > b.seconds;
  });
  std::printf("the worst ten:\n");
  for (std::size_t i = 0; i < std::min<std::size_t>(10, kept.size()); ++i) print(kept[i]);
  const bool good = count[Kind::solved] >= 0.995 * problems && count[Kind::wrong] == 0;
  std::printf("%s\n", good ? "at least 99.5 % are certified and stable, none is wrong" : "the campaign is not met");
  return good ? 0 : 1;
}

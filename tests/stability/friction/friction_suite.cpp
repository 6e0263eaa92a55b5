// The long form of the friction trains: friction_suite [COUNT [FIRST]] tries COUNT (2000) trains from seed FIRST (1) on
// and prints what became of them (docs/friction.md), then the same trains with break-away ratios in loops of contacts, too,
// which are judged by themselves.
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "tests/stability/friction/friction_train.hpp"

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 2000, first = argc > 2 ? std::atoi(argv[2]) : 1;
  int agree = 0, failed = 0;
  long changes = 0, events = 0, most = 0;
  double energy = 0.0, worst = 0.0;
  for (int seed = first; seed < first + count; ++seed) {
    const auto verdict = drev::test::judge(drev::test::random_friction_train(static_cast<unsigned>(seed)));
    agree += verdict.agrees();
    failed += !verdict.failure.empty();
    changes += verdict.changes;
    events += verdict.events;
    most = std::max(most, verdict.changes);
    energy = std::max(energy, std::abs(verdict.energy_error));
    if (verdict.agrees()) {
      worst = std::max(worst, verdict.difference);
      continue;
    }
    std::printf("seed %d: difference %.2g, sensitivity %.2g, changes %ld, events %ld %s\n", seed,
                verdict.difference, verdict.sensitivity, verdict.changes, verdict.events,
                verdict.failure.c_str());
    std::fflush(stdout);
  }
  std::printf(
      "%d of %d trains agree, %d failed; largest difference of those that agree %.2g, largest energy error "
      "%.2g, %ld changes (%ld by the other code), at most %ld in one train\n",
      agree, count, failed, worst, energy, changes, events, most);
  int sound = 0;
  most = 0;
  for (int seed = first; seed < first + count; ++seed) {
    const auto verdict =
        drev::test::judge_alone(drev::test::random_friction_train(static_cast<unsigned>(seed), true));
    sound += verdict.failure.empty();
    most = std::max(most, verdict.changes);
    if (!verdict.failure.empty())
      std::printf("seed %d with break-away in loops: %s\n", seed, verdict.failure.c_str());
  }
  std::printf(
      "with break-away ratios in loops: %d of %d run and close their balance, at most %ld changes in one "
      "train\n",
      sound, count, most);
  return agree == count && sound == count ? 0 : 1;
}

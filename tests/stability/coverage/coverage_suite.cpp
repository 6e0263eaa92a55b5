// The coverage suite as a program: random models, every kind of figure, each against the reference.
//   coverage_suite [--models N] [--first SEED] [--missed] [--family TEXT]
// --missed lists what does not hold; --family takes only models whose family holds the text.
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <string>

#include "tests/stability/coverage/cover.hpp"
#include "tests/stability/coverage/random_spec.hpp"

int main(int argc, char** argv) {
  using namespace coverage;
  unsigned models = 300, first = 1;
  bool missed = false;
  std::string family;
  for (int i = 1; i < argc; ++i) {
    if (!std::strcmp(argv[i], "--models") && i + 1 < argc)
      models = static_cast<unsigned>(std::atoi(argv[++i]));
    else if (!std::strcmp(argv[i], "--first") && i + 1 < argc)
      first = static_cast<unsigned>(std::atoi(argv[++i]));
    else if (!std::strcmp(argv[i], "--family") && i + 1 < argc)
      family = argv[++i];
    else if (!std::strcmp(argv[i], "--missed"))
      missed = true;
  }
  Table table;
  for (unsigned seed = first; seed < first + models; ++seed) {
    const auto begin = std::chrono::steady_clock::now();
    const auto seconds = [&] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    const Spec spec = random_spec(seed);
    if (spec.family.find(family) == std::string::npos) continue;
    const Case c = make_case(spec);
    const double reference = seconds();
    if (c.usable) cover_runs(c, table);
    std::cerr << c.spec.name << " " << c.spec.family << " nodes " << c.spec.nodes.size() << " steps "
              << c.fine.steps << " edges " << c.fine.edges.size() << " growth " << c.growth << " "
              << c.problem << " " << reference << " s, drev " << seconds() - reference << " s\n";
  }
  table.print(std::cout, missed);
}

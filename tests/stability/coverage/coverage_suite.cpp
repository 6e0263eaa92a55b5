// The coverage suite as a program: random models, every kind of figure, each against the reference.
//   coverage_suite [--models N] [--first SEED] [--missed] [--channels] [--family TEXT] [--part NAME]
// --missed lists what does not hold; --channels gives each kind of channel a row; --family takes only models whose family holds the text; --part: only
// runs, accuracy, contacts, modes, periodic or statistics.
#include <drev/core/error.hpp>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <string>

#include "tests/stability/coverage/cover.hpp"
#include "tests/stability/coverage/random_spec.hpp"
#include "tests/stability/coverage/to_drev.hpp"

namespace {

constexpr int kRuns = 4;  // of each chaotic model

/// True where drev refuses the model (nothing that moves is left, say); the table says why.
bool refused(const coverage::Spec& spec, coverage::Table& table) {
  try {
    to_drev(spec);
    return false;
  } catch (const drev::ModelError& refusal) {
    table.add_note("drev refuses " + spec.name + ": " + refusal.what());
    return true;
  }
}

}  // namespace

int main(int argc, char** argv) {
  using namespace coverage;
  unsigned models = 300, first = 1;
  bool missed = false, channels = false;
  std::string family, part;
  for (int i = 1; i < argc; ++i) {
    if (!std::strcmp(argv[i], "--models") && i + 1 < argc)
      models = static_cast<unsigned>(std::atoi(argv[++i]));
    else if (!std::strcmp(argv[i], "--first") && i + 1 < argc)
      first = static_cast<unsigned>(std::atoi(argv[++i]));
    else if (!std::strcmp(argv[i], "--family") && i + 1 < argc)
      family = argv[++i];
    else if (!std::strcmp(argv[i], "--part") && i + 1 < argc)
      part = argv[++i];
    else if (!std::strcmp(argv[i], "--missed"))
      missed = true;
    else if (!std::strcmp(argv[i], "--channels"))
      channels = true;
  }
  Table table;
  const auto all = [&] { return part.empty(); };
  for (unsigned seed = first; seed < first + models; ++seed) {
    const Spec spec = random_spec(seed);
    if (spec.family.find(family) == std::string::npos) continue;
    if (refused(spec, table)) continue;
    const auto begin = std::chrono::steady_clock::now();
    if (all() || part == "modes") cover_modes(spec, table);
    if (all() || part == "runs" || part == "accuracy" || part == "contacts") {
      const Case c = make_case(spec);
      if (!c.usable) table.add_note("the reference fails: " + c.spec.name + ": " + c.problem);
      if (c.usable && (all() || part == "runs")) cover_runs(c, table);
      if (c.usable && (all() || part == "contacts")) cover_contacts(c, table);
      if (c.usable && (all() || part == "accuracy")) {
        cover_accuracy(c, {.accuracy = seed / 10 % 2 ? 1e-10 : 1e-6, .which = seed / 10}, table);
        if (seed / 10 % 3 == 0)
          cover_accuracy(
              c, {.accuracy = 1e-3, .method = "dormand_prince", .which = seed / 10 + 1, .pairs = 1}, table);
      }
      std::cerr << c.spec.name << " (" << c.spec.family << "): " << c.spec.nodes.size() << " nodes, "
                << c.fine.edges.size() << " contact changes, growth " << c.growth;
    }
    if ((all() || part == "periodic") && seed % 3 == 0) {
      constexpr int harmonics[] = {8, 32, 128, 0};
      const Spec periodic = random_periodic_spec(seed);
      if (!refused(periodic, table)) cover_periodic(periodic, harmonics[seed / 3 % 4], table);
    }
    if ((all() || part == "statistics") && seed % 10 == 0) cover_statistics(seed, kRuns, table);
    std::cerr << " [" << seed << ", "
              << std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() << " s]\n";
  }
  table.print(std::cout, missed, channels);
}

// Exact propagation beside the integrators of SUNDIALS at an error no larger. One thread, medians of
// 3 runs by turns. Right-hand side and Jacobian are hand-written for the model (peers/chain.hpp).
//   build/release/bin/bench_sundials                    the explicit ones, which are the best (minutes)
//   build/release/bin/bench_sundials "SUNDIALS held"    one table
//   build/release/bin/bench_sundials "[all]"            all of them, one run each (half an hour)
//   build/release/bin/bench_sundials "[smooth]"         smooth pulses in place of tables
#include "tests/benchmark/peer_harness.hpp"
#include "tests/benchmark/peers/sundials.hpp"

using namespace drev;
using namespace drev::benchmark;
using peers::Integrator;

namespace {

struct Choice {
  Integrator integrator;
  bool roots;
};

void measure(const std::string& drive, bool smooth, const std::vector<Choice>& choices, int runs) {
  const Problem p = make_problem(drive, smooth);
  if (const auto why = why_not_exact(p.system)) {
    std::printf("\n%s: left out, %s\n", p.name.c_str(), why->c_str());
    return;
  }
  check_reference(p);
  Drev drev(p);
  print_header(p);
  std::vector<Row> rows;
  for (const double rtol : {1e-6, 1e-8, 1e-10})
    for (const auto& [integrator, roots] : choices) {
      const auto run = [&, i = integrator, r = roots](double t_end, int samples) {
        return run_sundials(p.chain, {i, rtol, t_end, r, samples});
      };
      rows.push_back(
          compare(p, drev, std::string(name(integrator)) + (roots ? ", roots" : ""), rtol, runs, run));
    }
  print_best(rows);
}

const std::vector<Choice> kHeld{{Integrator::erk5, false}, {Integrator::erk8, false}};
const std::vector<Choice> kGears{
    {Integrator::erk5, false}, {Integrator::erk5, true}, {Integrator::erk8, true}};

/// Every integrator, with and without roots where there are contacts.
std::vector<Choice> all(bool contacts) {
  std::vector<Choice> choices;
  for (const bool roots : {false, true})
    for (int i = 0; i <= static_cast<int>(Integrator::ida); ++i)
      if (contacts || !roots) choices.push_back({static_cast<Integrator>(i), roots});
  return choices;
}

}  // namespace

TEST_CASE("SUNDIALS held") { measure("held", false, kHeld, 3); }
TEST_CASE("SUNDIALS gears") { measure("gears", false, kGears, 3); }
TEST_CASE("SUNDIALS smooth pulses held", "[.][smooth]") { measure("held", true, kHeld, 3); }
TEST_CASE("SUNDIALS smooth pulses gears", "[.][smooth]") { measure("gears", true, kGears, 3); }
TEST_CASE("SUNDIALS all held", "[.][all]") { measure("held", false, all(false), 1); }
TEST_CASE("SUNDIALS all gears", "[.][all]") { measure("gears", false, all(true), 1); }

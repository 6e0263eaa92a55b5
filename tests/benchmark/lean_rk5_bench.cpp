// Exact propagation beside Dormand and Prince's RK5(4), hand-written for this one model with contact
// changes located (peers/lean_rk5.cpp), at an error no larger. One thread, medians of 3 runs by turns.
//   build/release/bin/bench_lean_rk5                    tables, gear drive and held
//   build/release/bin/bench_lean_rk5 "[smooth]"         smooth pulses
//   build/release/bin/bench_lean_rk5 "[reference]"      the reference against extended precision
#include "tests/benchmark/peer_harness.hpp"

using namespace drev;
using namespace drev::benchmark;

namespace {

void measure(const std::string& drive, bool smooth) {
  const Problem p = make_problem(drive, smooth);
  if (const auto why = why_not_exact(p.system)) {
    std::printf("\n%s: left out, %s\n", p.name.c_str(), why->c_str());
    return;
  }
  Drev drev(p);
  print_header(p);
  std::vector<Row> rows;
  for (const double rtol : {1e-6, 1e-8, 1e-10}) {
    const auto row = [&](const char* what, bool changes, bool knots) {
      rows.push_back(compare(p, drev, what, rtol, 3, [&](double t_end, int samples) {
        return run_lean_rk5(p.chain, {rtol, t_end, changes, knots, samples});
      }));
    };
    if (drive == "gears") row("RK5, nothing located", false, false);
    row(drive == "gears" ? "RK5, contact changes located" : "RK5", drive == "gears", false);
    if (!smooth) row("RK5, knots located too", drive == "gears", true);
  }
  print_best(rows);
}

}  // namespace

TEST_CASE("Lean RK5 held") { measure("held", false); }
TEST_CASE("Lean RK5 gears") { measure("gears", false); }
TEST_CASE("Lean RK5 smooth pulses held", "[.][smooth]") { measure("held", true); }
TEST_CASE("Lean RK5 smooth pulses gears", "[.][smooth]") { measure("gears", true); }
TEST_CASE("Reference against extended precision", "[.][reference]") {
  for (const bool smooth : {false, true})
    for (const char* drive : {"held", "gears"}) {
      const Problem p = make_problem(drive, smooth);
      if (why_not_exact(p.system)) continue;
      std::printf("%s: ", p.name.c_str());
      check_reference(p);
    }
}

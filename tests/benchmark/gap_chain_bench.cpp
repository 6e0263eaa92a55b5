// Masses on springs with a gap each, by average acceleration, 1 ms: microseconds a step, beside what
// FEDEM R8.1.6 took for such chains. FEDEM's figures are from another machine of this kind (61 us a step
// for 2 masses, 1.1 ms for 100, 11.3 ms for 1,000, least output): the ratios are no measurement side by side.
//   build/release/bin/bench_gap_chain
#include <drev/core/system.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "tests/catch.hpp"

using namespace drev;

namespace {

/// Processor time of this thread alone: at a program's start BLAS keeps a thread of its own turning.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// ground -(k, gap)- m -(k, gap)- m ..., the last mass pulled for 2 s and let go, as in
/// models/two_mass_backlash.
System gap_chain(int masses) {
  Model m("gap chain");
  NodeId last{-1};
  for (int i = 0; i < masses; ++i) {
    const std::string n = std::to_string(i);
    const NodeId node = m.add_node("mass_" + n, NodeKind::translational);
    m.add<Inertia>("m_" + n, {node}, {.inertia = 10.0});
    const PolylineSpring::Params spring = PolylineSpring::dead_band(2000.0, 0.05 / masses);
    if (i == 0)
      m.add<PolylineSpring>("spring_" + n, {node}, spring);
    else
      m.add<PolylineSpring>("spring_" + n, {last, node}, spring);
    last = node;
  }
  m.add<AppliedTorque>("force", {last}, {.table = TimeTable({0.0, 1.0, 2.0, 2.0}, {0.0, 100.0, 100.0, 0.0})});
  return m.build();
}

}  // namespace

TEST_CASE("Chains with a gap at every mass beside FEDEM's figures") {
  struct Case {
    int masses;
    double fedem_us, duration;
    int repeats;  // a processor takes some 50 ms to come to speed
  };
  for (const Case& c : {Case{2, 61.0, 10.0, 201}, Case{100, 1100.0, 10.0, 9}, Case{1000, 11300.0, 4.0, 5}}) {
    const System system = gap_chain(c.masses);
    std::vector<double> us;
    RunSummary run;
    for (int repeat = 0; repeat < c.repeats; ++repeat) {
      const double start = thread_seconds();
      run = simulate(system, {.step = 1e-3, .t_end = c.duration, .energy_tolerance = 10.0});
      us.push_back(1e6 * (thread_seconds() - start) / static_cast<double>(run.steps));
      INFO(run.reason);
      CHECK(run.ok());
    }
    // The least: there is nothing beside it that other programs would slow down alike.
    const double least = *std::min_element(us.begin(), us.end());
    std::printf("gap_chain %d %.4g us a step, %.0f times FEDEM's %g us; %.2f iterations a step\n", c.masses,
                least, c.fedem_us / least, c.fedem_us,
                static_cast<double>(run.iterations) / static_cast<double>(run.steps));
  }
}

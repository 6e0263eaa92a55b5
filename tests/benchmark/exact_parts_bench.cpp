// What the parts of exact propagation cost, beside bare loops of the same arithmetic (peers/floor.cpp,
// compiled for the machine at hand). Differences of whole runs of the camshaft, 5 s, fastest of 3:
//   degrees  held, no loads: its time over the products with the matrices
//   knots    loads from tables less none, over the knots passed
//   pulses   smooth loads less none, over the calls of evaluate()
//   changes  undamped and without loads, gear drive with backlash less without, over contact changes
//   build/release/bin/bench_exact_parts
#include "tests/benchmark/peer_harness.hpp"
#include "tests/benchmark/peers/floor.hpp"

using namespace drev;
using namespace drev::benchmark;

namespace {

/// The camshaft without loads, its end struck.
Model unloaded(const char* drive, const char* damping, const char* backlash_mm) {
  Parameters s("camshaft", camshaft_entry().parameters);
  s.set("drive", drive);
  s.set("damping", damping);
  s.set("backlash_mm", backlash_mm);
  const Model from = camshaft_entry().build(s).model;
  Model m("camshaft without loads");
  for (const std::string& node : from.node_names()) m.add_node(node);
  for (const ElementInstance& p : from.element_instances())
    if (!p.name.starts_with("cam_")) m.add(p.name, p.nodes, p.element);
  for (const Model::Prescription& p : from.prescriptions()) m.constant_speed(p.node, *p.omega);
  m.set_initial("end", 0.0, 20.0);
  return m;
}

struct Measured {
  double seconds = 1e9;
  RunSummary summary;
};

Measured run(const System& system, double tolerance) {
  Measured m;
  for (int i = 0; i < 3; ++i) {
    const std::clock_t start = std::clock();
    m.summary = propagate(system, {.tolerance = tolerance, .t_end = 5.0, .energy_tolerance = 1.0});
    m.seconds = std::min(m.seconds, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  CHECK(m.summary.ok());
  return m;
}

void print(const char* part, const Measured& m, double count, double extra, double floor) {
  const auto steps = static_cast<double>(m.summary.steps);
  std::printf("| %s | %.4f | %.0f | %.3f | %.0f | %.1f | %.1f |\n", part, m.seconds, steps,
              1e6 * m.seconds / steps, count, 1e9 * extra / count, 1e9 * floor);
}

}  // namespace

TEST_CASE("Parts of exact propagation") {
  const Problem held = make_problem("held", false), pulses = make_problem("held", true);
  const System gears = unloaded("gears", "undamped", "0.15").build();
  const System closed = unloaded("gears", "undamped", "0").build();
  const System bare = unloaded("held", "case_1", "0.15").build();

  const double knots = 27.0 * held.duration * held.chain.omega / kTwoPi * held.chain.knots;
  const double degree_floor = peers::seconds_per_degree(held.chain);
  for (const double tolerance : {1e-4, 1e-7, 1e-10}) {
    std::printf(
        "\ntolerance %.0e\n| part | time [s] | steps | us a step | count | ns apiece | bare loop "
        "[ns] |\n"
        "|---|---|---|---|---|---|---|\n",
        tolerance);
    const Measured b = run(bare, tolerance), h = run(held.system, tolerance);
    const Measured c = run(closed, tolerance), g = run(gears, tolerance);
    print("degrees", b, static_cast<double>(b.summary.solves), b.seconds, degree_floor);
    print("knots", h, knots, h.seconds - b.seconds, peers::seconds_per_load(held.chain));
    print("changes", g, static_cast<double>(g.summary.contact_changes), g.seconds - c.seconds,
          peers::seconds_per_root());
    if (why_not_exact(pulses.system)) continue;
    PulseTorque::calls = 0;
    propagate(pulses.system, {.tolerance = tolerance, .t_end = 5.0, .energy_tolerance = 1.0});
    const auto calls = static_cast<double>(PulseTorque::calls);
    const Measured p = run(pulses.system, tolerance);
    print("pulses", p, calls, p.seconds - b.seconds, peers::seconds_per_load(pulses.chain));
  }
}

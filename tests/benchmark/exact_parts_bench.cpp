// What the parts of exact propagation cost, beside bare loops of the same arithmetic (peers/floor.cpp, compiled for the
// machine at hand): from pairs of runs of the camshaft over 5 s, fastest of 5, that differ in one part.
//   step, degree     held, no loads, at two tolerances: time = steps x step + products x degree
//   sweep, knot      held, 4 and 27 loads from tables: time beyond that without loads = steps x sweep + knots x knot
//   watch            undamped gears without loads: a backlash of 5 mm, hardly crossed, less none, over steps
//   contact change   the same with 0.15 mm, beyond steps of the time that they take with 5 mm
//   pulse            smooth loads less none, over the calls of evaluate()
//   build/release/bin/bench_exact_parts
#include "tests/benchmark/peer_harness.hpp"
#include "tests/benchmark/peers/floor.hpp"

using namespace drev;
using namespace drev::benchmark;

namespace {

/// The camshaft with so many of its 27 loads, spread over the cylinders; without one its end is struck.
System camshaft_with(int loads, const char* drive, const char* damping, const char* backlash_mm) {
  Parameters s("camshaft", camshaft_entry().parameters);
  s.set("drive", drive);
  s.set("damping", damping);
  s.set("backlash_mm", backlash_mm);
  const Model from = camshaft_entry().build(s).model;
  Model m("camshaft with fewer loads");
  for (const std::string& node : from.node_names()) m.add_node(node);
  int cam = 0;
  for (const ElementInstance& p : from.element_instances())
    if (!p.name.starts_with("cam_") || 7 * cam++ % 27 < loads) m.add(p.name, p.nodes, p.element);
  for (const Model::Prescription& p : from.prescriptions()) m.constant_speed(p.node, *p.omega);
  if (loads == 0) m.set_initial("end", 0.0, 20.0);
  return m.build();
}

struct Measured {
  double seconds = 1e9;
  RunSummary summary;
};

Measured run(const System& system, double tolerance) {
  Measured m;
  for (int i = 0; i < 5; ++i) {
    const std::clock_t start = std::clock();
    m.summary = propagate(system, {.tolerance = tolerance, .t_end = 5.0, .energy_tolerance = 1.0});
    m.seconds = std::min(m.seconds, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  CHECK(m.summary.ok());
  return m;
}

struct Costs {
  double step, each;
};

/// From two runs: seconds = steps x step + counts x each.
Costs costs_of(const std::array<Measured, 2>& runs, const std::array<double, 2>& seconds,
               const std::array<double, 2>& counts) {
  const auto steps = [&](std::size_t i) { return static_cast<double>(runs[i].summary.steps); };
  const double determinant = steps(0) * counts[1] - steps(1) * counts[0];
  return {(seconds[0] * counts[1] - seconds[1] * counts[0]) / determinant,
          (steps(0) * seconds[1] - steps(1) * seconds[0]) / determinant};
}

void print(const char* part, double seconds, double a_step, double floor = 0.0) {
  std::printf("| %s | %.1f | %.0f |", part, a_step, 1e9 * seconds);
  std::printf(floor > 0.0 ? " %.1f | %.1f |\n" : " | |\n", 1e9 * floor, seconds / floor);
}

}  // namespace

TEST_CASE("Parts of exact propagation") {
  constexpr int kLoads = 27, kFew = 4;
  const Problem held = make_problem("held", false), pulses = make_problem("held", true);
  const double knots = held.duration * held.chain.omega / kTwoPi * held.chain.knots;  // of one load
  const System bare = camshaft_with(0, "held", "case_1", "0.15");
  const System few = camshaft_with(kFew, "held", "case_1", "0.15");
  const System all = camshaft_with(kLoads, "held", "case_1", "0.15");
  const System closed = camshaft_with(0, "gears", "undamped", "0");
  const System clear = camshaft_with(0, "gears", "undamped", "5");
  const System gears = camshaft_with(0, "gears", "undamped", "0.15");
  for (const double tolerance : {1e-4, 1e-7}) {
    const auto steps = [](const Measured& m) { return static_cast<double>(m.summary.steps); };
    const auto products = [](const Measured& m) { return static_cast<double>(m.summary.solves); };
    const auto changes = [](const Measured& m) { return static_cast<double>(m.summary.contact_changes); };
    std::printf(
        "\ntolerance %.0e\n| part | a step | ns apiece | bare loop [ns] | times |\n|---|---|---|---|---|\n",
        tolerance);
    const std::array plain{run(bare, tolerance), run(bare, 1e-5 * tolerance)};
    const Costs degree =
        costs_of(plain, {plain[0].seconds, plain[1].seconds}, {products(plain[0]), products(plain[1])});
    print("step", degree.step, 1.0);
    print("degree", degree.each, products(plain[0]) / steps(plain[0]), peers::seconds_per_degree(held.chain));

    const std::array loaded{run(few, tolerance), run(all, tolerance)};
    const auto beyond = [&](const Measured& m) {
      return m.seconds - steps(m) * plain[0].seconds / steps(plain[0]);
    };
    const Costs knot =
        costs_of(loaded, {beyond(loaded[0]), beyond(loaded[1])}, {kFew * knots, kLoads * knots});
    print("sweep", knot.step, 1.0);
    print("knot", knot.each, kLoads * knots / steps(loaded[1]), peers::seconds_per_load(held.chain));

    const Measured c = run(closed, tolerance), w = run(clear, tolerance), g = run(gears, tolerance);
    const double watched = w.seconds / steps(w);
    print("watch", watched - c.seconds / steps(c), 1.0);
    print("contact change", (g.seconds - steps(g) * watched) / changes(g), changes(g) / steps(g),
          peers::seconds_per_root());

    PulseTorque::calls = 0;
    propagate(pulses.system, {.tolerance = tolerance, .t_end = 5.0, .energy_tolerance = 1.0});
    const auto calls = static_cast<double>(PulseTorque::calls);
    const Measured p = run(pulses.system, tolerance);
    print("pulse", beyond(p) / calls, calls / steps(p), peers::seconds_per_load(pulses.chain));
  }
}

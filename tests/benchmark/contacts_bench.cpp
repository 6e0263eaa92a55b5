// Newton on the contact forces against Newton with the sparse tangent, over the number of meshes: where
// StepOptions::max_dense_contacts should be. Processor time, best of 3.
//   build/release/bin/bench_contacts
#include <drev/core/system.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "tests/catch.hpp"

using namespace drev;

namespace {

/// A train of gears: shaft, mesh, shaft, mesh, ... that a sine torque makes knock; two nodes a mesh.
System gear_train(int meshes) {
  Model m("gear train");
  std::string last = "start";
  m.add_node(last);
  m.add<Inertia>("J_start", {last}, {.inertia = 2.0});
  for (int i = 0; i < meshes; ++i) {
    const std::string n = std::to_string(i), a = "a" + n, b = "b" + n;
    for (const std::string& node : {a, b}) {
      m.add_node(node);
      m.add<Inertia>("J_" + node, {node}, {.inertia = 1.0});
    }
    m.add<ShaftSpring>("shaft_" + n, {last, a}, {.stiffness = 1e6, .damping = 50.0});
    m.add<GearMesh>("mesh_" + n, {a, b},
                    {.base_radius_1 = 0.2,
                     .base_radius_2 = 0.2,
                     .stiffness = 5e8,
                     .normal_backlash = 1e-4,
                     .damping = 2e3});
    last = b;
  }
  m.add<AppliedTorque>("drive", {"start"}, {.torque = [](double t) { return 3000.0 * std::sin(200.0 * t); }});
  m.add<Dashpot>("drag", {last}, {.damping = 5.0});
  return m.build();
}

double us_per_step(const System& system, int limit) {
  double best = 1e9;
  for (int repeat = 0; repeat < 3; ++repeat) {
    TransientOptions options{.step = 1e-5, .t_end = 0.02, .energy_tolerance = 10};
    options.newton.max_dense_contacts = limit;
    const std::clock_t start = std::clock();
    const RunSummary run = simulate(system, options);
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    best = std::min(best, 1e6 * seconds / static_cast<double>(run.steps));
  }
  return best;
}

}  // namespace

TEST_CASE("Contacts: dense Newton on their forces or sparse tangent") {
  std::printf("| meshes | unknowns | on the forces, us a step | sparse tangent, us a step |\n");
  for (const int meshes : {1, 2, 4, 8, 12, 16, 24, 32, 48, 64, 96}) {
    const System system = gear_train(meshes);
    std::printf("| %d | %d | %.1f | %.1f |\n", meshes, system.size(), us_per_step(system, 1000),
                us_per_step(system, 0));
  }
}

// Runs whose instructions are counted (count.sh): what is inside measured() is.
//   instructions_runs held|gears|modes|main_job|mesh_fourier|mesh_table
#include <drev/core/system.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>
#include <cstdio>
#include <functional>

#include "tests/problems/mesh_laws.hpp"

using namespace drev;

extern "C" [[gnu::noinline]] void measured(const std::function<bool()>& run, bool& ok) { ok = run(); }

namespace {

constexpr double kDuration = 0.02, kMeshDuration = 0.05, kLongDuration = 1.0;  // s

ModelCase camshaft_case(const char* drive) {
  Parameters parameters("camshaft", camshaft_entry().parameters);
  parameters.set("drive", drive);
  return camshaft_entry().build(parameters);
}
System camshaft(const char* drive) { return camshaft_case(drive).model.build(); }

System chain(int n) {
  Model m("chain");
  m.add_node("n0");
  m.constant_speed("n0", 0.0);
  for (int i = 1; i <= n; ++i) {
    const std::string node = "n" + std::to_string(i), before = "n" + std::to_string(i - 1);
    m.add_node(node);
    m.add<Inertia>("J" + node, {node}, {.inertia = 1.0 + 0.5 * std::sin(2.3 * i)});
    m.add<ShaftSpring>("k" + node, {before, node}, {.stiffness = 1e6 * (1.0 + 0.3 * std::sin(1.7 * i))});
  }
  return m.build();
}

/// Exact propagation under the main job's observers.
void watched(const System& system, const std::vector<std::string>& torques,
             const std::vector<std::string>& deflections, double t_end, bool& ok) {
  Peaks torque(find_channels(system, torques)), deflection(find_channels(system, deflections));
  ContactStatistics contacts(system);
  measured(
      [&] {
        return propagate(system, {.tolerance = 1e-8, .t_end = t_end}, {&torque, &deflection, &contacts}).ok();
      },
      ok);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string name = argc == 2 ? argv[1] : "";
  bool ok = false;
  if (name == "held") {
    const System system = camshaft("held");
    measured([&] { return simulate(system, {.step = 1e-5, .t_end = kDuration}).ok(); }, ok);
  } else if (name == "gears") {
    const System system = camshaft("gears");
    measured([&] { return propagate(system, {.tolerance = 1e-6, .t_end = kDuration}).ok(); }, ok);
  } else if (name == "main_job") {
    const ModelCase model_case = camshaft_case("gears");
    watched(model_case.model.build(), model_case.torques, {model_case.deflection}, kLongDuration, ok);
  } else if (name == "mesh_fourier" || name == "mesh_table") {
    const test::GearDrive drive =
        test::gear_drive_with(test::mesh_law(name == "mesh_fourier" ? "Fourier" : "table"));
    watched(drive.system, drive.torques, {}, kMeshDuration, ok);
  } else if (name == "modes") {
    const System system = chain(2000);
    measured([&] { return solve_modes(system, {.count = 10}).count() == 10; }, ok);
  }
  if (!ok) std::fprintf(stderr, "instructions_runs: %s failed\n", name.c_str());
  return ok ? 0 : 1;
}

// Two inertias on one shaft, in a dozen lines of C++: describe, build, modes, run.
// Shows: Model, add, build, solve_modes, simulate with a recorder and peaks.
// Run:   build/release/bin/example_two_inertia
// Read first: nothing, start here. Then two_mass_backlash, gear_drive, camshaft.
#include <drev/core/channel.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>
#include <cstdio>

int main() {
  using namespace drev;
  Model m("motor and load");
  const auto motor = m.add_node("motor"), load = m.add_node("load");
  m.add<Inertia>("J_motor", {motor}, {.inertia = 0.012});  // kg m^2
  m.add<Inertia>("J_load", {load}, {.inertia = 0.035});
  m.add<ShaftSpring>("shaft", {motor, load}, {.stiffness = 8.5e3, .damping = 0.5});  // N m/rad, N m s/rad
  m.add<AppliedTorque>("drive", {motor}, {.torque = [](double t) { return 20 * std::sin(251.3 * t); }});
  const System system = m.build();

  const ModeSet modes = solve_modes(system, {.count = 1});
  Peaks peaks({find_channel(system, "shaft.torque_Nm")});
  const RunSummary run = simulate(system, {.step = 1e-5, .t_end = 0.2}, {&peaks});
  std::printf("mode %.4f Hz, largest shaft torque %.3f N m; %s\n", modes.frequency_Hz[0],
              peaks.peaks()[0].amplitude(), run.brief_report().c_str());
  return run.ok() ? 0 : 1;
}

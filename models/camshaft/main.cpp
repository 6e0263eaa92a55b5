// The camshaft with its gear held at constant speed: modes, static torque, dynamic amplification.
// Shows: a model built in a loop, static_sweep, Peaks over many channels.
// Run:   build/release/bin/example_camshaft
// Read first: two_inertia.
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/statics.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cstdio>

#include "models/camshaft/camshaft_data.hpp"

int main() {
  using namespace drev;
  for (const int cylinders : {6, 8, 9}) {
    const RayleighCase damping = rayleigh_case("case_1", cylinders);
    Model m("camshaft");
    add_camshaft(m, {.cylinders = cylinders, .rayleigh_a = damping.a});
    m.constant_speed("gear", rpm(375));
    const System system = m.build();

    std::vector<Channel> sections;
    for (const Channel& c : all_channels(system))
      if (c.name().starts_with("shaft_")) sections.push_back(c);
    double static_torque = 0.0;
    for (const Peak& p : static_sweep(system, sections, 0.0, kTwoPi, 720))
      static_torque = std::max(static_torque, p.amplitude());

    Peaks peaks(sections);
    const RunSummary run = simulate(system, {.step = 5e-5, .t_end = 5.0}, {&peaks});
    const double torque = peaks.peaks()[peaks.largest()].amplitude();
    std::printf(
        "%d cylinders: first mode %.2f Hz, largest torque %.0f N m in %s, static %.0f N m, "
        "amplification %.2f\n",
        cylinders, solve_modes(system, {.count = 1}).frequency_Hz[0], torque,
        sections[peaks.largest()].name().c_str(), static_torque, torque / static_torque);
    if (!run.ok()) std::printf("  %s\n", run.brief_report().c_str());
  }
}

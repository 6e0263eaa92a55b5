// The two-stage gear drive alone, hammered by a cyclic torque on the camshaft gear.
// Shows: gear meshes with backlash, constant speed at the crank, modes in two contact states.
// Run:   build/release/bin/example_gear_drive
// Read first: two_mass_backlash.
#include <drev/core/system.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cstdio>

int main() {
  using namespace drev;
  const ModelEntry& entry = gear_drive_entry();
  const ModelCase model_case = entry.build(Parameters(entry.name, entry.parameters));
  const System system = model_case.model.build();

  const ModeSet closed = solve_modes(system, {.count = 2, .contact = Contact::closed});
  std::printf("modes with both meshes closed: %.1f and %.1f Hz\n", closed.frequency_Hz[0],
              closed.frequency_Hz[1]);
  std::printf("with both open %d parts move freely\n", system.rigid_mode_count(Contact::open));

  ContactStatistics contacts(system);
  const RunSummary run =
      simulate(system, {.step = model_case.default_step, .t_end = model_case.duration}, {&contacts});
  for (const ContactRecord& c : contacts.records())
    std::printf("%s: %ld impacts in front, %ld behind, separated for %.1f %% of the time, at most %.0f N\n",
                c.element.c_str(), c.front_impacts, c.back_impacts,
                100 * c.time_separated / model_case.duration, c.largest_force);
  std::printf("%s\n", run.brief_report().c_str());
  return run.ok() ? 0 : 1;
}

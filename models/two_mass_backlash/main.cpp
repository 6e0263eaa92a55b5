// Two masses on springs with backlash, pulled and let go: the source's benchmark against FEDEM.
// Shows: translational nodes, PolylineSpring with a dead band, a table with a jump, contact statistics.
// Run:   build/release/bin/example_two_mass_backlash
// Read first: two_inertia.
#include <drev/core/system.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cstdio>

int main() {
  using namespace drev;
  const ModelEntry& entry = two_mass_backlash_entry();
  const ModelCase model_case = entry.build(Parameters(entry.name, entry.parameters));
  const System system = model_case.model.build();

  Recorder recorder(system, {"mass_1.position_m", "mass_2.position_m"}, 0.5);
  ContactStatistics contacts(system);
  const RunSummary run = simulate(system, {.step = model_case.default_step, .t_end = model_case.duration},
                                  {&recorder, &contacts});

  std::printf("   t s      x_1 m      x_2 m\n");
  for (std::size_t i = 0; i < recorder.times().size(); ++i)
    std::printf("%6.2f %10.6f %10.6f\n", recorder.times()[i], recorder.samples(0)[i], recorder.samples(1)[i]);
  for (const ContactRecord& c : contacts.records())
    std::printf("%s: %ld impacts in front, %ld behind, %.3f s separated, at most %.1f N\n", c.element.c_str(),
                c.front_impacts, c.back_impacts, c.time_separated, c.largest_force);
  std::printf("%s\n", run.brief_report().c_str());
  return run.ok() ? 0 : 1;
}

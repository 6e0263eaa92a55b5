// The assembled whole: camshaft of 9 cylinders, two-stage gear drive with backlash, crank at 750 rpm.
// Shows: a model put together from two parts that know nothing of each other.
// Run:   build/release/bin/example_camshaft_with_gear_drive   (the same by command: drev run camshaft)
// Read first: gear_drive and camshaft.
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cstdio>

#include "models/camshaft/camshaft_data.hpp"

int main() {
  using namespace drev;
  Model m("camshaft with gear drive");
  add_camshaft(m, {.cylinders = 9, .rayleigh_a = rayleigh_case("case_1", 9).a});
  add_gear_drive(m, "gear", {.normal_backlash = mm(0.15)});
  m.constant_speed("crank_gear", rpm(750));
  const System system = m.build();

  ContactStatistics contacts(system);
  Peaks peaks({find_channel(system, "inlet_9-fuel_1.twist_rad")});
  const RunSummary run = simulate(system, {.step = 1e-5, .t_end = 1.0}, {&contacts, &peaks});
  std::printf("largest deflection from first to last cam: %.3f deg\n", to_deg(peaks.peaks()[0].amplitude()));
  for (const ContactRecord& c : contacts.records())
    std::printf("%s: %ld impacts in front, %ld behind, separated for %.1f %% of the time\n",
                c.element.c_str(), c.front_impacts, c.back_impacts, 100 * c.time_separated);
  std::printf("%s\n", run.brief_report().c_str());
  return run.ok() ? 0 : 1;
}

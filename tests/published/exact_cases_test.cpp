// Exact propagation of the published cases 7 and 8 (cases_in_time_test.cpp), to the digits printed.
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/problems/backlash_oscillator.hpp"

using namespace drev;

TEST_CASE("Exact propagation, case 7: a damper limited to the spring's force") {
  const System system = backlash_oscillator(50.0, kPi / 4);
  Recorder recorder(system, {"disc.angle_rad", "disc.speed_rad_per_s"}, 0.05);
  const RunSummary run =
      propagate(system, {.tolerance = 1e-14, .t_end = 1.0, .energy_tolerance = 1e-12}, {&recorder});
  INFO(run.brief_report());
  CHECK(run.ok());
  CHECK(run.contact_changes > 20);
  for (const auto& e : kCase7) {
    const auto i = static_cast<std::size_t>(std::lround(e[0] / 0.05));
    CHECK(recorder.samples(0)[i] == Approx(e[1]).margin(1e-9 * kPi / 2));
    CHECK(recorder.samples(1)[i] == Approx(e[2]).margin(1e-9 * 66.196495));
  }
}

TEST_CASE("Exact propagation, case 8: undamped with a gap, closed-form period") {
  // T = 2 pi/w + 4 g/(w (A - g)); after 50 periods it is where it started.
  const double w = std::sqrt(2e4 / 5.0), gap = kPi / 8, amplitude = kPi / 2;
  const double period = kTwoPi / w + 4 * gap / (w * (amplitude - gap));
  const System system = backlash_oscillator(0.0, kPi / 4);
  State state = State::initial(system);
  const RunSummary run = propagate(system, {.tolerance = 1e-15, .t_end = 50 * period}, state);
  CHECK(run.ok());
  CHECK(run.contact_changes == 200);
  CHECK(state.z[0] == Approx(amplitude).epsilon(1e-13));
  CHECK(std::abs(state.v[0]) < 1e-11 * w * amplitude);
}

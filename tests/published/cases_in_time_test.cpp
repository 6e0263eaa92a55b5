// Published cases 7 to 9: other projects' numbers, recomputed independently.
#include <drev/core/channel.hpp>
#include <drev/core/law_element.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/problems/backlash_oscillator.hpp"

using namespace drev;

TEST_CASE("Case 7: backlash with a damper that never pulls (Modelica Standard Library)") {
  // The library's ElastoBacklash limits the damper to the spring's force. h = 5e-6 s is small enough.
  const double step = 5e-6, tolerance = 1e-6;
  const System system = backlash_oscillator(50.0, kPi / 4);
  Recorder recorder(system, {"disc.angle_rad", "disc.speed_rad_per_s"}, 0.05);
  const RunSummary run = simulate(system, {.step = step, .t_end = 1.0}, {&recorder});
  CHECK(run.ok());
  const double amplitude = kPi / 2, speed = 66.196495;
  for (const auto& e : kCase7) {
    const auto i = static_cast<std::size_t>(std::lround(e[0] / 0.05));
    INFO("t = " << e[0]);
    CHECK(recorder.samples(0)[i] == Approx(e[1]).margin(tolerance * amplitude));
    CHECK(recorder.samples(1)[i] == Approx(e[2]).margin(tolerance * speed));
  }
}

TEST_CASE("Case 7 without a gap: damped free vibration") {
  const System system = backlash_oscillator(50.0, 0.0);
  Recorder recorder(system, {"disc.angle_rad", "disc.speed_rad_per_s"}, 0.1);
  CHECK(simulate(system, {.step = 1e-6, .t_end = 0.1}, {&recorder}).ok());
  CHECK(recorder.samples(0)[1] == Approx(0.9541444033).margin(1e-8));
  CHECK(recorder.samples(1)[1] == Approx(-1.3039986217).margin(1e-6));
}

TEST_CASE("Case 8: period of the undamped oscillator with a symmetric gap, closed form") {
  // T = 2 pi/w + 4 g/(w (A - g)), w = 63.2455532, A = pi/2, g = pi/8.
  const System system = backlash_oscillator(0.0, kPi / 4);
  Reversals reversals;
  CHECK(simulate(system, {.step = 1e-6, .t_end = 0.5}, {&reversals}).ok());
  REQUIRE(reversals.times.size() >= 6);
  const double period = 0.1204277338;
  CHECK(reversals.times[0] == Approx(0.5 * period).epsilon(1e-6));
  CHECK(reversals.times[5] == Approx(3.0 * period).epsilon(1e-6));
}

TEST_CASE("Case 9: ideal gear, forced (Chrono unit test)") {
  Model m("ideal gear");
  m.add_node("first");
  m.add_node("second");
  m.add<Inertia>("J_1", {"first"}, {.inertia = 10.0});
  m.add<Inertia>("J_2", {"second"}, {.inertia = 100.0});
  m.add<IdealGear>("gear", {"first", "second"}, {.ratio = -0.1});
  m.add<AppliedTorque>("drive", {"first"}, {.torque = [](double) { return 6.0; }});
  const System system = m.build();
  CHECK(system.size() == 1);
  Recorder r(system,
             {"first.acceleration_rad_per_s2", "second.acceleration_rad_per_s2", "first.angle_rad",
              "first.speed_rad_per_s", "gear.torque_Nm"},
             0.5);
  CHECK(simulate(system, {.step = 1e-3, .t_end = 0.5}, {&r}).ok());
  CHECK(r.samples(0)[1] == Approx(0.5454545455).epsilon(1e-9));
  CHECK(r.samples(1)[1] == Approx(-0.0545454545).epsilon(1e-9));
  CHECK(r.samples(2)[1] == Approx(0.0681818).epsilon(1e-6));
  CHECK(r.samples(3)[1] == Approx(0.2727273).epsilon(1e-6));
  // The gear turns 100 kg m^2 at -0.0545 rad/s^2.
  CHECK(r.samples(4)[1] == Approx(-5.4545454545).epsilon(1e-9));
}

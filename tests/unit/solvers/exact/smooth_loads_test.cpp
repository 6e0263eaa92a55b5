// Loads that can only be called, beside closed forms: kinks and jumps that nobody states, also beside the ends of a step, and
// rounding near zero (solvers/exact/smooth_loads.hpp, load_series.hpp).
#include <drev/core/model.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/applied_torque.hpp>
#include <drev/elements/ground_spring.hpp>
#include <drev/elements/inertia.hpp>
#include <drev/elements/machines/torque_function.hpp>
#include <drev/elements/shaft_spring.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "tests/catch.hpp"

using namespace drev;

namespace {

System disc_under(std::function<double(double)> torque) {
  Model m("disc");
  m.add_node("a");
  m.add<Inertia>("J", {"a"}, {.inertia = 2.0});
  m.add<AppliedTorque>("load", {"a"}, {.torque = std::move(torque)});
  return m.build();
}

struct Came {
  double speed = 0.0;
  long steps = 0;
};
Came speed_at(const System& system, double t, double tolerance) {
  State state = State::initial(system);
  const RunSummary summary = propagate(system, {.tolerance = tolerance, .t_end = t}, state);
  REQUIRE(summary.ok());
  return {state.v[0], summary.steps};
}

/// Two discs on a shaft, a torque of so many Hz on the first.
System two_discs_under(double hertz) {
  Model m("pair");
  m.add_node("a");
  m.add_node("b");
  m.add<Inertia>("Ja", {"a"}, {.inertia = 0.012});
  m.add<Inertia>("Jb", {"b"}, {.inertia = 0.035});
  m.add<ShaftSpring>("shaft", {"a", "b"}, {.stiffness = 8500.0});
  m.add<AppliedTorque>("load", {"a"}, {.harmonics = {{hertz, 20.0, -0.5 * kPi}}});
  return m.build();
}

}  // namespace

TEST_CASE("A torque that ends shortly behind the start of a step as long as the run is in the motion") {
  // A jump that nobody states is found to 1e-6 of the longest step, which nothing limits for a single disc; and the first of the twelve nodes lies 0.9 % behind a step's start.
  for (const double ends : {0.05, 0.004, 9.96})
    for (const double tolerance : {1e-3, 1e-6, 1e-10, 1e-13}) {
      INFO("ends at " << ends << " s, tolerance " << tolerance);
      const bool at_end = ends > 5.0;
      const System system = disc_under([=](double t) { return (t < ends) != at_end ? 250.0 : 25.0; });
      const double early = at_end ? 25.0 : 250.0, late = at_end ? 250.0 : 25.0;
      const double expected = (early * ends + late * (10.0 - ends)) / 2.0;
      CHECK(speed_at(system, 10.0, tolerance).speed == Approx(expected).epsilon(std::max(tolerance, 1e-6)));
    }
}

TEST_CASE("Steep ramps between plateaus, which nodes see as jumps: the motion at every tolerance") {
  const double omega = kTwoPi * 200.0, bend = std::asin(1.0 / 50.0) / omega;
  const System system =
      disc_under([=](double t) { return 20.0 * std::clamp(50.0 * std::sin(omega * t), -1.0, 1.0); });
  // Ten halves of the torque's period and one: that of one half is all that is left.
  const double half = 2.0 * 50.0 * (1.0 - std::cos(omega * bend)) / omega + (0.0025 - 2.0 * bend);
  const double expected = 20.0 * half / 2.0;
  for (const double tolerance : {1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    INFO("tolerance " << tolerance);
    const Came came = speed_at(system, 0.0275, tolerance);
    CHECK(std::abs(came.speed - expected) <= std::max(3.0 * tolerance, 1e-9) * expected);
    CHECK(came.steps < 1500);
  }
}

TEST_CASE("Rounding of a torque that begins at zero shortens no steps") {
  const System system = two_discs_under(40.0);
  for (const double t : {1e-3, 1e-6, 1e-9}) {
    INFO(t << " s");
    const Came came = speed_at(system, t, 1e-10);
    CHECK(came.steps <= 10);
    // J v = int 20 sin(w t) dt, of which the shaft takes a part of 1/12 omega_shaft^2 t^2.
    const double omega = kTwoPi * 40.0, s = std::sin(0.5 * omega * t);
    const double free = 20.0 / 0.012 * 2.0 * s * s / omega, shaft = 8500.0 / 0.012 * t * t / 12.0;
    CHECK(std::abs(came.speed / free - (1.0 - shaft)) < 1e-8 + shaft * shaft);
  }
}

TEST_CASE("Harmonics that cancel are no torque, and others of one frequency are their sum") {
  const auto pair = [](std::vector<Harmonic> harmonics) {
    Model m("disc");
    m.add_node("a");
    m.add<Inertia>("J", {"a"}, {.inertia = 2.0});
    m.add<GroundSpring>("k", {"a"}, {.stiffness = 2e4});
    m.add<AppliedTorque>("load", {"a"}, {.harmonics = std::move(harmonics)});
    return m.build();
  };
  const auto run = [&](std::vector<Harmonic> harmonics) {
    return speed_at(pair(std::move(harmonics)), 1.0, 1e-10);
  };
  const Came none = run({{2.0, 100.0, 0.0}, {2.0, 100.0, kPi}});
  CHECK(none.speed == 0.0);
  CHECK(none.steps < 100);
  CHECK(run({{2.0, 7.0, 0.0}, {2.0, 7.0, kTwoPi / 3.0}, {2.0, 7.0, 2.0 * kTwoPi / 3.0}}).speed == 0.0);
  // 3 cos + 4 sin = 5 cos(x - atan2(4, 3))
  const double sum = run({{3.0, 3.0, 0.0}, {1.0, 2.0, 0.1}, {3.0, 4.0, -0.5 * kPi}}).speed;
  CHECK(sum == Approx(run({{1.0, 2.0, 0.1}, {3.0, 5.0, -std::atan2(4.0, 3.0)}}).speed).epsilon(1e-9));
}

TEST_CASE("A train that leaves an unstable rest takes no steps for the rounding of its load's angle") {
  // J x'' = T sin x from x = 0, which the load looks up within a turn: its rounding alone drives the train off, and
  // J x'^2/2 = T (1 - cos x) from then on.
  const double torque = 400.0, inertia = 0.1;
  Model m("top");
  m.add_node("a");
  m.add<Inertia>("J", {"a"}, {.inertia = inertia});
  m.add<TorqueFunction>("top", {"a"},
                        {.torque = [=](const TorqueVariables& at) { return -torque * sin(at.angle + kPi); }});
  const System system = m.build();
  State state = State::initial(system);
  const RunSummary summary = propagate(system, {.tolerance = 1e-10, .t_end = 0.45}, state);
  REQUIRE(summary.ok());
  CHECK(summary.steps < 300);
  const double x = std::abs(state.z[0]), speed = 2.0 * std::sqrt(torque / inertia) * std::sin(0.5 * x);
  CHECK(x > 1e-6);
  CHECK(std::abs(state.v[0]) == Approx(speed).epsilon(1e-7));
}

TEST_CASE("A torque of frequencies takes steps that the fastest mode limits") {
  const System system = two_discs_under(50.0);
  State state = State::initial(system);
  const double t = 1.003, omega = kTwoPi * 50.0;
  const RunSummary summary = propagate(system, {.tolerance = 1e-10, .t_end = t}, state);
  CHECK(state.v[0] * 0.012 + state.v[1] * 0.035 ==
        Approx(20.0 / omega * (1.0 - std::cos(omega * t))).epsilon(1e-9));
  // 975 rad/s, a little less than 3 rad a step
  CHECK(summary.steps < 420);
}

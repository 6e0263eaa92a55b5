// Propeller, TorqueCurve, Generator, SpeedGovernor, PlanetarySet: tangents, signs, bad input.
#include <drev/core/assembler.hpp>
#include <drev/core/channel.hpp>
#include <drev/core/element.hpp>
#include <drev/core/model.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/gears/planetary_set.hpp>
#include <drev/elements/inertia.hpp>
#include <drev/elements/machines/generator.hpp>
#include <drev/elements/machines/propeller.hpp>
#include <drev/elements/machines/speed_governor.hpp>
#include <drev/elements/machines/torque_curve.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/elements/checks.hpp"

using namespace drev;

TEST_CASE("Propeller: quadratic law, blades, damping factor") {
  const Propeller propeller(
      {.rated_torque = 6e5, .rated_speed = 10.0, .damping_factor = 3.0, .harmonics = {{4.0, 0.1, 0.0}}});
  CHECK(check_element(propeller, 1).failures == std::vector<std::string>{});
  const LoadResponse r = propeller.evaluate({.nominal_angle = kPi / 8.0, .speed = 5.0, .nominal_speed = 5.0});
  CHECK(r.torque == Approx(-1.5e5));        // cos(pi/2): no part of the blades
  CHECK(r.dtorque_dspeed == Approx(-9e4));  // a Q/w = 3 * 1.5e5/5
  CHECK(propeller.evaluate({.speed = -5.0, .nominal_speed = -5.0}).torque == Approx(1.65e5));
  CHECK(test::contains(test::findings(Propeller({.rated_torque = -1.0})), "rated_speed"));
}

TEST_CASE("Torque curve over the speed") {
  const TorqueCurve motor({.speeds = {0.0, 100.0, 150.0}, .torques = {50.0, 80.0, 0.0}, .scale = 2.0});
  CHECK(check_element(motor, 1).ok());
  CHECK(motor.evaluate({.speed = 50.0}).torque == Approx(130.0));
  CHECK(motor.evaluate({.speed = 125.0}).dtorque_dspeed == Approx(-3.2));
  CHECK(motor.evaluate({.speed = -10.0}).torque == Approx(100.0));
  CHECK(motor.evaluate({.speed = 500.0}).torque == 0.0);
  CHECK(test::contains(test::findings(TorqueCurve({.speeds = {1.0}, .torques = {}})), "at least 2"));
  // A starter that lets go.
  const TorqueCurve starter(
      {.speeds = {0.0, 30.0}, .torques = {400.0, 250.0}, .gate = {.to_speed = 28.0, .speed_ramp = 2.0}});
  CHECK(check_element(starter, 1).failures == std::vector<std::string>{});
  CHECK(starter.evaluate({.speed = 10.0}).torque == Approx(350.0));
  CHECK(starter.evaluate({.speed = 27.0}).torque == Approx(0.5 * 265.0));
  CHECK(starter.evaluate({.speed = 27.0}).dtorque_dspeed == Approx(-0.5 * 265.0 - 0.5 * 5.0));
  CHECK(starter.evaluate({.speed = 28.5}).torque == 0.0);
  CHECK(test::contains(
      test::findings(TorqueCurve({.speeds = {0.0, 1.0}, .torques = {1.0, 1.0}, .gate = {.from_speed = 5.0}})),
      "speed_ramp"));
}

TEST_CASE("Generator: braking torque, short circuit, synchronous torque on the deviation") {
  const Generator generator({.torque = 1500.0,
                             .synchronous_stiffness = 12e3,
                             .synchronous_damping = 60.0,
                             .fault_time = 0.5,
                             .fault_torque = 1e4,
                             .fault_torque_double = 4e3,
                             .fault_decay = 0.04});
  CHECK(check_element(generator, 1).failures == std::vector<std::string>{});
  CHECK(generator.evaluate({.t = 0.4999}).torque == -1500.0);
  const double t = 0.004;  // a fifth of the period
  CHECK(generator.evaluate({.t = 0.5 + t}).torque ==
        Approx(-1500.0 - std::exp(-0.1) * (1e4 * std::sin(0.2 * kTwoPi) + 4e3 * std::sin(0.4 * kTwoPi))));
  CHECK(generator.breakpoints() == std::vector<double>{0.5});
  const Terms terms = test::described(generator, 1);
  CHECK(terms.stiffness(0, 0) == 12e3);
  CHECK(terms.deviation_damping(0, 0) == 60.0);
  CHECK(terms.speed_ratio_constraints[0].holds_deviation);
  CHECK(check_element(Generator({.torque = 10.0}), 1).ok());
  CHECK(test::contains(test::findings(Generator({.fault_torque = 1.0})), "fault_time"));
}

TEST_CASE("Speed governor: gains and droop") {
  const SpeedGovernor pi({.proportional_gain = 600.0, .integral_gain = 1500.0});
  CHECK(check_element(pi, 1).ok());
  CHECK(SpeedGovernor({.droop = 0.05, .rated_torque = 500.0, .rated_speed = 100.0}).proportional_gain() ==
        Approx(100.0));
  CHECK(test::findings(SpeedGovernor({.droop = 0.05, .rated_torque = 500.0, .rated_speed = 100.0})).empty());
  const std::string text = test::findings(SpeedGovernor({.integral_gain = -1.0, .droop = 2.0}));
  for (const char* part : {"integral_gain", "droop", "rated_torque", "rated_speed"})
    CHECK(test::contains(text, part));
  CHECK(test::contains(test::findings(SpeedGovernor({.proportional_gain = 1.0, .droop = 0.1})),
                       "give one of them"));
}

TEST_CASE("Torque channels of governor and generator: a spring's sign, and that of a load") {
  for (const double lag : {0.0, 0.2}) {
    Model model("signs");
    for (const char* node : {"governed", "generating"}) {
      model.add_node(node);
      model.add<Inertia>(std::string("J_") + node, {node}, {.inertia = 3.0});
      model.set_initial(node, 0.01, 2.0);
    }
    model.add<SpeedGovernor>("governor", {"governed"},
                             {.proportional_gain = 600.0, .integral_gain = 1500.0, .actuator_lag = lag});
    model.add<Generator>("generator", {"generating"},
                         {.torque = 10.0, .synchronous_stiffness = 2000.0, .synchronous_damping = 7.0});
    const System system = model.build();
    Assembler assembler(system);
    const State state = State::initial(system, 0.0);
    assembler.set_time(0.0);
    const auto channel = [&](const char* name) {
      return find_channel(system, name).evaluate(assembler, state);
    };
    // Ahead of the nominal motion and faster than it: a governor brakes (one with a lag has not begun), and so does the grid.
    if (lag == 0.0) CHECK(channel("governor.torque_Nm") == Approx(600.0 * 2.0 + 1500.0 * 0.01));
    CHECK(channel("generator_synchronous.torque_Nm") == Approx(2000.0 * 0.01 + 7.0 * 2.0));
    CHECK(channel("generator_gap.torque_Nm") == -10.0);
  }
}

TEST_CASE("Planetary set: its row, and bad input") {
  const Terms terms = test::described(PlanetarySet({.teeth_sun = 20, .teeth_ring = 50}), 3);
  REQUIRE(terms.constraints.size() == 1);
  CHECK(terms.constraints[0][1] == -2.5);
  CHECK(terms.constraints[0].sum() == Approx(0.0).margin(1e-15));  // all turn together
  CHECK(test::contains(test::findings(PlanetarySet({})), "ratio"));
  CHECK(test::contains(test::findings(PlanetarySet({.ratio = 2.0, .teeth_sun = 20})), "must both be > 0"));
}

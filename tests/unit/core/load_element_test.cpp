// Torques by a formula of one's own (core/law/load_element.hpp): slopes, motion against closed forms, ends of pieces.
#include <drev/core/law/load_element.hpp>
#include <drev/core/model.hpp>
#include <drev/core/state.hpp>
#include <drev/core/system.hpp>
#include <drev/core/verify.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/elements/checks.hpp"

using namespace drev;
using namespace drev::test;

namespace {

/// tau = -c w |w| - a sin(2 theta).
struct Fan {
  static constexpr std::string_view type = "fan";
  double c = 0.0, a = 0.0;
  template <class T>
  T torque(double, const T& angle, const T& speed) const {
    using std::abs, std::sin;
    return -c * speed * abs(speed) - a * sin(2.0 * angle);
  }
  void check(ParameterCheck& check) const { check.positive("c", c, "N m s^2/rad^2"); }
};

/// 6 N m from t = 0.25 s on.
struct Push {
  static constexpr bool follows_motion = false;
  template <class T>
  T torque(double t, const T&, const T&) const {
    return t < 0.25 ? 0.0 : 6.0;
  }
  std::vector<double> breakpoints() const { return {0.25}; }
};

double speed_at_end(const System& system, bool exact) {
  State state = State::initial(system);
  const RunSummary run = exact ? propagate(system, {.tolerance = 1e-12, .t_end = 1.0}, state)
                               : run_method(system, {.name = "sdirk4", .step = 1e-3}, {.t_end = 1.0}, state);
  REQUIRE(run.ok());
  return state.v[0];
}

}  // namespace

TEST_CASE("The slopes of a torque's formula are its own, at any angle and speed") {
  CHECK(check_element(LoadElement<Fan>({.c = 0.05, .a = 3.0}), 1).text() == "");
  CHECK(check_element(LoadElement<Push>({}), 1).text() == "");
  const LoadElement<Fan> fan({.c = 0.05, .a = 3.0});
  const LoadResponse r =
      fan.evaluate({.nominal_angle = 0.3, .deviation = 0.1, .speed = -20.0, .nominal_speed = 5.0});
  CHECK(r.torque == Approx(20.0 - 3.0 * std::sin(0.8)).epsilon(1e-15));
  CHECK(r.dtorque_dangle == Approx(-6.0 * std::cos(0.8)).epsilon(1e-15));
  CHECK(r.dtorque_dspeed == Approx(-2.0).epsilon(1e-15));
  CHECK(fan.type() == "fan");
  CHECK(contains(findings(LoadElement<Fan>({.c = -1.0})), "c = -1 N m s^2/rad^2"));
}

TEST_CASE("A fan slows its rotor as the closed form says, by every kind of method") {
  // J w' = -c w^2: w = w_0/(1 + c w_0 t/J) = 100/(1 + 0.05 100/2) = 100/3.5 rad/s after 1 s.
  Model m("fan");
  m.add_node("rotor");
  m.add<Inertia>("J", {"rotor"}, {.inertia = 2.0});
  m.add<LoadElement<Fan>>("fan", {"rotor"}, {.c = 0.05});
  m.set_initial("rotor", 0.0, 100.0);
  const System system = m.build();
  CHECK(speed_at_end(system, true) == Approx(100.0 / 3.5).epsilon(1e-10));
  CHECK(speed_at_end(system, false) == Approx(100.0 / 3.5).epsilon(1e-9));
}

TEST_CASE("A formula's jump is its breakpoint") {
  // 6 N m for 0.75 s on 2 kg m^2.
  Model m("push");
  m.add_node("rotor");
  m.add<Inertia>("J", {"rotor"}, {.inertia = 2.0});
  m.add<LoadElement<Push>>("push", {"rotor"}, {});
  const System system = m.build();
  CHECK(speed_at_end(system, true) == Approx(2.25).epsilon(1e-13));
  CHECK(speed_at_end(system, false) == Approx(2.25).epsilon(1e-13));
}

// TorqueFunction and Formula: slopes by forward differentiation, gate by speed, closed forms in time, bad input.
#include <drev/core/units.hpp>
#include <drev/elements/formula.hpp>
#include <drev/elements/inertia.hpp>
#include <drev/elements/machines/torque_function.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/elements/checks.hpp"

using namespace drev;

namespace {

/// -0.02 w |w| (1 + 0.3 cos(4 theta)) + 5 exp(-t)
Dual fan(const TorqueVariables& x) {
  return -0.02 * x.speed * abs(x.speed) * (1.0 + 0.3 * cos(4.0 * x.angle)) + 5.0 * std::exp(-x.t);
}

}  // namespace

TEST_CASE("A torque function's slopes are those of its formula") {
  const TorqueFunction by_cpp({.torque = fan});
  CHECK(check_element(by_cpp, 1).failures == std::vector<std::string>{});
  const LoadResponse r = by_cpp.evaluate({.t = 2.0, .nominal_angle = 0.3, .deviation = 0.1, .speed = 30.0});
  CHECK(r.torque == Approx(-18.0 * (1.0 + 0.3 * std::cos(1.6)) + 5.0 * std::exp(-2.0)).epsilon(1e-14));
  CHECK(r.dtorque_dangle == Approx(18.0 * 1.2 * std::sin(1.6)).epsilon(1e-14));
  CHECK(r.dtorque_dspeed == Approx(-1.2 * (1.0 + 0.3 * std::cos(1.6))).epsilon(1e-14));
}

TEST_CASE("A formula by steps: every operation, with its slopes, and as text") {
  using Op = Formula::Op;
  // sqrt(|w|) + exp(-t) tan(x) / (log(w) + 2)^1.5 - max(x, w) min(sin(x), cos(x)) + tanh(x) atan(w)
  const Formula f({{.op = Op::variable, .a = 0},
                   {.op = Op::variable, .a = 1},
                   {.op = Op::variable, .a = 2},
                   {.op = Op::abs, .a = 1},
                   {.op = Op::sqrt, .a = 3},
                   {.op = Op::negate, .a = 2},
                   {.op = Op::exp, .a = 5},
                   {.op = Op::tan, .a = 0},
                   {.op = Op::multiply, .a = 6, .b = 7},
                   {.op = Op::log, .a = 1},
                   {.op = Op::constant, .value = 2.0},
                   {.op = Op::add, .a = 9, .b = 10},
                   {.op = Op::power, .a = 11, .value = 1.5},
                   {.op = Op::divide, .a = 8, .b = 12},
                   {.op = Op::larger, .a = 0, .b = 1},
                   {.op = Op::sin, .a = 0},
                   {.op = Op::cos, .a = 0},
                   {.op = Op::smaller, .a = 15, .b = 16},
                   {.op = Op::multiply, .a = 14, .b = 17},
                   {.op = Op::add, .a = 4, .b = 13},
                   {.op = Op::subtract, .a = 19, .b = 18},
                   {.op = Op::tanh, .a = 0},
                   {.op = Op::atan, .a = 1},
                   {.op = Op::multiply, .a = 21, .b = 22},
                   {.op = Op::add, .a = 20, .b = 23}});
  const auto expected = [](double x, double w, double t) {
    return std::sqrt(std::abs(w)) + std::exp(-t) * std::tan(x) / std::pow(std::log(w) + 2.0, 1.5) -
           std::max(x, w) * std::min(std::sin(x), std::cos(x)) + std::tanh(x) * std::atan(w);
  };
  const double x = 0.4, w = 3.0, t = 0.7, d = 1e-6;
  const Dual r = f.at(std::array{Dual(x, 1.0, 0.0), Dual(w, 0.0, 1.0), Dual(t)});
  CHECK(r.value == Approx(expected(x, w, t)).epsilon(1e-14));
  CHECK(r.by_x == Approx((expected(x + d, w, t) - expected(x - d, w, t)) / (2.0 * d)).epsilon(1e-8));
  CHECK(r.by_x_dot == Approx((expected(x, w + d, t) - expected(x, w - d, t)) / (2.0 * d)).epsilon(1e-8));
  CHECK(f.text(std::vector<std::string>{"x", "w", "t"}) ==
        "sqrt(abs(w)) + exp(-t) * tan(x) / (log(w) + 2)^1.5 - max(x, w) * min(sin(x), cos(x)) + tanh(x) * "
        "atan(w)");
  CHECK(Formula().at({}).value == 0.0);
  CHECK_THROWS_AS(Formula({{.op = Op::add, .a = 0, .b = 1}}), std::invalid_argument);
}

TEST_CASE("A gate by speed: closed outside, straight over its ramps") {
  const TorqueFunction gated({.torque = [](const TorqueVariables&) { return Dual(10.0); },
                              .gate = {.from_speed = 50.0, .to_speed = 100.0, .speed_ramp = 4.0}});
  CHECK(check_element(gated, 1).failures == std::vector<std::string>{});
  for (const auto& [speed, torque, slope] : {std::tuple{20.0, 0.0, 0.0},
                                             {51.0, 2.5, 2.5},
                                             {70.0, 10.0, 0.0},
                                             {98.0, 5.0, -2.5},
                                             {130.0, 0.0, 0.0}}) {
    CHECK(gated.evaluate({.speed = speed}).torque == Approx(torque));
    CHECK(gated.evaluate({.speed = speed}).dtorque_dspeed == Approx(slope));
  }
}

TEST_CASE("A torque function in time: run-up against a quadratic law, exact and stepped") {
  // J w' = T - k w^2: w = w_inf tanh(t sqrt(T k)/J)
  Model m("fan");
  m.add_node("rotor");
  m.add<Inertia>("J", {"rotor"}, {.inertia = 2.0});
  m.add<TorqueFunction>("drive", {"rotor"}, {.torque = [](const TorqueVariables& x) {
                          return 300.0 - 0.03 * x.speed * abs(x.speed);
                        }});
  const System system = m.build();
  const double w_inf = 100.0, rate = std::sqrt(300.0 * 0.03) / 2.0;
  State exact = State::initial(system), stepped = exact;
  CHECK(propagate(system, {.tolerance = 1e-11, .t_end = 0.9}, exact).ok());
  CHECK(exact.v[0] == Approx(w_inf * std::tanh(0.9 * rate)).epsilon(1e-10));
  CHECK(run_method(system, {.step = 1e-4}, {.t_end = 0.9}, stepped).ok());
  CHECK(stepped.v[0] == Approx(w_inf * std::tanh(0.9 * rate)).epsilon(1e-7));
}

TEST_CASE("A brake by tanh of the speed comes to rest as its closed form says") {
  // J w' = -T tanh(w/w_0): sinh(w/w_0) = sinh(w(0)/w_0) exp(-T t/(J w_0))
  using Op = Formula::Op;
  Model m("brake");
  m.add_node("rotor");
  m.add<Inertia>("J", {"rotor"}, {.inertia = 2.0});
  m.add<TorqueFunction>("brake", {"rotor"},
                        {.formula = Formula({{.op = Op::variable, .a = 1},
                                             {.op = Op::constant, .value = 0.5},
                                             {.op = Op::divide, .a = 0, .b = 1},
                                             {.op = Op::tanh, .a = 2},
                                             {.op = Op::constant, .value = -30.0},
                                             {.op = Op::multiply, .a = 4, .b = 3}})});
  m.set_initial("rotor", 0.0, 10.0);
  const System system = m.build();
  for (const double t : {0.3, 0.66, 0.8}) {
    State state = State::initial(system);
    CHECK(propagate(system, {.tolerance = 1e-11, .t_end = t}, state).ok());
    CHECK(state.v[0] == Approx(0.5 * std::asinh(std::sinh(20.0) * std::exp(-30.0 * t))).epsilon(1e-9));
  }
}

TEST_CASE("Torque function: bad input is named, all at once") {
  const std::string text =
      test::findings(TorqueFunction({.breakpoints = {NAN}, .gate = {.from_speed = 3.0, .to_speed = 2.0}}));
  for (const char* part : {"exactly one of torque and formula", "breakpoints", "speed_ramp"})
    CHECK(test::contains(text, part));
  CHECK(test::contains(test::findings(TorqueFunction(
                           {.torque = fan, .gate = {.from_speed = 3.0, .to_speed = 4.0, .speed_ramp = 1.0}})),
                       "by two speed_ramps"));
  CHECK(test::contains(test::findings(TorqueFunction({.torque = fan, .gate = {.speed_ramp = 1.0}})),
                       "needs from_speed"));
}

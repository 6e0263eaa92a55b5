// Ranges of formulas and of their slopes hold every value within (core/law/ranged.hpp), and those of the catalogue's loads too
// (Load::steepest; elements/machines/speed_gate.cpp).
#include "core/law/ranged.hpp"

#include <drev/core/law/dual.hpp>
#include <drev/elements/catalogue.hpp>

#include <cmath>
#include <functional>
#include <random>

#include "tests/catch.hpp"

using namespace drev;

namespace {

bool holds(const Interval& range, double value) {
  const double rounding = 1e-12 * (1.0 + std::abs(value));
  return value >= range.low - rounding && value <= range.high + rounding;
}

struct Case {
  const char* text;
  double low, high;  // of the variable
  std::function<Dual(const Dual&)> at;
  std::function<Ranged(const Ranged&)> over;
};

#define DREV_CASE(low, high, formula)                                                                    \
  Case {                                                                                                 \
#formula, low, high,                                                                                 \
        [](const Dual& x) -> Dual { return formula; }, [](const Ranged& x) -> Ranged { return formula; } \
  }

}  // namespace

TEST_CASE("Ranges of functions and of their slopes hold what lies within") {
  std::mt19937 random(7);
  const Case cases[] = {
      DREV_CASE(-3.0, 3.0, abs(x)),
      DREV_CASE(-3.0, 3.0, exp(x) - 2.0 * x),
      DREV_CASE(-9.0, 9.0, sin(x)),
      DREV_CASE(-9.0, 9.0, cos(3.0 * x + 1.0)),
      DREV_CASE(-3.0, 3.0, tanh(x) * atan(x)),
      DREV_CASE(0.0, 3.0, sqrt(x)),
      DREV_CASE(0.1, 3.0, log(x)),
      DREV_CASE(-3.0, 3.0, pow(x, 2.0)),
      DREV_CASE(-3.0, 3.0, pow(x, 3.0)),
      DREV_CASE(0.1, 3.0, pow(x, -1.5)),
      DREV_CASE(0.1, 3.0, pow(x, 2.5)),
      DREV_CASE(-3.0, 3.0, -50.0 * x * exp(-pow(x / 0.3, 2.0))),
      DREV_CASE(-3.0, 3.0, x * abs(x) / (1.0 + x * x)),
      DREV_CASE(-3.0, 3.0, 1.0 / x),
  };
  for (const Case& c : cases)
    for (int i = 0; i < 200; ++i) {
      std::uniform_real_distribution<double> within(c.low, c.high);
      double a = within(random), b = within(random);
      if (a > b) std::swap(a, b);
      const Ranged range = c.over(Ranged::variable(1, {a, b}));
      for (int k = 0; k <= 20; ++k) {
        const double x = a + (b - a) * k / 20.0;
        if (x == 0.0) continue;  // kinks and poles there
        INFO(c.text << " at " << x << " in " << a << " to " << b);
        const Dual at = c.at(Dual(x, 0.0, 1.0));
        CHECK(holds(range.value, at.value));
        CHECK(holds(range.by[1], at.by_x_dot));
      }
    }
  // Where nothing stands twice and nothing bends within, they are tight.
  const Ranged tight = exp(Ranged::variable(0, {0.0, 1.0}));
  CHECK(tight.value.low == 1.0);
  CHECK(tight.by[0].high == Approx(std::exp(1.0)));
  CHECK(smaller(Ranged(1.0), Ranged(Interval{2.0, 3.0})).value.high == 1.0);
}

TEST_CASE("How steep the loads of the catalogue are: bounds over ranges against slopes at points") {
  const SpeedGate gate{.from_speed = -20.0, .to_speed = 30.0, .speed_ramp = 5.0};
  const TorqueCurve curve(
      {.speeds = {-10.0, 0.0, 15.0}, .torques = {5.0, 100.0, -20.0}, .scale = 2.0, .gate = gate});
  using Op = Formula::Op;
  // angle * speed - time, gated
  const TorqueFunction function({.formula = Formula({{.op = Op::variable, .a = 0},
                                                     {.op = Op::variable, .a = 1},
                                                     {.op = Op::multiply, .a = 0, .b = 1},
                                                     {.op = Op::variable, .a = 2},
                                                     {.op = Op::subtract, .a = 2, .b = 3}}),
                                 .gate = gate});
  const Propeller propeller(
      {.rated_torque = 10.0, .rated_speed = 10.0, .damping_factor = 3.0, .harmonics = {{4.0, 0.1, 0.3}}});
  const Generator generator({.fault_time = 0.5,
                             .fault_torque = 10.0,
                             .fault_torque_double = -5.0,
                             .grid_frequency = 2.0,
                             .fault_decay = 0.3});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  for (const Load* load : {static_cast<const Load*>(&curve), static_cast<const Load*>(&function),
                           static_cast<const Load*>(&propeller), static_cast<const Load*>(&generator)})
    for (int i = 0; i < 300; ++i) {
      LoadRanges over;
      const auto draw = [&](Interval& x, double low, double high) {
        x.low = low + (high - low) * part(random);
        x.high = x.low + 0.3 * (high - low) * part(random);
      };
      draw(over.t, 0.0, 2.0);
      draw(over.angle, -3.0, 3.0);
      draw(over.speed, -40.0, 40.0);
      draw(over.nominal_speed, -40.0, 40.0);
      const auto slopes = load->steepest(over);
      REQUIRE(slopes);
      for (int k = 0; k < 10; ++k) {
        LoadInput in;
        const auto at = [&](const Interval& x) { return x.low + (x.high - x.low) * part(random); };
        in.t = at(over.t);
        in.deviation = at(over.angle);
        in.speed = at(over.speed);
        in.nominal_speed = at(over.nominal_speed);
        const LoadResponse r = load->evaluate(in);
        CHECK(std::abs(r.dtorque_dangle) <= slopes->by_angle * (1.0 + 1e-12));
        CHECK(std::abs(r.dtorque_dspeed) <= slopes->by_speed * (1.0 + 1e-12));
        const double d = 1e-7;
        LoadInput later = in;
        later.t += d;
        const double by_time = (load->evaluate(later).torque - r.torque) / d;
        if (later.t <= over.t.high) CHECK(std::abs(by_time) <= slopes->by_time * (1.0 + 1e-6) + 1e-5);
      }
    }
  CHECK(!TorqueFunction({.torque = [](const TorqueVariables& at) { return at.speed; }}).steepest({}));
}

// Formulas in model files: an expression of variables is what the same grammar gives for numbers, with slopes; its units;
// its faults with their columns; written and read again.
#include <drev/app/model_file/model_file.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/machines/torque_function.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>

#include <cmath>

#include "app/model_file/expression.hpp"
#include "app/model_file/writing/export.hpp"
#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using namespace drev;
using test::contains;

namespace {

const app::Scope kFormulaScope{{{"n", 9.0}, {"rated_Nm", 40.0}, {"rated_rpm", 1500.0}, {"gap_mm", 2.0}},
                               {{"part", {0.5, 0.25}}}};
const std::vector<app::FormulaVariable> kFormulaVariables{{"angle_rad", 0, 1.0},
                                                          {"angle_deg", 0, to_deg(1.0)},
                                                          {"speed_rad_per_s", 1, 1.0},
                                                          {"speed_rpm", 1, to_rpm(1.0)},
                                                          {"time_s", 2, 1.0}};

Formula compiled(const std::string& text) {
  return app::compile(text, kFormulaScope, kFormulaVariables, "Nm");
}

Dual at(const std::string& text, double angle, double speed, double time) {
  return compiled(text).at(std::array{Dual(angle, 1.0, 0.0), Dual(speed, 0.0, 1.0), Dual(time)});
}

std::string refused_formula(const std::string& text) {
  try {
    compiled(text);
  } catch (const app::ExpressionError& error) {
    return error.sentence;
  }
  return "accepted";
}

std::string model_of(const std::string& expression, const std::string& more = "") {
  return "format = 1\n[parameters]\nrated_Nm = { default = 40 }\n[nodes]\na = {}\n[elements]\nJ = { type = "
         "\"inertia\", "
         "node = \"a\", "
         "inertia_kg_m2 = 2 }\nfan = { type = \"torque_function\", node = \"a\", expression = \"" +
         expression + "\"" + more + " }\n[run]\nduration_s = 1\nstep_s = 1e-3\n";
}

ModelCase built(const std::string& text) {
  const app::ModelFile file(text, "fan.toml", "");
  return file.entry().build(Parameters(file.entry().name, file.entry().parameters));
}

}  // namespace

TEST_CASE("A formula is what the grammar gives for numbers, with its slopes") {
  const double x = 0.4, w = 3.0, t = 0.7, d = 1e-6;
  const std::string text =
      "-2*angle_rad^3/(n - 1) + part[2]*sqrt(abs(speed_rad_per_s))*exp(-time_s) + max(sin(angle_rad), "
      "min(speed_rad_per_s, 2.5)) - log(speed_rad_per_s)*tan(angle_rad)*cos(30*pi/180)";
  const auto by_numbers = [&](double a, double s) {
    app::Scope scope = kFormulaScope;
    scope.numbers.insert({{"angle_rad", a}, {"speed_rad_per_s", s}, {"time_s", t}});
    std::string plain = text;  // numbers there have the unit of their names
    for (const char* name : {"angle_rad", "speed_rad_per_s", "time_s"})
      for (std::size_t i = 0; (i = plain.find(name, i)) != std::string::npos;
           i += std::string(name).size() + 7)
        plain.replace(i, std::string(name).size(), "plain(" + std::string(name) + ")");
    return app::evaluate(plain, scope).value;
  };
  const Dual r = at(text, x, w, t);
  CHECK(r.value == Approx(by_numbers(x, w)).epsilon(1e-14));
  CHECK(r.by_x == Approx((by_numbers(x + d, w) - by_numbers(x - d, w)) / (2.0 * d)).epsilon(1e-8));
  CHECK(r.by_x_dot == Approx((by_numbers(x, w + d) - by_numbers(x, w - d)) / (2.0 * d)).epsilon(1e-8));
  CHECK(at("7", x, w, t).value == 7.0);
  CHECK(at("angle_deg", kPi, w, t).value == Approx(180.0));
}

TEST_CASE("A formula written as text is read back with its operations in their order") {
  const std::array<std::string, 3> names{"angle_rad", "speed_rad_per_s", "time_s"};
  std::string long_one = "time_s";
  for (int i = 0; i < 40; ++i) long_one += i % 2 == 0 ? "*(angle_rad*3)" : "/(speed_rad_per_s/time_s)";
  for (const std::string& text :
       {std::string("-0.1*speed_rpm"), std::string("angle_rad*(speed_rpm/(time_s*3)) - (angle_rad - time_s)"),
        std::string("-(angle_rad*speed_rpm)^-1.3*(-time_s)^2 - -time_s"), long_one}) {
    const Formula first = compiled(text);
    INFO(first.text(names));
    for (double x = 0.1; x < 3.0; x += 0.1)
      CHECK(at(first.text(names), x, 70.0 + x, 1.7).value == at(text, x, 70.0 + x, 1.7).value);
  }
}

TEST_CASE("Variables are plain where that makes a whole, else they have their unit") {
  const double w = rpm(750.0);
  CHECK(at("-0.02*speed_rpm^2 + angle_deg", 0.0, w, 0.0).value == Approx(-0.02 * 750.0 * 750.0));
  CHECK(at("-rated_Nm*(speed_rpm/rated_rpm)^2", 0.0, w, 0.0).value == Approx(-10.0));
  CHECK(at("-rated_Nm*(speed_rpm/rated_rpm)^2", 0.0, w, 0.0).by_x_dot == Approx(-20.0 / w));
  CHECK(at("-plain(rated_Nm)*speed_rpm", 0.0, w, 0.0).value == Approx(-30000.0));
}

TEST_CASE("What is wrong with a formula is said with its column") {
  CHECK(contains(refused_formula("3*speed_rmp"),
                 "names speed_rmp, in column 3, which is no variable and no parameter"));
  CHECK(contains(refused_formula("3*speed_rmp"), "speed_rpm"));
  CHECK(contains(refused_formula("3*+*speed_rpm"), "column 4"));
  CHECK(contains(refused_formula("(3*speed_rpm"), "lacks a ')'"));
  CHECK(contains(refused_formula("2^(speed_rpm/rated_rpm)"), "has an exponent that follows a variable"));
  CHECK(contains(refused_formula("part[speed_rpm]"), "takes a place that follows a variable"));
  CHECK(contains(refused_formula("gap_mm*speed_rpm"), "the key in Nm"));
  CHECK(
      contains(refused_formula("1/0 + speed_rpm/1"), "accepted"));  // at its values it is an error of the run
}

TEST_CASE("A torque by an expression in a model file: closed form in time, written and read again") {
  // J w' = T - k w^2: w = w_inf tanh(t sqrt(T k)/J)
  const ModelCase fan = built(model_of("rated_Nm - 0.004*speed_rad_per_s*abs(speed_rad_per_s)"));
  const System system = fan.model.build();
  State state = State::initial(system);
  CHECK(propagate(system, {.tolerance = 1e-11, .t_end = 1.0}, state).ok());
  CHECK(state.v[0] == Approx(100.0 * std::tanh(std::sqrt(40.0 * 0.004) / 2.0)).epsilon(1e-10));

  const std::string gate = ", from_speed_rpm = 100, to_speed_rpm = 900, speed_ramp_rpm = 20";
  const std::string text =
      model_of("rated_Nm*cos(2*angle_rad)/(1 + time_s) - 0.004*speed_rpm^2 + min(time_s, -3)", gate);
  const app::ModelFile file(text, "fan.toml", "");
  const Parameters parameters(file.entry().name, file.entry().parameters);
  const ModelCase first = file.entry().build(parameters);
  const ModelCase again = built(app::export_model(file.entry(), parameters, first));
  const auto torque = [](const ModelCase& c, double angle, double speed, double t) {
    for (const ElementInstance& e : c.model.element_instances())
      if (const auto* f = dynamic_cast<const TorqueFunction*>(e.element.get()))
        return f->evaluate({.t = t, .deviation = angle, .speed = speed});
    return LoadResponse{};
  };
  for (const double speed : {5.0, 11.0, 40.0, 93.5}) {
    CHECK(torque(again, 0.3, speed, 0.2).torque == torque(first, 0.3, speed, 0.2).torque);
    CHECK(torque(again, 0.3, speed, 0.2).dtorque_dspeed == torque(first, 0.3, speed, 0.2).dtorque_dspeed);
  }
  // In a file the fault names its place, too.
  try {
    built(model_of("3*speeed_rpm"));
    FAIL("accepted");
  } catch (const ModelError& error) {
    const std::string what = error.what();
    for (const char* part : {"fan.toml:8", "elements.fan.expression", "speeed_rpm, in column 3", "speed_rpm"})
      CHECK(contains(what, part));
  }
}

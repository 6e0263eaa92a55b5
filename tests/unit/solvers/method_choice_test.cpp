// Which method a system is given, and the rate that decides.
// Covers solvers/method.hpp, solvers/method_costs.hpp.
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/problems/backlash_oscillator.hpp"
#include "tests/problems/general_elements.hpp"
#include "tests/problems/unit_oscillator.hpp"

using namespace drev;

TEST_CASE("Fastest rate: closed forms") {
  CHECK(fastest_rate(unit_oscillator().build()) == Approx(kTwoPi).epsilon(1e-12));
  // Chain of 10 discs, fixed at one end: 2 sqrt(k/J) cos(pi/21) (k = 1000, J = 0.1).
  Model chain("chain");
  for (int i = 0; i < 10; ++i) {
    const std::string n = "d" + std::to_string(i), before = "d" + std::to_string(i - 1);
    chain.add_node(n);
    chain.add<Inertia>("J" + n, {n}, {.inertia = 0.1});
    if (i == 0)
      chain.add<GroundSpring>("k" + n, {n}, {.stiffness = 1000.0});
    else
      chain.add<ShaftSpring>("k" + n, {before, n}, {.stiffness = 1000.0});
  }
  const double exact = 2.0 * std::sqrt(1e4) * std::cos(kPi / 21.0);
  const double found = fastest_rate(chain.build());
  CHECK(found <= exact * (1.0 + 1e-12));
  CHECK(found > 0.95 * exact);
  // A damper can be faster than any spring.
  Model damped = unit_oscillator();
  damped.add<Dashpot>("c", {"m"}, {.damping = 100.0});
  CHECK(fastest_rate(damped.build()) == Approx(100.0).epsilon(1e-12));
}

TEST_CASE("The method follows what the model is") {
  const MethodChoice linear = choose_method(unit_oscillator().build(), 10.0, 1e-3);
  CHECK(linear.method.exact());
  CHECK(linear.reason.find("linear, with 1 unknown and 0 contacts") != std::string::npos);
  const MethodChoice contact = choose_method(backlash_oscillator(0.0, 1.0), 10.0, 1e-3);
  CHECK(contact.method.exact());
  CHECK(contact.reason.find("piecewise linear, with 1 unknown and 1 contact") != std::string::npos);
  Model general = unit_oscillator();
  general.add_node("end", NodeKind::translational);
  general.add<Inertia>("end mass", {"end"}, {.inertia = 1.0});
  general.add<problems::Maxwell>("mount", {"m", "end"}, {.stiffness = 1.0, .damping = 1.0});
  const MethodChoice other = choose_method(general.build(), 10.0, 1e-3);
  CHECK(other.method.name == "average_acceleration");
  CHECK(other.method.step == 1e-3);
  for (const char* part : {"mount", "history"}) CHECK(other.reason.find(part) != std::string::npos);
  // However long it takes: no other method takes less.
  const MethodChoice lasting = choose_method(unit_oscillator().build(), 1e9, 1.0);
  CHECK(lasting.method.exact());
  CHECK(lasting.reason == linear.reason);
  // 25 products in each step of 3/omega, times 20 + unknowns + 10 contacts.
  CHECK(linear.exact_work == Approx(25 * kTwoPi * 10 / 3 * 21).epsilon(1e-9));
  CHECK(contact.exact_work == Approx(25 * fastest_rate(backlash_oscillator(0.0, 1.0)) * 10 / 3 * 31));
  CHECK(other.exact_work == 0.0);
}

TEST_CASE("A motion that is an unknown function: controlled steps, to their tolerance of the closed form") {
  // x'' + w^2 x = u, u = sin t the motion of the foot of a second spring of 1 N/m, w^2 = 4 pi^2 + 1.
  Model m = unit_oscillator();
  m.add_node("foot", NodeKind::translational);
  m.add<ShaftSpring>("between", {"m", "foot"}, {.stiffness = 1.0});
  m.given_motion("foot", {.at = [](double t) {
                   return MotionPoint{std::sin(t), std::cos(t), -std::sin(t)};
                 }});
  const System system = m.build();
  const MethodChoice choice = choose_method(system, 10.0, 1e-3);
  CHECK(choice.method.name == "dormand_prince");
  CHECK(choice.method.controlled());
  CHECK(choice.reason.find("foot") != std::string::npos);
  State s = State::initial(system);
  const RunSummary run = run_method(system, choice.method, {.t_end = 10.0}, s);
  CHECK(run.ok());
  // x = (sin t - sin(w t)/w) / (w^2 - 1) from rest.
  const double w = std::sqrt(4 * kPi * kPi + 1.0);
  CHECK(std::abs(s.z[0] - (std::sin(10.0) - std::sin(10.0 * w) / w) / (w * w - 1.0)) <
        1e-4 * (1.0 + 1.0 / w) / (w * w - 1.0));
  // So fast that explicit steps would take hours: implicit ones.
  CHECK(choose_method(system, 1e10, 1e-3).method.name == "sdirk4");
}

TEST_CASE("A method by name runs as its own function would") {
  Model m = unit_oscillator();
  m.set_initial("m", 1.0, 0.0);
  const System system = m.build();
  State exact = State::initial(system), stepped = exact, own = exact;
  CHECK(run_method(system, {.name = "exact", .tolerance = 1e-12}, {.t_end = 0.3}, exact).ok());
  CHECK(exact.z[0] == Approx(std::cos(kTwoPi * 0.3)).epsilon(1e-11));
  const RunSummary run = run_method(system, {.name = "hht:0.1", .step = 1e-3}, {.t_end = 0.3}, stepped);
  CHECK(run.steps == 300);
  simulate(system, {.scheme = hht(0.1), .step = 1e-3, .t_end = 0.3}, own);
  CHECK(stepped.z[0] == own.z[0]);
  CHECK_THROWS_AS(run_method(system, {.name = "euler", .step = 1e-3}, {.t_end = 0.3}), ModelError);
}

namespace {

/// A load on a slow spring, driven at 4 Hz through a shaft whose own mode, at 53 kHz for 1e9 N m/rad, settles at once.
System driven_through(double shaft_stiffness, double damping = 2000.0) {
  Model m("driven through a shaft");
  for (const char* node : {"motor", "load"}) m.add_node(node);
  m.add<Inertia>("J_motor", {"motor"}, {.inertia = 0.012});
  m.add<Inertia>("J_load", {"load"}, {.inertia = 0.035});
  m.add<GroundSpring>("mount", {"load"}, {.stiffness = 500.0, .damping = 0.05});
  m.add<ShaftSpring>("shaft", {"motor", "load"}, {.stiffness = shaft_stiffness, .damping = damping});
  m.add<AppliedTorque>("drive", {"motor"}, {.harmonics = {{4.0, 20.0, -0.5 * kPi}}});
  return m.build();
}

}  // namespace

TEST_CASE("Exact propagation stays for a run of hours whose modes all move", "[once]") {
  Model m = unit_oscillator();
  m.add_node("second", NodeKind::translational);
  m.add<Inertia>("second mass", {"second"}, {.inertia = 1.0});
  m.add<ShaftSpring>("between", {"m", "second"}, {.stiffness = 1e4});
  m.set_initial("second", 0.0, 1.0);
  const System system = m.build();
  const double duration = 1e8;
  const MethodChoice first = choose_method(system, duration, 1e-3);
  CHECK(first.exact_work > 1e11);
  const MethodTrial trial = try_methods(system, first, duration);
  INFO(trial.choice.reason);
  CHECK(trial.choice.method.exact());
  CHECK(trial.chosen_ns > 0.0);
}

TEST_CASE("A method more than twenty times as dear as another that keeps the accuracy gives way to it") {
  const System stiff = driven_through(1e9);
  const MethodChoice first = choose_method(stiff, 20.0, 1e-4);
  REQUIRE(first.method.exact());
  const MethodTrial trial = try_methods(stiff, first, 20.0);
  INFO(trial.choice.reason);
  CHECK(trial.choice.method.name == "sdirk4");
  CHECK(trial.choice.method.tolerance == kControlledTolerance);
  CHECK(trial.chosen_ns > kTooExpensive * trial.other_ns);
  CHECK(trial.choice.reason.find("times as much as sdirk4") != std::string::npos);
  // Counts and weights, no clocks: the same numbers each time.
  const MethodTrial again = try_methods(stiff, first, 20.0);
  CHECK(again.chosen_ns == trial.chosen_ns);
  CHECK(again.other_ns == trial.other_ns);
  // The estimates are of the right size: the counts of whole runs.
  State exact = State::initial(stiff), other = State::initial(stiff);
  const RunSummary part = run_method(stiff, first.method, {.t_end = 0.4}, exact);
  const double exact_steps = static_cast<double>(part.steps) * 20.0 / 0.4;
  CHECK(trial.chosen_ns > 8000.0 * exact_steps * 0.5);
  CHECK(trial.chosen_ns < 8000.0 * exact_steps * 4.0);
  // And it keeps the accuracy: at 0.4 s both are at the same place.
  run_method(stiff, trial.choice.method, {.t_end = 0.4}, other);
  CHECK((other.z - exact.z).norm() < 1e-3 * exact.z.norm());
}

TEST_CASE("A long chain with one stiff and strongly damped shaft gives way to implicit steps", "[once]") {
  constexpr int kDiscs = 1000;
  Model m("long chain");
  for (int i = 0; i < kDiscs; ++i) {
    const std::string node = "n" + std::to_string(i);
    m.add_node(node);
    m.add<Inertia>("J" + std::to_string(i), {node}, {.inertia = i == 0 ? 1000.0 : 10.0});
  }
  for (int i = 0; i + 1 < kDiscs; ++i) {
    const bool stiff = i + 2 == kDiscs;
    m.add<ShaftSpring>("s" + std::to_string(i), {"n" + std::to_string(i), "n" + std::to_string(i + 1)},
                       {.stiffness = stiff ? 1e12 : 1e5, .damping = stiff ? 1e6 : 10.0});
  }
  m.set_initial("n0", 0.0, 1.0);
  const System system = m.build();
  const MethodTrial trial = try_methods(system, choose_method(system, 20.0, 1e-4), 20.0);
  INFO(trial.choice.reason << ": " << trial.chosen_ns << " beside " << trial.other_ns);
  CHECK(trial.choice.method.name == "sdirk4");
}

TEST_CASE("A light disc behind a stiff shaft gives way to implicit steps, whatever the duration") {
  // Its mode, at 700 kHz, keeps the implicit steps short until they have damped it: they grow for thousands of steps.
  Model m("light disc");
  for (const auto& [node, inertia] : {std::pair("a", 0.5), {"b", 1e-6}, {"c", 0.3}}) {
    m.add_node(node);
    m.add<Inertia>(std::string("J_") + node, {node}, {.inertia = inertia});
  }
  m.set_reference("a", constant_speed(50.0 * kPi));
  m.add<ShaftSpring>("stiff", {"a", "b"}, {.stiffness = 2e7});
  m.add<ShaftSpring>("soft", {"b", "c"}, {.stiffness = 3e4, .damping = 2.0});
  m.add<EngineOrderTorque>("engine", {"a"}, {.harmonics = {{2.0, 100.0}, {4.0, 40.0}}, .mean = 50.0});
  m.add<TorqueFunction>("fan", {"c"},
                        {.torque = [](const TorqueVariables& v) { return -0.002 * v.speed * v.speed; }});
  const System system = m.build();
  for (const double duration : {0.5, 1.0, 2.0, 10.0, 100.0}) {
    const MethodTrial trial = try_methods(system, choose_method(system, duration, 1e-4), duration);
    INFO(duration << " s: " << trial.choice.reason << ": " << trial.chosen_ns << " beside "
                  << trial.other_ns);
    CHECK(trial.choice.method.name == "sdirk4");
  }
}

TEST_CASE("A method that is affordable, or the cheapest that is right, stays") {
  // Short: a run of two seconds or less is never tried beyond its first steps.
  const System stiff = driven_through(1e9);
  const MethodChoice chosen = choose_method(stiff, 0.5, 1e-4);
  const MethodTrial soon = try_methods(stiff, chosen, 0.5);
  CHECK(soon.choice.method.exact());
  CHECK(soon.choice.reason == chosen.reason);
  CHECK(soon.other_ns == 0.0);
  // Long, but its steps are those of the motion.
  const System soft = driven_through(1e6, 2.0);
  const MethodChoice cheap = choose_method(soft, 1000.0, 1e-4);
  REQUIRE(cheap.method.exact());
  const MethodTrial kept = try_methods(soft, cheap, 1000.0);
  INFO(kept.chosen_ns << " ns beside " << kept.other_ns);
  CHECK(kept.choice.method.exact());
  CHECK(kept.chosen_ns > 1e10);
  // Constant steps are no one's choice but where nothing else is fit for the system.
  MethodChoice constant = choose_method(stiff, 20.0, 1e-4);
  constant.method = Method{};
  constant.method.step = 1e-3;
  CHECK(try_methods(stiff, constant, 20.0).choice.method.name == "average_acceleration");
  // Interrupted: what was chosen stays.
  CHECK(
      try_methods(stiff, choose_method(stiff, 20.0, 1e-4), 20.0, [] { return false; }).choice.method.exact());
}

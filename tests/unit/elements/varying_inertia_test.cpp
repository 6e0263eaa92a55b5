// EngineCylinders with varying_inertia: J(theta) theta'' + 1/2 J' theta'^2 against closed forms and an independent program.
#include <drev/core/assembler.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/batch/simulate_many.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/nonlinear_sweep.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>
#include <drev/solvers/periodic/periodic_response.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/catch.hpp"
#include "tests/unit/elements/checks.hpp"

using namespace drev;

namespace {

constexpr double kCrank = 0.05, kRod = 0.16, kMass = 2.0;

EngineCylinders::Params engine_of(std::vector<double> firing) {
  return {.bore = 0.09,
          .stroke = 2.0 * kCrank,
          .rod = kRod,
          .oscillating_mass = kMass,
          .varying_inertia = true,
          .strokes = 2,
          .firing_angles = std::move(firing)};
}

/// m x'^2 at an angle from top dead centre.
double oscillating(double angle) { return kMass * std::pow(CrankSlider{kCrank, kRod}.at(angle).first, 2); }

TransientOptions by(const char* method, double step, double t_end) {
  return {.scheme = step_scheme(method), .step = step, .t_end = t_end};
}

}  // namespace

TEST_CASE("A crank that turns freely keeps J(theta) w^2, and takes the time that follows from it") {
  constexpr double kInertia = 0.004, kStart = 100.0, kEnd = 0.05;
  Model m("free crank");
  m.add_node("crank");
  m.add<Inertia>("J", {"crank"}, {.inertia = kInertia});
  m.add<EngineCylinders>("engine", {"crank"}, engine_of({0.0}));
  m.set_initial("crank", 0.0, kStart);
  const System system = m.build();
  const auto speed = [&](double angle) {
    return kStart * std::sqrt(kInertia / (kInertia + oscillating(angle)));
  };
  double slowest = kStart;
  for (int i = 0; i < 100; ++i) slowest = std::min(slowest, speed(0.01 * kTwoPi * i));
  CHECK(slowest < 0.7 * kStart);  // the inertia more than doubles
  const auto errors = [&](const char* method, double step) {
    State state = State::initial(system);
    const RunSummary run = simulate(system, by(method, step, kEnd), state);
    CHECK(run.ok());
    const double time = test::integral([&](double a) { return 1.0 / speed(a); }, 0.0, state.z[0], 1 << 16);
    return std::pair{std::abs(state.v[0] / speed(state.z[0]) - 1.0), std::abs(time / kEnd - 1.0)};
  };
  const auto coarse = errors("average_acceleration", 2e-5), fine = errors("average_acceleration", 1e-5);
  CHECK(coarse.first / fine.first == Approx(4.0).epsilon(0.02));  // of second order
  CHECK(coarse.second / fine.second == Approx(4.0).epsilon(0.02));
  CHECK(errors("hht", 1e-5).second < 2e-6);
  for (const char* method : {"sdirk4", "rk4", "dormand_prince"}) {
    INFO(method);
    CHECK(errors(method, 2e-5).first < 2e-10);
    CHECK(errors(method, 2e-5).second < 2e-10);
  }
  // Controlled steps; the cylinder's torque is all that accelerates the constant inertia.
  State state = State::initial(system);
  Recorder recorder(system,
                    {"crank.angle_rad", "crank.speed_rad_per_s", "crank.acceleration_rad_per_s2",
                     "engine.torque_Nm", "engine.power_W"},
                    1e-3);
  TransientOptions controlled = by("dormand_prince", 1e-5, kEnd);
  controlled.tolerance = 1e-10;
  CHECK(simulate(system, controlled, state, {&recorder}).ok());
  const CrankSlider crank{kCrank, kRod};
  const double mean = kMass * crank.mean_square();
  REQUIRE(recorder.times().size() == 51);
  for (std::size_t i = 0; i < recorder.times().size(); ++i) {
    const double angle = recorder.samples(0)[i], w = recorder.samples(1)[i], a = recorder.samples(2)[i];
    CHECK(w == Approx(speed(angle)).epsilon(1e-7));
    const CrankSlider::Derivatives x = crank.at(angle);  // J theta'' = -1/2 J' w^2
    const double expected = -kMass * x.first * x.second * w * w / (kInertia + kMass * x.first * x.first);
    CHECK(a == Approx(expected).margin(1e-3));
    CHECK(recorder.samples(3)[i] == Approx((kInertia + mean) * a).margin(1e-9));
    CHECK(recorder.samples(4)[i] == Approx(recorder.samples(3)[i] * w).margin(1e-7));
  }
}

namespace {

/// Two cylinders, each on an inertia of its own, and a flywheel with a drag. nominal: of the flywheel, or none.
System train(bool varying, std::optional<Motion> nominal) {
  EngineCylinders::Params engine = engine_of({0.0, kPi});
  engine.varying_inertia = varying;
  engine.mean_oscillating_inertia = true;
  engine.mean_tangential_pressure = 3e5;
  engine.tangential_pressure = {{1.0, 6e5, -1.2}};
  Model m("two cylinders");
  for (const char* node : {"throw_1", "throw_2", "flywheel"}) m.add_node(node);
  m.add<Inertia>("J_1", {"throw_1"}, {.inertia = 0.02});
  m.add<Inertia>("J_2", {"throw_2"}, {.inertia = 0.02});
  m.add<Inertia>("J", {"flywheel"}, {.inertia = 0.2});
  m.add<ShaftSpring>("web", {"throw_1", "throw_2"}, {.stiffness = 4e4, .damping = 10.0});
  m.add<ShaftSpring>("shaft", {"throw_2", "flywheel"}, {.stiffness = 3e4, .damping = 8.0});
  m.add<Dashpot>("drag", {"flywheel"}, {.damping = 1.5});
  m.add<EngineCylinders>("engine", {"throw_1", "throw_2"}, engine);
  if (nominal) m.set_reference("flywheel", *nominal);
  const double rate = 120.0 - (nominal ? nominal->at(0.0).rate : 0.0);
  for (const char* node : {"throw_1", "throw_2", "flywheel"}) m.set_initial(node, 0.0, rate);
  return m.build();
}

/// Angles and speeds after 0.1 s: SciPy 1.17, solve_ivp with DOP853 at a tolerance of 1e-13, within 5e-12 of Radau at
/// 1e-12; slider and crank, equations and orders written there again. With the mean inertia: the same program.
constexpr double kVarying[] = {12.093408838779,  12.0904460608269, 12.0819415543615,
                               123.605872145463, 123.115259700813, 123.363889683105};
constexpr double kMean[] = {12.0940433626314, 12.0910858762617, 12.0826092459099,
                            123.626594164427, 123.136090251108, 123.38476009202};

double error_of(const System& system, const TransientOptions& options, const double (&expected)[6]) {
  State state = State::initial(system);
  CHECK(simulate(system, options, state).ok());
  const Assembler at_end = [&] {
    Assembler assembler(system);
    assembler.set_time(state.t);
    return assembler;
  }();
  double most = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double rate = at_end.node_motion(k, state).rate + system.ratio(k) * at_end.nominal().rate;
    most = std::max({most, std::abs(at_end.node_angle(k, state.z) / expected[k] - 1.0),
                     std::abs(rate / expected[k + 3] - 1.0)});
  }
  return most;
}

}  // namespace

TEST_CASE("Two cylinders with varying inertia: an independent program, whatever the nominal motion") {
  for (const std::optional<Motion>& nominal : {std::optional<Motion>(), std::optional(constant_speed(120.0)),
                                               std::optional(run_up(100.0, 130.0, 0.01, 0.08))}) {
    const System varying = train(true, nominal), mean = train(false, nominal);
    INFO(nominal.has_value());
    // What the term in the acceleration moves here.
    CHECK(error_of(varying, by("dormand_prince", 2e-5, 0.1), kMean) > 5e-5);
    CHECK(error_of(mean, by("dormand_prince", 2e-5, 0.1), kMean) < 1e-10);
    CHECK(error_of(varying, by("dormand_prince", 2e-5, 0.1), kVarying) < 1e-10);
    CHECK(error_of(varying, by("sdirk4", 2e-5, 0.1), kVarying) < 1e-9);
    const double coarse = error_of(varying, by("average_acceleration", 4e-5, 0.1), kVarying),
                 fine = error_of(varying, by("average_acceleration", 2e-5, 0.1), kVarying);
    CHECK(fine < 1e-6);
    CHECK(coarse / fine == Approx(4.0).epsilon(0.1));
    const double alpha = error_of(varying, by("generalized_alpha", 2e-5, 0.1), kVarying);
    CHECK(error_of(varying, by("generalized_alpha", 4e-5, 0.1), kVarying) / alpha ==
          Approx(4.0).epsilon(0.15));
  }
}

TEST_CASE("A cylinder on a wheel that is geared, beside a contact: the energy of the varying inertia stays") {
  // Crank and wheel tied 1 : 2, and a load behind play; nothing is lost: 1/2 (J_1 + 4 J_2 + m x'^2) w^2 + 1/2 J_3 w_3^2 + U.
  Model m("geared");
  for (const char* node : {"crank", "wheel", "load"}) m.add_node(node);
  m.add<Inertia>("J_1", {"crank"}, {.inertia = 0.004});
  m.add<Inertia>("J_2", {"wheel"}, {.inertia = 0.0005});
  m.add<Inertia>("J_3", {"load"}, {.inertia = 0.01});
  m.add<IdealGear>("gear", {"crank", "wheel"}, {.ratio = -2.0});
  m.add<DeadBandCoupling>("play", {"wheel", "load"}, {.stiffness = 500.0, .gap = 0.02});
  m.add<EngineCylinders>("engine", {"crank"}, engine_of({0.3}));
  m.set_initial("crank", 0.0, 100.0);
  m.set_initial("load", 0.0, -150.0);
  const System system = m.build();
  Recorder recorder(system,
                    {"crank.angle_rad", "crank.speed_rad_per_s", "wheel.speed_rad_per_s",
                     "load.speed_rad_per_s", "play.deflection_rad"},
                    1e-4);
  State state = State::initial(system);
  REQUIRE(simulate(system, by("average_acceleration", 1e-6, 0.1), state, {&recorder}).ok());
  double first = 0.0, free = 0.0;
  for (std::size_t i = 0; i < recorder.times().size(); ++i) {
    const auto at = [&](std::size_t c) { return recorder.samples(c)[i]; };
    const double pressed = std::max(0.0, std::abs(at(4)) - 0.01);
    free += pressed == 0.0 ? 1.0 : 0.0;
    CHECK(std::abs(at(2)) == Approx(2.0 * std::abs(at(1))));
    const double energy = 0.5 * (0.004 + oscillating(at(0) - 0.3)) * at(1) * at(1) +
                          0.5 * 0.0005 * at(2) * at(2) + 0.5 * 0.01 * at(3) * at(3) +
                          250.0 * pressed * pressed;
    if (i == 0) first = energy;
    CHECK(energy == Approx(first).epsilon(1e-6));
  }
  CHECK(free > 20.0);
  CHECK(free < 980.0);
}

TEST_CASE("Varying inertia: what it needs, and what refuses it by name") {
  EngineCylinders::Params p = engine_of({0.0});
  p.twist_feedback = false;
  CHECK(test::contains(test::findings(EngineCylinders(p)), "needs twist_feedback"));
  CHECK(check_element(EngineCylinders(engine_of({0.0})), 1).failures == std::vector<std::string>{});
  const auto message = [](const auto& task) {
    try {
      task();
    } catch (const ModelError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto alone = [](bool held) {
    Model m("alone");
    m.add_node("crank");
    if (held) {
      m.add_node("wheel");
      m.add<Inertia>("J", {"wheel"}, {.inertia = 1.0});
      m.add<ShaftSpring>("shaft", {"crank", "wheel"}, {.stiffness = 1e3});
      m.hold("crank");
    }
    m.add<EngineCylinders>("engine", {"crank"}, engine_of({0.0}));
    m.build();
  };
  CHECK(test::contains(message([&] { alone(false); }), "needs another inertia on its node"));
  CHECK(test::contains(message([&] { alone(true); }), "needs a node that moves freely"));
  const System system = train(true, constant_speed(120.0));
  CHECK(solve_modes(system, {.count = 2}).frequency_Hz ==
        solve_modes(train(false, constant_speed(120.0)), {.count = 2}).frequency_Hz);
  const auto why = why_not_exact(system);
  REQUIRE(why);
  CHECK(test::contains(*why, "engine has an inertia that follows the angle (varying_inertia)"));
  CHECK(test::contains(why_not_exact(system, false).value_or(""), "does not take; take its mean inertia"));
  CHECK(test::contains(message([&] {
                         sweep_linear(system, {.speeds = {100.0, 120.0}});
                       }),
                       "varying_inertia"));
  // A nonlinear sweep and a rigid planetary set refuse it by name and say what to take instead.
  const auto check_refusal = [](const std::string& said, const char* method) {
    INFO(said);
    CHECK(test::contains(said, "engine has an inertia that follows the angle (varying_inertia), which " +
                                   std::string(method) + " does not take; run it in steps"));
    CHECK(test::contains(said, "or with its mean inertia (varying_inertia = false)"));
  };
  check_refusal(message([&] { sweep_nonlinear(system, {.speeds = {100.0, 120.0}}); }), "a sweep");
  const auto with_planets = [](bool varying) {
    Model m("with planets");
    for (const char* node : {"crank", "ring", "carrier"}) m.add_node(node);
    m.add<Inertia>("J_crank", {"crank"}, {.inertia = 0.02});
    m.add<Inertia>("J_carrier", {"carrier"}, {.inertia = 0.3});
    m.add<Inertia>("J_ring", {"ring"}, {.inertia = 0.1});
    m.add<PlanetarySet>("planets", {"crank", "ring", "carrier"}, {.ratio = 2.0});
    EngineCylinders::Params engine = engine_of({0.0});
    engine.varying_inertia = varying;
    m.add<EngineCylinders>("engine", {"crank"}, engine);
    m.build();
  };
  check_refusal(message([&] { with_planets(true); }),
                "a train with a rigid planetary set, or a reduced one,");
  CHECK(message([&] { with_planets(false); }) == "");
  const PeriodicResponse periodic = solve_periodic(system, {});
  CHECK(test::contains(periodic.reason, "varying_inertia"));
  const ManyResult many = simulate_many(9, [](std::size_t) { return train(true, std::nullopt); },
                                        by("average_acceleration", 1e-4, 1e-3), {});
  CHECK(test::contains(many.why_not_lockstep, "inertia that follows the angle"));
  for (const VariantResult& variant : many.variants) CHECK(variant.error == "");
}

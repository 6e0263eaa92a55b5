// Where a run starts, and how long it takes to settle.
#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/start.hpp>

#include <cmath>
#include <complex>

#include "core/dense/eigenvalues.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

constexpr double kDiscInertia = 2.0, kShaftStiffness = 20000.0, kShaftDamping = 8.0, kMotorSpeed = 100.0;

/// A disc on a shaft from a node at constant speed, under a mean torque and order 0.5.
System disc_on_shaft(double damping = kShaftDamping, bool feedback = false) {
  Model m("disc");
  const NodeId motor = m.add_node("motor"), disc = m.add_node("disc");
  m.constant_speed(motor, kMotorSpeed);
  m.add<Inertia>("J", {disc}, {.inertia = kDiscInertia});
  m.add<ShaftSpring>("shaft", {motor, disc}, {.stiffness = kShaftStiffness, .damping = damping});
  m.add<EngineOrderTorque>(
      "load", {disc},
      {.harmonics = {{.order = 0.5, .amplitude = 20.0}}, .mean = 50.0, .twist_feedback = feedback});
  return m.build();
}

double largest_torque_of(const System& system, double from_rest_to) {
  Peaks peaks(find_channels(system, {"shaft.torque_Nm"}), true);
  REQUIRE(run_method(system, {.name = kExact, .tolerance = 1e-12}, {.t_end = from_rest_to}, {&peaks}).ok());
  return peaks.peaks()[0].amplitude();
}

}  // namespace

TEST_CASE("A run from the periodic steady state has the closed form's peak from its start on") {
  const System system = disc_on_shaft();
  const double w = 0.5 * kMotorSpeed;
  const double response = 20.0 / std::hypot(kShaftStiffness - kDiscInertia * w * w, kShaftDamping * w) *
                          std::hypot(kShaftStiffness, kShaftDamping * w);
  const FoundStart start = find_start(system, Start::periodic, {.duration = 1.0});
  CHECK(std::abs(start.cycle - 2.0 * kTwoPi / kMotorSpeed) < 1e-12);  // order 0.5 takes two turns
  CHECK(start.error < 1e-6);
  CHECK(std::abs(largest_torque_of(start.system, 1.0) - (50.0 + response)) < 1e-5 * response);
  CHECK(largest_torque_of(system, 1.0) > 1.2 * (50.0 + response));  // the start from rest
}

TEST_CASE(
    "A mode that grows is stated by a periodic start and by a sweep, with the rate of the cubic's root") {
  // J y'' = m, T m' + m = -(K_p y' + K_i y) + p: J T s^3 + J s^2 + K_p s + K_i = 0, which grows where K_p < T K_i (Routh).
  constexpr double inertia = 2.0, lag = 0.5, k_i = 100.0;
  for (const double k_p : {20.0, 80.0}) {
    Model m("governed disc");
    const NodeId disc = m.add_node("disc");
    m.set_reference("disc", constant_speed(kMotorSpeed));
    m.add<Inertia>("J", {disc}, {.inertia = inertia});
    m.add<SpeedGovernor>("governor", {disc},
                         {.proportional_gain = k_p, .integral_gain = k_i, .actuator_lag = lag});
    m.add<EngineOrderTorque>("load", {disc},
                             {.harmonics = {{.order = 1.0, .amplitude = 20.0}}, .twist_feedback = false});
    const System system = m.build();
    Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(3, 3);
    companion(1, 0) = companion(2, 1) = 1.0;
    companion.col(2) << -k_i / (inertia * lag), -k_p / (inertia * lag), -1.0 / lag;
    std::complex<double> root = -1e9;
    for (const std::complex<double> s : general_eigen(companion).values)
      if (s.real() > root.real()) root = s;
    CAPTURE(k_p, root);
    const FoundStart start = find_start(system, Start::periodic, {.duration = 1.0});
    const LinearSweep sweep =
        sweep_linear(system, {.speeds = {kMotorSpeed, 2.0 * kMotorSpeed}, .orders = {1.0}});
    const bool grows = k_p < lag * k_i;
    REQUIRE(grows == (root.real() > 0.0));
    CHECK(start.unsettled().empty() == !grows);
    CHECK(sweep.growth.rate == Approx(grows ? root.real() : 0.0).epsilon(1e-9));
    CHECK(sweep.growth.frequency_Hz == Approx(grows ? std::abs(root.imag()) / kTwoPi : 0.0).epsilon(1e-9));
    CHECK(start.growing == (grows ? sweep.growth.text() : ""));
  }
}

TEST_CASE("With loads that follow the twist, too, a periodic start repeats after its cycle") {
  const System system = disc_on_shaft(kShaftDamping, true);
  const FoundStart start = find_start(system, Start::periodic, {.duration = 1.0});
  Recorder recorder(start.system, {"disc.angle_rad", "disc.speed_rad_per_s"}, start.cycle);
  REQUIRE(run_method(start.system, {.name = kExact, .tolerance = 1e-12}, {.t_end = 5.0 * start.cycle},
                     {&recorder})
              .ok());
  for (const std::size_t c : {0UL, 1UL})
    for (const double x : recorder.samples(c)) CHECK(std::abs(x - recorder.samples(c)[0]) < 1e-6);
}

TEST_CASE("A static start is the equilibrium under the mean of the loads, moving with the nominal speed") {
  for (const bool feedback : {false, true}) {  // loads that follow the twist have the same mean
    const System system = disc_on_shaft(kShaftDamping, feedback);
    const FoundStart start = find_start(system, Start::static_equilibrium, {.duration = 1.0});
    CHECK(std::abs(start.system.initial_deviation()[0] - 50.0 / kShaftStiffness) < 1e-12);
    CHECK(start.system.initial_rate()[0] == 0.0);
  }

  // Drag of the nominal speed is part of it.
  Model m("dragged");
  const NodeId motor = m.add_node("motor"), disc = m.add_node("disc");
  m.constant_speed(motor, kMotorSpeed);
  m.add<Inertia>("J", {disc}, {.inertia = 1.0});
  m.add<ShaftSpring>("shaft", {motor, disc}, {.stiffness = 1000.0});
  m.add<Dashpot>("drag", {disc}, {.damping = 0.2});
  const FoundStart dragged = find_start(m.build(), Start::static_equilibrium, {.duration = 1.0});
  CHECK(std::abs(dragged.system.initial_deviation()[0] + 0.2 * kMotorSpeed / 1000.0) < 1e-12);

  // A torque in time that does not repeat in turns of the shaft has the mean of its own period.
  m.add<AppliedTorque>("mean", {disc}, {.torque = [](double) { return 7.0; }});
  m.add<AppliedTorque>("pulsation", {disc}, {.harmonics = {{kMotorSpeed / 10.0, 100.0, -0.5 * kPi}}});
  const FoundStart pulsating = find_start(m.build(), Start::static_equilibrium, {.duration = 1.0});
  CHECK(pulsating.system.initial_deviation()[0] == Approx((7.0 - 0.2 * kMotorSpeed) / 1000.0).epsilon(1e-12));
}

TEST_CASE("A static start of a run-up takes the speed and the acceleration that it starts with") {
  // k z = -J dw/dt - c w at t = 0, whatever the ramp does later.
  for (const double begins : {0.0, 0.5, 5.0}) {
    Model m("run-up");
    const NodeId motor = m.add_node("motor"), disc = m.add_node("disc");
    m.hold(motor);
    m.set_reference(motor, run_up(rpm(60.0), rpm(120.0), begins, begins + 1.0));
    m.add<Inertia>("J", {disc}, {.inertia = 1.0});
    m.add<ShaftSpring>("shaft", {motor, disc}, {.stiffness = 100.0});
    m.add<Dashpot>("drag", {disc}, {.damping = 0.5});
    const FoundStart start = find_start(m.build(), Start::static_equilibrium, {.duration = 1.0});
    const double acceleration = begins > 0.0 ? 0.0 : rpm(60.0);
    CHECK(start.system.initial_deviation()[0] ==
          Approx(-(acceleration + 0.5 * rpm(60.0)) / 100.0).epsilon(1e-10));
  }
}

TEST_CASE("A static start of a run-up from rest takes the acceleration that it starts with") {
  Model m("run-up from rest");
  const NodeId motor = m.add_node("motor"), disc = m.add_node("disc");
  m.hold(motor);
  m.set_reference(motor, run_up(0.0, 100.0, 0.0, 1.0));
  m.add<Inertia>("J", {disc}, {.inertia = 1.0});
  m.add<ShaftSpring>("shaft", {motor, disc}, {.stiffness = 1000.0});
  const FoundStart start = find_start(m.build(), Start::static_equilibrium, {.duration = 1.0});
  CHECK(start.system.initial_deviation()[0] == Approx(-0.1).epsilon(1e-10));  // -J alpha / k
}

TEST_CASE("A cycle is one of turns and times together, of gears that turn slower too") {
  // 10 Hz of the reference and 4 Hz in time repeat after 0.5 s; 0.3 turns of a gear after 1/3 s. Their means are 0.
  for (const bool in_time : {true, false}) {
    Model m("cycles");
    const NodeId motor = m.add_node("motor"), disc = m.add_node("disc"), slow = m.add_node("slow");
    m.constant_speed(motor, rpm(600.0));
    m.add<IdealGear>("gear", {motor, slow}, {.ratio = 0.3});
    m.add<ShaftSpring>("shaft", {in_time ? motor : slow, disc}, {.stiffness = 1000.0, .damping = 1.0});
    m.add<Inertia>("J", {disc}, {.inertia = 0.01});
    m.add<Inertia>("J_slow", {slow}, {.inertia = 0.01});
    m.add<EngineOrderTorque>("order", {disc}, {.harmonics = {{1.0, 10.0, 0.0}}, .twist_feedback = false});
    if (in_time) m.add<AppliedTorque>("time", {disc}, {.harmonics = {{4.0, 20.0, 0.0}}});
    const System system = m.build();
    const FoundStart found = find_start(system, Start::static_equilibrium, {.duration = 1.0});
    CAPTURE(in_time, found.how);
    CHECK(found.cycle == Approx(in_time ? 0.5 : 1.0 / 3.0).epsilon(1e-9));
    CHECK(found.system.initial_deviation().cwiseAbs().maxCoeff() < 1e-9);
    CHECK(find_start(system, Start::periodic, {.duration = 1.0}).cycle == Approx(found.cycle).epsilon(1e-9));
  }
}

TEST_CASE("A given motion has a period, which loads in time may share") {
  // J z'' + c z' + k z = k u, u = 0.1 cos(w t) at 1.5 Hz, beside a torque of 1 Hz: they repeat after 2 s.
  constexpr double inertia = 2.0, damping = 3.0, stiffness = 500.0, amplitude = 0.1, torque = 20.0;
  for (const bool loaded : {false, true}) {
    Model m("given");
    const NodeId base = m.add_node("base"), disc = m.add_node("disc");
    const double w = kTwoPi * 1.5;
    m.given_motion(base, {.at = [=](double t) -> MotionPoint {
                            const double c = amplitude * std::cos(w * t);
                            return {c, -w * amplitude * std::sin(w * t), -w * w * c};
                          },
                          .frequency = 1.5});
    m.add<Inertia>("J", {disc}, {.inertia = inertia});
    m.add<ShaftSpring>("shaft", {base, disc}, {.stiffness = stiffness});
    m.add<Dashpot>("c", {disc}, {.damping = damping});
    if (loaded) m.add<AppliedTorque>("torque", {disc}, {.harmonics = {{1.0, torque, 0.0}}});
    const FoundStart start = find_start(m.build(), Start::periodic, {.duration = 10.0});
    CHECK(start.cycle == Approx(loaded ? 2.0 : 1.0 / 1.5).epsilon(1e-9));
    const auto answer = [&](double force, double v) {
      return force / std::complex<double>(stiffness - inertia * v * v, damping * v);
    };
    const double expected =
        (answer(stiffness * amplitude, w) + (loaded ? answer(torque, kTwoPi) : 0.0)).real();
    CHECK(start.system.initial_deviation()[0] == Approx(expected).epsilon(1e-6));
  }
}

TEST_CASE("The period of torques in time is the one that their harmonics share") {
  Model m("timed");
  const NodeId disc = m.add_node("disc");
  m.add<Inertia>("J", {disc}, {.inertia = 1.0});
  m.add<GroundSpring>("spring", {disc}, {.stiffness = 1e4, .damping = 5.0});
  m.add<AppliedTorque>("load", {disc}, {.harmonics = {{15.0, 3.0, 0.1}, {25.0, 2.0, 0.0}}});
  CHECK(std::abs(find_start(m.build(), Start::periodic, {.duration = 1.0}).cycle - 0.2) < 1e-12);
}

TEST_CASE(
    "Where harmonic balance finds none, a run seeks the steady state, and says how far it is from one") {
  // A loose gear that a wheel of changing speed throws from flank to flank.
  Model m("rattle");
  const NodeId motor = m.add_node("motor"), wheel = m.add_node("wheel"), loose = m.add_node("loose");
  m.constant_speed(motor, kMotorSpeed);
  m.add<Inertia>("J", {wheel}, {.inertia = 0.5});
  m.add<ShaftSpring>("shaft", {motor, wheel}, {.stiffness = 5000.0, .damping = 10.0});
  m.add<Inertia>("J_loose", {loose}, {.inertia = 0.002});
  m.add<Dashpot>("drag", {loose}, {.damping = 0.002});
  m.add<GearMesh>("mesh", {wheel, loose},
                  {.base_radius_1 = 0.05,
                   .base_radius_2 = 0.05,
                   .stiffness = 5e7,
                   .normal_backlash = 2e-4,
                   .damping = 4000.0});
  m.add<EngineOrderTorque>("load", {wheel}, {.harmonics = {{.order = 2.0, .amplitude = 150.0}}});
  const System system = m.build();
  const Method method{.name = kExact, .tolerance = 1e-9};
  const FoundStart start = find_start(system, Start::periodic, {.duration = 1.0, .method = method});
  INFO(start.how);
  CHECK(start.by_run);
  // It rattles on from cycle to cycle: no steady state, and not called one.
  REQUIRE(start.error > kSettledPart);
  CHECK(start.how.find("did not settle on a periodic motion (it changes by") != std::string::npos);
  CHECK(start.unsettled().find("does not start in a periodic steady state") != std::string::npos);
  FoundStart settled = start;
  settled.error = 0.5 * kSettledPart;
  CHECK(settled.unsettled().empty());
  Recorder recorder(start.system, {"wheel.angle_rad"}, start.cycle);
  REQUIRE(run_method(start.system, method, {.t_end = 1.5 * start.cycle}, {&recorder}).ok());
  const std::vector<double>& x = recorder.samples(0);
  REQUIRE(x.size() == 2);
  // What is stated is the largest change of all, beside the largest deviation.
  CHECK(std::abs(x[1] - x[0]) < 2.0 * std::max(start.error, 1e-6) * 0.1);
}

TEST_CASE("Where there is no such state to start from, the reason is said") {
  const auto why = [](const Model& model, Start start) {
    try {
      find_start(model.build(), start, {.duration = 1.0});
    } catch (const SolverError& error) {
      return std::string(error.what());
    }
    return std::string("found");
  };
  Model free("free");
  const NodeId shaft = free.add_node("shaft");
  free.add<Inertia>("J", {shaft}, {.inertia = 1.0});
  free.add<EngineOrderTorque>("drive", {shaft}, {.harmonics = {{1.0, 1.0, 0.0}}, .mean = 1.0});
  free.set_reference(shaft, constant_speed(100.0));
  CHECK(why(free, Start::periodic).find("floats freely (with shaft)") != std::string::npos);
  CHECK(why(free, Start::static_equilibrium).find("no static equilibrium") != std::string::npos);

  Model up("up");
  const NodeId end = up.add_node("end"), disc = up.add_node("disc");
  up.set_reference(end, run_up(10.0, 100.0, 0.0, 1.0));
  up.hold(end);
  up.add<Inertia>("J", {disc}, {.inertia = 1.0});
  up.add<ShaftSpring>("shaft", {end, disc}, {.stiffness = 10.0});
  CHECK(why(up, Start::periodic).find("a run-up has no periodic steady state") != std::string::npos);
}

TEST_CASE("The settling time is that of the slowest decay, and infinite without damping") {
  const Settling damped = settling_time(disc_on_shaft());
  const double decay = kShaftDamping / (2.0 * kDiscInertia);
  const double square = kShaftStiffness / kDiscInertia;
  CHECK(std::abs(damped.time - std::log(1e3 / std::sqrt(1.0 - decay * decay / square)) / decay) < 1e-6);
  CHECK(damped.reason.find("15.9") != std::string::npos);  // Hz
  const Settling never = settling_time(disc_on_shaft(0.0));
  CHECK(std::isinf(never.time));
  CHECK(never.reason.find("is not damped") != std::string::npos);

  // A free drive: its own rotation against the drag is the slowest, 4 s.
  Model m("free");
  const NodeId a = m.add_node("a"), b = m.add_node("b");
  m.add<Inertia>("Ja", {a}, {.inertia = 1.0});
  m.add<Inertia>("Jb", {b}, {.inertia = 1.0});
  m.add<ShaftSpring>("shaft", {a, b}, {.stiffness = 1e4, .damping = 10.0});
  CHECK(settling_time(m.build()).time < 1.0);
  m.add<Dashpot>("drag", {b}, {.damping = 0.5});
  CHECK(std::abs(settling_time(m.build()).time / (4.0 * std::log(1e3)) - 1.0) < 1e-3);
}

TEST_CASE("A critically damped disc settles as (1 + w t) exp(-w t), one damped more as two of its decays") {
  const double w = 10.0;
  const auto time = [&](double ratio) {
    Model m("disc");
    m.add_node("wall");
    m.hold("wall");
    m.add_node("disc");
    m.add<Inertia>("J", {"disc"}, {.inertia = 1.0});
    m.add<ShaftSpring>("shaft", {"wall", "disc"}, {.stiffness = w * w, .damping = 2.0 * ratio * w});
    return settling_time(m.build()).time;
  };
  for (const double ratio : {1.0 - 1e-9, 1.0, 1.0 + 1e-9}) {
    const double wt = w * time(ratio);
    CHECK((1.0 + wt) * std::exp(-wt) == Approx(1e-3).epsilon(1e-3));
  }
  const double a = w * (1.2 - std::sqrt(0.44)), b = w * (1.2 + std::sqrt(0.44)), t = time(1.2);
  CHECK((b * std::exp(-a * t) - a * std::exp(-b * t)) / (b - a) == Approx(1e-3).epsilon(1e-6));
}

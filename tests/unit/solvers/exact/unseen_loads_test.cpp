// What loads do between the points at which exact propagation calls them: narrow curves and gates over the speed, smooth ones of
// small width, short circuits and pulses, kinks at rest, stops of a law that does not say where it kinks (solvers/exact/smooth_loads.hpp, core/law/ranged.hpp, elements/machines/speed_gate.cpp).
#include <drev/core/law_element.hpp>
#include <drev/core/model.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/applied_torque.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

namespace {

using Op = Formula::Op;

State after(const Model& model, double t, double tolerance, long most_steps) {
  const System s = model.build();
  State state = State::initial(s);
  const RunSummary summary = propagate(s, {.tolerance = tolerance, .t_end = t}, state);
  REQUIRE(summary.ok());
  CHECK(summary.steps < most_steps);
  return state;
}

/// A disc of 1 kg m^2 on a spring of 100 N m/rad, pushed off at `speed` rad/s.
Model pushed_off(double speed, double damping = 0.0) {
  Model m("disc on a spring");
  m.add_node("a");
  m.add<Inertia>("J", {"a"}, {.inertia = 1.0});
  m.add<GroundSpring>("spring", {"a"}, {.stiffness = 100.0, .damping = damping});
  m.set_initial("a", 0.0, speed);
  return m;
}

/// k (x - at) beyond `at`; its kink is not stated.
struct BareStop {
  double k, at;
  ScalarResponse operator()(const ScalarInput& in) const {
    const double in_it = std::max(0.0, in.x - at);
    return {.y = k * in_it, .dy_dx = in_it > 0.0 ? k : 0.0, .stored_energy = 0.5 * k * in_it * in_it};
  }
};

/// Two discs on a soft shaft, free; their momentum is what torques from outside gave them.
Model free_pair() {
  Model m("pair");
  for (const char* name : {"a", "b"}) {
    m.add_node(name);
    m.add<Inertia>(std::string("J_") + name, {name}, {.inertia = 1.0});
  }
  m.add<ShaftSpring>("shaft", {"a", "b"}, {.stiffness = 0.2});
  return m;
}

}  // namespace

TEST_CASE("A torque curve of 20 rad/s in a disc that swings by 200 rad/s, by every way to state it") {
  // 100 N m (1 - |w|/10 rad/s) within 10 rad/s. Matrix exponentials between the speeds -10, 0 and 10 rad/s, found by Brent's
  // method: x(1 s), v(1 s).
  const double x = -5.338660222096, v = -84.556908075578;
  Model curve = pushed_off(100.0), formula = pushed_off(100.0), gate = pushed_off(100.0),
        function = pushed_off(100.0);
  curve.add<TorqueCurve>("m", {"a"}, {.speeds = {-10.0, 0.0, 10.0}, .torques = {0.0, 100.0, 0.0}});
  // max(0, 100 - 10 |speed|)
  formula.add<TorqueFunction>("m", {"a"},
                              {.formula = Formula({{.op = Op::variable, .a = 1},
                                                   {.op = Op::abs, .a = 0},
                                                   {.op = Op::constant, .value = 10.0},
                                                   {.op = Op::multiply, .a = 1, .b = 2},
                                                   {.op = Op::constant, .value = 100.0},
                                                   {.op = Op::subtract, .a = 4, .b = 3},
                                                   {.op = Op::constant},
                                                   {.op = Op::larger, .a = 5, .b = 6}})});
  gate.add<TorqueCurve>("m", {"a"},
                        {.speeds = {-1000.0, 1000.0},
                         .torques = {100.0, 100.0},
                         .gate = {.from_speed = -10.0, .to_speed = 10.0, .speed_ramp = 10.0}});
  // Nobody knows how steep a function is: what is as wide as this one is seen halfway between the nodes.
  function.add<TorqueFunction>("m", {"a"}, {.torque = [](const TorqueVariables& at) -> Dual {
                                 const Dual torque = 100.0 - 10.0 * abs(at.speed);
                                 return torque > 0.0 ? torque : Dual(0.0);
                               }});
  for (const Model* m : {&curve, &formula, &gate, &function}) {
    INFO(m->element_instances().back().element->type());
    const State state = after(*m, 1.0, 1e-10, 2000);
    CHECK(state.z[0] == Approx(x).epsilon(2e-9));
    CHECK(state.v[0] == Approx(v).epsilon(2e-9));
  }
}

TEST_CASE("Gas pressure that follows the actual speed in a window of 2 % of its swing") {
  // z(0.1 s), v(0.1 s) by DOP853 of scipy at 3e-14 with steps of 3 us at most.
  EngineCylinders::Params engine{
      .bore = 0.1,
      .stroke = 0.1,
      .rod = 0.2,
      .firing_angles = {0.0},
      .gas = {.angle = {0.0, kPi, kTwoPi, 3.0 * kPi}, .pressure = {50e5, 40e5, 0.0, 0.0}}};
  const auto swing = [&](const GasPressure::Params& gas, double z, double v) {
    engine.gas = gas;
    Model m("throw on a spring");
    m.add_node("a");
    m.add<Inertia>("J", {"a"}, {.inertia = 1.0});
    m.add<GroundSpring>("spring", {"a"}, {.stiffness = 1e4});
    m.add<EngineCylinders>("engine", {"a"}, engine);
    m.set_initial("a", 0.0, 100.0);
    for (const double tolerance : {1e-8, 1e-10, 1e-12}) {
      INFO(tolerance);
      const State state = after(m, 0.1, tolerance, 3000);
      CHECK(state.z[0] == Approx(z).margin(std::max(10.0 * tolerance, 2e-11)));
      CHECK(state.v[0] == Approx(v).margin(100.0 * std::max(10.0 * tolerance, 2e-11)));
    }
  };
  GasPressure::Params by_peak = engine.gas, gated = engine.gas;
  by_peak.peak_speed = {rpm(490), rpm(500), rpm(520), rpm(530)},
  by_peak.peak_pressure = {0.0, 200e5, 200e5, 0.0};
  gated.firing = {.from_speed = rpm(500), .to_speed = rpm(530), .speed_ramp = rpm(10)};
  swing(by_peak, -0.225614556781, -97.4216645186);
  swing(gated, 0.154029082648, -99.0903849313);
}

TEST_CASE("Friction that falls with the speed, smooth and narrow, in a disc that swings far beyond it") {
  // -50 w exp(-(w/0.3)^2) beside 0.1 N m s/rad: x(10 s) by DOP853 and Radau of scipy at 1e-12 and 1e-10.
  Model m = pushed_off(20.0, 0.1);
  m.add<TorqueFunction>("brake", {"a"},
                        {.formula = Formula({{.op = Op::variable, .a = 1},
                                             {.op = Op::constant, .value = 1.0 / 0.3},
                                             {.op = Op::multiply, .a = 0, .b = 1},
                                             {.op = Op::power, .a = 2, .value = 2.0},
                                             {.op = Op::negate, .a = 3},
                                             {.op = Op::exp, .a = 4},
                                             {.op = Op::multiply, .a = 0, .b = 5},
                                             {.op = Op::constant, .value = -50.0},
                                             {.op = Op::multiply, .a = 6, .b = 7}})});
  CHECK(after(m, 10.0, 1e-10, 5000).z[0] == Approx(-0.616974694234).epsilon(1e-8));
}

TEST_CASE("A short circuit and a pulse of milliseconds give a train of slow modes their momentum") {
  Model circuit = free_pair(), pulse = free_pair();
  const double torque = 1000.0, decay = 0.01, omega = 2.0 * kPi * 50.0;
  circuit.add<Generator>("generator", {"a"},
                         {.fault_time = 0.5, .fault_torque = torque, .fault_decay = decay});
  const State shorted = after(circuit, 10.0, 1e-10, 2000);
  CHECK(shorted.v.sum() == Approx(-torque * omega / (omega * omega + 1.0 / (decay * decay))).epsilon(1e-8));

  // 1000 exp(-((t - 7)/0.001)^2): sqrt(pi) N m s
  pulse.add<TorqueFunction>("pulse", {"a"},
                            {.formula = Formula({{.op = Op::variable, .a = 2},
                                                 {.op = Op::constant, .value = 7.0},
                                                 {.op = Op::subtract, .a = 0, .b = 1},
                                                 {.op = Op::constant, .value = 1000.0},
                                                 {.op = Op::multiply, .a = 2, .b = 3},
                                                 {.op = Op::power, .a = 4, .value = 2.0},
                                                 {.op = Op::negate, .a = 5},
                                                 {.op = Op::exp, .a = 6},
                                                 {.op = Op::multiply, .a = 7, .b = 3}})});
  CHECK(after(pulse, 10.0, 1e-10, 2000).v.sum() == Approx(std::sqrt(kPi)).epsilon(1e-8));
}

TEST_CASE("A train that rests on a kink of its motor's curve, moved by next to nothing, takes few steps") {
  // Full torque up to 10 rad/s, none at 10.5: rounding of the speed changes it by 4e-13 N m, as much as moves the train.
  Model m("at rest on a kink");
  m.add_node("a");
  m.add_node("b");
  m.add<Inertia>("J_a", {"a"}, {.inertia = 1.0});
  m.add<Inertia>("J_b", {"b"}, {.inertia = 0.1});
  m.add<ShaftSpring>("shaft", {"a", "b"}, {.stiffness = 1000.0});
  m.set_reference("a", constant_speed(10.0));
  m.add<TorqueCurve>(
      "motor", {"b"},
      {.speeds = {0.0, 100.0}, .torques = {100.0, 100.0}, .gate = {.to_speed = 10.5, .speed_ramp = 0.5}});
  m.add<AppliedTorque>("load", {"b"}, {.torque = [](double) { return -100.0; }});
  m.add<AppliedTorque>("shake", {"b"}, {.harmonics = {{1.0, 1e-6, -0.5 * kPi}}});
  after(m, 0.2, 1e-10, 5000);
}

TEST_CASE("A fan that turns back beside large torques keeps its kink, which is no rounding") {
  // Speed of node 3 at 1.2 s: DOP853 of scipy, 2.33463400 rad/s, beside drev's Dormand-Prince steps to 2e-12.
  Model m("fan");
  for (const auto& [name, inertia] : {std::pair{"n0", 2.0}, {"n1", 1.0}, {"n2", 1.0}, {"n3", 0.5}}) {
    m.add_node(name);
    m.add<Inertia>(std::string("J_") + name, {name}, {.inertia = inertia});
  }
  m.set_initial("n0", 1.0, 0.0);
  m.set_initial("n3", 1.0, -1.0);
  m.add<DeadBandCoupling>(
      "gap", {"n0", "n1"},
      {.stiffness = 100.0, .gap = 0.1, .damping = 10.0, .damping_law = MeshDamping::always});
  m.add<PolylineSpring>("spring", {"n1", "n2"}, {.x = {-0.1, 0.0, 0.1, 0.2}, .y = {-10.0, 0.0, 10.0, 100.0}});
  m.add<Dashpot>("oil", {"n2", "n3"}, {.damping = 10.0});
  m.add<Dashpot>("drag", {"n0", "n3"}, {.damping = 1.0});
  m.add<AppliedTorque>("shake", {"n3"}, {.harmonics = {{10.0, 100.0, 0.5 * kPi}}});
  m.add<Propeller>("fan", {"n3"}, {.rated_torque = 10.0, .rated_speed = 10.0});
  for (const double tolerance : {1e-10, 1e-12}) {
    const State state = after(m, 1.2, tolerance, 2000);
    CHECK(state.v[3] == Approx(2.33463400).epsilon(5e-9));
  }
}

TEST_CASE("A stop of a law that does not say where it kinks is met wherever the disc just reaches it") {
  // x = 10 sin 10 t up to the stop at x_0 = 10 sin phi; in it about x_c with w^2 = 100 + k, and back with the same speed.
  const double t_end = 2.0;
  for (const double k : {1e2, 1e4, 1e6})
    for (const double at : {5.0, 9.0, 9.9, 9.99}) {
      INFO("stop of " << k << " N m/rad at " << at << " rad");
      const double phi = std::asin(0.1 * at), speed = 100.0 * std::cos(phi), w = std::sqrt(100.0 + k);
      const double deep = 100.0 * at / (w * w), in_it = 2.0 * std::atan2(speed / w, deep) / w;
      const double t = std::fmod(t_end, 0.1 * (kPi + 2.0 * phi) + in_it), since = t - 0.1 * phi;
      const double x = since < 0.0 ? 10.0 * std::sin(10.0 * t)
                       : since < in_it
                           ? at - deep + deep * std::cos(w * since) + speed / w * std::sin(w * since)
                           : 10.0 * std::sin(kPi - phi + 10.0 * (since - in_it));
      Model m = pushed_off(100.0);
      m.add<LawElement<BareStop>>("stop", {"a"}, {k, at});
      CHECK(after(m, t_end, 1e-10, 1000).z[0] == Approx(x).margin(2e-8));
    }
}

TEST_CASE("A torque curve whose point the speed passes there and back between two looks") {
  // n0 comes 0.06 rpm over 1000 rpm, where the curve is eight times as steep, within one step.
  Model m("motor");
  m.add_node("n0");
  m.add_node("n1");
  m.add<Inertia>("J0", {"n0"}, {.inertia = 0.1});
  m.add<Inertia>("J1", {"n1"}, {.inertia = 1.0});
  m.add<ShaftSpring>("shaft", {"n0", "n1"}, {.stiffness = 1e5});
  m.add<TorqueCurve>("motor", {"n0"},
                     {.speeds = {rpm(0.0), rpm(1000.0), rpm(1450.0), rpm(1500.0), rpm(1550.0)},
                      .torques = {120.0, 150.0, 260.0, 0.0, -260.0}});
  for (const double tolerance : {1e-8, 1e-9, 1e-10, 1e-11}) {
    INFO(tolerance);
    const State state = after(m, 0.85, tolerance, 2000);
    // SciPy's DOP853 at a relative tolerance of 1e-13, split at the curve's points.
    const double within = std::max(1e-11, 3.0 * tolerance);
    CHECK(state.v[0] == Approx(101.67484588194654).epsilon(within));
    CHECK(state.v[1] == Approx(104.0102512539543).epsilon(within));
  }
}

TEST_CASE("A motion between the ends of a step has its kinks where bounds of the series come to no end") {
  Model m("two cams");
  for (const char* node : {"n0", "n1", "n2"}) m.add_node(node);
  m.set_reference("n0", run_up(0.0, rpm(1500.0), 0.0, 1.0));
  m.set_initial("n1", 0.0, 100.0);
  m.add<Inertia>("J0", {"n0"}, {.inertia = 10.0});
  m.add<Inertia>("J1", {"n1"}, {.inertia = 10.0});
  m.add<Inertia>("J2", {"n2"}, {.inertia = 1.0});
  m.add<ShaftSpring>("shaft", {"n0", "n1"}, {.stiffness = 100.0, .damping = 1.0});
  m.add<PolylineSpring>("spring", {"n1", "n2"},
                        {.x = {deg(-6.0), deg(-1.0), 0.0, deg(1.0), deg(6.0)},
                         .y = {-500.0, -50.0, 0.0, 50.0, 500.0},
                         .damping = 1.0});
  const PeriodicTable table({0.0, deg(90.0), deg(180.0), deg(270.0)}, {0.0, 50.0, 0.0, -50.0}, kTwoPi);
  m.add<CamTorque>("smooth", {"n1"}, {.angle_table = table, .interpolation = Interpolation::cubic});
  m.add<CamTorque>("straight", {"n0"}, {.angle_table = table});
  const System s = m.build();
  State state = State::initial(s);
  Recorder recorder(s, {"n0.angle_rad", "n0.speed_rad_per_s", "n2.angle_rad"}, 0.575);
  REQUIRE(propagate(s, {.tolerance = 1e-10, .t_end = 0.6}, state, {&recorder}).ok());
  // SciPy's DOP853 at a relative tolerance of 1e-12 with steps of at most 2e-5 s.
  CHECK(recorder.samples(0)[1] == Approx(-4.558793587852484).epsilon(1e-10));
  CHECK(recorder.samples(1)[1] == Approx(-5.576400451949589).epsilon(1e-9));
  CHECK(recorder.samples(2)[1] == Approx(7.652795875354345).epsilon(1e-10));
}

TEST_CASE("A kink over the speed beside loads of time on the same node is not taken for rounding") {
  // Short circuits of two generators, and a motor that pulls no harder below zero speed, which the node passes again and again.
  Model m("short circuit");
  m.add_node("n0");
  m.add_node("n1");
  m.add<Inertia>("J0", {"n0"}, {.inertia = 1.0});
  m.add<Inertia>("J1", {"n1"}, {.inertia = 0.1});
  m.add<ShaftSpring>("shaft", {"n0", "n1"}, {.stiffness = 2865.0});
  for (const double torque : {100.0, 10.0})
    m.add<Generator>("generator_" + std::to_string(static_cast<int>(torque)), {"n0"},
                     {.torque = torque,
                      .synchronous_stiffness = 1000.0,
                      .fault_time = 0.5,
                      .fault_torque = 500.0,
                      .fault_torque_double = 200.0,
                      .fault_decay = 0.05});
  m.add<TorqueCurve>("motor", {"n0"},
                     {.speeds = {rpm(0.0), rpm(1000.0), rpm(1450.0), rpm(1500.0), rpm(1550.0)},
                      .torques = {120.0, 150.0, 260.0, 0.0, -260.0}});
  for (const double tolerance : {1e-10, 1e-12, 1e-13}) {
    INFO(tolerance);
    const State state = after(m, 1.0, tolerance, 5000);
    // SciPy's DOP853 at a relative tolerance of 1e-13, split where the speed is zero.
    CHECK(state.z[0] == Approx(-0.05530810797688894).epsilon(1e-9));
    CHECK(state.z[1] == Approx(-0.03309735453031989).epsilon(1e-9));
    CHECK(state.v[0] == Approx(2.0908210156322884).epsilon(1e-9));
    CHECK(state.v[1] == Approx(5.382868167441675).epsilon(1e-9));
  }
}

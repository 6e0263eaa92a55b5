/// Dampers, couplings, machines and gear sets against closed forms and separate programs (numpy, scipy), and the
/// published numbers that these reproduce:
///
/// - viscous damper: J. P. Den Hartog, Mechanical Vibrations, 1956 (optimum; .288 for equal inertias);
/// - tuned rubber damper with a loss factor: optimum f = 1/(1 + mu), eta = sqrt(mu (3 + mu)/2), peak
///   sqrt(2 (1 + 1/mu));
/// - hysteretic coupling between two inertias: closed form;
/// - marine shafting with propeller law: frequencies printed by a public program, damped modes by a separate one;
/// - planetary set: J. Lin, R. G. Parker, J. Vib. Acoust. 121 (1999) 316, in its purely torsional limit.
#include <drev/core/channel.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

namespace {

const SweepSection& find_section(const LinearSweep& sweep, const std::string& name) {
  for (const SweepSection& section : sweep.sections)
    if (section.name == name) return section;
  throw std::runtime_error("no section " + name);
}

double largest(const LinearSweep& sweep, const std::string& name) {
  for (const SweepPeak& peak : sweep.peaks)
    if (sweep.sections[std::size_t(peak.section)].name == name) return peak.half_range;
  throw std::runtime_error("no peak of " + name);
}

/// J = 2, K = 8e4 (w_n = 200 rad/s) on a clock, 100 N m of order 1, and a damper on it.
System damped_disc(const TorsionalDamper::Params& damper, double speed = 200.0) {
  Model m("disc with damper");
  m.add_node("clock"), m.add_node("disc");
  m.constant_speed("clock", speed);
  m.add<ShaftSpring>("shaft", {"clock", "disc"}, {.stiffness = 8e4});
  m.add<Inertia>("J", {"disc"}, {.inertia = 2.0});
  m.add<TorsionalDamper>("damper", {"disc"}, damper);
  m.add<EngineOrderTorque>("torque", {"disc"}, {.harmonics = {{1.0, 100.0, 0.0}}, .twist_feedback = false});
  return m.build();
}

}  // namespace

TEST_CASE("Viscous damper as an element: optimum, heat, relative angle", "[train_elements]") {
  const double mu = 0.25, zeta = 0.421637021;
  const System system = damped_disc({.ring_inertia = 0.5, .damping = 2.0 * 0.5 * 200.0 * zeta});
  const double worst = 200.0 * std::sqrt(2.0 / (2.0 + mu));
  const LinearSweep sweep = sweep_linear(system, {.speeds = {worst}, .orders = {1.0}});
  CHECK(find_section(sweep, "shaft.torque_Nm").half_range()[0] == Approx(900.0).epsilon(1e-9));
  CHECK(find_section(sweep, "damper.torque_Nm").twist_half_range[0] == Approx(8.38525492e-3).epsilon(1e-8));
  CHECK(find_section(sweep, "damper.torque_Nm").heat[0] == Approx(105.409255).epsilon(1e-8));
  // The ring turns with the hub from the start, and its channel is there in time.
  CHECK(system.ratio(system.node("damper_1")) == 1.0);
  CHECK(find_channel(system, "damper.deflection_rad").is_linear());
  CHECK(solve_modes(system, {.count = 1}).rigid_modes == 1);
}

TEST_CASE("Tuned rubber damper: optimum and a loss factor of 0.2", "[train_elements]") {
  for (const auto& [mu, best, at_02] : {std::tuple{0.05, 6.480740698, 7.555190429},
                                        {0.1, 4.690415760, 7.399066678},
                                        {0.2, 3.464101615, 8.008507906}})
    for (const bool optimal : {true, false}) {
      const double eta = optimal ? std::sqrt(mu * (3.0 + mu) / 2.0) : 0.2, expected = optimal ? best : at_02;
      TorsionalDamper::Params p{.ring_inertia = 2.0 * mu, .natural_frequency = 200.0 / kTwoPi / (1.0 + mu)};
      p.spring = {
          .loss_factor = eta, .lowest_frequency = 20, .highest_frequency = 50, .permitted_error = 0.3};
      const LinearSweep sweep = sweep_linear(
          damped_disc(p), {.speeds = {60.0, 100.0, 140.0, 180.0, 220.0, 300.0}, .orders = {1.0}});
      INFO(mu << " " << eta);
      CHECK(largest(sweep, "shaft.torque_Nm") / 100.0 == Approx(expected).epsilon(1e-8));
    }
}

namespace {

/// J 10 and 4 with a coupling between, 100 N m on the first, at an order of 2 of a shaft of its own speed.
LinearSweep two_masses(const ElasticCoupling::Params& coupling, double omega) {
  Model m("two masses");
  m.add_node("a"), m.add_node("b");
  m.add<Inertia>("J_a", {"a"}, {.inertia = 10.0});
  m.add<Inertia>("J_b", {"b"}, {.inertia = 4.0});
  m.add<ElasticCoupling>("coupling", {"a", "b"}, coupling);
  m.add<EngineOrderTorque>("torque", {"a"}, {.harmonics = {{2.0, 100.0, 0.4}}, .twist_feedback = false});
  m.set_reference("a", constant_speed(0.5 * omega));
  return sweep_linear(m.build(), {.speeds = {0.5 * omega}, .orders = {2.0}, .refine = false});
}

}  // namespace

TEST_CASE("Hysteretic coupling: exact at each frequency, and the chain in time within its stated error",
          "[train_elements]") {
  const ElasticCoupling::Params coupling{
      .material = {.stiffness = 2e5, .loss_factor = 0.1, .lowest_frequency = 30, .highest_frequency = 60}};
  const double natural = 264.575131;
  for (const auto& [factor, torque, twist, heat] : {std::tuple{0.8, 76.8510726, 3.82348377e-4, .309426503},
                                                    {1.0, 287.139303, 1.42857143e-3, 5.39949247},
                                                    {1.2, 63.6361293, 3.16601578e-4, .318241207}}) {
    const LinearSweep sweep = two_masses(coupling, factor * natural);
    const SweepSection& section = find_section(sweep, "coupling.torque_Nm");
    CHECK(std::abs(section.amplitude(0, 0)) == Approx(torque).epsilon(1e-8));
    CHECK(std::abs(section.twist(0, 0)) == Approx(twist).epsilon(1e-8));
    CHECK(section.heat[0] == Approx(heat).epsilon(1e-8));
    CHECK(sweep.input_power[0] == Approx(heat).epsilon(1e-8));
    CHECK(sweep.dissipated_power[0] == Approx(heat).epsilon(1e-8));
  }
  const ViscoelasticStiffness spring(coupling.material);
  CHECK(spring.fit_error() < 0.03);
  CHECK(spring.fit_error() > 0.01);  // k and eta constant is not causal: over an octave k grows by .0442 k
  double worst = 0.0;
  for (double f = 30.0; f <= 60.0; f += 0.1) {
    const double w = kTwoPi * f;
    worst = std::max(worst, std::abs(spring.chain(w) - spring.at(w)) / std::abs(spring.at(w)));
  }
  CHECK(worst == Approx(spring.fit_error()).epsilon(0.02));
}

TEST_CASE("Coupling with stiffness and loss factor over the frequency", "[train_elements]") {
  const ElasticCoupling::Params coupling{.material = {.frequencies = {0, 20, 40, 60},
                                                      .stiffnesses = {1.8e5, 2.0e5, 2.15e5, 2.25e5},
                                                      .loss_factors = {.08, .10, .13, .15},
                                                      .lowest_frequency = 20,
                                                      .highest_frequency = 60}};
  for (const auto& [hertz, torque, heat] : {std::tuple{30.0, 54.931876, .155558531},
                                            {40.0, 139.447078, 1.45296565},
                                            {45.0, 200.185988, 3.45350817},
                                            {50.0, 91.6949993, .824302673}}) {
    const LinearSweep sweep = two_masses(coupling, kTwoPi * hertz);
    const SweepSection& section = find_section(sweep, "coupling.torque_Nm");
    CHECK(std::abs(section.amplitude(0, 0)) == Approx(torque).epsilon(1e-8));
    CHECK(section.heat[0] == Approx(heat).epsilon(1e-8));
  }
  CHECK(ViscoelasticStiffness(coupling.material).fit_error() < 0.03);
}

TEST_CASE("The chain in time is the chain: a run settles on its complex stiffness", "[train_elements]") {
  const ViscoelasticStiffness::Params material{
      .stiffness = 2e5, .loss_factor = 0.2, .lowest_frequency = 25, .highest_frequency = 60};
  Model m("held coupling");
  m.add_node("wall"), m.add_node("disc");
  m.hold("wall");
  m.add<Inertia>("J", {"disc"}, {.inertia = 4.0});
  m.add<ElasticCoupling>("coupling", {"wall", "disc"}, {.material = material});
  m.add<AppliedTorque>("drive", {"disc"}, {.harmonics = {{40.0, 100.0, 0.0}}});
  const System system = m.build();
  const double w = kTwoPi * 40.0, period = 1.0 / 40.0;
  const std::complex<double> z = 100.0 / (ViscoelasticStiffness(material).chain(w) - 4.0 * w * w);
  Recorder recorder(system, {"disc.angle_rad"}, period / 8.0);
  const RunSummary run = propagate(system, {.tolerance = 1e-10, .t_end = 60 * period}, {&recorder});
  CHECK(run.ok());
  const std::vector<double>& samples = recorder.samples(0);
  const double t = 59.0 * period;  // an eighth later each
  for (int i = 0; i < 8; ++i) {
    const double expected = (z * std::polar(1.0, w * (t + i * period / 8.0))).real();
    CHECK(samples[59 * 8 + std::size_t(i)] == Approx(expected).margin(1e-6 * std::abs(z)));
  }
}

TEST_CASE("Marine shafting with the propeller element: damped modes at 66 rpm", "[train_elements]") {
  const std::vector<double> inertias{8730, 578, 4920, 4920,   4920,   4920,
                                     4920, 735, 8136, 82.095, 194.14, 21497};
  const std::vector<double> stiffnesses{18e6,   1.508e9, 1.344e9, 1.344e9,  1.344e9, 1.344e9,
                                        .892e9, .509e9,  .02e9,   62.058e9, 19.377e9};
  const double w_0 = rpm(99.0);
  const Propeller::Params law{.rated_torque = 6350e3 / w_0, .rated_speed = w_0};
  CHECK(law.rated_torque == Approx(612505.387).epsilon(1e-9));
  Model m("marine shafting");
  for (std::size_t i = 0; i < inertias.size(); ++i) {
    const std::string node = "n" + std::to_string(i), before = "n" + std::to_string(i - 1);
    m.add_node(node);
    m.add<Inertia>("J" + std::to_string(i), {node}, {.inertia = inertias[i]});
    if (i > 0)
      m.add<ShaftSpring>("k" + std::to_string(i), {before, node},
                         {.stiffness = stiffnesses[i - 1], .damping = i == 1 ? 2e5 : 0.0});
    if (i >= 2 && i <= 6) m.add<AbsoluteDamper>("c" + std::to_string(i), {node}, {.damping = 540.0});
  }
  m.add<Propeller>("propeller", {"n11"}, law);
  m.set_reference("n11", constant_speed(rpm(66.0)));
  const System system = m.build();
  const Vector damping = load_damping(system, rpm(66.0));
  CHECK(damping.sum() == Approx(78774.3515).epsilon(1e-9));
  const DampedModeSet damped = solve_damped_modes(system, {.damping = damping});
  const std::vector<std::complex<double>> expected{
      {-1.93311178, 34.86885142}, {-12.93576269, 50.66091318}, {-3.44630774, 195.69446473}};
  for (std::size_t i = 0; i < 3; ++i) CHECK(std::abs(damped.modes[i].lambda - expected[i]) < 1e-7);
  // An absolute damper does not brake the nominal motion, a dashpot does.
  CHECK(system.nominal_drag().cwiseAbs().maxCoeff() == 0.0);
}

TEST_CASE("Propeller law: run-up of a rigid line", "[train_elements]") {
  // J w' = T - k w^2: w = w_inf tanh(t sqrt(T k)/J)
  const double w_0 = rpm(99.0);
  Model m("rigid line");
  m.add_node("shaft");
  m.add<Inertia>("J", {"shaft"}, {.inertia = 3e4});
  m.add<AppliedTorque>("engine", {"shaft"}, {.table = TimeTable({0.0}, {4e5})});
  m.add<Propeller>("propeller", {"shaft"}, {.rated_torque = 6350e3 / w_0, .rated_speed = w_0});
  const System system = m.build();
  Recorder recorder(system, {"shaft.speed_rad_per_s"}, 1.0);
  CHECK(propagate(system, {.tolerance = 1e-11, .t_end = 5.0}, {&recorder}).ok());
  CHECK(recorder.samples(0)[1] == Approx(7.71087685).epsilon(2e-9));
  CHECK(recorder.samples(0)[5] == Approx(8.37796893).epsilon(2e-9));
}

TEST_CASE("Speed governor: load step on an inertia", "[train_elements]") {
  const auto speeds = [](const SpeedGovernor::Params& governor) {
    Model m("set");
    m.add_node("rotor");
    m.add<Inertia>("J", {"rotor"}, {.inertia = 120.0});
    m.add<SpeedGovernor>("governor", {"rotor"}, governor);
    m.add<AppliedTorque>("load", {"rotor"}, {.table = TimeTable({0.0}, {-900.0})});
    m.set_reference("rotor", constant_speed(rpm(1500.0)));
    const System system = m.build();
    Recorder recorder(system, {"rotor.speed_rad_per_s"}, kPi / 10.0);
    Recorder seconds(system, {"rotor.speed_rad_per_s"}, 1.0);
    CHECK(propagate(system, {.tolerance = 1e-12, .t_end = 2.0}, {&recorder, &seconds}).ok());
    return std::vector<double>{recorder.samples(0)[1], seconds.samples(0)[1], seconds.samples(0)[2]};
  };
  const std::vector<double> pi = speeds({.proportional_gain = 600.0, .integral_gain = 1500.0});
  CHECK(pi[0] == Approx(-.967190826).epsilon(2e-9));  // the largest dip, at pi/10 s
  CHECK(pi[1] == Approx(-.147376755).epsilon(5e-9));
  CHECK(pi[2] == Approx(.0193835428).epsilon(5e-9));
  // Droop of 4 % at 3769.911 N m and 1500 rpm: K_p = 600.
  const std::vector<double> droop =
      speeds({.droop = 0.04, .rated_torque = 600.0 * 0.04 * rpm(1500.0), .rated_speed = rpm(1500.0)});
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(droop[i] ==
          Approx(-1.5 * (1.0 - std::exp(-std::array{kPi / 10.0, 1.0, 2.0}[i] / 0.2))).epsilon(1e-10));
}

namespace {

/// Sun, ring, carrier and n planets of consistent geometry, meshes 5e8 N/m each.
Model elastic_planets(int planets, bool ring_fixed, double backlash = 0.0) {
  const double r_sun = .0387, r_planet = .05015, r_ring = .139;
  Model m("planetary train");
  for (const char* node : {"sun", "ring", "carrier"}) m.add_node(node);
  m.add<Inertia>("J_sun", {"sun"}, {.inertia = 5.840991e-4});
  m.add<Inertia>("J_ring", {"ring"}, {.inertia = .057963});
  m.add<Inertia>("J_carrier", {"carrier"}, {.inertia = .06806076006});
  for (int i = 1; i <= planets; ++i) {
    const std::string planet = "planet_" + std::to_string(i);
    m.add_node(planet);
    m.add<Inertia>("J_" + planet, {planet}, {.inertia = 1.534163725e-3});
    m.add<GearMesh>(
        "sun_" + planet, {"sun", planet, "carrier"},
        {.base_radius_1 = r_sun, .base_radius_2 = r_planet, .stiffness = 5e8, .normal_backlash = backlash});
    m.add<GearMesh>("ring_" + planet, {planet, "ring", "carrier"},
                    {.base_radius_1 = r_planet,
                     .base_radius_2 = r_ring,
                     .internal = true,
                     .stiffness = 5e8,
                     .normal_backlash = backlash});
  }
  if (ring_fixed) m.hold("ring");
  return m;
}

}  // namespace

TEST_CASE("Planetary train with elastic meshes: modes", "[train_elements]") {
  for (const auto& [fixed, expected] :
       {std::pair{true, std::vector<double>{4743.118, 6443.995287, 6443.995287, 11192.24}},
        std::pair{false, std::vector<double>{5898.155, 6443.995287, 6443.995287, 11208.94}}}) {
    const System system = elastic_planets(3, fixed).build();
    const ModeSet modes = solve_modes(system, {.count = 4});
    CHECK(modes.rigid_modes == (fixed ? 1 : 2));
    REQUIRE(modes.frequency_Hz.size() >= 4);
    for (std::size_t i = 0; i < 4; ++i) CHECK(modes.frequency_Hz[i] == Approx(expected[i]).epsilon(6e-7));
  }
}

TEST_CASE("Planetary train: nominal speeds follow from the ring that is held", "[train_elements]") {
  Model m = elastic_planets(3, true);
  m.set_reference("sun", constant_speed(100.0));
  const System system = m.build();
  const double i = .139 / .0387;
  CHECK(system.ratio(system.node("carrier")) == Approx(1.0 / (1.0 + i)).epsilon(1e-12));
  CHECK(system.ratio(system.node("ring")) == 0.0);
  // Planet: r_p n_p = -(r_ring - r_planet) n_c
  CHECK(system.ratio(system.node("planet_2")) == Approx(-.08885 / .05015 / (1.0 + i)).epsilon(1e-12));
  // Free on all sides it has two motions.
  Model free = elastic_planets(3, false);
  free.set_reference("sun", constant_speed(100.0));
  CHECK_THROWS_AS(free.build(), ModelError);
}

TEST_CASE("Planetary train with backlash in all meshes runs exactly", "[train_elements]") {
  Model m = elastic_planets(3, true, 50e-6);
  m.set_reference("sun", constant_speed(100.0));
  m.add<AppliedTorque>("drive", {"sun"}, {.harmonics = {{40.0, 5.0, 0.0}}});
  const System system = m.build();
  Recorder recorder(system, {"carrier.angle_rad", "sun_planet_1.force_N", "sun_planet_3.force_N"}, 1e-3);
  const RunSummary run = propagate(system, {.tolerance = 1e-10, .t_end = 0.03}, {&recorder});
  CHECK(run.ok());
  double loaded = 0.0;
  for (std::size_t i = 0; i < recorder.samples(1).size(); ++i) {
    // Planets are alike.
    CHECK(recorder.samples(1)[i] == Approx(recorder.samples(2)[i]).margin(1e-4));
    loaded = std::max(loaded, std::abs(recorder.samples(1)[i]));
  }
  CHECK(loaded > 1.0);
}

namespace {

/// Motor .1 - 2e4 - sun .02, ring .05, carrier .3 - 5e4 - load 2.
Model ideal_set(bool ring_fixed) {
  Model m("planetary set");
  for (const char* node : {"motor", "sun", "ring", "carrier", "load"}) m.add_node(node);
  m.add<Inertia>("J_motor", {"motor"}, {.inertia = .1});
  m.add<Inertia>("J_sun", {"sun"}, {.inertia = .02});
  m.add<Inertia>("J_ring", {"ring"}, {.inertia = .05});
  m.add<Inertia>("J_carrier", {"carrier"}, {.inertia = .3});
  m.add<Inertia>("J_load", {"load"}, {.inertia = 2.0});
  m.add<ShaftSpring>("input", {"motor", "sun"}, {.stiffness = 2e4});
  m.add<ShaftSpring>("output", {"carrier", "load"}, {.stiffness = 5e4});
  m.add<PlanetarySet>("set", {"sun", "ring", "carrier"}, {.ratio = 2.0});
  if (ring_fixed) m.hold("ring");
  return m;
}

}  // namespace

TEST_CASE("Ideal planetary set: modes, nominal speeds, accelerations", "[train_elements]") {
  for (const auto& [fixed, expected] :
       {std::pair{true, std::vector<double>{37.0412972, 128.314817}}, {false, {61.0675634, 151.045662}}}) {
    const ModeSet modes = solve_modes(ideal_set(fixed).build(), {.count = 2});
    CHECK(modes.rigid_modes == (fixed ? 1 : 2));
    for (std::size_t i = 0; i < 2; ++i) CHECK(modes.frequency_Hz[i] == Approx(expected[i]).epsilon(1e-8));
  }
  Model turning = ideal_set(true);
  turning.set_reference("motor", constant_speed(90.0));
  const System system = turning.build();
  CHECK(system.ratio(system.node("carrier")) == Approx(1.0 / 3.0).epsilon(1e-13));
  CHECK(system.ratio(system.node("load")) == Approx(1.0 / 3.0).epsilon(1e-13));

  // The set alone, 10 N m on its sun.
  Model alone("set alone");
  for (const auto& [node, inertia] : {std::pair{"sun", .02}, {"ring", .05}, {"carrier", .3}}) {
    alone.add_node(node);
    alone.add<Inertia>(std::string("J_") + node, {node}, {.inertia = inertia});
  }
  alone.add<PlanetarySet>("set", {"sun", "ring", "carrier"}, {.teeth_sun = 30, .teeth_ring = 60});
  alone.add<AppliedTorque>("torque", {"sun"}, {.table = TimeTable({0.0}, {10.0})});
  const System free = alone.build();
  Recorder recorder(free, {"sun.speed_rad_per_s", "ring.speed_rad_per_s", "carrier.speed_rad_per_s"}, 1.0);
  CHECK(propagate(free, {.t_end = 1.0}, {&recorder}).ok());
  CHECK(recorder.samples(0)[1] == Approx(343.75).epsilon(1e-10));
  CHECK(recorder.samples(1)[1] == Approx(-125.0).epsilon(1e-10));
  CHECK(recorder.samples(2)[1] == Approx(31.25).epsilon(1e-10));
}

TEST_CASE("Differential: modes free and with a wheel locked, straight ahead", "[train_elements]") {
  const auto differential = [](bool locked) {
    Model m("differential");
    for (const char* node : {"left", "right", "carrier", "wheel_left", "wheel_right"}) m.add_node(node);
    m.add<Inertia>("J_carrier", {"carrier"}, {.inertia = .05});
    for (const std::string side : {"left", "right"}) {
      m.add<Inertia>("J_" + side, {side}, {.inertia = .01});
      m.add<Inertia>("J_wheel_" + side, {"wheel_" + side}, {.inertia = 1.2});
      m.add<ShaftSpring>("axle_" + side, {side, "wheel_" + side}, {.stiffness = 4e3});
    }
    m.add<PlanetarySet>("differential", {"left", "right", "carrier"}, {.ratio = 1.0, .together = !locked});
    if (locked) m.hold("wheel_left");
    return m;
  };
  for (const auto& [locked, first, second] :
       {std::tuple{false, 54.5831960, 101.076964}, {true, 54.1928211, 100.869132}}) {
    const ModeSet modes = solve_modes(differential(locked).build(), {.count = 2});
    CHECK(modes.rigid_modes == (locked ? 1 : 2));
    CHECK(modes.frequency_Hz[0] == Approx(first).epsilon(1e-8));
    CHECK(modes.frequency_Hz[1] == Approx(second).epsilon(1e-8));
  }
  Model straight = differential(false);
  straight.set_reference("carrier", constant_speed(50.0));
  const System system = straight.build();
  CHECK(system.ratio(system.node("wheel_left")) == Approx(1.0).epsilon(1e-13));
  CHECK(system.ratio(system.node("wheel_right")) == Approx(1.0).epsilon(1e-13));
}

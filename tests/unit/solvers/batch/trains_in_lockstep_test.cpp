// Engine cylinders, dampers with a loss factor, planets, gears on bearings, couplings with play, modal damping: variants
// in lockstep (or one by one, where a model needs that) are single runs.
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/modal_damping.hpp>
#include <drev/solvers/batch/simulate_many.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <array>
#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

namespace {

/// Variants against single runs; returns why they were not made in lockstep.
std::string compare(const VariantBuilder& build, const TransientOptions& options, std::size_t count = 9) {
  const ManyResult many = simulate_many(count, build, options, {.threads = 1});
  REQUIRE(many.variants.size() == count);
  for (std::size_t i = 0; i < count; ++i) {
    CAPTURE(i);
    const VariantResult& v = many.variants[i];
    REQUIRE(v.error == "");
    CHECK(v.in_lockstep == many.why_not_lockstep.empty());
    const System system = build(i);
    State state = State::initial(system);
    const RunSummary single = simulate(system, options, state);
    CHECK(v.summary.status == single.status);
    CHECK(v.summary.steps == single.steps);
    CHECK((v.state.z - state.z).lpNorm<Eigen::Infinity>() < 1e-10 * state.z.lpNorm<Eigen::Infinity>());
    CHECK((v.state.v - state.v).lpNorm<Eigen::Infinity>() < 1e-10 * state.v.lpNorm<Eigen::Infinity>());
    CHECK(v.summary.energy.dissipated == Approx(single.energy.dissipated).epsilon(1e-8));
    // Variants differ.
    if (i > 0) CHECK((v.state.z - many.variants[0].state.z).norm() > 1e-6 * state.z.norm());
  }
  return many.why_not_lockstep;
}

/// Two cylinders, a damper on the free end, a flywheel.
System engine(const TorsionalDamper::Params& damper, double pressure) {
  Model m("engine");
  for (const char* node : {"throw_1", "throw_2", "flywheel"}) m.add_node(node);
  m.add<Inertia>("J_1", {"throw_1"}, {.inertia = 0.05});
  m.add<Inertia>("J_2", {"throw_2"}, {.inertia = 0.05});
  m.add<Inertia>("J", {"flywheel"}, {.inertia = 1.0});
  m.add<ShaftSpring>("web", {"throw_1", "throw_2"}, {.stiffness = 4e5, .damping = 20.0});
  m.add<ShaftSpring>("shaft", {"throw_2", "flywheel"}, {.stiffness = 5e5, .damping = 20.0});
  m.add<TorsionalDamper>("damper", {"throw_1"}, damper);
  m.add<EngineCylinders>(
      "engine", {"throw_1", "throw_2"},
      {.bore = 0.1,
       .stroke = 0.12,
       .rod = 0.2,
       .oscillating_mass = 2.0,
       .firing_angles = {0.0, kTwoPi},
       .gas = {.angle = {deg(0), deg(10), deg(30), deg(90), deg(180), deg(540), deg(690)},
               .pressure = {pressure, 1.2 * pressure, 0.4 * pressure, 5e5, 2e5, 1e5, 3e6}}});
  m.set_reference("flywheel", constant_speed(200.0));
  return m.build();
}

}  // namespace

TEST_CASE("Engines with each kind of damper in lockstep", "[batch]") {
  const TransientOptions options{.step = 2e-5, .t_end = 0.008};
  const auto pressure = [](std::size_t i) { return 5e6 + 3e5 * static_cast<double>(i); };
  CHECK(compare([&](std::size_t i) { return engine({.ring_inertia = 0.1, .damping = 60.0}, pressure(i)); },
                options) == "");
  CHECK(compare(
            [&](std::size_t i) {
              return engine({.ring_inertia = 0.05, .natural_frequency = 180.0, .damping_ratio = 0.2},
                            pressure(i));
            },
            options) == "");
  CHECK(compare(
            [&](std::size_t i) {
              return engine(
                  {.ring_inertia = 0.05,
                   .natural_frequency = 180.0,
                   .spring = {.loss_factor = 0.15, .lowest_frequency = 120, .highest_frequency = 240}},
                  pressure(i));
            },
            options) == "");
}

TEST_CASE("Planetary trains: elastic meshes in lockstep, a rigid set one by one", "[batch]") {
  const auto elastic = [](std::size_t i) {
    Model m("planets");
    for (const char* node : {"sun", "ring", "carrier"}) m.add_node(node);
    m.add<Inertia>("J_sun", {"sun"}, {.inertia = 5.8e-4});
    m.add<Inertia>("J_carrier", {"carrier"}, {.inertia = .068});
    for (int p = 1; p <= 3; ++p) {
      const std::string planet = "planet_" + std::to_string(p);
      m.add_node(planet);
      m.add<Inertia>("J_" + planet, {planet}, {.inertia = 1.5e-3});
      m.add<GearMesh>("sun_" + planet, {"sun", planet, "carrier"},
                      {.base_radius_1 = .0387,
                       .base_radius_2 = .05015,
                       .stiffness = 5e8,
                       .normal_backlash = 30e-6 + 2e-6 * static_cast<double>(i),
                       .damping = 500.0});
      m.add<GearMesh>("ring_" + planet, {planet, "ring", "carrier"},
                      {.base_radius_1 = .05015,
                       .base_radius_2 = .139,
                       .internal = true,
                       .stiffness = 5e8,
                       .normal_backlash = 50e-6,
                       .damping = 500.0});
    }
    m.hold("ring");
    m.add<AppliedTorque>("drive", {"sun"}, {.harmonics = {{400.0, 20.0, 0.0}}});
    return m.build();
  };
  CHECK(compare(elastic, {.step = 1e-6, .t_end = 5e-4}) == "");
  const auto rigid = [](std::size_t i) {
    Model m("set");
    for (const char* node : {"motor", "sun", "ring", "carrier"}) m.add_node(node);
    m.add<Inertia>("J_motor", {"motor"}, {.inertia = .1});
    m.add<Inertia>("J_sun", {"sun"}, {.inertia = .02});
    m.add<Inertia>("J_ring", {"ring"}, {.inertia = .05});
    m.add<Inertia>("J_carrier", {"carrier"}, {.inertia = .3});
    m.add<ShaftSpring>("input", {"motor", "sun"},
                       {.stiffness = 2e4 + 500.0 * static_cast<double>(i), .damping = 1.0});
    m.add<PlanetarySet>("set", {"sun", "ring", "carrier"}, {.ratio = 2.0});
    m.add<AppliedTorque>("torque", {"motor"}, {.table = TimeTable({0.0}, {10.0})});
    return m.build();
  };
  CHECK(compare(rigid, {.step = 1e-4, .t_end = 0.02}) != "");
}

TEST_CASE("Gears on bearings with backlash in lockstep", "[batch]") {
  const auto gears = [](std::size_t i) {
    const double part = static_cast<double>(i);
    Model m("gears on bearings");
    for (const char* n : {"1", "2"}) {
      const std::string gear = std::string("gear_") + n, centre = std::string("centre_") + n;
      m.add_node(gear);
      m.add_node(centre, NodeKind::translational);
      m.add<Inertia>("J_" + gear, {gear}, {.inertia = 0.01});
      m.add<Inertia>("m_" + centre, {centre}, {.inertia = 8.0});
      m.add<GroundSpring>("bearing_" + centre, {centre},
                          {.stiffness = 2e8 * (1.0 + 0.05 * part), .damping = 500.0});
    }
    m.add<LateralGearMesh>("mesh", {"gear_1", "gear_2", "centre_1", "centre_2"},
                           {.base_radius_1 = 0.05,
                            .base_radius_2 = 0.05,
                            .stiffness = 3e8,
                            .normal_backlash = 60e-6 + 2e-6 * part,
                            .damping = 2e3,
                            .damping_law = MeshDamping::limited});
    m.add<AppliedTorque>("swing", {"gear_2"}, {.harmonics = {{300.0, 200.0, 0.0}}});
    return m.build();
  };
  const TransientOptions options{.step = 1e-6, .t_end = 4e-3};
  CHECK(compare(gears, options) == "");
  const System one = gears(0);
  State state = State::initial(one);
  CHECK(propagate(one, {.t_end = options.t_end}, state).contact_changes > 3);  // the flanks part and meet
}

TEST_CASE("A coupling with play and a stop in lockstep", "[batch]") {
  const auto play = [](std::size_t i) {
    const double part = static_cast<double>(i);
    Model m("play");
    m.add_node("motor"), m.add_node("load");
    m.add<Inertia>("J_motor", {"motor"}, {.inertia = 0.02});
    m.add<Inertia>("J_load", {"load"}, {.inertia = 0.05});
    m.add<DeadBandCoupling>("spline", {"motor", "load"},
                            {.stiffness = 4e4, .gap = 0.004 + 1e-4 * part, .damping = 8.0});
    m.add<DeadBandCoupling>("stop", {"load"},
                            {.stiffness = 2e4,
                             .gap = 0.02,
                             .damping = 5.0,
                             .damping_law = MeshDamping::proportional,
                             .reference_penetration = 1e-3});
    m.add<AppliedTorque>("swing", {"motor"}, {.harmonics = {{40.0, 120.0, 0.0}}});
    return m.build();
  };
  const TransientOptions options{.step = 1e-5, .t_end = 0.06};
  CHECK(compare(play, options) == "");
  const System one = play(0);
  State state = State::initial(one);
  CHECK(propagate(one, {.t_end = options.t_end}, state).contact_changes > 5);
}

TEST_CASE("Trains with modal damping in lockstep", "[batch]") {
  const auto damped = [](std::size_t i) {
    Model m("modal damping");
    const std::array<double, 4> inertia{0.1, 0.05, 0.08, 0.4};
    for (std::size_t k = 0; k < inertia.size(); ++k) {
      const std::string node = "n" + std::to_string(k);
      m.add_node(node);
      m.add<Inertia>("J_" + node, {node}, {.inertia = inertia[k]});
      if (k > 0)
        m.add<ShaftSpring>("shaft_" + std::to_string(k), {"n" + std::to_string(k - 1), node},
                           {.stiffness = 2e4 * static_cast<double>(k)});
    }
    m.add<AppliedTorque>("swing", {"n0"}, {.harmonics = {{60.0, 50.0, 0.0}}});
    add_modal_damping(m, "modal", {.ratios = {0.02, 0.01 + 0.002 * static_cast<double>(i)}});
    return m.build();
  };
  CHECK(compare(damped, {.step = 2e-5, .t_end = 0.05}) == "");
}

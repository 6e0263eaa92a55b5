// Many variants in lockstep are single runs: same motion, peaks, contacts and energy, whatever the model.
// Covers solvers/batch/lockstep.hpp, lane_factor.hpp, lane_laws.hpp, lane_loads.hpp, lane_motion.hpp,
// lane_step.hpp and lane_watch.hpp through simulate_many().
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/batch/simulate_many.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <atomic>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/problems/general_elements.hpp"

using namespace drev;

namespace {

double part(std::size_t i) { return static_cast<double>(i); }

/// Largest difference of two vectors relative to the second's largest entry.
double apart(const Vector& a, const Vector& b) {
  return (a - b).lpNorm<Eigen::Infinity>() / b.lpNorm<Eigen::Infinity>();
}

/// Eleven variants (a whole block and a part of one) in lockstep against single runs; returns the result.
ManyResult check_same(const VariantBuilder& build, TransientOptions options, double tolerance,
                      const std::vector<std::string>& channels = {}) {
  constexpr std::size_t kCount = 11;
  options.energy_tolerance = 1.0;
  const ManyResult many = simulate_many(kCount, build, options, {.channels = channels, .threads = 2});
  CHECK(many.why_not_lockstep == "");
  REQUIRE(many.variants.size() == kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    CAPTURE(i);
    const VariantResult& v = many.variants[i];
    REQUIRE(v.error == "");
    const System system = build(i);
    Peaks peaks(find_channels(system, channels), false);
    ContactStatistics contacts(system, false);
    State state = State::initial(system);
    const RunSummary single = simulate(system, options, state, {&peaks, &contacts});
    CHECK(v.in_lockstep);
    CHECK(v.summary.status == single.status);
    CHECK(v.summary.steps == single.steps);
    CHECK(v.state.t == single.t_end);
    CHECK(apart(v.state.z, state.z) < tolerance);
    CHECK(apart(v.state.v, state.v) < tolerance);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const double size = peaks.peaks()[c].amplitude();
      CHECK(std::abs(v.peaks[c].max - peaks.peaks()[c].max) <= tolerance * size);
      CHECK(std::abs(v.peaks[c].min - peaks.peaks()[c].min) <= tolerance * size);
      CHECK(v.peaks[c].max_time == Approx(peaks.peaks()[c].max_time).margin(1e-12));
    }
    const EnergyBalance &a = v.summary.energy, &b = single.energy;
    const double joule = tolerance * b.scale;
    CHECK(std::abs(a.kinetic - b.kinetic) <= joule);
    CHECK(std::abs(a.stored - b.stored) <= joule);
    CHECK(std::abs(a.input - b.input) <= joule);
    CHECK(std::abs(a.dissipated - b.dissipated) <= joule);
    CHECK(std::abs(a.worst_imbalance - b.worst_imbalance) <= joule);
    REQUIRE(v.contacts.size() == contacts.records().size());
    for (std::size_t c = 0; c < v.contacts.size(); ++c) {
      const ContactRecord& expected = contacts.records()[c];
      CHECK(v.contacts[c].element == expected.element);
      CHECK(v.contacts[c].front_impacts == expected.front_impacts);
      CHECK(v.contacts[c].back_impacts == expected.back_impacts);
      CHECK(std::abs(v.contacts[c].time_separated - expected.time_separated) <= tolerance * single.t_end);
      CHECK(std::abs(v.contacts[c].largest_force - expected.largest_force) <=
            tolerance * std::max(1.0, expected.largest_force));
      CHECK(v.contacts[c].impact_energy == Approx(expected.impact_energy).epsilon(10 * tolerance));
      const auto same = [tolerance](const Distribution& a, const Distribution& b) {
        CHECK(a.count() == b.count());
        CHECK(a.mean() == Approx(b.mean()).epsilon(10 * tolerance));
        CHECK(a.largest() == Approx(b.largest()).epsilon(10 * tolerance));
        // A value on the edge of a bin may be on either side of it.
        CHECK(a.quantile(0.5) == Approx(b.quantile(0.5)).epsilon(0.045));
      };
      same(v.contacts[c].front_speed, expected.front_speed);
      same(v.contacts[c].back_speed, expected.back_speed);
      same(v.contacts[c].front_force, expected.front_force);
      same(v.contacts[c].back_force, expected.back_force);
    }
  }
  return many;
}

VariantBuilder camshafts(const std::string& drive, const std::string& loads = "actual",
                         const std::string& mesh_damping = "0", const std::string& mesh = "mean") {
  return [=](std::size_t i) {
    Parameters s("camshaft", camshaft_entry().parameters);
    s.set("drive", drive);
    s.set("loads", loads);
    s.set("cylinders", "6");
    s.set("engine_rpm", to_text(600.0 + 40.0 * part(i)));
    if (i % 3 == 1) s.set("firing_order", "1-4-2-6-3-5");
    if (i % 2 == 1) s.set("damping", "case_2");
    s.set("backlash_mm", to_text(0.1 + 0.01 * part(i)));
    s.set("mesh_stiffness_factor", to_text(0.5 + 0.1 * part(i)));
    s.set("mesh_damping_Ns_per_m", mesh_damping);
    s.set("mesh_stiffness", mesh);
    return build_camshaft(s).model.build();
  };
}

/// A gear pair under a load, with one variant of each number. loop: two shafts in parallel beside it.
Model gear_pair(std::size_t i, GearMesh::Params mesh, bool loop = false) {
  Model m("gear pair");
  for (const char* name : {"motor", "pinion", "wheel", "load"}) m.add_node(name);
  m.add<Inertia>("J_pinion", {"pinion"}, {.inertia = 0.002 + 1e-4 * part(i)});
  m.add<Inertia>("J_wheel", {"wheel"}, {.inertia = 0.02});
  m.add<Inertia>("J_load", {"load"}, {.inertia = 0.05});
  m.add<ShaftSpring>("input", {"motor", "pinion"}, {.stiffness = 8e3, .damping = 0.1});
  m.add<ShaftSpring>("output", {"wheel", "load"}, {.stiffness = 2e4 + 500.0 * part(i), .damping = 0.2});
  m.add<Dashpot>("friction", {"load"}, {.damping = 0.02 + 0.001 * part(i)});
  mesh.base_radius_1 = 0.03, mesh.base_radius_2 = 0.075;
  mesh.teeth_1 = 20, mesh.teeth_2 = 50;
  m.add<GearMesh>("mesh", {"pinion", "wheel"}, mesh);
  if (loop) {
    for (const char* name : {"side_1", "side_2", "side_3"}) {
      m.add_node(name);
      m.add<Inertia>(std::string("J_") + name, {name}, {.inertia = 0.01});
    }
    m.add<ShaftSpring>("a", {"wheel", "side_1"}, {.stiffness = 1e4});
    m.add<ShaftSpring>("b", {"side_1", "side_2"}, {.stiffness = 1.5e4 + 100.0 * part(i)});
    m.add<ShaftSpring>("c", {"side_2", "load"}, {.stiffness = 2e4});
    m.add<ShaftSpring>("d", {"side_3", "load"}, {.stiffness = 2e4});
    m.add<ShaftSpring>("e", {"side_1", "side_3"}, {.stiffness = 1e3});
  }
  return m;
}

AppliedTorque::Params pulses(std::size_t i) {
  return {.torque = [=](double t) { return -20.0 * std::sin(900.0 * t) - 2.0 * part(i); }};
}

}  // namespace

TEST_CASE("Lockstep: a camshaft that is held, by its actual and by its nominal angle") {
  for (const char* loads : {"actual", "source"})
    check_same(camshafts("held", loads), {.step = 2e-5, .t_end = 0.1}, 1e-11,
               {"inlet_6-fuel_1.twist_rad", "shaft_gear.torque_Nm", "end.speed_rad_per_s",
                "end.acceleration_rad_per_s2"});
}

TEST_CASE("Lockstep: a camshaft with gear drive, as long as its chaos allows") {
  // Differences grow like exp(39 t): 7 times over 0.05 s.
  const std::vector<std::string> channels{"shaft_gear.torque_Nm", "mesh_1.force_N", "mesh_2.deflection_m"};
  for (const char* damping : {"0", "2e4"})
    for (const char* mesh : {"mean", "fourier"})
      check_same(camshafts("gears", "actual", damping, mesh), {.step = 1e-5, .t_end = 0.05}, 1e-9, channels);
}

TEST_CASE("Lockstep: every law of mesh damping, transmission error, moved ends, loops") {
  const MeshDamping laws[] = {MeshDamping::proportional, MeshDamping::limited, MeshDamping::contact_only,
                              MeshDamping::always};
  for (const MeshDamping law : laws) {
    CAPTURE(static_cast<int>(law));
    const auto build = [law](std::size_t i) {
      Model m = gear_pair(i,
                          {.stiffness = 1e8,
                           .normal_backlash = 2e-5 + 2e-6 * part(i),
                           .damping = 400.0,
                           .damping_law = law,
                           .reference_penetration = 2e-6},
                          true);
      m.add<AppliedTorque>("torque", {"load"}, pulses(i));
      m.constant_speed("motor", 100.0);
      return m.build();
    };
    check_same(build, {.step = 1e-5, .t_end = 0.005}, 1e-8, {"mesh.force_N", "output.torque_Nm"});
  }
  const auto build = [](std::size_t i) {
    Model m = gear_pair(i, {.stiffness = MeshStiffness::fourier_of_step(8e7, 1.2e8, 1.6, 5),
                            .normal_backlash = 1e-5,
                            .transmission_error = std::vector<Harmonic>{{1.0, 2e-6, 0.1 * part(i)}}});
    m.add<EngineOrderTorque>("orders", {"load"}, {.harmonics = {{2.0, 10.0 + part(i), 0.0}}, .mean = -20.0});
    m.set_reference("motor", run_up(50.0, 80.0 + part(i), 0.005, 0.015));
    m.given_motion("motor", {.at = [](double t) {
                     return MotionPoint{1e-3 * std::sin(300.0 * t), 0.3 * std::cos(300.0 * t),
                                        -90.0 * std::sin(300.0 * t)};
                   }});
    return m.build();
  };
  check_same(build, {.step = 1e-5, .t_end = 0.01}, 1e-8, {"mesh.force_N", "motor.reaction_Nm"});
}

TEST_CASE("Lockstep: other methods of the family, and breakpoints that differ between variants") {
  for (const char* method :
       {"hht:0.1", "generalized_alpha:0.6", "newmark:0.3025,0.6", "linear_acceleration"}) {
    CAPTURE(method);
    const auto build = [](std::size_t i) {
      Model m = gear_pair(i, {.stiffness = 1e8, .normal_backlash = 2e-5});
      const double kink = i < 6 ? 0.003 : 0.0041 + 1e-4 * part(i % 2);
      m.add<AppliedTorque>("ramp", {"load"},
                           {.table = TimeTable({0.0, kink, 2 * kink}, {0.0, -30.0, -10.0})});
      m.constant_speed("motor", 100.0);
      return m.build();
    };
    check_same(build, {.scheme = step_scheme(method), .step = 1e-5, .t_end = 0.01}, 1e-9, {"mesh.force_N"});
  }
}

TEST_CASE(
    "Lockstep: chains of 2 to 7 inertias, whole and in parts, with gaps along and across, with a loop") {
  enum class Shape { whole, gap_along, gap_across, apart, loop };
  const auto check_chain = [](Shape shape, int n, bool same, const char* method) {  // same: all matrices
    CAPTURE(static_cast<int>(shape), n, same, method);
    const auto build = [=](std::size_t i) {
      const double varied = same ? 0.0 : part(i), damping = same ? 0.0 : 0.05;
      const PolylineSpring::Params gap = PolylineSpring::dead_band(5e3, 1e-4 * (1.0 + part(i)));
      Model m("chain");
      NodeId before{};
      for (int k = 0; k < n; ++k) {
        const std::string name = std::to_string(k);
        const NodeId node = m.add_node("n" + name);
        m.add<Inertia>("J" + name, {node}, {.inertia = 0.01 + 0.001 * k + 1e-4 * varied});
        const bool middle = k == n / 2;
        if (k == 0)
          m.add<Dashpot>("friction", {node}, {.damping = 0.3});
        else if (shape == Shape::gap_along && middle)
          m.add<PolylineSpring>("gap", {before, node}, gap);
        else if (!(shape == Shape::apart && middle))
          m.add<ShaftSpring>("k" + name, {before, node},
                             {.stiffness = 1e4 + 100.0 * varied, .damping = damping});
        before = node;
      }
      if (shape == Shape::gap_across) m.add<PolylineSpring>("gap", {"n0", "n3"}, gap);
      if (shape == Shape::loop) m.add<ShaftSpring>("loop", {"n0", "n2"}, {.stiffness = 3e3 + 10.0 * varied});
      m.add<AppliedTorque>("torque", {before}, pulses(i));
      m.add<AppliedTorque>("other torque", {"n0"}, pulses(i + 1));
      return m.build();
    };
    check_same(build, {.scheme = step_scheme(method), .step = 1e-4, .t_end = 0.05}, 1e-9, {"n0.angle_rad"});
  };
  for (const bool same : {true, false})
    for (int n = 2; n <= 7; ++n) {
      for (const Shape shape : {Shape::whole, Shape::gap_along, Shape::apart})
        check_chain(shape, n, same, "average_acceleration");
      if (n > 2) check_chain(Shape::loop, n, same, "average_acceleration");
      if (n > 3) check_chain(Shape::gap_across, n, same, "average_acceleration");
      if (n > 5) check_chain(Shape::gap_along, n, same, "hht:0.1");
    }
}

TEST_CASE("Lockstep: a backlash that begins at zero, where the mesh is a straight line") {
  const auto build = [](std::size_t i) {
    Model m =
        gear_pair(i, {.stiffness = 1e8, .normal_backlash = i % 4 ? 5e-6 * part(i) : 0.0, .damping = 400.0});
    m.add<AppliedTorque>("torque", {"load"}, pulses(i));
    m.constant_speed("motor", 100.0);
    return m.build();
  };
  CHECK(build(0).scalars().empty());
  CHECK(build(1).scalars().size() == 1);
  check_same(build, {.step = 1e-5, .t_end = 0.005}, 1e-8, {"mesh.force_N", "mesh.deflection_m"});
}

TEST_CASE("Lockstep: steps that one variant cannot make with the others it makes by itself") {
  // A damper that jumps where the flanks meet leaves steps without a root, which a single run halves.
  const auto build = [](std::size_t i) {
    Model m = gear_pair(i, {.stiffness = 1e8,
                            .normal_backlash = 2e-5,
                            .damping = i % 2 ? 4e4 : 0.0,
                            .damping_law = MeshDamping::contact_only});
    m.add<AppliedTorque>("torque", {"load"}, pulses(i));
    m.constant_speed("motor", 100.0);
    return m.build();
  };
  const ManyResult many = check_same(build, {.step = 2e-5, .t_end = 0.01}, 1e-7, {"mesh.force_N"});
  long alone = 0;
  for (std::size_t i = 0; i < many.variants.size(); ++i) {
    if (i % 2 == 0) CHECK(many.variants[i].steps_alone == 0);
    alone += many.variants[i].steps_alone;
  }
  CHECK(alone > 0);
}

TEST_CASE("Lockstep: a result does not depend on neighbours nor on the number of threads") {
  const VariantBuilder build = camshafts("gears", "actual", "2e4");
  const TransientOptions options{.step = 5e-5, .t_end = 0.5, .energy_tolerance = 1e3};
  const ManyResult all = simulate_many(20, build, options, {.threads = 3});
  for (const std::size_t i : {std::size_t{3}, std::size_t{12}}) {
    const ManyResult one = simulate_many(1, [&](std::size_t) { return build(i); }, options, {.threads = 1});
    CHECK(one.variants[0].state.z == all.variants[i].state.z);
    CHECK(one.variants[0].summary.energy.worst_imbalance == all.variants[i].summary.energy.worst_imbalance);
  }
}

TEST_CASE("Many: what lockstep does not cover runs one by one, the same way") {
  const VariantBuilder build = camshafts("held");
  const auto same = [&](const TransientOptions& options, const VariantBuilder& builder, const char* why) {
    const ManyResult many = simulate_many(3, builder, options, {.threads = 2});
    CHECK_THAT(many.why_not_lockstep, Catch::Contains(why));
    for (std::size_t i = 0; i < 3; ++i) {
      const System system = builder(i);
      State state = State::initial(system);
      simulate(system, options, state);
      CHECK_FALSE(many.variants[i].in_lockstep);
      CHECK(many.variants[i].state.z == state.z);
    }
  };
  same({.scheme = bathe(), .step = 1e-4, .t_end = 0.01}, build, "generalized-alpha");
  same({.tolerance = 1e-4, .t_end = 0.005}, build, "controlled");
  same({.step = 1e-4, .locate_contacts = true, .t_end = 0.01}, build, "located");
  const auto general = [](std::size_t i) {
    Model m("maxwell");
    m.add_node("disc");
    m.add<Inertia>("J", {"disc"}, {.inertia = 1.0 + part(i)});
    m.add<problems::Maxwell>("M", {"disc"}, {});
    m.set_initial("disc", 0.1, 0.0);
    return m.build();
  };
  same({.step = 1e-2, .t_end = 1.0}, general, "general elements");
  const ManyResult exact = propagate_many(3, camshafts("gears"), {.t_end = 0.01}, {.threads = 2});
  for (std::size_t i = 0; i < 3; ++i) {
    const System system = camshafts("gears")(i);
    State state = State::initial(system);
    const RunSummary run = propagate(system, {.t_end = 0.01}, state);
    CHECK(exact.variants[i].state.z == state.z);
    CHECK(exact.variants[i].summary.contact_changes == run.contact_changes);
  }
}

TEST_CASE("Many: another topology, a variant that cannot be built, bad options, the caller's stop") {
  const TransientOptions options{.step = 1e-4, .t_end = 0.01};
  const auto longer = [](std::size_t i) {
    Parameters s("camshaft", camshaft_entry().parameters);
    s.set("cylinders", i == 2 ? "7" : "6");
    return build_camshaft(s).model.build();
  };
  for (const bool lockstep : {true, false})
    CHECK_THROWS_WITH(simulate_many(4, longer, options, {.lockstep = lockstep}),
                      Catch::Contains("variant = 2") && Catch::Contains("nodes"));
  const auto stiffer = [](std::size_t i) {
    Model m = gear_pair(0, {.stiffness = 1e8, .normal_backlash = i == 1 ? -1.0 : 0.0});
    m.constant_speed("motor", 10.0);
    return m.build();
  };
  const ManyResult some = simulate_many(3, stiffer, options);
  CHECK(some.variants[0].ok());
  CHECK_THAT(some.variants[1].error, Catch::Contains("normal_backlash"));
  CHECK(some.variants[2].ok());
  CHECK_THROWS_AS(simulate_many(3, stiffer, options, {.stop_at_error = true}), ModelError);
  CHECK_THROWS_AS(simulate_many(3, stiffer, {.step = -1.0, .t_end = 1.0}), ModelError);
  CHECK_THROWS_WITH(simulate_many(3, stiffer, options, {.channels = {"mesh.forceN"}}),
                    Catch::Contains("mesh.force_N"));
  std::atomic<int> calls = 0;
  TransientOptions stopped = options;
  stopped.t_end = 10.0;
  stopped.progress = [&](double) { return ++calls < 3; };
  const ManyResult cut = simulate_many(40, camshafts("held"), stopped, {.threads = 2});
  CHECK(cut.interrupted);
  for (const VariantResult& v : cut.variants) CHECK(v.summary.status == RunStatus::interrupted);
}

TEST_CASE("Variants in lockstep carry the warnings of single runs: coarse steps, stiff twists, neither") {
  // Variant by variant: right; a vibration that the step does not follow; a shaft of which rounding leaves little.
  constexpr double kStiffness[] = {8.5e3, 4e5, 1e16};
  const auto build = [&](std::size_t i) {
    Model m("two inertias");
    for (const char* node : {"motor", "load"}) m.add_node(node);
    m.add<Inertia>("J_motor", {"motor"}, {.inertia = 0.012});
    m.add<Inertia>("J_load", {"load"}, {.inertia = 0.035});
    m.add<ShaftSpring>("shaft", {"motor", "load"}, {.stiffness = kStiffness[i % 3], .damping = 0.5});
    m.add<AppliedTorque>("drive", {"motor"}, {.harmonics = {{40.0, 20.0, 0.0}}});
    m.set_initial("motor", 1e-3, 0.0);
    if (i % 3 == 2) m.set_initial("load", 1e-3, 0.0);  // untwisted
    return m.build();
  };
  const TransientOptions options{.step = 2.5e-4, .t_end = 0.5, .energy_tolerance = 1.0};
  const ManyResult many = simulate_many(6, build, options, {.threads = 1});
  TransientOptions alone = options;
  alone.locate_contacts = true;  // keeps them from lockstep
  const ManyResult single = simulate_many(6, build, alone, {.threads = 1});
  for (std::size_t i = 0; i < 6; ++i) {
    CAPTURE(i);
    CHECK(many.variants[i].in_lockstep);
    CHECK_FALSE(single.variants[i].in_lockstep);
    const std::vector<std::string>& warnings = many.variants[i].summary.warnings;
    CHECK(warnings == single.variants[i].summary.warnings);
    if (i % 3 == 0) CHECK(warnings.empty());
    if (i % 3 == 1) {
      REQUIRE(warnings.size() == 1);
      CHECK(warnings[0].find("too long for the vibration") != std::string::npos);
    }
    if (i % 3 == 2) CHECK(warnings.back().find("shaft is so stiff") != std::string::npos);
  }
}

// LossyGear: efficiency by quadrant and self-locking, against closed forms and Modelica's results (cases G1 to G3).
// Covers solvers/exact/friction_gears.cpp through propagate().
#include <drev/core/assembler.hpp>
#include <drev/core/channel.hpp>
#include <drev/core/law/friction.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/statics.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/solvers/exact/friction_run.hpp"

using namespace drev;
using test::channel_at, test::FrictionRun;

namespace {

FrictionRun ran(const System& system, double t_end) { return test::ran_to(system, t_end, 1e-10); }

Model gear_train(double j_1, double j_2, LossyGear::Params gear) {
  Model m("lossy gear");
  m.add_node("a");
  m.add_node("b");
  m.add<Inertia>("J_a", {"a"}, {.inertia = j_1});
  m.add<Inertia>("J_b", {"b"}, {.inertia = j_2});
  m.add<LossyGear>("gear", {"a", "b"}, std::move(gear));
  return m;
}

void load(Model& m, const std::string& node, double torque) {
  m.add<AppliedTorque>("on " + node, {node}, {.table = TimeTable({0.0}, {torque})});
}

}  // namespace

TEST_CASE("Lossy gear: Demo1 of the Modelica Standard Library (case G1)") {
  Model m = gear_train(1.0, 1.5, {.ratio = 0.5, .efficiency_forward = 0.5, .efficiency_backward = 0.5});
  m.add<AppliedTorque>("sine", {"a"}, {.harmonics = {{1.0, 10.0, -kPi / 2.0}}});
  m.add<AppliedTorque>("ramp", {"b"}, {.table = TimeTable({0.0, 4.0}, {-10.0, 0.0})});
  const System system = m.build();
  const FrictionRun end = ran(system, 0.5);
  const std::vector<std::pair<double, std::string>> expected{{.0804771338559, "stuck"},
                                                             {.1995199008476, "sliding forward"},
                                                             {.3713427780495, "stuck"},
                                                             {.4645394616362, "sliding backward"}};
  REQUIRE(end.summary.friction_events.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CHECK(std::abs(end.summary.friction_events[i].t - expected[i].first) < 2e-12);
    CHECK(end.summary.friction_events[i].becomes == expected[i].second);
  }
  CHECK(std::abs(end.state.v[1] - -.0162619294) < 1e-10);
  CHECK(end.state.v[0] == Approx(2.0 * end.state.v[1]).epsilon(1e-14));
  CHECK(channel_at(system, end.state, "gear.heat_J") == Approx(.0185210833).epsilon(1e-8));
  const State at_004 = ran(system, 0.04).state, at_03 = ran(system, 0.3).state;
  CHECK(std::abs(at_004.v[1] - -.0208414939) < 1e-10);
  CHECK(std::abs(at_03.v[1] - .0131811951) < 1e-10);
  CHECK(std::abs(at_03.z[1] - -5.17318149e-4) < 1e-12);
  CHECK(channel_at(system, ran(system, 0.1).state, "gear.state") == 0.0);
}

TEST_CASE("Lossy gear: efficiency by quadrant (case G2)") {
  for (const bool first : {true, false}) {
    Model m = gear_train(1.0, 1.5, {.ratio = 0.5, .efficiency_forward = 0.5, .efficiency_backward = 0.5});
    load(m, first ? "a" : "b", 10.0);
    const System system = m.build();
    const FrictionRun r = ran(system, 0.5);
    const double a_b = first ? 10.0 / 3.5 : 10.0 / 9.5;
    CHECK(r.state.v[1] == Approx(0.5 * a_b).epsilon(1e-14));
    CHECK(channel_at(system, r.state, "gear.driving_shaft") == (first ? 1.0 : 2.0));
    const double in = channel_at(system, r.state, "gear.torque_in_Nm"),
                 out = channel_at(system, r.state, "gear.torque_out_Nm");
    CHECK(in == Approx((first ? 10.0 : 0.0) - 2.0 * a_b).epsilon(1e-13));
    CHECK(out == Approx(1.5 * a_b - (first ? 0.0 : 10.0)).epsilon(1e-13));
    CHECK((first ? out / (2.0 * in) : 2.0 * in / out) == Approx(0.5).epsilon(1e-13));
    CHECK(channel_at(system, r.state, "gear.loss_power_W") ==
          Approx(in * r.state.v[0] - out * r.state.v[1]).epsilon(1e-13));
  }
}

TEST_CASE("Lossy gear: which shaft drives is not obvious (Modelica's Demo3, case G3)") {
  Model m = gear_train(1e-3, 1e-3,
                       {.ratio = 1.0,
                        .efficiency_forward = 0.25,
                        .efficiency_backward = 0.25,
                        .bearing_torque_forward = 0.625,
                        .bearing_torque_backward = 2.5});
  m.set_initial("a", 0.0, 10.0);  // and with it b
  m.add<AppliedTorque>("step", {"a"}, {.table = TimeTable({0.5, 0.5}, {0.0, 1.0})});
  const System system = m.build();
  const FrictionRun r = ran(system, 2.0);
  REQUIRE(r.summary.friction_events.size() == 1);
  CHECK(r.summary.friction_events[0].t == Approx(0.02).epsilon(1e-13));
  CHECK(r.state.z[0] == Approx(0.1).epsilon(1e-13));
  CHECK(r.state.z[1] == Approx(0.1).epsilon(1e-13));
  CHECK(std::abs(r.state.v[0]) < 1e-15);
  CHECK(r.summary.steps < 20);
}

TEST_CASE("Lossy gear: a self-locking worm holds its load, and must be driven to lower it") {
  // Shaft 2 drives: tau_1 = -0.2 P, so that shaft 1 must add 2 N m to lower a load of 10 N m.
  const auto worm = [](double load_inertia) {
    Model m =
        gear_train(1.0, load_inertia, {.ratio = 1.0, .efficiency_forward = 0.5, .efficiency_backward = -0.2});
    load(m, "b", 10.0);
    m.add<AppliedTorque>("crank", {"a"}, {.table = TimeTable({0.0, 1.0}, {0.0, 10.0})});
    return m.build();
  };
  const System system = worm(1.0);
  const FrictionRun held = ran(system, 0.19);
  CHECK(held.summary.friction_changes == 0);
  CHECK(held.state.v.lpNorm<Eigen::Infinity>() == 0.0);
  CHECK(channel_at(system, held.state, "gear.loss_torque_Nm") == Approx(11.9).epsilon(1e-13));
  const FrictionRun lowered = ran(system, 0.5);
  REQUIRE(lowered.summary.friction_events.size() == 1);
  CHECK(lowered.summary.friction_events[0].t == Approx(0.2).epsilon(1e-13));
  CHECK(lowered.state.v[0] == Approx(5.0 * 0.3 * 0.3 / 0.8).epsilon(1e-12));  // (1 - 0.2) a = 10 t - 2
  CHECK(channel_at(system, lowered.state, "gear.driving_shaft") == 2.0);
  // 1 - 0.2 x 10 < 0: no acceleration fulfils it.
  CHECK_THROWS_WITH(propagate(worm(10.0), {.t_end = 0.5}), Catch::Contains("jams"));
}

TEST_CASE("Lossy gear: a worm before a heavy load stays at rest where it can, else moves as its lines ask") {
  // tau_1 = 2 P or -0.1 P, the lesser where it turns backwards. At rest between -0.1 and 2 N m for a load of 1 N m.
  const auto worm = [](double on_a) {
    Model m = gear_train(1.0, 100.0, {.ratio = 1.0, .efficiency_forward = 0.5, .efficiency_backward = -0.1});
    load(m, "a", on_a);
    load(m, "b", -1.0);
    return m.build();
  };
  const FrictionRun held = ran(worm(-0.05), 2.0);
  CHECK(held.state.v.lpNorm<Eigen::Infinity>() == 0.0);
  // P = 100 a + 1, a + 2 P = -0.11.
  const System system = worm(-0.11);
  const FrictionRun pushed = ran(system, 2.0);
  CHECK(pushed.state.v[0] == Approx(-2.11 / 201.0 * 2.0).epsilon(1e-12));
  CHECK(channel_at(system, pushed.state, "gear.torque_in_Nm") == Approx(2.0 - 200.0 * 2.11 / 201.0));
}

TEST_CASE("Lossy gear: efficiencies and bearing torques over the speed") {
  const auto train = [](const std::string& driven, LossyGear::Params gear) {
    Model m = gear_train(0.8, 1.5, std::move(gear));
    load(m, driven, 10.0);
    return m.build();
  };
  // eta = 1 - 0.005 w: (0.8 eta + 1.5) w' = 10 eta if shaft 1 drives, (0.8 + 1.5 eta) w' = 10 eta if shaft 2 does.
  LossyGear::Params eta{.ratio = 1.0,
                        .speeds = {0.0, 100.0},
                        .efficiencies_forward = {1.0, 0.5},
                        .efficiencies_backward = {1.0, 0.5}};
  for (const bool first : {true, false}) {
    const double w = ran(train(first ? "a" : "b", eta), 5.0).state.v[0];
    const double part = -std::log1p(-0.005 * w) / 0.005;  // int dw/eta
    CHECK((first ? 0.8 * w + 1.5 * part : 0.8 * part + 1.5 * w) == Approx(50.0).epsilon(1e-11));
  }
  // Bearing friction that grows with the speed: 2.3 w' = 10 - w/4, until it is constant from 20 rad/s on.
  LossyGear::Params bearing{.ratio = 1.0,
                            .speeds = {0.0, 20.0},
                            .efficiencies_forward = {1.0, 1.0},
                            .efficiencies_backward = {1.0, 1.0},
                            .bearing_torques_forward = {0.0, 5.0},
                            .bearing_torques_backward = {0.0, 5.0}};
  const System system = train("a", bearing);
  CHECK(ran(system, 5.0).state.v[0] == Approx(40.0 * (1.0 - std::exp(-0.25 * 5.0 / 2.3))).epsilon(1e-11));
  const double at_knot = 2.3 / 0.25 * std::log(2.0);
  CHECK(ran(system, 10.0).state.v[0] == Approx(20.0 + 5.0 / 2.3 * (10.0 - at_knot)).epsilon(1e-11));
}

TEST_CASE("Lossy gears, a brake and a bearing at rest let go together, at the torque of them all") {
  Model m("row");
  for (const char* n : {"a", "b", "c"}) {
    m.add_node(n);
    m.add<Inertia>(std::string("J_") + n, {n}, {.inertia = 1.0});
  }
  m.add<LossyGear>(
      "one", {"a", "b"},
      {.ratio = 0.5, .efficiency_forward = 0.8, .efficiency_backward = 0.7, .bearing_torque_forward = 1.0});
  m.add<LossyGear>("two", {"b", "c"}, {.ratio = 0.5, .efficiency_forward = 0.5, .efficiency_backward = 0.4});
  m.add<BearingFriction>("bearing", {"b"}, {.torque = 1.0});
  m.add<Brake>("brake", {"c"}, {.torque = 4.0});
  m.add<AppliedTorque>("load", {"a"}, {.table = TimeTable({0.0, 10.0}, {0.0, 40.0})});
  const System system = m.build();
  // c takes 4, two asks 2/0.5 = 4 at b, with the bearing 5, 2.5 referred to a; one asks (2.5 + 1)/0.8.
  const double torque = 3.5 / 0.8, t_0 = torque / 4.0;
  const FrictionRun r = ran(system, 2.0);
  REQUIRE(r.summary.friction_events.size() == 4);
  for (const FrictionEvent& e : r.summary.friction_events) CHECK(e.t == Approx(t_0).epsilon(1e-12));
  // From there on 4 (t - t_0) accelerates 1 + (0.5 + 0.25 * 0.5 / 0.5) 0.5 / 0.8.
  CHECK(r.state.v[0] == Approx(2.0 * (2.0 - t_0) * (2.0 - t_0) / (1.0 + 0.75 * 0.5 / 0.8)).epsilon(1e-12));
  CHECK(r.state.v[2] == Approx(0.25 * r.state.v[0]).epsilon(1e-14));
}

TEST_CASE("Lossy gear: modes see an ideal gear, other methods say why they do not take it") {
  Model m = gear_train(1.0, 1.5, {.ratio = 0.5, .efficiency_forward = 0.5, .efficiency_backward = 0.5});
  m.add<GroundSpring>("spring", {"b"}, {.stiffness = 300.0, .damping = 2.0});
  const System system = m.build();
  const double omega = std::sqrt(300.0 / (1.5 + 4.0));
  const ModeSet modes = solve_modes(system);
  REQUIRE(modes.count() == 1);
  CHECK(modes.omega(0) == Approx(omega).epsilon(1e-12));
  CHECK(modes.shapes(1, 0) == Approx(0.5 * modes.shapes(0, 0)).epsilon(1e-14));
  CHECK(modes.vectors.rows() == 2);
  const DampedModeSet damped = solve_damped_modes(system);
  REQUIRE(damped.modes.size() == 1);
  CHECK(damped.modes[0].lambda.real() == Approx(-2.0 / (2.0 * 5.5)).epsilon(1e-12));
  CHECK_THROWS_WITH(StaticSolver(system), Catch::Contains("does not take dry friction"));
  Model held = m;
  held.hold("a");
  CHECK_THROWS_WITH(propagate(held.build(), {.t_end = 1.0}), Catch::Contains("given motion of a"));
  Model loop = m;
  loop.add<LossyGear>("again", {"a", "b"},
                      {.ratio = 0.5, .efficiency_forward = 1.0, .efficiency_backward = 1.0});
  CHECK_THROWS_WITH(propagate(loop.build(), {.t_end = 1.0}), Catch::Contains("again closes a loop of gears"));
  Model differs = m;
  differs.set_initial("a", 0.0, 2.0);
  differs.set_initial("b", 0.0, 3.0);
  CHECK_THROWS_WITH(differs.build(), Catch::Contains("but that of a gives 1"));
  State state = State::initial(system);
  state.v << 1.0, 1.0;
  CHECK_THROWS_WITH(propagate(system, {.t_end = 1.0}, state), Catch::Contains("do not fit its ratio"));
}

TEST_CASE("Lossy gear: one that spins freely is driven from the touch behind a play on") {
  // The gear adds J_c/efficiency to J_b: x = q_a - q_b - gap/2 is a vibration of 1 and 3 kg m^2 about 10 N m.
  Model m = gear_train(1.0, 1.0, {.ratio = 1.0, .efficiency_forward = 0.5, .efficiency_backward = 0.5});
  m.add_node("motor");
  m.add<Inertia>("J", {"motor"}, {.inertia = 1.0});
  m.add<DeadBandCoupling>("play", {"motor", "a"}, {.stiffness = 100.0, .gap = 0.1});
  load(m, "motor", 10.0);
  for (const char* n : {"motor", "a", "b"}) m.set_initial(n, 0.0, 1.0);
  const System system = m.build();
  const FrictionRun r = ran(system, 0.2);  // the touch is at 0.1 s, at 2 and 1 rad/s
  const double w = std::sqrt(100.0 * 4.0 / 3.0),
               x = 0.075 * (1.0 - std::cos(0.1 * w)) + std::sin(0.1 * w) / w,
               x_dot = 0.075 * w * std::sin(0.1 * w) + std::cos(0.1 * w);
  const auto node = [&](const char* name, const char* what) {
    return channel_at(system, r.state, std::string(name) + what);
  };
  // v_motor + 3 v_a = 5 + 10 t and q_motor + 3 q_a = 0.45 + 5 t + 5 t^2 behind the touch.
  const double v_a = (6.0 - x_dot) / 4.0, q_a = (0.95 - x) / 4.0;
  CHECK(node("a", ".speed_rad_per_s") == Approx(v_a).epsilon(1e-12));
  CHECK(node("motor", ".speed_rad_per_s") == Approx(v_a + x_dot).epsilon(1e-12));
  CHECK(node("a", ".angle_rad") == Approx(q_a).epsilon(1e-12));
}

TEST_CASE("Lossy gear: how a torque goes on that is zero at the start tells which shaft drives") {
  // The torque brakes shaft 1, so that shaft 2 drives: (J_a + efficiency J_b) q'' = f(q), from scipy's DOP853.
  for (const bool touches : {false, true}) {
    Model m = gear_train(0.01, 10.0, {.ratio = 1.0, .efficiency_forward = 0.5, .efficiency_backward = 0.9});
    for (const char* n : {"a", "b"}) m.set_initial(n, 0.0, 10.0);
    m.add<TorqueFunction>("f", {"a"}, {.torque = [touches](const TorqueVariables& x) {
                            return touches ? cos(x.angle) - 1.0 : -sin(x.angle);
                          }});
    const FrictionRun r = ran(m.build(), 0.2);
    CHECK(r.state.z[0] == Approx(touches ? 1.99935209007772 : 1.99878952270416).epsilon(1e-11));
    CHECK(r.state.v[0] == Approx(touches ? 9.987897390788 : 9.98428236646743).epsilon(1e-11));
  }
}

TEST_CASE("Lossy gear: held at rest together with a brake, whatever follows the motion") {
  // Bearing torque and brake hold the same shaft: how they share a load below both is not determined.
  for (const double torque : {0.0, 1.0})
    for (const bool engages : {false, true})
      for (const bool called : {false, true}) {
        CAPTURE(torque, engages, called);
        Model m = gear_train(0.01, 10.0,
                             {.ratio = 0.5,
                              .efficiency_forward = 0.5,
                              .efficiency_backward = 1.0,
                              .bearing_torque_forward = 1.0});
        DryFriction::Params brake{.torque = 5.0};
        if (engages) brake.engagement = TimeTable({0.0, 0.2}, {torque == 0.0 ? 0.0 : 0.5, 1.0});
        m.add<Brake>("brake", {"a"}, brake);
        if (called)
          m.add<TorqueFunction>("drag", {"b"}, {.torque = [torque](const TorqueVariables& x) {
                                  return torque - 0.1 * x.speed * abs(x.speed);
                                }});
        else
          load(m, "b", torque);
        const FrictionRun r = ran(m.build(), 0.2);
        CHECK(r.summary.steps <= 200);
        CHECK(r.summary.friction_changes == 0);
        CHECK(r.state.v.lpNorm<Eigen::Infinity>() < 1e-13);
      }
}

TEST_CASE("Lossy gear: a self-locking worm rests beside friction, whichever way its load turns") {
  // Friction holds the wheel: it could press the worm harder than the load does, and then there were no way on.
  struct Case {
    double j_1, j_2, friction;
    bool both;
    LossyGear::Params gear;
    TimeTable load;
    double on_wheel;
  };
  const LossyGear::Params hoist{.ratio = 0.05, .efficiency_forward = 0.61, .efficiency_backward = -0.1},
      even{.ratio = 1.0, .efficiency_forward = 0.8, .efficiency_backward = 0.0};
  for (const Case& c : {Case{0.0137, 0.83, 7.3, false, hoist, TimeTable({0.0, 1.0}, {0.17, -0.21}), 0.0},
                        Case{1.0, 1.0, 2.0, false, even, TimeTable({0.0, 1.0, 2.0}, {1.0, -1.0, 1.0}), -1.0},
                        Case{1.0, 1.0, 1.0, true, even, TimeTable({0.0, 1.0}, {0.0, 1.5}), 0.0},
                        Case{1.0, 1.0, 1.0, true, even, TimeTable({0.0, 1.0}, {0.0, -1.5}), 0.0}}) {
    CAPTURE(c.j_1, c.both, c.on_wheel, c.load.values().back());
    Model m = gear_train(c.j_1, c.j_2, c.gear);
    m.add<BearingFriction>("friction", {"b"}, {.torque = c.friction});
    if (c.both) m.add<BearingFriction>("on worm", {"a"}, {.torque = c.friction});
    m.add<AppliedTorque>("load", {"a"}, {.table = c.load});
    if (c.on_wheel != 0.0) load(m, "b", c.on_wheel);
    const System system = m.build();
    const FrictionRun r = ran(system, c.load.times().back());
    CHECK(r.state.v.lpNorm<Eigen::Infinity>() < 1e-13);
    // Held by what the gear passes on and the friction: each within what it can do.
    const double in = channel_at(system, r.state, "gear.torque_in_Nm"),
                 out = channel_at(system, r.state, "gear.torque_out_Nm"),
                 held = channel_at(system, r.state, "friction.torque_Nm"),
                 worm = c.both ? channel_at(system, r.state, "on worm.torque_Nm") : 0.0;
    const auto balances = [](double a, double b) { return std::abs(a - b) < 1e-11; };
    CHECK(balances(in + worm, c.load.values().back()));
    CHECK(balances(std::abs(held - c.on_wheel), std::abs(out)));
    CHECK(std::abs(held) <= c.friction * (1.0 + 1e-12));
    CHECK(std::abs(worm) <= c.friction * (1.0 + 1e-12));
    const double passed = std::abs(out) * c.gear.ratio;
    if (in * out > 0.0) CHECK(passed <= std::abs(in) * (1.0 + 1e-9));
  }
}

TEST_CASE("Lossy gear: one that jams ends the run with its name and the time, and what there is of the run") {
  // |eta_b| r^2 J_2 = 2 > J_1: where the wheel brakes, nothing fits. It turns until the load on it changes its sign.
  Model m = gear_train(1.0, 20.0, {.ratio = 1.0, .efficiency_forward = 0.8, .efficiency_backward = -0.1});
  m.add<AppliedTorque>("load", {"a"}, {.table = TimeTable({0.0, 1.0}, {1.0, -1.0})});
  try {
    propagate(m.build(), {.tolerance = 1e-10, .t_end = 1.0});
    FAIL("it did not jam");
  } catch (const RunError& error) {
    CAPTURE(error.what());
    CHECK(std::string(error.what()).find("lossy gear: at t = 0.5 s: gear: ") == 0);
    CHECK(error.summary.t_end == Approx(0.5));
    CHECK(error.summary.steps > 0);
    CHECK(error.summary.energy.input > 0.0);
  }
}

TEST_CASE("Lossy gear: between events it costs what an ideal gear does") {
  const auto train = [](bool lossy, double brake) {
    Model m("cost");
    for (const char* n : {"motor", "a", "b", "load"}) {
      m.add_node(n);
      m.add<Inertia>(std::string("J_") + n, {n}, {.inertia = 1.0});
    }
    m.add<ShaftSpring>("in", {"motor", "a"}, {.stiffness = 500.0});
    m.add<ShaftSpring>("out", {"b", "load"}, {.stiffness = 500.0});
    if (lossy)
      m.add<LossyGear>("gear", {"a", "b"},
                       {.ratio = 1.0,
                        .efficiency_forward = 0.9,
                        .efficiency_backward = 0.9,
                        .bearing_torque_forward = brake,
                        .bearing_torque_backward = brake});
    else
      m.add<IdealGear>("gear", {"a", "b"}, {.ratio = 1.0});
    m.set_initial("motor", 0.0, 1.0);
    return m.build();
  };
  const FrictionRun ideal = ran(train(false, 0.0), 5.0), stuck = ran(train(true, 1e3), 5.0);
  CHECK(stuck.summary.friction_changes == 0);
  CHECK(stuck.state.z[0] == Approx(std::sin(5.0 * std::sqrt(500.0)) / std::sqrt(500.0)).epsilon(1e-11));
  CHECK(stuck.summary.steps <= ideal.summary.steps + ideal.summary.steps / 10);
  CHECK(stuck.summary.solves <= ideal.summary.solves + ideal.summary.solves / 10);
}

TEST_CASE("ElasticBearing of the Modelica Standard Library: a gear's reaction on its housing (case G4)") {
  // shaft = 3 gear - 2 housing: a planetary set with the gear as carrier.
  Model m("elastic bearing");
  for (const char* n : {"shaft", "gear", "housing", "load"}) m.add_node(n);
  m.add<Inertia>("J_shaft", {"shaft"}, {.inertia = 1.0});
  m.add<Inertia>("J_gear", {"gear"}, {.inertia = 1e-13});
  m.add<Inertia>("J_housing", {"housing"}, {.inertia = 5.0});
  m.add<Inertia>("J_load", {"load"}, {.inertia = 50.0});
  m.add<PlanetarySet>("gears", {"shaft", "housing", "gear"}, {.ratio = 2.0});
  m.add<GroundSpring>("bearing", {"housing"}, {.stiffness = 1e5, .damping = 5.0});
  m.add<ShaftSpring>("spring", {"gear", "load"}, {.stiffness = 1e3});
  m.add<AppliedTorque>("drive", {"shaft"}, {.table = TimeTable({0.0, 5.0}, {0.0, 100.0})});
  const System system = m.build();
  Recorder recorder(system, {"shaft.speed_rad_per_s", "load.speed_rad_per_s", "housing.angle_rad"}, 1.0);
  CHECK(propagate(system, {.tolerance = 1e-13, .t_end = 10.0}, {&recorder}).ok());
  const double expected[3][4] = {{1, 1.6012282949, .5039263023, -3.661246112e-4},
                                 {5, 38.1565224917, 12.7106086505, -1.678656690e-3},
                                 {10, 114.4628016794, 38.1322318992, -1.683894281e-3}};
  for (const auto& row : expected)
    for (std::size_t c = 0; c < 3; ++c)
      CHECK(std::abs(recorder.samples(c)[static_cast<std::size_t>(row[0])] - row[c + 1]) <
            1e-10 + (c == 2 ? 1e-12 : 0.0));
}

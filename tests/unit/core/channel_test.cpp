// Every kind of channel: value, sign and unit, against hand computation.
#include <drev/core/assembler.hpp>
#include <drev/core/channel.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/statics.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/problems/findings.hpp"
#include "tests/problems/general_elements.hpp"

using namespace drev;

namespace {

void disc(Model& m, const char* name, double inertia, NodeKind kind = NodeKind::rotational) {
  m.add_node(name, kind);
  m.add<Inertia>(std::string("J_") + name, {name}, {.inertia = inertia});
}

double value(const System& s, const Assembler& a, const State& state, const std::string& name) {
  return find_channel(s, name).evaluate(a, state);
}

State state_of(const System& s, std::initializer_list<double> z, std::initializer_list<double> v,
               std::initializer_list<double> a) {
  State state = State::initial(s);
  std::copy(z.begin(), z.end(), state.z.begin());
  std::copy(v.begin(), v.end(), state.v.begin());
  std::copy(a.begin(), a.end(), state.a.begin());
  return state;
}

}  // namespace

TEST_CASE("Channels of nodes, shafts, springs, dashpots and loads") {
  Model m("all");
  disc(m, "a", 1.0);
  disc(m, "b", 2.0);
  disc(m, "slide", 3.0, NodeKind::translational);
  m.add<ShaftSpring>("shaft", {"a", "b"}, {.stiffness = 100.0, .damping = 2.0});
  m.add<Dashpot>("brake", {"b"}, {.damping = 0.5});
  m.add<GroundSpring>("buffer", {"slide"}, {.stiffness = 10.0, .damping = 1.0});
  m.add<PolylineSpring>("stop", {"a", "b"}, PolylineSpring::dead_band(1000.0, 0.1));
  m.add<AppliedTorque>("drive", {"a"}, {.torque = [](double t) { return 7.0 * t; }});
  m.add<AppliedTorque>("push", {"slide"}, {.torque = [](double) { return -3.0; }});
  m.add<RayleighDamping>("rayleigh", {}, {.alpha_mass = 1.0, .beta_stiffness = 1.0});
  const System s = m.build();
  Assembler a(s);
  a.set_time(2.0);
  const State state = state_of(s, {0.1, 0.4, 0.02}, {1.0, -2.0, 0.3}, {5.0, 6.0, 7.0});
  const auto get = [&](const char* name) { return value(s, a, state, name); };
  CHECK(get("a.angle_rad") == 0.1);
  CHECK(get("b.speed_rad_per_s") == -2.0);
  CHECK(get("b.acceleration_rad_per_s2") == 6.0);
  CHECK(get("slide.position_m") == 0.02);
  CHECK(get("slide.velocity_m_per_s") == 0.3);
  CHECK(get("slide.acceleration_m_per_s2") == 7.0);
  CHECK(get("a-b.twist_rad") == Approx(-0.3));
  CHECK(get("b-a.twist_rad") == Approx(0.3));
  // End b minus end a, without Rayleigh damping.
  CHECK(get("shaft.torque_Nm") == Approx(100 * 0.3 + 2 * -3.0));
  CHECK(get("brake.torque_Nm") == Approx(0.5 * -2.0));
  CHECK(get("buffer.force_N") == Approx(10 * 0.02 + 0.3));
  CHECK(get("stop.torque_Nm") == Approx(1000 * 0.2));
  CHECK(get("stop.deflection_rad") == Approx(0.3));
  CHECK(get("drive.torque_Nm") == Approx(14.0));
  CHECK(get("push.force_N") == Approx(-3.0));
  CHECK(find_channel(s, "shaft.torque_Nm").unit() == "N m");
  CHECK(find_channel(s, "buffer.force_N").unit() == "N");
  CHECK(find_channel(s, "a-b.twist_rad").unit() == "rad");
  CHECK(find_channel(s, "a.acceleration_rad_per_s2").unit() == "rad/s^2");
  CHECK(find_channel(s, "slide.velocity_m_per_s").unit() == "m/s");
  // Every listed channel is found by its name.
  for (const Channel& c : all_channels(s)) CHECK(find_channel(s, c.name()).unit() == c.unit());
  CHECK(all_channels(s).size() == 3 * 3 + 3 + 2 + 2);
}

TEST_CASE("A mesh's force is positive on the front flank") {
  Model m("pair");
  disc(m, "pinion", 1.0);
  disc(m, "wheel", 1.0);
  m.add<GearMesh>("mesh", {"pinion", "wheel"},
                  {.base_radius_1 = 0.1, .base_radius_2 = 0.2, .stiffness = 1e6, .normal_backlash = 1e-3});
  const System s = m.build();
  const Assembler a(s);
  // x = 0.1 * 0.03 + 0.2 * (-0.01) = 1 mm; half a mm of penetration.
  const State front = state_of(s, {0.03, -0.01}, {0, 0}, {0, 0});
  CHECK(value(s, a, front, "mesh.deflection_m") == Approx(1e-3));
  CHECK(value(s, a, front, "mesh.force_N") == Approx(500.0));
  const State back = state_of(s, {-0.03, 0.01}, {0, 0}, {0, 0});
  CHECK(value(s, a, back, "mesh.force_N") == Approx(-500.0));
  const State apart = state_of(s, {0.0, 0.002}, {0, 0}, {0, 0});
  CHECK(value(s, a, apart, "mesh.force_N") == 0.0);
  CHECK(find_channel(s, "mesh.force_N").unit() == "N");
}

TEST_CASE(
    "The rate of a mesh's force is that of its values, where its stiffness and its offset move by "
    "themselves") {
  const double speed = 30.0, dt = 1e-7;
  for (const bool table : {false, true}) {
    CAPTURE(table);
    GearMesh::Params mesh{.base_radius_1 = 0.1, .base_radius_2 = 0.2, .teeth_1 = 20};
    mesh.stiffness = table ? MeshStiffness::table({0.0, 0.6}, {1e6, 1.4e6})
                           : MeshStiffness::fourier_of_step(0.8e6, 1.2e6, 1.4, 3);
    mesh.normal_backlash = 1e-4;
    mesh.transmission_error = TransmissionError::table({0.0, 0.3}, {0.0, 2e-5});
    const auto rate = [&](double damping) {
      mesh.damping = damping;
      Model m("pair");
      m.add_node("given");
      disc(m, "pinion", 1.0);
      disc(m, "wheel", 1.0);
      m.constant_speed("given", speed);
      m.add<ShaftSpring>("shaft", {"given", "pinion"}, {.stiffness = 1e4});
      m.add<GearMesh>("mesh", {"pinion", "wheel"}, mesh);
      const System s = m.build();
      Assembler a(s);
      const Channel force = find_channel(s, "mesh.force_N");
      const auto at = [&](double t) {
        a.set_time(t);
        return state_of(s, {0.003 + 0.7 * t, -0.0002 - 0.4 * t}, {0.7, -0.4}, {0, 0});
      };
      const double later = force.evaluate(a, at(0.01 + dt)), earlier = force.evaluate(a, at(0.01 - dt));
      const State state = at(0.01);
      return std::pair(force.rate(a, state), (later - earlier) / (2.0 * dt));
    };
    const auto [undamped, difference] = rate(0.0);
    REQUIRE(undamped);
    CHECK(std::abs(difference) > 1e4);
    CHECK(*undamped == Approx(difference).epsilon(1e-6));
    CHECK_FALSE(rate(100.0).first);  // the offset's second derivative is not known
  }
}

TEST_CASE("Reaction of a held node under a static load is the load's negative") {
  Model m("cantilever");
  disc(m, "wall", 1.0);
  disc(m, "tip", 1.0);
  m.add<ShaftSpring>("shaft", {"wall", "tip"}, {.stiffness = 50.0});
  m.add<AppliedTorque>("load", {"tip"}, {.torque = [](double) { return 4.0; }});
  m.hold("wall");
  SECTION("shaft alone") {
    const System s = m.build();
    StaticSolver solver(s);
    const State state = solver.solve().state;
    CHECK(value(s, solver.assembler(), state, "wall.reaction_Nm") == Approx(-4.0));
    CHECK(value(s, solver.assembler(), state, "tip.angle_rad") == Approx(0.08));
  }
  SECTION("a load on the held node itself") {
    m.add<AppliedTorque>("at_wall", {"wall"}, {.torque = [](double) { return 1.5; }});
    const System s = m.build();
    StaticSolver solver(s);
    const State state = solver.solve().state;
    CHECK(value(s, solver.assembler(), state, "wall.reaction_Nm") == Approx(-5.5));
  }
  SECTION("a polyline spring and a general element carry their part") {
    m.add<PolylineSpring>("stop", {"wall", "tip"}, {.x = {-1, 1}, .y = {-30, 30}});
    m.add<problems::Jenkins>("friction", {"wall", "tip"}, {.stiffness = 20.0, .slip = 100.0});
    const System s = m.build();
    StaticSolver solver(s);
    const State state = solver.solve().state;
    CHECK(value(s, solver.assembler(), state, "tip.angle_rad") == Approx(0.04));
    CHECK(value(s, solver.assembler(), state, "wall.reaction_Nm") == Approx(-4.0));
  }
  SECTION("through an ideal gear: the wall carries ratio times the torque, as power demands") {
    m.add_node("anchor");
    m.add<IdealGear>("gear", {"tip", "anchor"}, {.ratio = -3.0});
    Model n = m;
    const System s = n.build();  // tip and anchor are one unknown
    StaticSolver solver(s);
    const State state = solver.solve().state;
    CHECK(value(s, solver.assembler(), state, "anchor.angle_rad") == Approx(-0.24));
    CHECK(value(s, solver.assembler(), state, "gear.torque_Nm") == Approx(0.0).margin(1e-12));
  }
}

TEST_CASE("Reaction of a given motion: everything that its node must overcome") {
  Model m("shaker");
  disc(m, "table", 2.0);
  disc(m, "load", 1.0);
  m.add<ShaftSpring>("shaft", {"table", "load"}, {.stiffness = 50.0, .damping = 3.0});
  m.add<Dashpot>("bearing", {"table"}, {.damping = 0.7});
  m.given_motion("table", {[](double t) {
                   return MotionPoint{0.1 * std::sin(4 * t), 0.4 * std::cos(4 * t), -1.6 * std::sin(4 * t)};
                 }});
  const System s = m.build();
  Assembler a(s);
  a.set_time(0.3);
  const State state = state_of(s, {0.05}, {-0.2}, {9.0});
  const double u = 0.1 * std::sin(1.2), u1 = 0.4 * std::cos(1.2), u2 = -1.6 * std::sin(1.2);
  CHECK(value(s, a, state, "table.reaction_Nm") ==
        Approx(2.0 * u2 + 0.7 * u1 + 50.0 * (u - 0.05) + 3.0 * (u1 + 0.2)));
}

TEST_CASE("Reaction of a shaft run up: its inertia and that of what it holds by an ideal gear") {
  Model m("run_up");
  disc(m, "crank", 2.0);
  disc(m, "gear", 0.5);
  disc(m, "free", 1.0);
  m.add<IdealGear>("ratio", {"crank", "gear"}, {.ratio = -2.0});
  m.add<ShaftSpring>("shaft", {"gear", "free"}, {.stiffness = 10.0});
  m.hold("crank");
  m.set_reference("crank", run_up(0.0, 30.0, 0.0, 10.0));  // 3 rad/s^2
  const System s = m.build();
  Assembler a(s);
  a.set_time(1.0);
  // The free disc lags by J n phi''/k: -1 * (-2) * 3 / 10 = 0.6 and then needs no torque of inertia.
  const State state = state_of(s, {0.6}, {0.0}, {0.0});
  // (2 + 4 * 0.5 + 4 * 1) * 3 in all: the shaft passes the last part on.
  CHECK(value(s, a, state, "crank.reaction_Nm") == Approx(24.0));
  // Torque of the gear on its second node: J n phi'' of gear and free disc.
  CHECK(value(s, a, state, "ratio.torque_Nm") == Approx(-2.0 * 3.0 * (0.5 + 1.0)));
}

TEST_CASE("Torques of two ideal gears in a chain") {
  Model m("chain");
  disc(m, "motor", 1.5);
  disc(m, "mid", 0.7);
  disc(m, "out", 0.2);
  m.add<IdealGear>("gear_1", {"motor", "mid"}, {.ratio = -2.0});
  m.add<IdealGear>("gear_2", {"mid", "out"}, {.ratio = 3.0});
  m.add<AppliedTorque>("drive", {"motor"}, {.torque = [](double) { return 23.0; }});
  const System s = m.build();
  const Assembler a(s);
  const double alpha = 23.0 / (1.5 + 4 * 0.7 + 36 * 0.2);  // 2 rad/s^2
  const State state = state_of(s, {0.0}, {0.0}, {alpha});
  CHECK(value(s, a, state, "gear_2.torque_Nm") == Approx(0.2 * -6.0 * alpha));
  CHECK(value(s, a, state, "gear_1.torque_Nm") == Approx(0.7 * -2.0 * alpha + 3.0 * (0.2 * -6.0 * alpha)));
}

TEST_CASE("Torque of an ideal gear whose driven side is prescribed") {
  Model m("driven");
  disc(m, "motor", 1.5);
  disc(m, "out", 0.4);
  disc(m, "tail", 1.0);
  m.add<IdealGear>("gear", {"motor", "out"}, {.ratio = -2.0});
  m.add<ShaftSpring>("shaft", {"out", "tail"}, {.stiffness = 10.0});
  m.add<AppliedTorque>("drive", {"motor"}, {.torque = [](double) { return 5.0; }});
  const auto motion = [](double t) { return MotionPoint{0.5 * t * t, t, 1.0}; };
  SECTION("held") {
    m.hold("out");
    const System s = m.build();
    const State state = state_of(s, {0.3}, {0.0}, {0.0});
    // On the motor 5 + 2 T = 0; on the out shaft T + R + k z = 0.
    CHECK(value(s, Assembler(s), state, "gear.torque_Nm") == Approx(-2.5));
    CHECK(value(s, Assembler(s), state, "out.reaction_Nm") == Approx(2.5 - 3.0));
  }
  SECTION("driven") {
    m.given_motion("out", {motion});
    const System s = m.build();
    Assembler a(s);
    a.set_time(0.2);
    const State state = state_of(s, {0.3}, {0.0}, {0.0});
    // Motor: 1.5 * (-0.5) = 5 + 2 T; out: 0.4 = T + R + 10 (0.3 - 0.02).
    const double torque = (-0.75 - 5.0) / 2.0;
    CHECK(value(s, a, state, "gear.torque_Nm") == Approx(torque));
    CHECK(value(s, a, state, "out.reaction_Nm") == Approx(0.4 - torque - 2.8));
  }
  SECTION("the driving side prescribed instead") {
    m.given_motion("motor", {motion});
    const System s = m.build();
    Assembler a(s);
    a.set_time(0.2);
    const State state = state_of(s, {0.3}, {0.0}, {0.0});
    // Out: 0.4 * (-2) = T + 10 (0.3 + 0.04).
    const double torque = -0.8 - 3.4;
    CHECK(value(s, a, state, "gear.torque_Nm") == Approx(torque));
    CHECK(value(s, a, state, "motor.reaction_Nm") == Approx(1.5 - 5.0 - 2.0 * torque));
  }
}

TEST_CASE("Differences between nodes whose names hold '-'") {
  Model m("dashes");
  for (const char* name : {"cam-1", "cam-2", "a", "b-c", "x"}) disc(m, name, 1.0);
  disc(m, "y", 1.0, NodeKind::translational);
  const System s = m.build();
  const State state = state_of(s, {1, 2, 4, 8, 16, 32}, {}, {});
  const Assembler a(s);
  CHECK(value(s, a, state, "cam-1-cam-2.twist_rad") == -1.0);
  CHECK(value(s, a, state, "b-c-a.twist_rad") == 4.0);
  CHECK(value(s, a, state, "x-x.twist_rad") == 0.0);
  REQUIRE_THROWS_AS(find_channel(s, "x-y.twist_rad"), ModelError);
  REQUIRE_THROWS_AS(find_channel(s, "x-a.distance_m"), ModelError);
  REQUIRE_THROWS_AS(find_channel(s, "-x.twist_rad"), ModelError);
  Model n = m;
  disc(n, "a-b", 1.0);
  disc(n, "c", 1.0);
  const System both = n.build();  // a - (b-c), or (a-b) - c
  try {
    (void)find_channel(both, "a-b-c.twist_rad");
    CHECK(false);
  } catch (const ModelError& error) {
    CHECK(problems::contains(error.what(), "2 pairs of nodes"));
  }
}

TEST_CASE("Unknown channels are listed together, with the nearest names") {
  Model m("pair");
  disc(m, "motor", 1.0);
  disc(m, "pump", 1.0);
  m.add<ShaftSpring>("shaft", {"motor", "pump"}, {.stiffness = 1.0});
  const System s = m.build();
  try {
    (void)find_channels(s, {"moter.angle_rad", "motor.angle_rad", "shaft.torque", "nonsense", ""});
    CHECK(false);
  } catch (const ModelError& error) {
    CHECK(error.findings().size() == 4);
    const std::string text = error.what();
    CHECK(problems::contains(text, "did you mean 'motor.angle_rad'?"));
    CHECK(problems::contains(text, "did you mean 'shaft.torque_Nm'?"));
    CHECK(problems::contains(text, "channel = nonsense, is no channel of this model"));
  }
}

TEST_CASE("A name that belongs to two channels is refused, not guessed") {
  Model m("clash");
  disc(m, "a", 1.0);
  disc(m, "b", 1.0);
  m.add<DistributedShaft>(
      "shaft", {"a", "b"},
      {.shear_modulus = 8e10, .density = 7850, .outer_diameter = 0.1, .length = 1.0, .segments = 2});
  m.add<ShaftSpring>("shaft_2", {"a", "b"}, {.stiffness = 1.0});
  const System s = m.build();
  CHECK(find_channel(s, "shaft_1.torque_Nm").unit() == "N m");
  REQUIRE_THROWS_AS(find_channel(s, "shaft_2.torque_Nm"), ModelError);
}

TEST_CASE("A pattern stands for every channel that fits it, each once, in the order of the model") {
  Model m("pair");
  disc(m, "motor", 1.0);
  disc(m, "pump", 1.0);
  m.add<ShaftSpring>("shaft", {"motor", "pump"}, {.stiffness = 1.0, .damping = 1.0});
  const System s = m.build();
  const auto names = [&](const std::vector<std::string>& asked) {
    std::string text;
    for (const Channel& c : find_channels(s, asked, OverRun::taken)) text += c.name() + " ";
    return text;
  };
  CHECK(names({"pump.angle_rad", "*.angle_rad", "shaft.*Nm"}) ==
        "pump.angle_rad motor.angle_rad shaft.torque_Nm ");
  CHECK(names({"*.stored_J", "sh*.dissip*_J"}) == "shaft.stored_J shaft.dissipated_J ");
  CHECK(names({"shaft.dissip*"}) == "shaft.dissipation_W shaft.dissipated_J ");  // no other channel fits
  CHECK(find_channels(s, {"*"}).size() == all_channels(s).size());
  CHECK(find_channel(s, "shaft.torque*").name() == "shaft.torque_Nm");
  const auto message = [&](const std::vector<std::string>& asked) -> std::string {
    try {
      find_channels(s, asked);
    } catch (const ModelError& error) {
      return std::to_string(error.findings().size()) + " findings: " + error.what();
    }
    return {};
  };
  const std::string text = message({"shafts*.torque_Nm", "*.work_J", "*.dissipated_J", "pum.angle_rad"});
  CHECK(problems::contains(text, "4 findings"));
  CHECK(problems::contains(text, "channel = shafts*.torque_Nm, fits no channel of this model"));
  CHECK(problems::contains(text, "did you mean 'shaft.torque_Nm'?; there are motor.angle_rad, "));
  CHECK(problems::contains(text, "channel = *.dissipated_J, is summed up over a run"));
  CHECK_THROWS_AS(find_channel(s, "*.angle_rad"), ModelError);
}

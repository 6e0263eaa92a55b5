// Ideal gears and prescribed nodes eliminated: q = T z + g(t). Reduced matrices against T' M T by hand.
#include <drev/elements/catalogue.hpp>

#include "tests/catch.hpp"
#include "tests/problems/dense.hpp"
#include "tests/problems/findings.hpp"

using namespace drev;
using problems::dense;
using problems::only_fault;

namespace {

constexpr double kJ[] = {1.5, 0.7, 0.2, 3.0};  // motor, mid, out, load
constexpr double kStiffness = 40.0, kDamping = 0.3;

/// motor -(-2)- mid -(3)- out - shaft - load. omega_out = -6 omega_motor.
Model train() {
  Model m("train");
  int i = 0;
  for (const char* name : {"motor", "mid", "out", "load"}) {
    m.add_node(name);
    m.add<Inertia>(std::string("J_") + name, {name}, {.inertia = kJ[i++]});
  }
  m.add<IdealGear>("gear_1", {"motor", "mid"}, {.ratio = -2.0});
  m.add<IdealGear>("gear_2", {"mid", "out"}, {.ratio = 3.0});
  m.add<ShaftSpring>("shaft", {"out", "load"}, {.stiffness = kStiffness, .damping = kDamping});
  return m;
}

/// Inertias in this order, with shafts between pairs of them.
System train_of(const std::vector<std::string>& nodes,
                const std::vector<std::pair<std::string, std::string>>& shafts) {
  Model m("train");
  for (const std::string& node : nodes) m.add_node(node);
  for (const std::string& node : nodes) m.add<Inertia>("J_" + node, {node}, {.inertia = 1.0});
  for (const auto& [a, b] : shafts) m.add<ShaftSpring>(a + b, {a, b}, {.stiffness = 100.0});
  m.set_initial("c", 0.25, -1.0);
  return m.build();
}
std::string unknowns(const System& s) {
  std::string names;
  for (int k = 0; k < s.size(); ++k) names += s.unknown_name(k);
  return names;
}

}  // namespace

TEST_CASE("Unknowns are numbered along the lines of a train, whatever the order of its nodes") {
  const std::vector<std::pair<std::string, std::string>> line{{"a", "b"}, {"b", "c"}, {"c", "d"}, {"d", "e"}};
  CHECK(unknowns(train_of({"a", "b", "c", "d", "e"}, line)) == "abcde");
  CHECK(unknowns(train_of({"b", "c", "d", "e", "a"}, line)) == "abcde");
  CHECK(unknowns(train_of({"e", "d", "c", "b", "a"}, line)) == "edcba");
  const System mixed = train_of({"d", "a", "e", "c", "b"}, line);
  CHECK((unknowns(mixed) == "abcde" || unknowns(mixed) == "edcba"));
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 5; ++column)
      if (std::abs(row - column) > 1) CHECK(dense(mixed, mixed.stiffness_values())(row, column) == 0.0);
  // What is given at a node stays with it.
  const NodeMap& c = mixed.node_map(mixed.node("c"));
  const State state = State::initial(mixed);
  CHECK(state.z[c.unknown] == 0.25);
  CHECK(state.v[c.unknown] == -1.0);
  CHECK(state.z.sum() == 0.25);
  // A branch behind its line stays there; a line that two branches interrupt is put together; so is a loop.
  const std::vector<std::pair<std::string, std::string>> branched{
      {"a", "b"}, {"b", "c"}, {"c", "d"}, {"b", "x"}, {"x", "y"}};
  CHECK(unknowns(train_of({"a", "b", "c", "d", "x", "y"}, branched)) == "abcdxy");
  CHECK(unknowns(train_of({"a", "x", "b", "y", "c", "d"}, branched)) == "abxycd");
  const std::vector<std::pair<std::string, std::string>> loop{{"a", "b"}, {"b", "c"}, {"c", "d"}, {"d", "a"}};
  CHECK(unknowns(train_of({"a", "c", "b", "d"}, loop)) == "abcd");
  CHECK(unknowns(train_of({"a", "b", "c", "d"}, loop)) == "abcd");
}

TEST_CASE("A chain of two ideal gears") {
  const System s = train().build();
  REQUIRE(s.size() == 2);
  // T = [1 0; -2 0; -6 0; 0 1].
  const Eigen::MatrixXd mass = dense(s, s.mass_values());
  CHECK(mass(0, 0) == Approx(1.5 + 4 * 0.7 + 36 * 0.2));
  CHECK(mass(1, 1) == Approx(3.0));
  CHECK(mass(0, 1) == 0.0);
  const Eigen::MatrixXd k = dense(s, s.stiffness_values());
  CHECK(k(0, 0) == Approx(36 * kStiffness));
  CHECK(k(0, 1) == Approx(6 * kStiffness));
  CHECK(k(1, 0) == Approx(6 * kStiffness));
  CHECK(k(1, 1) == Approx(kStiffness));
  const Eigen::MatrixXd c = dense(s, s.damping_values());
  CHECK(c(0, 0) == Approx(36 * kDamping));
  CHECK(c(0, 1) == Approx(6 * kDamping));
  // The user's names stay.
  CHECK(s.node_count() == 4);
  CHECK(s.unknown_name(0) == "motor");
  State state = State::initial(s);
  state.z << 0.1, 0.5;
  state.v << -1.0, 2.0;
  const Assembler a(s);
  CHECK(a.node_motion(s.node("out"), state).value == Approx(-0.6));
  CHECK(a.node_motion(s.node("mid"), state).rate == Approx(2.0));
  CHECK(a.node_motion(s.node("load"), state).value == Approx(0.5));
}

TEST_CASE("Rayleigh damping goes through the ratios too") {
  Model m = train();
  m.add<RayleighDamping>("rayleigh", {}, {.alpha_mass = 0.5, .beta_stiffness = 0.01});
  const System s = m.build();
  const Eigen::MatrixXd c = dense(s, s.damping_values());
  CHECK(c(0, 0) == Approx(36 * kDamping + 0.5 * 11.5 + 0.01 * 36 * kStiffness));
  CHECK(c(1, 0) == Approx(6 * kDamping + 0.01 * 6 * kStiffness));
}

TEST_CASE("An ideal gear on a held node holds the other side") {
  Model m = train();
  m.hold("mid");
  const System s = m.build();
  REQUIRE(s.size() == 1);
  CHECK(s.unknown_name(0) == "load");
  CHECK(dense(s, s.stiffness_values())(0, 0) == Approx(kStiffness));
  State state = State::initial(s);
  state.z << 0.2;
  const Assembler a(s);
  CHECK(a.node_motion(s.node("motor"), state).value == 0.0);
  CHECK(a.node_motion(s.node("out"), state).value == 0.0);
}

TEST_CASE("A given motion passes through the ratios") {
  Model m = train();
  m.given_motion("mid", {[](double t) { return MotionPoint{t * t, 2 * t, 2.0}; }});
  const System s = m.build();
  Assembler a(s);
  a.set_time(3.0);
  State state = State::initial(s);
  state.z << 0.25;
  state.v << -1.0;
  const MotionPoint motor = a.node_motion(s.node("motor"), state);
  const MotionPoint out = a.node_motion(s.node("out"), state);
  CHECK(motor.value == Approx(-4.5));
  CHECK(motor.acceleration == Approx(-1.0));
  CHECK(out.rate == Approx(18.0));
  // p of the load: k u_out + c u_out'.
  Vector p;
  a.external(state.z, state.v, p);
  CHECK(p[0] == Approx(kStiffness * 27.0 + kDamping * 18.0));
}

TEST_CASE("Loops of ideal gears are refused, though their ratios agree") {
  Model m = train();
  m.add<IdealGear>("gear_3", {"motor", "out"}, {.ratio = -6.0});
  CHECK(only_fault(m, {"train/gear_", "closes a loop of ideal gears"}));
  Model twice = train();
  twice.add<IdealGear>("again", {"motor", "mid"}, {.ratio = -2.0});
  CHECK(only_fault(twice, {"closes a loop of ideal gears"}));
}

TEST_CASE("Initial conditions through a ratio") {
  Model m = train();
  SECTION("on the far side") {
    m.set_initial("out", 0.6, -12.0);
    const System s = m.build();
    CHECK(s.initial_deviation()[0] == Approx(-0.1));
    CHECK(s.initial_rate()[0] == Approx(2.0));
    CHECK(s.initial_deviation()[1] == 0.0);
  }
  SECTION("said twice, in agreement") {
    m.set_initial("motor", 0.1, 2.0);
    m.set_initial("mid", -0.2, -4.0);
    CHECK(m.build().initial_deviation()[0] == Approx(0.1));
  }
  SECTION("in contradiction") {
    m.set_initial("motor", 0.1, 2.0);
    m.set_initial("mid", 0.2, -4.0);
    CHECK(only_fault(m, {"train/mid", "initial deviation = 0.2 rad", "that of motor gives -0.2"}));
  }
  SECTION("where a gear ties to a held node") {
    m.hold("motor");
    m.set_initial("out", 0.1, 0.0);
    CHECK(only_fault(m, {"train/out", "is prescribed"}));
  }
}

TEST_CASE("A spring between two nodes of one ideal train sees its one unknown") {
  // motor and mid (-2): x = q_mid - q_motor = -3 z: k = 9 k_s.
  Model m = train();
  m.add<PolylineSpring>("across", {"motor", "mid"}, {.x = {-1, 1}, .y = {-5, 5}});
  // Its speed ratio constraint asks for equal speeds, which the gear denies.
  CHECK(only_fault(m, {"across", "gear_1", "cannot turn"}));
  Model n("coaxial");
  for (const char* name : {"a", "b", "c"}) {
    n.add_node(name);
    n.add<Inertia>(std::string("J_") + name, {name}, {.inertia = 1.0});
  }
  n.add<IdealGear>("g_1", {"a", "b"}, {.ratio = -2.0});
  n.add<IdealGear>("g_2", {"b", "c"}, {.ratio = -0.5});
  n.add<PolylineSpring>("across", {"a", "c"}, {.x = {-1, 1}, .y = {-5, 5}});
  n.add<GearMesh>("mesh", {"a", "b"}, {.base_radius_1 = 0.2, .base_radius_2 = 0.1, .stiffness = 1e3});
  const System s = n.build();
  REQUIRE(s.size() == 1);
  const Assembler a(s);
  Vector values, history(0);
  a.tangent_values({0, 0, 1}, Vector::Ones(1), Vector::Zero(1), history, false, values);
  CHECK(dense(s, values)(0, 0) == Approx(0.0).margin(1e-12));  // both are rigid motions of the train
}

TEST_CASE("Ratios too large or too small for a number are refused") {
  for (const double ratio : {1e200, 1e-320, -1e308}) {
    Model m = train();
    m.add_node("far");
    m.add<Inertia>("J_far", {"far"}, {.inertia = 1.0});
    m.add<IdealGear>("gear_3", {"out", "far"}, {.ratio = ratio});
    INFO(ratio);
    const auto found = problems::findings_of(m);
    // 1e-320: the far side barely moves; its own inertia vanishes from the sum, nothing overflows.
    if (ratio == 1e-320)
      CHECK(found.size() <= 1);
    else
      CHECK(!found.empty());
  }
}

// Nominal ratios through everything that turns together; loops; ground; floating parts.
#include "core/kinematics.hpp"

#include <drev/elements/catalogue.hpp>

#include "tests/catch.hpp"
#include "tests/problems/findings.hpp"

using namespace drev;
using problems::count_with;
using problems::findings_of;
using problems::only_fault;

namespace {

Model discs(std::initializer_list<const char*> names) {
  Model m("train");
  for (const char* name : names) {
    m.add_node(name);
    m.add<Inertia>(std::string("J_") + name, {name}, {.inertia = 1.0});
  }
  return m;
}

void mesh(Model& m, const char* name, const char* a, const char* b, double r_a, double r_b,
          bool internal = false, double backlash = 0.0) {
  m.add<GearMesh>(name, {a, b},
                  {.base_radius_1 = r_a,
                   .base_radius_2 = r_b,
                   .internal = internal,
                   .stiffness = 1e8,
                   .normal_backlash = backlash});
}

double ratio(const System& s, const char* node) { return s.ratio(s.node(node)); }

}  // namespace

TEST_CASE("Ratios through shafts, external and internal meshes, idlers and ideal gears") {
  Model m = discs({"crank", "flywheel", "idler", "cam", "ring", "pump", "apart"});
  m.add<ShaftSpring>("shaft", {"crank", "flywheel"}, {.stiffness = 1e4});
  mesh(m, "m1", "crank", "idler", 0.1, 0.25, false, 1e-4);
  mesh(m, "m2", "idler", "cam", 0.25, 0.2);
  mesh(m, "m3", "cam", "ring", 0.2, 0.5, true);
  m.add<IdealGear>("gear", {"ring", "pump"}, {.ratio = -3.0});
  SECTION("from the crank") {
    m.set_reference("crank", constant_speed(10.0));
    const System s = m.build();
    CHECK(ratio(s, "crank") == 1.0);
    CHECK(ratio(s, "flywheel") == Approx(1.0));
    CHECK(ratio(s, "idler") == Approx(-0.4));
    CHECK(ratio(s, "cam") == Approx(0.5));   // the idler's radius cancels
    CHECK(ratio(s, "ring") == Approx(0.2));  // a ring turns with its pinion
    CHECK(ratio(s, "pump") == Approx(-0.6));
    CHECK(ratio(s, "apart") == 0.0);
  }
  SECTION("from the pump, the same train") {
    m.set_reference("pump", constant_speed(6.0));
    const System s = m.build();
    CHECK(ratio(s, "pump") == 1.0);
    CHECK(ratio(s, "crank") == Approx(-1.0 / 0.6));
    CHECK(ratio(s, "cam") == Approx(-0.5 / 0.6));
  }
  SECTION("no reference: nothing moves") {
    const System s = m.build();
    CHECK(ratio(s, "crank") == 0.0);
    CHECK(ratio(s, "cam") == 0.0);
    CHECK(!s.reference());
  }
  SECTION("a dashpot ties no speeds") {
    m.add<Dashpot>("bearing", {"crank", "cam"}, {.damping = 1.0});
    m.set_reference("crank", constant_speed(10.0));
    CHECK(ratio(m.build(), "cam") == Approx(0.5));
  }
  SECTION("the first constant speed is the reference; others must fit") {
    m.constant_speed("cam", 5.0);
    m.constant_speed("crank", 10.0);
    const System s = m.build();
    CHECK(ratio(s, "cam") == 1.0);
    CHECK(ratio(s, "crank") == Approx(2.0));
    REQUIRE(s.reference());
    CHECK(s.reference()->at(2.0).value == Approx(10.0));
  }
}

TEST_CASE("Constant speeds that contradict the reference") {
  Model m = discs({"crank", "idler", "disc"});
  mesh(m, "m1", "crank", "idler", 0.1, 0.2);
  m.add<ShaftSpring>("shaft", {"idler", "disc"}, {.stiffness = 1.0});
  SECTION("another speed") {
    m.set_reference("crank", constant_speed(10.0));
    m.constant_speed("idler", 5.0);
    CHECK(only_fault(m, {"train/idler", "omega = 5 rad/s", "at -5 rad/s"}));
  }
  SECTION("the fitting speed") {
    m.set_reference("crank", constant_speed(10.0));
    m.constant_speed("idler", -5.0);
    CHECK(findings_of(m).empty());
  }
  SECTION("a run-up leaves the speed, though it fits at first") {
    m.set_reference("crank", run_up(10.0, 20.0, 1.0, 2.0));
    m.constant_speed("idler", -5.0);
    CHECK(only_fault(m, {"train/idler", "omega = -5 rad/s", "at -10 rad/s at t = 2 s"}));
  }
  SECTION("a part that the reference does not reach") {
    m.add_node("other");
    m.set_reference("crank", constant_speed(10.0));
    m.constant_speed("other", 3.0);
    CHECK(only_fault(m, {"train/other", "nothing connects this node with the reference shaft, at "}));
  }
}

TEST_CASE("Loops of gears") {
  // crank -(-1/2)- a -(-1)- b, and crank -(+1/2)- b closes it; two gears on one node are coaxial.
  Model m = discs({"crank", "a", "b"});
  mesh(m, "m1", "crank", "a", 0.1, 0.2, false, 1e-4);
  mesh(m, "m2", "a", "b", 0.2, 0.2);
  SECTION("consistent") {
    mesh(m, "m3", "crank", "b", 0.1, 0.2, true);
    m.set_reference("crank", constant_speed(1.0));
    const System s = m.build();
    CHECK(ratio(s, "b") == Approx(0.5));
  }
  SECTION("radii that agree to their digits only") {
    mesh(m, "m3", "crank", "b", 0.1, 0.2 * (1.0 + 1e-12), true);
    CHECK(findings_of(m).empty());
  }
  SECTION("contradicting, with a reference: every element of the loop is named") {
    mesh(m, "m3", "crank", "b", 0.1, 0.21, true);
    m.set_reference("crank", constant_speed(1.0));
    CHECK(only_fault(m, {"m1", "m2", "m3", "cannot turn"}));
  }
  SECTION("contradicting, without a reference") {
    mesh(m, "m3", "crank", "b", 0.1, 0.2);  // three external gears in a ring lock
    CHECK(only_fault(m, {"m1", "m2", "m3", "cannot turn"}));
  }
  SECTION("two loops, two findings; an element outside is not named") {
    mesh(m, "m3", "crank", "b", 0.1, 0.3, true);
    m.add_node("tail");
    m.add<Inertia>("J_tail", {"tail"}, {.inertia = 1.0});
    m.add<ShaftSpring>("stub", {"b", "tail"}, {.stiffness = 1.0});
    m.add<IdealGear>("gear", {"b", "tail"}, {.ratio = 2.0});
    const auto found = findings_of(m);
    CHECK(found.size() == 2);
    CHECK(count_with(found, {"m1", "m2", "m3"}) == 1);
    CHECK(count_with(found, {"stub", "gear"}) == 1);
    CHECK(count_with(found, {"m1", "stub"}) == 0);
  }
}

TEST_CASE("What turns cannot be tied to ground by a spring") {
  Model m = discs({"crank", "disc"});
  m.add<ShaftSpring>("shaft", {"crank", "disc"}, {.stiffness = 1.0});
  m.add<GroundSpring>("support", {"disc"}, {.stiffness = 1.0});
  CHECK(findings_of(m).empty());
  m.set_reference("crank", constant_speed(1.0));
  CHECK(only_fault(m, {"train/support", "node = disc", "cannot be tied to ground"}));
}

TEST_CASE("Floating parts, with contacts closed and open") {
  Model m = discs({"crank", "cam", "tail", "apart"});
  mesh(m, "m1", "crank", "cam", 0.1, 0.2, false, 1e-4);
  m.add<ShaftSpring>("shaft", {"cam", "tail"}, {.stiffness = 1.0});
  using Names = std::vector<std::string>;
  SECTION("free") {
    const System s = m.build();
    CHECK(s.floating_parts(Contact::closed) == Names{"crank", "apart"});
    CHECK(s.floating_parts(Contact::open) == Names{"crank", "cam", "apart"});
    CHECK(s.rigid_mode_count(Contact::open) == 3);
  }
  SECTION("held on one side of the contact") {
    m.hold("crank");
    const System s = m.build();
    CHECK(s.floating_parts(Contact::closed) == Names{"apart"});
    CHECK(s.floating_parts(Contact::open) == Names{"cam", "apart"});
  }
  SECTION("tied to ground, to a stop with play, and by an ideal gear to a held node") {
    m.add<GroundSpring>("support", {"tail"}, {.stiffness = 1.0});
    m.add<PolylineSpring>("stop", {"apart"}, PolylineSpring::dead_band(10.0, 0.1));
    const System s = m.build();
    CHECK(s.floating_parts(Contact::closed).empty());
    CHECK(s.floating_parts(Contact::open) == Names{"crank", "apart"});
  }
  SECTION("an ideal gear passes the hold on") {
    m.add_node("anchor");
    m.add<IdealGear>("gear", {"anchor", "apart"}, {.ratio = 2.0});
    m.hold("anchor");
    CHECK(m.build().floating_parts(Contact::closed) == Names{"crank"});
  }
}

// Validation: what is wrong with a model is found, all at once, and said in words that name it.
#include <drev/core/model.hpp>
#include <drev/elements/catalogue.hpp>

#include "tests/catch.hpp"
#include "tests/problems/findings.hpp"
#include "tests/unit/not_finite.hpp"

using namespace drev;
using problems::count_with;
using problems::findings_of;
using problems::only_fault;

namespace {

/// motor - shaft - pump: sound.
Model sound() {
  Model m("pump_set");
  m.add_node("motor");
  m.add_node("pump");
  m.add<Inertia>("motor_disc", {"motor"}, {.inertia = 2.0});
  m.add<Inertia>("pump_disc", {"pump"}, {.inertia = 1.0});
  m.add<ShaftSpring>("shaft", {"motor", "pump"}, {.stiffness = 100.0});
  return m;
}

}  // namespace

TEST_CASE("A sound model builds, again and again, and outlives its description") {
  std::optional<System> system;
  {
    const Model m = sound();
    CHECK(findings_of(m).empty());
    CHECK(m.build().size() == 2);
    system.emplace(m.build());
  }
  CHECK(system->name() == "pump_set");
  CHECK(system->node("pump") == 1);
  CHECK(system->unknown_name(0) == "motor");
  CHECK(system->element_instances().size() == 3);
  REQUIRE_THROWS_AS(system->node("pmup"), ModelError);
}

TEST_CASE("Five faults of five kinds are five findings") {
  Model m = sound();
  m.add_node("shaft end");                                                     // 1: no inertia
  m.add<ShaftSpring>("coupling", {"pump", "shaft end"}, {.stiffness = -5.0});  // 2
  m.add<ShaftSpring>("stub", {"pmup", "motor"}, {.stiffness = 1.0});           // 3: unknown node
  m.hold("motr");                                                              // 4: unknown node
  m.set_initial("pump", kNan, 0.0);                                            // 5
  // The faulty coupling and the unknown held node leave it open whether "shaft end" lacks an inertia.
  CHECK(findings_of(m).size() == 4);

  Model n = sound();
  n.add_node("flywheel");                                                    // 1
  n.add<ShaftSpring>("coupling", {"pump", "flywheel"}, {.stiffness = 5.0});  // (sound)
  n.add<Inertia>("extra", {"pump"}, {.inertia = -5.0});                      // 2
  n.add<ShaftSpring>("stub", {"pmup", "motor"}, {.stiffness = 1.0});         // 3
  n.set_initial("motr", 0.1, 0.0);                                           // 4
  n.add<IdealGear>("gear", {"motor", "pump"}, {.ratio = -2.0});              // 5: contradicts the shaft
  const auto found = findings_of(n);
  CHECK(found.size() == 5);
  CHECK(count_with(found, {"pump_set/flywheel", "inertia = 0 kg m^2", "needs an inertia"}) == 1);
  CHECK(count_with(found, {"pump_set/extra", "inertia = -5 kg m^2", "must be > 0"}) == 1);
  CHECK(count_with(found, {"pump_set/stub", "node 1 = pmup", "did you mean 'pump'?"}) == 1);
  CHECK(count_with(found, {"initial condition = motr", "did you mean 'motor'?"}) == 1);
  CHECK(count_with(found, {"shaft", "gear", "cannot turn"}) == 1);
}

TEST_CASE("Several faults in one element are several findings") {
  Model m = sound();
  m.add<GearMesh>("mesh", {"motor", "pump"},
                  {.base_radius_1 = -0.1, .stiffness = 1e8, .normal_backlash = -0.25, .damping = kNan});
  const auto found = findings_of(m);
  CHECK(count_with(found, {"pump_set/mesh", "base_radius_1 = -0.1 m"}) == 1);
  CHECK(count_with(found, {"pump_set/mesh", "base_radius_2 = NaN m"}) == 1);
  CHECK(count_with(found, {"pump_set/mesh", "normal_backlash = -0.25 m"}) == 1);
  CHECK(count_with(found, {"pump_set/mesh", "damping = NaN"}) == 1);
}

TEST_CASE("Names") {
  SECTION("node used twice") {
    Model m = sound();
    m.add_node("pump");
    CHECK(only_fault(m, {"node name = pump", "is used twice"}));
  }
  SECTION("element used twice") {
    Model m = sound();
    m.add<ShaftSpring>("shaft", {"motor", "pump"}, {.stiffness = 100.0});
    CHECK(only_fault(m, {"element name = shaft", "is used twice"}));
  }
  SECTION("what channel names and tables cannot hold") {
    for (const char* bad :
         {"", "a.b", "a*", "a,b", "a\nb", "a\"b", "a\tb", "\x1b[31m", "a\x7f", "a\xc2\x9b"}) {
      Model m = sound();
      m.add_node(bad);
      m.add<Inertia>("disc", {bad}, {.inertia = 1.0});
      INFO(bad);
      CHECK(only_fault(m, {"node name"}));
      Model n = sound();
      n.add<Inertia>(bad, {"motor"}, {.inertia = 1.0});
      CHECK(only_fault(n, {"element name"}));
    }
  }
  SECTION("what would end or steer what is printed") {
    Model m = sound();
    m.add_node(std::string("a\0b", 3));
    m.add<Inertia>("disc", {NodeId{2}}, {.inertia = 1.0});
    CHECK(only_fault(m, {"node name = a\\x00b", "control characters"}));
    Model named("a\x1b[2Jb");
    named.add_node("n");
    named.add<Inertia>("disc", {"n"}, {.inertia = 1.0});
    CHECK(only_fault(named, {"name = a\\x1b[2Jb, must be without control characters"}));
  }
  SECTION("an element's internal nodes meet the user's") {
    Model m = sound();
    m.add_node("long_1");
    m.add<Inertia>("disc", {"long_1"}, {.inertia = 1.0});
    m.add<DistributedShaft>(
        "long", {"motor", "pump"},
        {.shear_modulus = 8e10, .density = 7850, .outer_diameter = 0.1, .length = 1.0, .segments = 3});
    CHECK(only_fault(m, {"node name = long_1", "is used twice"}));
  }
}

TEST_CASE("Nodes of elements") {
  Model m = sound();
  SECTION("too few") {
    m.add<ShaftSpring>("bad", {"motor"}, {.stiffness = 1.0});
    CHECK(only_fault(m, {"pump_set/bad", "nodes = 1", "a shaft spring takes 2"}));
  }
  SECTION("too many") {
    m.add<Inertia>("bad", {"motor", "pump"}, {.inertia = 1.0});
    CHECK(only_fault(m, {"pump_set/bad", "nodes = 2", "an inertia takes 1"}));
  }
  SECTION("too many for one or two") {
    m.add_node("third");
    m.add<Inertia>("third", {"third"}, {.inertia = 1.0});
    m.add<Dashpot>("bad", {"motor", "pump", "third"}, {.damping = 1.0});
    CHECK(only_fault(m, {"pump_set/bad", "nodes = 3", "takes 1 or 2"}));
  }
  SECTION("none where none are taken, one given") {
    m.add<RayleighDamping>("bad", {"motor"}, {.alpha_mass = 1.0});
    CHECK(only_fault(m, {"pump_set/bad", "nodes = 1", "takes 0"}));
  }
  SECTION("the same twice") {
    m.add<ShaftSpring>("bad", {"pump", "pump"}, {.stiffness = 1.0});
    CHECK(only_fault(m, {"pump_set/bad", "node 2 = pump", "given twice"}));
  }
  SECTION("an id beyond this model's nodes") {
    m.add<Inertia>("bad", {NodeId{7}}, {.inertia = 1.0});
    CHECK(only_fault(m, {"pump_set/bad", "node 1 = 7", "is no node of this model (it has 2)"}));
  }
  SECTION("a negative id") {
    m.add<Inertia>("bad", {NodeId{-1}}, {.inertia = 1.0});
    CHECK(only_fault(m, {"pump_set/bad", "node 1 = -1", "is no node of this model"}));
  }
  SECTION("an unknown name far from any") {
    m.add<Inertia>("bad", {"windscreen_wiper"}, {.inertia = 1.0});
    CHECK(only_fault(m, {"node 1 = windscreen_wiper, is no node of this model"}));
    CHECK(count_with(findings_of(m), {"did you mean"}) == 0);
  }
  SECTION("no element at all") {
    m.add("bad", {"motor"}, nullptr);
    CHECK(only_fault(m, {"pump_set/bad", "element", "null"}));
  }
}

TEST_CASE("Parameters that are not numbers, or were forgotten") {
  Model m = sound();
  m.add<ShaftSpring>("forgotten", {"motor", "pump"}, {});
  m.add<ShaftSpring>("infinite", {"motor", "pump"}, {.stiffness = kInfinity});
  m.add<Inertia>("nan", {"motor"}, {.inertia = kNan});
  m.add<IdealGear>("zero", {"motor", "pump"}, {.ratio = 0.0});
  m.add<AppliedTorque>("nothing", {"motor"}, {});
  const auto found = findings_of(m);
  CHECK(found.size() == 5);
  CHECK(count_with(found, {"forgotten", "stiffness = NaN N m/rad"}) == 1);
  CHECK(count_with(found, {"infinite", "stiffness = infinity"}) == 1);
  CHECK(count_with(found, {"nan", "inertia = NaN kg m^2"}) == 1);
  CHECK(count_with(found, {"zero", "ratio = 0, must not be 0"}) == 1);
  CHECK(count_with(found, {"nothing", "torque"}) == 1);
}

TEST_CASE("Models with nothing to compute") {
  CHECK(only_fault(Model("void"), {"void", "nodes = 0", "the model is empty"}));
  Model m = sound();
  m.hold("motor");
  m.hold("pump");
  CHECK(only_fault(m, {"unknowns = 0", "every node is prescribed"}));
}

TEST_CASE("A node without inertia in a free chain, held, or tied by an ideal gear, it needs none") {
  Model m = sound();
  const NodeId joint = m.add_node("joint");
  m.add<ShaftSpring>("stub", {"pump", joint}, {.stiffness = 10.0});
  CHECK(only_fault(m, {"pump_set/joint", "inertia = 0 kg m^2"}));
  Model held = m;
  held.hold(joint);
  CHECK(findings_of(held).empty());
  Model geared = m;
  geared.add_node("big");
  geared.add<Inertia>("big", {"big"}, {.inertia = 1.0});
  geared.add<IdealGear>("gear", {joint, "big"}, {.ratio = -3.0});
  CHECK(findings_of(geared).empty());

  Model line = sound();
  line.add_node("carriage", NodeKind::translational);
  line.add<GroundSpring>("buffer", {"carriage"}, {.stiffness = 1.0});
  CHECK(only_fault(line, {"pump_set/carriage", "mass = 0 kg"}));
}

TEST_CASE("Prescribed nodes") {
  Model m = sound();
  SECTION("two prescriptions on one node") {
    m.hold("motor");
    m.given_motion(NodeId{0}, {[](double) { return MotionPoint{}; }});
    CHECK(only_fault(m, {"pump_set/motor", "given twice"}));
  }
  SECTION("on both sides of an ideal gear") {
    m.add_node("third");
    m.add<IdealGear>("gear", {"pump", "third"}, {.ratio = 2.0});
    m.hold("pump");
    m.hold("third");
    CHECK(only_fault(m, {"pump_set/third", "is prescribed already"}));
  }
  SECTION("unknown node") {
    m.hold("moter");
    CHECK(only_fault(m, {"prescribed node = moter", "did you mean 'motor'?"}));
  }
  SECTION("no function") {
    m.given_motion("motor", {});
    CHECK(only_fault(m, {"pump_set/motor", "given motion", "has no function"}));
  }
  SECTION("reference without a function") {
    m.set_reference("motor", {});
    CHECK(only_fault(m, {"reference motion", "has no function"}));
  }
  SECTION("two references") {
    m.set_reference("motor", constant_speed(1.0));
    m.set_reference("pump", constant_speed(1.0));
    CHECK(only_fault(m, {"reference = 2", "at most one"}));
  }
  SECTION("speed not finite") {
    m.constant_speed("motor", kNan);
    CHECK(only_fault(m, {"pump_set/motor", "omega = NaN rad/s"}));
  }
  SECTION("breakpoints not finite") {
    m.given_motion("motor", {[](double) { return MotionPoint{}; }, {1.0, kNan}});
    CHECK(only_fault(m, {"pump_set/motor", "given motion breakpoints[1] = NaN s"}));
  }
}

TEST_CASE("Initial conditions") {
  Model m = sound();
  SECTION("on a prescribed node") {
    m.hold("motor");
    m.set_initial("motor", 0.1, 0.0);
    CHECK(only_fault(m, {"pump_set/motor", "initial deviation = 0.1 rad", "is prescribed"}));
    m.set_initial("motor", 0.0, 2.0);
    CHECK(count_with(findings_of(m), {"initial rate = 2 rad/s", "is prescribed"}) == 1);
  }
  SECTION("not finite") {
    m.set_initial("motor", kInfinity, kNan);
    const auto found = findings_of(m);
    CHECK(found.size() == 2);
    CHECK(count_with(found, {"initial rate = NaN rad/s"}) == 1);
  }
  SECTION("twice, in contradiction") {
    m.set_initial("motor", 0.1, 0.0);
    m.set_initial("motor", 0.2, 0.0);
    CHECK(only_fault(m, {"pump_set/motor", "initial deviation = 0.2", "gives 0.1"}));
  }
}

TEST_CASE("Rotational and translational nodes in one element") {
  Model m = sound();
  m.add_node("slide", NodeKind::translational);
  m.add<Inertia>("slide_mass", {"slide"}, {.inertia = 3.0});
  SECTION("shaft") {
    m.add<ShaftSpring>("bad", {"motor", "slide"}, {.stiffness = 1.0});
    CHECK(only_fault(m, {"pump_set/bad", "node = slide", "is translational", "motor is rotational",
                         "shaft spring joins nodes of one kind"}));
  }
  SECTION("mesh") {
    m.add<GearMesh>("bad", {"motor", "slide"},
                    {.base_radius_1 = 0.1, .base_radius_2 = 0.1, .stiffness = 1e8});
    CHECK(only_fault(m, {"pump_set/bad", "node 2 = slide", "is translational"}));
  }
  SECTION("ideal gear") {
    m.add<IdealGear>("bad", {"slide", "motor"}, {.ratio = 0.1});
    CHECK(only_fault(m, {"pump_set/bad", "node = motor", "is rotational"}));
  }
  SECTION("dashpot") {
    m.add<Dashpot>("bad", {"slide", "motor"}, {.damping = 0.1});
    CHECK(only_fault(m, {"pump_set/bad", "node = motor", "is rotational"}));
  }
  SECTION("two of a kind are fine") {
    m.add_node("table", NodeKind::translational);
    m.add<Inertia>("table_mass", {"table"}, {.inertia = 3.0});
    m.add<ShaftSpring>("rod", {"table", "slide"}, {.stiffness = 1.0});
    CHECK(findings_of(m).empty());
  }
}

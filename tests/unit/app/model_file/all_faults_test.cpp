// All faults of a file at once: one fault hides no other that does not depend on it, and none follows from another.
#include <algorithm>
#include <fstream>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using namespace drev;
using drev::test::contains;

namespace {

/// Two inertias and a shaft between them, with more elements, or with one changed.
std::string train(const std::string& more, const std::string& inertia = "inertia_kg_m2 = 1") {
  return "format = 1\n[nodes]\na = {}\nb = {}\n[elements]\n"
         "J_a = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n"
         "J_b = { type = \"inertia\", node = \"b\", " +
         inertia +
         " }\n"
         "s = { type = \"shaft_spring\", nodes = [\"a\", \"b\"], stiffness_Nm_per_rad = 5 }\n" +
         more;
}

test::Outcome checked(const std::string& text, const std::vector<std::string>& more = {}) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "m.toml") << text;
  std::vector<std::string> words{"check", (folder / "m.toml").string()};
  words.insert(words.end(), more.begin(), more.end());
  return test::drev_command(words);
}

/// The faults are these, and no other.
void require_faults(const std::string& text, const std::vector<std::string>& faults) {
  const auto run = checked(text);
  CAPTURE(text, run.err);
  CHECK(run.exit_code == 2);
  CHECK(std::count(run.err.begin(), run.err.end(), '\n') ==
        static_cast<long>(faults.size()) + (faults.size() > 1 ? 1 : 0));
  for (const std::string& fault : faults) CHECK(contains(run.err, fault));
}

}  // namespace

TEST_CASE("A key that is wrong hides no fault of the nodes of other elements, nor of its own") {
  const std::string nodes =
      "one = { type = \"shaft_spring\", nodes = [\"a\"], stiffness_Nm_per_rad = 5 }\n"
      "twice = { type = \"shaft_spring\", nodes = [\"a\", \"a\"], stiffness_Nm_per_rad = 5 }\n";
  const std::vector<std::string> said{"m/one: nodes = 1, a shaft spring takes 2", "m/twice: node 2 = a"};
  require_faults(train(nodes), said);
  // Without its inertia node b would lack one: that follows, and is not said.
  require_faults(train(nodes, "inertia_kg_m3 = 1"), {said[0], said[1], "J_b.inertia_kg_m3"});
  require_faults(train(nodes + "own = { type = \"shaft_spring\", nodes = [\"a\"], damp = 3, "
                               "stiffness_Nm_per_rad = 1 }\n"),
                 {said[0], said[1], "own.damp, is unknown", "m/own: nodes = 1"});
}

TEST_CASE("What cannot be read of a node or element is not missed elsewhere") {
  require_faults(train("", "inertia_kg_m2 = 1, x = 2"), {"J_b.x"});
  require_faults(
      "format = 1\n[nodes]\na = {}\nb = 3\n[elements]\n"
      "J = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n"
      "s = { type = \"shaft_spring\", nodes = [\"a\", \"b\"], stiffness_Nm_per_rad = 5 }\n",
      {"nodes.b, must be a table"});
  require_faults(
      "format = 1\n[nodes]\na = {}\nb = { holdd = true }\n[elements]\n"
      "J = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n"
      "s = { type = \"shaft_spring\", nodes = [\"a\", \"b\"], stiffness_Nm_per_rad = 5 }\n",
      {"nodes.b.holdd"});
  require_faults("format = 1\ninclude = \"none.toml\"\n[nodes]\na = {}\n[run]\nrecord = \"z.angle_rad\"\n",
                 {"there is no such file"});
  // A node that the element does not name may have been meant.
  require_faults(
      "format = 1\n[nodes]\na = {}\nb = {}\n[elements]\n"
      "J_a = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n"
      "J_b = { type = \"inertia\", node = 7, inertia_kg_m2 = 1 }\n"
      "s = { type = \"shaft_spring\", nodes = [\"a\", \"b\"], stiffness_Nm_per_rad = 5 }\n",
      {"elements.J_b.node"});
}

TEST_CASE("A control character in one name hides no other fault, and is said once") {
  require_faults(
      "format = 1\n[nodes]\n\"a*\" = {}\n\"b\\nc\" = {}\n[elements]\n"
      "J = { type = \"inertia\", node = \"a*\", inertia_kg_m2 = 1 }\n"
      "K = { type = \"inertia\", node = \"b\\nc\", inertia_kg_m2 = 1 }\n",
      {"m.toml:3:1: m: node name = a*, must be", "m.toml:4:1: nodes, has a control character"});
}

TEST_CASE("A fault of the train hides none of [run] and [class]") {
  const std::string rest =
      "[run]\nrecord = [\"x.angle_rad\", \"a.angle_rad\", \"s.torque_Nm\"]\ndeflection = "
      "\"y.angle_rad\"\n"
      "[class]\nrated_speed_rpm = -1\n[class.sections]\nnope = { diameter_mm = 5 }\n"
      "s = { diameter_mm = -5, permissible_stress_MPa = 50 }\n";
  const std::vector<std::string> said{"channel = x.angle_rad", "channel = y.angle_rad",
                                      "nope, is the name of no element", "rated_speed = -1 rpm",
                                      "class.sections.s: diameter = -0.005 m"};
  require_faults(train(rest), said);
  std::vector<std::string> more = said;
  more.emplace_back("m/J_b: inertia = -1");
  require_faults(train(rest, "inertia_kg_m2 = -1"), more);
  more.back() = "J_b.inertia_kg_m3";
  require_faults(train(rest, "inertia_kg_m3 = 1"), more);
  // Channels and sections of the element that is wrong are not missed.
  require_faults(
      "format = 1\n[nodes]\na = {}\nb = {}\n[elements]\n"
      "J_a = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n"
      "J_b = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 1 }\n"
      "s = { type = \"shaft_spring\", nodes = [\"a\", \"b\"], stiffness_Nm_per_rad = -5 }\n"
      "[run]\nrecord = [\"s.torque_Nm\", \"s*.torque_Nm\"]\n"
      "[class.sections]\ns = { diameter_mm = 5, permissible_stress_MPa = 50 }\n",
      {"m/s: stiffness = -5"});
}

TEST_CASE("What an S-N line without its range has else is a fault, which a check also gives as JSON") {
  const std::string text = train(
      "[class.sections]\ns = { diameter_mm = 5, sn_cycles = 1e6, sn_slope = 3 }\n"
      "[run]\nduration_s = 1\n");
  require_faults(text, {"class.sections.s.sn_cycles, has no effect: an S-N line needs an sn_range",
                        "class.sections.s.sn_slope, has no effect"});
  const auto run = checked(text, {"--json"});
  CAPTURE(run.out);
  CHECK(run.exit_code == 2);
  CHECK(contains(run.out, "\"faults\""));
  CHECK(contains(run.out, "has no effect: an S-N line needs an sn_range"));
}

TEST_CASE("A firing order that cannot be read hides no fault of its engine") {
  require_faults(
      train("e = { type = \"engine_cylinders\", nodes = [\"a\", \"b\"], bore_mm = -1, stroke_mm = 100, "
            "rod_mm = 20, strokes = 3, firing_order = \"1-1\", pressure = { angle_deg = [0, 30, 20], "
            "pressure_bar = [1, 2, 3] }, misfiring_cylinder = 7 }\n"),
      {"bore = -0.001 m", "rod = 0.02 m", "strokes = 3",
       "firing_order = 1-1, must name each cylinder from 1 on once", "pressure.arguments[2]",
       "misfiring_cylinder = 7, must be the number of a cylinder, 1 to 2"});
}

TEST_CASE("A key of an engine that has no effect beside the others is a fault") {
  const auto engine = [](const std::string& keys) {
    return train(
        "[elements.e]\ntype = \"engine_cylinders\"\nnodes = [\"a\", \"b\"]\nbore_mm = 100\n"
        "stroke_mm = 100\nrod_mm = 200\nfiring = { angle_deg = [0, 360] }\n" +
        keys);
  };
  const std::string pressure = "pressure = { angle_deg = [0, 360], pressure_bar = [50, 1] }\n";
  const std::string gas =
      "peak_pressure = { speed_rpm = [900], pressure_bar = [90] }\nreference_pressure_bar = 90\n"
      "load = 0.5\nfiring_tdc_deg = 9\ninterpolation = \"cubic\"\ncrankcase_pressure_bar = 1\n";
  std::vector<std::string> said{"e.first_firing_deg, has no effect: firing gives"};
  for (const char* key : {"load", "firing_tdc_deg", "interpolation", "peak_pressure",
                          "reference_pressure_bar", "crankcase_pressure_bar"})
    said.push_back("e." + std::string(key) + ", has no effect: it belongs to pressure");
  require_faults(engine(gas + "first_firing_deg = 9\n"), said);
  require_faults(engine(gas + "first_firing_deg = 9\nmean_tangential_pressure_bar = 3\n"), said);
  require_faults(engine(pressure + "load = 0.5\nreference_pressure_bar = 90\n"),
                 {"e.load, has no effect: pressure has no", "e.reference_pressure_bar, has no effect: it"});
  require_faults(engine("pressure = { angle_deg = [], pressure_bar = [] }\nload = 0.5\n"),
                 {"e.pressure, holds no numbers"});
  require_faults(engine(pressure + "peak_pressure = { speed_rpm = [], pressure_bar = [] }\n"),
                 {"e.peak_pressure, holds no numbers"});
  const std::string peak = "peak_pressure = { speed_rpm = [900], pressure_bar = [90] }\n";
  require_faults(engine(pressure + peak + "reference_pressure_bar = 0\n"), {"reference_pressure = 0 Pa"});
  // What nothing is scaled by may be zero.
  const std::string none = "pressure = { angle_deg = [0, 360], pressure_bar = [0, 0] }\n";
  CHECK(checked(engine(none)).exit_code == 0);
  require_faults(engine(none + peak), {"the largest pressure must be > 0: it is the reference"});
}

TEST_CASE("Ratios of modal damping are checked beside the train that they damp") {
  const std::string modal = "m = { type = \"modal_damping\", ratio = 2 }\n";
  require_faults(train(modal), {"m/m: ratio = 2"});
  require_faults(train(modal, "inertia_kg_m2 = -1"), {"m/m: ratio = 2", "m/J_b: inertia = -1"});
  require_faults(train(modal, "inertia_kg_m3 = 1"), {"m/m: ratio = 2", "J_b.inertia_kg_m3"});
}

TEST_CASE("Faults of a gear drawing are listed beside each other, each at its line") {
  const std::string geometry =
      "[elements.z]\ntype = \"gear_mesh\"\nnodes = [\"a\", \"b\"]\n[elements.z.geometry]\n"
      "module_mm = 9\nload_N_per_mm = -1\n"
      "gear_1 = { teeth = 34, width_mm = -130, bore_diameter_mm = 141 }\n"
      "gear_2 = { teeth = 59, width_mm = 130, bore_diameter_mm = 253.5 }\n";
  require_faults(train(geometry), {"m.toml:14:1: elements.z: load = -1000 N/m",
                                   "m.toml:15:24: elements.z: gear_1.width = -0.13 m"});
  // Computed bounds are rounded, in the unit of the key.
  std::string crushed = geometry;
  crushed.replace(crushed.find("-1\n"), 2, "1e6");
  crushed.replace(crushed.find("-130"), 4, "130");
  require_faults(train(crushed), {"load = 1000000 N/mm, must be at most 8844 N/mm for these teeth"});
  const test::TemporaryFolder folder;
  std::ofstream(folder / "m.toml") << train(geometry);
  const auto run = test::drev_command({"gear", (folder / "m.toml").string()});
  CAPTURE(run.err);
  CHECK(contains(run.err, "m.toml:14:1: elements.z.geometry: load = -1000 N/m"));
  CHECK(contains(run.err, "m.toml:15:24: elements.z.geometry: gear_1.width = -0.13 m"));
}

TEST_CASE("Faults of a contour are said at the line of their station") {
  require_faults(
      train("[elements.st]\ntype = \"contour_shaft\"\nnodes = [\"a\", \"b\"]\nshear_modulus_GPa = 80\n"
            "density_kg_per_m3 = 7850\nstations = [\n"
            "  { length_mm = 200, outer_diameter_mm = 100 },\n"
            "  { length_mm = 100, outer_diameter_mm = 150, inner_diameter_mm = 160 },\n]\n"),
      {"m.toml:16:47: m/st: stations[2].inner_diameter = 0.16 m"});
}

TEST_CASE("A governor says which of its keys are missing") {
  const auto governor = [](const std::string& keys) {
    return train(
        "[nodes.c]\nnominal_speed_rpm = 100\n[elements.J_c]\ntype = \"inertia\"\nnode = \"c\"\n"
        "inertia_kg_m2 = 1\n[elements.g]\ntype = \"speed_governor\"\nnode = \"c\"\n" +
        keys);
  };
  require_faults(governor("droop = 0.04\n"), {"m/g: rated_torque, is missing: droop needs it",
                                              "m/g: rated_speed, is missing: droop needs it"});
  // Of other elements, whatever they say of a number that is not given.
  require_faults(train("c = { type = \"clutch\", nodes = [\"a\", \"b\"], friction_coefficient = 0.3 }\n"),
                 {"m/c: normal_force, is missing: must be >= 0", "m/c: geometry, is missing: must be > 0"});
  require_faults(train("c = { type = \"elastic_coupling\", nodes = [\"a\", \"b\"] }\n"),
                 {"m/c: stiffness, is missing: must be > 0"});
  require_faults(governor(""), {"m/g: proportional_gain, is missing; or give droop"});
}

TEST_CASE("Faults of a run are said beside those of its model, with the values as they were typed") {
  require_faults(
      train("[parameters]\nx_deg = { default = 95, meaning = \"an angle\" }\n[run]\nduration_ms = -1\n"
            "method = \"euler\"\nstart = \"warm\"\nsettle_s = -3\nevery_s = -2\n"
            "[class.sections.s]\ndiameter_mm = -3\nbogus = 3\n[elements.m]\ntype = \"gear_mesh\"\n"
            "nodes = [\"a\", \"b\"]\nmodule_mm = 0\npressure_angle_deg = \"x_deg\"\nteeth_1 = 9\n"
            "teeth_2 = 9\nstiffness_N_per_m = 1\n"),
      {"run.duration_ms, must be > 0, not the number -1", "run: method name = euler, is no method",
       "run: start = warm, must be rest", "run: settle = -3 s, must be auto",
       "run: every = -2 s, must be between", "class.sections.s.bogus, is unknown here",
       "class.sections.s: diameter = -0.003 m, must be > 0 (given as diameter_mm = -3)",
       "module = 0 m, must be > 0 and finite (given as module_mm = 0)",
       "rad, must be >= 0 and < pi/2 (given as pressure_angle_deg = \"x_deg\")"});
}

TEST_CASE("What a run with output would refuse is wrong with its file") {
  const auto fault = [](const std::string& run, const std::string& said) {
    require_faults(train("[run]\n" + run + "\n"), {said});
  };
  fault("every_ms = -1", "m.toml:10:12: run: every = -0.001 s, must be");
  fault("every_s = 0", "run: every = 0 s, must be");
  fault("every_s = 5", "run: every = 5 s, must be");
  fault("method = \"rk4\"\nstep_s = 0.9",
        "m.toml:11:10: run: step = 0.9 s, is above the stability limit of rk4");
  fault("static_turn_deg = -5", "run.static_turn_deg, must be >= 0");
  fault("out = \"\"", "run.out, must be the name of a folder");
  fault("record = [\"a.angle_rad\", \"a.angle_rad\"]", "run.record, a.angle_rad is named twice");
  CHECK(checked(train("[run]\nevery_s = 0.5\nmethod = \"rk4\"\nstep_s = 0.01\n")).exit_code == 0);
}

TEST_CASE("A check of one run says which runs the file has") {
  const auto run = checked(train("[run]\n[run.long]\nduration_s = 2\n[run.short]\nduration_s = 0.1\n"),
                           {"--run", "long", "--json"});
  CAPTURE(run.out);
  CHECK(contains(run.out, "\"long\""));
  CHECK(contains(run.out, "\"short\""));
}

TEST_CASE("A run that records nothing says so") {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "m.toml") << train("[run]\nduration_s = 0.01\nrecord = []\n");
  const auto run =
      test::drev_command({"run", (folder / "m.toml").string(), "--out", (folder / "out").string()});
  CAPTURE(run.out, run.err);
  CHECK(run.exit_code == 0);
  CHECK(contains(run.out, "of no channel"));
}

TEST_CASE("A held node, or one of given motion, that no element is at is a fault") {
  const auto with_node = [](const std::string& node) {
    std::string text = train("");
    return text.insert(text.find("[elements]"), node + "\n");
  };
  require_faults(with_node("c = { hold = true }"),
                 {"m.toml:5:1: nodes.c, is held without effect: no element is at this node"});
  require_faults(with_node("c = { given_motion = { amplitude_deg = 1, frequency_Hz = 2 } }"),
                 {"nodes.c, has a given motion without effect"});
  CHECK(checked(with_node("c = { hold = true, when = false }")).exit_code == 0);
  // An element that is wrong may be at it.
  require_faults(with_node("c = { hold = true }") +
                     "k = { type = \"shaft_spring\", nodes = [\"b\", 3], stiffness_Nm_per_rad = 5 }\n",
                 {"elements.k"});
}

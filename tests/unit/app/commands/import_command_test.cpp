// drev import: trains of openTorsion and mass-elastic tables, against their natural frequencies.
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using drev::test::read_file;

namespace {

double first_frequency(const std::string& file) {
  const auto outcome = drev_command({"modes", file, "--json"});
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  return nlohmann::json::parse(outcome.out).at("frequencies_Hz")[0];
}

}  // namespace

TEST_CASE("openTorsion's JSON: discs, shafts, gear, what cannot be taken is said", "[import]") {
  const drev::test::TemporaryFolder folder;
  std::ofstream(folder / "train.json")
      << R"({"structure": [["motor.shaft", "box.pinion"], ["box.wheel", "mill.tail"]],
    "components": [
      {"name": "mill", "elements": [{"name": "tail", "type": "ShaftDiscrete", "stiffness": 5e4, "damping": 3},
                                    {"name": "drum", "type": "Disk", "inertia": 8, "damping": 0.5}]},
      {"name": "motor", "colour": "red", "elements": [
        {"name": "rotor", "type": "Disk", "inertia": 0.5, "damping": 0, "excitation": {"values": [1]}},
        {"name": "shaft", "type": "ShaftDiscrete", "stiffness": 2e4, "damping": 1}]},
      {"name": "box", "elements": [
        {"name": "pinion", "type": "GearElement", "inertia": 0.01, "teeth": 20},
        {"name": "wheel", "type": "GearElement", "inertia": 0.2, "teeth": 60, "parent": "pinion", "finish": "ground"},
        {"name": "brake", "type": "Brake"}]}]})";
  const std::string in = (folder / "train.json").string(), out = (folder / "train.toml").string();
  const auto done = drev_command({"import", in, "--out", out});
  INFO(done.err);
  REQUIRE(done.exit_code == 0);
  for (const char* part :
       {"the excitation of motor.rotor", "\"finish\" of box.wheel", "the element box.brake of type Brake"})
    CHECK(contains(done.err, part));
  CHECK(contains(read_file(out), "# Not taken over: the element box.brake"));
  // Referred to the motor: J_1 0.5 - 2e4 - 0.01 + 0.2/9 - 5e4/9 - 8/9.
  const double j_1 = 0.5, j_2 = 0.01 + 0.2 / 9.0, j_3 = 8.0 / 9.0, k_1 = 2e4, k_2 = 5e4 / 9.0;
  const double a = k_1 / j_1 + (k_1 + k_2) / j_2 + k_2 / j_3;
  const double b = k_1 * k_2 * (j_1 + j_2 + j_3) / (j_1 * j_2 * j_3);
  const double w = std::sqrt(0.5 * (a - std::sqrt(a * a - 4.0 * b)));
  CHECK(first_frequency(out) == Approx(w / 6.283185307179586).epsilon(1e-10));
}

TEST_CASE("A continuous shaft of openTorsion has its stiffness and mass", "[import]") {
  const drev::test::TemporaryFolder folder;
  std::ofstream(folder / "bar.json") << R"({"components": [{"name": "c", "elements": [
      {"name": "a", "type": "Disk", "inertia": 1, "damping": 0},
      {"name": "s", "type": "ShaftContinuous", "length": 1000, "innerDiameter": 0, "outerDiameter": 50},
      {"name": "b", "type": "Disk", "inertia": 1, "damping": 0}]}]})";
  const std::string out = (folder / "bar.toml").string();
  REQUIRE(drev_command({"import", (folder / "bar.json").string(), "--out", out}).exit_code == 0);
  // Consistent mass rho J L / 6 (2 1; 1 2): the discs against each other have 1 + m each, m = rho J L / 6.
  const double polar = 3.141592653589793 * std::pow(0.05, 4) / 32.0, k = 80e9 * polar,
               m = 8000.0 * polar / 6.0;
  CHECK(first_frequency(out) == Approx(std::sqrt(2.0 * k / (1.0 + m)) / 6.283185307179586).epsilon(1e-10));
}

TEST_CASE("A mass-elastic table: masses, shafts, gear, diameters", "[import]") {
  const drev::test::TemporaryFolder folder;
  std::ofstream(folder / "table.csv")
      << "# a train\nnode,inertia_kg_m2,stiffness_MNm_per_rad,damping_Nms_per_rad,ratio,"
         "diameter_mm,remark\n"
         "motor,0.5,0.02,1,,45,new\n"
         "pinion,0.01,,,-0.333333333333333333,,\n"
         "wheel,0.2,0.05,3,,60,\n"
         "drum,8,,,,,\n";
  const std::string out = (folder / "table.toml").string();
  const auto done = drev_command({"import", (folder / "table.csv").string(), "--out", out, "--json"});
  INFO(done.err);
  REQUIRE(done.exit_code == 0);
  CHECK(nlohmann::json::parse(done.out).at("nodes") == 4);
  CHECK(contains(done.err, "the column \"remark\""));
  CHECK(contains(read_file(out), "motor_pinion = { diameter_m = 0.045 }"));
  const double j_1 = 0.5, j_2 = 0.01 + 0.2 / 9.0, j_3 = 8.0 / 9.0, k_1 = 2e4, k_2 = 5e4 / 9.0;
  const double a = k_1 / j_1 + (k_1 + k_2) / j_2 + k_2 / j_3;
  const double b = k_1 * k_2 * (j_1 + j_2 + j_3) / (j_1 * j_2 * j_3);
  CHECK(first_frequency(out) ==
        Approx(std::sqrt(0.5 * (a - std::sqrt(a * a - 4.0 * b))) / 6.283185307179586).epsilon(1e-10));
}

TEST_CASE("Faults of what is imported are named, all at once", "[import]") {
  const drev::test::TemporaryFolder folder;
  const auto said = [&](const char* name, const std::string& text) {
    std::ofstream(folder / name) << text;
    const auto outcome = drev_command({"import", (folder / name).string()});
    CHECK(outcome.exit_code == 2);
    return outcome.err;
  };
  const std::string table = said("t.csv", "node,inertia,stiffness_Nm_per_rad\na,1,-3\na,x,\n");
  for (const char* part : {"the column inertia has no unit", "lacks the column inertia_kg_m2",
                           "t.csv:2: stiffness_Nm_per_rad = -3, must be a number >= 0",
                           "the node a is there already, in line 2"})
    CHECK(contains(table, part));
  CHECK(contains(said("u.csv", "inertia_kg_m2\n1\n2\n"),
                 "has neither a stiffness, a damping nor a ratio other than 0"));
  CHECK(contains(said("w.csv", "inertia_kg_m2,stiffness_MN\n1,2\n2,\n"), "has a unit that it cannot have"));
  CHECK(contains(said("x.csv", "node,inertia_kg_m2,stiffness_Nm_per_rad\na,1,2\nb,,\n"),
                 "x.csv: x/b: inertia = 0 kg m^2"));
  CHECK(contains(said("v.csv", ""), "has no line with the names"));
  CHECK(contains(said("q.csv", "node,inertia_kg_m2,stiffness_Nm_per_rad\n\"a, b\",1,\"1,5\"\nc,1,\n"),
                 "q.csv:2: stiffness_Nm_per_rad = 1,5, must be a number"));
  CHECK(contains(said("r.csv", "node,inertia_kg_m2\n\"a,1\n"),
                 "r.csv:2: the quotes that begin here do not end"));
  CHECK(contains(said("a.json", "{"), "is no JSON"));
  CHECK(contains(said("b.json", "[]"), "no JSON of openTorsion"));
  const std::string train =
      said("c.json", R"({"structure": [["a.x", "z.y"]], "components": [{"name": "a", "elements": [
      {"name": "x", "type": "Disk", "inertia": "much"}]}, {"name": "b", "elements": []}]})");
  for (const char* part : {"structure[0]: names z.y, which is none", "must connect all components"})
    CHECK(contains(train, part));
  CHECK(contains(said("d.json", R"({"components": [{"name": "a", "elements": [
      {"name": "x", "type": "Disk", "inertia": "much"}]}]})"),
                 "a.x: inertia = \"much\" kg m^2, must be a number >= 0"));
  CHECK(drev_command({"import"}).exit_code == 2);
  CHECK(drev_command({"import", "train.xml"}).exit_code == 2);
}

TEST_CASE("Every connection of an openTorsion train is between elements that are there", "[import]") {
  const drev::test::TemporaryFolder folder;
  const auto said =
      [&](const std::string& structure, const std::string& last) {
        std::ofstream(folder / "t.json")
            << R"({"components": [{"name": "A", "elements": [{"type": "Disk", "name": "d1", "inertia": 2},
        {"type": "ShaftDiscrete", "name": "s1", "stiffness": 1e4}, {"type": "Disk", "name": "d2", "inertia": 3}]},
        {"name": "B", "elements": [{"type": "ShaftDiscrete", "name": "s", "stiffness": 2e4},
        {"type": "Disk", "name": "d3", "inertia": )"
            << last << R"(}]}], "structure": )" << structure << "}";
        const auto outcome = drev_command({"import", (folder / "t.json").string()});
        CHECK(outcome.exit_code == (structure == R"([["A.d2", "B.s"]])" && last == "1" ? 0 : 2));
        return outcome.err;
      };
  CHECK(said(R"([["A.d2", "B.s"]])", "1").empty());
  CHECK(contains(said(R"([["A.nosuch", "B.s"]])", "1"),
                 "structure[0]: names A.nosuch, which is none of the elements A.d1, A.s1, A.d2"));
  CHECK(contains(said(R"([["A.d2", "B.zs"]])", "1"), "did you mean 'B.s'?"));
  CHECK(contains(said(R"([["A.d2", "b.s"]])", "1"),
                 "names b.s, which is none of the components; there are A, B"));
  CHECK(contains(said(R"([["A.d2", "B.d3"]])", "1"), "connected by its first element, B.s"));
  CHECK(contains(said(R"([["A.d2", "A.d1"]])", "1"), "connects A with no part of the train"));
  CHECK(contains(said(R"([["A.d2", "B.s"], ["A.d1", "B.s"]])", "1"), "connects B a second time"));
  // What is wrong inside a component that nothing leads to is said with the rest.
  const std::string train = said(R"([["A", "B"]])", "-1");
  for (const char* part : {"names A, a component, in place of", "names B, a component", "B.d3: inertia = -1"})
    CHECK(contains(train, part));
}

TEST_CASE("What a mass-elastic table says that is not taken over is said", "[import]") {
  const drev::test::TemporaryFolder folder;
  const auto outcome =
      [&](const std::string& rows) {
        std::ofstream(folder / "t.csv")
            << "inertia_kg_m2,stiffness_Nm_per_rad,damping_Nms_per_rad,ratio,diameter_mm,bore_mm\n" + rows;
        return drev_command({"import", (folder / "t.csv").string(), "--out", (folder / "t.toml").string()});
      };
  CHECK(contains(outcome("1,0,5,2,,\n1,,,,,\n").err, "t.csv:2: has a damping and a ratio"));
  const auto taken = outcome("1,0,0,2,100,\n1,5,,0,,50\n1,0,7,0,0,0\n2,,,,,\n");
  CHECK(taken.exit_code == 0);
  CHECK(contains(taken.out + taken.err, "the diameter of the gear mass_1_mass_2"));
  CHECK(contains(taken.out + taken.err, "the bore of mass_2_mass_3, which has no diameter"));
  for (const char* last : {"1,5,,,,\n2,,7,,,\n", "1,5,,,,\n2,,,,90,\n", "1,5,,,,\n2,3,,,,\n"}) {
    const auto rest = outcome(last);
    CHECK(contains(rest.out + rest.err, "the shaft behind the last mass, mass_2"));
  }
  const auto filled = outcome("1,5,0,0,0,0\n2,0,0,0,0,0\n");
  CHECK(filled.exit_code == 0);
  CHECK_FALSE(contains(filled.out + filled.err, "last mass"));
}

TEST_CASE("Columns of a mass-elastic table that say the same, or are spelt otherwise, are named",
          "[import]") {
  const drev::test::TemporaryFolder folder;
  const auto said = [&](const std::string& text) {
    std::ofstream(folder / "t.csv") << text;
    const auto outcome = drev_command({"import", (folder / "t.csv").string()});
    CHECK(outcome.exit_code == 2);
    return outcome.err;
  };
  CHECK(contains(said("inertia_kg_m2,stiffness_Nm_per_rad,stiffness_kNm_per_rad\n1,5,9\n2,,\n"),
                 "t.csv:1: the columns stiffness_Nm_per_rad and stiffness_kNm_per_rad state the same"));
  const std::string capital = said("inertia_kg_m2,Stiffness_Nm_per_rad\n1,5\n2,\n");
  CHECK(contains(capital, "has neither a stiffness, a damping nor a ratio other than 0"));
  CHECK(contains(capital, "the column \"Stiffness_Nm_per_rad\"; did you mean stiffness_Nm_per_rad"));
  CHECK(contains(said("J [kgm2],stiffness_Nm_per_rad\n1,5\n2,\n"),
                 "the column \"J [kgm2]\"; did you mean inertia_kg_m2"));
  CHECK(contains(said("Node,inertia_kg_m2,NAME\na,1,A\nb,2,B\n"), "the column \"Node\"; did you mean node?"));
  std::ofstream(folder / "t.json") << "{\n\"components\": [\n}";
  CHECK(contains(drev_command({"import", (folder / "t.json").string()}).err,
                 "t.json:3: is no JSON: unexpected"));
}

TEST_CASE(
    "Gears of openTorsion have a ratio by what both state, and a file that is no text is said to be none",
    "[import]") {
  const drev::test::TemporaryFolder folder;
  const auto outcome = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return drev_command({"import", (folder / name).string()});
  };
  const auto gears = [&](const std::string& first, const std::string& second) {
    return outcome("g.json", R"({"components": [{"name": "A", "elements": [
      {"name": "d", "type": "Disk", "inertia": 1}, {"name": "s", "type": "ShaftDiscrete", "stiffness": 100},
      {"name": "g", "type": "GearElement", "inertia": 1, )" +
                                 first + R"(},
      {"name": "h", "type": "GearElement", "inertia": 1, )" +
                                 second + "}]}]}");
  };
  CHECK(
      contains(gears(R"("teeth": 20)", R"("diameter": 100, "parent": "g")").err,
               "A.h: has diameter and its parent teeth: a ratio takes teeth of both, or diameters of both"));
  CHECK(contains(gears(R"("teeth": 20, "diameter": 50)", R"("diameter": 100, "parent": "g")").out,
                 "ratio = -0.5"));
  CHECK(
      contains(gears(R"("teeth": 20, "parent": null)", R"("teeth": 40, "parent": "g")").out, "ratio = -0.5"));
  CHECK(contains(gears(R"("teeth": 20)", R"("teeth": 0, "parent": "g")").err,
                 "A.h: teeth = 0, must be a number > 0"));
  CHECK(contains(gears(R"("teeth": 20)", R"("teeth": 40, "parent": 3)").err,
                 "A.h.parent: must be the name of a gear in quotes"));
  CHECK(contains(gears(R"("teeth": 20)", R"("teeth": 1e999)").err, "g.json: has a number that is too large"));
  for (const std::string& name : {std::string("Mot\xF6r"), std::string("M\0o\0", 4)}) {
    const auto other =
        outcome("t.csv", "node,inertia_kg_m2,stiffness_Nm_per_rad\n" + name + ",1,100\nb,1,\n");
    CHECK(contains(other.err, "t.csv:2: is no text in UTF-8"));
    CHECK(other.exit_code == 2);
  }
}

// Files that include others: names, runs, nodes and elements laid over theirs; conditions, texts as parameters; [class].
#include <drev/app/model_file/model_file.hpp>
#include <drev/core/system.hpp>
#include <drev/solvers/strength/section_strength.hpp>

#include <cmath>
#include <fstream>

#include "app/model_file/writing/export.hpp"
#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using namespace drev;
using drev::test::contains;

namespace {

constexpr const char* kBase = R"(format = 1
name = "base"
summary = "what both have"
[parameters]
drive = { default = "gears", choices = ["gears", "held"], meaning = "how it is driven" }
[tables]
lift_1 = { deflection_rad = [-1, 0, 1], torque_Nm = [-10, 0, 30] }
lift_2 = { deflection_rad = [-1, 0, 1], torque_Nm = [-20, 0, 40] }
[nodes]
a = { initial_angle_deg = 5 }
b = {}
[elements]
J_a = { type = "inertia", node = "a", inertia_kg_m2 = 1 }
J_b = { type = "inertia", node = "b", inertia_kg_m2 = 2 }
shaft = { type = "shaft_spring", nodes = ["a", "b"], stiffness_Nm_per_rad = 100, damping_Nms_per_rad = 1, when = "drive == 'gears'" }
wall = { type = "ground_spring", node = "b", stiffness_Nm_per_rad = 70, when = "drive != 'gears'" }
[[repeat]]
count = 2
[repeat.elements."stop_{i}"]
type = "polyline_spring"
nodes = ["a", "b"]
points = "lift_{i}"
[run]
duration_s = 2
record = ["a.angle_rad"]
[run.long]
duration_s = 20
[class]
rated_speed_rpm = 1500
[class.sections]
"s*" = { diameter_mm = 40, permissible_stress_MPa = 50 }
)";

ModelCase case_of(const test::TemporaryFolder& folder, const std::string& main, const std::string& run = "",
                  const std::string& drive = "gears") {
  std::ofstream(folder / "base.toml") << kBase;
  std::ofstream(folder / "main.toml") << main;
  const app::ModelFile file((folder / "main.toml").string(), run);
  Parameters parameters(file.entry().name, file.entry().parameters);
  parameters.set("drive", drive);
  return file.entry().build(parameters);
}

const char* const kInclude = "format = 1\ninclude = \"base.toml\"\n";

}  // namespace

TEST_CASE("A base file brings its name and runs, the file that includes it lays its own over them") {
  const test::TemporaryFolder folder;
  ModelCase plain = case_of(folder, kInclude);
  CHECK(plain.model.name() == "base");
  CHECK(plain.duration == 2.0);
  CHECK(case_of(folder, kInclude, "long").duration == 20.0);
  const std::string own =
      std::string(kInclude) + "name = \"mine\"\n[run]\nduration_ms = 500\n[run.long]\nstep_s = 1e-5\n";
  plain = case_of(folder, own);
  CHECK(plain.model.name() == "mine");
  CHECK(plain.duration == 0.5);  // another unit of the same key
  CHECK(plain.channels == std::vector<std::string>{"a.angle_rad"});
  CHECK(case_of(folder, own, "long").duration == 20.0);
  CHECK(case_of(folder, own, "long").default_step == 1e-5);
}

TEST_CASE("Nodes and elements of a base file are changed key by key, or replaced") {
  const test::TemporaryFolder folder;
  const auto diagonal = [&](const std::string& more, const std::string& drive = "gears") {
    const System system = case_of(folder, kInclude + more, "", drive).model.build();
    return system.stiffness_values()[system.diagonal_slots()[1]];
  };
  CHECK(diagonal("") == 100.0);
  CHECK(diagonal("[elements]\nshaft = { stiffness_kNm_per_rad = 3 }\n") == 3000.0);
  CHECK(diagonal("[elements]\nshaft = { when = false }\n") == 0.0);
  CHECK(diagonal(
            "[elements]\nshaft = { type = \"ground_spring\", node = \"b\", stiffness_Nm_per_rad = 9 }\n") ==
        9.0);
  CHECK(diagonal("", "held") == 70.0);
  CHECK_THROWS_WITH(
      case_of(folder, std::string(kInclude) + "[elements]\nstop_2 = { friction_Nm = 1 }\n"),
      Catch::Contains("base.toml:19") &&
          Catch::Contains("names that a [[repeat]] makes, or files beside each other have, are not laid"));
  const ModelCase turned =
      case_of(folder, std::string(kInclude) + "[nodes]\na = { initial_angle_rad = 0.5 }\n");
  const System system = turned.model.build();
  CHECK(system.initial_deviation()[0] == 0.5);
}

TEST_CASE("Parameters of a base file are changed key by key, a plain value being the default") {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "base.toml")
      << "format = 1\n[parameters]\nk = { default = 100, min = 1, max = 1000, meaning = \"stiff\" }\n"
         "n = { default = 3, whole = true }\nm = 2\nmode = { default = \"x\", choices = [\"x\", \"y\"] }\n"
         "[nodes]\na = {}\n[elements]\nJ = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n";
  const auto parameters = [&](const std::string& own) {
    std::ofstream(folder / "main.toml") << kInclude << "[parameters]\n" << own;
    return app::ModelFile((folder / "main.toml").string(), "").entry().parameters;
  };
  const auto all = parameters("k = 200\nn = { default = 4 }\nm = { min = 1 }\nmode = \"y\"\n");
  REQUIRE(all.size() == 4);
  CHECK((all[0].default_text == "200" && all[0].low == 1.0 && all[0].high == 1000.0));
  CHECK(all[0].meaning == "stiff");
  CHECK((all[1].default_text == "4" && all[1].kind == Parameter::Kind::integer));
  CHECK((all[2].default_text == "2" && all[2].low == 1.0));
  CHECK((all[3].default_text == "y" && all[3].choices.size() == 2));
  CHECK_THROWS_WITH(parameters("k = { default = 5000 }\n"),
                    Catch::Contains("main.toml:4") && Catch::Contains("5000 is not between min and max"));
}

TEST_CASE("A table's name is filled in, as a file's is") {
  const test::TemporaryFolder folder;
  const ModelCase model_case = case_of(folder, kInclude);
  const System system = model_case.model.build();
  REQUIRE(system.scalars().size() == 2);
  CHECK(system.scalars()[0].force->evaluate({.x = 1.0}).y == Approx(30.0));
  CHECK(system.scalars()[1].force->evaluate({.x = 1.0}).y == Approx(40.0));
}

TEST_CASE("What sections may carry is read, for each element that the name fits, and written again") {
  const test::TemporaryFolder folder;
  const std::string own =
      std::string(kInclude) +
      "[class.sections]\nshaft = { diameter_mm = 50, tensile_strength_MPa = 600, shape_factor = 0.6, "
      "sn_range_MPa = 100 }\n";
  const ModelCase model_case = case_of(folder, own);
  const Strength& strength = *model_case.strength;
  CHECK(strength.rated_speed == Approx(157.07963267949));
  REQUIRE(strength.sections.size() == 3);
  CHECK(strength.sections[0].element == "stop_1");
  CHECK(strength.sections[0].diameter == Approx(0.04));
  CHECK(strength.sections[2].element == "shaft");
  CHECK(strength.sections[2].diameter == Approx(0.05));
  CHECK(strength.sections[2].tensile_strength == Approx(600e6));
  CHECK(strength.sections[2].sn.slope == 5.0);
  const app::ModelFile file((folder / "main.toml").string(), "");
  const Parameters parameters(file.entry().name, file.entry().parameters);
  std::ofstream(folder / "again.toml") << app::export_model(file.entry(), parameters, model_case);
  const app::ModelFile again((folder / "again.toml").string(), "");
  const Strength same =
      *again.entry().build(Parameters(again.entry().name, again.entry().parameters)).strength;
  REQUIRE(same.sections.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(same.sections[i].element == strength.sections[i].element);
    CHECK(same.sections[i].diameter == strength.sections[i].diameter);
    CHECK((same.sections[i].shape_factor == strength.sections[i].shape_factor || i < 2));
  }
}

TEST_CASE("Faults of [class], of conditions and of texts as parameters have their lines") {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "base.toml") << kBase;
  std::ofstream(folder / "main.toml")
      << kInclude
      << "[parameters]\nmode = { default = \"x\", choices = [\"y\"] }\n"
         "[nodes]\nc = { when = \"drive\" }\n"
         "[elements]\nJ_c = { type = \"inertia\", node = \"c\", inertia_kg_m2 = 1 }\n"
         "[class]\nmisfire = { cylinder = 1 }\n[class.sections]\n"
         "shft = { diameter_mm = 30 }\nshaft = { diameter = 30 }\n";
  const auto refused = test::drev_command({"check", (folder / "main.toml").string()});
  INFO(refused.err);
  CHECK(refused.exit_code == 2);
  for (const char* part :
       {"main.toml:4:20: parameters.mode.default, must be one of y", "c.when", "is no condition"})
    CHECK(contains(refused.err, part));
  std::ofstream(folder / "main.toml") << kInclude
                                      << "[class]\nmisfire = { cylinder = 1 }\n[class.sections]\n"
                                         "shft = { diameter_mm = 30 }\nshaft = { diameter = 30 }\n";
  const auto sections = test::drev_command({"check", (folder / "main.toml").string()});
  INFO(sections.err);
  for (const char* part :
       {"class.misfire.cylinder, is none of [parameters]", "class.sections.shft, is the name of no element",
        "did you mean 'shaft'?", "class.sections.shaft.diameter, needs a unit"})
    CHECK(contains(sections.err, part));
  std::ofstream(folder / "main.toml")
      << kInclude << "[class.sections]\nshaft = { diameter_mm = 30, bore_mm = 31 }\n";
  CHECK(contains(test::drev_command({"check", (folder / "main.toml").string()}).err, ">= 0 and < diameter"));
}

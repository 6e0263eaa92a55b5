// Engines, dampers and planets in the report: the drawing's nodes, joints and loads, channels with their energies.
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "app/report/report_page.hpp"
#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

namespace {

nlohmann::json report_of(const std::string& file, const std::string& duration) {
  const drev::test::TemporaryFolder folder;
  const std::string page = (folder / "r.html").string();
  REQUIRE(drev::test::drev_command(
              {"run", file, "--duration", duration, "--settle", "0", "--report", page, "--quiet"})
              .exit_code == 0);
  return nlohmann::json::parse(drev::app::blocks_of(drev::test::read_file(page)).at(0));
}

}  // namespace

TEST_CASE("The report draws an engine with a rubber damper", "[report]") {
  const drev::test::TemporaryFolder folder;
  const std::string file = (folder / "engine.toml").string();
  std::ofstream(file) << R"(format = 1
[nodes]
throw_1 = {}
throw_2 = {}
flywheel = { nominal_speed_rpm = 1900 }
[elements]
J_1 = { type = "inertia", node = "throw_1", inertia_kg_m2 = 0.05 }
J_2 = { type = "inertia", node = "throw_2", inertia_kg_m2 = 0.05 }
J = { type = "inertia", node = "flywheel", inertia_kg_m2 = 1 }
web = { type = "shaft_spring", nodes = ["throw_1", "throw_2"], stiffness_kNm_per_rad = 400, damping_Nms_per_rad = 20 }
shaft = { type = "shaft_spring", nodes = ["throw_2", "flywheel"], stiffness_kNm_per_rad = 500, damping_Nms_per_rad = 20 }
damper = { type = "torsional_damper", node = "throw_1", ring_inertia_kg_m2 = 0.05, natural_frequency_Hz = 180, loss_factor = 0.15, lowest_frequency_Hz = 120, highest_frequency_Hz = 240 }
engine = { type = "engine_cylinders", nodes = ["throw_1", "throw_2"], bore_mm = 100, stroke_mm = 120, rod_mm = 200, oscillating_mass_kg = 2, firing_order = "1-2", pressure = { angle_deg = [0, 10, 30, 90, 180, 540, 690], pressure_bar = [50, 60, 20, 5, 2, 1, 30] } }
[run]
duration_s = 0.06
step_s = 1e-5
record = ["damper.torque_Nm", "damper.deflection_rad", "engine_1.torque_Nm"]
)";
  const nlohmann::json data = report_of(file, "0.02");
  // One spring between hub and ring, whatever chain stands for rubber in time: soft below its band.
  int dampers = 0;
  for (const nlohmann::json& joint : data["model"]["joints"]) {
    CHECK(joint.value("stiffness", 1.0) > 0.0);
    if (joint["name"] != "damper") continue;
    ++dampers;
    CHECK(joint["nodes"].size() == 2);
    const double stiffness = joint["stiffness"], nominal = 0.05 * 1130.97 * 1130.97;
    CHECK(stiffness > 0.5 * nominal);
    CHECK(stiffness < nominal);
  }
  CHECK(dampers == 1);
  CHECK(data["model"]["loads"].size() == 2);  // a cylinder a throw
  std::set<std::string> names;
  for (const nlohmann::json& series : data["history"]["series"]) names.insert(series["name"]);
  for (const char* name : {"damper.torque_Nm", "damper.deflection_rad", "engine_1.torque_Nm"})
    CHECK(names.contains(name));
}

TEST_CASE("The report draws a planetary train and its torques by expressions", "[report]") {
  const nlohmann::json data = report_of(DREV_SOURCE_DIR "/models/wind_turbine/wind_turbine.toml", "0.05");
  int meshes = 0, sets = 0;
  for (const nlohmann::json& joint : data["model"]["joints"]) {
    meshes += joint["type"] == "gear mesh" ? 1 : 0;
    sets += joint["type"] == "planetary set" ? 1 : 0;
  }
  CHECK(meshes >= 6);
  CHECK(sets >= 1);
  REQUIRE(data["model"]["loads"].size() == 2);
  for (const nlohmann::json& load : data["model"]["loads"]) CHECK(load["type"] == "torque function");
  // The first mode swings rotor against generator.
  CHECK(data["modes"][0]["frequency_Hz"].get<double>() == Approx(1.9272).epsilon(1e-4));
}

// Engines, dampers, planets, gears on bearings, couplings with play and modal damping in the report: the drawing's nodes,
// joints and loads, modes and channels.
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>
#include <vector>

#include "app/report/report_page.hpp"
#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

namespace {

nlohmann::json report_of(const std::string& file, const std::string& duration) {
  const drev::test::TemporaryFolder folder;
  const std::string page = (folder / "r.html").string();
  REQUIRE(drev::test::drev_command(
              {"run", file, "--duration", duration, "--settle", "0", "--energy", "--report", page, "--quiet"})
              .exit_code == 0);
  return nlohmann::json::parse(drev::app::blocks_of(drev::test::read_file(page)).at(0));
}

}  // namespace

TEST_CASE("The report draws an engine with a rubber damper", "[report][once]") {
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

TEST_CASE("The report draws a planetary train and its torques by expressions", "[report][once]") {
  const nlohmann::json data = report_of(DREV_SOURCE_DIR "/models/wind_turbine/wind_turbine.toml", "0.05");
  // Sun and ring are in mesh with each planet, which its carrier carries; of the rigid set sun and ring stand beside the carrier.
  std::map<std::string, int> joints;
  const auto name = [&](const nlohmann::json& node) {
    return data["model"]["nodes"][node.get<std::size_t>()]["name"].get<std::string>();
  };
  for (const nlohmann::json& joint : data["model"]["joints"])
    if (joint["type"] == "gear mesh" || joint["type"] == "planetary set") {
      if (joint["kind"] == "mesh") CHECK(joint["carried"] == true);
      ++joints[joint["kind"].get<std::string>() + " " + name(joint["nodes"][0]) + " " +
               name(joint["nodes"][1])];
    }
  CHECK(joints == std::map<std::string, int>{{"mesh planet_1 ring_1", 1},
                                             {"mesh planet_2 ring_1", 1},
                                             {"mesh planet_3 ring_1", 1},
                                             {"mesh sun_1 planet_1", 1},
                                             {"mesh sun_1 planet_2", 1},
                                             {"mesh sun_1 planet_3", 1},
                                             {"other planet_1 carrier_1", 2},
                                             {"other planet_2 carrier_1", 2},
                                             {"other planet_3 carrier_1", 2},
                                             {"other ring_2 carrier_2", 1},
                                             {"other sun_2 carrier_2", 1}});
  REQUIRE(data["model"]["loads"].size() == 2);
  for (const nlohmann::json& load : data["model"]["loads"]) CHECK(load["type"] == "torque function");
  // The first mode swings rotor against generator (models/wind_turbine/README.md).
  CHECK(data["modes"][0]["frequency_Hz"].get<double>() == Approx(1.9675).epsilon(1e-4));
}

TEST_CASE("The report draws gears on bearings, with their modes and channels", "[report][once]") {
  const drev::test::TemporaryFolder folder;
  const std::string file = (folder / "gears.toml").string();
  std::ofstream(file) << R"(format = 1
[nodes]
gear_1 = { nominal_speed_rpm = 900 }
gear_2 = {}
centre_1 = { kind = "translational" }
centre_2 = { kind = "translational" }
[elements]
J_1 = { type = "inertia", node = "gear_1", inertia_kg_m2 = 0.01 }
J_2 = { type = "inertia", node = "gear_2", inertia_kg_m2 = 0.01 }
m_1 = { type = "inertia", node = "centre_1", mass_kg = 8 }
m_2 = { type = "inertia", node = "centre_2", mass_kg = 8 }
bearing_1 = { type = "ground_spring", node = "centre_1", stiffness_N_per_um = 200 }
bearing_2 = { type = "ground_spring", node = "centre_2", stiffness_N_per_um = 200 }
mesh = { type = "lateral_gear_mesh", nodes = ["gear_1", "gear_2", "centre_1", "centre_2"], base_radius_1_mm = 50, base_radius_2_mm = 50, stiffness_N_per_um = 300, normal_backlash_um = 80, damping_Ns_per_m = 900, damping_law = "limited" }
swing = { type = "applied_torque", node = "gear_1", harmonics = { frequency_Hz = [300], amplitude_Nm = [60] } }
[run]
step_s = 1e-6
record = ["mesh.force_N", "mesh.deflection_m", "centre_1.position_m"]
)";
  const nlohmann::json data = report_of(file, "0.005");
  const nlohmann::json& nodes = data["model"]["nodes"];
  REQUIRE(nodes.size() == 4);
  for (const nlohmann::json& node : nodes)
    CHECK(node["turns"] == (node["name"] == "gear_1" || node["name"] == "gear_2"));
  CHECK(nodes[1]["ratio"].get<double>() == Approx(-1.0));
  CHECK(nodes[2]["ratio"] == 0.0);
  std::set<std::pair<std::string, std::vector<int>>> links;
  int bearings = 0;
  for (const nlohmann::json& joint : data["model"]["joints"]) {
    if (joint["name"] == "mesh") {
      CHECK(joint["type"] == "lateral gear mesh");
      links.emplace(joint["kind"].get<std::string>(), joint["nodes"].get<std::vector<int>>());
      if (joint["kind"] == "mesh") CHECK(joint["carried"] == false);  // drawn as gears above each other
    } else {
      ++bearings;
      CHECK(joint["nodes"].size() == 1);
      CHECK(joint["stiffness"] == 2e8);
    }
  }
  // The gears are in mesh, each beside its centre.
  CHECK(links == std::set<std::pair<std::string, std::vector<int>>>{
                     {"mesh", {0, 1}}, {"other", {0, 2}}, {"other", {1, 3}}});
  CHECK(bearings == 2);
  // y_1 - y_2 swings on the bearings alone: sqrt(k_b/m), the mesh has no share.
  bool on_bearings = false;
  for (const nlohmann::json& mode : data["modes"])
    if (std::abs(mode["frequency_Hz"].get<double>() - 5000.0 / 6.283185307179586) < 1e-6) {
      on_bearings = true;
      CHECK(mode["energy"].size() == 2);
      for (const nlohmann::json& part : mode["energy"]) CHECK(part["share"].get<double>() == Approx(0.5));
    }
  CHECK(on_bearings);
  std::map<std::string, std::string> units;
  for (const nlohmann::json& series : data["history"]["series"]) units[series["name"]] = series["unit"];
  CHECK(units == std::map<std::string, std::string>{{"mesh.force_N", "N"},
                                                    {"mesh.deflection_m", "m"},
                                                    {"centre_1.position_m", "m"},
                                                    {"kinetic", "J"},
                                                    {"stored", "J"}});
}

TEST_CASE("The report draws a coupling with play beside modal damping, whose heat it gives",
          "[report][once]") {
  const drev::test::TemporaryFolder folder;
  const std::string file = (folder / "play.toml").string();
  std::ofstream(file) << R"(format = 1
[nodes]
motor = { nominal_speed_rpm = 900 }
middle = {}
load = {}
[elements]
J_1 = { type = "inertia", node = "motor", inertia_kg_m2 = 0.1 }
J_2 = { type = "inertia", node = "middle", inertia_kg_m2 = 0.05 }
J_3 = { type = "inertia", node = "load", inertia_kg_m2 = 0.3 }
spline = { type = "dead_band_coupling", nodes = ["motor", "middle"], stiffness_kNm_per_rad = 80, gap_deg = 0.4, damping_Nms_per_rad = 3 }
shaft = { type = "shaft_spring", nodes = ["middle", "load"], stiffness_kNm_per_rad = 20 }
modal = { type = "modal_damping", by_mode = { ratio = [0.01, 0.02] } }
swing = { type = "applied_torque", node = "motor", harmonics = { frequency_Hz = [60], amplitude_Nm = [60] } }
[run]
step_s = 1e-5
record = ["spline.torque_Nm", "spline.deflection_rad", "shaft.torque_Nm"]
)";
  const nlohmann::json data = report_of(file, "0.1");
  std::set<std::string> joints;
  for (const nlohmann::json& joint : data["model"]["joints"]) {
    joints.insert(joint["name"]);
    if (joint["name"] != "spline") continue;
    CHECK(joint["type"] == "dead-band coupling");
    CHECK(joint["kind"] == "spring");
    CHECK(joint["stiffness"] == 8e4);
    CHECK(joint["gap"].get<double>() == Approx(0.4 * 3.14159265358979 / 180.0));
  }
  CHECK(joints == std::set<std::string>{"spline", "shaft"});  // modal damping joins nothing
  // Two elastic modes of the closed train: J = .1, .05, .3, k = 8e4, 2e4.
  REQUIRE(data["modes"].size() == 2);
  for (const nlohmann::json& mode : data["modes"]) {
    const double w_2 = std::pow(6.283185307179586 * mode["frequency_Hz"].get<double>(), 2);
    CHECK(0.1 * 0.05 * 0.3 * w_2 * w_2 + 8e4 * 2e4 * 0.45 ==
          Approx((8e4 * 0.3 * 0.15 + 2e4 * 0.1 * 0.35) * w_2).epsilon(1e-6));
  }
  std::set<std::string> names;
  for (const nlohmann::json& series : data["history"]["series"]) names.insert(series["name"]);
  CHECK(names == std::set<std::string>{"spline.torque_Nm", "spline.deflection_rad", "shaft.torque_Nm",
                                       "kinetic", "stored"});
  // Input = heat of coupling and modal damping + kinetic and stored energy, which the elements' figures give.
  std::map<std::string, double> heat;
  double work = 0.0;
  for (const nlohmann::json& element : data["result"]["results"]["elements"]) {
    if (element["dissipated_J"].is_number()) heat[element["element"]] = element["dissipated_J"];
    work += element["work_J"].get<double>();
  }
  CHECK(heat.size() == 2);
  CHECK(heat["modal"] > 0.1 * heat["spline"]);
  const nlohmann::json& energy = data["result"]["energy"];
  CHECK(heat["modal"] + heat["spline"] == Approx(energy["dissipated_J"].get<double>()).epsilon(1e-9));
  CHECK(work == Approx(energy["kinetic_J"].get<double>()).epsilon(1e-9));  // from rest
}

// drev sweep where curves end: motions of a linear train that grow between two multipliers of +1.
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using Json = nlohmann::json;

TEST_CASE("A motion that grows slowly in a tongue of +1 has no statistics, and the curve's end its speed",
          "[sweep]") {
  const drev::test::TemporaryFolder folder;
  std::ofstream(folder / "mesh.toml")
      << "format = 1\n[nodes]\npinion = { nominal_speed_rpm = 2000, hold = true }\nwheel = {}\n[elements]\n"
         "J = { type = \"inertia\", node = \"wheel\", inertia_kg_m2 = 0.01 }\n"
         "load = { type = \"engine_order_torque\", node = \"wheel\", mean_Nm = 50 }\n"
         "mesh = { type = \"gear_mesh\", nodes = [\"pinion\", \"wheel\"], base_radius_1_mm = 50, "
         "base_radius_2_mm = 50, teeth_1 = 30, damping_Ns_per_m = 200, damping_law = \"always\", "
         "stiffness_fourier = { mean_N_per_m = 2e8, harmonics = { order = [1], amplitude_N_per_m = [1.2e8] } "
         "} "
         "}\n";
  // Floquet's theorem by a separate integration (Dormand and Prince of order 8): a multiplier of +1 at 1087.07699 and
  // 1102.33818 rpm, 1.033 a cycle at 1100 rpm.
  const std::vector<std::string> words{"sweep", (folder / "mesh.toml").string(), "--speeds", "1080:10:1100"};
  std::vector<std::string> as_json = words;
  as_json.emplace_back("--json");
  const auto printed = drev_command(as_json);
  REQUIRE(printed.exit_code == 0);
  const Json json = Json::parse(printed.out);
  int grows = 0;
  for (const Json& run : json.at("runs")) {
    CAPTURE(run.dump());
    const std::string reason = run.at("reason");
    CHECK(contains(reason, "grows without bound"));
    ++grows;
  }
  CHECK(grows == 2);
  const auto text = drev_command(words);
  CHECK(contains(text.out, "could not be followed to its end: it was left at 1087.0"));
  CHECK(contains(text.out,
                 "No fold and no loss of stability was located, as far as the curves could be followed."));
  CHECK(!contains(text.out, "neither fold nor lose"));
}

TEST_CASE("Orders of a sweep may be quotients", "[sweep]") {
  const drev::test::TemporaryFolder folder;
  std::ofstream(folder / "thirds.toml")
      << "format = 1\n[nodes]\na = { nominal_speed_rpm = 1200, hold = true }\nb = {}\n[elements]\n"
         "J = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 1 }\n"
         "s = { type = \"shaft_spring\", nodes = [\"a\", \"b\"], stiffness_kNm_per_rad = 20, "
         "damping_Nms_per_rad = 5 }\n"
         "t = { type = \"engine_order_torque\", node = \"b\", harmonics = { order = [0.5, "
         "0.6666666666666666], "
         "amplitude_Nm = [50, 40], phase_deg = [0, 30] }, twist_feedback = false }\n"
         "[run]\nduration_s = 3\nstart = \"periodic\"\n";
  const std::string file = (folder / "thirds.toml").string();
  const auto printed =
      drev_command({"sweep", file, "--speeds", "1000,1200", "--orders", "1/2,2/3", "--json"});
  REQUIRE(printed.exit_code == 0);
  const Json json = Json::parse(printed.out);
  CHECK(json.at("orders") == Json({0.5, 2.0 / 3.0}));
  CHECK(json.at("left_out").empty());
  const auto rounded = drev_command({"sweep", file, "--speeds", "1000,1200", "--orders", "0.5,0.6667"});
  CHECK(rounded.exit_code == 2);
  CHECK(contains(rounded.err, "2/3 needs all its digits"));
  // The cycle of six turns is the model's own.
  CHECK(drev_command({"run", file, "--duration", "1"}).exit_code == 0);
}

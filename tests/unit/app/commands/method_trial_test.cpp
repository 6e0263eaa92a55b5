// drev run takes the cheaper method where the one that suits the model is far too dear, and says so.
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using drev::test::read_file;
using Json = nlohmann::json;

TEST_CASE("A run says that another method took the place of one far too dear, in text, JSON and report",
          "[once]") {
  const drev::test::TemporaryFolder folder;
  const std::string path = (folder / "stiff.toml").string(), report = (folder / "r.html").string();
  std::ofstream(path)
      << "format = 1\n[parameters]\nmount = 500\n[nodes]\nmotor = {}\nload = {}\n[elements]\n"
         "J_motor = { type = \"inertia\", node = \"motor\", inertia_kg_m2 = 0.012 }\n"
         "J_load = { type = \"inertia\", node = \"load\", inertia_kg_m2 = 0.035 }\n"
         "mount = { type = \"ground_spring\", node = \"load\", stiffness_Nm_per_rad = \"mount\", "
         "damping_Nms_per_rad = 0.05 }\n"
         "shaft = { type = \"shaft_spring\", nodes = [\"motor\", \"load\"], "
         "stiffness_Nm_per_rad = 1e9, damping_Nms_per_rad = 2000 }\n"
         "drive = { type = \"applied_torque\", node = \"motor\", harmonics = { frequency_Hz = "
         "[4], amplitude_Nm = [20], phase_deg = [-90] } }\n[run]\nduration_s = 20\n";
  const auto run = drev_command({"run", path, "--json", "--report", report});
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const Json json = Json::parse(run.out);
  CHECK(json.at("method") == "sdirk4");
  const std::string reason = json.at("method_reason");
  CHECK(contains(reason, "a trial says that it would cost about "));
  CHECK(contains(reason, "times as much as sdirk4, tolerance 0.0001"));
  CHECK(contains(read_file(report), "a trial says that it would cost about "));
  // The load follows the drive as one body of 0.047 kg m^2 on the mount (25.13 rad/s; at 103.14 rad/s it is resonant):
  // amplitude of the steady part, and as much again of the start.
  const double part = 500.0 * 20.0 / (500.0 - 0.047 * 25.13274 * 25.13274);
  const double peak = json.at("results").at("max_torque_Nm");
  CHECK(peak > part);
  CHECK(peak < 2.0 * part);
  const auto text = drev_command({"run", path});
  CHECK(contains(text.out, "Method                  sdirk4, tolerance 0.0001"));
  CHECK(contains(text.out, "a trial says"));
  // A method that was asked for stays, and so does one that --accuracy tightens.
  const auto asked = Json::parse(drev_command({"run", path, "--method", "dormand_prince", "--tolerance",
                                               "1e-3", "--settle", "1", "--json"})
                                     .out);
  CHECK(asked.at("method") == "dormand_prince");
  CHECK(asked.at("method_reason") == "asked for");
  // A table is computed as a run of its first variant.
  const auto table = drev_command(
      {"run", path, "--vary", "mount=500,501", "--table", "--out", (folder / "table").string(), "--json"});
  INFO(table.err);
  CHECK(Json::parse(table.out).at("study").at("method") == "sdirk4");
}

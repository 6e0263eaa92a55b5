// drev gear: text, JSON and report of drawings, and what is refused.
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using drev::test::read_file;

namespace {

const std::string kCamshaftGears = DREV_SOURCE_DIR "/models/camshaft_gears/camshaft_gears.toml";

void write_gears(const std::filesystem::path& path, const std::string& text) { std::ofstream(path) << text; }

const std::string kPair =
    "[geometry]\nmodule_mm = 9\nload_N_per_mm = 100\npoints = 20\ncorner_contact = false\n"
    "gear_1 = { teeth = 34, profile_shift = -0.082, width_mm = 130, bore_diameter_mm = 141.012 }\n"
    "gear_2 = { teeth = 59, profile_shift = -0.082, width_mm = 130, bore_diameter_mm = 253.512 }\n";

}  // namespace

TEST_CASE("drev gear prints, draws and reports a pair", "[gear]") {
  const drev::test::TemporaryFolder folder;
  const std::string file = (folder / "pair.toml").string(), page = (folder / "pair.html").string();
  write_gears(file, kPair);
  const auto text = drev_command({"gear", file, "--report", page});
  INFO(text.err);
  REQUIRE(text.exit_code == 0);
  for (const char* part : {"Centre distance", "417.003544 mm", "1.7705 transverse", "Tooth pair in mesh",
                           "2222", "1111", "Mesh stiffness", "+-", "ISO 6336-1", "held at their bores"})
    CHECK(contains(text.out, part));
  const std::string html = read_file(page);
  for (const char* part : {"<svg", "Tooth pair in mesh", "Load shared", "Transmission error", "</html>"})
    CHECK(contains(html, part));
  const auto json = drev_command({"gear", file, "--json"});
  REQUIRE(json.exit_code == 0);
  const nlohmann::json result = nlohmann::json::parse(json.out);
  CHECK(result.at("kind") == "gear");
  const nlohmann::json& pair = result.at("pairs")[0];
  const double mean = pair.at("mean_N_per_m2").at("value"), error = pair.at("mean_N_per_m2").at("error");
  CHECK(std::abs(mean / 17.935e9 - 1.0) < 0.02);
  CHECK(error > 0.0);
  CHECK(error < 0.005 * mean);
  CHECK(pair.at("curve").at("secant_N_per_m2").size() == 20);
  CHECK(std::abs(pair.at("gears")[0].at("tip_diameter_m").get<double>() - 0.322524) < 1e-9);
}

TEST_CASE("drev gear takes the meshes of a model file", "[gear]") {
  const auto text = drev_command({"gear", kCamshaftGears});
  REQUIRE(text.exit_code == 0);
  CHECK(contains(text.out, "mesh_1: module 8 mm"));
  CHECK(contains(text.out, "mesh_2: module 9 mm"));
}

TEST_CASE("drev gear says what cannot be", "[gear]") {
  const drev::test::TemporaryFolder folder;
  const std::string file = (folder / "pair.toml").string();
  const auto refusal = [&](const std::string& text) {
    write_gears(file, text);
    const auto outcome = drev_command({"gear", file});
    CHECK(outcome.exit_code != 0);
    CHECK(outcome.out.empty());
    return outcome.err;
  };
  // The source's mesh 1 with full tips.
  const std::string tips = refusal(
      "[geometry]\nmodule_mm = 8\nload_N_per_mm = 44.5\ngear_1 = { teeth = 59, profile_shift = -0.626, "
      "width_mm = 88, "
      "bore_diameter_mm = 200 }\ngear_2 = { teeth = 68, profile_shift = -0.626, width_mm = 88, "
      "bore_diameter_mm = 200 }\n");
  CHECK(contains(tips, "gear_1.tip_diameter"));
  CHECK(contains(tips, "fillet"));
  CHECK(contains(refusal("[other]\n"), "other"));
  CHECK(contains(refusal("format = 1\n[nodes]\na = {}\n"), "geometry"));
  CHECK(contains(refusal(kPair + "colour = 1\n"), "colour"));
  CHECK(contains(refusal("[geometry]\nmodule_mm = 9\n"), "gear_1"));
  CHECK(drev_command({"gear"}).exit_code != 0);
  CHECK(drev_command({"gear", "/nowhere.toml"}).exit_code != 0);
}

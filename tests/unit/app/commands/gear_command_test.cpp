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
  // Hertz's contacts under half and twice the load: 1.5 %, without contact outside the path.
  CHECK(pair.at("mean_load_error").at("rms").get<double>() == Approx(0.0147).epsilon(0.1));
  CHECK(contains(text.out, "between half and twice of it"));
  CHECK(std::abs(pair.at("gears")[0].at("tip_diameter_m").get<double>() - 0.322524) < 1e-9);
}

TEST_CASE("drev gear computes a planet in its ring", "[gear]") {
  const drev::test::TemporaryFolder folder;
  const std::string file = DREV_SOURCE_DIR "/models/ring_gear/ring_gear.toml",
                    page = (folder / "ring.html").string();
  const auto text = drev_command({"gear", file, "--report", page});
  INFO(text.err);
  REQUIRE(text.exit_code == 0);
  for (const char* part : {"1.6763 transverse", "the flanks allow 1.9152", "170 mm", "outside of the ring",
                           "by Weber and Banaschek, 14.3"})
    CHECK(contains(text.out, part));
  CHECK(contains(read_file(page), "Tooth pair in mesh"));
  const auto json = drev_command({"gear", file, "--json"});
  REQUIRE(json.exit_code == 0);
  const nlohmann::json result = nlohmann::json::parse(json.out);
  const nlohmann::json& pair = result.at("pairs")[0];
  CHECK(pair.at("gears")[0].at("outer_diameter_m").is_null());
  CHECK(pair.at("gears")[1].at("bore_diameter_m").is_null());
  CHECK(pair.at("gears")[1].at("outer_diameter_m") == 0.17);
  // Drawn, the teeth touch at the pitch point (0, r_w1) and nowhere overlap there: the ring's outline has a point on it.
  const nlohmann::json& ring = pair.at("gears")[1].at("outline");
  double nearest = 1.0;
  for (std::size_t i = 0; i < ring.at("x_m").size(); ++i)
    nearest =
        std::min(nearest, std::hypot(ring["x_m"][i].get<double>(), ring["y_m"][i].get<double>() - 0.024));
  CHECK(nearest < 2e-4);
  const double mean = pair.at("mean_N_per_m2").at("value"), error = pair.at("mean_N_per_m2").at("error");
  CHECK(error < 0.005 * mean);
}

TEST_CASE("drev gear takes the meshes of a model file", "[gear]") {
  const auto text = drev_command({"gear", kCamshaftGears});
  REQUIRE(text.exit_code == 0);
  CHECK(contains(text.out, "mesh_1: module 8 mm"));
  CHECK(contains(text.out, "mesh_2: module 9 mm"));
}

TEST_CASE("drev gear takes parameters and repeated meshes", "[gear]") {
  const drev::test::TemporaryFolder folder;
  const std::string file = (folder / "train.toml").string();
  write_gears(
      file,
      "format = 1\n[parameters]\nload = { default = 100, min = 1, max = 1000, meaning = \"N/mm\" }\n"
      "[nodes]\na0 = { nominal_speed_rpm = 100, hold = true }\n[[repeat]]\ncounter = \"i\"\ncount = 2\n"
      "[repeat.nodes]\n\"a{i}\" = {}\n[repeat.elements]\n\"J{i}\" = { type = \"inertia\", node = "
      "\"a{i}\", inertia_kg_m2 = 1 }\n"
      "[repeat.elements.\"mesh{i}\"]\ntype = \"gear_mesh\"\nnodes = [\"a{i - 1}\", \"a{i}\"]\n"
      "[repeat.elements.\"mesh{i}\".geometry]\nmodule_mm = 4\npoints = 10\ncorner_contact = false\n"
      "load_N_per_mm = \"load\"\nloads = { load_N_per_mm = [30, 100, 300] }\n"
      "gear_1 = { teeth = \"20 + i\", width_mm = 40, bore_diameter_mm = 35, upper_allowance_um = -60 }\n"
      "gear_2 = { teeth = 40, width_mm = 40, bore_diameter_mm = 75, upper_allowance_um = -60 }\n");
  const auto json = drev_command({"gear", file, "--set", "load=200", "--json"});
  INFO(json.err);
  REQUIRE(json.exit_code == 0);
  const nlohmann::json result = nlohmann::json::parse(json.out);
  REQUIRE(result.at("pairs").size() == 2);
  CHECK(result["pairs"][0].at("name") == "mesh1");
  CHECK(result["pairs"][1].at("name") == "mesh2");
  CHECK(result["pairs"][1].at("gears")[0].at("teeth") == 22);
  CHECK(std::abs(result["pairs"][0].at("load_N_per_m").get<double>() - 200e3) < 1e-6);
  const nlohmann::json& law = result["pairs"][0].at("load_law");
  CHECK(law.at("slopes").size() == 4);
  CHECK(law.at("error").at("most").get<double>() < law.at("error_of_constant").at("most").get<double>());
  const auto text = drev_command({"gear", "--set", "load=50", file});
  REQUIRE(text.exit_code == 0);
  CHECK(contains(text.out, "Stiffness with the load"));
  CHECK(contains(text.out, "30 to 300 N/mm"));
  CHECK(contains(drev_command({"gear", file, "--set", "load=0"}).err, "must be 1 to 1000"));
  CHECK(contains(drev_command({"gear", file, "--set", "lod=5"}).err, "did you mean 'load'?"));
  const std::string plain = (folder / "pair.toml").string();
  write_gears(plain, kPair);
  CHECK(contains(drev_command({"gear", plain, "--set", "load=5"}).err, "is no parameter"));
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

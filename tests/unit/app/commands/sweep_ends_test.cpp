// drev sweep where curves end and where runs answer: motions of a linear train that grow between two multipliers of +1;
// a free train whose load follows the speed; what couplings of rubber have in motions with contacts.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using drev::test::read_file;
using Json = nlohmann::json;

TEST_CASE("A motion that grows slowly in a tongue of +1 has no statistics, and the curve's end its speed",
          "[sweep][once]") {
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
  REQUIRE(json.at("changes").size() == 1);
  CHECK(json["changes"][0].at("what") == "branching");
  CHECK(json["changes"][0].at("speed_rpm").get<double>() == Approx(1087.07699).margin(2e-5));
  CHECK(!contains(text.out, "neither fold nor lose"));
}

TEST_CASE("A linear sweep of a train with a mode that grows says so in text, JSON and report", "[sweep]") {
  const drev::test::TemporaryFolder folder;
  std::ofstream(folder / "governed.toml")
      << "format = 1\n[nodes]\na = { nominal_speed_rpm = 600 }\n[elements]\n"
         "J = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 2 }\n"
         "gov = { type = \"speed_governor\", node = \"a\", proportional_gain_Nms_per_rad = 10, "
         "integral_gain_Nm_per_rad = 100, actuator_lag_s = 0.5 }\n"
         "t = { type = \"engine_order_torque\", node = \"a\", harmonics = { order = [1], amplitude_Nm = "
         "[100] }, "
         "twist_feedback = false }\n";
  // Routh: s^3 + 2 s^2 + 10 s + 100 = 0 has the roots -4.5814807 and 1.2907404 +- 4.4900995 i (Newton).
  const std::string page = (folder / "page.html").string();
  const std::vector<std::string> words{"sweep", (folder / "governed.toml").string(), "--speeds", "10:10:600"};
  std::vector<std::string> as_json = words, as_page = words;
  as_json.emplace_back("--json");
  as_page.insert(as_page.end(), {"--report", page});
  const auto text = drev_command(as_page);
  CHECK(contains(text.out, "The train is unstable: a mode at 0.7146 Hz grows at 1.291 1/s"));
  CHECK(contains(read_file(page), "The train is unstable: a mode at 0.7146 Hz grows at 1.291 1/s"));
  const Json grows = Json::parse(drev_command(as_json).out).at("growing_mode");
  CHECK(grows.at("rate_per_s").get<double>() == Approx(1.2907404).epsilon(1e-7));
  CHECK(grows.at("frequency_Hz").get<double>() == Approx(4.4900995 / 6.283185307).epsilon(1e-7));
}

TEST_CASE("A motion within a gap, and a train that nothing excites: the sweep says which", "[sweep][once]") {
  const drev::test::TemporaryFolder folder;
  const std::string model = (folder / "gap.toml").string();
  const auto sweep = [&](const std::string& train) {
    std::ofstream(model) << "format = 1\n[nodes]\na = { nominal_speed_rpm = 600 }\nb = {}\n[elements]\n"
                            "Ja = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n"
                            "Jb = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 2 }\n"
                            "da = { type = \"absolute_damper\", node = \"b\", damping_Nms_per_rad = 1 }\n"
                         << train;
    std::string text = drev_command({"sweep", model, "--speeds", "200,300", "--cycle", "1"}).out;
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
  };
  // 20 N m at 20 rad/s and more turn 1 kg m2 by 0.05 rad at the most, within +-0.1 rad.
  const std::string within = sweep(
      "play = { type = \"polyline_spring\", nodes = [\"a\", \"b\"], dead_band = { "
      "stiffness_Nm_per_rad = 2000, half_gap_rad = 0.1 }, damping_Nms_per_rad = 5 }\n"
      "t = { type = \"engine_order_torque\", node = \"a\", twist_feedback = false, harmonics = { order = "
      "[1], amplitude_Nm = [20] } }\n");
  CHECK(contains(within, "or a law stays within its gap throughout"));
  CHECK(!contains(within, "Nothing vibrates"));
  const std::string resting = sweep(
      "play = { type = \"dead_band_coupling\", nodes = [\"a\", \"b\"], stiffness_Nm_per_rad = 1000, "
      "gap_rad = 0.01, damping_Nms_per_rad = 2, damping_law = \"proportional\" }\n"
      "p1 = { type = \"engine_order_torque\", node = \"a\", mean_Nm = 1e3 }\n"
      "p2 = { type = \"engine_order_torque\", node = \"b\", mean_Nm = -1e3 }\n");
  CHECK(contains(resting, "Nothing vibrates at 200, 300 rpm"));
  CHECK(!contains(resting, "more harmonics than were tried"));
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

TEST_CASE("A free train whose load follows the speed is held at it: no speed runs up and down in a cycle",
          "[sweep][once]") {
  const drev::test::TemporaryFolder folder;
  std::ofstream(folder / "launch.toml")
      << "format = 1\n[nodes]\nm = { nominal_speed_rpm = 900 }\ng1 = {}\ng2 = {}\npl = {}\n[elements]\n"
         "Jm = { type = \"inertia\", node = \"m\", inertia_kg_m2 = 3 }\n"
         "J1 = { type = \"inertia\", node = \"g1\", inertia_kg_m2 = 0.2 }\n"
         "J2 = { type = \"inertia\", node = \"g2\", inertia_kg_m2 = 1.0 }\n"
         "Jp = { type = \"inertia\", node = \"pl\", inertia_kg_m2 = 20 }\n"
         "cp = { type = \"shaft_spring\", nodes = [\"m\", \"g1\"], stiffness_kNm_per_rad = 15, "
         "damping_Nms_per_rad = 8 }\n"
         "me = { type = \"gear_mesh\", nodes = [\"g1\", \"g2\"], module_mm = 5, teeth_1 = 25, teeth_2 = 60, "
         "pressure_angle_deg = 20, stiffness_N_per_um = 400, normal_backlash_um = 150, damping_Ns_per_m = "
         "3000, "
         "damping_law = \"always\" }\n"
         "sh = { type = \"shaft_spring\", nodes = [\"g2\", \"pl\"], stiffness_kNm_per_rad = 300, "
         "damping_Nms_per_rad = 30 }\n"
         "en = { type = \"engine_order_torque\", node = \"m\", mean_Nm = 283.5, harmonics = { order = [2, "
         "4], "
         "amplitude_Nm = [900, 300], phase_deg = [0, 45] }, twist_feedback = false }\n"
         "pr = { type = \"propeller\", node = \"pl\", rated_torque_Nm = 840, rated_speed_rpm = "
         "\"1000*25/60\" }\n";
  const auto printed = drev_command(
      {"sweep", (folder / "launch.toml").string(), "--speeds", "400,900", "--tolerance", "1e-6", "--json"});
  REQUIRE(printed.exit_code == 0);
  const Json json = Json::parse(printed.out);
  const auto section = [&](const std::string& name) {
    const Json& all = json.at("sections");
    return static_cast<std::size_t>(
        std::find_if(all.begin(), all.end(), [&](const Json& s) { return s.at("name") == name; }) -
        all.begin());
  };
  const auto run = std::find_if(json.at("runs").begin(), json.at("runs").end(), [](const Json& r) {
    return std::abs(r.at("speed_rpm").get<double>() - 400.0) < 1e-6;
  });
  REQUIRE(run != json.at("runs").end());
  CAPTURE(run->dump());
  // A separate integration, with a constant torque along the rigid motion and the mean speed at 400 rpm, in steps of 20
  // and of 10 us, which agree to 5e-7 of the coupling's torque and 1e-5 of the mesh's mean.
  CHECK(std::abs(run->at("lowest")[section("cp.torque_Nm")].get<double>() + 12276.463) < 0.05);
  CHECK(std::abs(run->at("highest")[section("cp.torque_Nm")].get<double>() - 11782.105) < 0.05);
  CHECK(std::abs(run->at("mean")[section("me.force_N")].get<double>() - 3211.24) < 0.05);
}

TEST_CASE("A curve of four cycles ends on that of two: each change once, no stable range without a width",
          "[sweep][once]") {
  const drev::test::TemporaryFolder folder;
  std::string model = read_file(DREV_SOURCE_DIR "/models/gear_pair/gear_pair.toml");
  const std::string amplitude = "amplitude_um = [2.5]";
  model.replace(model.find(amplitude), amplitude.size(), "amplitude_um = [5]");
  std::ofstream(folder / "pair.toml") << model;
  const std::vector<std::string> words{
      "sweep", (folder / "pair.toml").string(), "--speeds", "3250,3300,4200", "--tolerance", "1e-2"};
  std::vector<std::string> as_json = words;
  as_json.emplace_back("--json");
  const auto printed = drev_command(as_json);
  REQUIRE(printed.exit_code == 0);
  const Json changes = Json::parse(printed.out).at("changes");
  CHECK(changes.size() >= 3);
  for (std::size_t i = 0; i < changes.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const double here = changes[i].at("speed_rpm"), there = changes[k].at("speed_rpm");
      CHECK_FALSE((changes[i].at("what") == changes[k].at("what") && std::abs(here - there) < 1e-6 * here));
    }
  const std::string text = drev_command(words).out;
  const std::size_t table = text.find("turns a cycle  "), end = text.find("section");
  REQUIRE(end < text.size());
  int ranges = 0;
  for (std::size_t at = text.find(" to ", table); at < end; at = text.find(" to ", at + 4), ++ranges) {
    const std::size_t first = text.rfind(' ', at - 1) + 1, last = text.find_first_of(",\n", at);
    CHECK(text.substr(first, at - first) != text.substr(at + 4, last - at - 4));
  }
  CHECK(ranges >= 2);
}

TEST_CASE("A sweep with contacts and its class calculation say what they take couplings for",
          "[sweep][class]") {
  const drev::test::TemporaryFolder folder;
  const auto model = [&](const std::string& name, const std::string& coupling) {
    std::ofstream(folder / name)
        << "format = 1\n[nodes]\na = { nominal_speed_rpm = 1000 }\nb = {}\ng = {}\n[elements]\n"
           "Ja = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n"
           "Jb = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 1 }\n"
           "Jg = { type = \"inertia\", node = \"g\", inertia_kg_m2 = 1 }\n"
           "s = { type = \"elastic_coupling\", nodes = [\"a\", \"b\"], damping_Nms_per_rad = 1, " +
               coupling +
               " }\n"
               "mesh = { type = \"gear_mesh\", nodes = [\"b\", \"g\"], base_radius_1_mm = 100, "
               "base_radius_2_mm = 100, stiffness_N_per_m = 1e7, damping_Ns_per_m = 1000, normal_backlash_mm "
               "= "
               "0.1 }\n"
               "e = { type = \"engine_order_torque\", node = \"a\", mean_Nm = 200, harmonics = { order = "
               "[1], "
               "amplitude_Nm = [10] }, twist_feedback = false }\n"
               "l = { type = \"engine_order_torque\", node = \"g\", mean_Nm = 200, twist_feedback = false }\n"
               "[class]\nrated_speed_rpm = 1000\n[class.sections]\ns = { permissible_torque_Nm = 50 }\n";
    return (folder / name).string();
  };
  const auto words = [](const std::string& command, const std::string& file) {
    return std::vector<std::string>{command, file, "--speeds", "900,1000"};
  };
  const std::string page = (folder / "page.html").string(),
                    follows = model("follows.toml",
                                    "by_mean_torque = { mean_torque_Nm = [0, 200], stiffness_Nm_per_rad = "
                                    "[1000, 4000], loss_factor = [0, 0] }");
  const std::string by_torque =
      "s has here, as in runs in time, the stiffness of its at_mean_torque, 0 N m (the motions carry 200 N "
      "m)";
  for (const char* command : {"sweep", "class"}) {
    std::vector<std::string> with_page = words(command, follows), as_json = with_page;
    with_page.insert(with_page.end(), {"--report", page});
    as_json.emplace_back("--json");
    auto text = drev_command(with_page);
    INFO(text.err);
    std::replace(text.out.begin(), text.out.end(), '\n', ' ');
    CHECK(contains(text.out, by_torque));
    CHECK(contains(read_file(page), by_torque));
    const Json json = Json::parse(drev_command(as_json).out);
    const Json& notes = (json.contains("cases") ? json["cases"][0] : json).at("notes");
    CHECK(contains(notes.dump(), by_torque));
  }
  auto lossy = drev_command(words("sweep", model("loses.toml",
                                                 "stiffness_Nm_per_rad = 1e4, loss_factor = 0.1, "
                                                 "lowest_frequency_Hz = 15, highest_frequency_Hz = 30")));
  std::replace(lossy.out.begin(), lossy.out.end(), '\n', ' ');
  CHECK(contains(lossy.out, "the loss of its chain, off by up to 2.1 % from 15 to 30 Hz"));
  auto closed = words("sweep", follows);
  closed.insert(closed.end(), {"--contact", "closed"});
  CHECK_FALSE(contains(drev_command(closed).out, "as in runs in time"));
}

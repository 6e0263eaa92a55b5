// Elements of plugins in everything that takes a model file, and what is wrong with a plugin. The plugins are
// in tests/plugins and tests/install_consumer/plugin.
#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <numbers>
#include <thread>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using drev::test::Outcome;
using drev::test::TemporaryFolder;
using Json = nlohmann::json;

namespace {

std::string plugin(const std::string& name) { return DREV_PLUGIN_FOLDER "/lib" + name + ".so"; }
const std::string kHardening = plugin("hardening"), kRing = plugin("ring_damper");
const std::string kDisc = DREV_SOURCE_DIR "/tests/install_consumer/plugin/disc.toml";

std::string written(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path) << text;
  return path.string();
}

/// A disc with a ring damper, pushed off; `held`: the hub stands still.
std::string ring_text(bool held, const std::string& damper) {
  return "format = 1\n[nodes]\nhub = { " + std::string(held ? "hold = true" : "initial_speed_rad_per_s = 2") +
         " }\ntail = {}\n[elements]\n"
         "J = { type = \"inertia\", node = \"hub\", inertia_kg_m2 = 0.5 }\n"
         "J_tail = { type = \"inertia\", node = \"tail\", inertia_kg_m2 = 0.1 }\n"
         "shaft = { type = \"shaft_spring\", nodes = [\"hub\", \"tail\"], stiffness_Nm_per_rad = 1e4 }\n"
         "damper = { type = \"ring_damper\", node = \"hub\", " +
         damper +
         " }\n[run]\nduration_s = 0.1\n"
         "torques = [\"damper.torque_Nm\", \"shaft.torque_Nm\"]\nrecord = [\"damper_1.angle_rad\"]\n";
}

Json json_of(const std::vector<std::string>& arguments) {
  const Outcome outcome = drev_command(arguments);
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  return Json::parse(outcome.out);
}

}  // namespace

TEST_CASE("A plugin's element is listed, checked, linearised and run") {
  const std::string all = drev_command({"list", "--elements", "--plugin", kHardening}).out;
  CHECK(contains(all, "shaft_spring"));
  CHECK(contains(all, "hardening_coupling   stiffness_Nm_per_rad*, cubic_Nm_per_rad3, of"));
  CHECK(!contains(drev_command({"list", "--elements"}).out, "hardening_coupling"));
  const Json elements = json_of({"list", "--elements", "--json", "--plugin", kHardening}).at("elements");
  CHECK(elements.size() == json_of({"list", "--elements", "--json"}).at("elements").size() + 1);
  CHECK(elements.front().at("plugin").is_null());
  CHECK(elements.back().at("type") == "hardening_coupling");
  CHECK(elements.back().at("plugin") == kHardening);
  CHECK(elements.back().at("keys")[0] == Json{{"name", "stiffness"},
                                              {"key", "stiffness_Nm_per_rad"},
                                              {"needed", true},
                                              {"default", nullptr},
                                              {"translational_key", "stiffness_Nm_per_rad"}});

  CHECK(contains(drev_command({"check", kDisc, "--plugin", kHardening}).out, "sound; 1 node, 3 elements"));
  CHECK(contains(drev_command({"list", kDisc, "--plugin", kHardening}).out, "coupling"));
  const double small = 100.0 / (2.0 * std::numbers::pi);  // sqrt(k / J) = 100 rad/s
  CHECK(json_of({"modes", kDisc, "--plugin", kHardening, "--json"}).at("frequencies_Hz")[0].get<double>() ==
        Approx(small).epsilon(1e-12));
  // T x = k x^2/2 + k3 x^4/4 for T = 2250 N m and x = 0.1 rad, where k x + k3 x^3 = 7000 N m.
  for (const char* method : {"exact", "sdirk4"}) {
    const Json run = json_of(
        {"run", kDisc, "--plugin=" + kHardening, "--json", "--method", method, "--tolerance", "1e-9"});
    CHECK(run.at("results").at("max_torque_Nm").get<double>() ==
          Approx(7000.0).epsilon(2e-6));  // peaks are interpolated
  }
}

TEST_CASE("A plugin's element is exported, runs the same again, and is in the report") {
  const TemporaryFolder folder;
  const std::string file = (folder / "again.toml").string(), page = (folder / "page.html").string();
  const Outcome fmu =
      drev_command({"export", kDisc, "--plugin", kHardening, "--fmu", (folder / "d.fmu").string()});
  CHECK(fmu.exit_code == 2);
  CHECK(contains(fmu.err, "cannot be in an FMU: it is of the plugin " + kHardening));
  REQUIRE(drev_command({"export", kDisc, "--plugin", kHardening, "--out", file}).exit_code == 0);
  const std::string text = drev::test::read_file(file);
  CHECK(contains(text,
                 "type = \"hardening_coupling\", node = \"disc\", stiffness_Nm_per_rad = 20000.0, "
                 "cubic_Nm_per_rad3 = 5000000.0 }"));
  const Json first = json_of({"run", kDisc, "--plugin", kHardening, "--json"});
  const Json again = json_of({"run", file, "--plugin", kHardening, "--json", "--report", page});
  const Json same = json_of({"run", file, "--plugin", kHardening, "--json"});
  CHECK(first.at("results") == same.at("results"));
  CHECK(again.at("results").at("max_torque_Nm").get<double>() == Approx(7000.0).epsilon(2e-6));
  const std::string report = drev::test::read_file(page);
  CHECK(contains(report, "hardening coupling"));
  CHECK(contains(report, "again.toml --plugin " + kHardening));
}

TEST_CASE("Several runs load the plugins, too") {
  const TemporaryFolder folder;
  const std::string file =
      written(folder / "ring.toml",
              "parameters = { c = 0 }\n" + ring_text(false,
                                                     "inertia_kg_m2 = 0.05, stiffness_Nm_per_rad = 2e3, "
                                                     "damping_Nms_per_rad = \"c\""));
  const Json runs = json_of({"run", file, "--plugin", kHardening + "," + kRing, "--vary", "c=0,5", "--out",
                             (folder / "runs").string(), "--json"});
  CHECK(runs.at("status") == "success");
  CHECK(runs.at("runs").size() == 2);
}

TEST_CASE("An element with an internal ring: modes, steps, exact propagation, export and report") {
  const TemporaryFolder folder;
  const std::string held = written(folder / "held.toml", ring_text(true,
                                                                   "inertia_kg_m2 = 0.05, "
                                                                   "stiffness_Nm_per_rad = 2e3"));
  // Held at the hub, ring and tail swing by themselves: 2e3/0.05 = 200^2, 1e4/0.1 = 316.2^2 (rad/s)^2.
  const Json modes = json_of({"modes", held, "--plugin", kRing, "--json"}).at("frequencies_Hz");
  REQUIRE(modes.size() == 2);
  CHECK(modes[0].get<double>() == Approx(200.0 / (2 * std::numbers::pi)).epsilon(1e-12));
  CHECK(modes[1].get<double>() == Approx(std::sqrt(1e5) / (2 * std::numbers::pi)).epsilon(1e-12));

  const std::string free =
      written(folder / "free.toml", ring_text(false,
                                              "inertia_kg_m2 = 0.05, stiffness_Nm_per_rad = 2e3, "
                                              "cubic_Nm_per_rad3 = 2e7, damping_Nms_per_rad = 1"));
  const std::string out = (folder / "free.out").string();
  const Json exact = json_of({"run", free, "--plugin", kRing, "--json", "--method", "exact", "--out", out});
  const Json steps = json_of(
      {"run", free, "--plugin", kRing, "--json", "--method", "average_acceleration", "--step", "1e-6"});
  const double torque = exact.at("results").at("max_torque_Nm");
  CHECK(steps.at("results").at("max_torque_Nm").get<double>() == Approx(torque).epsilon(1e-5));
  CHECK(exact.at("energy_error").get<double>() < 1e-8);
  const std::string report = drev::test::read_file(out + "/report.html");
  CHECK(contains(report, "ring damper"));
  CHECK(contains(report, "damper_1"));
  CHECK(drev::test::read_file(out + "/history.csv").starts_with("time_s,damper_1.angle_rad\n"));

  const std::string again = (folder / "again.toml").string();
  REQUIRE(drev_command({"export", free, "--plugin", kRing, "--out", again}).exit_code == 0);
  CHECK(!contains(drev::test::read_file(again), "damper_1 ="));
  CHECK(
      json_of({"run", again, "--plugin", kRing, "--json", "--method", "exact", "--out", out}).at("results") ==
      exact.at("results"));
}

TEST_CASE("An internal node along a line: modes, both ways to run, a reduction, export and report") {
  const TemporaryFolder folder;
  const std::string rack = plugin("rack"), out = (folder / "out").string();
  const std::string file =
      written(folder / "rack.toml",
              "format = 1\nparameters = { r_mm = 50 }\n[nodes]\npinion = { initial_speed_rad_per_s = 2 "
              "}\n[elements]\n"
              "J = { type = \"inertia\", node = \"pinion\", inertia_kg_m2 = 0.02 }\n"
              "rack = { type = \"rack\", node = \"pinion\", mass_kg = 3, radius_mm = \"r_mm\", "
              "stiffness_N_per_um = 4 }\n"
              "[run]\nduration_s = 0.05\ntorques = \"rack.force_N\"\nrecord = \"rack_1.*\"\n");
  // omega^2 = k (r^2/J + 1/m); the teeth carry k r theta'(0)/omega at most.
  const double omega = std::sqrt(4e6 * (0.05 * 0.05 / 0.02 + 1.0 / 3.0)), force = 4e6 * 0.05 * 2.0 / omega;
  const Json modes = json_of({"modes", file, "--plugin", rack, "--json"});
  CHECK(modes.at("rigid_modes") == 1);
  CHECK(modes.at("frequencies_Hz")[0].get<double>() == Approx(omega / (2 * std::numbers::pi)).epsilon(1e-12));
  for (const std::vector<std::string>& how : std::vector<std::vector<std::string>>{
           {"--method", "exact"}, {"--method", "sdirk4", "--tolerance", "1e-8"}, {"--reduce", "1%"}}) {
    std::vector<std::string> words{"run", file, "--plugin", rack, "--json", "--out", out};
    words.insert(words.end(), how.begin(), how.end());
    const Json results = json_of(words).at("results");
    CHECK(results.at("max_force_N").get<double>() == Approx(force).epsilon(1e-5));
  }
  CHECK(drev::test::read_file(out + "/history.csv")
            .starts_with("time_s,rack_1.position_m,rack_1.velocity_m_per_s"));
  CHECK(contains(drev::test::read_file(out + "/report.html"), "{\"name\":\"rack_1\",\"turns\":false"));
  const Outcome text = drev_command({"export", file, "--plugin", rack});
  CHECK(contains(text.out,
                 "rack = { type = \"rack\", node = \"pinion\", mass_kg = 3.0, radius_m = 0.05, "
                 "stiffness_N_per_m = 4000000.0 }"));
}

TEST_CASE("Completion knows the channels of a file whose elements are a plugin's") {
  const TemporaryFolder folder;
  const std::string file =
      written(folder / "ring.toml", ring_text(true, "inertia_kg_m2 = 0.05, stiffness_Nm_per_rad = 2e3"));
  const auto offered = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "__complete");
    return drev_command(words).out;
  };
  CHECK(offered({"run", file, "--record", "damper_1.a"}).empty());
  CHECK(offered({"run", file, "--plugin", kRing, "--record", "damper_1.an"}) == "damper_1.angle_rad\n");
  CHECK(offered({"run", file, "--plugin=" + kRing, "--record", "damper_1.an"}) == "damper_1.angle_rad\n");
  CHECK(offered({"modes", "--plug"}) == "--plugin\n");
  CHECK(offered({"list", "--el"}) == "--elements\n");
}

TEST_CASE("What a file says of a plugin's element is told at its place, and its name is suggested") {
  const Outcome unknown = drev_command({"check", kDisc});
  CHECK(unknown.exit_code == 2);
  CHECK(contains(unknown.err, "disc.toml:6:"));
  CHECK(contains(unknown.err, "\"hardening_coupling\", which is no element"));
  const TemporaryFolder folder;
  std::string text = drev::test::read_file(kDisc);
  text.replace(text.find("hardening_coupling"), 18, "hardening_copling");
  const Outcome misspelt = drev_command({"check", written(folder / "a.toml", text), "--plugin", kHardening});
  CHECK(contains(misspelt.err, "did you mean 'hardening_coupling'?"));
  text = drev::test::read_file(kDisc);
  text.replace(text.find("5e6"), 3, "-5.0");
  const Outcome negative = drev_command({"check", written(folder / "b.toml", text), "--plugin", kHardening});
  CHECK(negative.exit_code == 2);
  CHECK(contains(negative.err, "b.toml:6:"));
  CHECK(contains(negative.err, "cubic_Nm_per_rad3 = -5 N m/rad^3, must be >= 0"));
}

TEST_CASE("What is wrong with a plugin is said of each, and nothing is run") {
  const TemporaryFolder folder;
  const std::string text = written(folder / "text.so", "not a library\n");
  const Outcome all = drev_command({"run", kDisc, "--plugin", kHardening, "--plugin",
                                    "no/such.so," + text + "," + plugin("no_plugin"), "--plugin",
                                    plugin("wrong_version") + "," + plugin("missing_symbol") + "," +
                                        plugin("taken_name") + "," + plugin("other_headers")});
  CHECK(all.exit_code == 2);
  CHECK(all.out.empty());
  CHECK(contains(all.err, "7 faults"));
  CHECK(contains(all.err, "no/such.so, is no file"));
  CHECK(contains(all.err, "text.so, cannot be loaded as a plugin of drev 0."));
  CHECK(contains(all.err, "no_plugin.so, is no plugin of drev: it lacks DREV_PLUGIN()"));
  CHECK(contains(all.err, "wrong_version.so, was built for drev 0.0.9, of old; this is drev 0."));
  CHECK(contains(all.err, "other_headers.so, was built for drev 0."));
  CHECK(contains(all.err, ", headers 0123456789ab, with Eigen "));
  CHECK(contains(all.err, "from_a_later_version"));
  CHECK(contains(all.err, "type = shaft_spring, is registered already, by drev itself"));
  // What a plugin had registered before its fault is gone.
  CHECK(!contains(drev_command({"check", kDisc, "--plugin", plugin("taken_name")}).err, "plain_inertia"));
  const Outcome twice = drev_command({"check", kDisc, "--plugin", kHardening, "--plugin", "./" + kHardening});
  CHECK(twice.exit_code == 2);
  CHECK(contains(drev_command({"check", kDisc, "--plugin", kHardening + "," + kHardening}).err,
                 "is named twice"));
}

TEST_CASE("The first interrupt ends a run that cannot ask for it") {
  const TemporaryFolder folder;
  const std::string model = written(
      folder / "m.toml",
      "format = 1\n[nodes]\na = {}\n[elements]\nJ = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n"
      "T = { type = \"endless\", node = \"a\" }\n[run]\nduration_s = 1\n");
  const drev::test::Process process({"run", model, "--plugin", plugin("endless"), "--method",
                                     "average_acceleration", "--step", "1e-3", "--out",
                                     (folder / "r").string()});
  for (int i = 0; i < 500 && !std::filesystem::exists(folder / "r/summary.partial.json"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const auto begin = std::chrono::steady_clock::now();
  process.send(SIGINT);
  const Outcome run = process.wait();
  CAPTURE(run.err);
  CHECK(run.exit_code == 130);
  CHECK(contains(run.err, "drev: interrupted in the midst of a computation"));
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(20));
  CHECK(Json::parse(drev::test::read_file(folder / "r/summary.partial.json")).at("status") == "running");
}

// drev sweep and drev modes --damped: what they print and write, and that docs/sweep.md shows it.
#include <drev/core/units.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using drev::test::read_file;
using Json = nlohmann::json;

namespace {

const std::string kEngine = DREV_SOURCE_DIR "/models/engine/engine.toml";
const std::string kGearPair = DREV_SOURCE_DIR "/models/gear_pair/gear_pair.toml";

}  // namespace

TEST_CASE("The page on sweeps shows what the commands print", "[sweep]") {
  std::istringstream page(read_file(DREV_SOURCE_DIR "/docs/sweep.md"));
  std::string shown, printed;
  int commands = 0;
  bool console = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("```")) {
      if (console) CHECK(shown == printed);
      console = line == "```console";
    } else if (console && line.starts_with("$ drev ")) {
      std::vector<std::string> words;
      std::istringstream typed(line.substr(7));
      for (std::string word; typed >> word;)
        words.push_back(word == "engine.toml" ? kEngine : word == "gear_pair.toml" ? kGearPair : word);
      const auto outcome = drev_command(words);
      CHECK(outcome.exit_code == 0);
      printed = outcome.out;
      shown.clear();
      ++commands;
    } else if (console) {
      shown += line + "\n";
    }
  }
  CHECK(commands == 3);
}

TEST_CASE("A train whose rattle takes more harmonics than there are: no curve is made up, its run is told",
          "[sweep][once]") {
  // At 1,440 to 1,452 rpm rounding decides whether the rattle comes to repeat within the run.
  const auto printed = drev_command(
      {"sweep", DREV_SOURCE_DIR "/models/tutorial/train.toml", "--speeds", "1460,1480", "--json"});
  REQUIRE(printed.exit_code == 0);
  const Json json = Json::parse(printed.out);
  for (const Json& branch : json.at("branches"))
    for (const Json& error : branch.at("error")) CHECK((error.is_null() || error.get<double>() < 0.05));
  CHECK(json.at("changes").empty());
  REQUIRE(json.at("runs").size() == 2);
  const double ratio = 83.0 / 21.0 * 77.0 / 19.0;
  for (const Json& run : json["runs"]) {
    CHECK(run.at("repeats_after") == 1);
    REQUIRE(json.at("sections")[1].at("name") == "coupling.torque_Nm");
    // What the motor gives is what the compressor takes, over the cycle.
    CHECK(run.at("mean")[1].get<double>() * ratio ==
          Approx(run.at("mean")[0].get<double>())
              .margin(run.at("mean_error")[0].get<double>() + ratio * run.at("mean_error")[1].get<double>()));
    CHECK(run.at("mean")[0].get<double>() ==
          Approx(-600.0).epsilon(1e-3));  // of the gas, less what the twist changes
    CHECK(run.at("mean_error")[0].get<double>() < 0.1);
    CHECK(run.at("error").get<double>() <= 1e-5);
    CHECK(run.at("left_over_Nm").size() == json.at("floating_parts").size());
  }
  // The largest half ranges are those of the runs, where no motion is stable.
  REQUIRE(json.at("largest").size() == json.at("sections").size());
  for (std::size_t c = 0; c < json["largest"].size(); ++c) {
    double most = 0.0, at = 0.0;
    for (const Json& run : json["runs"]) {
      const double half = 0.5 * (run.at("highest")[c].get<double>() - run.at("lowest")[c].get<double>());
      if (half > most) most = half, at = run.at("speed_rpm");
    }
    CHECK(json["largest"][c].at("section") == json["sections"][c].at("name"));
    CHECK(json["largest"][c].at("half_range").get<double>() == Approx(most).epsilon(1e-14));
    CHECK(json["largest"][c].at("speed_rpm") == at);
    CHECK(json["largest"][c].at("branch").is_null());
  }
}

TEST_CASE("A sweep takes constant torques, by one value or as a table", "[sweep]") {
  for (const char* torque : {"torque_Nm = -100", "table = { time_s = [0, 1], torque_Nm = [-100, -100] }"}) {
    const drev::test::TemporaryFolder folder;
    std::ofstream(folder / "line.toml")
        << "format = 1\n[nodes]\na = { nominal_speed_rpm = 600 }\nb = {}\n[elements]\n"
           "J_1 = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 2 }\n"
           "J_2 = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 3 }\n"
           "shaft = { type = \"shaft_spring\", nodes = [\"a\", \"b\"], stiffness_Nm_per_rad = 1e4 }\n"
           "drive = { type = \"engine_order_torque\", node = \"a\", mean_Nm = 100, harmonics = "
           "{ order = [2], amplitude_Nm = [50] } }\n"
           "brake = { type = \"applied_torque\", node = \"b\", "
        << torque << " }\n";
    const auto swept = drev_command({"sweep", (folder / "line.toml").string(), "--speeds", "600", "--json"});
    INFO(swept.err);
    REQUIRE(swept.exit_code == 0);
    const Json section = Json::parse(swept.out).at("sections").at(0);
    CHECK(std::abs(section.at("mean")[0].get<double>()) == Approx(100.0));
    // Two inertias: T J_2/J k_r/(k_r - w^2 J_1 J_2/J) at w = 2 x 600 rpm.
    const double w = 40.0 * M_PI, reduced = 2.0 * 3.0 / 5.0;
    CHECK(section.at("half_range")[0].get<double>() ==
          Approx(std::abs(50.0 * 3.0 / 5.0 * 1e4 / (1e4 - w * w * reduced))));
  }
}

TEST_CASE("A linear sweep says of a spring that bends below its mean torque what it is taken for",
          "[sweep]") {
  const drev::test::TemporaryFolder folder;
  std::ofstream(folder / "bent.toml")
      << "format = 1\n[nodes]\na = { nominal_speed_rpm = 900 }\nb = {}\n[elements]\n"
         "J_1 = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n"
         "J_2 = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 2 }\n"
         "spring = { type = \"polyline_spring\", nodes = [\"b\", \"a\"], points = { deflection_deg = "
         "[-6, 0, 6, 12], torque_Nm = [-500, 0, 500, 2500] }, damping_Nms_per_rad = 2 }\n"
         "drive = { type = \"engine_order_torque\", node = \"a\", mean_Nm = \"mean_Nm\" }\n"
         "brake = { type = \"engine_order_torque\", node = \"b\", mean_Nm = \"-mean_Nm\" }\n"
         "[parameters]\nmean_Nm = 1000\n";
  const std::vector<std::string> words{
      "sweep", (folder / "bent.toml").string(), "--speeds", "900", "--contact", "closed", "--set"};
  const auto swept = [&](const char* mean) {
    std::vector<std::string> all = words;
    all.emplace_back(mean);
    const auto printed = drev_command(all);
    INFO(printed.err);
    REQUIRE(printed.exit_code == 0);
    return printed.out;
  };
  // 1000 N m over 500 N m / 6 deg is 12 deg, where the points say 2500 N m.
  CHECK(contains(swept("mean_Nm=1000"), "where that gives 1000 N m, the law gives 2500"));
  CHECK_FALSE(contains(swept("mean_Nm=400"), "straight line"));
  // A mesh without backlash has its mean stiffness: no bent law.
  std::ofstream(folder / "mesh.toml")
      << "format = 1\n[nodes]\na = { nominal_speed_rpm = 900 }\nb = {}\n[elements]\n"
         "J_a = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 0.02 }\n"
         "J_b = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 0.05 }\n"
         "mesh = { type = \"gear_mesh\", nodes = [\"a\", \"b\"], module_mm = 3, teeth_1 = 20, teeth_2 = 40, "
         "pressure_angle_deg = 20, stiffness_step = { single_N_per_um = 200, double_N_per_um = 300, "
         "contact_ratio = 1.5 }, normal_backlash_um = 0 }\n"
         "drive = { type = \"engine_order_torque\", node = \"a\", mean_Nm = 60 }\n"
         "brake = { type = \"engine_order_torque\", node = \"b\", mean_Nm = 120 }\n";
  const auto meshed =
      drev_command({"sweep", (folder / "mesh.toml").string(), "--speeds", "900", "--contact", "closed"});
  REQUIRE(meshed.exit_code == 0);
  CHECK_FALSE(contains(meshed.out, "straight line"));
}

TEST_CASE("A sweep as JSON and as tables: one set of numbers", "[sweep]") {
  const drev::test::TemporaryFolder folder;
  const std::string out = (folder / "out").string();
  const std::vector<std::string> words{"sweep",    kEngine,     "--speeds", "900,1500",
                                       "--orders", "0.5:0.5:8", "--record", "rear.torque_Nm,hub.angle_rad",
                                       "--out",    out};
  std::vector<std::string> as_json = words;
  as_json.insert(as_json.end(), {"--json", "--absolute-sum"});
  const auto printed = drev_command(as_json);
  REQUIRE(printed.exit_code == 0);
  CHECK(read_file(out + "/summary.json") == printed.out);
  const Json json = Json::parse(printed.out);
  CHECK(json.at("kind") == "sweep");
  CHECK(json.at("speeds_rpm") == Json({900.0, 1500.0}));
  CHECK(json.at("orders").size() == 16);
  CHECK(json.at("cycle_deg").get<double>() == Approx(720.0));
  REQUIRE(json.at("sections").size() == 2);
  const Json& rear = json["sections"][0];
  CHECK(rear.at("name") == "rear.torque_Nm");
  CHECK(json["sections"][1].at("twist").is_null());
  double sum = 0.0, at = 0.0;
  const double angle = drev::deg(rear.at("maximum_at_deg")[1].get<double>());
  for (std::size_t k = 0; k < 16; ++k) {
    const double a = rear.at("amplitude")[k][1], order = json["orders"][k];
    sum += a;
    at += a * std::cos(order * angle + drev::deg(rear.at("phase_deg")[k][1].get<double>()));
  }
  CHECK(rear.at("absolute_sum")[1].get<double>() == Approx(sum).epsilon(1e-12));
  CHECK(rear.at("maximum")[1].get<double>() == Approx(at).epsilon(1e-9));
  CHECK(rear.at("half_range")[1].get<double>() < sum);
  CHECK(rear.at("mean")[1].get<double>() == Approx(-1500.0).epsilon(1e-9));  // end b behind end a
  CHECK(json.at("input_power_W")[1].get<double>() ==
        Approx(json.at("dissipated_power_W")[1].get<double>()).epsilon(1e-11));

  std::istringstream table(read_file(out + "/sweep.csv"));
  std::string header, row;
  std::getline(table, header), std::getline(table, row);
  CHECK(header.starts_with("speed_rpm,rear.torque_Nm half_range,rear.torque_Nm maximum"));
  CHECK(std::stod(row.substr(row.find(',') + 1)) == rear.at("half_range")[0].get<double>());
  std::istringstream orders(read_file(out + "/orders.csv"));
  int rows = -1;
  for (std::string line; std::getline(orders, line);) ++rows;
  CHECK(rows == 32);
  CHECK(read_file(out + "/criticals.csv").starts_with("speed_rpm,order,mode,"));
}

TEST_CASE("Mean torque that does not balance: at how many speeds, where and how much", "[sweep]") {
  const drev::test::TemporaryFolder folder;
  const std::string file = (folder / "free.toml").string();
  std::ofstream(file) << R"(format = 1
[nodes]
motor = {}
hub = { nominal_speed_rpm = 1000 }
[elements]
J_motor = { type = "inertia", node = "motor", inertia_kg_m2 = 2 }
J_hub = { type = "inertia", node = "hub", inertia_kg_m2 = 5 }
shaft = { type = "shaft_spring", nodes = ["motor", "hub"], stiffness_Nm_per_rad = 1e5, damping_Nms_per_rad = 20 }
torque = { type = "engine_order_torque", node = "motor", mean_Nm = 100, harmonics = { order = [2], amplitude_Nm = [30] } }
propeller = { type = "propeller", node = "hub", rated_torque_Nm = 100, rated_speed_rpm = 1000 }
)";
  const auto said = [&](std::vector<std::string> more) {
    std::vector<std::string> words{"sweep", file, "--speeds", "900,1000,1200", "--orders", "2"};
    words.insert(words.end(), more.begin(), more.end());
    const auto run = drev_command(words);
    CHECK(run.exit_code == 0);
    std::string line = run.out;  // it is wrapped
    std::replace(line.begin(), line.end(), '\n', ' ');
    return line;
  };
  // The propeller takes 100 n^2/1000^2: of 100 N m, -19 at 900 rpm, 0 at 1000 and 44 at 1200, of 100 + 144.
  const std::string sentence =
      "does not balance at 2 of 3 speeds: up to 44.0000 N m, at 1200 rpm, are left over of mean torques of "
      "up to 244.000 N m on "
      "the part of";
  CHECK(contains(said({}), sentence));
  CHECK(contains(said({"--balance", "hub"}), sentence));
  CHECK(contains(said({"--balance", "hub"}), "It is taken up at hub."));
}

TEST_CASE("Damped modes as JSON: shares of energy sum to one", "[sweep]") {
  const auto printed = drev_command({"modes", kEngine, "--damped", "--count", "3", "--json"});
  REQUIRE(printed.exit_code == 0);
  const Json json = Json::parse(printed.out);
  CHECK(json.at("kind") == "damped_modes");
  CHECK(json.at("rigid_modes") == 2);
  REQUIRE(json.at("modes").size() == 3);
  for (const Json& mode : json["modes"]) {
    const double re = mode.at("real_per_s"), im = mode.at("imaginary_per_s");
    CHECK(mode.at("frequency_Hz").get<double>() == Approx(im / drev::kTwoPi));
    CHECK(mode.at("damping_ratio").get<double>() == Approx(-re / std::hypot(re, im)));
    double largest = 0.0, kinetic = 0.0, elastic = 0.0, dissipated = 0.0;
    for (const Json& node : mode.at("shape")) largest = std::max(largest, node.at("amplitude").get<double>());
    for (const Json& element : mode.at("energy")) {
      kinetic += element.at("kinetic").get<double>();
      elastic += element.at("elastic").get<double>();
      dissipated += element.at("dissipated").get<double>();
    }
    CHECK(largest == Approx(1.0));
    CHECK(kinetic == Approx(1.0));
    CHECK(elastic == Approx(1.0));
    CHECK(dissipated == Approx(1.0));
  }
  int free = 0;
  for (const Json& real : json.at("real_eigenvalues")) free += real.at("turns_freely").get<bool>() ? 1 : 0;
  CHECK(free == 1);  // the train; its damper's ring is dragged along
  const auto open = drev_command({"modes", "gear_drive", "--damped", "--contact", "open", "--json"});
  CHECK(Json::parse(open.out).at("contact") == "open");
}

TEST_CASE("Campbell: the criticals are those of the sweep", "[sweep]") {
  const drev::test::TemporaryFolder folder;
  const std::string out = (folder / "out").string();
  const auto printed = drev_command({"campbell", kEngine, "--speeds", "600:10:2000", "--out", out, "--json"});
  REQUIRE(printed.exit_code == 0);
  CHECK(read_file(out + "/summary.json") == printed.out);
  const Json json = Json::parse(printed.out);
  const Json sweep = Json::parse(drev_command({"sweep", kEngine, "--speeds", "600:10:2000", "--json"}).out);
  REQUIRE(json.at("criticals").size() == sweep.at("criticals").size());
  REQUIRE(json["criticals"].size() == 4);
  double largest = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    Json critical = json["criticals"][i];
    largest = std::max(largest, critical.at("relative").get<double>());
    critical.erase("relative");
    CHECK(critical == sweep["criticals"][i]);
    // The order meets the mode there, except for what damping and the other orders' flanks move.
    CHECK(critical.at("order").get<double>() * critical.at("speed_rpm").get<double>() / 60.0 ==
          Approx(critical.at("frequency_Hz").get<double>()).epsilon(0.1));
  }
  CHECK(largest == 1.0);
  CHECK(json.at("modes").size() == 6);
  CHECK(read_file(out + "/modes.csv").starts_with("speed_rpm,mode_1_frequency_Hz,mode_1_damping_ratio"));
  CHECK(drev_command({"campbell", kEngine}).exit_code == 2);
}

TEST_CASE("Faults of a sweep are listed at once", "[sweep]") {
  const auto refused = drev_command({"sweep", kEngine, "--orders", "2,1"});
  CHECK(refused.exit_code == 2);
  for (const char* part : {"2 faults", "--speeds", "is missing", "--orders", "rise from each to the next"})
    CHECK(contains(refused.err, part));
  // Names of the model are looked up although the speeds are wrong.
  const auto names =
      drev_command({"sweep", "two_inertia", "--speeds", "x", "--record", "nix", "--balance", "nox"});
  CHECK(names.exit_code == 2);
  for (const char* part : {"3 faults", "--speeds = x", "nix", "nox"}) CHECK(contains(names.err, part));
  const auto contacts =
      drev_command({"sweep", kGearPair, "--speeds", "900", "--cycle", "0", "--absolute-sum"});
  CHECK(contacts.exit_code == 2);
  for (const char* part : {"--cycle", "--absolute-sum", "linear models"}) CHECK(contains(contacts.err, part));
  CHECK(contains(drev_command({"sweep", kGearPair, "--speeds", "900"}).err, "must be at least two"));
  CHECK(contains(drev_command({"sweep", kEngine, "--speeds", "900", "--cycle", "1"}).err, "not linear"));
  CHECK(contains(drev_command({"modes", kEngine, "--out", "x"}).err, "is for --damped"));
  CHECK(drev_command({"modes", kEngine, "--speed", "900"}).exit_code == 2);
  const auto closed = drev_command({"sweep", "camshaft", "--speeds", "700", "--contact", "closed"});
  CHECK(closed.exit_code == 0);
  CHECK(contains(closed.out, "the teeth separate there"));
}

TEST_CASE("A sweep of a gear pair with backlash: branches as JSON and as tables", "[sweep]") {
  const drev::test::TemporaryFolder folder;
  const std::string out = (folder / "out").string();
  const std::vector<std::string> words{"sweep",     kGearPair,  "--speeds",
                                       "1800,1900", "--out",    out,
                                       "--json",    "--record", "mesh.force_N,wheel.angle_rad"};
  const auto printed = drev_command(words);
  REQUIRE(printed.exit_code == 0);
  CHECK(read_file(out + "/summary.json") == printed.out);
  const Json json = Json::parse(printed.out);
  CHECK(json.at("kind") == "branches");
  CHECK(json.at("cycle_deg").get<double>() == Approx(12.0));
  CHECK(json.at("unsolved_rpm").empty());
  CHECK(json.at("sections")[0].at("contact") == true);
  // The nondimensional fold at 0.8284639844 of sqrt(k r^2/J)/30.
  const double natural = drev::to_rpm(std::sqrt(2e8 * 0.05 * 0.05 / 0.01) / 30.0);
  int folds = 0;
  for (const Json& change : json.at("changes")) {
    if (change.at("what") != "fold") continue;
    ++folds;
    CHECK(change.at("speed_rpm").get<double>() == Approx(0.8284639844 * natural).epsilon(1e-9));
  }
  CHECK(folds == 1);
  std::istringstream table(read_file(out + "/branches.csv"));
  std::string line;
  std::getline(table, line);
  CHECK(line.starts_with(
      "curve,turns,speed_rpm,asked,state,multiplier,separates,error,mesh.force_N half_range"));
  std::size_t rows = 0, motions = 0;
  while (std::getline(table, line)) ++rows;
  for (const Json& branch : json.at("branches")) {
    motions += branch.at("speed_rpm").size();
    CHECK(branch.at("sections")[0].at("amplitude").size() == json.at("orders").size());
  }
  CHECK(rows == motions);
  CHECK(
      read_file(out + "/changes.csv").starts_with("speed_rpm,error_rpm,curve,what,mesh.force_N half_range"));
}

TEST_CASE("Damped modes as tables", "[sweep]") {
  const drev::test::TemporaryFolder folder;
  const std::string out = (folder / "out").string();
  const auto printed = drev_command({"modes", kEngine, "--damped", "--out", out, "--json"});
  REQUIRE(printed.exit_code == 0);
  CHECK(read_file(out + "/summary.json") == printed.out);
  const Json json = Json::parse(printed.out);
  std::istringstream table(read_file(out + "/modes.csv"));
  std::string line;
  std::getline(table, line);
  CHECK(line == "mode,real_per_s,imaginary_per_s,frequency_Hz,modulus_Hz,damping_ratio");
  for (const Json& mode : json.at("modes")) {
    REQUIRE(std::getline(table, line));
    const std::size_t comma = line.find(',');
    CHECK(std::stod(line.substr(comma + 1)) == mode.at("real_per_s").get<double>());
  }
  CHECK(read_file(out + "/shapes.csv").starts_with("mode,node,amplitude,phase_deg\n1,ring,"));
  CHECK(read_file(out + "/energy.csv").starts_with("mode,element,kinetic,elastic,dissipated\n1,"));
}

TEST_CASE("Meissner's tongue by the command: its ends, and a motion that grows without bound", "[sweep]") {
  const drev::test::TemporaryFolder folder;
  std::ofstream(folder / "meissner.toml")
      << "format = 1\n[nodes]\npinion = { nominal_speed_rpm = 19, hold = true }\nwheel = {}\n[elements]\n"
         "J = { type = \"inertia\", node = \"wheel\", inertia_kg_m2 = 1 }\n"
         "load = { type = \"engine_order_torque\", node = \"wheel\", mean_Nm = 1 }\n"
         "mesh = { type = \"gear_mesh\", nodes = [\"pinion\", \"wheel\"], base_radius_1_m = 1, "
         "base_radius_2_m = 1, "
         "teeth_1 = 1, teeth_2 = 1, damping_Ns_per_m = 0.04, damping_law = \"always\", stiffness_step = { "
         "single_N_per_m = 0.8, double_N_per_m = 1.2, contact_ratio = 1.5 } }\n";
  const std::vector<std::string> words{
      "sweep", (folder / "meissner.toml").string(), "--speeds", "17.2,19.1,21", "--tolerance", "1e-3"};
  std::vector<std::string> as_json = words;
  as_json.emplace_back("--json");
  const auto printed = drev_command(as_json);
  REQUIRE(printed.exit_code == 0);
  const Json json = Json::parse(printed.out);
  std::vector<double> ends;
  for (const Json& change : json.at("changes"))
    if (change.at("what") == "period doubling") ends.push_back(change.at("speed_rpm"));
  REQUIRE(ends.size() == 2);
  std::sort(ends.begin(), ends.end());
  // Closed form of Floquet's theorem, as in nonlinear_sweep_test.cpp.
  CHECK(ends[0] == Approx(drev::to_rpm(1.8770879929279)).epsilon(1e-9));
  CHECK(ends[1] == Approx(drev::to_rpm(2.1184359568012)).epsilon(1e-9));
  const auto text = drev_command(words);
  CHECK(contains(text.out, "17.2 to 17.92, 20.23 to 21"));
  CHECK(contains(text.out, "grows without bound"));
}

TEST_CASE("Both folds of a gear pair to eight digits by the command", "[sweep]") {
  const auto printed = drev_command({"sweep", kGearPair, "--speeds", "1500:100:2000", "--json"});
  REQUIRE(printed.exit_code == 0);
  const double natural = drev::to_rpm(std::sqrt(2e8 * 0.05 * 0.05 / 0.01) / 30.0);
  const Json json = Json::parse(printed.out);
  std::vector<double> folds;
  for (const Json& change : json.at("changes"))
    if (change.at("what") == "fold") folds.push_back(change.at("speed_rpm").get<double>() / natural);
  REQUIRE(folds.size() == 2);
  std::sort(folds.begin(), folds.end());
  CHECK(folds[0] == Approx(0.7080316187).epsilon(2e-9));
  CHECK(folds[1] == Approx(0.8284639844).epsilon(2e-9));
}

TEST_CASE("A sweep and a class calculation that are interrupted say so, write nothing and end with 130",
          "[sweep]") {
  const int signal = GENERATE(SIGINT, SIGTERM);
  const bool judged = GENERATE(false, true);
  const drev::test::TemporaryFolder folder;
  const std::string genset = DREV_SOURCE_DIR "/models/genset/genset.toml";
  const drev::test::Process process({judged ? "class" : "sweep", genset, "--speeds", "1200:0.01:1700",
                                     "--contact", "closed", "--balance", "generator", "--report",
                                     (folder / "s.html").string()});
  for (int i = 0; i < 6000 && !std::filesystem::exists(folder / "s.partial.html"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  process.send(signal);
  const auto outcome = process.wait();
  CHECK(outcome.exit_code == 130);
  CHECK(contains(outcome.err, "drev: interrupted; nothing is written"));
  CHECK(outcome.out.empty());
  CHECK_FALSE(std::filesystem::exists(folder / "s.html"));
}

TEST_CASE(
    "Loads beyond the harmonics that can be solved for: the runs are told as the largest, with the reason",
    "[sweep][once]") {
  const drev::test::TemporaryFolder folder;
  const std::string file = (folder / "drive.toml").string();
  std::ofstream(file) << R"(format = 1
name = "drive"
[nodes]
rotor = { nominal_speed_rpm = 4000 }
pinion = {}
wheel = {}
load = {}
[elements]
J_r = { type = "inertia", node = "rotor", inertia_kg_m2 = 0.02 }
J_p = { type = "inertia", node = "pinion", inertia_kg_m2 = 0.0008 }
J_w = { type = "inertia", node = "wheel", inertia_kg_m2 = 0.03 }
J_l = { type = "inertia", node = "load", inertia_kg_m2 = 0.6 }
input = { type = "shaft_spring", nodes = ["rotor", "pinion"], stiffness_Nm_per_rad = 15000, damping_Nms_per_rad = 0.3 }
output = { type = "shaft_spring", nodes = ["wheel", "load"], stiffness_Nm_per_rad = 25000, damping_Nms_per_rad = 2 }
mesh = { type = "gear_mesh", nodes = ["pinion", "wheel"], module_mm = 2, teeth_1 = 21, teeth_2 = 83, pressure_angle_deg = 20, stiffness_N_per_um = 200, damping_Ns_per_m = 900, normal_backlash_um = 80 }
motor = { type = "engine_order_torque", node = "rotor", mean_Nm = 60, harmonics = { order = [24], amplitude_Nm = [200] } }
brake = { type = "engine_order_torque", node = "load", mean_Nm = "60*83/21", harmonics = { order = [1], amplitude_Nm = [20] } }
[class]
rated_speed_rpm = 4000
[class.sections]
input = { permissible_torque_Nm = 2.5 }
)";
  const std::vector<std::string> words{"sweep", file, "--speeds", "3990,4000", "--record", "input.torque_Nm"};
  std::vector<std::string> as_json = words;
  as_json.emplace_back("--json");
  const auto printed = drev_command(as_json);
  REQUIRE(printed.exit_code == 0);
  const Json json = Json::parse(printed.out);
  CHECK(json.at("branches").empty());
  CHECK(json.at("excess").at("needed") == 664);
  REQUIRE(json.at("largest").size() == 1);
  const Json& largest = json["largest"][0];
  CHECK(largest.at("branch").is_null());
  // Closed form with closed teeth at 4000 rpm, without what the twist changes of the loads: 3.03386 N m.
  const Json& run = json.at("runs")[largest.at("speed_rpm").get<double>() > 3995.0 ? 1 : 0];
  CHECK(largest.at("half_range").get<double>() == Approx(3.03386).epsilon(0.02));
  CHECK(largest.at("half_range").get<double>() ==
        0.5 * (run.at("highest")[0].get<double>() - run.at("lowest")[0].get<double>()));
  CHECK(contains(drev_command(words).out, "  run  "));
  // A curve without order 24 has 1.8645 N m.
  const auto judged = drev_command({"class", file, "--speeds", "3990,4000", "--json"});
  const Json verdict = Json::parse(judged.out).at("cases")[0];
  CHECK(verdict.at("accepted") == false);
  CHECK(contains(verdict.at("notes").dump(), "harmonics up to 664 (order 24)"));
}

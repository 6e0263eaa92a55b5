// Figures of a run: which part of it they are of, at which speed, against what, and with which digits.
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using drev::test::read_file;
using drev::test::TemporaryFolder;
using Json = nlohmann::json;

namespace {

constexpr double kSettledPi = 3.14159265358979323846;

/// A disc on a shaft from a node at constant speed, 100 rad/s; order 0.5 and a mean torque.
std::string disc(const std::string& damping, const std::string& run) {
  return "format = 1\n[nodes]\nmotor = { constant_speed_rad_per_s = 100 }\ndisc = {}\n[elements]\n"
         "J = { type = \"inertia\", node = \"disc\", inertia_kg_m2 = 2 }\n"
         "shaft = { type = \"shaft_spring\", nodes = [\"motor\", \"disc\"], stiffness_Nm_per_rad = 20000, "
         "damping_Nms_per_rad = " +
         damping +
         " }\nload = { type = \"engine_order_torque\", node = \"disc\", mean_Nm = 50, twist_feedback = "
         "false, harmonics = { order = "
         "[0.5], "
         "amplitude_Nm = [20] } }\n[run]\nduration_s = 5\n" +
         run;
}

/// Largest torque of its steady state (damping 8): order 0.5 at 50 rad/s.
double steady() {
  return 50.0 + 20.0 * std::hypot(20000.0, 400.0) / std::hypot(20000.0 - 2.0 * 2500.0, 400.0);
}

/// Every run of blanks and line ends as one blank: what is wrapped reads as it was written.
std::string unwrapped(const std::string& text) {
  std::string out;
  for (const char c : text)
    if (c != '\n' && c != ' ')
      out += c;
    else if (!out.empty() && out.back() != ' ')
      out += ' ';
  return out;
}

struct Ran {
  int exit_code = 0;
  Json json;
  std::string text, err;
};
Ran run_of(const std::string& model, std::vector<std::string> words = {}) {
  const TemporaryFolder folder;
  const std::string path = (folder / "m.toml").string();
  std::ofstream(path) << model;
  words.insert(words.begin(), {"run", path});
  const auto text = drev_command(words);
  words.emplace_back("--json");
  const auto json = drev_command(words);
  return {text.exit_code, Json::parse(json.out, nullptr, false), unwrapped(text.out), text.err};
}

}  // namespace

TEST_CASE("Figures from rest hold the start, from the periodic state, or settled, they are the closed form's",
          "[once]") {
  const Ran rest = run_of(disc("8", ""));
  REQUIRE(rest.exit_code == 0);
  const double from_rest = rest.json["results"]["max_torque_Nm"];
  CHECK(from_rest > 1.02 * steady());
  CHECK(rest.json["results"]["of"]["from_s"] == 0.0);
  CHECK(rest.json["results"]["of"]["settled"] == false);
  CHECK(contains(rest.text, "of the whole run, 5 s, which starts from the model's initial conditions"));
  for (const auto& words : std::vector<std::vector<std::string>>{{"--start", "periodic"},
                                                                 {"--settle", "auto"},
                                                                 {"--settle", "4"},
                                                                 {"--start", "static", "--settle", "4"}}) {
    INFO(words[0] << words[1]);
    const Ran run = run_of(disc("8", ""), words);
    REQUIRE(run.exit_code == 0);
    CHECK(std::abs(run.json["results"]["max_torque_Nm"].get<double>() / steady() - 1.0) < 2e-3);
    CHECK(run.json["results"]["max_at_time_s"] >= run.json["results"]["of"]["from_s"]);
  }
  // The same from the file, and the command line has the last word.
  const Ran file = run_of(disc("8", "settle = \"auto\"\n"));
  CHECK(file.json["results"]["of"]["settled"] == true);
  // Damping ratio 0.02, decay 2/s.
  CHECK(std::abs(file.json["results"]["of"]["from_s"].get<double>() -
                 std::log(1e3 / std::sqrt(1.0 - 4e-4)) / 2.0) < 1e-6);
  CHECK(contains(file.text, "of the run from 3.45398 s to 5 s"));
  CHECK(contains(file.text, "decayed to 0.1 %"));
  CHECK(run_of(disc("8", "settle_s = 1.5\n")).json["results"]["of"]["from_s"] == 1.5);
  CHECK(run_of(disc("8", "settle_s = 1.5\n"), {"--settle", "2"}).json["results"]["of"]["from_s"] == 2.0);
  const Ran periodic = run_of(disc("8", "start = \"periodic\"\n"));
  CHECK(periodic.json["results"]["of"]["settled"] == true);
  CHECK(contains(periodic.text, "which starts in the periodic motion of 0.125664 s (harmonic balance"));
}

TEST_CASE("A run that does not settle says so, and has its figures of the whole run") {
  for (const char* damping : {"0", "0.5"}) {
    const Ran run = run_of(disc(damping, "settle = \"auto\"\n"));
    REQUIRE(run.exit_code == 0);
    CHECK(run.json["results"]["of"]["settled"] == false);
    CHECK(run.json["results"]["of"]["from_s"] == 0.0);
    CHECK(contains(run.json["results"]["of"]["reason"].get<std::string>(), "the run of 5 s does not settle"));
  }
}

TEST_CASE("A run that settles but has no whole cycle left says just that") {
  // It has settled after 3.45398 s; the cycle, four turns, is 0.251327 s. That of the loads is two turns.
  const std::string of_loads = disc("8", "settle = \"auto\"\n");
  CHECK(run_of(of_loads, {"--duration", "3.58"}).json["results"]["of"]["settled"] == true);
  CHECK(contains(run_of(of_loads, {"--duration", "3.57"}).json["results"]["of"]["reason"].get<std::string>(),
                 "less than one cycle of 0.125664 s"));
  const std::string model = disc("8", "settle = \"auto\"\nstatic_turn_deg = 1440\n");
  const Ran shorter = run_of(model, {"--duration", "3.6"});
  REQUIRE(shorter.exit_code == 0);
  const Json& of = shorter.json["results"]["of"];
  CHECK(of["settled"] == false);
  CHECK(of["from_s"] == 0.0);
  const std::string reason = of["reason"];
  CHECK(contains(reason, "the run of 3.6 s ends less than one cycle of 0.251327 s after it has settled"));
  CHECK(contains(reason, "from 3.70531 s on there is a whole cycle"));
  CHECK_FALSE(contains(reason, "does not settle"));
  CHECK(contains(unwrapped(shorter.text), "ends less than one cycle of 0.251327 s"));
  CHECK(run_of(model, {"--duration", "3.71"}).json["results"]["of"]["settled"] == true);
  CHECK(contains(run_of(model, {"--duration", "3.4"}).json["results"]["of"]["reason"].get<std::string>(),
                 "the run of 3.4 s does not settle"));
}

TEST_CASE("A periodic start that no run settles on is no steady state: a warning in text, JSON and report",
          "[once]") {
  // A disc rattles in a wide gap without ever repeating.
  const TemporaryFolder folder;
  const std::string model = (folder / "m.toml").string(), report = (folder / "r.html").string();
  std::ofstream(model)
      << "format = 1\n[nodes]\nmotor = { constant_speed_rad_per_s = 100 }\ndisc = {}\n[elements]\n"
         "J = { type = \"inertia\", node = \"disc\", inertia_kg_m2 = 2 }\n"
         "teeth = { type = \"dead_band_coupling\", nodes = [\"motor\", \"disc\"], stiffness_Nm_per_rad = "
         "2e5, "
         "gap_rad = 0.02, damping_Nms_per_rad = 20 }\n"
         "load = { type = \"engine_order_torque\", node = \"disc\", mean_Nm = 20, twist_feedback = false, "
         "harmonics = { order = [1], amplitude_Nm = [500] } }\n[run]\nduration_s = 0.1\n";
  std::vector<std::string> words{"run", model, "--start", "periodic", "--report", report};
  const auto text = drev_command(words);
  CHECK(text.exit_code == 0);
  CHECK(contains(unwrapped(text.out), "WARNING: the run does not start in a periodic steady state"));
  CHECK_FALSE(contains(unwrapped(text.out), "s settled (it changes"));
  CHECK(contains(read_file(report), "does not start in a periodic steady state"));
  words.emplace_back("--json");
  const Json json = Json::parse(drev_command(words).out);
  REQUIRE(json["warnings"].size() == 1);
  CHECK(contains(json["warnings"][0].get<std::string>(), "from cycle to cycle at its end"));
  CHECK(json["results"]["of"]["settled"] == false);
  CHECK(contains(json["results"]["of"]["start"].get<std::string>(),
                 "which did not settle on a periodic motion"));
}

TEST_CASE(
    "A chain that is far softer at rest than the coupling it stands for: a warning in text, JSON and "
    "report") {
  const TemporaryFolder folder;
  const std::string model = (folder / "m.toml").string(), report = (folder / "r.html").string();
  for (const char* eta : {"0.1", "0.5"}) {
    std::ofstream(model) << "format = 1\n[nodes]\nw = { hold = true }\na = {}\n[elements]\n"
                            "J = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n"
                            "c = { type = \"elastic_coupling\", nodes = [\"w\", \"a\"], "
                            "stiffness_Nm_per_rad = 1e4, loss_factor = "
                         << eta
                         << ", lowest_frequency_Hz = 10, highest_frequency_Hz = 20, permitted_error = 0.2 }\n"
                            "h = { type = \"applied_torque\", node = \"a\", torque_Nm = 100 }\n"
                            "[run]\nduration_s = 20\nrecord = [\"a.angle_rad\"]\n";
    std::vector<std::string> words{"run", model, "--report", report};
    const auto text = drev_command(words);
    CHECK(text.exit_code == 0);
    words.emplace_back("--json");
    const Json warnings = Json::parse(drev_command(words).out).at("warnings");
    const bool soft = std::string(eta) == "0.5";
    REQUIRE(warnings.size() == (soft ? 1 : 0));
    CHECK(contains(unwrapped(text.out), "of the 10000 N m/rad stated") == soft);
    CHECK(contains(read_file(report), "of the 10000 N m/rad stated") == soft);
  }
}

TEST_CASE("What cannot be a start or a settling time is a fault of its place, all at once") {
  const Ran wrong = run_of(disc("8", "start = \"periodc\"\nsettle = \"often\"\n"));
  CHECK(wrong.exit_code == 2);
  for (const char* part :
       {"m.toml:11", "start", "did you mean 'periodic'", "m.toml:12", "must be auto, or a time"})
    CHECK(contains(wrong.err, part));
  CHECK(
      contains(run_of(disc("8", "settle_s = 6\n")).err, "must be auto, or a time from 0 s to less than 5 s"));
  CHECK(contains(run_of(disc("8", "settle = \"auto\"\nsettle_s = 1\n")).err, "is there already"));
  // No steady state: the run fails, and says why.
  const std::string free_drive =
      "format = 1\n[nodes]\nshaft = { nominal_speed_rad_per_s = 100 }\n[elements]\n"
      "J = { type = \"inertia\", node = \"shaft\", inertia_kg_m2 = 1 }\n[run]\nstart = \"periodic\"\n";
  const Ran none = run_of(free_drive);
  CHECK(none.exit_code == 1);
  CHECK(none.json["status"] == "failed");
  CHECK(contains(none.json["reason"].get<std::string>(), "floats freely (with shaft)"));
}

TEST_CASE("With --accuracy, figures and their errors are of the part after the settling time", "[once]") {
  // The transient has the time constant 2 J/c = 0.5 s: exp(-9) of it is left after 4.5 s.
  const Ran settled = run_of(disc("8", ""), {"--settle", "4.5", "--accuracy", "1e-8"});
  INFO(settled.err);
  REQUIRE(settled.exit_code == 0);
  const Json& results = settled.json["results"];
  CHECK(results["of"]["from_s"] == 4.5);
  CHECK(results["checked"] == true);
  CHECK(settled.json["accuracy"]["reached"] == true);
  const double peak = results["max_torque_Nm"], error = results["max_error"];
  CHECK(peak == Approx(steady()).epsilon(2e-4));
  CHECK(results["max_at_time_s"].get<double>() >= 4.5);
  // A much tighter plain run over the same part.
  const Ran plain = run_of(disc("8", ""), {"--settle", "4.5", "--tolerance", "1e-14"});
  CHECK(std::abs(plain.json["results"]["max_torque_Nm"].get<double>() - peak) <= error);
  CHECK(plain.json["results"]["max_error"].is_null());
  // Of the whole run it is another, with the start in it.
  const Ran whole = run_of(disc("8", ""), {"--accuracy", "1e-8"});
  CHECK(whole.json["results"]["max_torque_Nm"].get<double>() > peak + 1.0);
  // auto, and from a start of its own: there is nothing to wait for in the steady state.
  const Ran found = run_of(disc("8", "settle = \"auto\"\n"), {"--accuracy", "1e-6"});
  CHECK(found.json["results"]["of"]["from_s"].get<double>() > 1.0);
  CHECK(found.json["results"]["max_torque_Nm"].get<double>() == Approx(steady()).epsilon(1e-3));
  for (const char* start : {"periodic", "static"}) {
    const Ran from = run_of(disc("8", ""), {"--start", start, "--settle", "2", "--accuracy", "1e-6"});
    INFO(start << ": " << from.err);
    REQUIRE(from.exit_code == 0);
    CHECK(from.json["results"]["of"]["from_s"] == 2.0);
    CHECK(from.json["results"]["max_torque_Nm"].get<double>() ==
          Approx(steady()).epsilon(start[0] == 'p' ? 1e-6 : 1e-2));
  }
}

TEST_CASE("A model that does not turn at its nominal speed says so before its figures") {
  // 10 N m against 0.1 N m s/rad: 100 rad/s, 20 % below the nominal 120.
  const auto drive = [](const char* torque) {
    return std::string(
               "format = 1\n[nodes]\nshaft = { nominal_speed_rad_per_s = 120 }\n[elements]\n"
               "J = { type = \"inertia\", node = \"shaft\", inertia_kg_m2 = 0.01 }\n"
               "drag = { type = \"dashpot\", node = \"shaft\", damping_Nms_per_rad = 0.1 }\n"
               "drive = { type = \"engine_order_torque\", node = \"shaft\", mean_Nm = ") +
           torque +
           ", harmonics = { order = [2], amplitude_Nm = [1] } }\n[run]\nduration_s = 3\nsettle_s = 1\n";
  };
  const Ran off = run_of(drive("10"));
  REQUIRE(off.exit_code == 0);
  CHECK(std::abs(off.json["speed"]["nominal_rpm"].get<double>() - 120.0 * 30.0 / kSettledPi) < 1e-6);
  CHECK(std::abs(off.json["speed"]["actual_rpm"].get<double>() - 100.0 * 30.0 / kSettledPi) < 0.5);
  REQUIRE(off.json["notes"].size() == 1);
  CHECK(off.text.starts_with("*** NOTE: the model turns at 954.9"));
  CHECK(contains(off.text, "not at the nominal 1145.9 rpm (-16.7 %)"));
  const Ran right = run_of(drive("12"));
  CHECK(right.json["notes"].empty());
  CHECK(!contains(right.text, "***"));
}

TEST_CASE("A run-up lists the criticals that it passes and tracks the orders over its speed") {
  const Ran run = run_of(
      "format = 1\n[nodes]\nend = { hold = true, run_up = { speed_0_rpm = 300, speed_1_rpm = 1800, time_1_s "
      "= 10 } }\n"
      "disc = {}\n[elements]\nJ = { type = \"inertia\", node = \"disc\", inertia_kg_m2 = 1 }\n"
      "shaft = { type = \"shaft_spring\", nodes = [\"end\", \"disc\"], stiffness_Nm_per_rad = 12279, "
      "damping_Nms_per_rad = 8 }\nload = { type = \"engine_order_torque\", node = \"disc\", harmonics = { "
      "order = "
      "[2], amplitude_Nm = [10] } }\n[run]\nduration_s = 10\nrecord = [\"shaft.torque_Nm\"]\n");
  REQUIRE(run.exit_code == 0);
  const double critical =
      std::sqrt(12279.0) / 2.0 * 30.0 / kSettledPi;  // 529 rpm, below half of the top speed
  const Json& up = run.json["run_up"];
  CHECK(up["slowest_rpm"].get<double>() == Approx(300.0));
  CHECK(up["fastest_rpm"].get<double>() == Approx(1800.0));
  REQUIRE(up["criticals"].size() == 1);
  CHECK(up["criticals"][0]["order"] == 2.0);
  CHECK(up["criticals"][0]["speed_rpm"].get<double>() == Approx(critical).epsilon(1e-6));
  REQUIRE(up["orders"] == Json::array({2.0}));
  const auto amplitude = up["channels"][0]["amplitude"][0].get<std::vector<double>>();
  const auto top = std::max_element(amplitude.begin(), amplitude.end()) - amplitude.begin();
  CHECK(std::abs(up["speed_rpm"][static_cast<std::size_t>(top)].get<double>() - critical) < 25.0);
  CHECK(contains(run.text, "300.00 rpm to 1800.0 rpm"));
  CHECK(contains(run.text, "529.0"));
  // Amplitudes are means over windows of four turns, and are called that.
  CHECK(up["turns"] == 4.0);
  CHECK(contains(run.text, "mean amplitudes over windows of 4 turns"));
  CHECK(contains(run.text, "shaft.torque_Nm: order 2 largest in the 4 turns about "));
  CHECK(run_of(disc("8", "")).json["run_up"].is_null());
}

TEST_CASE(
    "A start from rest without nominal speed has its orders by the turns of the driven node, or of one "
    "named") {
  const std::string nodes = "format = 1\n[nodes]\nrotor = {";
  const std::string elements =
      "}\ndisc = {}\n[elements]\n"
      "J_1 = { type = \"inertia\", node = \"rotor\", inertia_kg_m2 = 1 }\n"
      "J_2 = { type = \"inertia\", node = \"disc\", inertia_kg_m2 = 0.05 }\n"
      "shaft = { type = \"shaft_spring\", nodes = [\"rotor\", \"disc\"], stiffness_Nm_per_rad = 150, "
      "damping_Nms_per_rad = 0.15 }\nload = { type = \"engine_order_torque\", node = \"rotor\", mean_Nm = 5, "
      "harmonics = { order = [2], amplitude_Nm = [3] } }\n[run]\nduration_s = 10\n"
      "record = [\"shaft.torque_Nm\"]\n";
  const std::string model = nodes + elements;
  const Ran run = run_of(model);
  REQUIRE(run.exit_code == 0);
  const Json& up = run.json["run_up"];
  REQUIRE(up.is_object());
  CHECK(up["shaft"] == "rotor");
  CHECK(up["turns"] == 4.0);
  REQUIRE(up["orders"] == Json::array({2.0}));
  // Half of the natural frequency sqrt(k/J_1 + k/J_2); the mean torque alone gives 5/1.05 rad/s^2.
  const double critical = std::sqrt(150.0 * 21.0) / 2.0 * 30.0 / kSettledPi;
  REQUIRE(up["criticals"].size() == 1);
  CHECK(up["criticals"][0]["speed_rpm"].get<double>() == Approx(critical).epsilon(1e-6));
  const auto speed = up["speed_rpm"].get<std::vector<double>>(),
             time = up["time_s"].get<std::vector<double>>();
  REQUIRE(speed.size() > 10);
  for (std::size_t i = 0; i < speed.size(); ++i)
    CHECK(speed[i] == Approx(5.0 / 1.05 * time[i] * 30.0 / kSettledPi).epsilon(0.05).margin(10.0));
  CHECK(up["fastest_rpm"].get<double>() == Approx(speed.back()).epsilon(1e-12));
  CHECK(up["slowest_rpm"] == 0.0);
  CHECK(contains(run.text, "actual mean speeds of rotor"));
  CHECK(run_of(model, {"--orders-of", "disc"}).json["run_up"]["shaft"] == "disc");
  const Ran wrong = run_of(model, {"--orders-of", "dics"});
  CHECK(wrong.exit_code != 0);

  // A nominal run-up does not hold a rotor that floats freely: it turns as its torques make it, with the same orders.
  const std::string free =
      nodes + "run_up = { speed_0_rpm = 0, speed_1_rpm = 2000, time_1_s = 10 }" + elements;
  const Json floats = run_of(free).json["run_up"];
  CHECK(floats["shaft"] == "rotor");
  const auto actual = floats["speed_rpm"].get<std::vector<double>>();
  REQUIRE(actual.size() > 10);
  CHECK(actual.back() == Approx(speed.back()).epsilon(1e-3));
  const auto largest_of = [](const Json& of) {
    double most = 0.0;
    for (const double a : of["channels"][0]["amplitude"][0]) most = std::max(most, a);
    return most;
  };
  CHECK(largest_of(floats) == Approx(largest_of(up)).epsilon(1e-3));
  CHECK(run_of(free, {"--orders-of", "disc"}).json["run_up"]["shaft"] == "disc");
}

TEST_CASE(
    "A static torque is stated where turning slowly would give it, and the amplification says against what") {
  // A cam on a shaft; the shaft's other end on a grid at constant speed, stiffly or by something soft.
  const auto cam = [](const char* stiffness, const char* more) {
    return std::string(
               "format = 1\n[nodes]\ncam = {}\ngrid = { constant_speed_rpm = 60 }\n[elements]\n"
               "J = { type = \"inertia\", node = \"cam\", inertia_kg_m2 = 0.1 }\n"
               "shaft = { type = \"shaft_spring\", nodes = [\"grid\", \"cam\"], stiffness_Nm_per_rad = ") +
           stiffness +
           ", damping_Nms_per_rad = 3 }\nload = { type = \"engine_order_torque\", node = \"cam\", mean_Nm = "
           "20, "
           "harmonics = { order = [1], amplitude_Nm = [100] } }\n" +
           more + "[run]\nduration_s = 3\nstatic_turn_deg = 360\n";
  };
  const Ran stiff = run_of(cam("1e5", ""));
  REQUIRE(stiff.exit_code == 0);
  CHECK(stiff.json["results"]["static_torque_Nm"].get<double>() == Approx(120.0).epsilon(1e-3));
  CHECK(stiff.json["results"]["dynamic_amplification"].is_number());
  CHECK(contains(stiff.text, "the largest torque over the largest in static equilibrium over one turn, 12"));
  const Ran soft = run_of(cam("300", ""));
  CHECK(soft.json["results"]["static_torque_Nm"].is_null());
  CHECK(soft.json["results"]["dynamic_amplification"].is_null());
  CHECK(contains(soft.json["results"]["static_reason"].get<std::string>(),
                 "something soft such as a spring to ground"));
  const Ran timed =
      run_of(cam("1e5",
                 "pulse = { type = \"applied_torque\", node = \"cam\", harmonics = { frequency_Hz = "
                 "[3], amplitude_Nm = [5] } }\n"));
  CHECK(timed.json["results"]["static_torque_Nm"].is_null());
  CHECK(contains(timed.json["results"]["static_reason"].get<std::string>(), "pulse follows the time"));
}

TEST_CASE(
    "Unchecked figures say so, with an accuracy, text and JSON have the accurate ones with their digits") {
  const Ran plain = run_of(disc("8", ""));
  CHECK(plain.json["results"]["checked"] == false);
  CHECK(plain.json["results"]["max_error"].is_null());
  CHECK(contains(plain.text, "unchecked: --accuracy gives"));
  const Ran run = run_of(disc("8", ""), {"--accuracy", "1e-6"});
  REQUIRE(run.exit_code == 0);
  CHECK(!contains(run.text, "unchecked"));
  CHECK(run.json["results"]["checked"] == true);
  for (const Json& figure : run.json["accuracy"]["figures"])
    if (figure["name"] == "peak torque") {
      CHECK(run.json["results"]["max_torque_Nm"] == figure["value"]);
      CHECK(run.json["results"]["max_error"] == figure["error"]);
    }
  // The same digits in the line of the largest torque and in the list of figures.
  const std::size_t line = run.text.find("Largest torque"), list = run.text.find("peak torque: ");
  REQUIRE(line != std::string::npos);
  REQUIRE(list != std::string::npos);
  const std::string value = run.text.substr(line + 15, run.text.find(" +-", line) - line - 15);
  CHECK(value == run.text.substr(list + 13, run.text.find(" +-", list) - list - 13));
}

TEST_CASE("A torque of which rounding leaves little is printed with what it leaves") {
  const std::string stiff =
      "format = 1\n[nodes]\nmotor = {}\nload = {}\n[elements]\n"
      "a = { type = \"inertia\", node = \"motor\", inertia_kg_m2 = 0.012 }\n"
      "b = { type = \"inertia\", node = \"load\", inertia_kg_m2 = 0.035 }\n"
      "shaft = { type = \"shaft_spring\", nodes = [\"motor\", \"load\"], stiffness_Nm_per_rad = 1e16 }\n"
      "drive = { type = \"applied_torque\", node = \"motor\", harmonics = { frequency_Hz = [40], "
      "amplitude_Nm = "
      "[20], phase_deg = [-90] } }\n[run]\nduration_s = 0.05\n";
  const Ran run = run_of(stiff, {"--method", "sdirk4", "--tolerance", "1e-4"});
  REQUIRE(run.exit_code == 0);
  CHECK(contains(run.text, "shaft is so stiff that rounding"));
  // Rigid: the load's share of the torque.
  const Json& results = run.json["results"];
  const double off = results["max_torque_Nm"].get<double>() - 20.0 * 0.035 / 0.047;
  REQUIRE(results["max_error"].is_number());
  CHECK(std::abs(off) < results["max_error"].get<double>());
  CHECK(contains(run.text.substr(run.text.find("Largest torque")), " +- "));
}

TEST_CASE("Advice is of the figures that a run has: from its start, and settled", "[once]") {
  const TemporaryFolder folder;
  const std::string path = (folder / "m.toml").string();
  for (const char* run :
       {"start = \"static\"\n", "start = \"periodic\"\n", "settle_s = 2\n", "settle = \"auto\"\n"}) {
    const std::string model = disc("8", run);
    std::ofstream(path) << model;
    const auto advice = drev_command({"advise", path, "--for", "peak torque", "--json"});
    INFO(run << advice.err);
    REQUIRE(advice.exit_code == 0);
    const double value = Json::parse(advice.out).at("rungs").back().at("value");
    CHECK(value == Approx(run_of(model).json["results"]["max_torque_Nm"].get<double>()).epsilon(1e-3));
  }
}

TEST_CASE("Advice on a steady figure says that the full model's run has not settled where it begins",
          "[once]") {
  const TemporaryFolder folder;
  const std::string path = (folder / "m.toml").string();
  const auto advice = [&](const char* damping, std::vector<std::string> words) {
    std::ofstream(path) << disc(damping, "");
    words.insert(words.begin(), {"advise", path, "--for", "steady peak torque"});
    return drev_command(words).out;
  };
  CHECK(Json::parse(advice("8", {"--json"})).at("notes").empty());  // ln(1e3) 2 J/c = 3.454 s
  const Json notes = Json::parse(advice("4", {"--json"})).at("notes");
  REQUIRE(notes.size() == 1);
  CHECK(contains(notes[0], "has not settled at 4 s"));
  CHECK(contains(notes[0], "after 6.908 s"));
  CHECK(contains(unwrapped(advice("4", {})), notes[0].get<std::string>()));
}

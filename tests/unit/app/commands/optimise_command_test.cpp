// drev optimise: optima with a closed form, all combinations where they are few, the same for the same seed.
// Covers app/variants/optimum.hpp.
#include <drev/core/units.hpp>

#include <algorithm>
#include <chrono>
#include <complex>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using drev::test::read_file;
using drev::test::TemporaryFolder;
using Json = nlohmann::json;

namespace {

using Words = std::vector<std::string>;

constexpr double kForcedFrequency = 10.0, kAbsorberInertia = 0.1;  // Hz, kg m^2

/// A disc on a shaft under a harmonic torque, with a tuned absorber: it stands still where the absorber by itself has
/// the torque's frequency, k = J w^2 (J. Ormondroyd, J. P. Den Hartog, Trans. ASME 50, 1928).
std::string absorber_file(const TemporaryFolder& folder) {
  const std::string path = (folder / "absorber.toml").string();
  std::ofstream(path)
      << "format = 1\n[parameters]\nk_Nm_per_rad = 300\n"
         "[nodes]\nwall = { hold = true }\ndisc = {}\nring = {}\n[elements]\n"
         "J = { type = \"inertia\", node = \"disc\", inertia_kg_m2 = 1 }\n"
         "J_ring = { type = \"inertia\", node = \"ring\", inertia_kg_m2 = 0.1 }\n"
         "shaft = { type = \"shaft_spring\", nodes = [\"wall\", \"disc\"], stiffness_Nm_per_rad = 2000, "
         "damping_Nms_per_rad = 1 }\n"
         "rubber = { type = \"shaft_spring\", nodes = [\"disc\", \"ring\"], "
         "stiffness_Nm_per_rad = \"k_Nm_per_rad\" }\n"
         "pulse = { type = \"applied_torque\", node = \"disc\", harmonics = { frequency_Hz = [10], "
         "amplitude_Nm = [10], phase_deg = [0] } }\n"
         "[run]\nduration_s = 0.1\n";
  return path;
}

Words search(const std::string& file, const Words& more) {
  Words words{"optimise", file, "--start", "periodic", "--record", "disc.angle_rad", "--json"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

TEST_CASE("The absorber that stops a disc is found by a search", "[once]") {
  const TemporaryFolder folder;
  const std::string file = absorber_file(folder);
  const Words words =
      search(file, {"--vary", "k_Nm_per_rad=uniform(100,900)", "--minimise", "disc.angle_rad.max",
                    "--variants", "120", "--out", (folder / "r").string()});
  const auto found = drev_command(words);
  INFO(found.err);
  REQUIRE(found.exit_code == 0);
  const Json json = Json::parse(found.out);
  const double omega = 2.0 * drev::kPi * kForcedFrequency;
  CHECK(json.at("best")[0].at("varied").at("k_Nm_per_rad").get<double>() ==
        Approx(kAbsorberInertia * omega * omega).epsilon(1e-4));
  CHECK_FALSE(json.at("all_combinations").get<bool>());
  CHECK(json.at("variants").get<int>() <= 120);
  CHECK(json == Json::parse(read_file(folder / "r/optimum.json")));
  const std::string tried = read_file(folder / "r/tried.csv");
  CHECK(tried.starts_with("k_Nm_per_rad,status,disc.angle_rad.max,reason\n"));
  CHECK(std::count(tried.begin(), tried.end(), '\n') == json.at("variants").get<int>() + 1);
  Words again = words;
  again.insert(again.end(), {"--jobs", "1"});
  CHECK(drev_command(again).out == found.out);
}

TEST_CASE(
    "All combinations are computed where there are no more than the variants allowed, the best is certain",
    "[once]") {
  const TemporaryFolder folder;
  const std::string file = absorber_file(folder);
  const auto found = drev_command(search(
      file, {"--vary", "k_Nm_per_rad=100:50:900", "--maximise", "disc.angle_rad.max", "--variants", "17"}));
  INFO(found.err);
  REQUIRE(found.exit_code == 0);
  const Json json = Json::parse(found.out);
  CHECK(json.at("all_combinations").get<bool>());
  CHECK(json.at("variants") == 17);
  CHECK(json.at("goal") == "largest");
  // Amplitude of the disc by its frequency response, damping of the shaft with it.
  const double w = 2.0 * drev::kPi * kForcedFrequency;
  double most = 0.0, at = 0.0;
  for (double k = 100.0; k <= 900.0; k += 50.0) {
    const std::complex<double> absorber = k * kAbsorberInertia * w * w / (k - kAbsorberInertia * w * w);
    const double amplitude = 10.0 / std::abs(std::complex<double>(2000.0 - w * w, w) - absorber);
    if (amplitude > most) most = amplitude, at = k;
  }
  CHECK(json.at("best")[0].at("varied").at("k_Nm_per_rad") == at);
  CHECK(json.at("best")[0].at("value").get<double>() == Approx(most).epsilon(1e-6));
}

TEST_CASE(
    "Combinations that failed are stated with their reasons, and the best is certain without them only") {
  const TemporaryFolder folder;
  const Words words{"optimise",   "gear_drive",
                    "--vary",     "backlash_mm=50,0.1,0.2",
                    "--minimise", "max_mesh_force_N",
                    "--step",     "2e-5",
                    "--duration", "0.01",
                    "--out",      (folder / "r").string()};
  const auto found = drev_command(words);
  INFO(found.out << found.err);
  CHECK(found.exit_code == 0);
  CHECK(contains(found.out,
                 "backlash_mm=50: bad_input: gear_drive/settings: backlash_mm = 50 mm, must be 0 to 10"));
  CHECK(contains(found.out, "among the 2 of 3 combinations that have a figure"));
  CHECK_FALSE(contains(found.out, "yes"));
  const Json json = Json::parse(read_file(folder / "r/optimum.json"));
  CHECK(json.at("without_figure") == 1);
  REQUIRE(json.at("failures").size() == 1);
  CHECK(json.at("failures")[0].at("status") == "bad_input");
  CHECK(json.at("failures")[0].at("varied").at("backlash_mm") == 50.0);
  CHECK(contains(json.at("failures")[0].at("reason"), "backlash_mm = 50 mm, must be 0 to 10"));
  CHECK(contains(read_file(folder / "r/tried.csv"),
                 "50,bad_input,,\"gear_drive/settings: backlash_mm = 50 mm, must"));
}

TEST_CASE("A search among firing orders and numbers together comes near the best of all orders") {
  const Words camshaft{"optimise",
                       "camshaft",
                       "--set",
                       "drive=held",
                       "cylinders=6",
                       "--vary",
                       "firing_order=orders(6)",
                       "--minimise",
                       "deflection_deg",
                       "--duration",
                       "0.02",
                       "--step",
                       "1e-4",
                       "--json"};
  Words all = camshaft, some = camshaft;
  all.insert(all.end(), {"--variants", "120"});
  some.insert(some.end(), {"--variants", "60", "--vary", "engine_rpm=uniform(740,760)"});
  const auto every = drev_command(all), found = drev_command(some);
  INFO(every.err << found.err);
  REQUIRE(every.exit_code == 0);
  REQUIRE(found.exit_code == 0);
  const Json certain = Json::parse(every.out), json = Json::parse(found.out);
  CHECK(certain.at("all_combinations").get<bool>());
  CHECK(certain.at("variants") == 120);
  CHECK_FALSE(json.at("all_combinations").get<bool>());
  CHECK(json.at("variants") == 60);
  const double best = certain.at("best")[0].at("value"), worst_told = certain.at("best")[9].at("value");
  CHECK(json.at("best")[0].at("value").get<double>() < worst_told + 0.05 * best);
}

TEST_CASE("What is wrong with an optimisation is said at once") {
  const auto wrong =
      drev_command({"optimise", "gear_drive", "--vary", "backlash_mm=normal(0.1,0.01)", "--minimise",
                    "max_mesh_force_N", "--maximise", "max_mesh_force_N", "--variants", "0"});
  CHECK(wrong.exit_code == 2);
  for (const char* part : {"has no bounds", "cannot be given with --maximise", "--variants"})
    CHECK(contains(wrong.err, part));
  const auto figure = drev_command({"optimise", "gear_drive", "--vary", "backlash_mm=0.1,0.2", "--minimise",
                                    "max_mesh_force", "--step", "1e-4"});
  CHECK(figure.exit_code == 2);
  CHECK(contains(figure.err, "did you mean 'max_mesh_force_N'"));
  CHECK(contains(figure.err, "front_contacts"));
  CHECK(drev_command({"optimise", "gear_drive", "--minimise", "max_mesh_force_N"}).exit_code == 2);
  const auto both = drev_command({"optimise", "gear_drive", "--vary", "backlash_mm=0.1,0.2", "--minimise",
                                  "max_mesh_force", "--variants", "0"});
  CHECK(contains(both.err, "did you mean 'max_mesh_force_N'"));
  CHECK(contains(both.err, "--variants = 0"));
  const auto name = drev_command({"optimise", "gear_drive", "--vary", "backlsh_mm=0.1,0.2", "--minimise",
                                  "max_mesh_force", "--variants", "0"});
  CHECK(contains(name.err, "did you mean 'backlash_mm'"));
  CHECK(contains(name.err, "--variants = 0"));
}

TEST_CASE("The least energy error is that of the least size, of either sign") {
  const auto found =
      drev_command({"optimise", "gear_drive", "--vary", "backlash_mm=0.05,0.15,0.25", "--minimise",
                    "energy_error", "--step", "1e-4", "--duration", "0.05", "--json"});
  INFO(found.out << found.err);
  REQUIRE(found.exit_code == 0);
  const Json best = Json::parse(found.out).at("best");
  REQUIRE(best.size() == 3);
  bool negative = false;
  for (std::size_t i = 0; i < best.size(); ++i) {
    const double error = best[i].at("value").get<double>();
    negative |= error < 0.0;
    if (i > 0) CHECK(std::abs(error) > std::abs(best[i - 1].at("value").get<double>()));
  }
  CHECK(negative);
  CHECK(best[2].at("value") > 0.0);
}

TEST_CASE("A distribution of a parameter that is a whole number is refused by the word that was typed") {
  const TemporaryFolder folder;
  const auto refused = [&](Words words) {
    words.insert(words.end(),
                 {"--duration", "0.01", "--vary", "cylinders=uniform(5.5,9)", "--set", "drive=held"});
    const auto run = drev_command(words);
    INFO(run.err);
    CHECK(run.exit_code == 2);
    CHECK(contains(run.err,
                   "--vary = cylinders=uniform(5.5,9), cylinders is a whole number: give its values, "
                   "cylinders=6:1:9"));
    CHECK_FALSE(contains(run.err, "must be a whole number"));
  };
  refused({"optimise", "camshaft", "--minimise", "deflection_deg"});
  refused({"run", "camshaft", "--sample", "lhs:4", "--out", (folder / "r").string()});
  const auto choice = drev_command({"run", "camshaft", "--sample", "lhs:4", "--out", (folder / "c").string(),
                                    "--duration", "0.01", "--vary", "drive=normal(1,1)"});
  CHECK(contains(choice.err, "has a distribution of numbers, and drive is "));
}

TEST_CASE("An optimisation of a model that settles has its figures of the whole runs, with --settle 0") {
  const TemporaryFolder folder;
  const std::string file = absorber_file(folder);
  std::ofstream(file, std::ios::app) << "settle_s = 0.05\n";
  const Words words = search(file, {"--vary", "k_Nm_per_rad=300,400", "--minimise", "disc.angle_rad.max"});
  const auto settles = drev_command(words);
  CHECK(settles.exit_code == 2);
  CHECK(contains(settles.err, "give --settle 0"));
  Words whole = words;
  whole.insert(whole.end(), {"--settle", "0"});
  const auto found = drev_command(whole);
  INFO(found.err);
  CHECK(found.exit_code == 0);
  whole.back() = "0.01";
  CHECK(contains(drev_command(whole).err, "is for single runs"));
}

TEST_CASE("The text of an optimisation keeps long figures apart from their values") {
  const TemporaryFolder folder;
  const auto found =
      drev_command({"optimise", absorber_file(folder), "--start", "periodic", "--record", "shaft.torque_Nm",
                    "--vary", "k_Nm_per_rad=300,400", "--minimise", "shaft.torque_Nm.max"});
  INFO(found.err);
  CHECK(found.exit_code == 0);
  CHECK(contains(found.out, "least shaft.torque_Nm.max  "));
  // An angle that nothing moves: no value is better than another.
  const std::string still = (folder / "still.toml").string();
  std::ofstream(still) << "format = 1\n[parameters]\nJ_kg_m2 = 1\n[nodes]\na = {}\n[elements]\n"
                          "J = { type = \"inertia\", node = \"a\", inertia_kg_m2 = \"J_kg_m2\" }\n"
                          "[run]\nduration_s = 0.01\nrecord = [\"a.angle_rad\"]\n";
  const auto equal = drev_command({"optimise", still, "--vary", "J_kg_m2=1,2,3", "--minimise",
                                   "a.angle_rad.max", "--record", "a.angle_rad"});
  INFO(equal.out << equal.err);
  CHECK(contains(equal.out, "any: all 3 have this figure"));
}

TEST_CASE("An optimum whose run starts in no steady state says so, and is not certain") {
  // A disc rattles in a wide gap without ever repeating; without the gap it is linear.
  const TemporaryFolder folder;
  const std::string file = (folder / "m.toml").string();
  std::ofstream(file)
      << "format = 1\n[parameters]\ngap_rad = { default = 0.02, min = 0, max = 1 }\n"
         "[nodes]\nmotor = { constant_speed_rad_per_s = 100 }\ndisc = {}\n[elements]\n"
         "J = { type = \"inertia\", node = \"disc\", inertia_kg_m2 = 2 }\n"
         "teeth = { type = \"dead_band_coupling\", nodes = [\"motor\", \"disc\"], "
         "stiffness_Nm_per_rad = 2e5, gap_rad = \"gap_rad\", damping_Nms_per_rad = 20 }\n"
         "load = { type = \"engine_order_torque\", node = \"disc\", mean_Nm = 20, twist_feedback = false, "
         "harmonics = { order = [1], amplitude_Nm = [500] } }\n[run]\nduration_s = 0.1\nstart = "
         "\"periodic\"\n";
  const Words words{"optimise",   file,
                    "--vary",     "gap_rad=0,0.02",
                    "--maximise", "max_torque_Nm",
                    "--out",      (folder / "r").string()};
  const auto found = drev_command(words);
  INFO(found.out << found.err);
  CHECK(
      found.out.starts_with("*** WARNING: gap_rad=0.02: the run does not start in a periodic steady state"));
  CHECK(contains(found.out, "no: 1 of the 2 combinations have a warning"));
  const Json json = Json::parse(read_file(folder / "r/optimum.json"));
  CHECK(json.at("with_warning") == 1);
  CHECK(contains(json.at("best")[0].at("warning"), "does not start in a periodic steady state"));
  CHECK(json.at("best")[1].at("warning").is_null());
}

TEST_CASE("A search for the largest value at a bound tries the bound, and no value beyond it") {
  const TemporaryFolder folder;
  const std::string file = (folder / "m.toml").string();
  std::ofstream(file)
      << "format = 1\n[parameters]\nk_Nm_per_rad = { default = 100, min = 1, max = 166.66666666666666 }\n"
         "[nodes]\nwall = { hold = true }\ndisc = { initial_speed_rad_per_s = 1 }\n[elements]\n"
         "J = { type = \"inertia\", node = \"disc\", inertia_kg_m2 = 1 }\n"
         "s = { type = \"shaft_spring\", nodes = [\"wall\", \"disc\"], "
         "stiffness_Nm_per_rad = \"k_Nm_per_rad\" }\n[run]\nduration_s = 0.5\n";
  const Words words{
      "optimise",      file,         "--vary", "k_Nm_per_rad=uniform(100,166.66666666666666)", "--maximise",
      "max_torque_Nm", "--variants", "40"};
  const auto text = drev_command(words);
  INFO(text.out << text.err);
  CHECK(contains(text.out, "k_Nm_per_rad=166.66666666666666"));
  CHECK_FALSE(contains(text.out, "failed"));
  CHECK(contains(text.out, "another --seed finds more"));
}

TEST_CASE("An optimisation that is interrupted among all combinations says so, and claims no search") {
  const TemporaryFolder folder;
  const Words words{"optimise",   absorber_file(folder),
                    "--vary",     "k_Nm_per_rad=100:1:1000",
                    "--minimise", "max_torque_Nm",
                    "--step",     "1e-6",
                    "--duration", "1",
                    "--variants", "1000"};
  drev::test::Outcome outcome;
  // A signal before the computation has begun is answered by another sentence.
  for (int wait = 200; wait < 20000; wait *= 2) {
    const drev::test::Process process(words);
    std::this_thread::sleep_for(std::chrono::milliseconds(wait));
    process.send(SIGINT);
    outcome = process.wait();
    if (!contains(outcome.err, "nothing is written")) break;
  }
  INFO(outcome.out << outcome.err);
  CHECK(outcome.exit_code == 130);
  CHECK(contains(outcome.err, "drev: interrupted; the optimum is that of the "));
  CHECK(contains(outcome.out, "interrupted before"));
  CHECK_FALSE(contains(outcome.out, "search"));
}

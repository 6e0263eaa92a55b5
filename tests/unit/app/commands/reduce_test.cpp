// --reduce: figures, history and report of the reduced run, beside the whole model's by another method.
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using drev::test::read_file;
using drev::test::TemporaryFolder;
using Json = nlohmann::json;

namespace {

/// Two shafts of so many segments between heavy flywheels, driven far below most of their modes.
std::string train(int segments, double duration) {
  std::ostringstream text;
  text << R"(format = 1
[nodes]
a = {}
b = {}
c = {}
d = {}
[elements]
Ja = { type = "inertia", node = "a", inertia_kg_m2 = 5 }
Jb = { type = "inertia", node = "b", inertia_kg_m2 = 1 }
Jc = { type = "inertia", node = "c", inertia_kg_m2 = 1 }
Jd = { type = "inertia", node = "d", inertia_kg_m2 = 5 }
coupling = { type = "shaft_spring", nodes = ["b", "c"], stiffness_Nm_per_rad = 1e6 }
drive = { type = "applied_torque", node = "a", harmonics = { frequency_Hz = [10], amplitude_Nm = [2000], phase_deg = [-90] } }
load = { type = "applied_torque", node = "d", harmonics = { frequency_Hz = [5], amplitude_Nm = [500], phase_deg = [-90] } }
)";
  for (const char* shaft : {"s1 = { nodes = [\"a\", \"b\"]", "s2 = { nodes = [\"c\", \"d\"]"})
    text << shaft << R"(, type = "distributed_shaft", shear_modulus_GPa = 80, density_kg_per_m3 = 7850, )"
         << "outer_diameter_mm = 100, length_m = 5, segments = " << segments << ", mass = \"lumped\" }\n";
  text << "[run]\nduration_s = " << duration << "\ntorques = \"coupling.torque_Nm\"\n"
       << "record = [\"a.angle_rad\", \"b.speed_rad_per_s\", \"coupling.torque_Nm\", \"a-d.twist_rad\"]\n";
  return text.str();
}

std::vector<std::vector<double>> rows_of(const std::filesystem::path& path) {
  std::istringstream file(read_file(path));
  std::string line, cell;
  std::getline(file, line);
  std::vector<std::vector<double>> rows;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    rows.emplace_back();
    while (std::getline(cells, cell, ',')) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

}  // namespace

TEST_CASE("Option --reduce: what is written is within the error stated of the whole model by implicit steps",
          "[once]") {
  const TemporaryFolder folder;
  const std::string file = (folder / "train.toml").string();
  std::ofstream(file) << train(40, 0.2);
  const auto run = [&](std::vector<std::string> words, const std::string& out) {
    words.insert(words.begin(), {"run", file, "--out", (folder / out).string()});
    const auto outcome = drev_command(words);
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    return outcome.out;
  };
  run({"--step", "5e-6"}, "whole");
  const auto whole = rows_of(folder / "whole/history.csv");
  // 0.1 %: the first trial is out by more, the second is not.
  for (const auto& [asked, within] : {std::pair{"1%", 0.01}, {"0.001", 0.001}}) {
    const std::string text = run({"--reduce", asked}, "reduced");
    CHECK(contains(text, "of 82"));
    CHECK(contains(text, "is estimated"));
    const Json summary = Json::parse(read_file(folder / "reduced/summary.json"));
    const Json& r = summary.at("reduction");
    CHECK(r.at("within") == within);
    REQUIRE(r.at("used") == true);
    CHECK(r.at("unknowns") == 82);
    CHECK(r.at("coordinates").get<int>() < 20);
    const double error = r.at("error").get<double>();
    CHECK(error <= within);
    const auto reduced = rows_of(folder / "reduced/history.csv");
    REQUIRE(reduced.size() == whole.size());
    for (std::size_t c = 1; c < whole[0].size(); ++c) {
      double worst = 0.0, peak = 0.0;
      for (std::size_t i = 0; i < whole.size(); ++i) {
        worst = std::max(worst, std::abs(whole[i][c] - reduced[i][c]));
        peak = std::max(peak, std::abs(whole[i][c]));
      }
      INFO(asked << ", column " << c << ": " << worst / peak);
      CHECK(peak > 0.0);
      CHECK(worst <= error * peak);
    }
    // The report holds samples of the reduced run, and the command that gives it again.
    const std::string page = read_file(folder / "reduced/report.html");
    CHECK(contains(page, std::string("--method exact --tolerance 1e-10 --reduce ") +
                             (within == 0.01 ? "0.01" : "0.001")));
  }
  const Json off = Json::parse(drev_command({"run", file, "--reduce", "off", "--json"}).out);
  CHECK(off.at("reduction").at("used") == false);
  CHECK(off.at("reduction").at("within").is_null());
  CHECK(off.at("reduction").at("coordinates") == 82);
}

TEST_CASE("Option --reduce: a large model is reduced unasked, a method asked for runs the whole", "[once]") {
  const TemporaryFolder folder;
  const std::string file = (folder / "large.toml").string();
  std::ofstream(file) << train(1000, 1.0);
  const Json large = Json::parse(drev_command({"run", file, "--json"}).out);
  const Json& r = large.at("reduction");
  CHECK(r.at("used") == true);
  CHECK(r.at("unknowns") == 2002);
  CHECK(r.at("within") == Approx(1e-5));
  CHECK(r.at("error").get<double>() <= 1e-5);
  std::ofstream(file) << train(1000, 1e-4);
  const Json whole = Json::parse(drev_command({"run", file, "--step", "1e-5", "--json"}).out);
  CHECK(whole.at("reduction").at("used") == false);
}

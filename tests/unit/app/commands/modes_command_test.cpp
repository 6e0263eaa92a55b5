// drev modes of springs that are bent: they are about zero deflection, and say so where a mean torque is elsewhere.
#include <drev/core/units.hpp>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using Json = nlohmann::json;

namespace {

/// 2000 N m/rad up to 200 N m, 5000 N m/rad beyond.
std::string bent_train(const drev::test::TemporaryFolder& folder, const std::string& wall,
                       const std::string& torque) {
  const std::string path = (folder / "bent.toml").string();
  std::ofstream(path) << "format = 1\n[nodes]\nwall = { " << wall
                      << " }\nmotor = {}\n[elements]\n"
                         "J_wall = { type = \"inertia\", node = \"wall\", inertia_kg_m2 = 1 }\n"
                         "J = { type = \"inertia\", node = \"motor\", inertia_kg_m2 = 0.5 }\n"
                         "coupling = { type = \"polyline_spring\", nodes = [\"wall\", \"motor\"], points = { "
                         "deflection_rad = [-0.2, -0.1, 0.1, 0.2], torque_Nm = [-700, -200, 200, 700] } }\n"
                         "load = { type = \"applied_torque\", node = \"motor\", torque_Nm = "
                      << torque << " }\n";
  return path;
}

}  // namespace

TEST_CASE("Modes of a bent spring name the torque that holds it, and its stiffness there") {
  const drev::test::TemporaryFolder folder;
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--damped"}}) {
    std::vector<std::string> words{"modes", bent_train(folder, "hold = true", "450"), "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const auto run = drev_command(words);
    INFO(run.out << run.err);
    REQUIRE(run.exit_code == 0);
    const Json notes = Json::parse(run.out).at("notes");
    REQUIRE(notes.size() == 1);
    CHECK(notes[0] ==
          "coupling: modes are about zero deflection, with 2000 N m/rad; under the mean of the loads it "
          "carries 450 N m, where its law has 5000 N m/rad: about that they are others");
    words.erase(words.begin() + 2);
    CHECK(contains(drev_command(words).out, "under the mean of the loads it"));
  }
  const auto inside = drev_command({"modes", bent_train(folder, "hold = true", "150"), "--json"});
  CHECK(Json::parse(inside.out).at("notes").empty());
  const auto free = drev_command({"modes", bent_train(folder, "", "150")});
  INFO(free.out << free.err);
  CHECK(contains(free.out, "coupling: modes are about zero deflection, with 2000 N m/rad; its law is"));
  CHECK_FALSE(contains(drev_command({"modes", "two_mass_backlash"}).out, "bent"));
  CHECK_FALSE(contains(drev_command({"modes", "camshaft"}).out, "bent"));
}

TEST_CASE("Modes of a coupling that follows its load say which, and have one frequency for its chain") {
  const drev::test::TemporaryFolder folder;
  const std::string path = (folder / "coupling.toml").string();
  std::ofstream(path)
      << "format = 1\n[nodes]\na = {}\nb = {}\n[elements]\n"
         "Ja = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 2 }\n"
         "Jb = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 2 }\n"
         "rubber = { type = \"elastic_coupling\", nodes = [\"a\", \"b\"], by_mean_torque = { "
         "mean_torque_Nm = [0, 400], stiffness_Nm_per_rad = [1000, 5000], loss_factor = [0.1, 0.1] "
         "}, at_mean_torque_Nm = 200, lowest_frequency_Hz = 5, highest_frequency_Hz = 15 }\n";
  const auto run = drev_command({"modes", path, "--json"});
  INFO(run.out << run.err);
  REQUIRE(run.exit_code == 0);
  const Json found = Json::parse(run.out);
  REQUIRE(found.at("frequencies_Hz").size() == 1);
  CHECK(found["frequencies_Hz"][0].get<double>() == Approx(std::sqrt(3000.0) / drev::kTwoPi).epsilon(1e-12));
  REQUIRE(found.at("notes").size() == 1);
  CHECK(contains(found["notes"][0].get<std::string>(), "its at_mean_torque, 200 N m; drev campbell takes"));
  CHECK(contains(drev_command({"modes", path, "--damped"}).out, "its at_mean_torque, 200 N m"));
  CHECK(contains(drev_command({"modes", path, "--count", "2"}).err, "to 1"));
}

TEST_CASE("A free train whose modes do not swing turns freely, and does not grow by rounding") {
  const drev::test::TemporaryFolder folder;
  const std::string path = (folder / "dashpot.toml").string();
  std::ofstream(path) << "format = 1\n[nodes]\na = {}\nb = {}\n[elements]\n"
                         "Ja = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n"
                         "Jb = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 0.5 }\n"
                         "d = { type = \"dashpot\", nodes = [\"a\", \"b\"], damping_Nms_per_rad = 1 }\n";
  const auto counted = drev_command({"modes", path, "--count", "1"});
  CHECK(counted.exit_code == 2);
  CHECK(contains(counted.err, "--count = 1, must be left out: the model has no elastic modes"));
  const auto text = drev_command({"modes", path, "--damped"});
  INFO(text.out << text.err);
  CHECK(contains(text.out, "0 1/s: turns freely, without drag"));
  CHECK(contains(text.out, "-3.000000 1/s: decays"));
  CHECK_FALSE(contains(text.out, "grows"));
  const Json real =
      Json::parse(drev_command({"modes", path, "--damped", "--json"}).out).at("real_eigenvalues");
  REQUIRE(real.size() == 2);
  CHECK(real[0].at("turns_freely") == true);
  CHECK(real[0].at("real_per_s") == 0.0);
  CHECK(real[1].at("turns_freely") == false);
}

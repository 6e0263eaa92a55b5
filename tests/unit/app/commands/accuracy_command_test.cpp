// drev run --accuracy: figures with their errors in text, JSON and report.
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using drev::test::read_file;
using Json = nlohmann::json;

namespace {

Json figure(const Json& json, const std::string& name) {
  for (const Json& f : json.at("accuracy").at("figures"))
    if (f.at("name").get<std::string>().starts_with(name)) return f;
  return {};
}

}  // namespace

TEST_CASE("An accuracy asked for: published times of contact within the stated errors") {
  const drev::test::TemporaryFolder folder;
  const std::vector<std::string> words{"run", "two_mass_backlash", "--accuracy", "1e-6"};
  std::vector<std::string> json_words = words;
  json_words.insert(json_words.end(), {"--json", "--out", (folder / "out").string()});
  const auto run = drev_command(json_words);
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const Json json = Json::parse(run.out);
  CHECK(json.at("accuracy").at("reached") == true);
  CHECK(json.at("accuracy").at("horizon_s").is_null());
  const Json first = figure(json, "first contact change");
  CHECK(std::abs(first.at("value").get<double>() - 0.26207413942088966) <= first.at("error").get<double>());
  CHECK(figure(json, "contact changes, comparable").at("value") == 72);  // published
  for (const Json& f : json["accuracy"]["figures"]) CHECK(f.at("keeps_accuracy") == true);
  const std::string text = drev_command(words).out;
  for (const char* part : {"Accuracy asked          1e-06: reached", "peak deflection: 0.1855", "+-"})
    CHECK(contains(text, part));
  CHECK(contains(read_file(folder / "out/report.html"), R"("name":"peak deflection")"));
}

TEST_CASE("Contacts and mesh forces carry their errors, in JSON, text and report", "[once]") {
  const drev::test::TemporaryFolder folder;
  const auto words = [&](const char* tolerance, const char* value) {
    return std::vector<std::string>{"run",     "gear_drive", "--set", "duration_s=0.05",
                                    tolerance, value,        "--json"};
  };
  const Json tight = Json::parse(drev_command(words("--tolerance", "1e-14")).out).at("results");
  auto asked = words("--accuracy", "1e-3");
  asked.insert(asked.end(), {"--report", (folder / "r.html").string()});
  const auto run = drev_command(asked);
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const Json results = Json::parse(run.out).at("results");
  CHECK(results.at("checked") == true);
  const auto holds = [&](const Json& of, const Json& truth, const char* key, const char* error) {
    INFO(key << ": " << of.at(key) << " +- " << of.at(error) << ", " << truth.at(key));
    REQUIRE(of.at(error).is_number());
    CHECK(std::abs(of.at(key).get<double>() - truth.at(key).get<double>()) <= of.at(error).get<double>());
    CHECK(of.at(error).get<double>() <= 1e-3 * of.at(key).get<double>());
  };
  holds(results, tight, "max_mesh_force_N", "max_mesh_force_error");
  REQUIRE(results.at("contacts").size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    const Json &of = results.at("contacts")[i], &truth = tight.at("contacts")[i];
    holds(of, truth, "max_force_N", "max_force_error_N");
    holds(of, truth, "time_separated_s", "time_separated_error_s");
    holds(of, truth, "front_contacts", "front_contacts_error");
    holds(of, truth, "back_contacts", "back_contacts_error");
    CHECK(of.at("max_force_error_N").get<double>() > 0.0);
    CHECK(truth.at("max_force_error_N").is_null());  // a run without --accuracy
  }
  CHECK(contains(read_file(folder / "r.html"), "\"max_force_error_N\":"));
  const std::string text =
      drev_command({"run", "gear_drive", "--set", "duration_s=0.05", "--accuracy", "1e-3"}).out;
  CHECK(contains(text, "\n    +-   "));
}

TEST_CASE("An accuracy that rattling does not allow is refused point by point, and statistics given",
          "[once]") {
  const auto run =
      drev_command({"run", "gear_drive", "--set", "duration_s=0.3", "--accuracy", "1e-3", "--json"});
  INFO(run.err);
  CHECK(run.exit_code == 0);
  const Json json = Json::parse(run.out);
  const Json& accuracy = json.at("accuracy");
  CHECK(accuracy.at("reached") == false);
  CHECK(accuracy.at("horizon_s").get<double>() < 0.3);
  CHECK(accuracy.at("growth_rate_per_s").get<double>() > 0.0);
  CHECK(contains(accuracy.at("reason").get<std::string>(), "two runs differ by more than 0.001"));
  // Of one motion among many; its statistics have the intervals.
  CHECK(json.at("results").at("checked") == false);
  CHECK(json.at("results").at("contacts")[0].at("time_separated_error_s").is_null());
  CHECK(json.at("results").at("contacts")[0].at("front_contacts_error").is_null());
  const Json apart = figure(json, "mesh_1: share of time separated");
  CHECK(apart.at("kind") == "95 % interval");
  CHECK(figure(json, "mesh_1: rattle index").at("unit") == "W");
  // The run's own share over all its time, less than the batches' over nine tenths of it knows.
  CHECK(std::abs(apart.at("value").get<double>() -
                 json.at("results").at("contacts")[0].at("time_separated_share").get<double>()) < 0.1);
}

TEST_CASE("The error stated of a torque that is a function of time covers what small steps give") {
  const auto run =
      drev_command({"run", "two_inertia", "--set", "duration_s=0.05", "--accuracy", "1e-4", "--json"});
  INFO(run.err);
  CHECK(run.exit_code == 0);
  const Json json = Json::parse(run.out);
  CHECK(json.at("method") == "exact");
  CHECK(json.at("accuracy").at("reached") == true);
  const Json peak = figure(json, "peak torque");
  const auto fine =
      drev_command({"run", "two_inertia", "--set", "duration_s=0.05", "--step", "1e-7", "--json"});
  CHECK(std::abs(peak.at("value").get<double>() -
                 Json::parse(fine.out).at("results").at("max_torque_Nm").get<double>()) <=
        peak.at("error").get<double>());
}

TEST_CASE("Methods of high order come to an accuracy by their tolerance, others by their step", "[once]") {
  const Json exact =
      figure(Json::parse(drev_command({"run", "two_mass_backlash", "--accuracy", "1e-10", "--json"}).out),
             "peak deflection");
  for (const char* method : {"dormand_prince", "average_acceleration"}) {
    INFO(method);
    const bool controlled = std::string(method) == "dormand_prince";
    const auto run = drev_command({"run", "two_mass_backlash", "--method", method, "--accuracy",
                                   controlled ? "1e-7" : "1e-3", "--json"});
    INFO(run.err);
    REQUIRE(run.exit_code == 0);
    const Json json = Json::parse(run.out);
    CHECK(json.at("accuracy").at("reached") == true);
    CHECK(json.at("tolerance").is_null() != controlled);
    const Json peak = figure(json, "peak deflection");
    CHECK(std::abs(peak.at("value").get<double>() - exact.at("value").get<double>()) <=
          peak.at("error").get<double>());
  }
}

// The contact events of a run as a file.
// Covers app/results/event_file.hpp.
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using drev::test::read_file;
using drev::test::TemporaryFolder;
using Json = nlohmann::json;

TEST_CASE("A run writes each contact made or lost, as many as it located") {
  const TemporaryFolder folder;
  const std::string file = (folder / "events.csv").string();
  const auto run = drev_command({"run", "camshaft", "--set", "duration_s=0.02", "--events", file, "--json"});
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const Json json = Json::parse(run.out);
  std::istringstream text(read_file(file));
  std::string line;
  REQUIRE(std::getline(text, line));
  CHECK(line == "time_s,element,flank,contact,rate,rate_unit");
  long rows = 0;
  double before = 0.0;
  while (std::getline(text, line)) {
    ++rows;
    const double t = std::stod(line);
    CHECK(t >= before);
    before = t;
    CHECK(contains(line, ",mesh_"));
    CHECK((contains(line, ",made,") || contains(line, ",lost,")));
    CHECK(line.ends_with(",m/s"));
  }
  CHECK(rows > 10);
  CHECK(json.at("contact_changes") == rows);
}

TEST_CASE("Friction events of a run are rows of the file: what sticks and slides, when") {
  const TemporaryFolder folder;
  const std::string file = (folder / "events.csv").string();
  const auto run = drev_command(
      {"run", DREV_SOURCE_DIR "/models/vehicle_clutch/vehicle_clutch.toml", "--events", file, "--json"});
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const Json events = Json::parse(run.out).at("results").at("friction").at("events");
  std::istringstream text(read_file(file));
  std::string line;
  std::getline(text, line);
  for (const Json& event : events) {
    REQUIRE(std::getline(text, line));
    CHECK(std::stod(line) == Approx(event.at("time_s").get<double>()).epsilon(1e-12));
    CHECK(contains(line, "," + event.at("element").get<std::string>() + ",," +
                             event.at("becomes").get<std::string>() + ","));
    CHECK(line.ends_with(",rad/s"));
  }
  CHECK(events.size() == 4);
  CHECK(!std::getline(text, line));
}

TEST_CASE("A chart of a model with dry friction says what takes it") {
  const auto run = drev_command({"chart", DREV_SOURCE_DIR "/models/vehicle_clutch/vehicle_clutch.toml"});
  CHECK(run.exit_code == 2);
  CHECK(contains(run.err, "which sticks and slips"));
  CHECK(contains(run.err, "take exact propagation"));
}

TEST_CASE("A file of contact events is refused where it cannot be written") {
  const TemporaryFolder folder;
  const auto refused = [&](std::vector<std::string> words, const char* why) {
    const auto run = drev_command(std::move(words));
    CHECK(run.exit_code == 2);
    CHECK(contains(run.err, why));
  };
  refused({"run", "camshaft", "--events", "events.txt"}, "must be the name of a .csv file");
  refused({"run", "camshaft", "two_inertia", "--out", (folder / "out").string(), "--events", "e.csv"},
          "is for one run");
  const auto nowhere = drev_command({"run", "two_inertia", "--events", "/dev/full/events.csv"});
  CHECK(nowhere.exit_code != 0);
  CHECK(contains(nowhere.err, "cannot write /dev/full/events.partial.csv"));
}

// The command chart: what it measures, writes and concludes.
#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using drev::test::read_file;
using Json = nlohmann::json;

TEST_CASE("A chart that is interrupted says so, whenever that is") {
  const int after_ms = GENERATE(50, 400, 1500, 3000);
  const int signal = GENERATE(SIGINT, SIGTERM);
  const drev::test::Process process({"chart", "camshaft"});
  std::this_thread::sleep_for(std::chrono::milliseconds(after_ms));
  process.send(signal);
  const auto run = process.wait();
  CAPTURE(after_ms, signal, run.err);
  CHECK(
      (run.exit_code == 130 || (run.exit_code == -1 && after_ms == 50)));  // before it listens: by the signal
  if (run.exit_code == 130) CHECK(contains(run.err, "drev: interrupted"));
  CHECK(run.out.empty());
}

TEST_CASE("A chart: reference checked, errors fall with the step, files written") {
  const drev::test::TemporaryFolder folder;
  const auto run =
      drev_command({"chart", "two_mass_backlash", "--set", "duration_s=0.5", "--limit", "0.1", "--methods",
                    "exact", "average_acceleration", "--json", "--out", (folder / "out").string()});
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const Json json = Json::parse(run.out);
  CHECK(contains(json.at("reference").get<std::string>(), "exact"));
  CHECK(contains(json.at("check").get<std::string>(), "dormand_prince"));
  const double agreement = json.at("agreement").get<double>();
  CHECK(agreement < 1e-6);
  CHECK(json.at("unit") == "m");
  REQUIRE(json.at("curves").size() == 2);
  // Second order: in the force's ramp nothing but smooth motion and two contacts.
  const Json& points = json["curves"][1].at("points");
  REQUIRE(points.size() > 4);
  const double coarse = points[0].at("error").get<double>(), fine = points[3].at("error").get<double>();
  CHECK(coarse / fine > 30.0);
  CHECK(coarse / fine < 130.0);
  for (const Json& p : points)
    CHECK(p.at("trusted").get<bool>() == (p.at("error").get<double>() >= agreement));
  CHECK(json.at("cheapest").size() == 3);

  std::istringstream csv(read_file(folder / "out/chart.csv"));
  std::string line;
  std::size_t rows = 0;
  while (std::getline(csv, line)) ++rows;
  CHECK(rows == 1 + json["curves"][0].at("points").size() + points.size());
  for (const char* name : {"out/error_over_time.svg", "out/error_over_work.svg"}) {
    const std::string svg = read_file(folder / name);
    CHECK(svg.starts_with("<svg"));
    CHECK(contains(svg, "average_acceleration"));
    CHECK(contains(svg, "step of 1 ms"));
  }
}

TEST_CASE("A chart as text says which method to use") {
  const auto run = drev_command({"chart", "two_inertia", "--set", "duration_s=0.02", "--limit", "0.005"});
  INFO(run.err);
  CHECK(run.exit_code == 0);
  for (const char* part :
       {"Which method should I use? From 0 to ", "for 0.01", "error at 1 ms", "Reference", "agrees"})
    CHECK(contains(run.out, part));
}

TEST_CASE("A chart of a model at rest has no errors to draw") {
  const auto run = drev_command({"chart", "two_mass_backlash", "--set", "force_N=0", "--limit", "0.01"});
  CHECK(run.exit_code == 1);
  CHECK(contains(run.err, "nothing moves"));
}

// The command chart: what it measures, writes and concludes.
#include <algorithm>
#include <chrono>
#include <cmath>
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

TEST_CASE("A chart advises for the span that it measured, the whole run where the limit allows", "[once]") {
  const auto chart = [](const char* duration, bool json) {
    std::vector<std::string> words{"chart",   "two_inertia", "--set",     duration,
                                   "--limit", "0.05",        "--methods", "exact"};
    if (json) words.emplace_back("--json");
    return drev_command(words).out;
  };
  const Json whole = Json::parse(chart("duration_s=0.1", true));
  CHECK(whole.at("t_end_s").get<double>() == Approx(0.1).epsilon(0.02));
  CHECK(contains(chart("duration_s=0.1", false), "Which method should I use? From 0 to 0.1 s:"));
  // 15,500 periods of 155 Hz are more than 25 ms of processor time.
  const Json part = Json::parse(chart("duration_s=100", true));
  CHECK(part.at("t_end_s").get<double>() < 50.0);
  CHECK(contains(part.at("horizon"), "longer runs pass half of the --limit, 0.05 s; the whole 100 s take"));
  // The cheapest that keeps the accuracy is among the points measured.
  for (const Json& advice : part.at("cheapest")) {
    if (advice.at("processor_time_s").is_null()) continue;
    double least = HUGE_VAL;
    for (const Json& p : part.at("curves")[0].at("points"))
      if (!p.at("error").is_null() && p.at("error") <= advice.at("accuracy"))
        least = std::min(least, p.at("processor_time_s").get<double>());
    CHECK(advice.at("processor_time_s").get<double>() >= least);
  }
}

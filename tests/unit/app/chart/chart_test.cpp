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

TEST_CASE("A chart advises for the model's whole run, of which it measured a part, and says so") {
  const auto words = [](const char* duration) {
    return std::vector<std::string>{"chart", "two_inertia", "--set", duration, "--limit",
                                    "0.02",  "--methods",   "exact", "sdirk4", "--json"};
  };
  // 20 periods of 155 Hz are 0.13 s.
  const Json part = Json::parse(drev_command(words("duration_s=0.1")).out);
  const Json whole = Json::parse(drev_command(words("duration_s=13")).out);
  CHECK(part.at("advice_for_s") == part.at("t_end_s"));
  CHECK(whole.at("advice_for_s") == 13.0);
  const double factor = 13.0 / whole.at("t_end_s").get<double>();
  CHECK(factor > 90.0);
  CHECK(factor < 110.0);
  // Of the points that keep a hundredth of the accuracy, the cheapest, a hundred times as long.
  for (const Json& advice : whole.at("cheapest")) {
    double least = HUGE_VAL;
    for (const Json& curve : whole.at("curves")) {
      double of_curve = HUGE_VAL;
      for (const Json& p : curve.at("points")) {
        if (p.at("error").is_null()) continue;
        const double accuracy = advice.at("accuracy").get<double>() / factor;
        if (p.at("error").get<double>() > accuracy)
          of_curve = HUGE_VAL;  // it is to keep it at all finer points, too
        else
          of_curve = std::min(of_curve, factor * p.at("processor_time_s").get<double>());
      }
      least = std::min(least, of_curve);
    }
    INFO(advice);
    if (advice.at("processor_time_s").is_null())
      CHECK((least == HUGE_VAL ||
             whole.at("agreement").get<double>() * factor > advice.at("accuracy").get<double>()));
    else
      CHECK(advice.at("processor_time_s").get<double>() == Approx(least));
  }
  auto text = words("duration_s=13");
  text.pop_back();
  const std::string out = drev_command(text).out;
  CHECK(contains(out, "Which method should I use? From 0 to 13 s, "));
  CHECK(contains(out, "times what was measured: times and errors"));
}

// What a program that holds drev's commands has of its own: the text of a model, where what is printed goes, when
// to stop, and how far a computation is (app/cli/print.hpp, app/base/interrupt.hpp, app/base/progress.hpp).
#include <drev/core/error.hpp>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/base/interrupt.hpp"
#include "app/base/progress.hpp"
#include "app/cli/model_option.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/modes_request.hpp"
#include "app/commands/run_request.hpp"
#include "app/report/run_files.hpp"
#include "tests/catch.hpp"

using namespace drev;
using namespace drev::app;

namespace {

CommandLine line_of(const char* command, const std::string& text) {
  CommandLine line{.model = "hosted", .text = text};
  for (const CommandEntry& entry : commands())
    if (entry.name == std::string(command)) line.command = &entry;
  line.json = true;
  return line;
}

const std::string kDisc =
    "format = 1\nname = 'disc'\n[nodes]\nwall = { hold = true }\ndisc = { initial_angle_rad = 1 "
    "}\n[elements]\n"
    "J = { type = 'inertia', node = 'disc', inertia_kg_m2 = 1 }\n"
    "k = { type = 'shaft_spring', nodes = ['wall', 'disc'], stiffness_Nm_per_rad = 4 }\n"
    "[run]\nduration_s = 1\nrecord = 'disc.angle_rad'\nevery_s = 0.25\n";

}  // namespace

TEST_CASE("A model's text stands in for its file, and a thread's output for stdout") {
  const CommandLine line = line_of("modes", kDisc);
  PrintedText outer;
  {
    PrintedText printed;
    CHECK(line.command->execute(line) == 0);
    const auto object = nlohmann::json::parse(printed.text());
    CHECK(object["frequencies_Hz"][0].get<double>() == Approx(2.0 / 6.283185307179586).epsilon(1e-12));
  }
  CHECK(outer.text().empty());
  print("x");
  CHECK(outer.text() == "x");
  CHECK(request_modes(line).model.entry->name == "disc");
  CHECK_THROWS_WITH(request_modes(line_of("modes", "format = 1\n[elements]\nJ = { type = 'inertya' }")),
                    Catch::Contains("hosted:3:") && Catch::Contains("did you mean 'inertia'"));
}

TEST_CASE("A program that keeps the history needs no file for --record and --every") {
  CommandLine line = line_of("run", kDisc);
  line.options["--record"] = {"disc.angle_rad"};
  CHECK_THROWS_AS(request_run(line), ModelError);
  line.keeps_history = true;
  const RunRequest request = request_run(line);
  CHECK(request.keeps_history);
  CHECK(request.every == 0.25);
  std::optional<Recorder> recorder;
  const RunOutcome outcome = run_and_write(request, [&](const System& system) -> std::vector<Observer*> {
    return {&recorder.emplace(system, request.record, request.every)};
  });
  CHECK(outcome.ok());
  REQUIRE(recorder->times().size() == 5);
  for (std::size_t i = 0; i < 5; ++i)
    CHECK(recorder->samples(0)[i] == Approx(std::cos(2.0 * recorder->times()[i])).margin(1e-10));
}

TEST_CASE("A thread's own question ends what it computes, and it alone") {
  int asked = 0;
  {
    const InterruptSource source([&] { return ++asked > 1; });
    CHECK_FALSE(interrupted());
    CHECK(interrupted());
    bool other = true;
    std::thread([&] { other = interrupted(); }).join();
    CHECK_FALSE(other);
    watch_signals();  // leaves signals to the program
    CommandLine line = line_of("run", kDisc);
    line.options["--duration"] = {"1e6"};
    CHECK(run_and_write(request_run(line)).status == "interrupted");
  }
  CHECK_FALSE(interrupted());
}

TEST_CASE("Progress is told to who listens") {
  std::vector<double> parts;
  const ProgressListener listener([&](double part, double left) {
    parts.push_back(part);
    CHECK(left >= 0.0);
  });
  Progress progress;
  progress.update(0.1);  // too soon to be worth a word
  std::this_thread::sleep_for(std::chrono::milliseconds(120));
  progress.update(0.5);
  progress.update(0.6);
  CHECK(parts == std::vector<double>{0.5});
}

TEST_CASE("Advice ends where a program that holds the command wants it to") {
  CommandLine line = line_of("advise", "");
  line.model = "two_mass_backlash";
  line.text.reset();
  const InterruptSource stop([] { return true; });
  CHECK_THROWS_AS(line.command->execute(line), Interruption);
}

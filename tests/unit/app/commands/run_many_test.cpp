// Several models in one run: what becomes of one leaves the others alone, results are those of single runs.
#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <thread>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using drev::test::Process;
using drev::test::read_file;
using drev::test::TemporaryFolder;
using Json = nlohmann::json;

namespace {

void wait_until(const std::function<bool()>& holds) {
  for (int i = 0; i < 3000 && !holds(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  REQUIRE(holds());
}

/// A shaft, for so long at steps of 1 us.
void write_train(const std::filesystem::path& path, const std::string& duration_s,
                 const std::string& more = "") {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path)
      << "format = 1\n[parameters]\nk_Nm_per_rad = 8500\n[nodes]\na = {}\nb = {}\n[elements]\n"
         "J_a = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 0.01 }\n"
         "J_b = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 0.03 }\n"
         "shaft = { type = \"shaft_spring\", nodes = [\"a\", \"b\"], "
         "stiffness_Nm_per_rad = \"k_Nm_per_rad\" }\n"
         "load = { type = \"applied_torque\", node = \"b\", torque_Nm = 10 }\n"
      << more << "[run]\nduration_s = " << duration_s << "\nmethod = \"average_acceleration\"\n"
      << "step_us = 1\n";
}

/// The run of this name.
Json run_of(const Json& all, const std::string& name) {
  for (const Json& run : all.at("runs"))
    if (run.at("name") == name) return run;
  FAIL("no run " << name);
  return {};
}

Json json_file(const std::filesystem::path& path) { return Json::parse(read_file(path)); }

}  // namespace

TEST_CASE("Several models: the good ones run, the others are named, results are those of single runs") {
  const TemporaryFolder folder;
  write_train(folder / "trains/good.toml", "0.01");
  write_train(folder / "trains/hard.toml", "0.02");
  write_train(folder / "trains/whole.toml", "0.01", "[elements.unknown]\ntype = \"inertai\"\n");
  std::ofstream(folder / "trains/torn.toml") << "format = 1\n[nodes\n";
  std::ofstream(folder / "trains/part.toml") << "format = 1\n[parameters]\np = 1\n";
  std::ofstream(folder / "trains/main.toml") << "format = 1\ninclude = \"part.toml\"\n"
                                             << read_file(folder / "trains/good.toml").substr(11);
  std::ofstream(folder / "trains/other.toml") << "colour = 1\n";
  std::ofstream(folder / "trains/table.csv") << "1,2\n";
  const std::string out = (folder / "results").string();
  const auto run = drev_command(
      {"run", (folder / "trains").string() + "/", "--out", out, "two_inertia", "--set", "k_Nm_per_rad=9000"});
  INFO(run.out << run.err);
  CHECK(run.exit_code == 2);
  CHECK(contains(run.out, "3 of 6 succeeded"));
  CHECK(contains(run.out, "not run: " + (folder / "trains").string() + "/other.toml"));
  CHECK(contains(run.err, "torn: bad_input: "));
  CHECK(contains(run.err, "/trains/whole.toml:13:"));
  CHECK(contains(run.err, "two_inertia: bad_input: "));  // it has no such parameter

  const Json all = json_file(folder / "results/runs.json");
  CHECK(all.at("status") == "failed");
  std::vector<std::string> names;
  for (const Json& one : all.at("runs")) names.push_back(one.at("name"));
  CHECK(names == std::vector<std::string>{"good", "hard", "main", "torn", "whole", "two_inertia"});
  CHECK(all.at("skipped").size() == 2);
  CHECK(contains(all.at("skipped")[1].at("reason"), "a part of"));
  for (const char* name : {"good", "hard", "main"}) {
    CHECK(run_of(all, name).at("status") == "success");
    const std::string alone = (folder / (std::string("alone_") + name)).string();
    drev_command({"run", (folder / "trains").string() + "/" + name + ".toml", "--out", alone, "--set",
                  "k_Nm_per_rad=9000"});
    CHECK(read_file(alone + "/history.csv") == read_file(out + "/" + name + "/history.csv"));
    CHECK(json_file(alone + "/summary.json").at("results") == run_of(all, name).at("summary").at("results"));
  }
  CHECK(run_of(all, "torn").at("summary").is_null());
  CHECK_FALSE(std::filesystem::exists(out + "/torn"));
  CHECK_FALSE(std::filesystem::exists(out + "/runs.partial.json"));

  const auto good = drev_command(
      {"run", "two_inertia", (folder / "trains/good.toml").string(), "--out", out, "--json", "--jobs", "1"});
  CHECK(good.exit_code == 0);
  CHECK(good.err.empty());
  CHECK(Json::parse(good.out) == json_file(folder / "results/runs.json"));
}

TEST_CASE("Exit codes of several models: what the failed ones share, or 1") {
  const TemporaryFolder folder;
  write_train(folder / "a.toml", "0.01");
  std::ofstream(folder / "torn.toml") << "format = 1\n[nodes\n";
  const std::string out = (folder / "r").string();
  // The folder of a cannot be made: there is a file.
  std::filesystem::create_directory(folder / "r");
  std::ofstream(folder / "r/a") << "x";
  const std::string a = (folder / "a.toml").string(), torn = (folder / "torn.toml").string();
  const auto disk = drev_command({"run", a, "two_inertia", "--out", out, "--quiet"});
  CHECK(disk.exit_code == 3);
  CHECK(disk.out.empty());
  CHECK(contains(disk.err, "a: output_error: cannot write"));
  CHECK(drev_command({"run", a, torn, "two_inertia", "--out", out}).exit_code == 1);
  CHECK(json_file(folder / "r/two_inertia/summary.json").at("status") == "success");
}

TEST_CASE("Several models: faults of the command line start nothing") {
  const TemporaryFolder folder;
  write_train(folder / "a.toml", "0.01");
  write_train(folder / "b/a.toml", "0.01");
  std::filesystem::create_directory(folder / "empty");
  const std::string out = (folder / "r").string();
  const std::string a = (folder / "a.toml").string(), b = (folder / "b").string();
  const auto refused = drev_command(
      {"run", a, b, (folder / "empty").string(), "--out", out, "--jobs", "0", "--report", "x.html", "--stp"});
  INFO(refused.err);
  CHECK(refused.exit_code == 2);
  CHECK(contains(refused.err, "5 faults"));
  for (const char* part : {"b/a.toml, has the name of", "both results would be in DIR/a", "--jobs = 0",
                           "directory without a model file", "--report = x.html, is for one run", "--stp"})
    CHECK(contains(refused.err, part));
  CHECK_FALSE(std::filesystem::exists(out));
}

TEST_CASE("A run that is killed does not stop the others") {
  const TemporaryFolder folder;
  write_train(folder / "long.toml", "10000");
  for (const char* name : {"a", "b", "c"}) write_train(folder / (std::string(name) + ".toml"), "0.01");
  const auto path = [&](const char* name) { return (folder / name).string(); };
  const Process process({"run", path("long.toml"), path("a.toml"), path("b.toml"), path("c.toml"), "--out",
                         path("r"), "--json", "--jobs", "2"});
  // The others, one after the other, beside the long one.
  wait_until([&] { return std::filesystem::exists(folder / "r/c/summary.json"); });
  const Json partial = json_file(folder / "r/long/summary.partial.json");
  CHECK(partial.at("status") == "running");
  ::kill(partial.at("process"), SIGKILL);
  const auto run = process.wait();
  CHECK(run.exit_code == 1);
  const Json all = Json::parse(run.out);
  CHECK(run_of(all, "long").at("status") == "killed");
  CHECK(run_of(all, "long").at("exit_code").is_null());
  for (const char* name : {"a", "b", "c"}) CHECK(run_of(all, name).at("status") == "success");
  CHECK(contains(run.err, "long: killed: "));
}

TEST_CASE(
    "Several models interrupted: those that run leave parts, the others are said not to have "
    "begun") {
  const int signal = GENERATE(SIGINT, SIGTERM, SIGKILL);
  const TemporaryFolder folder;
  for (const char* name : {"a", "b", "c"}) write_train(folder / (std::string(name) + ".toml"), "10000");
  const auto path = [&](const char* name) { return (folder / name).string(); };
  const Process process(
      {"run", path("a.toml"), path("b.toml"), path("c.toml"), "--out", path("r"), "--jobs", "2"});
  const auto begun = [&](const char* name) {
    std::error_code missing;
    return std::filesystem::file_size(folder / "r" / name / "history.partial.csv", missing) > 0 && !missing;
  };
  wait_until([&] { return begun("a") && begun("b"); });
  process.send(signal);
  const auto run = process.wait();
  const auto status = [&](const char* name) {
    return json_file(folder / "r" / name / "summary.partial.json").at("status");
  };
  // With SIGKILL the runs end when the system tells them.
  wait_until([&] { return status("a") == "interrupted" && status("b") == "interrupted"; });
  CHECK_FALSE(std::filesystem::exists(folder / "r/c"));
  CHECK_FALSE(std::filesystem::exists(folder / "r/runs.json"));
  const Json all = json_file(folder / "r/runs.partial.json");
  CHECK(run_of(all, "c").at("status") == "not_started");
  if (signal == SIGKILL) {
    CHECK(all.at("status") == "running");
    return;
  }
  CHECK(run.exit_code == 130);
  CHECK(all.at("status") == "interrupted");
  CHECK(run_of(all, "a").at("summary").at("status") == "interrupted");
  CHECK(contains(run.out, "not_started"));
  CHECK(contains(run.out, "0 of 3 succeeded"));
}

TEST_CASE("Parameters varied: every combination, with one table of figures", "[once]") {
  const TemporaryFolder folder;
  const std::string out = (folder / "r").string();
  const auto run =
      drev_command({"run", "two_inertia", "--vary", "inertia_1_kg_m2=0.01:0.01:0.03", "--vary",
                    "stiffness_Nm_per_rad=8000,9000.5", "--set", "duration_s=0.05", "--out", out});
  INFO(run.out << run.err);
  CHECK(run.exit_code == 0);
  CHECK(contains(run.out, "6 of 6 succeeded"));
  const Json all = json_file(folder / "r/runs.json");
  REQUIRE(all.at("runs").size() == 6);
  std::vector<std::string> rows;
  std::istringstream csv(read_file(folder / "r/runs.csv"));
  for (std::string row; std::getline(csv, row);) rows.push_back(row);
  REQUIRE(rows.size() == 7);
  CHECK(rows[0].starts_with("name,status,inertia_1_kg_m2,stiffness_Nm_per_rad,deflection_deg,"));
  for (std::size_t i = 0; i < 6; ++i) {
    const Json& one = all.at("runs")[i];
    const std::string inertia = std::vector<std::string>{"0.01", "0.02", "0.03"}[i / 2];
    const std::string stiffness = i % 2 == 0 ? "8000" : "9000.5";
    const std::string name = "inertia_1_kg_m2=" + inertia + ",stiffness_Nm_per_rad=" + stiffness;
    CHECK(one.at("name") == name);
    const Json& parameters = one.at("summary").at("parameters");
    CHECK(parameters.at("inertia_1_kg_m2") == std::stod(inertia));
    CHECK(parameters.at("stiffness_Nm_per_rad") == std::stod(stiffness));
    CHECK(parameters.at("duration_s") == 0.05);
    CHECK(one.at("varied").at("inertia_1_kg_m2") == std::stod(inertia));
    CHECK(rows[i + 1].starts_with('"' + name + "\",success," + inertia + "," + stiffness + ","));
    const Json alone = Json::parse(
        drev_command({"run", "two_inertia", "--json", "--out", (folder / "alone").string(), "--set",
                      "duration_s=0.05", "inertia_1_kg_m2=" + inertia, "stiffness_Nm_per_rad=" + stiffness})
            .out);
    CHECK(alone.at("results") == one.at("summary").at("results"));
    CHECK(contains(rows[i + 1], "," + alone.at("results").at("max_torque_Nm").dump() + ","));
  }
  CHECK(std::filesystem::exists(folder / "r/inertia_1_kg_m2=0.03,stiffness_Nm_per_rad=9000.5/history.csv"));
}

TEST_CASE("Names of runs: in quotes where CSV needs it, refused where no folder can have them") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "trains");
  write_train(folder / "trains/a \"1\", new.toml", "0.01");
  write_train(folder / "trains/b.toml", "0.01");
  const std::string trains = (folder / "trains").string(), out = (folder / "r").string();
  REQUIRE(drev_command({"run", trains, "--out", out}).exit_code == 0);
  CHECK(contains(read_file(out + "/runs.csv"), "\n\"a \"\"1\"\", new\",success,"));

  // Files that include each other are no parts: each says what is wrong.
  std::ofstream(folder / "trains/x.toml") << "format = 1\ninclude = \"y.toml\"\n";
  std::ofstream(folder / "trains/y.toml") << "format = 1\ninclude = \"x.toml\"\n";
  const auto run = drev_command({"run", trains, "--out", out});
  CHECK(run.exit_code == 2);
  CHECK(contains(run.err, "x: bad_input: "));
  CHECK(contains(run.out, "2 of 4 succeeded"));

  for (const char* name : {"...toml", "runs.csv.toml"}) {
    write_train(folder / name, "0.01");
    const auto refused = drev_command({"run", (folder / name).string(), "two_inertia", "--out", out});
    CHECK(refused.exit_code == 2);
    CHECK(contains(refused.err, "which no folder of results can have"));
  }
}

TEST_CASE("The duration that is stated is the one that was run, and cannot be varied beside --duration") {
  const TemporaryFolder folder;
  const auto run = drev_command({"run", "two_inertia", "--duration", "0.05", "--json"});
  const Json result = Json::parse(run.out);
  CHECK(result.at("parameters").at("duration_s") == 0.05);
  CHECK(result.at("t_end_s") == 0.05);
  const std::string text = drev_command({"run", "two_inertia", "--duration", "0.05"}).out;
  CHECK(contains(std::regex_replace(text, std::regex("\\s+"), " "), "duration_s 0.05"));
  const auto set =
      drev_command({"run", "two_inertia", "--set", "duration_s=0.2", "--duration", "0.05", "--json"});
  CHECK(Json::parse(set.out).at("parameters").at("duration_s") == 0.05);
  CHECK(contains(drev_command({"run", "two_inertia", "--duration", "1e-10"}).err,
                 "--duration = 1e-10 s, must be"));

  // A parameter of another name may be the duration, too.
  write_train(folder / "a.toml", "\"length_s\"");
  const std::string of_train = read_file(folder / "a.toml"), head = "[parameters]\n";
  std::ofstream(folder / "a.toml") << std::string(of_train).insert(of_train.find(head) + head.size(),
                                                                   "length_s = 0.01\n");
  const std::string out = (folder / "r").string(), file = (folder / "a.toml").string();
  const std::vector<std::vector<std::string>> varied{{"two_inertia", "--vary", "duration_s=0.1,0.2"},
                                                     {"two_inertia", "--vary", "duration_s=0.5"},
                                                     {file, "--vary", "length_s=0.01,0.02"}};
  for (const std::vector<std::string>& model : varied)
    for (const bool table : {false, true}) {
      std::vector<std::string> words{"run"};
      words.insert(words.end(), model.begin(), model.end());
      words.insert(words.end(), {"--duration", "0.3", "--step", "1e-4", "--out", out});
      if (table) words.push_back("--table");
      const auto refused = drev_command(words);
      INFO(refused.err);
      CHECK(refused.exit_code == 2);
      CHECK(contains(refused.err,
                     "is the duration of the runs, which --duration gives to all: give one of them"));
      CHECK_FALSE(std::filesystem::exists(out));
    }
}

TEST_CASE("A directory that does not exist has its name among the results") {
  const TemporaryFolder folder;
  const std::string out = (folder / "r").string();
  const auto run = drev_command({"run", (folder / "trains/").string(), "two_inertia", "--out", out});
  CHECK(contains(run.err, "trains: bad_input: "));
  CHECK(run_of(json_file(folder / "r/runs.json"), "trains").at("status") == "bad_input");
  CHECK(contains(read_file(out + "/runs.csv"), "\ntrains,bad_input,"));
}

TEST_CASE("Table of several runs that cannot be written: what became of them is told all the same") {
  const TemporaryFolder folder;
  const std::string out = (folder / "r").string();
  std::filesystem::create_directories(folder / "r/runs.csv/x");
  const auto run = drev_command({"run", "two_inertia", "--vary", "duration_s=0.01,0.02", "--out", out});
  CHECK(run.exit_code == 3);
  CHECK(contains(run.out, "2 of 2 succeeded"));
  CHECK(contains(run.err, "runs.csv"));
}

TEST_CASE("Values of --vary may mix lists and ranges") {
  const TemporaryFolder folder;
  const std::string out = (folder / "r").string();
  const auto run =
      drev_command({"run", "two_inertia", "--vary", "duration_s=0.01,0.02:0.01:0.04,0.1", "--out", out});
  CHECK(run.exit_code == 0);
  for (const char* value : {"0.01", "0.02", "0.03", "0.04", "0.1"})
    CHECK(std::filesystem::exists(folder / (std::string("r/duration_s=") + value + "/summary.json")));
}

TEST_CASE("What is wrong with --vary is said once, before anything is run") {
  const TemporaryFolder folder;
  const std::string out = (folder / "r").string();
  const std::vector<std::pair<std::vector<std::string>, std::string>> faults{
      {{"two_inertia", "--vary", "stiffnes_Nm_per_rad=1,2"}, "did you mean 'stiffness_Nm_per_rad'?"},
      {{"two_inertia", "--vary", "duration_s"}, "must be NAME=A,B,C, NAME=FIRST:STEP:LAST, or both mixed"},
      {{"two_inertia", "--vary", "duration_s=1,,2"},
       "must be NAME=A,B,C, NAME=FIRST:STEP:LAST, or both mixed"},
      {{"two_inertia", "--vary", "duration_s=1:2"},
       "must be NAME=A,B,C, NAME=FIRST:STEP:LAST, or both mixed"},
      {{"two_inertia", "--vary", "duration_s=1:0:2"}, "does not lead from FIRST to LAST"},
      {{"two_inertia", "--vary", "duration_s=1:-1:2"}, "does not lead from FIRST to LAST"},
      {{"two_inertia", "--vary", "duration_s=1:1e-9:2"}, "more values than 10000"},
      {{"two_inertia", "--vary", "duration_s=1,1"}, "has 1 twice"},
      {{"two_inertia", "--vary", "duration_s=1000000:1e-7:1000000.000001"}, "STEP too small for 12 digits"},
      {{"two_inertia", "--set", "duration_s=1", "--vary", "duration_s=2"}, "is set by --set already"},
      {{"two_inertia", "--vary", "duration_s=1", "--vary", "duration_s=2"}, "duration_s is varied already"},
      {{"--vary", "duration_s=1,2"}, "MODEL"}};
  for (const auto& [words, said] : faults) {
    std::vector<std::string> line{"run", "--out", out};
    line.insert(line.end(), words.begin(), words.end());
    const auto run = drev_command(line);
    INFO(run.err);
    CHECK(run.exit_code == 2);
    CHECK(contains(run.err, said));
  }
  CHECK_FALSE(std::filesystem::exists(out));
}

// A table of many variants: figures of single runs, the same bytes on however many threads and ranks and after however many
// kills, and nothing lost that counts as done.
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "app/variants/variant_store.hpp"
#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::app::VariantStore;
using drev::test::contains;
using drev::test::drev_command;
using drev::test::Process;
using drev::test::read_file;
using drev::test::TemporaryFolder;
using Json = nlohmann::json;

namespace {

using Words = std::vector<std::string>;

/// Backlashes and speeds of the gear drive in lockstep.
Words study(const std::string& out, const std::string& backlash, const Words& more = {}) {
  Words words{"run",        "gear_drive",
              "--vary",     "backlash_mm=" + backlash,
              "--vary",     "engine_rpm=700,750,755.5",
              "--step",     "2e-5",
              "--duration", "0.02",
              "--table",    "--out",
              out};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::string table_in(const std::filesystem::path& folder) { return read_file(folder / "variants.h5"); }

std::filesystem::path mpi_library() {
  return std::filesystem::path(DREV_EXECUTABLE).parent_path() / "../lib/drev-mpi/drev_mpi.so";
}

bool without_mpi() {
  return !std::filesystem::exists(mpi_library()) || std::system("command -v mpirun >/dev/null 2>&1") != 0;
}

/// mpirun with so many ranks; `before`: shell commands of each rank. Returns the exit code.
int mpirun(int ranks, const Words& words, const std::filesystem::path& said, const std::string& before = "") {
  std::string command = "mpirun --allow-run-as-root --oversubscribe -n " + std::to_string(ranks) +
                        " sh -c '" + before + " exec " DREV_EXECUTABLE;
  for (const std::string& word : words) command += " " + word;
  command += "' >" + said.string() + " 2>&1 </dev/null";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

TEST_CASE("A table's figures are those of single runs of its variants") {
  const TemporaryFolder folder;
  const std::string method = GENERATE("exact", "average_acceleration");
  Words words{"run",        "gear_drive", "--vary",  "backlash_mm=0:0.1:0.4",
              "--duration", "0.05",       "--table", "--json",
              "--method",   method,       "--out",   (folder / "r").string()};
  if (method != "exact") words.insert(words.end(), {"--step", "1e-5"});
  const auto run = drev_command(words);
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const Json summary = Json::parse(run.out);
  CHECK(summary == Json::parse(read_file(folder / "r/variants.json")));
  CHECK(summary.at("statuses").at("success") == 5);
  CHECK(summary.at("lockstep") == (method != "exact"));
  CHECK_FALSE(std::filesystem::exists(VariantStore::path_in((folder / "r").string())));
  int compared = 0;
  for (const Json& figure : summary.at("figures")) {
    const std::string name = figure.at("name");
    if (name == "energy_error") continue;
    for (const char* end : {"min", "max"}) {
      Words single{
          "run",  "gear_drive", "--duration",
          "0.05", "--json",     "--method",
          method, "--set",      "backlash_mm=" + figure.at(end).at("varied").at("backlash_mm").dump()};
      if (method != "exact") single.insert(single.end(), {"--step", "1e-5"});
      const Json result = Json::parse(drev_command(single).out).at("results");
      // Single runs with steps look for peaks inside them.
      CHECK(result.at(name).get<double>() ==
            Approx(figure.at(end).at("value").get<double>()).epsilon(method == "exact" ? 1e-9 : 2e-3));
      ++compared;
    }
  }
  CHECK(compared >= 10);
}

TEST_CASE("Quantiles of few variants are exact") {
  const TemporaryFolder folder;
  const auto run =
      drev_command({"run", "gear_drive", "--vary", "torque_mean_Nm=-4000,-8000", "--duration", "0.02",
                    "--step", "1e-5", "--table", "--json", "--out", (folder / "r").string()});
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const Json table = Json::parse(run.out);
  int differ = 0;
  for (const Json& figure : table.at("figures")) {
    const double low = figure.at("min").at("value"), high = figure.at("max").at("value");
    for (const Json& quantile : figure.at("quantiles")) {
      const double part = quantile.at("part");
      const double value = part < 0.25 ? low : part > 0.75 ? high : 0.5 * (low + high);
      CHECK(quantile.at("value").get<double>() == Approx(value).epsilon(1e-14));
    }
    differ += low < high;
  }
  CHECK(differ >= 3);
}

TEST_CASE("A table is the same on any number of threads, and one that is complete is not computed again") {
  const TemporaryFolder folder;
  const auto one = drev_command(study((folder / "one").string(), "0:0.05:0.4", {"--jobs", "1"}));
  INFO(one.out << one.err);
  REQUIRE(one.exit_code == 0);
  CHECK(contains(one.out, "27 of gear_drive: 27 success"));
  REQUIRE(drev_command(study((folder / "two").string(), "0:0.05:0.4", {"--jobs", "3"})).exit_code == 0);
  CHECK(table_in(folder / "one") == table_in(folder / "two"));
  CHECK(read_file(folder / "one/variants.json") == read_file(folder / "two/variants.json"));
  const auto again = drev_command(study((folder / "one").string(), "0:0.05:0.4", {"--resume"}));
  CHECK(again.exit_code == 0);
  CHECK(contains(again.out, "complete already"));
  const std::string before = table_in(folder / "one");
  const auto other = drev_command(study((folder / "one").string(), "0:0.05:0.3", {"--resume"}));
  CHECK(other.exit_code == 2);
  CHECK(contains(other.err, "cannot go on with another study"));
  CHECK(table_in(folder / "one") == before);
}

TEST_CASE(
    "Variants that fail keep their place, their status and a reason, other topologies run by themselves") {
  const TemporaryFolder folder;
  const auto run =
      drev_command({"run", "camshaft", "--vary", "cylinders=6,8,9,11,7", "--set", "drive=held", "--step",
                    "1e-4", "--duration", "0.01", "--table", "--json", "--out", (folder / "r").string()});
  INFO(run.err);
  CHECK(run.exit_code == 2);
  const Json summary = Json::parse(run.out);
  CHECK(summary.at("statuses").at("success") == 4);
  CHECK(summary.at("statuses").at("bad_input") == 1);
  REQUIRE(summary.at("failures").size() == 1);
  CHECK(summary.at("failures")[0].at("variant") == 3);
  CHECK(contains(summary.at("failures")[0].at("reason"), "cylinders = 11"));
  const auto again =
      drev_command({"run", "camshaft", "--vary", "cylinders=6,8,9,11,7", "--set", "drive=held", "--step",
                    "1e-4", "--duration", "0.01", "--resume", "--out", (folder / "r").string()});
  CHECK(again.exit_code == 2);  // as at first
  CHECK(contains(again.out, "complete already"));
}

TEST_CASE("Each variant that failed has its own status and reason") {
  const TemporaryFolder folder;
  const Words words{"run",
                    "gear_drive",
                    "--vary",
                    "backlash_mm=0.1,0.12,0.14,20,0.2,11",
                    "--step",
                    "1e-4",
                    "--duration",
                    "0.1",
                    "--table",
                    "--out",
                    (folder / "r").string()};
  const auto run = drev_command(words);
  INFO(run.out << run.err);
  CHECK(run.exit_code == 1);
  const Json failures = Json::parse(read_file(folder / "r/variants.json")).at("failures");
  REQUIRE(failures.size() >= 3);
  const std::vector<std::string> backlashes{"0.1", "0.12", "0.14", "20", "0.2", "11"};
  std::vector<int> bad;
  for (const Json& failure : failures) {
    const int number = failure.at("variant");
    const std::string status = failure.at("status"), reason = failure.at("reason");
    const std::string backlash = backlashes[static_cast<std::size_t>(number)];
    if (status == "bad_input") bad.push_back(number);
    CHECK(contains(reason, status == "bad_input" ? "backlash_mm = " + backlash + " mm" : "energy balance"));
    CHECK(contains(run.out, "variant " + std::to_string(number) + " (backlash_mm=" + backlash +
                                "): " + status + ": " + reason.substr(0, 20)));
  }
  CHECK(bad == std::vector<int>{3, 5});
  CHECK(failures[0].at("variant") == 0);
  CHECK(failures[0].at("status") == "energy_error");
}

TEST_CASE("A quiet table says on standard error which variants failed, also when it is complete already") {
  const TemporaryFolder folder;
  Words words = study((folder / "r").string(), "0.1,20", {"--quiet"});
  const auto run = drev_command(words);
  CHECK(run.exit_code == 2);
  CHECK(run.out.empty());
  CHECK(contains(run.err, "variant 3 (backlash_mm=20, engine_rpm=700): bad_input: gear_drive/settings"));
  words.emplace_back("--resume");
  const auto again = drev_command(words);
  CHECK(again.exit_code == 2);
  CHECK(contains(again.err, "not all of its variants succeeded"));
}

TEST_CASE("A variant has the warnings that a run of its own would have") {
  // A disc rattles in a gap of 20 mrad without ever repeating.
  const TemporaryFolder folder;
  const std::string model = (folder / "m.toml").string(), out = (folder / "r").string();
  std::ofstream(model)
      << "format = 1\n[parameters]\ngap_rad = { default = 0.02, min = 0, max = 1, meaning = \"gap\" }\n"
         "[nodes]\nmotor = { constant_speed_rad_per_s = 100 }\ndisc = {}\n[elements]\n"
         "J = { type = \"inertia\", node = \"disc\", inertia_kg_m2 = 2 }\n"
         "teeth = { type = \"dead_band_coupling\", nodes = [\"motor\", \"disc\"], stiffness_Nm_per_rad = "
         "2e5, "
         "gap_rad = \"gap_rad\", damping_Nms_per_rad = 20 }\n"
         "load = { type = \"engine_order_torque\", node = \"disc\", mean_Nm = 20, twist_feedback = false, "
         "harmonics = { order = [1], amplitude_Nm = [500] } }\n[run]\nduration_s = 0.1\n";
  const auto run = drev_command({"run", model, "--start", "periodic", "--vary", "gap_rad=0,0.02", "--table",
                                 "--out", out, "--report", (folder / "r.html").string()});
  INFO(run.out << run.err);
  CHECK(run.exit_code == 0);
  const Json summary = Json::parse(read_file(folder / "r/variants.json"));
  CHECK(summary.at("statuses").at("success") == 2);
  REQUIRE(summary.at("warnings").size() == 1);
  CHECK(summary.at("warnings")[0].at("variant") == 1);
  CHECK(contains(summary.at("warnings")[0].at("warning"), "does not start in a periodic steady state"));
  CHECK(contains(run.out, "variant 1 (gap_rad=0.02): warning: the run does not start"));
  CHECK(contains(read_file(folder / "r.html"), "does not start in a periodic steady state"));
}

TEST_CASE("A bad first variant has its place and status among the results, as a later one has") {
  const TemporaryFolder folder;
  const std::string out = (folder / "r").string();
  const auto run = [&](const Words& more) {
    std::filesystem::remove_all(out);
    Words words{"run", "gear_drive", "--step", "2e-5", "--duration", "0.01", "--json", "--out", out};
    words.insert(words.end(), more.begin(), more.end());
    return drev_command(words);
  };
  const auto table = run({"--table", "--vary", "backlash_mm=20,0.1"});
  INFO(table.err);
  CHECK(table.exit_code == 2);
  REQUIRE(std::filesystem::exists(folder / "r/variants.h5"));
  const Json summary = Json::parse(table.out);
  CHECK(summary.at("statuses").at("success") == 1);
  REQUIRE(summary.at("failures").size() == 1);
  CHECK(summary.at("failures")[0].at("variant") == 0);
  CHECK(summary.at("failures")[0].at("status") == "bad_input");
  // Normally distributed: some are below 0.
  const auto sample = run({"--vary", "backlash_mm=normal(0.15,0.2)", "--sample", "lhs:10"});
  const Json sampled = Json::parse(sample.out);
  CHECK(sampled.at("statuses").at("bad_input").get<int>() > 0);
  CHECK(sampled.at("statuses").at("success").get<int>() > 0);
  const auto many = run({"--vary", "backlash_mm=20,0.1"});
  CHECK(many.exit_code == 2);
  const Json runs = Json::parse(many.out).at("runs");
  CHECK(runs[0].at("status") == "bad_input");
  CHECK(runs[1].at("status") == "success");
  // Where all are bad, or the model is without them, nothing is run.
  for (const Words& bad : {Words{"--vary", "backlash_mm=20,30"},
                           Words{"--vary", "backlash_mm=20,0.1", "--set", "engine_rpm=-1"}})
    for (const bool tabled : {true, false}) {
      Words words = bad;
      if (tabled) words.push_back("--table");
      const auto refused = run(words);
      CHECK(refused.exit_code == 2);
      CHECK(contains(refused.err, "backlash_mm = 20 mm, must be 0 to 10"));
      CHECK_FALSE(std::filesystem::exists(out));
    }
}

TEST_CASE("A study's report has its figures, points of the table, and the command that gives it again") {
  const TemporaryFolder folder;
  const std::string page = (folder / "page.html").string();
  Words words{"run",        "camshaft",
              "--set",      "drive=held",
              "--vary",     "backlash_mm=uniform(0.1,0.2)",
              "--vary",     "damping=case_1,case_2",
              "--sample",   "lhs:40",
              "--step",     "1e-4",
              "--duration", "0.01",
              "--out",      (folder / "r").string(),
              "--report"};
  words.push_back(page);
  const auto run = drev_command(words);
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const std::string begin = "<script type=\"application/json\" class=\"run\">";
  const auto data_of = [&] {
    const std::string html = read_file(page);
    const std::size_t at = html.find(begin) + begin.size();
    return Json::parse(html.substr(at, html.find("</script>", at) - at));
  };
  const Json data = data_of();
  CHECK(data.at("result") == Json::parse(read_file(folder / "r/variants.json")));
  CHECK(contains(data.at("command").get<std::string>(),
                 "--vary 'backlash_mm=uniform(0.1,0.2)' --vary damping=case_1,case_2"));
  // A parameter that is varied is not set, too, which drev would refuse.
  CHECK(contains(data.at("command").get<std::string>(), "--set drive=held"));
  CHECK_FALSE(contains(data.at("command").get<std::string>(), "--set backlash_mm"));
  for (const Json& input : data.at("inputs"))
    if (input.at("name") == "backlash_mm") CHECK(input.at("value") == "uniform(0.1,0.2)");
  const Json& points = data.at("points");
  CHECK(points.at("count") == 40);
  CHECK(points.at("parameters")[1].at("names") == Json{"case_1", "case_2"});
  for (const Json& figure : data.at("result").at("figures"))
    for (const Json& column : points.at("figures"))
      if (column.at("name") == figure.at("name"))
        CHECK(column.at("values")[figure.at("max").at("variant").get<std::size_t>()] ==
              figure.at("max").at("value"));
  std::filesystem::remove(page);
  words.push_back("--resume");
  REQUIRE(drev_command(words).exit_code == 0);  // from the table that is there
  CHECK(data_of().at("points") == points);
  words.back() = "--quiet";
  words[words.size() - 2] = (folder / "page.txt").string();
  const auto wrong = drev_command(words);
  CHECK(wrong.exit_code == 2);
  CHECK(contains(wrong.err, "--report"));
}

TEST_CASE("What is wrong with a table's command line is listed at once, before anything is run") {
  const TemporaryFolder folder;
  const auto run = drev_command({"run", "gear_drive", "--table", "--accuracy", "1e-3", "--events", "x.csv",
                                 "--vary", "backlash_mm=uniform(0,1)"});
  CHECK(run.exit_code == 2);
  for (const char* part : {"--out", "--accuracy", "--events"}) CHECK(contains(run.err, part));
  CHECK(contains(drev_command({"run", "gear_drive", "--sample", "lhs:5", "--out", "r"}).err, "--vary"));
}

TEST_CASE("A study resumed with a changed model is refused by its change, and none is thrown away unasked") {
  const TemporaryFolder folder;
  const std::string model = (folder / "train.toml").string(), out = (folder / "r").string();
  const auto write = [&](const std::string& inertia) {
    std::ofstream(model) << "format = 1\n[parameters]\nk = 8500\n[nodes]\na = {}\nb = {}\n[elements]\n"
                            "J_a = { type = \"inertia\", node = \"a\", inertia_kg_m2 = "
                         << inertia
                         << " }\nJ_b = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 0.03 }\n"
                            "shaft = { type = \"shaft_spring\", nodes = [\"a\", \"b\"], "
                            "stiffness_Nm_per_rad = \"k\" }\n"
                            "load = { type = \"applied_torque\", node = \"b\", torque_Nm = 10 }\n"
                            "[run]\nduration_s = 20\nmethod = \"average_acceleration\"\nstep_us = 1\n";
  };
  write("0.01");
  const std::string plugin = (folder / "ring_damper.so").string();
  std::filesystem::copy_file(DREV_PLUGIN_FOLDER "/libring_damper.so", plugin);
  const Words words{"run", model,    "--vary", "k=8000:1:8031", "--table", "--out",
                    out,   "--jobs", "1",      "--plugin",      plugin};
  {
    const Process process(words);
    for (int i = 0; i < 3000 && !VariantStore::description_in(out); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    process.send(SIGINT);
    const auto ended = process.wait();
    CHECK(ended.exit_code == 130);
    CHECK(contains(ended.err, "--resume goes on"));
  }
  {  // As if a block had been done.
    REQUIRE(VariantStore::description_in(out));
    const std::string description = *VariantStore::description_in(out);
    const Json study = Json::parse(description);
    const std::size_t numbers = (1 + study.at("figures").size()) * study.at("block").get<std::size_t>();
    VariantStore store(out, description, {.blocks = 4, .numbers = numbers}, true);
    store.put(1, {.numbers = std::vector<double>(numbers)});
    store.sync();
  }
  const auto careless = drev_command(words);
  INFO(careless.err);
  CHECK(careless.exit_code == 2);
  CHECK(contains(careless.err, "holds 8 finished variants, of 32"));
  Words resumed = words;
  resumed.push_back("--resume");
  write("0.02");
  std::ofstream(plugin, std::ios::app) << "more";
  resumed.insert(resumed.end(), {"--duration", "10"});
  const auto changed = drev_command(resumed);
  INFO(changed.err);
  CHECK(changed.exit_code == 2);
  CHECK(contains(changed.err, "train.toml has changed (checksum "));
  CHECK(contains(changed.err, "in line 8: "));
  CHECK(contains(changed.err, "ring_damper.so has changed (checksum "));
  CHECK(contains(changed.err, "inertia_kg_m2 = 0.01"));
  CHECK(contains(changed.err, "duration_s was nothing and is 10"));
  CHECK(VariantStore::progress_in(out).first == 1);
}

namespace {

/// Kills studies at random moments, and goes on with them until they come to their end; the table of each must be that of
/// one that was left alone.
void kill_and_resume(int kills, const std::string& backlash, bool told) {
  const TemporaryFolder folder;
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  REQUIRE(drev_command(study((folder / "whole").string(), backlash, {"--jobs", "1"})).exit_code == 0);
  const double duration = std::chrono::duration<double>(Clock::now() - start).count();
  const std::string whole = table_in(folder / "whole");
  std::mt19937 random(1);
  int killed = 0, studies = 0, early = 0, late = 0, equal = 0;
  std::uint64_t kept = 0;
  while (killed < kills) {
    const std::string out = (folder / ("r" + std::to_string(studies++))).string();
    std::uint64_t before = 0;
    for (;;) {
      const Process process(study(out, backlash, {"--jobs", "2", "--resume"}));
      const double wait = std::uniform_real_distribution(0.0, 0.6 * duration)(random);
      std::this_thread::sleep_for(std::chrono::duration<double>(wait));
      if (killed < kills) process.send(SIGKILL);
      const auto ended = process.wait();
      if (ended.exit_code == 0) break;
      INFO(ended.err);
      REQUIRE(ended.exit_code == -1);
      ++killed;
      if (!VariantStore::description_in(out) && !table_in(out).empty()) {
        ++late;  // the table was written, and the store taken away
        continue;
      }
      const auto [done, all] = VariantStore::progress_in(out);
      CHECK(done >= before);  // what was done is done
      before = done;
      early += done == 0, late += all > 0 && done == all;
      kept += done;
    }
    const bool same = table_in(out) == whole;
    CHECK(same);
    equal += same;
  }
  if (told)
    std::printf(
        "%d kills over %d studies: %d before the first block was done, %d after the last one; blocks done at "
        "a kill: %.1f on average; tables equal to the uninterrupted one: %d of %d\n",
        killed, studies, early, late, static_cast<double>(kept) / killed, equal, studies);
}

}  // namespace

TEST_CASE("Killed at random moments and resumed, a study's table is that of one left alone", "[once]") {
  kill_and_resume(6, "0:0.01:0.5", false);
}

TEST_CASE("Killed 50 times", "[.][once][kill50]") { kill_and_resume(50, "0:0.002:0.6", true); }

TEST_CASE("A full disk ends a study, and a later one goes on", "[once]") {
  const TemporaryFolder folder;
  const std::string out = (folder / "r").string();
  const auto full = drev_command(study(out, "0:0.01:0.5"), {.file = 5000});
  CHECK(full.exit_code == 3);
  INFO(full.err);
  CHECK(contains(full.err, "variants.partial.store"));
  CHECK_FALSE(std::filesystem::exists(folder / "r/variants.h5"));
  // Room for the store, none for the table's file beside it.
  const auto later = drev_command(study(out, "0:0.01:0.5", {"--resume"}), {.file = 16000});
  INFO(later.err);
  CHECK(later.exit_code == 3);
  const auto last = drev_command(study(out, "0:0.01:0.5", {"--resume"}));
  CHECK(last.exit_code == 0);
  REQUIRE(drev_command(study((folder / "whole").string(), "0:0.01:0.5")).exit_code == 0);
  CHECK(table_in(out) == table_in(folder / "whole"));
}

TEST_CASE("The same table from 2 and 4 ranks of MPI, also where a rank is killed", "[once]") {
  if (without_mpi()) {
    WARN("SKIPPED: no MPI");
    return;
  }
  const TemporaryFolder folder;
  REQUIRE(drev_command(study((folder / "alone").string(), "0:0.01:0.5")).exit_code == 0);
  const std::string alone = table_in(folder / "alone");
  for (const int ranks : {2, 4}) {
    const std::string out = (folder / ("r" + std::to_string(ranks))).string();
    const int code = mpirun(ranks, study(out, "0:0.01:0.5"), folder / "said");
    INFO(read_file(folder / "said"));
    CHECK(code == 0);
    CHECK(contains(read_file(folder / "said"), "153 of gear_drive: 153 success"));
    CHECK(table_in(out) == alone);
  }
  // Rank 1 of 2 kills itself; the launcher ends the other one.
  const std::string out = (folder / "killed").string();
  const std::string kill = "[ $OMPI_COMM_WORLD_RANK = 0 ] || (sleep 0.2; kill -9 $$) &";
  const int killed = mpirun(2, study(out, "0:0.001:0.5"), folder / "said", kill);
  CHECK(killed != 0);
  CHECK_FALSE(std::filesystem::exists(folder / "killed/variants.h5"));
  CHECK(mpirun(2, study(out, "0:0.001:0.5", {"--resume"}), folder / "said") == 0);
  REQUIRE(drev_command(study((folder / "long").string(), "0:0.001:0.5")).exit_code == 0);
  CHECK(table_in(out) == table_in(folder / "long"));
  // Bad input is said once, and ends all ranks.
  const int refused = mpirun(2, study((folder / "bad").string(), "0,-1"), folder / "said");
  const std::string said = read_file(folder / "said");
  INFO(said);
  CHECK(refused != 0);
}

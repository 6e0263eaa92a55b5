// history.csv: exactly the times asked for, the library's own values, 17 digits; and what is left when
// something goes wrong.
#include <drev/models/model_case.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <chrono>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>
#include <sys/stat.h>
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

struct Table {
  std::string header;
  std::vector<std::vector<double>> rows;
  std::size_t longest = 0;  ///< significant digits of the longest number
};

std::size_t significant_digits(const std::string& text) {
  std::size_t digits = 0;
  for (const char c : text.substr(0, text.find('e')))
    if (c >= '0' && c <= '9' && (digits > 0 || c != '0')) ++digits;
  return digits;
}

Table read_table(const std::filesystem::path& path) {
  Table table;
  std::istringstream file(read_file(path));
  std::getline(file, table.header);
  for (std::string line; std::getline(file, line);) {
    std::istringstream cells(line);
    table.rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) {
      char* end = nullptr;
      table.rows.back().push_back(std::strtod(cell.c_str(), &end));
      CHECK(*end == '\0');
      table.longest = std::max(table.longest, significant_digits(cell));
    }
  }
  return table;
}

}  // namespace

TEST_CASE("history.csv has the times asked for and the library's values") {
  const TemporaryFolder folder;
  const std::vector<std::string> channels{"mass_2.velocity_m_per_s", "mass_1.position_m", "spring_1.force_N",
                                          "mass_2-mass_1.distance_m"};
  const auto run = drev_command({"run", "two_mass_backlash", "--set", "duration_s=2.5", "--step", "0.001",
                                 "--every", "0.017", "--out", (folder / "deep/result").string(), "--record",
                                 "mass_2.velocity_m_per_s,mass_1.position_m", "--record",
                                 "spring_1.force_N,mass_2-mass_1.distance_m"});
  CHECK(run.exit_code == 0);
  CHECK(contains(run.out, "every 0.017 s"));
  const Table table = read_table(folder / "deep/result/history.csv");
  CHECK(table.header ==
        "time_s,mass_2.velocity_m_per_s,mass_1.position_m,spring_1.force_N,"
        "mass_2-mass_1.distance_m");
  CHECK(table.longest == 17);

  const drev::ModelEntry& entry = drev::find_model("two_mass_backlash");
  drev::Parameters parameters(entry.name, entry.parameters);
  parameters.set("duration_s", "2.5");
  const drev::ModelCase model_case = entry.build(parameters);
  const drev::System system = model_case.model.build();
  drev::Recorder recorder(system, channels, 0.017);
  drev::run_method(system, {.step = 0.001}, {.t_end = 2.5}, {&recorder});
  REQUIRE(table.rows.size() == 148);  // 0 to 147 * 0.017 = 2.499
  REQUIRE(recorder.times().size() == table.rows.size());
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    REQUIRE(table.rows[k].size() == 1 + channels.size());
    CHECK(table.rows[k][0] == static_cast<double>(k) * 0.017);
    for (std::size_t c = 0; c < channels.size(); ++c) CHECK(table.rows[k][c + 1] == recorder.samples(c)[k]);
  }
  const Json summary = Json::parse(read_file(folder / "deep/result/summary.json"));
  CHECK(summary.at("status") == "success");
  CHECK_FALSE(std::filesystem::exists(folder / "deep/result/history.partial.csv"));
}

TEST_CASE("The default interval is a round number, and the last row is the end of the run") {
  const TemporaryFolder folder;
  const auto run =
      drev_command({"run", "two_inertia", "--set", "duration_s=0.3", "--out", (folder / "r").string()});
  CHECK(run.exit_code == 0);
  CHECK(contains(run.out, "every 0.0002 s"));
  const Table table = read_table(folder / "r/history.csv");
  REQUIRE(table.rows.size() == 1501);
  CHECK(table.rows.back()[0] == 1500 * 0.0002);
  const drev::ModelEntry& entry = drev::find_model("two_inertia");
  for (const std::string& channel : entry.build(drev::Parameters(entry.name, entry.parameters)).channels)
    CHECK(contains(table.header, "," + channel));
}

TEST_CASE("A file that cannot be written is refused before the run") {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "x";
  // A run that would take minutes: it must not start.
  const auto run = drev_command(
      {"run", "camshaft", "--set", "duration_s=10000", "--out", (folder / "file/below").string()});
  CHECK(run.exit_code == 3);
  CHECK(contains(run.err, "cannot write"));
  CHECK(run.out.empty());
  CHECK(drev_command({"run", "two_inertia", "--out", (folder / "file").string()}).exit_code == 3);
}

TEST_CASE("A full disk is an error, and the old result stays") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "r");
  std::ofstream(folder / "r/history.csv") << "old\n";
  SECTION("at the end") {
    const auto run = drev_command({"run", "two_inertia", "--out", (folder / "r").string()}, {.file = 20000});
    CHECK(run.exit_code == 3);
    CHECK(contains(run.err, "history.partial.csv: File too large"));
  }
  SECTION("on the way: the run is given up") {
    const auto run = drev_command({"run", "camshaft", "--set", "duration_s=1000", "--every", "1e-5", "--out",
                                   (folder / "r").string(), "--json"},
                                  {.file = 20000});
    CHECK(run.exit_code == 3);
    CHECK(contains(run.err, "File too large"));
    CHECK(Json::parse(run.out).at("status") == "output_error");
  }
  CHECK(read_file(folder / "r/history.csv") == "old\n");
  CHECK_FALSE(std::filesystem::exists(folder / "r/summary.json"));
}

TEST_CASE("A history.h5 that does not fit on the disk leaves the rest") {
  const TemporaryFolder folder;
  const auto run = drev_command({"run", "two_mass_backlash", "--set", "duration_s=0.1", "--every", "0.02",
                                 "--out", (folder / "r").string(), "--format", "hdf5"},
                                {.file = 20000});
  CHECK(run.exit_code == 3);
  CHECK(contains(run.err, "history.partial.h5"));
  CHECK(std::filesystem::exists(folder / "r/history.csv"));
  CHECK(std::filesystem::exists(folder / "r/summary.json"));
  CHECK_FALSE(std::filesystem::exists(folder / "r/history.h5"));
}

TEST_CASE("Channels of which HDF5 would make one path are refused before the run, by either of its files") {
  const TemporaryFolder folder;
  const std::string file = (folder / "m.toml").string(), out = (folder / "r").string();
  const auto write = [&](const std::string& name) {
    std::ofstream(file) << "format = 1\n[parameters]\nk = 1\n[nodes]\nx = {}\n'" + name +
                               "' = {}\n[elements]\nJ = { type = 'inertia', node = 'x', inertia_kg_m2 = 1 }\n"
                               "I = { type = 'inertia', node = '" +
                               name + "', inertia_kg_m2 = 1 }\nk = { type = 'shaft_spring', nodes = ['x', '" +
                               name + "'], stiffness_Nm_per_rad = 'k' }\n[run]\nduration_s = 0.1\n";
  };
  const auto refused = [&](const std::string& name, const std::vector<std::string>& more,
                           const std::string& why) {
    write(name);
    std::vector<std::string> words{"run", file, "--record", "*.angle_rad", "--out", out};
    words.insert(words.end(), more.begin(), more.end());
    const auto run = drev_command(words);
    INFO(run.err);
    CHECK(run.exit_code == 2);
    CHECK(contains(run.err, why));
    CHECK_FALSE(std::filesystem::exists(out));
  };
  const std::string one = "' are one path in HDF5, where a '/' makes groups: rename one of them";
  refused("/x", {"--format", "hdf5"}, "'x.angle_rad' and '/x.angle_rad" + one);
  refused("//x", {"--vary", "k=1,2", "--table"}, "'x.angle_rad.max' and '//x.angle_rad.max" + one);
  refused("time_s/x", {"--format", "hdf5"}, "'time_s' would be the group of 'time_s/x.angle_rad' in HDF5");
  write("u/x");
  CHECK(drev_command({"run", file, "--out", out, "--format", "hdf5"}).exit_code == 0);
}

TEST_CASE("What someone else has put in the way of a file is neither followed nor written") {
  const std::string name = GENERATE("history.partial.csv", "summary.partial.json",
                                    "summary.partial.json.next", "report.partial.html", "history.partial.h5");
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "r");
  const std::string place = (folder / ("r/" + name)).string(), target = (folder / "precious").string();
  std::string reason = "no regular file";
  SECTION("a symbolic link") {
    std::ofstream(target) << "precious\n";
    std::filesystem::create_symlink(target, place);
    reason = "symbolic link, which is not followed";
  }
  SECTION("a link to nothing") {
    std::filesystem::create_symlink(target, place);
    reason = "symbolic link, which is not followed";
  }
  SECTION("a pipe that no one reads") { REQUIRE(::mkfifo(place.c_str(), 0600) == 0); }
  const bool kept = std::filesystem::exists(target);
  const auto run = drev_command({"run", "two_mass_backlash", "--set", "duration_s=0.1", "--out",
                                 (folder / "r").string(), "--format", "hdf5"});
  CAPTURE(name, run.err);
  CHECK(run.exit_code == 3);
  CHECK(contains(run.err, name + ": it is "));
  CHECK(contains(run.err, reason));
  CHECK(std::filesystem::exists(target) == kept);
  if (kept) CHECK(read_file(target) == "precious\n");
}

TEST_CASE("A name that a spreadsheet would take for a formula is marked in history.csv") {
  const TemporaryFolder folder;
  std::ofstream(folder / "m.toml") << R"toml(format = 1
[nodes]
"=HYPERLINK(1)" = { initial_speed_rpm = 1 }
"+1" = {}
"'-2" = {}
"@x" = {}
"a=b" = {}
[elements]
J1 = { type = "inertia", node = "=HYPERLINK(1)", inertia_kg_m2 = 1 }
J2 = { type = "inertia", node = "+1", inertia_kg_m2 = 1 }
J3 = { type = "inertia", node = "'-2", inertia_kg_m2 = 1 }
J4 = { type = "inertia", node = "@x", inertia_kg_m2 = 1 }
J5 = { type = "inertia", node = "a=b", inertia_kg_m2 = 1 }
[run]
duration_s = 0.1
)toml";
  const auto run = drev_command({"run", (folder / "m.toml").string(), "--out", (folder / "r").string()});
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  CHECK(read_table(folder / "r/history.csv").header ==
        "time_s,'=HYPERLINK(1).angle_rad,'+1.angle_rad,''-2.angle_rad,'@x.angle_rad,a=b.angle_rad");
}

TEST_CASE("Standard output on a full disk is an error") {
  if (!std::filesystem::exists("/dev/full")) return;
  CHECK(Process({"list"}, "/dev/full").wait().exit_code == 3);
  CHECK(Process({"run", "two_inertia", "--json"}, "/dev/full").wait().exit_code == 3);
}

TEST_CASE("An interrupted run leaves what it had", "[once]") {
  const int signal = GENERATE(SIGINT, SIGTERM);
  const TemporaryFolder folder;
  const Process process({"run", "camshaft", "--set", "duration_s=10000", "--every", "0.0001", "--out",
                         (folder / "r").string(), "--json"});
  // The file grows as the run goes.
  const auto partial = folder / "r/history.partial.csv";
  for (int i = 0; i < 1000; ++i) {
    std::error_code missing;
    if (std::filesystem::file_size(partial, missing) > 1000 && !missing) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  process.send(signal);
  const auto run = process.wait();
  CHECK(run.exit_code == 130);
  CHECK(contains(run.err, "RUN INTERRUPTED"));
  CHECK(contains(run.err, "history.partial.csv"));
  CHECK(Json::parse(run.out).at("status") == "interrupted");
  CHECK_FALSE(std::filesystem::exists(folder / "r/history.csv"));
  const Table table = read_table(partial);
  // 1000 bytes are five rows at least.
  REQUIRE(table.rows.size() >= 5);
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    REQUIRE(table.rows[k].size() == table.rows[0].size());
    REQUIRE(table.rows[k][0] == static_cast<double>(k) * 0.0001);
  }
}

TEST_CASE("A killed run leaves a readable part that says so, beside the result before it", "[once]") {
  const TemporaryFolder folder;
  const std::string out = (folder / "r").string();
  const auto kill_one = [&](const std::string& channel) {
    const Process process({"run", "camshaft", "--set", "duration_s=10000", "--method", "exact", "--every",
                           "0.0001", "--record", channel, "--out", out});
    for (int i = 0; i < 1000; ++i) {
      std::error_code missing;
      if (std::filesystem::file_size(folder / "r/history.partial.csv", missing) > 1000 && !missing) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    process.send(SIGKILL);
    CHECK(process.wait().exit_code == -1);
  };
  const auto partial = [&] { return Json::parse(read_file(folder / "r/summary.partial.json")); };

  kill_one("end.angle_rad");
  CHECK(partial().at("status") == "running");
  CHECK(contains(partial().at("reason"), "killed"));
  CHECK(partial().at("model") == "camshaft");
  CHECK(partial().at("parameters").at("duration_s") == 10000);
  CHECK(partial().at("record") == Json::array({"end.angle_rad"}));
  CHECK_FALSE(std::filesystem::exists(folder / "r/summary.json"));
  CHECK(read_table(folder / "r/history.partial.csv").rows.size() >= 5);
  const auto refused = drev_command({"report", out, "--out", (folder / "a.html").string()});
  CHECK(refused.exit_code == 2);
  CHECK(contains(refused.err, "did not come to its end (running: " + out + "/summary.partial.json)"));

  // The next run takes the leftovers' place.
  CHECK(drev_command({"run", "two_inertia", "--out", out, "--format", "hdf5"}).exit_code == 0);
  CHECK_FALSE(std::filesystem::exists(folder / "r/summary.partial.json"));
  CHECK_FALSE(std::filesystem::exists(folder / "r/history.partial.csv"));
  const std::string before = read_file(folder / "r/summary.json");
  CHECK(Json::parse(before).at("status") == "success");

  // One more that is killed leaves that result, and is not mistaken for it.
  kill_one("fuel_1.angle_rad");
  CHECK(read_file(folder / "r/summary.json") == before);
  CHECK(partial().at("record") == Json::array({"fuel_1.angle_rad"}));
  const auto report = drev_command({"report", out, "--out", (folder / "a.html").string()});
  CHECK(report.exit_code == 0);
  CHECK(contains(report.err, "is of an older run; the last run there did not come to its end (running"));

  // A text that was being written when a process was killed is in nobody's way.
  std::ofstream(folder / "r/summary.partial.json.next") << "{";
  const auto last = drev_command({"run", "two_inertia", "--out", out});
  CHECK(last.exit_code == 0);
  CHECK(contains(last.err, "history.h5 is of an older run"));
  CHECK_FALSE(std::filesystem::exists(folder / "r/summary.partial.json.next"));
}

TEST_CASE("A disk that fills up leaves the summary that says that the run has not ended") {
  const TemporaryFolder folder;
  // A summary has more bytes than there is room for, the history few.
  const Process process({"run", "camshaft", "--set", "duration_s=10000", "--method", "exact", "--every",
                         "5000", "--record", "end.angle_rad", "--out", (folder / "r").string()},
                        "/dev/null");
  for (int i = 0; i < 500 && !std::filesystem::exists(folder / "r/summary.partial.json"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  process.limit_files(1000);
  process.send(SIGTERM);
  const auto run = process.wait();
  CAPTURE(run.err);
  CHECK(run.exit_code == 130);
  CHECK(contains(run.err, "summary.partial.json: File too large"));
  CHECK(Json::parse(read_file(folder / "r/summary.partial.json")).at("status") == "running");
}

TEST_CASE("Two runs do not write one file") {
  const TemporaryFolder folder;
  const Process first({"run", "camshaft", "--set", "duration_s=10000", "--method", "exact", "--out",
                       (folder / "r").string()});
  for (int i = 0; i < 500 && !std::filesystem::exists(folder / "r/summary.partial.json"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const auto second = drev_command({"run", "two_inertia", "--out", (folder / "r").string()});
  first.send(SIGTERM);
  CHECK(first.wait().exit_code == 130);
  CHECK(second.exit_code == 3);
  CHECK(contains(second.err, "another process, or another output of this command, is writing it"));
}

TEST_CASE("An export onto a full disk says why it failed and leaves no file", "[once]") {
  const drev::test::TemporaryFolder folder;
  for (const std::string name : {"c.toml", "c.fmu"}) {
    const auto full = drev_command(
        {"export", "two_inertia", name == "c.toml" ? "--out" : "--fmu", (folder / name).string()},
        {.file = name == "c.toml" ? 0U : 100000U});
    CHECK(full.exit_code == 3);
    if (name == "c.fmu") CHECK(contains(full.err, "File too large"));
    CHECK(std::filesystem::is_empty(folder / ""));
  }
}

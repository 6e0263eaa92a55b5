// The report's data block: what it holds is the run, no peak is lost, and what is derived (bands, spectra,
// resonances) agrees with closed forms. What the page makes of it: tests/browser.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <nlohmann/json.hpp>
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

std::vector<Json> blocks_of(const std::filesystem::path& path) {
  const std::string page = read_file(path);
  const std::string begin = R"(<script type="application/json" class="run">)";
  std::vector<Json> blocks;
  for (std::size_t at = page.find(begin); at != page.npos; at = page.find(begin, at + 1)) {
    const std::size_t from = at + begin.size();
    blocks.push_back(Json::parse(page.substr(from, page.find("</script>", from) - from)));
  }
  return blocks;
}

template <class T>
std::vector<T> decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned word = 0, bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    word = word << 6 | static_cast<unsigned>(digits.find(c)), bits += 6;
    if (bits >= 8) bits -= 8, bytes += static_cast<char>(word >> bits & 0xFFU);
  }
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

/// Columns of a history.csv.
std::vector<std::vector<double>> columns_of(const std::filesystem::path& path) {
  std::istringstream file(read_file(path));
  std::string line, cell;
  std::getline(file, line);
  const auto commas = static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
  std::vector<std::vector<double>> columns(commas + 1);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    for (auto& column : columns) {
      std::getline(cells, cell, ',');
      column.push_back(std::stod(cell));
    }
  }
  return columns;
}

Json block_of_run(std::vector<std::string> words) {
  const TemporaryFolder folder;
  words.insert(words.begin(), "run");
  words.insert(words.end(), {"--report", (folder / "r.html").string()});
  const auto run = drev_command(words);
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const std::vector<Json> blocks = blocks_of(folder / "r.html");
  REQUIRE(blocks.size() == 1);
  return blocks.front();
}

}  // namespace

TEST_CASE("Of every group of samples the report has the lowest and the highest") {
  const TemporaryFolder folder;
  const auto run = drev_command({"run", "two_mass_backlash", "--out", (folder / "r").string(), "--every",
                                 "0.0001", "--record", "mass_1.position_m,spring_2.force_N"});
  REQUIRE(run.exit_code == 0);
  CHECK(contains(run.out, "report.html"));
  const Json data = blocks_of(folder / "r/report.html").at(0);
  const Json& history = data.at("history");
  const auto columns = columns_of(folder / "r/history.csv");
  REQUIRE(columns[0].size() == 100001);
  CHECK(history.at("samples") == 100001);
  const std::size_t group = history.at("group"), groups = history.at("groups");
  CHECK(group == 4);  // 2^15 places
  CHECK(groups == (100001 + group - 1) / group);
  for (std::size_t c = 0; c < 2; ++c) {
    const Json& series = history.at("series").at(c);
    const auto low = decoded<float>(series.at("low")), high = decoded<float>(series.at("high"));
    REQUIRE(low.size() == groups);
    REQUIRE(high.size() == groups);
    for (std::size_t i = 0; i < groups; ++i) {
      const auto begin = columns[c + 1].begin() + static_cast<std::ptrdiff_t>(i * group);
      const auto end =
          columns[c + 1].begin() + static_cast<std::ptrdiff_t>(std::min((i + 1) * group, columns[0].size()));
      REQUIRE(low[i] == static_cast<float>(*std::min_element(begin, end)));
      REQUIRE(high[i] == static_cast<float>(*std::max_element(begin, end)));
    }
  }
  CHECK(data.at("result").at("results") == Json::parse(read_file(folder / "r/summary.json")).at("results"));
}

TEST_CASE("A report records by itself, and does not change the run") {
  const Json data = block_of_run({"two_mass_backlash", "--step", "0.003", "--set", "duration_s=3"});
  // Constant steps are not cut: one sample a step, more where the force kinks.
  CHECK(data.at("history").at("samples") == data.at("result").at("steps").get<long>() + 1);
  const auto plain =
      drev_command({"run", "two_mass_backlash", "--step", "0.003", "--set", "duration_s=3", "--json"});
  CHECK(Json::parse(plain.out).at("results") == data.at("result").at("results"));
  const auto times = decoded<double>(data.at("history").at("times"));
  REQUIRE(times.size() == data.at("history").at("samples"));
  CHECK(times.front() == 0.0);
  CHECK(times.back() == 3.0);
  // Its energies are those of the balance.
  const Json& series = data.at("history").at("series");
  const Json& energy = data.at("result").at("energy");
  CHECK(decoded<float>(series.at(series.size() - 2).at("low")).back() ==
        Approx(energy.at("kinetic_J").get<double>()).epsilon(1e-6));
  CHECK(decoded<float>(series.back().at("low")).back() ==
        Approx(energy.at("stored_J").get<double>()).epsilon(1e-6));
}

TEST_CASE("Contact bands add up to the time separated") {
  const Json data = block_of_run({"two_mass_backlash"});
  const Json& history = data.at("history");
  const double length = history.at("every").get<double>() * history.at("group").get<double>();
  const double end = history.at("end");
  REQUIRE(history.at("bands").size() == 2);
  for (std::size_t b = 0; b < 2; ++b) {
    const auto front = decoded<unsigned char>(history.at("bands")[b].at("front"));
    const auto back = decoded<unsigned char>(history.at("bands")[b].at("back"));
    double apart = 0.0;
    for (std::size_t i = 0; i < front.size(); ++i) {
      REQUIRE(front[i] + back[i] <= 256);
      const double begin = static_cast<double>(i) * length;
      apart += std::min(length, end - begin) * (1.0 - (front[i] + back[i]) / 255.0);
    }
    const Json& contact = data.at("result").at("results").at("contacts").at(b);
    CHECK(history.at("bands")[b].at("element") == contact.at("element"));
    // A byte is 1/255 of a group; only groups with a change in them are rounded.
    const double impacts =
        contact.at("front_contacts").get<double>() + contact.at("back_contacts").get<double>();
    CHECK(std::abs(apart - contact.at("time_separated_s").get<double>()) <=
          length * (2.0 + 2.0 * impacts) / 255.0);
  }
}

TEST_CASE("Resonances: speeds and static responses as in closed form") {
  // One cyclic torque on the last of three gears, the first held: the modes' static responses, each taken at
  // the loaded gear, add up to torque times static compliance.
  const Json data =
      block_of_run({"gear_drive", "--set", "engine_rpm=3000", "torque_order=9", "duration_s=0.2"});
  const Json &campbell = data.at("campbell"), &modes = data.at("modes");
  REQUIRE(modes.size() == 2);
  const auto gear = std::find_if(data["model"]["nodes"].begin(), data["model"]["nodes"].end(),
                                 [](const Json& node) { return node.at("name") == "gear"; });
  const auto place = static_cast<std::size_t>(gear - data["model"]["nodes"].begin());
  const double ratio = std::abs(gear->at("ratio").get<double>());
  CHECK(ratio == Approx(59.0 / 68 * 34 / 59));
  CHECK(campbell.at("shaft") == "crank_gear");
  double sum = 0.0;
  int found = 0;
  for (const Json& crossing : campbell.at("crossings")) {
    REQUIRE(crossing.at("order").get<double>() == Approx(9 * ratio));
    const Json& mode = modes.at(crossing.at("mode").get<std::size_t>());
    CHECK(crossing.at("speed").get<double>() * 9 * ratio ==
          Approx(2 * M_PI * mode.at("frequency_Hz").get<double>()));
    sum += crossing.at("static").get<double>() * std::abs(mode.at("shape").at(place).get<double>());
    ++found;
  }
  REQUIRE(found == 2);
  double k[2] = {}, r[2][2] = {};
  for (const Json& joint : data["model"]["joints"]) {
    const std::size_t m = joint.at("name") == "mesh_1" ? 0 : 1;
    k[m] = joint.at("stiffness");
    r[m][0] = joint.at("radii")[0], r[m][1] = joint.at("radii")[1];
  }
  CHECK(r[0][0] == Approx(0.5 * 0.008 * 59 * std::cos(20 * M_PI / 180)));
  const double idler = r[1][0] / r[0][1];  // force of mesh 1 over force of mesh 2
  const double compliance = (1 / k[1] + idler * idler / k[0]) / (r[1][1] * r[1][1]);
  CHECK(sum == Approx(6000 * compliance).epsilon(2e-5));  // shapes are given to 1e-5
}

TEST_CASE("Spectra find a known tone") {
  // Driven at 40 Hz below the only mode: the shaft's torque swings at 40 Hz and, undamped, at 155.2 Hz.
  const Json data = block_of_run({"two_inertia"});
  const Json& channels = data.at("spectra").at("channels");
  const auto torque = std::find_if(channels.begin(), channels.end(),
                                   [](const Json& c) { return c.at("name") == "shaft.torque_Nm"; });
  REQUIRE(torque != channels.end());
  CHECK(torque->at("peaks")[0].at("frequency_Hz").get<double>() == Approx(40.0).margin(0.1));
}

TEST_CASE("Two reports are compared in one") {
  const TemporaryFolder folder;
  const std::string a = (folder / "a").string(), b = (folder / "b.html").string(),
                    both = (folder / "both.html").string();
  REQUIRE(drev_command({"run", "two_inertia", "--out", a}).exit_code == 0);
  REQUIRE(drev_command({"run", "two_inertia", "--set", "duration_s=0.3", "--report", b}).exit_code == 0);
  CHECK(drev_command({"report", a, b, "--out", both}).exit_code == 0);
  const auto blocks = blocks_of(both);
  REQUIRE(blocks.size() == 2);
  CHECK(blocks[0] == blocks_of(folder / "a/report.html").at(0));
  CHECK(blocks[1] == blocks_of(b).at(0));
  const auto twice = drev_command({"report", both, b, "--out", (folder / "x.html").string()});
  CHECK(twice.exit_code == 2);
  CHECK(contains(twice.err, "compares two runs already"));
  const auto none = drev_command({"report", (folder / "a/history.csv").string(), (folder / "no").string()});
  CHECK(none.exit_code == 2);
  CHECK(contains(none.err, "is no report of drev run"));
  CHECK(contains(none.err, "is no file that can be read"));
  CHECK(contains(none.err, "--out"));
}

TEST_CASE("A report that cannot be written is refused before the run, or said") {
  const TemporaryFolder folder;
  const std::vector<std::string> long_run{"run", "camshaft", "--set", "duration_s=10000", "--report"};
  const auto with = [&](const std::string& path) {
    auto words = long_run;
    words.push_back(path);
    return words;
  };
  CHECK(drev_command(with((folder / "r.txt").string())).exit_code == 2);
  CHECK(drev_command(with((folder / "no/r.html").string())).exit_code == 3);
  // Interrupted: nothing of it is left.
  const Process process(with((folder / "r.html").string()));
  for (int i = 0; i < 500 && !std::filesystem::exists(folder / "r.partial.html"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  process.send(SIGINT);
  CHECK(process.wait().exit_code == 130);
  CHECK(std::filesystem::is_empty(folder / ""));
  const auto full =
      drev_command({"run", "two_inertia", "--report", (folder / "f.html").string()}, {.file = 20000});
  CAPTURE(full.err);
  CHECK(full.exit_code == 3);
  CHECK(contains(full.err, "f.partial.html: File too large"));
  CHECK_FALSE(std::filesystem::exists(folder / "f.html"));
}

TEST_CASE("Texts cannot break out of the page") {
  const TemporaryFolder folder;
  const std::string summary = "a </script><script>alert(1)</script><!--";
  std::ofstream(folder / "m.toml") << "format = 1\nsummary = \"" << summary
                                   << "\"\n[nodes]\na = {}\n[elements]\n"
                                   << "J = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n";
  const auto run =
      drev_command({"run", (folder / "m.toml").string(), "--report", (folder / "r.html").string()});
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const std::vector<Json> blocks = blocks_of(folder / "r.html");
  REQUIRE(blocks.size() == 1);
  CHECK(blocks.front().at("about") == summary);
  const std::string page = read_file(folder / "r.html");
  CHECK(!contains(page, "alert(1)</script>"));
  // Nothing runs but the two programs that bear this page's own nonce.
  const std::string policy = "content=\"default-src 'none'; script-src 'nonce-";
  const std::size_t begin = page.find(policy) + policy.size();
  REQUIRE(begin > policy.size());
  const std::string nonce = page.substr(begin, page.find('\'', begin) - begin);
  CHECK(nonce.size() >= 22);
  std::size_t programs = 0;
  for (std::size_t at = page.find("<script"); at != page.npos; at = page.find("<script", at + 1)) {
    const std::string rest = page.substr(at, 100);
    const bool own = rest.starts_with("<script nonce=\"" + nonce + "\">");
    programs += own;
    CHECK((own || rest.starts_with("<script type=\"application/json\" class=\"run\">")));
  }
  CHECK(programs == 2);
  REQUIRE(drev_command({"report", (folder / "r.html").string(), "--out", (folder / "again.html").string()})
              .exit_code == 0);
  CHECK(!contains(read_file(folder / "again.html"), nonce));
}

TEST_CASE("A report is not written over what it is made of") {
  const TemporaryFolder folder;
  const std::string model = (folder / "model.html").string(), table = (folder / "table.html").string();
  const std::string text =
      "format = 1\n[nodes]\na = {}\n[elements]\n"
      "J = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n"
      "T = { type = \"applied_torque\", node = \"a\", table = { csv = \"table.html\" } }\n";
  std::ofstream(model) << text;
  std::ofstream(table) << "time_s,torque_Nm\n0,0\n1,1\n";
  std::filesystem::create_hard_link(model, folder / "other.html");
  for (const std::string name : {"model.html", "other.html", "table.html"}) {
    const auto run = drev_command({"run", model, "--report", (folder / name).string()});
    CAPTURE(name, run.err);
    CHECK(run.exit_code == 2);
    CHECK(contains(run.err, "--report = " + (folder / name).string() + ", would be written over"));
  }
  CHECK(read_file(model) == text);
  CHECK(read_file(table) == "time_s,torque_Nm\n0,0\n1,1\n");

  // Nor a result over a table, a model over itself, or a report over the one that it is made of.
  std::filesystem::create_directory(folder / "r");
  std::filesystem::rename(table, folder / "r/history.csv");
  std::ofstream(folder / "m.toml") << text.substr(0, text.find("table.html")) << "r/history.csv\" } }\n";
  const auto over = drev_command({"run", (folder / "m.toml").string(), "--out", (folder / "r").string()});
  CHECK(over.exit_code == 2);
  CHECK(contains(over.err, "history.csv, would be written over"));
  CHECK(drev_command({"export", (folder / "m.toml").string(), "--out", (folder / "m.toml").string()})
            .exit_code == 2);
  const std::string report = (folder / "report.html").string();
  REQUIRE(drev_command({"run", "two_inertia", "--report", report}).exit_code == 0);
  const std::string before = read_file(report);
  CHECK(drev_command({"report", report, "--out", report}).exit_code == 2);
  CHECK(read_file(report) == before);
}

TEST_CASE("A damaged report is refused") {
  const TemporaryFolder folder;
  REQUIRE(drev_command({"run", "two_inertia", "--report", (folder / "r.html").string()}).exit_code == 0);
  const std::string page = read_file(folder / "r.html");
  const std::size_t series = page.find("\"low\":\"") + 7;
  const auto refused = [&](std::string damaged) {
    std::ofstream(folder / "d.html") << damaged;
    const auto report =
        drev_command({"report", (folder / "d.html").string(), "--out", (folder / "x.html").string()});
    CAPTURE(report.err);
    return report.exit_code == 2 && contains(report.err, "d.html, is damaged") &&
           !std::filesystem::exists(folder / "x.html");
  };
  const auto with = [&](std::size_t at, std::size_t count, const std::string& text) {
    return std::string(page).replace(at, count, text);
  };
  CHECK(refused(with(series + 40, 100, "")));  // values are missing
  CHECK(refused(with(series + 40, 1, "*")));   // one is none
  CHECK(refused(with(series - 8, 1, "")));     // no JSON
  CHECK(refused(with(page.find("\"history\":"), 9, "\"hostory\"")));
  CHECK(refused(with(page.find("\"groups\":"), 9, "\"groups\":1e9,\"g\"")));
  // Whatever is changed and still reads well: a value of the history, a digit of a figure, the checksum itself.
  CHECK(refused(with(series + 40, 1, page[series + 40] == 'A' ? "B" : "A")));
  const std::size_t digit = page.find("\"max_torque_Nm\":") + 18;
  CHECK(refused(with(digit, 1, page[digit] == '7' ? "3" : "7")));
  const std::size_t sum = page.find(",\"checksum\":\"");
  REQUIRE(sum != std::string::npos);
  CHECK(refused(with(sum + 13, 1, page[sum + 13] == '0' ? "1" : "0")));
  CHECK(refused(with(sum, 30, "")));
  // As it was written it is taken, also after it was written again.
  CHECK_FALSE(refused(page));
  std::filesystem::remove(folder / "x.html");
  std::ofstream(folder / "e.html") << page;
  REQUIRE(drev_command({"report", (folder / "e.html").string(), "--out", (folder / "f.html").string()})
              .exit_code == 0);
  CHECK(drev_command({"report", (folder / "f.html").string(), "--out", (folder / "g.html").string()})
            .exit_code == 0);
}

TEST_CASE(
    "The report of a run-up has its criticals from the slowest speed on, and no spectrum of the whole") {
  const TemporaryFolder folder;
  const std::string path = (folder / "up.toml").string();
  std::ofstream(path)
      << "format = 1\n[nodes]\nend = { hold = true, run_up = { speed_0_rpm = 300, speed_1_rpm = 1800, "
         "time_1_s = 10 } }\n"
         "disc = {}\n[elements]\nJ = { type = \"inertia\", node = \"disc\", inertia_kg_m2 = 1 }\n"
         "shaft = { type = \"shaft_spring\", nodes = [\"end\", \"disc\"], stiffness_Nm_per_rad = 12279, "
         "damping_Nms_per_rad = 8 }\nload = { type = \"engine_order_torque\", node = \"disc\", harmonics = { "
         "order = "
         "[2], amplitude_Nm = [10] } }\n[run]\nduration_s = 10\n";
  const Json data = block_of_run({path});
  CHECK(data.at("spectra").is_null());
  CHECK(!data.at("result").at("run_up").is_null());
  const Json& campbell = data.at("campbell");
  const double rpm = 2.0 * 3.14159265358979323846 / 60.0;
  CHECK(campbell.at("speed")[0].get<double>() == Approx(300.0 * rpm));
  CHECK(campbell.at("speed")[1].get<double>() == Approx(1800.0 * rpm));
  // Order 2 meets the only mode at 529 rpm, below half of the top speed, and is drawn.
  CHECK(campbell.at("orders")[0].at("order") == 2.0);
  CHECK(campbell.at("crossings")[0].at("speed").get<double>() == Approx(std::sqrt(12279.0) / 2.0));
}

TEST_CASE("Orders of the report are of the speed at which the shaft really turned") {
  const TemporaryFolder folder;
  const std::string path = (folder / "off.toml").string();
  std::ofstream(path)
      << "format = 1\n[nodes]\na = { nominal_speed_rad_per_s = 120 }\nb = {}\n[elements]\n"
         "Ja = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 0.01 }\n"
         "Jb = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 0.01 }\n"
         "shaft = { type = \"shaft_spring\", nodes = [\"a\", \"b\"], stiffness_Nm_per_rad = 4000, "
         "damping_Nms_per_rad = 0.5 }\n"
         "drag = { type = \"dashpot\", node = \"b\", damping_Nms_per_rad = 0.1 }\n"
         "drive = { type = \"engine_order_torque\", node = \"a\", mean_Nm = 10, harmonics = { order "
         "= [2], amplitude_Nm = [3] } }\n[run]\nduration_s = 8\nsettle_s = 2\n"
         "record = [\"shaft.torque_Nm\"]\n";
  const Json data = block_of_run({path});
  CHECK(data.at("notes").size() == 1);
  const Json& spectra = data.at("spectra");
  const double turns = spectra.at("speed").get<double>() / (2.0 * 3.14159265358979323846);
  CHECK(std::abs(turns * 2.0 * 3.14159265358979323846 / 100.0 - 1.0) < 1e-3);
  const Json& peak = spectra.at("channels")[0].at("peaks")[0];
  CHECK(std::abs(peak.at("frequency_Hz").get<double>() / turns - 2.0) < 2e-3);
}

TEST_CASE("Spectra are over whole cycles at any constant nominal speed: an order shows its amplitude") {
  // 617 rpm: half of the run is 10.28 turns. A held node, and on a stiff shaft 50 N m of order 1.
  const TemporaryFolder folder;
  const std::string path = (folder / "whole.toml").string();
  std::ofstream(path)
      << "format = 1\n[nodes]\nend = { hold = true, nominal_speed_rpm = 617 }\ndisc = {}\n[elements]\n"
         "J = { type = \"inertia\", node = \"disc\", inertia_kg_m2 = 1e-3 }\n"
         "shaft = { type = \"shaft_spring\", nodes = [\"end\", \"disc\"], stiffness_Nm_per_rad = 1e4, "
         "damping_Nms_per_rad = 3 }\nload = { type = \"engine_order_torque\", node = \"disc\", harmonics = { "
         "order = [1], amplitude_Nm = [50] }, twist_feedback = false }\n[run]\nduration_s = 2\n"
         "record = [\"load.torque_Nm\"]\n";
  const Json spectra = block_of_run({path}).at("spectra");
  const double turns = (spectra.at("to").get<double>() - spectra.at("from").get<double>()) * 617.0 / 60.0;
  CHECK(turns / 2.0 == Approx(std::round(turns / 2.0)).margin(1e-9));
  CHECK(turns > 7.9);
  const auto lines = decoded<float>(spectra.at("channels")[0].at("amplitude").get<std::string>());
  REQUIRE_FALSE(lines.empty());
  CHECK(*std::max_element(lines.begin(), lines.end()) == Approx(50.0).epsilon(1e-4));
  // Once a turn the torque is always the same: what rounding leaves of it is no peak.
  const Json once = block_of_run({path, "--every", "0.09724473257698542", "--duration", "20"}).at("spectra");
  CHECK(once.at("channels")[0].at("peaks").empty());
}

TEST_CASE("A train without a frequency or a speed of its own has the spectrum of what was recorded") {
  const TemporaryFolder folder;
  const std::string path = (folder / "one.toml").string();
  std::ofstream(path) << "format = 1\n[nodes]\na = {}\n[elements]\n"
                         "J = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n"
                         "T = { type = \"applied_torque\", node = \"a\", torque_Nm = 1 }\n"
                         "[run]\nduration_s = 1\nrecord = [\"a.speed_rad_per_s\"]\n";
  const Json spectra = block_of_run({path}).at("spectra");
  CHECK(decoded<float>(spectra.at("channels")[0].at("amplitude").get<std::string>()).size() > 10);
}

TEST_CASE("The waterfall begins at two cycles a window, so that order 0.5 is not shown at 0.25, too") {
  const TemporaryFolder folder;
  const std::string path = (folder / "up.toml").string(), out = (folder / "out").string();
  std::ofstream(path)
      << "format = 1\n[nodes]\nend = { run_up = { speed_0_rpm = 600, speed_1_rpm = 1200, time_0_s = 0, "
         "time_1_s = 1 }, hold = true }\ndisc = {}\n[elements]\n"
         "J = { type = \"inertia\", node = \"disc\", inertia_kg_m2 = 1 }\n"
         "shaft = { type = \"shaft_spring\", nodes = [\"end\", \"disc\"], stiffness_Nm_per_rad = 1e4 }\n"
         "[run]\nduration_s = 1\n";
  REQUIRE(drev_command({"run", path, "--out", out}).exit_code == 0);
  std::istringstream rows(read_file(out + "/waterfall.csv"));
  std::string row;
  std::getline(rows, row);
  std::getline(rows, row);
  CHECK(contains(row, ",0.5,"));
}

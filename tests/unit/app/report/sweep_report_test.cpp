// Reports of sweeps: the page holds the numbers of the JSON, in the frame that reports of runs have.
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/base/text_layout.hpp"
#include "app/report/report_page.hpp"
#include "app/report/report_spectra.hpp"
#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using drev::test::read_file;

namespace {

const std::string kEngineFile = DREV_SOURCE_DIR "/models/engine/engine.toml";

/// The base64 text of numbers, as the page holds them.
std::string as_floats(const nlohmann::json& values) {
  std::vector<float> list;
  for (const nlohmann::json& value : values) list.push_back(value.get<float>());
  return drev::app::base64(list);
}

}  // namespace

TEST_CASE("The report of a sweep holds what its JSON says", "[sweep][report]") {
  const drev::test::TemporaryFolder folder;
  for (const std::string command : {"sweep", "campbell"}) {
    const std::string file = (folder / (command + ".html")).string();
    REQUIRE(drev_command({command, kEngineFile, "--speeds", "600:50:1000", "--report", file, "--quiet"})
                .exit_code == 0);
    const std::string page = read_file(file);
    CHECK(contains(page, "default-src 'none'; script-src 'nonce-"));
    for (const char* marker : {"{{policy", "{{sections", "{{nonce", "{{runs"})
      CHECK_FALSE(contains(page, marker));
    const std::vector<std::string> blocks = drev::app::blocks_of(page);
    REQUIRE(blocks.size() == 1);
    const nlohmann::json data = nlohmann::json::parse(blocks.front());
    const nlohmann::json json =
        nlohmann::json::parse(drev_command({"sweep", kEngineFile, "--speeds", "600:50:1000", "--json"}).out);
    const nlohmann::json& sweep = data.at("sweeps").at(0);
    CHECK(data.at("command") == "drev " + command + " " + kEngineFile + " --speeds 600:50:1000");
    CHECK(sweep.at("speeds_rpm") == json.at("speeds_rpm"));
    CHECK(sweep.at("criticals") == json.at("criticals"));
    REQUIRE(sweep.at("sections").size() == json.at("sections").size());
    for (std::size_t s = 0; s < json.at("sections").size(); ++s) {
      const nlohmann::json &drawn = sweep["sections"][s], &section = json["sections"][s];
      CHECK(drawn.at("name") == section.at("name"));
      CHECK(drawn.at("half_range") == as_floats(section.at("half_range")));
      nlohmann::json amplitudes = nlohmann::json::array();
      for (const nlohmann::json& order : section.at("amplitude"))
        for (const nlohmann::json& value : order) amplitudes.push_back(value);
      CHECK(drawn.at("amplitude") == as_floats(amplitudes));
      double largest = 0.0;
      for (const nlohmann::json& value : section.at("half_range"))
        largest = std::max(largest, value.get<double>());
      CHECK(drawn.at("peaks").at(0).at("half_range").get<double>() >= largest);
    }
    CHECK(data.at("campbell").at("modes").size() == 6);
    CHECK(data.at("model").at("nodes").size() == 8);
    // It is no report of a run, and drev report says so.
    const auto refused = drev_command({"report", file, "--out", (folder / "again.html").string()});
    CHECK(refused.exit_code == 2);
    CHECK(contains(refused.err, "is the report of a sweep"));
  }
  const auto refused = drev_command({"sweep", kEngineFile, "--speeds", "900", "--report", "sweep.txt"});
  CHECK(refused.exit_code == 2);
  CHECK(contains(refused.err, "--report"));
}

TEST_CASE("The report of a sweep with contacts holds its branches and limits", "[sweep][report][once]") {
  const drev::test::TemporaryFolder folder;
  const std::string model = (folder / "pair.toml").string(), file = (folder / "branches.html").string();
  std::ofstream(model) << read_file(DREV_SOURCE_DIR "/models/gear_pair/gear_pair.toml");
  const std::vector<std::string> words{"sweep", model, "--speeds", "1500:250:2500"};
  std::vector<std::string> reported = words, as_json = words;
  reported.insert(reported.end(), {"--report", file, "--quiet"});
  as_json.emplace_back("--json");
  REQUIRE(drev_command(reported).exit_code == 0);
  const std::vector<std::string> blocks = drev::app::blocks_of(read_file(file));
  REQUIRE(blocks.size() == 1);
  const nlohmann::json data = nlohmann::json::parse(blocks.front());
  const nlohmann::json json = nlohmann::json::parse(drev_command(as_json).out);
  CHECK(json.at("changes").size() == 3);
  CHECK(data.at("result").at("branches") == json.at("branches"));
  CHECK(data.at("result").at("changes") == json.at("changes"));
  CHECK(data.at("command") == "drev sweep " + model + " --speeds 1500:250:2500");
  CHECK(data.at("limits").size() == json.at("sections").size());
  const auto refused = drev_command({"report", file, "--out", (folder / "again.html").string()});
  CHECK(refused.exit_code == 2);
  CHECK(contains(refused.err, "is the report of a sweep"));
}

TEST_CASE("Text, JSON and report name the shaft whose speeds those of a sweep are", "[sweep][report]") {
  const drev::test::TemporaryFolder folder;
  const std::string file = (folder / "shaft.html").string();
  // The speed parameter of this model is the engine's, which turns twice as fast as its reference shaft, the held gear.
  const std::vector<std::string> camshaft{"camshaft", "--set",    "drive=held", "--speeds",
                                          "300,375",  "--report", file};
  for (const char* command : {"sweep", "campbell"}) {
    std::vector<std::string> words = camshaft;
    words.insert(words.begin(), command);
    CHECK(contains(drev_command(words).out, "375 rpm of gear, the reference shaft"));
    CHECK(nlohmann::json::parse(drev::app::blocks_of(read_file(file)).front()).at("shaft") == "gear");
    words.emplace_back("--json");
    CHECK(nlohmann::json::parse(drev_command(words).out).at("reference_shaft") == "gear");
  }
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"sweep", DREV_SOURCE_DIR "/models/gear_pair/gear_pair.toml", "--speeds",
                                 "2400,2500"},
        std::vector<std::string>{"class", DREV_SOURCE_DIR "/models/genset/genset.toml", "--speeds",
                                 "1400,1500", "--contact", "closed"}}) {
    const std::string shaft = words.front() == "sweep" ? "pinion" : "throw_1";
    CHECK(contains(drev_command(words).out, "rpm of " + shaft + ", the reference shaft"));
    std::vector<std::string> as_json = words;
    as_json.emplace_back("--json");
    CHECK(nlohmann::json::parse(drev_command(as_json).out).at("reference_shaft") == shaft);
  }
}

TEST_CASE("Largest half range, error of a fold and sign of a mean are the same in text, JSON and report",
          "[sweep][report][once]") {
  const drev::test::TemporaryFolder folder;
  const std::string file = (folder / "pair.html").string();
  std::vector<std::string> words{"sweep",    DREV_SOURCE_DIR "/models/gear_pair/gear_pair.toml",
                                 "--speeds", "1500:100:2500",
                                 "--report", file};
  const std::string text = drev_command(words).out;
  words.emplace_back("--json");
  const nlohmann::json json = nlohmann::json::parse(drev_command(words).out);
  const nlohmann::json data = nlohmann::json::parse(drev::app::blocks_of(read_file(file)).front());
  CHECK(data.at("result").at("largest") == json.at("largest"));
  CHECK(contains(read_file(file), "result.largest"));  // what the page's table is made from
  const nlohmann::json& largest = json.at("largest").at(0);
  CHECK(largest.at("speed_rpm").get<double>() == Approx(1600.0));
  // The curve is highest beside 1600 rpm, which the grid does not show.
  CHECK(largest.at("between_half_range").get<double>() > largest.at("half_range").get<double>());
  CHECK(largest.at("between_rpm").get<double>() > 1600.0);
  CHECK(largest.at("between_rpm").get<double>() < 1700.0);
  for (const char* name : {"half_range", "heat_W", "between_half_range"})
    CHECK(contains(text, drev::app::digits(largest.at(name).get<double>(), 6)));
  for (const nlohmann::json& change : json.at("changes")) {
    CHECK(contains(text, " " + drev::app::digits(change.at("error_rpm").get<double>(), 2) + " "));
    CHECK(change.at("error_rpm").get<double>() >= 1e-10 * change.at("speed_rpm").get<double>());
  }
  const std::string means = drev_command({"sweep", kEngineFile, "--speeds", "600:100:2000"}).out;
  CHECK(contains(means, " -375.000 "));
}

TEST_CASE("What orders leave out is said to be a part of the loads, above and below 0.1 %",
          "[sweep][report]") {
  const drev::test::TemporaryFolder folder;
  const std::string file = (folder / "left.html").string();
  for (const bool many : {false, true}) {
    std::vector<std::string> words{
        "sweep",        "camshaft", "--set", "drive=held", "--set",
        "loads=source", "--speeds", "375",   "--orders",   many ? "1:1:400" : "1:1:20",
        "--report",     file};
    const std::string text = drev_command(words).out;
    words.emplace_back("--json");
    const nlohmann::json json = nlohmann::json::parse(drev_command(words).out);
    const nlohmann::json& most = json.at("most_left_out");
    CHECK(json.at("left_out").empty() == many);
    CHECK((most.at("share").get<double>() > 1e-3) == !many);
    CHECK(contains(text, "of what alternates in"));
    CHECK(contains(text, "half ranges may be off by"));
    CHECK(contains(read_file(file), "half ranges may be off by a larger part"));
    // Orders 401 to 800 add 2.0 % to a half range, although less than 0.1 % of each load is in them.
    if (many) CHECK(contains(text, most.at("load").get<std::string>() + ", rms) is in"));
  }
  const nlohmann::json whole =
      nlohmann::json::parse(drev_command({"sweep", kEngineFile, "--speeds", "600,700", "--json"}).out);
  CHECK(whole.at("most_left_out").is_null());
}

TEST_CASE("Limits of sections stand in the report of a sweep", "[sweep][report]") {
  const drev::test::TemporaryFolder folder;
  const std::string file = (folder / "limits.html").string();
  REQUIRE(drev_command({"sweep", DREV_SOURCE_DIR "/models/genset/genset.toml", "--speeds", "1400,1500,1600",
                        "--contact", "closed", "--report", file, "--quiet"})
              .exit_code == 0);
  const nlohmann::json data = nlohmann::json::parse(drev::app::blocks_of(read_file(file)).front());
  std::size_t limits = 0;
  for (const nlohmann::json& section : data.at("sweeps").at(0).at("sections"))
    for (const nlohmann::json& limit : section.at("limits")) {
      ++limits;
      CHECK(contains(limit.at("name").get<std::string>(), "permissible"));
    }
  // As many as the judgement draws of the same sections.
  const std::string judged = (folder / "class.html").string();
  REQUIRE(drev_command({"class", DREV_SOURCE_DIR "/models/genset/genset.toml", "--speeds", "1400,1500,1600",
                        "--contact", "closed", "--report", judged, "--quiet"})
              .exit_code == 0);
  const nlohmann::json of_class = nlohmann::json::parse(drev::app::blocks_of(read_file(judged)).front());
  std::size_t expected = 0;
  for (const nlohmann::json& section : of_class.at("sweeps").at(0).at("sections"))
    expected += section.at("limits").size();
  CHECK(limits == expected);
  CHECK(limits > 2);
}

TEST_CASE("Every section of a sweep's report has its own criticals", "[sweep][report]") {
  const drev::test::TemporaryFolder folder;
  const std::string model = (folder / "chain.toml").string(), file = (folder / "chain.html").string();
  std::ofstream(model) << R"(format = 1
nodes = { motor = { constant_speed_rpm = 600 }, a = {}, b = {} }
[elements]
Ja = { type = "inertia", node = "a", inertia_kg_m2 = 1 }
Jb = { type = "inertia", node = "b", inertia_kg_m2 = 1 }
s1 = { type = "shaft_spring", nodes = ["motor", "a"], stiffness_Nm_per_rad = 100, damping_Nms_per_rad = 1 }
s2 = { type = "shaft_spring", nodes = ["a", "b"], stiffness_Nm_per_rad = 100, damping_Nms_per_rad = 1 }
gas = { type = "engine_order_torque", node = "b", harmonics = { order = [1], amplitude_Nm = [1] } }
)";
  REQUIRE(drev_command({"sweep", model, "--speeds", "20:20:400", "--report", file, "--quiet"}).exit_code ==
          0);
  const nlohmann::json sweep =
      nlohmann::json::parse(drev::app::blocks_of(read_file(file)).front()).at("sweeps").at(0);
  for (std::size_t s = 0; s < 2; ++s) {
    const nlohmann::json& section = sweep["sections"][s];
    REQUIRE(section.at("criticals").size() == 2);
    const nlohmann::json &peak = section["peaks"][0], &critical = section["criticals"][0];
    // The one order is the half range, which no speed of the sweep has.
    CHECK(critical.at("order") == 1.0);
    CHECK(critical.at("of_mode") == true);
    CHECK(critical.at("speed_rpm").get<double>() == Approx(peak.at("speed_rpm").get<double>()).epsilon(1e-4));
    CHECK(critical.at("amplitude").get<double>() ==
          Approx(peak.at("half_range").get<double>()).epsilon(1e-4));
  }
}

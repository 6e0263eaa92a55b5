// drev class: what it judges of the genset, against the sweep and the rule by hand; its report. Rainflow counts of runs.
#include <drev/solvers/strength/iacs_m68.hpp>
#include <drev/solvers/strength/section_strength.hpp>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using drev::test::read_file;

namespace {

const std::string kGensetFile = DREV_SOURCE_DIR "/models/genset/genset.toml";
const std::vector<std::string> kGensetSpeeds{"--speeds", "1200:20:1700", "--contact",
                                             "closed",   "--balance",    "generator"};

nlohmann::json class_json_of(std::vector<std::string> words) {
  words.emplace_back("--json");
  const auto outcome = drev_command(words);
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  return nlohmann::json::parse(outcome.out);
}

std::vector<std::string> with_genset_speeds(std::vector<std::string> words) {
  words.insert(words.end(), kGensetSpeeds.begin(), kGensetSpeeds.end());
  return words;
}

}  // namespace

TEST_CASE("The class calculation judges what the sweep finds, fired and misfiring", "[class]") {
  const drev::test::TemporaryFolder folder;
  const std::string report = (folder / "tvc.html").string();
  const nlohmann::json judged = class_json_of(
      with_genset_speeds({"class", kGensetFile, "--report", report, "--out", (folder / "out").string()}));
  CHECK(nlohmann::json::parse(read_file(folder / "out/class.json")) == judged);
  REQUIRE(judged.at("cases").size() == 2);
  for (std::size_t c = 0; c < 2; ++c) {
    std::vector<std::string> words = with_genset_speeds({"sweep", kGensetFile});
    if (c == 1) words.insert(words.end(), {"--set", "fires_1=0"});
    const nlohmann::json sweep = class_json_of(words);
    const nlohmann::json& one = judged["cases"][c];
    CHECK(one.at("name") == (c == 0 ? "normal" : "misfire"));
    CHECK(one.at("parameters").at("fires_1") == (c == 0 ? 1 : 0));
    for (const nlohmann::json& s : one.at("sections")) {
      const auto same =
          std::find_if(sweep.at("sections").begin(), sweep.at("sections").end(),
                       [&](const nlohmann::json& other) { return other.at("name") == s.at("section"); });
      REQUIRE(same != sweep.at("sections").end());
      CHECK(s.at("half_range_Nm") == same->at("half_range"));
      const double limit = s.at("permissible_Nm")[0];
      double largest = 0.0;
      for (const nlohmann::json& value : same->at("half_range"))
        largest = std::max(largest, value.get<double>());
      CHECK(s.at("utilisation").get<double>() >= largest / limit * (1.0 - 1e-12));
      if (s.at("section") == "flange.torque_Nm") {
        const double modulus = drev::polar_section_modulus(0.074);
        CHECK(s.at("modulus_m3").get<double>() == Approx(modulus));
        CHECK(limit == Approx(90e6 * modulus / 1.6));  // local stress: nominal times 1.6
        CHECK(s.at("stress_Pa")[3].get<double>() ==
              Approx(1.6 * s.at("half_range_Nm")[3].get<double>() / modulus));
      }
    }
  }
  // A misfire loads the coupling most, which its limit shows.
  CHECK(judged["cases"][0].at("accepted") == true);
  CHECK(judged["cases"][1].at("accepted") == false);
  CHECK(judged.at("mass_elastic").at("nodes").size() == 10);
  // The report has both cases, the limits drawn, the formulas and what is not judged.
  const std::string text = read_file(report), mark = "class=\"run\">";
  const std::size_t begin = text.find(mark) + mark.size();
  const nlohmann::json page =
      nlohmann::json::parse(text.substr(begin, text.find("</script>", begin) - begin));
  CHECK(page.at("class") == judged);
  CHECK(page.at("sweeps").size() == 2);
  std::size_t limits = 0;
  for (const nlohmann::json& s : page["sweeps"][0].at("sections")) limits += s.at("limits").size();
  CHECK(limits >= 6);
}

TEST_CASE("By rule, with a barred range: a shaft below the strength that its critical needs", "[class]") {
  const drev::test::TemporaryFolder folder;
  std::ofstream(folder / "line.toml")
      << "format = 1\n[nodes]\nengine = { nominal_speed_rpm = 60 }\npropeller = {}\n[elements]\n"
         "J_1 = { type = \"inertia\", node = \"engine\", inertia_kg_m2 = 30000 }\n"
         "J_2 = { type = \"inertia\", node = \"propeller\", inertia_kg_m2 = 20000 }\n"
         "shaft = { type = \"shaft_spring\", nodes = [\"engine\", \"propeller\"], stiffness_MNm_per_rad = "
         "15, "
         "damping_kNms_per_rad = 20 }\n"
         "firing = { type = \"engine_order_torque\", node = \"engine\", harmonics = { order = [5], "
         "amplitude_kNm = "
         "[60] } }\n[class]\nrated_speed_rpm = 100\n[class.sections]\n"
         "shaft = { diameter_mm = 340, tensile_strength_MPa = 600, shape_factor = 1 }\n";
  const nlohmann::json judged =
      class_json_of({"class", (folder / "line.toml").string(), "--speeds", "30:0.5:105"});
  const nlohmann::json& s = judged["cases"][0]["sections"][0];
  REQUIRE(s.at("barred_by_rule").size() == 1);
  const nlohmann::json& barred = s["barred_by_rule"][0];
  const double critical = barred.at("critical_rpm"), ratio = critical / 100.0;
  CHECK(barred.at("order") == 5.0);
  CHECK(barred.at("from_rpm").get<double>() == Approx(16.0 * critical / (18.0 - ratio)));
  CHECK(barred.at("to_rpm").get<double>() == Approx((18.0 - ratio) * critical / 16.0));
  CHECK(s.at("rule") == "IACS UR M68.5");
  const double limit = drev::iacs_m68::permissible_stress(600e6, 1.0, 0.34, 0.3).continuous;
  CHECK(s.at("permissible_Nm")[0].get<double>() == Approx(limit * drev::polar_section_modulus(0.34)));
  REQUIRE(s.at("exceeded").size() == 1);
  CHECK(s["exceeded"][0].at("from_rpm").get<double>() < critical);
  CHECK(s["exceeded"][0].at("to_rpm").get<double>() > critical);
  const auto text = drev_command({"class", (folder / "line.toml").string(), "--speeds", "30:0.5:105"});
  for (const char* part : {"LIMITS EXCEEDED", "barred by IACS UR M68.5", "Rev.3 February 2021", "Not judged"})
    CHECK(contains(text.out, part));
}

TEST_CASE("A model without [class] is told what it lacks", "[class]") {
  const auto refused =
      drev_command({"class", DREV_SOURCE_DIR "/models/engine/engine.toml", "--speeds", "900"});
  CHECK(refused.exit_code == 2);
  CHECK(contains(refused.err, "[class]"));
}

TEST_CASE("A run counts load cycles of sections with an S-N line and of channels asked for", "[class]") {
  const nlohmann::json run = class_json_of({"run", kGensetFile, "--step", "1e-5", "--duration", "0.3",
                                            "--settle", "0.1", "--rainflow", "coupling.torque_Nm"});
  CHECK(run.at("t_end_s") == 0.3);
  const nlohmann::json& counted = run.at("results").at("rainflow");
  REQUIRE(counted.size() == 2);
  CHECK(counted[0].at("channel") == "flange.torque_Nm");
  CHECK(counted[1].at("channel") == "coupling.torque_Nm");
  CHECK(counted[1].at("damage").is_null());
  const double stress = counted[0].at("stress_per_unit_Pa");
  CHECK(stress == Approx(1.6 / drev::polar_section_modulus(0.074)));
  double least = 0.0, most = 0.0, cycles = 0.0;
  for (const nlohmann::json& c : counted[0].at("classes")) {
    const double n = c.at("cycles");
    cycles += n;
    least += n * std::pow(c.at("mean_range").get<double>() * stress / 160e6, 6) / 2e6;
    most += n * std::pow(c.at("largest_range").get<double>() * stress / 160e6, 6) / 2e6;
  }
  CHECK(cycles == counted[0].at("cycles").get<double>());
  CHECK(counted[0].at("damage").get<double>() >= least * (1.0 - 1e-12));
  CHECK(counted[0].at("damage").get<double>() <= most * (1.0 + 1e-12));
  // Each section with its peaks, of the whole run and of the part that figures are of.
  for (const nlohmann::json& s : run.at("results").at("sections")) {
    CHECK(s.at("peak_maximum").get<double>() >= s.at("maximum").get<double>());
    CHECK(s.at("peak_minimum").get<double>() <= s.at("minimum").get<double>());
    if (s.at("channel") == "flange.torque_Nm") CHECK(s.at("permissible").get<double>() > 0.0);
  }
  CHECK(drev_command({"run", kGensetFile, "--rainflow", "flnge.torque_Nm"}).exit_code == 2);
  CHECK(drev_command({"run", kGensetFile, "--duration", "-1"}).exit_code == 2);
}

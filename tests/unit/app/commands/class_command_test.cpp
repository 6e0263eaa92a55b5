// drev class: what it judges of the genset, against the sweep and the rule by hand; its report. Rainflow counts of runs.
#include <drev/solvers/strength/section_strength.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "solvers/strength/iacs_m68.hpp"
#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using drev::test::read_file;

namespace {

const std::string kGensetFile = DREV_SOURCE_DIR "/models/genset/genset.toml";
const std::vector<std::string> kGensetSpeeds{"--speeds", "1200:20:1700", "--contact",
                                             "closed",   "--balance",    "generator"};

/// The gear pair, whose wheel drives a machine through a shaft; [class] follows.
constexpr const char* kPairWithMachine =
    "format = 1\ninclude = [\"" DREV_SOURCE_DIR
    "/models/gear_pair/gear_pair.toml\"]\n[nodes]\nmachine = {}\n"
    "[elements]\nJ_machine = { type = \"inertia\", node = \"machine\", inertia_kg_m2 = 0.02 }\n"
    "shaft = { type = \"shaft_spring\", nodes = [\"wheel\", \"machine\"], stiffness_Nm_per_rad = 2e6, "
    "damping_Nms_per_rad = 5 }\n";

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

/// What a report shows.
nlohmann::json page_of(const std::string& report) {
  const std::string text = read_file(report), mark = "class=\"run\">";
  const std::size_t begin = text.find(mark) + mark.size();
  return nlohmann::json::parse(text.substr(begin, text.find("</script>", begin) - begin));
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
        // A peak between the speeds is what counts: half range, stress and utilisation are of one speed.
        const double worst = s.at("worst_half_range_Nm");
        CHECK(worst >= largest * (1.0 - 1e-12));
        CHECK(s.at("worst_permissible_Nm") == limit);
        CHECK(s.at("utilisation").get<double>() == Approx(worst / limit));
        CHECK(s.at("worst_stress_Pa").get<double>() == Approx(1.6 * worst / modulus));
      }
    }
  }
  // A misfire loads the coupling most, which its limit shows.
  CHECK(judged["cases"][0].at("accepted") == true);
  CHECK(judged["cases"][1].at("accepted") == false);
  CHECK(judged.at("mass_elastic").at("nodes").size() == 10);
  // The report has both cases, the limits drawn, the formulas and what is not judged.
  const nlohmann::json page = page_of(report);
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
         "firing = { type = \"engine_order_torque\", node = \"engine\", mean_kNm = 100, harmonics = "
         "{ order = [5], amplitude_kNm = [60] } }\n[class]\nrated_speed_rpm = 100\n[class.sections]\n"
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
  CHECK(s.at("rule_ends_rpm").is_null());  // 105 rpm is 1.05 of the rated speed
  const auto text = drev_command({"class", (folder / "line.toml").string(), "--speeds", "30:0.5:105"});
  for (const char* part : {"LIMITS EXCEEDED", "(order 5, mode 1)", "M68.5 from 62.", "Rev.3 February 2021",
                           "Not judged", "Mean torque does not balance at 151 of 151 speeds"})
    CHECK(contains(text.out, part));
}

TEST_CASE("Above 1.05 of the rated speed the rule has no limit: what holds there is said", "[class]") {
  const drev::test::TemporaryFolder folder;
  // Undamped, one order: mu/J_1 a / |1 - (o w / w_0)^2| of the closed form, below the resonance at 1.2 of the rated speed.
  for (const bool by_number : {false, true}) {
    std::ofstream(folder / "line.toml")
        << "format = 1\n[nodes]\nengine = { nominal_speed_rpm = 60 }\npropeller = {}\n[elements]\n"
           "J_1 = { type = \"inertia\", node = \"engine\", inertia_kg_m2 = 30000 }\n"
           "J_2 = { type = \"inertia\", node = \"propeller\", inertia_kg_m2 = 20000 }\n"
           "shaft = { type = \"shaft_spring\", nodes = [\"engine\", \"propeller\"], stiffness_MNm_per_rad = "
           "15 }\n"
           "firing = { type = \"engine_order_torque\", node = \"engine\", harmonics = { order = [2.8], "
           "amplitude_kNm = [200] } }\n[class]\nrated_speed_rpm = 100\n[class.sections]\n"
           "shaft = { diameter_mm = 340, tensile_strength_MPa = 600, shape_factor = 1"
        << (by_number ? ", permissible_torque_Nm = 900000 }\n" : " }\n");
    const std::string file = (folder / "line.toml").string(), report = (folder / "line.html").string();
    const nlohmann::json judged =
        class_json_of({"class", file, "--speeds", "60:10:110", "--orders", "2.8", "--report", report});
    const nlohmann::json& s = judged["cases"][0]["sections"][0];
    const auto half_range = [](double rpm) {
      const double mu = 12000.0, frequency = 2.8 * rpm * std::acos(-1.0) / 30.0;
      return mu / 30000.0 * 200e3 / std::abs(1.0 - frequency * frequency * mu / 15e6);
    };
    const double limit = drev::iacs_m68::permissible_stress(600e6, 1.0, 0.34, 1.0).continuous *
                         drev::polar_section_modulus(0.34);
    REQUIRE(half_range(105.0) > limit);
    REQUIRE(half_range(110.0) < 900e3);
    CHECK(s.at("rule_ends_rpm").get<double>() == Approx(105.0).epsilon(1e-14));
    CHECK(s.at("rule_beyond") == (by_number ? nlohmann::json("permissible torque") : nlohmann::json()));
    CHECK(s.at("utilisation").get<double>() == Approx(half_range(105.0) / limit).epsilon(1e-9));
    CHECK(s.at("utilisation_at_rpm").get<double>() == Approx(105.0).epsilon(1e-14));
    CHECK(s.at("permissible_Nm").at(5) == (by_number ? nlohmann::json(900000.0) : nlohmann::json()));
    const nlohmann::json& range = s.at("exceeded").at(0);
    CHECK(range.at("to_rpm").get<double>() == Approx(105.0).epsilon(1e-6));
    CHECK(range.at("open_to") == !by_number);
    const auto text = drev_command({"class", file, "--speeds", "60:10:110", "--orders", "2.8"});
    CHECK(contains(text.out, "IACS UR M68.5 has no limit above 105.00 rpm"));
    CHECK(contains(text.out, by_number ? "permissible torque alone holds" : "the torque is not judged"));
    CHECK(contains(read_file(report), "rule_ends_rpm"));
  }
}

TEST_CASE("A class calculation of teeth as they are: the worst stable motion, fired and misfiring",
          "[class][once]") {
  const drev::test::TemporaryFolder folder;
  std::ofstream(folder / "pair.toml") << kPairWithMachine
                                      << "[class]\nmisfire = { torque_Nm = 30 }\n[class.sections]\n"
                                         "shaft = { permissible_torque_Nm = 28 }\n";
  const std::string file = (folder / "pair.toml").string(), report = (folder / "pair.html").string();
  const std::string speeds = "1800:100:2100";
  const nlohmann::json judged = class_json_of({"class", file, "--speeds", speeds, "--report", report});
  CHECK(judged.at("contact").is_null());
  REQUIRE(judged.at("cases").size() == 2);
  for (std::size_t c = 0; c < 2; ++c) {
    const nlohmann::json& one = judged["cases"][c];
    CHECK(contains(one.at("notes")[0].get<std::string>(), "Contacts as they are"));
    std::vector<std::string> words{"sweep", file, "--speeds", speeds};
    if (c == 1) words.insert(words.end(), {"--set", "torque_Nm=30"});
    const nlohmann::json sweep = class_json_of(words);
    const auto shaft = std::find_if(sweep.at("sections").begin(), sweep.at("sections").end(),
                                    [](const auto& s) { return s.at("name") == "shaft.torque_Nm"; });
    const auto section = static_cast<std::size_t>(shaft - sweep.at("sections").begin());
    for (std::size_t i = 0; i < judged.at("speeds_rpm").size(); ++i) {
      double worst = 0.0;
      for (const nlohmann::json& branch : sweep.at("branches"))
        for (std::size_t m = 0; m < branch.at("speed_rpm").size(); ++m)
          if (branch["asked"][m] == true && branch["stable"][m] == true &&
              std::abs(branch["speed_rpm"][m].get<double>() - judged["speeds_rpm"][i].get<double>()) < 1e-6)
            worst = std::max(worst, branch["sections"][section]["half_range"][m].get<double>());
      // With too little torque nothing is stable at one of the speeds: a run's lowest and highest value.
      for (const nlohmann::json& run : sweep.at("runs"))
        if (worst == 0.0 &&
            std::abs(run["speed_rpm"].get<double>() - judged["speeds_rpm"][i].get<double>()) < 1e-6)
          worst = 0.5 * (run["highest"][section].get<double>() - run["lowest"][section].get<double>());
      CHECK(worst > 0.0);
      CHECK(one.at("sections")[0].at("half_range_Nm")[i].get<double>() == Approx(worst).epsilon(1e-12));
    }
    // The limit of 28 N m is met between two speeds of the grid, in the normal case at a point of the curve between them.
    const nlohmann::json& range = one.at("sections")[0].at("exceeded").at(0);
    CHECK(range.at("kept_below_rpm").is_null());
    CHECK(range.at("to_rpm").get<double>() > (c == 0 ? 1900.0 : 2000.0));
    CHECK(range.at("to_rpm").get<double>() < range.at("kept_above_rpm").get<double>());
    CHECK(range.at("kept_above_rpm").get<double>() < (c == 0 ? 1999.0 : 2101.0));
    // Only with little torque the mesh's force swings beyond its mean.
    CHECK(one.at("chatter").empty() == (c == 0));
  }
  CHECK(contains(read_file(report), "Contacts as they are"));
  const auto text = drev_command({"class", file, "--speeds", speeds});
  CHECK(contains(text.out, "they separate at"));
  CHECK(contains(text.out, "(interpolated; no longer exceeded at"));
  CHECK_FALSE(contains(text.out, "taken as closed"));
  const auto refused = drev_command(
      {"class", DREV_SOURCE_DIR "/models/engine/engine.toml", "--speeds", "900", "--cycle", "1"});
  CHECK(refused.exit_code == 2);
}

TEST_CASE("A limit of heat where only a run in time answers is not decided: text, JSON and report say so",
          "[class][once]") {
  const drev::test::TemporaryFolder folder;
  std::ofstream(folder / "pair.toml") << kPairWithMachine
                                      << "[class.sections]\n"
                                         "shaft = { permissible_torque_Nm = 1e6, permissible_heat_W = 50 }\n";
  const std::string report = (folder / "pair.html").string();
  // No motion that is found at 2000 rpm is stable, one at 2100 rpm is.
  const std::vector<std::string> words{"class",    (folder / "pair.toml").string(),
                                       "--speeds", "2000:100:2100",
                                       "--set",    "torque_Nm=30",
                                       "--report", report};
  const nlohmann::json judged = class_json_of(words);
  const nlohmann::json& one = judged.at("cases")[0];
  CHECK(one.at("accepted").is_null());
  const nlohmann::json& s = one.at("sections")[0];
  CHECK(s.at("heat_W").get<double>() > 0.0);
  CHECK(s.at("heat_exceeds").is_null());
  REQUIRE(s.at("heat_unknown_rpm").size() == 1);
  CHECK(s.at("heat_unknown_rpm")[0].get<double>() == Approx(2000.0));
  REQUIRE(one.at("undecided").size() == 1);
  const std::string why = one.at("undecided")[0];
  CHECK(contains(why, "shaft.torque_Nm: permissible heat of 50.00 W not judged at 1 of 2 speeds, 2000 rpm"));
  CHECK(one.at("not_judged") == nlohmann::json{"mesh.force_N"});
  const auto text = drev_command(words);
  CHECK(contains(text.out, "Normal firing: NOT DECIDED"));
  CHECK(contains(text.out, "permissible heat of 50.00 W not judged at 1 of 2 speeds, 2000 rpm"));
  CHECK(contains(text.out, "permissible torque, heat not judged"));
  CHECK_FALSE(contains(text.out, "within all limits"));
  CHECK(page_of(report).at("class") == judged);
  CHECK(contains(read_file(report), "not decided: limits that are given could not be judged"));
}

namespace {

/// Two discs on a shaft, with a limit of torque and of heat, written to folder / name.
std::string two_discs(const drev::test::TemporaryFolder& folder, const char* name, const char* damping,
                      const char* limits) {
  std::ofstream(folder / name)
      << "format = 1\n[nodes]\na = { nominal_speed_rpm = 600 }\nb = {}\n[elements]\n"
         "J_a = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 2 }\n"
         "J_b = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 3 }\n"
         "s = { type = \"shaft_spring\", nodes = [\"a\", \"b\"], stiffness_Nm_per_rad = 10000"
      << damping
      << " }\ng = { type = \"engine_order_torque\", node = \"a\", mean_Nm = 100, harmonics = { order = [1, "
         "2, 3], "
         "amplitude_Nm = [50, 40, 30], phase_deg = [10, 50, 100] }, twist_feedback = false }\n"
         "l = { type = \"engine_order_torque\", node = \"b\", mean_Nm = -100 }\n"
         "[class]\nrated_speed_rpm = 2000\n[class.sections]\ns = { "
      << limits << " }\n";
  return (folder / name).string();
}

}  // namespace

TEST_CASE("A judgement says that the train is unstable, and what is not known of its criticals", "[class]") {
  const drev::test::TemporaryFolder folder;
  const std::string page = (folder / "page.html").string();
  const std::string file = two_discs(folder, "grows.toml", "", "permissible_torque_Nm = 1e6");
  std::ofstream(file, std::ios::app)
      << "[elements.soft]\ntype = \"elastic_coupling\"\nnodes = [\"a\", \"b\"]\nlowest_frequency_Hz = 5\n"
         "highest_frequency_Hz = 50\nby_amplitude = { amplitude_rad = [0, 0.1], "
         "stiffness_Nm_per_rad = [10, 9], loss_factor = [0.1, 0.1] }\n"
         "[elements.drive]\ntype = \"torque_function\"\nnode = \"a\"\nexpression = \"speed_rad_per_s\"\n";
  const std::vector<std::string> words{"class", file, "--speeds", "1200:50:1500", "--report", page};
  const nlohmann::json one = class_json_of(words)["cases"][0];
  CHECK(one.at("accepted").is_null());
  CHECK(contains(drev_command(words).out, "NOT DECIDED"));
  CHECK(contains(one.at("undecided")[0], "the train is unstable (a mode at 14.5"));
  CHECK(contains(one.at("notes").dump(),
                 "Criticals: modes, and where orders meet them, have the stiffness of soft"));
  const nlohmann::json shown = page_of(page);
  CHECK(shown.at("class")["cases"][0] == one);
  CHECK(shown.at("notes") == one.at("notes"));
}

TEST_CASE("A coarse grid gives the verdict of a fine one: heat at its peak", "[class]") {
  const drev::test::TemporaryFolder folder;
  const std::string file = two_discs(folder, "two.toml", ", damping_Nms_per_rad = 5",
                                     "permissible_torque_Nm = 3000, permissible_heat_W = 50");
  // Of mu x'' + c x' + k x = mu/J_a p by a separate program: 90.06277 W at 871.7270 rpm; 30.5 W at the grid's speeds.
  const nlohmann::json judged = class_json_of({"class", file, "--speeds", "300:100:1500"});
  const nlohmann::json& s = judged["cases"][0]["sections"][0];
  CHECK(s.at("heat_W").get<double>() == Approx(90.06277346).epsilon(1e-8));
  CHECK(s.at("heat_at_rpm").get<double>() == Approx(871.7270173).epsilon(1e-6));
  CHECK(s.at("heat_exceeds") == true);
  CHECK(judged["cases"][0].at("accepted") == false);
  const auto text = drev_command({"class", file, "--speeds", "300:100:1500"});
  for (const char* part : {"90.06 of 50.00", "LIMITS EXCEEDED", "permissible torque, permissible heat"})
    CHECK(contains(text.out, part));
  const auto sweep = drev_command({"sweep", file, "--speeds", "300:100:1500"});
  for (const char* part : {"0.0655420 rad", "90.0628"}) CHECK(contains(sweep.out, part));
}

TEST_CASE("Ranges end where the torque crosses the limit, whatever the grid", "[class]") {
  const drev::test::TemporaryFolder folder;
  const std::string file =
      two_discs(folder, "ends.toml", ", damping_Nms_per_rad = 5", "permissible_torque_Nm = 300");
  // Of mu x'' + c x' + k x = mu/J_a p by a separate program; straight lines through the coarse grid give 412 to 472 rpm and
  // 817 to 926 rpm.
  const double ends[][2] = {{419.019369587, 451.653470304}, {831.053086659, 909.628659970}};
  for (const char* grid : {"300:100:1500", "410:3:1000"}) {
    const nlohmann::json judged = class_json_of({"class", file, "--speeds", grid});
    const nlohmann::json& exceeded = judged["cases"][0]["sections"][0].at("exceeded");
    REQUIRE(exceeded.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(exceeded[i].at("from_rpm").get<double>() == Approx(ends[i][0]).epsilon(1e-6));
      CHECK(exceeded[i].at("to_rpm").get<double>() == Approx(ends[i][1]).epsilon(1e-6));
      CHECK(exceeded[i].at("kept_below_rpm").get<double>() == Approx(ends[i][0]).epsilon(1e-6));
      CHECK(exceeded[i].at("kept_above_rpm").get<double>() == Approx(ends[i][1]).epsilon(1e-6));
    }
  }
  const auto text = drev_command({"class", file, "--speeds", "300:100:1500"});
  for (const char* part : {"from 419.02 to 451.65 rpm,", "from 831.05 to 909.63 rpm,"})
    CHECK(contains(text.out, part));
}

TEST_CASE("An undamped resonance between two speeds is unbounded, and exceeds any limit", "[class]") {
  const drev::test::TemporaryFolder folder;
  const std::string file = two_discs(folder, "free.toml", "", "permissible_torque_Nm = 300");
  const nlohmann::json judged = class_json_of({"class", file, "--speeds", "300:100:1500"});
  const nlohmann::json& s = judged["cases"][0]["sections"][0];
  CHECK(s.at("unbounded") == true);
  CHECK(s.at("utilisation").is_null());
  // Where order 2 meets the mode, sqrt(k / mu) / 2 = 435.864 rpm. Half ranges of the closed form, by a separate program,
  // exceed 300 N m from 417.14906 to 454.05263 rpm.
  const auto range = std::find_if(
      s.at("exceeded").begin(), s.at("exceeded").end(),
      [](const nlohmann::json& r) { return std::abs(r.at("worst_rpm").get<double>() - 435.8637623) < 1e-5; });
  REQUIRE(range != s.at("exceeded").end());
  CHECK(range->at("worst").is_null());
  CHECK(range->at("from_rpm").get<double>() == Approx(417.1490635).epsilon(1e-6));
  CHECK(range->at("to_rpm").get<double>() == Approx(454.0526330).epsilon(1e-6));
  CHECK(range->at("passing") == "no transient limit given");
  CHECK(range->at("may_be_passed") == false);
  const auto text = drev_command({"class", file, "--speeds", "300:100:1500"});
  CHECK(contains(text.out, "unbounded at 435.86 rpm"));
  CHECK(contains(text.out, "no limit for passing is"));
  CHECK_FALSE(contains(text.out, "must not be passed"));
  const auto sweep = drev_command({"sweep", file, "--speeds", "300:100:1500"});
  CHECK(contains(sweep.out, "unbounded rad"));
  CHECK_FALSE(contains(drev_command({"sweep", file, "--speeds", "300:100:1500", "--json"}).out, "-0.0,"));
}

TEST_CASE("The stress beside a limit is of its kind, a section judged by heat alone is judged", "[class]") {
  const drev::test::TemporaryFolder folder;
  const std::string file =
      two_discs(folder, "rule.toml", ", damping_Nms_per_rad = 5",
                "diameter_mm = 50, stress_concentration = 2, tensile_strength_MPa = 600, "
                "shape_factor = 1");
  const nlohmann::json judged = class_json_of({"class", file, "--speeds", "300:100:1500"});
  const nlohmann::json& s = judged["cases"][0]["sections"][0];
  const double nominal = s.at("worst_half_range_Nm").get<double>() / drev::polar_section_modulus(0.05);
  CHECK(s.at("stress_of_rule") == "nominal");
  CHECK(s.at("worst_nominal_stress_Pa").get<double>() == Approx(nominal));
  CHECK(s.at("worst_stress_Pa").get<double>() == Approx(2.0 * nominal));
  CHECK(contains(drev_command({"class", file, "--speeds", "300:100:1500"}).out, " nominal "));
  const std::string hot =
      two_discs(folder, "hot.toml", ", damping_Nms_per_rad = 5", "permissible_heat_W = 100");
  const auto text = drev_command({"class", hot, "--speeds", "300:100:1500"});
  CHECK(contains(text.out, "torque not judged, permissible heat"));
  CHECK_FALSE(contains(text.out, "Without a limit, not judged"));
}

TEST_CASE("A model without [class] is told what it lacks", "[class]") {
  const auto refused =
      drev_command({"class", DREV_SOURCE_DIR "/models/engine/engine.toml", "--speeds", "900"});
  CHECK(refused.exit_code == 2);
  CHECK(contains(refused.err, "[class]"));
}

TEST_CASE("Faults of [class] are told of all at once, at the file and key that they are of", "[class]") {
  const drev::test::TemporaryFolder folder;
  std::ofstream(folder / "mine.toml")
      << "format = 1\ninclude = [\"" << kGensetFile << "\"]\n[class]\nrated_speed_rpm = -3\n"
      << "misfire = { cylinder_1 = 0 }\n[class.sections]\nflange = { diameter_mm = -5 }\n";
  const auto refused = drev_command(with_genset_speeds({"class", (folder / "mine.toml").string()}));
  CHECK(refused.exit_code == 2);
  for (const char* part :
       {"mine.toml:4:1: class: rated_speed = -3 rpm", "mine.toml:5:13: class.misfire.cylinder_1",
        "mine.toml:7:12: class.sections.flange: diameter = -0.005 m"})
    CHECK(contains(refused.err, part));
}

TEST_CASE("drev report --class writes what drev class --report does", "[class]") {
  const drev::test::TemporaryFolder folder;
  const auto judged_by = [&](std::vector<std::string> words, const char* name) {
    const auto outcome = drev_command(with_genset_speeds(std::move(words)));
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    return page_of(folder / name).at("class");
  };
  const nlohmann::json by_class =
      judged_by({"class", kGensetFile, "--report", (folder / "a.html").string()}, "a.html");
  CHECK(judged_by({"report", "--class", kGensetFile, "--out", (folder / "b.html").string()}, "b.html") ==
        by_class);
  CHECK(judged_by({"report", kGensetFile, "--class", "--out=" + (folder / "c.html").string()}, "c.html") ==
        by_class);
}

TEST_CASE("A run counts load cycles of sections with an S-N line and of channels asked for",
          "[class][once]") {
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
  const drev::test::TemporaryFolder folder;
  // '*' stands for anything, in what is counted as in what is recorded.
  const auto patterns =
      drev_command({"run", kGensetFile, "--duration", "0.02", "--json", "--rainflow", "coupl*.torque_Nm",
                    "--record", "coupl*.torque_Nm,ring.angle_rad", "--out", (folder / "p").string()});
  INFO(patterns.err);
  CHECK(contains(patterns.out, "coupling.torque_Nm"));
  const std::string history = read_file(folder / "p/history.csv");
  CHECK(history.substr(0, history.find('\n')) == "time_s,coupling.torque_Nm,ring.angle_rad");
  CHECK(drev_command({"run", kGensetFile, "--duration", "-1"}).exit_code == 2);
}

TEST_CASE("Faults of [class] have one unit on both sides, and a [class] without sections is no missing one",
          "[class]") {
  const drev::test::TemporaryFolder folder;
  const auto said =
      [&](const std::string& sections) {
        std::ofstream(folder / "t.toml")
            << "format = 1\n[nodes]\na = { nominal_speed_rpm = 600 }\nb = {}\n[elements]\n"
               "Ja = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 2 }\n"
               "Jb = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 3 }\n"
               "s = { type = \"shaft_spring\", nodes = [\"a\", \"b\"], stiffness_Nm_per_rad = 10000 }\n"
               "[class]\nrated_speed_rpm = 600\n"
            << sections;
        const auto outcome = drev_command({"class", (folder / "t.toml").string(), "--speeds", "500"});
        CHECK(outcome.exit_code == 2);
        return outcome.err;
      };
  CHECK(contains(said(""), "[class], names no section"));
  const std::string faults =
      said("[class.sections]\ns = { diameter_mm = -72, tensile_strength_MPa = 300, shape_factor = 1 }\n");
  CHECK(contains(faults, "= -0.072 m"));
  CHECK(contains(faults, "= 300 MPa, must be from 400 to 800 MPa"));
}

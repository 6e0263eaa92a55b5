// drev campbell with orders whose sum has no cycle.
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using drev::test::read_file;

TEST_CASE("A Campbell diagram takes orders without a common cycle: criticals by the closed form",
          "[campbell]") {
  const drev::test::TemporaryFolder folder;
  std::ofstream(folder / "two.toml")
      << "format = 1\n[nodes]\na = { nominal_speed_rpm = 600 }\nb = {}\n[elements]\n"
         "J_a = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 2 }\n"
         "J_b = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 3 }\n"
         "s = { type = \"shaft_spring\", nodes = [\"a\", \"b\"], stiffness_Nm_per_rad = 10000, "
         "damping_Nms_per_rad = 20 }\n"
         "g = { type = \"engine_order_torque\", node = \"a\", mean_Nm = 100, harmonics = { order = [1, "
         "1.4142135623730951, 2.718281828459045], amplitude_Nm = [50, 40, 30] }, twist_feedback = false }\n"
         "l = { type = \"engine_order_torque\", node = \"b\", mean_Nm = -100 }\n";
  const std::string file = (folder / "two.toml").string(), report = (folder / "two.html").string();
  const std::string orders = "1,1.4142135623730951,2.718281828459045";
  const auto printed = drev_command({"campbell", file, "--speeds", "300:100:1500", "--orders", orders,
                                     "--json", "--report", report, "--out", (folder / "out").string()});
  INFO(printed.err);
  REQUIRE(printed.exit_code == 0);
  const auto criticals = nlohmann::json::parse(printed.out).at("criticals");
  REQUIRE(criticals.size() == 3);
  // Largest transmissibility of k + i c w: (w/w_0)^2 = (sqrt(1 + 8 zeta^2) - 1) / (4 zeta^2).
  const double mu = 1.2, k = 1e4, natural = std::sqrt(k / mu), zeta = 20.0 / (2.0 * std::sqrt(k * mu));
  const double square = (std::sqrt(1.0 + 8.0 * zeta * zeta) - 1.0) / (4.0 * zeta * zeta);
  const double damped = 4.0 * zeta * zeta * square;
  const double highest = std::sqrt((1.0 + damped) / (std::pow(1.0 - square, 2) + damped));
  const double of[][2] = {{2.718281828459045, 30.0}, {1.4142135623730951, 40.0}, {1.0, 50.0}};  // by speed
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(criticals[i].at("order") == of[i][0]);
    CHECK(criticals[i].at("speed_rpm").get<double>() ==
          Approx(std::sqrt(square) * natural / of[i][0] * 30.0 / std::acos(-1.0)).epsilon(1e-6));
    CHECK(criticals[i].at("amplitude").get<double>() == Approx(mu / 2.0 * of[i][1] * highest).epsilon(1e-9));
    CHECK(criticals[i].at("half_range").is_null());  // of a sum that has no cycle
  }
  CHECK_FALSE(contains(read_file(folder / "out/criticals.csv"), "nan"));
  CHECK(contains(read_file(report), "The orders have no common cycle"));
  // A sweep sums the orders over their cycle, and still needs one.
  const auto sweep = drev_command({"sweep", file, "--speeds", "300:100:1500", "--orders", orders});
  CHECK(sweep.exit_code == 2);
  CHECK(contains(sweep.err, "no common cycle"));
}

TEST_CASE("A mode that is overdamped at some speeds is listed, with a frequency where it swings",
          "[campbell]") {
  // k = 1000 N m/rad, J = 1 kg m2: 63.2 N m s/rad are critical, the curve has 95 below 350 rpm, or 109 above 650 rpm: both sides of
  // its kink are among the speeds of the modes.
  const drev::test::TemporaryFolder folder;
  const std::string file = (folder / "disc.toml").string(), out = (folder / "out").string();
  for (const bool first : {true, false}) {
    std::ofstream(file)
        << "format = 1\n[nodes]\na = { constant_speed_rpm = 200 }\nb = {}\n[elements]\n"
           "J = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 1 }\n"
           "s = { type = \"shaft_spring\", nodes = [\"a\", \"b\"], stiffness_Nm_per_rad = 1000 }\n"
           "p = { type = \"torque_curve\", node = \"b\", curve = { speed_rpm = "
        << (first ? "[0, 350, 1000], torque_Nm = [0, -3500, -3501]"
                  : "[0, 650, 1000], torque_Nm = [0, -1, -4000]")
        << " } }\n";
    const auto printed =
        drev_command({"campbell", file, "--speeds", "100:100:900", "--orders", "9", "--out", out});
    INFO(printed.err << printed.out);
    REQUIRE(printed.exit_code == 0);
    CHECK(contains(printed.out, first ? "350 .. 900" : "100 .. 650"));
    const auto object = nlohmann::json::parse(read_file(out + "/summary.json"));
    REQUIRE(object.at("modes").size() == 1);
    const auto &frequency = object["modes"][0]["frequency_Hz"], &ratio = object["modes"][0]["damping_ratio"];
    CHECK(frequency[first ? 0 : 8].is_null());
    CHECK(ratio[first ? 0 : 8].is_null());
    CHECK(frequency[first ? 8 : 0].get<double>() == Approx(std::sqrt(1000.0) / (2.0 * std::acos(-1.0))));
    CHECK(ratio[first ? 8 : 0].get<double>() < 1e-3);
    CHECK(contains(read_file(out + "/modes.csv"), ",,\n"));
  }
}

TEST_CASE("Criticals say that a coupling has another stiffness in them than in the amplitudes",
          "[campbell]") {
  const drev::test::TemporaryFolder folder;
  const std::string file = (folder / "coupling.toml").string();
  for (const bool follows : {true, false}) {
    std::ofstream(file)
        << "format = 1\n[nodes]\na = { constant_speed_rpm = 600 }\nb = {}\n[elements]\n"
           "J = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 1 }\n"
           "rubber = { type = \"elastic_coupling\", nodes = [\"a\", \"b\"], by_amplitude = { "
        << (follows ? "amplitude_rad = [0, 1], stiffness_Nm_per_rad = [1000, 2000], loss_factor = [0, 0]"
                    : "amplitude_rad = [0], stiffness_Nm_per_rad = [1000], loss_factor = [0]")
        << " } }\ne = { type = \"engine_order_torque\", node = \"b\", mean_Nm = 250, harmonics = { "
           "order = [1], amplitude_Nm = [1] } }\n";
    for (const char* command : {"campbell", "sweep"}) {
      const auto text = drev_command({command, file, "--speeds", "100:100:900"}),
                 json = drev_command({command, file, "--speeds", "100:100:900", "--json"});
      INFO(text.err << text.out << json.out);
      REQUIRE(json.exit_code == 0);
      CHECK(contains(text.out, "stiffness of rubber at its at_amplitude") == follows);
      CHECK(nlohmann::json::parse(json.out).at("criticals_note").is_null() != follows);
    }
  }
}

TEST_CASE("Campbell has the stiffness of a coupling under the mean torque, which a node can take up",
          "[campbell]") {
  const drev::test::TemporaryFolder folder;
  const std::string file = (folder / "free.toml").string();
  std::ofstream(file)
      << "format = 1\n[nodes]\na = { nominal_speed_rpm = 600 }\nb = {}\n[elements]\n"
         "J_a = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 2 }\n"
         "J_b = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 2 }\n"
         "rubber = { type = \"elastic_coupling\", nodes = [\"a\", \"b\"], by_mean_torque = { mean_torque_Nm "
         "= "
         "[0, 400], stiffness_Nm_per_rad = [1000, 5000], loss_factor = [0, 0] } }\n"
         "e = { type = \"engine_order_torque\", node = \"b\", mean_Nm = 200, harmonics = { order = [1], "
         "amplitude_Nm = [1] } }\n";
  // Left over, the mean torque speeds the train up: half of it goes through the coupling.
  for (const bool balanced : {false, true}) {
    std::vector<std::string> words{"campbell", file, "--speeds", "100:100:900", "--json"};
    if (balanced) words.insert(words.end(), {"--balance", "a"});
    const auto run = drev_command(words);
    INFO(run.err);
    REQUIRE(run.exit_code == 0);
    const auto found = nlohmann::json::parse(run.out);
    CHECK(found["modes"][0]["frequency_Hz"][0].get<double>() ==
          Approx(std::sqrt(balanced ? 3000.0 : 2000.0) / (2.0 * std::acos(-1.0))).epsilon(1e-10));
    CHECK(contains(found["criticals_note"].get<std::string>(),
                   balanced ? "taken up at a" : "Couplings whose stiffness follows the mean torque"));
  }
}

// What a run states of its sections' limits.
#include <drev/solvers/strength/section_strength.hpp>

#include <fstream>
#include <nlohmann/json.hpp>

#include "solvers/strength/iacs_m68.hpp"
#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

TEST_CASE("The limit of a section in a run-up is that of the speed at which it carries most") {
  const drev::test::TemporaryFolder folder;
  const std::string file = (folder / "ramp.toml").string();
  // Constant acceleration: the torque is -J alpha (1 - cos w t), w = pi/0.4 s: least at 0.4 s, at 0.4 of the rated speed.
  std::ofstream(file) << R"(
format = 1
[nodes]
motor = { hold = true, run_up = { speed_0_rpm = 0, speed_1_rpm = 100, time_0_s = 0, time_1_s = 1 } }
disc = {}
[elements]
J = { type = "inertia", node = "disc", inertia_kg_m2 = 1 }
shaft = { type = "shaft_spring", nodes = ["motor", "disc"], stiffness_Nm_per_rad = "pi^2/0.16" }
[run]
duration_s = 0.5
[class]
rated_speed_rpm = 100
[class.sections]
shaft = { diameter_mm = 50, tensile_strength_MPa = 600, shape_factor = 0.6 }
)";
  const auto outcome = drev::test::drev_command({"run", file, "--json"});
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  const nlohmann::json section = nlohmann::json::parse(outcome.out).at("results").at("sections")[0];
  CHECK(section.at("permissible").get<double>() ==
        Approx(drev::iacs_m68::permissible_stress(600e6, 0.6, 0.05, 0.4).continuous *
               drev::polar_section_modulus(0.05, 0.0))
            .epsilon(1e-6));
}

// The twelve published cases, written as model files (cases/*.toml), give the published numbers. Tolerances
// are half a unit of the last digit printed, or say why not.
#include <drev/app/model_file/model_file.hpp>
#include <drev/core/channel.hpp>
#include <drev/elements/gear_mesh.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/problems/backlash_oscillator.hpp"

using namespace drev;

namespace {

ModelCase scene_of(const std::string& name,
                   const std::vector<std::pair<std::string, std::string>>& set = {}) {
  const app::ModelFile file(std::string(DREV_SOURCE_DIR "/tests/published/cases/") + name + ".toml", "");
  Parameters parameters(file.entry().name, file.entry().parameters);
  for (const auto& [key, value] : set) parameters.set(key, value);
  return file.entry().build(parameters);
}

void check_modes(const std::string& name, const std::vector<double>& hertz, double tolerance,
                 const std::vector<std::pair<std::string, std::string>>& set = {}) {
  const ModeSet modes = solve_modes(scene_of(name, set).model.build());
  INFO(name);
  CHECK(modes.rigid_modes == 1);
  REQUIRE(modes.frequency_Hz.size() >= hertz.size());
  for (std::size_t i = 0; i < hertz.size(); ++i)
    CHECK(std::abs(modes.frequency_Hz[i] - hertz[i]) <= tolerance);
}

double contact_ratio(const ModelCase& model_case, const std::string& mesh) {
  for (const ElementInstance& placement : model_case.model.element_instances())
    if (placement.name == mesh)
      return std::get<MeshStiffness::Step>(
                 dynamic_cast<const GearMesh&>(*placement.element).params().stiffness.law())
          .contact_ratio;
  return 0.0;
}

/// What the file records, at multiples of `every`.
std::vector<std::vector<double>> recorded(const ModelCase& model_case, double every, double t_end) {
  const System system = model_case.model.build();
  Recorder recorder(system, model_case.channels, every);
  CHECK(propagate(system, {.tolerance = 1e-13, .t_end = t_end}, {&recorder}).ok());
  std::vector<std::vector<double>> all;
  for (std::size_t c = 0; c < model_case.channels.size(); ++c) all.push_back(recorder.samples(c));
  return all;
}

}  // namespace

TEST_CASE("Files of cases 1 to 6 and 12: modes") {
  check_modes("01_two_discs", {176.0767}, 0.5e-4);
  check_modes("02_geared_pair", {425.3595, 634.0728, 3247.1924}, 0.5e-4);
  check_modes("03_five_discs", {81.2076, 141.2141, 378.9530, 536.3633}, 0.5e-4);
  check_modes("04_branched_geared", {10.30419, 20.47926, 24.42292}, 0.5e-5);
  check_modes("05_drill_string", {1.9106, 3.8232, 5.7394, 7.6613}, 0.5e-4);
  check_modes("05_drill_string", {1.9417, 4.0719, 6.5437, 9.1547}, 0.5e-4, {{"segments", "5"}});
  check_modes("05_drill_string", {1.9225, 3.9187, 6.0625, 8.4185}, 0.5e-4, {{"segments", "8"}});
  const ModeSet windmill = solve_modes(scene_of("06_windmill").model.build());
  CHECK(std::abs(windmill.omega(0) - 58.3402) <= 0.5e-4);
  CHECK(std::abs(windmill.omega(1) - 1034.1147) <= 0.5e-4);
  // The discs' inertia is given to 6 digits, which moves the frequency by 9e-5 Hz.
  check_modes("12_two_disc_rotor", {123.24158}, 1e-4);
}

TEST_CASE("File of case 7: backlash with a damper that never pulls") {
  const ModelCase model_case = scene_of("07_backlash_limited_damper");
  const auto samples = recorded(model_case, 0.05, model_case.duration);
  for (const auto& e : kCase7) {
    const auto i = static_cast<std::size_t>(std::lround(e[0] / 0.05));
    CHECK(samples[0][i] == Approx(e[1]).margin(2e-10));
    CHECK(samples[1][i] == Approx(e[2]).margin(1e-7));
  }
  const auto without = recorded(scene_of("07_backlash_limited_damper", {{"gap", "0"}}), 0.1, 0.1);
  CHECK(without[0][1] == Approx(0.9541444033).margin(1e-10));
  CHECK(without[1][1] == Approx(-1.3039986217).margin(1e-10));
}

TEST_CASE("File of case 8: after a whole number of periods, in closed form, the disc is where it was") {
  const ModelCase model_case = scene_of("08_symmetric_gap");
  const double period = 0.1204277338;
  const auto samples = recorded(model_case, period, 4 * period);
  // At a turning point an error of the time, 4 x 5e-11 s, enters squared.
  for (std::size_t i = 0; i <= 4; ++i) CHECK(samples[0][i] == Approx(std::acos(-1.0) / 2).margin(1e-12));
}

TEST_CASE("File of case 9: ideal gear, forced") {
  const ModelCase model_case = scene_of("09_ideal_gear");
  const auto samples = recorded(model_case, 0.5, model_case.duration);
  CHECK(samples[0][1] == Approx(0.0681818).margin(0.5e-7));
  CHECK(samples[1][1] == Approx(0.2727273).margin(0.5e-7));
  // The gear turns 100 kg m^2 at -0.0545454545 rad/s^2.
  CHECK(samples[2][1] == Approx(-5.45454545).margin(1e-8));
}

TEST_CASE("File of case 10: damped modes") {
  const DampedModeSet set = solve_damped_modes(scene_of("10_damped_oscillator").model.build());
  REQUIRE(set.modes.size() == 1);
  CHECK(std::abs(set.modes[0].lambda - std::complex<double>(-2.5, 49.93746089)) < 0.5e-8);
}

TEST_CASE("File of case 11: involute contact ratios") {
  const ModelCase model_case = scene_of("11_contact_ratio");
  CHECK(contact_ratio(model_case, "first") == Approx(1.6377334309511222).epsilon(1e-12));
  CHECK(contact_ratio(model_case, "second") == Approx(1.7897798668).epsilon(1e-10));
}

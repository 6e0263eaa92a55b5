// models/marine_two_stroke and models/wind_turbine: what their pages say, beside published numbers and closed forms.
#include <drev/app/model_file/model_file.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

namespace {

ModelCase plant(const std::string& name, const std::vector<std::pair<std::string, std::string>>& set = {}) {
  const app::ModelFile file(DREV_SOURCE_DIR "/models/" + name + "/" + name + ".toml", "");
  Parameters parameters(file.entry().name, file.entry().parameters);
  for (const auto& [key, value] : set) parameters.set(key, value);
  return file.entry().build(parameters);
}

}  // namespace

TEST_CASE("The marine plant: printed frequencies, the propeller's damping, the fifth order's critical") {
  const System system = plant("marine_two_stroke").model.build();
  const ModeSet modes = solve_modes(system, {.count = 3});
  CHECK(60.0 * modes.frequency_Hz[0] == Approx(330.079056).epsilon(2e-9));
  CHECK(60.0 * modes.frequency_Hz[1] == Approx(502.104797).epsilon(2e-9));
  CHECK(60.0 * modes.frequency_Hz[2] == Approx(1872.20).epsilon(2e-5));
  CHECK(load_damping(system, rpm(66.0)).minCoeff() >= 0.0);
  std::vector<double> speeds;
  for (double n = 62.0; n <= 71.0; n += 1.0) speeds.push_back(rpm(n));
  const LinearSweep sweep = sweep_linear(system, {.speeds = speeds, .orders = {5.0}, .threads = 1});
  bool found = false;
  for (const SweepPeak& peak : sweep.peaks)
    if (sweep.sections[std::size_t(peak.section)].name == "shaft_9.torque_Nm") {
      // Damped and with the propeller, 0.9 % above 330.079/5 = 66.016 rpm of the train alone.
      CHECK(to_rpm(peak.speed) == Approx(66.016).epsilon(0.012));
      found = true;
    }
  CHECK(found);
  // A misfire brings up the low orders.
  const auto first_order = [&](const char* misfire) {
    const System other = plant("marine_two_stroke", {{"misfire", misfire}}).model.build();
    const LinearSweep at = sweep_linear(
        other, {.speeds = {rpm(99.0)}, .orders = {1.0}, .sections = {"shaft_9.torque_Nm"}, .refine = false});
    return at.sections[0].half_range()[0];
  };
  CHECK(first_order("3") > 5.0 * first_order("0"));
}

TEST_CASE("The wind turbine: ratio, first mode, planets against each other, shared load") {
  const System system = plant("wind_turbine").model.build();
  const double i_1 = 1.0 + 56.0 / 19.0, i_2 = 1.0 + 93.0 / 18.0, i_3 = 95.0 / 24.0, ratio = i_1 * i_2 * i_3;
  CHECK(ratio == Approx(96.354).epsilon(1e-5));  // published
  CHECK(system.ratio(system.node("generator")) / system.ratio(system.node("rotor")) ==
        Approx(ratio).epsilon(1e-12));
  const ModeSet modes = solve_modes(system, {.count = 6});
  // Two inertias and all springs between them in series, seen from the rotor. Each planet's two meshes are in series along
  // the line of action and drive the carrier by the sun's and the ring's base radii together.
  const double cosine = std::cos(deg(20)), r_sun = 0.5 * 0.045 * 19 * cosine;
  const double mesh = 3.0 * 9e9 / 2.0 * std::pow(i_1 * r_sun, 2);
  const double compliance =
      1.0 / 867637000.0 + 1.0 / mesh + 1.0 / (400e6 * i_1 * i_1) + 1.0 / (60e6 * ratio * ratio);
  const double driven = 9500 + 202 * i_1 * i_1 + 2900 * i_1 * i_1 + 880 * std::pow(i_1 * i_2, 2) +
                        (3.5 + 534.116) * ratio * ratio + 3.0 * 130.0 * std::pow((56.0 - 17.0) / 17.0, 2);
  const double first = std::sqrt((1.0 / 57231535.0 + 1.0 / driven) / compliance) / kTwoPi;
  CHECK(modes.frequency_Hz[0] == Approx(first).epsilon(5e-3));
  const double r_planet = 0.5 * 0.045 * 17 * cosine;
  const double planets = std::sqrt(2.0 * 9e9 * r_planet * r_planet / 130.0) / kTwoPi;
  CHECK(modes.frequency_Hz[4] == Approx(planets).epsilon(1e-9));
  CHECK(modes.frequency_Hz[5] == Approx(planets).epsilon(1e-9));
  // The mean of a mesh's force over two periods of the first mode: a third of what the generator takes, but for what
  // speeds it up.
  const double window = 2.0 / modes.frequency_Hz[0], end = 2.0;
  Recorder recorder(
      system,
      {"sun_mesh_1.force_N", "sun_mesh_2.force_N", "sun_mesh_3.force_N", "generator_torque.torque_Nm"},
      window / 64.0);
  CHECK(propagate(system, {.tolerance = 1e-6, .t_end = end}, {&recorder}).ok());
  const std::vector<double>& force = recorder.samples(0);
  double mean = 0.0, taken = 0.0;
  for (std::size_t i = force.size() - 64; i < force.size(); ++i) {
    mean += force[i] / 64.0;
    taken += recorder.samples(3)[i] / 64.0;
  }
  CHECK(std::abs(mean) == Approx(std::abs(taken) * i_2 * i_3 / (3.0 * r_sun)).epsilon(0.05));
  for (const std::size_t other : {1U, 2U})
    CHECK(recorder.samples(other).back() == Approx(force.back()).epsilon(1e-9));
}

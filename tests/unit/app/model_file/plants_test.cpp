// models/genset, models/marine_two_stroke, models/wind_turbine and models/engine/varying_inertia.toml: what their pages say,
// beside published numbers, closed forms and other programs.
#include <drev/app/model_file/model_file.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using namespace drev;

namespace {

ModelCase plant(const std::string& name, const std::vector<std::pair<std::string, std::string>>& set = {}) {
  const app::ModelFile file(DREV_SOURCE_DIR "/models/" + name + "/" + name + ".toml", "");
  Parameters parameters(file.entry().name, file.entry().parameters);
  for (const auto& [key, value] : set) parameters.set(key, value);
  return file.entry().build(parameters);
}

}  // namespace

TEST_CASE("The genset: frequencies and half ranges of openTorsion's matrices") {
  const System system = plant("genset").model.build();
  // openTorsion 0.3.2, its undamped_modal_analysis() and its M, K, C solved with NumPy (models/genset/README.md).
  const std::vector<double> hertz{17.5792551, 130.468379, 314.097432, 708.449931, 981.412271,
                                  999.951921, 1274.95406, 1483.29288, 4072.26358};
  const ModeSet modes = solve_modes(system, {.count = 9});
  for (std::size_t i = 0; i < hertz.size(); ++i)
    CHECK(modes.frequency_Hz[i] == Approx(hertz[i]).epsilon(1e-8));
  const LinearSweep sweep =
      sweep_linear(system, {.speeds = {rpm(1500.0)}, .close_contacts = true, .refine = false, .threads = 1});
  const double base_radius = 0.5 * 0.0025 * 28 * std::cos(deg(20));
  for (const auto& [name, half_range] : {std::pair{"coupling.torque_Nm", 190.2086469529575},
                                         {"flange.torque_Nm", 2642.710342790223},
                                         {"crank_3.torque_Nm", 2722.368749221346},
                                         {"damper.torque_Nm", 592.2848044498814},
                                         {"timing.force_N", 42.27541326262275 / base_radius}}) {
    INFO(name);
    bool found = false;
    for (const SweepSection& section : sweep.sections)
      if (section.name == name) {
        // The other sum's 20,000 points miss a maximum by 1e-6 at most.
        CHECK(section.half_range()[0] == Approx(half_range).epsilon(2e-6));
        found = true;
      }
    CHECK(found);
  }
}

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
  // The definition of the turbine, rotor and generator by ratio 97 on its equivalent drive shaft: 43,784,725 kg m2 in all,
  // damped by 5 % of the critical damping.
  const double seen = 97.0 * 97.0 * 534.116, reduced = 38759228.0 * seen / (38759228.0 + seen);
  CHECK(38759228.0 + seen == Approx(43784725.0).epsilon(1e-7));
  CHECK(6215000.0 / (2.0 * std::sqrt(867637000.0 * reduced)) == Approx(0.05).epsilon(2e-3));
  const ModeSet modes = solve_modes(system, {.count = 6});
  // Two inertias and all springs between them in series, seen from the rotor. Each planet's two meshes are in series along
  // the line of action and drive the carrier by the sun's and the ring's base radii together.
  const double cosine = std::cos(deg(20)), r_sun = 0.5 * 0.045 * 19 * cosine;
  const double mesh = 3.0 * 9e9 / 2.0 * std::pow(i_1 * r_sun, 2);
  const double compliance =
      1.0 / 867637000.0 + 1.0 / mesh + 1.0 / (400e6 * i_1 * i_1) + 1.0 / (60e6 * ratio * ratio);
  const double driven = 9500 + 202 * i_1 * i_1 + 2900 * i_1 * i_1 + 880 * std::pow(i_1 * i_2, 2) +
                        (3.5 + 534.116) * ratio * ratio + 3.0 * 130.0 * std::pow((56.0 - 17.0) / 17.0, 2);
  const double first = std::sqrt((1.0 / 38759228.0 + 1.0 / driven) / compliance) / kTwoPi;
  CHECK(modes.frequency_Hz[0] == Approx(first).epsilon(5e-3));
  const double r_planet = 0.5 * 0.045 * 17 * cosine;
  const double planets = std::sqrt(2.0 * 9e9 * r_planet * r_planet / 130.0) / kTwoPi;
  CHECK(modes.frequency_Hz[4] == Approx(planets).epsilon(1e-9));
  CHECK(modes.frequency_Hz[5] == Approx(planets).epsilon(1e-9));
  // The mean of a mesh's force over two periods of the first mode: a third of what the generator takes, except for what
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

TEST_CASE("Two cylinders with varying inertia, by the command: SciPy's motion, and why it is not exact") {
  const test::TemporaryFolder folder;
  const std::string file = DREV_SOURCE_DIR "/models/engine/varying_inertia.toml";
  const test::Outcome chosen = test::drev_command({"run", file, "--settle", "0"});
  CHECK(chosen.exit_code == 0);
  CHECK(test::contains(chosen.out, "engine has an inertia"));
  const test::Outcome run =
      test::drev_command({"run", file, "--settle", "0", "--method", "dormand_prince", "--tolerance", "1e-10",
                          "--out", (folder / "run").string(), "--quiet"});
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  // Speeds of throw 1 and flywheel after 0.1 s (tests/unit/elements/varying_inertia_test.cpp).
  const std::string history = test::read_file(folder / "run" / "history.csv");
  const std::string last = history.substr(history.rfind('\n', history.size() - 2) + 1);
  double t = 0.0, throw_1 = 0.0, flywheel = 0.0;
  REQUIRE(std::sscanf(last.c_str(), "%lf,%lf,%lf", &t, &throw_1, &flywheel) == 3);
  CHECK(t == Approx(0.1));
  CHECK(throw_1 == Approx(123.605872145463).epsilon(1e-8));
  CHECK(flywheel == Approx(123.363889683105).epsilon(1e-8));
  const test::Outcome exact = test::drev_command({"run", file, "--method", "exact"});
  CHECK(exact.exit_code != 0);
  CHECK(test::contains(exact.err, "(varying_inertia)"));
  const test::Outcome sweep = test::drev_command({"sweep", file, "--speeds", "900:10:1000"});
  CHECK(sweep.exit_code != 0);
  CHECK(test::contains(sweep.err, "(varying_inertia)"));
}

// Exact propagation beside average acceleration at 1e-5 s, with the main job's observers: processor
// time, and the error of each at 0.05 s (of exact propagation at tolerance 1e-14). Fastest of 3
// runs. Then what mesh laws cost it.
//   build/release/bin/bench_exact
#include <drev/core/system.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/stepping/step_scheme.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <algorithm>
#include <cstdio>
#include <ctime>

#include "tests/catch.hpp"
#include "tests/problems/mesh_laws.hpp"

using namespace drev;

namespace {

template <class Run>
double fastest_seconds(const Run& run) {
  double best = 1e9;
  for (int i = 0; i < 3; ++i) {
    const std::clock_t start = std::clock();
    run();
    best = std::min(best, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return best;
}

}  // namespace

TEST_CASE("Exact propagation of the camshaft beside average acceleration") {
  std::printf(
      "| drive, loads | exact [s] | steps | us a step | average acceleration [s] | ratio | "
      "error of exact | of average acceleration |\n");
  for (const auto& [drive, loads] : {std::pair{"held", "source"}, {"held", "actual"}, {"gears", "actual"}}) {
    Parameters s("camshaft", camshaft_entry().parameters);
    s.set("drive", drive);
    s.set("loads", loads);
    const ModelCase model_case = camshaft_entry().build(s);
    const System system = model_case.model.build();
    RunSummary exact;
    const auto observed = [&](const auto& run) {
      Peaks torque(find_channels(system, model_case.torques));
      Peaks deflection(find_channels(system, {model_case.deflection}));
      ContactStatistics contacts(system);
      return run(std::vector<Observer*>{&torque, &deflection, &contacts});
    };
    const double t_exact = fastest_seconds(
        [&] { exact = observed([&](const auto& o) { return propagate(system, {.t_end = 5.0}, o); }); });
    const double t_steps = fastest_seconds(
        [&] { observed([&](const auto& o) { return simulate(system, {.step = 1e-5, .t_end = 5.0}, o); }); });
    CHECK(exact.ok());
    State at_default = State::initial(system), tight = at_default, stepped = at_default;
    propagate(system, {.t_end = 0.05}, at_default);
    propagate(system, {.tolerance = 1e-14, .t_end = 0.05}, tight);
    simulate(system, {.step = 1e-5, .t_end = 0.05}, stepped);
    const double peak = tight.z.lpNorm<Eigen::Infinity>();
    std::printf("| %s, %s | %.2f | %ld | %.2f | %.2f | %.2f | %.0e | %.0e |\n", drive, loads, t_exact,
                exact.steps, 1e6 * t_exact / static_cast<double>(exact.steps), t_steps, t_steps / t_exact,
                (at_default.z - tight.z).lpNorm<Eigen::Infinity>() / peak,
                (stepped.z - tight.z).lpNorm<Eigen::Infinity>() / peak);
  }
}

TEST_CASE("Mesh laws under exact propagation: stiffness by phase and damping, beside constant and none") {
  // The camshaft's gear drive, 0.5 s at a tolerance of 1e-8: later stepped stiffness drives the undamped motion up. Errors of
  // the angles at 2 ms over the largest, beside dormand_prince at 1e-11, which shares no series and takes seconds for that.
  std::printf(
      "| mesh | time [s] | steps | ratio | with observers [s] | ratio | error "
      "|\n|---|---|---|---|---|---|---|\n");
  double constant = 0.0, constant_observed = 0.0;
  for (const test::MeshLaw& law : test::mesh_laws()) {
    const test::GearDrive drive = test::gear_drive_with(law);
    const System& system = drive.system;
    RunSummary run;
    const ExactOptions options{.tolerance = 1e-8, .t_end = 0.5};
    const double seconds = fastest_seconds([&] { run = propagate(system, options); });
    const double observed = fastest_seconds([&] {
      Peaks torque(find_channels(system, drive.torques));
      ContactStatistics contacts(system);
      propagate(system, options, {&torque, &contacts});
    });
    CHECK(run.ok());
    if (constant == 0.0) constant = seconds, constant_observed = observed;
    State at_tolerance = State::initial(system), other = at_tolerance;
    propagate(system, {.tolerance = 1e-8, .t_end = 0.002}, at_tolerance);
    simulate(system, {.scheme = step_scheme("dormand_prince"), .tolerance = 1e-11, .t_end = 0.002}, other);
    std::printf("| %s | %.3f | %ld | %.2f | %.3f | %.2f | %.1e |\n", law.name, seconds, run.steps,
                seconds / constant, observed, observed / constant_observed,
                (at_tolerance.z - other.z).lpNorm<Eigen::Infinity>() / other.z.lpNorm<Eigen::Infinity>());
  }
}

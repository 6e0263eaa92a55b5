// Time per step of the main job (`drev run camshaft` without what it prints), median of 5 runs, and its
// share by phase. Processor time: what else the machine does is not in it.
//   build/release/bin/bench_main_job
#include <drev/core/system.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <algorithm>
#include <cstdio>
#include <ctime>

#include "tests/catch.hpp"

using namespace drev;

TEST_CASE("Main job: time per step and share by phase") {
  const ModelCase model_case = camshaft_entry().build(Parameters("camshaft", camshaft_entry().parameters));
  const System system = model_case.model.build();
  const auto run = [&](bool phases) {
    Peaks torque(find_channels(system, model_case.torques));
    Peaks deflection(find_channels(system, {model_case.deflection}));
    ContactStatistics contacts(system);
    TransientOptions options{.step = model_case.default_step, .t_end = model_case.duration};
    options.newton.time_phases = phases;
    return simulate(system, options, {&torque, &deflection, &contacts});
  };
  std::vector<double> times;
  RunSummary summary;
  for (int i = 0; i < 5; ++i) {
    const std::clock_t start = std::clock();
    summary = run(false);
    times.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  CHECK(summary.ok());
  std::sort(times.begin(), times.end());
  const auto steps = static_cast<double>(summary.steps);
  std::printf("%d unknowns, %ld steps, %ld contact iterations, %ld load passes, %ld factorisations\n",
              system.size(), summary.steps, summary.iterations, summary.load_passes, summary.factorizations);
  std::printf("median %.3f s = %.2f us a step (fastest %.2f, slowest %.2f)\n", times[2],
              1e6 * times[2] / steps, 1e6 * times.front() / steps, 1e6 * times.back() / steps);
  const auto phases = run(true).phases;
  double sum = 0.0;
  for (const auto& [name, seconds] : phases) sum += seconds;
  for (const auto& [name, seconds] : phases)
    std::printf("| %s | %.2f us | %.0f %% |\n", name.c_str(), 1e6 * seconds / steps, 100.0 * seconds / sum);
}

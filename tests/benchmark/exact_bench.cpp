// Exact propagation beside average acceleration at 1e-5 s, with the main job's observers: processor
// time, and the error of each at 0.05 s (of exact propagation at tolerance 1e-14). Fastest of 3
// runs.
//   build/release/bin/bench_exact
#include <drev/core/system.hpp>
#include <drev/models/camshaft/build_camshaft.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <algorithm>
#include <cstdio>
#include <ctime>

#include "tests/catch.hpp"

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

// Many variants of the camshaft with gear drive in lockstep, beside single runs of the same variants on one
// core, by turns: throughput in steps and variants a second. Processor time of all threads, and the wall's.
//   build/release/bin/bench_many
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <thread>

#include "core/system.hpp"
#include "models/camshaft/build_camshaft.hpp"
#include "solvers/simulate_many.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

constexpr std::size_t kVariants = 32, kSingle = 2;
constexpr double kDuration = 1.0;  // s
constexpr int kTurns = 5;

Settings settings_of(std::size_t i) {
  Settings s("camshaft", camshaft_entry().settings);
  s.set("engine_rpm", to_text(600.0 + 3.0 * static_cast<double>(i)));
  s.set("backlash_mm", to_text(0.1 + 0.001 * static_cast<double>(i)));
  return s;
}

struct Clock {
  std::clock_t processor = std::clock();
  std::chrono::steady_clock::time_point wall = std::chrono::steady_clock::now();
  double processor_seconds() const {
    return static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC;
  }
  double wall_seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
  }
};

double median(std::vector<double> x) {
  std::sort(x.begin(), x.end());
  return x[x.size() / 2];
}

}  // namespace

TEST_CASE("Many variants in lockstep against single runs") {
  for (const double step : {1e-5, 1e-3}) {
    const TransientOptions options{.step = step, .t_end = kDuration * (step > 1e-4 ? 20.0 : 1.0),
                                   .energy_tolerance = 1e3};
    const auto build = [](std::size_t i) { return build_camshaft(settings_of(i)).model.build(); };
    const ManyOptions many{.channels = {"inlet_9-fuel_1.twist_rad"}};
    std::vector<double> single, lanes_processor, lanes_wall;
    double steps = 0.0;
    long alone = 0;
    for (int turn = 0; turn < kTurns; ++turn) {
      ManyOptions one = many;
      one.threads = 1;
      one.lockstep = false;
      const Clock single_clock;
      const ManyResult a = simulate_many(
          kSingle, [&](std::size_t i) { return build(i * kVariants / kSingle); }, options, one);
      double single_steps = 0.0;
      for (const VariantResult& v : a.variants) single_steps += static_cast<double>(v.summary.steps);
      single.push_back(single_clock.processor_seconds() / single_steps);
      const Clock clock;
      const ManyResult b = simulate_many(kVariants, build, options, many);
      steps = 0.0, alone = 0;
      for (const VariantResult& v : b.variants) {
        CHECK(v.ok());
        steps += static_cast<double>(v.summary.steps);
        alone += v.steps_alone;
      }
      lanes_processor.push_back(clock.processor_seconds() / steps);
      lanes_wall.push_back(clock.wall_seconds() / steps);
    }
    const double s = median(single), p = median(lanes_processor), w = median(lanes_wall);
    std::printf("h = %g s: %zu variants, %.0f steps in all, %ld of them alone; us a step and variant: "
                "single %.3f, lockstep %.4f of processor time, %.4f of the wall's on %u processors\n"
                "throughput over that of single runs on one core: %.1f a core, %.1f on all\n",
                step, kVariants, steps, alone, 1e6 * s, 1e6 * p, 1e6 * w,
                std::thread::hardware_concurrency(), s / p, s / w);
  }
}
